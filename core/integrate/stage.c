#include "core/integrate/stage.h"

#include <math.h>
#include <string.h>

/* The stage as a system in v. */
typedef struct Stage {
  const SporeDynamics *dynamics;
  const double *qa, *va;
  double c;
  size_t linear_iterations;
  double *q, *v;        /* where the force is evaluated */
  double *force, *work; /* 3 block_count each */
  double *linear;       /* SPORE_PCG_SCRATCH vectors */
} Stage;

static double dot(size_t n, const double *a, const double *b) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

static void residual(void *data, const double *v, double *r) {
  Stage *stage = data;
  const SporeDynamics *dynamics = stage->dynamics;
  size_t n = 3 * dynamics->block_count;
  dynamics->drift(dynamics->data, stage->qa, v, stage->c, stage->q, stage->v);
  dynamics->force(dynamics->data, stage->q, v, stage->force);
  for (size_t i = 0; i < n; i++) stage->work[i] = v[i] - stage->va[i];
  dynamics->mass_multiply(dynamics->data, stage->work, r);
  for (size_t i = 0; i < n; i++) r[i] = stage->c * stage->force[i] - r[i];
}

static void linearise(void *data, const double *v) {
  Stage *stage = data;
  const SporeDynamics *dynamics = stage->dynamics;
  dynamics->drift(dynamics->data, stage->qa, v, stage->c, stage->q, stage->v);
  dynamics->linearise(dynamics->data, stage->q, v, stage->c, stage->c * stage->c);
}

static bool reuse(void *data, const double *v) {
  Stage *stage = data;
  const SporeDynamics *dynamics = stage->dynamics;
  dynamics->drift(dynamics->data, stage->qa, v, stage->c, stage->q, stage->v);
  return dynamics->reuse(dynamics->data, stage->q, v, stage->c, stage->c * stage->c);
}

static SporeLinearResult solve(void *data, const double *r, double tolerance, double *dv) {
  Stage *stage = data;
  const SporeDynamics *dynamics = stage->dynamics;
  SporeLinearOperator operator= {dynamics->data, 3 * dynamics->block_count, dynamics->multiply, dynamics->precondition};
  return spore_pcg(&operator, r, tolerance, stage->linear_iterations, dv, stage->linear);
}

static double kinetic_dot(void *data, const double *a, const double *b) {
  Stage *stage = data;
  stage->dynamics->mass_multiply(stage->dynamics->data, b, stage->work);
  return dot(3 * stage->dynamics->block_count, a, stage->work);
}

static double dual_norm(void *data, const double *r) {
  Stage *stage = data;
  size_t n = 3 * stage->dynamics->block_count;
  memset(stage->work, 0, n * sizeof(double));
  stage->dynamics->kick(stage->dynamics->data, r, 1, stage->work);
  return sqrt(dot(n, r, stage->work));
}

static double rounding(void *data, const double *v, bool stiff_axes) {
  Stage *stage = data;
  return stage->dynamics->rounding(stage->dynamics->data, stage->q, stage->c, stiff_axes);
}

static SporeSystem stage_system(Stage *stage) {
  double gravity = stage->c * stage->dynamics->gravity_momentum;
  return (SporeSystem){.data = stage,
                       .count = 3 * stage->dynamics->block_count,
                       .residual = residual,
                       .linearise = linearise,
                       .reuse = reuse,
                       .solve = solve,
                       .dot = kinetic_dot,
                       .norm = dual_norm,
                       .scale_x = gravity,
                       .scale_r = gravity,
                       .rounding = rounding};
}

/* The guess: going on as before, or standing still, whichever is nearer to the answer. Where the step is long for the
 * stiffness, going on stretches what is stiff, and only standing still starts with no more energy than there was. */
static void guess(Stage *stage, double *v, double *r) {
  size_t n = 3 * stage->dynamics->block_count;
  memset(v, 0, n * sizeof *v);
  residual(stage, v, r);
  double still = dual_norm(stage, r);
  residual(stage, stage->va, r);
  if (!(still < dual_norm(stage, r))) memcpy(v, stage->va, n * sizeof *v);
}

SporeStepResult spore_stage_solve(const SporeDynamics *dynamics, const SporeSolverFields *fields, double c,
                                  const double *qa, const double *va, double *v, double *scratch) {
  size_t n = 3 * dynamics->block_count;
  Stage stage = {.dynamics = dynamics, .qa = qa, .va = va, .c = c};
  stage.linear_iterations = (size_t)fields->linear_iterations;
  stage.q = scratch;
  stage.v = scratch + 2 * n;
  stage.force = scratch + 3 * n;
  stage.work = scratch + 4 * n;
  stage.linear = scratch + 5 * n;
  double *nonlinear = scratch + (5 + SPORE_PCG_SCRATCH) * n;
  guess(&stage, v, nonlinear);
  SporeSystem system = stage_system(&stage);
  SporeNonlinearOptions options = {(size_t)fields->newton_iterations, fields->tolerance};
  SporeNonlinearResult result = fields->nonlinear == SPORE_NONLINEAR_BROYDEN
                                    ? spore_broyden(&system, &options, v, nonlinear)
                                    : spore_newton(&system, &options, v, nonlinear);
  return (SporeStepResult){.converged = result.converged,
                           .newton_iterations = result.iterations,
                           .linear_iterations = result.linear_iterations,
                           .force_evaluations = result.evaluations + 2,
                           .linearisations = result.linearisations,
                           .unsolved = result.unsolved,
                           .residual = result.residual};
}
