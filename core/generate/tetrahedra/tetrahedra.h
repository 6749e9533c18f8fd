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
#define SPORE_TETRAHEDRA_PIECES 64      /* pieces of the surface of which a report tells, at most */

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
  bool hollow;      /* a closed piece inside another one bounds a cavity; else what it encloses is solid */
  bool largest;     /* the piece of the largest area is meshed, with what lies inside it; else all are, as one solid */
  bool apart; /* each piece gets cells of its own, with shared faces where pieces touch: result->labels has 1 + the
                 piece of the report of each cell. Where pieces overlap, the one of the least area has the place.
                 Pieces too thin for the number of cells are merged until it is met, the costliest first.
                 By a lattice; not with curvature, a gap, regions or another method */
  double gap; /* m: openings narrower than this are closed by wrapping; 0: wrapping uses about half an edge */
  const SporeGenerateRegion *regions;
  size_t region_count;
  const uint32_t *parts;         /* of each triangle the part of its file; NULL: of one */
  const char *const *part_names; /* of each part; NULL: they have none */
} SporeTetrahedraOptions;

/* What a piece of the surface is to the solid, at SPORE_PIECE_SAMPLES points of it. */
typedef enum SporePieceRole {
  SPORE_PIECE_BOUNDS, /* it bounds the solid */
  SPORE_PIECE_MERGED, /* more than a fiftieth of it bounds the solid, and more than a fiftieth lies inside */
  SPORE_PIECE_INSIDE, /* it lies inside the solid: a second wall, or a part inside another one; it is left out */
  SPORE_PIECE_CAVITY, /* closed and turned inward: it bounds a cavity */
  SPORE_PIECE_SHEET,  /* there is no solid on either side of more than half of it */
} SporePieceRole;
/* "bounds", "merged", "inside", "cavity", "sheet", then NULL. */
extern const char *const spore_piece_role_names[];

/* A piece that lies wholly inside another one and has no cells of its own: which kind of wall it is there. */
typedef enum SporePieceWall {
  SPORE_WALL_NONE,    /* it lies in none, or has cells of its own, or bounds a cavity that `hollow` asked for */
  SPORE_WALL_OPEN,    /* a tube or sheet with holes: the solid is on both sides of it */
  SPORE_WALL_LUMEN,   /* the same, turned inward: what it holds is cut out of the solid */
  SPORE_WALL_DOUBLED, /* closed, nowhere farther from the wall around it than a tenth of its own least extent */
  SPORE_WALL_CLOSED,  /* closed, farther from the wall around it: a chamber, or a part of the organ */
  SPORE_WALL_TURNED,  /* closed and turned inside out: it bounds a cavity that `hollow` did not ask for */
} SporePieceWall;
/* "none", "open", "lumen", "doubled", "closed", "turned", then NULL. */
extern const char *const spore_piece_wall_names[];

/* Triangles that hang together by edges and are of one part of the file. */
typedef struct SporeTetrahedraPiece {
  char name[48]; /* of its part; "": it has none */
  SporePieceRole role;
  SporePieceWall wall;
  int in; /* piece of the report in which most of what lies inside does, or that holds a lumen; -1: none of the report
           */
  size_t triangles, holes, open_edges;
  double size[3], area; /* m along the axes, m^2 */
  double inside_share;  /* share of the area that lies inside the solid */
  double depth[2];      /* least and largest distance from the surface of the piece `in`, m, of what lies inside */
  bool parted;          /* with options.apart: the piece is to have cells of its own */
  size_t cells;         /* that it has; a piece too thin for the cells has none */
  double thickness;     /* m, with options.apart: about 4 volume / area, of its place in the first lattice, or, where it
                           has none there, of what it encloses; 0: unknown */
  int merged;           /* with options.apart: piece that its cells went to, as it is too thin; -1: none */
} SporeTetrahedraPiece;

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
  size_t unwanted;             /* pieces that were left out by options.largest */
  size_t shared_faces;         /* with options.apart: between cells of two pieces */
  double border_lost;          /* share of the surfaces between these pieces where a piece is too thin for a border */
  double border_distance;      /* largest distance of the rest of these surfaces from the faces shared there, of the
                                  diagonal */
  size_t piece_count, piece_total;                     /* told of (those of the largest area), and all */
  SporeTetrahedraPiece piece[SPORE_TETRAHEDRA_PIECES]; /* piece_count, the largest area first */
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
