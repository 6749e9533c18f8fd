/* A method tried on one body alone, from the body's state at time 0. */
#include "core/sim/solve/method_trial.h"

#include "core/base/memory.h"
#include "core/sim/solve/island_system.h"

/* Parts of the body's extent: what moves while the fastest mode turns by 1 rad, in a step at most, and in a second at
 * least. Small, so that the body's forces are nearly linear, and far above rounding. */
#define PUSH 1e-6
#define PUSH_OF_STEP 1e-3
#define PUSH_OF_SECOND 1e-3
#define GAIN 0.01      /* of the energy at work */
#define SWING 2        /* times the gains of the first half of the steps */
#define SWING_MOST 1e3 /* times the energy at work; that of a mode swings so far at .998 of its largest step */

typedef struct Trial {
  SporeWorld *world;
  SporeBody *body;
  SporeIsland island;
  SporeIslandSystem system;
  const SporeIntegrator *integrator;
  double step_s;
  double *q[2], *v[2], *scratch; /* scratch: history, given force, and the integrator's own */
} Trial;

/* Energy since the start, J. */
typedef struct Account {
  double kinetic, potential; /* at the start */
  double work;               /* the largest of what is at work */
  double gain[2];            /* largest gain in each half of the steps */
} Account;

static bool is_here(const SporeBody *body, const double *q) {
  return !body->model->type->rates || !spore_particle_is_out(q);
}

/* Largest distance of a node from the middle of all, m. */
static double extent_of(const SporeBody *body, const double *q) {
  SporeVec3 middle = {0, 0, 0};
  double most = 0;
  size_t count = 0;
  for (size_t i = 0; i < body->model->node_count; i++) {
    if (!is_here(body, q + 3 * i)) continue;
    middle = spore_vec3_add(middle, spore_vec3_load(q + 3 * i));
    count++;
  }
  if (count == 0) return 0;
  middle = spore_vec3_scale(1 / (double)count, middle);
  for (size_t i = 0; i < body->model->node_count; i++)
    if (is_here(body, q + 3 * i)) most = fmax(most, spore_vec3_distance(middle, spore_vec3_load(q + 3 * i)));
  return most;
}

/* What is solved is pushed smoothly: its nodes come apart as a linear function of place. */
static void push_smoothly(const SporeBody *body, double speed, double extent, const double *q, double *v) {
  static const SporeMat3 shear = {{0.3, 0.5, -0.2, 0.1, -0.4, 0.6, -0.5, 0.2, 0.1}};
  const SporeVec3 whole = {0.3, 0.5, -0.4};
  for (size_t i = 0; i < body->block_count; i++) {
    bool node = i < body->model->node_count;
    SporeVec3 part = whole;
    if (node) {
      SporeVec3 arm = spore_vec3_sub(spore_vec3_load(q + 3 * i), spore_vec3_load(q));
      part = spore_vec3_add(whole, spore_mat3_apply(shear, spore_vec3_scale(1 / extent, arm)));
    }
    spore_vec3_accumulate(v + 3 * i, spore_vec3_scale(node ? speed : speed / extent, part));
  }
}

/* What is not solved is pushed so that the velocity differs from node to node, the same on every machine: the fastest
 * modes are those that grow. */
static void push_each(const SporeBody *body, double speed, double extent, const double *q, double *v) {
  uint32_t state = 2463534242u;
  for (size_t k = 0; k < 3 * body->block_count; k++) {
    state = state * 1664525u + 1013904223u;
    double part = 2 * (double)(state >> 8) / (1 << 24) - 1;
    bool node = k / 3 < body->model->node_count;
    if (!node || is_here(body, q + 3 * (k / 3))) v[k] += part * (node ? speed : speed / extent);
  }
}

static void push(const Trial *trial, double frequency) {
  const SporeBody *body = trial->body;
  double extent = extent_of(body, trial->q[0]), least = 1e-2;
  if (extent == 0) extent = least; /* a single node, or a frame */
  double most = fmax(PUSH_OF_STEP / trial->step_s, PUSH_OF_SECOND) * extent;
  bool solved = trial->integrator->implicit && !body->model->type->rates;
  if (solved) push_smoothly(body, most, extent, trial->q[0], trial->v[0]);
  else push_each(body, fmin(fmax(PUSH * frequency, PUSH_OF_SECOND) * extent, most), extent, trial->q[0], trial->v[0]);
  spore_pin_filter(body->held.blocks, body->held.count, trial->v[0]);
}

static bool allocate(Trial *trial) {
  size_t n = trial->island.v_count, scratch = spore_integrator_scratch() / 3 + 4;
  for (int i = 0; i < 2; i++) {
    trial->q[i] = SPORE_NEW_ARRAY(double, trial->island.q_count);
    trial->v[i] = SPORE_NEW_ARRAY(double, n);
  }
  trial->scratch = spore_allocate(n, scratch * sizeof(double));
  const SporeModelSweep *sweep = trial->integrator->sweeps ? trial->body->model->type->sweep : NULL;
  if (sweep && !sweep->prepare(trial->body->model, trial->world->cancel)) return false;
  return trial->q[0] && trial->q[1] && trial->v[0] && trial->v[1] && trial->scratch;
}

static void free_trial(Trial *trial) {
  for (int i = 0; i < 2; i++) {
    spore_free(trial->q[i]);
    spore_free(trial->v[i]);
  }
  spore_free(trial->scratch);
}

/* A force that takes gravity away. */
static const double *against_gravity(const Trial *trial, double *given) {
  double lift[3];
  spore_vec3_store(lift, spore_vec3_scale(-1, spore_body_gravity(trial->world, trial->body)));
  spore_nodes_pull(trial->body->block_count, given, trial->body->model->block_mass, lift);
  return given;
}

/* The body alone as an island, at the front of the vectors of all islands. */
static void isolate(Trial *trial, uint32_t index) {
  SporeWorld *world = trial->world;
  const SporeBody *body = trial->body;
  world->solve.island_bodies[0] = index;
  world->solve.local_sites[index] = (SporeSite){0, 0};
  trial->island = (SporeIsland){.body_count = 1,
                                .kept_count = 1,
                                .q_count = body->q_count,
                                .v_count = 3 * body->block_count,
                                .substeps = 1,
                                .gravity_momentum = sqrt(body->total_mass) * spore_vec3_length(world->state.gravity),
                                .integrator = body->method.integrator};
}

/* Adds the state to the account. half: 0 or 1. False: it is more than a swing. */
static bool enter(const Trial *trial, Account *account, const double *q, const double *v, int half) {
  double kinetic = spore_body_kinetic_energy(trial->world, trial->body, v);
  double stored = trial->body->model->type->potential(trial->body->model, q) - account->potential;
  double gain = kinetic - account->kinetic + stored;
  account->work = fmax(account->work, kinetic + fabs(stored) - fmax(gain, 0));
  account->gain[half] = fmax(account->gain[half], gain);
  return gain <= SWING_MOST * account->work;
}

static bool is_bounded(const Trial *trial, const Account *account) {
  double allowed = GAIN * account->work;
  if (trial->integrator->implicit) return fmax(account->gain[0], account->gain[1]) <= allowed;
  return account->gain[1] <= (trial->integrator->swings ? SWING : 1) * account->gain[0] + allowed;
}

/* A step, taken again by the factor where conjugate gradients did not solve it, as in every step of the world. */
static SporeStepResult take_step(Trial *trial, SporeHistory *history, size_t i, double *scratch) {
  const double *q0 = trial->q[i % 2], *v0 = trial->v[i % 2];
  double *q1 = trial->q[1 - i % 2], *v1 = trial->v[1 - i % 2];
  SporeStepResult result = {0};
  for (int attempt = 0; attempt < 2; attempt++) {
    SporeHistory before = *history;
    trial->system =
        (SporeIslandSystem){.world = trial->world, .island = &trial->island, .given = trial->system.given, .now_s = -1};
    SporeDynamics dynamics = spore_island_system_dynamics(&trial->system);
    dynamics.keep = NULL;
    dynamics.set_mass(dynamics.data, q0);
    dynamics.set_time(dynamics.data, trial->step_s);
    result = trial->integrator->step(&dynamics, &trial->world->solver, history, trial->step_s, q0, v0, q1, v1, scratch);
    trial->island.result = result;
    if (!trial->integrator->implicit || !spore_island_choose(trial->world, &trial->island)) break;
    history->step_s = before.step_s;
  }
  spore_body_turn_mass(trial->world, trial->body, q1);
  return result;
}

static bool finite_all(const double *values, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (!isfinite(values[i])) return false;
  return true;
}

static SporeMethodResult run(Trial *trial, size_t steps, const SporeCancel *cancel) {
  size_t n = trial->island.v_count, q_count = trial->island.q_count;
  SporeHistory history = {.a = trial->scratch, .b = trial->scratch + n};
  SporeMethodResult result = {.outcome = SPORE_METHOD_BOUNDED};
  trial->system.given = against_gravity(trial, trial->scratch + 2 * n);
  Account account = {.kinetic = spore_body_kinetic_energy(trial->world, trial->body, trial->v[0]),
                     .potential = trial->body->model->type->potential(trial->body->model, trial->q[0])};
  account.work = account.kinetic;
  for (size_t i = 0; i < steps && result.outcome == SPORE_METHOD_BOUNDED; i++) {
    SporeStepResult step = take_step(trial, &history, i, trial->scratch + 3 * n);
    const double *q = trial->q[1 - i % 2], *v = trial->v[1 - i % 2];
    trial->world->state.step++;
    result.steps++;
    if (spore_cancel_asked(trial->world->cancel) || spore_cancel_asked(cancel)) result.outcome = SPORE_METHOD_CANCELLED;
    else if (!finite_all(q, q_count) || !finite_all(v, n)) result.outcome = SPORE_METHOD_NOT_FINITE;
    else if (!step.converged) result.outcome = SPORE_METHOD_NOT_SOLVED;
    else if (!enter(trial, &account, q, v, i >= steps / 2)) result.outcome = SPORE_METHOD_GREW;
  }
  if (result.outcome == SPORE_METHOD_BOUNDED && !is_bounded(trial, &account)) result.outcome = SPORE_METHOD_GREW;
  if (account.work == 0) result.outcome = SPORE_METHOD_NOTHING;
  result.gain = account.work > 0 ? fmax(account.gain[0], account.gain[1]) / account.work : 0;
  return result;
}

/* What the steps left with the solver and the model is of no use to the world. */
static void forget(SporeWorld *world, SporeBody *body) {
  spore_body_forget_steps(world, body);
  spore_body_set_mass(world, body);
  if (body->model->type->forget) body->model->type->forget(body->model);
}

SporeMethodResult spore_world_try_method(SporeWorld *world, uint32_t index, const SporeMethodTrial *how) {
  assert(index < world->body_count && world->bodies[index].role == SPORE_PASSIVE && world->state.step == 0);
  assert(how && how->step_s > 0 && how->integrator >= 0 && how->integrator != SPORE_INTEGRATOR_STATIC);
  SporeBody *body = &world->bodies[index];
  SporeIntegratorKind own = body->method.integrator;
  SporeStepLimit limit = {0};
  SporeMethodResult result = {.outcome = SPORE_METHOD_NO_MEMORY};
  Trial trial = {.world = world, .body = body, .integrator = spore_integrator(how->integrator), .step_s = how->step_s};
  body->method.integrator = how->integrator;
  forget(world, body);
  isolate(&trial, index);
  if (allocate(&trial) && spore_world_predict_step(world, index, how->integrator, &limit, NULL)) {
    memcpy(trial.q[0], world->state.q + body->q_offset, body->q_count * sizeof(double));
    memcpy(trial.v[0], world->state.v + body->v_offset, 3 * body->block_count * sizeof(double));
    push(&trial, limit.frequency);
    result = run(&trial, how->steps, how->cancel);
  }
  free_trial(&trial);
  world->state.step = 0;
  body->method.integrator = own;
  forget(world, body);
  return result;
}

bool spore_world_predict_step(const SporeWorld *world, uint32_t index, SporeIntegratorKind kind, SporeStepLimit *limit,
                              SporeError *error) {
  assert(index < world->body_count && world->bodies[index].role == SPORE_PASSIVE && limit);
  const SporeBody *body = &world->bodies[index];
  bool implicit = spore_integrator(kind)->implicit;
  if (!spore_step_limit(body->model, implicit ? SPORE_INTEGRATOR_VERLET : kind, world->state.rest_q + body->q_offset,
                        world->state.rest_v + body->v_offset, body->held.blocks, body->held.count, limit, error))
    return false;
  if (implicit && !body->model->type->rates) limit->dt_s = limit->whole_dt_s = HUGE_VAL;
  return true;
}
