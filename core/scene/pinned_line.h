/* What a pin makes of a line: it holds control points, so that the line bends as if it were clamped elsewhere than
 * where the pin's radius ends. */
#ifndef SPORE_SCENE_PINNED_LINE_H
#define SPORE_SCENE_PINNED_LINE_H

#include "core/scene/compile.h"

/* One side of the pin, towards the end of the line or towards its start. */
typedef struct SporePinnedSide {
  size_t held;    /* control points */
  gboolean turns; /* too few are held: the line can turn there; `beyond_m` is 0 */
  double
      beyond_m;  /* of the effective clamp from where the line leaves the radius, along the line; negative: within it */
  double free_m; /* length of the line outside the radius on this side */
} SporePinnedSide;

/* side: 1 towards the end, -1 towards the start. FALSE: the body is no line, the line has no free part on this side, or
 * it comes back to the pin, so that there is no one clamp. */
gboolean spore_pinned_side_measure(const SporeSimulation *simulation, SporeObject *pin, int side,
                                   SporePinnedSide *measured);

#endif
