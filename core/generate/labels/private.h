/* The steps of spore_label_tetrahedra. */
#ifndef SPORE_GENERATE_LABELS_PRIVATE_H
#define SPORE_GENERATE_LABELS_PRIVATE_H

#include "core/generate/labels/labels.h"
#include "core/generate/common/common.h"

#define SPORE_LABEL_SHARES 4 /* that a voxel has at most */
#define SPORE_LABEL_MOST (8 * SPORE_LABEL_SHARES)

/* How much of a label there is at a place. */
typedef struct SporeLabelShare {
  uint16_t label; /* 0: nothing, or what is not wanted */
  float share;
} SporeLabelShare;

/* Shares of labels at any place: those of the voxels, blurred, interpolated between the voxels' middles. A voxel keeps
 * most of its own label, so that layers of one voxel stay. */
typedef struct SporeLabelField {
  const SporeLabelMap *map;
  const bool *wanted; /* 65536 */
  double inverse[12]; /* from places (m) to indices */
  /* Voxels near a border, a row of the map after the other; the others have one label alone. */
  size_t *row;      /* first of each row, and their count */
  uint32_t *column; /* ascending in a row */
  SporeLabelShare (*shares)[SPORE_LABEL_SHARES];
} SporeLabelField;

bool spore_label_field_create(SporeLabelField *field, const SporeLabelMap *map, const bool *wanted,
                              const SporeProgress *progress, SporeError *error);
void spore_label_field_clear(SporeLabelField *field);
/* The labels at p, each once; returns how many. Their shares' sum is 1. */
int spore_label_field_shares(const SporeLabelField *field, SporeVec3 p, SporeLabelShare shares[SPORE_LABEL_MOST]);
/* Adds to a list in which each label stands once; returns its length then. */
int spore_label_add(SporeLabelShare *shares, int count, SporeLabelShare one);
/* Which of them is there: nothing where more than half is, else the organ that has most, of equal ones the larger
 * number: so that nothing does not eat into where organs meet. */
uint16_t spore_label_winner(const SporeLabelShare *shares, int count);

/* The label that has most of a cell with these corners. */
uint16_t spore_label_of_cell(const SporeLabelField *field, const SporeVec3 corner[4]);

/* Cells of the lattice with a label above 0, their nodes numbered; mesh->labels set. *count only where mesh is NULL. */
bool spore_label_lattice(const SporeLabelField *field, const double lower[3], const double upper[3], double edge,
                         SporeTetrahedralMesh *mesh, size_t *count, const SporeProgress *progress, SporeError *error);

/* Points of the borders, which vertices are drawn to. */
typedef struct SporeLabelPoints {
  SporeSkinPoints points;
  uint16_t *between; /* count x 2: the lower label and the higher one; alike where more than two meet */
  double *normal;    /* count x 3: unit length, from the lower to the higher one */
} SporeLabelPoints;

void spore_label_points_clear(SporeLabelPoints *points);

/* Moves vertices between labels to where the labels meet, in rounds; borders then give way a little, so that each label
 * gets the volume it is to have. volumes: m^3, one for each of the 65536 labels. points: where the borders
 * are by the map alone, also where angles between faces hold vertices back; cleared by the caller; NULL: not wanted. */
bool spore_label_fit(const SporeLabelField *field, SporeTetrahedralMesh *mesh, double edge, const double *volumes,
                     SporeLabelPoints *points, const SporeProgress *progress, SporeError *error);

/* Draws cells together until `cells` are left, their borders staying near the points, which then give way a little for
 * the volumes. size: m, of an edge that is wanted. */
bool spore_label_coarsen(SporeTetrahedralMesh *mesh, SporeLabelPoints *points, size_t cells, double size,
                         const double *volumes, const SporeProgress *progress, SporeError *error);

#endif
