/* Change of a body's level while the world runs: the state of one level becomes that of another, or the body stays as
 * it is and the monitor reports the reason.
 *
 * Positions and velocities follow material points (fit.c). Linear and angular momentum of a free body are kept. Where
 * the internal energy grows, the kinetic energy of the remaining motion shrinks as much. Links and pulls keep their
 * points, jaws and friction keep their spheres. */
#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "core/base/text.h"
#include "core/body/momentum.h"
#include "core/constraint/pin.h"
#include "core/sim/world_private.h"

#define WEIGHT 9.81 /* N/kg */

/* Whether a needle leads the body or goes through it: such ends exist at one level only. Jaws hold spheres, which each
 * level has. */
static bool is_sewn(const SporeWorld *world, uint32_t index) {
  assert(index < world->body_count);
  const SporeMapping *spheres = &world->bodies[index].collision.spheres;
  for (size_t i = 0; i < world->tools.count; i++)
    for (int part = 1; part < SPORE_TOOL_BODIES; part++)
      if (world->tools.all[i]->bodies[part] == index) return true;
  for (size_t i = world->links.term_count; i < world->links.term_count + world->links.hold_count; i++) {
    const SporeEnd *end = &world->links.springs[i].a;
    if (world->links.active[i] && end->body == index && end->mapping != spheres) return true;
  }
  return false;
}

static const char *fault_of(const SporeWorld *world, uint32_t index, SporeLodGrade level) {
  assert(index < world->body_count);
  assert((unsigned)level < SPORE_LOD_COUNT);
  const SporeBody *body = &world->bodies[index];
  if (!body->lod || !body->lod->level[level].model) return _("it has no such level; add one to its fidelity");
  if (body->frozen) return _("it is frozen; thaw it first");
  if (body->effect.on) return _("an effect moves it; give it back to physics first");
  if (body->altered) return _("it was cut, torn or coagulated, which no other level knows of; start again from time 0");
  if (is_sewn(world, index))
    return _("a needle leads it or a thread goes through it, at one level alone; free it first");
  return NULL;
}

static double own_energy(const SporeModel *model, const double *q, const double *v) {
  return model->type->potential(model, q) + spore_model_motion(model, q, v, NULL).kinetic;
}

/* Change of momentum by the change of level, N s. */
static double momentum_missed(const SporeModel *from, const double *q, const double *v, const SporeModel *to,
                              const double *q1, const double *v1) {
  SporeMotion before = spore_model_motion(from, q, v, NULL);
  SporeMotion after = spore_model_motion(to, q1, v1, &before.centre);
  assert(before.mass > 0 && after.mass > 0);
  double extent = sqrt(spore_mat3_trace(after.inertia) / after.mass);
  return fmax(spore_vec3_distance(before.momentum, after.momentum),
              spore_vec3_distance(before.angular, after.angular) / extent);
}

/* Kinetic and internal energy of the candidate, less that of the body, J. */
static double energy_gained(const SporeWorld *world, const SporeBody *body, SporeLodGrade to) {
  assert(body->lod && body->lod->level[to].model);
  const SporeLod *levels = body->lod;
  return own_energy(levels->level[to].model, levels->q, levels->v) -
         own_energy(body->model, world->state.q + body->q_offset, world->state.v + body->v_offset);
}

static void note_change(const SporeWorld *world, const SporeBody *body, SporeLodGrade to, double error) {
  SporeLod *levels = body->lod;
  const SporeLodLevel *level = &levels->level[to];
  const double *q = world->state.q + body->q_offset, *v = world->state.v + body->v_offset;
  double gained = energy_gained(world, body, to);
  SporeLodState *state = &levels->state;
  state->energy = state->changes ? fmax(state->energy, gained) : gained;
  state->error = fmax(state->error, error);
  state->changes++;
  state->level = to;
  if (body->held.count == 0 && level->held_count == 0)
    state->momentum = fmax(state->momentum, momentum_missed(body->model, q, v, level->model, levels->q, levels->v));
}

/* Makes the body's part of the next state the state between two steps: its solver and the model know nothing of the
 * state before. */
static void take_state(SporeWorld *world, SporeBody *body) {
  spore_body_mark_changed(world, body);
  spore_world_advance_state(world);
  spore_body_forget_steps(world, body);
  if (!body->model) return;
  if (body->model->type->forget) body->model->type->forget(body->model);
  spore_body_set_mass(world, body);
}

/* Places what follows from the state: spheres and the ends of links; and shows the state to the reader. */
static void show_state(SporeWorld *world) {
  spore_world_map_spheres(world);
  spore_world_link(world);
  spore_world_publish(world);
}

static void accept(SporeWorld *world, uint32_t index, SporeLodGrade to) {
  assert(world->bodies[index].grade != to);
  SporeBody *body = &world->bodies[index];
  SporeVec3 pulled;
  bool pull = spore_world_pulled_point(world, index, &pulled);
  spore_world_exchange_lod(world, index, to);
  memcpy(world->state.next_q + body->q_offset, body->lod->q, body->q_count * sizeof(double));
  memcpy(world->state.next_v + body->v_offset, body->lod->v, 3 * body->block_count * sizeof(double));
  take_state(world, body);
  spore_body_put(world, index);
  if (pull) spore_world_pull_by(world, index, pulled);
  show_state(world);
}

static void log_change(SporeWorld *world, uint32_t index, SporeLodGrade from, SporeLodCause by, double figure) {
  SporeLodSystem *system = &world->levels;
  system->log[system->change_count++ % SPORE_LOD_LOG] = (SporeLodChange){.body = index,
                                                                         .from = from,
                                                                         .to = world->bodies[index].grade,
                                                                         .time_s = spore_world_time_s(world),
                                                                         .by = by,
                                                                         .figure = figure};
}

/* Whether the candidate is refused, and the reason as text. It may have more energy than the body only by what lifting
 * the body by the tolerance takes: the levels' fineness does not explain more. */
static bool refuses(const SporeWorld *world, const SporeBody *body, SporeLodGrade to, double error, char *text,
                    size_t size) {
  double own = own_energy(body->model, world->state.q + body->q_offset, world->state.v + body->v_offset);
  double gained = energy_gained(world, body, to), most = own + WEIGHT * body->total_mass * body->lod->tolerance;
  if (!(error <= body->lod->tolerance))
    snprintf(
        text, size,
        _("a point of it would move %.3g m, and level_tolerance is %.3g m; wait until it is bent less, or make the "
          "level finer"),
        error, body->lod->tolerance);
  else if (!(gained <= most))
    snprintf(text, size,
             _("it would add %.3g J to the %.3g J that the body has; wait until it is bent less, or make the level "
               "finer"),
             gained, own);
  else return false;
  return true;
}

/* Fits the level and looks at it. False: it is refused. */
static bool is_good(const SporeWorld *world, uint32_t index, SporeLodGrade to, double *error, char *reason,
                    size_t size) {
  const SporeBody *body = &world->bodies[index];
  const char *fault = fault_of(world, index, to);
  if (fault) {
    snprintf(reason, size, "%s", fault);
    return false;
  }
  spore_lod_fit(world, body, to);
  *error = spore_lod_error(body->lod, to);
  return !refuses(world, body, to, *error, reason, size);
}

bool spore_world_try_lod(SporeWorld *world, uint32_t index, SporeLodGrade to, SporeLodCause cause, double figure,
                         char *reason, size_t size) {
  assert(index < world->body_count);
  assert((unsigned)to < SPORE_LOD_COUNT && world->bodies[index].grade != to);
  SporeBody *body = &world->bodies[index];
  SporeLodGrade from = body->grade;
  double error;
  if (!is_good(world, index, to, &error, reason, size)) {
    if (body->lod) body->lod->state.refused++;
    return false;
  }
  note_change(world, body, to, error);
  accept(world, index, to);
  log_change(world, index, from, cause, figure);
  return true;
}

void spore_world_change_lod(SporeWorld *world, uint32_t index, SporeLodGrade to) {
  assert(index < world->body_count);
  assert((unsigned)to < SPORE_LOD_COUNT);
  const SporeBody *body = &world->bodies[index];
  char reason[300];
  if (body->grade == to) return;
  if (!spore_world_try_lod(world, index, to, SPORE_LOD_BY_HAND, 0, reason, sizeof reason))
    spore_world_report(world, _("%s: does not change to level %s: %s"), body->name, spore_lod_names[to], reason);
  else if (to != SPORE_LOD_FINE && spore_world_may_be_cut(world, index))
    spore_world_report(world, _("%s: at level %s it is neither cut nor torn; change it to level fine before"),
                       body->name, spore_lod_names[to]);
}

void spore_world_set_lod(SporeWorld *world, uint32_t index, SporeLodGrade to) {
  assert(index < world->body_count);
  assert((unsigned)to < SPORE_LOD_COUNT);
  SporeBody *body = &world->bodies[index];
  if (!body->lod || body->grade == to) return;
  assert(body->lod->level[to].model);
  spore_world_wake(world, index);
  spore_world_exchange_lod(world, index, to);
  body->lod->state.level = to;
  spore_world_set_state(world, index, body->lod->level[to].rest_q, body->lod->level[to].rest_v);
}

void spore_world_set_state(SporeWorld *world, uint32_t index, const double *q, const double *v) {
  assert(index < world->body_count);
  assert(q && v);
  SporeBody *body = &world->bodies[index];
  spore_world_wake_all(world);
  memcpy(world->state.next_q + body->q_offset, q, body->q_count * sizeof *q);
  memcpy(world->state.target_q + body->q_offset, q, body->q_count * sizeof *q);
  memcpy(world->state.next_v + body->v_offset, v, 3 * body->block_count * sizeof *v);
  if (body->parking_gap > 0) spore_body_find_parked(body, q);
  body->effect.settled = false;
  spore_pin_filter(body->held.blocks, body->held.count, world->state.next_v + body->v_offset);
  take_state(world, body);
  spore_body_thaw(body);
  spore_contacts_forget(world);
  spore_world_lose_lines(world);
  if (body->role == SPORE_ACTIVE) spore_world_follow_tools(world, index);
  show_state(world);
}
