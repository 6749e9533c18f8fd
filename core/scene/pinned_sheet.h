/* What a pin makes of a sheet: it holds control points, and only what all the control points that weigh on it are held
 * for stands still. */
#ifndef SPORE_SCENE_PINNED_SHEET_H
#define SPORE_SCENE_PINNED_SHEET_H

#include "core/scene/compile.h"

typedef struct SporePinnedSheet {
  size_t held;    /* control points, by this pin */
  gboolean still; /* some place of the sheet within the radius stands still */
  double
      moves_m; /* how far within the radius, at most, a place of the sheet still moves: all places deeper stand still */
  double free_m; /* how far the sheet reaches beyond the radius */
} SporePinnedSheet;

/* By samples of the sheet, a few a span; other pins on it hold what they hold. FALSE: the body is no sheet, no sample
 * lies within the radius, or there is no memory. */
gboolean spore_pinned_sheet_measure(const SporeSimulation *simulation, SporeObject *pin, SporePinnedSheet *measured);

#endif
