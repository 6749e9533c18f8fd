/* The stage as an eye sees it: its bounds, the cameras of the scene, and the body under a ray. */
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/scene/camera_sight.h"
#include "ui/render/stage_body.h"

/* Bounds. */

static void take_in(double lower[3], double upper[3], const double *p, double radius) {
  for (int i = 0; i < 3; i++) {
    lower[i] = MIN(lower[i], p[i] - radius);
    upper[i] = MAX(upper[i], p[i] + radius);
  }
}

void spore_stage_bounds(const SporeStage *stage, double lower[3], double upper[3]) {
  for (int i = 0; i < 3; i++) lower[i] = HUGE_VAL, upper[i] = -HUGE_VAL;
  for (guint b = 0; b < stage->bodies->len; b++) {
    const SporeStageBody *body = stage->bodies->pdata[b];
    if (!spore_stage_shows(stage, body->object)) continue;
    for (gsize i = 0; i < body->surface.count; i++) take_in(lower, upper, body->surface.positions + 3 * i, 0);
    for (gsize i = 0; body->solid && i < body->shown; i++)
      take_in(lower, upper, body->spheres + 4 * i, body->spheres[4 * i + 3]);
  }
  const SporeStageCandidate *candidate = stage->candidate;
  for (gsize i = 0; candidate && !candidate->body && i < candidate->vertex_count; i++)
    take_in(lower, upper, candidate->vertices + 3 * i, 0);
  if (!(lower[0] <= upper[0])) /* an empty scene: a place the size of a hand */
    for (int i = 0; i < 3; i++) lower[i] = -0.05, upper[i] = 0.05;
}

/* Cameras. */

/* The first camera, or the one of that name. */
static const SporeObject *find_camera(const SporeStage *stage, const char *name) {
  if (name) return spore_document_find(stage->document, "camera", name);
  return spore_object_child_of(spore_document_section(stage->document, "tools"), "camera");
}

/* Where a rigid body has moved a point that belonged to it at the start. The point stays with any other body. */
static SporeVec3 moved_with(const SporeStage *stage, const SporeObject *body, SporeVec3 point) {
  SporeBodyFields fields;
  for (guint i = 0; body && i < stage->bodies->len; i++) {
    const SporeStageBody *shown = stage->bodies->pdata[i];
    if (shown->object != spore_object_id(body) || !shown->moves || shown->q_count != 7) continue;
    spore_object_fields(body, &fields);
    SporeQuat start = spore_quat_from_rotation_vector(spore_vec3_load(fields.rotation));
    SporeVec3 arm = spore_vec3_sub(point, spore_vec3_load(fields.position));
    SporePose now = spore_pose_load(shown->q);
    return spore_pose_apply(now, spore_quat_rotate(spore_quat_conjugate(start), arm));
  }
  return point;
}

/* Cameras of scenes are placed for a picture of this aspect. A narrower picture shows as much to the sides. */
#define SCENE_ASPECT (16.0 / 9)

static SporeCamera look_from(SporeVec3 position, SporeVec3 target, const SporeCameraFields *fields) {
  SporeVec3 back = spore_vec3_sub(position, target);
  double distance = spore_vec3_length(back);
  if (!(distance > 0)) back = spore_vec3(0, 0, 1), distance = 1e-3;
  return (SporeCamera){.target = target,
                       .distance = distance,
                       .azimuth = atan2(back.x, back.z),
                       .elevation = asin(CLAMP(back.y / spore_vec3_length(back), -1, 1)),
                       .field_of_view = fields->field_of_view,
                       .distortion = fields->distortion};
}

/* What is on the lens of that camera: the cameras of the scene are the eyes of the world, in the same order. */
static void see_through_lens(const SporeStage *stage, const SporeObject *object, SporeCamera *camera) {
  guint index = spore_camera_number(stage->document, object);
  if (index >= stage->lenses->len) return;
  const SporeLensState *lens = &g_array_index(stage->lenses, SporeLensState, index);
  camera->blood = (double)lens->blood, camera->water = (double)lens->water, camera->haze = (double)lens->haze;
}

/* The camera is level at the start, and turns with its body. */
static SporeCamera look_with(const SporeStage *stage, const SporeObject *object) {
  SporeCameraFields fields;
  SporeVec3 eye, right, up, forward;
  spore_object_fields(object, &fields);
  SporeVec3 position = spore_vec3_load(fields.position), target = spore_camera_sight(&fields);
  const SporeObject *body = spore_object_reference(object, "body");
  SporeCamera camera = look_from(position, target, &fields);
  if (!body) return camera;
  spore_camera_eye(&camera, &eye, &right, &up, &forward);
  SporeVec3 now = moved_with(stage, body, target);
  SporeVec3 upward = spore_vec3_sub(moved_with(stage, body, spore_vec3_add(target, up)), now);
  camera = look_from(moved_with(stage, body, position), now, &fields);
  spore_camera_eye(&camera, &eye, &right, &up, &forward);
  camera.roll = atan2(spore_vec3_dot(upward, right), spore_vec3_dot(upward, up));
  return camera;
}

gboolean spore_stage_camera(const SporeStage *stage, const char *name, double aspect, SporeCamera *camera,
                            GError **error) {
  const SporeObject *object = find_camera(stage, name);
  if (!object && name)
    return spore_error_raise(error, SPORE_ERROR_INPUT, name,
                             _("the scene has no camera of this name; a camera among its tools was expected; leave the "
                               "name out to see everything"));
  if (!object) {
    double lower[3], upper[3];
    spore_stage_bounds(stage, lower, upper);
    *camera = (SporeCamera){.azimuth = 0.5, .elevation = 0.35};
    spore_camera_frame(camera, lower, upper, aspect);
    return TRUE;
  }
  *camera = look_with(stage, object);
  see_through_lens(stage, object, camera);
  if (aspect < SCENE_ASPECT) camera->field_of_view = 2 * atan(tan(camera->field_of_view / 2) * SCENE_ASPECT / aspect);
  return TRUE;
}

/* Picking. */

/* Does the ray meet the box of the points before `nearest`? Slab test. */
static gboolean meets_box(const double *points, gsize count, const double origin[3], const double direction[3],
                          double nearest) {
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (gsize p = 0; p < 3 * count; p++) {
    lower[p % 3] = MIN(lower[p % 3], points[p]);
    upper[p % 3] = MAX(upper[p % 3], points[p]);
  }
  double enter = 0, leave = nearest;
  for (int i = 0; i < 3; i++) {
    if (direction[i] == 0) {
      if (origin[i] < lower[i] || origin[i] > upper[i]) return FALSE;
      continue;
    }
    double a = (lower[i] - origin[i]) / direction[i], b = (upper[i] - origin[i]) / direction[i];
    enter = MAX(enter, MIN(a, b));
    leave = MIN(leave, MAX(a, b));
  }
  return enter <= leave;
}

/* Distance along the ray to a triangle, or HUGE_VAL (Moeller and Trumbore 1997). shares: of its corners in that place.
 */
static double meet_triangle(SporeVec3 origin, SporeVec3 direction, const double *points, const guint32 *corners,
                            double shares[3]) {
  SporeVec3 a = spore_vec3_load(points + 3 * (gsize)corners[0]);
  SporeVec3 ab = spore_vec3_sub(spore_vec3_load(points + 3 * (gsize)corners[1]), a);
  SporeVec3 ac = spore_vec3_sub(spore_vec3_load(points + 3 * (gsize)corners[2]), a);
  SporeVec3 p = spore_vec3_cross(direction, ac), s = spore_vec3_sub(origin, a), q = spore_vec3_cross(s, ab);
  double determinant = spore_vec3_dot(ab, p);
  if (determinant == 0) return HUGE_VAL;
  double u = spore_vec3_dot(s, p) / determinant, v = spore_vec3_dot(direction, q) / determinant;
  double t = spore_vec3_dot(ac, q) / determinant;
  if (!(u >= 0 && v >= 0 && u + v <= 1 && t >= 0)) return HUGE_VAL;
  shares[0] = 1 - u - v, shares[1] = u, shares[2] = v;
  return t;
}

/* Distance along the ray to the sphere, to its far side where the near one is cut away; or HUGE_VAL. */
static double meet_sphere(SporeVec3 origin, SporeVec3 direction, const double *sphere, const SporeClip *clip) {
  SporeVec3 to = spore_vec3_sub(spore_vec3_load(sphere), origin);
  double along = spore_vec3_dot(to, direction);
  double inside = sphere[3] * sphere[3] - (spore_vec3_dot(to, to) - along * along);
  if (inside < 0 || along < sqrt(inside)) return HUGE_VAL;
  double near = along - sqrt(inside), far = along + sqrt(inside);
  if (!spore_clip_hides(clip, spore_vec3_add_scaled(origin, near, direction))) return near;
  return spore_clip_hides(clip, spore_vec3_add_scaled(origin, far, direction)) ? HUGE_VAL : far;
}

/* Where the ray comes out of what the plane hides; else HUGE_VAL. */
static double meet_plane(const SporeClip *clip, SporeVec3 origin, SporeVec3 direction) {
  double against = spore_vec3_dot(clip->normal, direction);
  double hidden = spore_vec3_dot(clip->normal, origin) - clip->distance;
  return against < 0 && hidden > 0 ? -hidden / against : HUGE_VAL;
}

/* Corners of the triangle as it is drawn, and its normal of length 1. */
static void load_triangle(const double *points, const guint32 *corners, SporeVec3 at[3], SporeVec3 *normal) {
  for (int k = 0; k < 3; k++) at[k] = spore_vec3_load(points + 3 * (gsize)corners[k]);
  SporeVec3 across = spore_vec3_cross(spore_vec3_sub(at[1], at[0]), spore_vec3_sub(at[2], at[0]));
  *normal = spore_vec3_normalise(across, spore_vec3(0, 1, 0));
}

/* Holds a place within the body by a triangle of its surface. */
static void hold_within(SporeStageHold *hold, const double *points, SporeVec3 place) {
  SporeVec3 at[3], normal;
  load_triangle(points, hold->corners, at, &normal);
  hold->above = spore_vec3_dot(spore_vec3_sub(place, at[0]), normal);
  SporeVec3 below = spore_vec3_add_scaled(place, -hold->above, normal);
  double whole = 0;
  for (int k = 0; k < 3; k++) { /* the share of a corner is that of the triangle across from the corner */
    SporeVec3 b = at[(k + 1) % 3], c = at[(k + 2) % 3];
    hold->at[k] = spore_vec3_dot(spore_vec3_cross(spore_vec3_sub(b, below), spore_vec3_sub(c, below)), normal);
    whole += hold->at[k];
  }
  for (int k = 0; k < 3 && whole > 0; k++) hold->at[k] /= whole;
}

/* Whether the ray comes out of the body through the triangle. */
static gboolean leaves(const double *points, const guint32 *corners, SporeVec3 direction) {
  SporeVec3 at[3], normal;
  load_triangle(points, corners, at, &normal);
  return spore_vec3_dot(normal, direction) > 0;
}

/* The nearest triangle that is not hidden, or the face at which the plane cuts the body, where that is filled. */
static double meet_surface(const SporeStage *stage, const SporeStageBody *body, SporeVec3 origin, SporeVec3 direction,
                           double nearest, SporeStageHold *hold) {
  const double *points = body->surface.positions;
  double plane = meet_plane(&stage->clip, origin, direction), behind = HUGE_VAL;
  SporeStageHold within = {0};
  for (gsize i = 0; i < body->triangle_count; i++) {
    SporeStageHold met = {.body = body->object, .count = body->surface.count};
    memcpy(met.corners, body->triangles + 3 * i, sizeof met.corners);
    double t = meet_triangle(origin, direction, points, met.corners, met.at);
    if (t == HUGE_VAL) continue;
    if (t > plane && t < behind) behind = t, within = met;
    if (t < nearest && !spore_clip_hides(&stage->clip, spore_vec3_add_scaled(origin, t, direction)))
      nearest = t, *hold = met;
  }
  if (behind == HUGE_VAL || !(plane < nearest) ||
      !spore_renderer_fills_surface(stage->renderer, body->surface_handle) ||
      !leaves(points, within.corners, direction))
    return nearest;
  *hold = within;
  hold_within(hold, points, spore_vec3_add_scaled(origin, plane, direction));
  return plane;
}

static double meet_body(const SporeStage *stage, const SporeStageBody *body, SporeVec3 origin, SporeVec3 direction,
                        double nearest, SporeStageHold *hold) {
  double o[3], d[3];
  spore_vec3_store(o, origin);
  spore_vec3_store(d, direction);
  if (body->surface_handle && meets_box(body->surface.positions, body->surface.count, o, d, nearest))
    nearest = meet_surface(stage, body, origin, direction, nearest, hold);
  for (gsize i = 0; body->solid && i < body->shown; i++) {
    double t = meet_sphere(origin, direction, body->spheres + 4 * i, &stage->clip);
    if (!(t < nearest)) continue;
    nearest = t;
    *hold = (SporeStageHold){.body = body->object, .on_sphere = TRUE, .count = body->shown, .corners = {(guint32)i}};
    SporeVec3 point = spore_vec3_add_scaled(origin, t, direction);
    spore_vec3_store(hold->at, spore_vec3_sub(point, spore_vec3_load(body->spheres + 4 * i)));
  }
  return nearest;
}

static guint32 pick(const SporeStage *stage, GHashTable *skipped, SporeVec3 origin, SporeVec3 direction,
                    SporeVec3 *point, SporeStageHold *hold) {
  double nearest = HUGE_VAL;
  guint32 picked = 0;
  for (guint i = 0; i < stage->bodies->len; i++) {
    const SporeStageBody *body = stage->bodies->pdata[i];
    if (!spore_stage_shows(stage, body->object) ||
        (skipped && g_hash_table_contains(skipped, GUINT_TO_POINTER(body->object))))
      continue;
    double t = meet_body(stage, body, origin, direction, nearest, hold);
    if (t < nearest) nearest = t, picked = body->object;
  }
  if (picked) *point = spore_vec3_add_scaled(origin, nearest, direction);
  return picked;
}

guint32 spore_stage_pick_hold(const SporeStage *stage, SporeVec3 origin, SporeVec3 direction, SporeVec3 *point,
                              SporeStageHold *hold) {
  return pick(stage, NULL, origin, direction, point, hold);
}

guint32 spore_stage_pick_past(const SporeStage *stage, GHashTable *skipped, SporeVec3 origin, SporeVec3 direction,
                              SporeVec3 *point) {
  SporeStageHold hold;
  return pick(stage, skipped, origin, direction, point, &hold);
}

guint32 spore_stage_pick(const SporeStage *stage, SporeVec3 origin, SporeVec3 direction, SporeVec3 *point) {
  return spore_stage_pick_past(stage, NULL, origin, direction, point);
}

static const SporeStageBody *find_body(const SporeStage *stage, guint32 object) {
  for (guint i = 0; i < stage->bodies->len; i++) {
    const SporeStageBody *body = stage->bodies->pdata[i];
    if (body->object == object) return body;
  }
  return NULL;
}

static SporeVec3 place_on_triangle(const double *points, const SporeStageHold *hold) {
  SporeVec3 at[3], normal;
  load_triangle(points, hold->corners, at, &normal);
  SporeVec3 place = spore_vec3_scale(hold->above, normal);
  for (int k = 0; k < 3; k++) place = spore_vec3_add_scaled(place, hold->at[k], at[k]);
  return place;
}

gboolean spore_stage_held(const SporeStage *stage, const SporeStageHold *hold, SporeVec3 *point) {
  const SporeStageBody *body = find_body(stage, hold->body);
  if (!body || hold->count != (hold->on_sphere ? body->shown : body->surface.count)) return FALSE;
  if (hold->on_sphere) {
    *point = spore_vec3_add(spore_vec3_load(body->spheres + 4 * hold->corners[0]), spore_vec3_load(hold->at));
    return TRUE;
  }
  *point = place_on_triangle(body->surface.positions, hold);
  return TRUE;
}

gboolean spore_stage_held_at_rest(const SporeStage *stage, const SporeStageHold *hold, SporeVec3 *place) {
  const SporeStageBody *body = find_body(stage, hold->body);
  if (!body || hold->on_sphere || !body->rest_surface || body->rest_count != body->surface.count) return FALSE;
  *place = place_on_triangle(body->rest_surface, hold);
  return TRUE;
}

gboolean spore_stage_surface(const SporeStage *stage, guint32 body, SporeTriangleMesh *surface) {
  const SporeStageBody *found = find_body(stage, body);
  if (!found || !found->surface_handle) return FALSE;
  *surface = (SporeTriangleMesh){.vertex_count = found->surface.count,
                                 .triangle_count = found->triangle_count,
                                 .vertices = found->surface.positions,
                                 .triangles = (uint32_t *)found->triangles};
  return TRUE;
}
