/* A line made from a curve: control points, masses, stiffness, spheres. */
#include "models/spline/line.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/collide/grid.h"
#include "core/collide/near_pairs.h"
#include "core/base/text.h"

#define SAMPLES 16 /* a span, of the walk along the line that spaces spheres */

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a spline"));
}

void spore_spline_line_clear(SporeSplineLine *line) {
  spore_spline_clear(&line->spline);
  spore_spline_course_clear(&line->course);
  spore_sphere_set_clear(&line->spheres);
  spore_free(line->breaks);
  spore_free(line->rest);
  spore_free(line->radius);
  spore_free(line->mass);
  spore_free(line->length);
  spore_free(line->weights);
  *line = (SporeSplineLine){0};
}

static SporeVec3 combine(const double *control, size_t span, const double weight[4]) {
  SporeVec3 sum = {0, 0, 0};
  for (size_t k = 0; k < 4; k++) sum = spore_vec3_add_scaled(sum, weight[k], spore_vec3_load(control + 3 * (span + k)));
  return sum;
}

double spore_spline_section_radius(const SporeSplineCourse *course, const SporeSplineSection *section,
                                   SporeSplineKnots knots, double parameter, double *inner) {
  double outer = spore_spline_radius(course, knots, parameter);
  *inner = section->wall_thickness > 0 ? fmax(outer - section->wall_thickness, 0) : 0;
  return outer;
}

/* One Gauss point, with derivatives by the length at rest: d/dS = 1/l d/du, d2/dS2 = 1/l^2 (d2/du2 - l'/l d/du).
 * Returns the length l for which it stands; 0 where the line turns back. */
static double set_point(SporeSplineLine *line, const SporeSplineCourse *course, const SporeSplineSection *section,
                        size_t span, int point) {
  assert(span < line->knots.span_count && point >= 0 && point < SPORE_SPLINE_POINTS);
  SporeSpline *spline = &line->spline;
  double u = spore_spline_gauss_parameter(line->knots, span, point), width = spore_spline_width(line->knots, span);
  SporeSplineBasis basis = spore_spline_basis(line->knots, u, &span);
  SporeVec3 slope = combine(line->rest, span, basis.first), bend = combine(line->rest, span, basis.second);
  double speed = spore_vec3_length(slope), inverse = 1 / speed;
  double change = spore_vec3_dot(slope, bend) * inverse * inverse;
  if (!(speed > 0)) return 0;
  SporeSplineGauss *gauss = &spline->gauss[span / SPORE_LANES * SPORE_SPLINE_POINTS + (size_t)point];
  size_t lane = span % SPORE_LANES;
  double inner, outer = spore_spline_section_radius(course, section, line->knots, u, &inner);
  double length = width * speed / SPORE_SPLINE_POINTS;
  double second[4], area = M_PI * (outer * outer - inner * inner), lumen = M_PI * inner * inner;
  for (size_t k = 0; k < 4; k++) {
    gauss->first[k][lane] = inverse * basis.first[k];
    gauss->second[k][lane] = second[k] = inverse * inverse * (basis.second[k] - change * basis.first[k]);
  }
  if (line->weights) {
    line->weights[span].length[point] = speed;
    line->weights[span].polar[point] = section->density * 0.5 * M_PI * (pow(outer, 4) - pow(inner, 4)) * speed;
    line->weights[span].mass[point] = (section->density * area + section->content_density * lumen) * speed;
  }
  SporeVec3 curvature = combine(line->rest, span, second);
  gauss->area[lane] = area * length;
  gauss->inertia[lane] = 0.25 * area * (outer * outer + inner * inner) * length;
  gauss->rest[lane] = section->straight_at_rest ? 0 : spore_vec3_dot(curvature, curvature);
  return length;
}

/* Sets the rest curvature of points to 0 that are straight but for rounding. */
static void straighten(SporeSpline *spline) {
  for (size_t i = 0; i < SPORE_SPLINE_POINTS * spline->group_count; i++)
    for (size_t lane = 0; lane < SPORE_LANES; lane++)
      if (spline->gauss[i].rest[lane] < 1e-10 * spline->straight) spline->gauss[i].rest[lane] = 0;
}

/* Between two Gauss points and beyond them, nowhere below 0; `part` of the span. */
static double between(const double at[SPORE_SPLINE_POINTS], double part) {
  double mean = 0.5 * (at[0] + at[1]), rise = sqrt(3) * (at[1] - at[0]);
  return mean + fmin(fmax(rise, -2 * mean), 2 * mean) * (part - 0.5);
}

double spore_spline_line_polar(const SporeSplineLine *line, const SporeSplineLine *made, size_t span) {
  assert(span < line->knots.span_count);
  assert(made->weights);
  double width = spore_spline_width(line->knots, span), middle = spore_spline_break(line->knots, span) + 0.5 * width;
  size_t of = spore_spline_span(made->knots, middle);
  double part = (middle - spore_spline_break(made->knots, of)) / spore_spline_width(made->knots, of);
  return width * between(made->weights[of].polar, part);
}

/* Gauss' rule of three points is exact for a linear weight times a cubic. So the integrals for one set of knots agree
 * exactly with those for a set of knots that contains it. */
static void weigh(SporeSplineLine *line, const SporeSplineLine *made) {
  static const double share[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  memset(line->mass, 0, line->control_count * sizeof *line->mass);
  memset(line->length, 0, line->control_count * sizeof *line->length);
  for (size_t span = 0, of = 0; span < line->knots.span_count; span++) {
    double from = spore_spline_break(line->knots, span), width = spore_spline_width(line->knots, span);
    while (spore_spline_break(made->knots, of + 1) <= from) of++;
    for (int g = 0; g < 3; g++) {
      size_t at;
      double u = from + (0.5 + 0.5 * sqrt(0.6) * (g - 1)) * width;
      double part = (u - spore_spline_break(made->knots, of)) / spore_spline_width(made->knots, of);
      SporeSplineBasis basis = spore_spline_basis(line->knots, u, &at);
      double mass = share[g] * width * between(made->weights[of].mass, part);
      double length = share[g] * width * between(made->weights[of].length, part);
      for (size_t k = 0; k < 4; k++) line->mass[at + k] += mass * basis.value[k];
      for (size_t k = 0; k < 4; k++) line->length[at + k] += length * basis.value[k];
    }
  }
}

void spore_spline_line_measure(SporeSplineLine *line, const SporeSplineLine *made, const SporeSplineSection *section,
                               double *lengths) {
  assert(line->knots.span_count > 0 && made->weights);
  SporeSpline *spline = &line->spline;
  spline->span_count = line->knots.span_count;
  spline->group_count = (spline->span_count + SPORE_LANES - 1) / SPORE_LANES;
  spline->straight = made->spline.straight;
  memset(spline->gauss, 0, SPORE_SPLINE_POINTS * spline->group_count * sizeof *spline->gauss);
  for (size_t span = 0; span < spline->span_count; span++)
    for (int point = 0; point < SPORE_SPLINE_POINTS; point++)
      lengths[SPORE_SPLINE_POINTS * span + (size_t)point] = set_point(line, &made->course, section, span, point);
  straighten(spline);
  weigh(line, made);
}

static bool set_points(SporeSplineLine *line, const SporeSplineSection *section, SporeError *error) {
  SporeSpline *spline = &line->spline;
  double whole = 0, shortest = 1e-6 * spore_spline_course_length(&line->course) / spore_spline_end(line->knots);
  for (size_t span = 0; span < spline->span_count; span++)
    for (int point = 0; point < SPORE_SPLINE_POINTS; point++) {
      double length = set_point(line, &line->course, section, span, point);
      whole += length;
      if (length > shortest * spore_spline_width(line->knots, span)) continue;
      char place[64];
      snprintf(place, sizeof place, "control point %zu", span);
      return spore_error_set(error, SPORE_ERROR_INPUT, place,
                             _("the curve turns back on itself here, and the spline has no direction; a smooth curve "
                               "was expected; smooth it or set another number of control points"));
    }
  spline->straight = 1e-2 / (whole * whole);
  straighten(spline);
  weigh(line, line);
  return true;
}

/* How many radii long the line is over one sample. */
static double radii_of_sample(const SporeSplineLine *line, size_t sample) {
  size_t span;
  double u = ((double)sample + 0.5) / SAMPLES;
  SporeSplineBasis basis = spore_spline_basis(line->knots, u, &span);
  return spore_vec3_length(combine(line->rest, span, basis.first)) / SAMPLES /
         spore_spline_radius(&line->course, line->knots, u);
}

static void set_sphere(const SporeSplineLine *line, double u, double *sphere) {
  size_t span;
  SporeSplineBasis basis = spore_spline_basis(line->knots, u, &span);
  spore_vec3_store(sphere, combine(line->rest, span, basis.value));
  sphere[3] = spore_spline_radius(&line->course, line->knots, u);
}

/* Loops that lie against each other. A body may ask that its spheres meet each other; those that touch at rest never
 * do (SPORE_GRID_SELF_MARGIN), so that neighbours along a line do not push each other. So spheres of different loops
 * are made so much smaller that they do not touch. Loops that lie deep in each other are left alone: their curve is
 * wrong, and a run says so (core/measure/loops.h). */

#define DEEP 0.5 /* of a sum of radii: loops that are nearer lie in each other, and stay so */
#define LOOP 2.0 /* sums of radii: spheres that are farther apart along the line are of different loops */
#define APART (1 + SPORE_GRID_SELF_MARGIN + 1e-6)

/* What is known of the spheres while loops are parted. */
typedef struct Parting {
  const double *centre, *radius, *along; /* m */
  double *scale;                         /* of the radius; above 1: the sphere is deep in another */
} Parting;

/* Distance of two spheres of different loops over the sum of their radii; HUGE_VAL: they are of one loop. */
static double apart(const Parting *parting, uint32_t a, uint32_t b) {
  double sum = parting->radius[a] + parting->radius[b];
  if (fabs(parting->along[a] - parting->along[b]) <= LOOP * sum) return HUGE_VAL;
  SporeVec3 p = spore_vec3_load(parting->centre + 3 * a), q = spore_vec3_load(parting->centre + 3 * b);
  return spore_vec3_distance(p, q) / sum;
}

static bool mark_deep(void *data, uint32_t a, uint32_t b) {
  const Parting *parting = data;
  if (apart(parting, a, b) < DEEP) parting->scale[a] = parting->scale[b] = 2;
  return true;
}

static bool part_pair(void *data, uint32_t a, uint32_t b) {
  const Parting *parting = data;
  double scale = apart(parting, a, b) / APART;
  if (parting->scale[a] > 1 || parting->scale[b] > 1) return true;
  parting->scale[a] = fmin(parting->scale[a], scale);
  parting->scale[b] = fmin(parting->scale[b], scale);
  return true;
}

static bool part_loops(SporeSphereSet *set) {
  size_t count = set->count;
  double *room = SPORE_NEW_ARRAY(double, 6 * count), *centre = room, *radius, *along, *scale;
  if (!room) return false;
  radius = room + 3 * count, along = radius + count, scale = along + count;
  for (size_t i = 0; i < count; i++) {
    SporeVec3 p = spore_vec3_load(set->spheres + 4 * i);
    spore_vec3_store(centre + 3 * i, p);
    radius[i] = set->spheres[4 * i + 3];
    scale[i] = 1;
    along[i] = i > 0 ? along[i - 1] + spore_vec3_distance(p, spore_vec3_load(centre + 3 * (i - 1))) : 0;
  }
  Parting parting = {centre, radius, along, scale};
  bool parted = spore_near_pairs(centre, radius, count, DEEP, 0, mark_deep, &parting) &&
                spore_near_pairs(centre, radius, count, APART, 0, part_pair, &parting);
  for (size_t i = 0; i < count; i++) set->spheres[4 * i + 3] *= fmin(scale[i], 1);
  spore_free(room);
  return parted;
}

/* From end to end, as far apart as each is thick: smooth to what slides over them. */
static bool set_spheres(SporeSplineLine *line, SporeError *error) {
  double end = spore_spline_end(line->knots);
  size_t samples = SAMPLES * (size_t)end;
  double whole = 0, walked = 0;
  for (size_t i = 0; i < samples; i++) whole += radii_of_sample(line, i);
  size_t gaps = (size_t)fmin(fmax(ceil(whole), 1), 1e6), next = 0;
  if (!spore_sphere_set_allocate(&line->spheres, gaps + 1, error)) return false;
  for (size_t i = 0; i < samples; i++) {
    double step = radii_of_sample(line, i);
    for (; next < gaps && (double)next / (double)gaps * whole <= walked + step; next++) {
      double part = ((double)next / (double)gaps * whole - walked) / step;
      set_sphere(line, ((double)i + part) / SAMPLES, line->spheres.spheres + 4 * next);
    }
    walked += step;
  }
  for (; next <= gaps; next++) set_sphere(line, end, line->spheres.spheres + 4 * next);
  return part_loops(&line->spheres) || no_memory(error);
}

/* By how much a span turns, rad. */
static double turn_of(const SporeSplineLine *line, size_t span) {
  assert(span < line->knots.span_count);
  double turn = 0, width = spore_spline_width(line->knots, span);
  for (int point = 0; point < SPORE_SPLINE_POINTS; point++) {
    SporeSplineBasis basis =
        spore_spline_basis(line->knots, spore_spline_gauss_parameter(line->knots, span, point), &span);
    SporeVec3 slope = combine(line->rest, span, basis.first), bend = combine(line->rest, span, basis.second);
    double square = fmax(spore_vec3_dot(slope, slope), 1e-300);
    turn += width / SPORE_SPLINE_POINTS * spore_vec3_length(spore_vec3_cross(slope, bend)) / square;
  }
  return turn;
}

/* Halves the spans that turn by too much, into `breaks`; false: none does, or no more may be. */
static bool halve(SporeSplineLine *line, const SporeSplineDensity *density, double *breaks) {
  size_t spans = line->knots.span_count, most = density->most - 3, made = 0, added = 0;
  line->bends = false;
  for (size_t span = 0; span < spans; span++) {
    double from = spore_spline_break(line->knots, span), width = spore_spline_width(line->knots, span);
    breaks[made++] = from;
    if (turn_of(line, span) <= density->most_bend) continue;
    bool full = spans + added >= most || width <= SPORE_SPLINE_NARROWEST;
    line->bends = line->bends || full;
    if (full) continue;
    breaks[made++] = from + 0.5 * width;
    added++;
  }
  breaks[made] = spore_spline_end(line->knots);
  return added > 0;
}

static bool fit(SporeSplineLine *line, const SporeSplineDensity *density) {
  assert(density->count >= 4 && density->count <= density->most);
  line->knots = spore_spline_uniform(density->count - 3);
  if (!spore_spline_fit(&line->course, line->knots, line->rest)) return false;
  if (!(density->most_bend > 0)) return true;
  double *next = SPORE_NEW_ARRAY(double, density->most);
  bool made = next && (line->breaks = SPORE_NEW_ARRAY(double, density->most));
  while (made && halve(line, density, next)) {
    size_t spans = line->knots.span_count;
    for (spans = 0; next[spans] < spore_spline_end(line->knots);) spans++;
    memcpy(line->breaks, next, (spans + 1) * sizeof *next);
    line->knots = (SporeSplineKnots){spans, line->breaks};
    made = spore_spline_fit(&line->course, line->knots, line->rest);
  }
  spore_free(next);
  line->control_count = line->knots.span_count + 3;
  return made;
}

static bool set_radii(SporeSplineLine *line) {
  size_t count = SPORE_LINE_SAMPLES * line->knots.span_count + 1;
  line->radius = SPORE_NEW_ARRAY(double, count);
  for (size_t i = 0; line->radius && i < count; i++)
    line->radius[i] =
        spore_spline_radius(&line->course, line->knots, spore_spline_part(line->knots, SPORE_LINE_SAMPLES, i));
  return line->radius;
}

bool spore_spline_line_init(SporeSplineLine *line, const SporeCurve *curve, const SporeSplineDensity *density,
                            const SporeSplineSection *section, SporeError *error) {
  assert(density->count >= 4 && density->count <= density->most);
  *line = (SporeSplineLine){.control_count = density->count};
  if (!curve || curve->count == 0)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("there is no curve; a spline follows one; give the body a curve as its geometry"));
  if (!spore_curve_validate(curve, error)) return false;
  line->rest = SPORE_NEW_ARRAY(double, 3 * density->most);
  if (!line->rest || !spore_spline_course_init(&line->course, curve) || !fit(line, density)) return no_memory(error);
  line->mass = SPORE_NEW_ARRAY(double, line->control_count);
  line->length = SPORE_NEW_ARRAY(double, line->control_count);
  line->weights = SPORE_NEW_ARRAY(SporeSplineWeight, line->knots.span_count);
  if (!line->mass || !line->length || !line->weights || !set_radii(line) ||
      !spore_spline_allocate(&line->spline, line->knots.span_count))
    return no_memory(error);
  return set_points(line, section, error) && set_spheres(line, error);
}

bool spore_spline_line_map(const SporeSplineLine *line, const double *arms, const double *points, size_t count,
                           const SporeCancel *cancel, double slack, bool follows, SporeMapping *mapping,
                           SporeError *error) {
  return spore_spline_map(line->knots, line->rest, arms, points, count, cancel, slack, follows, mapping, error);
}

bool spore_spline_line_map_drawn(const SporeSplineLine *line, const SporeModel *model, bool arms,
                                 const SporeTriangleMesh *mesh, SporeMapping *mapping, SporeError *error) {
  const SporeVec3 none = {0, 0, 0};
  double *q = SPORE_NEW_ARRAY(double, model->q_room), *v = SPORE_NEW_ARRAY(double, 3 * model->block_room);
  bool made = q && v;
  if (made) {
    model->type->place(model, spore_pose_identity(), none, none, q, v);
    SporeLine at_rest = {line->knots, line->radius, arms, !spore_model_is_nodal(model), q};
    made = spore_mapping_init_frames(mapping, &at_rest, mesh, error);
  } else {
    no_memory(error);
  }
  spore_free(q);
  spore_free(v);
  return made;
}

bool spore_spline_line_samples(const SporeSplineLine *line, const double *arms, size_t arm_count, double **points,
                               size_t *count, size_t *seen) {
  assert(arm_count == 0 || arms);
  *points = spore_spline_sample(line->knots, line->rest, arm_count, count);
  *seen = *count;
  if (!*points) return false;
  if (arm_count > 0) memcpy(*points + 3 * *count, arms, 3 * arm_count * sizeof **points);
  *count += arm_count;
  return true;
}

bool spore_spline_line_spheres(const SporeSplineLine *line, SporeSphereSet *set, SporeError *error) {
  if (!spore_sphere_set_allocate(set, line->spheres.count, error)) return false;
  memcpy(set->spheres, line->spheres.spheres, 4 * set->count * sizeof *set->spheres);
  return true;
}
