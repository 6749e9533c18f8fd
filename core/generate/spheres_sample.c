#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres_parts.h"

/* Weights of the kinds of samples, each as a whole. */
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

/* Points off the surface by a normal deviate of the band, kept where they are outside and not far. Returns how many. */
static size_t outside_points(const SporeSolid *solid, const double *surface, size_t count, size_t wanted, double band,
                             SporeRandom *random, double *points, double *depth) {
  size_t found = 0;
  for (size_t i = 0; found < wanted && i < 3 * wanted; i++) {
    double u = 1 - spore_random_unit(random), distance = band * sqrt(-2 * log(u));
    SporeVec3 p = spore_vec3_add_scaled(spore_vec3_load(surface + 3 * (i % count)),
                                        distance * (1 - 2 * spore_random_unit(random)), spore_random_direction(random));
    double d = spore_bvh_depth(solid->bvh, p);
    if (d >= 0 || d < -FARTHEST * band) continue;
    spore_vec3_store(points + 3 * found, p);
    depth[found++] = d;
  }
  return found;
}

static bool measure_depths(const SporeSolid *solid, const double *points, size_t count, double *depth,
                           const SporeProgressPart *progress, SporeError *error) {
  for (size_t i = 0; i < count; i++) {
    if (i % REPORT_EVERY == 0 &&
        !spore_progress_part(progress, (double)i / (double)count, _("Sampling the solid"), error))
      return false;
    depth[i] = spore_bvh_distance(solid->bvh, spore_vec3_load(points + 3 * i), NULL, NULL);
  }
  return true;
}

/* Sorts points, depths and weights into blocks. */
static bool arrange(SporeSamples *samples, const double *points, const double *depth, Kinds kinds, SporeError *error) {
  size_t count = kinds.interior + kinds.surface + kinds.outside;
  if (!spore_points_create(&samples->points, points, count)) return spore_spheres_no_memory(error);
  size_t padded = samples->points.block_count * SPORE_BLOCK;
  samples->depth = SPORE_NEW_ARRAY(double, padded);
  samples->weight = SPORE_NEW_ARRAY(double, padded);
  if (!samples->depth || !samples->weight) return spore_spheres_no_memory(error);
  for (size_t i = 0; i < count; i++) {
    size_t from = samples->points.original[i];
    samples->depth[i] = depth[from];
    samples->weight[i] = from < kinds.interior                   ? WEIGHT_INTERIOR / (double)kinds.interior
                         : from < kinds.interior + kinds.surface ? WEIGHT_SURFACE / (double)kinds.surface
                                                                 : WEIGHT_OUTSIDE / (double)kinds.outside;
  }
  return true;
}

bool spore_samples_create(SporeSamples *samples, const SporeSolid *solid, size_t count, SporeRandom *random,
                          const SporeProgressPart *progress, SporeError *error) {
  Kinds kinds = wanted_samples(count);
  size_t most = kinds.interior + kinds.surface + kinds.outside;
  double *points = SPORE_NEW_ARRAY(double, 3 * most), *depth = SPORE_NEW_ARRAY(double, most);
  *samples = (SporeSamples){0};
  samples->typical = cbrt(solid->volume / (double)count * 3 / (4 * M_PI));
  samples->band = BAND * samples->typical;
  bool done = points && depth;
  if (!done) spore_spheres_no_memory(error);
  if (done) {
    double *surface = points + 3 * kinds.interior;
    spore_solid_interior(solid, kinds.interior, random, points);
    spore_solid_surface(solid, kinds.surface, random, surface, NULL);
    done = measure_depths(solid, points, kinds.interior, depth, progress, error);
    if (done) {
      size_t before = kinds.interior + kinds.surface;
      kinds.outside = outside_points(solid, surface, kinds.surface, kinds.outside, samples->band, random,
                                     points + 3 * before, depth + before);
      done = arrange(samples, points, depth, kinds, error);
    }
  }
  spore_free(points);
  spore_free(depth);
  if (!done) spore_samples_clear(samples);
  return done;
}

void spore_samples_clear(SporeSamples *samples) {
  spore_points_clear(&samples->points);
  spore_free(samples->depth);
  spore_free(samples->weight);
  *samples = (SporeSamples){0};
}
