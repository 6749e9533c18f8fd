/* Verification: whether the accepted state solves the equations of the scene as written.
 *
 * An integrator keeps the equations that it solved last, M (v - va) = c f(drift(qa, v, c), v), or f(q, v) = 0, with its
 * answer. Stage `verify` computes their residuals anew. Where a stage ends the step, drift(qa, v, c) is the accepted
 * state. Nothing of the world is written but the verdict, and the inertia of frames, which `advance` sets again.
 *
 * Forces are a pure function of q, v and t. Those that the solver evaluated last are used again where, bit by bit,
 * their v is the answer and their q is where that leads, and no law of a contact or link has changed since. Else they
 * are evaluated again, by code that the solver does not use: forces of the models by `force` instead of `force_along`,
 * contacts one by one instead of in lanes. So they are where the residual is above the tolerance, where the solver
 * says that it failed, where recovery stepped in, and every SPORE_STEPS_BETWEEN_LOOKS steps, for what the solver's own
 * evaluation may have wrong.
 *
 * Of a step in many parts the last equations are evaluated; of the others the solver's word is taken
 * (result.converged).
 *
 * Rounding is measured, where a residual is above the tolerance: the equation is evaluated where every number of q is
 * moved a little, up or down at random, and the change is scaled to the last digit. No answer in the same digits can be
 * sure of a smaller residual. */
#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/sim/solve/island_system.h"

#define ROUNDING_MARGIN 4 /* times what the last digits of q change: a residual below may be rounding alone */
#define MOVED 256.        /* last digits: so many that sums of few numbers do not round the change away */
#define TRIALS 2

/* An equation, and vectors of 3 block_count to evaluate it in; q: of at most 4/3 of one. */
typedef struct Equation {
  SporeIslandSystem system;
  double c, at_s, load;
  bool shaped;
  const double *qa, *va, *v;
  bool evaluated; /* by the solver: */
  SporeEvaluation last;
  uint64_t laws; /* of that evaluation */
  double *q, *work, *force, *residual, *other;
} Equation;

static Equation equation_of(SporeWorld *world, SporeIsland *island, size_t i) {
  assert(i < SPORE_EQUATIONS && i < island->equations.count);
  size_t buffer = SPORE_EQUATIONS * island->equations.set + i, n = island->v_count;
  double *scratch = world->solve.scratch + world->solve.scratch_per_block * (island->v_start / 3);
  const SporeEvaluation *last = &world->solve.evaluated[buffer];
  return (Equation){.system = {.world = world, .island = island, .apart = island->equations.kept[i].apart},
                    .c = island->equations.kept[i].c,
                    .at_s = island->equations.kept[i].at_s,
                    .load = island->equations.kept[i].load,
                    .shaped = island->equations.kept[i].shaped,
                    .qa = world->solve.kept_q[buffer] + island->q_start,
                    .va = world->solve.kept_va[buffer] + island->v_start,
                    .v = world->solve.kept_v[buffer] + island->v_start,
                    .evaluated = island->equations.kept[i].evaluated,
                    .last = {last->q + island->q_start, last->v + island->v_start, last->f + island->v_start},
                    .laws = island->equations.kept[i].laws,
                    .q = scratch,
                    .work = scratch + 2 * n,
                    .force = scratch + 3 * n,
                    .residual = scratch + 4 * n,
                    .other = scratch + 5 * n};
}

/* The balance of forces at rest where the step ended: the equation of a static body, whatever moved it. */
static Equation balance_of(SporeWorld *world, SporeIsland *island) {
  assert(island->equations.balance_load > 0 && island->equations.count > 0);
  Equation equation = equation_of(world, island, 0);
  equation.c = 0;
  equation.load = island->equations.balance_load;
  equation.shaped = false;
  equation.qa = island->q1;
  equation.v = world->solve.still;
  equation.evaluated = false;
  return equation;
}

/* Moves q from qa along v. */
static void place(const Equation *equation) {
  const SporeIslandSystem *system = &equation->system;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (equation->c > 0)
      spore_body_drift(body, equation->qa + site->q, equation->v + site->v, equation->c, equation->q + site->q,
                       equation->work + site->v);
    else memcpy(equation->q + site->q, equation->qa + site->q, body->q_count * sizeof(double));
  }
}

/* Whether the solver's last evaluation is that of the answer. Where a step ends there, the accepted q is known. */
static bool is_known(const Equation *equation) {
  const SporeIsland *island = equation->system.island;
  const SporeEvaluation *last = &equation->last;
  size_t q_size = island->q_count * sizeof(double);
  if (!equation->evaluated || memcmp(last->v, equation->v, island->v_count * sizeof(double)) != 0) return false;
  if (equation->laws != spore_island_system_laws(&equation->system)) return false;
  if (!memcmp(last->q, island->q1, q_size)) return true;
  place(equation);
  return !memcmp(last->q, equation->q, q_size);
}

static void add_body_forces(const Equation *equation, double *f) {
  const SporeIslandSystem *system = &equation->system;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (spore_island_system_leaves(system, body)) continue;
    const double *q = equation->q + site->q, *shape = equation->shaped ? equation->qa + site->q : q;
    const double *v = spore_body_is_static(body) ? system->world->solve.still : equation->v + site->v;
    body->model->type->force(body->model, q, shape, v, f + site->v);
    double gravity[3];
    spore_vec3_store(gravity, spore_body_gravity(system->world, body));
    spore_nodes_pull(body->block_count, f + site->v, body->model->block_mass, gravity);
  }
}

static void set_time(SporeEnd *end, double at_s) {
  if (end->prescribed) end->offset = spore_vec3_scale(at_s, end->velocity);
}

/* Evaluates a copy of the contact, so that what the step left in it stays, by the law alone. */
static void add_contact(const Equation *equation, const SporeContactTerm *contact, double *f) {
  SporeContactTerm copy = *contact;
  set_time(&copy.a, equation->at_s);
  set_time(&copy.b, equation->at_s);
  spore_contact_term_force(&copy, equation->system.world->solve.local_sites, equation->q, equation->v, equation->at_s,
                           f);
}

/* The same for a spring. One that runs along a curve writes the place of its end: it gets a mapping of its own. */
static void add_spring(const Equation *equation, const SporeSpringTerm *spring, double *f) {
  SporeSpringTerm copy = *spring;
  SporeCurveJoint joint;
  SporeMapping mapping;
  uint32_t rows[2] = {0, SPORE_PATH_WIDTH}, blocks[SPORE_PATH_WIDTH];
  double weights[SPORE_PATH_WIDTH], point[3];
  set_time(&copy.a, equation->at_s);
  set_time(&copy.b, equation->at_s);
  if (copy.curve && !copy.b.prescribed) {
    joint = *copy.curve;
    mapping = *joint.mapping;
    mapping.points = joint.points ? point : NULL;
    mapping.row_start = rows;
    mapping.block = blocks;
    mapping.weight = weights;
    joint.mapping = &mapping;
    copy.curve = &joint;
    copy.b.mapping = &mapping;
  }
  spore_spring_term_force(&copy, equation->system.world->solve.local_sites, equation->q, equation->v, f);
}

static void add_term_forces(const Equation *equation, double *f) {
  const SporeIslandSystem *system = &equation->system;
  for (size_t i = 0; i < system->island->contact_count; i++)
    add_contact(equation, spore_island_system_contact(system, i), f);
  for (size_t i = 0; i < system->island->spring_count; i++)
    add_spring(equation, spore_island_system_spring(system, i), f);
}

/* residual = M (v - va) - c f, or f where c is 0 */
static void set_residual(const Equation *equation, const double *f) {
  const SporeIslandSystem *system = &equation->system;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    size_t n = 3 * body->block_count;
    double *r = equation->residual + site->v, *change = equation->work + site->v;
    if (equation->c > 0) {
      spore_vector_move(n, change, equation->v + site->v, -1, equation->va + site->v);
      spore_island_system_weigh(system, body, change, r);
      spore_vector_add_scaled(n, r, -equation->c, f + site->v);
    } else {
      memcpy(r, f + site->v, n * sizeof *r);
    }
    spore_pin_filter(body->held.blocks, body->held.count, r);
  }
}

/* The residual at q. */
static void evaluate(const Equation *equation) {
  memset(equation->force, 0, equation->system.island->v_count * sizeof *equation->force);
  add_body_forces(equation, equation->force);
  add_term_forces(equation, equation->force);
  set_residual(equation, equation->force);
}

/* x.M^-1 x of the body; x: its part of a vector, 0 where blocks are held. */
static double dual_square(const SporeIslandSystem *system, const SporeBody *body, const double *x) {
  size_t nodes = spore_model_is_rigid(body->model) ? 0 : body->model->node_count;
  const double *inverse = system->world->state.mass_inverse + 3 * body->v_offset;
  double sum = spore_nodes_dual(nodes, x, body->model->block_mass);
  for (size_t i = nodes; i < body->block_count; i++) {
    double lighter[3];
    spore_blocks_apply(inverse + 9 * i, 1, x + 3 * i, lighter);
    sum += spore_vec3_dot(spore_vec3_load(x + 3 * i), spore_vec3_load(lighter));
  }
  return sum;
}

/* (x.M^-1 x)^1/2. *most, unless NULL: the body with the largest part of it, or with one that is not finite. */
static double dual_norm(const Equation *equation, const double *x, uint32_t *most) {
  const SporeIslandSystem *system = &equation->system;
  double sum = 0, largest = -1;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    double part = dual_square(system, body, x + site->v);
    sum += part;
    if (!most || part <= largest) continue;
    largest = part;
    *most = system->world->solve.island_bodies[system->island->body_start + b];
  }
  return sqrt(sum);
}

/* x moved by MOVED of its last digits, up or down by its place in the vector and the trial. */
static double moved(double x, size_t place, uint32_t trial) {
  uint32_t bits = ((uint32_t)place + 1) * 2654435761u ^ trial * 2246822519u;
  bits = (bits ^ bits >> 15) * 2654435761u;
  return x + (bits >> 31 ? MOVED : -MOVED) * DBL_EPSILON * x;
}

/* Norm of what the residual may be wrong by, since q has only so many digits. Overwrites q and the residual. */
static double measure_rounding(const Equation *equation) {
  const SporeIsland *island = equation->system.island;
  size_t n = island->v_count, q_count = island->q_count;
  double *q = equation->other + n, *before = q + 2 * n, largest = 0;
  memcpy(before, equation->residual, n * sizeof *before);
  memcpy(q, equation->q, q_count * sizeof *q);
  for (uint32_t trial = 0; trial < TRIALS; trial++) {
    for (size_t k = 0; k < q_count; k++) equation->q[k] = moved(q[k], k, trial);
    evaluate(equation);
    memcpy(equation->other, before, n * sizeof *before);
    spore_vector_add_scaled(n, equation->other, -1, equation->residual);
    largest = fmax(largest, dual_norm(equation, equation->other, NULL) / MOVED);
  }
  return ROUNDING_MARGIN * largest;
}

/* Whether gravity pulls at the island, or a contact or link. */
static bool is_loaded(const Equation *equation) {
  const SporeIsland *island = equation->system.island;
  if (island->gravity_momentum > 0) return true;
  memset(equation->other, 0, island->v_count * sizeof(double));
  add_term_forces(equation, equation->other);
  spore_island_system_filter(&equation->system, equation->other);
  return dual_norm(equation, equation->other, NULL) > 0;
}

/* Sets the inertia of frames to that at qa. */
static void turn_mass(const Equation *equation) {
  const SporeIslandSystem *system = &equation->system;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    spore_body_turn_mass(system->world, body, equation->qa + site->q);
  }
}

static double norm_of_residual(const Equation *equation, SporeVerdict *verdict) {
  *verdict = (SporeVerdict){.body = SPORE_NO_BODY};
  double norm = dual_norm(equation, equation->residual, &verdict->body);
  if (norm > 0) verdict->residual = norm / equation->load;
  return norm;
}

static SporeVerdict judge(const Equation *equation, double tolerance) {
  SporeVerdict verdict;
  turn_mass(equation);
  if (is_known(equation)) {
    set_residual(equation, equation->last.f);
    if (norm_of_residual(equation, &verdict) <= tolerance * equation->load) return verdict;
  }
  place(equation);
  evaluate(equation);
  double norm = norm_of_residual(equation, &verdict);
  if (norm <= tolerance * equation->load) return verdict;
  if (!isfinite(norm)) verdict.residual = INFINITY;
  bool loaded = is_loaded(equation);
  double rounding = measure_rounding(equation);
  /* In a body that nothing pulls or touches there is nothing to solve but rounding. */
  if (!loaded && norm <= rounding) return (SporeVerdict){.body = SPORE_NO_BODY};
  verdict.rounding = rounding / equation->load;
  return verdict;
}

static void judge_also(SporeVerdict *verdict, const Equation *equation, double tolerance) {
  SporeVerdict other = judge(equation, tolerance);
  if (other.residual > verdict->residual) *verdict = other;
}

/* Whether forces are evaluated again, come what may. */
static bool is_doubted(const SporeWorld *world, const SporeIsland *island) {
  size_t turn = world->state.step + (size_t)(island - world->solve.islands);
  return turn % SPORE_STEPS_BETWEEN_LOOKS == 0 || island->mending_substeps > 0 || !island->result.converged;
}

static void verify_island(void *data, size_t index) {
  SporeWorld *world = data;
  assert(index < world->solve.island_count);
  SporeIsland *island = &world->solve.islands[index];
  SporeVerdict *verdict = &island->verdict;
  double tolerance = world->solver.tolerance;
  bool moved = false, doubted = is_doubted(world, island);
  *verdict = (SporeVerdict){.body = SPORE_NO_BODY};
  if (island->kept_count == 0) return;
  for (size_t i = 0; i < island->equations.count && i < SPORE_EQUATIONS; i++) {
    Equation equation = equation_of(world, island, i);
    equation.evaluated &= !doubted;
    judge_also(verdict, &equation, tolerance);
    moved |= equation.c > 0;
  }
  if (moved && island->equations.balance_load > 0) {
    Equation balance = balance_of(world, island);
    judge_also(verdict, &balance, tolerance);
  }
  bool solved = verdict->residual <= tolerance;
  if (solved && !island->result.converged && !(island->result.residual <= tolerance)) {
    *verdict = (SporeVerdict){.residual = island->result.residual, .body = island->offender}; /* of an earlier part */
  } else if (!solved && island->trouble <= SPORE_TROUBLE_NOT_CONVERGED) {
    island->trouble = SPORE_TROUBLE_NOT_CONVERGED;
    island->offender = verdict->body;
  }
}

void spore_world_verify(SporeWorld *world) {
  size_t work = 0;
  for (size_t i = 0; i < world->solve.island_count; i++) work += world->solve.islands[i].v_count;
  spore_pool_run(spore_pool_for(world->pool, work), world->solve.island_count, verify_island, world);
  SporeStepCounts *counts = &world->state.counts;
  for (size_t i = 0; i < world->solve.island_count; i++)
    counts->residual = fmax(counts->residual, world->solve.islands[i].verdict.residual);
}
