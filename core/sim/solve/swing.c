/* Swing: one mass on its spring or its rod, stepped by an integrator to see how much energy that takes away. */
#include "core/sim/solve/swing.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/math/mat3.h"

/* The mass is 1 kg. */
typedef struct Mass {
  const SporeSwing *swing;
  SporeMat3 matrix, inverse; /* A and A^-1, at the last linearisation */
} Mass;

static SporeVec3 force_at(const SporeSwing *swing, SporeVec3 x) {
  double square = swing->frequency * swing->frequency;
  if (swing->length == 0) return spore_vec3_scale(-square, x);
  double length = spore_vec3_length(x);
  SporeVec3 rod = spore_vec3_scale(-swing->stiffness * (1 - swing->length / length), x);
  rod.y -= square * swing->length;
  return rod;
}

static SporeMat3 stiffness_at(const SporeSwing *swing, SporeVec3 x) {
  SporeMat3 identity = spore_mat3_identity();
  if (swing->length == 0) return spore_mat3_scale(swing->frequency * swing->frequency, identity);
  double length = spore_vec3_length(x);
  SporeVec3 n = spore_vec3_scale(1 / length, x);
  double across = fmax(1 - swing->length / length, 0);
  SporeMat3 axial = spore_mat3_scale(1 - across, spore_mat3_outer(n, n));
  return spore_mat3_scale(swing->stiffness, spore_mat3_add(axial, spore_mat3_scale(across, identity)));
}

static double energy_at(const SporeSwing *swing, const double *q, const double *v) {
  SporeVec3 x = spore_vec3_load(q), velocity = spore_vec3_load(v);
  double square = swing->frequency * swing->frequency, kinetic = 0.5 * spore_vec3_dot(velocity, velocity);
  if (swing->length == 0) return kinetic + 0.5 * square * spore_vec3_dot(x, x);
  double stretch = spore_vec3_length(x) - swing->length;
  return kinetic + 0.5 * swing->stiffness * stretch * stretch + square * swing->length * (x.y + swing->length);
}

static void set_shape(void *data, const double *shape, double h) {}
static void force(void *data, const double *q, const double *v, double *f) {
  spore_vec3_store(f, force_at(((const Mass *)data)->swing, spore_vec3_load(q)));
}
static void no_force(void *data, const double *q, const double *v, double *f) {}
static void set_time(void *data, double elapsed_s) {}
static void set_mass(void *data, const double *q) {}
static void kick(void *data, const double *f, double h, double *v) {
  for (int i = 0; i < 3; i++) v[i] += h * f[i];
}
static void drift(void *data, const double *q0, const double *v, double h, double *q1, double *v1) {
  for (int i = 0; i < 3; i++) q1[i] = q0[i] + h * v[i], v1[i] = v[i];
}
static void carry(void *data, const double *dv, const double *q1, double *v1) {
  for (int i = 0; i < 3; i++) v1[i] += dv[i];
}
static void weigh(void *data, const double *x, double *y) { memcpy(y, x, 3 * sizeof *y); }

static void linearise(void *data, const double *q, const double *from, const double *v, double c, double c2) {
  Mass *mass = data;
  SporeMat3 stiffness = spore_mat3_scale(c2, stiffness_at(mass->swing, spore_vec3_load(q)));
  mass->matrix = spore_mat3_add(spore_mat3_identity(), stiffness);
  bool inverted = spore_mat3_invert(mass->matrix, &mass->inverse); /* it is at least 1 */
  assert(inverted);
  (void)inverted;
}
static bool reuse(void *data, const double *q, const double *v, double c, double c2) { return false; }
static void multiply(void *data, const double *x, double *y) {
  spore_vec3_store(y, spore_mat3_apply(((const Mass *)data)->matrix, spore_vec3_load(x)));
}
static void precondition(void *data, const double *r, double *z) {
  spore_vec3_store(z, spore_mat3_apply(((const Mass *)data)->inverse, spore_vec3_load(r)));
}
static bool never(void *data) { return false; }
static double no_cost(void *data) { return 0; }
static bool always(void *data) { return true; }
static double no_rounding(void *data, double c, bool stiff_axes) { return 0; }
static double distance(void *data, const double *x) { return spore_vec3_length(spore_vec3_load(x)); }

static SporeDynamics dynamics_of(Mass *mass) {
  const SporeSwing *swing = mass->swing;
  double reach = swing->length > 0 ? swing->length : spore_vec3_length(swing->position);
  return (SporeDynamics){.data = mass,
                         .q_count = 3,
                         .block_count = 1,
                         .set_shape = set_shape,
                         .force = force,
                         .body_force = force,
                         .term_force = no_force,
                         .set_time = set_time,
                         .set_mass = set_mass,
                         .kick = kick,
                         .drift = drift,
                         .carry = carry,
                         .mass_multiply = weigh,
                         .linearise = linearise,
                         .reuse = reuse,
                         .multiply = multiply,
                         .drags = never,
                         .multiply_dragged = multiply,
                         .precondition = precondition,
                         .precondition_dragged = precondition,
                         .factor_cost = no_cost,
                         .factorised = always,
                         .rounding = no_rounding,
                         .distance = distance,
                         .gravity_momentum = swing->frequency * swing->frequency * reach};
}

#define STEPS_MAXIMUM 100000
#define TOLERANCE 1e-9 /* of the stages: finer than what a scene asks for, so that their error takes nothing */

/* Whole periods, a second at least. */
static size_t steps_of(const SporeSwing *swing, double h, double period_s) {
  double time_s = period_s * fmax(ceil(1 / period_s), 1), steps = round(time_s / h);
  (void)swing;
  return steps < 1 ? 1 : steps > STEPS_MAXIMUM ? 0 : (size_t)steps;
}

bool spore_swing_damping(const SporeSwing *swing, SporeIntegratorKind kind, const SporeSolverFields *fields, double h,
                         double *share) {
  assert(swing->frequency > 0 && swing->length >= 0 && h > 0 && share);
  const SporeIntegrator *integrator = spore_integrator(kind);
  size_t steps = steps_of(swing, h, 6.283185307179586 / swing->frequency);
  double *scratch = SPORE_NEW_ARRAY(double, spore_integrator_scratch());
  if (!scratch || steps == 0) {
    spore_free(scratch);
    return false;
  }
  SporeSolverFields fine = *fields;
  fine.nonlinear = SPORE_NONLINEAR_NEWTON;
  fine.tolerance = TOLERANCE;
  Mass mass = {.swing = swing};
  SporeDynamics dynamics = dynamics_of(&mass);
  double q[2][3], v[2][3], memory[2][3] = {{0}};
  SporeHistory history = {.a = memory[0], .b = memory[1]};
  spore_vec3_store(q[0], swing->position);
  spore_vec3_store(v[0], swing->velocity);
  double start = energy_at(swing, q[0], v[0]);
  for (size_t s = 0; s < steps; s++)
    integrator->step(&dynamics, &fine, &history, h, q[s % 2], v[s % 2], q[(s + 1) % 2], v[(s + 1) % 2], scratch);
  spore_free(scratch);
  double left = energy_at(swing, q[steps % 2], v[steps % 2]) / start;
  if (!isfinite(left)) return false;
  *share = 1 - pow(fmin(fmax(left, 0), 1), 1 / ((double)steps * h));
  return true;
}
