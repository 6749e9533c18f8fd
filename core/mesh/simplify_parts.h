/* The parts of simplifying. */
#ifndef SPORE_MESH_SIMPLIFY_PARTS_H
#define SPORE_MESH_SIMPLIFY_PARTS_H

#include "core/base/progress.h"
#include "core/math/mat3.h"
#include "core/mesh/shell.h"
#include "core/mesh/simplify.h"

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

/* A triangle near others: what is asked of it most often, together. */
typedef struct SporeNearTriangle {
  float lower[3], upper[3]; /* a box around it, rounded away from it */
  uint32_t seen;            /* the last look into a cell that met it */
  bool gone;
} SporeNearTriangle;

/* Triangles of a shell by the cells of a grid that they reach into, so that those near another are found. */
typedef struct SporeShellNeighbours {
  size_t side;    /* cells a side, over the shell's box */
  uint32_t *head; /* first entry of each cell */
  size_t count, capacity;
  uint32_t *entries; /* triangle, next entry: also those of before a triangle moved, or went */
  SporeNearTriangle *triangles;
  uint32_t asked; /* looks into cells so far */
} SporeShellNeighbours;

/* edge: length of an edge, as of most of the work. Clear it in either case. False: no memory. */
bool spore_shell_neighbours_create(SporeShellNeighbours *near, const SporeShell *shell, double edge);
void spore_shell_neighbours_clear(SporeShellNeighbours *near);
/* The triangles at the edge a b, which is to be collapsed. */
void spore_shell_neighbours_drop(SporeShellNeighbours *near, const SporeShell *shell, uint32_t a, uint32_t b);
/* A triangle that moved. */
bool spore_shell_neighbours_add(SporeShellNeighbours *near, const SporeShell *shell, uint32_t triangle);
/* Whether triangles around the edge a b would go through others once it is collapsed to x, and go through none now. */
bool spore_shell_would_cross(SporeShellNeighbours *near, const SporeShell *shell, uint32_t a, uint32_t b, SporeVec3 x);
/* The same of a vertex that is moved to x, and of a new triangle. */
bool spore_shell_move_crosses(SporeShellNeighbours *near, const SporeShell *shell, uint32_t vertex, SporeVec3 x);
bool spore_shell_triangle_crosses(SporeShellNeighbours *near, const SporeShell *shell, const uint32_t corner[3]);
/* All triangles around a vertex. */
bool spore_shell_neighbours_add_ring(SporeShellNeighbours *near, const SporeShell *shell, uint32_t vertex);

/* A limit, with what was seen on the way. */
typedef struct SporeShellLimit {
  const SporeSurfaceLimit *limit;
  SporeBvhKnown *vertex; /* where each is; depth 0: not looked at */
  double *off;           /* m, of each triangle, 0 within the limit; below 0: not looked at */
  SporeBvhKnown last;    /* where the last edge asked about would go */
} SporeShellLimit;

/* Whether the triangles around the edge a b, once it is collapsed to x, are as near as a limit asks for, or no farther
 * off than they are. */
bool spore_shell_limit_allows(SporeShellLimit *work, const SporeShell *shell, uint32_t a, uint32_t b, SporeVec3 x);
/* After the edge last asked about has become this vertex. */
void spore_shell_limit_moved(const SporeShellLimit *work, const SporeShell *shell, uint32_t vertex);
/* False: no memory. */
bool spore_shell_limit_create(SporeShellLimit *work, const SporeShell *shell, const SporeSurfaceLimit *limit);
void spore_shell_limit_clear(SporeShellLimit *work);

/* Collapses edges of a shell whose features are found, down to so many vertices, and betters it; limit: as few as it
 * allows, no better; NULL: none. False: no memory, or cancelled. */
bool spore_shell_collapse_to(SporeShell *shell, size_t vertices, const SporeSurfaceLimit *limit,
                             const SporeProgress *progress, SporeError *error);
/* Turns edges and moves points along the surface, to widen angles, as long as the quadrics (one a vertex, of the planes
 * that it stands for) say that the surface stays as near as it is, and
 * nothing goes through what it did not. near: of the shell now. False: cancelled, or no memory. */
bool spore_shell_improve(SporeShell *shell, const SporeQuadric *quadric, SporeShellNeighbours *near,
                         const SporeProgress *progress, SporeError *error);

/* Moves points, but those of features, so that the largest distance to the original and back gets smaller, as long as
 * triangles are well shaped and nothing goes through what it did not. False: cancelled, or no memory. */
bool spore_shell_fit(SporeShell *shell, const SporeTriangleMesh *original, const SporeProgress *progress,
                     SporeError *error);

#endif
