#include <math.h>
#include <string.h>

#include "core/generate/surface_distance.h"
#include "core/generate/tetrahedra_improve.h"
#include "core/generate/tetrahedra_stars.h"
#include "core/mesh/common.h"

#define SHARE (2.0 / 3) /* of the mean gap of a face: half of that at its middle, where it bends evenly */
#define HALVINGS 2
#define MOST_WORSE 1.05 /* times the largest distance: the volume is worth as much */

typedef struct {
  SporeStars stars;
  SporeTriangleMesh boundary; /* vertices: the mesh's */
  double *normals, *gap, *weight, *kept, *samples;
  size_t count; /* of points, and of samples */
} Balance;

static bool create(Balance *balance, SporeTetrahedralMesh *mesh, size_t count, SporeError *error) {
  const size_t n = mesh->vertex_count;
  *balance = (Balance){.boundary = {.vertex_count = n, .vertices = mesh->vertices},
                       .normals = SPORE_NEW_ARRAY(double, 3 * n),
                       .gap = SPORE_NEW_ARRAY(double, n),
                       .weight = SPORE_NEW_ARRAY(double, n),
                       .kept = SPORE_NEW_ARRAY(double, 3 * n),
                       .samples = SPORE_NEW_ARRAY(double, 3 * count),
                       .count = count};
  if (!balance->normals || !balance->gap || !balance->weight || !balance->kept || !balance->samples ||
      !spore_tetrahedral_mesh_boundary(mesh, &balance->boundary.triangles, &balance->boundary.triangle_count))
    return spore_mesh_no_memory(error);
  return spore_stars_create(&balance->stars, mesh, NULL, error);
}

static void clear(Balance *balance) {
  spore_stars_clear(&balance->stars);
  spore_free(balance->boundary.triangles);
  spore_free(balance->normals);
  spore_free(balance->gap);
  spore_free(balance->weight);
  spore_free(balance->kept);
  spore_free(balance->samples);
}

/* At each vertex, how far the surface is before the faces around it, by their areas: at their middles and those of
 * their sides, the vertices counting as on it. The weights are those of Simpson's rule on a triangle (1/20, 2/15,
 * 9/20). */
static void measure_gaps(Balance *balance, const SporeBvh *surface) {
  const SporeTriangleMesh *boundary = &balance->boundary;
  for (size_t t = 0; t < boundary->triangle_count; t++) {
    const uint32_t *corner = boundary->triangles + 3 * t;
    SporeVec3 p[3], near, area;
    for (int k = 0; k < 3; k++) p[k] = spore_mesh_vertex(boundary->vertices, corner[k]);
    area = spore_mesh_area_vector(p[0], p[1], p[2]);
    SporeVec3 normal = spore_vec3_normalise(area, spore_vec3(0, 0, 0));
    double size = spore_vec3_length(area), sum = 0;
    for (int k = 0; k < 4; k++) {
      SporeVec3 at = k == 3 ? spore_vec3_scale(1.0 / 3, spore_vec3_add(p[0], spore_vec3_add(p[1], p[2])))
                            : spore_vec3_scale(0.5, spore_vec3_add(p[k], p[(k + 1) % 3]));
      spore_bvh_distance(surface, at, &near, NULL);
      sum += (k == 3 ? 0.45 : 2.0 / 15) * spore_vec3_dot(spore_vec3_sub(near, at), normal);
    }
    for (int k = 0; k < 3; k++) balance->gap[corner[k]] += size * sum, balance->weight[corner[k]] += size;
  }
}

static void move_all(Balance *balance, double least) {
  for (uint32_t v = 0; v < balance->boundary.vertex_count; v++) {
    if (!(balance->weight[v] > 0)) continue;
    SporeVec3 here = spore_mesh_vertex(balance->boundary.vertices, v), normal = spore_mesh_vertex(balance->normals, v);
    double way = SHARE * balance->gap[v] / balance->weight[v];
    const double floor = fmin(least, spore_stars_quality_at(&balance->stars, v, here, -2));
    for (int k = 0; k <= HALVINGS; k++, way *= 0.5) {
      SporeVec3 place = spore_vec3_add_scaled(here, way, normal);
      if (spore_stars_quality_at(&balance->stars, v, place, floor) < floor) continue;
      spore_stars_move(&balance->stars, v, place);
      break;
    }
  }
}

/* Both ways; below 0: no memory. */
static double largest_distance(const Balance *balance, const SporeBvh *surface, const double *points) {
  SporeBvh *tree = spore_bvh_create(&balance->boundary, NULL);
  double most = tree ? 0 : -1;
  if (tree) spore_surface_samples(&balance->boundary, balance->count, balance->samples, NULL);
  for (size_t i = 0; tree && i < 3 * balance->count; i += 3) {
    most = fmax(most, spore_bvh_distance(tree, spore_vec3_load(points + i), NULL, NULL));
    most = fmax(most, spore_bvh_distance(surface, spore_vec3_load(balance->samples + i), NULL, NULL));
  }
  spore_bvh_free(tree);
  return most;
}

bool spore_tetrahedra_balance(SporeTetrahedralMesh *mesh, const SporeBvh *surface, const double *points, size_t count,
                              double least, SporeError *error) {
  Balance balance;
  bool done = create(&balance, mesh, count, error);
  double before = done ? largest_distance(&balance, surface, points) : 0;
  if (done) {
    memcpy(balance.kept, mesh->vertices, 3 * mesh->vertex_count * sizeof(double));
    spore_triangle_mesh_normals(mesh->vertices, mesh->vertex_count, balance.boundary.triangles,
                                balance.boundary.triangle_count, balance.normals);
    measure_gaps(&balance, surface);
    move_all(&balance, least);
    double after = largest_distance(&balance, surface, points);
    if (before < 0 || after < 0) done = spore_mesh_no_memory(error);
    else if (after > before * MOST_WORSE) memcpy(mesh->vertices, balance.kept, 3 * mesh->vertex_count * sizeof(double));
  }
  clear(&balance);
  return done;
}
