/* Integrators: one operation each, registered by SporeIntegratorKind. */
#ifndef SPORE_INTEGRATE_INTEGRATOR_H
#define SPORE_INTEGRATE_INTEGRATOR_H

#include "core/integrate/dynamics.h"
#include "core/integrate/solver.h"

typedef struct SporeStepResult {
  bool converged; /* explicit ones always do */
  size_t newton_iterations, linear_iterations, force_evaluations;
  size_t linearisations, unsolved; /* unsolved: linear systems that did not reach their tolerance */
  double residual;                 /* relative */
} SporeStepResult;

typedef struct SporeIntegrator {
  const char *name; /* as spore_integrator_names */
  const char *doc;  /* translatable */
  bool implicit;
  /* Doubles of scratch a block. */
  size_t scratch;
  /* q1, v1 from q0, v0 (not aliased) after h seconds. Whatever happens q1 and v1 are written; they may not be finite.
   */
  SporeStepResult (*step)(const SporeDynamics *dynamics, const SporeSolverFields *fields, double h, const double *q0,
                          const double *v0, double *q1, double *v1, double *scratch);
} SporeIntegrator;

/* By kind, SPORE_INTEGRATOR_DEFAULT excepted. The higher the kind, the safer at large steps. */
const SporeIntegrator *spore_integrator(SporeIntegratorKind kind);
/* Scratch a block that serves any of them. */
size_t spore_integrator_scratch(void);

extern const SporeIntegrator spore_symplectic_euler, spore_implicit_euler;

#endif
