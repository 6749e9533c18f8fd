/* The sum of weighted balls at the samples and its slopes by the balls' unknowns, block by block. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
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

bool spore_weighted_images_create(SporeWeightedImages *images, size_t most) {
  double *columns = SPORE_NEW_ARRAY(double, 4 * most);
  *images = (SporeWeightedImages){.ball = SPORE_NEW_ARRAY(uint32_t, most), .planes = SPORE_NEW_ARRAY(uint8_t, most)};
  images->x = columns;
  if (columns) images->y = columns + most, images->z = columns + 2 * most, images->r = columns + 3 * most;
  return columns && images->ball && images->planes;
}

void spore_weighted_images_clear(SporeWeightedImages *images) {
  spore_free(images->x);
  spore_free(images->ball);
  spore_free(images->planes);
  *images = (SporeWeightedImages){0};
}

static void add_image(SporeWeightedImages *to, SporeVec3 centre, double radius, uint32_t ball, uint8_t planes) {
  size_t n = to->count++;
  to->x[n] = centre.x, to->y[n] = centre.y, to->z[n] = centre.z, to->r[n] = radius;
  to->ball[n] = ball, to->planes[n] = planes;
}

/* The balls and their images as they are now. */
static void find_images(SporeWeightedFit *fit) {
  const SporeSymmetry *symmetry = &fit->solid->symmetry;
  fit->images.count = 0;
  for (size_t i = 0; i < fit->balls.count; i++)
    for (unsigned planes = 0; planes < 1u << symmetry->count; planes++) {
      if (planes & fit->bound[i]) continue;
      SporeVec3 centre = spore_symmetry_mirror(symmetry, planes, spore_balls_centre(&fit->balls, i));
      add_image(&fit->images, centre, fit->balls.r[i], (uint32_t)i, (uint8_t)planes);
    }
}

/* Collects those of the images that reach into the bounding sphere. Without a branch, as which ones do is hard to
 * foretell. */
static void gather_near(SporeWeightedFit *fit, const SporeWeightedImages *from, const double bound[4],
                        SporeWeightedImages *near) {
  size_t count = 0;
  SPORE_KERNEL(spore_balls_reach)(from->x, from->y, from->z, from->r, from->count, bound, fit->reaches);
  for (size_t n = 0; n < from->count; n++) {
    fit->listed[count] = (uint32_t)n;
    count += fit->reaches[n];
  }
  near->count = count;
  for (size_t k = 0; k < count; k++) {
    uint32_t n = fit->listed[k];
    near->x[k] = from->x[n], near->y[k] = from->y[n], near->z[k] = from->z[n], near->r[k] = from->r[n];
    near->ball[k] = from->ball[n], near->planes[k] = from->planes[n];
  }
}

/* Adds the slopes of the images to their balls, mirrored back. */
static void add_slopes(SporeWeightedFit *fit, size_t count) {
  const SporeSymmetry *symmetry = &fit->solid->symmetry;
  for (size_t n = 0; n < count; n++) {
    const float *s = fit->slopes + SPORE_WEIGHTED_UNKNOWNS * n;
    double *to = fit->slope + SPORE_WEIGHTED_UNKNOWNS * (size_t)fit->near_block.ball[n];
    SporeVec3 v = spore_vec3((double)s[0], (double)s[1], (double)s[2]);
    for (unsigned k = 0; k < symmetry->count; k++)
      if (fit->near_block.planes[n] >> k & 1)
        v = spore_vec3_add_scaled(v, -2 * spore_vec3_dot(v, symmetry->normal[k]), symmetry->normal[k]);
    to[0] += v.x, to[1] += v.y, to[2] += v.z, to[3] += (double)s[3], to[4] += (double)s[4];
  }
  fit->level_slope += (double)fit->slopes[SPORE_WEIGHTED_UNKNOWNS * count];
}

void spore_weighted_load_samples(SporeWeightedFit *fit) {
  const SporePoints *points = &fit->samples.points;
  double unit = fit->samples.typical;
  for (size_t b = 0; b < points->block_count; b++) {
    const double *middle = points->block + 4 * b;
    float *x = fit->loaded + SPORE_WEIGHTED_COLUMNS * SPORE_BLOCK * b, *y = x + SPORE_BLOCK, *z = y + SPORE_BLOCK,
          *depth = z + SPORE_BLOCK, *weight = depth + SPORE_BLOCK;
    for (size_t k = 0, at = b * SPORE_BLOCK; k < SPORE_BLOCK; k++, at++) {
      x[k] = (float)((points->x[at] - middle[0]) / unit);
      y[k] = (float)((points->y[at] - middle[1]) / unit);
      z[k] = (float)((points->z[at] - middle[2]) / unit);
      depth[k] = (float)(fit->samples.depth[at] / unit);
      weight[k] = (float)fit->samples.weight[at];
    }
  }
}

void spore_weighted_bound_regions(SporeWeightedFit *fit) {
  const SporePoints *points = &fit->samples.points;
  for (size_t first = 0; first < points->group_count; first += SPORE_WEIGHTED_REGION) {
    double *region = fit->region + 4 * (first / SPORE_WEIGHTED_REGION);
    size_t end = first + SPORE_WEIGHTED_REGION;
    if (end > points->group_count) end = points->group_count;
    SporeVec3 sum = spore_vec3(0, 0, 0);
    for (size_t g = first; g < end; g++) sum = spore_vec3_add(sum, spore_vec3_load(points->group + 4 * g));
    SporeVec3 centre = spore_vec3_scale(1 / (double)(end - first), sum);
    spore_vec3_store(region, centre);
    region[3] = 0;
    for (size_t g = first; g < end; g++) {
      const double *group = points->group + 4 * g;
      region[3] = fmax(region[3], spore_vec3_distance(centre, spore_vec3_load(group)) + group[3] * (1 + 1e-9));
    }
  }
}

static void evaluate_block(SporeWeightedFit *fit, size_t b) {
  const double *middle = fit->samples.points.block + 4 * b, unit = fit->samples.typical;
  const float *sample = fit->loaded + SPORE_WEIGHTED_COLUMNS * SPORE_BLOCK * b;
  float sum[SPORE_BLOCK];
  float *x = fit->columns, *y = x + fit->image_count, *z = y + fit->image_count, *r = z + fit->image_count,
        *weight = r + fit->image_count;
  const SporeWeightedImages *near = &fit->near_block;
  size_t count = 0;
  gather_near(fit, &fit->near_group, middle, &fit->near_block);
  for (; count < near->count; count++) {
    x[count] = (float)((near->x[count] - middle[0]) / unit), y[count] = (float)((near->y[count] - middle[1]) / unit);
    z[count] = (float)((near->z[count] - middle[2]) / unit), r[count] = (float)(near->r[count] / unit);
    weight[count] = (float)fit->weights[near->ball[count]];
  }
  SporeWeightedBlock block = {count,
                              x,
                              y,
                              z,
                              r,
                              weight,
                              sample,
                              sample + SPORE_BLOCK,
                              sample + 2 * SPORE_BLOCK,
                              sample + 3 * SPORE_BLOCK,
                              sample + 4 * SPORE_BLOCK,
                              (float)(fit->smoothing / unit),
                              (float)(fit->level / unit),
                              fit->distance};
  SPORE_KERNEL(spore_weighted_slopes)(&block, sum, fit->slopes);
  for (size_t k = 0; k < SPORE_BLOCK; k++) fit->sum[b * SPORE_BLOCK + k] = (double)sum[k] * unit;
  add_slopes(fit, count);
}

void spore_weighted_evaluate(SporeWeightedFit *fit, size_t part, size_t parts) {
  const SporePoints *points = &fit->samples.points;
  fit->level_slope = 0;
  find_images(fit);
  memset(fit->slope, 0, SPORE_WEIGHTED_UNKNOWNS * fit->balls.count * sizeof *fit->slope);
  for (size_t g = 0; g < points->group_count; g++) {
    size_t end = (g + 1) * SPORE_GROUP;
    if (g % SPORE_WEIGHTED_REGION == 0)
      gather_near(fit, &fit->images, fit->region + 4 * (g / SPORE_WEIGHTED_REGION), &fit->near_region);
    gather_near(fit, &fit->near_region, points->group + 4 * g, &fit->near_group);
    for (size_t b = g * SPORE_GROUP; b < end && b < points->block_count; b++)
      if (b % parts == part) evaluate_block(fit, b);
  }
}
