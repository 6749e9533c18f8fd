/* Frames along a line: stations, and the sections of points that follow them. */
#include "core/body/line_frames.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/body/path.h"
#include "core/mesh/attach.h"

#define REACH 4.0         /* mean radii: length over which sections even out their roll */
#define SPREAD 2.5        /* radii: from a section to the ends of its chord */
#define SPREAD_LEAST 0.01 /* of the parameter: the same at an end of the line */
#define STRAIGHT 1e-6     /* moment across a straight line, of that along it */

void spore_line_frames_clear(SporeLineFrames *frames) {
  spore_free(frames->stations);
  spore_free(frames->points);
  spore_free(frames->frames);
  spore_free(frames->tangent_rate);
  spore_free(frames->roll_rate);
  spore_free(frames->system);
  *frames = (SporeLineFrames){0};
}

static SporeLineSum sum_at(SporeSplineKnots knots, double parameter) {
  SporeLineSum sum;
  SporeSplineBasis basis = spore_spline_basis(knots, parameter, &sum.first);
  memcpy(sum.weight, basis.value, sizeof sum.weight);
  return sum;
}

static SporeLineRow row_at(SporeSplineKnots knots, double parameter, double spread) {
  return (SporeLineRow){sum_at(knots, parameter), sum_at(knots, parameter + spread), sum_at(knots, parameter - spread)};
}

/* How far off the ends of the chord are, in the parameter: toward an end of the line as far as the end, so that the
 * sections there are square to it. */
static double spread_at(const SporeLine *line, double parameter) {
  size_t span = spore_spline_span(line->knots, parameter), low = SPORE_LINE_SAMPLES * span;
  double at = (parameter - spore_spline_break(line->knots, span)) / spore_spline_width(line->knots, span);
  double share = SPORE_LINE_SAMPLES * fmin(at, 1), end = spore_spline_end(line->knots);
  size_t before = (size_t)fmin(floor(share), SPORE_LINE_SAMPLES - 1);
  const double *radii = line->radius + low + before;
  double radius = radii[0] + (share - (double)before) * (radii[1] - radii[0]);
  double speed = spore_vec3_length(spore_path_at(line->knots, line->q, parameter).slope);
  double spread = SPREAD * radius / fmax(speed, 1e-150);
  return fmax(fmin(spread, fmin(parameter, end - parameter)), SPREAD_LEAST);
}

static bool allocate(SporeLineFrames *frames, size_t stations, size_t points) {
  assert(stations >= 2);
  frames->station_count = stations;
  frames->point_count = points;
  frames->stations = SPORE_NEW_ARRAY(SporeLineStation, stations);
  frames->points = SPORE_NEW_ARRAY(SporeLinePoint, points);
  frames->frames = SPORE_NEW_ARRAY(SporeLineFrame, stations);
  frames->tangent_rate = SPORE_NEW_ARRAY(double, 3 * stations);
  frames->roll_rate = SPORE_NEW_ARRAY(double, stations);
  frames->system = SPORE_NEW_ARRAY(double, 2 * stations);
  return frames->stations && frames->points && frames->frames && frames->tangent_rate && frames->roll_rate &&
         frames->system;
}

/* Sets lengths of the stations, and their places from the middle. Returns the length of the line. */
static double measure_stations(SporeLineFrames *frames, const SporeLine *line) {
  assert(line->q);
  SporeVec3 middle = {0, 0, 0};
  double whole = 0;
  for (size_t k = 0; k + 1 < frames->station_count; k++) {
    SporeLineStation *station = &frames->stations[k];
    double piece = spore_path_length(line->knots, line->q, station->parameter, station[1].parameter);
    station->coupling = 1 / fmax(piece, 1e-300);
    station->length += 0.5 * piece;
    station[1].length = 0.5 * piece;
    whole += piece;
  }
  for (size_t k = 0; k < frames->station_count; k++) {
    SporeLineStation *station = &frames->stations[k];
    station->place = spore_line_sum(&station->row.value, line->q);
    middle = spore_vec3_add_scaled(middle, station->length / whole, station->place);
  }
  for (size_t k = 0; k < frames->station_count; k++)
    frames->stations[k].place = spore_vec3_sub(frames->stations[k].place, middle);
  return whole;
}

/* Sets the normals at rest, carried along the line. Roll is counted from them. */
static void set_normals(SporeLineFrames *frames, const SporeLine *line) {
  SporeVec3 tangent = {1, 0, 0}, normal = {0, 1, 0};
  for (size_t k = 0; k < frames->station_count; k++) {
    SporeLineStation *station = &frames->stations[k];
    SporeVec3 next = spore_vec3_normalise(spore_line_chord(&station->row, line->q), tangent);
    normal = spore_vec3_transport(normal, tangent, next);
    station->tangent = tangent = next;
    station->normal = normal = spore_vec3_normalise(spore_line_across(normal, next), normal);
    if (!frames->arms) continue;
    SporeVec3 foot = spore_line_sum(&station->row.value, line->q);
    SporeVec3 arm = spore_line_across(spore_vec3_sub(spore_vec3_load(line->q + 3 * station->arm), foot), next);
    station->angle = atan2(spore_vec3_dot(normal, spore_vec3_cross(next, arm)), spore_vec3_dot(normal, arm));
  }
}

/* Finds whether the line is straight at rest, and its direction. */
static void find_chord(SporeLineFrames *frames) {
  SporeMat3 moment = {{0}}, axes;
  double value[3];
  for (size_t k = 0; k < frames->station_count; k++) {
    const SporeLineStation *station = &frames->stations[k];
    moment =
        spore_mat3_add(moment, spore_mat3_scale(station->length, spore_mat3_outer(station->place, station->place)));
  }
  spore_mat3_eigen_symmetric(moment, value, &axes);
  frames->straight = value[1] <= STRAIGHT * value[2];
  frames->chord = spore_mat3_column(axes, 2);
}

static void set_system(SporeLineFrames *frames, double reach) {
  assert(reach > 0);
  double excess = 0;
  for (size_t k = 0; k < frames->station_count; k++) {
    SporeLineStation *station = &frames->stations[k];
    station->weight = station->length / (reach * reach);
    excess += station->weight;
    station->pivot = excess + station->coupling; /* of the last station 0 */
    excess *= station->coupling / station->pivot;
  }
}

static double mean_radius(const SporeLine *line) {
  size_t count = SPORE_LINE_SAMPLES * line->knots.span_count + 1;
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += line->radius[i] / (double)count;
  return sum;
}

/* Sets the nodes of the stations, of arms and of the root, for these knots. */
static void lead(SporeLineFrames *frames, SporeSplineKnots knots) {
  size_t count = knots.span_count + 3;
  frames->root = count;
  frames->quaternion = 3 * (count + 1);
  for (size_t k = 0; k < frames->station_count; k++) {
    SporeLineStation *station = &frames->stations[k];
    bool end = station->parameter >= spore_spline_end(knots);
    station->row = row_at(knots, station->parameter, station->spread);
    station->arm = count + (end ? knots.span_count : spore_spline_span(knots, station->parameter));
  }
}

void spore_line_frames_follow(SporeLineFrames *frames, SporeSplineKnots knots) {
  assert(knots.span_count > 0);
  lead(frames, knots);
  for (size_t i = 0; i < frames->point_count; i++) {
    SporeLinePoint *point = &frames->points[i];
    point->row = row_at(knots, point->parameter, point->spread);
  }
}

static void set_stations(SporeLineFrames *frames, const SporeLine *line) {
  size_t parts = frames->arms ? 1 : 2;
  for (size_t k = 0; k < frames->station_count; k++) {
    frames->stations[k].parameter = spore_spline_part(line->knots, parts, k);
    frames->stations[k].spread = spread_at(line, frames->stations[k].parameter);
  }
  lead(frames, line->knots);
  measure_stations(frames, line);
  set_normals(frames, line);
  find_chord(frames);
  set_system(frames, REACH * mean_radius(line));
}

/* Frame of the line at a point, and its parts. */
typedef struct Section {
  SporeVec3 position, tangent, normal;
  double inverse;
  SporeVec3 bend; /* from the tangent of the station before */
} Section;

static Section section_at(const SporeLineFrames *frames, const SporeLinePoint *point, const double *q) {
  assert(point->station + 1 < frames->station_count);
  const SporeLineFrame *before = &frames->frames[point->station];
  SporeVec3 slope = spore_line_chord(&point->row, q);
  Section section = {.position = spore_line_sum(&point->row.value, q)};
  section.inverse = 1 / fmax(spore_vec3_length(slope), 1e-150);
  section.tangent = spore_vec3_normalise(slope, before->tangent);
  section.bend = spore_line_bend(before->tangent, section.tangent);
  SporeVec3 normal = spore_vec3_transport(before->normal, before->tangent, section.tangent);
  double angle = point->share * before->twist;
  section.normal = spore_vec3_add_scaled(spore_vec3_scale(cos(angle), normal), sin(angle),
                                         spore_vec3_cross(section.tangent, normal));
  return section;
}

static SporeVec3 arm_of(const SporeLinePoint *point, const Section *section) {
  SporeVec3 side = spore_vec3_cross(section->tangent, section->normal);
  SporeVec3 arm = spore_vec3_scale(point->place[0], section->tangent);
  arm = spore_vec3_add_scaled(arm, point->place[1], section->normal);
  return spore_vec3_add_scaled(arm, point->place[2], side);
}

/* Places of the line that vertices are attached to. */
static bool sample(const SporeLine *line, SporeCurve *samples, SporeError *error) {
  if (!spore_curve_allocate(samples, SPORE_LINE_SAMPLES * line->knots.span_count + 1, error)) return false;
  for (size_t i = 0; i < samples->count; i++) {
    double parameter = spore_spline_part(line->knots, SPORE_LINE_SAMPLES, i), *sample = samples->points + 4 * i;
    spore_vec3_store(sample, spore_path_at(line->knots, line->q, parameter).position);
    sample[3] = line->radius[i];
  }
  return true;
}

static void set_point(SporeLineFrames *frames, const SporeLine *line, uint32_t sample, SporeVec3 p,
                      SporeLinePoint *point) {
  assert(sample <= SPORE_LINE_SAMPLES * line->knots.span_count);
  double start = spore_spline_part(line->knots, SPORE_LINE_SAMPLES, sample);
  SporePathPlace place = spore_path_follow(line->knots, line->q, start, p);
  size_t low = 0, high = frames->station_count - 1;
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    *(frames->stations[middle].parameter <= place.parameter ? &low : &high) = middle;
  }
  double from = frames->stations[low].parameter;
  point->parameter = place.parameter;
  point->spread = spread_at(line, place.parameter);
  point->row = row_at(line->knots, place.parameter, point->spread);
  point->station = (uint32_t)low;
  point->share = (place.parameter - from) / (frames->stations[low + 1].parameter - from);
  Section section = section_at(frames, point, line->q);
  SporeVec3 off = spore_vec3_sub(p, section.position);
  point->place[0] = spore_vec3_dot(off, section.tangent);
  point->place[1] = spore_vec3_dot(off, section.normal);
  point->place[2] = spore_vec3_dot(off, spore_vec3_cross(section.tangent, section.normal));
  SporeVec3 ahead = spore_path_at(line->knots, line->q, place.parameter + point->spread).slope,
            behind = spore_path_at(line->knots, line->q, place.parameter - point->spread).slope;
  SporeVec3 turn = spore_line_across(spore_vec3_sub(ahead, behind), section.tangent);
  point->crowd =
      spore_vec3_length(turn) * section.inverse * spore_vec3_length(off) / fmax(spore_vec3_length(place.slope), 1e-150);
}

static bool no_memory(size_t count, SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for %zu points"), count);
}

static bool attach(SporeLineFrames *frames, const SporeLine *line, const SporeTriangleMesh *mesh, SporeError *error) {
  SporeCurve samples = {0};
  uint32_t *place = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count);
  bool made = sample(line, &samples, error);
  if (made && !(place && spore_curve_attach(&samples, mesh, place, &frames->torn)))
    made = no_memory(mesh->vertex_count, error);
  for (size_t i = 0; made && i < mesh->vertex_count; i++)
    set_point(frames, line, place[i], spore_vec3_load(mesh->vertices + 3 * i), &frames->points[i]);
  spore_curve_clear(&samples);
  spore_free(place);
  return made;
}

bool spore_line_frames_init(SporeLineFrames *frames, const SporeLine *line, const SporeTriangleMesh *mesh,
                            SporeError *error) {
  assert(line->knots.span_count > 0 && line->q && line->radius);
  size_t stations = (line->arms ? 1 : 2) * line->knots.span_count + 1;
  *frames = (SporeLineFrames){.arms = line->arms, .rooted = line->rooted};
  if (!allocate(frames, stations, mesh->vertex_count)) return no_memory(mesh->vertex_count, error);
  set_stations(frames, line);
  spore_line_roll_place(frames, line->q);
  return attach(frames, line, mesh, error);
}

static size_t first_of(size_t point) { return point == SPORE_LINE_ALL ? 0 : point; }
static size_t end_of(const SporeLineFrames *frames, size_t point) {
  assert(point == SPORE_LINE_ALL || point < frames->point_count);
  return point == SPORE_LINE_ALL ? frames->point_count : point + 1;
}

void spore_line_frames_positions(const SporeLineFrames *frames, size_t point, const double *q, double *positions) {
  spore_line_roll_place(frames, q);
  for (size_t i = first_of(point); i < end_of(frames, point); i++, positions += 3) {
    Section section = section_at(frames, &frames->points[i], q);
    spore_vec3_store(positions, spore_vec3_add(section.position, arm_of(&frames->points[i], &section)));
  }
}

/* The frame turns with its tangent. It rolls with the normal that is carried from the station before, and by its share
 * of the twist to the next station. */
void spore_line_frames_velocities(const SporeLineFrames *frames, size_t point, const double *q, const double *v,
                                  double *velocities) {
  spore_line_roll_place(frames, q);
  spore_line_roll_rate(frames, q, v);
  for (size_t i = first_of(point); i < end_of(frames, point); i++, velocities += 3) {
    const SporeLinePoint *its = &frames->points[i];
    const double *rates = frames->tangent_rate + 3 * its->station, *rolls = frames->roll_rate + its->station;
    Section section = section_at(frames, its, q);
    SporeVec3 before = spore_vec3_load(rates), next = spore_vec3_load(rates + 3);
    SporeVec3 rate = spore_line_across(spore_line_chord(&its->row, v), section.tangent);
    rate = spore_vec3_scale(section.inverse, rate);
    double twisting =
        rolls[1] - rolls[0] + spore_vec3_dot(frames->frames[its->station].bend, spore_vec3_add(before, next));
    double roll = rolls[0] - spore_vec3_dot(section.bend, spore_vec3_add(before, rate)) + its->share * twisting;
    SporeVec3 spin = spore_vec3_cross(section.tangent, rate);
    spin = spore_vec3_add_scaled(spin, roll, section.tangent);
    SporeVec3 speed = spore_line_sum(&its->row.value, v);
    spore_vec3_store(velocities, spore_vec3_add(speed, spore_vec3_cross(spin, arm_of(its, &section))));
  }
}

static void pull_point(const SporeLineFrames *frames, const SporeLinePoint *point, const double *q, SporeVec3 force,
                       double *f) {
  assert(f);
  Section section = section_at(frames, point, q);
  SporeVec3 torque = spore_vec3_cross(arm_of(point, &section), force);
  double roll = spore_vec3_dot(torque, section.tangent), *rates = frames->tangent_rate + 3 * point->station;
  SporeVec3 across = spore_vec3_cross(torque, section.tangent);
  SporeVec3 bend = spore_vec3_scale(roll, section.bend);
  SporeVec3 twist = spore_vec3_scale(roll * point->share, frames->frames[point->station].bend);
  SporeVec3 slope = spore_line_across(spore_vec3_sub(across, bend), section.tangent);
  frames->roll_rate[point->station] += (1 - point->share) * roll;
  frames->roll_rate[point->station + 1] += point->share * roll;
  spore_vec3_accumulate(rates, spore_vec3_sub(twist, bend));
  spore_vec3_accumulate(rates + 3, twist);
  spore_line_spread_chord(&point->row, spore_vec3_scale(section.inverse, slope), f);
  spore_line_spread(&point->row.value, force, f);
}

void spore_line_frames_add_forces(const SporeLineFrames *frames, size_t point, const double *q, const double *forces,
                                  double *f) {
  spore_line_roll_place(frames, q);
  memset(frames->tangent_rate, 0, 3 * frames->station_count * sizeof(double));
  memset(frames->roll_rate, 0, frames->station_count * sizeof(double));
  for (size_t i = first_of(point); i < end_of(frames, point); i++, forces += 3)
    pull_point(frames, &frames->points[i], q, spore_vec3_load(forces), f);
  spore_line_roll_pull(frames, q, f);
}

double spore_line_frames_crowd(const SporeLineFrames *frames, size_t *point, double *share) {
  assert(point && share);
  double most = 0;
  *point = 0;
  *share = 0;
  for (size_t i = 0; i < frames->point_count; i++) {
    if (frames->points[i].crowd > 1) *share += 1 / (double)frames->point_count;
    if (frames->points[i].crowd > most) most = frames->points[i].crowd, *point = i;
  }
  return most;
}
