/* Tetrahedra in a surface: by CGAL in a helper process, or by a lattice of SPORE where CGAL fails. */
#ifndef SPORE_GENERATE_TETRAHEDRA_TETRAHEDRA_H
#define SPORE_GENERATE_TETRAHEDRA_TETRAHEDRA_H

#include <glib.h>

#include "core/generate/common/common.h"
#include "core/scene/error.h"

/* In the order in which they are tried. */
typedef enum SporeTetrahedraMethod {
  SPORE_TETRAHEDRA_DIRECT,   /* the surface as it is: closed, oriented, free of self-intersections */
  SPORE_TETRAHEDRA_REPAIRED, /* stitched, oriented consistently, holes filled, self-intersections removed */
  SPORE_TETRAHEDRA_WRAPPED,  /* another surface that wraps the given one closely */
  SPORE_TETRAHEDRA_VOXELS,   /* a lattice of tetrahedra, cut at the surface; needs no CGAL */
  SPORE_TETRAHEDRA_METHODS,  /* tries all of the above; the first that works is used */
} SporeTetrahedraMethod;
/* SPORE_TETRAHEDRA_METHODS names, then NULL: "direct", "repaired", "wrapped", "voxels". */
extern const char *const spore_tetrahedra_method_names[];

#define SPORE_TETRAHEDRA_CELLS 5000000u /* at most */

/* The usual choice: method SPORE_TETRAHEDRA_METHODS, cells or size set, all else zero. */
typedef struct SporeTetrahedraOptions {
  SporeTetrahedraMethod method; /* SPORE_TETRAHEDRA_METHODS: the first that works */
  size_t cells;                 /* approximate number wanted; 0: `size` is used instead */
  double size;                  /* edge length, m, when cells is 0 */
  double tolerance; /* wanted distance to the surface, of the diagonal; with `cells`, the cells are refined where the
                       distance is larger; 0: 0.01 */
  double curvature; /* degrees, 0 (off) or 5 to 90: the largest turn of the surface along one edge; edges are shortened
                       for this down to a quarter of the usual size */
  bool fill;        /* cavities inside are filled */
  double gap;       /* m: openings narrower than this are closed by wrapping; 0: wrapping uses about half an edge */
  const SporeGenerateRegion *regions;
  size_t region_count;
} SporeTetrahedraOptions;

typedef struct SporeTetrahedraReport {
  SporeTetrahedraMethod method;
  char refused[SPORE_TETRAHEDRA_METHODS][320]; /* why each earlier method was refused; empty: not tried */
  SporeTetrahedraQuality quality;
  double hausdorff;      /* between the mesh and the bounds of the given solid, sampled both ways, of the diagonal */
  double inner_distance; /* largest distance from the mesh to parts of the given surface inside the solid, of the
                            diagonal; 0: no such part */
  double inner_share;    /* share of the surface that lies inside the solid; the solid is filled there */
  double thickened, widened; /* shares of the surface, by VOXELS: at walls, and at slits, that the cells had missed; the
                                mesh makes these about `thickness` wide */
  double thickness;          /* m; 0: nothing was missed */
  double volume, volume_given,
      volume_change; /* m^3, m^3, fraction; given: of the solid, where the winding number is over one half */
  double area, area_given, area_change; /* of the boundaries, m^2, m^2, fraction */
  size_t pieces, pieces_given; /* connected pieces: of the cells, by shared vertices; of the surface, by shared edges */
  double small_components; /* share of the volume: small pieces left out, whose piece of the surface has a larger piece
                              of cells */
  double filled;           /* m^3, with options.fill: volume of the filled cavities */
  double seconds;
} SporeTetrahedraReport;

/* Uses the first method that works and reports which one. The solid is where the winding number is over one half. The
 * caller clears *result; after a failure *result is empty. Error messages name `place`. */
gboolean spore_tetrahedra_from_mesh(const char *place, const SporeTriangleMesh *mesh,
                                    const SporeTetrahedraOptions *options, SporeTetrahedralMesh *result,
                                    SporeTetrahedraReport *report, const SporeProgress *progress, GError **error);

/* Remarks for the user on generated tetrahedra: which parts of the surface are missing, which requests were not met,
 * and what to do. The command line and the editor share this wording. */

/* In the user's language; each line ends in a newline; empty: no remarks. g_free. */
char *spore_tetrahedra_remarks(const SporeTetrahedralMesh *mesh, const SporeTetrahedraOptions *options,
                               const SporeTetrahedraReport *report);

#endif
