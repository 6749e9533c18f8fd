/* Inserting and removing knots of a line while it runs.
 *
 * A span that turns by more than most_bend is halved: a knot is inserted in its middle, which changes neither the line
 * nor its velocity (spore_spline_insert). Two halves that together turn by less than a third of most_bend for
 * SPORE_KNOTS_CALM seconds become one span again, where that moves the line by no more than SPORE_KNOTS_SLACK of its
 * radius; the control points are then the nearest ones in the mean square. The knots of creation stay, and so do knots
 * beside what is held, so that no constraint is lost or gained. The parameter of a material point never changes. */
#ifndef SPORE_MODELS_SPLINE_KNOTS_H
#define SPORE_MODELS_SPLINE_KNOTS_H

#include "models/spline/twist.h"

#define SPORE_KNOTS_CALM 0.25  /* s */
#define SPORE_KNOTS_SLACK 0.05 /* of the line's radius */

typedef struct SporeSplineChanges {
  const SporeSplineLine *made; /* NULL: knots never change, and nothing below is there */
  const SporeSplineTwist *made_twist;
  SporeSplineLine now;    /* without spheres and weights; room for `most` control points */
  SporeSplineTwist twist; /* of no spans: the line turns freely about itself */
  size_t most;
  double most_bend; /* rad */
  SporeSplineSection section;
  /* What is to be changed next. */
  double *lengths; /* as spore_spline_line_measure has them; twice most */
  double *turn;    /* a span: rad; most */
  double *calm;    /* a knot: for how long its spans were straight, s; most */
  uint8_t *halve;  /* a span; most */
  size_t insert_count;
  size_t drop;  /* the knot that goes, 0: none */
  bool spent;   /* it bends where there are to be no more points */
  double *work; /* breaks: most */
} SporeSplineChanges;

/* The line and twist as they were made are borrowed. False: no memory. Clear it in either case. */
bool spore_spline_changes_init(SporeSplineChanges *changes, const SporeSplineLine *made, const SporeSplineTwist *twist,
                               const SporeSplineDensity *density, const SporeSplineSection *section);
void spore_spline_changes_clear(SporeSplineChanges *changes);
/* As it was made. */
void spore_spline_changes_undo(SporeSplineChanges *changes);
/* The slots weigh_nodes and change_nodes of SporeModelType: control points, and arms behind them. */
bool spore_spline_changes_weigh(SporeSplineChanges *changes, double h, const double *q, const uint8_t *held);
void spore_spline_changes_make(SporeSplineChanges *changes, double *q, double *v, uint8_t *held);

/* Control points at rest of the line as it was made, led by these knots, its own among them: room for three each.
 * breaks: scratch, as many as those. */
void spore_spline_line_lead(const SporeSplineLine *made, SporeSplineKnots knots, double *control, double *breaks);

#endif
