#include "core/generate/surface_distance.h"

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/mesh/bvh.h"
#include "core/mesh/common.h"

#define SAMPLES_A_REPORT 512

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
      go_on = spore_progress(progress, fraction + 0.5 * (double)i / (double)samples, _("measuring the distance")) ||
              spore_error_set(error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
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
