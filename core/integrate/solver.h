/* How a world is integrated: the table of solver parameters. */
#ifndef SPORE_INTEGRATE_SOLVER_H
#define SPORE_INTEGRATE_SOLVER_H

#include "core/base/parameter.h"

/* The integrators, explicit ones first. COUNT says how many; DEFAULT leaves the choice to the world. */
typedef enum SporeIntegratorKind {
  SPORE_INTEGRATOR_EXPLICIT_EULER,
  SPORE_INTEGRATOR_SYMPLECTIC_EULER,
  SPORE_INTEGRATOR_VERLET,
  SPORE_INTEGRATOR_RK4,
  SPORE_INTEGRATOR_POSITION_BASED,
  SPORE_INTEGRATOR_IMPLICIT_EULER,
  SPORE_INTEGRATOR_IMPLICIT_MIDPOINT,
  SPORE_INTEGRATOR_BDF2,
  SPORE_INTEGRATOR_TR_BDF2,
  SPORE_INTEGRATOR_STATIC,
  SPORE_INTEGRATOR_COUNT,
  SPORE_INTEGRATOR_DEFAULT = -1
} SporeIntegratorKind;
/* Names by SporeIntegratorKind, NULL-terminated: the choices of every `integrator` parameter. */
extern const char *const spore_integrator_names[];

/* What solves the nonlinear equations of an implicit step. */
typedef enum SporeNonlinearKind {
  SPORE_NONLINEAR_AUTOMATIC, /* Broyden where the island's matrix is factorised, else Newton */
  SPORE_NONLINEAR_NEWTON,
  SPORE_NONLINEAR_BROYDEN
} SporeNonlinearKind;
/* What solves the linear equations of an iteration. */
typedef enum SporeLinearKind {
  SPORE_LINEAR_AUTOMATIC, /* whichever takes less work, body by body */
  SPORE_LINEAR_CONJUGATE_GRADIENTS,
  SPORE_LINEAR_CHOLESKY,
  SPORE_LINEAR_BANDED /* of chains and splines; of others as SPORE_LINEAR_CHOLESKY */
} SporeLinearKind;

/* Names by SporeNonlinearKind, NULL-terminated. */
extern const char *const spore_nonlinear_names[];
/* Names by SporeLinearKind, NULL-terminated. */
extern const char *const spore_linear_names[];

/* The most substeps that a step may be divided into. */
#define SPORE_SUBSTEPS_MAXIMUM 1000

/* How the world is integrated, for all bodies that do not say otherwise. */
typedef struct SporeSolverFields {
  double time_step;          /* s */
  int integrator;            /* SporeIntegratorKind */
  int64_t substeps;          /* of a step, for bodies that do not choose for themselves */
  double error_tolerance;    /* m, of tr_bdf2; 0: it takes the step as it is */
  int nonlinear;             /* SporeNonlinearKind */
  int linear;                /* SporeLinearKind */
  int64_t newton_iterations; /* at most, a step */
  int64_t linear_iterations; /* at most, a Newton iteration */
  double tolerance;          /* relative residual to reach */
  double maximum_speed;      /* m/s: above it the monitor steps in */
  double sleep_speed;        /* m/s: what stays slower for a while sleeps; 0: nothing does */
} SporeSolverFields;
/* The parameters of SporeSolverFields. */
extern const SporeParameterTable spore_solver_parameters;

#endif
