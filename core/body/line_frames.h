/* Frames along a line: how what surrounds a line led by control points goes with it, section by section. Each point
 * keeps its parameter along the line and its place in the frame there: the tangent, and a normal that turns about it as
 * little as it can. Sections stay as they are and turn as a whole, so that what bends is not pinched and what twists is
 * wrung. The places at rest are reproduced to rounding.
 *
 * Normals are carried from station to station by the least turn of the tangent (Bishop 1975; Bergou, Wardetzky,
 * Robinson, Audoly and Grinspun 2008). What tells how far the material has rolled about the line:
 *   arms    of a line that resists twist: the nodes at its knots (models/spline/twist.h);
 *   a root  that turns with the body: sections are drawn to where its turn and the least turn of their tangent put
 * them; nothing but the line: the same with the turn that fits the line best to how it was at rest; of a line that is
 *           straight at rest the least turn of its direction, and its roll about that is not known.
 * Without arms, sections give way to one another: with z = exp(i roll) at the stations, they minimise
 *   sum over pieces |z - z'|^2 / length  +  sum over stations length |z - a|^2 / reach^2,
 * a linear system of one matrix. All of it is a smooth function of the nodes; velocities and forces are its derivative
 * and the transpose of that. */
#ifndef SPORE_SIM_LINE_FRAMES_H
#define SPORE_SIM_LINE_FRAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/base/error.h"
#include "core/math/quat.h"
#include "core/math/spline.h"
#include "core/mesh/mesh.h"

/* A line at rest. Its control points are the first nodes of a body; behind them are the ends of arms, one a knot, or a
 * root: a node with a frame, whose turning is the block behind it, and whose quaternion is behind all nodes. */
typedef struct SporeLine {
  SporeSplineKnots knots;
  const double *radius; /* at SPORE_LINE_SAMPLES places a span, evenly, and at the end, m */
  bool arms, rooted;
  const double *q; /* the body's configuration at rest, at the identity */
} SporeLine;
#define SPORE_LINE_SAMPLES 8

/* How the line follows from nodes at one parameter: first .. first + 3. */
typedef struct SporeLineRow {
  size_t first;
  double value[4], slope[4];
} SporeLineRow;

typedef struct SporeLineStation {
  double parameter;
  size_t arm; /* node */
  SporeLineRow row;
  SporeVec3 place, tangent, normal; /* at rest; place: from the middle of the stations */
  double angle;                     /* about the tangent, from the arm to the normal, rad */
  double length;                    /* of the line for which it stands, m */
  double weight, coupling, pivot;   /* of the system for z; coupling: with the next station */
} SporeLineStation;

/* Where a station is now. */
typedef struct SporeLineFrame {
  SporeVec3 position, tangent, normal;
  double inverse;              /* 1 / length of the slope */
  double twist;                /* to the next station, rad */
  SporeVec3 bend;              /* t x t' / (1 + t . t') to the next one */
  SporeVec3 arm;               /* from the line */
  SporeVec3 reference, source; /* normal carried along the line; tangent at rest, turned as the root is */
  double near;                 /* (1 + cosine of the angle from source to tangent) / 2 */
  double anchor[2], roll[2];   /* a and z, both seen from the reference; |a| is `near` */
} SporeLineFrame;

typedef struct SporeLinePoint {
  double parameter;
  SporeLineRow row;
  uint32_t station; /* before it */
  double share;     /* of the way to the next */
  double place[3];  /* along the tangent, the normal, their product, m */
  double crowd;     /* curvature of the line at rest, times the distance from it */
} SporeLinePoint;

typedef struct SporeLineFrames {
  bool arms, rooted, straight;
  size_t root;       /* node behind the control points: the first arm, or the root */
  size_t quaternion; /* of the root, entries of q before it */
  SporeVec3 chord;   /* direction of a straight line at rest */
  size_t station_count, point_count;
  SporeLineStation *stations;
  SporeLinePoint *points;
  double torn; /* share of the mesh's edges that lead to another loop of the line */
  /* Room for one evaluation at a time. */
  SporeLineFrame *frames;
  double *tangent_rate, *roll_rate; /* of each station: 3 and 1; in forces what these are multiplied by */
  double *system;                   /* 2 each */
} SporeLineFrames;

/* The mesh's vertices, body's frame, each with the place of the line that spore_curve_attach tells. False: no memory;
 * clear it then too. */
bool spore_line_frames_init(SporeLineFrames *frames, const SporeLine *line, const SporeTriangleMesh *mesh,
                            SporeError *error);
/* The same line led by other control points: parameters stay, and stations, whose knots are still there. Arms are in
 * the order of the knots. */
void spore_line_frames_follow(SporeLineFrames *frames, SporeSplineKnots knots);
void spore_line_frames_clear(SporeLineFrames *frames);

/* As those of a mapping (core/body/mapping.h), of all points or, with `point`, of one. Not by two threads at once. */
#define SPORE_LINE_ALL SIZE_MAX
void spore_line_frames_positions(const SporeLineFrames *frames, size_t point, const double *q, double *positions);
void spore_line_frames_velocities(const SporeLineFrames *frames, size_t point, const double *q, const double *v,
                                  double *velocities);
void spore_line_frames_add_forces(const SporeLineFrames *frames, size_t point, const double *q, const double *forces,
                                  double *f);

/* Greatest curvature of the line at rest times distance from it, of the points; above 1 what surrounds the line folds
 * on the inside of the bend. *point: where; *share: of the points, that are above 1. */
double spore_line_frames_crowd(const SporeLineFrames *frames, size_t *point, double *share);

/* line_roll.c: the frames of the stations at q; what they do as nodes move; and, in tangent_rate and roll_rate, what
 * the nodes get for each. */
void spore_line_roll_place(const SporeLineFrames *frames, const double *q);
void spore_line_roll_rate(const SporeLineFrames *frames, const double *q, const double *v);
void spore_line_roll_pull(const SporeLineFrames *frames, const double *q, double *f);

static inline SporeVec3 spore_line_sum(const SporeLineRow *row, const double weight[4], const double *values) {
  SporeVec3 sum = {0, 0, 0};
  for (size_t k = 0; k < 4; k++)
    sum = spore_vec3_add_scaled(sum, weight[k], spore_vec3_load(values + 3 * (row->first + k)));
  return sum;
}
static inline void spore_line_spread(const SporeLineRow *row, const double weight[4], SporeVec3 value, double *f) {
  for (size_t k = 0; k < 4; k++) spore_vec3_accumulate(f + 3 * (row->first + k), spore_vec3_scale(weight[k], value));
}
static inline SporeVec3 spore_line_across(SporeVec3 a, SporeVec3 tangent) {
  return spore_vec3_add_scaled(a, -spore_vec3_dot(a, tangent), tangent);
}
/* By how much a normal that is carried from one tangent to the other rolls as these turn: -bend . (both rates). */
static inline SporeVec3 spore_line_bend(SporeVec3 from, SporeVec3 to) {
  return spore_vec3_scale(1 / fmax(1 + spore_vec3_dot(from, to), 1e-9), spore_vec3_cross(from, to));
}

#endif
