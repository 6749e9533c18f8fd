/* Points spread over the volume of a solid and over surfaces, and the distance between two surfaces at such points. */
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/common/solid.h"
#include "core/mesh/common.h"

#define SAMPLES_A_REPORT 512
#define TRIES_A_REPORT 4096

bool spore_generate_no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL,
                         _("there is not enough memory to generate this; close other programs or ask for less"));
}

SporeVec3 spore_random_direction(SporeRandom *random) {
  double z = 2 * spore_random_unit(random) - 1, angle = 2 * M_PI * spore_random_unit(random);
  double s = sqrt(fmax(0, 1 - z * z));
  return spore_vec3(s * cos(angle), s * sin(angle), z);
}

/* First index whose running sum exceeds `value`. */
static size_t pick(const double *end, size_t count, double value) {
  size_t low = 0, high = count - 1;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (end[middle] > value) high = middle;
    else low = middle + 1;
  }
  return low;
}

bool spore_solid_try(const SporeSolid *solid, double share, SporeRandom *random, double p[3]) {
  size_t c = pick(solid->cell_end, solid->cell_count, share * solid->cell_end[solid->cell_count - 1]);
  for (int k = 0; k < 3; k++) p[k] = solid->cells[4 * c + k] + solid->cells[4 * c + 3] * spore_random_unit(random);
  return solid->cell_inside[c] || spore_bvh_inside(solid->bvh, spore_vec3_load(p));
}

bool spore_solid_interior(const SporeSolid *solid, size_t count, SporeRandom *random, double *points,
                          const SporeProgressPart *progress, SporeError *error) {
  double filling = solid->volume / solid->cell_end[solid->cell_count - 1];
  size_t found = 0, round = (size_t)((double)count / filling * 1.02) + 64;
  while (found < count) {
    /* strata in a scrambled order, so that a cut-off at the end affects the whole solid evenly */
    for (size_t i = 0; found < count && i < round; i++) {
      double golden = (double)i * 0.6180339887498949;
      if (i % TRIES_A_REPORT == 0 && !spore_progress_part(progress, 0, _("Sampling the solid"), error)) return false;
      found += spore_solid_try(solid, golden - floor(golden), random, points + 3 * found);
    }
  }
  return true;
}

void spore_solid_surface(const SporeSolid *solid, size_t count, SporeRandom *random, double *points,
                         SporeVec3 *normals) {
  double area = solid->triangle_end[solid->mesh.triangle_count - 1];
  for (size_t i = 0; i < count; i++) {
    double share = ((double)i + spore_random_unit(random)) / (double)count;
    size_t t = pick(solid->triangle_end, solid->mesh.triangle_count, share * area);
    SporeVec3 p[3];
    for (int k = 0; k < 3; k++)
      p[k] = spore_vec3_load(solid->mesh.vertices + 3 * (size_t)solid->mesh.triangles[3 * t + k]);
    double u = spore_random_unit(random), v = spore_random_unit(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    SporeVec3 ab = spore_vec3_sub(p[1], p[0]), ac = spore_vec3_sub(p[2], p[0]);
    spore_vec3_store(points + 3 * i, spore_vec3_add_scaled(spore_vec3_add_scaled(p[0], u, ab), v, ac));
    if (normals) normals[i] = spore_vec3_normalise(spore_vec3_cross(ab, ac), spore_vec3(0, 0, 1));
  }
}

static SporeVec3 corner(const SporeTriangleMesh *mesh, size_t triangle, int c) {
  return spore_vec3_load(mesh->vertices + 3 * (size_t)mesh->triangles[3 * triangle + (size_t)c]);
}

static double triangle_area(const SporeTriangleMesh *mesh, size_t triangle) {
  SporeVec3 a = corner(mesh, triangle, 0);
  return 0.5 * spore_vec3_length(spore_vec3_cross(spore_vec3_sub(corner(mesh, triangle, 1), a),
                                                  spore_vec3_sub(corner(mesh, triangle, 2), a)));
}

static SporeVec3 point_in(const SporeTriangleMesh *mesh, size_t triangle, double u, double v) {
  if (u + v > 1) u = 1 - u, v = 1 - v;
  SporeVec3 a = corner(mesh, triangle, 0), b = corner(mesh, triangle, 1), c = corner(mesh, triangle, 2);
  return spore_vec3_add_scaled(spore_vec3_add_scaled(a, u, spore_vec3_sub(b, a)), v, spore_vec3_sub(c, a));
}

void spore_surface_samples(const SporeTriangleMesh *mesh, size_t samples, double *points, uint32_t *triangles) {
  double area = 0, passed = 0;
  for (size_t i = 0; i < mesh->triangle_count; i++) area += triangle_area(mesh, i);
  size_t triangle = 0;
  double here = triangle_area(mesh, 0);
  for (size_t i = 0; i < samples; i++) {
    double wanted = area * ((double)i + 0.5) / (double)samples;
    while (passed + here < wanted && triangle + 1 < mesh->triangle_count) {
      passed += here;
      here = triangle_area(mesh, ++triangle);
    }
    double u = fmod(0.7548776662466927 * (double)(i + 1), 1), v = fmod(0.5698402909980532 * (double)(i + 1), 1);
    spore_vec3_store(points + 3 * i, point_in(mesh, triangle, u, v));
    if (triangles) triangles[i] = (uint32_t)triangle;
  }
}

/* Largest distance from evenly spread points of `mesh` to `other`. */
static bool one_way(const SporeTriangleMesh *mesh, const SporeBvh *other, size_t samples, double fraction,
                    double *distance, const SporeProgress *progress, SporeError *error) {
  double *points = SPORE_NEW_ARRAY(double, 3 * samples);
  if (!points) return spore_mesh_no_memory(error);
  spore_surface_samples(mesh, samples, points, NULL);
  bool go_on = true;
  for (size_t i = 0; i < samples && go_on; i++) {
    if (i % SAMPLES_A_REPORT == 0)
      go_on = spore_progress_step(progress, fraction + 0.5 * (double)i / (double)samples, _("measuring the distance"),
                                  error);
    *distance = fmax(*distance, spore_bvh_distance(other, spore_vec3_load(points + 3 * i), NULL, NULL));
  }
  spore_free(points);
  return go_on;
}

bool spore_surface_distance(const SporeTriangleMesh *a, const SporeTriangleMesh *b, size_t samples, double *distance,
                            const SporeProgress *progress, SporeError *error) {
  SporeBvh *tree_a = spore_bvh_create(a, error), *tree_b = tree_a ? spore_bvh_create(b, error) : NULL;
  *distance = 0;
  bool done = tree_b && one_way(a, tree_b, samples, 0, distance, progress, error) &&
              one_way(b, tree_a, samples, 0.5, distance, progress, error);
  spore_bvh_free(tree_b);
  spore_bvh_free(tree_a);
  return done;
}
