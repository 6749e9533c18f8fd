/* Arms of a twisted line whose knots come and go: a new one halves the angle between its neighbours. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/body/path.h"
#include "models/spline/twist.h"

static SporeVec3 unit(SporeVec3 a) { return spore_vec3_normalise(a, spore_vec3(1, 0, 0)); }
static SporeVec3 across(SporeVec3 a, SporeVec3 t) { return spore_vec3_add_scaled(a, -spore_vec3_dot(a, t), t); }

/* An arm and the line's tangent at its knot. */
typedef struct Place {
  SporeVec3 position, tangent, arm;
} Place;

static Place place_of(SporeSplineKnots knots, const double *control, double parameter, const double *end) {
  SporePathPlace at = spore_path_at(knots, control, parameter);
  SporeVec3 arm = end ? spore_vec3_sub(spore_vec3_load(end), at.position) : spore_vec3(0, 0, 0);
  return (Place){at.position, unit(at.slope), arm};
}

/* The angle from one arm, transported along the line, to the other; of all turns the one nearest to `about`. */
static double angle_between(const Place *a, const Place *b, double about) {
  SporeVec3 from = spore_vec3_transport(across(a->arm, a->tangent), a->tangent, b->tangent);
  SporeVec3 to = across(b->arm, b->tangent);
  double angle = atan2(spore_vec3_dot(b->tangent, spore_vec3_cross(from, to)), spore_vec3_dot(from, to));
  return angle + 2 * M_PI * rint((about - angle) / (2 * M_PI));
}

/* The arm of this length at the angle from where `from` is transported to. */
static SporeVec3 turned_arm(const Place *from, SporeVec3 tangent, double angle, double length) {
  SporeVec3 arm = unit(spore_vec3_transport(across(from->arm, from->tangent), from->tangent, tangent));
  SporeVec3 turned =
      spore_vec3_add_scaled(spore_vec3_scale(cos(angle), arm), sin(angle), spore_vec3_cross(tangent, arm));
  return spore_vec3_scale(length, turned);
}

bool spore_spline_twist_reserve(SporeSplineTwist *now, const SporeSplineTwist *made, size_t most) {
  assert(most >= made->span_count);
  *now = (SporeSplineTwist){.modulus = made->modulus,
                            .arm = made->arm,
                            .spans = SPORE_NEW_ARRAY(SporeTwistSpan, most),
                            .rest = SPORE_NEW_ARRAY(double, 3 * (most + 1)),
                            .mass = SPORE_NEW_ARRAY(double, most + 1)};
  return now->spans && now->rest && now->mass;
}

/* The angle over a span of the line as it was made, turns and all. */
static double whole_angle(const SporeSplineTwist *made, const SporeSplineLine *line, size_t span) {
  assert(span < made->span_count);
  Place a = place_of(line->knots, line->rest, spore_spline_break(line->knots, span), made->rest + 3 * span);
  Place b = place_of(line->knots, line->rest, spore_spline_break(line->knots, span + 1), made->rest + 3 * (span + 1));
  return angle_between(&a, &b, made->spans[span].rest);
}

void spore_spline_twist_lead(const SporeSplineTwist *made, const SporeSplineLine *line, SporeSplineKnots knots,
                             double *arms) {
  for (size_t knot = 0, of = 0; knot <= knots.span_count; knot++) {
    double at = spore_spline_break(knots, knot);
    while (of < line->knots.span_count && spore_spline_break(line->knots, of + 1) <= at) of++;
    double from = spore_spline_break(line->knots, of);
    if (at == from) {
      memcpy(arms + 3 * knot, made->rest + 3 * of, 3 * sizeof *arms);
      continue;
    }
    double part = (at - from) / spore_spline_width(line->knots, of);
    Place before = place_of(line->knots, line->rest, from, made->rest + 3 * of);
    Place here = place_of(line->knots, line->rest, at, NULL);
    SporeVec3 arm = turned_arm(&before, here.tangent, part * whole_angle(made, line, of), made->arm);
    spore_vec3_store(arms + 3 * knot, spore_vec3_add(here.position, arm));
  }
}

/* Rest angles: what the arms at rest have between them, without the turns that the line is twisted by. */
static void set_rest(SporeSplineTwist *now, const SporeSplineTwist *made, const SporeSplineLine *line,
                     const SporeSplineLine *made_line) {
  for (size_t span = 0, of = 0; span < line->knots.span_count; span++) {
    double from = spore_spline_break(line->knots, span), to = spore_spline_break(line->knots, span + 1);
    while (spore_spline_break(made_line->knots, of + 1) <= from) of++;
    double part = (to - from) / spore_spline_width(made_line->knots, of), whole = whole_angle(made, made_line, of);
    Place a = place_of(line->knots, line->rest, from, now->rest + 3 * span);
    Place b = place_of(line->knots, line->rest, to, now->rest + 3 * (span + 1));
    now->spans[span].rest = angle_between(&a, &b, part * whole) - part * (whole - made->spans[of].rest);
  }
}

void spore_spline_twist_measure(SporeSplineTwist *now, const SporeSplineTwist *made, SporeSplineLine *line,
                                const SporeSplineLine *made_line, const SporeSplineSection *section) {
  now->span_count = line->knots.span_count;
  spore_spline_twist_lead(made, made_line, line->knots, now->rest);
  spore_spline_twist_set_spans(now, line, made_line, section);
  set_rest(now, made, line, made_line);
}

/* The spin that two arms have about the line's places. */
static SporeVec3 spin_of(const Place arm[2], const SporeVec3 speed[2]) {
  SporeMat3 inertia = {{0}};
  SporeVec3 momentum = {0, 0, 0};
  for (int i = 0; i < 2; i++) {
    SporeMat3 skew = spore_mat3_skew(arm[i].arm);
    inertia = spore_mat3_sub(inertia, spore_mat3_multiply(skew, skew));
    momentum = spore_vec3_add(momentum, spore_vec3_cross(arm[i].arm, speed[i]));
  }
  double values[3];
  SporeMat3 axes;
  SporeVec3 spin = {0, 0, 0};
  spore_mat3_eigen_symmetric(inertia, values, &axes);
  double most = fmax(values[0], fmax(values[1], values[2]));
  for (int k = 0; k < 3; k++) {
    SporeVec3 axis = spore_mat3_column(axes, k);
    if (values[k] > 1e-3 * most) spin = spore_vec3_add_scaled(spin, spore_vec3_dot(axis, momentum) / values[k], axis);
  }
  return spin;
}

void spore_spline_twist_insert(const SporeSplineTwist *now, SporeSplineKnots knots, size_t span, double parameter,
                               const double *q, const double *v, double arm_q[3], double arm_v[3]) {
  assert(span < knots.span_count);
  assert(arm_q && arm_v);
  size_t count = knots.span_count + 3;
  Place arm[2], here = place_of(knots, q, parameter, NULL);
  SporeVec3 speed[2];
  for (size_t end = 0; end < 2; end++) {
    size_t node = 3 * (count + span + end);
    double at = spore_spline_break(knots, span + end);
    arm[end] = place_of(knots, q, at, q + node);
    speed[end] = spore_vec3_sub(spore_vec3_load(v + node), spore_path_at(knots, v, at).position);
  }
  double angle = angle_between(&arm[0], &arm[1], now->spans[span].rest);
  double length = 0.5 * (spore_vec3_length(arm[0].arm) + spore_vec3_length(arm[1].arm));
  SporeVec3 d = turned_arm(&arm[0], here.tangent, 0.5 * angle, length);
  SporeVec3 u = spore_vec3_add(spore_path_at(knots, v, parameter).position, spore_vec3_cross(spin_of(arm, speed), d));
  spore_vec3_store(arm_q, spore_vec3_add(here.position, d));
  spore_vec3_store(arm_v, u);
}
