/* Terms: what couples two material points for the length of a step, contacts and springs. Their points, normals and
 * laws are frozen when the step begins, so that the forces are a pure function of q and v. Private to the room. */
#ifndef SPORE_SIM_TERM_H
#define SPORE_SIM_TERM_H

#include "core/collide/response.h"
#include "core/body/path.h"
#include "core/constraint/spring.h"
#include "core/body/mapping.h"

/* Where the state of a body begins in a pair of vectors q and v, in doubles. */
typedef struct SporeSite {
  size_t q, v;
} SporeSite;

/* One end of a term. A moving end follows its body's state by the mapping; a prescribed one (unmovable, active and
 * frozen bodies, the world) is at position + offset and has `velocity`. */
typedef struct SporeEnd {
  const SporeMapping *mapping;
  uint32_t body, point; /* body: index, or SPORE_NO_BODY for the world */
  bool prescribed;
  SporeVec3 position; /* when the step began */
  SporeVec3 velocity; /* of a prescribed end */
  SporeVec3 offset;   /* prescribed: motion since the step began; moving and rigid: lever from the body's origin to
                         where the force acts, at the last evaluation */
} SporeEnd;

typedef struct SporeContactTerm {
  SporeEnd a, b; /* sphere centres */
  uint32_t sphere_a, sphere_b;
  uint32_t pair_a, pair_b;            /* what friction remembers the pair by */
  SporeVec3 normal;                   /* from b to a */
  double depth;                       /* m, when the step began */
  double overlap;                     /* of the depth, m: the part that motion has not made, see response.h */
  SporeVec3 arm_a, arm_b;             /* from the centres to the contact point when the step began, m */
  SporeVec3 frame_arm_a, frame_arm_b; /* the same in the frames of rigid bodies */
  bool field_a, field_b;              /* the body is felt as one: depth follows its contact point, not the centre */
  SporeVec3 stretch;                  /* of friction's spring, when the step began, m */
  SporeContactLaw law;
  SporeVec3 drag;    /* at the last linearisation: see spore_contact_jacobian */
  SporeVec3 force;   /* on a, at the last evaluation, N */
  double pressing;   /* its normal part; infinite before the first */
  SporeVec3 impulse; /* on a, N s: of the parts of a step in an impact, see core/sim/solve/impact.c */
} SporeContactTerm;

/* What end b of a spring runs along, instead of staying where it is on its body: the place nearest to end a, found anew
 * at each evaluation from where it was when the step began. So the spring's energy is that of how far a is off the
 * path, and what it does to the points that lead the path follows from it. */
/* What its turning under load adds to the stiffness of a spring that runs along a path, beside that of the spring
 * across it: with d from the path to end a, t along it, p = J^T t the speed of a past the path, and e = (N_i' / |b'|) k
 * d what turns the load as the points i turn the path, -df/dx = k J^T (I - tt^T) J + along pp^T - turn (pe^T + ep^T) -
 * load ee^T g = 1 - d.b'' / |b'|^2,  along = k (1 - 1/g),  turn = 1/g,  load = 1/(k g) from the Hessian of min over s
 * of k/2 |a - b(s)|^2. Symmetric, and indefinite. */
typedef struct SporeCurveJointBend {
  size_t first; /* of the four points */
  SporeVec3 tangent;
  double weight[SPORE_PATH_WIDTH];
  SporeVec3 turned[SPORE_PATH_WIDTH]; /* e */
  double along, turn, load;           /* times c2; all 0: nothing is added */
  bool assembled;                     /* it is in the body's matrix */
} SporeCurveJointBend;

typedef struct SporeCurveJoint {
  SporeSplineKnots knots; /* core/body/path.h */
  const double *points;   /* of a rigid body: what leads the path, in its frame; NULL: the first nodes of the body do */
  SporeMapping *mapping;  /* of end b, one point: linear, or of the frame */
  bool stops;             /* at its ends, as a contact would (core/collide/response.h) */
  double end, soft;       /* 1, -1: it stops here, and end b is at the end, at the start; over how much of depth, m */
  double start;           /* parameter when the step began */
  SporeCurveJointBend bend; /* at the last linearisation */
} SporeCurveJoint;

typedef struct SporeSpringTerm {
  SporeEnd a, b;
  SporeSpring law;
  SporeCurveJoint *curve; /* NULL: none */
  SporeVec3 force;        /* on a, at the last evaluation, N */
  double stretch;         /* of friction's spring, when the step began, m */
  double slid;            /* since then, at the last evaluation, m */
  double held;            /* force across the free direction, at the last evaluation, N */
} SporeSpringTerm;

/* Below, q and v are the vectors that `sites` (by body) belongs to. */

/* Whether two spheres that are apart when the step begins meet within it, which only fast ones do; what is felt as one
 * is a contact shortly before it touches. */
static inline bool spore_contact_term_meets(const SporeContactTerm *term) {
  return term->depth <= 0 && !term->field_a && !term->field_b;
}

/* Bodies that meet within the step may turn by radians in it. An arm that has turned so far does not tell how far its
 * sphere has rolled, and friction that follows it pulls any way, and makes energy: such a contact has slipped by its
 * slip velocity times the time since the step began. */
bool spore_contact_term_rolls(const SporeContactTerm *term);

/* Evaluates the term's force and adds it to f. elapsed_s: since the step began. */
void spore_contact_term_force(SporeContactTerm *term, const SporeSite *sites, const double *q, const double *v,
                              double elapsed_s, double *f);
void spore_spring_term_force(SporeSpringTerm *term, const SporeSite *sites, const double *q, const double *v,
                             double *f);
/* How fast end a parts from end b along the normal, by a vector x of velocities (or accelerations) at q, of what
 * physics moves. */
double spore_contact_term_parting(SporeContactTerm *term, const SporeSite *sites, const double *q, const double *x);
/* Sets the arms of the contact of two spheres by its normal and depth. */
void spore_contact_term_set_arms(SporeContactTerm *term, double radius_a, double radius_b);
/* Makes the contact of two spheres the one that is found at q, as if a step began there: with its normal, depth and
 * arms, and what is left of its stretch. A contact with a depth field stays as it is. */
void spore_contact_term_follow(SporeContactTerm *term, double radius_a, double radius_b, const SporeSite *sites,
                               const double *q);
/* Sets the force of a term of which physics moves no end: a device may still feel the force. */
void spore_contact_term_hold(SporeContactTerm *term);
void spore_spring_term_hold(SporeSpringTerm *term);
/* c (-df/dv) + c2 (-df/dx) for the motion of end a relative to end b; of a contact without what is not symmetric in it,
 * which is kept as its drag. */
SporeMat3 spore_contact_term_jacobian(SporeContactTerm *term, const SporeSite *sites, const double *q, const double *v,
                                      double elapsed_s, double c, double c2);
SporeMat3 spore_spring_term_jacobian(SporeSpringTerm *term, const SporeSite *sites, const double *q, const double *v,
                                     double c, double c2);
/* What the drag adds to that times x, added to y. */
void spore_contact_term_drag(const SporeContactTerm *term, const SporeSite *sites, const double *x, double *y);
/* Of a term with a curve joint, after its Jacobian: what the path's bending adds, kept with the curve joint; and that
 * times x, added to y. */
void spore_curve_joint_bend(SporeSpringTerm *term, const SporeSite *sites, const double *q, double c2);
void spore_curve_joint_bend_multiply(const SporeSpringTerm *term, const SporeSite *sites, const double *x, double *y);
/* Its block between two of the path's four points. */
SporeMat3 spore_curve_joint_bend_block(const SporeCurveJointBend *bend, size_t i, size_t j);
/* Potential energy, J. */
double spore_contact_term_energy(const SporeContactTerm *term, const SporeSite *sites, const double *q);
double spore_spring_term_energy(const SporeSpringTerm *term, const SporeSite *sites, const double *q);

/* Stretch of friction's spring at q, as the next step finds it, m. */
SporeVec3 spore_contact_term_stretch(const SporeContactTerm *term, const SporeSite *sites, const double *q);
double spore_spring_term_stretch(const SporeSpringTerm *term, const SporeSite *sites, const double *q);

/* The curve joint's place nearest to p, both in the world; local: the configuration of the body that it belongs to. */
SporePathPlace spore_curve_joint_place(const SporeCurveJoint *joint, const double *local, SporeVec3 p);
/* Puts end b there, and leaves the term free along the curve joint. */
void spore_curve_joint_set(SporeSpringTerm *term, const SporePathPlace *place);
/* Whether what slides may come to a stop in this step. */
bool spore_curve_joint_may_stop(const SporeCurveJoint *joint);
/* How far p is beyond an end of the path, m; 0: it is not. */
double spore_curve_joint_overshoot(const SporeCurveJoint *joint, const SporePathPlace *place, SporeVec3 p);

/* Contact point when the step began, m. */
SporeVec3 spore_contact_term_point(const SporeContactTerm *term);

#endif
