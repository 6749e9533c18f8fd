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

double spore_contact_pressing(const SporeContactLaw *law, double depth, double gap_speed) {
  return normal_force(law, depth, gap_speed).force;
}

static SporeVec3 across(const SporeContactState *state) {
  return spore_vec3_add_scaled(state->velocity, -spore_vec3_dot(state->normal, state->velocity), state->normal);
}

SporeVec3 spore_contact_hold(const SporeContactLaw *law, const SporeContactState *state, double *damping) {
  double unused;
  *damping = law->damping * smooth_step(state->depth / law->damping_depth, &unused);
  return spore_vec3_add_scaled(spore_vec3_scale(law->stiffness, state->stretch), *damping, across(state));
}

static SporeVec3 cut(SporeVec3 vector, double longest) {
  double length = spore_vec3_length(vector);
  return length > longest ? spore_vec3_scale(longest / length, vector) : vector;
}

SporeVec3 spore_contact_cut(const SporeContactLaw *law, SporeVec3 hold, double pressing) {
  return cut(hold, law->friction * pressing);
}

SporeVec3 spore_contact_slip(const SporeContactLaw *law, SporeVec3 stretch, double pressing) {
  if (!(law->stiffness > 0 && law->friction > 0 && pressing > 0)) return (SporeVec3){0, 0, 0};
  return cut(stretch, law->friction * pressing / law->stiffness);
}

SporeVec3 spore_contact_force(const SporeContactLaw *law, const SporeContactState *state) {
  double damping, gap_speed = spore_vec3_dot(state->normal, state->velocity);
  double pressing = normal_force(law, state->depth, gap_speed).force;
  if (!(pressing > 0)) return (SporeVec3){0, 0, 0};
  SporeVec3 hold = spore_contact_cut(law, spore_contact_hold(law, state, &damping), pressing);
  return spore_vec3_add_scaled(spore_vec3_scale(-1, hold), pressing, state->normal);
}

void spore_contact_jacobian(const SporeContactLaw *law, const SporeContactState *state, SporeMat3 *stiffness,
                            SporeMat3 *damping) {
  NormalForce pressing = normal_force(law, state->depth, spore_vec3_dot(state->normal, state->velocity));
  SporeMat3 along = spore_mat3_outer(state->normal, state->normal);
  *stiffness = spore_mat3_scale(pressing.stiffness, along);
  *damping = spore_mat3_scale(pressing.damping, along);
  double hold_damping, most = law->friction * pressing.force;
  if (!(most > 0)) return;
  SporeVec3 hold = spore_contact_hold(law, state, &hold_damping);
  double length = spore_vec3_length(hold), part = 1;
  SporeMat3 plane = spore_mat3_sub(spore_mat3_identity(), along);
  if (length > most) { /* slipping: the force does not change along itself */
    SporeVec3 direction = spore_vec3_scale(1 / length, hold);
    plane = spore_mat3_sub(plane, spore_mat3_outer(direction, direction));
    part = most / length;
  }
  *stiffness = spore_mat3_add(*stiffness, spore_mat3_scale(part * law->stiffness, plane));
  *damping = spore_mat3_add(*damping, spore_mat3_scale(part * hold_damping, plane));
}

double spore_contact_potential(const SporeContactLaw *law, double depth, SporeVec3 stretch) {
  return depth > 0 ? 0.5 * law->stiffness * (depth * depth + spore_vec3_dot(stretch, stretch)) : 0;
}
