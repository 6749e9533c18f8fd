/* What bodies along a curve share: a spline made from it, what it weighs, and spheres along it. */
#ifndef SPORE_MODELS_SPLINE_LINE_H
#define SPORE_MODELS_SPLINE_LINE_H

#include "core/body/model.h"
#include "models/spline/spline.h"

/* What a line is across: a round tube, or solid. */
typedef struct SporeSplineSection {
  double density, content_density; /* of the wall and of what is inside it, kg/m^3 */
  double wall_thickness;           /* m; 0, or at least the radius: solid */
  bool straight_at_rest;           /* would be straight if nothing bent it */
} SporeSplineSection;

/* How many control points a line gets: `count` evenly along it; then, while some span turns by more than most_bend
 * (rad; 0: without limit), a knot in the middle of that span, up to `most` control points in all. */
#define SPORE_SPLINE_NARROWEST (1. / 64) /* of an even span, that is still halved where the line bends */
typedef struct SporeSplineDensity {
  size_t count, most;
  double most_bend;
} SporeSplineDensity;

/* Radius of the section at a parameter of the spline, m; *inner: of what is hollow, 0 where it is solid. */
double spore_spline_section_radius(const SporeSplineCourse *course, const SporeSplineSection *section,
                                   SporeSplineKnots knots, double parameter, double *inner);

/* How a span weighs by the parameter, at both Gauss points, between and beyond which it is linear. */
typedef struct SporeSplineWeight {
  /* kg, m and, about the line, kg m^2, by the parameter */
  double mass[SPORE_SPLINE_POINTS], length[SPORE_SPLINE_POINTS], polar[SPORE_SPLINE_POINTS];
} SporeSplineWeight;

typedef struct SporeSplineLine {
  size_t control_count;
  SporeSplineKnots knots;
  SporeSplineCourse course;   /* what it was made along; empty: another line has it */
  double *breaks;             /* of the knots; NULL: evenly */
  bool bends;                 /* a span turns by more than the density asks for: there were to be no more points */
  double *rest;               /* control points, 3 each, body's frame, m */
  double *radius;             /* at SPORE_LINE_SAMPLES places a span and at the end, m */
  double *mass, *length;      /* of each control point: integrals of its function, kg and m */
  SporeSplineWeight *weights; /* of each span; NULL: another line has them */
  SporeSphereSet spheres;     /* along the line, each a radius from the next; smaller where loops
                                 touch at rest */
  SporeSpline spline;         /* young, bending and viscous are the model's to set; its blocks are not looked up yet */
} SporeSplineLine;

/* Refuses no curve, one of no use and one that turns back on itself. Clear it in either case. */
bool spore_spline_line_init(SporeSplineLine *line, const SporeCurve *curve, const SporeSplineDensity *density,
                            const SporeSplineSection *section, SporeError *error);
void spore_spline_line_clear(SporeSplineLine *line);
/* Sets all that follows from the knots and control points of a line, in arrays that are there: stiffness, mass and
 * length. Mass and length are integrals of the weights of `made`, whose knots are among the knots of the line. lengths:
 * the length at rest for which each Gauss point stands, the points of a span next to each other, m. */
void spore_spline_line_measure(SporeSplineLine *line, const SporeSplineLine *made, const SporeSplineSection *section,
                               double *lengths);
/* Polar inertia of a span of the line about itself, as `made` weighs, kg m^2. */
double spore_spline_line_polar(const SporeSplineLine *line, const SporeSplineLine *made, size_t span);
/* The slots map, samples and spheres of SporeModelType; arms as for spore_spline_map. */
bool spore_spline_line_map(const SporeSplineLine *line, const double *arms, const double *points, size_t count,
                           const SporeCancel *cancel, double slack, bool follows, SporeMapping *mapping,
                           SporeError *error);
/* The slot map_drawn of a model that begins with the line; arms: it has them behind the control points, else a root if
 * it has a frame. */
bool spore_spline_line_map_drawn(const SporeSplineLine *line, const SporeModel *model, bool arms,
                                 const SporeTriangleMesh *mesh, SporeMapping *mapping, SporeError *error);
bool spore_spline_line_samples(const SporeSplineLine *line, const double *arms, size_t arm_count, double **points,
                               size_t *count, size_t *seen);
bool spore_spline_line_spheres(const SporeSplineLine *line, SporeSphereSet *set, SporeError *error);

#endif
