/* State of the world: configuration and velocity of all bodies, snapshots for readers, the monitor's counts, and
 * energy.
 *
 * The last good state lies in `q` and `v`, body by body. A step reads that state and writes the next state into
 * `next_q` and `next_v`. Stage `advance` makes the next state the last good one. All four vectors are buffers of the
 * snapshots, so that publishing a state copies nothing.
 *
 * spore_..._init and spore_..._create allocate, and return false without memory; spore_..._clear frees. "Stage:" marks
 * a function that the table in step.c calls. */
#ifndef SPORE_SIM_STATE_H
#define SPORE_SIM_STATE_H

#include <stdatomic.h>

#include "core/base/triple.h"
#include "core/constraint/term.h"
#include "core/sim/world.h"

#define SPORE_POSE_Q 7      /* doubles in q of a body without a model: position, quaternion wxyz */
#define SPORE_POSE_BLOCKS 2 /* blocks in v of a body without a model: velocity, angular velocity */

typedef struct SporeBody SporeBody;

/* The triple buffer of snapshots. States are numbered, one number a state. */
typedef struct SporeSnapshots {
  SporeSnapshot buffers[3];
  SporeTriple triple;
  double *q[3], *v[3];        /* owned; the buffers point at them */
  uint64_t number[3], newest; /* number of the state in each buffer; number of the newest state */
  atomic_bool energy_wanted;  /* a reader acquired a snapshot since the energy was last computed */
} SporeSnapshots;

/* Register of the steps that were not solved, since time 0. */
typedef struct SporeUnsolvedCount {
  uint64_t steps;
  uint64_t last; /* the last of the steps; holds only where `steps` is above 0 */
  double worst;
} SporeUnsolvedCount;

/* The world's state. q vectors have q_count doubles, v vectors v_count. */
typedef struct SporeState {
  size_t q_count, v_count;
  size_t dof;                  /* components of v that physics moves */
  double *rest_q, *rest_v;     /* as models place their bodies: what links and tools are made at */
  double *still;               /* v_count zeros, where some body has a start of its own; else NULL */
  SporeSite *sites;            /* where each body begins in q and v */
  uint64_t step;               /* steps taken */
  SporeVec3 gravity;           /* m/s^2 */
  const double *q, *v;         /* the last good state */
  double *next_q, *next_v;     /* the state that the step makes */
  double *target_q;            /* where active bodies are to be at the end of the step */
  double *mass, *mass_inverse; /* 9 doubles a block, which begin at 3 times the block's index in v; kg or kg m^2 */
  double *reaction;            /* body_count x 6: force (N) and torque (N m) of contacts and links */
  SporeStepCounts counts;
  SporeEnergy energy; /* as last computed for a snapshot */
  SporeSnapshots snapshots;
  SporeMonitor monitor;
  SporeUnsolvedCount *unsolved; /* body_count x SPORE_UNSOLVED_CAUSES */
} SporeState;

/* What may go wrong with a body in a step; the worst is last. */
typedef enum SporeTrouble {
  SPORE_TROUBLE_NONE,
  SPORE_TROUBLE_NOT_CONVERGED,
  SPORE_TROUBLE_SPEED,
  SPORE_TROUBLE_NOT_FINITE
} SporeTrouble;
/* What the monitor has already reported of a body: it reports each thing once. */
typedef struct SporeReported {
  SporeTrouble trouble; /* the worst so far */
  bool deep;            /* the body lies too deep in another body */
  bool fast;            /* the body comes faster than contacts stop it */
  bool passed;          /* the body passed through another */
  bool error;           /* the body's explicit step is too large for its motion */
  bool turned;          /* the body turns further in a step than its turning is followed */
  bool torn;            /* the body tears */
  bool notice;          /* what the body's model had to correct */
} SporeReported;

/* snapshot.c */
bool spore_snapshots_init(SporeWorld *world); /* false: no memory */
void spore_state_clear(SporeState *state);
/* Notes that the body's part of the next state was written. spore_world_advance_state copies the parts of all other
 * bodies from the last state. */
void spore_body_mark_changed(const SporeWorld *world, SporeBody *body);
/* A body may have more room in the state than it uses now. Sets the unused room in the next state to 0. */
void spore_body_clear_unused(SporeWorld *world, const SporeBody *body);
/* Makes the next state the last good one. First copies into it the parts of bodies that this step did not write. */
void spore_world_advance_state(SporeWorld *world);
/* Publishes the last good state to the reader, and takes another buffer for the next state. */
void spore_world_publish(SporeWorld *world);
/* Stage: counts the step, and shows its state to the reader. */
void spore_world_end_step(SporeWorld *world);
/* Sets the velocity of an active body in the next state: the velocity that takes the body to its target in one step. */
void spore_active_set_velocity(SporeWorld *world, uint32_t body);

/* monitor.c */
/* Adds a message to the monitor. format: as of printf, translated. */
void spore_world_report(SporeWorld *world, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Stage: reports what went wrong in the islands of this step, and what models had to correct. */
void spore_world_report_islands(SporeWorld *world);
/* Reports that the step took longer than the budget. */
void spore_world_report_budget(SporeWorld *world);
void spore_monitor_reset(SporeMonitor *monitor); /* counts to 0; the messages stay */

/* unsolved.c */
bool spore_world_create_unsolved(SporeWorld *world); /* false: no memory */
void spore_world_reset_unsolved(SporeWorld *world);
/* Counts this step as unsolved for the body, once for each cause. worst: the figure of the cause, 0 or more; NaN counts
 * as infinite. Not for code that several threads run. */
void spore_world_count_unsolved(SporeWorld *world, uint32_t body, SporeUnsolvedCause cause, double worst);
/* The sentences of the table, translated: why, and what to do. */
const char *spore_unsolved_cause(SporeUnsolvedCause cause);
const char *spore_unsolved_remedy(SporeUnsolvedCause cause);

/* energy.c: energy of a body at q, v, in J. */
double spore_body_kinetic_energy(const SporeWorld *world, const SporeBody *body, const double *v);
double spore_body_gravity_energy(const SporeWorld *world, const SporeBody *body, const double *q);

#endif
