/* Sphere sets from solids, tetrahedra, curves and sheets: with a given count, by targets, and in series. */
#include "core/generate/spheres/spheres.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/profile.h"
#include "core/base/text.h"
#include "core/generate/spheres/bounding.h"
#include "core/generate/spheres/weighted.h"

#define CANDIDATES_LEAST 1500
#define CANDIDATES_PER_SPHERE 12
#define ENOUGH_ROOM 0.9 /* of the radius: least depth at the new centre of a ball that is moved onto a plane */
#define RANKED_LEAST 64 /* balls from which those that add up to the count are chosen */
#define NEAR_PLANE 0.4  /* of the radius: a ball whose centre is nearer to a mirror plane starts on the plane */

const char *const spore_spheres_mode_names[SPORE_SPHERES_MODE_COUNT + 1] = {[SPORE_SPHERES_BALANCED] = "balanced",
                                                                            [SPORE_SPHERES_BOUNDING] = "bounding",
                                                                            [SPORE_SPHERES_WEIGHTED] = "weighted"};

/* Input of a Maker. */
typedef struct Work {
  const SporeSpheresSource *source;
  const SporeSpheresOptions *options;
  SporeSolid *solid; /* NULL: the source is a curve or a sheet */
} Work;
typedef bool Maker(const Work *work, size_t count, SporeSphereSet *set, SporeSpheresReport *report,
                   const SporeProgressPart *progress, SporeError *error);

static bool check_regions(const SporeSpheresOptions *options, SporeError *error) {
  for (size_t i = 0; i < options->region_count; i++) {
    const SporeGenerateRegion *region = &options->regions[i];
    bool placed = isfinite(region->centre[0]) && isfinite(region->centre[1]) && isfinite(region->centre[2]);
    if (!placed || !(region->radius > 0 && isfinite(region->radius)))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("region %zu has no place or the radius %g; finite numbers and a radius above 0 m were "
                               "expected; correct it"),
                             i + 1, region->radius);
    if (!(region->value >= SPORE_SPHERES_FACTOR_LEAST && region->value <= SPORE_SPHERES_FACTOR_MOST))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("region %zu has the factor %g; a number from %g to %g was expected; give one of those"),
                             i + 1, region->value, SPORE_SPHERES_FACTOR_LEAST, SPORE_SPHERES_FACTOR_MOST);
  }
  return true;
}

static bool check_options(const SporeSpheresOptions *options, SporeError *error) {
  if (options->count > SPORE_SPHERES_MAXIMUM)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("%zu spheres are too many; 1 to %u were expected; ask for fewer"), options->count,
                           SPORE_SPHERES_MAXIMUM);
  if (!options->count && !spore_targets_check(&options->targets, error)) return false;
  if (!(options->thickness >= 0 && options->thickness <= 1e9))
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the thickness is %g; a length of 0 m or more was expected; correct it"),
                           options->thickness);
  return check_regions(options, error);
}

/* Only a source with an inside has a volume to cover, an outside and a depth. */
static bool check_mode(const SporeSpheresSource *source, const SporeSpheresOptions *options, SporeError *error) {
  const SporeSpheresTargets *targets = &options->targets;
  if (source->solid || source->tetrahedra) return true;
  if (!source->curve && !options->count && (targets->outside > 0 || targets->depth_error > 0))
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("a sheet has neither a volume nor a depth, of which at most %g and %g are asked for; a "
                             "coverage or a tolerance was expected; ask for those alone"),
                           targets->outside, targets->depth_error);
  if (options->mode == SPORE_SPHERES_BALANCED) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the mode \"%s\" needs an inside, and a curve or a sheet has none; a closed mesh was "
                           "expected; use the mode \"%s\""),
                         spore_spheres_mode_names[options->mode], spore_spheres_mode_names[SPORE_SPHERES_BALANCED]);
}

static SporeProgressPart part_of(const SporeProgressPart *whole, double first, double share) {
  return (SporeProgressPart){whole->whole, whole->first + whole->share * first, whole->share * share};
}

static unsigned count_bits(unsigned mask) { return (unsigned)__builtin_popcount(mask); }

/* Number of images of a ball, itself included: planes to which the ball is bound give none. */
static size_t images_of(const SporeSymmetry *symmetry, unsigned bound) {
  return (size_t)1 << (symmetry->count - count_bits(bound));
}

/* weights: of the balls, or NULL. */
static bool store_balls(const SporeSymmetry *symmetry, const SporeBalls *balls, const uint8_t *bound,
                        const double *weights, double level, SporeSphereSet *set, SporeError *error) {
  if (!spore_sphere_set_allocate(set, spore_balls_images(symmetry, balls, bound, NULL), error)) return false;
  spore_balls_images(symmetry, balls, bound, set->spheres);
  if (!weights) return true;
  if (!spore_sphere_set_add_weights(set, error)) return false;
  set->level = level;
  for (size_t i = 0, image = 0; i < balls->count; i++)
    for (size_t k = images_of(symmetry, bound[i]); k > 0; k--) set->weights[image++] = weights[i];
  return true;
}

/* Planes so near to the ball that the ball is better placed on them than mirrored. */
static unsigned near_planes(const SporeSymmetry *symmetry, SporeVec3 centre, double radius) {
  unsigned planes = 0;
  for (unsigned k = 0; k < symmetry->count; k++) {
    double height = spore_vec3_dot(spore_vec3_sub(centre, symmetry->point), symmetry->normal[k]);
    if (height < NEAR_PLANE * radius) planes |= 1u << k;
  }
  return planes;
}

/* Binds a ball with more than `count` images to more planes: planes on which the solid is deep enough for the ball.
 * `forced`: any planes. */
static unsigned bind_more(const SporeSolid *solid, size_t count, SporeVec3 centre, double radius, unsigned planes,
                          bool forced) {
  for (unsigned k = 0; k < solid->symmetry.count && images_of(&solid->symmetry, planes) > count; k++) {
    SporeVec3 moved = spore_symmetry_bind(&solid->symmetry, planes | 1u << k, centre);
    if (forced || spore_bvh_depth(solid->bvh, moved) >= ENOUGH_ROOM * radius) planes |= 1u << k;
  }
  return planes;
}

/* Chooses balls of `ranked`, the best first, that with their images add up to `count`. Each is bound to the planes near
 * it; *chosen: their number. `forced`: see bind_more. False: the balls do not add up to `count`. */
static bool choose_bound(const SporeSolid *solid, size_t count, const SporeBalls *ranked, bool forced, uint32_t *which,
                         uint8_t *bound, size_t *chosen) {
  *chosen = 0;
  for (size_t i = 0; i < ranked->count && count; i++) {
    SporeVec3 centre = spore_balls_centre(ranked, i);
    unsigned planes = near_planes(&solid->symmetry, centre, ranked->r[i]);
    planes = bind_more(solid, count, centre, ranked->r[i], planes, forced);
    if (images_of(&solid->symmetry, planes) > count) continue;
    count -= images_of(&solid->symmetry, planes);
    which[*chosen] = (uint32_t)i, bound[(*chosen)++] = (uint8_t)planes;
  }
  return count == 0;
}

/* What a fit starts from. */
typedef struct Start {
  SporeSamples samples;
  SporeBalls candidates, ranked;
} Start;

static void clear_start(Start *start) {
  spore_balls_clear(&start->ranked);
  spore_balls_clear(&start->candidates);
  spore_samples_clear(&start->samples);
}

static bool make_start(Start *start, const SporeSolid *solid, size_t count, uint64_t seed,
                       const SporeProgressPart *progress, SporeError *error) {
  SporeRandom random = {seed ^ UINT64_C(0x9e3779b97f4a7c15)};
  SporeProgressPart sampling = part_of(progress, 0, 0.3), finding = part_of(progress, 0.3, 0.4),
                    choosing = part_of(progress, 0.7, 0.3);
  size_t candidates = CANDIDATES_PER_SPHERE * count, ranked = count < RANKED_LEAST ? RANKED_LEAST : count;
  *start = (Start){0};
  return spore_samples_create(&start->samples, solid, count, &random, &sampling, error) &&
         spore_candidates_create(&start->candidates, solid,
                                 candidates < CANDIDATES_LEAST ? CANDIDATES_LEAST : candidates, &random, &finding,
                                 error) &&
         (spore_balls_create(&start->ranked, ranked) || spore_generate_no_memory(error)) &&
         spore_candidates_cover(&start->candidates, &start->samples, &start->ranked, &choosing, error);
}

/* The planes of `all` whose bits are set. */
static SporeSymmetry some_planes(const SporeSymmetry *all, unsigned planes) {
  SporeSymmetry some = {.point = all->point};
  for (unsigned k = 0; k < all->count; k++)
    if (planes >> k & 1) some.normal[some.count++] = all->normal[k];
  return some;
}

/* A start with as many of the solid's mirror planes as the count allows. An odd count, for instance, needs a ball that
 * lies on all planes. */
static bool start_in_planes(Start *start, SporeSolid *solid, size_t count, uint64_t seed, uint32_t *which,
                            uint8_t *bound, size_t *chosen, const SporeProgressPart *progress, SporeError *error) {
  static const unsigned char ways[] = {7, 3, 5, 6, 1, 2, 4, 1}; /* the most planes first; the last way is forced */
  const SporeSymmetry all = solid->symmetry;
  for (size_t i = 0; i < sizeof ways; i++) {
    SporeProgressPart part = part_of(progress, (double)i / sizeof ways, 1. / sizeof ways);
    if (all.count && ways[i] >> all.count) continue;
    solid->symmetry = some_planes(&all, ways[i]);
    if (!make_start(start, solid, count, seed, &part, error)) return false;
    if (choose_bound(solid, count, &start->ranked, i + 1 == sizeof ways, which, bound, chosen)) return true;
    clear_start(start);
  }
  return false;
}

/* Balls in the solid that with their images add up to `count`. Reduces the solid's planes to those used. Creates
 * *balls; bound has room for `count`. */
static bool place_balls(SporeSolid *solid, size_t count, const SporeSpheresOptions *options, SporeBalls *balls,
                        uint8_t *bound, const SporeProgressPart *progress, SporeError *error) {
  SporeProgressPart starting = part_of(progress, 0, 0.3), fitting = part_of(progress, 0.3, 0.7);
  Start start = {0};
  size_t chosen = 0;
  uint32_t *which = SPORE_NEW_ARRAY(uint32_t, count);
  bool done = which || spore_generate_no_memory(error);
  done = done && start_in_planes(&start, solid, count, options->seed, which, bound, &chosen, &starting, error) &&
         (spore_balls_create(balls, chosen) || spore_generate_no_memory(error));
  for (size_t i = 0; done && i < chosen; i++) {
    SporeVec3 centre = spore_balls_centre(&start.ranked, which[i]);
    spore_balls_set(balls, i, spore_symmetry_bind(&solid->symmetry, bound[i], centre), start.ranked.r[which[i]]);
  }
  done = done && spore_spheres_fit(solid, &start.samples, &start.candidates, balls, bound,
                                   options->mode != SPORE_SPHERES_BALANCED, options->seed, &fitting, error);
  spore_free(which);
  clear_start(&start);
  return done;
}

/* Fits the balls of a balanced start in the bounding and the weighted mode. The caller frees *weights. */
static bool refine(const Work *work, const SporeSolid *solid, SporeBalls *balls, const uint8_t *bound, double **weights,
                   double *level, const SporeProgressPart *progress, SporeError *error) {
  uint64_t seed = work->options->seed;
  if (work->options->mode == SPORE_SPHERES_BOUNDING)
    return spore_spheres_bound(solid, balls, bound, seed, progress, error);
  if (work->options->mode == SPORE_SPHERES_BALANCED) return true;
  *weights = SPORE_NEW_ARRAY(double, balls->count);
  return *weights ? spore_spheres_weigh(solid, balls, bound, *weights, level, seed, progress, error)
                  : spore_generate_no_memory(error);
}

/* Exactly `count` spheres in the solid, measured. */
static bool fill_solid(const Work *work, size_t count, SporeSphereSet *set, SporeSpheresReport *report,
                       const SporeProgressPart *progress, SporeError *error) {
  SporeSolid part = *work->solid, *solid = &part; /* a copy, whose planes may be reduced */
  bool balanced = work->options->mode == SPORE_SPHERES_BALANCED;
  SporeProgressPart placing = part_of(progress, 0, balanced ? 0.9 : 0.4), refining = part_of(progress, 0.4, 0.5),
                    measuring = part_of(progress, 0.9, 0.1);
  SporeBalls balls = {0};
  double *weights = NULL, level = 0;
  uint8_t *bound = SPORE_NEW_ARRAY(uint8_t, count);
  *set = (SporeSphereSet){0};
  bool done = bound || spore_generate_no_memory(error);
  done = done && place_balls(solid, count, work->options, &balls, bound, &placing, error) &&
         refine(work, solid, &balls, bound, &weights, &level, &refining, error) &&
         store_balls(&solid->symmetry, &balls, bound, weights, level, set, error) &&
         spore_solid_measure(solid, set, report, &measuring, error);
  report->mirrors = solid->symmetry.count;
  spore_balls_clear(&balls);
  spore_free(weights);
  spore_free(bound);
  if (!done) spore_sphere_set_clear(set);
  return done;
}

static bool string_curve(const Work *work, size_t count, SporeSphereSet *set, SporeSpheresReport *report,
                         const SporeProgressPart *progress, SporeError *error) {
  return spore_spheres_along(work->source->curve, count, set, report, progress, error);
}

static bool cover_sheet(const Work *work, size_t count, SporeSphereSet *set, SporeSpheresReport *report,
                        const SporeProgressPart *progress, SporeError *error) {
  return spore_spheres_over(work->source->sheet, count, work->options, set, report, progress, error);
}

/* The smallest set found that reaches the targets. */
static bool search(Maker *make, const Work *work, SporeSphereSet *set, SporeSpheresReport *report,
                   const SporeProgress *progress, SporeError *error) {
  SporeTargetSearch found = {0};
  for (int trial = 0;; trial++) {
    SporeProgressPart part = {progress, 1 - pow(0.8, trial), 0.2 * pow(0.8, trial)};
    SporeSphereSet tried;
    SporeSpheresReport measured;
    if (!make(work, spore_target_search_next(&found), &tried, &measured, &part, error)) return false;
    if (spore_target_search_add(&found, tried.count, &work->options->targets, &measured)) {
      spore_sphere_set_clear(set);
      *set = tried, *report = measured;
    } else spore_sphere_set_clear(&tried);
    if (spore_target_search_done(&found)) return true;
    if (spore_target_search_failed(&found))
      return spore_targets_out_of_reach(&work->options->targets, &measured, error);
  }
}

static bool make_set(Maker *make, const Work *work, SporeSphereSet *set, SporeSpheresReport *report,
                     const SporeProgress *progress, SporeError *error) {
  SporeProgressPart whole = {progress, 0, 1};
  return work->options->count ? make(work, work->options->count, set, report, &whole, error)
                              : search(make, work, set, report, progress, error);
}

static bool from_solid(Work *work, const SporeTriangleMesh *mesh, SporeSphereSet *set, SporeSpheresReport *report,
                       const SporeProgress *progress, SporeError *error) {
  SporeSolid solid;
  const SporeSpheresOptions *options = work->options;
  if (!spore_solid_create(&solid, mesh, error)) return false;
  solid.regions = options->regions, solid.region_count = options->region_count;
  if (!options->asymmetric && !options->region_count)
    spore_symmetry_find(&solid.symmetry, &solid.mesh, solid.bvh, solid.diagonal);
  work->solid = &solid;
  bool done = make_set(fill_solid, work, set, report, progress, error);
  spore_solid_clear(&solid);
  if (done && !(report->coverage > 0))
    done = spore_error_set(
        error, SPORE_ERROR_INPUT, NULL,
        _("the spheres hold nothing of what the surface encloses; expected a closed one whose walls are not "
          "too thin for so few; mend it (spore import --fill-holes), ask for more, or take it for a sheet "
          "(spore spheres --thickness)"));
  return done;
}

static bool from_cells(Work *work, SporeSphereSet *set, SporeSpheresReport *report, const SporeProgress *progress,
                       SporeError *error) {
  const SporeTetrahedralMesh *mesh = work->source->tetrahedra;
  if (!spore_tetrahedral_mesh_validate(mesh, error)) return false;
  SporeTriangleMesh boundary = {.vertex_count = mesh->vertex_count, .vertices = mesh->vertices};
  if (!spore_tetrahedral_mesh_boundary(mesh, &boundary.triangles, &boundary.triangle_count))
    return spore_generate_no_memory(error);
  bool done = from_solid(work, &boundary, set, report, progress, error);
  spore_free(boundary.triangles);
  return done;
}

bool spore_spheres_from_source(const SporeSpheresSource *source, const SporeSpheresOptions *options,
                               SporeSphereSet *set, SporeSpheresReport *report, const SporeProgress *progress,
                               SporeError *error) {
  uint64_t start = spore_clock_ns();
  Work work = {source, options, NULL};
  bool done = false;
  *set = (SporeSphereSet){0};
  *report = (SporeSpheresReport){0};
  if (options->each_cell && source->tetrahedra)
    return spore_spheres_of_cells(source->tetrahedra, NULL, set, report, error);
  if (options->each_cell)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("there are no tetrahedra to put a sphere round each; expected a soft organ of "
                             "tetrahedra, or a .mesh file; choose another method, or make them first"));
  if (!check_options(options, error) || !check_mode(source, options, error)) return false;
  if (source->solid) done = from_solid(&work, source->solid, set, report, progress, error);
  else if (source->tetrahedra) done = from_cells(&work, set, report, progress, error);
  else if (source->curve)
    done = spore_curve_validate(source->curve, error) && make_set(string_curve, &work, set, report, progress, error);
  else
    done = spore_triangle_mesh_validate(source->sheet, error) &&
           make_set(cover_sheet, &work, set, report, progress, error);
  if (!done) spore_sphere_set_clear(set);
  report->seconds = (double)(spore_clock_ns() - start) * 1e-9;
  return done;
}

bool spore_spheres_from_mesh(const SporeTriangleMesh *mesh, const SporeSpheresOptions *options, SporeSphereSet *set,
                             SporeSpheresReport *report, const SporeProgress *progress, SporeError *error) {
  return spore_spheres_from_source(&(SporeSpheresSource){.solid = mesh}, options, set, report, progress, error);
}

bool spore_spheres_from_tetrahedra(const SporeTetrahedralMesh *mesh, const SporeSpheresOptions *options,
                                   SporeSphereSet *set, SporeSpheresReport *report, const SporeProgress *progress,
                                   SporeError *error) {
  return spore_spheres_from_source(&(SporeSpheresSource){.tetrahedra = mesh}, options, set, report, progress, error);
}

static bool check_counts(const size_t *counts, size_t count, SporeError *error) {
  if (!count)
    return spore_error_set(
        error, SPORE_ERROR_INPUT, NULL,
        _("no number of spheres is given; at least one was expected; give some, such as 16, 32, 64"));
  for (size_t i = 0; i < count; i++)
    if (counts[i] < 1 || counts[i] > SPORE_SPHERES_MAXIMUM || (i > 0 && counts[i] <= counts[i - 1]))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("%zu as number of spheres is out of range or not larger than the one before; ascending "
                               "numbers from 1 to %u were expected; sort them"),
                             counts[i], SPORE_SPHERES_MAXIMUM);
  return true;
}

bool spore_spheres_series(const SporeSpheresSource *source, const SporeSpheresOptions *options, const size_t *counts,
                          size_t count, SporeSpheresReport *reports, SporeSpheresMeasured *measured, void *data,
                          const SporeProgress *progress, SporeError *error) {
  double sum = 0, done = 0;
  if (!check_counts(counts, count, error)) return false;
  for (size_t i = 0; i < count; i++) sum += 40 + (double)counts[i]; /* about the time of each */
  for (size_t i = 0; i < count; i++) {
    SporeProgressShare part = {progress, done / sum, (40 + (double)counts[i]) / sum};
    SporeProgress inner = spore_progress_of_share(&part);
    SporeSpheresOptions one = *options;
    SporeSphereSet set;
    one.count = counts[i];
    if (!spore_spheres_from_source(source, &one, &set, &reports[i], &inner, error)) return false;
    spore_sphere_set_clear(&set);
    if (measured) measured(data, i, &reports[i]);
    done += 40 + (double)counts[i];
  }
  return true;
}

/* How much a doubling lowers the error, between the points i - 1 and i. */
static double gain(const size_t *counts, const double *errors, size_t i) {
  return (errors[i - 1] - errors[i]) / log2((double)counts[i] / (double)counts[i - 1]);
}

size_t spore_enough(const size_t *counts, const double *errors, size_t count, double worth) {
  size_t enough = count;
  for (size_t i = count; i-- > 1 && gain(counts, errors, i) < worth;) enough = i - 1;
  return enough;
}
