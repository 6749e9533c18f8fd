/* Twist of a spline. At each knot an arm across the line, a node of its own, tells how far the material has turned
 * about the line ("ghost points": Umetani, Schmidt and Stam 2014, "Position-based elastic rods"). The first of two
 * neighbouring arms is transported along the line to the other by the least rotation of the tangent; the angle m
 * between the two is then the twist of their span, writhe included (Bergou, Wardetzky, Robinson, Audoly and Grinspun
 * 2008, "Discrete elastic rods"). With d an arm, t the tangent at the arm, and a the length of the arm at rest:
 *   U = sum over spans G J / l  m^2 / 2  +  sum over arms k ((d . t)^2 + ((d . d - a^2) / 2 a)^2) / 2
 * The energy depends on places alone, so that both momenta are kept, and what holds an arm holds the line from turning.
 * An arm has the polar inertia of its piece of the line; k is such that the arm swings as fast as twist runs over a
 * span. The arms of neighbouring knots stand at a right angle, so that together they reproduce any point beside the
 * line. */
#ifndef SPORE_MODELS_SPLINE_TWIST_H
#define SPORE_MODELS_SPLINE_TWIST_H

#include "core/body/model.h"
#include "models/spline/line.h"

#define SPORE_TWIST_NODES 6 /* of a span: its control points, the arms at its knots */

typedef struct SporeTwistSpan {
  double value[2][4], slope[2][4]; /* place and slope at both knots by the span's control points */
  double polar;                    /* J / l, m^3 */
  double rest;                     /* m at rest, rad */
  uint32_t node[SPORE_TWIST_NODES];
  uint32_t block[SPORE_TWIST_NODES][SPORE_TWIST_NODES]; /* where the model's matrix has them */
} SporeTwistSpan;

typedef struct SporeSplineTwist {
  size_t span_count; /* 0: the line does not resist twist; one arm more */
  double modulus;    /* Pa */
  double viscous;    /* s */
  double arm;        /* length of an arm, m */
  SporeTwistSpan *spans;
  double *rest; /* ends of the arms, 3 each, body's frame, m */
  double *mass; /* kg each */
} SporeSplineTwist;

/* Arms for the line, twisted by so many turns from end to end, right-handed about the way it runs. Their nodes are
 * those behind the control points, and their mass is taken from them. Refuses turns that so few spans cannot have.
 * Clear it in either case. */
bool spore_spline_twist_init(SporeSplineTwist *twist, SporeSplineLine *line, const SporeSplineSection *section,
                             double modulus, double turns, SporeError *error);
void spore_spline_twist_clear(SporeSplineTwist *twist);
bool spore_spline_twist_pattern(const SporeSplineTwist *twist, SporeBlockPattern *pattern);
/* In a matrix of the model's whole pattern. */
void spore_spline_twist_find_blocks(SporeSplineTwist *twist, const SporeBlockMatrix *matrix);

/* Sets what follows from the knots of the line, without the rest angles: nodes and stiffness of the spans, and the mass
 * of the arms by the weights of `made`. That mass is taken from the control points of the line. */
void spore_spline_twist_set_spans(SporeSplineTwist *twist, SporeSplineLine *line, const SporeSplineLine *made,
                                  const SporeSplineSection *section);

/* spline_twist_knots.c: of a line whose knots come and go, whose twist as it was made is `made`. Room for so many
 * spans; false: no memory, clear it in either case. */
bool spore_spline_twist_reserve(SporeSplineTwist *now, const SporeSplineTwist *made, size_t most);
/* Arms at rest at these knots, of the line as it was made: three each. */
void spore_spline_twist_lead(const SporeSplineTwist *made, const SporeSplineLine *line, SporeSplineKnots knots,
                             double *arms);
/* All that follows from the knots that the line has now. */
void spore_spline_twist_measure(SporeSplineTwist *now, const SporeSplineTwist *made, SporeSplineLine *line,
                                const SporeSplineLine *made_line, const SporeSplineSection *section);
/* The arm at a new knot in a span of these knots: halfway between the arms of its ends, in angle, length and spin. */
void spore_spline_twist_insert(const SporeSplineTwist *now, SporeSplineKnots knots, size_t span, double parameter,
                               const double *q, const double *v, double arm_q[3], double arm_v[3]);

/* What twist adds, as SporeModelType says; the matrix leaves out how a twist that is there turns as the line bends. */
void spore_spline_twist_force(const SporeSplineTwist *twist, const double *q, const double *shape, const double *v,
                              double *f);
double spore_spline_twist_potential(const SporeSplineTwist *twist, const double *q);
void spore_spline_twist_jacobian(const SporeSplineTwist *twist, const SporeTangent *at, SporeBlockMatrix *matrix);
/* Greatest angle of a span from its rest, rad; above half a turn there is none. */
double spore_spline_twist_worst(const SporeSplineTwist *twist, const double *q);

#endif
