/* The corners that a mesh asset names for a spline sheet. */
#ifndef SPORE_SCENE_SHEET_CORNERS_H
#define SPORE_SCENE_SHEET_CORNERS_H

#include "core/scene/document.h"

/* Properties of a mesh asset that are its corners, in turn around it. */
extern const char *const spore_sheet_corner_names[4];
/* corners: 4 x 3, m. FALSE: it names none, that is, all are the same. */
gboolean spore_sheet_corners(const SporeObject *mesh, double corners[12]);

#endif
