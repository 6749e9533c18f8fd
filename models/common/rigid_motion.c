/* Inertia of a solid, and its free rotation. */
#include "models/common/rigid_motion.h"

#include <assert.h>
#include <math.h>

#define EVEN 1e-12          /* moments that differ by no more, relative, are equal */
#define ANGLE 0.2           /* rad: partial rotation in a substep of free motion */
#define SUBSTEPS_MAXIMUM 25 /* of free motion */
#define NEGLIGIBLE 1e-12    /* rad: a partial rotation that is rounding */

bool spore_inertia_init(SporeInertia *inertia, SporeMat3 tensor) {
  inertia->tensor = tensor;
  spore_mat3_eigen_symmetric(tensor, inertia->moment, &inertia->principal);
  if (!(inertia->moment[0] > 0) || !isfinite(inertia->moment[2])) return false;
  for (int i = 0; i < 3; i++) inertia->inverse[i] = 1 / inertia->moment[i];
  inertia->principal_quat = spore_quat_from_mat3(inertia->principal);
  inertia->even = inertia->moment[2] - inertia->moment[0] <= EVEN * inertia->moment[2];
  return true;
}

SporeMat3 spore_inertia_turned(const SporeInertia *inertia, SporeQuat orientation) {
  assert(inertia->moment[0] > 0);
  if (inertia->even) return inertia->tensor;
  SporeMat3 rotation = spore_quat_to_mat3(orientation);
  SporeMat3 turned =
      spore_mat3_multiply(spore_mat3_multiply(rotation, inertia->tensor), spore_mat3_transpose(rotation));
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < i; j++) turned.m[3 * i + j] = turned.m[3 * j + i];
  return turned;
}

/* Free motion. In principal axes, with a = 1 / moment and body angular momentum p, the kinetic energy is
 *   |p|^2 a1/2 + p0^2 (a0 - a1)/2 + p2^2 (a2 - a1)/2.
 * The first term commutes with the others: it turns the body about the fixed world vector L by |L| a1 h. The other two
 * turn it about its own axes 0 and 2; composed symmetrically they are a symplectic map that keeps |p| and L
 * (Reich 1994; Touma and Wisdom 1994), exact for any body of revolution. Kahan and Li's composition of seventeen
 * (1997, "Composition constants for raising the orders of unconventional schemes for ordinary differential equations")
 * makes it eighth order: a body that spins about its middle axis turns over on time. */
typedef struct FreeTop {
  double p[3];           /* angular momentum along the principal axes */
  SporeQuat orientation; /* of the principal axes */
} FreeTop;

/* The body turns by `angle` about its principal axis k: p turns the other way. */
static void turn_about(FreeTop *top, int k, double angle) {
  assert(k >= 0 && k < 3);
  double ch = cos(0.5 * angle), sh = sin(0.5 * angle), c = 1 - 2 * sh * sh, s = 2 * sh * ch;
  double *i = &top->p[(k + 1) % 3], *j = &top->p[(k + 2) % 3], pi = *i, pj = *j;
  *i = c * pi + s * pj;
  *j = c * pj - s * pi;
  double axis[3] = {0, 0, 0};
  axis[k] = sh;
  top->orientation = spore_quat_multiply(top->orientation, (SporeQuat){ch, axis[0], axis[1], axis[2]});
}

static void strang_step(FreeTop *top, const double inverse[3], double h) {
  double a = inverse[0] - inverse[1], b = inverse[2] - inverse[1];
  turn_about(top, 0, 0.5 * h * a * top->p[0]);
  turn_about(top, 2, h * b * top->p[2]);
  turn_about(top, 0, 0.5 * h * a * top->p[0]);
}

/* The last turn of one part and the first of the next are one. */
static void composed_step(FreeTop *top, const double inverse[3], double h) {
  static const double part[9] = {0.13020248308889008088, 0.56116298177510838456,  -0.38947496264484728641,
                                 0.15884190655515560090, -0.39590389413323757734, 0.18453964097831570709,
                                 0.25837438768632204729, 0.29501172360931029887,  -0.60550853383003451170};
  double a = inverse[0] - inverse[1], b = inverse[2] - inverse[1], before = 0;
  for (int i = 0; i < 17; i++) {
    double now = part[i < 9 ? i : 16 - i] * h;
    turn_about(top, 0, 0.5 * (before + now) * a * top->p[0]);
    turn_about(top, 2, now * b * top->p[2]);
    before = now;
  }
  turn_about(top, 0, 0.5 * before * a * top->p[0]);
}

/* Bounds of the two partial rotations, rad/s. They are constants of free motion, so that the number of substeps does
 * not change along the motion. */
typedef struct Rates {
  double fast, slow;
} Rates;

static Rates rates_of(const double p[3], const double inverse[3]) {
  double square = 0, energy2 = 0;
  for (int i = 0; i < 3; i++) square += p[i] * p[i], energy2 += p[i] * p[i] * inverse[i];
  return (Rates){fmin(sqrt(square), sqrt(energy2 / inverse[0])) * (inverse[0] - inverse[1]),
                 fmin(sqrt(square), sqrt(energy2 / inverse[2])) * (inverse[1] - inverse[2])};
}

/* See spore_inertia_longest_drift. With one partial rotation alone, one step is exact. */
static double longest_drift(const Rates *rates) {
  double larger = fmax(rates->fast, rates->slow), smaller = fmin(rates->fast, rates->slow);
  double followed = larger > 0 ? SUBSTEPS_MAXIMUM * ANGLE / larger : INFINITY;
  return fmax(followed, smaller > 0 ? NEGLIGIBLE / smaller : INFINITY);
}

/* Turns the top for h seconds, in substeps in which neither partial rotation exceeds ANGLE; the error of one substep is
 * then below 1e-14. One step of second order is enough where its error is below rounding: for a body of revolution, or
 * for a body that hardly turns. One step is taken, too, where more than the maximum number of substeps were needed: the
 * motion stays stable and keeps its momentum, but loses phase, as it would in fewer substeps than it needs; more of
 * them would be work for nothing. */
static void turn(FreeTop *top, const double inverse[3], double h) {
  assert(isfinite(h));
  Rates rates = rates_of(top->p, inverse);
  double size = fabs(h), fast = size * rates.fast, slow = size * rates.slow;
  bool slight = fast * slow * (fast + slow) < 1e-17 || fmin(fast, slow) < NEGLIGIBLE;
  if (slight || !(size <= longest_drift(&rates))) {
    strang_step(top, inverse, h);
    return;
  }
  double count = fmin(fmax(ceil(fmax(fast, slow) / ANGLE), 1), SUBSTEPS_MAXIMUM);
  for (int i = 0; i < (int)count; i++) composed_step(top, inverse, h / count);
}

/* Orthonormal to rounding, also where the length of the quaternion is off by rounding: an error of one step would
 * otherwise be repeated by the next. */
static SporeMat3 rotation_of(SporeQuat q) {
  double s = 2 / (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  double x = s * q.x, y = s * q.y, z = s * q.z;
  return (SporeMat3){{1 - (y * q.y + z * q.z), x * q.y - z * q.w, x * q.z + y * q.w, x * q.y + z * q.w,
                      1 - (x * q.x + z * q.z), y * q.z - x * q.w, x * q.z - y * q.w, y * q.z + x * q.w,
                      1 - (x * q.x + y * q.y)}};
}

/* World axes; rotation: of the principal axes. */
static SporeVec3 momentum_of(const SporeInertia *inertia, const SporeMat3 *rotation, SporeVec3 spin) {
  SporeVec3 along = spore_mat3_apply(spore_mat3_transpose(*rotation), spin);
  const double *moment = inertia->moment;
  return spore_mat3_apply(*rotation, spore_vec3(along.x * moment[0], along.y * moment[1], along.z * moment[2]));
}

static SporeVec3 spin_of(const SporeInertia *inertia, const SporeMat3 *rotation, SporeVec3 momentum) {
  SporeVec3 p = spore_mat3_apply(spore_mat3_transpose(*rotation), momentum);
  const double *inverse = inertia->inverse;
  return spore_mat3_apply(*rotation, spore_vec3(p.x * inverse[0], p.y * inverse[1], p.z * inverse[2]));
}

void spore_inertia_drift(const SporeInertia *inertia, double h, SporeQuat *orientation, SporeVec3 *spin) {
  assert(inertia->moment[0] > 0);
  assert(isfinite(h));
  if (inertia->even) {
    SporeQuat by = spore_quat_from_rotation_vector(spore_vec3_scale(h, *spin));
    *orientation = spore_quat_normalise(spore_quat_multiply(by, *orientation));
    return;
  }
  SporeQuat axes = spore_quat_multiply(*orientation, inertia->principal_quat);
  SporeMat3 rotation = rotation_of(axes);
  SporeVec3 momentum = momentum_of(inertia, &rotation, *spin);
  FreeTop top = {.orientation = axes};
  spore_vec3_store(top.p, spore_mat3_apply(spore_mat3_transpose(rotation), momentum));
  turn(&top, inertia->inverse, h);
  SporeQuat about_momentum = spore_quat_from_rotation_vector(spore_vec3_scale(inertia->inverse[1] * h, momentum));
  axes = spore_quat_multiply(about_momentum, top.orientation);
  *orientation = spore_quat_normalise(spore_quat_multiply(axes, spore_quat_conjugate(inertia->principal_quat)));

  /* The spin is computed from the world's angular momentum, which is constant, and not from p, which has gathered
   * rounding. The axes are those from which the next step will compute the momentum again; one correction takes away
   * what rounding leaves. */
  rotation = rotation_of(spore_quat_multiply(*orientation, inertia->principal_quat));
  *spin = spin_of(inertia, &rotation, momentum);
  SporeVec3 missed = spore_vec3_sub(momentum, momentum_of(inertia, &rotation, *spin));
  *spin = spore_vec3_add(*spin, spin_of(inertia, &rotation, missed));
}

double spore_inertia_longest_drift(const SporeInertia *inertia, SporeQuat orientation, SporeVec3 spin) {
  assert(inertia->moment[0] > 0);
  if (inertia->even) return INFINITY;
  SporeMat3 rotation = rotation_of(spore_quat_multiply(orientation, inertia->principal_quat));
  double p[3];
  spore_vec3_store(p, spore_mat3_apply(spore_mat3_transpose(rotation), momentum_of(inertia, &rotation, spin)));
  Rates rates = rates_of(p, inertia->inverse);
  return longest_drift(&rates);
}
