/* A surface made of fewer triangles, so well shaped that it can be the mesh of a net. */
#ifndef SPORE_MESH_SIMPLIFY_H
#define SPORE_MESH_SIMPLIFY_H

#include "core/base/progress.h"
#include "core/mesh/depth_cells.h"
#include "core/mesh/mesh.h"

typedef struct SporeSimplifyOptions {
  size_t vertices;   /* as many at most; 0: see size */
  double size;       /* m: mean length of edges wanted; where vertices is 0 */
  double keep_angle; /* rad: edges at which the surface turns more are creases, and corners of outlines that turn more
                        stay; above pi: none; 0: SPORE_SIMPLIFY_KEEP_ANGLE */
} SporeSimplifyOptions;
#define SPORE_SIMPLIFY_KEEP_ANGLE 1.0471975511965976 /* 60 degrees */

typedef struct SporeSimplifyReport {
  size_t creases;      /* edges sharper than keep_angle */
  bool creases_kept;   /* false: so few vertices come nearer to the surface without; kept are the open edges alone */
  bool reached;        /* false: fewer vertices would change what the surface hangs together like */
  size_t locked_edges; /* where more than two triangles meet: stay as they are */
  size_t crossings_before, crossings; /* pairs of triangles that go through each other, of the given surface and now */
} SporeSimplifyReport;

/* Collapses edges, the cheapest first, by the squared distance from the planes around (Garland and Heckbert 1997) at
 * the volume below as it was (Lindstrom and Turk 1998), with a share for the length, so that triangles are alike where
 * the surface is plain. Open edges and creases give up points along themselves only; each piece stays in one piece with
 * its holes and handles; no triangle turns over. Then edges are turned and points moved along the surface where that
 * makes the narrowest angle wider. Valid mesh; the result is a new one, oriented as it was. The same mesh gives the
 * same result. No collapse makes what went through nothing go
 * through something, unless so few vertices cannot be had otherwise. False: no
 * memory, or cancelled. */
bool spore_triangle_mesh_simplify(const SporeTriangleMesh *mesh, const SporeSimplifyOptions *options,
                                  SporeTriangleMesh *result, SporeSimplifyReport *report, const SporeProgress *progress,
                                  SporeError *error);

/* The surface that is meant lies at a depth (m) in another; how far (m) off it triangles may come to be where they were
 * not so far before, at points `spacing` (m) apart. */
typedef struct SporeSurfaceLimit {
  SporeDepthCells *cells; /* of the other */
  double depth, most, spacing;
  double (*off)(void *data, SporeVec3 place); /* where there is one, it says how far off a place is, and there is no
                                                 other surface */
  void *data;
} SporeSurfaceLimit;
/* The same of a closed surface with as few vertices as the limit allows: *mesh is replaced. Nothing that goes through
 * nothing goes through something then. False: no memory, or cancelled; *mesh is as it was. */
bool spore_triangle_mesh_thin(SporeTriangleMesh *mesh, const SporeSurfaceLimit *limit, const SporeProgress *progress,
                              SporeError *error);

/* Of the angles of all triangles, degrees: the least, and the mean of each one's least. */
void spore_triangle_mesh_angles(const SporeTriangleMesh *mesh, double *least, double *mean);

#endif
