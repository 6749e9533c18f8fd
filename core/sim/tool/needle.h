/* A curved needle and its thread: what it has pierced. Private to the room. */
#ifndef SPORE_SIM_NEEDLE_H
#define SPORE_SIM_NEEDLE_H

#include "core/constraint/term.h"
#include "core/sim/world.h"

#define SPORE_NEEDLE_SPANS 24 /* of the path along the needle */

/* Where one place of tissue is on its way from the tip along the needle onto the thread. */
typedef enum SporeStitchState {
  SPORE_STITCH_FREE,
  SPORE_STITCH_PRESSED, /* the tip presses on it */
  SPORE_STITCH_ON_NEEDLE,
  SPORE_STITCH_ON_THREAD
} SporeStitchState;

typedef struct SporeStitch {
  SporeStitchState state;
  uint32_t body;
  SporeVec3 touched; /* where the tip first pressed, m */
  SporeCurveJoint needle, thread;
} SporeStitch;

/* Triangles of a body that can be pierced, by its nodes. */
typedef struct SporeSkin {
  uint32_t body;
  size_t count;
  uint32_t *triangles;
} SporeSkin;

/* Its terms: the thread's end at the swage, and behind it two for each stitch, along the needle and along the thread.
 */
typedef struct SporeNeedle {
  SporeNeedleFields fields;
  double path[3 * (SPORE_NEEDLE_SPANS + 3)]; /* in the body's frame, from the tip to the swage, m */
  double length;                             /* m */
  uint32_t thread;                           /* SPORE_NO_BODY: none */
  bool from_end;                             /* the swage has the thread's last point, not its first */
  size_t skin_count;
  SporeSkin *skins;
  SporeStitch *stitches; /* fields.stitches */
  size_t pierced;        /* so far */
} SporeNeedle;

#endif
