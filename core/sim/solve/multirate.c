/* Multirate steps of an island whose bodies have different methods: explicit bodies keep their own method and substeps,
 * and the terms between bodies are implicit.
 *
 * Each explicit body first goes alone through the step, without contacts and links, to (q*, v*). Then one stage of
 * implicit Euler is solved for the whole island. Explicit bodies are free masses there, so that they need no Jacobian,
 *   M (v - v*) = h f_terms,   q = q* + h (v - v*),
 * and the other bodies are as in any implicit step. The impulse of the terms on an explicit body, J = M (v - v*), is
 * then spread over its step as a constant force J/h, and the body goes through the step again. The impulses are equal
 * and opposite, so momentum is kept to the solver's tolerance. On a mode of frequency w of the explicit body a term of
 * any stiffness acts as the map F = -g q*, g <= m/h^2,   (q, v) -> rotation by h w with F constant, whose eigenvalues
 * lie in the unit disk for all h w and g (their product is 1 - g (1 - cos h w) / (m w^2), and 1 +- sum + product >= 0):
 * applied at the end of the step instead, as in impulse multiple time stepping, the same force resonates near h w = pi.
 * A body at rest on a stiff term is off by h^2 a / 2, a the acceleration by the term.
 *
 * Where the stage is not solved (friction on nodes that are light without their body's own stiffness), implicit Euler
 * takes the whole step: see integrate.c. In such an island a static body that pins hold has next to no inertia, and
 * loses its velocity. */
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

static bool is_explicit(const SporeBody *body) { return !spore_integrator(body->method.integrator)->implicit; }

static Multirate begin(SporeWorld *world, SporeIsland *island) {
  assert(world->solver.time_step > 0 && world->solve.scratch_per_block >= spore_multirate_scratch());
  size_t n = island->v_count;
  Multirate multirate = {.world = world, .island = island, .parts = 1};
  for (size_t i = 0; i < island->kept_count; i++) {
    const SporeBody *body = &world->bodies[world->solve.island_bodies[island->body_start + i]];
    if (!is_explicit(body) && body->method.substeps > multirate.parts) multirate.parts = body->method.substeps;
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
  size_t substeps = (body->method.substeps + multirate->parts - 1) / multirate->parts;
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

/* Start of the stage: free motion with va for h leads explicit bodies to (q*, v*); other bodies start at (q0, v0). */
static void place_start(const Multirate *multirate, const double *q0, const double *v0, double *q1, double *v1,
                        SporeStepResult *result) {
  assert(multirate->h > 0);
  SporeWorld *world = multirate->world;
  for (size_t i = 0; i < multirate->island->kept_count; i++) {
    uint32_t index = world->solve.island_bodies[multirate->island->body_start + i];
    const SporeBody *body = &world->bodies[index];
    const SporeSite *site = &world->solve.local_sites[index];
    double *qa = multirate->qa + site->q, *va = multirate->va + site->v;
    if (is_explicit(body)) {
      go_alone(multirate, i, NULL, q0, v0, q1, v1, result);
      spore_body_drift(body, q1 + site->q, v1 + site->v, -multirate->h, qa, va);
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

/* Steps the explicit bodies again, with the forces of the terms. */
static void go_again(const Multirate *multirate, const double *q0, const double *v0, double *q1, double *v1,
                     SporeStepResult *result) {
  SporeWorld *world = multirate->world;
  for (size_t i = 0; i < multirate->island->kept_count; i++) {
    uint32_t index = world->solve.island_bodies[multirate->island->body_start + i];
    const SporeBody *body = &world->bodies[index];
    if (!is_explicit(body) || all_zero(multirate->given + world->solve.local_sites[index].v, 3 * body->block_count))
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
  return total;
}

size_t spore_multirate_scratch(void) {
  size_t method = spore_integrator_scratch(), stage = 3 * SPORE_STAGE_SCRATCH;
  return 3 * MULTIRATE_VECTORS + (method + 9 > stage ? method + 9 : stage); /* 9: q and v of a body that goes alone */
}
