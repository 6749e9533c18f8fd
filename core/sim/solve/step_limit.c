/* Step limit: the largest stable step of explicit integrators, by power iteration. */
#include "core/sim/solve/step_limit.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/constraint/pin.h"
#include "core/sim/world_private.h"

#define ITERATIONS 500
#define SURE 0.98 /* of a limit that the iteration finds: its eigenvalue is a lower bound */

typedef struct Power {
  SporeBlockMatrix matrix;
  double *inverse;         /* M^-1, 9 a block */
  double *x, *y, *z;       /* after an iteration: the eigenvector; work; M times the eigenvector */
  double *other, *weighed; /* the eigenvector before that, and M times it */
  const uint32_t *held;
  size_t held_count;
  double shift; /* s: the matrix is K + s M */
} Power;

static bool invert_mass(const SporeModel *model, const double *q, double *blocks) {
  spore_model_mass(model, q, blocks);
  for (size_t i = 0; i < model->block_count; i++) {
    SporeMat3 block, inverse;
    memcpy(block.m, blocks + 9 * i, sizeof block.m);
    if (!spore_mat3_invert(block, &inverse)) return false;
    memcpy(blocks + 9 * i, inverse.m, sizeof inverse.m);
  }
  return true;
}

/* Start of the iteration: no eigenvector of a symmetric body, and the same on every machine. */
static void fill_start(double *x, size_t count) {
  uint32_t state = 12345;
  for (size_t i = 0; i < count; i++) {
    state = state * 1664525u + 1013904223u;
    x[i] = (double)(state >> 8) / (1 << 24) - 0.5;
  }
}

static double dot(const double *a, const double *b, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += a[i] * b[i];
  return sum;
}

/* y = M^-1 x, block by block */
static void solve_mass(const Power *power, const double *x, double *y) {
  for (size_t i = 0; i < power->matrix.block_count; i++) {
    SporeMat3 block;
    memcpy(block.m, power->inverse + 9 * i, sizeof block.m);
    spore_vec3_store(y + 3 * i, spore_mat3_apply(block, spore_vec3_load(x + 3 * i)));
  }
}

/* Largest eigenvalue of M^-1 K + s, as the Rayleigh quotient x.K x / x.M x. The iteration is in r = M x, so that M
 * itself is not needed: x = M^-1 r, r <- K x. */
static double largest_eigenvalue(const Power *power) {
  assert(power->matrix.block_count > 0);
  size_t n = 3 * power->matrix.block_count;
  double *r = power->z, *x = power->x, *k = power->y, value = 0;
  fill_start(r, n);
  spore_pin_filter(power->held, power->held_count, r);
  for (int i = 0; i < ITERATIONS; i++) {
    solve_mass(power, r, x);
    double square = dot(r, x, n); /* x.M x */
    if (!(square > 0)) return 0;
    for (size_t e = 0; e < n; e++) k[e] = power->shift * r[e];
    spore_block_matrix_multiply_add(&power->matrix, x, k);
    spore_pin_filter(power->held, power->held_count, k);
    double next = dot(x, k, n) / square;
    bool settled = fabs(next - value) <= 1e-4 * next;
    value = next;
    if (!(value > 0) || (settled && i > 20)) break;
    double scale = 1 / (sqrt(square) * value);
    for (size_t e = 0; e < n; e++) r[e] = scale * k[e];
  }
  return fmax(value, 0);
}

static bool allocate(Power *power, const SporeModel *model) {
  size_t n = 3 * model->block_count;
  bool made = spore_model_matrix_create(model, &power->matrix);
  power->inverse = SPORE_NEW_ARRAY(double, 3 * n);
  power->x = SPORE_NEW_ARRAY(double, n);
  power->y = SPORE_NEW_ARRAY(double, n);
  power->z = SPORE_NEW_ARRAY(double, n);
  power->other = SPORE_NEW_ARRAY(double, n);
  power->weighed = SPORE_NEW_ARRAY(double, n);
  return made && power->inverse && power->x && power->y && power->z && power->other && power->weighed;
}

static void clear(Power *power) {
  spore_block_matrix_clear(&power->matrix);
  spore_free(power->inverse);
  spore_free(power->x);
  spore_free(power->y);
  spore_free(power->z);
  spore_free(power->other);
  spore_free(power->weighed);
}

/* Root of w^2 h^2 + b d h = a - 1. */
static double stable_step(const SporeIntegrator *integrator, double square, double damping) {
  assert(integrator->stable_square > 1);
  double a = integrator->stable_square - 1, b = integrator->stable_damping * damping;
  if (square <= 0) return damping > 0 ? a / b : HUGE_VAL;
  return (sqrt(b * b + 4 * a * square) - b) / (2 * square);
}

/* One step of h seconds of the mode x' = v, v' = -w^2 x - d v, as a matrix on (w x, v, and h v' where it is kept). */
static void step_matrix(const SporeIntegrator *integrator, double w, double d, double h, double m[9]) {
  double y = h * w, z = h * d;
  if (integrator == &spore_symplectic_euler || integrator == &spore_position_based) {
    memcpy(m, (double[]){1 - y * y, y * (1 - z), 0, -y, 1 - z, 0, 0, 0, 0}, 9 * sizeof *m);
  } else if (integrator == &spore_verlet) {
    double kept[3] = {-y, -y * y - z, -0.5 * y * y - z};
    memcpy(m, (double[]){1, y, 0.5 * y, 0.5 * kept[0], 1 + 0.5 * kept[1], 0.5 + 0.5 * kept[2]}, 6 * sizeof *m);
    memcpy(m + 6, kept, sizeof kept);
  } else {
    assert(integrator == &spore_rk4);
    double power[4] = {1, 0, 0, 1}, sum[4] = {1, 0, 0, 1};
    for (int k = 1; k <= 4; k++) {
      const double next[4] = {-y * power[1] / k, (y * power[0] - z * power[1]) / k, -y * power[3] / k,
                              (y * power[2] - z * power[3]) / k};
      memcpy(power, next, sizeof next);
      for (int e = 0; e < 4; e++) sum[e] += next[e];
    }
    memcpy(m, (double[]){sum[0], sum[1], 0, sum[2], sum[3], 0, 0, 0, 0}, 9 * sizeof *m);
  }
}

/* Whether no eigenvalue is larger than 1: Jury's conditions on l^3 + a l^2 + b l + c. */
static bool is_stable(const double m[9]) {
  const double slack = 1e-9;
  double a = -(m[0] + m[4] + m[8]);
  double b = m[0] * m[4] - m[1] * m[3] + m[0] * m[8] - m[2] * m[6] + m[4] * m[8] - m[5] * m[7];
  double c =
      -(m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]));
  return 1 + a + b + c >= -slack && 1 - a + b - c >= -slack && fabs(c) <= 1 + slack &&
         fabs(b - a * c) <= 1 - c * c + slack;
}

/* The largest step of a mode with that frequency and damping, by bisection. */
static double mode_step(const SporeIntegrator *integrator, double frequency, double damping) {
  double rate = fmax(frequency, damping), m[9];
  if (rate == 0) return HUGE_VAL;
  double low = 0, high = 8 / rate; /* no method is stable there: a rate of the mode is w, or d/2, at least */
  for (int i = 0; i < 50; i++) {
    double middle = 0.5 * (low + high);
    step_matrix(integrator, frequency, damping, middle, m);
    if (is_stable(m)) low = middle;
    else high = middle;
  }
  return low;
}

/* x.A x / x.M x of the present matrix; weighed: M x. */
static double quotient(Power *power, const double *x, const double *weighed) {
  size_t n = 3 * power->matrix.block_count;
  double square = dot(x, weighed, n);
  memset(power->y, 0, n * sizeof *power->y);
  spore_block_matrix_multiply_add(&power->matrix, x, power->y);
  return square > 0 ? fmax(dot(x, power->y, n) / square, 0) : 0;
}

/* Eigenvalues, and the step of the mode of largest frequency with the damping that it has, or of that of largest
 * damping with its frequency, whichever is smaller. */
static void find_modes(Power *power, const SporeModel *model, const double *q, const double *v,
                       const SporeIntegrator *integrator, SporeStepLimit *limit) {
  size_t n = 3 * model->block_count;
  model->type->jacobian(model, q, q, v, 1, 0, &power->matrix);
  limit->frequency = sqrt(largest_eigenvalue(power));
  memcpy(power->other, power->x, n * sizeof *power->x);
  memcpy(power->weighed, power->z, n * sizeof *power->z);
  spore_block_matrix_zero(&power->matrix);
  model->type->jacobian(model, q, q, v, 0, 1, &power->matrix);
  double its_damping = quotient(power, power->other, power->weighed);
  limit->damping = largest_eigenvalue(power);
  spore_block_matrix_zero(&power->matrix);
  model->type->jacobian(model, q, q, v, 1, 0, &power->matrix);
  double its_frequency = limit->damping > 0 ? sqrt(quotient(power, power->x, power->z)) : 0;
  if (integrator->stable_square == 0) return;
  limit->dt_s = SURE * stable_step(integrator, limit->frequency * limit->frequency, limit->damping);
  limit->whole_dt_s = mode_step(integrator, limit->frequency, its_damping);
  if (limit->damping > 0)
    limit->whole_dt_s = fmin(limit->whole_dt_s, mode_step(integrator, its_frequency, limit->damping));
}

/* Whether a step of explicit Euler makes some motion grow: h K is more than D in its direction. */
static bool grows(Power *power, const SporeModel *model, const double *q, const double *v, double h) {
  assert(h > 0 && power->shift > 0);
  spore_block_matrix_zero(&power->matrix);
  model->type->jacobian(model, q, q, v, h, -1, &power->matrix);
  return largest_eigenvalue(power) > power->shift * (1 + 1e-6);
}

#define HALVINGS 14

static double explicit_euler_step(Power *power, const SporeModel *model, const double *q, const double *v,
                                  const SporeStepLimit *limit) {
  assert(limit->frequency >= 0 && limit->damping >= 0);
  if (limit->frequency == 0) return limit->damping > 0 ? 2 / limit->damping : HUGE_VAL;
  if (limit->damping == 0) return 0;
  power->shift = 1.02 * limit->damping; /* keeps the matrix positive definite */
  double high = fmin(2 / limit->damping, limit->damping / (limit->frequency * limit->frequency)), low = 0;
  for (int i = 0; i < HALVINGS; i++) {
    double middle = i == 0 ? high : 0.5 * (low + high);
    if (grows(power, model, q, v, middle)) high = middle;
    else low = middle;
    if (low == high) break;
  }
  return low;
}

bool spore_step_limit(const SporeModel *model, SporeIntegratorKind kind, const double *q, const double *v,
                      const uint32_t *held, size_t held_count, SporeStepLimit *limit, SporeError *error) {
  assert(model && limit);
  assert(held_count == 0 || held);
  *limit = (SporeStepLimit){0, 0, HUGE_VAL, HUGE_VAL};
  const SporeIntegrator *integrator = spore_integrator(kind);
  if (model->type->rates) {
    model->type->rates(model, &limit->frequency, &limit->damping);
    if (integrator->stable_square == 0) return limit->dt_s = limit->whole_dt_s = 0, true;
    limit->dt_s = SURE * stable_step(integrator, limit->frequency * limit->frequency, limit->damping);
    limit->whole_dt_s = mode_step(integrator, limit->frequency, limit->damping);
    return true;
  }
  if (!model->type->jacobian) return true;
  Power power = {.held = held, .held_count = held_count};
  if (!allocate(&power, model)) {
    clear(&power);
    return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory to find the largest step"));
  }
  if (invert_mass(model, q, power.inverse)) {
    find_modes(&power, model, q, v, integrator, limit);
    if (integrator->stable_square == 0) {
      limit->whole_dt_s = explicit_euler_step(&power, model, q, v, limit);
      limit->dt_s = SURE * limit->whole_dt_s;
    }
  }
  clear(&power);
  if (integrator->sweeps && spore_model_sweeps(model)) limit->dt_s = limit->whole_dt_s = HUGE_VAL;
  return true;
}

static bool refuse(const SporeWorld *world, const SporeBody *body, double limit_s, SporeError *error) {
  assert(body->method.substeps >= 1);
  char place[200];
  const char *name = spore_integrator_names[body->method.integrator];
  double h = world->solver.time_step / (double)body->method.substeps, needed = ceil(world->solver.time_step / limit_s);
  snprintf(place, sizeof place, "bodies/%s", body->name);
  if (limit_s == 0)
    return spore_error_set(error, SPORE_ERROR_INPUT, place,
                           _("no step is small enough for %s: something here swings without damping; expected another "
                             "method; take integrator symplectic_euler or implicit_euler"),
                           name);
  if (body->model->type->rates && needed <= SPORE_SUBSTEPS_MAXIMUM)
    return spore_error_set(error, SPORE_ERROR_INPUT, place,
                           _("a step of %.3g s is too large for particles like these; expected at most %.3g s; take "
                             "%.0f substeps, a smaller time_step or fewer particles"),
                           h, limit_s, needed);
  if (body->model->type->rates)
    return spore_error_set(error, SPORE_ERROR_INPUT, place,
                           _("a step of %.3g s is too large for particles like these; expected at most %.3g s; take a "
                             "smaller time_step, fewer or heavier particles, or forces less strong"),
                           h, limit_s);
  if (needed <= SPORE_SUBSTEPS_MAXIMUM)
    return spore_error_set(error, SPORE_ERROR_INPUT, place,
                           _("a step of %.3g s is too large for %s with this stiffness; expected at most %.3g s; take "
                             "%.0f substeps, a smaller time_step or integrator implicit_euler"),
                           h, name, limit_s, needed);
  return spore_error_set(error, SPORE_ERROR_INPUT, place,
                         _("a step of %.3g s is too large for %s with this stiffness; expected at most %.3g s; take a "
                           "smaller time_step or integrator implicit_euler"),
                         h, name, limit_s);
}

bool spore_body_is_held(const SporeWorld *world, uint32_t index) {
  assert(index < world->body_count);
  if (world->bodies[index].held.pin_count > 0) return true;
  for (size_t i = 0; i < world->links.term_count; i++)
    if (world->links.springs[i].a.body == index || world->links.springs[i].b.body == index) return true;
  return false;
}

/* Whether a pin or a link holds the body, or contacts may. */
static bool may_be_held(const SporeWorld *world, uint32_t index) {
  return spore_body_is_held(world, index) || world->bodies[index].collision.spheres.point_count > 0;
}

static bool check_static(const SporeWorld *world, uint32_t index, SporeError *error) {
  assert(spore_body_is_static(&world->bodies[index]));
  char place[200];
  snprintf(place, sizeof place, "bodies/%s", world->bodies[index].name);
  if (world->bodies[index].model->type->rates)
    return spore_error_set(error, SPORE_ERROR_INPUT, place,
                           _("particles have no one balance of forces to be found; expected a method that moves them; "
                             "leave the integrator open, or take verlet"));
  if (may_be_held(world, index)) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, place,
                         _("nothing can hold the body, so that its forces have no balance; expected a pin, a link or "
                           "spheres; pin it, or take integrator implicit_euler"));
}

bool spore_body_check_step(const SporeWorld *world, uint32_t index, SporeError *error) {
  assert(index < world->body_count);
  assert(world->solver.time_step > 0);
  const SporeBody *body = &world->bodies[index];
  if (body->role != SPORE_PASSIVE) return true;
  if (spore_body_is_static(body) && !check_static(world, index, error)) return false;
  SporeIntegratorKind kind = body->method.integrator;
  if (spore_integrator(kind)->implicit) {
    if (!body->model->type->rates) return true;
    kind = SPORE_INTEGRATOR_VERLET; /* without a Jacobian, an implicit method needs steps as small */
  }
  SporeStepLimit limit;
  if (!spore_step_limit(body->model, kind, world->state.rest_q + body->q_offset, world->state.rest_v + body->v_offset,
                        body->held.blocks, body->held.count, &limit, error))
    return false;
  return world->solver.time_step <= limit.dt_s * (double)body->method.substeps ||
         refuse(world, body, limit.dt_s, error);
}
