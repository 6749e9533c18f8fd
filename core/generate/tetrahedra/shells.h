/* The pieces of a surface: triangles that hang together by edges and are of one part of the file. */
#ifndef SPORE_GENERATE_TETRAHEDRA_SHELLS_H
#define SPORE_GENERATE_TETRAHEDRA_SHELLS_H

#include "core/mesh/bvh.h"

#define SPORE_PIECE_SAMPLES 200 /* points of a piece, spread evenly over its area */
#define SPORE_PIECE_NONE UINT32_MAX

typedef struct SporePiece {
  uint32_t part; /* of the file; 0 where no parts are given */
  size_t triangles;
  size_t holes, open_edges;  /* edges that one triangle of the whole mesh has, and how many rims they form */
  double lower[3], upper[3]; /* of its box */
  double area, volume;       /* volume: signed, meaningful where the piece is closed */
  bool closed;               /* by itself: no edge is one of an odd number of its triangles */
} SporePiece;

typedef struct SporePieces {
  size_t count;
  SporePiece *pieces; /* count */
  uint32_t *of;       /* triangle_count of the mesh: the piece of each triangle */
} SporePieces;

/* parts: of each triangle the part of the file (NULL: of one). Pieces are counted in the order of their first
 * triangles. The caller clears *pieces. False: no memory; *pieces is then empty. */
bool spore_pieces_find(SporePieces *pieces, const SporeTriangleMesh *mesh, const uint32_t *parts, SporeError *error);
void spore_pieces_clear(SporePieces *pieces);

/* A piece by itself. */
typedef struct SporePieceShell {
  SporeBvh *tree; /* of its triangles */
  double points[3 * SPORE_PIECE_SAMPLES];
  SporeVec3 normals[SPORE_PIECE_SAMPLES]; /* unit */
} SporePieceShell;
/* The caller clears *shell. False: no memory. */
bool spore_piece_shell(SporePieceShell *shell, const SporeTriangleMesh *mesh, const SporePieces *pieces, size_t piece,
                       SporeError *error);
void spore_piece_shell_clear(SporePieceShell *shell);

/* How many of the points of one piece lie where the winding number of the other one is over one half. */
size_t spore_piece_points_in(const SporePieceShell *shell, const SporePieceShell *other);
/* Whether the box of one piece lies in the box of the other. */
bool spore_piece_fits(const SporePiece *piece, const SporePiece *other);

#endif
