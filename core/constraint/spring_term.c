/* Spring terms: springs between two points, or with an end that slides along a line or a path. */
#include <assert.h>

#include "core/constraint/term_ends.h"

/* Whether the end slides along a path that moves. A path that physics does not move is a line during a step. */
INLINE bool runs(const SporeSpringTerm *term) { return term->curve && !term->b.prescribed; }

static double joint_length(const SporeCurveJoint *joint, const double *local, double to) {
  assert(joint->points || local);
  return spore_path_length(joint->knots, joint->points ? joint->points : local, joint->start, to);
}

static double slid_along_curve(const SporeSpringTerm *term, const double *local, SporeVec3 a) {
  return joint_length(term->curve, local, spore_curve_joint_place(term->curve, local, a).parameter);
}

static double slid_along_line(const SporeSpringTerm *term, SporeVec3 a, SporeVec3 b) {
  SporeVec3 apart = spore_vec3_sub(a, b), before = spore_vec3_sub(term->a.position, term->b.position);
  return spore_vec3_dot(term->law.free, spore_vec3_sub(apart, before));
}

static void run_along(SporeSpringTerm *term, const SporeSite *sites, const double *q, SporeVec3 a) {
  assert(!term->b.prescribed);
  const double *local = q + sites[term->b.body].q;
  SporePathPlace place = spore_curve_joint_place(term->curve, local, a);
  spore_curve_joint_set(term, &place);
  if (term->law.friction > 0) term->slid = joint_length(term->curve, local, place.parameter);
}

/* Positions of the ends, and how far the spring of friction has slid. */
static void spring_ends(SporeSpringTerm *term, const SporeSite *sites, const double *q, SporeVec3 *a, SporeVec3 *b) {
  assert(term->law.rest_length >= 0 && term->law.friction >= 0);
  const SporeVec3 none = {0, 0, 0};
  *a = locate(&term->a, none, sites, q);
  if (runs(term)) run_along(term, sites, q, *a);
  *b = locate(&term->b, none, sites, q);
  if (term->law.friction > 0 && !runs(term)) term->slid = slid_along_line(term, *a, *b);
  /* A spring without length pulls in any direction. Its force acts on both bodies at the place of the first end, so
   * that it does not turn the two together. */
  if (term->law.rest_length == 0 && !term->b.prescribed && term->b.mapping->kind == SPORE_MAPPING_RIGID)
    term->b.offset = spore_vec3_add(term->b.offset, spore_vec3_sub(*a, *b));
}

/* Force of a stop, where end a is beyond an end of the path that stops it. */
static SporeContactNormal stop_of(const SporeSpringTerm *term, SporeVec3 a, SporeVec3 b, SporeVec3 velocity_a,
                                  SporeVec3 velocity_b) {
  const SporeCurveJoint *joint = term->curve;
  if (!joint || joint->end == 0) return (SporeContactNormal){0, 0, 0};
  const SporeContactLaw law = {
      .stiffness = term->law.stiffness, .damping = term->law.damping, .damping_depth = joint->soft};
  double depth = joint->end * spore_vec3_dot(term->law.free, spore_vec3_sub(a, b));
  double speed = joint->end * spore_vec3_dot(term->law.free, spore_vec3_sub(velocity_a, velocity_b));
  return spore_contact_normal(&law, depth, depth, -speed);
}

static SporeMat3 spring_jacobian(const SporeSpringTerm *term, SporeVec3 a, SporeVec3 b, SporeVec3 velocity_a,
                                 SporeVec3 velocity_b, double c, double c2) {
  assert(c >= 0 && c2 >= 0);
  SporeMat3 stiffness, damping;
  spore_spring_jacobian(&term->law, a, b, &stiffness, &damping);
  SporeContactNormal stop = stop_of(term, a, b, velocity_a, velocity_b);
  SporeMat3 along = spore_mat3_outer(term->law.free, term->law.free);
  SporeMat3 jacobian = spore_mat3_add(spore_mat3_scale(c2, stiffness), spore_mat3_scale(c, damping));
  jacobian = spore_mat3_add(jacobian, spore_mat3_scale(c2 * stop.stiffness + c * stop.damping, along));
  if (!(term->law.friction > 0)) return jacobian;
  double held = spore_vec3_length(spore_spring_force(&term->law, a, b, velocity_a, velocity_b));
  double speed = spore_vec3_dot(term->law.free, spore_vec3_sub(velocity_a, velocity_b));
  if (spore_spring_slips(&term->law, term->stretch + term->slid, speed, held)) return jacobian;
  double stuck = c2 * term->law.stiffness + c * term->law.damping;
  return spore_mat3_add(jacobian, spore_mat3_scale(stuck, along));
}

static void add_friction(SporeSpringTerm *term, SporeVec3 velocity_a, SporeVec3 velocity_b) {
  double speed = spore_vec3_dot(term->law.free, spore_vec3_sub(velocity_a, velocity_b));
  term->held = spore_vec3_length(term->force);
  double hold = spore_spring_friction(&term->law, term->stretch + term->slid, speed, term->held);
  term->force = spore_vec3_add_scaled(term->force, -hold, term->law.free);
}

void spore_spring_term_force(SporeSpringTerm *term, const SporeSite *sites, const double *q, const double *v,
                             double *f) {
  SporeVec3 a, b;
  spring_ends(term, sites, q, &a, &b);
  SporeVec3 velocity_a = velocity(&term->a, sites, v), velocity_b = velocity(&term->b, sites, v);
  term->force = spore_spring_force(&term->law, a, b, velocity_a, velocity_b);
  double stop = stop_of(term, a, b, velocity_a, velocity_b).force;
  if (term->law.friction > 0) add_friction(term, velocity_a, velocity_b);
  if (stop > 0) term->force = spore_vec3_add_scaled(term->force, -stop * term->curve->end, term->law.free);
  scatter_pair(&term->a, &term->b, sites, term->force, f);
}

void spore_spring_term_hold(SporeSpringTerm *term) {
  assert(term->a.prescribed && term->b.prescribed);
  spore_spring_term_force(term, NULL, NULL, NULL, NULL);
}

SporeMat3 spore_spring_term_jacobian(SporeSpringTerm *term, const SporeSite *sites, const double *q, const double *v,
                                     double c, double c2) {
  SporeVec3 a, b;
  spring_ends(term, sites, q, &a, &b);
  return spring_jacobian(term, a, b, velocity(&term->a, sites, v), velocity(&term->b, sites, v), c, c2);
}

double spore_spring_term_stretch(const SporeSpringTerm *term, const SporeSite *sites, const double *q) {
  assert(!(term->law.friction > 0) || term->law.stiffness > 0);
  if (!(term->law.friction > 0)) return 0;
  SporeVec3 a = position_of(&term->a, sites, q);
  double slid = runs(term) ? slid_along_curve(term, q + sites[term->b.body].q, a)
                           : slid_along_line(term, a, position_of(&term->b, sites, q));
  double longest = term->law.friction * term->held / term->law.stiffness;
  return fmin(fmax(term->stretch + slid, -longest), longest);
}

double spore_spring_term_energy(const SporeSpringTerm *term, const SporeSite *sites, const double *q) {
  SporeVec3 a = position_of(&term->a, sites, q), b;
  SporeSpring law = term->law;
  double stretch = spore_spring_term_stretch(term, sites, q), depth = 0;
  if (runs(term)) {
    SporePathPlace place = spore_curve_joint_place(term->curve, q + sites[term->b.body].q, a);
    law.free = spore_vec3_normalise(place.slope, (SporeVec3){0, 0, 0});
    b = place.position;
    if (term->curve->stops) depth = spore_curve_joint_overshoot(term->curve, &place, a);
  } else {
    b = position_of(&term->b, sites, q);
  }
  return spore_spring_energy(&law, a, b) + 0.5 * law.stiffness * (stretch * stretch + depth * depth);
}
