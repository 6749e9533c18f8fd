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

/* N alone; gap speed in m/s. */
double spore_contact_pressing(const SporeContactLaw *law, double depth, double gap_speed);
/* Force on a, N. */
SporeVec3 spore_contact_force(const SporeContactLaw *law, const SporeContactState *state);

/* -df/d(xa - xb), N/m, and -df/d(va - vb), N s/m, of that force with the normal held: symmetric positive
 * semi-definite. Left out because they are not symmetric: the change of friction with N. */
void spore_contact_jacobian(const SporeContactLaw *law, const SporeContactState *state, SporeMat3 *stiffness,
                            SporeMat3 *damping);

/* T before it is cut, and its -dT/dw: the damping across the normal, N s/m. */
SporeVec3 spore_contact_hold(const SporeContactLaw *law, const SporeContactState *state, double *damping);
/* Cuts T to the cone of the normal force N. */
SporeVec3 spore_contact_cut(const SporeContactLaw *law, SporeVec3 hold, double pressing);
/* The stretch that is left of one where N presses: what is longer has slipped. */
SporeVec3 spore_contact_slip(const SporeContactLaw *law, SporeVec3 stretch, double pressing);

/* Energy stored in the contact's springs, J. */
double spore_contact_potential(const SporeContactLaw *law, double depth, SporeVec3 stretch);

#endif
