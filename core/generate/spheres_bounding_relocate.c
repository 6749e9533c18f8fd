/* Relocations: a ball that alone holds little of the solid is given up, and one that holds much outside is divided in
 * two. Those around settle; the trial stands where all of that together saves. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres_bounding_search.h"

#define ACTIVE_MOST 20   /* balls that settle in a trial */
#define TRIAL_SWEEPS 5   /* of them */
#define TRIAL_STEP 0.2   /* of a radius: of the first sweep */
#define PAIR_SWEEPS 3    /* of the two alone, before */
#define HALF_RADIUS 0.85 /* of the divided ball's: radius of its halves, at first */
#define APART_LEAST 0.2  /* of the divided ball's radius: its halves' way from its middle */
#define APART_MOST 0.6
#define SHAKE 1.2 /* largest logarithm of a factor by which ranks are blurred */
#define AXIS_ROUNDS 20

typedef struct Relocate {
  SporeBoundingSearch *search;
  double *worth, *burden; /* balls: volume inside that it holds alone, volume outside that it holds, shared, m^3 */
  bool *marked;           /* balls: done with in this pass */
  uint32_t active[ACTIVE_MOST];
  size_t active_count;
  SporeBalls before;
  uint16_t *held; /* before */
} Relocate;

static void weigh_ball(Relocate *r, size_t i) {
  SporeBoundingSearch *search = r->search;
  r->worth[i] = r->burden[i] = 0;
  spore_bounding_reach(search, spore_balls_centre(search->balls, i), search->balls->r[i]);
  for (size_t m = 0; m < search->reached_count; m++) {
    size_t k = search->reached[m];
    double volume = search->prices.volume[k];
    unsigned held = search->prices.held[k];
    if (volume > 0) r->burden[i] += volume / held;
    else if (held == 1) r->worth[i] -= volume;
  }
}

/* Blurs what the balls are ranked by, so that another pass tries other pairs. */
static void weigh_balls(Relocate *r) {
  SporeRandom *random = &r->search->random;
  double little = 1e-3 * r->search->solid->volume / (double)r->search->balls->count;
  for (size_t i = 0; i < r->search->balls->count; i++) {
    weigh_ball(r, i);
    r->worth[i] = (r->worth[i] + little) * exp(SHAKE * (spore_random_unit(random) - 0.5));
    r->burden[i] *= exp(SHAKE * (spore_random_unit(random) - 0.5));
    r->marked[i] = false;
  }
}

/* Ball of the least (sign 1) or the largest (sign -1) value, of those not marked; SIZE_MAX: all are. */
static size_t first_of(const Relocate *r, const double *value, double sign) {
  size_t best = SIZE_MAX;
  for (size_t i = 0; i < r->search->balls->count; i++)
    if (!r->marked[i] && (best == SIZE_MAX || sign * value[i] < sign * value[best])) best = i;
  return best;
}

/* Direction in which the inside points that the ball alone holds lie widest, as long as their deviation. */
static SporeVec3 long_axis(SporeBoundingSearch *search, size_t i) {
  const SporePoints *points = &search->prices.points;
  SporeVec3 c = spore_balls_centre(search->balls, i);
  double weight = 0, sum[3] = {0}, square[3][3] = {{0}};
  spore_bounding_reach(search, c, search->balls->r[i]);
  for (size_t m = 0; m < search->reached_count; m++) {
    size_t k = search->reached[m];
    double volume = -search->prices.volume[k], p[3] = {points->x[k] - c.x, points->y[k] - c.y, points->z[k] - c.z};
    if (volume <= 0 || search->prices.held[k] != 1) continue;
    weight += volume;
    for (int a = 0; a < 3; a++) {
      sum[a] += volume * p[a];
      for (int b = 0; b < 3; b++) square[a][b] += volume * p[a] * p[b];
    }
  }
  double axis[3] = {1, 1, 1}, length = 0;
  for (int round = 0; weight > 0 && round < AXIS_ROUNDS; round++) {
    double next[3] = {0};
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) next[a] += (square[a][b] / weight - sum[a] / weight * sum[b] / weight) * axis[b];
    length = sqrt(next[0] * next[0] + next[1] * next[1] + next[2] * next[2]);
    for (int a = 0; length > 0 && a < 3; a++) axis[a] = next[a] / length;
  }
  return spore_vec3_scale(sqrt(length), spore_vec3_normalise(spore_vec3_load(axis), spore_vec3(1, 0, 0)));
}

/* The pair, and balls that overlap either of them. */
static void choose_active(Relocate *r, size_t spare, size_t target) {
  const SporeBalls *balls = r->search->balls;
  r->active[0] = (uint32_t)target, r->active[1] = (uint32_t)spare;
  r->active_count = 2;
  for (size_t i = 0; i < balls->count && r->active_count < ACTIVE_MOST; i++)
    for (size_t p = 0; p < 2; p++) {
      size_t of = r->active[p];
      if (i == spare || i == target ||
          spore_vec3_distance(spore_balls_centre(balls, i), spore_balls_centre(balls, of)) >=
              balls->r[i] + balls->r[of])
        continue;
      r->active[r->active_count++] = (uint32_t)i;
      break;
    }
}

/* A sweep of the first `count`; what it saves. */
static double settle_active(Relocate *r, size_t count) {
  double saved = 0;
  for (size_t k = 0; k < count; k++) saved += spore_bounding_settle(r->search, r->active[k]);
  return saved;
}

/* What it saves that `spare` becomes one half of `target`. */
static double divide_ball(SporeBoundingSearch *search, size_t spare, size_t target) {
  double saved = spore_bounding_remove(search, spare);
  double radius = search->balls->r[target], half = HALF_RADIUS * radius;
  SporeVec3 c = spore_balls_centre(search->balls, target), axis = long_axis(search, target);
  double length = spore_vec3_length(axis), apart = fmin(fmax(length, APART_LEAST * radius), APART_MOST * radius);
  axis = spore_vec3_scale(apart, spore_vec3_normalise(axis, spore_vec3(1, 0, 0)));
  saved += spore_bounding_remove(search, target);
  SporeVec3 one = spore_bounding_confine(search, target, spore_vec3_add(c, axis)),
            other = spore_bounding_confine(search, spare, spore_vec3_sub(c, axis));
  saved += spore_bounding_insert(search, target, one, half);
  return saved + spore_bounding_insert(search, spare, other, half);
}

/* True: it pays, and stands. */
static bool try_pair(Relocate *r, size_t spare, size_t target) {
  SporeBoundingSearch *search = r->search;
  size_t size = search->prices.points.block_count * SPORE_BLOCK * sizeof *r->held;
  memcpy(r->held, search->prices.held, size);
  spore_balls_copy(&r->before, search->balls);
  choose_active(r, spare, target);
  double saved = divide_ball(search, spare, target);
  for (size_t k = 0; k < r->active_count; k++) search->step[r->active[k]] = TRIAL_STEP;
  for (int sweep = 0; sweep < PAIR_SWEEPS; sweep++) saved += settle_active(r, 2);
  for (int left = TRIAL_SWEEPS - 1; left >= 0; left--) {
    double more = settle_active(r, r->active_count);
    saved += more;
    if (saved > 0 && left <= TRIAL_SWEEPS - 2) return true;
    if (saved + left * more <= 0) break; /* the next sweeps will hardly save more than this one */
  }
  memcpy(search->prices.held, r->held, size);
  spore_balls_copy(search->balls, &r->before);
  return false;
}

static bool open_relocate(Relocate *r, SporeBoundingSearch *search) {
  size_t n = search->balls->count;
  *r = (Relocate){.search = search,
                  .worth = SPORE_NEW_ARRAY(double, n),
                  .burden = SPORE_NEW_ARRAY(double, n),
                  .marked = SPORE_NEW_ARRAY(bool, n),
                  .held = SPORE_NEW_ARRAY(uint16_t, search->prices.points.block_count * SPORE_BLOCK)};
  return spore_balls_create(&r->before, n) && r->worth && r->burden && r->marked && r->held;
}

static void close_relocate(Relocate *r) {
  spore_free(r->worth);
  spore_free(r->burden);
  spore_free(r->marked);
  spore_free(r->held);
  spore_balls_clear(&r->before);
}

bool spore_bounding_relocate(SporeBoundingSearch *search, size_t trials, const SporeProgressPart *progress,
                             SporeError *error) {
  Relocate r;
  size_t n = search->balls->count, a_pass = n / 8 + 1;
  bool done = n < 2 || open_relocate(&r, search) || spore_spheres_no_memory(error);
  if (n < 2) return true;
  for (size_t trial = 0; done && trial < trials; trial++) {
    if (trial % a_pass == 0) weigh_balls(&r);
    size_t spare = first_of(&r, r.worth, 1);
    if (spare != SIZE_MAX) r.marked[spare] = true;
    size_t target = first_of(&r, r.burden, -1);
    if (target == SIZE_MAX) continue;
    r.marked[target] = true;
    done = spore_progress_part(progress, (double)trial / (double)trials, _("Bounding with spheres"), error);
    if (!done || !try_pair(&r, spare, target)) continue;
    for (size_t k = 0; k < r.active_count; k++) r.marked[r.active[k]] = true;
    spore_progress_show_images(progress, &search->solid->symmetry, search->balls, search->bound);
  }
  close_relocate(&r);
  return done;
}
