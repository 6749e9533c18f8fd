/* A surface while it is edited: triangles around each vertex as a list, and which edges are features. Coordinates are
 * those of the mesh about the middle of its box, over the box's diagonal. */
#ifndef SPORE_MESH_SHELL_H
#define SPORE_MESH_SHELL_H

#include "core/mesh/mesh.h"

#define SPORE_SHELL_NONE UINT32_MAX

typedef enum SporeShellKind {
  SPORE_SHELL_SMOOTH, /* no feature edge: may go anywhere on the surface */
  SPORE_SHELL_LINE,   /* on a line of feature edges: may go along it */
  SPORE_SHELL_CORNER  /* stays */
} SporeShellKind;

typedef struct SporeShell {
  size_t vertex_count, triangle_count; /* as at the start; gone ones are left in */
  size_t live;                         /* vertices that some triangle has */
  double *x;                           /* 3 a vertex */
  uint32_t *corner;                    /* 3 a triangle; SPORE_SHELL_NONE in the first: gone */
  uint32_t *head, *next;               /* of a vertex, of a corner: lists of the corners at each vertex */
  uint8_t *kind;                       /* SporeShellKind of each vertex */
  bool *feature;                       /* of the side from a corner to the next; an edge is one where any side is */
  uint32_t *mark;                      /* scratch, for spore_shell_mark */
  uint32_t marked;
  double middle[3], diagonal; /* m: to go back by */
} SporeShell;

/* Valid mesh with some extent. Everything is smooth. False: no memory. */
bool spore_shell_create(SporeShell *shell, const SporeTriangleMesh *mesh);
void spore_shell_clear(SporeShell *shell);
/* As a mesh, without what is gone. */
bool spore_shell_mesh(const SporeShell *shell, SporeTriangleMesh *mesh, SporeError *error);

typedef struct SporeShellFeatures {
  size_t creases, locked; /* edges */
} SporeShellFeatures;
/* Marks open edges, those where more than two triangles meet, and those that turn more than `angle` (rad). */
bool spore_shell_find_features(SporeShell *shell, double angle, SporeShellFeatures *features);

static inline uint32_t spore_shell_after(uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
static inline uint32_t spore_shell_before(uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }
static inline SporeVec3 spore_shell_at(const SporeShell *shell, uint32_t vertex) {
  return spore_vec3_load(shell->x + 3 * (size_t)vertex);
}
/* Twice the area along the normal. */
SporeVec3 spore_shell_normal(const SporeShell *shell, uint32_t triangle);
/* 4 sqrt 3 area over the sum of the squared sides: 1 of an equilateral triangle. */
double spore_shell_quality(SporeVec3 a, SporeVec3 b, SporeVec3 c);
/* The worst quality among the triangles around a vertex, those with vertex `except` left out, that become worse when it
 * is moved to x; 1: none does; 0: one turns over. */
double spore_shell_moved_quality(const SporeShell *shell, uint32_t vertex, SporeVec3 x, uint32_t except);

/* Triangles that have both vertices: up to two corners at a, each in one of them; how many there are. */
size_t spore_shell_between(const SporeShell *shell, uint32_t a, uint32_t b, uint32_t corners[2]);
bool spore_shell_is_feature(const SporeShell *shell, uint32_t a, uint32_t b);
/* How many triangles have the vertex. */
size_t spore_shell_count(const SporeShell *shell, uint32_t vertex);
/* Puts a new mark on the neighbours of a vertex; returns it. */
uint32_t spore_shell_mark(SporeShell *shell, uint32_t vertex);

/* b becomes a, at x; triangles that had both are gone. */
void spore_shell_collapse(SporeShell *shell, uint32_t a, uint32_t b, SporeVec3 x);
/* The two triangles (a, b, c), (b, a, d) of an edge become (c, d, b), (d, c, a). corners: those at a. */
void spore_shell_flip(SporeShell *shell, const uint32_t corners[2]);

#endif
