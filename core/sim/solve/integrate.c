/* Integrates the islands, each on its own and on any thread. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/math/vector.h"
#include "core/sim/solve/island_system.h"

#define HOPELESS_ITERATIONS 10 /* a part of a step */

/* Limits the iterations of the next part of the step, and leaves one for each part behind it. */
static void limit_iterations(const SporeEffort *effort, size_t behind, const SporeSolverFields *solver,
                             SporeSolverFields *fields) {
  assert(solver->newton_iterations >= 1);
  int64_t left = effort->iterations > behind ? (int64_t)(effort->iterations - behind) : 1;
  int64_t most = (effort->patience > 0 ? (int64_t)effort->patience : 1) * solver->newton_iterations;
  fields->newton_iterations = left < most ? left : most;
}

/* Whether an attempt is still worth its next part, after a part with this result. */
static bool go_on(SporeEffort *effort, const SporeStepResult *result) {
  size_t spent = result->newton_iterations;
  effort->iterations -= spent < effort->iterations ? spent : effort->iterations;
  effort->given_up = !result->converged && !(result->residual <= effort->hopeless);
  if (effort->linear > 0) {
    effort->linear = effort->linear > result->linear_iterations ? effort->linear - result->linear_iterations : 1;
    effort->given_up |= effort->linear == 1;
  }
  return !effort->given_up;
}

/* Velocity that the step starts from. The velocity of a body by the static method only shows how far its balance moved,
 * so where another method stands in, such a body starts from rest. */
static const double *start_velocity(SporeWorld *world, const SporeIsland *island, SporeIntegratorKind kind) {
  assert(island->v_start + island->v_count <= world->state.v_count);
  const double *v0 = island->v0;
  for (size_t i = 0; kind != island->integrator && i < island->kept_count; i++) {
    uint32_t b = world->solve.island_bodies[island->body_start + i];
    if (!spore_body_is_static(&world->bodies[b])) continue;
    double *rest = world->solve.local_v0 + island->v_start;
    if (v0 != rest) v0 = memcpy(rest, v0, island->v_count * sizeof *rest);
    memset(rest + world->solve.local_sites[b].v, 0, 3 * world->bodies[b].block_count * sizeof *rest);
  }
  return v0;
}

SporeStepResult spore_island_advance(SporeWorld *world, SporeIsland *island, SporeIntegratorKind kind, size_t substeps,
                                     SporeEffort *effort) {
  assert(substeps >= 1 && island->kept_count >= 1);
  assert(island->q0 && island->v0 && island->q1 && island->v1);
  SporeIslandSystem system = {.world = world,
                              .island = island,
                              .equations = &island->equations,
                              .now_s = island->attempts > 1 ? -1 : world->solver.time_step};
  system.balance = kind == SPORE_INTEGRATOR_STATIC && spore_island_system_is_held(&system);
  system.meets = kind == island->integrator && spore_island_system_can_meet(&system);
  SporeDynamics dynamics = spore_island_system_dynamics(&system);
  if (effort) dynamics.patience = effort->patience;
  const SporeIntegrator *integrator = spore_integrator(kind);
  const double *q0 = island->q0, *v0 = start_velocity(world, island, kind);
  double *q1 = island->q1, *v1 = island->v1;
  double *scratch = world->solve.scratch + world->solve.scratch_per_block * (island->v_start / 3);
  double h = world->solver.time_step / (double)substeps;
  /* The history of one method is of no use to another. */
  SporeHistory none = {0}, *history = kind == island->integrator ? &island->history : &none;
  if (kind != island->integrator) island->history.step_s = 0;
  SporeStepResult total = {.converged = true};
  SporeSolverFields fields = world->solver;
  if (effort) effort->given_up = false;
  for (size_t s = 0; s < substeps; s++) {
    if (s > 0) {
      q0 = memcpy(world->solve.local_q0 + island->q_start, q1, island->q_count * sizeof *q0);
      v0 = memcpy(world->solve.local_v0 + island->v_start, v1, island->v_count * sizeof *v0);
    }
    if (s > 0 || island->attempts > 1) dynamics.set_mass(dynamics.data, q0);
    system.start_s = (double)s * h;
    dynamics.set_time(dynamics.data, h);
    if (effort) limit_iterations(effort, substeps - 1 - s, &world->solver, &fields);
    SporeStepResult result = integrator->step(&dynamics, &fields, history, h, q0, v0, q1, v1, scratch);
    dynamics.set_time(dynamics.data, h);
    spore_step_result_add(&total, &result);
    if ((effort && !go_on(effort, &result)) || spore_cancel_asked(world->cancel)) break;
  }
  spore_island_system_keep_contacts(&system);
  island->drift_s = system.drift_s;
  return total;
}

/* Whether bodies that are still apart meet within the step. Only fast bodies do. Which of their contacts press is only
 * known at the end of the step. An explicit method evaluates forces where the bodies are still apart or already past
 * each other, and would let the bodies pass through each other. */
static bool meets_in_step(const SporeWorld *world, const SporeIsland *island) {
  assert(island->contact_start + island->contact_count <= world->contact.count);
  for (size_t i = 0; i < island->contact_count; i++)
    if (spore_contact_term_meets(&world->contact.terms[world->contact.order[island->contact_start + i]])) return true;
  return false;
}

/* The step of an integrator in the island, s. */
static double step_of(const SporeWorld *world, const SporeIsland *island) {
  assert(island->substeps >= 1);
  return world->solver.time_step / (double)island->substeps;
}

static bool some_go_alone(const SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++)
    if (spore_body_goes_alone(&world->bodies[world->solve.island_bodies[island->body_start + i]])) return true;
  return false;
}

#define FEW_SUBSTEPS 3 /* of particles: so many cost less than the two passes and the stage of a multirate step */

/* Particles alone, of the same substeps, take a few more of them in this step where these resolve all contacts and
 * links. */
static bool resolve_by_few_substeps(SporeWorld *world, SporeIsland *island) {
  assert(island->substeps >= 1);
  for (size_t i = 0; i < island->kept_count; i++) {
    const SporeBody *body = &world->bodies[world->solve.island_bodies[island->body_start + i]];
    if (!spore_body_goes_alone(body) || body->method.substeps != island->substeps) return false;
  }
  const SporeIslandSystem system = {.world = world, .island = island};
  for (size_t n = 2; n <= FEW_SUBSTEPS; n++) {
    if (!spore_island_system_resolves(&system, step_of(world, island), n, true)) continue;
    island->substeps *= n;
    return true;
  }
  return false;
}

/* An explicit island with contacts or links that its step does not resolve takes this step by implicit Euler, unless
 * the contacts are met in its sweep, or a few substeps resolve them. Particles keep their own method: only contacts and
 * links are implicit. */
static void couple(SporeWorld *world, SporeIsland *island) {
  if (spore_integrator(island->integrator)->implicit) return;
  SporeIslandSystem system = {.world = world, .island = island};
  system.meets = spore_island_system_can_meet(&system);
  bool steady = system.meets || !meets_in_step(world, island);
  if (steady && spore_island_system_resolves(&system, step_of(world, island), 1, true)) return;
  if (steady && resolve_by_few_substeps(world, island)) return;
  island->multirate = some_go_alone(world, island);
  island->integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
  spore_island_gather(world, island); /* with the history of that method */
}

/* Smallest number of substeps that resolves the links of the island; 0: there is none. */
static size_t substeps_to_resolve(SporeWorld *world, const SporeIsland *island) {
  const SporeIslandSystem system = {.world = world, .island = island};
  size_t low = 0, high = 1;
  while (high <= SPORE_SUBSTEPS_MAXIMUM &&
         !spore_island_system_resolves(&system, world->solver.time_step / (double)high, 1, true))
    low = high, high *= 2;
  if (high > SPORE_SUBSTEPS_MAXIMUM) return 0;
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    if (spore_island_system_resolves(&system, world->solver.time_step / (double)middle, 1, true)) high = middle;
    else low = middle;
  }
  return high;
}

SporeCoupled spore_body_coupled(SporeWorld *world, uint32_t index, size_t *resolving) {
  assert(index < world->body_count && resolving);
  const SporeBody *body = &world->bodies[index];
  *resolving = 0;
  if (spore_integrator(body->method.integrator)->implicit) return SPORE_COUPLED_NEVER;
  SporeCoupled otherwise =
      world->contact.grid && body->collision.spheres.point_count > 0 ? SPORE_COUPLED_CONTACTS : SPORE_COUPLED_NEVER;
  if (!spore_body_moves(body)) return otherwise;
  spore_world_find_islands(world);
  SporeIsland alike = world->solve.islands[world->solve.island_of[index]];
  alike.contact_count = 0; /* they come and go */
  if (alike.spring_count == 0) return otherwise;
  if (alike.multirate) return SPORE_COUPLED_LINKS;
  spore_island_gather(world, &alike);
  const SporeIslandSystem system = {.world = world, .island = &alike};
  if (spore_island_system_resolves(&system, step_of(world, &alike), 1, true)) return otherwise;
  *resolving = substeps_to_resolve(world, &alike);
  return SPORE_COUPLED_LINKS;
}

/* The method of an implicit island in this step. A contact that the step does not resolve is an impact, which no method
 * follows to second order: a method with too little damping throws bodies out faster than they came in. Then implicit
 * Euler takes its place, unless the method controls its error. */
static SporeIntegratorKind method(SporeWorld *world, const SporeIsland *island) {
  const SporeIntegrator *integrator = spore_integrator(island->integrator);
  bool controlled = island->integrator == SPORE_INTEGRATOR_TR_BDF2 && world->solver.error_tolerance > 0;
  if (!integrator->implicit || integrator->damping == SPORE_DAMPING_FULL || controlled) return island->integrator;
  const SporeIslandSystem system = {.world = world, .island = island};
  bool resolved = spore_island_system_resolves(&system, step_of(world, island), 1, false);
  return resolved ? island->integrator : SPORE_INTEGRATOR_IMPLICIT_EULER;
}

static SporeStepResult advance(SporeWorld *world, SporeIsland *island) {
  island->stand_in = NULL;
  island->taken = SPORE_INTEGRATOR_IMPLICIT_EULER;
  if (island->multirate) {
    island->history.step_s = 0;
    SporeStepResult multirate = spore_island_advance_multirate(world, island);
    if (multirate.converged || spore_cancel_asked(world->cancel)) return multirate;
    /* It fails on friction on nodes that are light without the stiffness of their body. With it the step may be solved.
     */
    spore_island_gather(world, island);
    island->stand_in = &spore_implicit_euler;
    SporeStepResult whole = spore_island_advance(world, island, SPORE_INTEGRATOR_IMPLICIT_EULER, 1, NULL);
    spore_step_result_add(&multirate, &whole);
    multirate.converged = whole.converged;
    multirate.residual = whole.residual;
    return multirate;
  }
  /* Where the steps before were work for nothing, this one may take few iterations: it costs little more than one that
   * is solved. */
  SporeEffort effort = {.iterations = HOPELESS_ITERATIONS * island->substeps, .hopeless = HUGE_VAL};
  bool hopeless = spore_island_is_hopeless(world, island);
  island->taken = method(world, island);
  return spore_island_advance(world, island, island->taken, island->substeps, hopeless ? &effort : NULL);
}

/* Whether a model of the island keeps something of where its forces were evaluated: then an evaluation elsewhere would
 * change what follows, if by rounding only. */
static bool some_remember(const SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++)
    if (world->bodies[world->solve.island_bodies[island->body_start + i]].model->type->forget) return true;
  return false;
}

/* Whether the error of this step is measured: every 64th time that the island is explicit. */
static bool is_looked_at(const SporeWorld *world, const SporeIsland *island) {
  bool is_explicit = !spore_integrator(island->integrator)->implicit;
  return is_explicit && !some_remember(world, island) &&
         world->state.step % SPORE_STEPS_BETWEEN_LOOKS == SPORE_STEPS_BETWEEN_LOOKS - 1;
}

/* Takes the step in halves, to best_q and best_v. To be called before the step itself, which then overwrites all else
 * that this changes. */
static void take_halves(SporeWorld *world, SporeIsland *island) {
  assert(island->kept_count >= 1);
  SporeIsland trial = *island;
  trial.q1 = world->solve.best_q + island->q_start;
  trial.v1 = world->solve.best_v + island->v_start;
  spore_island_advance(world, &trial, trial.integrator, 2 * trial.substeps, NULL);
  spore_island_gather(world, island);
}

/* (v.M v)^1/2 of a velocity of the island. */
static double speed_norm(const SporeWorld *world, const SporeIsland *island, const double *v) {
  double energy = 0;
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t index = world->solve.island_bodies[island->body_start + i];
    energy += spore_body_kinetic_energy(world, &world->bodies[index], v + world->solve.local_sites[index].v);
  }
  return sqrt(2 * energy);
}

#define SMALLEST_SPEED 1e-6 /* m/s: below, it is rounding */

/* How far the step and its halves are apart, against the speed and what gravity gives in a step. Overwrites the halves.
 */
static double error_of_step(SporeWorld *world, const SporeIsland *island) {
  assert(island->attempts > 1);
  double h = world->solver.time_step, mass = 0;
  for (size_t i = 0; i < island->kept_count; i++)
    mass += world->bodies[world->solve.island_bodies[island->body_start + i]].total_mass;
  double speed = fmax(speed_norm(world, island, island->v0), speed_norm(world, island, island->v1));
  double least = h * island->gravity_momentum + SMALLEST_SPEED * sqrt(mass);
  double *apart = world->solve.best_v + island->v_start;
  spore_vector_add_scaled(island->v_count, apart, -1, island->v1);
  return speed_norm(world, island, apart) / (speed + least);
}

static void integrate_island(void *data, size_t index) {
  assert(index < ((SporeWorld *)data)->solve.island_count);
  SporeWorld *world = data;
  SporeIsland *island = &world->solve.islands[index];
  spore_island_gather(world, island);
  double part_s;
  bool strikes = spore_island_strikes(world, island, &part_s);
  if (!strikes) couple(world, island);
  bool looked_at = !strikes && is_looked_at(world, island);
  if (looked_at) take_halves(world, island);
  island->result = strikes ? spore_island_advance_impact(world, island, part_s) : advance(world, island);
  if (spore_cancel_asked(world->cancel)) return; /* the step ends, and nothing of what it did is kept */
  if (looked_at) island->error = error_of_step(world, island);
  if (!strikes && spore_island_choose(world, island)) {
    SporeStepResult spent = island->result;
    spore_island_gather(world, island);
    island->result = advance(world, island);
    island->result.newton_iterations += spent.newton_iterations;
    island->result.linear_iterations += spent.linear_iterations;
    island->result.force_evaluations += spent.force_evaluations;
  }
  spore_island_examine(world, island);
  if (island->trouble != SPORE_TROUBLE_NONE) spore_island_recover(world, island);
  /* The error is that of a step that is not kept. */
  if (island->mending_substeps > 0 || island->kept_count < island->body_count) island->error = 0;
  if (spore_cancel_asked(world->cancel)) return;
  spore_island_remember(world, island);
  island->rests = spore_island_rests(world, island);
}

/* Estimated work of the islands, in units of roughly 10 ns. */
static size_t count_work(const SporeWorld *world) {
  size_t work = 0;
  for (size_t i = 0; i < world->solve.island_count; i++) {
    const SporeIsland *island = &world->solve.islands[i];
    size_t size = island->v_count + 10 * (island->contact_count + island->spring_count);
    work += spore_integrator(island->integrator)->implicit ? 10 * size : size;
  }
  return work;
}

void spore_world_integrate(SporeWorld *world) {
  assert(world->solve.island_count <= world->body_count);
  spore_world_start_watch(world);
  spore_pool_run(spore_pool_for(world->pool, count_work(world)), world->solve.island_count, integrate_island, world);
  SporeStepCounts *counts = &world->state.counts;
  *counts = (SporeStepCounts){.islands = world->solve.island_count, .sleeping = world->solve.sleeping_count};
  for (size_t i = 0; i < world->solve.island_count; i++) {
    const SporeStepResult *result = &world->solve.islands[i].result;
    counts->newton_iterations += result->newton_iterations;
    counts->linear_iterations += result->linear_iterations;
    counts->force_evaluations += result->force_evaluations;
  }
}
