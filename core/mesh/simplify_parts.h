/* The parts of simplifying. */
#ifndef SPORE_MESH_SIMPLIFY_PARTS_H
#define SPORE_MESH_SIMPLIFY_PARTS_H

#include "core/base/progress.h"
#include "core/math/mat3.h"
#include "core/mesh/shell.h"

/* Sum of weighted squared distances from planes, x' A x + 2 b' x + c, and of the weights. */
typedef struct SporeQuadric {
  SporeMat3 a;
  SporeVec3 b;
  double c, weight;
} SporeQuadric;

static inline double spore_quadric_at(const SporeQuadric *quadric, SporeVec3 x) {
  double value = spore_vec3_dot(x, spore_mat3_apply(quadric->a, x)) + 2 * spore_vec3_dot(quadric->b, x) + quadric->c;
  return value > 0 ? value : 0;
}

/* The worst quality among the triangles around a vertex, those with vertex `except` left out, that become worse when it
 * is moved to x; 1: none does; 0: one turns over. */
double spore_shell_moved_quality(const SporeShell *shell, uint32_t vertex, SporeVec3 x, uint32_t except);

/* Turns edges and moves points along the surface, to widen angles, as long as the quadrics (one a vertex, of the planes
 * that it stands for) say that the surface stays as near as it is. False: cancelled. */
bool spore_shell_improve(SporeShell *shell, const SporeQuadric *quadric, const SporeProgress *progress,
                         SporeError *error);

#endif
