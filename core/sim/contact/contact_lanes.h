/* Contacts side by side, one a lane, so that the forces of several contacts are evaluated at once. The law is that of
 * term.c, for spheres on nodes or on rigid bodies. Other contacts are evaluated one by one. Private to the room. */
#ifndef SPORE_SIM_CONTACT_LANES_H
#define SPORE_SIM_CONTACT_LANES_H

#include "core/math/simd.h"
#include "core/constraint/term.h"

#define SPORE_LANE_FIXED UINT32_MAX /* instead of an index of an end's velocity: physics does not move the end */
/* Of a rigid body: the rows of its rotation, position, velocity, spin. */
#define SPORE_FRAME_DOUBLES 18

typedef enum SporeLanesKind {
  SPORE_LANES_APART, /* evaluated one by one */
  SPORE_LANES_NODES, /* ends that move are nodes */
  SPORE_LANES_FRAMES /* ends that move are points of rigid bodies */
} SporeLanesKind;

typedef struct SporeLaneVector {
  double x[SPORE_LANES], y[SPORE_LANES], z[SPORE_LANES];
} SporeLaneVector;

typedef struct SporeLaneEnd {
  uint32_t at[SPORE_LANES]; /* third of the index of its node in q, or of its body in the frames; 0: it does not move */
  uint32_t v[SPORE_LANES];  /* third of the index of its node or body in v, or SPORE_LANE_FIXED */
  uint32_t v_node[SPORE_LANES];                 /* the same; 0: it does not move */
  int64_t moves[SPORE_LANES];                   /* -1, or 0 */
  SporeLaneVector start;                        /* its position when the step began, m */
  SporeLaneVector point, arm, frame_arm, lever; /* of frames: see SporeContactTerm and SporeEnd */
} SporeLaneEnd;

/* Consecutive contacts of an island. Lanes behind the last contact have no force. */
typedef struct SporeContactLanes {
  SporeLanesKind kind;
  bool rubs, overlaps; /* some lane has friction; some lane has an overlap */
  uint32_t count;
  SporeLaneEnd a, b;
  SporeLaneVector normal, driven; /* driven: velocity of prescribed ends, a less b, m/s */
  int64_t rolls[SPORE_LANES];     /* -1, or 0: see spore_contact_term_rolls */
  double depth[SPORE_LANES];      /* that presses, m */
  double overlap[SPORE_LANES];    /* of it, m: see SporeContactTerm */
  double stiffness[SPORE_LANES], damping[SPORE_LANES], damping_depth[SPORE_LANES], friction[SPORE_LANES];
  SporeLaneVector stretch;
  SporeLaneVector force;
  double pressing[SPORE_LANES];
} SporeContactLanes;

/* Number of SporeContactLanes that so many contacts take. */
static inline size_t spore_lanes_for(size_t contacts) { return (contacts + SPORE_LANES - 1) / SPORE_LANES; }

/* Force and pressing, and the levers of frames. `at`: q, or the frames; elapsed_s: since the step began. */
SPORE_DECLARE_KERNEL(void, spore_contact_lanes_force, SporeContactLanes *lanes, const double *at, const double *v,
                     double elapsed_s);

#endif
