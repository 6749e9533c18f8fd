/* Samples of the depth in small cells, densest at the surface. */
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres/private.h"

#define SAMPLES_PER_BALL 700 /* at the surface, about */
#define SAMPLES_LEAST 12000
#define SAMPLES_MOST 90000 /* unless there are so many balls that each has too few */
#define SAMPLES_PER_BALL_LEAST 180
#define NEAR 0.2 /* of the typical radius: samples are dense up to this distance from the surface */
#define FAR 0.7  /* of the typical radius: how far outside samples go */
#define REPORT_EVERY 4096

typedef struct Cells {
  const SporeSolid *solid;
  double *xyz, *depth, *volume;
  size_t count, capacity, visited;
  double finest, near, far; /* m */
  SporeRandom *random;
  const SporeProgressPart *progress;
  SporeError *error;
} Cells;

static bool grow(Cells *cells) {
  size_t old = cells->capacity, capacity = old ? 2 * old : 65536;
  double *xyz = spore_reallocate(cells->xyz, 3 * old, 3 * capacity, sizeof *xyz);
  if (xyz) cells->xyz = xyz;
  double *depth = spore_reallocate(cells->depth, old, capacity, sizeof *depth);
  if (depth) cells->depth = depth;
  double *volume = spore_reallocate(cells->volume, old, capacity, sizeof *volume);
  if (volume) cells->volume = volume;
  if (!xyz || !depth || !volume) return spore_generate_no_memory(cells->error);
  cells->capacity = capacity;
  return true;
}

/* Adds a random point of the cell, which stands for the whole cell, unless the point lies too far outside. Errors weigh
 * more where regions want more balls, see samples.c. */
static bool add_cell(Cells *cells, SporeVec3 middle, double edge, const SporeBvhKnown *known) {
  const SporeSolid *solid = cells->solid;
  double offset[3];
  if (cells->count == cells->capacity && !grow(cells)) return false;
  for (int k = 0; k < 3; k++) offset[k] = edge * (spore_random_unit(cells->random) - 0.5);
  SporeVec3 p = spore_vec3_add(middle, spore_vec3_load(offset));
  double depth = spore_bvh_depth_beside(cells->solid->bvh, p, known).depth,
         factor = solid->region_count ? spore_solid_factor(solid, p) : 1;
  if (depth < -cells->far) return true;
  spore_vec3_store(cells->xyz + 3 * cells->count, spore_symmetry_fold(&solid->symmetry, p));
  cells->depth[cells->count] = depth;
  cells->volume[cells->count++] = edge * edge * edge * factor * cbrt(factor);
  return true;
}

static bool divide(Cells *cells, SporeVec3 middle, double edge, const SporeBvhKnown *known) {
  if (cells->visited++ % REPORT_EVERY == 0 &&
      !spore_progress_part(cells->progress, fmin(1, (double)cells->count / SAMPLES_MOST), _("Sampling the solid"),
                           cells->error))
    return false;
  if (edge <= 1.001 * cells->finest) return add_cell(cells, middle, edge, known);
  SporeBvhKnown here = spore_bvh_depth_beside(cells->solid->bvh, middle, known);
  double reach = edge * (sqrt(3) / 2);
  if (here.depth < -cells->far - reach) return true;
  if (edge <= 2.001 * cells->finest && fabs(here.depth) > cells->near + reach)
    return add_cell(cells, middle, edge, &here);
  for (int k = 0; k < 8; k++) {
    double quarter = edge / 4;
    SporeVec3 at = spore_vec3(middle.x + (k & 1 ? quarter : -quarter), middle.y + (k & 2 ? quarter : -quarter),
                              middle.z + (k & 4 ? quarter : -quarter));
    if (!divide(cells, at, edge / 2, &here)) return false;
  }
  return true;
}

/* Starts from a cell that contains all, with an edge of a power of two times the finest. */
static bool divide_all(Cells *cells) {
  const SporeTriangleMesh *mesh = &cells->solid->mesh;
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, extent = 0;
  for (size_t i = 0; i < 3 * mesh->vertex_count; i++) {
    lower[i % 3] = fmin(lower[i % 3], mesh->vertices[i]);
    upper[i % 3] = fmax(upper[i % 3], mesh->vertices[i]);
  }
  for (int k = 0; k < 3; k++) extent = fmax(extent, upper[k] - lower[k]);
  SporeVec3 middle = spore_vec3_scale(0.5, spore_vec3_add(spore_vec3_load(lower), spore_vec3_load(upper)));
  double edge = cells->finest;
  while (edge < extent + 2 * cells->far) edge *= 2;
  return divide(cells, middle, edge, &(SporeBvhKnown){.depth = 0});
}

static bool sort_cells(const Cells *cells, SporeSamples *samples) {
  if (!spore_points_create(&samples->points, cells->xyz, cells->count)) return false;
  size_t padded = samples->points.block_count * SPORE_BLOCK;
  samples->depth = SPORE_NEW_ARRAY(double, padded);
  samples->weight = SPORE_NEW_ARRAY(double, padded);
  if (!samples->depth || !samples->weight) return false;
  for (size_t i = 0; i < cells->count; i++) {
    samples->depth[i] = cells->depth[samples->points.original[i]];
    samples->weight[i] = cells->volume[samples->points.original[i]];
  }
  return true;
}

bool spore_samples_create_graded(SporeSamples *samples, const SporeSolid *solid, size_t count, double typical,
                                 SporeRandom *random, const SporeProgressPart *progress, SporeError *error) {
  double most = fmax(SAMPLES_MOST, SAMPLES_PER_BALL_LEAST * (double)count);
  double wanted = fmin(fmax(SAMPLES_PER_BALL * (double)count, SAMPLES_LEAST), most);
  double area = solid->triangle_end[solid->mesh.triangle_count - 1], near = NEAR * typical, far = FAR * typical;
  Cells cells = {.solid = solid,
                 .finest = cbrt(2 * near * area / wanted),
                 .near = near,
                 .far = far,
                 .random = random,
                 .progress = progress,
                 .error = error};
  *samples = (SporeSamples){.typical = typical, .band = far};
  bool done = divide_all(&cells);
  if (done && !sort_cells(&cells, samples)) done = spore_generate_no_memory(error);
  spore_free(cells.xyz);
  spore_free(cells.depth);
  spore_free(cells.volume);
  if (!done) spore_samples_clear(samples);
  return done;
}
