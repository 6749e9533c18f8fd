/* The brush that paints regions on an organ. A stroke is one undo step. */
#include "core/author/brush.h"
#include "core/author/edits.h"
#include "core/author/region_edits.h"
#include "core/mesh/common.h"
#include "core/scene/region.h"
#include "ui/panels/report.h"
#include "ui/viewport/spore-viewport-private.h"

#define PART 0.04 /* of the organ's diagonal: radius of the brush at first */
#define SIZE_A_NOTCH 1.1
#define LEAST_M 1e-5  /* radius */
#define STEP_PART 0.4 /* of the brush's radius on the screen: from pick to pick along a stroke */
#define LEAST_STEP_PIXELS 2
#define DOT_PIXELS 1.5

static SporeDocument *document_of(SporeViewport *self) { return spore_editor_document_get(self->document); }

static SporeObject *region_of(SporeViewport *self) {
  return self->brush.region ? spore_document_by_id(document_of(self), self->brush.region) : NULL;
}

/* The balls of the region, or none of a region that is still to come. g_array_unref. */
static GArray *balls_of(SporeViewport *self) {
  guint count;
  g_autofree double *balls = spore_region_balls(region_of(self), &count);
  return spore_brush_balls_new(balls, count);
}

/* The organ shows what is painted. */
void spore_viewport_brush_show(SporeViewport *self) {
  g_autoptr(GArray) kept = self->brush.balls ? g_array_ref(self->brush.balls) : balls_of(self);
  if (self->stage) spore_stage_set_painted(self->stage, self->brush.body, spore_brush_numbers(kept), kept->len);
  spore_viewport_redraw(self);
}

/* Beginning and ending. */

static double usual_radius(SporeViewport *self) {
  SporeTriangleMesh surface;
  double lower[3], upper[3];
  const SporeObject *region = region_of(self);
  guint dabs = region ? spore_object_child_count(region) : 0;
  if (region) return spore_object_number(dabs ? spore_object_child(region, dabs - 1) : region, "radius");
  if (!self->stage || !spore_stage_surface(self->stage, self->brush.body, &surface)) return 0.005;
  return fmax(PART * spore_mesh_bounds(surface.vertices, surface.vertex_count, 3, lower, upper), LEAST_M);
}

void spore_viewport_begin_brush(SporeViewport *self, SporeObject *body, const char *path) {
  SporeObject *object = spore_document_by_path(document_of(self), path);
  gboolean is_region = object && spore_region_is(object);
  spore_viewport_end_brush(self);
  self->brush.body = spore_object_id(body);
  self->brush.region = is_region ? spore_object_id(object) : 0;
  self->brush.holder = is_region ? spore_object_path(spore_object_parent(object)) : g_strdup(path);
  spore_viewport_edit_refresh(self);
  self->brush.radius = usual_radius(self);
  spore_viewport_brush_show(self);
}

gboolean spore_viewport_end_brush(SporeViewport *self) {
  if (!self->brush.body) return FALSE;
  if (self->drag == DRAG_BRUSH) self->drag = DRAG_NONE;
  if (self->stage) spore_stage_set_painted(self->stage, 0, NULL, 0);
  g_clear_pointer(&self->brush.balls, g_array_unref);
  g_free(self->brush.holder);
  self->brush = (SporeViewportBrush){0};
  spore_viewport_redraw(self);
  return TRUE;
}

gboolean spore_viewport_has_brush(SporeViewport *self) { return self->brush.body != 0; }

/* Where it is. */

/* The place of the organ under that pixel: now, and at rest in the body's frame. FALSE: the organ is not there. */
static gboolean place_under(SporeViewport *self, double x, double y, SporeVec3 *now, SporeVec3 *at_rest) {
  SporeVec3 origin, direction;
  SporeStageHold hold;
  const SporeObject *body = spore_document_by_id(document_of(self), self->brush.body);
  if (!self->stage || !body) return FALSE;
  spore_camera_ray(&self->camera, x, y, gtk_widget_get_allocated_width(self->area),
                   gtk_widget_get_allocated_height(self->area), &origin, &direction);
  spore_viewport_clip_picking(self);
  if (spore_stage_pick_hold(self->stage, origin, direction, now, &hold) != self->brush.body) return FALSE;
  if (!spore_stage_held_at_rest(self->stage, &hold, at_rest)) {
    SporePose pose = spore_body_pose(body);
    *at_rest = spore_quat_rotate(spore_quat_conjugate(pose.orientation), spore_vec3_sub(*now, pose.position));
  }
  return TRUE;
}

/* The brush's radius at that place, in pixels. */
static double pixels_at(SporeViewport *self, SporeVec3 place) {
  SporeVec3 eye, right, up, forward;
  double x, y, rim_x, rim_y;
  spore_camera_eye(&self->camera, &eye, &right, &up, &forward);
  if (!spore_viewport_project(self, place, &x, &y) ||
      !spore_viewport_project(self, spore_vec3_add_scaled(place, self->brush.radius, right), &rim_x, &rim_y))
    return 0;
  return hypot(rim_x - x, rim_y - y);
}

/* A dot in the middle of each dab. */
static void draw_dabs(SporeViewport *self, cairo_t *cr) {
  double x, y;
  g_autoptr(GArray) balls = self->brush.balls ? g_array_ref(self->brush.balls) : balls_of(self);
  SporePose pose = spore_body_pose(spore_document_by_id(document_of(self), self->brush.body));
  for (guint i = 0; i < balls->len; i++) {
    if (!spore_viewport_project(self, spore_pose_apply(pose, spore_vec3_load(spore_brush_numbers(balls) + 4 * i)), &x,
                                &y))
      continue;
    for (int bright = 0; bright < 2; bright++) {
      cairo_new_path(cr);
      cairo_arc(cr, x, y, bright ? DOT_PIXELS : DOT_PIXELS + 1, 0, 2 * G_PI);
      cairo_set_source_rgba(cr, bright, bright, bright, bright ? 0.8 : 0.5);
      cairo_fill(cr);
    }
  }
}

void spore_viewport_brush_draw(SporeViewport *self, cairo_t *cr) {
  SporeVec3 now, at_rest;
  if (!self->brush.body || !spore_document_by_id(document_of(self), self->brush.body)) return;
  draw_dabs(self, cr);
  if (!place_under(self, self->last_x, self->last_y, &now, &at_rest)) return;
  double radius = pixels_at(self, now);
  cairo_new_path(cr);
  cairo_arc(cr, self->last_x, self->last_y, radius, 0, 2 * G_PI);
  spore_viewport_stroke(cr, (const double[4]){1, 1, 1, 0.85}, 1.5);
}

/* Strokes. */

/* FALSE: the organ is not there. */
static gboolean dab(SporeViewport *self, double x, double y, double *pixels) {
  SporeVec3 now, at_rest;
  if (!place_under(self, x, y, &now, &at_rest)) return FALSE;
  *pixels = pixels_at(self, now);
  if (self->brush.erases) {
    if (spore_brush_erase(self->brush.balls, at_rest, self->brush.radius)) spore_viewport_brush_show(self);
    return TRUE;
  }
  double ball[4] = {at_rest.x, at_rest.y, at_rest.z, self->brush.radius};
  if (spore_brush_paint(self->brush.balls, at_rest, self->brush.radius)) spore_stage_add_painted(self->stage, ball);
  return TRUE;
}

gboolean spore_viewport_brush_press(SporeViewport *self, double x, double y, gboolean erases) {
  double pixels;
  if (!self->brush.body) return FALSE;
  self->brush.balls = balls_of(self);
  self->brush.erases = erases;
  if (dab(self, x, y, &pixels)) {
    self->drag = DRAG_BRUSH;
    spore_viewport_redraw(self);
    return TRUE;
  }
  g_clear_pointer(&self->brush.balls, g_array_unref);
  return FALSE;
}

void spore_viewport_brush_motion(SporeViewport *self, double from_x, double from_y) {
  double way = hypot(self->last_x - from_x, self->last_y - from_y), step = LEAST_STEP_PIXELS, pixels;
  for (double gone = step; gone < way; gone += step) {
    double part = gone / way;
    if (dab(self, from_x + part * (self->last_x - from_x), from_y + part * (self->last_y - from_y), &pixels))
      step = fmax(STEP_PART * pixels, LEAST_STEP_PIXELS);
  }
  dab(self, self->last_x, self->last_y, &pixels);
}

/* A region of which nothing is left is deleted. */
static gboolean commit(SporeViewport *self, const GArray *balls, GError **error) {
  SporeObject *region = region_of(self);
  if (region && balls->len)
    return spore_edit_paint_region(document_of(self), region, spore_brush_numbers(balls), balls->len, error);
  if (region) {
    g_autofree char *path = spore_object_path(region);
    return spore_edit_remove_region(document_of(self), path, error);
  }
  if (!balls->len) return TRUE;
  region = spore_edit_add_painted_region(document_of(self), self->brush.holder, NULL, spore_brush_numbers(balls),
                                         balls->len, error);
  if (region) self->brush.region = spore_object_id(region);
  return region != NULL;
}

void spore_viewport_brush_release(SporeViewport *self, gboolean keep) {
  g_autoptr(GArray) balls = g_steal_pointer(&self->brush.balls);
  g_autoptr(GArray) before = balls_of(self);
  g_autoptr(GError) error = NULL;
  gboolean changed =
      balls && (balls->len != before->len || memcmp(balls->data, before->data, balls->len * 4 * sizeof(double)) != 0);
  if (keep && changed && !commit(self, balls, &error)) spore_report(GTK_WIDGET(self), error);
  if (self->brush.body) spore_viewport_brush_show(self);
}

gboolean spore_viewport_brush_scroll(SporeViewport *self, double notches) {
  if (!self->brush.body) return FALSE;
  self->brush.radius = fmax(self->brush.radius * pow(SIZE_A_NOTCH, -notches), LEAST_M);
  spore_viewport_redraw(self);
  return TRUE;
}

/* The keyboard paints in the middle of the view. */
static void dab_in_the_middle(SporeViewport *self, gboolean erases) {
  double x = 0.5 * gtk_widget_get_allocated_width(self->area), y = 0.5 * gtk_widget_get_allocated_height(self->area);
  if (!spore_viewport_brush_press(self, x, y, erases)) return;
  self->drag = DRAG_NONE;
  spore_viewport_brush_release(self, TRUE);
}

/* The Edit tool goes on with the region as a whole. */
static void end_to_placing(SporeViewport *self) {
  const SporeObject *region = region_of(self);
  g_autofree char *path = region ? spore_object_path(region) : NULL;
  spore_viewport_end_brush(self);
  if (path) spore_activate(GTK_WIDGET(self), "place-region", g_variant_new_string(path));
  else spore_activate(GTK_WIDGET(self), "tool", g_variant_new_string("edit"));
}

gboolean spore_viewport_brush_key(SporeViewport *self, guint key) {
  if (!self->brush.body || self->drag != DRAG_NONE) return FALSE;
  switch (key) {
  case GDK_KEY_Escape:
    end_to_placing(self);
    return TRUE;
  case GDK_KEY_Insert:
  case GDK_KEY_Delete:
    dab_in_the_middle(self, key == GDK_KEY_Delete);
    return TRUE;
  case GDK_KEY_plus:
  case GDK_KEY_KP_Add:
  case GDK_KEY_bracketright:
    return spore_viewport_brush_scroll(self, -1);
  case GDK_KEY_minus:
  case GDK_KEY_KP_Subtract:
  case GDK_KEY_bracketleft:
    return spore_viewport_brush_scroll(self, 1);
  default:
    return FALSE;
  }
}
