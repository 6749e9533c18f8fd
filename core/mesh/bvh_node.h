/* Inside of the bounding volume hierarchy, shared by its construction and its queries. */
#ifndef SPORE_MESH_BVH_NODE_H
#define SPORE_MESH_BVH_NODE_H

#include "core/mesh/bvh.h"

#define SPORE_BVH_LEAF 4   /* triangles a leaf, at most */
#define SPORE_BVH_DEPTH 96 /* of the tree, at most */

/* Nodes lie in depth-first order: the left child of node i is i + 1. */
typedef struct SporeBvhNode {
  double lower[3], upper[3];
  uint32_t first; /* leaf: first triangle; else: right child */
  uint32_t count; /* leaf: triangles; else 0 */
} SporeBvhNode;

/* The moments of a node's triangles, which replace the triangles for a far point. */
typedef struct SporeBvhMoment {
  SporeVec3 centre;   /* area-weighted */
  double far_squared; /* beyond this squared distance from the centre the expansion holds */
  SporeVec3 dipole;   /* sum of area vectors, m^2 */
  double first[9];    /* sum of (centroid - centre) x area vector, row: position, column: area; m^3 */
} SporeBvhMoment;

struct SporeBvh {
  SporeBvhNode *nodes;
  SporeBvhMoment *moments;
  double *corners;     /* triangle_count x 9, in the order of the leaves */
  uint32_t *triangles; /* triangle_count: number in the mesh */
  size_t node_count, triangle_count;
  bool closed; /* every edge of a triangle is passed as often one way as the other */
};

/* Whether the triangles, by the places of their corners, enclose: the winding number is then whole everywhere off them.
 */
bool spore_bvh_is_closed(const SporeBvh *bvh);

/* As spore_bvh_distance, but no more than `below` (m): a search for farther points is cut off. */
double spore_bvh_distance_below(const SporeBvh *bvh, SporeVec3 p, double below, SporeVec3 *nearest, uint32_t *triangle);

typedef struct SporeBvhNear {
  double distance; /* m */
  uint32_t place;  /* of the triangle, in the order of the leaves */
} SporeBvhNear;
/* Triangles no farther from p than `within` (m), and how many there are. Above `most` the search ends: most + 1. */
size_t spore_bvh_near(const SporeBvh *bvh, SporeVec3 p, double within, SporeBvhNear *near, size_t most);

#endif
