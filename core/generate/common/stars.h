/* The cells around each vertex of a tetrahedral mesh, for operations that change the mesh in place. */
#ifndef SPORE_GENERATE_COMMON_STARS_H
#define SPORE_GENERATE_COMMON_STARS_H

#include "core/mesh/bvh.h"

typedef struct SporeStars {
  SporeTetrahedralMesh *mesh;
  const uint32_t *labels; /* of cells, or NULL */
  size_t *first;          /* vertex_count + 1: into cells */
  uint32_t *cells;
  double *quality; /* of cells, see spore_tetrahedron_quality */
  bool *outer;     /* of vertices: on the boundary, or between labels */
} SporeStars;

/* Valid until the mesh's cells change. */
bool spore_stars_create(SporeStars *stars, SporeTetrahedralMesh *mesh, const uint32_t *labels, SporeError *error);
void spore_stars_clear(SporeStars *stars);
/* Least quality of the cells around v with v at p; the search may stop at a value below `floor`. */
double spore_stars_quality_at(const SporeStars *stars, uint32_t v, SporeVec3 p, double floor);
/* Moves v to p and updates the quality of its cells. */
void spore_stars_move(SporeStars *stars, uint32_t v, SporeVec3 p);
/* Mean length of the edges from v in its cells. */
double spore_stars_edge(const SporeStars *stars, uint32_t v);

/* Moves vertices of cells below `goal` to where the worst cell around them is best. Vertices of the boundary move on
 * `surface`, or not at all if it is NULL. Returns the number of moves. */
long spore_stars_smooth(SporeStars *stars, const SporeBvh *surface, double goal);
/* Flips edges and faces of cells below `goal` and drops slivers of the boundary; returns the number of changes. If
 * there are any, the stars are no longer valid. -1: no memory. */
long spore_stars_flip(SporeStars *stars, uint32_t **labels, double goal, SporeError *error);

#endif
