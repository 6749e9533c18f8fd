/* Preconditioner of a body: its diagonal blocks, or a factor of its whole matrix.
 *
 * Conjugate gradients with block-Jacobi are cheap where the step is short for the stiffness. They never converge where
 * the step is very long. The cost of the last steps with the present choice is compared with the estimated cost of the
 * other choice. Costs are counted in floating-point operations and not by a clock, so that every run chooses alike. */
#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/solve/local_assembly.h"

#define WORTH_ITERATIONS 2000 /* a factor that takes more work than this many iterations is not made */
#define WORTH_STATIC 12500    /* the same of a static body */
#define GAIN 1.25             /* cost of the present choice over the other, above which it changes */
#define PATIENCE 4            /* steps over which costs are compared */
#define PATIENCE_MAXIMUM 256
#define TRIAL_STEPS 128      /* after so many steps the choice of a factor is tested */
#define CONTACT_STEPS 32     /* the same among contacts, which come and go */
#define FACTOR_ITERATIONS 2. /* expected of conjugate gradients with the factor, a Newton iteration */
#define KEEP 4               /* steps that a linearisation is kept at first, and at most */
#define KEEP_MAXIMUM 64
#define TRIAL_MAXIMUM 32
/* Work is counted in operations of a product with the matrix. Operations of a dense factor are faster by these weights.
 * A Jacobian takes JACOBIAN_WORK a block; a force and the vectors of an iteration take the others a node. */
#define FACTOR_WEIGHT 0.25
#define SOLVE_WEIGHT 0.4
#define JACOBIAN_WORK 150.
#define FORCE_WORK 300.
#define BROYDEN_WORK 250.

/* Work of one iteration without its preconditioner: the product, and six vector operations. */
static double product_work(const SporeBody *body) {
  assert(body->preconditioner.matrix.block_count > 0);
  return 18. * body->preconditioner.matrix.row_start[body->preconditioner.matrix.block_count] +
         36. * (double)body->block_count;
}

double spore_body_gradient_work(const SporeBody *body) { return product_work(body) + 18. * (double)body->block_count; }

double spore_body_solve_work(const SporeBody *body) { return SOLVE_WEIGHT * body->preconditioner.factor.solve_flops; }

static double jacobian_work(const SporeBody *body) {
  return JACOBIAN_WORK * body->preconditioner.matrix.row_start[body->preconditioner.matrix.block_count];
}

double spore_body_factor_work(const SporeBody *body) {
  return FACTOR_WEIGHT * body->preconditioner.factor.factor_flops;
}

double spore_body_linearisation_work(const SporeBody *body) {
  return jacobian_work(body) + spore_body_factor_work(body);
}

double spore_body_iteration_work(const SporeBody *body) {
  assert(body->block_count > 0);
  return (FORCE_WORK + BROYDEN_WORK) * (double)body->block_count + spore_body_solve_work(body);
}

/* Time by work. Blocks of the matrix and of the factor are those of a spline of 200 x 200 control points; one thread.
 */
#define OPERATIONS_A_SECOND 2e9
#define MAKE_WORK 520.           /* a block of the matrix, its model's part and all */
#define ANALYSIS_WORK 290.       /* a block of the factor */
#define SOLVE_FLOPS_OF_BLOCK 36. /* of a block of the factor */

bool spore_world_body_work(const SporeWorld *world, uint32_t index, SporeBodyWork *work) {
  assert(index < world->body_count);
  const SporeBody *body = &world->bodies[index];
  const SporePreconditioner *own = &body->preconditioner;
  *work = (SporeBodyWork){.time_step_s = world->solver.time_step};
  if (body->role != SPORE_PASSIVE || !spore_integrator(body->method.integrator)->implicit) return false;
  if (own->matrix.block_count == 0) return false;
  double blocks = own->matrix.row_start[own->matrix.block_count],
         step = jacobian_work(body) + spore_body_gradient_work(body);
  double make = MAKE_WORK * blocks;
  if (own->factor.block_count > 0) {
    make += ANALYSIS_WORK / SOLVE_FLOPS_OF_BLOCK * own->factor.solve_flops;
    work->factor_s = spore_body_factor_work(body) / OPERATIONS_A_SECOND;
    step = fmin(step, spore_body_iteration_work(body));
  }
  work->make_s = make / OPERATIONS_A_SECOND;
  work->step_s = step / OPERATIONS_A_SECOND;
  return true;
}

static SporeFactorLayout layout_of(int linear) {
  if (linear == SPORE_LINEAR_BANDED) return SPORE_FACTOR_BANDED;
  return linear == SPORE_LINEAR_CHOLESKY ? SPORE_FACTOR_SPARSE : SPORE_FACTOR_AUTOMATIC;
}

bool spore_body_create_matrix(SporeBody *body, SporeError *error) {
  assert(!body->model || body->model->block_count == body->block_count);
  if (!body->model || !body->model->type->jacobian) return true;
  return spore_model_matrix_create(body->model, &body->preconditioner.matrix) ||
         spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the world"));
}

bool spore_body_create_factor(const SporeWorld *world, SporeBody *body, SporeError *error) {
  assert(body->held.count == 0 || body->held.blocks);
  spore_block_cholesky_clear(&body->preconditioner.factor);
  body->preconditioner.bare_c = 0;
  /* A matrix without couplings consists of diagonal blocks only. */
  if (body->preconditioner.matrix.block_count == 0 ||
      body->preconditioner.matrix.row_start[body->preconditioner.matrix.block_count] ==
          body->preconditioner.matrix.block_count)
    return true;
  double worth = spore_body_is_static(body) ? WORTH_STATIC : WORTH_ITERATIONS;
  if (!body->held.flags) body->held.flags = SPORE_NEW_ARRAY(uint8_t, body->preconditioner.matrix.block_room);
  if (!body->held.flags ||
      !spore_block_cholesky_create(&body->preconditioner.factor, &body->preconditioner.matrix,
                                   layout_of(world->solver.linear),
                                   worth / FACTOR_WEIGHT * spore_body_gradient_work(body), world->cancel))
    return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the world"));
  for (size_t i = 0; i < body->held.count; i++) body->held.flags[body->held.blocks[i]] = 1;
  return true;
}

bool spore_world_create_factors(SporeWorld *world, SporeError *error) {
  for (size_t b = 0; b < world->body_count; b++) {
    if (!spore_body_create_factor(world, &world->bodies[b], error)) return false;
    if (!spore_body_create_rows(&world->bodies[b]))
      return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the world"));
  }
  return true;
}

/* A banded factor takes less work than the matrix itself, so it is always chosen. So is any factor of a static body:
 * its steps are as long as steps can be. */
static bool wants_factor(const SporeBody *body) {
  return body->preconditioner.factor.band.block_count > 0 ||
         (body->preconditioner.factor.block_count > 0 && spore_body_is_static(body));
}

void spore_body_reset_choice(const SporeWorld *world, SporeBody *body) {
  body->preconditioner.choice = (SporeFactorChoice){.patience = PATIENCE, .keep = KEEP, .trial = PATIENCE};
  bool by_hand = world->solver.linear == SPORE_LINEAR_CHOLESKY || world->solver.linear == SPORE_LINEAR_BANDED;
  bool automatic = world->solver.linear == SPORE_LINEAR_AUTOMATIC;
  body->preconditioner.choice.factorised =
      (by_hand && body->preconditioner.factor.block_count > 0) || (automatic && wants_factor(body));
  body->preconditioner.factor_ready = false;
  body->preconditioner.bare_c = 0;
  if (body->preconditioner.coupled) spore_coupled_room_forget(body->preconditioner.coupled);
}

void spore_body_forget_steps(SporeWorld *world, SporeBody *body) {
  body->preconditioner.matrix_c = 0;
  body->history.step_s = 0;
  world->solve.watch.started = false;
  body->hopeless = 0;
  body->pause = body->impatience = (SporePause){0, 0};
  spore_body_reset_choice(world, body);
}

static void change(SporeBody *body, double iterations) {
  assert(iterations >= 0);
  SporeFactorChoice *choice = &body->preconditioner.choice;
  choice->factorised = !choice->factorised;
  choice->iterations = iterations;
  choice->steps = choice->votes = 0;
  choice->present = choice->other = 0;
}

/* Work of the step with conjugate gradients alone, and estimated work with a factor. Newton's method makes a factor in
 * each linearisation, and solves with it about FACTOR_ITERATIONS times an iteration. Broyden's keeps one for some
 * steps. */
static double work_without(const SporeBody *body, const SporeStepResult *result) {
  return (double)result->linear_iterations * spore_body_gradient_work(body) +
         (double)result->linearisations * jacobian_work(body);
}

static double expected_with(const SporeBody *body, const SporeStepResult *result, bool broyden) {
  double iterations = (double)result->newton_iterations;
  if (broyden) return spore_body_linearisation_work(body) / KEEP + iterations * spore_body_iteration_work(body);
  return (double)result->linearisations * spore_body_linearisation_work(body) +
         FACTOR_ITERATIONS * iterations * (spore_body_solve_work(body) + product_work(body));
}

/* Work of the step with a factor, and estimated work without, from the conjugate gradients before the change. */
static double work_with(const SporeBody *body, const SporeStepResult *result, uint32_t factors) {
  return (double)result->linearisations * jacobian_work(body) + factors * spore_body_factor_work(body) +
         (double)result->linear_iterations * (spore_body_solve_work(body) + product_work(body));
}

static double expected_without(const SporeBody *body, const SporeStepResult *result) {
  return (double)result->newton_iterations *
         (body->preconditioner.choice.iterations * spore_body_gradient_work(body) + jacobian_work(body));
}

/* Judges how long a linearisation is kept: as long as the extra iterations cost less than a new one. Where a new one is
 * needed in the middle of a step, the old one was kept too long. Where that does not happen for a while, the next may
 * be kept longer. */
static void judge_age(const SporeWorld *world, SporeBody *body, const SporeStepResult *result) {
  SporeFactorChoice *choice = &body->preconditioner.choice;
  SporeStart start = choice->start;
  choice->start = SPORE_START_NONE;
  if (start == SPORE_START_NONE) return;
  assert(choice->made <= world->state.step && body->preconditioner.matrix_step <= world->state.step);
  double iterations = (double)result->newton_iterations;
  uint32_t age = (uint32_t)(world->state.step - choice->made);
  if (start == SPORE_START_NEW) {
    choice->fresh = iterations;
    choice->excess = 0;
  } else if (result->linearisations == 0) {
    choice->excess += fmax(iterations - choice->fresh, 0) * spore_body_iteration_work(body);
    if (choice->excess > spore_body_linearisation_work(body)) body->preconditioner.matrix_c = 0;
  } else {
    choice->keep = age > 1 ? age : 1;
    choice->calm = 0;
    choice->trial = age > 1 ? PATIENCE : choice->trial < TRIAL_MAXIMUM ? 2 * choice->trial : TRIAL_MAXIMUM;
  }
  choice->made = body->preconditioner.matrix_step;
  if (++choice->calm < choice->trial) return;
  choice->calm = 0;
  if (choice->trial > PATIENCE) choice->trial /= 2;
  if (choice->keep < KEEP_MAXIMUM) choice->keep += (choice->keep + 1) / 2;
}

/* With couplings, Newton's method makes a new matrix in every iteration. The factor is kept as long as the additional
 * conjugate gradients are less work than a new factor. */
static void judge_kept_factor(SporeBody *body, const SporeStepResult *result) {
  assert(body->preconditioner.factor.block_count > 0);
  SporeFactorChoice *choice = &body->preconditioner.choice;
  if (!body->preconditioner.factor_kept || result->newton_iterations == 0) return;
  double iterations = (double)result->newton_iterations, linear = (double)result->linear_iterations / iterations;
  if (choice->factors > 0) {
    choice->linear = linear;
    choice->debt = 0;
    return;
  }
  choice->debt += fmax(linear - choice->linear, 0) * iterations * (spore_body_solve_work(body) + product_work(body));
  if (choice->debt > spore_body_factor_work(body) || result->unsolved > 0) body->preconditioner.factor_kept = false;
}

/* Chooses whether the body is factorised. alone: no contact or link couples bodies. With couplings a factor would not
 * serve as the start of Broyden's method. */
static void choose(const SporeWorld *world, SporeBody *body, const SporeStepResult *result, bool alone) {
  assert(body->preconditioner.choice.patience >= 1);
  SporeFactorChoice *choice = &body->preconditioner.choice;
  uint32_t factors = choice->factors;
  choice->factors = 0;
  if (choice->factorised && (spore_body_is_static(body) || (alone && wants_factor(body)))) return;
  if (choice->needed) {
    /* A body that did not converge without a factor may converge now. If not, that step is taken again. */
    if (++choice->steps < TRIAL_STEPS) return;
    choice->needed = choice->stuck = false;
    change(body, 0);
    return;
  }
  if (result->newton_iterations == 0) return; /* at rest: there is nothing to compare */
  double iterations = (double)result->linear_iterations / (double)result->newton_iterations;
  bool broyden = alone && world->solver.nonlinear != SPORE_NONLINEAR_NEWTON;
  choice->present += choice->factorised ? work_with(body, result, factors) : work_without(body, result);
  choice->other += choice->factorised ? expected_without(body, result) : expected_with(body, result, broyden);
  choice->steps++;
  if (++choice->votes >= choice->patience) {
    bool better = choice->present > GAIN * choice->other;
    choice->votes = 0;
    choice->present = choice->other = 0;
    if (better) {
      if (choice->factorised && choice->patience < PATIENCE_MAXIMUM) choice->patience *= 2;
      change(body, iterations);
      return;
    }
  }
  if (choice->factorised && choice->steps >= (alone ? TRIAL_STEPS : CONTACT_STEPS)) {
    change(body, iterations);
    choice->votes = choice->patience - 1; /* one step with the other choice decides */
  }
}

/* The same for a small island of rigid bodies: whether its matrix is factorised as a whole. Contacts that do not
 * converge are no sign that this would help: they come and go. */
static bool choose_together(const SporeIslandSystem *system) {
  const SporeStepResult *result = &system->island->result;
  bool hard = result->unsolved > 0 || (!result->converged && system->island->contact_count == 0), again = false;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeFactorChoice *choice = &spore_island_system_body(system, b, &site)->preconditioner.choice;
    if (hard && !choice->needed) {
      choice->needed = true;
      choice->steps = 0;
      again |= !result->converged;
    } else if (choice->needed && ++choice->steps >= TRIAL_STEPS) {
      choice->needed = false;
    }
  }
  return again;
}

bool spore_island_choose(SporeWorld *world, const SporeIsland *island) {
  assert(island->kept_count <= island->body_count);
  assert(island->body_start + island->body_count <= world->body_count);
  const SporeStepResult *result = &island->result;
  SporeIslandSystem system = {.world = world, .island = island};
  if (spore_island_system_is_small(&system)) return choose_together(&system);
  bool again = false, alone = !spore_island_system_couples(&system);
  for (size_t i = 0; i < island->kept_count; i++) {
    SporeBody *body = &world->bodies[world->solve.island_bodies[island->body_start + i]];
    SporeFactorChoice *choice = &body->preconditioner.choice;
    if (body->preconditioner.factor.block_count == 0) continue;
    if (island->multirate && !spore_integrator(body->method.integrator)->implicit)
      continue; /* its matrix was not used */
    judge_age(world, body, result);
    judge_kept_factor(body, result);
    if (world->solver.linear != SPORE_LINEAR_AUTOMATIC) continue;
    /* Newton's method that did not converge may converge with a factor: only a factor takes the whole tangent. */
    bool loose = island->contact_count + island->spring_count == 0; /* with terms the tangent is not taken whole */
    bool stuck = loose && !result->converged && body->model->type->tangent != NULL;
    if ((result->unsolved > 0 || stuck) && !choice->factorised) {
      change(body, 0);
      choice->needed = true;
      choice->stuck = stuck;
      again |= !result->converged;
    } else {
      choose(world, body, result, alone);
    }
  }
  return again;
}
