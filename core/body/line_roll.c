/* Roll of the frames along a line: at the stations, its rate, and the forces by it. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/body/line_frames.h"

#define SHORT 1e-150 /* length of a vector without direction */

static const SporeVec3 none = {0, 0, 0};

/* Turn of the body as a whole, and the parts of its derivative. */
typedef struct Turn {
  SporeMat3 rotation, inverse; /* inverse of tr(S) 1 - S, where rotation S is the fitted moment */
  SporeVec3 direction, bend;   /* present direction of a straight line; bend from its direction at rest */
  double along;                /* 1 / length of the vector with this direction */
} Turn;

static SporeMat3 least_turn(SporeVec3 from, SporeVec3 to) {
  SporeVec3 normal = spore_vec3_any_across(from), turned = spore_vec3_transport(normal, from, to);
  SporeMat3 before = spore_mat3_from_columns(from, normal, spore_vec3_cross(from, normal));
  SporeMat3 after = spore_mat3_from_columns(to, turned, spore_vec3_cross(to, turned));
  return spore_mat3_multiply(after, spore_mat3_transpose(before));
}

/* Least squares: sum of length x X^T = rotation S. */
static void fit(const SporeLineFrames *frames, Turn *turn) {
  SporeMat3 moment = {{0}}, stretch;
  for (size_t k = 0; k < frames->station_count; k++) {
    const SporeLineStation *station = &frames->stations[k];
    moment = spore_mat3_add(
        moment, spore_mat3_outer(spore_vec3_scale(station->length, frames->frames[k].position), station->place));
  }
  spore_mat3_polar(moment, &turn->rotation, &stretch);
  double trace = spore_mat3_trace(stretch), least = 1e-9 * fabs(trace) + SHORT;
  SporeMat3 square = spore_mat3_sub(spore_mat3_diagonal(trace, trace, trace), stretch);
  if (!spore_mat3_invert(square, &turn->inverse))
    spore_mat3_invert(spore_mat3_add(square, spore_mat3_diagonal(least, least, least)), &turn->inverse);
}

/* Direction of the line, as sum of length (X . chord) x. */
static void follow_chord(const SporeLineFrames *frames, Turn *turn) {
  SporeVec3 sum = none;
  for (size_t k = 0; k < frames->station_count; k++) {
    const SporeLineStation *station = &frames->stations[k];
    sum = spore_vec3_add_scaled(sum, station->length * spore_vec3_dot(station->place, frames->chord),
                                frames->frames[k].position);
  }
  turn->along = 1 / fmax(spore_vec3_length(sum), SHORT);
  turn->direction = spore_vec3_normalise(sum, frames->chord);
  turn->bend = spore_line_bend(frames->chord, turn->direction);
  turn->rotation = least_turn(frames->chord, turn->direction);
}

static Turn turn_at(const SporeLineFrames *frames, const double *q) {
  assert(q);
  Turn turn = {.rotation = spore_mat3_identity()};
  if (frames->rooted) turn.rotation = spore_quat_to_mat3(spore_quat_load(q + frames->quaternion));
  else if (frames->straight) follow_chord(frames, &turn);
  else fit(frames, &turn);
  return turn;
}

/* Rate of the turn, rad/s. */
static SporeVec3 turn_rate(const SporeLineFrames *frames, const Turn *turn, const double *v) {
  if (frames->rooted) return spore_vec3_load(v + 3 * (frames->root + 1));
  SporeVec3 sum = none;
  for (size_t k = 0; k < frames->station_count; k++) {
    const SporeLineStation *station = &frames->stations[k];
    SporeVec3 speed = spore_vec3_scale(station->length, spore_line_sum(&station->row.value, v));
    if (frames->straight) {
      sum = spore_vec3_add_scaled(sum, spore_vec3_dot(station->place, frames->chord), speed);
    } else {
      SporeVec3 back = spore_mat3_apply(spore_mat3_transpose(turn->rotation), speed);
      sum = spore_vec3_add(sum, spore_vec3_cross(station->place, back));
    }
  }
  if (!frames->straight) return spore_mat3_apply(turn->rotation, spore_mat3_apply(turn->inverse, sum));
  SporeVec3 swing = spore_vec3_scale(turn->along, spore_line_across(sum, turn->direction));
  return spore_vec3_add_scaled(spore_vec3_cross(turn->direction, swing), -spore_vec3_dot(turn->bend, swing),
                               turn->direction);
}

/* The transpose: a torque on the turn, as forces. */
static void turn_pull(const SporeLineFrames *frames, const Turn *turn, SporeVec3 torque, double *f) {
  if (frames->rooted) {
    spore_vec3_accumulate(f + 3 * (frames->root + 1), torque);
    return;
  }
  SporeVec3 swing = spore_vec3_add_scaled(spore_vec3_cross(torque, turn->direction),
                                          -spore_vec3_dot(torque, turn->direction), turn->bend);
  swing = spore_vec3_scale(turn->along, spore_line_across(swing, turn->direction));
  SporeVec3 fitted = spore_mat3_apply(turn->inverse, spore_mat3_apply(spore_mat3_transpose(turn->rotation), torque));
  for (size_t k = 0; k < frames->station_count; k++) {
    const SporeLineStation *station = &frames->stations[k];
    SporeVec3 force = frames->straight ? spore_vec3_scale(spore_vec3_dot(station->place, frames->chord), swing)
                                       : spore_mat3_apply(turn->rotation, spore_vec3_cross(fitted, station->place));
    spore_line_spread(&station->row.value, spore_vec3_scale(station->length, force), f);
  }
}

static void place_stations(const SporeLineFrames *frames, const double *q) {
  SporeVec3 axis = spore_vec3(1, 0, 0);
  for (size_t k = 0; k < frames->station_count; k++) {
    const SporeLineRow *row = &frames->stations[k].row;
    SporeLineFrame *frame = &frames->frames[k];
    SporeVec3 slope = spore_line_chord(row, q);
    frame->position = spore_line_sum(&row->value, q);
    frame->inverse = 1 / fmax(spore_vec3_length(slope), SHORT);
    frame->tangent = axis = spore_vec3_normalise(slope, axis);
  }
  for (size_t k = 0; k + 1 < frames->station_count; k++)
    frames->frames[k].bend = spore_line_bend(frames->frames[k].tangent, frames->frames[k + 1].tangent);
}

static void follow_arms(const SporeLineFrames *frames, const double *q) {
  for (size_t k = 0; k < frames->station_count; k++) {
    SporeLineFrame *frame = &frames->frames[k];
    frame->arm = spore_vec3_sub(spore_vec3_load(q + 3 * frames->stations[k].arm), frame->position);
    SporeVec3 flat =
        spore_vec3_normalise(spore_line_across(frame->arm, frame->tangent), spore_vec3_any_across(frame->tangent));
    SporeVec3 side = spore_vec3_cross(frame->tangent, flat);
    double angle = frames->stations[k].angle;
    frame->normal = spore_vec3_add_scaled(spore_vec3_scale(cos(angle), flat), sin(angle), side);
  }
}

/* The normal at rest, turned with the body and then by the least turn of its tangent, times `near`. It is smooth even
 * where the least turn is not unique, since `near` is 0 there. */
static SporeVec3 drawn_to(const SporeLineStation *station, const SporeMat3 *rotation, SporeLineFrame *frame) {
  SporeVec3 normal = spore_mat3_apply(*rotation, station->normal);
  frame->source = spore_mat3_apply(*rotation, station->tangent);
  SporeVec3 axis = spore_vec3_cross(frame->source, frame->tangent);
  double cosine = spore_vec3_dot(frame->source, frame->tangent);
  frame->near = fmax(0.5 * (1 + cosine), 0);
  SporeVec3 turned = spore_vec3_add(spore_vec3_scale(cosine, normal), spore_vec3_cross(axis, normal));
  return spore_vec3_add_scaled(spore_vec3_scale(frame->near, turned), 0.5 * spore_vec3_dot(axis, normal), axis);
}

/* Solves the system of the rolls, with `system` as right-hand side and solution. */
static void solve(const SporeLineFrames *frames) {
  double *x = frames->system;
  const SporeLineStation *stations = frames->stations;
  for (size_t k = 1; k < frames->station_count; k++)
    for (size_t c = 0; c < 2; c++)
      x[2 * k + c] += stations[k - 1].coupling / stations[k - 1].pivot * x[2 * (k - 1) + c];
  for (size_t k = frames->station_count; k-- > 0;)
    for (size_t c = 0; c < 2; c++) {
      if (k + 1 < frames->station_count) x[2 * k + c] += stations[k].coupling * x[2 * (k + 1) + c];
      x[2 * k + c] /= stations[k].pivot;
    }
}

static void settle_rolls(const SporeLineFrames *frames, const double *q) {
  Turn turn = turn_at(frames, q);
  for (size_t k = 0; k < frames->station_count; k++) {
    const SporeLineStation *station = &frames->stations[k];
    SporeLineFrame *frame = &frames->frames[k];
    SporeVec3 drawn = drawn_to(station, &turn.rotation, frame);
    if (k == 0) frame->reference = spore_vec3_normalise(drawn, spore_vec3_any_across(frame->tangent));
    else frame->reference = spore_vec3_transport(frame[-1].reference, frame[-1].tangent, frame->tangent);
    frame->anchor[0] = spore_vec3_dot(drawn, frame->reference);
    frame->anchor[1] = spore_vec3_dot(drawn, spore_vec3_cross(frame->tangent, frame->reference));
    for (size_t c = 0; c < 2; c++) frames->system[2 * k + c] = station->weight * frame->anchor[c];
  }
  solve(frames);
  for (size_t k = 0; k < frames->station_count; k++) {
    SporeLineFrame *frame = &frames->frames[k];
    double size = hypot(frames->system[2 * k], frames->system[2 * k + 1]);
    frame->roll[0] = size > SHORT ? frames->system[2 * k] : 1;
    frame->roll[1] = size > SHORT ? frames->system[2 * k + 1] : 0;
    size = size > SHORT ? size : 1;
    SporeVec3 side = spore_vec3_cross(frame->tangent, frame->reference);
    frame->normal =
        spore_vec3_add_scaled(spore_vec3_scale(frame->roll[0] / size, frame->reference), frame->roll[1] / size, side);
  }
}

void spore_line_roll_place(const SporeLineFrames *frames, const double *q) {
  assert(frames->station_count >= 2 && q);
  place_stations(frames, q);
  if (frames->arms) follow_arms(frames, q);
  else settle_rolls(frames, q);
  for (size_t k = 0; k + 1 < frames->station_count; k++) {
    SporeLineFrame *frame = &frames->frames[k], *next = frame + 1;
    SporeVec3 carried = spore_vec3_transport(frame->normal, frame->tangent, next->tangent);
    frame->twist = atan2(spore_vec3_dot(next->normal, spore_vec3_cross(next->tangent, carried)),
                         spore_vec3_dot(next->normal, carried));
  }
}

/* Roll of an arm's direction for a motion of its end. */
static SporeVec3 roll_of_arm(const SporeLineFrame *frame) {
  SporeVec3 flat = spore_line_across(frame->arm, frame->tangent);
  return spore_vec3_scale(1 / fmax(spore_vec3_dot(flat, flat), SHORT), spore_vec3_cross(frame->tangent, frame->arm));
}

static SporeVec3 rate_of(const SporeLineFrames *frames, size_t k) {
  assert(k < frames->station_count);
  return spore_vec3_load(frames->tangent_rate + 3 * k);
}

static void rate_of_arms(const SporeLineFrames *frames, const double *v) {
  for (size_t k = 0; k < frames->station_count; k++) {
    const SporeLineRow *row = &frames->stations[k].row;
    const SporeLineFrame *frame = &frames->frames[k];
    SporeVec3 turn = roll_of_arm(frame), end = spore_vec3_load(v + 3 * frames->stations[k].arm);
    SporeVec3 speed = spore_vec3_sub(end, spore_line_sum(&row->value, v));
    double lean = spore_vec3_dot(frame->arm, frame->tangent);
    frames->roll_rate[k] = spore_vec3_dot(turn, speed) - lean * spore_vec3_dot(turn, rate_of(frames, k));
  }
}

/* Direction of the anchor of a station, seen from the reference. */
static void direction_of(const SporeLineFrame *frame, double direction[2]) {
  double size = hypot(frame->anchor[0], frame->anchor[1]);
  direction[0] = size > SHORT ? frame->anchor[0] / size : 1;
  direction[1] = size > SHORT ? frame->anchor[1] / size : 0;
}

/* With a the anchor, of size `near` and angle phi: a' = near' exp(i phi) + near phi' i exp(i phi). */
static void rate_of_rolls(const SporeLineFrames *frames, const double *q, const double *v) {
  Turn turn = turn_at(frames, q);
  SporeVec3 spin = turn_rate(frames, &turn, v), before = none;
  double carried = 0; /* roll rate of the reference */
  for (size_t k = 0; k < frames->station_count; k++) {
    const SporeLineFrame *frame = &frames->frames[k];
    SporeVec3 rate = rate_of(frames, k), axis = spore_vec3_cross(frame->source, frame->tangent);
    SporeVec3 swing = spore_vec3_cross(spin, frame->source);
    if (k > 0) carried -= spore_vec3_dot(frame[-1].bend, spore_vec3_add(before, rate));
    double nearing = 0.5 * (spore_vec3_dot(swing, frame->tangent) + spore_vec3_dot(frame->source, rate));
    double rolling = frame->near * (spore_vec3_dot(spin, frame->source) - carried) -
                     0.5 * spore_vec3_dot(axis, spore_vec3_add(swing, rate));
    double at[2], weight = frames->stations[k].weight;
    direction_of(frame, at);
    frames->system[2 * k] = weight * (nearing * at[0] - rolling * at[1]);
    frames->system[2 * k + 1] = weight * (nearing * at[1] + rolling * at[0]);
    frames->roll_rate[k] = carried;
    before = rate;
  }
  solve(frames);
  for (size_t k = 0; k < frames->station_count; k++) {
    const double *z = frames->frames[k].roll, *rate = frames->system + 2 * k;
    frames->roll_rate[k] += (z[0] * rate[1] - z[1] * rate[0]) / (z[0] * z[0] + z[1] * z[1]);
  }
}

void spore_line_roll_rate(const SporeLineFrames *frames, const double *q, const double *v) {
  assert(q && v);
  for (size_t k = 0; k < frames->station_count; k++) {
    const SporeLineRow *row = &frames->stations[k].row;
    const SporeLineFrame *frame = &frames->frames[k];
    SporeVec3 speed = spore_line_across(spore_line_chord(row, v), frame->tangent);
    spore_vec3_store(frames->tangent_rate + 3 * k, spore_vec3_scale(frame->inverse, speed));
  }
  if (frames->arms) rate_of_arms(frames, v);
  else rate_of_rolls(frames, q, v);
}

static void pull_arms(const SporeLineFrames *frames, double *f) {
  for (size_t k = 0; k < frames->station_count; k++) {
    const SporeLineRow *row = &frames->stations[k].row;
    const SporeLineFrame *frame = &frames->frames[k];
    SporeVec3 turn = spore_vec3_scale(frames->roll_rate[k], roll_of_arm(frame));
    spore_vec3_accumulate(f + 3 * frames->stations[k].arm, turn);
    spore_line_spread(&row->value, spore_vec3_scale(-1, turn), f);
    spore_vec3_accumulate(frames->tangent_rate + 3 * k,
                          spore_vec3_scale(-spore_vec3_dot(frame->arm, frame->tangent), turn));
  }
}

/* Transpose of rate_of_rolls for station k, from the part of a' in `system`. Returns the torque on the turn. */
static SporeVec3 pull_anchor(const SporeLineFrames *frames, size_t k) {
  assert(k < frames->station_count);
  const SporeLineFrame *frame = &frames->frames[k];
  double at[2], weight = frames->stations[k].weight, *to = frames->system + 2 * k;
  SporeVec3 axis = spore_vec3_cross(frame->source, frame->tangent);
  direction_of(frame, at);
  double nearing = 0.5 * weight * (to[0] * at[0] + to[1] * at[1]), rolling = weight * (to[1] * at[0] - to[0] * at[1]);
  frames->roll_rate[k] -= rolling * frame->near;
  SporeVec3 pull = spore_vec3_sub(spore_vec3_scale(nearing, frame->source), spore_vec3_scale(0.5 * rolling, axis));
  spore_vec3_accumulate(frames->tangent_rate + 3 * k, pull);
  SporeVec3 torque = spore_vec3_scale(nearing, axis);
  torque = spore_vec3_add_scaled(torque, rolling * frame->near, frame->source);
  return spore_vec3_add_scaled(torque, -0.5 * rolling, spore_vec3_cross(frame->source, axis));
}

static void pull_rolls(const SporeLineFrames *frames, const double *q, double *f) {
  Turn turn = turn_at(frames, q);
  SporeVec3 torque = none;
  for (size_t k = 0; k < frames->station_count; k++) {
    const double *z = frames->frames[k].roll;
    double pull = frames->roll_rate[k] / (z[0] * z[0] + z[1] * z[1]);
    frames->system[2 * k] = -pull * z[1];
    frames->system[2 * k + 1] = pull * z[0];
  }
  solve(frames);
  for (size_t k = 0; k < frames->station_count; k++) torque = spore_vec3_add(torque, pull_anchor(frames, k));
  for (size_t k = frames->station_count; k-- > 1;) {
    SporeVec3 turned = spore_vec3_scale(-frames->roll_rate[k], frames->frames[k - 1].bend);
    for (size_t both = 0; both < 2; both++) spore_vec3_accumulate(frames->tangent_rate + 3 * (k - both), turned);
    frames->roll_rate[k - 1] += frames->roll_rate[k];
  }
  turn_pull(frames, &turn, torque, f);
}

void spore_line_roll_pull(const SporeLineFrames *frames, const double *q, double *f) {
  assert(q && f);
  if (frames->arms) pull_arms(frames, f);
  else pull_rolls(frames, q, f);
  for (size_t k = 0; k < frames->station_count; k++) {
    const SporeLineRow *row = &frames->stations[k].row;
    const SporeLineFrame *frame = &frames->frames[k];
    SporeVec3 pull = spore_line_across(rate_of(frames, k), frame->tangent);
    spore_line_spread_chord(row, spore_vec3_scale(frame->inverse, pull), f);
  }
}
