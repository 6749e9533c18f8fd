/* Forces, energy and Jacobian of twist. */
#include "models/spline/twist.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define SHORT 1e-9 /* of an arm, or of a slope: below, it has no direction of its own */
#define SCALARS 5  /* of a span: its twist, and two of each arm that is counted with it */

/* A knot as a span sees it: the arm d, and the tangent t of slope s. */
typedef struct Knot {
  SporeVec3 d, t;
  double inverse; /* 1 / |s| */
} Knot;

static Knot knot_of(const SporeSplineTwist *twist, const SporeTwistSpan *span, int end,
                    const SporeVec3 x[SPORE_TWIST_NODES]) {
  assert(end == 0 || end == 1);
  SporeVec3 place = {0, 0, 0}, slope = {0, 0, 0};
  for (int i = 0; i < 4; i++) {
    place = spore_vec3_add_scaled(place, span->value[end][i], x[i]);
    slope = spore_vec3_add_scaled(slope, span->slope[end][i], x[i]);
  }
  double inverse = 1 / fmax(spore_vec3_length(slope), SHORT * twist->arm);
  return (Knot){spore_vec3_sub(x[4 + end], place), spore_vec3_scale(inverse, slope), inverse};
}

static void load_nodes(const SporeTwistSpan *span, const double *from, SporeVec3 x[SPORE_TWIST_NODES]) {
  for (int i = 0; i < SPORE_TWIST_NODES; i++) x[i] = spore_vec3_load(from + 3 * (size_t)span->node[i]);
}

static SporeVec3 across(SporeVec3 a, SporeVec3 t) { return spore_vec3_add_scaled(a, -spore_vec3_dot(a, t), t); }

/* What a span has energy for: stiffness value^2 / 2. */
typedef struct Scalar {
  double stiffness, value;
  SporeVec3 of_arm[2], of_slope[2]; /* the value by d and s */
  double spread;                    /* second derivative of the value by the arm `end`: spread I */
  int end;
} Scalar;

/* The angle from the first arm, transported along the line, to the second, less the angle at rest; within half a
 * turn. */
static double twist_angle(const SporeTwistSpan *span, const Knot knot[2]) {
  SporeVec3 a = spore_vec3_transport(across(knot[0].d, knot[0].t), knot[0].t, knot[1].t);
  SporeVec3 b = across(knot[1].d, knot[1].t);
  double angle = atan2(spore_vec3_dot(knot[1].t, spore_vec3_cross(a, b)), spore_vec3_dot(a, b)) - span->rest;
  return angle - 2 * M_PI * rint(angle / (2 * M_PI));
}

/* The angle changes with an arm as the arm turns; with a tangent by half the binormal of the bend of the span, and by
 * the swing of an arm that leans over the line. */
static void set_twist(const SporeTwistSpan *span, const Knot knot[2], double arm, Scalar *scalar) {
  double cosine = fmax(spore_vec3_dot(knot[0].t, knot[1].t), -1 + 1e-6);
  SporeVec3 bend = spore_vec3_scale(1 / (1 + cosine), spore_vec3_cross(knot[0].t, knot[1].t));
  scalar->value = twist_angle(span, knot);
  for (int end = 0; end < 2; end++) {
    const Knot *at = &knot[end];
    SporeVec3 flat = across(at->d, at->t);
    double square = fmax(spore_vec3_dot(flat, flat), SHORT * SHORT * arm * arm), sign = end ? 1 : -1;
    SporeVec3 turn = spore_vec3_scale(sign / square, spore_vec3_cross(at->t, at->d));
    scalar->of_arm[end] = turn;
    scalar->of_slope[end] =
        spore_vec3_scale(at->inverse, spore_vec3_add_scaled(bend, -spore_vec3_dot(at->d, at->t), turn));
  }
}

/* The arm stays across the line and keeps its length. */
static void set_arm(const Knot *knot, int end, double arm, Scalar *lean, Scalar *length) {
  assert(arm > 0);
  SporeVec3 zero = {0, 0, 0};
  lean->value = spore_vec3_dot(knot->d, knot->t);
  lean->of_arm[end] = knot->t, lean->of_slope[end] = spore_vec3_scale(knot->inverse, across(knot->d, knot->t));
  length->value = (spore_vec3_dot(knot->d, knot->d) - arm * arm) / (2 * arm);
  length->of_arm[end] = spore_vec3_scale(1 / arm, knot->d), length->of_slope[end] = zero;
  length->spread = 1 / arm, length->end = end;
}

/* An arm is counted with the span behind it; the last one with the last span. */
static int scalars_of(const SporeSplineTwist *twist, size_t index, const double *from, Scalar out[SCALARS]) {
  assert(index < twist->span_count);
  const SporeTwistSpan *span = &twist->spans[index];
  SporeVec3 x[SPORE_TWIST_NODES];
  load_nodes(span, from, x);
  Knot knot[2] = {knot_of(twist, span, 0, x), knot_of(twist, span, 1, x)};
  int ends = index + 1 == twist->span_count ? 2 : 1, count = 1 + 2 * ends;
  memset(out, 0, (size_t)count * sizeof *out);
  out[0].stiffness = twist->modulus * span->polar;
  for (int i = 1; i < count; i++) out[i].stiffness = out[0].stiffness / (twist->arm * twist->arm);
  set_twist(span, knot, twist->arm, &out[0]);
  for (int end = 0; end < ends; end++) set_arm(&knot[end], end, twist->arm, &out[1 + 2 * end], &out[2 + 2 * end]);
  return count;
}

/* The value by each node. */
static void gradient_of(const SporeTwistSpan *span, const Scalar *scalar, SporeVec3 gradient[SPORE_TWIST_NODES]) {
  for (int i = 0; i < 4; i++) {
    SporeVec3 sum = {0, 0, 0};
    for (int end = 0; end < 2; end++) {
      sum = spore_vec3_add_scaled(sum, -span->value[end][i], scalar->of_arm[end]);
      sum = spore_vec3_add_scaled(sum, span->slope[end][i], scalar->of_slope[end]);
    }
    gradient[i] = sum;
  }
  gradient[4] = scalar->of_arm[0], gradient[5] = scalar->of_arm[1];
}

static void add_force(const SporeTwistSpan *span, const SporeVec3 gradient[SPORE_TWIST_NODES], double pull, double *f) {
  for (int i = 0; i < SPORE_TWIST_NODES; i++)
    spore_vec3_accumulate(f + 3 * (size_t)span->node[i], spore_vec3_scale(-pull, gradient[i]));
}

static void add_drag(const SporeSplineTwist *twist, size_t index, const double *shape, const double *v, double *f) {
  Scalar scalars[SCALARS];
  const SporeTwistSpan *span = &twist->spans[index];
  int count = scalars_of(twist, index, shape, scalars);
  SporeVec3 gradient[SPORE_TWIST_NODES], speed[SPORE_TWIST_NODES];
  load_nodes(span, v, speed);
  for (int k = 0; k < count; k++) {
    double rate = 0;
    gradient_of(span, &scalars[k], gradient);
    for (int i = 0; i < SPORE_TWIST_NODES; i++) rate += spore_vec3_dot(gradient[i], speed[i]);
    add_force(span, gradient, twist->viscous * scalars[k].stiffness * rate, f);
  }
}

void spore_spline_twist_force(const SporeSplineTwist *twist, const double *q, const double *shape, const double *v,
                              double *f) {
  assert(f != q && f != v);
  for (size_t index = 0; index < twist->span_count; index++) {
    Scalar scalars[SCALARS];
    SporeVec3 gradient[SPORE_TWIST_NODES];
    int count = scalars_of(twist, index, q, scalars);
    for (int k = 0; k < count; k++) {
      gradient_of(&twist->spans[index], &scalars[k], gradient);
      add_force(&twist->spans[index], gradient, scalars[k].stiffness * scalars[k].value, f);
    }
    if (twist->viscous > 0) add_drag(twist, index, shape, v, f);
  }
}

double spore_spline_twist_potential(const SporeSplineTwist *twist, const double *q) {
  double sum = 0;
  for (size_t index = 0; index < twist->span_count; index++) {
    Scalar scalars[SCALARS];
    int count = scalars_of(twist, index, q, scalars);
    for (int k = 0; k < count; k++) sum += 0.5 * scalars[k].stiffness * scalars[k].value * scalars[k].value;
  }
  return sum;
}

/* matrix += k g g^T + spread w w^T I, with w the weights by which nodes move the arm. */
static void add_stiffness(const SporeTwistSpan *span, const Scalar *scalar, double k, double spread,
                          SporeBlockMatrix *matrix) {
  SporeVec3 gradient[SPORE_TWIST_NODES];
  double weight[SPORE_TWIST_NODES] = {0};
  gradient_of(span, scalar, gradient);
  for (int i = 0; i < 4; i++) weight[i] = -span->value[scalar->end][i];
  weight[4 + scalar->end] = 1;
  for (int i = 0; i < SPORE_TWIST_NODES; i++)
    for (int j = 0; j < SPORE_TWIST_NODES; j++) {
      double *block = matrix->values + 9 * (size_t)span->block[i][j];
      double a[3], b[3], even = spread * weight[i] * weight[j];
      spore_vec3_store(a, gradient[i]);
      spore_vec3_store(b, gradient[j]);
      for (int e = 0; e < 9; e++) block[e] += k * (a[e / 3] * b[e % 3]) + (e % 4 ? 0 : even);
    }
}

void spore_spline_twist_jacobian(const SporeSplineTwist *twist, const SporeTangent *at, SporeBlockMatrix *matrix) {
  assert(at->stiffness_scale >= 0);
  double drag = at->damping_scale * twist->viscous, least = at->whole ? -HUGE_VAL : 0;
  for (size_t index = 0; index < twist->span_count; index++) {
    const SporeTwistSpan *span = &twist->spans[index];
    Scalar scalars[SCALARS];
    int count = scalars_of(twist, index, at->q, scalars);
    for (int k = 0; k < count; k++) {
      double stiffness = at->stiffness_scale * scalars[k].stiffness;
      add_stiffness(span, &scalars[k], stiffness, fmax(stiffness * scalars[k].value, least) * scalars[k].spread,
                    matrix);
    }
    if (drag > 0) count = scalars_of(twist, index, at->shape, scalars);
    for (int k = 0; drag > 0 && k < count; k++)
      add_stiffness(span, &scalars[k], drag * scalars[k].stiffness, 0, matrix);
  }
}

double spore_spline_twist_worst(const SporeSplineTwist *twist, const double *q) {
  double worst = 0;
  for (size_t index = 0; index < twist->span_count; index++) {
    const SporeTwistSpan *span = &twist->spans[index];
    SporeVec3 x[SPORE_TWIST_NODES];
    load_nodes(span, q, x);
    Knot knot[2] = {knot_of(twist, span, 0, x), knot_of(twist, span, 1, x)};
    worst = fmax(worst, fabs(twist_angle(span, knot)));
  }
  return worst;
}
