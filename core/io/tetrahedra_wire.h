/* What SPORE and its tetrahedra helper say to each other. Native byte order; lengths in diagonals of the surface. */
#ifndef SPORE_IO_TETRAHEDRA_WIRE_H
#define SPORE_IO_TETRAHEDRA_WIRE_H

#include <stdint.h>

typedef enum SporeTetrahedraTask {
  SPORE_TETRAHEDRA_CHECK,  /* the surface as it is, where the mesher can take it */
  SPORE_TETRAHEDRA_REPAIR, /* the surface, repaired */
  SPORE_TETRAHEDRA_WRAP,   /* another surface around it, by alpha wrapping */
  SPORE_TETRAHEDRA_MESH,   /* tetrahedra in a surface that one of the tasks above has returned */
  SPORE_TETRAHEDRA_TASKS
} SporeTetrahedraTask;

/* How a mesh is improved after its refinement; a set of bits. */
typedef enum SporeTetrahedraFinish {
  SPORE_TETRAHEDRA_ROUGH = 0,   /* nothing: to count cells and to measure distances */
  SPORE_TETRAHEDRA_SMOOTH = 1,  /* optimal Delaunay triangulation */
  SPORE_TETRAHEDRA_PERTURB = 2, /* of slivers */
  SPORE_TETRAHEDRA_EXUDE = 4    /* of slivers, by weights */
} SporeTetrahedraFinish;

/* vertex_count x 3 doubles, triangle_count x 3 uint32_t and the sizing's doubles (product of sizing_count, at least 1)
 * follow. */
typedef struct SporeTetrahedraRequest {
  uint64_t task, finish;
  double alpha, offset;   /* of a wrap: see spore_cgal_wrap */
  uint64_t most_vertices; /* of a mesh and of a wrap: a larger result is refused */
  uint64_t sizing_count[3];
  double sizing_lower[3], sizing_spacing;
  uint64_t vertex_count, triangle_count;
} SporeTetrahedraRequest;

/* vertex_count x 3 doubles and cell_count x corners (3: surface, 4: tetrahedra) uint32_t follow. */
typedef struct SporeTetrahedraAnswer {
  uint64_t vertex_count, cell_count, corners;
} SporeTetrahedraAnswer;

#endif
