#include "core/collide/response.h"

/* C1 step from 0 at x <= 0 to 1 at x >= 1, and its slope. */
static double smooth_step(double x, double *slope) {
  if (x <= 0 || x >= 1) {
    *slope = 0;
    return x >= 1;
  }
  *slope = 6 * x * (1 - x);
  return x * x * (3 - 2 * x);
}

static double in_series(double a, double b) { return a > 0 && b > 0 ? 1 / (1 / a + 1 / b) : 0; }

SporeContactLaw spore_contact_law(const SporeContactMaterial *a, const SporeContactMaterial *b, double radius_a,
                                  double radius_b) {
  return (SporeContactLaw){
      .stiffness = in_series(a->stiffness, b->stiffness),
      .damping = in_series(a->damping, b->damping),
      .friction = fmin(a->friction, b->friction),
      .damping_depth = SPORE_CONTACT_DAMPING_DEPTH * fmin(radius_a, radius_b),
  };
}

/* Normal force with its slopes: dN/dd and -dN/dg, both kept from going below 0. */
typedef struct NormalForce {
  double force, stiffness, damping;
} NormalForce;

static NormalForce normal_force(const SporeContactLaw *law, double depth, double gap_speed) {
  NormalForce normal = {0, 0, 0};
  if (!(depth > 0)) return normal;
  const double half_exit = 0.5 * SPORE_CONTACT_EXIT_SPEED;
  double damping_slope, exit_slope;
  double damping = law->damping * smooth_step(depth / law->damping_depth, &damping_slope);
  double exit = 1 - smooth_step(gap_speed / half_exit - 1, &exit_slope);
  normal.force = law->stiffness * depth * exit - damping * gap_speed;
  if (!(normal.force > 0)) return (NormalForce){0, 0, 0};
  damping_slope *= law->damping / law->damping_depth;
  normal.stiffness = fmax(0, law->stiffness * exit - damping_slope * gap_speed);
  normal.damping = law->stiffness * depth * exit_slope / half_exit + damping;
  return normal;
}

static SporeVec3 across(SporeVec3 velocity, SporeVec3 normal, double gap_speed) {
  return spore_vec3_add_scaled(velocity, -gap_speed, normal);
}

SporeVec3 spore_contact_force(const SporeContactLaw *law, SporeVec3 normal, double depth, SporeVec3 relative_velocity) {
  double gap_speed = spore_vec3_dot(normal, relative_velocity);
  double pressing = normal_force(law, depth, gap_speed).force;
  SporeVec3 slip = across(relative_velocity, normal, gap_speed);
  double slip_scale = fmax(spore_vec3_length(slip), SPORE_CONTACT_SLIP_SPEED);
  return spore_vec3_add_scaled(spore_vec3_scale(pressing, normal), -law->friction * pressing / slip_scale, slip);
}

void spore_contact_jacobian(const SporeContactLaw *law, SporeVec3 normal, double depth, SporeVec3 relative_velocity,
                            SporeMat3 *stiffness, SporeMat3 *damping) {
  double gap_speed = spore_vec3_dot(normal, relative_velocity);
  NormalForce pressing = normal_force(law, depth, gap_speed);
  SporeMat3 along = spore_mat3_outer(normal, normal);
  *stiffness = spore_mat3_scale(pressing.stiffness, along);
  *damping = spore_mat3_scale(pressing.damping, along);
  SporeVec3 slip = across(relative_velocity, normal, gap_speed);
  double slip_speed = spore_vec3_length(slip);
  double hold = law->friction * pressing.force / fmax(slip_speed, SPORE_CONTACT_SLIP_SPEED);
  SporeMat3 plane = spore_mat3_sub(spore_mat3_identity(), along);
  if (slip_speed > SPORE_CONTACT_SLIP_SPEED) { /* slipping: the force does not change with the speed along it */
    SporeVec3 direction = spore_vec3_scale(1 / slip_speed, slip);
    plane = spore_mat3_sub(plane, spore_mat3_outer(direction, direction));
  }
  *damping = spore_mat3_add(*damping, spore_mat3_scale(hold, plane));
}

double spore_contact_potential(const SporeContactLaw *law, double depth) {
  return depth > 0 ? 0.5 * law->stiffness * depth * depth : 0;
}
