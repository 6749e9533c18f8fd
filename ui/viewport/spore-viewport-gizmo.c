/* The gizmo: handles over the picture by which the selected bodies are moved, turned and scaled. A drag is one undo
 * step. Scaling makes new meshes, so that a drag shows the box, and the bodies are scaled when it ends. */
#include <glib/gi18n.h>
#include <math.h>

#include "core/author/scale_edits.h"
#include "core/scene/length_unit.h"
#include "ui/panels/report.h"
#include "ui/viewport/spore-viewport-private.h"

#define LENGTH_PIXELS 90.0 /* of an axis, radius of a ring */
#define REACH_PIXELS 8.0   /* of the cursor from a handle */
#define RING_POINTS 48
#define FREE 3         /* in place of an axis: in the plane of the picture, or about the line of sight */
#define GRID_M 0.001   /* with Ctrl */
#define COARSE_M 0.005 /* with Ctrl and Shift */
#define TURN_RAD (G_PI / 12)
#define TENTH 0.1 /* of the size, with Ctrl */
#define HALF 0.5  /* with Ctrl and Shift */

static const SporeVec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const double colours[4][4] = {
    {0.95, 0.3, 0.3, 1}, {0.4, 0.85, 0.35, 1}, {0.4, 0.6, 1, 1}, {0.95, 0.95, 0.95, 1}};

static SporeDocument *document_of(SporeViewport *self) { return spore_editor_document_get(self->document); }

static gboolean is_shown(SporeViewport *self) {
  SporeSession *session = self->player ? spore_player_get_session(self->player) : NULL;
  if (session && spore_session_snapshot(session)->time_s > 0) return FALSE;
  return self->gizmo != SPORE_GIZMO_NONE && self->document && self->tool == SPORE_VIEWPORT_TOOL_SELECT &&
         !self->presented && !self->picking && !spore_viewport_measures_now(self) && !spore_viewport_is_locked(self);
}

/* What the selection is moved with. NULL: no body is selected. */
static SporePlacement *placement_of(SporeViewport *self) {
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(self->document);
  return bodies->len ? spore_placement_new(document_of(self), bodies) : NULL;
}

/* Geometry on the screen. */

/* The way out of the picture, of length 1. */
static SporeVec3 toward_eye(SporeViewport *self, SporeVec3 place) {
  SporeVec3 eye, right, up, forward;
  spore_camera_eye(&self->camera, &eye, &right, &up, &forward);
  return spore_vec3_normalise(spore_vec3_sub(eye, place), spore_vec3_scale(-1, forward));
}

/* So long that it is of fixed size on the screen, m. */
static double length_at(SporeViewport *self, SporeVec3 middle) {
  double x, y;
  if (!spore_viewport_project(self, middle, &x, &y)) return 0;
  SporeVec3 beside =
      spore_camera_unproject(&self->camera, middle, x + LENGTH_PIXELS, y, gtk_widget_get_allocated_width(self->area),
                             gtk_widget_get_allocated_height(self->area));
  return spore_vec3_distance(beside, middle);
}

static SporeVec3 on_ring(int axis, SporeVec3 middle, double radius, double angle) {
  SporeVec3 u = axes[(axis + 1) % 3], v = axes[(axis + 2) % 3];
  return spore_vec3_add_scaled(spore_vec3_add_scaled(middle, radius * cos(angle), u), radius * sin(angle), v);
}

/* Points of a handle's line, on the screen; returns how many. */
static guint line_of(SporeViewport *self, int axis, SporeVec3 middle, double (*line)[2]) {
  double length = length_at(self, middle);
  guint count = 0, points = self->gizmo == SPORE_GIZMO_TURN ? RING_POINTS + 1 : 2;
  for (guint i = 0; i < points; i++) {
    SporeVec3 at = self->gizmo == SPORE_GIZMO_TURN ? on_ring(axis, middle, length, 2 * G_PI * i / RING_POINTS)
                                                   : spore_vec3_add_scaled(middle, i * length, axes[axis]);
    if (spore_viewport_project(self, at, &line[count][0], &line[count][1])) count++;
  }
  return count;
}

static double way_to_segment(const double *a, const double *b, double x, double y) {
  double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
  double t = square > 0 ? CLAMP(((x - a[0]) * dx + (y - a[1]) * dy) / square, 0, 1) : 0;
  return hypot(a[0] + t * dx - x, a[1] + t * dy - y);
}

/* Whether the frame of the scale is there: a circle about the middle. */
static gboolean is_on_frame(SporeViewport *self, SporeVec3 middle, double x, double y) {
  double at[2];
  return spore_viewport_project(self, middle, &at[0], &at[1]) &&
         fabs(hypot(x - at[0], y - at[1]) - LENGTH_PIXELS) < REACH_PIXELS;
}

/* The axis whose handle is there, FREE for the middle; below 0: none. */
static int handle_at(SporeViewport *self, SporeVec3 middle, double x, double y) {
  double line[RING_POINTS + 1][2], least = REACH_PIXELS;
  int nearest = -1;
  if (self->gizmo == SPORE_GIZMO_SCALE) return is_on_frame(self, middle, x, y) ? FREE : -1;
  if (spore_viewport_handle_is_at(self, middle, x, y)) return FREE;
  for (int axis = 0; axis < 3; axis++) {
    guint count = line_of(self, axis, middle, line);
    for (guint i = 0; i + 1 < count; i++) {
      double way = way_to_segment(line[i], line[i + 1], x, y);
      if (way < least) least = way, nearest = axis;
    }
  }
  return nearest;
}

/* Drawing. */

static void draw_axis(SporeViewport *self, cairo_t *cr, int axis, SporeVec3 middle, gboolean held) {
  double line[RING_POINTS + 1][2];
  guint count = line_of(self, axis, middle, line);
  if (count < 2) return;
  cairo_move_to(cr, line[0][0], line[0][1]);
  for (guint i = 1; i < count; i++) cairo_line_to(cr, line[i][0], line[i][1]);
  spore_viewport_stroke(cr, colours[axis], held ? 4 : 2.5);
  if (self->gizmo == SPORE_GIZMO_TURN) return;
  static const char *const names[] = {"x", "y", "z"};
  cairo_arc(cr, line[count - 1][0], line[count - 1][1], held ? 7 : 5, 0, 2 * G_PI);
  cairo_fill(cr);
  spore_viewport_draw_text(self, cr, names[axis], line[count - 1][0] + 8, line[count - 1][1] - 8);
}

/* A circle with four grips. */
static void draw_frame(SporeViewport *self, cairo_t *cr, SporeVec3 middle, double factor, gboolean held) {
  static const int grips[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  double x, y, radius = LENGTH_PIXELS * factor;
  if (!spore_viewport_project(self, middle, &x, &y)) return;
  cairo_new_sub_path(cr);
  cairo_arc(cr, x, y, radius, 0, 2 * G_PI);
  spore_viewport_stroke(cr, colours[FREE], held ? 4 : 2.5);
  for (int i = 0; i < 4; i++) cairo_rectangle(cr, x + radius * grips[i][0] - 5, y + radius * grips[i][1] - 5, 10, 10);
  cairo_set_source_rgb(cr, colours[0][0], colours[0][1], colours[0][2]);
  cairo_fill(cr);
}

/* The box around what will be scaled. */
static void draw_box(SporeViewport *self, cairo_t *cr, const SporePlacement *placement, double factor) {
  double bounds[2][3], at[8][2];
  SporeVec3 middle = spore_placement_middle(placement);
  spore_placement_box(placement, bounds[0], bounds[1]);
  for (int i = 0; i < 8; i++) {
    SporeVec3 corner = {bounds[i & 1][0], bounds[i >> 1 & 1][1], bounds[i >> 2][2]};
    corner = spore_vec3_add_scaled(middle, factor, spore_vec3_sub(corner, middle));
    if (!spore_viewport_project(self, corner, &at[i][0], &at[i][1])) return;
  }
  for (int i = 0; i < 8; i++)
    for (int bit = 1; bit < 8; bit *= 2) {
      if (i & bit) continue;
      cairo_move_to(cr, at[i][0], at[i][1]);
      cairo_line_to(cr, at[i | bit][0], at[i | bit][1]);
    }
  spore_viewport_stroke(cr, colours[FREE], 1.5);
}

static void draw_scale(SporeViewport *self, cairo_t *cr, const SporePlacement *placement, gboolean drags) {
  double x, y, factor = drags ? self->factor : 1;
  SporeVec3 middle = spore_placement_middle(placement);
  draw_frame(self, cr, middle, factor, drags);
  if (!drags || !spore_viewport_project(self, middle, &x, &y)) return;
  draw_box(self, cr, placement, factor);
  g_autofree char *text = g_strdup_printf(_("%.0f %%"), 100 * factor);
  spore_viewport_draw_text(self, cr, text, x + 14, y + 14);
}

/* How far it is from where the drag began. */
static void draw_amount(SporeViewport *self, cairo_t *cr, SporeVec3 middle) {
  double x, y;
  if (!spore_viewport_project(self, middle, &x, &y)) return;
  double turn = spore_vec3_length(spore_quat_to_rotation_vector(self->motion.orientation));
  g_autofree char *text = self->gizmo == SPORE_GIZMO_TURN ? g_strdup_printf(_("%.1f°"), turn * 180 / G_PI)
                                                          : spore_length_text(spore_vec3_length(self->motion.position));
  spore_viewport_draw_text(self, cr, text, x + 14, y + 14);
}

void spore_viewport_gizmo_draw(SporeViewport *self, cairo_t *cr) {
  if (!is_shown(self)) return;
  gboolean drags = self->drag == DRAG_GIZMO;
  g_autoptr(SporePlacement) placement = placement_of(self);
  if (!placement) return;
  SporeVec3 middle = spore_placement_middle(placement);
  if (self->gizmo == SPORE_GIZMO_SCALE) {
    draw_scale(self, cr, placement, drags);
    return;
  }
  for (int axis = 0; axis < 3; axis++)
    if (!drags || self->gizmo_axis == axis || self->gizmo_axis == FREE)
      draw_axis(self, cr, axis, middle, drags && self->gizmo_axis == axis);
  spore_viewport_draw_handle(self, cr, middle, drags && self->gizmo_axis == FREE);
  if (drags) draw_amount(self, cr, middle);
}

/* Motions. */

static double snapped(double value, double step) { return step > 0 ? step * round(value / step) : value; }

/* How far the cursor has gone along the axis, m. */
static double along_axis(SporeViewport *self, double dx, double dy) {
  double length = length_at(self, self->start), from[2], to[2];
  SporeVec3 end = spore_vec3_add_scaled(self->start, length, axes[self->gizmo_axis]);
  if (!spore_viewport_project(self, self->start, &from[0], &from[1]) ||
      !spore_viewport_project(self, end, &to[0], &to[1]))
    return 0;
  double ax = to[0] - from[0], ay = to[1] - from[1], square = ax * ax + ay * ay;
  return square > 1 ? length * (dx * ax + dy * ay) / square : 0; /* an axis that points at the eye does not move it */
}

static SporePose shift(SporeViewport *self, double step) {
  SporePose motion = spore_pose_identity();
  if (self->gizmo_axis != FREE) {
    double way = along_axis(self, self->last_x - self->pressed_x, self->last_y - self->pressed_y);
    motion.position = spore_vec3_scale(snapped(way, step), axes[self->gizmo_axis]);
    return motion;
  }
  SporeVec3 way =
      spore_vec3_sub(spore_vec3_add(spore_viewport_under_cursor(self, self->start), self->offset), self->start);
  motion.position = spore_vec3(snapped(way.x, step), snapped(way.y, step), snapped(way.z, step));
  return motion;
}

static SporePose turn(SporeViewport *self, double step) {
  double x, y;
  if (!spore_viewport_project(self, self->start, &x, &y)) return spore_pose_identity();
  SporeVec3 eye = toward_eye(self, self->start), axis = self->gizmo_axis == FREE ? eye : axes[self->gizmo_axis];
  double angle = atan2(self->pressed_y - y, self->pressed_x - x) - atan2(self->last_y - y, self->last_x - x);
  angle = snapped(remainder(spore_vec3_dot(axis, eye) < 0 ? -angle : angle, 2 * G_PI), step);
  return spore_placement_turn(self->start, axis, angle);
}

/* How many times as far from the middle the cursor is as where the drag began. */
static double size_of(SporeViewport *self, double step) {
  double x, y;
  if (!spore_viewport_project(self, self->start, &x, &y)) return 1;
  double factor = hypot(self->last_x - x, self->last_y - y) / hypot(self->pressed_x - x, self->pressed_y - y);
  return fmax(snapped(factor, step), step > 0 ? step : 0.01);
}

/* The drag. */

/* Says why, where the selection cannot be scaled. */
static gboolean may_scale(SporeViewport *self) {
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(self->document);
  g_autoptr(GError) error = NULL;
  gboolean may = spore_edit_may_scale(document_of(self), bodies, &error);
  if (!may) spore_report(self->area, error);
  return may;
}

static void scale_selection(SporeViewport *self) {
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(self->document);
  g_autoptr(GError) error = NULL;
  if (self->factor != 1 && !spore_edit_scale(document_of(self), bodies, self->factor, &error))
    spore_report(self->area, error);
}

gboolean spore_viewport_gizmo_press(SporeViewport *self, double x, double y) {
  SporePlacement *placement = is_shown(self) ? placement_of(self) : NULL;
  if (!placement) return FALSE;
  self->start = spore_placement_middle(placement);
  self->gizmo_axis = handle_at(self, self->start, x, y);
  if (self->gizmo_axis < 0) {
    spore_placement_free(placement);
    return FALSE;
  }
  if (self->gizmo == SPORE_GIZMO_SCALE && !may_scale(self)) {
    spore_placement_free(placement);
    return TRUE;
  }
  self->placement = placement;
  self->factor = 1;
  self->pressed_x = x, self->pressed_y = y;
  self->motion = spore_pose_identity();
  self->offset = spore_vec3_sub(self->start, spore_viewport_under_cursor(self, self->start));
  self->drag = DRAG_GIZMO;
  if (self->gizmo != SPORE_GIZMO_SCALE)
    spore_document_begin(document_of(self), self->gizmo == SPORE_GIZMO_TURN ? _("Turn") : _("Move"));
  return TRUE;
}

void spore_viewport_gizmo_motion(SporeViewport *self, GdkModifierType modifiers) {
  g_autoptr(GError) error = NULL;
  gboolean snaps = modifiers & GDK_CONTROL_MASK;
  if (self->gizmo == SPORE_GIZMO_SCALE) {
    self->factor = size_of(self, !snaps ? 0 : modifiers & GDK_SHIFT_MASK ? HALF : TENTH);
    return;
  }
  double grid = !snaps ? 0 : modifiers & GDK_SHIFT_MASK ? COARSE_M : GRID_M;
  self->motion = self->gizmo == SPORE_GIZMO_TURN ? turn(self, snaps ? TURN_RAD : 0) : shift(self, grid);
  if (!spore_placement_move(self->placement, self->motion, &error)) spore_report(self->area, error);
}

void spore_viewport_gizmo_release(SporeViewport *self, gboolean keep) {
  g_clear_pointer(&self->placement, spore_placement_free);
  if (self->gizmo == SPORE_GIZMO_SCALE) {
    if (keep) scale_selection(self);
    return;
  }
  if (keep) spore_document_end(document_of(self));
  else spore_document_abort(document_of(self));
}

gboolean spore_viewport_gizmo_key(SporeViewport *self, guint key) {
  if (self->drag != DRAG_GIZMO || self->gizmo == SPORE_GIZMO_SCALE || key < GDK_KEY_x || key > GDK_KEY_z) return FALSE;
  self->gizmo_axis = (int)(key - GDK_KEY_x);
  spore_viewport_gizmo_motion(self, 0);
  return TRUE;
}
