/* Making the arms of a line: their mass, length and place at rest. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/spline/twist.h"

#define RADII 4         /* of the line: what an arm is long at least, so that it weighs little beside it */
#define MOST_TURNS 0.33 /* of a span at the start: twist beyond half a turn cannot be told from less the other way */

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a spline"));
}

void spore_spline_twist_clear(SporeSplineTwist *twist) {
  spore_free(twist->spans);
  spore_free(twist->rest);
  spore_free(twist->mass);
  *twist = (SporeSplineTwist){0};
}

static SporeVec3 combine(const double *control, size_t span, const double weight[4]) {
  SporeVec3 sum = {0, 0, 0};
  for (size_t k = 0; k < 4; k++) sum = spore_vec3_add_scaled(sum, weight[k], spore_vec3_load(control + 3 * (span + k)));
  return sum;
}

/* The basis functions of a span at one of its knots. At the last knot of the span the functions are those of the next
 * span, shifted by one. */
static void set_knot(const SporeSplineTwist *twist, SporeSplineKnots knots, size_t index, int end) {
  assert(index < twist->span_count && (end == 0 || end == 1));
  size_t at;
  SporeTwistSpan *span = &twist->spans[index];
  SporeSplineBasis basis = spore_spline_basis(knots, spore_spline_break(knots, index + (size_t)end), &at);
  for (size_t k = 0; k < 4; k++) {
    size_t from = index + k - at;
    bool known = index + k >= at;
    span->value[end][k] = known ? basis.value[from] : 0;
    span->slope[end][k] = known ? basis.first[from] : 0;
  }
}

/* How the span resists twist, by both Gauss points. */
static void set_polar(SporeSplineTwist *twist, const SporeSplineLine *line, const SporeSplineCourse *course,
                      const SporeSplineSection *section, size_t index) {
  assert(index < twist->span_count);
  double soft = 0;
  for (int point = 0; point < SPORE_SPLINE_POINTS; point++) {
    size_t span;
    double u = spore_spline_gauss_parameter(line->knots, index, point), inner;
    double outer = spore_spline_section_radius(course, section, line->knots, u, &inner);
    SporeSplineBasis basis = spore_spline_basis(line->knots, u, &span);
    double part = spore_spline_width(line->knots, index) * spore_vec3_length(combine(line->rest, span, basis.first)) /
                  SPORE_SPLINE_POINTS;
    soft += part / (0.5 * M_PI * (pow(outer, 4) - pow(inner, 4)));
  }
  twist->spans[index].polar = 1 / soft;
}

void spore_spline_twist_set_spans(SporeSplineTwist *twist, SporeSplineLine *line, const SporeSplineLine *made,
                                  const SporeSplineSection *section) {
  assert(twist->span_count > 0 && twist->arm > 0);
  memset(twist->mass, 0, (twist->span_count + 1) * sizeof *twist->mass);
  for (size_t index = 0; index < twist->span_count; index++) {
    SporeTwistSpan *span = &twist->spans[index];
    for (int end = 0; end < 2; end++) set_knot(twist, line->knots, index, end);
    for (size_t k = 0; k < 4; k++) span->node[k] = (uint32_t)(index + k);
    for (size_t end = 0; end < 2; end++) span->node[4 + end] = (uint32_t)(twist->span_count + 3 + index + end);
    set_polar(twist, line, &made->course, section, index);
    double inertia = spore_spline_line_polar(line, made, index);
    for (size_t end = 0; end < 2; end++) twist->mass[index + end] += 0.5 * inertia / (twist->arm * twist->arm);
  }
  for (size_t knot = 0; knot <= twist->span_count; knot++) {
    size_t index = knot < twist->span_count ? knot : knot - 1, end = knot - index;
    for (size_t k = 0; k < 4; k++) line->mass[index + k] -= twist->spans[index].value[end][k] * twist->mass[knot];
  }
}

/* As long as a span, and so long that it weighs little beside the line. */
static double arm_length(const SporeSplineLine *line, const SporeSplineSection *section) {
  double length = 0, radius = 0, inner;
  for (size_t i = 0; i < line->control_count; i++) length += line->length[i];
  for (size_t index = 0; index < line->knots.span_count; index++)
    for (int point = 0; point < SPORE_SPLINE_POINTS; point++) {
      double u = spore_spline_gauss_parameter(line->knots, index, point);
      radius = fmax(radius, spore_spline_section_radius(&line->course, section, line->knots, u, &inner));
    }
  return fmax(length / (double)line->knots.span_count, RADII * radius);
}

/* Any vector across a unit vector. */
static SporeVec3 any_across(SporeVec3 t) {
  SporeVec3 axis = fabs(t.x) < fabs(t.y) ? spore_vec3(1, 0, 0) : spore_vec3(0, 1, 0);
  return spore_vec3_normalise(spore_vec3_cross(t, axis), axis);
}

/* Sets arms along the line, each turned by an angle from where the arm before is transported to. */
static void set_arms(SporeSplineTwist *twist, const SporeSplineLine *line, double turns) {
  double soft = 0;
  SporeVec3 before = {0, 0, 0}, arm = {0, 0, 0};
  for (size_t index = 0; index < twist->span_count; index++) soft += 1 / twist->spans[index].polar;
  for (size_t knot = 0; knot <= twist->span_count; knot++) {
    size_t index = knot < twist->span_count ? knot : knot - 1, end = knot - index;
    const SporeTwistSpan *span = &twist->spans[index];
    SporeVec3 t = spore_vec3_normalise(combine(line->rest, index, span->slope[end]), spore_vec3(1, 0, 0));
    if (knot == 0) arm = any_across(t);
    else {
      const SporeTwistSpan *behind = &twist->spans[knot - 1];
      double angle = behind->rest + 2 * M_PI * turns / (behind->polar * soft);
      arm = spore_vec3_transport(arm, before, t);
      arm = spore_vec3_add_scaled(spore_vec3_scale(cos(angle), arm), sin(angle), spore_vec3_cross(t, arm));
      arm = spore_vec3_normalise(arm, any_across(t));
    }
    before = t;
    SporeVec3 at = combine(line->rest, index, span->value[end]);
    spore_vec3_store(twist->rest + 3 * knot, spore_vec3_add_scaled(at, twist->arm, arm));
  }
}

static bool check_turns(const SporeSplineTwist *twist, double turns, SporeError *error) {
  double soft = 0, softest = 0;
  for (size_t index = 0; index < twist->span_count; index++) {
    soft += 1 / twist->spans[index].polar;
    softest = fmax(softest, 1 / twist->spans[index].polar);
  }
  double most = MOST_TURNS * soft / softest;
  if (fabs(turns) <= most) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("%g turns are more than the line can have between its control points, at most a third of a "
                           "turn from one to the next; at most %.3g turns were expected; set %.0f control points, or "
                           "fewer turns"),
                         turns, most, ceil(fabs(turns) / most * (double)twist->span_count) + 3);
}

bool spore_spline_twist_init(SporeSplineTwist *twist, SporeSplineLine *line, const SporeSplineSection *section,
                             double modulus, double turns, SporeError *error) {
  assert(modulus > 0 && isfinite(turns));
  size_t spans = line->spline.span_count;
  *twist = (SporeSplineTwist){.span_count = spans,
                              .modulus = modulus,
                              .spans = SPORE_NEW_ARRAY(SporeTwistSpan, spans),
                              .rest = SPORE_NEW_ARRAY(double, 3 * (spans + 1)),
                              .mass = SPORE_NEW_ARRAY(double, spans + 1)};
  if (!twist->spans || !twist->rest || !twist->mass) return no_memory(error);
  twist->arm = arm_length(line, section);
  spore_spline_twist_set_spans(twist, line, line, section);
  for (size_t index = 0; index < spans; index++) twist->spans[index].rest = 0.5 * M_PI;
  if (!check_turns(twist, turns, error)) return false;
  set_arms(twist, line, turns);
  return true;
}

bool spore_spline_twist_pattern(const SporeSplineTwist *twist, SporeBlockPattern *pattern) {
  for (size_t index = 0; index < twist->span_count; index++) {
    const uint32_t *node = twist->spans[index].node;
    for (size_t i = 4; i < SPORE_TWIST_NODES; i++)
      for (size_t j = 0; j < i; j++)
        if (!spore_block_pattern_add(pattern, node[i], node[j])) return false;
  }
  return true;
}

void spore_spline_twist_find_blocks(SporeSplineTwist *twist, const SporeBlockMatrix *matrix) {
  assert(twist->span_count == 0 || matrix->block_count > 2 * twist->span_count + 3);
  for (size_t index = 0; index < twist->span_count; index++) {
    SporeTwistSpan *span = &twist->spans[index];
    for (size_t i = 0; i < SPORE_TWIST_NODES; i++)
      for (size_t j = 0; j < SPORE_TWIST_NODES; j++)
        span->block[i][j] = (uint32_t)spore_block_matrix_find(matrix, span->node[i], span->node[j]);
  }
}
