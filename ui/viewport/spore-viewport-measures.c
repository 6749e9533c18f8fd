/* Measures in the view: distances, angles and volumes, made by clicks on bodies, which they follow. They are of the
 * view alone: the scene and its file do not know of them. */
#include "ui/viewport/spore-viewport-private.h"

#include <glib/gi18n.h>

#include "core/mesh/volume.h"
#include "ui/panels/report.h"

typedef struct Measure {
  const SporeGauge *gauge;
  guint32 number; /* that the list says, from 1 */
  guint count;    /* of the places so far */
  SporeStageHold holds[SPORE_GAUGE_PLACES];
  SporeVec3 places[SPORE_GAUGE_PLACES]; /* world, m */
  double figure;
  gboolean lost;        /* what it was made on is gone or changed; the figure is the last one */
  gsize triangle_count; /* of the surface around the volume, when it was last looked at closely */
  gboolean closed;      /* was it */
  GtkWidget *row, *label;
} Measure;

struct SporeViewportMeasures {
  Measure draft; /* gauge NULL: nothing is being measured */
  GPtrArray *made;
  guint32 last_number;
};

static void measure_free(gpointer data) {
  Measure *measure = data;
  if (measure->row) gtk_widget_destroy(measure->row);
  g_free(measure);
}

SporeViewportMeasures *spore_viewport_measures_new(void) {
  SporeViewportMeasures *measures = g_new0(SporeViewportMeasures, 1);
  measures->made = g_ptr_array_new_with_free_func(measure_free);
  return measures;
}

void spore_viewport_measures_free(SporeViewportMeasures *measures) {
  g_ptr_array_unref(measures->made);
  g_free(measures);
}

static void changed(SporeViewport *self) {
  gtk_widget_queue_draw(self->area);
  g_signal_emit_by_name(self, "measuring");
}

/* Figures. */

/* The surface is looked at closely where it has other triangles than before; moving leaves it closed. FALSE with a
 * GError only after such a look. */
static gboolean find_volume(SporeViewport *self, Measure *measure, GError **error) {
  SporeTriangleMesh surface;
  if (!spore_stage_surface(self->stage, measure->holds[0].body, &surface))
    return spore_error_raise(error, SPORE_ERROR_INPUT, NULL,
                             _("this body shows no surface, so that it has no volume; click on another one"));
  if (surface.triangle_count != measure->triangle_count) {
    measure->triangle_count = surface.triangle_count;
    measure->closed = spore_gauge_volume(&surface, &measure->figure, error);
  } else if (measure->closed) {
    measure->figure = fabs(spore_triangle_mesh_volume(&surface));
  }
  return measure->closed;
}

static gboolean find_figure(SporeViewport *self, Measure *measure, GError **error) {
  if (!measure->gauge->of_places) return find_volume(self, measure, error);
  measure->figure = measure->gauge->of_places(measure->places);
  return TRUE;
}

/* What was made on a body follows it. */
static void follow(SporeViewport *self, Measure *measure) {
  measure->lost = FALSE;
  for (guint i = 0; i < measure->count; i++)
    measure->lost = !spore_stage_held(self->stage, &measure->holds[i], &measure->places[i]) || measure->lost;
  if (!measure->lost) measure->lost = !find_figure(self, measure, NULL);
}

static char *text_of(const Measure *measure) {
  g_autofree char *figure = measure->gauge->text(measure->figure);
  return measure->lost ? g_strdup_printf(_("%s (before the body changed)"), figure) : g_steal_pointer(&figure);
}

static void show_row(const Measure *measure) {
  g_autofree char *figure = text_of(measure);
  g_autofree char *text = g_strdup_printf(_("%u  %s %s"), measure->number, _(measure->gauge->label), figure);
  gtk_label_set_text(GTK_LABEL(measure->label), text);
}

void spore_viewport_measures_follow(SporeViewport *self) {
  for (guint i = 0; self->stage && i < self->measures->made->len; i++) {
    Measure *measure = self->measures->made->pdata[i];
    follow(self, measure);
    show_row(measure);
  }
}

/* The list. */

static void remove_asked(GtkButton *button, SporeViewport *self) {
  GtkWidget *row = gtk_widget_get_parent(GTK_WIDGET(button));
  for (guint i = 0; i < self->measures->made->len; i++) {
    Measure *measure = self->measures->made->pdata[i];
    if (measure->row != row) continue;
    g_ptr_array_remove_index(self->measures->made, i);
    break;
  }
  changed(self);
}

static void add_row(SporeViewport *self, Measure *measure) {
  GtkWidget *button = gtk_button_new_from_icon_name("window-close-symbolic", GTK_ICON_SIZE_MENU);
  g_autofree char *name = g_strdup_printf(_("Remove measure %u"), measure->number);
  gtk_widget_set_tooltip_text(button, name);
  atk_object_set_name(gtk_widget_get_accessible(button), name);
  gtk_style_context_add_class(gtk_widget_get_style_context(button), "row-button");
  g_signal_connect_object(button, "clicked", G_CALLBACK(remove_asked), self, 0);
  measure->row = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
  measure->label = gtk_label_new(NULL);
  gtk_style_context_add_class(gtk_widget_get_style_context(measure->row), "hud");
  gtk_box_pack_end(GTK_BOX(measure->row), button, FALSE, FALSE, 0);
  gtk_box_pack_end(GTK_BOX(measure->row), measure->label, FALSE, FALSE, 0);
  gtk_widget_set_halign(measure->row, GTK_ALIGN_START);
  gtk_container_add(GTK_CONTAINER(self->measure_list), measure->row);
  show_row(measure);
  gtk_widget_show_all(measure->row);
}

void spore_viewport_measures_forget(SporeViewportMeasures *measures) {
  g_ptr_array_set_size(measures->made, 0);
  measures->draft = (Measure){0};
  measures->last_number = 0;
}

void spore_viewport_clear_measures(SporeViewport *self) {
  spore_viewport_measures_forget(self->measures);
  changed(self);
}

guint spore_viewport_measure_count(SporeViewport *self) { return self->measures->made->len; }

/* A menu of the kinds. Returns a reference. */
static GMenuModel *menu_of_kinds(void) {
  GMenu *menu = g_menu_new(), *removing = g_menu_new();
  for (const SporeGauge *const *gauge = spore_gauges; *gauge; gauge++) {
    g_autoptr(GMenuItem) item = g_menu_item_new(_((*gauge)->label), NULL);
    g_menu_item_set_action_and_target(item, "win.measure", "s", (*gauge)->name);
    g_menu_append_item(menu, item);
  }
  g_menu_append(removing, _("Remove all measures"), "win.clear-measures");
  g_menu_append_section(menu, NULL, G_MENU_MODEL(removing));
  g_object_unref(removing);
  return G_MENU_MODEL(menu);
}

void spore_viewport_measures_fill_menu(GtkMenuButton *button) {
  g_autoptr(GMenuModel) menu = menu_of_kinds();
  gtk_menu_button_set_menu_model(button, menu);
}

/* Making one. */

void spore_viewport_measure(SporeViewport *self, const SporeGauge *gauge) {
  self->measures->draft = (Measure){.gauge = gauge};
  gtk_widget_grab_focus(self->area);
  changed(self);
}

void spore_viewport_end_measuring(SporeViewport *self) {
  if (!self->measures->draft.gauge) return;
  self->measures->draft = (Measure){0};
  changed(self);
}

gboolean spore_viewport_measures_now(SporeViewport *self) { return self->measures->draft.gauge != NULL; }

char *spore_viewport_measure_hint(SporeViewport *self) {
  const Measure *draft = &self->measures->draft;
  if (!draft->gauge) return NULL;
  return g_strdup_printf(_("%s: %s (%u of %u); Escape goes back"), _(draft->gauge->label),
                         _(draft->gauge->hints[draft->count]), draft->count + 1, draft->gauge->place_count);
}

static void finish(SporeViewport *self) {
  g_autoptr(GError) error = NULL;
  Measure *draft = &self->measures->draft;
  if (!find_figure(self, draft, &error)) {
    draft->count--; /* another click may be right */
    draft->triangle_count = 0;
    spore_report(self->area, error);
    return;
  }
  draft->number = ++self->measures->last_number;
  Measure *made = g_memdup2(draft, sizeof *draft);
  *draft = (Measure){0};
  add_row(self, made);
  g_ptr_array_add(self->measures->made, made);
}

gboolean spore_viewport_measures_press(SporeViewport *self, double x, double y) {
  Measure *draft = &self->measures->draft;
  SporeVec3 origin, direction;
  if (!draft->gauge || !self->stage) return FALSE;
  spore_camera_ray(&self->camera, x, y, gtk_widget_get_allocated_width(self->area),
                   gtk_widget_get_allocated_height(self->area), &origin, &direction);
  spore_viewport_clip_picking(self);
  if (!spore_stage_pick_hold(self->stage, origin, direction, &draft->places[draft->count], &draft->holds[draft->count]))
    return FALSE;
  if (++draft->count == draft->gauge->place_count) finish(self);
  changed(self);
  return TRUE;
}

gboolean spore_viewport_measures_back(SporeViewport *self) {
  Measure *draft = &self->measures->draft;
  if (!draft->gauge) return FALSE;
  if (draft->count) draft->count--;
  else *draft = (Measure){0};
  changed(self);
  return TRUE;
}

/* Drawing. */

static void draw_lines(SporeViewport *self, cairo_t *cr, const Measure *measure) {
  double x, y;
  gboolean going = FALSE;
  cairo_new_path(cr);
  for (guint i = 0; i < measure->count; i++) {
    if (!spore_viewport_project(self, measure->places[i], &x, &y)) continue;
    if (going) cairo_line_to(cr, x, y);
    else cairo_move_to(cr, x, y);
    going = TRUE;
  }
  if (measure == &self->measures->draft && going) cairo_line_to(cr, self->last_x, self->last_y);
  spore_viewport_stroke(cr, (const double[4]){0.55, 0.95, 0.65, measure->lost ? 0.4 : 1}, 2);
  for (guint i = 0; i < measure->count; i++) spore_viewport_draw_handle(self, cr, measure->places[i], FALSE);
}

/* At the corner of an angle, in the middle of a distance, beside the place of a volume. */
static void draw_figure(SporeViewport *self, cairo_t *cr, const Measure *measure) {
  double x, y;
  SporeVec3 at = measure->places[measure->count / 2];
  if (measure->count == 2) at = spore_vec3_scale(0.5, spore_vec3_add(measure->places[0], at));
  if (!spore_viewport_project(self, at, &x, &y)) return;
  g_autofree char *figure = measure->gauge->text(measure->figure);
  g_autofree char *text = g_strdup_printf("%u  %s", measure->number, figure);
  spore_viewport_draw_text(self, cr, text, x + 9, y - 22);
}

void spore_viewport_measures_draw(SporeViewport *self, cairo_t *cr) {
  const GPtrArray *made = self->measures->made;
  for (guint i = 0; i < made->len; i++) draw_lines(self, cr, made->pdata[i]);
  for (guint i = 0; i < made->len; i++) draw_figure(self, cr, made->pdata[i]);
  if (!self->measures->draft.gauge) return;
  draw_lines(self, cr, &self->measures->draft);
  spore_viewport_draw_cross(self, cr);
}
