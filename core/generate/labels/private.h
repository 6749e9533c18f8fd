/* The steps of spore_label_tetrahedra. */
#ifndef SPORE_GENERATE_LABELS_PRIVATE_H
#define SPORE_GENERATE_LABELS_PRIVATE_H

#include "core/generate/labels/labels.h"
#include "core/generate/common/common.h"

#define SPORE_LABEL_SHARES 4 /* most labels with a share in one voxel */
#define SPORE_LABEL_MOST (8 * SPORE_LABEL_SHARES)

/* The share of one label at a place. */
typedef struct SporeLabelShare {
  uint16_t label; /* 0: nothing, or an unwanted label */
  float share;
} SporeLabelShare;

/* Shares of labels at any place: the voxels' labels, blurred, then interpolated between voxel centres. A voxel's own
 * label keeps the largest share, so that layers of one voxel survive. */
typedef struct SporeLabelField {
  const SporeLabelMap *map;
  const bool *wanted; /* 65536 */
  double inverse[12]; /* from places (m) to indices */
  /* Voxels near a border, row by row of the map. All other voxels have one label only. */
  size_t *row;      /* index of the first voxel of each row; at the end, the count */
  uint32_t *column; /* ascending in a row */
  SporeLabelShare (*shares)[SPORE_LABEL_SHARES];
} SporeLabelField;

bool spore_label_field_create(SporeLabelField *field, const SporeLabelMap *map, const bool *wanted,
                              const SporeProgress *progress, SporeError *error);
void spore_label_field_clear(SporeLabelField *field);
/* The labels at p, each once; returns their number. The shares sum to 1. */
int spore_label_field_shares(const SporeLabelField *field, SporeVec3 p, SporeLabelShare shares[SPORE_LABEL_MOST]);
/* Adds a share to a list that has each label once; returns the new length. */
int spore_label_add(SporeLabelShare *shares, int count, SporeLabelShare one);
/* The winning label: nothing if its share is over one half, else the organ with the largest share (if equal, the larger
 * number). So nothing does not win where organs meet. */
uint16_t spore_label_winner(const SporeLabelShare *shares, int count);

/* False with an error: most of the wanted voxels lie in pieces of fewer voxels than `least`, a cell, and there are many
 * such pieces for each of the cells. Pieces hang together by faces, edges and corners of voxels. */
bool spore_label_check_specks(const SporeLabelMap *map, const bool *wanted, size_t cells, double least,
                              const SporeProgress *progress, SporeError *error);

/* Takes a surface from indices of the map to metres; what is outward in indices is outward there, too. */
void spore_label_surface_place(const SporeLabelMap *map, SporeTriangleMesh *surface);

/* The winning label of a cell with these corners. */
uint16_t spore_label_of_cell(const SporeLabelField *field, const SporeVec3 corner[4]);

/* Makes the cells of the lattice with a label above 0, with vertices and mesh->labels. mesh NULL: only counts. */
bool spore_label_lattice(const SporeLabelField *field, const double lower[3], const double upper[3], double edge,
                         SporeTetrahedralMesh *mesh, size_t *count, const SporeProgress *progress, SporeError *error);

/* Points of the borders: targets for the vertices. */
typedef struct SporeLabelPoints {
  SporeSkinPoints points;
  uint16_t *between; /* count x 2: the lower and the higher label; equal where more than two labels meet */
  double *normal;    /* count x 3: unit length, from the lower to the higher label */
} SporeLabelPoints;

void spore_label_points_clear(SporeLabelPoints *points);

/* Moves vertices between labels to where the labels meet, in rounds. The borders also shift slightly, so that each
 * label gets its wanted volume. volumes: m^3, one for each of the 65536 labels. points: the borders by the map alone,
 * even where limits on dihedral angles stop the vertices; cleared by the caller; NULL: not wanted. */
bool spore_label_fit(const SporeLabelField *field, SporeTetrahedralMesh *mesh, double edge, const double *volumes,
                     SporeLabelPoints *points, const SporeProgress *progress, SporeError *error);

/* Coarsens the mesh to `cells` cells, with its borders near the points. The points then shift slightly to restore the
 * volumes. size: m, the wanted edge length; kept: of the 65536 labels, the fewest cells that each keeps. */
bool spore_label_coarsen(SporeTetrahedralMesh *mesh, SporeLabelPoints *points, size_t cells, double size,
                         const size_t *kept, const double *volumes, const SporeProgress *progress, SporeError *error);

#endif
