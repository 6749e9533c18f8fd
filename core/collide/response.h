/* The penalty law of a contact, as a pure function of the state of the contact: explicit steps ask for forces, implicit
 * steps for stiffness and damping too.
 *
 * With unit normal n (from b to a), depth d, relative velocity w = va - vb, gap speed g = n.w, w_t = w - g n, and the
 * stretch s, how far a has moved along b since the contact holds:
 *
 *   N = max(0, k (d - o) + k o e(g) - c s(d) g)           for d > 0, else 0
 *   T = k s + c s(d) w_t, cut to the length mu N
 *   force on a = N n - T, on b the opposite
 *
 * s(d) is a C1 step from 0 at d = 0 to 1 at `damping_depth`: the damping force starts at zero when bodies touch first.
 * o is the part of the depth that motion has not made: bodies overlap at the start, or were put or pulled into each
 * other. e(g) is 1 up to half of SPORE_CONTACT_EXIT_SPEED and falls, C1, to 0 at that speed: the spring of that part
 * cannot throw bodies out faster. What bodies enter by their motion (o = 0) they get back at any speed: without damping
 * the law is that of a spring. Both functions only take energy away from that of the springs, k (d^2 + s^2) / 2. A cap
 * on the depth would bound the energy but not the speed, and heavy bodies would sink in.
 *
 * A spring stops a mass m within the depth r up to a speed of r sqrt(k/m); damping raises it (spore_contact_stops).
 *
 * Friction is a spring that slips (P. A. Cundall and O. D. L. Strack, "A discrete numerical model for granular
 * assemblies", Geotechnique 29, 1979): within the cone the contact holds, and a body at rest stays at rest. */
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
  double overlap;     /* of it, m: the part that motion has not made; may be more than the depth */
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

/* overlap: o, m. Gap speed in m/s. */
static inline SporeContactNormal spore_contact_normal(const SporeContactLaw *law, double depth, double overlap,
                                                      double gap_speed) {
  SporeContactNormal normal = {0, 0, 0};
  if (!(depth > 0)) return normal;
  const double half_exit = 0.5 * SPORE_CONTACT_EXIT_SPEED;
  double damping_slope, exit_slope, fading = overlap < depth ? overlap : depth;
  double damping = law->damping * spore_contact_step(depth, law->damping_depth, &damping_slope);
  double lost = spore_contact_step(gap_speed - half_exit, half_exit, &exit_slope);
  double force = law->stiffness * (depth - lost * fading) - damping * gap_speed;
  if (!(force > 0)) return normal;
  double stiffness = law->stiffness * (overlap < depth ? 1 : 1 - lost) - law->damping * damping_slope * gap_speed;
  return (SporeContactNormal){force, stiffness > 0 ? stiffness : 0, law->stiffness * fading * exit_slope + damping};
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
  double pressing = spore_contact_normal(law, state->depth, state->overlap, gap_speed).force;
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

/* The stretch, turned into the present tangent plane of the contact. */
SporeVec3 spore_contact_turn_stretch(SporeVec3 stretch, SporeVec3 normal);

/* The speed up to which the law stops a mass of 1/inverse_mass kg, that comes in from outside, within `depth` m:
 *   r w exp(z / sqrt(1 - z^2) acos z),  w = sqrt(k/m),  z = c / (2 sqrt(k m)),
 * of the damped oscillator from 0 depth, with its analytic continuation for z > 1; without damping r sqrt(k/m). */
double spore_contact_stops(const SporeContactLaw *law, double inverse_mass, double depth);

/* Energy stored in the contact's springs, J. */
double spore_contact_potential(const SporeContactLaw *law, double depth, SporeVec3 stretch);

#endif
