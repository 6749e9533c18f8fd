/* The sum of weighted balls at the samples and its slopes by the balls' unknowns, block by block. */
#include <string.h>

#include "core/generate/spheres/kernels.h"
#include "core/generate/spheres/weighted_parts.h"

#define REACH 2 /* of the samples' band: how far outside a ball may reach */

SporeVec3 spore_weighted_confine(const SporeWeightedFit *fit, size_t ball, SporeVec3 centre) {
  const SporeSymmetry *symmetry = &fit->solid->symmetry;
  if (!symmetry->count) return centre;
  return spore_symmetry_bind(symmetry, fit->bound[ball], spore_symmetry_fold(symmetry, centre));
}

double spore_weighted_reach(const SporeWeightedFit *fit) {
  return fit->levelled ? REACH * fit->samples.band : fit->samples.band;
}

static bool reaches(const SporeWeightedFit *fit, SporeWeightedImage image, const double bound[4], SporeVec3 *centre) {
  *centre = spore_symmetry_mirror(&fit->solid->symmetry, image.planes, spore_balls_centre(&fit->balls, image.ball));
  return spore_vec3_distance(*centre, spore_vec3_load(bound)) < fit->balls.r[image.ball] + bound[3];
}

/* Collects the balls and images that reach the group; returns their number. */
static size_t gather_near(SporeWeightedFit *fit, size_t group) {
  const double *bound = fit->samples.points.group + 4 * group;
  size_t near = 0;
  for (size_t i = 0; i < fit->balls.count; i++)
    for (unsigned planes = 0; planes < 1u << fit->solid->symmetry.count; planes++) {
      SporeWeightedImage image = {(uint32_t)i, (uint8_t)planes};
      SporeVec3 unused;
      if (!(planes & fit->bound[i]) && reaches(fit, image, bound, &unused)) fit->near_group[near++] = image;
    }
  return near;
}

/* Adds the slopes of the images to their balls, mirrored back. */
static void add_slopes(SporeWeightedFit *fit, size_t count) {
  const SporeSymmetry *symmetry = &fit->solid->symmetry;
  for (size_t n = 0; n < count; n++) {
    const float *s = fit->slopes + SPORE_WEIGHTED_UNKNOWNS * n;
    double *to = fit->slope + SPORE_WEIGHTED_UNKNOWNS * (size_t)fit->near_block[n].ball;
    SporeVec3 v = spore_vec3((double)s[0], (double)s[1], (double)s[2]);
    for (unsigned k = 0; k < symmetry->count; k++)
      if (fit->near_block[n].planes >> k & 1)
        v = spore_vec3_add_scaled(v, -2 * spore_vec3_dot(v, symmetry->normal[k]), symmetry->normal[k]);
    to[0] += v.x, to[1] += v.y, to[2] += v.z, to[3] += (double)s[3], to[4] += (double)s[4];
  }
  fit->level_slope += (double)fit->slopes[SPORE_WEIGHTED_UNKNOWNS * count];
}

/* The block's samples as columns of SPORE_BLOCK, relative to the block's middle, lengths in `unit`. */
static void load_samples(const SporeWeightedFit *fit, size_t b, double unit, float columns[][SPORE_BLOCK]) {
  const SporePoints *points = &fit->samples.points;
  const double *middle = points->block + 4 * b;
  for (size_t k = 0, at = b * SPORE_BLOCK; k < SPORE_BLOCK; k++, at++) {
    columns[0][k] = (float)((points->x[at] - middle[0]) / unit);
    columns[1][k] = (float)((points->y[at] - middle[1]) / unit);
    columns[2][k] = (float)((points->z[at] - middle[2]) / unit);
    columns[3][k] = (float)(fit->samples.depth[at] / unit);
    columns[4][k] = (float)fit->samples.weight[at];
  }
}

static void evaluate_block(SporeWeightedFit *fit, size_t b, size_t near) {
  const double *middle = fit->samples.points.block + 4 * b, unit = fit->samples.typical;
  float sample[SPORE_WEIGHTED_UNKNOWNS][SPORE_BLOCK], sum[SPORE_BLOCK];
  float *x = fit->columns, *y = x + fit->image_count, *z = y + fit->image_count, *r = z + fit->image_count,
        *weight = r + fit->image_count;
  size_t count = 0;
  load_samples(fit, b, unit, sample);
  for (size_t n = 0; n < near; n++) {
    SporeWeightedImage image = fit->near_group[n];
    SporeVec3 c;
    if (!reaches(fit, image, middle, &c)) continue;
    x[count] = (float)((c.x - middle[0]) / unit), y[count] = (float)((c.y - middle[1]) / unit);
    z[count] = (float)((c.z - middle[2]) / unit), r[count] = (float)(fit->balls.r[image.ball] / unit);
    weight[count] = (float)fit->weights[image.ball];
    fit->near_block[count++] = image;
  }
  SporeWeightedBlock block = {count,
                              x,
                              y,
                              z,
                              r,
                              weight,
                              sample[0],
                              sample[1],
                              sample[2],
                              sample[3],
                              sample[4],
                              (float)(fit->smoothing / unit),
                              (float)(fit->level / unit)};
  SPORE_KERNEL(spore_weighted_slopes)(&block, sum, fit->slopes);
  for (size_t k = 0; k < SPORE_BLOCK; k++) fit->sum[b * SPORE_BLOCK + k] = (double)sum[k] * unit;
  add_slopes(fit, count);
}

void spore_weighted_evaluate(SporeWeightedFit *fit, size_t part, size_t parts) {
  const SporePoints *points = &fit->samples.points;
  fit->level_slope = 0;
  memset(fit->slope, 0, SPORE_WEIGHTED_UNKNOWNS * fit->balls.count * sizeof *fit->slope);
  for (size_t g = 0; g < points->group_count; g++) {
    size_t near = gather_near(fit, g), end = (g + 1) * SPORE_GROUP;
    for (size_t b = g * SPORE_GROUP; b < end && b < points->block_count; b++)
      if (b % parts == part) evaluate_block(fit, b, near);
  }
}
