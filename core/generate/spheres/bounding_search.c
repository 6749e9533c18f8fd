/* The search for bounding spheres: the cost of a ball at a place, and places of less cost. */
#include "core/generate/spheres/bounding_search.h"

#include <math.h>

#include "core/base/memory.h"
#include "core/generate/spheres/kernels.h"

#define BINS 48          /* number of radii that are compared */
#define TABLES 4         /* of sums by radius: points next to each other often add to the same sum */
#define SETTLE_TRIES 6   /* places tried for a ball in a sweep */
#define HARD_TRIES 12    /* the same where all must be covered */
#define LOOK_WORK 100    /* fixed work of a search around a ball */
#define COVER_TRIES 10   /* places tried for a ball, to cover a point */
#define COVER_SLACK 2e-3 /* of the diagonal: tolerance in choosing the balls that may cover a point */
#define NEEDED 1e3       /* of the solid's volume: cost of not covering a point that must be covered */
#define SHORTER 0.85     /* factor on the search distance, after a place of no less cost */
#define LONGER 1.5       /* factor after a search that found a better place */
#define STEP_LEAST 1e-3  /* of a radius */
#define STEP_MOST 0.3
#define ROUNDING 1e-6f /* of a distance in single precision */

static double square_distance(const SporePoints *points, size_t k, SporeVec3 c) {
  double dx = points->x[k] - c.x, dy = points->y[k] - c.y, dz = points->z[k] - c.z;
  return dx * dx + dy * dy + dz * dz;
}

static bool reaches(const double bound[4], SporeVec3 c, double radius) {
  double dx = bound[0] - c.x, dy = bound[1] - c.y, dz = bound[2] - c.z, reach = radius + bound[3];
  return dx * dx + dy * dy + dz * dz <= reach * reach;
}

static bool within(const double bound[4], SporeVec3 c, double radius) {
  double dx = bound[0] - c.x, dy = bound[1] - c.y, dz = bound[2] - c.z, room = radius - bound[3];
  return room > 0 && dx * dx + dy * dy + dz * dz < room * room;
}

void spore_bounding_reach(SporeBoundingSearch *search, SporeVec3 c, double inner, double radius) {
  const SporePoints points = search->costs.points;
  double inner2 = inner > 0 ? inner * inner : 0, at[3] = {c.x, c.y, c.z};
  uint32_t *end_reached = search->reached;
  for (size_t g = 0; g < points.group_count; g++) {
    if (!reaches(points.group + 4 * g, c, radius) || within(points.group + 4 * g, c, inner)) continue;
    size_t end = (g + 1) * SPORE_GROUP < points.block_count ? (g + 1) * SPORE_GROUP : points.block_count;
    for (size_t b = g * SPORE_GROUP; b < end; b++) {
      if (!reaches(points.block + 4 * b, c, radius) || within(points.block + 4 * b, c, inner)) continue;
      size_t first = b * SPORE_BLOCK;
      uint32_t bits = SPORE_KERNEL(spore_block_between)(points.x + first, points.y + first, points.z + first, at,
                                                        inner2, radius * radius);
      for (; bits; bits &= bits - 1) *end_reached++ = (uint32_t)(first + (size_t)__builtin_ctz(bits));
    }
  }
  search->reached_count = (size_t)(end_reached - search->reached);
}

static void add_local(SporeBoundingLocal *local, double x, double y, double z, double cost) {
  size_t k = local->count++;
  local->x[k] = (float)x, local->y[k] = (float)y, local->z[k] = (float)z, local->cost[k] = (float)cost;
}

static void pad_local(SporeBoundingLocal *local) {
  for (size_t k = local->count; k % SPORE_LOCAL_LANES; k++)
    local->x[k] = local->y[k] = local->z[k] = local->cost[k] = 0;
}

/* Collects the reached points that a ball near c could be the only one to contain. `radius`: of the ball at c that
 * `held` counts now; 0: there is none. */
static void find_local(SporeBoundingSearch *search, SporeVec3 c, double radius) {
  const SporePoints points = search->costs.points;
  SporeBoundingLocal local = search->local; /* copies: what is stored could alias the originals */
  const uint16_t *held = search->costs.held;
  const double *volume = search->costs.volume;
  double r2 = radius > 0 ? radius * radius : -1, uncovered = search->cost;
  bool hard = uncovered >= SPORE_BOUNDING_HARD;
  size_t count = 0;
  for (const uint32_t *k = search->reached; k < search->reached + search->reached_count; k++) {
    if (held[*k] > 1) continue;
    double cost = volume[*k] < 0 ? volume[*k] * uncovered : volume[*k];
    if (hard && (held[*k] == 0 || cost > 0))
      continue; /* uncovered points are covered one by one: spore_bounding_cover */
    double dx = points.x[*k] - c.x, dy = points.y[*k] - c.y, dz = points.z[*k] - c.z;
    if (cost == 0 || (held[*k] == 1 && dx * dx + dy * dy + dz * dz > r2)) continue;
    local.x[count] = (float)dx, local.y[count] = (float)dy, local.z[count] = (float)dz;
    local.cost[count++] = (float)cost;
  }
  search->local.count = count;
  pad_local(&search->local);
}

/* Distances of the local points from `at`, in the local coordinates. */
static void measure_local(SporeBoundingLocal *local, SporeVec3 at) {
  SPORE_KERNEL(spore_local_distances)
  (local->x, local->y, local->z, local->count, (const float[3]){(float)at.x, (float)at.y, (float)at.z},
   local->distance);
}

/* Cost of a ball of this radius, from the distances. */
static double local_cost(const SporeBoundingLocal *local, double radius, double *farthest) {
  SporeLocalCost cost;
  SPORE_KERNEL(spore_local_cost)(local->distance, local->cost, local->count, (float)radius, &cost);
  if (farthest) *farthest = (double)cost.farthest;
  return (double)cost.outside + (double)cost.inside;
}

/* The radius at which a ball contains all points that must be covered. */
static double needed_radius(const SporeBoundingLocal *local, double least) {
  double farthest;
  local_cost(local, HUGE_VAL, &farthest);
  return fmax(least, farthest * (1 + (double)ROUNDING));
}

/* About the radius of least cost between least and most, reduced to just contain the inside points within it. */
static double best_radius(const SporeBoundingLocal *local, double least, double most) {
  double sums[TABLES][BINS + 1] = {{0}}, width = (most - least) / (BINS - 1);
  SPORE_KERNEL(spore_local_bins)
  (local->distance, local->count, (float)least, (float)(1 / width), BINS, local->bin);
  for (size_t k = 0; k < local->count; k++) sums[k % TABLES][local->bin[k]] += (double)local->cost[k];
  double cost = 0, best = HUGE_VAL, farthest;
  int at = 0;
  for (int bin = 0; bin < BINS; bin++) {
    for (int t = 0; t < TABLES; t++) cost += sums[t][bin];
    if (cost < best) best = cost, at = bin;
  }
  local_cost(local, fmin(least + at * width, most), &farthest);
  return fmax(least, farthest * (1 + (double)ROUNDING));
}

/* A place for a ball, and the cost that a move there saves. */
typedef struct Place {
  SporeVec3 centre;
  double radius, saved;
} Place;

/* The best of a few places for ball i. Each try starts from the best place so far: first again in the direction that
 * led to it, then in a random direction. The distance shrinks after each failure. *scale (m): the search distance,
 * within which points were collected; returns the distance with which the next search should start. */
static Place try_places(SporeBoundingSearch *search, size_t i, double *scale, int tries, const SporeVec3 *needed) {
  SporeVec3 start = spore_balls_centre(search->balls, i), way = spore_vec3(0, 0, 0);
  double radius = search->balls->r[i], reach = *scale;
  bool hard = search->cost >= SPORE_BOUNDING_HARD, found = false;
  Place best = {start, radius, needed ? -HUGE_VAL : 0};
  measure_local(&search->local, spore_vec3(0, 0, 0));
  double before = hard ? spore_bounding_shell_volume(&search->shell, start, radius)
                       : local_cost(&search->local, radius, NULL),
         least = fmax(radius - 2 * reach, 0.1 * radius);
  for (int t = 0; t < tries; t++) {
    SporeVec3 c = spore_vec3_add(best.centre, way);
    if (t && !(spore_vec3_dot(way, way) > 0))
      c = spore_vec3_add_scaled(c, *scale * cbrt(spore_random_unit(&search->random)),
                                spore_random_direction(&search->random));
    c = spore_bounding_confine(search, i, c);
    double away = spore_vec3_distance(c, start), most = radius + 2 * reach - away;
    way = spore_vec3(0, 0, 0);
    if (away > reach) continue;
    measure_local(&search->local, spore_vec3_sub(c, start));
    double r = hard ? needed_radius(&search->local, least) : best_radius(&search->local, least, most);
    double saved = -HUGE_VAL;
    if (r <= most)
      saved = before - (hard ? spore_bounding_shell_volume(&search->shell, c, r) : local_cost(&search->local, r, NULL));
    if (saved > best.saved) {
      way = spore_vec3_sub(c, best.centre);
      best = (Place){c, r, saved};
      found = found || t;
    } else if (t) *scale *= SHORTER;
  }
  if (found) *scale = fmin(*scale * LONGER, reach * LONGER);
  return best;
}

static Place look_around(SporeBoundingSearch *search, size_t i, double *scale, int tries, const SporeVec3 *needed) {
  SporeVec3 start = spore_balls_centre(search->balls, i);
  double radius = search->balls->r[i];
  spore_bounding_reach(search, start, radius - 3 * *scale, radius + 2 * *scale);
  if (search->cost >= SPORE_BOUNDING_HARD)
    spore_bounding_shell_look(&search->shell, &search->solid->symmetry, search->balls, i, 2 * *scale);
  find_local(search, start, radius);
  if (needed) {
    SporeVec3 p = spore_vec3_sub(*needed, start);
    add_local(&search->local, p.x, p.y, p.z, -NEEDED * search->solid->volume);
    pad_local(&search->local);
  }
  search->work += LOOK_WORK + 2 * search->reached_count + search->local.count * (size_t)tries;
  return try_places(search, i, scale, tries, needed);
}

/* Adds `by` to `held` of the reached points in the ball: 1 when the ball is inserted, -1 when removed. */
static void hold_reached(SporeBoundingSearch *search, SporeVec3 c, double radius, int by) {
  const SporePoints points = search->costs.points;
  uint16_t *held = search->costs.held;
  for (const uint32_t *k = search->reached; k < search->reached + search->reached_count; k++) {
    bool in = square_distance(&points, *k, c) <= radius * radius;
    held[*k] = (uint16_t)(held[*k] + in * by);
  }
}

/* Moves ball i to a place. The points in the ball before and after must be in `reached`. */
static void put_reached(SporeBoundingSearch *search, size_t i, const Place *place) {
  hold_reached(search, spore_balls_centre(search->balls, i), search->balls->r[i], -1);
  hold_reached(search, place->centre, place->radius, 1);
  spore_balls_set(search->balls, i, place->centre, place->radius);
}

void spore_bounding_set_steps(SporeBoundingSearch *search, double step) {
  for (size_t i = 0; i < search->balls->count; i++) search->step[i] = step;
}

double spore_bounding_settle(SporeBoundingSearch *search, size_t i) {
  double radius = search->balls->r[i], scale = search->step[i] * radius;
  Place best = look_around(search, i, &scale, search->cost >= SPORE_BOUNDING_HARD ? HARD_TRIES : SETTLE_TRIES, NULL);
  search->step[i] = fmin(fmax(scale / radius, STEP_LEAST), STEP_MOST);
  if (best.saved > 0) put_reached(search, i, &best);
  return best.saved;
}

void spore_bounding_cover(SporeBoundingSearch *search, SporeVec3 p) {
  const SporeBalls *balls = search->balls;
  double least_gap = HUGE_VAL;
  for (size_t i = 0; i < balls->count; i++)
    least_gap = fmin(least_gap, spore_vec3_distance(p, spore_balls_centre(balls, i)) - balls->r[i]);
  if (least_gap <= 0) return;
  Place best = {.saved = -HUGE_VAL};
  size_t ball = 0;
  double limit = 2 * least_gap + COVER_SLACK * search->solid->diagonal;
  for (size_t i = 0; i < balls->count; i++) {
    double gap = spore_vec3_distance(p, spore_balls_centre(balls, i)) - balls->r[i];
    if (gap > limit) continue;
    double scale = 2 * gap;
    Place place = look_around(search, i, &scale, COVER_TRIES, &p);
    if (place.saved > best.saved) best = place, ball = i;
  }
  if (!(best.saved > -HUGE_VAL)) return;
  SporeVec3 c = spore_balls_centre(balls, ball);
  spore_bounding_reach(search, c, 0, fmax(balls->r[ball], spore_vec3_distance(c, best.centre) + best.radius));
  put_reached(search, ball, &best);
}

/* Cost of a ball at c; the points in the ball must be in `reached`. `counted`: `held` counts the ball. */
static double cost_of(SporeBoundingSearch *search, SporeVec3 c, double radius, bool counted) {
  find_local(search, c, counted ? radius : 0);
  measure_local(&search->local, spore_vec3(0, 0, 0));
  return local_cost(&search->local, radius * (1 + (double)ROUNDING), NULL);
}

double spore_bounding_remove(SporeBoundingSearch *search, size_t i) {
  SporeVec3 c = spore_balls_centre(search->balls, i);
  spore_bounding_reach(search, c, 0, search->balls->r[i]);
  double cost = cost_of(search, c, search->balls->r[i], true);
  hold_reached(search, c, search->balls->r[i], -1);
  return cost;
}

double spore_bounding_insert(SporeBoundingSearch *search, size_t i, SporeVec3 c, double radius) {
  spore_bounding_reach(search, c, 0, radius);
  double cost = cost_of(search, c, radius, false);
  hold_reached(search, c, radius, 1);
  spore_balls_set(search->balls, i, c, radius);
  return -cost;
}

SporeVec3 spore_bounding_confine(const SporeBoundingSearch *search, size_t i, SporeVec3 centre) {
  const SporeSymmetry *symmetry = &search->solid->symmetry;
  if (!symmetry->count) return centre;
  return spore_symmetry_bind(symmetry, search->bound[i], spore_symmetry_fold(symmetry, centre));
}

bool spore_bounding_open(SporeBoundingSearch *search) {
  size_t most = search->costs.points.block_count * SPORE_BLOCK + 2 * SPORE_LOCAL_LANES;
  float *memory = SPORE_NEW_ARRAY(float, 5 * most);
  int32_t *bin = SPORE_NEW_ARRAY(int32_t, most);
  search->reached = SPORE_NEW_ARRAY(uint32_t, most);
  search->step = SPORE_NEW_ARRAY(double, search->balls->count);
  search->local = (SporeBoundingLocal){.bin = bin};
  if (memory)
    search->local =
        (SporeBoundingLocal){0, memory, memory + most, memory + 2 * most, memory + 3 * most, memory + 4 * most, bin};
  if (!memory || !bin || !search->reached || !search->step) return false;
  for (size_t i = 0; i < search->balls->count; i++) {
    SporeVec3 c = spore_balls_centre(search->balls, i);
    spore_bounding_reach(search, c, 0, search->balls->r[i]);
    hold_reached(search, c, search->balls->r[i], 1);
  }
  if (!spore_bounding_shell_create(&search->shell)) return false;
  spore_bounding_shell_turn(&search->shell, &search->random);
  return true;
}

void spore_bounding_close(SporeBoundingSearch *search) {
  spore_free(search->reached);
  spore_free(search->step);
  spore_free(search->local.x);
  spore_free(search->local.bin);
  spore_bounding_shell_clear(&search->shell);
  search->reached = NULL;
  search->step = NULL;
  search->local = (SporeBoundingLocal){0};
}
