#include "core/sim/term.h"

/* Terms are evaluated by the thousand: what follows is small, and compiled into each place. */
#define INLINE static inline __attribute__((always_inline))

INLINE SporeVec3 position_of(const SporeEnd *end, const SporeSite *sites, const double *q) {
  if (end->prescribed) return spore_vec3_add(end->position, end->offset);
  const double *local = q + sites[end->body].q;
  if (end->mapping->kind == SPORE_MAPPING_IDENTITY) return spore_vec3_load(local + 3 * (size_t)end->point);
  return spore_mapping_position(end->mapping, end->point, local);
}

SporeVec3 spore_end_position(const SporeEnd *end, const SporeSite *sites, const double *q) {
  return position_of(end, sites, q);
}

/* With its body, by physics. */
INLINE bool turns(const SporeEnd *end) { return !end->prescribed && end->mapping->kind == SPORE_MAPPING_RIGID; }

/* Position of the end; keeps the lever of a force that acts `arm` away from it. */
INLINE SporeVec3 locate(SporeEnd *end, SporeVec3 arm, const SporeSite *sites, const double *q) {
  SporeVec3 position = position_of(end, sites, q);
  if (turns(end)) end->offset = spore_vec3_add(spore_vec3_sub(position, spore_vec3_load(q + sites[end->body].q)), arm);
  return position;
}

/* What the velocity-like vector x gives the point where the force acts; nothing to a prescribed end. */
INLINE SporeVec3 gather(const SporeEnd *end, const SporeSite *sites, const double *x) {
  if (end->prescribed) return (SporeVec3){0, 0, 0};
  const double *local = x + sites[end->body].v;
  switch (end->mapping->kind) {
  case SPORE_MAPPING_IDENTITY:
    return spore_vec3_load(local + 3 * (size_t)end->point);
  case SPORE_MAPPING_RIGID:
    return spore_vec3_add(spore_vec3_load(local), spore_vec3_cross(spore_vec3_load(local + 3), end->offset));
  case SPORE_MAPPING_LINEAR:
  case SPORE_MAPPING_FIXED:
    break;
  }
  return spore_mapping_velocity(end->mapping, end->point, NULL, local);
}

/* The transpose of gather. */
INLINE void scatter(const SporeEnd *end, const SporeSite *sites, SporeVec3 force, double *f) {
  if (end->prescribed) return;
  double *local = f + sites[end->body].v;
  switch (end->mapping->kind) {
  case SPORE_MAPPING_IDENTITY:
    spore_vec3_accumulate(local + 3 * (size_t)end->point, force);
    return;
  case SPORE_MAPPING_RIGID:
    spore_vec3_accumulate(local, force);
    spore_vec3_accumulate(local + 3, spore_vec3_cross(end->offset, force));
    return;
  case SPORE_MAPPING_LINEAR:
  case SPORE_MAPPING_FIXED:
    break;
  }
  spore_mapping_add_force(end->mapping, end->point, NULL, force, local);
}

INLINE SporeVec3 velocity(const SporeEnd *end, const SporeSite *sites, const double *v) {
  return end->prescribed ? end->velocity : gather(end, sites, v);
}

INLINE void scatter_pair(const SporeEnd *a, const SporeEnd *b, const SporeSite *sites, SporeVec3 force, double *f) {
  scatter(a, sites, force, f);
  scatter(b, sites, spore_vec3_scale(-1, force), f);
}

SporeSoftening spore_softening(double h, double inverse_mass, double stiffness) {
  double stiff = 2 * h * h * stiffness * inverse_mass;
  return (SporeSoftening){h, h * stiff / (1 + stiff), inverse_mass};
}

/* (I + w jacobian)^-1 force, jacobian = h D + h t K: symmetric and at least I, so the adjugate does. */
static SporeVec3 soften(const SporeSoftening *softening, SporeMat3 jacobian, SporeVec3 force) {
  double w = softening->inverse_mass;
  double xx = 1 + w * jacobian.m[0], yy = 1 + w * jacobian.m[4], zz = 1 + w * jacobian.m[8];
  double xy = w * jacobian.m[1], xz = w * jacobian.m[2], yz = w * jacobian.m[5];
  SporeVec3 row_x = {yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy};
  SporeVec3 row_y = {row_x.y, xx * zz - xz * xz, xy * xz - xx * yz};
  SporeVec3 row_z = {row_x.z, row_y.z, xx * yy - xy * xy};
  double scale = 1 / (xx * row_x.x + xy * row_x.y + xz * row_x.z);
  return (SporeVec3){scale * spore_vec3_dot(row_x, force), scale * spore_vec3_dot(row_y, force),
                     scale * spore_vec3_dot(row_z, force)};
}

/* Relative velocity of the ends without what is prescribed: that is where it will be already. */
INLINE SporeVec3 own_motion(const SporeEnd *a, const SporeEnd *b, const SporeSite *sites, const double *v) {
  return spore_vec3_sub(gather(a, sites, v), gather(b, sites, v));
}

INLINE SporeVec3 across(SporeVec3 normal, SporeVec3 a) {
  return spore_vec3_add_scaled(a, -spore_vec3_dot(normal, a), normal);
}

/* How far the end's material point that was the contact point has come; `position` of the end. A node does not turn its
 * sphere. */
static SporeVec3 contact_point_motion(const SporeEnd *end, SporeVec3 position, SporeVec3 frame_arm, SporeVec3 arm,
                                      const SporeSite *sites, const double *q) {
  SporeVec3 motion = spore_vec3_sub(position, end->position);
  if (!turns(end)) return motion;
  SporeVec3 turned = spore_quat_rotate(spore_quat_load(q + sites[end->body].q + 3), frame_arm);
  return spore_vec3_add(motion, spore_vec3_sub(turned, arm));
}

/* What depth and friction follow of the two ends at positions a and b. */
typedef struct Motion {
  SporeVec3 depth_a, depth_b; /* of the sphere's centre, or of a field's contact point */
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

/* Stretch with all slip of the step in it. */
INLINE SporeVec3 stretch_after(const SporeContactTerm *term, const Motion *motion) {
  return spore_vec3_add(term->stretch, across(term->normal, spore_vec3_sub(motion->point_a, motion->point_b)));
}

bool spore_contact_term_rolls(const SporeContactTerm *term) {
  return spore_contact_term_meets(term) && (turns(&term->a) || turns(&term->b));
}

static Motion motion_at(const SporeContactTerm *term, const SporeSite *sites, const double *q) {
  return motion_of(term, position_of(&term->a, sites, q), position_of(&term->b, sites, q), sites, q);
}

/* A body that is felt as one gets its force where the sphere presses on it, wherever that has slid to in the step: at
 * one point, so that the two gain no angular momentum from each other. */
INLINE void meet_at(SporeEnd *end, SporeVec3 point, const SporeSite *sites, const double *q) {
  if (turns(end)) end->offset = spore_vec3_sub(point, spore_vec3_load(q + sites[end->body].q));
}

SporeVec3 spore_contact_term_stretch(const SporeContactTerm *term, const SporeSite *sites, const double *q) {
  if (!(term->law.friction > 0) || spore_contact_term_rolls(term)) return (SporeVec3){0, 0, 0};
  Motion motion = motion_at(term, sites, q);
  return spore_contact_slip(&term->law, stretch_after(term, &motion), term->yield);
}

/* At q and v; a little ahead where the term is softened. */
INLINE SporeContactState contact_state(SporeContactTerm *term, const SporeSite *sites, const double *q, const double *v,
                                       double elapsed_s) {
  SporeVec3 a = locate(&term->a, term->arm_a, sites, q), b = locate(&term->b, term->arm_b, sites, q);
  if (term->field_a) meet_at(&term->a, spore_vec3_add(b, term->arm_b), sites, q);
  if (term->field_b) meet_at(&term->b, spore_vec3_add(a, term->arm_a), sites, q);
  Motion motion = motion_of(term, a, b, sites, q);
  SporeContactState state = {term->normal, depth_after(term, &motion) - term->slack};
  state.velocity = spore_vec3_sub(velocity(&term->a, sites, v), velocity(&term->b, sites, v));
  if (spore_contact_term_rolls(term)) {
    SporeVec3 slip = across(term->normal, spore_vec3_scale(elapsed_s, state.velocity));
    state.stretch = spore_vec3_add(term->stretch, slip);
  } else if (term->law.friction > 0) {
    state.stretch = stretch_after(term, &motion);
  }
  if (term->softening.ahead > 0) {
    SporeVec3 ahead = spore_vec3_scale(term->softening.ahead, own_motion(&term->a, &term->b, sites, v));
    state.depth -= spore_vec3_dot(term->normal, ahead);
    state.stretch = spore_vec3_add(state.stretch, across(term->normal, ahead));
  }
  return state;
}

/* What is left of N when the ends alone take a step in which N' presses: the law at the gap speed and depth that it
 * leads to, less N'. */
static double unbalanced(const SporeContactLaw *law, double ahead, double faster, double depth, double gap_speed,
                         double pressing) {
  double change = faster * pressing;
  return spore_contact_normal(law, depth - ahead * change, gap_speed + change).force - pressing;
}

/* It falls with the gap speed that it leads to, so false position (the Illinois variant) closes in on it. */
double spore_contact_implicit_pressing(const SporeContactLaw *law, double ahead, double faster, double depth,
                                       double gap_speed, double most) {
  double low = 0, high = most, above = unbalanced(law, ahead, faster, depth, gap_speed, low);
  double below = unbalanced(law, ahead, faster, depth, gap_speed, high);
  if (!(above > 0)) return low;
  if (!(below < 0)) return high;
  for (int i = 0, side = 0; i < 40 && high - low > 1e-9 * most; i++) {
    double middle = low + (high - low) * above / (above - below);
    double value = unbalanced(law, ahead, faster, depth, gap_speed, middle);
    if (value > 0) {
      low = middle, above = value;
      if (side == 1) below *= 0.5;
      side = 1;
    } else {
      high = middle, below = value;
      if (value == 0) return middle;
      if (side == -1) above *= 0.5;
      side = -1;
    }
  }
  return low;
}

/* Softens along the normal by the law's slopes, or, where that would throw the ends apart so fast that the law bends,
 * by the law itself. Friction's spring is softened by itself, and cut by what then presses. */
static void soften_contact(SporeContactTerm *term, const SporeContactState *state) {
  const SporeSoftening *softening = &term->softening;
  double w = softening->inverse_mass, h = softening->h;
  SporeVec3 n = term->normal;
  if (term->pressing <= 0) return;
  double gap_speed = spore_vec3_dot(n, state->velocity);
  SporeContactNormal law = spore_contact_normal(&term->law, state->depth, gap_speed);
  double pressing = term->pressing / (1 + w * h * (law.damping + softening->ahead * law.stiffness));
  if (gap_speed + w * h * pressing > 0.5 * SPORE_CONTACT_EXIT_SPEED)
    pressing = spore_contact_implicit_pressing(&term->law, softening->ahead, w * h, state->depth, gap_speed, pressing);
  term->pressing = term->yield = pressing;
  term->force = spore_vec3_scale(pressing, n);
  if (!(term->law.friction > 0)) return;
  double damping;
  SporeVec3 hold = spore_contact_hold(&term->law, state, &damping);
  double softer = 1 + w * h * (damping + softening->ahead * term->law.stiffness);
  hold = spore_contact_cut(&term->law, spore_vec3_scale(1 / softer, hold), pressing);
  term->force = spore_vec3_sub(term->force, hold);
  term->yield = softer * pressing;
}

void spore_contact_term_force(SporeContactTerm *term, const SporeSite *sites, const double *q, const double *v,
                              double elapsed_s, double *f) {
  SporeContactState state = contact_state(term, sites, q, v, elapsed_s);
  term->force = spore_contact_force(&term->law, &state);
  term->yield = term->pressing = spore_vec3_dot(term->normal, term->force);
  if (term->softening.inverse_mass > 0) soften_contact(term, &state);
  scatter_pair(&term->a, &term->b, sites, term->force, f);
}

SporeMat3 spore_contact_term_jacobian(SporeContactTerm *term, const SporeSite *sites, const double *q, const double *v,
                                      double elapsed_s, double c, double c2) {
  SporeContactState state = contact_state(term, sites, q, v, elapsed_s);
  return spore_contact_jacobian(&term->law, &state, c2, c);
}

/* Where the ends are, or will be after `ahead`. */
static void spring_ends(SporeSpringTerm *term, const SporeSite *sites, const double *q, const double *v, SporeVec3 *a,
                        SporeVec3 *b) {
  const SporeVec3 none = {0, 0, 0};
  *a = locate(&term->a, none, sites, q);
  *b = locate(&term->b, none, sites, q);
  /* What holds two points together pulls in any direction: both bodies feel it where the first is, so that together
   * they are not turned by it. */
  if (term->law.rest_length == 0 && !term->b.prescribed && term->b.mapping->kind == SPORE_MAPPING_RIGID)
    term->b.offset = spore_vec3_add(term->b.offset, spore_vec3_sub(*a, *b));
  *a = spore_vec3_add_scaled(*a, term->softening.ahead, gather(&term->a, sites, v));
  *b = spore_vec3_add_scaled(*b, term->softening.ahead, gather(&term->b, sites, v));
}

static SporeMat3 spring_jacobian(const SporeSpring *law, SporeVec3 a, SporeVec3 b, double c, double c2) {
  SporeMat3 stiffness, damping;
  spore_spring_jacobian(law, a, b, &stiffness, &damping);
  return spore_mat3_add(spore_mat3_scale(c2, stiffness), spore_mat3_scale(c, damping));
}

void spore_spring_term_force(SporeSpringTerm *term, const SporeSite *sites, const double *q, const double *v,
                             double *f) {
  SporeVec3 a, b;
  spring_ends(term, sites, q, v, &a, &b);
  term->force = spore_spring_force(&term->law, a, b, velocity(&term->a, sites, v), velocity(&term->b, sites, v));
  const SporeSoftening *softening = &term->softening;
  if (softening->inverse_mass > 0) {
    SporeMat3 jacobian = spring_jacobian(&term->law, a, b, softening->h, softening->h * softening->ahead);
    term->force = soften(softening, jacobian, term->force);
  }
  scatter_pair(&term->a, &term->b, sites, term->force, f);
}

SporeMat3 spore_spring_term_jacobian(SporeSpringTerm *term, const SporeSite *sites, const double *q, const double *v,
                                     double c, double c2) {
  SporeVec3 a, b;
  spring_ends(term, sites, q, v, &a, &b);
  return spring_jacobian(&term->law, a, b, c, c2);
}

double spore_contact_term_energy(const SporeContactTerm *term, const SporeSite *sites, const double *q) {
  Motion motion = motion_at(term, sites, q);
  return spore_contact_potential(&term->law, depth_after(term, &motion), spore_contact_term_stretch(term, sites, q));
}

double spore_spring_term_energy(const SporeSpringTerm *term, const SporeSite *sites, const double *q) {
  return spore_spring_energy(&term->law, spore_end_position(&term->a, sites, q),
                             spore_end_position(&term->b, sites, q));
}

SporeVec3 spore_contact_term_point(const SporeContactTerm *term) {
  return spore_vec3_add(term->a.position, term->arm_a);
}
