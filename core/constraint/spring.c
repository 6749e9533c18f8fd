/* Force, friction, Jacobian and energy of a damped spring. */
#include "core/constraint/spring.h"

#include <assert.h>

/* Length l and direction n from b to a. */
static double span(const SporeSpring *spring, SporeVec3 a, SporeVec3 b, SporeVec3 *n) {
  assert(spring->rest_length > 0);
  SporeVec3 d = spore_vec3_sub(a, b);
  double length = spore_vec3_length(d);
  *n = length > 1e-9 * spring->rest_length && length > 0 ? spore_vec3_scale(1 / length, d) : spring->fallback;
  return length;
}

SporeVec3 spore_spring_held(const SporeSpring *spring, SporeVec3 a) {
  return spore_vec3_add_scaled(a, -spore_vec3_dot(spring->free, a), spring->free);
}

SporeVec3 spore_spring_force(const SporeSpring *spring, SporeVec3 a, SporeVec3 b, SporeVec3 velocity_a,
                             SporeVec3 velocity_b) {
  SporeVec3 speed = spore_vec3_sub(velocity_a, velocity_b);
  if (spring->rest_length == 0) {
    SporeVec3 pull = spore_vec3_scale(-spring->stiffness, spore_vec3_sub(a, b));
    return spore_spring_held(spring, spore_vec3_add_scaled(pull, -spring->damping, speed));
  }
  SporeVec3 n;
  double length = span(spring, a, b, &n);
  double tension = spring->stiffness * (length - spring->rest_length) + spring->damping * spore_vec3_dot(n, speed);
  return spore_vec3_scale(-tension, n);
}

static double uncut_friction(const SporeSpring *spring, double stretch, double speed) {
  return spring->stiffness * stretch + spring->damping * speed;
}

/* held is not a number where the bodies are not: a step that goes wrong comes by there. */
double spore_spring_friction(const SporeSpring *spring, double stretch, double speed, double held) {
  assert(spring->friction >= 0 && !(held < 0));
  double most = spring->friction * held;
  return fmin(fmax(uncut_friction(spring, stretch, speed), -most), most);
}

bool spore_spring_slips(const SporeSpring *spring, double stretch, double speed, double held) {
  assert(spring->friction >= 0 && !(held < 0));
  return fabs(uncut_friction(spring, stretch, speed)) > spring->friction * held;
}

void spore_spring_jacobian(const SporeSpring *spring, SporeVec3 a, SporeVec3 b, SporeMat3 *stiffness,
                           SporeMat3 *damping) {
  if (spring->rest_length == 0) {
    SporeMat3 all = spore_mat3_sub(spore_mat3_identity(), spore_mat3_outer(spring->free, spring->free));
    *stiffness = spore_mat3_scale(spring->stiffness, all);
    *damping = spore_mat3_scale(spring->damping, all);
    return;
  }
  SporeVec3 n;
  double length = span(spring, a, b, &n);
  double sideways = length > spring->rest_length ? 1 - spring->rest_length / length : 0;
  SporeMat3 axial = spore_mat3_outer(n, n), across = spore_mat3_sub(spore_mat3_identity(), axial);
  *stiffness = spore_mat3_scale(spring->stiffness, spore_mat3_add(axial, spore_mat3_scale(sideways, across)));
  *damping = spore_mat3_scale(spring->damping, axial);
}

double spore_spring_energy(const SporeSpring *spring, SporeVec3 a, SporeVec3 b) {
  double stretch = spore_vec3_length(spore_spring_held(spring, spore_vec3_sub(a, b))) - spring->rest_length;
  return 0.5 * spring->stiffness * stretch * stretch;
}
