/* The contact law's Jacobian, slip and energy. */
#include "core/collide/response.h"

#include <assert.h>

static double in_series(double a, double b) { return a > 0 && b > 0 ? 1 / (1 / a + 1 / b) : 0; }

SporeContactLaw spore_contact_law(const SporeContactMaterial *a, const SporeContactMaterial *b, double radius_a,
                                  double radius_b) {
  assert(a->stiffness >= 0 && a->damping >= 0 && a->friction >= 0);
  assert(b->stiffness >= 0 && b->damping >= 0 && b->friction >= 0);
  assert(radius_a > 0 && radius_b > 0);
  return (SporeContactLaw){
      .stiffness = in_series(a->stiffness, b->stiffness),
      .damping = in_series(a->damping, b->damping),
      .friction = fmin(a->friction, b->friction),
      .damping_depth = SPORE_CONTACT_DAMPING_DEPTH * fmin(radius_a, radius_b),
  };
}

SporeVec3 spore_contact_turn_stretch(SporeVec3 stretch, SporeVec3 normal) {
  SporeVec3 flat = spore_vec3_add_scaled(stretch, -spore_vec3_dot(stretch, normal), normal);
  return spore_vec3_scale(spore_vec3_length(stretch), spore_vec3_normalise(flat, (SporeVec3){0, 0, 0}));
}

SporeVec3 spore_contact_slip(const SporeContactLaw *law, SporeVec3 stretch, double pressing) {
  if (!(law->stiffness > 0 && law->friction > 0 && pressing > 0)) return (SporeVec3){0, 0, 0};
  double square = spore_vec3_dot(stretch, stretch), longest = law->friction * pressing / law->stiffness;
  return square > longest * longest ? spore_vec3_scale(longest / sqrt(square), stretch) : stretch;
}

/* plane (I - n n^T) + along n n^T - slide d d^T, by its six numbers */
static SporeMat3 compose(SporeVec3 n, double along, double plane, double slide, SporeVec3 d) {
  double normal = along - plane, xy = normal * n.x * n.y - slide * d.x * d.y;
  double xz = normal * n.x * n.z - slide * d.x * d.z, yz = normal * n.y * n.z - slide * d.y * d.z;
  double xx = plane + normal * n.x * n.x - slide * d.x * d.x, yy = plane + normal * n.y * n.y - slide * d.y * d.y;
  return (SporeMat3){{xx, xy, xz, xy, yy, yz, xz, yz, plane + normal * n.z * n.z - slide * d.z * d.z}};
}

SporeMat3 spore_contact_jacobian(const SporeContactLaw *law, const SporeContactState *state, double stiffness_scale,
                                 double damping_scale, SporeVec3 *drag) {
  assert(stiffness_scale >= 0);
  const SporeVec3 none = *drag = (SporeVec3){0, 0, 0};
  SporeContactNormal normal =
      spore_contact_normal(law, state->depth, state->overlap, spore_vec3_dot(state->normal, state->velocity));
  double along = stiffness_scale * normal.stiffness + damping_scale * normal.damping;
  double damping, most = law->friction * normal.force;
  if (!(most > 0)) return compose(state->normal, along, 0, 0, none);
  SporeVec3 hold = spore_contact_hold(law, state, &damping);
  double length = spore_vec3_length(hold), plane = stiffness_scale * law->stiffness + damping_scale * damping;
  if (!(length > most)) return compose(state->normal, along, plane, 0, none);
  /* Slipping: the force does not change along itself. */
  SporeVec3 slip = spore_vec3_scale(1 / length, hold);
  plane *= most / length;
  *drag = spore_vec3_scale(law->friction * along, slip);
  return compose(state->normal, along, plane, plane, slip);
}

/* z / sqrt(1 - z^2) acos z, for any z >= 0. */
static double damping_exponent(double z) {
  double square = 1 - z * z;
  if (fabs(square) < 1e-6) return 1; /* its limit at z = 1 */
  return square > 0 ? z / sqrt(square) * acos(z) : z / sqrt(-square) * acosh(z);
}

double spore_contact_stops(const SporeContactLaw *law, double inverse_mass, double depth) {
  assert(inverse_mass >= 0 && depth >= 0);
  if (!(law->stiffness > 0)) return law->damping * inverse_mass * depth;
  double frequency = sqrt(law->stiffness * inverse_mass), z = 0.5 * law->damping / law->stiffness * frequency;
  return depth * frequency * exp(damping_exponent(z));
}

double spore_contact_potential(const SporeContactLaw *law, double depth, SporeVec3 stretch) {
  return depth > 0 ? 0.5 * law->stiffness * (depth * depth + spore_vec3_dot(stretch, stretch)) : 0;
}
