/* Messages and counts of the monitor about steps that went wrong. */
#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "core/base/text.h"
#include "core/sim/world_private.h"

#define ERROR_OF_STEP 0.25 /* of the speed: an explicit step and its halves may be so far apart */

void spore_world_report(SporeWorld *world, const char *format, ...) {
  assert(format);
  SporeMonitor *monitor = &world->state.monitor;
  SporeMonitorMessage *message = &monitor->messages[monitor->message_count++ % SPORE_MONITOR_MESSAGES];
  message->step = world->state.step;
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
  case SPORE_TROUBLE_NOT_CONVERGED:
    return _("its equations are not solved to tolerance");
  case SPORE_TROUBLE_NONE:
    break;
  }
  return "";
}

static void report_frozen(SporeWorld *world, const SporeIsland *island) {
  assert(island->trouble != SPORE_TROUBLE_NONE);
  assert(island->body_start + island->body_count <= world->body_count);
  const uint32_t *bodies = world->solve.island_bodies + island->body_start;
  for (size_t i = island->kept_count; i < island->body_count; i++) {
    SporeBody *body = &world->bodies[bodies[i]];
    body->reported.trouble = SPORE_TROUBLE_NOT_FINITE;
    spore_world_report(world, _("%s: frozen, because %s, in smaller steps too; reset, or change its parameters"),
                       body->name, cause(island->trouble));
  }
}

static bool is_unsolved(const SporeWorld *world, const SporeIsland *island) {
  return !(island->verdict.residual <= world->solver.tolerance);
}

static SporeUnsolvedCause unsolved_cause(const SporeIsland *island) {
  return island->verdict.residual <= island->verdict.rounding ? SPORE_UNSOLVED_ROUNDING : SPORE_UNSOLVED_RESIDUAL;
}

/* Each trouble of a body is reported once. Only a worse trouble is reported after it. */
static void report_mended(SporeWorld *world, const SporeIsland *island) {
  assert(island->offender < world->body_count);
  SporeBody *body = &world->bodies[island->offender];
  if (island->made_safer)
    spore_world_report(world,
                       _("%s: integrated by %s from now on, because %s; take a smaller time_step, or choose that "
                         "integrator"),
                       body->name, spore_integrator_names[SPORE_INTEGRATOR_IMPLICIT_EULER], cause(island->trouble));
  bool unsolved = is_unsolved(world, island), mended = island->mending_substeps > 0 && !island->made_safer;
  if (body->reported.trouble >= island->trouble || !(unsolved || mended)) return;
  body->reported.trouble = island->trouble;
  if (unsolved)
    spore_world_report(world, _("%s: %s (residual %.1e); %s"), world->bodies[island->verdict.body].name,
                       spore_unsolved_cause(unsolved_cause(island)), island->verdict.residual,
                       spore_unsolved_remedy(unsolved_cause(island)));
  else if (island->mending_substeps == 1)
    spore_world_report(world, _("%s: a step was taken again with more iterations, because %s"), body->name,
                       cause(island->trouble));
  else
    spore_world_report(world, _("%s: a step was taken again in %llu smaller ones, because %s"), body->name,
                       (unsigned long long)island->mending_substeps, cause(island->trouble));
}

static void report_notice(SporeWorld *world, SporeBody *body) {
  const SporeModel *model = body->model;
  if (!model || !model->type->notice) return;
  const char *notice = model->type->notice(model, world->state.q + body->q_offset);
  if (!notice) return;
  spore_world_count_unsolved(world, (uint32_t)(body - world->bodies), SPORE_UNSOLVED_MODEL, 0);
  if (body->reported.notice) return;
  body->reported.notice = true;
  spore_world_report(world, "%s: %s", body->name, notice);
}

/* Counts a step that another integrator took for the body, and says so the first time. Bodies of several methods that
 * touch or are tied may need that in most steps, as where light parts rub, and nothing else of the step shows it. */
static void count_stood_in(SporeWorld *world, const SporeIsland *island, uint32_t index) {
  const SporeBody *body = &world->bodies[index];
  const SporeUnsolvedCount *count = &world->state.unsolved[index * SPORE_UNSOLVED_CAUSES + SPORE_UNSOLVED_STOOD_IN];
  if (count->steps == 0)
    spore_world_report(world,
                       island->body_count > 1
                           ? _("%s: %s takes steps that %s cannot take with what touches or ties it; %s")
                           : _("%s: %s takes steps that %s cannot take; %s"),
                       body->name, island->stand_in->name, spore_integrator(body->method.integrator)->name,
                       spore_unsolved_remedy(SPORE_UNSOLVED_STOOD_IN));
  spore_world_count_unsolved(world, index, SPORE_UNSOLVED_STOOD_IN, 0);
}

/* Counts bodies of the island that its step did not move as the scene is written. */
static void count_island(SporeWorld *world, const SporeIsland *island) {
  bool wrong = island->trouble > SPORE_TROUBLE_NOT_CONVERGED;
  if (is_unsolved(world, island))
    spore_world_count_unsolved(world, island->verdict.body, unsolved_cause(island), island->verdict.residual);
  if (island->frictionless) spore_world_count_unsolved(world, island->offender, SPORE_UNSOLVED_FRICTION, 0);
  if (wrong && !island->made_safer && !world->bodies[island->offender].frozen)
    spore_world_count_unsolved(world, island->offender, SPORE_UNSOLVED_RETAKEN, 0);
  for (size_t i = 0; island->stand_in && !wrong && i < island->kept_count; i++) {
    uint32_t b = world->solve.island_bodies[island->body_start + i];
    if (spore_integrator(world->bodies[b].method.integrator) != island->stand_in) count_stood_in(world, island, b);
  }
}

/* The error of a step falls at least with the square of its size. */
static void count_error(SporeWorld *world, const SporeIsland *island) {
  SporeBody *body = &world->bodies[world->solve.island_bodies[island->body_start]];
  spore_world_count_unsolved(world, world->solve.island_bodies[island->body_start], SPORE_UNSOLVED_HALVES,
                             island->error);
  if (body->reported.error || !isfinite(island->error)) return;
  body->reported.error = true;
  double h = world->solver.time_step / (double)island->substeps;
  spore_world_report(world,
                     _("%s: an explicit step of %.2g s and two of half its size are %.0f%% of its speed apart; take "
                       "steps of %.2g s"),
                     body->name, h, 100 * island->error, h * sqrt(0.5 * ERROR_OF_STEP / island->error));
}

/* Counts bodies whose frame turned further at once than its turning is followed. How far static turns one on the way to
 * a balance does not matter. */
static void count_turning(SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->solve.island_bodies[island->body_start + i];
    SporeBody *body = &world->bodies[b];
    if (!body->model->type->longest_turn || spore_body_is_static(body)) continue;
    const double *q = world->state.q + body->q_offset, *v = world->state.v + body->v_offset;
    double longest = body->model->type->longest_turn(body->model, q, v);
    if (island->drift_s <= longest) continue;
    double rate = spore_vec3_length(spore_vec3_load(v + 3 * (body->block_count - 1)));
    spore_world_count_unsolved(world, b, SPORE_UNSOLVED_TURNED, rate * island->drift_s);
    if (body->reported.turned) continue;
    body->reported.turned = true;
    spore_world_report(world,
                       _("%s: turns by %.3g rad at once, about changing axes, and where it points is lost; take steps "
                         "of %.2g s or less"),
                       body->name, rate * island->drift_s,
                       0.95 * longest); /* which two digits do not round up above it */
  }
}

/* Counts the bodies that this step did not move as the scene is written. */
static void count_unsolved(SporeWorld *world) {
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (body->frozen) spore_world_count_unsolved(world, b, SPORE_UNSOLVED_FROZEN, 0);
    else if (body->method.integrator != body->method.chosen)
      spore_world_count_unsolved(world, b, SPORE_UNSOLVED_SAFER, 0);
  }
  for (size_t i = 0; i < world->solve.island_count; i++) {
    const SporeIsland *island = &world->solve.islands[i];
    count_island(world, island);
    count_turning(world, island);
    if (!(island->error <= ERROR_OF_STEP)) count_error(world, island);
  }
}

void spore_world_report_islands(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) report_notice(world, &world->bodies[b]);
  count_unsolved(world);
  SporeMonitor *monitor = &world->state.monitor;
  for (size_t i = 0; i < world->solve.island_count; i++) {
    const SporeIsland *island = &world->solve.islands[i];
    if (island->trouble == SPORE_TROUBLE_NONE) continue;
    monitor->recoveries += island->mending_substeps > 0;
    monitor->substeps += island->mending_substeps;
    monitor->not_finite += island->trouble == SPORE_TROUBLE_NOT_FINITE;
    monitor->too_fast += island->trouble == SPORE_TROUBLE_SPEED;
    monitor->not_converged += is_unsolved(world, island);
    if (island->kept_count < island->body_count) report_frozen(world, island);
    else report_mended(world, island);
  }
}

/* Name of the first body of the island that took most work, by the counts of the step. */
static const char *busiest_body(const SporeWorld *world) {
  const char *name = NULL;
  size_t most = 0;
  for (size_t i = 0; i < world->solve.island_count; i++) {
    const SporeIsland *island = &world->solve.islands[i];
    size_t work = (island->result.force_evaluations + island->result.linear_iterations) * island->v_count;
    if (work <= most) continue;
    most = work;
    name = world->bodies[world->solve.island_bodies[island->body_start]].name;
  }
  return name;
}

void spore_world_report_budget(SporeWorld *world) {
  if (world->state.monitor.over_budget++ > 0) return;
  const SporeProfilePhase *slowest = NULL;
  for (size_t i = 0; i < world->schedule.run_count; i++) {
    const SporeProfilePhase *phase = &world->schedule.profiles[world->schedule.run[i]];
    if (!slowest || spore_profile_last_ns(phase) > spore_profile_last_ns(slowest)) slowest = phase;
  }
  assert(slowest);
  const char *body = busiest_body(world);
  spore_world_report(world,
                     _("%s: a step took %.3g us of the %.3g us it may take, most of it to %s; make the scene "
                       "coarser, or take a larger time_step"),
                     body ? body : "", world->schedule.step_us, world->schedule.budget_us, slowest->name);
}

void spore_monitor_reset(SporeMonitor *monitor) {
  monitor->recoveries = monitor->substeps = monitor->not_finite = monitor->too_fast = monitor->energy = 0;
  monitor->not_converged = monitor->deep_contacts = monitor->over_budget = 0;
  monitor->held_inputs = monitor->shortened_forces = monitor->broken_links = monitor->lost_holds = 0;
  monitor->torn_springs = 0;
}
