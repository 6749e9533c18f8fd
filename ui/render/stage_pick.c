#include <math.h>

#include "ui/render/stage_body.h"

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

/* Distance along the ray to a triangle, or HUGE_VAL (Moeller and Trumbore 1997). */
static double meet_triangle(SporeVec3 origin, SporeVec3 direction, const double *points, const guint32 *corners) {
  SporeVec3 a = spore_vec3_load(points + 3 * (gsize)corners[0]);
  SporeVec3 ab = spore_vec3_sub(spore_vec3_load(points + 3 * (gsize)corners[1]), a);
  SporeVec3 ac = spore_vec3_sub(spore_vec3_load(points + 3 * (gsize)corners[2]), a);
  SporeVec3 p = spore_vec3_cross(direction, ac), s = spore_vec3_sub(origin, a), q = spore_vec3_cross(s, ab);
  double determinant = spore_vec3_dot(ab, p);
  if (determinant == 0) return HUGE_VAL;
  double u = spore_vec3_dot(s, p) / determinant, v = spore_vec3_dot(direction, q) / determinant;
  double t = spore_vec3_dot(ac, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 ? t : HUGE_VAL;
}

static double meet_sphere(SporeVec3 origin, SporeVec3 direction, const double *sphere) {
  SporeVec3 to = spore_vec3_sub(spore_vec3_load(sphere), origin);
  double along = spore_vec3_dot(to, direction);
  double inside = sphere[3] * sphere[3] - (spore_vec3_dot(to, to) - along * along);
  double t = inside >= 0 ? along - sqrt(inside) : -1;
  return t >= 0 ? t : HUGE_VAL;
}

static double meet_body(const SporeStageBody *body, SporeVec3 origin, SporeVec3 direction, double nearest) {
  double o[3], d[3];
  spore_vec3_store(o, origin);
  spore_vec3_store(d, direction);
  if (body->surface_handle && meets_box(body->surface.positions, body->surface.count, o, d, nearest))
    for (gsize i = 0; i < body->triangle_count; i++)
      nearest = MIN(nearest, meet_triangle(origin, direction, body->surface.positions, body->triangles + 3 * i));
  for (gsize i = 0; body->solid && i < body->shown; i++)
    nearest = MIN(nearest, meet_sphere(origin, direction, body->spheres + 4 * i));
  return nearest;
}

guint32 spore_stage_pick(const SporeStage *stage, SporeVec3 origin, SporeVec3 direction, SporeVec3 *point) {
  double nearest = HUGE_VAL;
  guint32 picked = 0;
  for (guint i = 0; i < stage->bodies->len; i++) {
    const SporeStageBody *body = stage->bodies->pdata[i];
    double t = meet_body(body, origin, direction, nearest);
    if (t < nearest) nearest = t, picked = body->object;
  }
  if (picked) *point = spore_vec3_add_scaled(origin, nearest, direction);
  return picked;
}
