/* Tetrahedra in a surface: by CGAL in a helper process, by a lattice of our own where that cannot. */
#ifndef SPORE_GENERATE_TETRAHEDRA_TETRAHEDRA_H
#define SPORE_GENERATE_TETRAHEDRA_TETRAHEDRA_H

#include <glib.h>

#include "core/generate/common/common.h"
#include "core/scene/error.h"

/* In the order in which they are tried. */
typedef enum SporeTetrahedraMethod {
  SPORE_TETRAHEDRA_DIRECT,   /* the surface as it is: closed, oriented, free of self-intersections */
  SPORE_TETRAHEDRA_REPAIRED, /* stitched, turned alike, holes filled, self-intersections removed */
  SPORE_TETRAHEDRA_WRAPPED,  /* another surface closely around it */
  SPORE_TETRAHEDRA_VOXELS,   /* a lattice of tetrahedra, cut at the surface; needs no CGAL */
  SPORE_TETRAHEDRA_METHODS,  /* all of the above, the first that does it */
} SporeTetrahedraMethod;
/* SPORE_TETRAHEDRA_METHODS names, then NULL: "direct", "repaired", "wrapped", "voxels". */
extern const char *const spore_tetrahedra_method_names[];

#define SPORE_TETRAHEDRA_CELLS 5000000u /* at most */

/* All zero but cells or size, and method SPORE_TETRAHEDRA_METHODS, is the usual choice. */
typedef struct SporeTetrahedraOptions {
  SporeTetrahedraMethod method; /* SPORE_TETRAHEDRA_METHODS: the first that does it */
  size_t cells;                 /* wanted, about; > 0, or 0 to go by size */
  double size;                  /* edge length, m, when cells is 0 */
  double tolerance; /* distance to the surface wanted, of the diagonal: with cells, they get finer where it is larger;
                       0: 0.01 */
  double curvature; /* degrees, 0 or 5 to 90: edges shall be so short that the surface turns by no more along them, down
                       to a quarter of the usual size */
  bool fill;        /* cavities inside are filled, and wrapping closes what is narrower than `gap` */
  double gap;       /* m: openings narrower than this are closed by wrapping; 0: half an edge */
  const SporeGenerateRegion *regions;
  size_t region_count;
} SporeTetrahedraOptions;

typedef struct SporeTetrahedraReport {
  SporeTetrahedraMethod method;
  char refused[SPORE_TETRAHEDRA_METHODS][320]; /* why each earlier method did not do; empty: it was not tried */
  SporeTetrahedraQuality quality;
  double hausdorff; /* sampled, both ways, between the mesh and what bounds the given solid, of the diagonal */
  double
      inner_distance; /* the largest from what of the given surface lies inside the solid, of the diagonal; 0: none */
  double inner_share; /* of the surface: what lies inside the solid, which is filled there */
  double thickened, widened; /* of the surface, by VOXELS: walls, and slits, that its cells had missed, and that are
                                about `thickness` wide there */
  double thickness;          /* m; 0: nothing was missed */
  double volume, volume_given,
      volume_change;                    /* m^3, m^3, fraction; given: of the solid, winding number over one half */
  double area, area_given, area_change; /* of what bounds them, m^2, m^2, fraction */
  size_t pieces, pieces_given;          /* that hang together by vertices: of the cells; by edges: of the surface */
  double small_components; /* volume of small pieces that came of one of the surface's, and were left out: share */
  double filled;           /* m^3, with options.fill: of the cavities that were */
  double seconds;
} SporeTetrahedraReport;

/* The first method of the chain that works is used and said. The solid is where the winding number is over one half.
 * *result is the caller's, to be cleared; untouched numbers of it are zero after a failure, whose message names
 * `place`.
 */
gboolean spore_tetrahedra_from_mesh(const char *place, const SporeTriangleMesh *mesh,
                                    const SporeTetrahedraOptions *options, SporeTetrahedralMesh *result,
                                    SporeTetrahedraReport *report, const SporeProgress *progress, GError **error);

/* What a user should know of tetrahedra that were made: what of the surface they do not show, what was asked for and
 * did not come, and what to do about it. One wording for the command line and the editor. */

/* In the user's language, lines that end in a newline each; empty: nothing is to be said. g_free. */
char *spore_tetrahedra_remarks(const SporeTetrahedralMesh *mesh, const SporeTetrahedraOptions *options,
                               const SporeTetrahedraReport *report);

#endif
