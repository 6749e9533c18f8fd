/* Curve joints: the end of a spring slides along a path of a body. */
#include <assert.h>

#include "core/constraint/term_ends.h"

#define SOFT_STOP 0.01 /* of a span: over this length a stop begins to damp */
#define LEAST_BEND 0.1 /* nearer to the centre of curvature, the nearest place of a path does not move smoothly */

bool spore_curve_joint_may_stop(const SporeCurveJoint *joint) {
  return joint->stops &&
         (joint->start <= SPORE_PATH_REACH || joint->start >= spore_spline_end(joint->knots) - SPORE_PATH_REACH);
}

double spore_curve_joint_overshoot(const SporeCurveJoint *joint, const SporePathPlace *place, SporeVec3 p) {
  assert(joint->knots.span_count > 0);
  SporeVec3 outward = spore_vec3_scale(spore_path_end(joint->knots, place->parameter),
                                       spore_vec3_normalise(place->slope, (SporeVec3){0, 0, 0}));
  return fmax(0, spore_vec3_dot(outward, spore_vec3_sub(p, place->position)));
}

SporePathPlace spore_curve_joint_place(const SporeCurveJoint *joint, const double *local, SporeVec3 p) {
  assert(local);
  if (!joint->points) return spore_path_follow(joint->knots, local, joint->start, p);
  SporePose frame = spore_pose_load(local);
  SporeVec3 in_frame = spore_quat_rotate(spore_quat_conjugate(frame.orientation), spore_vec3_sub(p, frame.position));
  SporePathPlace place = spore_path_follow(joint->knots, joint->points, joint->start, in_frame);
  place.position = spore_pose_apply(frame, place.position);
  place.slope = spore_quat_rotate(frame.orientation, place.slope);
  return place;
}

void spore_curve_joint_set(SporeSpringTerm *term, const SporePathPlace *place) {
  assert(term->curve && term->curve->mapping);
  SporeCurveJoint *joint = term->curve;
  term->law.free = spore_vec3_normalise(place->slope, (SporeVec3){0, 0, 0});
  joint->end = joint->stops ? spore_path_end(joint->knots, place->parameter) : 0;
  joint->soft = SOFT_STOP * spore_vec3_length(place->slope);
  if (joint->points) {
    SporePathPlace in_frame = spore_path_at(joint->knots, joint->points, place->parameter);
    spore_vec3_store(joint->mapping->points, in_frame.position);
    return;
  }
  for (size_t k = 0; k < SPORE_PATH_WIDTH; k++) {
    joint->mapping->block[k] = (uint32_t)(place->first + k);
    joint->mapping->weight[k] = place->weight[k];
  }
}

void spore_curve_joint_bend(SporeSpringTerm *term, const SporeSite *sites, const double *q, double c2) {
  assert(term->curve && c2 >= 0);
  SporeCurveJoint *joint = term->curve;
  joint->bend = (SporeCurveJointBend){0};
  if (term->b.prescribed || joint->points || !(spore_vec3_dot(term->law.free, term->law.free) > 0)) return;
  SporeVec3 a = position_of(&term->a, sites, q);
  SporePathPlace place = spore_curve_joint_place(joint, q + sites[term->b.body].q, a);
  if (spore_path_end(joint->knots, place.parameter) != 0) return; /* it stays at the end, however the path turns */
  double k = term->law.stiffness, square = spore_vec3_dot(place.slope, place.slope), speed = sqrt(square);
  SporeVec3 d = spore_spring_held(&term->law, spore_vec3_sub(a, place.position));
  double g = 1 - spore_vec3_dot(d, place.bend) / square;
  if (!(g > LEAST_BEND) || !(k > 0)) return;
  SporeCurveJointBend *bend = &joint->bend;
  *bend = (SporeCurveJointBend){.first = place.first,
                                .tangent = term->law.free,
                                .along = c2 * k * (1 - 1 / g),
                                .turn = c2 / g,
                                .load = c2 / (k * g)};
  for (size_t i = 0; i < SPORE_PATH_WIDTH; i++) {
    bend->weight[i] = place.weight[i];
    bend->turned[i] = spore_vec3_scale(place.slope_weight[i] / speed * k, d);
  }
}

void spore_curve_joint_bend_multiply(const SporeSpringTerm *term, const SporeSite *sites, const double *x, double *y) {
  assert(term->curve && !term->b.prescribed);
  const SporeCurveJointBend *bend = &term->curve->bend;
  size_t at = sites[term->b.body].v + 3 * bend->first;
  double past = spore_vec3_dot(bend->tangent, gather(&term->a, sites, x)), turned = 0;
  for (size_t i = 0; i < SPORE_PATH_WIDTH; i++) {
    SporeVec3 motion = spore_vec3_load(x + at + 3 * i);
    past -= bend->weight[i] * spore_vec3_dot(bend->tangent, motion);
    turned += spore_vec3_dot(bend->turned[i], motion);
  }
  double along = bend->along * past - bend->turn * turned, across = bend->turn * past + bend->load * turned;
  scatter(&term->a, sites, spore_vec3_scale(along, bend->tangent), y);
  for (size_t i = 0; i < SPORE_PATH_WIDTH; i++) {
    SporeVec3 force = spore_vec3_scale(-bend->weight[i] * along, bend->tangent);
    spore_vec3_accumulate(y + at + 3 * i, spore_vec3_add_scaled(force, -across, bend->turned[i]));
  }
}

SporeMat3 spore_curve_joint_bend_block(const SporeCurveJointBend *bend, size_t i, size_t j) {
  assert(i < SPORE_PATH_WIDTH && j < SPORE_PATH_WIDTH);
  SporeVec3 p = spore_vec3_scale(-bend->weight[i], bend->tangent),
            r = spore_vec3_scale(-bend->weight[j], bend->tangent);
  SporeVec3 e = bend->turned[i], f = bend->turned[j];
  SporeMat3 along = spore_mat3_scale(bend->along, spore_mat3_outer(p, r));
  SporeMat3 turn = spore_mat3_add(spore_mat3_outer(p, f), spore_mat3_outer(e, r));
  SporeMat3 load = spore_mat3_scale(bend->load, spore_mat3_outer(e, f));
  return spore_mat3_sub(spore_mat3_sub(along, spore_mat3_scale(bend->turn, turn)), load);
}
