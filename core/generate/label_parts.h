/* The steps of spore_label_tetrahedra. */
#ifndef SPORE_GENERATE_LABEL_PARTS_H
#define SPORE_GENERATE_LABEL_PARTS_H

#include "core/generate/label_tetrahedra.h"

#define SPORE_LABEL_CORNERS 8

/* Labels at any place. */
typedef struct SporeLabelField {
  const SporeLabelMap *map;
  const bool *wanted; /* 65536 */
  double inverse[12]; /* from places (m) to indices */
} SporeLabelField;

void spore_label_field_init(SporeLabelField *field, const SporeLabelMap *map, const bool *wanted);
/* The eight voxels around p with their trilinear shares; label 0 for what is outside or not wanted. */
void spore_label_field_shares(const SporeLabelField *field, SporeVec3 p, uint16_t label[SPORE_LABEL_CORNERS],
                              double share[SPORE_LABEL_CORNERS]);

/* Cells of the lattice with a label above 0, their nodes numbered; mesh->labels set. *count only where mesh is NULL. */
bool spore_label_lattice(const SporeLabelField *field, const double lower[3], const double upper[3], double edge,
                         SporeTetrahedralMesh *mesh, size_t *count, const SporeProgress *progress, SporeError *error);

/* Moves vertices between labels to where the labels meet, in rounds; borders then give way a little, so that each label
 * gets the volume it is to have. volumes: m^3, one for each of the 65536 labels. */
bool spore_label_fit(const SporeLabelField *field, SporeTetrahedralMesh *mesh, double edge, const double *volumes,
                     const SporeProgress *progress, SporeError *error);

#endif
