/* Middle lines of tubes whose middle line is known. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/centreline/centreline.h"
#include "tests/mesh/shapes.h"
#include "tests/sanitized.h"

#define SECTORS 16
#define RADIUS 0.01

/* A line by a parameter in 0..1. */
typedef SporeVec3 (*Shape)(double u);
typedef double (*Width)(double u);

static SporeVec3 straight(double u) { return spore_vec3(0.2 * u, 0.01, -0.02); }
static SporeVec3 arc(double u) { return spore_vec3(0.05 * cos(1.5 * G_PI * u), 0.05 * sin(1.5 * G_PI * u), 0); }
static SporeVec3 helix(double u) { return spore_vec3(0.03 * cos(6 * G_PI * u), 0.09 * u, 0.03 * sin(6 * G_PI * u)); }
/* Two and a half turns, each a tenth of a radius into the next: where they meet, the radius is less by that, and the
 * walls part them all the same; the
 * innermost is two radii wide. */
static SporeVec3 spiral(double u) {
  double angle = 5 * G_PI * u, ring = 0.02 + 1.9 * RADIUS * angle / (2 * G_PI);
  return spore_vec3(ring * cos(angle), ring * sin(angle), 0);
}
/* Turns so close on each other that most of their inner side is seen from nowhere: no wall of a lumen. */
static SporeVec3 coil(double u) {
  return spore_vec3(0.022 * cos(6 * G_PI * u), 6.15 * RADIUS * u, 0.022 * sin(6 * G_PI * u));
}
static bool winds(Shape shape) { return shape == spiral || shape == helix || shape == coil; }
static double even(double u) { return RADIUS; }
static double inside(double u) { return 0.65 * RADIUS; }
static double taper(double u) { return RADIUS * (0.5 + 0.7 * u); }

static SporeCurve line_of(Shape shape, Width width, size_t count) {
  SporeCurve line;
  g_assert_true(spore_curve_allocate(&line, count, NULL));
  for (size_t i = 0; i < count; i++) {
    double u = (double)i / (double)(count - 1);
    spore_vec3_store(line.points + 4 * i, shape(u));
    line.points[4 * i + 3] = width(u);
  }
  return line;
}

static SporeTriangleMesh tube_of(Shape shape, Width width) {
  SporeTriangleMesh mesh;
  SporeCurve line = line_of(shape, width, shape == coil ? 90 : winds(shape) ? 160 : 60);
  g_assert_true(spore_curve_tube(&line, winds(shape) && shape != coil ? 24 : SECTORS, &mesh, NULL));
  spore_curve_clear(&line);
  return mesh;
}

static SporeCurve find(const SporeTriangleMesh *mesh, const SporeCentrelineOptions *options,
                       SporeCentrelineReport *report) {
  static const SporeCentrelineOptions plain = {0};
  SporeError error = SPORE_ERROR_INIT;
  SporeCurve curve;
  bool done = spore_centreline_from_mesh(mesh, options ? options : &plain, &curve, report, NULL, &error);
  g_assert_cmpstr(error.message, ==, "");
  g_assert_true(done);
  g_assert_true(spore_curve_validate(&curve, NULL));
  g_assert_cmpfloat(report->outside, ==, 0);
  g_test_message("%zu points, length %.4f, radius %.4f (%.4f..%.4f), offset %.3f, cover %.2f, approach %.2f, %.2f s",
                 curve.count, report->length, report->radius_mean, report->radius_min, report->radius_max,
                 report->offset, report->cover, report->approach, report->seconds);
  for (size_t i = 0; i < report->branches && i < SPORE_CENTRELINE_NAMED; i++)
    g_test_message("branch at %.4f, %.4f long, to %.4f %.4f %.4f", report->branch[i].from, report->branch[i].length,
                   report->branch[i].end[0], report->branch[i].end[1], report->branch[i].end[2]);
  return curve;
}

static double distance_to(const SporeCurve *line, SporeVec3 p, size_t *nearest) {
  double least = HUGE_VAL;
  for (size_t i = 0; i < line->count; i++) {
    double distance = spore_vec3_distance(p, spore_vec3_load(line->points + 4 * i));
    if (distance < least) least = distance, *nearest = i;
  }
  return least;
}

/* Each point lies on the line, radii are the tube's but for its caps, the ends reach the ends, nothing turns back. */
static void check(const SporeCurve *curve, const SporeCentrelineReport *report, Shape shape, Width width) {
  SporeCurve line = line_of(shape, width, 4000);
  size_t at = 0, before = 0, steps[2] = {0, 0};
  double thick = report->radius_max, length = spore_curve_length(&line), gone = 0;
  for (size_t i = 0; i < curve->count; i++) {
    SporeVec3 p = spore_vec3_load(curve->points + 4 * i);
    double away = distance_to(&line, p, &at);
    if (i > 0) {
      steps[at > before]++;
      gone += spore_vec3_distance(p, spore_vec3_load(curve->points + 4 * i - 4));
    }
    before = at;
    bool inner = gone > 1.2 * thick && gone < length - 1.5 * thick;
    g_assert_cmpfloat(away, <, (inner ? shape == spiral ? 0.15 : 0.1 : 0.3) * thick);
    if (inner)
      g_assert_cmpfloat_with_epsilon(curve->points[4 * i + 3], line.points[4 * at + 3],
                                     (shape == spiral ? 0.2 : 0.08) * thick);
  }
  g_assert_cmpuint(MIN(steps[0], steps[1]), ==, 0);
  g_assert_cmpfloat_with_epsilon(report->length, length, 0.02 * length);
  g_assert_cmpfloat_with_epsilon(report->length, spore_curve_length(curve), 0.005 * length);
  g_assert_cmpfloat(report->offset, <, 0.1);
  g_assert_cmpuint(report->branches, ==, 0);
  spore_curve_clear(&line);
}

typedef struct {
  const char *name;
  Shape shape;
  Width width;
} Tube;

static void test_tube(gconstpointer data) {
  const Tube *tube = data;
  SporeTriangleMesh mesh = tube_of(tube->shape, tube->width);
  SporeCentrelineReport report;
  SporeCurve curve = find(&mesh, NULL, &report);
  check(&curve, &report, tube->shape, tube->width);
  g_assert_cmpuint(report.components, ==, 1);
  g_assert_cmpfloat(report.cover, >, 0.97);
  g_assert_cmpfloat(report.inner_wall, ==, 0);
  if (tube->shape == spiral) g_assert_cmpfloat(report.approach, <, 1.1); /* where walls cross, the nearer one counts */
  else if (!winds(tube->shape)) g_assert_cmpfloat(report.approach, >, 1.5);
  spore_curve_clear(&curve);
  spore_triangle_mesh_clear(&mesh);
}

/* Turned inside out, and the same bits each time. */
static void test_inside_out(void) {
  SporeTriangleMesh mesh = tube_of(arc, even);
  SporeCentrelineReport report;
  shape_turn(&mesh);
  SporeCurve one = find(&mesh, NULL, &report), again = find(&mesh, NULL, &report);
  g_assert_cmpmem(one.points, 4 * one.count * sizeof(double), again.points, 4 * again.count * sizeof(double));
  check(&one, &report, arc, even);
  spore_curve_clear(&one);
  spore_curve_clear(&again);
  spore_triangle_mesh_clear(&mesh);
}

/* A heap of triangles that share no vertices, every third turned: they are turned to where they are seen from. */
static void test_soup(void) {
  SporeTriangleMesh mesh = tube_of(arc, even), soup;
  SporeCentrelineReport report;
  g_assert_true(spore_triangle_mesh_allocate(&soup, 3 * mesh.triangle_count, mesh.triangle_count, NULL));
  for (size_t i = 0; i < 3 * mesh.triangle_count; i++) {
    size_t corner = i / 3 % 3 == 0 ? i - i % 3 + 2 - i % 3 : i;
    soup.triangles[i] = (uint32_t)corner;
    for (size_t k = 0; k < 3; k++)
      soup.vertices[3 * i + k] = mesh.vertices[3 * (size_t)mesh.triangles[i] + k] + 1e-7 * (double)(i % 7);
  }
  SporeCurve curve = find(&soup, NULL, &report);
  check(&curve, &report, arc, even);
  spore_curve_clear(&curve);
  spore_triangle_mesh_clear(&soup);
  spore_triangle_mesh_clear(&mesh);
}

/* The caps are the first and the last of the two points that spore_curve_tube puts behind the rings. */
static void open_ends(SporeTriangleMesh *mesh) {
  size_t kept = 0;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const uint32_t *corner = mesh->triangles + 3 * t;
    if (MAX(MAX(corner[0], corner[1]), corner[2]) >= mesh->vertex_count - 2) continue;
    memmove(mesh->triangles + 3 * kept++, corner, 3 * sizeof *corner);
  }
  mesh->triangle_count = kept;
}

/* A wall with a lumen that is open at both ends, without rims. */
static void check_wall(double (*lumen_radius)(double)) {
  SporeTriangleMesh mesh = tube_of(arc, even), lumen = tube_of(arc, lumen_radius);
  SporeCentrelineReport report;
  open_ends(&mesh);
  open_ends(&lumen);
  shape_turn(&lumen);
  shape_append(&mesh, &lumen);
  SporeCurve curve = find(&mesh, NULL, &report), line = line_of(arc, even, 4000);
  g_assert_cmpfloat(report.inner_wall, >, 0.25);
  g_assert_cmpfloat(report.cover, >, 0.97);
  g_assert_cmpfloat_with_epsilon(report.length, spore_curve_length(&line), 0.03 * spore_curve_length(&line));
  for (size_t i = 0, at = 0; i < curve.count; i++)
    g_assert_cmpfloat(distance_to(&line, spore_vec3_load(curve.points + 4 * i), &at), <, 0.15 * RADIUS);
  g_assert_cmpfloat_with_epsilon(report.radius_max, RADIUS, 0.05 * RADIUS);
  spore_curve_clear(&curve);
  spore_curve_clear(&line);
  spore_triangle_mesh_clear(&lumen);
  spore_triangle_mesh_clear(&mesh);
}

static double skin(double u) { return RADIUS - 5e-6; }

static void test_double_wall(void) {
  check_wall(inside);
  check_wall(skin);
}

static SporeVec3 side(double u) { return spore_vec3(0.12, 0.01 + 0.07 * u, -0.02); }

static void test_branch(void) {
  SporeTriangleMesh mesh = tube_of(straight, even), branch = tube_of(side, even);
  SporeCentrelineReport report;
  shape_append(&mesh, &branch);
  SporeCurve curve = find(&mesh, NULL, &report);
  g_assert_cmpuint(report.branches, ==, 1);
  double from = curve.points[0] < 0.1 ? report.branch[0].from : 0.2 - report.branch[0].from;
  g_assert_cmpfloat_with_epsilon(from, 0.12, 0.012);
  g_assert_cmpfloat_with_epsilon(report.branch[0].length, 0.06, 0.008);
  g_assert_cmpfloat_with_epsilon(report.branch[0].end[1], 0.08, 0.004);
  g_assert_false(report.branch[0].returns);
  g_assert_cmpfloat(report.branch[0].from, <=, report.length);
  g_assert_cmpfloat_with_epsilon(report.length, 0.2, 0.006);
  spore_curve_clear(&curve);
  spore_triangle_mesh_clear(&branch);
  spore_triangle_mesh_clear(&mesh);
}

static SporeVec3 near_end(double u) { return spore_vec3(0.145, 0.01 + 0.12 * u, -0.02); }
static double thin(double u) { return 0.35 * RADIUS; }
static double pouch(double u) { return RADIUS * (1 + 1.5 / (1 + exp(100 * (0.83 - u)))); }

/* A pouch at the end holds more than the thin tube that leaves it, as of the caecum and the ileum; that is longer. */
static void test_thin_end(void) {
  SporeTriangleMesh mesh = tube_of(straight, pouch), branch = tube_of(near_end, thin);
  SporeCentrelineReport report;
  shape_append(&mesh, &branch);
  SporeCurve curve = find(&mesh, NULL, &report);
  g_test_message("%.3g m, %zu branches, the longest %.3g m from %.3g m%s", report.length, report.branches,
                 report.branch[0].length, report.branch[0].from, report.branch[0].returns ? ", back" : "");
  const double *last = curve.points + 4 * (curve.count - 1), *end = last[1] > curve.points[1] ? last : curve.points;
  g_assert_cmpfloat(spore_vec3_distance(spore_vec3_load(end), near_end(1)), <, 0.6 * RADIUS);
  g_assert_cmpfloat_with_epsilon(report.length, 0.145 + 0.12, 0.012);
  spore_curve_clear(&curve);
  spore_triangle_mesh_clear(&branch);
  spore_triangle_mesh_clear(&mesh);
}

static void test_pieces(void) {
  SporeTriangleMesh mesh = tube_of(straight, taper), other = tube_of(arc, inside);
  SporeCentrelineReport report;
  shape_move(&other, 0, 0, 0.3);
  shape_append(&mesh, &other);
  SporeCurve curve = find(&mesh, NULL, &report);
  g_assert_cmpuint(report.components, ==, 2);
  g_assert_cmpfloat(report.share, >, 0.5);
  g_assert_cmpfloat(report.share, <, 0.75);
  check(&curve, &report, straight, taper);
  spore_curve_clear(&curve);
  spore_triangle_mesh_clear(&other);
  spore_triangle_mesh_clear(&mesh);
}

/* Ends beside the middle: the line runs between their sections. Points are as many as asked for, evenly. */
static void test_options(void) {
  SporeTriangleMesh mesh = tube_of(straight, even);
  SporeCentrelineReport report;
  SporeCentrelineOptions options = {
      .ends_given = true, .ends = {{0.05, 0.015, -0.02}, {0.15, 0.01, -0.012}}, .points = 21};
  SporeCurve curve = find(&mesh, &options, &report);
  g_assert_cmpuint(curve.count, ==, 21);
  for (size_t i = 0; i < curve.count; i++) {
    const double *p = curve.points + 4 * i;
    g_assert_cmpfloat_with_epsilon(p[0], 0.05 + 0.005 * (double)i, 0.1 * RADIUS);
    g_assert_cmpfloat_with_epsilon(hypot(p[1] - 0.01, p[2] + 0.02), 0, 0.1 * RADIUS);
    g_assert_cmpfloat_with_epsilon(p[3], RADIUS, 0.05 * RADIUS);
  }
  curve.points[4 * 10 + 1] += 0.3 * RADIUS;
  SporeError error = SPORE_ERROR_INIT;
  g_assert_true(spore_centreline_measure(&mesh, &curve, &report, &error));
  g_assert_cmpfloat_with_epsilon(curve.points[4 * 10 + 3], 0.7 * RADIUS, 0.05 * RADIUS);
  g_assert_cmpfloat(report.outside, ==, 0);
  curve.points[4 * 10 + 1] += 2 * RADIUS;
  g_assert_true(spore_centreline_measure(&mesh, &curve, &report, &error));
  g_assert_cmpfloat_with_epsilon(report.outside, 1. / 21, 1e-9);
  spore_curve_clear(&curve);
  spore_triangle_mesh_clear(&mesh);
}

static void refuse(const SporeTriangleMesh *mesh, const SporeCentrelineOptions *options, const SporeProgress *progress,
                   SporeErrorCode code, const char *says) {
  SporeError error = SPORE_ERROR_INIT;
  SporeCentrelineReport report;
  SporeCurve curve;
  g_assert_false(spore_centreline_from_mesh(mesh, options, &curve, &report, progress, &error));
  g_assert_cmpint(error.code, ==, code);
  if (!strstr(error.message, says)) g_test_message("%s", error.message);
  g_assert_nonnull(strstr(error.message, says));
  g_assert_null(curve.points);
}

static bool stop_late(void *data, double fraction, const char *stage) { return fraction < *(double *)data; }

static void test_refusals(void) {
  SporeCentrelineOptions plain = {0}, one = {.points = 1}, wild = {.tolerance = NAN};
  SporeCentrelineOptions outside = {.ends_given = true, .ends = {{0, 0.01, -0.02}, {0.1, 0.1, 0}}};
  SporeCentrelineOptions same = {.ends_given = true, .ends = {{0.1, 0.01, -0.02}, {0.1, 0.01, -0.02}}};
  SporeCentrelineOptions nowhere = {.ends_given = true, .ends = {{NAN, 0, 0}, {0.1, 0.01, -0.02}}};
  SporeTriangleMesh ball, plate, tube = tube_of(straight, even), empty = {0};
  const double lower[3] = {0, 0, 0}, upper[3] = {0.2, 0.15, 0.01};
  shape_ball(&ball, 0.05, 6);
  shape_box(&plate, lower, upper, 2);
  refuse(&ball, &plain, NULL, SPORE_ERROR_INPUT, "not a tube");
  refuse(&plate, &plain, NULL, SPORE_ERROR_INPUT, "not a tube");
  refuse(&empty, &plain, NULL, SPORE_ERROR_INPUT, "triangle");
  refuse(&tube, &one, NULL, SPORE_ERROR_INPUT, "points");
  refuse(&tube, &wild, NULL, SPORE_ERROR_INPUT, "tolerance");
  refuse(&tube, &outside, NULL, SPORE_ERROR_INPUT, "end 2");
  refuse(&tube, &same, NULL, SPORE_ERROR_INPUT, "same place");
  refuse(&tube, &nowhere, NULL, SPORE_ERROR_INPUT, "end 1");
  for (double limit = 0.05; limit < 1; limit += tests_sanitized ? 0.9 : 0.3) {
    SporeProgress progress = {.report = stop_late, .data = &limit};
    refuse(&tube, &plain, &progress, SPORE_ERROR_CANCELLED, "cancelled");
  }
  plate.triangle_count = 2; /* a scrap */
  refuse(&plate, &plain, NULL, SPORE_ERROR_INPUT, "expected");
  spore_triangle_mesh_clear(&ball);
  spore_triangle_mesh_clear(&plate);
  spore_triangle_mesh_clear(&tube);
}

/* Without memory, at whichever allocation, it says so and leaves nothing. */
static void test_memory(void) {
  SporeTriangleMesh tube = tube_of(straight, even);
  SporeCentrelineOptions plain = {0};
  SporeCentrelineReport report;
  SporeCurve curve;
  uint64_t before = spore_allocation_count(), all;
  g_assert_true(spore_centreline_from_mesh(&tube, &plain, &curve, &report, NULL, NULL));
  spore_curve_clear(&curve);
  all = spore_allocation_count() - before;
  for (uint64_t n = 1; n <= all; n += 1 + n / 2) {
    spore_allocation_fail_at(n);
    refuse(&tube, &plain, NULL, SPORE_ERROR_MEMORY, "memory");
  }
  spore_allocation_fail_at(0);
  spore_triangle_mesh_clear(&tube);
}

int main(int argc, char **argv) {
  static const Tube tubes[] = {{"straight", straight, even},
                               {"arc", arc, even},
                               {"helix", helix, even},
                               {"coil", coil, even},
                               {"spiral", spiral, even}};
  g_test_init(&argc, &argv, NULL);
  for (gsize i = 0; i < G_N_ELEMENTS(tubes); i++) {
    g_autofree char *path = g_strdup_printf("/centreline/%s", tubes[i].name);
    g_test_add_data_func(path, &tubes[i], test_tube);
  }
  g_test_add_func("/centreline/inside_out", test_inside_out);
  g_test_add_func("/centreline/soup", test_soup);
  g_test_add_func("/centreline/double_wall", test_double_wall);
  g_test_add_func("/centreline/branch", test_branch);
  g_test_add_func("/centreline/thin_end", test_thin_end);
  g_test_add_func("/centreline/pieces", test_pieces);
  g_test_add_func("/centreline/options", test_options);
  g_test_add_func("/centreline/refusals", test_refusals);
  g_test_add_func("/centreline/memory", test_memory);
  return g_test_run();
}
