/* Multirate steps: of islands whose bodies have different methods, and of explicit islands with contacts or links that
 * their step does not resolve. One stage of implicit Euler is solved for the whole island, so that every contact and
 * link acts as it is written, however stiff. Bodies whose method is explicit take part as all others do, but particles,
 * which have no Jacobian and keep their own method and substeps.
 *
 * Particles first go alone through the step, without contacts and links, to (q*, v*). In the stage they are free
 * masses, M (v - v*) = h f_terms,   q = q* - s h v* + h v, s h^2 a the way that a constant acceleration a moves them in
 * a step of their method (1/2 for Verlet). The impulse of the terms on them, J = M (v - v*), is then spread over their
 * step as a constant force J/h, and they go through the step again, to q' = q* + s h (v - v*). So terms are evaluated
 * (1 - s) h v ahead of where the step ends: nowhere else at rest, so that a particle rests where its forces balance. On
 * a term of stiffness k the eigenvalues of (q, v) -> (q', v') are those of implicit Euler for any s: with g = a/(1 +
 * a), a = h^2 k/m, their sum is 2 - 2g and their product 1 - g. The impulses are equal and opposite, so momentum is
 * kept to the solver's tolerance.
 *
 * Where the stage is not solved (friction on light particles), implicit Euler takes the whole step: see integrate.c. In
 * such an island a static body that pins hold has next to no inertia, and loses its velocity. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/integrate/stage.h"
#include "core/sim/solve/island_system.h"

/* Vectors of 3 block_count in front of the scratch of the solver or the method. */
#define MULTIRATE_VECTORS 9

typedef struct Multirate {
  SporeWorld *world;
  SporeIsland *island;
  size_t parts; /* of the world's step, each solved on its own */
  double h;
  double *qa, *va, *v, *given, *memory, *q, *scratch; /* q, v: of the part before, where there are several */
} Multirate;

static Multirate begin(SporeWorld *world, SporeIsland *island) {
  assert(world->solver.time_step > 0 && world->solve.scratch_per_block >= spore_multirate_scratch());
  size_t n = island->v_count;
  Multirate multirate = {.world = world, .island = island, .parts = 1};
  for (size_t i = 0; i < island->kept_count; i++) {
    const SporeBody *body = &world->bodies[world->solve.island_bodies[island->body_start + i]];
    bool implicit = spore_integrator(body->method.integrator)->implicit;
    if (implicit && body->method.substeps > multirate.parts) multirate.parts = body->method.substeps;
  }
  multirate.h = world->solver.time_step / (double)multirate.parts;
  multirate.qa = world->solve.scratch + world->solve.scratch_per_block * (island->v_start / 3);
  multirate.va = multirate.qa + 2 * n;
  multirate.v = multirate.va + n;
  multirate.given = multirate.v + n;
  multirate.memory = multirate.given + n;
  multirate.q = multirate.memory + n;
  multirate.scratch = multirate.q + 3 * n;
  return multirate;
}

static size_t substeps_of(const Multirate *multirate, const SporeBody *body) {
  return (body->method.substeps + multirate->parts - 1) / multirate->parts;
}

/* A constant acceleration a moves the body by shift h^2 a in its step of h seconds. */
static double shift(const Multirate *multirate, const SporeBody *body) {
  double n = (double)substeps_of(multirate, body);
  return (n - 1 + 2 * spore_integrator(body->method.integrator)->shift) / (2 * n);
}

/* The i-th body alone through the step, with the constant force `given` besides its own; NULL: none. From q0, v0 to q1,
 * v1, the island's vectors. */
static void go_alone(const Multirate *multirate, size_t i, const double *given, const double *q0, const double *v0,
                     double *q1, double *v1, SporeStepResult *result) {
  assert(i < multirate->island->kept_count && multirate->parts >= 1);
  SporeWorld *world = multirate->world;
  uint32_t index = world->solve.island_bodies[multirate->island->body_start + i];
  const SporeBody *body = &world->bodies[index];
  const SporeSite site = world->solve.local_sites[index];
  const SporeIsland alone = {.body_start = multirate->island->body_start + i,
                             .body_count = 1,
                             .kept_count = 1,
                             .q_count = body->q_count,
                             .v_start = multirate->island->v_start + site.v,
                             .v_count = 3 * body->block_count,
                             .integrator = body->method.integrator};
  SporeIslandSystem system = {.world = world, .island = &alone, .given = given ? given + site.v : NULL};
  SporeDynamics dynamics = spore_island_system_dynamics(&system);
  const SporeIntegrator *integrator = spore_integrator(body->method.integrator);
  SporeHistory history = {.a = multirate->memory};
  size_t substeps = substeps_of(multirate, body);
  assert(substeps >= 1);
  double *q = multirate->scratch, *v = q + 2 * alone.v_count, *scratch = v + alone.v_count;
  world->solve.local_sites[index] = (SporeSite){0, 0};
  memcpy(q1 + site.q, q0 + site.q, body->q_count * sizeof *q1);
  memcpy(v1 + site.v, v0 + site.v, alone.v_count * sizeof *v1);
  for (size_t s = 0; s < substeps; s++) {
    memcpy(q, q1 + site.q, body->q_count * sizeof *q);
    memcpy(v, v1 + site.v, alone.v_count * sizeof *v);
    dynamics.set_mass(dynamics.data, q);
    SporeStepResult part = integrator->step(&dynamics, &world->solver, &history, multirate->h / (double)substeps, q, v,
                                            q1 + site.q, v1 + site.v, scratch);
    spore_step_result_add(result, &part);
    if (spore_cancel_asked(world->cancel)) break;
  }
  world->solve.local_sites[index] = site;
}

/* Start of the stage: of bodies that go alone q* - s h v* and v*; of all others q0 and v0. */
static void place_start(const Multirate *multirate, const double *q0, const double *v0, double *q1, double *v1,
                        SporeStepResult *result) {
  assert(multirate->h > 0);
  SporeWorld *world = multirate->world;
  for (size_t i = 0; i < multirate->island->kept_count; i++) {
    uint32_t index = world->solve.island_bodies[multirate->island->body_start + i];
    const SporeBody *body = &world->bodies[index];
    const SporeSite *site = &world->solve.local_sites[index];
    double *qa = multirate->qa + site->q, *va = multirate->va + site->v;
    if (spore_body_goes_alone(body)) {
      go_alone(multirate, i, NULL, q0, v0, q1, v1, result);
      spore_body_drift(body, q1 + site->q, v1 + site->v, -shift(multirate, body) * multirate->h, qa, va);
      continue;
    }
    memcpy(qa, q0 + site->q, body->q_count * sizeof *qa);
    if (spore_body_is_static(body)) memset(va, 0, 3 * body->block_count * sizeof *va);
    else memcpy(va, v0 + site->v, 3 * body->block_count * sizeof *va);
  }
}

static bool all_zero(const double *values, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (values[i] != 0) return false;
  return true;
}

/* Steps the bodies that go alone again, with the forces of the terms. */
static void go_again(const Multirate *multirate, const double *q0, const double *v0, double *q1, double *v1,
                     SporeStepResult *result) {
  SporeWorld *world = multirate->world;
  for (size_t i = 0; i < multirate->island->kept_count; i++) {
    uint32_t index = world->solve.island_bodies[multirate->island->body_start + i];
    const SporeBody *body = &world->bodies[index];
    if (!spore_body_goes_alone(body) ||
        all_zero(multirate->given + world->solve.local_sites[index].v, 3 * body->block_count))
      continue;
    go_alone(multirate, i, multirate->given, q0, v0, q1, v1, result);
  }
}

static SporeStepResult advance_part(const Multirate *multirate, SporeIslandSystem *system, const double *q0,
                                    const double *v0) {
  assert(q0 != multirate->island->q1 && v0 != multirate->island->v1);
  SporeIsland *island = multirate->island;
  SporeDynamics dynamics = spore_island_system_dynamics(system);
  double *q1 = island->q1, *v1 = island->v1;
  SporeStepResult own = {.converged = true};
  place_start(multirate, q0, v0, q1, v1, &own);
  dynamics.set_mass(dynamics.data, multirate->qa);
  dynamics.set_time(dynamics.data, multirate->h);
  dynamics.set_shape(dynamics.data, multirate->qa, multirate->h);
  SporeStepResult result = spore_stage_solve(&dynamics, &multirate->world->solver, multirate->h, multirate->qa,
                                             multirate->va, NULL, multirate->v, multirate->scratch);
  dynamics.drift(dynamics.data, multirate->qa, multirate->v, multirate->h, q1, v1);
  for (size_t k = 0; k < island->v_count; k++) multirate->va[k] = (multirate->v[k] - multirate->va[k]) / multirate->h;
  dynamics.mass_multiply(dynamics.data, multirate->va, multirate->given);
  go_again(multirate, q0, v0, q1, v1, &own);
  result.force_evaluations += own.force_evaluations;
  return result;
}

SporeStepResult spore_island_advance_multirate(SporeWorld *world, SporeIsland *island) {
  assert(island->multirate);
  assert(island->q0 && island->v0 && island->q1 && island->v1);
  Multirate multirate = begin(world, island);
  SporeIslandSystem system = {
      .world = world, .island = island, .equations = &island->equations, .apart = true, .now_s = -1};
  SporeStepResult total = {.converged = true};
  const double *q0 = island->q0, *v0 = island->v0;
  double *v = multirate.q + 2 * island->v_count;
  for (size_t part = 0; part < multirate.parts; part++) {
    if (part > 0) {
      q0 = memcpy(multirate.q, island->q1, island->q_count * sizeof *q0);
      v0 = memcpy(v, island->v1, island->v_count * sizeof *v0);
    }
    system.start_s = (double)part * multirate.h;
    SporeStepResult result = advance_part(&multirate, &system, q0, v0);
    spore_step_result_add(&total, &result);
    if (spore_cancel_asked(world->cancel)) break;
  }
  spore_island_system_keep_contacts(&system);
  island->drift_s = system.drift_s;
  return total;
}

size_t spore_multirate_scratch(void) {
  size_t method = spore_integrator_scratch(), stage = 3 * SPORE_STAGE_SCRATCH;
  return 3 * MULTIRATE_VECTORS + (method + 9 > stage ? method + 9 : stage); /* 9: q and v of a body that goes alone */
}
