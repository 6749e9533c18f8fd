/* The seat of something on tissue. */
#include "core/sim/tool/seat.h"

#include <assert.h>
#include <math.h>

#define NEAR 2.5     /* times as far as the nearest point: no farther off is the third */
#define ON_A_LINE .2 /* sine of the triangle's angle: below, the points lie on a line */

static SporeVec3 point_at(const SporeSeatPoints *points, uint32_t i) {
  assert(i < points->count);
  return points->mapping ? spore_mapping_position(points->mapping, i, points->q)
                         : spore_vec3_load(points->q + 3 * (size_t)i);
}

/* The triangle of the seat's points; *sine: of its angle at the seat. */
static SporeMat3 triangle_of(const SporeSeat *seat, const SporeSeatPoints *points, double *sine) {
  SporeVec3 at = point_at(points, seat->point), none = {0, 0, 0};
  SporeVec3 one = spore_vec3_sub(point_at(points, seat->beside[0]), at);
  SporeVec3 other = spore_vec3_sub(point_at(points, seat->beside[1]), at);
  one = spore_vec3_normalise(one, none), other = spore_vec3_normalise(other, none);
  SporeVec3 normal = spore_vec3_cross(one, other);
  *sine = spore_vec3_length(normal);
  normal = spore_vec3_normalise(normal, none);
  return spore_mat3_from_columns(one, spore_vec3_cross(normal, one), normal);
}

/* How the tissue has turned about the seat since that was found. */
static SporeQuat turn_of(const SporeSeat *seat, const SporeSeatPoints *points) {
  double sine;
  SporeMat3 now = triangle_of(seat, points, &sine);
  if (!(spore_vec3_length(spore_mat3_column(now, 0)) > 0)) return (SporeQuat){1, 0, 0, 0}; /* two in one place */
  if (seat->on_a_line) return spore_quat_between(spore_mat3_column(seat->triangle, 0), spore_mat3_column(now, 0));
  if (!(sine > 0)) return (SporeQuat){1, 0, 0, 0};
  return spore_quat_from_mat3(spore_mat3_multiply(now, spore_mat3_transpose(seat->triangle)));
}

static double apart(const SporeSeatPoints *points, uint32_t a, uint32_t b) {
  return spore_vec3_distance(point_at(points, a), point_at(points, b));
}

/* The point that is nearest to the place, besides one in the same place as `but`. */
static uint32_t nearest_point(const SporeSeatPoints *points, SporeVec3 place, uint32_t but) {
  uint32_t nearest = SPORE_NO_POINT;
  double least = INFINITY;
  for (uint32_t i = 0; i < points->count; i++) {
    double off = spore_vec3_distance(point_at(points, i), place);
    if (!(off < least) || (but != SPORE_NO_POINT && !(apart(points, i, but) > 0))) continue;
    least = off;
    nearest = i;
  }
  return nearest;
}

/* Two points beside the seat's: the nearest, and of those near it the one that is least on a line with it. */
static void find_beside(SporeSeat *seat, const SporeSeatPoints *points) {
  uint32_t one = nearest_point(points, point_at(points, seat->point), seat->point);
  double most = -1, sine;
  if (one == SPORE_NO_POINT) one = seat->point;
  seat->beside[0] = one;
  uint32_t best = one;
  for (uint32_t i = 0; i < points->count; i++) {
    seat->beside[1] = i;
    if (apart(points, i, seat->point) > NEAR * apart(points, one, seat->point)) continue;
    triangle_of(seat, points, &sine);
    if (sine > most) most = sine, best = i;
  }
  seat->beside[1] = best;
  seat->triangle = triangle_of(seat, points, &sine);
  seat->on_a_line = sine < ON_A_LINE;
}

void spore_seat_find(SporeSeat *seat, const SporeSeatPoints *points, SporeVec3 place) {
  assert(points->count > 0);
  seat->point = nearest_point(points, place, SPORE_NO_POINT);
  find_beside(seat, points);
}

SporePose spore_seat_frame(const SporeSeat *seat, const SporeSeatPoints *points) {
  assert(points->count > 0);
  uint32_t last = points->count - 1;
  SporePose frame = spore_pose_identity();
  frame.position = point_at(points, seat->point < last ? seat->point : last);
  if (seat->point <= last && seat->beside[0] <= last && seat->beside[1] <= last)
    frame.orientation = turn_of(seat, points);
  return frame;
}
