/* Frames along a line: how a mesh around a line of control points follows that line, section by section. Each point of
 * the mesh keeps its parameter along the line, and its place in the frame there. The frame has the tangent of the line,
 * and a normal that turns about the tangent as little as it can. The tangent is that of the chord between two places on
 * either side, two and a half radii away: so a bend that is sharper than the mesh is thick is spread over its sections,
 * which else would pass each other on the inside and turn the mesh inside out. A section keeps its shape and turns as a
 * whole. So a bend does not pinch the mesh, and a twist wrings it. At rest every point is where it was, to rounding.
 *
 * Normals are carried from station to station by the smallest rotation from one tangent to the next (parallel
 * transport: R. L. Bishop, "There is more than one way to frame a curve", 1975; Bergou, Wardetzky, Robinson, Audoly and
 * Grinspun, "Discrete elastic rods", 2008). How far the material has rolled about the line, there are four ways to
 * tell: arms      of a line that resists twist: the nodes beside its knots (models/spline/twist.h); a root    that
 * turns with the body: each section follows the root's rotation, and then the smallest rotation onto its own tangent;
 *   no root   nor arms: the same with the rotation that best fits the line to how it was at rest, by least squares;
 *   straight  at rest, with neither: the smallest rotation of the line's direction; the roll about it is not known.
 * Without arms, neighbouring sections share their roll. With z = exp(i roll) at the stations, they minimise
 *   sum over pieces |z - z'|^2 / length  +  sum over stations length |z - a|^2 / reach^2,
 * where a is the roll of the station by itself, and z' that of the next station: one linear system with a constant
 * tridiagonal matrix. All of it is a smooth function of the nodes. Velocities are its derivative, and forces the
 * transpose of that. */
#ifndef SPORE_SIM_LINE_FRAMES_H
#define SPORE_SIM_LINE_FRAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/base/error.h"
#include "core/math/quat.h"
#include "core/math/spline.h"
#include "core/mesh/mesh.h"

/* A line at rest. Its control points are the first nodes of a body. Behind them lie the ends of arms, one a knot; or a
 * root: a node with a frame, whose angular velocity is the block behind the node, and whose quaternion lies behind all
 * nodes in q. All is borrowed. */
typedef struct SporeLine {
  SporeSplineKnots knots;
  const double *radius; /* SPORE_LINE_SAMPLES a span, evenly, and one at the end, m */
  bool arms, rooted;
  const double *q; /* configuration of the body at rest, in the identity pose */
} SporeLine;
/* Places in a span at which the radius of a line is given. */
#define SPORE_LINE_SAMPLES 8

/* A sum over the nodes `first` .. `first` + 3. */
typedef struct SporeLineSum {
  size_t first;
  double weight[4];
} SporeLineSum;

/* How a place on the line, and the two ends of the chord about it, follow from the nodes. */
typedef struct SporeLineRow {
  SporeLineSum value, ahead, behind;
} SporeLineRow;

/* A place on the line that has a frame of its own, as it is at rest. */
typedef struct SporeLineStation {
  double parameter, spread; /* spread: the chord's ends are so far off, in the parameter */
  size_t arm;               /* node at the end of its arm */
  SporeLineRow row;
  SporeVec3 place;           /* at rest, from the mean of the stations, m */
  SporeVec3 tangent, normal; /* at rest */
  double angle;              /* about the tangent, from the arm to the normal, rad */
  double length;             /* of the part of the line for which the station stands, m */
  double weight;             /* length / reach^2, in the system for z */
  double coupling, pivot;    /* of the system for z: 1 / distance to the next station; pivot of its factor */
} SporeLineStation;

/* The frame of a station, and what its derivatives need, at the q that was last placed. */
typedef struct SporeLineFrame {
  SporeVec3 position, tangent, normal;
  double inverse;            /* 1 / length of the chord, 1/m */
  double twist;              /* roll to the next station, rad */
  SporeVec3 bend;            /* spore_line_bend to the next station */
  SporeVec3 arm;             /* from the line to the end of the arm, m */
  SporeVec3 reference;       /* normal carried along the line from its start */
  SporeVec3 source;          /* tangent at rest, turned as the root is */
  double near;               /* (1 + cosine of the angle from source to tangent) / 2 */
  double anchor[2], roll[2]; /* a and z, as angles from the reference; |a| is `near` */
} SporeLineFrame;

/* A point of the mesh. */
typedef struct SporeLinePoint {
  double parameter, spread;
  SporeLineRow row;
  uint32_t station; /* before the point */
  double share;     /* part of the way from that station to the next */
  double place[3];  /* from the line, along the tangent, the normal, and tangent x normal, m */
  double crowd;     /* how fast sections turn along the line at rest, 1/m, times the point's distance from the line */
} SporeLinePoint;

/* Frames of a line, and the points that follow them. The structure owns its arrays. */
typedef struct SporeLineFrames {
  bool arms, rooted, straight;
  size_t root;       /* node behind the control points: the first arm, or the root */
  size_t quaternion; /* index in q of the root's quaternion */
  SporeVec3 chord;   /* direction of a straight line at rest */
  size_t station_count, point_count;
  SporeLineStation *stations;
  SporeLinePoint *points;
  double torn; /* part of the mesh's edges that lead to another loop of the line */
  /* Room for one evaluation at a time. */
  SporeLineFrame *frames; /* station_count */
  double *tangent_rate;   /* station_count x 3: rates of the tangents, 1/s; in forces, the force on each */
  double *roll_rate;      /* station_count: rates of the rolls, rad/s; in forces, the torque on each */
  double *system;         /* station_count x 2 */
} SporeLineFrames;

/* Attaches the vertices of the mesh (body's frame) to the line, each where spore_curve_attach puts it. False: no
 * memory; spore_line_frames_clear has to be called then, too. */
bool spore_line_frames_init(SporeLineFrames *frames, const SporeLine *line, const SporeTriangleMesh *mesh,
                            SporeError *error);
/* The same line led by other control points. Points and stations keep their parameters; the knots of the stations must
 * still exist. Arms are in the order of the knots. */
void spore_line_frames_follow(SporeLineFrames *frames, SporeSplineKnots knots);
/* Frees the arrays and zeroes the structure. */
void spore_line_frames_clear(SporeLineFrames *frames);

/* In place of the index of one point: all points. */
#define SPORE_LINE_ALL SIZE_MAX
/* Positions at q of one point (3 doubles) or of all (point_count x 3), m. Here and below: not by two threads at once,
 * as all of these use the room of `frames`. */
void spore_line_frames_positions(const SporeLineFrames *frames, size_t point, const double *q, double *positions);
/* Velocities at q and v of one point or of all, m/s; shape as positions. */
void spore_line_frames_velocities(const SporeLineFrames *frames, size_t point, const double *q, const double *v,
                                  double *velocities);
/* f += J^T forces: forces (N) on one point or on all, shape as positions; f: 3 doubles a block of v. */
void spore_line_frames_add_forces(const SporeLineFrames *frames, size_t point, const double *q, const double *forces,
                                  double *f);

/* Largest turn of the sections per length of the line at rest, times distance from the line, over all points. Where
 * this exceeds 1, the mesh folds on the inside of the bend. *point: where it is largest; *share: part of the points
 * where it exceeds 1. */
double spore_line_frames_crowd(const SporeLineFrames *frames, size_t *point, double *share);

/* line_roll.c: computes the frames of the stations at q, into `frames->frames`. */
void spore_line_roll_place(const SporeLineFrames *frames, const double *q);
/* line_roll.c: computes tangent_rate and roll_rate from the velocity v; after spore_line_roll_place at the same q. */
void spore_line_roll_rate(const SporeLineFrames *frames, const double *q, const double *v);
/* line_roll.c: the transpose of spore_line_roll_rate: adds to f what tangent_rate and roll_rate, as forces, do to the
 * nodes. */
void spore_line_roll_pull(const SporeLineFrames *frames, const double *q, double *f);

/* The sum of `values` (3 doubles a node). */
static inline SporeVec3 spore_line_sum(const SporeLineSum *sum, const double *values) {
  SporeVec3 all = {0, 0, 0};
  for (size_t k = 0; k < 4; k++)
    all = spore_vec3_add_scaled(all, sum->weight[k], spore_vec3_load(values + 3 * (sum->first + k)));
  return all;
}
/* The transpose: f of each node += its weight times value. */
static inline void spore_line_spread(const SporeLineSum *sum, SporeVec3 value, double *f) {
  for (size_t k = 0; k < 4; k++)
    spore_vec3_accumulate(f + 3 * (sum->first + k), spore_vec3_scale(sum->weight[k], value));
}
/* The chord, of `values`, and the transpose. */
static inline SporeVec3 spore_line_chord(const SporeLineRow *row, const double *values) {
  return spore_vec3_sub(spore_line_sum(&row->ahead, values), spore_line_sum(&row->behind, values));
}
static inline void spore_line_spread_chord(const SporeLineRow *row, SporeVec3 value, double *f) {
  spore_line_spread(&row->ahead, value, f);
  spore_line_spread(&row->behind, spore_vec3_scale(-1, value), f);
}
/* The part of a that is perpendicular to the tangent (a unit vector). */
static inline SporeVec3 spore_line_across(SporeVec3 a, SporeVec3 tangent) {
  return spore_vec3_add_scaled(a, -spore_vec3_dot(a, tangent), tangent);
}
/* b = t x t' / (1 + t . t'), for unit tangents t and t'. A normal that is carried from t to t' rolls about t' at the
 * rate -b . (rate of t + rate of t') while both tangents turn (Bergou et al. 2008: b is half the curvature binormal).
 */
static inline SporeVec3 spore_line_bend(SporeVec3 from, SporeVec3 to) {
  return spore_vec3_scale(1 / fmax(1 + spore_vec3_dot(from, to), 1e-9), spore_vec3_cross(from, to));
}

#endif
