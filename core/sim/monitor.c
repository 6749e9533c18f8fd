/* What to do when a step goes wrong. The last good state is still in the world's q and v: it is stepped again in
 * smaller steps and implicitly; a body that cannot be helped is held where it was good, and the others go on. */
#include <float.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core/base/text.h"
#include "core/math/vector.h"
#include "core/sim/world_private.h"

#define SUBSTEPS_MAXIMUM 8
/* An answer that misses its tolerance by no more than this factor is counted and told of, but stands: a step again
 * would cost more than it mends. So does one that misses this part of the load and has not gained energy. */
#define MISS_TO_STAND 10
#define MISS_OF_LOAD 1e-3
#define PAUSE_MAXIMUM 32 /* steps */

static bool finite_all(const double *values, size_t count) { return spore_vector_within(count, values, DBL_MAX); }

/* Fastest block of a body that has weight, m/s. */
static double top_speed(const SporeBody *body, const double *v) {
  double top = 0;
  for (size_t i = 0; i < body->block_count; i++)
    if (body->model->block_mass[i] > 0) top = fmax(top, spore_vec3_length(spore_vec3_load(v + 3 * i)));
  return top;
}

void spore_island_examine(SporeWorld *world, SporeIsland *island) {
  double top = world->solver.maximum_speed;
  island->trouble = island->result.converged ? SPORE_TROUBLE_NONE : SPORE_TROUBLE_NOT_CONVERGED;
  island->offender = world->island_bodies[island->body_start];
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->island_bodies[island->body_start + i];
    const SporeBody *body = &world->bodies[b];
    const SporeSite *site = &world->local_sites[b];
    const double *q = island->q1 + site->q, *v = island->v1 + site->v;
    /* A block this slow in each direction is slow enough; that is nearly always so. */
    if (spore_vector_within(3 * body->block_count, v, 0.5 * top) && finite_all(q, body->q_count)) continue;
    bool finite = finite_all(q, body->q_count) && finite_all(v, 3 * body->block_count);
    double speed = finite ? top_speed(body, v) : HUGE_VAL;
    if (speed <= top) continue;
    top = speed;
    island->offender = b;
    island->trouble = finite ? SPORE_TROUBLE_SPEED : SPORE_TROUBLE_NOT_FINITE;
    if (!finite) return;
  }
}

/* A body whose own forces are not finite at the last good state, or SPORE_NO_BODY. Leaves v1 undefined. */
static uint32_t broken_model(SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->island_bodies[island->body_start + i];
    const SporeBody *body = &world->bodies[b];
    double *f = island->v1;
    memset(f, 0, 3 * body->block_count * sizeof *f);
    const double *q = world->q + body->q_offset;
    body->model->type->force(body->model, q, q, world->v + body->v_offset, f);
    if (!finite_all(f, 3 * body->block_count)) return b;
  }
  return SPORE_NO_BODY;
}

static void prescribe(SporeWorld *world, SporeEnd *end, uint32_t body) {
  if (end->body != body) return;
  const SporeVec3 none = {0, 0, 0};
  end->prescribed = true;
  end->velocity = end->offset = none;
  end->position = spore_mapping_position(end->mapping, end->point, world->q + world->bodies[body].q_offset);
}

/* Takes the body out of the island for good; its terms see it standing still. */
static void freeze(SporeWorld *world, SporeIsland *island, uint32_t index) {
  uint32_t *bodies = world->island_bodies + island->body_start;
  world->bodies[index].frozen = true;
  if (!spore_model_is_nodal(world->bodies[index].model))
    spore_body_turn_mass(world, &world->bodies[index], world->q + world->bodies[index].q_offset);
  size_t at = 0;
  while (bodies[at] != index) at++;
  memmove(bodies + at, bodies + at + 1, (island->kept_count - at - 1) * sizeof *bodies);
  bodies[--island->kept_count] = index;
  for (size_t i = 0; i < island->contact_count; i++) {
    SporeContactTerm *term = &world->contacts[world->contact_order[island->contact_start + i]];
    prescribe(world, &term->a, index);
    prescribe(world, &term->b, index);
  }
  for (size_t i = 0; i < island->spring_count; i++) {
    SporeSpringTerm *term = &world->springs[world->spring_order[island->spring_start + i]];
    prescribe(world, &term->a, index);
    prescribe(world, &term->b, index);
  }
}

/* Implicit Euler stands what others do not, where it has Jacobians to go by; particles are best helped by smaller steps
 * alone, of a method that remembers nothing. */
static SporeIntegratorKind mending_method(const SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++)
    if (!world->bodies[world->island_bodies[island->body_start + i]].model->type->rates)
      return SPORE_INTEGRATOR_IMPLICIT_EULER;
  return SPORE_INTEGRATOR_SYMPLECTIC_EULER;
}

static void try_again(SporeWorld *world, SporeIsland *island, size_t substeps) {
  spore_island_gather(world, island);
  substeps *= island->substeps;
  island->result = spore_island_advance(world, island, mending_method(world, island), substeps);
  island->mending_substeps += substeps;
  spore_island_examine(world, island);
}

static double energy(const SporeWorld *world, const SporeIsland *island, const SporeSite *sites, const double *q,
                     const double *v) {
  double sum = 0;
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->island_bodies[island->body_start + i];
    const SporeBody *body = &world->bodies[b];
    const double *local = q + sites[b].q;
    sum += spore_body_kinetic_energy(world, body, v + sites[b].v) + spore_body_gravity_energy(world, body, local) +
           body->model->type->potential(body->model, local);
  }
  for (size_t i = 0; i < island->contact_count; i++)
    sum += spore_contact_term_energy(&world->contacts[world->contact_order[island->contact_start + i]], sites, q);
  for (size_t i = 0; i < island->spring_count; i++)
    sum += spore_spring_term_energy(&world->springs[world->spring_order[island->spring_start + i]], sites, q);
  return sum;
}

/* More than when the step began, tools being where they are now, and by more than a part of what gravity gives in a
 * step. */
static bool gained_energy(const SporeWorld *world, const SporeIsland *island) {
  double speed = world->solver.time_step * island->gravity_momentum;
  double before = energy(world, island, world->world_sites, world->q, world->v);
  return !(energy(world, island, world->local_sites, island->q1, island->v1) <= before + MISS_OF_LOAD * speed * speed);
}

/* Whether an answer that is not solved to tolerance will do; `miss`: what it may miss of the load. */
static bool stands(const SporeWorld *world, const SporeIsland *island, double miss) {
  if (island->trouble != SPORE_TROUBLE_NOT_CONVERGED) return island->trouble == SPORE_TROUBLE_NONE;
  double residual = island->result.residual;
  if (residual <= MISS_TO_STAND * world->solver.tolerance) return true;
  return residual <= miss && island->integrator != SPORE_INTEGRATOR_STATIC && !gained_energy(world, island);
}

/* Smaller steps that did not help would not at once again: they are tried after a pause, twice as long each time. */
static bool pauses(SporeWorld *world, const SporeIsland *island) {
  bool paused = false;
  for (size_t i = 0; i < island->kept_count; i++) {
    SporeBody *body = &world->bodies[world->island_bodies[island->body_start + i]];
    if (body->pause > 0) paused = true, body->pause--;
  }
  return paused;
}

static void set_pause(SporeWorld *world, const SporeIsland *island, bool helped) {
  for (size_t i = 0; i < island->kept_count; i++) {
    SporeBody *body = &world->bodies[world->island_bodies[island->body_start + i]];
    body->pauses = helped ? 0 : body->pauses == 0 ? 1 : body->pauses < PAUSE_MAXIMUM ? 2 * body->pauses : PAUSE_MAXIMUM;
    body->pause = body->pauses;
  }
}

/* Smaller and smaller steps. An answer that is sound but not solved to tolerance is better than a frozen body. */
static void try_substeps(SporeWorld *world, SporeIsland *island) {
  bool helped = false;
  for (size_t substeps = 2; substeps <= SUBSTEPS_MAXIMUM && !helped; substeps *= 2) {
    try_again(world, island, substeps);
    helped = stands(world, island, MISS_OF_LOAD);
  }
  set_pause(world, island, helped);
}

/* What a step that damps nothing made unsound once, it makes so again: the one that mended it is kept. */
static void make_safer(SporeWorld *world, SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++) {
    SporeBody *body = &world->bodies[world->island_bodies[island->body_start + i]];
    body->watch.started = false;
    if (spore_integrator(body->integrator)->damping > SPORE_DAMPING_NEUTRAL || body->model->type->rates) continue;
    body->integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
    island->made_safer = true;
  }
}

/* Ends with what the trouble was at its worst, and the body that it was met in first. */
void spore_island_recover(SporeWorld *world, SporeIsland *island) {
  bool paused = pauses(world, island);
  if (stands(world, island, paused ? 1 : MISS_OF_LOAD)) return;
  SporeTrouble worst = island->trouble;
  uint32_t met = island->offender, broken = broken_model(world, island);
  while (island->kept_count > 0) {
    if (broken == SPORE_NO_BODY) {
      try_substeps(world, island);
      if (island->trouble <= SPORE_TROUBLE_NOT_CONVERGED) break;
      broken = island->offender;
      if (island->trouble > worst) worst = island->trouble;
    } else {
      worst = SPORE_TROUBLE_NOT_FINITE;
    }
    freeze(world, island, broken);
    broken = broken_model(world, island);
  }
  if (island->kept_count == 0) island->result = (SporeStepResult){.converged = true};
  else if (worst > SPORE_TROUBLE_NOT_CONVERGED) make_safer(world, island);
  island->trouble = worst;
  island->offender = met;
}

void spore_world_report(SporeWorld *world, const char *format, ...) {
  SporeMonitor *monitor = &world->monitor;
  SporeMonitorMessage *message = &monitor->messages[monitor->message_count++ % SPORE_MONITOR_MESSAGES];
  message->step = world->step;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message->text, sizeof message->text, format, arguments);
  va_end(arguments);
}

static const char *cause(SporeTrouble trouble) {
  switch (trouble) {
  case SPORE_TROUBLE_NOT_FINITE:
    return _("its forces or motion are not finite");
  case SPORE_TROUBLE_SPEED:
    return _("it moves faster than the maximum speed");
  case SPORE_TROUBLE_ENERGY:
    return _("its energy grows beyond what it was given");
  case SPORE_TROUBLE_NOT_CONVERGED:
    return _("its equations are not solved to tolerance");
  case SPORE_TROUBLE_NONE:
    break;
  }
  return "";
}

static void report_frozen(SporeWorld *world, const SporeIsland *island) {
  const uint32_t *bodies = world->island_bodies + island->body_start;
  for (size_t i = island->kept_count; i < island->body_count; i++) {
    SporeBody *body = &world->bodies[bodies[i]];
    body->told = SPORE_TROUBLE_NOT_FINITE;
    spore_world_report(world, _("%s: frozen, because %s, in smaller steps too; reset, or change its parameters"),
                       body->name, cause(island->trouble));
  }
}

/* Each body's troubles are told of once, the worst last. */
static void report_mended(SporeWorld *world, const SporeIsland *island) {
  SporeBody *body = &world->bodies[island->offender];
  if (island->made_safer)
    spore_world_report(world,
                       _("%s: integrated by %s from now on, because %s; take a smaller time_step, or choose that "
                         "integrator"),
                       body->name, spore_integrator_names[SPORE_INTEGRATOR_IMPLICIT_EULER], cause(island->trouble));
  if (body->told >= island->trouble) return;
  body->told = island->trouble;
  if (!island->result.converged)
    spore_world_report(world, _("%s: %s (residual %.1e); take a smaller time step or more iterations"), body->name,
                       cause(SPORE_TROUBLE_NOT_CONVERGED), island->result.residual);
  else if (!island->made_safer)
    spore_world_report(world, _("%s: a step was taken again in %llu smaller ones, because %s"), body->name,
                       (unsigned long long)island->mending_substeps, cause(island->trouble));
}

static void report_notice(SporeWorld *world, SporeBody *body) {
  const SporeModel *model = body->model;
  if (body->noticed || !model || !model->type->notice) return;
  const char *notice = model->type->notice(model);
  if (!notice) return;
  body->noticed = true;
  spore_world_report(world, "%s: %s", body->name, notice);
}

void spore_world_report_islands(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) report_notice(world, &world->bodies[b]);
  SporeMonitor *monitor = &world->monitor;
  for (size_t i = 0; i < world->island_count; i++) {
    const SporeIsland *island = &world->islands[i];
    if (island->trouble == SPORE_TROUBLE_NONE) continue;
    monitor->recoveries += island->mending_substeps > 0;
    monitor->substeps += island->mending_substeps;
    monitor->not_finite += island->trouble == SPORE_TROUBLE_NOT_FINITE;
    monitor->too_fast += island->trouble == SPORE_TROUBLE_SPEED;
    monitor->energy += island->trouble == SPORE_TROUBLE_ENERGY;
    monitor->not_converged += !island->result.converged;
    if (island->kept_count < island->body_count) report_frozen(world, island);
    else report_mended(world, island);
  }
}

void spore_world_report_depth(SporeWorld *world, const SporeContactTerm *term) {
  SporeBody *a = &world->bodies[term->a.body], *b = &world->bodies[term->b.body];
  world->monitor.deep_contacts++;
  if (a->told_deep && b->told_deep) return;
  a->told_deep = b->told_deep = true;
  spore_world_report(world,
                     _("%s: is %.2g m deep in %s, more than the radius of a sphere; take a stiffer contact or a "
                       "smaller time_step"),
                     a->name, term->depth, b->name);
}

/* The body that the solvers were busiest with, by the counts of the step. */
static const char *busiest_body(const SporeWorld *world) {
  const char *name = NULL;
  size_t most = 0;
  for (size_t i = 0; i < world->island_count; i++) {
    const SporeIsland *island = &world->islands[i];
    size_t work = (island->result.force_evaluations + island->result.linear_iterations) * island->v_count;
    if (work <= most) continue;
    most = work;
    name = world->bodies[world->island_bodies[island->body_start]].name;
  }
  return name;
}

void spore_world_report_budget(SporeWorld *world) {
  if (world->monitor.over_budget++ > 0) return;
  const SporeProfilePhase *slowest = NULL;
  for (size_t i = 0; i < world->run_count; i++) {
    const SporeProfilePhase *phase = &world->run[i]->profile;
    if (!slowest || spore_profile_last_ns(phase) > spore_profile_last_ns(slowest)) slowest = phase;
  }
  const char *body = busiest_body(world);
  spore_world_report(world,
                     _("%s: a step took %.3g us of the %.3g us it may take, most of it to %s; make the scene "
                       "coarser, or take a larger time_step"),
                     body ? body : "", world->step_us, world->budget_us, slowest->name);
}
