/* Distance, nearest point and winding number of a triangle mesh. */
#ifndef SPORE_MESH_BVH_H
#define SPORE_MESH_BVH_H

#include "core/mesh/mesh.h"

/* A hierarchy of boxes around the triangles of a mesh; opaque. */
typedef struct SporeBvh SporeBvh;

/* Copies what it needs of a valid mesh. NULL: no memory. */
SporeBvh *spore_bvh_create(const SporeTriangleMesh *mesh, SporeError *error);
/* Frees the hierarchy; NULL is allowed. */
void spore_bvh_free(SporeBvh *bvh);

/* Point of a triangle (3 x 3) nearest to p. */
SporeVec3 spore_triangle_nearest(SporeVec3 p, const double *corners);
/* Distance (m) from p to the surface, exact; *nearest and *triangle may be NULL. */
double spore_bvh_distance(const SporeBvh *bvh, SporeVec3 p, SporeVec3 *nearest, uint32_t *triangle);
/* The same distance, to the bit, sooner. *nearest: a place of the surface that may be near; becomes the nearest. */
double spore_bvh_distance_beside(const SporeBvh *bvh, SporeVec3 p, SporeVec3 *nearest);
/* Generalised winding number (about 1 inside, 0 outside), near triangles exactly, far ones by their
 * first two moments, which errs by up to about 0.03 a shell (Barill et al. 2018, "Fast winding numbers for soups and
 * clouds"). */
double spore_bvh_winding(const SporeBvh *bvh, SporeVec3 p);
/* Whether the winding number is over 0.5. Where each edge is passed as often one way as the other, the number is whole,
 * and this is exact and several times as fast as the number. */
bool spore_bvh_inside(const SporeBvh *bvh, SporeVec3 p);
/* Depth: distance where the winding number is over 0.5, minus distance elsewhere. */
double spore_bvh_depth(const SporeBvh *bvh, SporeVec3 p);
/* A place whose depth is known: all that is nearer to it than the surface lies on its side, and the surface is no
 * farther from anywhere than that of it which is nearest to the place. */
typedef struct SporeBvhKnown {
  SporeVec3 place, nearest;
  double depth; /* below 0 outside; 0 where nothing is known */
} SporeBvhKnown;
/* The same depth, to the bit, sooner by what is known beside: without the winding number where that tells the side. */
SporeBvhKnown spore_bvh_depth_beside(const SporeBvh *bvh, SporeVec3 p, const SporeBvhKnown *known);
/* First hit of the ray p + t d, t >= 0; false: none. */
bool spore_bvh_ray(const SporeBvh *bvh, SporeVec3 p, SporeVec3 d, double *t, uint32_t *triangle);

#endif
