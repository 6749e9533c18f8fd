/* Bodies whose matrix changes its pattern while the world runs: their held blocks, and their factor that is made later.
 */
#include <assert.h>

#include "core/sim/world_private.h"

static size_t nodes_in_use(const SporeBody *body) {
  assert(body->model->spare_count <= body->model->node_count);
  return body->model->node_count - body->model->spare_count;
}

void spore_body_list_held(SporeBody *body) {
  assert(body->changing.pinned && body->held.blocks);
  body->held.count = 0;
  for (size_t i = 0; i < nodes_in_use(body); i++)
    if (body->changing.pinned[i]) body->held.blocks[body->held.count++] = (uint32_t)i;
  body->held.pin_count = body->held.count;
  for (size_t i = nodes_in_use(body); i < body->block_count; i++) body->held.blocks[body->held.count++] = (uint32_t)i;
  for (size_t i = 0; body->held.flags && i < body->block_count; i++)
    body->held.flags[i] = i >= nodes_in_use(body) || body->changing.pinned[i];
}

void spore_body_lay_out_matrix(SporeBody *body) {
  assert(body->model->type->settle && body->model->type->pattern);
  SporeChangingMatrix *changing = &body->changing;
  spore_block_pattern_empty(&changing->pattern);
  changing->pattern.block_count = body->block_count;
  body->model->type->pattern(body->model, &changing->pattern);
  spore_block_matrix_lay_out(&body->preconditioner.matrix, &changing->pattern, &changing->room);
  body->model->type->settle(body->model, &body->preconditioner.matrix);
}

#define CALM_STEPS 16 /* without a change, before a factor is made: while blades keep cutting, it would not last */

bool spore_world_tidy(SporeWorld *world) {
  bool done = false;
  for (uint32_t b = 0; world->topology.cuts.corner_count + world->topology.line_count > 0 && b < world->body_count;
       b++) {
    SporeBody *body = &world->bodies[b];
    if (!body->changing.factor_is_old || world->state.step < body->changing.step + CALM_STEPS) continue;
    body->changing.factor_is_old = false;
    if (!spore_body_create_factor(world, body, NULL)) continue; /* no memory: conjugate gradients stay */
    spore_body_reset_choice(world, body);
    done = true;
  }
  return done;
}
