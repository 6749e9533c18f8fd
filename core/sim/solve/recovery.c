/* Recovery of steps that went wrong. The last good state is still in the world's q and v. The step is taken again from
 * there, in smaller steps and implicitly. A body that this does not help is frozen where it was good, and the others go
 * on. */
#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/math/vector.h"
#include "core/nonlinear/system.h"
#include "core/sim/solve/island_system.h"

#define SUBSTEPS_MAXIMUM 8
#define HARD_SYSTEM 300 /* linear iterations: to solve several such systems more is more work than a step is worth */
/* A solution that misses its tolerance by no more than MISS_TO_STAND is counted and reported, but accepted: another
 * attempt would cost more than it improves. So is a solution that misses no more than MISS_OF_LOAD of the load and has
 * not gained energy. */
#define MISS_TO_STAND 10
#define MISS_OF_LOAD 1e-3
#define MISS_OF_STEP 0.1 /* of the load: a worse solution is of little use */
#define PAUSE_MAXIMUM 32 /* steps */
#define EFFORT                                                                                                         \
  3 /* iterations of all smaller steps together, in those that a step may take; 1 after a hopeless step                \
     */
/* A step is hopeless where each attempt misses SPORE_HOPELESS of the load, or makes energy. After so many of them in a
 * row, which is work for nothing, the body that is pulled hardest is frozen. */
#define HOPELESS_MOST 3
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

/* Whether the body's velocity or own forces are not finite at the last good state. */
static bool is_broken(SporeWorld *world, const SporeIsland *island, const SporeBody *body) {
  assert(3 * body->block_count <= world->state.v_count - island->v_start);
  const double *q = world->state.q + body->q_offset, *v = world->state.v + body->v_offset;
  double *f = world->solve.best_v + island->v_start; /* free: no attempt is kept there yet */
  if (!finite_all(v, 3 * body->block_count)) return true;
  memset(f, 0, 3 * body->block_count * sizeof *f);
  body->model->type->force(body->model, q, q, v, f);
  return !finite_all(f, 3 * body->block_count);
}

/* The first such body of the island, or SPORE_NO_BODY. */
static uint32_t broken_body(SporeWorld *world, const SporeIsland *island) {
  assert(island->body_start + island->body_count <= world->body_count);
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->solve.island_bodies[island->body_start + i];
    if (is_broken(world, island, &world->bodies[b])) return b;
  }
  return SPORE_NO_BODY;
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

static SporePause *pause_of(SporeBody *body) { return &body->pause; }
static SporePause *impatience_of(SporeBody *body) { return &body->impatience; }

/* What did not help is not tried again at once, but after a pause, which doubles each time. */
static bool pauses(SporeWorld *world, const SporeIsland *island, SporePause *(*of)(SporeBody *body)) {
  bool paused = false;
  for (size_t i = 0; i < island->kept_count; i++) {
    SporePause *pause = of(&world->bodies[world->solve.island_bodies[island->body_start + i]]);
    if (pause->left > 0) paused = true, pause->left--;
  }
  return paused;
}

static void set_pause(SporeWorld *world, const SporeIsland *island, SporePause *(*of)(SporeBody *body), bool helped) {
  for (size_t i = 0; i < island->kept_count; i++) {
    SporePause *pause = of(&world->bodies[world->solve.island_bodies[island->body_start + i]]);
    uint32_t last = pause->length;
    pause->length = helped ? 0 : last == 0 ? 1 : last < PAUSE_MAXIMUM ? 2 * last : PAUSE_MAXIMUM;
    pause->left = pause->length;
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
  double least; /* residual of all attempts that gained no energy */
  SporeKeptEquations equations;
  const SporeIntegrator *stand_in;
} Best;

static void remember_best(SporeWorld *world, SporeIsland *island, Best *best) {
  assert(island->q_start + island->q_count <= world->state.q_count);
  if (island->trouble > SPORE_TROUBLE_NOT_CONVERGED) return;
  double residual = island->result.residual;
  Worth worth = gained_energy(world, island) ? WORTH_GAINED : residual < MISS_OF_STEP ? WORTH_STEP : WORTH_MISSED;
  if (worth > WORTH_GAINED) best->least = fmin(best->least, residual);
  if (worth < best->worth || (worth == WORTH_STEP && best->worth == worth && residual >= best->residual)) return;
  best->worth = worth;
  best->residual = residual;
  best->equations = island->equations;
  best->stand_in = island->stand_in;
  island->equations.set = 1 - island->equations.set; /* the next attempt's */
  memcpy(world->solve.best_q + island->q_start, island->q1, island->q_count * sizeof(double));
  memcpy(world->solve.best_v + island->v_start, island->v1, island->v_count * sizeof(double));
}

static void restore_best(const SporeWorld *world, SporeIsland *island, const Best *best) {
  assert(best->worth > WORTH_NOTHING);
  memcpy(island->q1, world->solve.best_q + island->q_start, island->q_count * sizeof(double));
  memcpy(island->v1, world->solve.best_v + island->v_start, island->v_count * sizeof(double));
  island->result.converged = false;
  island->result.residual = best->residual;
  island->equations = best->equations;
  island->stand_in = best->stand_in;
  island->frictionless = false;
  island->history.step_s = 0; /* the history is that of the last attempt */
  island->trouble = SPORE_TROUBLE_NOT_CONVERGED;
}

/* Takes the step again. The result counts the work of this attempt and of those before. */
static void try_by(SporeWorld *world, SporeIsland *island, SporeIntegratorKind kind, size_t substeps,
                   SporeEffort *effort) {
  assert(substeps >= 1 && island->kept_count >= 1);
  SporeStepResult spent = island->result;
  spore_island_gather(world, island);
  substeps *= island->substeps;
  island->stand_in = spore_integrator(kind);
  island->result = spore_island_advance(world, island, kind, substeps, effort);
  island->mending_substeps += substeps;
  spore_island_examine(world, island);
  spent.converged = island->result.converged;
  spent.residual = 0;
  spore_step_result_add(&spent, &island->result);
  island->result = spent;
}

static void try_again(SporeWorld *world, SporeIsland *island, size_t substeps, SporeEffort *effort) {
  try_by(world, island, mending_method(world, island), substeps, effort);
}

/* Takes the step without friction. Friction depends on the normal force, so contacts with friction may have no unique
 * solution that Newton's method finds from any start. A body that hits many spheres at once in a long step may end up
 * spinning, with more energy than it had. */
static bool try_without_friction(SporeWorld *world, SporeIsland *island, size_t iterations) {
  SporeEffort effort = {.iterations = iterations, .hopeless = HUGE_VAL};
  island->frictionless = true;
  for (size_t i = 0; i < island->contact_count; i++)
    world->contact.terms[world->contact.order[island->contact_start + i]].law.friction = 0;
  try_again(world, island, SUBSTEPS_MAXIMUM, &effort);
  if (!effort.given_up && stands(world, island, MISS_OF_LOAD)) return true;
  island->frictionless = false;
  for (size_t i = 0; i < island->contact_count; i++) {
    SporeContactTerm *term = &world->contact.terms[world->contact.order[island->contact_start + i]];
    term->law.friction = fmin(world->bodies[term->a.body].collision.fields.friction,
                              world->bodies[term->b.body].collision.fields.friction);
  }
  return false;
}

/* Counts a hopeless step for all bodies of the island. True: it is one too many in a row. A body that comes apart may
 * meet many such steps, which end when it is apart. */
static bool despairs(SporeWorld *world, const SporeIsland *island) {
  uint64_t step = world->state.step;
  bool despairs = false;
  for (size_t i = 0; i < island->kept_count; i++) {
    SporeBody *body = &world->bodies[world->solve.island_bodies[island->body_start + i]];
    if (!spore_body_is_hopeless(world, body)) body->hopeless = 0;
    if (body->hopeless == 0 || step > body->hopeless_step) body->hopeless++;
    body->hopeless_step = step;
    despairs |= body->hopeless >= HOPELESS_MOST && !body->altered;
  }
  return despairs;
}

/* Takes the step as a whole, with as many iterations as all smaller steps may take together: what is stiff and buckles
 * needs them in each of the smaller steps, too. Not where it hardly gets one linear system solved. */
static bool try_patiently(SporeWorld *world, SporeIsland *island, Best *best) {
  const SporeStepResult *first = &island->result;
  bool hard = first->linear_iterations > HARD_SYSTEM * first->newton_iterations;
  bool ran_out = first->newton_iterations >= (size_t)world->solver.newton_iterations ||
                 first->residual > SPORE_HOPELESS; /* else more iterations do not help */
  if (island->trouble != SPORE_TROUBLE_NOT_CONVERGED || hard || !ran_out || spore_island_is_hopeless(world, island) ||
      pauses(world, island, impatience_of))
    return false;
  SporeEffort effort = {.iterations = EFFORT * (size_t)world->solver.newton_iterations * island->substeps,
                        .hopeless = HUGE_VAL,
                        .patience = EFFORT};
  try_by(world, island, island->taken, 1, &effort); /* another method may damp what this one keeps */
  bool helped = stands(world, island, MISS_OF_LOAD);
  set_pause(world, island, impatience_of, helped);
  if (!helped) remember_best(world, island, best);
  return helped;
}

/* Tries the step with patience, then smaller and smaller steps, as long as the iterations last. Once an attempt was
 * worth a step, hopeless attempts are given up early. In the end the best attempt is accepted: a valid state that is
 * not solved to tolerance is better than a frozen body. False: the step is hopeless. */
static bool try_substeps(SporeWorld *world, SporeIsland *island) {
  assert(world->solver.newton_iterations >= 1);
  Best best = {.worth = WORTH_NOTHING, .residual = HUGE_VAL, .least = HUGE_VAL};
  remember_best(world, island, &best);
  size_t most = (size_t)world->solver.newton_iterations, least = most < ITERATIONS_MINIMUM ? 1 : ITERATIONS_MINIMUM;
  size_t iterations = (spore_island_is_hopeless(world, island) ? 1 : EFFORT) * most * island->substeps;
  SporeEffort effort = {.iterations = iterations};
  if (!(island->result.residual <= SPORE_HOPELESS)) effort.linear = SPORE_HOPELESS_WORK;
  bool helped = try_patiently(world, island, &best);
  for (size_t substeps = 2; substeps <= SUBSTEPS_MAXIMUM && !helped && effort.linear != 1; substeps *= 2) {
    if (spore_cancel_asked(world->cancel)) return true;
    if (best.worth > WORTH_GAINED && effort.iterations < least * substeps * island->substeps) break;
    effort.hopeless = best.worth == WORTH_STEP ? MISS_OF_LOAD : HUGE_VAL;
    try_again(world, island, substeps, &effort);
    if (effort.given_up) continue;
    helped = stands(world, island, MISS_OF_LOAD);
    if (!helped) remember_best(world, island, &best);
  }
  if (!helped && best.worth <= WORTH_GAINED && island->contact_count > 0)
    helped = try_without_friction(world, island, iterations);
  if (!helped && best.worth > WORTH_NOTHING) restore_best(world, island, &best);
  set_pause(world, island, pause_of, helped);
  return helped || best.least < SPORE_HOPELESS;
}

/* The body that the forces of the last good state would accelerate most, each body as a whole. */
static uint32_t most_pulled(SporeWorld *world, SporeIsland *island) {
  assert(island->kept_count >= 1);
  spore_island_gather(world, island);
  SporeIslandSystem system = {.world = world, .island = island, .now_s = -1};
  SporeDynamics dynamics = spore_island_system_dynamics(&system);
  double *f = world->solve.best_v + island->v_start; /* free: the step is not kept */
  dynamics.set_time(dynamics.data, 0);
  dynamics.force(dynamics.data, island->q0, island->v0, f);
  uint32_t found = world->solve.island_bodies[island->body_start];
  double most = -1;
  for (size_t i = 0; i < island->kept_count; i++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(&system, i, &site);
    SporeVec3 sum = {0, 0, 0};
    for (size_t k = 0; k < body->block_count; k++)
      if (body->model->block_mass[k] > 0) sum = spore_vec3_add(sum, spore_vec3_load(f + site->v + 3 * k));
    double acceleration = spore_vec3_length(sum) / body->total_mass;
    if (acceleration > most) most = acceleration, found = world->solve.island_bodies[island->body_start + i];
  }
  return found;
}

/* A method without damping that failed once will fail again, so the bodies keep the method that helped. */
static void make_safer(SporeWorld *world, SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++) {
    SporeBody *body = &world->bodies[world->solve.island_bodies[island->body_start + i]];
    if (spore_integrator(body->method.integrator)->damping == SPORE_DAMPING_FULL || body->model->type->rates) continue;
    body->method.integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
    island->made_safer = true;
  }
}

/* Whether the island is to be in balance: no motion stands in for that. */
static bool seeks_balance(SporeWorld *world, const SporeIsland *island) {
  const SporeIslandSystem system = {.world = world, .island = island};
  return island->integrator == SPORE_INTEGRATOR_STATIC && spore_island_system_is_held(&system);
}

/* A balance that was not found is left as far on the way to it as the island got, but not where that made energy: then
 * the island stays where it was. */
static void stay(SporeIsland *island) {
  memcpy(island->q1, island->q0, island->q_count * sizeof *island->q1);
  memset(island->v1, 0, island->v_count * sizeof *island->v1);
}

/* In the end island->trouble is the worst trouble, and island->offender the body that had the first. */
void spore_island_recover(SporeWorld *world, SporeIsland *island) {
  assert(island->offender < world->body_count);
  bool paused = pauses(world, island, pause_of);
  if (stands(world, island, paused ? 1 : MISS_OF_LOAD)) return;
  bool balance = seeks_balance(world, island);
  if (balance && island->trouble == SPORE_TROUBLE_NOT_CONVERGED) {
    if (gained_energy(world, island)) stay(island);
    return;
  }
  SporeTrouble worst = island->trouble;
  uint32_t met = island->offender, broken = broken_body(world, island);
  while (island->kept_count > 0) {
    if (spore_cancel_asked(world->cancel)) return;
    if (broken == SPORE_NO_BODY) {
      bool hopeless = !try_substeps(world, island);
      if (spore_cancel_asked(world->cancel)) return;
      if (island->trouble > worst) worst = island->trouble;
      if (island->trouble > SPORE_TROUBLE_NOT_CONVERGED) broken = island->offender;
      else if (hopeless && despairs(world, island)) broken = most_pulled(world, island);
      else break;
    } else {
      worst = SPORE_TROUBLE_NOT_FINITE;
    }
    spore_island_freeze(world, island, broken);
    broken = broken_body(world, island);
  }
  if (balance) island->result.converged = false;
  if (island->kept_count == 0) island->result = (SporeStepResult){.converged = true};
  else if (worst > SPORE_TROUBLE_NOT_CONVERGED) make_safer(world, island);
  island->trouble = worst;
  island->offender = met;
}
