/* The slowest swing of a body, for how much of its energy the body's method takes away. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/linalg/block_cholesky.h"
#include "core/math/vector.h"
#include "core/sim/solve/swing.h"
#include "core/sim/world_private.h"

#define ITERATIONS 60
#define MOST_FLOPS 5e9      /* of the factor */
#define SINGULAR 1e-9       /* of the stiffness of its nodes: a softer mode is rounding */
#define SMALLEST_SWING 0.02 /* rad or m: where the body does not move */

/* Number of active springs on the body, and the last of them. */
static size_t springs_of(const SporeWorld *world, uint32_t index, const SporeSpringTerm **spring) {
  size_t found = 0, count = spore_world_spring_count(world);
  for (size_t i = 0; i < count; i++) {
    const SporeSpringTerm *term = &world->links.springs[i];
    if (!world->links.active[i] || (term->a.body != index && term->b.body != index)) continue;
    *spring = term;
    found++;
  }
  return found;
}

static bool stands_still(const SporeWorld *world, uint32_t index) {
  return index == SPORE_NO_BODY || world->bodies[index].role == SPORE_UNMOVABLE;
}

/* Where a ball joint with what stands still holds the rigid body, and nothing else does. */
static const SporeEnd *pivot_of(const SporeWorld *world, uint32_t index, double *stiffness) {
  const SporeSpringTerm *spring = NULL;
  if (springs_of(world, index, &spring) != 1) return NULL;
  bool first = spring->a.body == index;
  const SporeEnd *own = first ? &spring->a : &spring->b, *other = first ? &spring->b : &spring->a;
  bool ball = spring->law.rest_length == 0 && spore_vec3_length(spring->law.free) == 0 && !spring->curve;
  if (!ball || own->prescribed || !stands_still(world, other->body)) return NULL;
  *stiffness = spring->law.stiffness;
  return own;
}

static SporeVec3 any_across(SporeVec3 direction) {
  SporeVec3 other = fabs(direction.x) < 0.9 ? (SporeVec3){1, 0, 0} : (SporeVec3){0, 1, 0};
  return spore_vec3_cross(direction, other);
}

/* A rigid body on a ball joint, as the pendulum of a point mass with the same frequency. It swings about the axis that
 * it turns about, or the one across its arm and gravity. */
static bool pendulum_of(const SporeWorld *world, uint32_t index, SporeSwing *swing) {
  const SporeBody *body = &world->bodies[index];
  double stiffness = 0;
  const SporeEnd *pivot = pivot_of(world, index, &stiffness);
  SporeVec3 gravity = spore_body_gravity(world, body);
  double pull = spore_vec3_length(gravity);
  if (!pivot || pull == 0 || body->held.count > 0) return false;
  const double *q = world->state.q + body->q_offset, *v = world->state.v + body->v_offset;
  SporeVec3 down = spore_vec3_scale(1 / pull, gravity), turn = spore_vec3_load(v + 3);
  SporeVec3 arm = spore_vec3_sub(spore_vec3_load(q), spore_mapping_position(pivot->mapping, pivot->point, q));
  SporeVec3 axis = spore_vec3_cross(down, arm);
  double reach = spore_vec3_length(arm);
  if (reach == 0) return false;
  if (spore_vec3_length(axis) < 1e-6 * reach) axis = turn;
  if (spore_vec3_length(axis) == 0) axis = any_across(down);
  axis = spore_vec3_normalise(axis, axis);
  SporeMat3 inertia;
  memcpy(inertia.m, world->state.mass + 3 * body->v_offset + 9, sizeof inertia.m);
  double own = spore_vec3_dot(axis, spore_mat3_apply(inertia, axis)), mass = body->total_mass;
  double length = (own + mass * reach * reach) / (mass * reach);
  double angle = atan2(spore_vec3_dot(axis, spore_vec3_cross(down, arm)), spore_vec3_dot(down, arm));
  double rate = spore_vec3_dot(axis, turn);
  double aside = spore_vec3_length(spore_vec3_add_scaled(turn, -rate, axis));
  if (aside * sqrt(length / pull) > SMALLEST_SWING) return false; /* it does not swing in a plane */
  if (fabs(angle) < SMALLEST_SWING && fabs(rate) * sqrt(length / pull) < SMALLEST_SWING) angle = SMALLEST_SWING;
  if (0.5 * rate * rate * length >= pull * (1 + cos(angle))) return false; /* it goes round */
  *swing = (SporeSwing){.frequency = sqrt(pull / length),
                        .length = length,
                        .stiffness = stiffness / mass,
                        .position = {length * sin(angle), -length * cos(angle), 0},
                        .velocity = {length * rate * cos(angle), length * rate * sin(angle), 0}};
  return true;
}

typedef struct Modes {
  SporeBlockMatrix stiffness;
  SporeBlockCholesky factor;
  double *mass, *x, *y; /* x, y: 3 a block */
  uint8_t *held;
} Modes;

static bool allocate(Modes *modes, const SporeModel *model) {
  size_t n = model->block_count;
  bool made = spore_model_matrix_create(model, &modes->stiffness);
  modes->mass = SPORE_NEW_ARRAY(double, 9 * n);
  modes->x = SPORE_NEW_ARRAY(double, 3 * n);
  modes->y = SPORE_NEW_ARRAY(double, 3 * n);
  modes->held = SPORE_NEW_ARRAY(uint8_t, n);
  return made && modes->mass && modes->x && modes->y && modes->held &&
         spore_block_cholesky_create(&modes->factor, &modes->stiffness, SPORE_FACTOR_AUTOMATIC, MOST_FLOPS, NULL) &&
         modes->factor.block_count > 0;
}

static void clear(Modes *modes) {
  spore_block_matrix_clear(&modes->stiffness);
  spore_block_cholesky_clear(&modes->factor);
  spore_free(modes->mass);
  spore_free(modes->x);
  spore_free(modes->y);
  spore_free(modes->held);
}

static void weigh(const Modes *modes, size_t blocks, const double *x, double *y) {
  for (size_t i = 0; i < blocks; i++) {
    SporeMat3 block;
    memcpy(block.m, modes->mass + 9 * i, sizeof block.m);
    spore_vec3_store(y + 3 * i, spore_mat3_apply(block, spore_vec3_load(x + 3 * i)));
  }
}

/* Square of the frequency that the stiffness of a single node makes, at most. */
static double stiffest_node(const Modes *modes, size_t blocks) {
  double most = 0;
  for (size_t i = 0; i < blocks; i++) {
    const double *k = modes->stiffness.values + 9 * (size_t)modes->stiffness.diagonal[i], *m = modes->mass + 9 * i;
    if (!modes->held[i]) most = fmax(most, (k[0] + k[4] + k[8]) / (m[0] + m[4] + m[8]));
  }
  return most;
}

/* Smallest eigenvalue of M^-1 K, by inverse iteration: y = K^-1 M x, x.M y / y.M y. 0: it did not settle. */
static double smallest_eigenvalue(Modes *modes, size_t blocks) {
  size_t n = 3 * blocks;
  double value = 0;
  for (size_t e = 0; e < n; e++) modes->x[e] = modes->held[e / 3] ? 0 : 1 + 0.1 * (double)(e % 7);
  for (int i = 0; i < ITERATIONS; i++) {
    weigh(modes, blocks, modes->x, modes->y);
    for (size_t b = 0; b < blocks; b++)
      if (modes->held[b]) memset(modes->y + 3 * b, 0, 3 * sizeof *modes->y);
    double square = spore_vector_dot(n, modes->x, modes->y); /* x.M x */
    spore_block_cholesky_solve(&modes->factor, modes->y, modes->x);
    double product = spore_vector_dot(n, modes->y, modes->x); /* M x . K^-1 M x */
    if (!(square > 0) || !(product > 0)) return 0;
    double next = square / product, scale = next / sqrt(square);
    for (size_t e = 0; e < n; e++) modes->x[e] *= scale;
    if (fabs(next - value) <= 1e-6 * next) return next;
    value = next;
  }
  return 0;
}

/* An elastic body that pins alone hold, as a mass on a spring. */
static bool spring_of(const SporeWorld *world, uint32_t index, SporeSwing *swing) {
  const SporeBody *body = &world->bodies[index];
  const SporeSpringTerm *none;
  if (!body->model->type->jacobian || body->held.pin_count == 0 || springs_of(world, index, &none) > 0) return false;
  const double *q = world->state.q + body->q_offset, *v = world->state.v + body->v_offset;
  Modes modes = {0};
  double square = 0;
  if (allocate(&modes, body->model)) {
    for (size_t i = 0; i < body->held.count; i++) modes.held[body->held.blocks[i]] = 1;
    spore_model_mass(body->model, q, modes.mass);
    body->model->type->jacobian(body->model, q, q, v, 1, 0, &modes.stiffness);
    if (spore_block_cholesky_factorise(&modes.factor, &modes.stiffness, NULL, modes.held, false))
      square = smallest_eigenvalue(&modes, body->block_count);
    if (!(square > SINGULAR * stiffest_node(&modes, body->block_count))) square = 0;
  }
  clear(&modes);
  if (square == 0) return false;
  *swing = (SporeSwing){.frequency = sqrt(square), .position = {SMALLEST_SWING, 0, 0}};
  return true;
}

bool spore_world_body_damping(const SporeWorld *world, uint32_t index, double *share) {
  assert(index < world->body_count && share);
  const SporeBody *body = &world->bodies[index];
  if (!spore_body_is_physical(body) || body->frozen || spore_body_is_static(body) || body->model->type->rates)
    return false;
  if (spore_body_sweeps(body)) return false; /* what one element loses does not tell what a sweep over many does */
  SporeSwing swing;
  bool known = spore_model_is_rigid(body->model) ? pendulum_of(world, index, &swing) : spring_of(world, index, &swing);
  if (!known) return false;
  size_t resolving;
  /* Islands are sorted anew by each step, so that sorting them changes nothing that is kept. */
  bool coupled = spore_body_coupled((SporeWorld *)(uintptr_t)world, index, &resolving) == SPORE_COUPLED_LINKS;
  SporeIntegratorKind kind = coupled ? SPORE_INTEGRATOR_IMPLICIT_EULER : body->method.integrator;
  return spore_swing_damping(&swing, kind, &world->solver, world->solver.time_step / (double)body->method.substeps,
                             share);
}
