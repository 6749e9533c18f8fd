/* Integrators: one operation each, registered by SporeIntegratorKind. */
#ifndef SPORE_INTEGRATE_INTEGRATOR_H
#define SPORE_INTEGRATE_INTEGRATOR_H

#include "core/integrate/dynamics.h"
#include "core/integrate/solver.h"

typedef struct SporeStepResult {
  bool converged; /* to the tolerance, or to rounding where that is more (see `residual`); explicit ones always do */
  size_t newton_iterations, linear_iterations, force_evaluations;
  size_t linearisations, unsolved; /* unsolved: linear systems that did not reach their tolerance */
  double residual;                 /* relative */
} SporeStepResult;

/* Adds the counts of a part of a step; the worst residual stays. */
static inline void spore_step_result_add(SporeStepResult *total, const SporeStepResult *part) {
  total->converged &= part->converged;
  total->newton_iterations += part->newton_iterations;
  total->linear_iterations += part->linear_iterations;
  total->force_evaluations += part->force_evaluations;
  total->linearisations += part->linearisations;
  total->unsolved += part->unsolved;
  if (!(part->residual <= total->residual)) total->residual = part->residual;
}

/* What a multistep or adaptive method remembers of the step before, at the q0 of this one. The vectors, 3 block_count
 * each, mean what the method says. */
typedef struct SporeHistory {
  double step_s; /* of the step that left it; 0: nothing is known. The method sets it for the next one. */
  double *a, *b; /* NULL for implicit Euler where it stands in for another method: then it remembers nothing */
} SporeHistory;

/* How sure a method is to take energy away from what it does not resolve. Bodies of several methods that are solved
 * together move by the one that damps most. */
typedef enum SporeDamping {
  SPORE_DAMPING_NONE,    /* explicit */
  SPORE_DAMPING_NEUTRAL, /* A-stable: keeps it */
  SPORE_DAMPING_FAST,    /* L-stable: takes it, of what is smooth */
  SPORE_DAMPING_FULL     /* contractive: takes it at every step, impacts too */
} SporeDamping;

typedef struct SporeIntegrator {
  const char *name; /* as spore_integrator_names */
  const char *doc;  /* translatable */
  bool implicit;
  bool chooses_step; /* step_s of its history is its own affair, and that of any body will do */
  bool remembers;    /* needs its SporeHistory kept */
  SporeDamping damping;
  /* Keeps, in small enough steps, an energy near the true one: the true one swings about it without growing (Hairer,
   * Lubich and Wanner, Acta Numerica 12, 2003, section 1). */
  bool swings;
  /* Meets the elements of bodies that can be met so one after the other (SporeModelSweep): then no step is too large
   * for these bodies. */
  bool sweeps;
  /* Explicit: modes with w^2 h^2 + stable_damping d h <= stable_square stay bounded; w^2 and d are eigenvalues of
   * M^-1 K and M^-1 D. 1 of it is for contacts and links. 0: not of this form. */
  double stable_square, stable_damping;
  double shift; /* explicit: a constant acceleration a moves q by shift h^2 a in a step, beside h v0 */
  /* Doubles of scratch a block. */
  size_t scratch;
  /* q1, v1 from q0, v0 (not aliased) after h seconds. Whatever happens q1 and v1 are written; they may not be finite.
   */
  SporeStepResult (*step)(const SporeDynamics *dynamics, const SporeSolverFields *fields, SporeHistory *history,
                          double h, const double *q0, const double *v0, double *q1, double *v1, double *scratch);
} SporeIntegrator;

/* By kind, SPORE_INTEGRATOR_DEFAULT excepted. */
const SporeIntegrator *spore_integrator(SporeIntegratorKind kind);
/* Scratch a block that serves any of them. */
size_t spore_integrator_scratch(void);

extern const SporeIntegrator spore_explicit_euler, spore_symplectic_euler, spore_verlet, spore_rk4,
    spore_position_based, spore_implicit_euler, spore_implicit_midpoint, spore_bdf2, spore_tr_bdf2, spore_static;

#endif
