/* Factors of the bodies' own matrices, and solutions by them. */
#include "core/sim/solve/island_system.h"

#define FLOPS_TO_ROUND 1e5 /* of a solution: below, a factor in full precision is fast enough */

void spore_island_system_body_diagonal(const SporeIslandSystem *system, const SporeBody *body, double *blocks) {
  assert(body->block_count == body->model->block_count);
  if (!spore_island_system_assembles(system, body)) {
    const double *mass = spore_island_system_mass(system, body);
    for (size_t e = 0; e < 9 * body->block_count; e++) blocks[e] = spore_island_system_inertia(system, body) * mass[e];
    for (size_t e = 0; body->preconditioner.rows && e < 9; e++) blocks[9 + e] += body->preconditioner.turning[e];
    return;
  }
  for (size_t i = 0; i < body->block_count; i++)
    memcpy(blocks + 9 * i, body->preconditioner.matrix.values + 9 * (size_t)body->preconditioner.matrix.diagonal[i],
           9 * sizeof *blocks);
}

void spore_body_factorise(SporeBody *body, const double *blocks, bool alone) {
  assert(body->preconditioner.matrix.block_count == body->block_count);
  bool may_round = body->preconditioner.factor.solve_flops > FLOPS_TO_ROUND;
  body->preconditioner.factor_alone = alone;
  body->preconditioner.factor_ready = spore_block_cholesky_factorise(
      &body->preconditioner.factor, &body->preconditioner.matrix, blocks, body->held.flags, may_round);
  body->preconditioner.factor_kept = body->preconditioner.factor_ready && !alone;
  body->preconditioner.bare_c = alone && body->preconditioner.factor_ready ? body->preconditioner.matrix_c : 0;
  body->preconditioner.bare_c2 = body->preconditioner.matrix_c2;
  body->preconditioner.choice.factors++;
  body->preconditioner.factors_made++;
}

bool spore_body_has_bare_factor(const SporeBody *body) {
  const SporePreconditioner *its = &body->preconditioner;
  return its->bare_c > 0 && its->bare_c == its->matrix_c && its->bare_c2 == its->matrix_c2;
}

void spore_island_system_solve_bodies(const SporeIslandSystem *system, const double *r, double *z) {
  assert(r != z);
  const double *inverse = spore_island_system_precondition_blocks(system);
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    if (body->preconditioner.factor_ready)
      spore_block_cholesky_solve(&body->preconditioner.factor, r + site->v, z + site->v);
    else spore_blocks_apply(inverse + 3 * site->v, body->block_count, r + site->v, z + site->v);
  }
}
