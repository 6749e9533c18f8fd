/* Relocations: a ball that alone contains little of the solid is removed, and a ball that contains much volume outside
 * is divided in two. The gain shows late, and relocations help each other. So many are done in a batch, then the balls
 * around settle. The batch is kept if it lowers the cost; if not, it is undone and the next batch is smaller. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres/bounding_search.h"

#define BATCH 0.25          /* of the balls: relocations of the first batch, and at most */
#define PASS 0.125          /* of the balls: relocations from one ranking */
#define FEWER 0.7           /* relocations after a batch that is undone, relative to that batch */
#define MORE 1.2            /* after a batch that is kept */
#define NEIGHBOURS_MOST 10  /* neighbours that settle with a ball */
#define PAIR_SWEEPS 3       /* sweeps of the pair alone */
#define NEIGHBOURS_SWEEPS 1 /* then with neighbours; at equal work, more give sets of higher cost */
#define BATCH_SWEEPS 12
#define STEP 0.2         /* of a radius: search distance in the first sweep */
#define HALF_RADIUS 0.85 /* of the divided ball's radius: initial radius of the halves */
#define APART_LEAST 0.2  /* of the divided ball's radius: distance of the halves from its centre */
#define APART_MOST 0.6
#define SHAKE 1.2 /* range of the logarithm of the random factor on ranking values */
#define AXIS_ROUNDS 20

typedef struct Relocate {
  SporeBoundingSearch *search;
  double *worth, *burden; /* balls: volume inside that the ball alone contains; its share of the volume outside that it
                             contains; m^3 */
  bool *marked;           /* balls: handled in this pass */
  uint32_t active[2 + 2 * NEIGHBOURS_MOST];
  size_t active_count;
  SporeBalls before;
  uint16_t *held;       /* before */
  uint64_t first, work; /* search->work at the start, and the work allowed after it */
  const SporeProgressPart *progress;
  SporeError *error;
  bool cancelled;
} Relocate;

static bool go_on(Relocate *r) {
  double fraction = fmin(1, (double)(r->search->work - r->first) / (double)r->work);
  if (!r->cancelled) r->cancelled = !spore_progress_part(r->progress, fraction, _("Bounding with spheres"), r->error);
  return !r->cancelled;
}

static void weigh_ball(Relocate *r, size_t i) {
  SporeBoundingSearch *search = r->search;
  r->worth[i] = r->burden[i] = 0;
  spore_bounding_reach(search, spore_balls_centre(search->balls, i), 0, search->balls->r[i]);
  for (size_t m = 0; m < search->reached_count; m++) {
    size_t k = search->reached[m];
    double volume = search->costs.volume[k];
    unsigned held = search->costs.held[k];
    if (volume > 0) r->burden[i] += volume / held;
    else if (held == 1) r->worth[i] -= volume;
  }
}

/* Weighs all balls, with a random factor on each value, so that another pass tries other pairs. */
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

/* Marks and returns the ball of the least (sign 1) or the largest (sign -1) value among those not marked; SIZE_MAX: all
 * are marked. */
static size_t take_first(Relocate *r, const double *value, double sign) {
  size_t best = SIZE_MAX;
  for (size_t i = 0; i < r->search->balls->count; i++)
    if (!r->marked[i] && (best == SIZE_MAX || sign * value[i] < sign * value[best])) best = i;
  if (best != SIZE_MAX) r->marked[best] = true;
  return best;
}

/* Principal axis of the inside points that the ball alone contains, with their standard deviation as its length. */
static SporeVec3 long_axis(SporeBoundingSearch *search, size_t i) {
  const SporePoints *points = &search->costs.points;
  SporeVec3 c = spore_balls_centre(search->balls, i);
  double weight = 0, sum[3] = {0}, square[3][3] = {{0}};
  spore_bounding_reach(search, c, 0, search->balls->r[i]);
  for (size_t m = 0; m < search->reached_count; m++) {
    size_t k = search->reached[m];
    double volume = -search->costs.volume[k], p[3] = {points->x[k] - c.x, points->y[k] - c.y, points->z[k] - c.z};
    if (volume <= 0 || search->costs.held[k] != 1) continue;
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

static bool is_active(const Relocate *r, size_t i) {
  for (size_t k = 0; k < r->active_count; k++)
    if (r->active[k] == i) return true;
  return false;
}

/* Adds the balls that overlap the ball most. */
static void add_neighbours(Relocate *r, size_t of) {
  const SporeBalls *balls = r->search->balls;
  double gap[NEIGHBOURS_MOST];
  size_t found[NEIGHBOURS_MOST], count = 0;
  for (size_t i = 0; i < balls->count; i++) {
    double its =
        spore_vec3_distance(spore_balls_centre(balls, i), spore_balls_centre(balls, of)) - balls->r[i] - balls->r[of];
    if (its >= 0 || is_active(r, i) || (count == NEIGHBOURS_MOST && its >= gap[count - 1])) continue;
    size_t at = count < NEIGHBOURS_MOST ? count++ : count - 1;
    for (; at > 0 && gap[at - 1] > its; at--) gap[at] = gap[at - 1], found[at] = found[at - 1];
    gap[at] = its, found[at] = i;
  }
  for (size_t k = 0; k < count; k++) r->active[r->active_count++] = (uint32_t)found[k];
}

/* Settles the first `count` active balls once; returns the cost saved. */
static double settle_active(Relocate *r, size_t count) {
  double saved = 0;
  for (size_t k = 0; k < count; k++) saved += spore_bounding_settle(r->search, r->active[k]);
  return saved;
}

/* Divides `target` in two halves, one of which is `spare`; returns the cost saved. */
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

/* Divides `target` with `spare` and settles the balls around both; returns the cost saved. */
static double relocate(Relocate *r, size_t spare, size_t target) {
  SporeBoundingSearch *search = r->search;
  r->active[0] = (uint32_t)target, r->active[1] = (uint32_t)spare;
  r->active_count = 2;
  add_neighbours(r, target);
  add_neighbours(r, spare);
  for (size_t k = 0; k < r->active_count; k++) search->step[r->active[k]] = STEP, r->marked[r->active[k]] = true;
  double saved = divide_ball(search, spare, target);
  for (int sweep = 0; sweep < PAIR_SWEEPS; sweep++) saved += settle_active(r, 2);
  for (int sweep = 0; sweep < NEIGHBOURS_SWEEPS; sweep++) saved += settle_active(r, r->active_count);
  return saved;
}

/* At most `wanted` relocations from one ranking; *done: their number. Returns the cost saved. */
static double run_pass(Relocate *r, size_t wanted, size_t *done) {
  double saved = 0;
  weigh_balls(r);
  for (*done = 0; *done < wanted && go_on(r); ++*done) {
    size_t spare = take_first(r, r->worth, 1), target = take_first(r, r->burden, -1);
    if (target == SIZE_MAX) break;
    saved += relocate(r, spare, target);
  }
  return saved;
}

/* Settles the balls of the last pass, or all balls. `saved`: cost saved so far. Stops where the total cannot be
 * expected to become positive. Returns the total saved. */
static double settle_marked(Relocate *r, bool all, double saved) {
  for (int left = BATCH_SWEEPS - 1; left >= 0 && go_on(r); left--) {
    double more = 0;
    for (size_t i = 0; i < r->search->balls->count; i++)
      if (all || r->marked[i]) more += spore_bounding_settle(r->search, i);
    saved += more;
    if (saved + left * more <= 0) break;
  }
  return saved;
}

/* True: the batch lowers the cost and is kept. */
static bool try_batch(Relocate *r, size_t wanted) {
  SporeCosts *costs = &r->search->costs;
  size_t size = costs->points.block_count * SPORE_BLOCK * sizeof *r->held,
         a_pass = 1 + (size_t)(PASS * (double)r->search->balls->count), done = 1;
  memcpy(r->held, costs->held, size);
  spore_balls_copy(&r->before, r->search->balls);
  double saved = 0;
  for (size_t left = wanted; left > 0 && done > 0; left -= done)
    saved += run_pass(r, left < a_pass ? left : a_pass, &done);
  if (settle_marked(r, wanted >= a_pass, saved) > 0) return true;
  memcpy(costs->held, r->held, size);
  spore_balls_copy(r->search->balls, &r->before);
  return false;
}

static bool open_relocate(Relocate *r, SporeBoundingSearch *search) {
  size_t n = search->balls->count;
  *r = (Relocate){.search = search,
                  .worth = SPORE_NEW_ARRAY(double, n),
                  .burden = SPORE_NEW_ARRAY(double, n),
                  .marked = SPORE_NEW_ARRAY(bool, n),
                  .held = SPORE_NEW_ARRAY(uint16_t, search->costs.points.block_count * SPORE_BLOCK)};
  return spore_balls_create(&r->before, n) && r->worth && r->burden && r->marked && r->held;
}

static void close_relocate(Relocate *r) {
  spore_free(r->worth);
  spore_free(r->burden);
  spore_free(r->marked);
  spore_free(r->held);
  spore_balls_clear(&r->before);
}

bool spore_bounding_relocate(SporeBoundingSearch *search, uint64_t work, const SporeProgressPart *progress,
                             SporeError *error) {
  Relocate r;
  size_t n = search->balls->count;
  if (n < 2) return true;
  bool done = open_relocate(&r, search) || spore_generate_no_memory(error);
  r.first = search->work, r.work = work, r.progress = progress, r.error = error;
  double most = fmax(1, BATCH * (double)n), batch = most;
  while (done && search->work - r.first < work) {
    batch = try_batch(&r, (size_t)batch) ? fmin(MORE * batch, most) : fmax(FEWER * batch, 1);
    done = !r.cancelled;
    spore_progress_show_images(progress, &search->solid->symmetry, search->balls, search->bound);
  }
  close_relocate(&r);
  return done;
}
