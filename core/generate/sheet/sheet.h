/* Spline sheets from organs: a patch of a surface between four corners, and the sheet of B-splines nearest to it. */
#ifndef SPORE_GENERATE_SHEET_SHEET_H
#define SPORE_GENERATE_SHEET_SHEET_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"

#define SPORE_SHEET_LEAST_POINTS 6 /* control points each way */
#define SPORE_SHEET_MOST_POINTS 200

typedef struct SporeSheetOptions {
  double corners[4][3];  /* m: on the surface or near it, in turn around the patch */
  bool corners_given;    /* false: the surface is an open sheet, and finds its corners itself */
  double inside[3];      /* m: on the part that becomes the patch */
  bool inside_given;     /* false: the smaller part, or the one that is a disc where only one is */
  size_t control_points; /* along the longer sides, and as many along the others as their length asks for; 0: as few as
                            the tolerance takes */
  double tolerance;      /* m: largest distance between sheet and patch, either way, where control_points is 0 */
  double smoothing;      /* m: as spore_sheet_fit says */
} SporeSheetOptions;

typedef struct SporeSheetReport {
  double corners[4][3];      /* m: where they came to lie on the surface, or where the sheet has found its own */
  double corner_distance[4]; /* m: from there to the given place */
  double side[4];            /* m: length of the side from a corner to the next one; 0 where they were not given */
  bool follows_edge[4];      /* the side runs along an open edge of the surface */
  double area, diagonal;     /* m^2, m: of the patch and of its box */
  size_t control_points[2];  /* along u, the longer sides, and along v */
  double rms[2], largest[2]; /* m: distance from points of the patch to the sheet, and from points of the sheet to the
                                patch; the mean square is by area */
  double area_kept;          /* area of the sheet / area of the patch */
  size_t fold_overs;         /* triangles of the patch over which the sheet faces the other way */
  bool reached;              /* the tolerance; true where the number was given */
  double seconds;
} SporeSheetReport;

/* Cuts the patch out of the surface and measures the sheet that fits it. A side is a shortest path over the surface
 * between two corners, straightened over its faces from the shortest path along edges (as J. Mitchell et al. 1987 say
 * what is a shortest path, and S. Xin and G. Wang 2007 straighten one); or, where both corners lie on the same open
 * edge, the shorter way along that edge. *patch gets the triangles between the sides, each cut where a side crosses it;
 * spore_sheet_parameters by the report's corners gives its parameters. Without corners the patch is the surface.
 * *distance (NULL: not wanted) gets the distance of each vertex of the patch from the sheet, m; from spore_allocate.
 * Refused, in words: corners on different pieces or at the same place; sides that cross or touch each other; a part
 * that is no disc (a hole, a handle) or has no border; a sheet that cannot be laid out. *patch is empty on failure. */
bool spore_sheet_from_mesh(const SporeTriangleMesh *mesh, const SporeSheetOptions *options, SporeTriangleMesh *patch,
                           double **distance, SporeSheetReport *report, const SporeProgress *progress,
                           SporeError *error);

#endif
