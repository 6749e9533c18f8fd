/* The spline sheet against the theory of beams and plates, and against itself with more control points. */
#include <math.h>

#include "tests/stability/rig.h"
#include "tests/stability/statics.h"

#define YOUNG 1e6
#define DENSITY 1000.0

static SporeModel *model_of(const SporeTriangleMesh *mesh, int64_t u, int64_t v, double poisson, double thickness,
                            SporeError *error) {
  const SporeParameterTable *table = &spore_spline_2d.parameters;
  const struct {
    const char *name;
    SporeValue value;
  } set[] = {{"control_points_u", {.type = SPORE_INTEGER, .number = {(double)u}}},
             {"control_points_v", {.type = SPORE_INTEGER, .number = {(double)v}}},
             {"young_modulus", {.type = SPORE_REAL, .number = {YOUNG}}},
             {"poisson_ratio", {.type = SPORE_REAL, .number = {poisson}}},
             {"thickness", {.type = SPORE_REAL, .number = {thickness}}},
             {"density", {.type = SPORE_REAL, .number = {DENSITY}}}};
  char *fields = g_malloc0(table->size);
  spore_parameters_set_initial(table, fields);
  for (size_t i = 0; i < G_N_ELEMENTS(set); i++)
    spore_parameter_store(table->parameters + spore_parameter_find(table, set[i].name), &set[i].value, fields);
  SporeModel *model = spore_spline_2d.create(&(SporeGeometry){.surface = mesh}, fields, error);
  g_free(fields);
  return model;
}

/* length x width, m, in the plane of x and y, of squares about `spacing` wide. */
static Statics flat_new(double length, double width, double spacing, int64_t u, int64_t v, double poisson,
                        double thickness) {
  SporeTriangleMesh mesh;
  SporeError error = SPORE_ERROR_INIT;
  unsigned columns = (unsigned)lround(length / spacing) + 1, rows = (unsigned)lround(width / spacing) + 1;
  shape_sheet(&mesh, columns, rows, spacing, TRUE);
  SporeModel *model = model_of(&mesh, u, v, poisson, thickness, &error);
  if (!model) g_error("%s: %s", error.place, error.message);
  spore_triangle_mesh_clear(&mesh);
  return statics_new(model);
}

static SporeVec3 point_of(const Statics *statics, SporeVec3 at) {
  SporeMapping mapping;
  double point[3];
  spore_vec3_store(point, at);
  g_assert_true(statics->model->type->map(statics->model, point, 1, NULL, &mapping, NULL));
  SporeVec3 found = spore_mapping_position(&mapping, 0, statics->q);
  spore_mapping_clear(&mapping);
  return found;
}

static void hold_clamped(Statics *statics, int64_t u, int64_t v) {
  for (int64_t j = 0; j < v; j++) statics->held[j * u] = statics->held[j * u + 1] = TRUE;
}

/* Force along z of `pressure` (Pa) on a flat sheet. */
static void press(Statics *statics, double pressure, double thickness) {
  for (size_t i = 0; i < statics->n / 3; i++)
    statics->load[3 * i + 2] = pressure * statics->model->block_mass[i] / (DENSITY * thickness);
}

/* w = P L^3 / 3 E I, where nothing narrows (nu = 0): a cubic, which the spline has. */
static void cantilever(void) {
  double length = 0.1, width = 0.02, thickness = 1e-3, expected = 3e-4 * length;
  double load = expected * 3 * YOUNG * width * pow(thickness, 3) / 12 / pow(length, 3), worst = 0;
  for (int64_t u = 6; u <= 12; u *= 2) {
    Statics statics = flat_new(length, width, 0.005, u, 6, 0, thickness);
    hold_clamped(&statics, u, 6);
    double share = 0; /* along the edge, as each function's integral there */
    for (int64_t j = 0; j < 6; j++) share += statics.model->block_mass[(j + 1) * u - 1];
    for (int64_t j = 0; j < 6; j++) {
      size_t i = (size_t)((j + 1) * u - 1);
      statics.load[3 * i + 2] = load * statics.model->block_mass[i] / share;
    }
    double left = statics_balance(&statics), tip = point_of(&statics, spore_vec3(length, 0.5 * width, 0)).z;
    g_test_message("%d x 6 control points: tip %.9e m of %.9e m: %+.1e; force left %.0e", (int)u, tip, expected,
                   tip / expected - 1, left);
    worst = fmax(worst, fabs(tip / expected - 1));
    statics_free(&statics);
  }
  g_assert_cmpfloat(worst, <, 1e-6);
}

/* A square plate clamped all around under a pressure: w = 0.00126532 p a^4 / D at its middle (Timoshenko and
 * Woinowsky-Krieger 1959, table 35, has 0.00126; the digits are Taylor and Govindjee's 2004). */
static void clamped_plate(void) {
  double side = 0.1, thickness = 1e-3, stiffness = YOUNG * pow(thickness, 3) / 12 / (1 - 0.09), error = 0;
  double expected = 1e-3 * thickness, pressure = expected * stiffness / (0.00126532 * pow(side, 4));
  for (int64_t n = 7; n <= 13; n += 3) {
    Statics statics = flat_new(side, side, 0.005, n, n, 0.3, thickness);
    for (int64_t i = 0; i < n * n; i++) {
      int64_t x = i % n, y = i / n;
      statics.held[i] = x < 2 || y < 2 || x >= n - 2 || y >= n - 2;
    }
    press(&statics, pressure, thickness);
    double left = statics_balance(&statics), middle = point_of(&statics, spore_vec3(0.5 * side, 0.5 * side, 0)).z;
    error = middle / expected - 1;
    g_test_message("%d x %d control points: middle %.6e m of %.6e m: %+.1e; force left %.0e", (int)n, (int)n, middle,
                   expected, error, left);
    statics_free(&statics);
  }
  g_assert_cmpfloat(fabs(error), <, 1e-3);
}

/* Depth of a membrane that is held at its edge and hangs by its weight, with n x n control points. */
static double sag(int64_t n) {
  double side = 0.1, thickness = 5e-4;
  Statics statics = flat_new(side, side, 0.005, n, n, 0.3, thickness);
  for (int64_t i = 0; i < n * n; i++) statics.held[i] = i % n == 0 || i % n == n - 1 || i < n || i >= n * (n - 1);
  press(&statics, -9.81 * DENSITY * thickness, thickness);
  double left = statics_balance(&statics), depth = -point_of(&statics, spore_vec3(0.5 * side, 0.5 * side, 0)).z;
  g_test_message("%d x %d control points: sag %.7f m; force left %.0e", (int)n, (int)n, depth, left);
  g_assert_cmpfloat(left, <, 1e-6);
  statics_free(&statics);
  return depth;
}

/* Many times as deep as it is thick: stretch carries it. */
static void hanging(void) {
  double fine = sag(14), before = 1;
  for (int64_t n = 6; n <= 10; n += 2) {
    double error = fabs(sag(n) / fine - 1);
    g_test_message("%d x %d: %.1e off the finest", (int)n, (int)n, error);
    g_assert_cmpfloat(error, <, before);
    before = error;
  }
  g_assert_cmpfloat(before, <, 2e-3);
}

/* Lowest bending of a clamped strip: 1.8751^2 sqrt(E t^2 / 12 rho) / L^2. What is off is the lumped mass. */
static void first_mode(void) {
  double length = 0.1, thickness = 1e-3, before = 1;
  double expected =
      pow(1.875104068711961, 2) * sqrt(YOUNG * thickness * thickness / (12 * DENSITY)) / (length * length);
  for (int64_t u = 8; u <= 32; u *= 2) {
    Statics statics = flat_new(length, 0.02, 0.005, u, 6, 0, thickness);
    hold_clamped(&statics, u, 6);
    double found = statics_lowest_frequency(&statics, 2), error = fabs(found / expected - 1);
    g_test_message("%d x 6 control points: first mode %.5f rad/s of %.5f rad/s: %+.1e", (int)u, found, expected,
                   found / expected - 1);
    g_assert_cmpfloat(error, <, before);
    before = error / 3; /* second order, nearly */
    statics_free(&statics);
  }
}

/* A sheet rolled through `angle` about y. */
static void roll(SporeTriangleMesh *mesh, double angle) {
  shape_sheet(mesh, 21, 11, 0.005, TRUE);
  double radius = 0.1 / angle;
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    double *x = mesh->vertices + 3 * i, at = x[0] / radius;
    x[0] = radius * sin(at), x[2] = radius * (1 - cos(at));
  }
}

/* Rolled up past a half turn, which is no graph over any plane, it keeps that shape. */
static void curved_at_rest(void) {
  SporeTriangleMesh mesh;
  SporeError error = SPORE_ERROR_INIT;
  roll(&mesh, 1.5 * G_PI);
  SporeModel *model = model_of(&mesh, 12, 8, 0.3, 1e-3, &error);
  if (!model) g_error("%s: %s", error.place, error.message);
  spore_triangle_mesh_clear(&mesh);
  Statics statics = statics_new(model);
  double *f = g_new0(double, statics.n), worst = 0;
  model->type->force(model, statics.q, statics.q, statics.still, f);
  for (size_t i = 0; i < statics.n; i++) worst = fmax(worst, fabs(f[i]));
  g_test_message("a rolled sheet at rest: greatest force %.1e N of %.1e N (E t L)", worst, YOUNG * 1e-3 * 0.1);
  g_assert_cmpfloat(worst, <, 1e-12 * YOUNG * 1e-3 * 0.1);
  g_free(f);
  statics_free(&statics);
}

static void refuse(SporeTriangleMesh *mesh, const char *says) {
  SporeError error = SPORE_ERROR_INIT;
  g_assert_null(model_of(mesh, 6, 6, 0.3, 1e-3, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  g_test_message("%s", error.message);
  g_assert_nonnull(strstr(error.message, says));
  spore_triangle_mesh_clear(mesh);
}

/* What a sheet cannot be made of is refused with its reason. */
static void refused(void) {
  SporeTriangleMesh mesh;
  shape_box(&mesh, spore_vec3(0, 0, 0), spore_vec3(0.1, 0.1, 0.1));
  refuse(&mesh, "closed");
  shape_sheet(&mesh, 5, 5, 0.01, FALSE);
  mesh.triangle_count--; /* the last one takes the place of one in the middle */
  for (size_t k = 0; k < 3; k++) mesh.triangles[3 * 10 + k] = mesh.triangles[3 * mesh.triangle_count + k];
  refuse(&mesh, "holes");
  shape_sheet(&mesh, 5, 5, 0.01, FALSE);
  uint32_t kept = mesh.triangles[0];
  mesh.triangles[0] = mesh.triangles[1], mesh.triangles[1] = kept;
  refuse(&mesh, "folds");
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/spline_2d/cantilever", cantilever);
  g_test_add_func("/spline_2d/clamped-plate", clamped_plate);
  g_test_add_func("/spline_2d/hanging", hanging);
  g_test_add_func("/spline_2d/first-mode", first_mode);
  g_test_add_func("/spline_2d/curved-at-rest", curved_at_rest);
  g_test_add_func("/spline_2d/refused", refused);
  return g_test_run();
}
