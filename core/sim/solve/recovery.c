/* Recovery of steps that went wrong. The last good state is still in the world's q and v. The step is taken again from
 * there, in smaller steps and implicitly. A body that this does not help is frozen where it was good, and the others go
 * on. */
#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/math/vector.h"
#include "core/sim/world_private.h"

#define SUBSTEPS_MAXIMUM 8
/* A solution that misses its tolerance by no more than MISS_TO_STAND is counted and reported, but accepted: another
 * attempt would cost more than it improves. So is a solution that misses no more than MISS_OF_LOAD of the load and has
 * not gained energy. */
#define MISS_TO_STAND 10
#define MISS_OF_LOAD 1e-3
#define MISS_OF_STEP 0.1 /* of the load: a worse solution is of little use */
#define PAUSE_MAXIMUM 32 /* steps */
#define EFFORT 3         /* iterations of all smaller steps together, in those that a step may take */
#define ITERATIONS_MINIMUM                                                                                             \
  4 /* left for each smaller step, or the attempt is not begun; 1 where a step may take fewer */

static bool finite_all(const double *values, size_t count) { return spore_vector_within(count, values, DBL_MAX); }

/* Speed of the fastest block with mass, m/s. */
static double top_speed(const SporeBody *body, const double *v) {
  double top = 0;
  for (size_t i = 0; i < body->block_count; i++)
    if (body->model->block_mass[i] > 0) top = fmax(top, spore_vec3_length(spore_vec3_load(v + 3 * i)));
  return top;
}

void spore_island_examine(SporeWorld *world, SporeIsland *island) {
  assert(island->body_count >= 1);
  assert(island->body_start + island->body_count <= world->body_count);
  double top = world->solver.maximum_speed;
  island->trouble = island->result.converged ? SPORE_TROUBLE_NONE : SPORE_TROUBLE_NOT_CONVERGED;
  island->offender = world->solve.island_bodies[island->body_start];
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->solve.island_bodies[island->body_start + i];
    const SporeBody *body = &world->bodies[b];
    const SporeSite *site = &world->solve.local_sites[b];
    const double *q = island->q1 + site->q, *v = island->v1 + site->v;
    /* A block this slow in each direction is slow enough. Nearly all blocks are. */
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

/* A body whose own forces are not finite at the last good state, or SPORE_NO_BODY. */
static uint32_t broken_model(SporeWorld *world, const SporeIsland *island) {
  assert(island->v_start + island->v_count <= world->state.v_count);
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->solve.island_bodies[island->body_start + i];
    const SporeBody *body = &world->bodies[b];
    double *f = world->solve.best_v + island->v_start; /* free: nothing was tried again yet */
    memset(f, 0, 3 * body->block_count * sizeof *f);
    const double *q = world->state.q + body->q_offset;
    body->model->type->force(body->model, q, q, world->state.v + body->v_offset, f);
    if (!finite_all(f, 3 * body->block_count)) return b;
  }
  return SPORE_NO_BODY;
}

static void prescribe(SporeWorld *world, SporeEnd *end, uint32_t body) {
  assert(body < world->body_count);
  if (end->body != body) return;
  const SporeVec3 none = {0, 0, 0};
  end->prescribed = true;
  end->velocity = end->offset = none;
  end->position = spore_mapping_position(end->mapping, end->point, world->state.q + world->bodies[body].q_offset);
}

/* Takes the body out of the island for good. For its terms the body stands still. */
static void freeze(SporeWorld *world, SporeIsland *island, uint32_t index) {
  assert(index < world->body_count && !world->bodies[index].frozen);
  assert(island->kept_count >= 1);
  uint32_t *bodies = world->solve.island_bodies + island->body_start;
  world->bodies[index].frozen = true;
  if (!spore_model_is_nodal(world->bodies[index].model))
    spore_body_turn_mass(world, &world->bodies[index], world->state.q + world->bodies[index].q_offset);
  size_t at = 0;
  while (bodies[at] != index) at++;
  assert(at < island->kept_count);
  memmove(bodies + at, bodies + at + 1, (island->kept_count - at - 1) * sizeof *bodies);
  bodies[--island->kept_count] = index;
  for (size_t i = 0; i < island->contact_count; i++) {
    SporeContactTerm *term = &world->contact.terms[world->contact.order[island->contact_start + i]];
    prescribe(world, &term->a, index);
    prescribe(world, &term->b, index);
  }
  for (size_t i = 0; i < island->spring_count; i++) {
    SporeSpringTerm *term = &world->links.springs[world->links.order[island->spring_start + i]];
    prescribe(world, &term->a, index);
    prescribe(world, &term->b, index);
  }
}

/* Method of the smaller steps. Implicit Euler is the most robust where bodies have Jacobians. Particles have none, and
 * are helped best by smaller steps of a method without history. */
static SporeIntegratorKind mending_method(const SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++)
    if (!world->bodies[world->solve.island_bodies[island->body_start + i]].model->type->rates)
      return SPORE_INTEGRATOR_IMPLICIT_EULER;
  return SPORE_INTEGRATOR_SYMPLECTIC_EULER;
}

static double energy(const SporeWorld *world, const SporeIsland *island, const SporeSite *sites, const double *q,
                     const double *v) {
  double sum = 0;
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->solve.island_bodies[island->body_start + i];
    const SporeBody *body = &world->bodies[b];
    const double *local = q + sites[b].q;
    sum += spore_body_kinetic_energy(world, body, v + sites[b].v) + spore_body_gravity_energy(world, body, local) +
           body->model->type->potential(body->model, local);
  }
  for (size_t i = 0; i < island->contact_count; i++)
    sum += spore_contact_term_energy(&world->contact.terms[world->contact.order[island->contact_start + i]], sites, q);
  for (size_t i = 0; i < island->spring_count; i++)
    sum += spore_spring_term_energy(&world->links.springs[world->links.order[island->spring_start + i]], sites, q);
  return sum;
}

/* Whether the island has more energy than when the step began, with tools where they are now, by more than a part of
 * what gravity gives in a step. */
static bool gained_energy(const SporeWorld *world, const SporeIsland *island) {
  double speed = world->solver.time_step * island->gravity_momentum;
  double before = energy(world, island, world->state.sites, world->state.q, world->state.v);
  return !(energy(world, island, world->solve.local_sites, island->q1, island->v1) <=
           before + MISS_OF_LOAD * speed * speed);
}

/* Whether the solution is accepted; `miss`: the part of the load that it may miss. */
static bool stands(const SporeWorld *world, const SporeIsland *island, double miss) {
  assert(miss > 0);
  if (island->trouble != SPORE_TROUBLE_NOT_CONVERGED) return island->trouble == SPORE_TROUBLE_NONE;
  double residual = island->result.residual;
  if (residual <= MISS_TO_STAND * world->solver.tolerance) return true;
  return residual <= miss && island->integrator != SPORE_INTEGRATOR_STATIC && !gained_energy(world, island);
}

/* Smaller steps that did not help are not tried again at once, but after a pause, which doubles each time. */
static bool pauses(SporeWorld *world, const SporeIsland *island) {
  bool paused = false;
  for (size_t i = 0; i < island->kept_count; i++) {
    SporeBody *body = &world->bodies[world->solve.island_bodies[island->body_start + i]];
    if (body->pause > 0) paused = true, body->pause--;
  }
  return paused;
}

static void set_pause(SporeWorld *world, const SporeIsland *island, bool helped) {
  for (size_t i = 0; i < island->kept_count; i++) {
    SporeBody *body = &world->bodies[world->solve.island_bodies[island->body_start + i]];
    body->pauses = helped ? 0 : body->pauses == 0 ? 1 : body->pauses < PAUSE_MAXIMUM ? 2 * body->pauses : PAUSE_MAXIMUM;
    body->pause = body->pauses;
  }
}

/* Worth of an attempt that did not solve the step, best last. */
typedef enum Worth {
  WORTH_NOTHING, /* its state is not valid */
  WORTH_GAINED,  /* it gained energy */
  WORTH_MISSED,  /* it misses much of the load */
  WORTH_STEP
} Worth;

/* The best attempt: among those that are worth a step, the one that misses least; else the last one, which had the
 * smallest steps. */
typedef struct Best {
  Worth worth;
  double residual;
} Best;

static void remember_best(SporeWorld *world, const SporeIsland *island, Best *best) {
  assert(island->q_start + island->q_count <= world->state.q_count);
  if (island->trouble > SPORE_TROUBLE_NOT_CONVERGED) return;
  double residual = island->result.residual;
  Worth worth = gained_energy(world, island) ? WORTH_GAINED : residual < MISS_OF_STEP ? WORTH_STEP : WORTH_MISSED;
  if (worth < best->worth || (worth == WORTH_STEP && best->worth == worth && residual >= best->residual)) return;
  *best = (Best){worth, residual};
  memcpy(world->solve.best_q + island->q_start, island->q1, island->q_count * sizeof(double));
  memcpy(world->solve.best_v + island->v_start, island->v1, island->v_count * sizeof(double));
}

static void restore_best(const SporeWorld *world, SporeIsland *island, const Best *best) {
  assert(best->worth > WORTH_NOTHING);
  memcpy(island->q1, world->solve.best_q + island->q_start, island->q_count * sizeof(double));
  memcpy(island->v1, world->solve.best_v + island->v_start, island->v_count * sizeof(double));
  island->result.converged = false;
  island->result.residual = best->residual;
  island->history.step_s = 0; /* the history is that of the last attempt */
  island->trouble = SPORE_TROUBLE_NOT_CONVERGED;
}

/* Takes the step again. The result counts the work of this attempt and of those before. */
static void try_again(SporeWorld *world, SporeIsland *island, size_t substeps, SporeEffort *effort) {
  assert(substeps >= 1 && island->kept_count >= 1);
  SporeStepResult spent = island->result;
  spore_island_gather(world, island);
  substeps *= island->substeps;
  island->result = spore_island_advance(world, island, mending_method(world, island), substeps, effort);
  island->mending_substeps += substeps;
  spore_island_examine(world, island);
  spent.converged = island->result.converged;
  spent.residual = 0;
  spore_step_result_add(&spent, &island->result);
  island->result = spent;
}

/* Takes the step without friction. Friction depends on the normal force, so contacts with friction may have no unique
 * solution that Newton's method finds from any start. A body that hits many spheres at once in a long step may end up
 * spinning, with more energy than it had. */
static bool try_without_friction(SporeWorld *world, SporeIsland *island, size_t iterations) {
  SporeEffort effort = {.iterations = iterations, .hopeless = HUGE_VAL};
  for (size_t i = 0; i < island->contact_count; i++)
    world->contact.terms[world->contact.order[island->contact_start + i]].law.friction = 0;
  try_again(world, island, SUBSTEPS_MAXIMUM, &effort);
  return !effort.given_up && stands(world, island, MISS_OF_LOAD);
}

/* Tries smaller and smaller steps, as long as the iterations last. Once an attempt was worth a step, hopeless attempts
 * are given up early. In the end the best attempt is accepted: a valid state that is not solved to tolerance is better
 * than a frozen body. */
static void try_substeps(SporeWorld *world, SporeIsland *island) {
  assert(world->solver.newton_iterations >= 1);
  bool helped = false;
  Best best = {WORTH_NOTHING, HUGE_VAL};
  remember_best(world, island, &best);
  size_t most = (size_t)world->solver.newton_iterations, least = most < ITERATIONS_MINIMUM ? 1 : ITERATIONS_MINIMUM;
  SporeEffort effort = {.iterations = EFFORT * most * island->substeps};
  for (size_t substeps = 2; substeps <= SUBSTEPS_MAXIMUM && !helped; substeps *= 2) {
    if (spore_cancel_asked(world->cancel)) return;
    if (best.worth > WORTH_GAINED && effort.iterations < least * substeps * island->substeps) break;
    effort.hopeless = best.worth == WORTH_STEP ? MISS_OF_LOAD : HUGE_VAL;
    try_again(world, island, substeps, &effort);
    if (effort.given_up) continue;
    helped = stands(world, island, MISS_OF_LOAD);
    if (!helped) remember_best(world, island, &best);
  }
  if (!helped && best.worth <= WORTH_GAINED && island->contact_count > 0)
    helped = try_without_friction(world, island, EFFORT * most * island->substeps);
  if (!helped && best.worth > WORTH_NOTHING) restore_best(world, island, &best);
  set_pause(world, island, helped);
}

/* A method without damping that failed once will fail again, so the bodies keep the method that helped. */
static void make_safer(SporeWorld *world, SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++) {
    SporeBody *body = &world->bodies[world->solve.island_bodies[island->body_start + i]];
    body->watch.started = false;
    if (spore_integrator(body->method.integrator)->damping == SPORE_DAMPING_FULL || body->model->type->rates) continue;
    body->method.integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
    island->made_safer = true;
  }
}

/* In the end island->trouble is the worst trouble, and island->offender the body that had the first. */
void spore_island_recover(SporeWorld *world, SporeIsland *island) {
  assert(island->offender < world->body_count);
  bool paused = pauses(world, island);
  if (stands(world, island, paused ? 1 : MISS_OF_LOAD)) return;
  SporeTrouble worst = island->trouble;
  uint32_t met = island->offender, broken = broken_model(world, island);
  while (island->kept_count > 0) {
    if (spore_cancel_asked(world->cancel)) return;
    if (broken == SPORE_NO_BODY) {
      try_substeps(world, island);
      if (spore_cancel_asked(world->cancel)) return;
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
