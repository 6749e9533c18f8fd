/* The cube in the corner: how the axes of the scene lie, and views along them. Where meshes came in the axes of a
 * patient, its faces have the letters of anatomy. */
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/scene/document.h"
#include "ui/panels/report.h"
#include "ui/viewport/spore-viewport-private.h"

#define HALF_EDGE 17.0 /* pixels */
#define SEEN 0.12      /* least cosine of a face that is drawn with its letter */
#define Y_UP 0         /* number of the frame without a patient, see core/io/mesh_import.h */

/* A face: the way out, along two of its edges, and the view from there. */
typedef struct Face {
  SporeVec3 out, along, across;
  const char *view, *axis;
  const char *letter, *anatomic; /* of a patient's axes (core/io/mesh_import.h) */
  const char *from;
} Face;

static const Face faces[] = {
    {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, "front", "Z", N_("P"), N_("posterior"), N_("+Z (front)")},
    {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}, "back", "−Z", N_("A"), N_("anterior"), N_("−Z (back)")},
    {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, "right", "X", N_("R"), N_("right"), N_("+X (right)")},
    {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}, "left", "−X", N_("L"), N_("left"), N_("−X (left)")},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}, "top", "Y", N_("S"), N_("superior"), N_("+Y (top)")},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}, "bottom", "−Y", N_("I"), N_("inferior"), N_("−Y (bottom)")},
};

/* Whether a mesh of the scene says that it came in the axes of a patient. */
static gboolean is_anatomic(SporeViewport *self) {
  const SporeObject *assets =
      self->document ? spore_document_section(spore_editor_document_get(self->document), "assets") : NULL;
  for (guint i = 0; assets && i < spore_object_child_count(assets); i++) {
    const SporeObject *asset = spore_object_child(assets, i);
    if (g_str_equal(spore_object_type(asset)->element, "mesh") && (int)spore_object_number(asset, "frame") != Y_UP)
      return TRUE;
  }
  return FALSE;
}

/* "anterior (−Z)" or "−Z (back)"; g_free. */
static char *name_of(SporeViewport *self, const Face *face) {
  if (!is_anatomic(self)) return g_strdup(_(face->from));
  return g_strdup_printf("%s (%s)", _(face->anatomic), face->axis);
}

/* The camera's axes, and the middle of the cube in its widget. */
typedef struct Sight {
  SporeVec3 right, up, forward;
  double x, y;
} Sight;

static Sight sight_of(SporeViewport *self) {
  Sight sight;
  SporeVec3 eye;
  spore_camera_eye(&self->camera, &eye, &sight.right, &sight.up, &sight.forward);
  sight.x = 0.5 * gtk_widget_get_allocated_width(self->axes);
  sight.y = 0.5 * gtk_widget_get_allocated_height(self->axes);
  return sight;
}

static double facing(const Sight *sight, const Face *face) { return -spore_vec3_dot(face->out, sight->forward); }

static void corner_of(const Sight *sight, const Face *face, int corner, double at[2]) {
  double a = corner == 0 || corner == 3 ? -HALF_EDGE : HALF_EDGE, b = corner < 2 ? -HALF_EDGE : HALF_EDGE;
  SporeVec3 place = spore_vec3_add_scaled(spore_vec3_add_scaled(spore_vec3_scale(HALF_EDGE, face->out), a, face->along),
                                          b, face->across);
  at[0] = sight->x + spore_vec3_dot(place, sight->right);
  at[1] = sight->y - spore_vec3_dot(place, sight->up);
}

/* The face that looks at the eye most. */
static const Face *nearest_face(const Sight *sight) {
  const Face *nearest = &faces[0];
  for (guint i = 1; i < G_N_ELEMENTS(faces); i++)
    if (facing(sight, &faces[i]) > facing(sight, nearest)) nearest = &faces[i];
  return nearest;
}

/* NULL: none is there. */
static const Face *face_at(const Sight *sight, double x, double y) {
  for (guint i = 0; i < G_N_ELEMENTS(faces); i++) {
    int inside = 0;
    for (int k = 0; k < 4; k++) {
      double a[2], b[2];
      corner_of(sight, &faces[i], k, a);
      corner_of(sight, &faces[i], (k + 1) % 4, b);
      inside += (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) <= 0;
    }
    if (inside == 4 && facing(sight, &faces[i]) > SEEN) return &faces[i];
  }
  return NULL;
}

/* Drawing. */

static void draw_letter(SporeViewport *self, cairo_t *cr, const char *text, double x, double y) {
  int width, height;
  g_autoptr(PangoLayout) layout = gtk_widget_create_pango_layout(self->axes, text);
  pango_layout_get_pixel_size(layout, &width, &height);
  cairo_move_to(cr, x - 0.5 * width, y - 0.5 * height);
  spore_viewport_set_letters(self, cr);
  pango_cairo_show_layout(cr, layout);
}

static void draw_face(SporeViewport *self, cairo_t *cr, const Sight *sight, const Face *face, gboolean anatomic) {
  double at[2], shade = (self->light ? 0.76 : 0.16) + 0.16 * facing(sight, face);
  SporeVec3 middle = spore_vec3_scale(HALF_EDGE, face->out);
  gboolean pointed = self->pointed_view && g_str_equal(self->pointed_view, face->view);
  for (int k = 0; k < 4; k++) {
    corner_of(sight, face, k, at);
    if (k == 0) cairo_move_to(cr, at[0], at[1]);
    else cairo_line_to(cr, at[0], at[1]);
  }
  cairo_close_path(cr);
  if (pointed && self->light) cairo_set_source_rgba(cr, 0.6, 0.78, 0.98, 0.95);
  else if (pointed) cairo_set_source_rgba(cr, 0.17, 0.42, 0.72, 0.95);
  else cairo_set_source_rgba(cr, shade, shade, shade + 0.02, 0.85);
  cairo_fill_preserve(cr);
  if (self->light) cairo_set_source_rgba(cr, 0.32, 0.34, 0.37, 0.9);
  else cairo_set_source_rgba(cr, 0.75, 0.77, 0.8, 0.9);
  cairo_set_line_width(cr, 1);
  cairo_stroke(cr);
  if (facing(sight, face) > 3 * SEEN)
    draw_letter(self, cr, anatomic ? _(face->letter) : face->axis, sight->x + spore_vec3_dot(middle, sight->right),
                sight->y - spore_vec3_dot(middle, sight->up));
}

gboolean spore_viewport_draw_axes(GtkWidget *axes, cairo_t *cr, SporeViewport *self) {
  Sight sight = sight_of(self);
  gboolean anatomic = is_anatomic(self);
  if (!self->renderer) return FALSE; /* there is no picture yet, or never */
  for (guint i = 0; i < G_N_ELEMENTS(faces); i++)
    if (facing(&sight, &faces[i]) > 0) draw_face(self, cr, &sight, &faces[i], anatomic);
  if (gtk_widget_has_visible_focus(axes))
    gtk_render_focus(gtk_widget_get_style_context(axes), cr, 1, 1, gtk_widget_get_allocated_width(axes) - 2,
                     gtk_widget_get_allocated_height(axes) - 2);
  return FALSE;
}

void spore_viewport_tell_axes(SporeViewport *self) {
  const double turned[3] = {self->camera.azimuth, self->camera.elevation, self->camera.roll};
  Sight sight = sight_of(self);
  AtkObject *accessible = gtk_widget_get_accessible(self->axes);
  g_autofree char *name = name_of(self, nearest_face(&sight)), *text = g_strdup_printf(_("Seen from %s"), name);
  if (g_strcmp0(atk_object_get_description(accessible), text) != 0) atk_object_set_description(accessible, text);
  if (memcmp(turned, self->axes_shown, sizeof turned) == 0) return;
  memcpy(self->axes_shown, turned, sizeof turned);
  gtk_widget_queue_draw(self->axes);
}

/* Pointer and keys. */

static void look_from(SporeViewport *self, const Face *face) {
  spore_activate(self->axes, "view", g_variant_new_string(face->view));
}

gboolean spore_viewport_axes_press(GtkWidget *axes, GdkEventButton *event, SporeViewport *self) {
  Sight sight = sight_of(self);
  const Face *face = face_at(&sight, event->x, event->y);
  if (!face || event->type != GDK_BUTTON_PRESS || event->button != GDK_BUTTON_PRIMARY) return GDK_EVENT_PROPAGATE;
  look_from(self, face);
  return GDK_EVENT_STOP;
}

gboolean spore_viewport_axes_point(GtkWidget *axes, GdkEvent *event, SporeViewport *self) {
  Sight sight = sight_of(self);
  const Face *face = event->type == GDK_MOTION_NOTIFY ? face_at(&sight, event->motion.x, event->motion.y) : NULL;
  const char *view = face ? face->view : NULL;
  if (g_strcmp0(view, self->pointed_view) == 0) return GDK_EVENT_STOP;
  g_autofree char *name = face ? name_of(self, face) : NULL;
  g_autofree char *text = name ? g_strdup_printf(_("View from %s"), name) : NULL;
  self->pointed_view = view;
  gtk_widget_set_tooltip_text(axes, text);
  gtk_widget_queue_draw(axes);
  return GDK_EVENT_STOP;
}

/* Arrow keys go to the next face on that side. */
gboolean spore_viewport_axes_key(GtkWidget *axes, GdkEventKey *event, SporeViewport *self) {
  Sight sight = sight_of(self);
  SporeVec3 way;
  if (event->state & gtk_accelerator_get_default_mod_mask()) return GDK_EVENT_PROPAGATE;
  switch (event->keyval) {
  case GDK_KEY_Left:
    way = spore_vec3_scale(-1, sight.right);
    break;
  case GDK_KEY_Right:
    way = sight.right;
    break;
  case GDK_KEY_Up:
    way = sight.up;
    break;
  case GDK_KEY_Down:
    way = spore_vec3_scale(-1, sight.up);
    break;
  default:
    return GDK_EVENT_PROPAGATE;
  }
  const Face *next = &faces[0];
  for (guint i = 1; i < G_N_ELEMENTS(faces); i++)
    if (spore_vec3_dot(faces[i].out, way) > spore_vec3_dot(next->out, way)) next = &faces[i];
  look_from(self, next);
  return GDK_EVENT_STOP;
}
