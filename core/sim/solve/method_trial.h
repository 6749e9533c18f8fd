/* A method tried on one body alone: how large its steps may be, without all that the world does where a step goes
 * wrong. */
#ifndef SPORE_SIM_METHOD_TRIAL_H
#define SPORE_SIM_METHOD_TRIAL_H

#include "core/sim/solve/step_limit.h"
#include "core/sim/world.h"

/* What came of the steps. */
typedef enum SporeMethodOutcome {
  SPORE_METHOD_BOUNDED,    /* every step was solved, and the energy stayed bounded */
  SPORE_METHOD_GREW,       /* energy came out of nothing */
  SPORE_METHOD_NOT_FINITE, /* the motion is not finite */
  SPORE_METHOD_NOT_SOLVED, /* an implicit step was not solved to tolerance */
  SPORE_METHOD_NOTHING,    /* nothing moved: pins hold all of the body, or none of its particles is in the world */
  SPORE_METHOD_CANCELLED,
  SPORE_METHOD_NO_MEMORY
} SporeMethodOutcome;

typedef struct SporeMethodTrial {
  SporeIntegratorKind integrator; /* not static, which takes no steps in time */
  double step_s;                  /* of the integrator */
  size_t steps;
  const SporeCancel *cancel; /* asked after each step, beside the world's; NULL: none */
} SporeMethodTrial;

typedef struct SporeMethodResult {
  SporeMethodOutcome outcome;
  size_t steps; /* taken until then */
  double gain;  /* largest gain of energy, as a part of the energy at work */
} SporeMethodResult;

/* Moves the body from its state at time 0, slightly pushed in all directions, by the integrator alone: nothing is taken
 * again, replaced or frozen. There are no contacts, links and gravity; pins hold. All that the body has is its own
 * energy, so that any gain comes out of nothing. An implicit method may gain 1 % of the energy at work. The energy of
 * an explicit one rises and falls within a period of a mode, also where it stays bounded: it may gain 1 % more in the
 * second half of the steps than in the first, and one that lets the energy swing (SporeIntegrator.swings) twice as
 * much; never more than 1000 times the energy at work.
 * To be called after a reset of the world, which is as before then. Allocates. body: a passive one. */
SporeMethodResult spore_world_try_method(SporeWorld *world, uint32_t body, const SporeMethodTrial *trial);

/* What spore_step_limit says of the body at time 0. dt_s and whole_dt_s are infinite for an implicit method, unless the
 * body has no Jacobian: then they are those of verlet. False: no memory. */
bool spore_world_predict_step(const SporeWorld *world, uint32_t body, SporeIntegratorKind kind, SporeStepLimit *limit,
                              SporeError *error);

#endif
