/* How a body is preconditioned: by its diagonal blocks, or by a factor of its whole matrix.
 *
 * Conjugate gradients with block-Jacobi are cheap where the step is short for the stiffness, and never finish where it
 * is very long. What the last steps cost one way is compared with what they would have cost the other way, counted in
 * floating-point operations and not by a clock, so that every run chooses alike. */
#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

#define WORTH_ITERATIONS 2000 /* a factor that costs more than so many iterations is not made */
#define GAIN 1.25             /* what a change must promise */
#define PATIENCE 4            /* steps in a row that must promise it */
#define PATIENCE_MAXIMUM 256
#define TRIAL_STEPS 128      /* a factor is put to the question so often */
#define FACTOR_ITERATIONS 2. /* expected of conjugate gradients with the factor, a Newton iteration */

/* Of one iteration without its preconditioner: the product, and six vector operations. */
static double product_flops(const SporeBody *body) {
  return 18. * body->matrix.row_start[body->matrix.block_count] + 36. * (double)body->block_count;
}

static double jacobi_flops(const SporeBody *body) { return product_flops(body) + 18. * (double)body->block_count; }

bool spore_world_compile_factors(SporeWorld *world, SporeError *error) {
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (body->matrix.block_count == 0) continue;
    body->held_flags = SPORE_NEW_ARRAY(uint8_t, body->block_count);
    if (!body->held_flags ||
        !spore_block_cholesky_create(&body->factor, &body->matrix, WORTH_ITERATIONS * jacobi_flops(body)))
      return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the world"));
    for (size_t i = 0; i < body->held_count; i++) body->held_flags[body->held[i]] = 1;
  }
  return true;
}

void spore_body_reset_choice(SporeBody *body) {
  body->choice = (SporeFactorChoice){.patience = PATIENCE};
  body->factor_ready = false;
}

static void change(SporeBody *body, double iterations) {
  SporeFactorChoice *choice = &body->choice;
  choice->factorised = !choice->factorised;
  choice->iterations = iterations;
  choice->votes = choice->steps = 0;
}

/* True where the factor promises less work than block-Jacobi took. */
static bool factor_pays(const SporeBody *body, const SporeStepResult *result) {
  double linearisations = result->linearisations > 0 ? (double)result->linearisations : 1;
  double before = (double)result->linear_iterations * jacobi_flops(body);
  double after = linearisations * body->factor.factor_flops + FACTOR_ITERATIONS * (double)result->newton_iterations *
                                                                  (body->factor.solve_flops + product_flops(body));
  return before > GAIN * after;
}

/* True where the factor takes more work than block-Jacobi did before. */
static bool factor_disappoints(const SporeBody *body, const SporeStepResult *result) {
  double linearisations = result->linearisations > 0 ? (double)result->linearisations : 1;
  double now = linearisations * body->factor.factor_flops +
               (double)result->linear_iterations * (body->factor.solve_flops + product_flops(body));
  double before = body->choice.iterations * (double)result->newton_iterations * jacobi_flops(body);
  return now > GAIN * before;
}

static void choose(SporeBody *body, const SporeStepResult *result) {
  SporeFactorChoice *choice = &body->choice;
  if (choice->needed) {
    /* What once did not converge without a factor may do now; where not, that step is taken again. */
    if (++choice->steps < TRIAL_STEPS) return;
    choice->needed = false;
    change(body, 0);
    return;
  }
  if (result->newton_iterations == 0) return; /* at rest: nothing to learn */
  double iterations = (double)result->linear_iterations / (double)result->newton_iterations;
  bool other = choice->factorised ? factor_disappoints(body, result) : factor_pays(body, result);
  choice->votes = other ? choice->votes + 1 : 0;
  choice->steps++;
  if (choice->votes >= choice->patience) {
    if (choice->factorised && choice->patience < PATIENCE_MAXIMUM) choice->patience *= 2;
    change(body, iterations);
  } else if (choice->factorised && choice->steps >= TRIAL_STEPS) {
    change(body, iterations);
  }
}

bool spore_island_choose(SporeWorld *world, const SporeIsland *island) {
  const SporeStepResult *result = &island->result;
  bool again = false;
  for (size_t i = 0; i < island->kept_count; i++) {
    SporeBody *body = &world->bodies[world->island_bodies[island->body_start + i]];
    SporeFactorChoice *choice = &body->choice;
    if (body->factor.block_count == 0) continue;
    if (result->unsolved > 0 && !choice->factorised) {
      change(body, 0);
      choice->needed = true;
      again |= !result->converged;
    } else {
      choose(body, result);
    }
  }
  return again;
}
