/* The penalty law of a contact, as a pure function of the contact's state: what explicit steps call for forces and
 * implicit ones for stiffness and damping too.
 *
 * With unit normal n (from b to a), depth d, relative velocity w = va - vb, gap speed g = n.w, w_t = w - g n, and the
 * stretch s, how far a has moved along b since they have held each other:
 *
 *   N = max(0, k d e(g) - c s(d) g)                       for d > 0, else 0
 *   T = k s + c s(d) w_t, cut to the length mu N
 *   force on a = N n - T, on b the opposite
 *
 * s(d) is a C1 step from 0 at d = 0 to 1 at `damping_depth`: the damping force starts from nothing at first touch.
 * e(g) is 1 up to half of SPORE_CONTACT_EXIT_SPEED and falls, C1, to 0 at it: a spring that is deeply compressed, such
 * as bodies that overlap at the start, cannot throw them out faster than that. Both only ever take energy away from
 * that of the springs, k (d^2 + s^2) / 2. A cap on the depth that pushes would bound the energy but not the speed, and
 * would let heavy bodies sink in.
 *
 * Friction is a spring that slips (P. A. Cundall and O. D. L. Strack, "A discrete numerical model for granular
 * assemblies", Geotechnique 29, 1979): within the cone it holds for good, and what rests comes to rest. */
#ifndef SPORE_COLLIDE_RESPONSE_H
#define SPORE_COLLIDE_RESPONSE_H

#include <assert.h>

#include "core/math/mat3.h"

#define SPORE_CONTACT_EXIT_SPEED 2.0     /* m/s */
#define SPORE_CONTACT_DAMPING_DEPTH 0.05 /* of the smaller radius */

/* One body's side. */
typedef struct SporeContactMaterial {
  double stiffness; /* N/m */
  double damping;   /* N s/m */
  double friction;  /* Coulomb coefficient */
} SporeContactMaterial;

/* Law of a pair. */
typedef struct SporeContactLaw {
  double stiffness, damping, friction;
  double damping_depth; /* m */
} SporeContactLaw;

/* Springs and dampers in series (1/k = 1/ka + 1/kb), the smaller friction. Radii in m. */
SporeContactLaw spore_contact_law(const SporeContactMaterial *a, const SporeContactMaterial *b, double radius_a,
                                  double radius_b);

typedef struct SporeContactState {
  SporeVec3 normal;   /* from b to a */
  double depth;       /* m */
  SporeVec3 velocity; /* va - vb, m/s */
  SporeVec3 stretch;  /* m; across the normal */
} SporeContactState;

/* N with its slopes dN/dd and -dN/dg, both kept from going below 0. */
typedef struct SporeContactNormal {
  double force, stiffness, damping;
} SporeContactNormal;

/* C1 step from 0 at x <= 0 to 1 at x >= width, and its slope. */
static inline double spore_contact_step(double x, double width, double *slope) {
  assert(width > 0);
  *slope = 0;
  if (x <= 0) return 0;
  if (x >= width) return 1;
  double y = x / width;
  *slope = 6 * y * (1 - y) / width;
  return y * y * (3 - 2 * y);
}

/* Gap speed in m/s. */
static inline SporeContactNormal spore_contact_normal(const SporeContactLaw *law, double depth, double gap_speed) {
  SporeContactNormal normal = {0, 0, 0};
  if (!(depth > 0)) return normal;
  const double half_exit = 0.5 * SPORE_CONTACT_EXIT_SPEED;
  double damping_slope, exit_slope;
  double damping = law->damping * spore_contact_step(depth, law->damping_depth, &damping_slope);
  double exit = 1 - spore_contact_step(gap_speed - half_exit, half_exit, &exit_slope);
  double spring = law->stiffness * depth, force = spring * exit - damping * gap_speed;
  if (!(force > 0)) return normal;
  double stiffness = law->stiffness * exit - law->damping * damping_slope * gap_speed;
  return (SporeContactNormal){force, stiffness > 0 ? stiffness : 0, spring * exit_slope + damping};
}

/* T before it is cut, and its -dT/dw: the damping across the normal, N s/m. */
static inline SporeVec3 spore_contact_hold(const SporeContactLaw *law, const SporeContactState *state,
                                           double *damping) {
  double unused, gap_speed = spore_vec3_dot(state->normal, state->velocity);
  *damping = law->damping * spore_contact_step(state->depth, law->damping_depth, &unused);
  SporeVec3 slip = spore_vec3_add_scaled(state->velocity, -gap_speed, state->normal);
  return spore_vec3_add_scaled(spore_vec3_scale(law->stiffness, state->stretch), *damping, slip);
}

/* Cuts T to the cone of the normal force N. */
static inline SporeVec3 spore_contact_cut(const SporeContactLaw *law, SporeVec3 hold, double pressing) {
  assert(pressing >= 0);
  double square = spore_vec3_dot(hold, hold), longest = law->friction * pressing;
  return square > longest * longest ? spore_vec3_scale(longest / sqrt(square), hold) : hold;
}

/* Force on a, N. */
static inline SporeVec3 spore_contact_force(const SporeContactLaw *law, const SporeContactState *state) {
  double damping, gap_speed = spore_vec3_dot(state->normal, state->velocity);
  double pressing = spore_contact_normal(law, state->depth, gap_speed).force;
  SporeVec3 force = spore_vec3_scale(pressing, state->normal);
  if (!(law->friction * pressing > 0)) return force;
  return spore_vec3_sub(force, spore_contact_cut(law, spore_contact_hold(law, state, &damping), pressing));
}

/* stiffness_scale (-df/d(xa - xb)) + damping_scale (-df/d(va - vb)) of that force with the normal held: symmetric
 * positive semi-definite. What is not symmetric, the change with N of the friction that slips, is apart: with
 * -*drag n^T added it is the whole. */
SporeMat3 spore_contact_jacobian(const SporeContactLaw *law, const SporeContactState *state, double stiffness_scale,
                                 double damping_scale, SporeVec3 *drag);

/* The stretch that is left of one where N presses: what is longer has slipped. */
SporeVec3 spore_contact_slip(const SporeContactLaw *law, SporeVec3 stretch, double pressing);

/* Energy stored in the contact's springs, J. */
double spore_contact_potential(const SporeContactLaw *law, double depth, SporeVec3 stretch);

#endif
