/* State of the world: the vectors of all bodies, snapshots of these for readers, the monitor's counts, and energy.
 *
 * The last good state is in `q` and `v`, body by body. A step only reads that state, and writes the next one into
 * `next_q` and `next_v`. All four are buffers of the snapshots, so that publishing a state copies nothing. */
#ifndef SPORE_SIM_STATE_H
#define SPORE_SIM_STATE_H

#include <stdatomic.h>

#include "core/base/triple.h"
#include "core/constraint/term.h"
#include "core/sim/world.h"

#define SPORE_POSE_Q 7 /* doubles of a body without a model: position, orientation; in v: velocity, spin */
#define SPORE_POSE_BLOCKS 2

typedef struct SporeBody SporeBody;

typedef struct SporeSnapshots {
  SporeSnapshot buffers[3];
  SporeTriple triple;
  double *q[3], *v[3];        /* owned; the buffers point at them */
  uint64_t number[3], newest; /* number of the state in each buffer; number of the newest state */
  atomic_bool energy_wanted;  /* a reader acquired a snapshot since the energy was last computed */
} SporeSnapshots;

typedef struct SporeState {
  size_t q_count, v_count, dof; /* doubles; dof: those of v that physics moves */
  double *rest_q, *rest_v;      /* at time 0 */
  SporeSite *sites;             /* where each body begins in q and v */
  uint64_t step;                /* steps taken */
  SporeVec3 gravity;            /* m/s^2 */
  const double *q, *v;          /* the last good state */
  double *next_q, *next_v;      /* the state that the step makes */
  double *target_q;             /* poses of active bodies at the end of the step */
  double *mass, *mass_inverse;  /* 9 doubles a block, at 3 x the block's place in v; kg or kg m^2 */
  double *reaction;             /* body_count x 6: force (N) and torque (N m) of contacts and links */
  SporeStepCounts counts;
  SporeEnergy energy; /* as last computed for a snapshot */
  SporeSnapshots snapshots;
  SporeMonitor monitor;
} SporeState;

/* What the monitor has already reported of a body, so that it reports each fact once. */
typedef enum SporeTrouble { /* worst last */
                            SPORE_TROUBLE_NONE,
                            SPORE_TROUBLE_NOT_CONVERGED,
                            SPORE_TROUBLE_ENERGY,
                            SPORE_TROUBLE_SPEED,
                            SPORE_TROUBLE_NOT_FINITE
} SporeTrouble;
typedef struct SporeReported {
  SporeTrouble trouble; /* the worst */
  bool deep;            /* the body lies too deep in another body */
  bool soft;            /* its contacts are too soft at this step */
  bool torn;            /* the body tears */
  bool notice;          /* its model corrected something */
} SporeReported;

/* snapshot.c */
bool spore_snapshots_init(SporeWorld *world); /* false: no memory */
void spore_state_clear(SporeState *state);
/* Marks the body's part of the next state as written, so that spore_world_advance_state does not copy it. */
void spore_body_mark_changed(const SporeWorld *world, SporeBody *body);
/* Sets the part of the body's room in the next state that lies behind its values to 0. */
void spore_body_clear_unused(SporeWorld *world, const SporeBody *body);
/* Copies each body that was not written from the last state to the next, and makes the next state the last good one. */
void spore_world_advance_state(SporeWorld *world);
/* Shows the state to the reader. After that the next state can be written. */
void spore_world_publish(SporeWorld *world);
/* Stage: counts the step, and shows its state to the reader. */
void spore_world_end_step(SporeWorld *world);
/* Velocity, in the next state, that takes an active body to its target in one step. */
void spore_active_set_velocity(SporeWorld *world, uint32_t body);

/* monitor.c */
/* Adds a message to the monitor; `format` is translated, as of printf. */
void spore_world_report(SporeWorld *world, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Stage: reports troubles of the islands in this step, and corrections that models made. */
void spore_world_report_islands(SporeWorld *world);
/* Reports a contact that is deeper than the radius of its smaller sphere. */
void spore_world_report_depth(SporeWorld *world, const SporeContactTerm *term);
/* Reports that the step took longer than the budget. */
void spore_world_report_budget(SporeWorld *world);
void spore_monitor_reset(SporeMonitor *monitor); /* counts to 0; the messages stay */

/* energy.c: energy of a body at q, v, in J. */
double spore_body_kinetic_energy(const SporeWorld *world, const SporeBody *body, const double *v);
double spore_body_gravity_energy(const SporeWorld *world, const SporeBody *body, const double *q);

#endif
