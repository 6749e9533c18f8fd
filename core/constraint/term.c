/* Contact terms: depth, friction and force of a contact between two ends. */
#include <assert.h>

#include "core/constraint/term_ends.h"

/* Relative velocity of the ends that physics moves. A prescribed end is at its final place already. */
INLINE SporeVec3 own_motion(const SporeEnd *a, const SporeEnd *b, const SporeSite *sites, const double *v) {
  return spore_vec3_sub(gather(a, sites, v), gather(b, sites, v));
}

INLINE SporeVec3 across(SporeVec3 normal, SporeVec3 a) {
  return spore_vec3_add_scaled(a, -spore_vec3_dot(normal, a), normal);
}

/* Displacement of the end's material point that was the contact point; `position`: of the end. A node does not turn its
 * sphere. */
static SporeVec3 contact_point_motion(const SporeEnd *end, SporeVec3 position, SporeVec3 frame_arm, SporeVec3 arm,
                                      const SporeSite *sites, const double *q) {
  SporeVec3 motion = spore_vec3_sub(position, end->position);
  if (!turns(end)) return motion;
  SporeVec3 turned = spore_quat_rotate(spore_quat_load(q + sites[end->body].q + 3), frame_arm);
  return spore_vec3_add(motion, spore_vec3_sub(turned, arm));
}

/* Displacements of the two ends, for depth and friction. */
typedef struct Motion {
  SporeVec3 depth_a, depth_b; /* of the centre of the sphere, or of the contact point of a depth field */
  SporeVec3 point_a, point_b; /* of the contact points; only where there is friction or a field */
} Motion;

INLINE Motion motion_of(const SporeContactTerm *term, SporeVec3 a, SporeVec3 b, const SporeSite *sites,
                        const double *q) {
  Motion motion = {.depth_a = spore_vec3_sub(a, term->a.position), .depth_b = spore_vec3_sub(b, term->b.position)};
  if (!(term->law.friction > 0 || term->field_a || term->field_b)) return motion;
  motion.point_a = contact_point_motion(&term->a, a, term->frame_arm_a, term->arm_a, sites, q);
  motion.point_b = contact_point_motion(&term->b, b, term->frame_arm_b, term->arm_b, sites, q);
  if (term->field_a) motion.depth_a = motion.point_a;
  if (term->field_b) motion.depth_b = motion.point_b;
  return motion;
}

/* depth = depth when the step began + n.(motion of b - motion of a) */
INLINE double depth_after(const SporeContactTerm *term, const Motion *motion) {
  return term->depth + spore_vec3_dot(term->normal, spore_vec3_sub(motion->depth_b, motion->depth_a));
}

/* Stretch with all slip of the step. */
INLINE SporeVec3 stretch_after(const SporeContactTerm *term, const Motion *motion) {
  return spore_vec3_add(term->stretch, across(term->normal, spore_vec3_sub(motion->point_a, motion->point_b)));
}

bool spore_contact_term_rolls(const SporeContactTerm *term) {
  return spore_contact_term_meets(term) && (turns(&term->a) || turns(&term->b));
}

static Motion motion_at(const SporeContactTerm *term, const SporeSite *sites, const double *q) {
  return motion_of(term, position_of(&term->a, sites, q), position_of(&term->b, sites, q), sites, q);
}

/* A body with a depth field gets its force where the sphere presses on it now. Both forces act at one point, so that
 * the two bodies gain no angular momentum from each other. */
INLINE void meet_at(SporeEnd *end, SporeVec3 point, const SporeSite *sites, const double *q) {
  if (turns(end)) end->offset = spore_vec3_sub(point, spore_vec3_load(q + sites[end->body].q));
}

SporeVec3 spore_contact_term_stretch(const SporeContactTerm *term, const SporeSite *sites, const double *q) {
  if (!(term->law.friction > 0) || spore_contact_term_rolls(term)) return (SporeVec3){0, 0, 0};
  Motion motion = motion_at(term, sites, q);
  return spore_contact_slip(&term->law, stretch_after(term, &motion), term->pressing);
}

/* State of the contact at q and v. */
INLINE SporeContactState contact_state(SporeContactTerm *term, const SporeSite *sites, const double *q, const double *v,
                                       double elapsed_s) {
  SporeVec3 a = locate(&term->a, term->arm_a, sites, q), b = locate(&term->b, term->arm_b, sites, q);
  if (term->field_a) meet_at(&term->a, spore_vec3_add(b, term->arm_b), sites, q);
  if (term->field_b) meet_at(&term->b, spore_vec3_add(a, term->arm_a), sites, q);
  Motion motion = motion_of(term, a, b, sites, q);
  SporeContactState state = {term->normal, depth_after(term, &motion), term->overlap};
  state.velocity = spore_vec3_sub(velocity(&term->a, sites, v), velocity(&term->b, sites, v));
  if (spore_contact_term_rolls(term)) {
    SporeVec3 slip = across(term->normal, spore_vec3_scale(elapsed_s, state.velocity));
    state.stretch = spore_vec3_add(term->stretch, slip);
  } else if (term->law.friction > 0) {
    state.stretch = stretch_after(term, &motion);
  }
  return state;
}

void spore_contact_term_force(SporeContactTerm *term, const SporeSite *sites, const double *q, const double *v,
                              double elapsed_s, double *f) {
  assert((term->a.prescribed && term->b.prescribed) || (sites && q && v && f));
  SporeContactState state = contact_state(term, sites, q, v, elapsed_s);
  term->force = spore_contact_force(&term->law, &state);
  term->pressing = spore_vec3_dot(term->normal, term->force);
  scatter_pair(&term->a, &term->b, sites, term->force, f);
}

double spore_contact_term_parting(SporeContactTerm *term, const SporeSite *sites, const double *q, const double *x) {
  locate(&term->a, term->arm_a, sites, q);
  locate(&term->b, term->arm_b, sites, q);
  return spore_vec3_dot(term->normal, own_motion(&term->a, &term->b, sites, x));
}

void spore_contact_term_set_arms(SporeContactTerm *term, double radius_a, double radius_b) {
  term->arm_a = spore_vec3_scale(0.5 * term->depth - radius_a, term->normal);
  term->arm_b = spore_vec3_scale(radius_b - 0.5 * term->depth, term->normal);
}

/* The end is where it is at q; the arm leads from there to the contact point. */
static void follow_end(SporeEnd *end, SporeVec3 position, SporeVec3 arm, SporeVec3 *frame_arm, const SporeSite *sites,
                       const double *q) {
  end->position = position;
  if (end->prescribed) end->offset = (SporeVec3){0, 0, 0};
  if (!turns(end)) return;
  SporeQuat turn = spore_quat_load(q + sites[end->body].q + 3);
  *frame_arm = spore_quat_rotate(spore_quat_conjugate(turn), arm);
}

void spore_contact_term_follow(SporeContactTerm *term, double radius_a, double radius_b, const SporeSite *sites,
                               const double *q) {
  if (term->field_a || term->field_b) return;
  SporeVec3 a = position_of(&term->a, sites, q), b = position_of(&term->b, sites, q), apart = spore_vec3_sub(a, b);
  double distance = spore_vec3_length(apart);
  SporeVec3 stretch = spore_contact_term_stretch(term, sites, q);
  if (distance > 0) term->normal = spore_vec3_scale(1 / distance, apart);
  term->stretch = spore_contact_turn_stretch(stretch, term->normal);
  term->depth = radius_a + radius_b - distance;
  spore_contact_term_set_arms(term, radius_a, radius_b);
  follow_end(&term->a, a, term->arm_a, &term->frame_arm_a, sites, q);
  follow_end(&term->b, b, term->arm_b, &term->frame_arm_b, sites, q);
}

void spore_contact_term_hold(SporeContactTerm *term) {
  assert(term->a.prescribed && term->b.prescribed);
  spore_contact_term_force(term, NULL, NULL, NULL, 0, NULL);
}

SporeMat3 spore_contact_term_jacobian(SporeContactTerm *term, const SporeSite *sites, const double *q, const double *v,
                                      double elapsed_s, double c, double c2) {
  assert(c >= 0 && c2 >= 0);
  SporeContactState state = contact_state(term, sites, q, v, elapsed_s);
  return spore_contact_jacobian(&term->law, &state, c2, c, &term->drag);
}

void spore_contact_term_drag(const SporeContactTerm *term, const SporeSite *sites, const double *x, double *y) {
  double apart = spore_vec3_dot(term->normal, own_motion(&term->a, &term->b, sites, x));
  scatter_pair(&term->a, &term->b, sites, spore_vec3_scale(-apart, term->drag), y);
}

double spore_contact_term_energy(const SporeContactTerm *term, const SporeSite *sites, const double *q) {
  Motion motion = motion_at(term, sites, q);
  return spore_contact_potential(&term->law, depth_after(term, &motion), spore_contact_term_stretch(term, sites, q));
}

SporeVec3 spore_contact_term_point(const SporeContactTerm *term) {
  return spore_vec3_add(term->a.position, term->arm_a);
}
