/* Middle lines of bowels whose loops lie side by side, touch, overlap or are grown together, and of what is no bowel.
 */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/generate/centreline/centreline.h"
#include "core/mesh/bvh.h"
#include "tests/generate/bowels.h"
#include "tests/mesh/shapes.h"
#include "tests/sanitized.h"

typedef struct Bowel {
  const char *name;
  BowelShape shape;
} Bowel;

static const Bowel bowels[] = {
    {"packed", {4, 2, 6, .gap = 0.02, .haustra = 0.1, .waves = 0.3, .noise = 0.05, .unevenness = 0.6, .sectors = 14}},
    {"overlapping", {4, 1, 8, .gap = -0.05, .waves = 0.3, .sectors = 14}},
    {"haustra", {4, 1, 8, .gap = 0.02, .haustra = 0.4, .waves = 0.3, .sectors = 16}},
    {"bridged in six places", {4, 2, 6, .gap = 0.3, .haustra = 0.1, .waves = 0.3, .bridges = 6, .bridge = 0.75}},
    {"grown together where the grid was coarse", {4, 2, 8, .gap = 0.1, .waves = 0.3, .grid = 0.5}},
    {"grown together along rows", {4, 2, 6, .gap = 0.2, .waves = 0.3, .bridges = 4, .bridge = 0.35, .seam = 3}},
};

/* What is aimed at on real bowels. */
static void check(const BowelFit *fit) {
  g_test_message("length %.3f of it, within %.3f, offset %.3f", fit->length, fit->within, fit->offset);
  g_assert_cmpfloat_with_epsilon(fit->length, 1, 0.03);
  g_assert_cmpfloat(fit->within, >=, 0.98);
  g_assert_cmpfloat(fit->offset, <, 0.15);
}

static void test_bowel(gconstpointer data) {
  const Bowel *bowel = data;
  SporeTriangleMesh mesh;
  SporeCurve known, line;
  SporeCentrelineReport report;
  SporeCentrelineOptions options = {0};
  SporeError error = SPORE_ERROR_INIT;
  bowel_create(&bowel->shape, &mesh, &known);
  bool done = spore_centreline_from_mesh(&mesh, &options, &line, &report, NULL, &error);
  g_assert_cmpstr(error.message, ==, "");
  g_assert_true(done);
  BowelFit fit = bowel_fit(&known, &line);
  g_test_message("%zu triangles, %.3f m, cover %.3f, %.2f s", mesh.triangle_count, spore_curve_length(&known),
                 report.cover, report.seconds);
  check(&fit);
  g_assert_cmpfloat(report.cover, >, 0.95);
  spore_curve_clear(&line);
  spore_curve_clear(&known);
  spore_triangle_mesh_clear(&mesh);
}

/* A line of which nothing is asked but that there is one, or a refusal. *farthest: the longest way of a vertex to it,
 * in radii of a bowel. */
static bool find(const SporeTriangleMesh *mesh, const double *ends, SporeCurve *line, SporeCentrelineReport *report,
                 double *farthest, SporeError *error) {
  g_autofree double *way = g_new(double, mesh->vertex_count);
  SporeCentrelineOptions options = {.ends_given = ends != NULL, .way = way};
  for (size_t k = 0; ends && k < 6; k++) options.ends[k / 3][k % 3] = ends[k];
  bool done = spore_centreline_from_mesh(mesh, &options, line, report, NULL, error);
  *farthest = 0;
  for (size_t i = 0; done && i < mesh->vertex_count; i++) {
    g_assert_cmpfloat(way[i], <, HUGE_VAL);
    *farthest = fmax(*farthest, way[i] / BOWEL_RADIUS);
  }
  if (!done) g_test_message("refused: %s", error->message);
  else
    g_test_message("%.3f m, cover %.3f, farthest %.2f radii, %zu pieces, %zu branches, the longest %.3f m%s",
                   report->length, report->cover, *farthest, report->components, report->branches,
                   report->branch[0].length, report->branch[0].returns ? ", back" : "");
  return done;
}

/* The place on the wall beside point i of the known line. */
static SporeVec3 wall_beside(const SporeTriangleMesh *mesh, const SporeCurve *known, size_t i, SporeVec3 toward) {
  SporeBvh *bvh = spore_bvh_create(mesh, NULL);
  SporeVec3 p = spore_vec3_load(known->points + 4 * i);
  double t = 0;
  g_assert_true(spore_bvh_ray(bvh, p, toward, &t, NULL));
  spore_bvh_free(bvh);
  return spore_vec3_add_scaled(p, t, toward);
}

/* Bowels grown together so widely that the line may take a short way: where it leaves the known line, the share of the
 * surface says so. */
static void test_grown_together(void) {
  static const BowelShape shapes[] = {
      {4, 1, 9.2, .gap = 0.2, .waves = 0.2, .bridges = 3, .bridge = 0.73},
      {2, 1, 7.6, .gap = 0.31, .waves = 0.2, .bridges = 3, .bridge = 0.81, .seam = 1.4},
      {4, 2, 4.3, .gap = 0.33, .waves = 0.2, .bridges = 7, .bridge = 0.82, .seam = 2.2},
      {4, 2, 5.8, .gap = 0.26, .waves = 0.2, .bridges = 11, .bridge = 0.74},
  };
  for (size_t k = 0; k < (tests_sanitized ? 1 : G_N_ELEMENTS(shapes)); k++) {
    SporeTriangleMesh mesh;
    SporeCurve known, line;
    SporeCentrelineReport report;
    SporeError error = SPORE_ERROR_INIT;
    double farthest;
    bowel_create(&shapes[k], &mesh, &known);
    if (find(&mesh, NULL, &line, &report, &farthest, &error)) {
      BowelFit fit = bowel_fit(&known, &line);
      g_test_message("within %.3f of it", fit.within);
      g_assert_true(fit.within >= 0.98 || report.cover < 0.95);
      spore_curve_clear(&line);
    }
    spore_curve_clear(&known);
    spore_triangle_mesh_clear(&mesh);
  }
}

/* Two places picked on the wall, there where the next loop touches: the line runs between their sections, through the
 * loop that they were picked on and all loops between. */
static void test_ends(void) {
  static const BowelShape shapes[] = {{4, 2, 6, .gap = 0.02, .waves = 0.3, .sectors = 12},
                                      {4, 1, 8, .gap = 0.3, .waves = 0.3, .bridges = 3, .bridge = 0.75}};
  for (size_t k = 0; k < G_N_ELEMENTS(shapes); k++) {
    SporeTriangleMesh mesh;
    SporeCurve known, line;
    SporeCentrelineReport report;
    SporeError error = SPORE_ERROR_INIT;
    double ends[6], farthest;
    bowel_create(&shapes[k], &mesh, &known);
    size_t from = known.count / 5, to = 4 * known.count / 5;
    spore_vec3_store(ends, wall_beside(&mesh, &known, from, spore_vec3(0, 0, 1)));
    spore_vec3_store(ends + 3, wall_beside(&mesh, &known, to, spore_vec3(0, 0, 1)));
    g_assert_true(find(&mesh, ends, &line, &report, &farthest, &error));
    SporeCurve between = {to - from, known.points + 4 * from};
    BowelFit fit = bowel_fit(&between, &line);
    check(&fit);
    spore_curve_clear(&line);
    spore_curve_clear(&known);
    spore_triangle_mesh_clear(&mesh);
  }
}

/* A bowel in two pieces: one is followed, and what is said of the surface counts both. */
static void test_two_pieces(void) {
  static const BowelShape shape = {4, 1, 8, .gap = 0.02, .sectors = 14};
  SporeTriangleMesh mesh, other;
  SporeCurve known, line;
  SporeCentrelineReport report;
  SporeError error = SPORE_ERROR_INIT;
  double farthest;
  bowel_create(&shape, &mesh, &known);
  g_assert_true(spore_triangle_mesh_copy(&other, &mesh, NULL));
  shape_move(&other, 0, 0, 2.02 * BOWEL_RADIUS);
  shape_append(&mesh, &other);
  g_assert_true(find(&mesh, NULL, &line, &report, &farthest, &error));
  g_assert_cmpuint(report.components, ==, 2);
  g_assert_cmpfloat(report.cover, <, 0.52);
  g_assert_cmpfloat(farthest, >, 8); /* no way leads to the other piece */
  spore_curve_clear(&line);
  spore_curve_clear(&known);
  spore_triangle_mesh_clear(&other);
  spore_triangle_mesh_clear(&mesh);
}

/* A hole of half a radius in the wall of a packed bowel. */
static void test_hole(void) {
  static const BowelShape shape = {4, 1, 8, .gap = 0.05, .waves = 0.3, .sectors = 20};
  SporeTriangleMesh mesh;
  SporeCurve known, line;
  SporeCentrelineReport report;
  SporeError error = SPORE_ERROR_INIT;
  size_t kept = 0;
  double farthest;
  bowel_create(&shape, &mesh, &known);
  SporeVec3 hole = wall_beside(&mesh, &known, known.count / 3, spore_vec3(0, 0, 1));
  for (size_t t = 0; t < mesh.triangle_count; t++) {
    const uint32_t *corner = mesh.triangles + 3 * t;
    if (spore_vec3_distance(hole, spore_vec3_load(mesh.vertices + 3 * (size_t)corner[0])) < 0.5 * BOWEL_RADIUS)
      continue;
    memmove(mesh.triangles + 3 * kept++, corner, 3 * sizeof *corner);
  }
  g_assert_cmpuint(kept, <, mesh.triangle_count);
  mesh.triangle_count = kept;
  g_assert_true(find(&mesh, NULL, &line, &report, &farthest, &error));
  BowelFit fit = bowel_fit(&known, &line);
  check(&fit);
  g_assert_cmpfloat(farthest, <, 2.5);
  spore_curve_clear(&line);
  spore_curve_clear(&known);
  spore_triangle_mesh_clear(&mesh);
}

static void test_torus(void) {
  SporeTriangleMesh mesh;
  SporeCurve line;
  SporeCentrelineReport report;
  SporeError error = SPORE_ERROR_INIT;
  double farthest;
  shape_torus(&mesh, 0.06, 0.01, 80, 20);
  g_assert_false(find(&mesh, NULL, &line, &report, &farthest, &error));
  g_assert_nonnull(strstr(error.message, "ring"));
  double ends[6] = {0.07, 0, 0, 0, 0.07, 0};
  error = (SporeError)SPORE_ERROR_INIT;
  g_assert_true(find(&mesh, ends, &line, &report, &farthest, &error));
  spore_curve_clear(&line);
  spore_triangle_mesh_clear(&mesh);
}

/* A tree of airways: the longest way is followed, and the share that is said is that of its surface. */
static void test_tree(void) {
  SporeTriangleMesh mesh;
  SporeCurve line;
  SporeCentrelineReport report;
  SporeError error = SPORE_ERROR_INIT;
  double farthest;
  bowel_tree(&mesh);
  if (find(&mesh, NULL, &line, &report, &farthest, &error)) {
    g_assert_cmpfloat(report.cover, <, 0.6);
    g_assert_cmpuint(report.branches, >=, 3);
    g_assert_cmpfloat(farthest, >, 8);
    spore_curve_clear(&line);
  } else g_assert_nonnull(strstr(error.message, "branches"));
  spore_triangle_mesh_clear(&mesh);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  for (gsize i = 0; i < G_N_ELEMENTS(bowels); i++) {
    g_autofree char *path = g_strdup_printf("/bowels/%s", bowels[i].name);
    g_test_add_data_func(path, &bowels[i], test_bowel);
  }
  g_test_add_func("/bowels/grown together widely", test_grown_together);
  g_test_add_func("/bowels/ends", test_ends);
  g_test_add_func("/bowels/two_pieces", test_two_pieces);
  g_test_add_func("/bowels/hole", test_hole);
  g_test_add_func("/bowels/torus", test_torus);
  g_test_add_func("/bowels/tree", test_tree);
  return g_test_run();
}
