/* Balls around a solid: a search that moves one ball at a time to the place of least cost, the other balls unchanged.
 * Covered volume outside costs its volume. Uncovered volume costs its volume times a factor. The factor rises from
 * stage to stage, so that at first balls can pass volume to their neighbours. Once little is uncovered, balls of little
 * worth are moved to balls that contain much volume outside, where that lowers the cost after the balls around have
 * settled. In the last stages all must be covered, and a ball costs the volume that it adds to the union of the others.
 */
#include "core/generate/spheres/bounding.h"

#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres/bounding_search.h"

#define FEW 60                /* balls: up to this many, twice the sweeps; up to half as many, three times the sweeps */
#define MANY 250              /* balls with images: from this many on, less of all that makes few balls better */
#define MANY_FEWER 4          /* work of relocations, which gain nothing with many balls */
#define MANY_SAMPLED 60       /* %: points per ball */
#define WORK_PER_BALL 6000000 /* work of relocations per ball */
#define WORK_MOST 180000000   /* of all balls together: most solids take less than five seconds */
#define GAPS_MOST 100000      /* points that a stage adds */
#define MANY_GAPS_MOST 30000
#define GAP_VOLUME 0.3 /* of a cube of edge `finest`: volume of an added point */

/* One of the successive stages of the search. */
typedef struct Stage {
  double cost;
  double margin, finest; /* of the diagonal: see spore_balls_gaps, for points that are added; finest 0: none */
  double step;           /* of a radius: initial search distance */
  int sweeps;
  bool relocate; /* after the sweeps, and then sweep again */
} Stage;

/* The balls and their images in the planes to which they are not bound; the images of a ball are consecutive. */
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

/* Adds points where the balls cover the surface by less than the margin. In the stages where all must be covered, the
 * points are then covered one by one, each by the ball of least cost. Otherwise the first ball that searches would take
 * them all. */
static bool add_points(SporeBoundingSearch *search, const Stage *stage) {
  double *points = NULL, length = stage->finest * search->solid->diagonal;
  size_t count = 0;
  SporeBalls all = {0};
  bool done = make_images(search->solid, search->balls, search->bound, &all) &&
              spore_balls_gaps(search->solid, &all, stage->margin, stage->finest,
                               search->many ? MANY_GAPS_MOST : GAPS_MOST, &points, &count);
  for (size_t k = 0; done && k < count; k++)
    spore_vec3_store(points + 3 * k, spore_symmetry_fold(&search->solid->symmetry, spore_vec3_load(points + 3 * k)));
  done = done && spore_costs_add(&search->costs, points, count, GAP_VOLUME * length * length * length);
  spore_balls_clear(&all);
  spore_bounding_close(search);
  done = done && spore_bounding_open(search);
  for (size_t k = 0; done && stage->cost >= SPORE_BOUNDING_HARD && k < count; k++)
    spore_bounding_cover(search, spore_vec3_load(points + 3 * k));
  spore_free(points);
  return done;
}

static bool sweep(SporeBoundingSearch *search, const Stage *stage, const SporeProgressPart *progress,
                  SporeError *error) {
  size_t balls = search->balls->count;
  int sweeps = stage->sweeps * (1 + (int)fmin(2, FEW / (double)balls));
  if (search->many) sweeps = (sweeps + 1) / 2;
  spore_bounding_set_steps(search, stage->step);
  for (int done = 0; done < sweeps; done++) {
    if (!spore_progress_part(progress, (double)done / sweeps, _("Bounding with spheres"), error)) return false;
    spore_bounding_shell_turn(&search->shell, &search->random);
    for (size_t i = 0; i < search->balls->count; i++) spore_bounding_settle(search, i);
    spore_progress_show_images(progress, &search->solid->symmetry, search->balls, search->bound);
  }
  return true;
}

static bool run_stage(SporeBoundingSearch *search, const Stage *stage, const SporeProgressPart *progress,
                      SporeError *error) {
  SporeProgressPart first = {progress->whole, progress->first, 0.05 * progress->share},
                    relocating = {progress->whole, progress->first + first.share, 0.9 * progress->share},
                    last = {progress->whole, relocating.first + relocating.share, 0.05 * progress->share};
  search->cost = stage->cost;
  if (stage->finest > 0 && !add_points(search, stage)) return spore_generate_no_memory(error);
  if (!stage->relocate) return sweep(search, stage, progress, error);
  uint64_t work = WORK_PER_BALL * search->balls->count;
  if (work > WORK_MOST) work = WORK_MOST;
  if (search->many) work /= MANY_FEWER;
  return sweep(search, stage, &first, error) && spore_bounding_relocate(search, work, &relocating, error) &&
         sweep(search, stage, &last, error);
}

static bool run_stages(SporeBoundingSearch *search, const SporeProgressPart *progress, SporeError *error) {
  static const Stage stages[] = {{2, 0, 0, 0.2, 12, false},
                                 {4, 0, 0, 0.2, 12, false},
                                 {8, 0, 0, 0.2, 12, false},
                                 {16, 4e-3, 6e-3, 0.2, 12, true},
                                 {32, 0, 0, 0.2, 12, false},
                                 {128, 0, 0, 0.2, 12, false},
                                 {2048, 0, 0, 0.2, 12, false},
                                 {SPORE_BOUNDING_HARD, 1.5e-3, 1.5e-3, 0.06, 8, false},
                                 {SPORE_BOUNDING_HARD, 3e-4, 7e-4, 0.06, 8, false},
                                 {SPORE_BOUNDING_HARD, 1e-4, 5e-4, 0.06, 5, false},
                                 {SPORE_BOUNDING_HARD, 1e-4, 4e-4, 0.06, 4, false}};
  const size_t count = sizeof stages / sizeof *stages;
  double share[sizeof stages / sizeof *stages], sum = 0; /* about the share of the time */
  for (size_t s = 0; s < count; s++) sum += share[s] = stages[s].relocate ? 1.5 * (double)count : 1;
  double first = progress->first;
  for (size_t s = 0; s < count; s++) {
    SporeProgressPart part = {progress->whole, first, progress->share * share[s] / sum};
    if (!run_stage(search, &stages[s], &part, error)) return false;
    first += part.share;
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
  search.many = spore_balls_images(&solid->symmetry, balls, bound, NULL) >= MANY;
  size_t sampled = search.many ? balls->count * MANY_SAMPLED / 100 : balls->count;
  if (!spore_costs_create(&search.costs, solid, sampled, &search.random, &sampling, error)) return false;
  bool done = spore_bounding_open(&search) || spore_generate_no_memory(error);
  done = done && run_stages(&search, &searching, error);
  spore_bounding_close(&search);
  spore_costs_clear(&search.costs);
  return done && (grow(solid, balls, bound) || spore_generate_no_memory(error));
}
