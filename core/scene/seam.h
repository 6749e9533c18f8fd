/* The points at which a seam joins two bodies. */
#ifndef SPORE_SCENE_SEAM_H
#define SPORE_SCENE_SEAM_H

#include <glib.h>

#include "core/math/quat.h"
#include "core/body/model.h"

/* A side of a seam; model NULL: it has no nodes. */
typedef struct SporeSeamSide {
  const SporeModel *model;
  SporePose pose;
} SporeSeamSide;

/* Appends to `points` (of SporeVec3; the scene's axes, m) each node of a, at rest, that has a node of b within
 * `distance` (m). Bodies of one piece have no nodes. */
void spore_seam_find(const SporeSeamSide *a, const SporeSeamSide *b, double distance, GArray *points);

#endif
