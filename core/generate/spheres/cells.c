/* One sphere round each tetrahedron, as in the paper: the least that holds its four corners. */
#include <math.h>

#include "core/base/profile.h"
#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/common/common.h"
#include "core/generate/spheres/spheres.h"

/* Solves the symmetric positive definite a x = b of `count` unknowns by elimination; a, b are destroyed. */
static void solve(size_t count, double a[3][3], double b[3], double x[3]) {
  for (size_t k = 0; k < count; k++)
    for (size_t i = k + 1; i < count; i++) {
      double factor = a[i][k] / a[k][k];
      for (size_t j = k; j < count; j++) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  for (size_t k = count; k-- > 0;) {
    x[k] = b[k];
    for (size_t j = k + 1; j < count; j++) x[k] -= a[k][j] * x[j];
    x[k] /= a[k][k];
  }
}

/* The least sphere through the corners, in their plane or on their line where they are three or two. */
static double circumscribe(const SporeVec3 *corners, size_t count, SporeVec3 *centre) {
  double gram[3][3], half[3], x[3];
  for (size_t i = 1; i < count; i++) {
    SporeVec3 a = spore_vec3_sub(corners[i], corners[0]);
    for (size_t j = 1; j < count; j++) gram[i - 1][j - 1] = spore_vec3_dot(a, spore_vec3_sub(corners[j], corners[0]));
    half[i - 1] = 0.5 * spore_vec3_dot(a, a);
  }
  solve(count - 1, gram, half, x);
  *centre = corners[0];
  for (size_t i = 1; i < count; i++)
    *centre = spore_vec3_add_scaled(*centre, x[i - 1], spore_vec3_sub(corners[i], corners[0]));
  return spore_vec3_distance(*centre, corners[0]);
}

/* The least sphere that holds all four: through two, three or four of them. */
static void enclose(const SporeVec3 corners[4], double sphere[4]) {
  sphere[3] = HUGE_VAL;
  for (unsigned subset = 3; subset < 16; subset++) {
    SporeVec3 some[4], centre;
    size_t count = 0;
    for (unsigned k = 0; k < 4; k++)
      if (subset >> k & 1) some[count++] = corners[k];
    if (count < 2) continue;
    double radius = circumscribe(some, count, &centre), farthest = 0;
    for (int k = 0; k < 4; k++) farthest = fmax(farthest, spore_vec3_distance(centre, corners[k]));
    if (farthest > radius * (1 + 1e-9) || !(farthest < sphere[3])) continue;
    spore_vec3_store(sphere, centre);
    sphere[3] = farthest;
  }
}

static bool check(const SporeTetrahedralMesh *cells, SporeError *error) {
  if (!spore_tetrahedral_mesh_validate(cells, error)) return false;
  if (cells->tetrahedron_count <= SPORE_SPHERES_MAXIMUM) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("there are %zu tetrahedra, and a set holds at most %u spheres; expected fewer, where each "
                           "gets one; choose another method"),
                         cells->tetrahedron_count, SPORE_SPHERES_MAXIMUM);
}

bool spore_spheres_of_cells(const SporeTetrahedralMesh *cells, const SporeTriangleMesh *solid, SporeSphereSet *set,
                            SporeSpheresReport *report, SporeError *error) {
  uint64_t start = spore_clock_ns();
  SporeTriangleMesh boundary = {.vertex_count = cells->vertex_count, .vertices = cells->vertices};
  *set = (SporeSphereSet){0};
  *report = (SporeSpheresReport){0};
  if (!check(cells, error) || !spore_sphere_set_allocate(set, cells->tetrahedron_count, error)) return false;
  for (size_t t = 0; t < cells->tetrahedron_count; t++) {
    SporeVec3 corners[4];
    for (size_t k = 0; k < 4; k++)
      corners[k] = spore_vec3_load(cells->vertices + 3 * (size_t)cells->tetrahedra[4 * t + k]);
    enclose(corners, set->spheres + 4 * t);
  }
  bool done = solid || spore_tetrahedral_mesh_boundary(cells, &boundary.triangles, &boundary.triangle_count) ||
              spore_generate_no_memory(error);
  done = done && spore_spheres_measure(solid ? solid : &boundary, set, report, error);
  spore_free(boundary.triangles);
  if (!done) spore_sphere_set_clear(set);
  report->seconds = (double)(spore_clock_ns() - start) * 1e-9;
  return done;
}
