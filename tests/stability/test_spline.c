/* The spline against the theory of thin rods: each figure with more control points, until it is the theory's. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/body/path.h"
#include "core/constraint/pin.h"
#include "tests/stability/rig.h"
#include "tests/stability/statics.h"

#define YOUNG 1e7
#define DENSITY 1000.0

static double inertia(double radius) { return 0.25 * G_PI * pow(radius, 4); }

/* A spline with nothing holding it; the curve is cleared. */
static SporeModel *spline_new(SporeCurve *curve, int64_t control_points, double bending_scale, bool straight) {
  const SporeParameterTable *table = &spore_spline_1d.parameters;
  const struct {
    const char *name;
    SporeValue value;
  } set[] = {{"control_points", {.type = SPORE_INTEGER, .number = {(double)control_points}}},
             {"young_modulus", {.type = SPORE_REAL, .number = {YOUNG}}},
             {"density", {.type = SPORE_REAL, .number = {DENSITY}}},
             {"bending_scale", {.type = SPORE_REAL, .number = {bending_scale}}},
             {"straight_at_rest", {.type = SPORE_BOOLEAN, .number = {straight}}}};
  char *fields = g_malloc0(table->size);
  spore_parameters_set_initial(table, fields);
  for (size_t i = 0; i < G_N_ELEMENTS(set); i++)
    spore_parameter_store(table->parameters + spore_parameter_find(table, set[i].name), &set[i].value, fields);
  SporeModel *model = spore_spline_1d.create(&(SporeGeometry){.curve = curve}, fields, NULL);
  g_assert_nonnull(model);
  g_free(fields);
  spore_curve_clear(curve);
  return model;
}

/* Along x. */
static SporeModel *rod_new(int64_t control_points, double length, double radius) {
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, 2, NULL));
  const double points[8] = {0, 0, 0, radius, length, 0, 0, radius};
  memcpy(curve.points, points, sizeof points);
  return spline_new(&curve, control_points, 1, true);
}

/* Where the tip of a rod goes whose first control points are held, under a load across. */
static SporeVec3 tip_held(size_t held, int64_t control_points, double length, double radius, double load) {
  Statics statics = statics_new(rod_new(control_points, length, radius));
  for (size_t i = 0; i < held; i++) statics.held[i] = TRUE;
  statics.load[statics.n - 2] = -load;
  double left = statics_balance(&statics);
  g_assert_cmpfloat(left, <, 1e-6);
  SporeVec3 tip = spore_vec3_load(statics.q + statics.n - 3);
  statics_free(&statics);
  return tip;
}

/* As above, of a rod that is clamped at the origin. */
static SporeVec3 tip_under(int64_t control_points, double length, double radius, double load) {
  return tip_held(2, control_points, length, radius, load);
}

/* Stability case 44: a line whose first control points a pin holds bends like a beam clamped where spore_pin_clamp
 * says, to 2 %. Where the pin's radius ends elsewhere, that is said (core/scene/pinned_line.c). */
static void pinned(void) {
  double length = 0.1, radius = 0.001, stiffness = YOUNG * inertia(radius);
  for (int64_t points = 10; points <= 80; points *= 2)
    for (size_t held = 2; held <= 6; held++) {
      double parameter;
      SporeSplineKnots knots = spore_spline_uniform((size_t)points - 3);
      g_assert_true(spore_pin_clamp(knots, 0, held - 1, 1, &parameter));
      double free = length * (1 - parameter / spore_spline_end(knots)), expected = 1e-3 * free;
      double tip = -tip_held(held, points, length, radius, expected * 3 * stiffness / pow(free, 3)).y;
      g_test_message("%d control points, %d held: clamped at %.4f of the length, tip %+.2f %%", (int)points, (int)held,
                     1 - free / length, 100 * (tip / expected - 1));
      g_assert_cmpfloat(fabs(tip / expected - 1), <, 0.02);
      double mirrored;
      g_assert_true(spore_pin_clamp(knots, (size_t)points - held, (size_t)points - 1, -1, &mirrored));
      g_assert_cmpfloat(fabs(parameter + mirrored - spore_spline_end(knots)), <, 1e-12);
      g_assert_false(spore_pin_clamp(knots, 0, held - 1, -1, &mirrored)); /* nothing is free there */
    }
  double none;
  SporeSplineKnots knots = spore_spline_uniform(7);
  g_assert_false(spore_pin_clamp(knots, 0, 0, 1, &none)); /* a hinge */
  g_assert_false(spore_pin_clamp(knots, 4, 5, 1, &none));
  g_assert_true(spore_pin_clamp(knots, 4, 6, 1, &none));
}

/* w = P L^3 / 3 E I; a cubic, which a cubic spline has. */
static void cantilever(void) {
  double length = 0.5, radius = 0.002, stiffness = YOUNG * inertia(radius);
  double expected = 1e-3 * length, load = expected * 3 * stiffness / pow(length, 3);
  for (int64_t points = 4; points <= 32; points *= 2) {
    double tip = -tip_under(points, length, radius, load).y;
    g_test_message("%d control points: tip %.9e m of %.9e m: %+.1e", (int)points, tip, expected, tip / expected - 1);
    g_assert_cmpfloat(fabs(tip / expected - 1), <, 2e-6);
  }
}

/* The elastica of unit length and stiffness, clamped level: theta'' = -load cos theta; its tip (x, y). Shooting at the
 * free end, where theta' = 0, by bisection of theta'(0). */
static SporeVec3 elastica(double load) {
  double low = -2 * load, high = 0;
  SporeVec3 tip = {0, 0, 0};
  for (int round = 0; round < 60; round++) {
    enum { STEPS = 2000 };
    double h = 1.0 / STEPS, state[4] = {0, 0.5 * (low + high), 0, 0}; /* theta, theta', x, y */
    for (int i = 0; i < STEPS; i++) {
      double slope[4][4], at[4];
      for (int stage = 0; stage < 4; stage++) {
        const double *last = slope[stage > 0 ? stage - 1 : 0];
        double part = stage == 3 ? h : 0.5 * h;
        for (int k = 0; k < 4; k++) at[k] = state[k] + (stage > 0 ? part * last[k] : 0);
        slope[stage][0] = at[1], slope[stage][1] = load * cos(at[0]);
        slope[stage][2] = cos(at[0]), slope[stage][3] = sin(at[0]);
      }
      for (int k = 0; k < 4; k++) state[k] += h / 6 * (slope[0][k] + 2 * slope[1][k] + 2 * slope[2][k] + slope[3][k]);
    }
    if (state[1] > 0) high = 0.5 * (low + high);
    else low = 0.5 * (low + high);
    tip = spore_vec3(state[2], state[3], 0);
  }
  return tip;
}

static void large_deflection(void) {
  static const double loads[] = {1, 10};
  double length = 0.5, radius = 2e-3, stiffness = YOUNG * inertia(radius);
  for (size_t i = 0; i < G_N_ELEMENTS(loads); i++) {
    SporeVec3 expected = spore_vec3_scale(length, elastica(loads[i]));
    double error = 0;
    for (int64_t points = 8; points <= 32; points *= 2) {
      SporeVec3 tip = tip_under(points, length, radius, loads[i] * stiffness / (length * length));
      error = spore_vec3_distance(tip, expected) / length;
      g_test_message("elastica, P L^2/EI = %g, %d control points: tip (%.5f, %.5f) L of (%.5f, %.5f) L, off by %.1e L",
                     loads[i], (int)points, tip.x / length, tip.y / length, expected.x / length, expected.y / length,
                     error);
    }
    g_assert_cmpfloat(error, <, 2e-4);
  }
}

/* Lowest point of a thread of length L between supports at a distance d: a catenary, y = c cosh(x / c). */
static double catenary_sag(double length, double distance) {
  double low = 1e-3 * distance, high = 1e3 * distance; /* of c: 2 c sinh(d / 2c) = L */
  for (int round = 0; round < 200; round++) {
    double c = 0.5 * (low + high);
    if (2 * c * sinh(0.5 * distance / c) > length) low = c;
    else high = c;
  }
  return low * (cosh(0.5 * distance / low) - 1);
}

/* Half a circle at first, which the thread leaves for its catenary. */
static void catenary(void) {
  double radius = 0.25, distance = 2 * radius, expected = catenary_sag(G_PI * radius, distance), error = 0;
  for (int64_t points = 9; points <= 33; points = 2 * points - 1) {
    SporeCurve curve;
    g_assert_true(spore_curve_allocate(&curve, 201, NULL));
    for (unsigned i = 0; i < 201; i++) {
      double angle = G_PI * i / 200, row[4] = {-radius * cos(angle), -radius * sin(angle), 0, 1e-3};
      memcpy(curve.points + 4 * i, row, sizeof row);
    }
    Statics statics = statics_new(spline_new(&curve, points, 1e-3, true));
    size_t last = statics.model->block_count - 1;
    statics.held[0] = statics.held[last] = TRUE;
    for (size_t i = 0; i <= last; i++) statics.load[3 * i + 1] = -9.81 * statics.model->block_mass[i];
    double left = statics_balance(&statics), length = G_PI * radius, down = 0;
    SporeVec3 middle = {0, 0, 0};
    SporeMapping mapping; /* the middle of the line at rest */
    double bottom[3] = {0, -radius, 0};
    g_assert_true(statics.model->type->map(statics.model, bottom, 1, NULL, &mapping, NULL));
    middle = spore_mapping_position(&mapping, 0, statics.q);
    spore_mapping_clear(&mapping);
    down = -middle.y;
    error = down / expected - 1;
    g_test_message("catenary of %.4f m, %d control points: sag %.6f m of %.6f m: %+.1e; force left %.0e", length,
                   (int)points, down, expected, error, left);
    g_assert_cmpfloat(left, <, 1e-6);
    statics_free(&statics);
  }
  g_assert_cmpfloat(fabs(error), <, 2e-3);
}

static void first_mode(void) {
  double length = 0.5, radius = 2e-3, before = 1;
  double expected = pow(1.875104068711961, 2) * sqrt(YOUNG * inertia(radius) / (DENSITY * G_PI * radius * radius)) /
                    (length * length);
  for (int64_t points = 10; points <= 80; points *= 2) {
    Statics statics = statics_new(rod_new(points, length, radius));
    statics.held[0] = statics.held[1] = TRUE;
    double found = statics_lowest_frequency(&statics, 1), error = fabs(found / expected - 1);
    statics_free(&statics);
    g_test_message("%d control points: first mode %.5f rad/s of %.5f rad/s: %+.1e", (int)points, found, expected,
                   found / expected - 1);
    g_assert_cmpfloat(error, <, before);
    before = error / 3; /* second order, nearly */
  }
  g_assert_cmpfloat(before, <, 3e-4);
}

/* A helix keeps its shape at rest, to rounding, where it is not straight at rest. */
static void curved_at_rest(void) {
  SporeCurve curve;
  shape_helix(&curve, 60, 0.15, 0.2, 0.01);
  Statics statics = statics_new(spline_new(&curve, 30, 1, false));
  double *f = g_new0(double, statics.n), worst = 0;
  statics.model->type->force(statics.model, statics.q, statics.q, statics.still, f);
  for (size_t i = 0; i < statics.n; i++) worst = fmax(worst, fabs(f[i]));
  g_test_message("a helix at rest: greatest force %.1e N of %.1e N (E A)", worst, YOUNG * G_PI * 1e-4);
  g_assert_cmpfloat(worst, <, 1e-12 * YOUNG * G_PI * 1e-4);
  g_free(f);
  statics_free(&statics);
}

/* A straight bowel on its mesentery alone sags by its weight per length over the mesentery's stiffness, everywhere the
 * same: a uniform load on springs that stand for as much of the line as it does bends nothing. */
static void bowel_on_its_mesentery(void) {
  double length = 0.3, radius = 0.012, wall = 0.002, density = 1060, content = 300, stiffness = 300;
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, 2, NULL));
  const double points[8] = {0, 0, 0, radius, length, 0, 0, radius};
  memcpy(curve.points, points, sizeof points);
  Statics statics = statics_new(rig_curve_model(&spore_intestine, &curve, "wall_thickness", wall, "density", density,
                                                "content_density", content, "mesentery_stiffness", stiffness, NULL));
  size_t root = statics.model->node_count - 1;
  statics.held[root] = statics.held[root + 1] = TRUE;
  for (size_t i = 0; i < root; i++) statics.load[3 * i + 1] = -9.81 * statics.model->block_mass[i];
  double left = statics_balance(&statics), inner = radius - wall;
  double weight = 9.81 * G_PI * (density * (radius * radius - inner * inner) + content * inner * inner);
  double expected = weight / stiffness, error = 0;
  for (size_t i = 0; i < root; i++) error = fmax(error, fabs(-statics.q[3 * i + 1] / expected - 1));
  g_test_message("sag %.9f m of %.9f m, worst %+.1e; force left %.0e", -statics.q[1], expected, error, left);
  g_assert_cmpfloat(left, <, 1e-9);
  g_assert_cmpfloat(error, <, 1e-9);
  statics_free(&statics);
}

/* A bowel far longer than its bending reaches, pulled down at its middle: a beam on an elastic foundation (Hetenyi
 * 1946), w = P b / 2 k, b^4 = k / 4 E I. */
static void bowel_pulled_aside(void) {
  double length = 1.2, radius = 0.012, wall = 0.002, young = 3e5, stiffness = 300, load = 1e-3, error = 1;
  double inner = radius - wall, bending = young * 0.25 * G_PI * (pow(radius, 4) - pow(inner, 4));
  double expected = load * pow(stiffness / (4 * bending), 0.25) / (2 * stiffness);
  for (int points = 21; points <= 161; points = 2 * points - 1) {
    SporeCurve curve;
    g_assert_true(spore_curve_allocate(&curve, 2, NULL));
    const double ends[8] = {0, 0, 0, radius, length, 0, 0, radius};
    memcpy(curve.points, ends, sizeof ends);
    SporeModel *model =
        rig_curve_model(&spore_intestine, &curve, "control_points", (double)points, "young_modulus", young,
                        "bending_scale", 1.0, "wall_thickness", wall, "mesentery_stiffness", stiffness, NULL);
    Statics statics = statics_new(model);
    size_t root = model->node_count - 1;
    statics.held[root] = statics.held[root + 1] = TRUE;
    double middle[3] = {0.5 * length, 0, 0}, force[3] = {0, -load, 0};
    SporeMapping mapping;
    g_assert_true(model->type->map(model, middle, 1, NULL, &mapping, NULL));
    spore_mapping_add_force(&mapping, 0, statics.q, spore_vec3_load(force), statics.load);
    double left = statics_balance(&statics), down = -spore_mapping_position(&mapping, 0, statics.q).y;
    double now = fabs(down / expected - 1);
    g_test_message("%d control points: %.9f m of %.9f m: %+.1e; force left %.0e", points, down, expected,
                   down / expected - 1, left);
    g_assert_cmpfloat(now, <, error);
    error = now / 3; /* second order */
    spore_mapping_clear(&mapping);
    statics_free(&statics);
  }
  g_assert_cmpfloat(error, <, 1e-3);
}

/* A straight line carries no point beside it; but one that few digits in a file put there is on it. */
static void points_as_written(void) {
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, 2, NULL));
  const double ends[8] = {0, 0, 0, 1e-3, 0.1, 0, 0, 1e-3};
  memcpy(curve.points, ends, sizeof ends);
  SporeModel *model = rig_curve_model(&spore_spline_1d, &curve, "control_points", 12.0, NULL);
  const double rounded[3] = {0.0321, 4.4e-8, 0}, beside[3] = {0.0321, 1e-4, 0};
  SporeMapping mapping;
  SporeError error = SPORE_ERROR_INIT;
  g_assert_true(model->type->map(model, rounded, 1, NULL, &mapping, &error));
  double heaviest = 0;
  for (uint32_t i = mapping.row_start[0]; i < mapping.row_start[1]; i++)
    heaviest = fmax(heaviest, fabs(mapping.weight[i]));
  g_assert_cmpfloat(heaviest, <, 1);
  spore_mapping_clear(&mapping);
  g_assert_false(model->type->map(model, beside, 1, NULL, &mapping, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  model->type->destroy(model);
}

/* Along x, then a quarter of a circle of radius `bend`, then along y: what is to be followed closely in one place. */
static SporeCurve hook(double straight, double bend) {
  enum { ON = 30, ROUND = 60 };
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, 2 * ON + ROUND + 1, NULL));
  for (int i = 0; i <= 2 * ON + ROUND; i++) {
    double before = fmin((double)i / ON, 1) * straight, behind = fmax((double)(i - ON - ROUND) / ON, 0) * straight;
    double angle = 0.5 * G_PI * fmin(fmax((double)(i - ON) / ROUND, 0), 1);
    double row[4] = {before + bend * sin(angle), bend * (1 - cos(angle)) + behind, 0, 5e-4};
    memcpy(curve.points + 4 * i, row, sizeof row);
  }
  return curve;
}

/* Farthest that the line lies from the hook, m. */
static double farthest(const SporeModel *model, double straight, double bend) {
  SporeSplineKnots knots = model->type->line->path(model);
  double most = 0, *q = g_new0(double, model->q_count), *v = g_new0(double, 3 * model->block_count);
  model->type->place(model, spore_pose_identity(), spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), q, v);
  for (int i = 0; i <= 1000; i++) {
    SporeVec3 p = spore_path_at(knots, q, i / 1000. * spore_spline_end(knots)).position;
    double x = p.x - straight, y = p.y - bend,
           off = x > 0 && y < 0 ? fabs(hypot(x, y) - bend)
                 : y >= 0       ? fabs(x - bend)
                                : fabs(p.y);
    most = fmax(most, off);
  }
  g_free(q);
  g_free(v);
  return most;
}

static SporeModel *hook_model(double points, double most_bend, double maximum) {
  SporeCurve curve = hook(0.1, 0.005);
  return rig_curve_model(&spore_spline_1d, &curve, "control_points", points, "most_bend", most_bend,
                         "maximum_control_points", maximum, "young_modulus", YOUNG, NULL);
}

/* Points that are added where the curve bends follow it as closely as many more that are even; the line weighs the
 * same; it is told where there were not to be enough. */
static void points_where_it_bends(void) {
  static const struct {
    double points, most_bend, maximum;
  } cases[] = {{20, 0, 1000}, {40, 0, 1000}, {20, 0.5, 1000}, {20, 0.5, 22}};
  double off[4], mass[4];
  size_t count[4];
  for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
    SporeModel *model = hook_model(cases[i].points, cases[i].most_bend, cases[i].maximum);
    const char *doubt = model->type->doubt(model);
    off[i] = farthest(model, 0.1, 0.005), mass[i] = spore_model_total_mass(model), count[i] = model->node_count;
    g_test_message("%g control points, most_bend %g: %zu, off the curve by %.1e m at most, %.9g kg; %s",
                   cases[i].points, cases[i].most_bend, count[i], off[i], mass[i], doubt ? doubt : "");
    g_assert_true((doubt != NULL) == (i == 3));
    g_assert_cmpfloat(fabs(mass[i] / mass[0] - 1), <, 0.01);
    model->type->destroy(model);
  }
  g_assert_cmpuint(count[2], <, 40);
  g_assert_cmpfloat(off[2], <, 0.1 * off[0]);
  g_assert_cmpfloat(off[2], <, off[1]);
  g_assert_cmpuint(count[3], ==, 22);
}

#define SPIRAL 2000 /* points of the spiral, with which theory is integrated */

/* 0.1 m that bend more and more sharply, from 5 to 100 1/m. */
static void spiral(double x[SPIRAL + 1][2]) {
  double h = 0.1 / SPIRAL;
  x[0][0] = x[0][1] = 0;
  for (int i = 0; i < SPIRAL; i++) {
    double part = (i + 0.5) / SPIRAL, angle = 0.1 * (5 * part + 95 * part * part * part / 3);
    x[i + 1][0] = x[i][0] + h * cos(angle), x[i + 1][1] = x[i][1] + h * sin(angle);
  }
}

/* A spiral is clamped at its flat end and pulled aside at the other, in its plane: P over E I times the integral of the
 * lever squared. Uneven knots keep to it, though on a curve as smooth as this even ones gain more; and it rests as the
 * curve is. */
static void uneven(void) {
  double x[SPIRAL + 1][2], levers = 0, error[2];
  spiral(x);
  for (int i = 0; i < SPIRAL; i++) levers += 0.1 / SPIRAL * pow(x[SPIRAL][1] - 0.5 * (x[i][1] + x[i + 1][1]), 2);
  double load = 1e-5 * YOUNG * inertia(5e-4) / levers;
  for (int added = 0; added < 2; added++) {
    SporeCurve curve;
    g_assert_true(spore_curve_allocate(&curve, SPIRAL + 1, NULL));
    for (int i = 0; i <= SPIRAL; i++) memcpy(curve.points + 4 * i, (double[4]){x[i][0], x[i][1], 0, 5e-4}, 32);
    Statics statics = statics_new(rig_curve_model(&spore_spline_1d, &curve, "control_points", added ? 10.0 : 24.0,
                                                  "most_bend", added ? 0.25 : 0, "young_modulus", YOUNG, NULL));
    size_t last = statics.n / 3 - 1;
    statics.held[0] = statics.held[1] = TRUE;
    double *f = g_new0(double, statics.n), most = 0, from = statics.q[3 * last];
    statics.model->type->force(statics.model, statics.q, statics.q, statics.still, f);
    for (size_t i = 0; i < statics.n; i++) most = fmax(most, fabs(f[i]));
    statics.load[3 * last] = load;
    double left = statics_balance(&statics), aside = statics.q[3 * last] - from;
    error[added] = fabs(aside / 1e-5 - 1);
    g_test_message("%zu control points: aside by %.4e m of %.4e m: %+.1e; at rest %.1e N; force left %.0e", last + 1,
                   aside, 1e-5, aside / 1e-5 - 1, most, left);
    g_assert_cmpfloat(left, <, 1e-6);
    g_assert_cmpfloat(most, <, 1e-11 * YOUNG * G_PI * 5e-4 * 5e-4);
    g_free(f);
    statics_free(&statics);
  }
  g_assert_cmpfloat(error[1], <, 0.01);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/spline/pinned", pinned);
  g_test_add_func("/spline/cantilever", cantilever);
  g_test_add_func("/spline/elastica", large_deflection);
  g_test_add_func("/spline/catenary", catenary);
  g_test_add_func("/spline/first-mode", first_mode);
  g_test_add_func("/spline/curved-at-rest", curved_at_rest);
  g_test_add_func("/spline/points-where-it-bends", points_where_it_bends);
  g_test_add_func("/spline/points-as-written", points_as_written);
  g_test_add_func("/spline/uneven", uneven);
  g_test_add_func("/intestine/sag", bowel_on_its_mesentery);
  g_test_add_func("/intestine/pulled-aside", bowel_pulled_aside);
  return g_test_run();
}
