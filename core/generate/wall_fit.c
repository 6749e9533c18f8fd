#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/wall.h"
#include "core/generate/wall_parts.h"
#include "core/math/mat3.h"
#include "core/mesh/common.h"
#include "core/mesh/crossings.h"

#define ROUNDS 2
#define WEAK 0.05      /* of the largest eigenvalue: directions in which planes say nothing of a vertex */
#define FARTHEST 0.5   /* of the lattice's step, that a vertex moves in a round */
#define LEAST_TURN 0.5 /* cosine by which a triangle may turn */
#define REPAIRS 4

/* What pulls at a vertex: planes as far below the outer surface as the wall is thick. */
typedef struct Pull {
  SporeMat3 square;
  SporeVec3 slope;
} Pull;

typedef struct Fit {
  const SporeBvh *bvh;
  double thickness, step;
  SporeTriangleMesh *inner;
  Pull *pulls;
  double *before; /* vertices, as they came */
  bool *back;     /* vertices that go back */
  bool *crossing;
} Fit;

static SporeVec3 vertex(const Fit *fit, uint32_t v) { return spore_mesh_vertex(fit->inner->vertices, v); }

/* The plane below the place of the outer surface that is nearest to p. */
static void pull(Fit *fit, SporeVec3 p, double weight, const uint32_t *vertices, size_t count) {
  SporeVec3 foot;
  spore_bvh_distance(fit->bvh, p, &foot, NULL);
  SporeVec3 normal = spore_vec3_normalise(spore_vec3_sub(p, foot), spore_vec3(0, 0, 0));
  for (size_t k = 0; k < count; k++) {
    Pull *its = &fit->pulls[vertices[k]];
    double off = fit->thickness - spore_vec3_dot(normal, spore_vec3_sub(vertex(fit, vertices[k]), foot));
    its->square = spore_mat3_add(its->square, spore_mat3_scale(weight, spore_mat3_outer(normal, normal)));
    its->slope = spore_vec3_add_scaled(its->slope, weight * off, normal);
  }
}

static void gather(Fit *fit) {
  memset(fit->pulls, 0, fit->inner->vertex_count * sizeof *fit->pulls);
  for (size_t t = 0; t < fit->inner->triangle_count; t++) {
    const uint32_t *n = fit->inner->triangles + 3 * t;
    SporeVec3 a = vertex(fit, n[0]), b = vertex(fit, n[1]), c = vertex(fit, n[2]);
    SporeVec3 middle = spore_vec3_scale(1. / 3, spore_vec3_add(a, spore_vec3_add(b, c)));
    pull(fit, middle, spore_vec3_length(spore_mesh_area_vector(a, b, c)), n, 3);
  }
}

/* Least squares of the planes, the least move. */
static SporeVec3 move_of(const Fit *fit, const Pull *its) {
  SporeMat3 axes;
  SporeVec3 move = {0, 0, 0};
  double value[3];
  spore_mat3_eigen_symmetric(its->square, value, &axes);
  for (int k = 0; k < 3; k++) {
    SporeVec3 axis = spore_mat3_column(axes, k);
    if (value[k] > WEAK * value[2] && value[k] > 0)
      move = spore_vec3_add_scaled(move, spore_vec3_dot(axis, its->slope) / value[k], axis);
  }
  double length = spore_vec3_length(move), most = FARTHEST * fit->step;
  return length > most ? spore_vec3_scale(most / length, move) : move;
}

static bool put_back(Fit *fit) {
  bool any = false;
  for (size_t v = 0; v < fit->inner->vertex_count; v++) {
    if (!fit->back[v]) continue;
    memcpy(fit->inner->vertices + 3 * v, fit->before + 3 * v, 3 * sizeof(double));
    fit->back[v] = false;
    any = true;
  }
  return any;
}

/* Corners of triangles that turned too far go back. */
static bool undo_turned(Fit *fit) {
  for (size_t t = 0; t < fit->inner->triangle_count; t++) {
    const uint32_t *n = fit->inner->triangles + 3 * t;
    SporeVec3 now = spore_mesh_area_vector(vertex(fit, n[0]), vertex(fit, n[1]), vertex(fit, n[2]));
    SporeVec3 was = spore_mesh_area_vector(spore_mesh_vertex(fit->before, n[0]), spore_mesh_vertex(fit->before, n[1]),
                                           spore_mesh_vertex(fit->before, n[2]));
    if (spore_vec3_dot(now, was) >= LEAST_TURN * spore_vec3_length(now) * spore_vec3_length(was)) continue;
    for (size_t k = 0; k < 3; k++)
      fit->back[n[k]] = memcmp(fit->inner->vertices + 3 * (size_t)n[k], fit->before + 3 * (size_t)n[k], 24) != 0;
  }
  return put_back(fit);
}

/* Of triangles that go through others, too; *clean: none does any more. */
static bool undo_crossing(Fit *fit, bool *clean) {
  size_t count;
  if (!spore_triangle_mesh_crossings(fit->inner, &count, fit->crossing)) return false;
  *clean = count == 0;
  for (size_t t = 0; t < fit->inner->triangle_count; t++)
    for (size_t k = 0; fit->crossing[t] && k < 3; k++) fit->back[fit->inner->triangles[3 * t + k]] = true;
  put_back(fit);
  return true;
}

static void fit_once(Fit *fit) {
  gather(fit);
  for (size_t v = 0; v < fit->inner->vertex_count; v++)
    spore_vec3_store(fit->inner->vertices + 3 * v,
                     spore_vec3_add(vertex(fit, (uint32_t)v), move_of(fit, &fit->pulls[v])));
  for (int repair = 0; repair < REPAIRS && undo_turned(fit);) repair++;
}

static bool repair_crossings(Fit *fit) {
  bool clean = false;
  for (int repair = 0; repair < REPAIRS && !clean; repair++)
    if (!undo_crossing(fit, &clean)) return false;
  if (!clean) memcpy(fit->inner->vertices, fit->before, 3 * fit->inner->vertex_count * sizeof(double));
  return true;
}

bool spore_wall_fit(const SporeBvh *bvh, double thickness, double step, SporeTriangleMesh *inner) {
  Fit fit = {bvh, thickness, step, inner};
  fit.pulls = SPORE_NEW_ARRAY(Pull, inner->vertex_count);
  fit.before = SPORE_NEW_ARRAY(double, 3 * inner->vertex_count);
  fit.back = SPORE_NEW_ARRAY(bool, inner->vertex_count);
  fit.crossing = SPORE_NEW_ARRAY(bool, inner->triangle_count);
  bool made = fit.pulls && fit.before && fit.back && fit.crossing;
  if (made) memcpy(fit.before, inner->vertices, 3 * inner->vertex_count * sizeof(double));
  for (int round = 0; made && round < ROUNDS; round++) fit_once(&fit);
  made = made && repair_crossings(&fit);
  spore_free(fit.pulls);
  spore_free(fit.before);
  spore_free(fit.back);
  spore_free(fit.crossing);
  return made;
}
