#include "models/rigid_motion.h"

#include <math.h>

#define EVEN 1e-12 /* moments that differ by no more, relative, are equal */

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
 * (Reich 1994; Touma and Wisdom 1994), exact for any body of revolution. Kahan and Li's composition of nine
 * (1997) makes it sixth order: a body that spins about its middle axis turns over on time. */
typedef struct FreeTop {
  double p[3];           /* angular momentum along the principal axes */
  SporeQuat orientation; /* of the principal axes */
} FreeTop;

/* The body turns by `angle` about its principal axis k: p turns the other way. */
static void turn_about(FreeTop *top, int k, double angle) {
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

static void composed_step(FreeTop *top, const double inverse[3], double h) {
  static const double part[9] = {0.39216144400731413928,  0.33259913678935943860, -0.70624617255763935981,
                                 0.08221359629355080023,  0.79854399093482996340, 0.08221359629355080023,
                                 -0.70624617255763935981, 0.33259913678935943860, 0.39216144400731413928};
  for (int i = 0; i < 9; i++) strang_step(top, inverse, part[i] * h);
}

/* Turns the top for h seconds, in substeps in which neither partial rotation passes 0.1 rad, by bounds that free motion
 * keeps (their number must not change along it). One step of second order does where its error is below rounding: for
 * a body of revolution, or when it hardly turns. Above the cap of substeps the motion stays stable and keeps its
 * momentum, but loses phase. */
static void turn(FreeTop *top, const double inverse[3], double h) {
  double square = 0, energy2 = 0, size = fabs(h);
  for (int i = 0; i < 3; i++) square += top->p[i] * top->p[i], energy2 += top->p[i] * top->p[i] * inverse[i];
  double fast = size * fmin(sqrt(square), sqrt(energy2 / inverse[0])) * (inverse[0] - inverse[1]);
  double slow = size * fmin(sqrt(square), sqrt(energy2 / inverse[2])) * (inverse[1] - inverse[2]);
  if (fast * slow * (fast + slow) < 1e-17 || fmin(fast, slow) < 1e-12) {
    strang_step(top, inverse, h);
    return;
  }
  double count = fmin(fmax(ceil(fmax(fast, slow) / 0.1), 1), 1000);
  for (int i = 0; i < (int)count; i++) composed_step(top, inverse, h / count);
}

void spore_inertia_drift(const SporeInertia *inertia, double h, SporeQuat *orientation, SporeVec3 *spin) {
  if (inertia->even) {
    SporeQuat by = spore_quat_from_rotation_vector(spore_vec3_scale(h, *spin));
    *orientation = spore_quat_normalise(spore_quat_multiply(by, *orientation));
    return;
  }
  SporeQuat axes = spore_quat_multiply(*orientation, inertia->principal_quat);
  SporeMat3 rotation = spore_quat_to_mat3(axes);
  SporeVec3 along = spore_mat3_apply(spore_mat3_transpose(rotation), *spin);
  FreeTop top = {{along.x * inertia->moment[0], along.y * inertia->moment[1], along.z * inertia->moment[2]}, axes};
  SporeVec3 momentum = spore_mat3_apply(rotation, spore_vec3_load(top.p));
  turn(&top, inertia->inverse, h);
  SporeQuat about_momentum = spore_quat_from_rotation_vector(spore_vec3_scale(inertia->inverse[1] * h, momentum));
  axes = spore_quat_normalise(spore_quat_multiply(about_momentum, top.orientation));

  /* Back from the world's angular momentum, which stays, and not from p, which has gathered rounding. */
  rotation = spore_quat_to_mat3(axes);
  SporeVec3 p = spore_mat3_apply(spore_mat3_transpose(rotation), momentum);
  SporeVec3 turned = {p.x * inertia->inverse[0], p.y * inertia->inverse[1], p.z * inertia->inverse[2]};
  *spin = spore_mat3_apply(rotation, turned);
  *orientation = spore_quat_normalise(spore_quat_multiply(axes, spore_quat_conjugate(inertia->principal_quat)));
}
