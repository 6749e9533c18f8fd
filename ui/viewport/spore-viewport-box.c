/* Selecting by a box. Drawn to the right the box takes the bodies that lie inside as a whole, drawn to the left all
 * that it touches, as drawing programs have it. */
#include <math.h>

#include "ui/panels/report.h"
#include "ui/viewport/spore-viewport-private.h"

#define LEAST_PIXELS 4.0 /* a smaller box is none */

static gboolean takes_touched(const SporeViewport *self) { return self->last_x < self->pressed_x; }

gboolean spore_viewport_box_press(SporeViewport *self, const GdkEventButton *event) {
  const guint both = GDK_CONTROL_MASK | GDK_SHIFT_MASK;
  if (!self->boxing && (event->state & gtk_accelerator_get_default_mod_mask()) != both) return FALSE;
  self->pressed_x = event->x, self->pressed_y = event->y;
  self->drag = DRAG_BOX;
  return TRUE;
}

/* Whether all points, or one of them, lie in the box. */
static gboolean takes(SporeViewport *self, const double *points, gsize count) {
  double left = MIN(self->pressed_x, self->last_x), right = MAX(self->pressed_x, self->last_x);
  double top = MIN(self->pressed_y, self->last_y), bottom = MAX(self->pressed_y, self->last_y);
  gboolean touched = takes_touched(self);
  for (gsize i = 0; i < count; i++) {
    double x, y;
    gboolean inside = spore_viewport_project(self, spore_vec3_load(points + 3 * i), &x, &y) && x >= left &&
                      x <= right && y >= top && y <= bottom;
    if (inside == touched) return touched;
  }
  return count > 0 && !touched;
}

static void select_boxed(SporeViewport *self) {
  const SporeObject *bodies = spore_document_section(spore_editor_document_get(self->document), "bodies");
  g_autoptr(GArray) chosen = g_array_new(FALSE, FALSE, sizeof(guint32));
  for (guint i = 0; self->stage && i < spore_object_child_count(bodies); i++) {
    guint32 id = spore_object_id(spore_object_child(bodies, i));
    SporeTriangleMesh surface;
    gboolean hidden = self->hidden && g_hash_table_contains(self->hidden, GUINT_TO_POINTER(id));
    gboolean locked = g_hash_table_contains(self->locked, GUINT_TO_POINTER(id));
    if (!hidden && !locked && spore_stage_surface(self->stage, id, &surface) &&
        takes(self, surface.vertices, surface.vertex_count))
      g_array_append_val(chosen, id);
  }
  spore_editor_document_select_several(self->document, (const guint32 *)(void *)chosen->data, chosen->len);
}

void spore_viewport_box_release(SporeViewport *self, gboolean keep) {
  double width = fabs(self->last_x - self->pressed_x), height = fabs(self->last_y - self->pressed_y);
  if (keep && MAX(width, height) >= LEAST_PIXELS) select_boxed(self);
  if (self->boxing) spore_activate(self->area, "box-select", NULL);
  gtk_widget_queue_draw(self->area);
}

void spore_viewport_box_draw(SporeViewport *self, cairo_t *cr) {
  const double dashes[] = {6, 4};
  if (self->drag != DRAG_BOX) return;
  cairo_rectangle(cr, self->pressed_x, self->pressed_y, self->last_x - self->pressed_x, self->last_y - self->pressed_y);
  cairo_set_source_rgba(cr, 0.35, 0.6, 1, 0.18);
  cairo_fill_preserve(cr);
  if (self->light) cairo_set_source_rgb(cr, 0.1, 0.3, 0.7);
  else cairo_set_source_rgb(cr, 0.75, 0.86, 1);
  cairo_set_line_width(cr, 1.5);
  if (takes_touched(self)) cairo_set_dash(cr, dashes, G_N_ELEMENTS(dashes), 0);
  cairo_stroke(cr);
  cairo_set_dash(cr, NULL, 0, 0);
}
