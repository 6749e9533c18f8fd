#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/text.h"
#include "core/generate/tetrahedra_improve.h"
#include "core/generate/tetrahedra_stars.h"
#include "core/mesh/common.h"

#define ROUNDS 8
#define HALVINGS 3
#define RELAX 1.8 /* times the floor: what vertices inside make room for */

typedef struct {
  double distance;
  uint32_t point, vertex;
} Far;

static int farther_first(const void *a, const void *b) {
  const Far *x = a, *y = b;
  if (x->distance != y->distance) return x->distance < y->distance ? 1 : -1;
  return x->point < y->point ? -1 : x->point > y->point;
}

/* The points farther than `tolerance`, each with the corner that is next to it of the triangle of the boundary next to
 * it, farthest first. Returns the largest distance. */
static double find_far(const SporeTriangleMesh *boundary, const SporeBvh *tree, const double *points, size_t count,
                       double tolerance, Far *far, size_t *far_count) {
  double most = 0;
  *far_count = 0;
  for (size_t i = 0; i < count; i++) {
    SporeVec3 p = spore_vec3_load(points + 3 * i);
    uint32_t triangle = 0;
    double distance = spore_bvh_distance(tree, p, NULL, &triangle), nearest = HUGE_VAL;
    most = fmax(most, distance);
    if (distance <= tolerance) continue;
    Far *next = far + (*far_count)++;
    *next = (Far){distance, (uint32_t)i, 0};
    for (size_t k = 0; k < 3; k++) {
      uint32_t v = boundary->triangles[3 * (size_t)triangle + k];
      double d = spore_vec3_distance(p, spore_mesh_vertex(boundary->vertices, v));
      if (d < nearest) nearest = d, next->vertex = v;
    }
  }
  qsort(far, *far_count, sizeof *far, farther_first);
  return most;
}

/* Each vertex goes to the farthest point that is its own, or as far as the cells around it allow. */
static size_t pull_all(SporeStars *stars, const SporeBvh *surface, const double *points, const Far *far, size_t count,
                       double floor, bool *pulled) {
  size_t moved = 0;
  memset(pulled, 0, stars->mesh->vertex_count * sizeof *pulled);
  for (size_t i = 0; i < count; i++) {
    uint32_t v = far[i].vertex;
    if (pulled[v]) continue;
    pulled[v] = true;
    SporeVec3 here = spore_mesh_vertex(stars->mesh->vertices, v),
              to = spore_vec3_load(points + 3 * (size_t)far[i].point);
    const double least = fmin(floor, spore_stars_quality_at(stars, v, here, -2));
    double share = 1;
    for (int k = 0; k <= HALVINGS; k++, share *= 0.5) {
      SporeVec3 place = spore_vec3_add_scaled(here, share, spore_vec3_sub(to, here));
      if (k) spore_bvh_distance(surface, place, &place, NULL);
      if (spore_stars_quality_at(stars, v, place, least) < least) continue;
      spore_stars_move(stars, v, place);
      moved++;
      break;
    }
  }
  return moved;
}

bool spore_tetrahedra_pull(SporeTetrahedralMesh *mesh, const SporeBvh *surface, const double *points, size_t count,
                           double tolerance, double least, const SporeProgress *progress, SporeError *error) {
  SporeStars stars = {0};
  SporeTriangleMesh boundary = {.vertex_count = mesh->vertex_count, .vertices = mesh->vertices};
  size_t bytes = 3 * mesh->vertex_count * sizeof(double);
  double *best = SPORE_NEW_ARRAY(double, 3 * mesh->vertex_count), best_distance = HUGE_VAL;
  Far *far = SPORE_NEW_ARRAY(Far, count);
  bool *pulled = SPORE_NEW_ARRAY(bool, mesh->vertex_count);
  bool done =
      (best && far && pulled && spore_tetrahedral_mesh_boundary(mesh, &boundary.triangles, &boundary.triangle_count)) ||
      spore_mesh_no_memory(error);
  done = done && spore_stars_create(&stars, mesh, NULL, error);
  for (int round = 0; done && round < ROUNDS; round++) {
    if (!spore_progress(progress, (double)round / ROUNDS, _("fitting the cells"))) {
      done = spore_error_set(error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
      break;
    }
    size_t far_count;
    SporeBvh *tree = spore_bvh_create(&boundary, error);
    if (!tree) {
      done = false;
      break;
    }
    double most = find_far(&boundary, tree, points, count, tolerance, far, &far_count);
    spore_bvh_free(tree);
    if (most < best_distance) {
      best_distance = most;
      memcpy(best, mesh->vertices, bytes);
    }
    if (!far_count || !pull_all(&stars, surface, points, far, far_count, least, pulled)) break;
    spore_stars_smooth(&stars, NULL, RELAX * least);
  }
  if (best_distance < HUGE_VAL) memcpy(mesh->vertices, best, bytes);
  spore_stars_clear(&stars);
  spore_free(boundary.triangles);
  spore_free(best);
  spore_free(far);
  spore_free(pulled);
  return done;
}
