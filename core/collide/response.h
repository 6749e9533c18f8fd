/* The penalty law of a contact, as a pure function of the contact's state: what explicit steps call for forces and
 * implicit ones for stiffness and damping too.
 *
 * With unit normal n (from b to a), depth d, relative velocity w = va - vb, gap speed g = n.w, w_t = w - g n:
 *
 *   N = max(0, k d e(g) - c s(d) g)                       for d > 0, else 0
 *   force on a = N n - mu N min(1, |w_t| / v_slip) w_t / |w_t|,   on b the opposite
 *
 * s(d) is a C1 step from 0 at d = 0 to 1 at `damping_depth`: the damping force starts from nothing at first touch.
 * e(g) is 1 up to half of SPORE_CONTACT_EXIT_SPEED and falls, C1, to 0 at it: a spring that is deeply compressed, such
 * as bodies that overlap at the start, cannot throw them out faster than that. Both only ever take energy away from
 * that of the spring, k d^2 / 2. A cap on the depth that pushes would bound the energy but not the speed, and would let
 * heavy bodies sink in. */
#ifndef SPORE_COLLIDE_RESPONSE_H
#define SPORE_COLLIDE_RESPONSE_H

#include "core/math/mat3.h"

#define SPORE_CONTACT_EXIT_SPEED 2.0     /* m/s */
#define SPORE_CONTACT_SLIP_SPEED 1e-3    /* m/s: below it friction acts as a viscous hold */
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

/* Force on a, N. depth in m, relative velocity va - vb in m/s. */
SporeVec3 spore_contact_force(const SporeContactLaw *law, SporeVec3 normal, double depth, SporeVec3 relative_velocity);

/* -df/d(xa - xb), N/m, and -df/d(va - vb), N s/m, of that force with the normal held: symmetric positive
 * semi-definite. Left out because they are not symmetric: the change of friction with N. */
void spore_contact_jacobian(const SporeContactLaw *law, SporeVec3 normal, double depth, SporeVec3 relative_velocity,
                            SporeMat3 *stiffness, SporeMat3 *damping);

/* Energy stored in the contact's spring, J. */
double spore_contact_potential(const SporeContactLaw *law, double depth);

#endif
