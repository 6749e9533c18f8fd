/* Forces, energy and Jacobian of a line. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/math/simd_matrix.h"
#include "models/spline/spline.h"

#define NODES (SPORE_LANES + 3) /* control points of a group */
#define SHORT 1e-9              /* |a| below which it has no direction of its own */

/* The group's control points, with zeros behind the last. */
SPORE_INLINE void load_nodes(const SporeSpline *spline, size_t group, const double *x, double nodes[3 * NODES]) {
  assert(group < spline->group_count);
  size_t first = group * SPORE_LANES, left = spline->span_count + 3 - first;
  if (left >= NODES) memcpy(nodes, x + 3 * first, 3 * NODES * sizeof *nodes);
  else {
    memset(nodes, 0, 3 * NODES * sizeof *nodes);
    memcpy(nodes, x + 3 * first, 3 * left * sizeof *nodes);
  }
}

/* Control points by the weights of one derivative. */
SPORE_INLINE SporeVd3 combine(const double weight[4][SPORE_LANES], size_t lane, const SporeVd3 nodes[4]) {
  SporeVd3 sum = spore_vd3_scale(spore_vd_load(weight[0] + lane), nodes[0]);
  SPORE_UNROLL for (int k = 1; k < 4; k++) sum =
      spore_vd3_add(sum, spore_vd3_scale(spore_vd_load(weight[k] + lane), nodes[k]));
  return sum;
}

SPORE_INLINE void lanes_of(const double nodes[3 * NODES], size_t lane, SporeVd3 x[4]) {
  SPORE_UNROLL for (size_t k = 0; k < 4; k++) x[k] = spore_vd3_load(nodes + 3 * (lane + k));
}

/* How a Gauss point is stretched and bent. */
typedef struct Strain {
  SporeVd3 a, b, tangent;
  SporeVd length, inverse, square; /* |a|, its inverse, |b|^2 */
} Strain;

SPORE_INLINE Strain strain_of(const SporeSplineGauss *gauss, size_t lane, const SporeVd3 x[4]) {
  Strain strain = {.a = combine(gauss->first, lane, x), .b = combine(gauss->second, lane, x)};
  strain.length = spore_vd_sqrt(spore_vd3_dot(strain.a, strain.a));
  strain.inverse = 1 / spore_vd_max(strain.length, spore_vd_all(SHORT));
  strain.tangent = spore_vd3_scale(strain.inverse, strain.a);
  strain.square = spore_vd3_dot(strain.b, strain.b);
  return strain;
}

/* c' of c(s), and 2 c'' s. */
SPORE_INLINE SporeVd bending_slope(SporeVd s, SporeVd rest, SporeVd *rise) {
  SporeVl curved = rest > 0;
  SporeVd one = spore_vd_all(1), sum = spore_vd_select(curved, s + 3 * rest, one), inverse = 1 / sum;
  *rise = 64 * rest * rest * s * inverse * inverse * inverse;
  return spore_vd_select(curved, (s - rest) * (s + 7 * rest) * inverse * inverse, one);
}

/* What drags at a Gauss point: speeds along the tangent, and of w = b' - turning a' along `across`, which is b across
 * the tangent. */
typedef struct Drag {
  SporeVd3 tangent, across;
  SporeVd turning, stretch, bend;
} Drag;

SPORE_INLINE Drag drag_of(const SporeSpline *spline, const SporeSplineGauss *gauss, size_t lane, const SporeVd3 x[4]) {
  Strain strain = strain_of(gauss, lane, x);
  SporeVd along = spore_vd3_dot(strain.b, strain.tangent);
  Drag drag = {.tangent = strain.tangent, .turning = along * strain.inverse};
  drag.across = spore_vd3_sub(strain.b, spore_vd3_scale(along, strain.tangent));
  double scale = spline->young * spline->viscous;
  SporeVd inverse = 1 / (spore_vd3_dot(drag.across, drag.across) + spline->straight);
  drag.stretch = scale * spore_vd_load(gauss->area + lane);
  drag.bend = scale * spline->bending * spore_vd_load(gauss->inertia + lane) * inverse;
  return drag;
}

/* Generalised forces of a and of b. */
SPORE_INLINE void add_drag(const Drag *drag, SporeVd3 a_speed, SporeVd3 b_speed, SporeVd3 *of_a, SporeVd3 *of_b) {
  SporeVd3 w = spore_vd3_sub(b_speed, spore_vd3_scale(drag->turning, a_speed));
  SporeVd3 moment = spore_vd3_scale(drag->bend * spore_vd3_dot(w, drag->across), drag->across);
  SporeVd pull = drag->stretch * spore_vd3_dot(drag->tangent, a_speed);
  *of_b = spore_vd3_add(*of_b, moment);
  *of_a = spore_vd3_add(*of_a, spore_vd3_scale(pull, drag->tangent));
  *of_a = spore_vd3_sub(*of_a, spore_vd3_scale(drag->turning, moment));
}

SPORE_INLINE void add_forces(const SporeSplineGauss *gauss, size_t lane, SporeVd3 of_a, SporeVd3 of_b,
                             SporeVd3 sum[4]) {
  SPORE_UNROLL for (int k = 0; k < 4; k++) {
    sum[k] = spore_vd3_add(sum[k], spore_vd3_scale(spore_vd_load(gauss->first[k] + lane), of_a));
    sum[k] = spore_vd3_add(sum[k], spore_vd3_scale(spore_vd_load(gauss->second[k] + lane), of_b));
  }
}

SPORE_INLINE void elastic_forces(const SporeSpline *spline, const SporeSplineGauss *gauss, size_t lane,
                                 const SporeVd3 x[4], SporeVd3 *of_a, SporeVd3 *of_b) {
  SporeVd rise;
  Strain strain = strain_of(gauss, lane, x);
  SporeVd slope = bending_slope(strain.square, spore_vd_load(gauss->rest + lane), &rise);
  *of_a = spore_vd3_scale(spline->young * spore_vd_load(gauss->area + lane) * (strain.length - 1), strain.tangent);
  *of_b = spore_vd3_scale(spline->young * spline->bending * spore_vd_load(gauss->inertia + lane) * slope, strain.b);
}

void SPORE_LEVEL_NAME(spore_spline_force)(const SporeSpline *spline, const double *q, const double *shape,
                                          const double *v, double *f) {
  assert(f != q && f != v);
  assert(spline->viscous >= 0);
  double position[3 * NODES], before[3 * NODES], speed[3 * NODES], pull[4][3 * SPORE_LANES];
  for (size_t group = 0; group < spline->group_count; group++) {
    load_nodes(spline, group, q, position);
    if (spline->viscous > 0) load_nodes(spline, group, shape, before);
    if (spline->viscous > 0) load_nodes(spline, group, v, speed);
    for (size_t lane = 0; lane < SPORE_LANES; lane += SPORE_WIDTH) {
      SporeVd3 x[4], s[4], u[4], sum[4] = {0};
      lanes_of(position, lane, x);
      if (spline->viscous > 0) lanes_of(before, lane, s);
      if (spline->viscous > 0) lanes_of(speed, lane, u);
      for (size_t point = 0; point < SPORE_SPLINE_POINTS; point++) {
        const SporeSplineGauss *gauss = spline->gauss + group * SPORE_SPLINE_POINTS + point;
        SporeVd3 of_a, of_b;
        elastic_forces(spline, gauss, lane, x, &of_a, &of_b);
        if (spline->viscous > 0) {
          Drag drag = drag_of(spline, gauss, lane, s);
          add_drag(&drag, combine(gauss->first, lane, u), combine(gauss->second, lane, u), &of_a, &of_b);
        }
        add_forces(gauss, lane, of_a, of_b, sum);
      }
      for (int k = 0; k < 4; k++) spore_vd3_store(pull[k] + 3 * lane, sum[k]);
    }
    size_t first = group * SPORE_LANES, spans = spline->span_count - first;
    for (size_t k = 0; k < 4; k++)
      for (size_t i = 0; i < 3 * (spans < SPORE_LANES ? spans : SPORE_LANES); i++) f[3 * (first + k) + i] -= pull[k][i];
  }
}

double SPORE_LEVEL_NAME(spore_spline_potential)(const SporeSpline *spline, const double *q) {
  double position[3 * NODES], lanes[SPORE_LANES] = {0};
  for (size_t group = 0; group < spline->group_count; group++) {
    load_nodes(spline, group, q, position);
    for (size_t lane = 0; lane < SPORE_LANES; lane += SPORE_WIDTH) {
      SporeVd3 x[4];
      SporeVd sum = spore_vd_load(lanes + lane);
      lanes_of(position, lane, x);
      for (size_t point = 0; point < SPORE_SPLINE_POINTS; point++) {
        const SporeSplineGauss *gauss = spline->gauss + group * SPORE_SPLINE_POINTS + point;
        Strain strain = strain_of(gauss, lane, x);
        SporeVd rest = spore_vd_load(gauss->rest + lane), change = strain.square - rest;
        SporeVd curved = change * change / spore_vd_select(rest > 0, strain.square + 3 * rest, spore_vd_all(1));
        SporeVd bend = spore_vd_select(rest > 0, curved, strain.square);
        sum += spore_vd_load(gauss->area + lane) * (strain.length - 1) * (strain.length - 1) +
               spline->bending * spore_vd_load(gauss->inertia + lane) * bend;
      }
      spore_vd_store(lanes + lane, sum);
    }
  }
  return 0.5 * spline->young * spore_lanes_sum(lanes);
}

/* A symmetric 3x3 matrix a lane: xx xy xz yy yz zz. */
typedef struct Symmetric {
  SporeVd m[6];
} Symmetric;

/* m += along n n^T + all I */
SPORE_INLINE void add_symmetric(Symmetric *m, SporeVd all, SporeVd along, SporeVd3 n) {
  SporeVd3 scaled = spore_vd3_scale(along, n);
  m->m[0] += scaled.x * n.x + all, m->m[1] += scaled.x * n.y, m->m[2] += scaled.x * n.z;
  m->m[3] += scaled.y * n.y + all, m->m[4] += scaled.y * n.z, m->m[5] += scaled.z * n.z + all;
}

/* Second derivatives by a and a, b and b, a and b. */
typedef struct Stiffness {
  Symmetric aa, bb, ab;
} Stiffness;

/* least: of the stiffness across the line and across the bend: 0, or minus infinity for the whole. */
SPORE_INLINE void add_elastic(const SporeSpline *spline, const SporeSplineGauss *gauss, size_t lane,
                              const SporeVd3 x[4], double scale, double least, Stiffness *stiffness) {
  SporeVd rise, lowest = spore_vd_all(least);
  Strain strain = strain_of(gauss, lane, x);
  SporeVd slope = bending_slope(strain.square, spore_vd_load(gauss->rest + lane), &rise);
  SporeVd stretch = scale * spline->young * spore_vd_load(gauss->area + lane);
  SporeVd bend = scale * spline->young * spline->bending * spore_vd_load(gauss->inertia + lane);
  SporeVd across = spore_vd_max(1 - strain.inverse, lowest);
  add_symmetric(&stiffness->aa, stretch * across, stretch * (1 - across), strain.tangent);
  SporeVd aside = spore_vd_max(slope, lowest), along = spore_vd_max(slope + rise, lowest);
  SporeVd inverse = 1 / spore_vd_max(strain.square, spore_vd_all(1e-200));
  add_symmetric(&stiffness->bb, bend * aside, bend * (along - aside) * inverse, strain.b);
}

SPORE_INLINE void add_viscosity(const Drag *drag, double scale, Stiffness *stiffness) {
  SporeVd zero = {0};
  Symmetric moment = {0};
  add_symmetric(&stiffness->aa, zero, scale * drag->stretch, drag->tangent);
  add_symmetric(&moment, zero, scale * drag->bend, drag->across);
  SPORE_UNROLL for (int e = 0; e < 6; e++) {
    stiffness->bb.m[e] += moment.m[e];
    stiffness->ab.m[e] -= drag->turning * moment.m[e];
    stiffness->aa.m[e] += drag->turning * drag->turning * moment.m[e];
  }
}

/* Blocks (i, j) with i <= j of a span, in the order 00 01 02 03 11 12 13 22 23 33. */
#define PAIRS 10

SPORE_INLINE void add_pairs(const SporeSplineGauss *gauss, size_t lane, const Stiffness *stiffness, bool mixed,
                            Symmetric sum[PAIRS]) {
  int pair = 0;
  SPORE_UNROLL for (int i = 0; i < 4; i++) {
    SporeVd first = spore_vd_load(gauss->first[i] + lane), second = spore_vd_load(gauss->second[i] + lane);
    Symmetric by_a, by_b;
    SPORE_UNROLL for (int e = 0; e < 6; e++) {
      by_a.m[e] = first * stiffness->aa.m[e], by_b.m[e] = second * stiffness->bb.m[e];
      if (mixed) by_a.m[e] += second * stiffness->ab.m[e], by_b.m[e] += first * stiffness->ab.m[e];
    }
    SPORE_UNROLL for (int j = i; j < 4; j++, pair++) {
      SporeVd a = spore_vd_load(gauss->first[j] + lane), b = spore_vd_load(gauss->second[j] + lane);
      SPORE_UNROLL for (int e = 0; e < 6; e++) sum[pair].m[e] += by_a.m[e] * a + by_b.m[e] * b;
    }
  }
}

/* Blocks (i, i + k) of a group's control points: [k][entry][i]. */
typedef double Band[4][6][NODES];

SPORE_INLINE void add_to_band(double lanes[PAIRS][6][SPORE_LANES], Band band) {
  int pair = 0;
  for (int i = 0; i < 4; i++)
    for (int j = i; j < 4; j++, pair++)
      for (int e = 0; e < 6; e++)
        for (int lane = 0; lane < SPORE_LANES; lane++) band[j - i][e][i + lane] += lanes[pair][e][lane];
}

/* Adds the rows of the first `count` control points to the matrix and moves the others to the front. */
SPORE_INLINE void flush(const SporeSpline *spline, size_t first, size_t count, Band band, SporeBlockMatrix *matrix) {
  static const int place[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  size_t nodes = spline->span_count + 3;
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < 4 && first + i + k < nodes; k++) {
      double *upper = matrix->values + 9 * (size_t)spline->upper[4 * (first + i) + k];
      double *lower = matrix->values + 9 * (size_t)spline->lower[4 * (first + i) + k];
      double entry[6];
      for (int e = 0; e < 6; e++) entry[e] = band[k][e][i];
      for (int e = 0; e < 9; e++) upper[e] += entry[place[e]];
      if (k == 0) continue;
      for (int e = 0; e < 9; e++) lower[e] += entry[place[e]];
    }
  for (int k = 0; k < 4; k++)
    for (int e = 0; e < 6; e++) {
      memcpy(band[k][e], band[k][e] + SPORE_LANES, 3 * sizeof(double));
      memset(band[k][e] + 3, 0, SPORE_LANES * sizeof(double));
    }
}

void SPORE_LEVEL_NAME(spore_spline_jacobian)(const SporeSpline *spline, const SporeTangent *at,
                                             SporeBlockMatrix *matrix) {
  assert(at->stiffness_scale >= 0);
  assert(matrix->values);
  bool drags = at->damping_scale * spline->viscous > 0;
  double least = at->whole ? -HUGE_VAL : 0;
  double position[3 * NODES], before[3 * NODES], lanes[PAIRS][6][SPORE_LANES];
  Band band = {0};
  for (size_t group = 0; group < spline->group_count; group++) {
    load_nodes(spline, group, at->q, position);
    if (drags) load_nodes(spline, group, at->shape, before);
    for (size_t lane = 0; lane < SPORE_LANES; lane += SPORE_WIDTH) {
      SporeVd3 x[4], s[4];
      Symmetric sum[PAIRS] = {0};
      lanes_of(position, lane, x);
      if (drags) lanes_of(before, lane, s);
      for (size_t point = 0; point < SPORE_SPLINE_POINTS; point++) {
        const SporeSplineGauss *gauss = spline->gauss + group * SPORE_SPLINE_POINTS + point;
        Stiffness stiffness = {0};
        add_elastic(spline, gauss, lane, x, at->stiffness_scale, least, &stiffness);
        if (drags) {
          Drag drag = drag_of(spline, gauss, lane, s);
          add_viscosity(&drag, at->damping_scale, &stiffness);
        }
        add_pairs(gauss, lane, &stiffness, drags, sum);
      }
      for (int pair = 0; pair < PAIRS; pair++)
        for (int e = 0; e < 6; e++) spore_vd_store(lanes[pair][e] + lane, sum[pair].m[e]);
    }
    add_to_band(lanes, band);
    bool last = group + 1 == spline->group_count;
    size_t first = group * SPORE_LANES;
    flush(spline, first, last ? spline->span_count + 3 - first : SPORE_LANES, band, matrix);
  }
}
