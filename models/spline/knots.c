/* Choosing, inserting and removing knots of a line while it runs. */
#include "models/spline/knots.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"

#define STRAIGHT (1. / 3) /* of most_bend: what the halves turn by together before they become one again */

bool spore_spline_changes_init(SporeSplineChanges *changes, const SporeSplineLine *made, const SporeSplineTwist *twist,
                               const SporeSplineDensity *density, const SporeSplineSection *section) {
  assert(density->most >= made->control_count);
  size_t most = density->most;
  *changes = (SporeSplineChanges){
      .made = made, .made_twist = twist, .most = most, .most_bend = density->most_bend, .section = *section};
  SporeSplineLine *now = &changes->now;
  now->breaks = SPORE_NEW_ARRAY(double, most);
  now->rest = SPORE_NEW_ARRAY(double, 3 * most);
  now->mass = SPORE_NEW_ARRAY(double, most);
  now->length = SPORE_NEW_ARRAY(double, most);
  changes->lengths = SPORE_NEW_ARRAY(double, SPORE_SPLINE_POINTS *most);
  changes->turn = SPORE_NEW_ARRAY(double, most);
  changes->calm = SPORE_NEW_ARRAY(double, most);
  changes->work = SPORE_NEW_ARRAY(double, most);
  changes->halve = SPORE_NEW_ARRAY(uint8_t, most);
  bool room = now->breaks && now->rest && now->mass && now->length && changes->lengths && changes->turn &&
              changes->calm && changes->work && changes->halve && spore_spline_allocate(&now->spline, most - 3);
  if (twist->span_count > 0) room = room && spore_spline_twist_reserve(&changes->twist, twist, most - 3);
  if (!room) return false;
  now->spline.young = made->spline.young;
  spore_spline_changes_undo(changes);
  return true;
}

void spore_spline_changes_clear(SporeSplineChanges *changes) {
  spore_spline_line_clear(&changes->now);
  spore_spline_twist_clear(&changes->twist);
  spore_free(changes->lengths);
  spore_free(changes->turn);
  spore_free(changes->calm);
  spore_free(changes->work);
  spore_free(changes->halve);
  *changes = (SporeSplineChanges){0};
}

static void measure(SporeSplineChanges *changes) {
  SporeSplineLine *now = &changes->now;
  now->control_count = now->knots.span_count + 3;
  spore_spline_line_measure(now, changes->made, &changes->section, changes->lengths);
  if (changes->made_twist->span_count > 0)
    spore_spline_twist_measure(&changes->twist, changes->made_twist, now, changes->made, &changes->section);
}

void spore_spline_changes_undo(SporeSplineChanges *changes) {
  const SporeSplineLine *made = changes->made;
  SporeSplineLine *now = &changes->now;
  size_t spans = made->knots.span_count;
  for (size_t i = 0; i <= spans; i++) now->breaks[i] = spore_spline_break(made->knots, i);
  now->knots = (SporeSplineKnots){spans, now->breaks};
  memcpy(now->rest, made->rest, 3 * (spans + 3) * sizeof *now->rest);
  memset(changes->calm, 0, changes->most * sizeof *changes->calm);
  changes->insert_count = changes->drop = 0;
  changes->spent = false;
  measure(changes);
}

/* Control points x, three numbers each, with a knot in span more. */
static void insert_points(double *x, size_t count, size_t span, const double ratio[3]) {
  assert(span + 3 < count);
  memmove(x + 3 * (span + 4), x + 3 * (span + 3), 3 * (count - span - 3) * sizeof *x);
  for (size_t i = 3; i-- > 0;) {
    double *at = x + 3 * (span + 1 + i);
    for (int e = 0; e < 3; e++) at[e] = ratio[i] * at[e] + (1 - ratio[i]) * at[e - 3];
  }
}

static void insert_number(double *x, size_t count, size_t at, double number) {
  assert(at <= count);
  memmove(x + at + 1, x + at, (count - at) * sizeof *x);
  x[at] = number;
}

void spore_spline_line_lead(const SporeSplineLine *made, SporeSplineKnots knots, double *control, double *breaks) {
  size_t spans = made->knots.span_count;
  for (size_t i = 0; i <= spans; i++) breaks[i] = spore_spline_break(made->knots, i);
  memcpy(control, made->rest, 3 * (spans + 3) * sizeof *control);
  for (size_t i = 0; i < knots.span_count; i++) {
    double ratio[3], at = spore_spline_break(knots, i);
    if (breaks[i] == at) continue;
    spore_spline_insert((SporeSplineKnots){spans, breaks}, i - 1, at, ratio);
    insert_points(control, spans + 3, i - 1, ratio);
    insert_number(breaks, ++spans, i, at);
  }
}

/* Which of five control points are held that a knot inserted in a span makes of four. */
static void hold_five(const uint8_t four[4], uint8_t five[5]) {
  five[0] = four[0], five[4] = four[3];
  for (int i = 0; i < 3; i++) five[1 + i] = four[i] && four[i + 1];
}

/* Whether at least as many control points are held after the span is halved as before. */
static bool may_halve(const uint8_t *held, size_t span) {
  uint8_t five[5];
  int before = 0, after = 0;
  if (!held) return true;
  hold_five(held + span, five);
  for (int i = 0; i < 4; i++) before += held[span + i] != 0;
  for (int i = 0; i < 5; i++) after += five[i] != 0;
  return after >= before;
}

static bool is_twisted(const SporeSplineChanges *changes) { return changes->made_twist->span_count > 0; }

static bool is_made(const SporeSplineLine *made, double at) {
  return spore_spline_break(made->knots, spore_spline_span(made->knots, at)) == at;
}

/* The spans before and behind the knot are halves of one. */
static bool parts_halves(const SporeSplineChanges *changes, size_t knot) {
  assert(knot > 0 && knot < changes->now.knots.span_count);
  const SporeSplineKnots knots = changes->now.knots;
  double width = spore_spline_width(knots, knot), at = spore_spline_break(knots, knot);
  if (width != spore_spline_width(knots, knot - 1) || is_made(changes->made, at)) return false;
  return fmod(spore_spline_break(knots, knot - 1), 2 * width) == 0;
}

/* The two control points, in `two`, that take the place of three about the knot. Returns the greatest distance by which
 * one of the three would be moved; the line moves by no more. */
static double merge_points(const double *x, size_t span, const double ratio[3], double two[6]) {
  const double *p = x + 3 * span;
  double a = ratio[0], b = 1 - ratio[1], c = ratio[1], d = 1 - ratio[2], apart[3] = {0};
  double aa = a * a + b * b, ab = b * c, bb = c * c + d * d, determinant = aa * bb - ab * ab;
  for (int e = 0; e < 3; e++) {
    double first = p[3 + e] - (1 - a) * p[e], last = p[9 + e] - ratio[2] * p[12 + e], middle = p[6 + e];
    double f = a * first + b * middle, g = c * middle + d * last;
    two[e] = (bb * f - ab * g) / determinant;
    two[3 + e] = (aa * g - ab * f) / determinant;
    apart[0] += pow(first - a * two[e], 2);
    apart[1] += pow(middle - b * two[e] - c * two[3 + e], 2);
    apart[2] += pow(last - d * two[3 + e], 2);
  }
  return sqrt(fmax(apart[0], fmax(apart[1], apart[2])));
}

/* The knots without one, in work. */
static SporeSplineKnots knots_without(SporeSplineChanges *changes, size_t knot) {
  assert(knot > 0 && knot < changes->now.knots.span_count);
  size_t spans = changes->now.knots.span_count;
  memcpy(changes->work, changes->now.breaks, knot * sizeof *changes->work);
  memcpy(changes->work + knot, changes->now.breaks + knot + 1, (spans - knot) * sizeof *changes->work);
  return (SporeSplineKnots){spans - 1, changes->work};
}

static bool may_drop(SporeSplineChanges *changes, const double *q, const uint8_t *held, size_t knot) {
  double ratio[3], two[6], at = changes->now.breaks[knot];
  for (size_t i = knot; held && i < knot + 3; i++)
    if (held[i]) return false;
  if (held && is_twisted(changes) && held[changes->now.control_count + knot]) return false;
  spore_spline_insert(knots_without(changes, knot), knot - 1, at, ratio);
  double radius = spore_spline_radius(&changes->made->course, changes->now.knots, at);
  return merge_points(q, knot - 1, ratio, two) <= SPORE_KNOTS_SLACK * radius;
}

/* The first knot that can be removed. Counts for each knot how long its two spans have been straight. */
static size_t find_drop(SporeSplineChanges *changes, double h, const double *q, const uint8_t *held) {
  size_t drop = 0;
  for (size_t knot = 1; knot < changes->now.knots.span_count; knot++) {
    bool calm = changes->turn[knot - 1] + changes->turn[knot] < STRAIGHT * changes->most_bend;
    changes->calm[knot] = calm ? changes->calm[knot] + h : 0;
    if (drop == 0 && changes->calm[knot] >= SPORE_KNOTS_CALM && parts_halves(changes, knot) &&
        may_drop(changes, q, held, knot))
      drop = knot;
  }
  return drop;
}

/* The spans that turn most, as many as there is room for. */
static void choose_halves(SporeSplineChanges *changes, const uint8_t *held) {
  size_t spans = changes->now.knots.span_count;
  changes->insert_count = 0;
  changes->spent = false;
  memset(changes->halve, 0, spans);
  for (;;) {
    size_t most = spans;
    for (size_t span = 0; span < spans; span++) {
      bool asks = changes->turn[span] > changes->most_bend && !changes->halve[span];
      if (!asks || spore_spline_width(changes->now.knots, span) <= SPORE_SPLINE_NARROWEST) continue;
      if (may_halve(held, span) && (most == spans || changes->turn[span] > changes->turn[most])) most = span;
    }
    if (most == spans) return;
    changes->spent = changes->now.control_count + changes->insert_count == changes->most;
    if (changes->spent) return;
    changes->halve[most] = 1;
    changes->insert_count++;
  }
}

static SporeVec3 combine(const double *x, const double weight[4][SPORE_LANES], size_t lane) {
  SporeVec3 sum = {0, 0, 0};
  for (size_t k = 0; k < 4; k++) sum = spore_vec3_add_scaled(sum, weight[k][lane], spore_vec3_load(x + 3 * k));
  return sum;
}

/* By how much a span turns, rad, by its Gauss points. */
static double turn_of(const SporeSplineChanges *changes, const double *q, size_t span) {
  assert(span < changes->now.knots.span_count);
  double turn = 0;
  for (size_t point = 0; point < SPORE_SPLINE_POINTS; point++) {
    const SporeSplineGauss *gauss = &changes->now.spline.gauss[span / SPORE_LANES * SPORE_SPLINE_POINTS + point];
    SporeVec3 a = combine(q + 3 * span, gauss->first, span % SPORE_LANES);
    SporeVec3 b = combine(q + 3 * span, gauss->second, span % SPORE_LANES), across = spore_vec3_cross(a, b);
    turn += changes->lengths[SPORE_SPLINE_POINTS * span + point] * spore_vec3_length(across) /
            fmax(spore_vec3_dot(a, a), 1e-300);
  }
  return turn;
}

bool spore_spline_changes_weigh(SporeSplineChanges *changes, double h, const double *q, const uint8_t *held) {
  assert(changes->made);
  assert(h >= 0);
  bool bends = false;
  for (size_t span = 0; span < changes->now.knots.span_count; span++) {
    changes->turn[span] = turn_of(changes, q, span);
    bends |= changes->turn[span] > changes->most_bend;
  }
  changes->insert_count = 0;
  changes->spent = false;
  if (bends) choose_halves(changes, held);
  changes->drop = changes->now.knots.span_count > changes->made->knots.span_count ? find_drop(changes, h, q, held) : 0;
  if (changes->insert_count > 0) changes->drop = 0; /* one thing at a time */
  return changes->insert_count > 0 || changes->drop > 0;
}

/* Makes room for an arm among the arms, which lie behind the control points; or, below, takes an arm out. The number of
 * control points changes by one at the same time. */
static void open_arms(void *nodes, size_t size, size_t spans, size_t arm) {
  uint8_t *arms = (uint8_t *)nodes + (spans + 3) * size;
  memmove(arms + (arm + 2) * size, arms + arm * size, (spans + 1 - arm) * size);
  memmove(arms + size, arms, arm * size);
}

static void close_arms(void *nodes, size_t size, size_t spans, size_t arm) {
  uint8_t *arms = (uint8_t *)nodes + (spans + 3) * size;
  memmove(arms - size, arms, arm * size);
  memmove(arms + (arm - 1) * size, arms + (arm + 1) * size, (spans - arm) * size);
}

static void hold_halves(uint8_t *held, size_t spans, size_t span, bool twisted) {
  uint8_t five[5];
  const uint8_t *arms = held + spans + 3;
  hold_five(held + span, five);
  uint8_t arm = twisted && arms[span] && arms[span + 1] && five[1] && five[2] && five[3];
  if (twisted) open_arms(held, 1, spans, span + 1);
  memmove(held + span + 5, held + span + 4, spans - span - 1);
  memcpy(held + span, five, sizeof five);
  if (twisted) held[spans + 4 + span + 1] = arm;
}

static void halve(SporeSplineChanges *changes, size_t span, double *q, double *v, uint8_t *held) {
  SporeSplineLine *now = &changes->now;
  double ratio[3], at = now->breaks[span] + 0.5 * spore_spline_width(now->knots, span), arm_q[3], arm_v[3];
  size_t spans = now->knots.span_count, arm = 3 * (spans + 4 + span + 1), node = 3 * sizeof *q;
  spore_spline_insert(now->knots, span, at, ratio);
  if (is_twisted(changes)) {
    spore_spline_twist_insert(&changes->twist, now->knots, span, at, q, v, arm_q, arm_v);
    open_arms(q, node, spans, span + 1), open_arms(v, node, spans, span + 1);
    memcpy(q + arm, arm_q, node), memcpy(v + arm, arm_v, node);
  }
  insert_points(q, spans + 3, span, ratio), insert_points(v, spans + 3, span, ratio);
  if (held) hold_halves(held, spans, span, is_twisted(changes));
  insert_number(now->breaks, spans + 1, span + 1, at);
  insert_number(changes->calm, spans + 1, span + 1, 0);
  now->knots.span_count++;
}

static void merge(double *x, size_t count, size_t span, const double ratio[3]) {
  double two[6];
  merge_points(x, span, ratio, two);
  memcpy(x + 3 * (span + 1), two, sizeof two);
  memmove(x + 3 * (span + 3), x + 3 * (span + 4), 3 * (count - span - 4) * sizeof *x);
}

static void drop(SporeSplineChanges *changes, double *q, double *v, uint8_t *held) {
  SporeSplineLine *now = &changes->now;
  size_t knot = changes->drop, spans = now->knots.span_count, node = 3 * sizeof *q;
  bool twisted = is_twisted(changes);
  double ratio[3];
  spore_spline_insert(knots_without(changes, knot), knot - 1, now->breaks[knot], ratio);
  merge(q, spans + 3, knot - 1, ratio), merge(v, spans + 3, knot - 1, ratio);
  if (twisted) close_arms(q, node, spans, knot), close_arms(v, node, spans, knot);
  if (held) memmove(held + knot, held + knot + 1, spans + 2 - knot);
  if (held && twisted) close_arms(held, 1, spans, knot);
  memmove(now->breaks + knot, now->breaks + knot + 1, (spans - knot) * sizeof *now->breaks);
  memmove(changes->calm + knot, changes->calm + knot + 1, (spans - knot) * sizeof *changes->calm);
  now->knots.span_count--;
}

void spore_spline_changes_make(SporeSplineChanges *changes, double *q, double *v, uint8_t *held) {
  for (size_t span = changes->now.knots.span_count; changes->insert_count > 0 && span-- > 0;)
    if (changes->halve[span]) halve(changes, span, q, v, held);
  if (changes->drop > 0) drop(changes, q, v, held);
  changes->insert_count = changes->drop = 0;
  spore_spline_line_lead(changes->made, changes->now.knots, changes->now.rest, changes->work);
  measure(changes);
}
