/* Balls around a solid: a search that moves one ball at a time to where it, the others as they are, costs least. What
 * is outside costs its volume; what is left uncovered costs its volume times a price that rises, so that at first balls
 * can hand over what they hold to their neighbours. Balls that do little are given up, and one that holds much outside
 * is divided, wherever that turns out to pay after their neighbours have settled. */
#include "core/generate/spheres_bounding.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"

#define BINS 48          /* of radii, of which the best is looked for */
#define SETTLE_TRIES 6   /* of places of a ball, a sweep */
#define COVER_TRIES 10   /* of places of a ball, to cover a point */
#define COVER_SLACK 2e-3 /* of the diagonal: balls not this much farther from a point than the nearest may cover it */
#define NEEDED 1e3       /* of the solid's volume: price of a point that must be covered */
#define FEW 60           /* balls: so many sweep twice, half as many or fewer three times */
#define HARD_PRICE 1e4   /* of volume left uncovered, above which nothing is */
#define GAP_VOLUME 0.3   /* of a cube: volume that an added point stands for */

typedef struct Local {
  size_t count;
  double *x, *y, *z, *price; /* points that no other ball holds; price of holding them, below 0: of leaving them */
} Local;

typedef struct Search {
  const SporeSolid *solid;
  SporePrices prices;
  SporeBalls *balls;
  double price; /* of volume left uncovered, against volume outside */
  uint32_t *reached;
  size_t reached_count;
  Local local;
  SporeRandom random;
} Search;

static double price_of(const Search *search, size_t point) {
  double volume = search->prices.volume[point];
  return volume < 0 ? volume * search->price : volume;
}

static double square_distance(const SporePoints *points, size_t k, SporeVec3 c) {
  double dx = points->x[k] - c.x, dy = points->y[k] - c.y, dz = points->z[k] - c.z;
  return dx * dx + dy * dy + dz * dz;
}

static bool reaches(const double bound[4], SporeVec3 c, double radius) {
  double dx = bound[0] - c.x, dy = bound[1] - c.y, dz = bound[2] - c.z, reach = radius + bound[3];
  return dx * dx + dy * dy + dz * dz <= reach * reach;
}

/* Points within `radius` of c into search->reached. */
static void find_reached(Search *search, SporeVec3 c, double radius) {
  const SporePoints *points = &search->prices.points;
  size_t count = 0;
  for (size_t g = 0; g < points->group_count; g++) {
    if (!reaches(points->group + 4 * g, c, radius)) continue;
    size_t end = (g + 1) * SPORE_GROUP < points->block_count ? (g + 1) * SPORE_GROUP : points->block_count;
    for (size_t b = g * SPORE_GROUP; b < end; b++) {
      if (!reaches(points->block + 4 * b, c, radius)) continue;
      for (size_t k = b * SPORE_BLOCK; k < (b + 1) * SPORE_BLOCK; k++) {
        search->reached[count] = (uint32_t)k;
        count += square_distance(points, k, c) <= radius * radius;
      }
    }
  }
  search->reached_count = count;
}

/* Points that the ball alone could hold, of those reached; `held_by_it`: it is counted in `held` now. */
static void find_local(Search *search, SporeVec3 c, double radius, bool held_by_it) {
  const SporePoints *points = &search->prices.points;
  Local *local = &search->local;
  double r2 = radius * radius;
  local->count = 0;
  for (size_t m = 0; m < search->reached_count; m++) {
    size_t k = search->reached[m];
    unsigned others = search->prices.held[k] - (held_by_it && square_distance(points, k, c) <= r2);
    double price = others ? 0 : price_of(search, k);
    local->x[local->count] = points->x[k], local->y[local->count] = points->y[k], local->z[local->count] = points->z[k];
    local->price[local->count] = price;
    local->count += price != 0;
  }
}

static void add_local(Local *local, SporeVec3 p, double price) {
  size_t k = local->count++;
  local->x[k] = p.x, local->y[k] = p.y, local->z[k] = p.z, local->price[k] = price;
}

static double local_cost(const Local *local, SporeVec3 c, double radius) {
  double sum = 0, r2 = radius * radius;
  for (size_t k = 0; k < local->count; k++) {
    double dx = local->x[k] - c.x, dy = local->y[k] - c.y, dz = local->z[k] - c.z;
    sum += dx * dx + dy * dy + dz * dz <= r2 ? local->price[k] : 0;
  }
  return sum;
}

/* The radius between least and most at which a ball about c costs least, about; just enough for what it holds. */
static double best_radius(const Local *local, SporeVec3 c, double least, double most) {
  double sum[BINS + 1] = {0}, farthest[BINS + 1] = {0}, scale = (BINS - 1) / (most - least);
  for (size_t k = 0; k < local->count; k++) {
    double dx = local->x[k] - c.x, dy = local->y[k] - c.y, dz = local->z[k] - c.z;
    double d = sqrt(dx * dx + dy * dy + dz * dz), at = (d - least) * scale;
    size_t bin = at <= 0 ? 0 : d >= most ? BINS : (size_t)at + 1;
    sum[bin] += local->price[k];
    if (local->price[k] < 0 && d > farthest[bin]) farthest[bin] = d;
  }
  double cost = 0, best = HUGE_VAL, radius = 0, needed = least;
  for (size_t bin = 0; bin < BINS; bin++) {
    cost += sum[bin];
    needed = fmax(needed, farthest[bin] * (1 + 1e-12));
    if (cost < best) best = cost, radius = needed;
  }
  return radius;
}

/* Counts the ball's points from the reached ones: `by` 1 as held, -1 as no longer held. */
static void hold_reached(Search *search, SporeVec3 c, double radius, int by) {
  for (size_t m = 0; m < search->reached_count; m++) {
    size_t k = search->reached[m];
    if (square_distance(&search->prices.points, k, c) <= radius * radius)
      search->prices.held[k] = (uint16_t)(search->prices.held[k] + by);
  }
}

/* Puts ball i elsewhere. */
static void put(Search *search, size_t i, SporeVec3 c, double radius) {
  SporeBalls *balls = search->balls;
  find_reached(search, spore_balls_centre(balls, i), balls->r[i]);
  hold_reached(search, spore_balls_centre(balls, i), balls->r[i], -1);
  find_reached(search, c, radius);
  hold_reached(search, c, radius, 1);
  spore_balls_set(balls, i, c, radius);
}

/* Where ball i costs least of a few places nearby. Returns what that saves. */
typedef struct Place {
  SporeVec3 centre;
  double radius, saved;
} Place;

static Place look_around(Search *search, size_t i, double step, int tries, const SporeVec3 *needed) {
  SporeVec3 start = spore_balls_centre(search->balls, i);
  double radius = search->balls->r[i];
  Place best = {start, radius, 0};
  find_reached(search, start, radius + 2 * step);
  find_local(search, start, radius, true);
  if (needed) add_local(&search->local, *needed, -NEEDED * search->solid->volume);
  double before = local_cost(&search->local, start, radius);
  for (int t = 0; t < tries; t++) {
    double length = t ? step * spore_random_unit(&search->random) : 0;
    SporeVec3 c = spore_vec3_add_scaled(best.centre, length, spore_random_direction(&search->random));
    double away = spore_vec3_distance(c, start);
    if (away > step) continue;
    double r = best_radius(&search->local, c, fmax(best.radius - 2 * step, 0.1 * radius), radius + 2 * step - away);
    double saved = before - local_cost(&search->local, c, r);
    if (saved > best.saved) best = (Place){c, r, saved};
  }
  return best;
}

static void settle_ball(Search *search, size_t i, double step) {
  Place best = look_around(search, i, step, SETTLE_TRIES, NULL);
  if (best.saved > 0) put(search, i, best.centre, best.radius);
}

/* Covers p with the ball that can do so at least cost. */
static void cover_point(Search *search, SporeVec3 p) {
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
    Place place = look_around(search, i, 2 * gap, COVER_TRIES, &p);
    if (place.saved > best.saved) best = place, ball = i;
  }
  if (best.saved > 0) put(search, ball, best.centre, best.radius);
}

static bool open_search(Search *search) {
  size_t most = search->prices.points.block_count * SPORE_BLOCK + 1;
  double *memory = SPORE_NEW_ARRAY(double, 4 * most);
  search->reached = SPORE_NEW_ARRAY(uint32_t, most);
  search->local = (Local){0};
  if (memory) search->local = (Local){0, memory, memory + most, memory + 2 * most, memory + 3 * most};
  if (!memory || !search->reached) return false;
  for (size_t i = 0; i < search->balls->count; i++) {
    find_reached(search, spore_balls_centre(search->balls, i), search->balls->r[i]);
    hold_reached(search, spore_balls_centre(search->balls, i), search->balls->r[i], 1);
  }
  return true;
}

static void close_search(Search *search) {
  spore_free(search->reached);
  spore_free(search->local.x);
  search->reached = NULL;
  search->local = (Local){0};
}

/* What the search does one after the other. */
typedef struct Stage {
  double price;
  double margin, finest; /* of the diagonal: which points of the surface are added; finest 0: none */
  double step;           /* of a radius: of the first sweep; later ones step less */
  int sweeps;
} Stage;

/* Adds points where the balls hold the surface by less than the margin. Once leaving them costs more than any ball
 * could, they are covered one by one, by the ball that does it best: the first that looks around would take them. */
static bool add_points(Search *search, const Stage *stage) {
  double *points = NULL, length = stage->finest * search->solid->diagonal;
  size_t count = 0;
  bool done = spore_balls_gaps(search->solid, search->balls, stage->margin, stage->finest, &points, &count) &&
              spore_prices_add(&search->prices, points, count, GAP_VOLUME * length * length * length);
  close_search(search);
  done = done && open_search(search);
  for (size_t k = 0; done && stage->price >= HARD_PRICE && k < count; k++)
    cover_point(search, spore_vec3_load(points + 3 * k));
  spore_free(points);
  return done;
}

static bool go_through(Search *search, const SporeProgressPart *progress, SporeError *error) {
  static const Stage stages[] = {{2, 0, 0, 0.2, 12},
                                 {4, 0, 0, 0.2, 12},
                                 {8, 0, 0, 0.2, 12},
                                 {16, 4e-3, 5e-3, 0.2, 12},
                                 {32, 0, 0, 0.2, 12},
                                 {128, 0, 0, 0.2, 12},
                                 {2048, 0, 0, 0.2, 12},
                                 {HARD_PRICE, 1.5e-3, 1.5e-3, 0.06, 8},
                                 {HARD_PRICE, 3e-4, 7e-4, 0.06, 8},
                                 {HARD_PRICE, 1e-4, 5e-4, 0.06, 8},
                                 {HARD_PRICE, 1e-4, 4e-4, 0.06, 8},
                                 {HARD_PRICE, 1e-4, 4e-4, 0.06, 8}};
  const size_t count = sizeof stages / sizeof *stages;
  for (size_t s = 0; s < count; s++) {
    const Stage *stage = &stages[s];
    search->price = stage->price;
    if (stage->finest > 0 && !add_points(search, stage)) return spore_spheres_no_memory(error);
    int sweeps = stage->sweeps * (1 + (int)fmin(2, FEW / (double)search->balls->count));
    for (int sweep = 0; sweep < sweeps; sweep++) {
      double fraction = ((double)s + (double)sweep / sweeps) / (double)count;
      if (!spore_progress_part(progress, fraction, _("Bounding with spheres"), error)) return false;
      double step = stage->step / (1 + 0.3 * sweep * stage->sweeps / sweeps);
      for (size_t i = 0; i < search->balls->count; i++) settle_ball(search, i, step * search->balls->r[i]);
      spore_progress_show_balls(progress, search->balls);
    }
  }
  return true;
}

bool spore_spheres_bound(const SporeSolid *solid, SporeBalls *balls, uint64_t seed, const SporeProgressPart *progress,
                         SporeError *error) {
  Search search = {.solid = solid, .balls = balls, .random = {seed}};
  SporeProgressPart sampling = {progress->whole, progress->first, 0.1 * progress->share},
                    searching = {progress->whole, progress->first + 0.1 * progress->share, 0.9 * progress->share};
  if (!spore_prices_create(&search.prices, solid, balls->count, &search.random, &sampling, error)) return false;
  bool done = open_search(&search) || spore_spheres_no_memory(error);
  done = done && go_through(&search, &searching, error);
  close_search(&search);
  spore_prices_clear(&search.prices);
  return done && (spore_balls_grow_to_cover(solid, balls) || spore_spheres_no_memory(error));
}
