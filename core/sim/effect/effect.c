/* Bodies that become effects and physics again while the world runs, and the stage that moves them. */
#include "core/sim/effect/effect.h"

#include <assert.h>
#include <string.h>

#include "core/base/text.h"
#include "core/sim/effect/drops.h"
#include "core/sim/effect/shape.h"
#include "core/sim/world_private.h"

SporeEffectForm spore_model_effect_form(const SporeModel *model) {
  if (model->type->particles)
    return model->type->particles->puff || !model->type->spheres ? SPORE_EFFECT_CARRIED : SPORE_EFFECT_POURED;
  return spore_model_is_nodal(model) ? SPORE_EFFECT_SHAPED : SPORE_EFFECT_STILL;
}

bool spore_world_body_is_effect(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].effect.on;
}

bool spore_world_has_effects(const SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].effect.on) return true;
  return false;
}

/* Particles go with the air or the flow; those out of the world stay there. */
static void carry(SporeWorld *world, SporeBody *body) {
  const double *q = world->state.q + body->q_offset, *v = world->state.v + body->v_offset;
  double *next_q = world->state.next_q + body->q_offset, *next_v = world->state.next_v + body->v_offset;
  body->model->type->particles->carry(body->model, spore_body_gravity(world, body), world->solver.time_step, q, v,
                                      next_q, next_v);
  for (size_t i = 0; i < body->held.count; i++) {
    size_t at = 3 * body->held.blocks[i];
    memcpy(next_q + at, q + at, 3 * sizeof *q);
    memset(next_v + at, 0, 3 * sizeof *v);
  }
}

/* Nodes that came with cuts or with knots have no place of time 0. */
static bool keeps_nodes(const SporeBody *body) { return !body->altered && !body->refinement.possible; }

/* Leaves the body where it is. False: it was left there before. */
static bool stand(SporeWorld *world, SporeBody *body) {
  if (body->effect.settled) return false;
  memcpy(world->state.next_q + body->q_offset, world->state.q + body->q_offset, body->q_count * sizeof(double));
  return body->effect.settled = true;
}

static void move(SporeWorld *world, SporeBody *body) {
  SporeEffectForm form = spore_model_effect_form(body->model);
  if (form == SPORE_EFFECT_CARRIED) {
    carry(world, body);
  } else if (form == SPORE_EFFECT_POURED) {
    if (spore_drops_stay(world, body)) return;
    spore_body_pour(world, body);
    spore_drops_watch(world, body);
  } else {
    bool shaped = form == SPORE_EFFECT_SHAPED && keeps_nodes(body);
    if (!(shaped ? spore_body_shape_effect(world, body) : stand(world, body))) return;
    memset(world->state.next_v + body->v_offset, 0, 3 * body->block_count * sizeof(double));
  }
  spore_body_mark_changed(world, body);
}

void spore_world_move_effects(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].effect.on) move(world, &world->bodies[b]);
}

/* Drops are read by nothing that touches: the grid only tells what is near them. */
static void set_apart(SporeWorld *world, uint32_t index) {
  const SporeBody *body = &world->bodies[index];
  if (body->effect.drops.from && world->contact.grid) spore_grid_set_apart(world->contact.grid, index, body->effect.on);
}

bool spore_world_create_effects(SporeWorld *world, SporeError *error) {
  for (uint32_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (!body->model || spore_model_effect_form(body->model) != SPORE_EFFECT_POURED) continue;
    if (!spore_body_make_drops(body, error)) return false;
    if (!spore_drops_make_rest(world, body))
      return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the world"));
    set_apart(world, b);
  }
  return true;
}

/* Why the body cannot become that (translated), or NULL. */
static const char *fault_of(const SporeBody *body, bool on) {
  if (!on && body->effect.too_long)
    return _("the time step is too long for its physics; it stays an effect until the scene has a smaller time_step");
  return NULL;
}

void spore_world_set_effect(SporeWorld *world, uint32_t index, bool on) {
  assert(index < world->body_count);
  SporeBody *body = &world->bodies[index];
  if (!body->model || body->effect.on == on) return;
  const char *fault = fault_of(body, on);
  if (fault) {
    spore_world_report(world, "%s: %s", body->name, fault);
    return;
  }
  spore_world_wake_all(world);
  body->effect.on = on;
  body->effect.settled = false;
  spore_drops_wake(world, body);
  set_apart(world, index);
  world->solve.watch.started = false;
  spore_body_thaw(body);
  spore_body_forget_steps(world, body);
  spore_body_put(world, index);
  world->schedule.stale = true;
}

void spore_world_reset_effects(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBodyEffect *effect = &world->bodies[b].effect;
    if (effect->on != effect->at_start) spore_world_set_effect(world, (uint32_t)b, effect->at_start);
    effect->settled = false;
    spore_drops_wake(world, &world->bodies[b]);
  }
}
