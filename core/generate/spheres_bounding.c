/* Balls around a solid: a search that moves one ball at a time to where it, the others as they are, costs least. What
 * is outside costs its volume; what is left uncovered costs its volume times a price that rises, so that at first balls
 * can hand over what they hold to their neighbours. Once little is left uncovered, balls that do little are put where
 * others hold much outside, wherever that turns out to pay after their neighbours have settled. */
#include "core/generate/spheres_bounding.h"

#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres_bounding_search.h"

#define FEW 60            /* balls: so many sweep twice, half as many or fewer three times */
#define TRIALS_PER_BALL 5 /* most relocations that are tried */
#define GAP_VOLUME 0.3    /* of a cube: volume that an added point stands for */

/* What the search does one after the other. */
typedef struct Stage {
  double price;
  double margin, finest; /* of the diagonal: which points of the surface are added; finest 0: none */
  double step;           /* of a radius: how far balls look around at first */
  int sweeps;
  size_t relocations; /* before the sweeps */
} Stage;

/* The balls and their images in the planes that they are not bound to, those of a ball one after the other. */
static bool make_images(const SporeSolid *solid, const SporeBalls *balls, const uint8_t *bound, SporeBalls *all) {
  size_t count = spore_balls_images(&solid->symmetry, balls, bound, NULL);
  double *spheres = SPORE_NEW_ARRAY(double, 4 * count);
  bool done = spheres && spore_balls_create(all, count);
  if (done) spore_balls_images(&solid->symmetry, balls, bound, spheres);
  for (size_t i = 0; done && i < count; i++)
    spore_balls_set(all, i, spore_vec3_load(spheres + 4 * i), spheres[4 * i + 3]);
  spore_free(spheres);
  return done;
}

/* Adds points where the balls hold the surface by less than the margin. Once leaving them costs more than any ball
 * could, they are covered one by one, by the ball that does it best: the first that looks around would take them. */
static bool add_points(SporeBoundingSearch *search, const Stage *stage) {
  double *points = NULL, length = stage->finest * search->solid->diagonal;
  size_t count = 0;
  SporeBalls all = {0};
  bool done = make_images(search->solid, search->balls, search->bound, &all) &&
              spore_balls_gaps(search->solid, &all, stage->margin, stage->finest, &points, &count);
  for (size_t k = 0; done && k < count; k++)
    spore_vec3_store(points + 3 * k, spore_symmetry_fold(&search->solid->symmetry, spore_vec3_load(points + 3 * k)));
  done = done && spore_prices_add(&search->prices, points, count, GAP_VOLUME * length * length * length);
  spore_balls_clear(&all);
  spore_bounding_close(search);
  done = done && spore_bounding_open(search);
  for (size_t k = 0; done && stage->price >= SPORE_BOUNDING_HARD && k < count; k++)
    spore_bounding_cover(search, spore_vec3_load(points + 3 * k));
  spore_free(points);
  return done;
}

static bool run_stage(SporeBoundingSearch *search, const Stage *stage, const SporeProgressPart *progress,
                      SporeError *error) {
  SporeProgressPart relocating = {progress->whole, progress->first, 0.7 * progress->share};
  double first = stage->relocations ? 0.7 : 0;
  search->price = stage->price;
  if (stage->finest > 0 && !add_points(search, stage)) return spore_spheres_no_memory(error);
  size_t trials = stage->relocations, most = TRIALS_PER_BALL * search->balls->count;
  if (!spore_bounding_relocate(search, trials < most ? trials : most, &relocating, error)) return false;
  spore_bounding_set_steps(search, stage->step);
  int sweeps = stage->sweeps * (1 + (int)fmin(2, FEW / (double)search->balls->count));
  for (int sweep = 0; sweep < sweeps; sweep++) {
    if (!spore_progress_part(progress, first + (1 - first) * sweep / sweeps, _("Bounding with spheres"), error))
      return false;
    for (size_t i = 0; i < search->balls->count; i++) spore_bounding_settle(search, i);
    spore_progress_show_images(progress, &search->solid->symmetry, search->balls, search->bound);
  }
  return true;
}

static bool run_stages(SporeBoundingSearch *search, const SporeProgressPart *progress, SporeError *error) {
  static const Stage stages[] = {{2, 0, 0, 0.2, 12, 0},
                                 {4, 0, 0, 0.2, 12, 0},
                                 {8, 0, 0, 0.2, 12, 0},
                                 {16, 4e-3, 6e-3, 0.2, 12, 250},
                                 {32, 0, 0, 0.2, 12, 0},
                                 {128, 0, 0, 0.2, 12, 0},
                                 {2048, 0, 0, 0.2, 12, 0},
                                 {SPORE_BOUNDING_HARD, 1.5e-3, 1.5e-3, 0.06, 8, 0},
                                 {SPORE_BOUNDING_HARD, 3e-4, 7e-4, 0.06, 8, 0},
                                 {SPORE_BOUNDING_HARD, 1e-4, 5e-4, 0.06, 5, 0},
                                 {SPORE_BOUNDING_HARD, 1e-4, 4e-4, 0.06, 4, 0},
                                 {SPORE_BOUNDING_HARD, 1e-4, 4e-4, 0.06, 4, 0}};
  const size_t count = sizeof stages / sizeof *stages;
  for (size_t s = 0; s < count; s++) {
    SporeProgressPart part = {progress->whole, progress->first + progress->share * (double)s / (double)count,
                              progress->share / (double)count};
    if (!run_stage(search, &stages[s], &part, error)) return false;
  }
  return true;
}

/* Grows balls until they and their images cover the solid. */
static bool grow(const SporeSolid *solid, SporeBalls *balls, const uint8_t *bound) {
  SporeBalls all = {0};
  bool done = make_images(solid, balls, bound, &all) && spore_balls_grow_to_cover(solid, &all);
  for (size_t i = 0, image = 0; done && i < balls->count; i++) {
    SporeBalls one = {1, balls->x + i, balls->y + i, balls->z + i, balls->r + i};
    size_t end = image + spore_balls_images(&solid->symmetry, &one, bound + i, NULL);
    for (; image < end; image++) balls->r[i] = fmax(balls->r[i], all.r[image]);
  }
  spore_balls_clear(&all);
  return done;
}

bool spore_spheres_bound(const SporeSolid *solid, SporeBalls *balls, const uint8_t *bound, uint64_t seed,
                         const SporeProgressPart *progress, SporeError *error) {
  SporeBoundingSearch search = {.solid = solid, .bound = bound, .balls = balls, .random = {seed}};
  SporeProgressPart sampling = {progress->whole, progress->first, 0.1 * progress->share},
                    searching = {progress->whole, progress->first + 0.1 * progress->share, 0.9 * progress->share};
  if (!spore_prices_create(&search.prices, solid, balls->count, &search.random, &sampling, error)) return false;
  bool done = spore_bounding_open(&search) || spore_spheres_no_memory(error);
  done = done && run_stages(&search, &searching, error);
  spore_bounding_close(&search);
  spore_prices_clear(&search.prices);
  return done && (grow(solid, balls, bound) || spore_spheres_no_memory(error));
}
