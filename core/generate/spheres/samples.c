/* Samples of the signed depth of a solid: inside, on the surface and in a band outside. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres/private.h"

/* Total weight of each kind of samples. */
#define WEIGHT_INTERIOR 1.0
#define WEIGHT_SURFACE 0.6
#define WEIGHT_OUTSIDE 0.5

#define BAND 0.5     /* of the typical radius */
#define FARTHEST 1.5 /* of the band */
#define REPORT_EVERY 1024

typedef struct Kinds {
  size_t interior, surface, outside;
} Kinds;

static Kinds wanted_samples(size_t count) {
  size_t interior = 60 * count;
  if (interior < 16000) interior = 16000;
  if (interior > 200000) interior = 200000;
  return (Kinds){interior, interior * 5 / 8, interior / 2};
}

/* The largest factor anywhere. */
static double most_factor(const SporeSolid *solid) {
  double most = 1;
  for (size_t i = 0; i < solid->region_count; i++) most = fmax(most, solid->regions[i].value);
  return most;
}

/* Keeps each of the first `count` points with the probability factor / most; returns how many are kept. */
static size_t thin_out(const SporeSolid *solid, double most, double *points, size_t count, SporeRandom *random) {
  size_t kept = 0;
  for (size_t i = 0; i < count; i++) {
    double chance = spore_solid_factor(solid, spore_vec3_load(points + 3 * i)) / most;
    if (spore_random_unit(random) < chance) memmove(points + 3 * kept++, points + 3 * i, 3 * sizeof *points);
  }
  return kept;
}

/* Draws `count` points of the inside or of the surface, with a density proportional to the factor, folded by the
 * symmetry. False: cancelled. */
static bool draw_points(const SporeSolid *solid, bool surface, size_t count, SporeRandom *random, double *points,
                        const SporeProgressPart *progress, SporeError *error) {
  double most = most_factor(solid);
  for (size_t have = 0; have < count;) {
    if (surface) spore_solid_surface(solid, count - have, random, points + 3 * have, NULL);
    else if (!spore_solid_interior(solid, count - have, random, points + 3 * have, progress, error)) return false;
    have += solid->region_count ? thin_out(solid, most, points + 3 * have, count - have, random) : count - have;
  }
  for (size_t i = 0; i < count; i++)
    spore_vec3_store(points + 3 * i, spore_symmetry_fold(&solid->symmetry, spore_vec3_load(points + 3 * i)));
  return true;
}

/* Points at random distances of the order of the band from the surface; keeps points that are outside and not too far.
 * Sets kinds->outside to their number. False: cancelled. */
static bool outside_points(const SporeSolid *solid, const double *surface, Kinds *kinds, double band,
                           SporeRandom *random, double *points, double *depth, const SporeProgressPart *progress,
                           SporeError *error) {
  size_t found = 0, wanted = kinds->outside;
  for (size_t i = 0; found < wanted && i < 3 * wanted; i++) {
    if (i % REPORT_EVERY == 0 && !spore_progress_part(progress, 0, _("Sampling the solid"), error)) return false;
    double u = 1 - spore_random_unit(random), distance = band * sqrt(-2 * log(u));
    SporeVec3 p = spore_vec3_add_scaled(spore_vec3_load(surface + 3 * (i % kinds->surface)),
                                        distance * (1 - 2 * spore_random_unit(random)), spore_random_direction(random));
    p = spore_symmetry_fold(&solid->symmetry, p);
    double d = spore_bvh_depth(solid->bvh, p);
    if (d >= 0 || d < -FARTHEST * band) continue;
    spore_vec3_store(points + 3 * found, p);
    depth[found++] = d;
  }
  kinds->outside = found;
  return true;
}

/* The depths of the points inside, which are the first `count`, one after another as they are sorted: what is nearest
 * to one is near the next. False: cancelled. */
static bool measure_depths(const SporeSolid *solid, const SporePoints *sorted, size_t count, double *depth,
                           const SporeProgressPart *progress, SporeError *error) {
  SporeVec3 nearest = spore_vec3_load(solid->mesh.vertices + 3 * (size_t)solid->mesh.triangles[0]);
  for (size_t i = 0; i < sorted->count; i++) {
    if (i % REPORT_EVERY == 0 &&
        !spore_progress_part(progress, (double)i / (double)sorted->count, _("Sampling the solid"), error))
      return false;
    if (sorted->original[i] >= count) continue;
    depth[sorted->original[i]] =
        spore_bvh_distance_beside(solid->bvh, spore_vec3(sorted->x[i], sorted->y[i], sorted->z[i]), &nearest);
  }
  return true;
}

/* Weight of a point among its kind. The error of spheres of size h is about proportional to h. So at the least sum of
 * weighted errors, the density of spheres is proportional to the 3/4th power of the weight. The density of the points
 * is proportional to the factor already. */
static double point_weight(const SporeSolid *solid, const double *point) {
  return solid->region_count ? cbrt(spore_solid_factor(solid, spore_vec3_load(point))) : 1;
}

/* Sets the weights of the points first .. first + count - 1, with the sum `whole`. */
static void weigh_kind(const SporeSolid *solid, const double *points, size_t first, size_t count, double whole,
                       double *weight) {
  double sum = 0;
  for (size_t i = first; i < first + count; i++) sum += weight[i] = point_weight(solid, points + 3 * i);
  for (size_t i = first; i < first + count; i++) weight[i] *= whole / sum;
}

/* Sorts points, depths and weights into blocks; measures the depths of the points inside. */
static bool arrange(SporeSamples *samples, const SporeSolid *solid, const double *points, double *depth, double *weight,
                    Kinds kinds, const SporeProgressPart *progress, SporeError *error) {
  size_t count = kinds.interior + kinds.surface + kinds.outside;
  if (!spore_points_create(&samples->points, points, count)) return spore_generate_no_memory(error);
  if (!measure_depths(solid, &samples->points, kinds.interior, depth, progress, error)) return false;
  size_t padded = samples->points.block_count * SPORE_BLOCK;
  samples->depth = SPORE_NEW_ARRAY(double, padded);
  samples->weight = SPORE_NEW_ARRAY(double, padded);
  if (!samples->depth || !samples->weight) return spore_generate_no_memory(error);
  weigh_kind(solid, points, 0, kinds.interior, WEIGHT_INTERIOR, weight);
  weigh_kind(solid, points, kinds.interior, kinds.surface, WEIGHT_SURFACE, weight);
  weigh_kind(solid, points, kinds.interior + kinds.surface, kinds.outside, WEIGHT_OUTSIDE, weight);
  for (size_t i = 0; i < count; i++) {
    size_t from = samples->points.original[i];
    samples->depth[i] = depth[from];
    samples->weight[i] = weight[from];
  }
  return true;
}

bool spore_samples_create(SporeSamples *samples, const SporeSolid *solid, size_t count, SporeRandom *random,
                          const SporeProgressPart *progress, SporeError *error) {
  Kinds kinds = wanted_samples(count);
  size_t most = kinds.interior + kinds.surface + kinds.outside;
  double *points = SPORE_NEW_ARRAY(double, 3 * most), *depth = SPORE_NEW_ARRAY(double, most),
         *weight = SPORE_NEW_ARRAY(double, most);
  *samples = (SporeSamples){0};
  samples->typical = cbrt(solid->volume / (double)count * 3 / (4 * M_PI));
  samples->band = BAND * samples->typical;
  bool done = points && depth && weight;
  if (!done) spore_generate_no_memory(error);
  if (done) {
    double *surface = points + 3 * kinds.interior;
    size_t before = kinds.interior + kinds.surface;
    done = draw_points(solid, false, kinds.interior, random, points, progress, error) &&
           draw_points(solid, true, kinds.surface, random, surface, progress, error) &&
           outside_points(solid, surface, &kinds, samples->band, random, points + 3 * before, depth + before, progress,
                          error) &&
           arrange(samples, solid, points, depth, weight, kinds, progress, error);
  }
  spore_free(points);
  spore_free(depth);
  spore_free(weight);
  if (!done) spore_samples_clear(samples);
  return done;
}

void spore_samples_clear(SporeSamples *samples) {
  spore_points_clear(&samples->points);
  spore_free(samples->depth);
  spore_free(samples->weight);
  *samples = (SporeSamples){0};
}
