/* One implicit stage as a nonlinear system, its first guess, and its solution. */
#include "core/integrate/stage.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/math/vector.h"

#define INNER_TOLERANCE 1e-3 /* of A^-1 r: rougher and the differences learn its error, finer and nothing is gained */

/* The stage as a system in v. */
typedef struct Stage {
  const SporeDynamics *dynamics;
  const double *qa, *va;
  double c;
  const double *at; /* v of the linearisation */
  bool whole;       /* that took all that may buckle */
  size_t linear_iterations;
  double *q, *v;        /* where it is linearised */
  double *from;         /* as q: of the linearisation before */
  double *force, *work; /* 3 block_count each */
  bool kept;            /* the last evaluation is for others too */
  SporeEvaluation last; /* its q and f; its v only where it is kept */
  double *linear;       /* SPORE_BICGSTAB_SCRATCH vectors, which is the more */
} Stage;

static void residual(void *data, const double *v, double *r) {
  Stage *stage = data;
  const SporeDynamics *dynamics = stage->dynamics;
  size_t n = 3 * dynamics->block_count;
  const SporeEvaluation *last = &stage->last;
  dynamics->drift(dynamics->data, stage->qa, v, stage->c, last->q, stage->v);
  dynamics->force(dynamics->data, last->q, v, last->f);
  if (stage->kept) memcpy(last->v, v, n * sizeof *v);
  for (size_t i = 0; i < n; i++) stage->work[i] = v[i] - stage->va[i];
  dynamics->mass_multiply(dynamics->data, stage->work, r);
  for (size_t i = 0; i < n; i++) r[i] = stage->c * last->f[i] - r[i];
}

static void linearise(void *data, const double *v, const double *from) {
  Stage *stage = data;
  const SporeDynamics *dynamics = stage->dynamics;
  if (from) dynamics->drift(dynamics->data, stage->qa, from, stage->c, stage->from, stage->v);
  dynamics->drift(dynamics->data, stage->qa, v, stage->c, stage->q, stage->v);
  dynamics->linearise(dynamics->data, stage->q, from ? stage->from : NULL, v, stage->c, stage->c * stage->c);
  stage->at = v;
  stage->whole = false;
}

/* A is of this form, and what follows is of the usual one again. */
static void linearise_by(Stage *stage, SporeTangentForm form, const double *v, const double *from) {
  const SporeDynamics *dynamics = stage->dynamics;
  dynamics->take_tangent(dynamics->data, form);
  linearise(stage, v, from);
  stage->whole = form == SPORE_TANGENT_WHOLE;
  dynamics->take_tangent(dynamics->data, SPORE_TANGENT_USUAL);
}

static void linearise_whole(void *data, const double *v, const double *from) {
  linearise_by(data, SPORE_TANGENT_WHOLE, v, from);
}

static bool reuse(void *data, const double *v) {
  Stage *stage = data;
  const SporeDynamics *dynamics = stage->dynamics;
  dynamics->drift(dynamics->data, stage->qa, v, stage->c, stage->q, stage->v);
  return dynamics->reuse(dynamics->data, stage->q, v, stage->c, stage->c * stage->c);
}

typedef SporeLinearResult Method(const SporeLinearOperator *operator, const double * b, double tolerance,
                                 size_t iterations, double *x, double *scratch);

/* Where iterations are many, the preconditioner is made to hold what couples bodies, unless the solution is all but
 * there. What may buckle has no factor: its solution is given up then. work: in an iteration, products. */
static SporeLinearResult iterate(Stage *stage, Method *method, const SporeLinearOperator *operator, const double * r,
                                 double tolerance, size_t work, double *dv) {
  const SporeDynamics *dynamics = stage->dynamics;
  size_t most = stage->linear_iterations / work, spent = 0;
  SporePatience patience = {0};
  if (dynamics->coupling_patience) patience = dynamics->coupling_patience(dynamics->data);
  if (patience.least > 0 && patience.least < most * work) {
    SporeLinearOperator patient = *operator;
    /* Biconjugate gradients leap: their rate tells nothing of what is left. */
    patient.patience = (SporePatience){(patience.least + work - 1) / work, work == 1 ? patience.more : 0};
    SporeLinearResult first = method(&patient, r, tolerance, most, dv, stage->linear);
    first.iterations *= work;
    if (first.status != SPORE_LINEAR_TOO_MANY || stage->whole) return first;
    dynamics->couple(dynamics->data);
    spent = first.iterations;
  }
  SporeLinearResult result = method(operator, r, tolerance, most, dv, stage->linear);
  result.iterations = result.iterations * work + spent;
  return result;
}

static SporeLinearResult solve(void *data, const double *r, double tolerance, double *dv) {
  Stage *stage = data;
  const SporeDynamics *dynamics = stage->dynamics;
  SporeLinearOperator operator= {dynamics->data, 3 * dynamics->block_count, dynamics->multiply, dynamics->precondition,
                                 dynamics->cancel};
  SporeLinearResult result = iterate(stage, spore_pcg, &operator, r, tolerance, 1, dv);
  if (result.status != SPORE_LINEAR_INDEFINITE || !dynamics->take_tangent || !stage->at) return result;
  linearise_by(stage, SPORE_TANGENT_DEFINITE, stage->at, NULL);
  SporeLinearResult again = iterate(stage, spore_pcg, &operator, r, tolerance, 1, dv);
  again.iterations += result.iterations;
  return again;
}

/* Slipping friction adds a term to the Jacobian that is not symmetric: friction changes with the pressing force, and
 * not the other way round. Where contacts hold one another, as in a knot, Newton's method without that term converges
 * slowly or not at all. A alone is used where there is no such term, or where the whole system cannot be solved. */
static SporeLinearResult solve_whole(void *data, const double *r, double tolerance, double *dv) {
  Stage *stage = data;
  const SporeDynamics *dynamics = stage->dynamics;
  if (!dynamics->drags(dynamics->data)) return solve(data, r, tolerance, dv);
  SporeLinearOperator operator= {dynamics->data, 3 * dynamics->block_count, dynamics->multiply_dragged,
                                 dynamics->precondition_dragged, dynamics->cancel};
  SporeLinearResult whole = iterate(stage, spore_bicgstab, &operator, r, tolerance, 2, dv);
  if (whole.status == SPORE_LINEAR_CONVERGED) return whole;
  SporeLinearResult part = solve(data, r, tolerance, dv);
  part.iterations += whole.iterations;
  return part;
}

/* A factor of an earlier linearisation, applied once, serves a quasi-Newton method as well as an exact solution. */
static SporeLinearResult approximate(void *data, const double *r, double *dv) {
  Stage *stage = data;
  const SporeDynamics *dynamics = stage->dynamics;
  if (!dynamics->factorised(dynamics->data)) return solve(data, r, INNER_TOLERANCE, dv);
  dynamics->precondition(dynamics->data, r, dv);
  return (SporeLinearResult){SPORE_LINEAR_CONVERGED, 1, 0};
}

static double linearisation_cost(void *data) {
  Stage *stage = data;
  double cost = stage->dynamics->factor_cost(stage->dynamics->data);
  return cost > 0 ? cost : 1;
}

static void weigh(void *data, const double *x, double *y) {
  Stage *stage = data;
  stage->dynamics->mass_multiply(stage->dynamics->data, x, y);
}

static double kinetic_dot(void *data, const double *a, const double *b) {
  Stage *stage = data;
  stage->dynamics->mass_multiply(stage->dynamics->data, b, stage->work);
  return spore_vector_dot(3 * stage->dynamics->block_count, a, stage->work);
}

static double dual_norm(void *data, const double *r) {
  Stage *stage = data;
  size_t n = 3 * stage->dynamics->block_count;
  memset(stage->work, 0, n * sizeof(double));
  stage->dynamics->kick(stage->dynamics->data, r, 1, stage->work);
  return sqrt(spore_vector_dot(n, r, stage->work));
}

static double rounding(void *data, const double *v, bool stiff_axes) {
  Stage *stage = data;
  return stage->dynamics->rounding(stage->dynamics->data, stage->c, stiff_axes);
}

/* What contacts and links push. */
static double load(void *data, const double *v) {
  Stage *stage = data;
  const SporeDynamics *dynamics = stage->dynamics;
  dynamics->drift(dynamics->data, stage->qa, v, stage->c, stage->q, stage->v);
  memset(stage->force, 0, 3 * dynamics->block_count * sizeof *stage->force);
  dynamics->term_force(dynamics->data, stage->q, v, stage->force);
  return stage->c * dual_norm(stage, stage->force);
}

static SporeSystem stage_system(Stage *stage) {
  double gravity = stage->c * stage->dynamics->gravity_momentum;
  return (SporeSystem){.data = stage,
                       .count = 3 * stage->dynamics->block_count,
                       .switches = stage->dynamics->switches,
                       .cancel = stage->dynamics->cancel,
                       .residual = residual,
                       .linearise = linearise,
                       .linearise_whole = stage->dynamics->take_tangent ? linearise_whole : NULL,
                       .reuse = reuse,
                       .solve = solve,
                       .solve_whole = solve_whole,
                       .approximate = approximate,
                       .linearisation_cost = linearisation_cost,
                       .weigh = weigh,
                       .dot = kinetic_dot,
                       .norm = dual_norm,
                       .scale_x = gravity,
                       .scale_r = gravity,
                       .least = stage->c * stage->dynamics->least_force,
                       .load = load,
                       .rounding = rounding};
}

typedef enum Start { START_CHANGING, START_GOING, START_STILL } Start;

static void set_start(const Stage *stage, Start start, const double *change, double *v) {
  for (size_t i = 0; i < 3 * stage->dynamics->block_count; i++) {
    double going = start == START_STILL ? 0 : stage->va[i];
    v[i] = start == START_CHANGING ? going + change[i] : going;
  }
}

/* The first guess. Of three candidates the one nearest to the answer is taken: the velocity changes as in the step
 * before, where that is known; the velocity stays; or the body stands still. Where the step is long for the stiffness,
 * keeping the velocity stretches what is stiff: the change of the last step is then needed again, and where that is of
 * no use, only standing still starts with no more energy than there was. A candidate whose residual is within that of
 * gravity stretches nothing and is taken at once, unless the speed is below `slow`: such a speed may be only the error
 * of earlier answers, and a body at rest is to be found at rest. r: the residual at the guess. Returns the number of
 * evaluations. */
static size_t guess(Stage *stage, const double *change, double gravity, double slow, double *v, double *r) {
  double speed = sqrt(kinetic_dot(stage, stage->va, stage->va)), least = INFINITY;
  Start best = START_STILL, first = speed == 0 ? START_STILL : change && speed > slow ? START_CHANGING : START_GOING;
  size_t evaluations = 0;
  for (Start start = first; start <= START_STILL; start++) {
    set_start(stage, start, change, v);
    residual(stage, v, r);
    evaluations++;
    double norm = dual_norm(stage, r);
    if (norm <= gravity && speed > slow) return evaluations;
    if (norm < least) best = start, least = norm;
  }
  if (best == START_STILL) return evaluations;
  set_start(stage, best, change, v);
  residual(stage, v, r);
  return evaluations + 1;
}

static SporeNonlinearResult solve_system(const SporeSystem *system, const SporeSolverFields *fields, double *v,
                                         double *r, double *scratch) {
  const SporeDynamics *dynamics = ((const Stage *)system->data)->dynamics;
  SporeNonlinearOptions options = {(size_t)fields->newton_iterations, fields->tolerance};
  options.patience = dynamics->patience;
  if (dynamics->factor_patience) options.linear_patience = dynamics->factor_patience(dynamics->data);
  bool broyden = fields->nonlinear == SPORE_NONLINEAR_BROYDEN ||
                 (fields->nonlinear == SPORE_NONLINEAR_AUTOMATIC && dynamics->factor_cost(dynamics->data) > 0);
  return broyden ? spore_broyden(system, &options, v, r, scratch) : spore_newton(system, &options, v, r, scratch);
}

SporeStepResult spore_stage_solve(const SporeDynamics *dynamics, const SporeSolverFields *fields, double c,
                                  const double *qa, const double *va, const double *change, double *v,
                                  double *scratch) {
  assert(c > 0 && isfinite(c));
  assert(fields->newton_iterations > 0 && fields->linear_iterations > 0);
  assert(qa && va && v && scratch);
  assert(v != va);
  size_t n = 3 * dynamics->block_count;
  Stage stage = {.dynamics = dynamics, .qa = qa, .va = va, .c = c};
  stage.linear_iterations = (size_t)fields->linear_iterations;
  stage.q = scratch;
  stage.v = scratch + 2 * n;
  stage.force = scratch + 3 * n;
  stage.work = scratch + 4 * n;
  stage.from = scratch + 5 * n;
  stage.linear = scratch + 7 * n;
  stage.last = (SporeEvaluation){.q = stage.q, .f = stage.force};
  stage.kept = dynamics->evaluation && dynamics->evaluation(dynamics->data, &stage.last);
  double *r = scratch + (7 + SPORE_BICGSTAB_SCRATCH) * n;
  SporeSystem system = stage_system(&stage);
  size_t evaluations = guess(&stage, change, system.scale_r, fields->tolerance * system.scale_x, v, r);
  SporeNonlinearResult result = solve_system(&system, fields, v, r, r + n);
  if (dynamics->keep)
    dynamics->keep(dynamics->data,
                   &(SporeEquation){.c = c, .load = result.load, .qa = qa, .va = va, .v = v, .evaluated = stage.kept});
  return (SporeStepResult){.converged = result.converged,
                           .newton_iterations = result.iterations,
                           .linear_iterations = result.linear_iterations,
                           .force_evaluations = result.evaluations + evaluations,
                           .linearisations = result.linearisations,
                           .unsolved = result.unsolved,
                           .residual = result.residual};
}
