/* Sphere sets and tetrahedra as text: what is written reads back to the same bits, and bad lines are named. */
#include <string.h>

#include "core/base/memory.h"
#include "core/io/mesh_import.h"
#include "tests/mesh/shapes.h"

static void check_message(GError *error, const char *words) {
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_INPUT);
  if (!strstr(error->message, words)) g_error("\"%s\" does not say \"%s\"", error->message, words);
  g_assert_null(strchr(error->message, '\n'));
  g_error_free(error);
}

static void check_spheres_refused(const char *text, const char *words) {
  SporeSphereSet set = {0};
  GError *error = NULL;
  g_assert_false(spore_spheres_parse("a.spheres", text, strlen(text), &set, &error));
  g_assert_null(set.spheres);
  check_message(error, words);
}

static void test_spheres(void) {
  double values[] = {0.1, -1. / 3, 1e-9, 0.05, 1e5, 2, 3.0000000000000004, 1e-300};
  SporeSphereSet set = {2, values}, again = {0};
  gsize size;
  char *text = spore_spheres_format(&set, &size);
  GError *error = NULL;
  g_assert_cmpuint(size, ==, strlen(text));
  g_assert_true(spore_spheres_parse("a.spheres", text, size, &again, &error));
  g_assert_no_error(error);
  g_assert_cmpmem(again.spheres, again.count * 4 * sizeof(double), values, sizeof values);
  spore_sphere_set_clear(&again);
  g_free(text);
}

/* Weights go to the file and come back; of all spheres, or of none. */
static void test_spheres_weights(void) {
  double values[] = {0.1, -1. / 3, 1e-9, 0.05, 1e5, 2, 3.0000000000000004, 1e-300}, weights[] = {1. / 3, 0.7};
  SporeSphereSet set = {.count = 2, .spheres = values, .weights = weights, .level = 0.1}, again = {0};
  gsize size;
  g_autofree char *text = spore_spheres_format(&set, &size);
  GError *error = NULL;
  g_assert_true(spore_spheres_parse("a.spheres", text, size, &again, &error));
  g_assert_no_error(error);
  g_assert_cmpmem(again.spheres, again.count * 4 * sizeof(double), values, sizeof values);
  g_assert_cmpmem(again.weights, again.count * sizeof(double), weights, sizeof weights);
  g_assert_cmpfloat(again.level, ==, 0.1);
  spore_sphere_set_clear(&again);
  check_spheres_refused("0 0 0 1 1\n0 0 0 1\n", "has no weight");
  check_spheres_refused("0 0 0 1\n0 0 0 1 1\n", "have no weight");
  check_spheres_refused("0 0 0 1 0\n", "not above 0");
  check_spheres_refused("0 0 0 1 2000\n", "weight 2000");
  check_spheres_refused("0 0 0 1 1 1\n", "behind the five numbers");
  check_spheres_refused("# level -1\n0 0 0 1 1\n", "a.spheres:1:9: the level -1 is below 0");
  check_spheres_refused("# of a liver\n# level 0.1\n0 0 0 1\n", "a.spheres:3:7: the sphere has no weight");
  check_spheres_refused("level 0.1\n0 0 0 1 1\n", "a.spheres:1:1");
  check_spheres_refused("# level 1e300\n0 0 0 1 1\n", "the level of the sphere set is 1e+300");
}

/* Only a comment that is a level and nothing else is one. */
static void test_spheres_level(void) {
  static const struct {
    const char *text;
    double level;
  } cases[] = {{"#level 0.1\n0 0 0 1 1", 0.1},        {"# a\r\n# level 0.25\r\n# b\n0 0 0 1 1", 0.25},
               {"# level of 3\n0 0 0 1 1", 0},        {"# level 3 of 4\n0 0 0 1 1", 0},
               {"# level\n0.5 0 0 1 1", 0},           {"0 0 0 1 1 # level 1\n", 0},
               {"0 0 0 1 1\n# level 1\n1 0 0 1 1", 0}};
  for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
    SporeSphereSet set = {0};
    GError *error = NULL;
    g_assert_true(spore_spheres_parse("a.spheres", cases[i].text, strlen(cases[i].text), &set, &error));
    g_assert_no_error(error);
    g_assert_cmpfloat(set.level, ==, cases[i].level);
    spore_sphere_set_clear(&set);
  }
}

/* Blank lines, comments, carriage returns, and no end of line at the end: not NUL-terminated either. */
static void test_spheres_layout(void) {
  static const char text[] = "# from the liver\r\n\r\n 1 2 3 0.5 # the first\r\n\t4\t5 6 +1e-1X";
  SporeSphereSet set = {0};
  GError *error = NULL;
  g_assert_true(spore_spheres_parse("a.spheres", text, sizeof text - 2, &set, &error));
  g_assert_no_error(error);
  g_assert_cmpuint(set.count, ==, 2);
  g_assert_cmpfloat(set.spheres[3], ==, 0.5);
  g_assert_cmpfloat(set.spheres[7], ==, 0.1);
  spore_sphere_set_clear(&set);
}

static void test_curve(void) {
  double values[] = {0.1, -1. / 3, 1e-9, 0.05, 1e5, 2, 3.0000000000000004, 1e-300};
  SporeCurve curve = {2, values}, again = {0};
  gsize size;
  GError *error = NULL;
  g_autofree char *text = spore_curve_format(&curve, &size);
  g_assert_true(spore_curve_parse("a.curve", text, size, &again, &error));
  g_assert_no_error(error);
  g_assert_cmpmem(again.points, again.count * 4 * sizeof(double), values, sizeof values);
  spore_curve_clear(&again);
}

static void check_curve_refused(const char *text, const char *words) {
  SporeCurve curve = {0};
  GError *error = NULL;
  g_assert_false(spore_curve_parse("a.curve", text, strlen(text), &curve, &error));
  g_assert_null(curve.points);
  check_message(error, words);
}

static void test_curve_refused(void) {
  check_curve_refused("", "a.curve:1:1: there is no point");
  check_curve_refused("1 2 3 0.1\n", "at least two were expected");
  check_curve_refused("1 2 3 0.1\n4 5 6 0\n", "a.curve:2:7: the radius 0 is not above 0");
  check_curve_refused("1 2 3 0.1\n1 2 3 0.1\n", "lies where the one before it does");
  check_curve_refused("1 2 3\n", "the radius at a point");
  check_curve_refused("1 2 3\n4 5 6 1\n", "a.curve:2:1: line 1 has fewer than four numbers");
}

static void test_spheres_refused(void) {
  check_spheres_refused("", "a.spheres:1:1: there is no sphere");
  check_spheres_refused("# nothing\n", "there is no sphere");
  check_spheres_refused("1 2 3 1\n1 2 3\n4 5 6 1\n", "a.spheres:3:1: line 2 has fewer than four numbers");
  check_spheres_refused("1 2 3 1 7 7\n", "there is more behind");
  check_spheres_refused("1 2 3 0\n", "a.spheres:1:7: the radius 0 is not above 0");
  check_spheres_refused("1 2 3 -1\n", "not above 0");
  check_spheres_refused("1 2 3 nan\n", "\"nan\" is not the radius of a sphere");
  check_spheres_refused("1 two 3 1\n", "a.spheres:1:3: \"two\" is not the y of a sphere");
  check_spheres_refused("1 2 3", "the file ends here; expected the radius");
  check_spheres_refused("1 2 3 1,5\n", "\"1,5\"");
}

static void check_same(const SporeTetrahedralMesh *a, const SporeTetrahedralMesh *b) {
  g_assert_cmpmem(a->vertices, a->vertex_count * 3 * sizeof(double), b->vertices, b->vertex_count * 3 * sizeof(double));
  g_assert_cmpmem(a->tetrahedra, a->tetrahedron_count * 4 * sizeof(guint32), b->tetrahedra,
                  b->tetrahedron_count * 4 * sizeof(guint32));
}

static void test_medit(void) {
  SporeTetrahedralMesh mesh = {0}, again = {0};
  shape_tetrahedral_box(&mesh, 3, 1. / 3);
  gsize size;
  char *text = spore_medit_format(&mesh, &size);
  GError *error = NULL;
  g_assert_true(spore_medit_parse("a.mesh", text, size, &again, &error));
  g_assert_no_error(error);
  check_same(&mesh, &again);
  g_free(text);
  spore_tetrahedral_mesh_clear(&mesh);
  spore_tetrahedral_mesh_clear(&again);
}

/* As other programs write: sections that are not needed, vertices that no cell uses, cells turned over. */
static void test_medit_of_others(void) {
  static const char text[] =
      "MeshVersionFormatted 1\nDimension\n3\n# a comment\nVertices 6\n9 9 9 1\n0 0 0 1\n1 0 0 1\n"
      "0 1 0 1\n0 0 1 1\n8 8 8 1\nTriangles\n1\n2 3 4 7\nRequiredVertices\n2\n1\n2\nTetrahedra\n1\n"
      "2 4 3 5 11\nEnd\nand what comes behind";
  SporeTetrahedralMesh mesh = {0};
  GError *error = NULL;
  g_assert_true(spore_medit_parse("a.mesh", text, strlen(text), &mesh, &error));
  g_assert_no_error(error);
  g_assert_cmpuint(mesh.vertex_count, ==, 4);
  g_assert_cmpuint(mesh.tetrahedron_count, ==, 1);
  SporeTetrahedraQuality quality;
  spore_tetrahedral_mesh_quality(&mesh, &quality);
  g_assert_cmpfloat_with_epsilon(quality.volume, 1. / 6, 1e-12);
  spore_tetrahedral_mesh_clear(&mesh);
}

static void check_medit_refused(const char *text, const char *words) {
  SporeTetrahedralMesh mesh = {0};
  GError *error = NULL;
  g_assert_false(spore_medit_parse("a.mesh", text, strlen(text), &mesh, &error));
  g_assert_null(mesh.vertices);
  check_message(error, words);
}

#define HEAD "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"

static void test_medit_refused(void) {
  check_medit_refused("", "a.mesh:1:1: this is not a Medit mesh");
  check_medit_refused("OFF\n", "this is not a Medit mesh");
  check_medit_refused("MeshVersionFormatted 2\nDimension 2\n", "a.mesh:2:11: the mesh is flat");
  check_medit_refused(HEAD "End\n", "the file has no tetrahedra");
  check_medit_refused(HEAD "Tetrahedra\n1\n1 2 3 5 0\n", "a.mesh:11:7: \"5\" is not the number of a vertex");
  check_medit_refused(HEAD "Tetrahedra\n1\n0 2 3 4 0\n", "from 1 to 4");
  check_medit_refused(HEAD "Tetrahedra\n1\n1 2 3 3 0\n", "a.mesh");
  check_medit_refused(HEAD "Tetrahedra\n1000000\n1 2 3 4 0\n", "too short");
  check_medit_refused(HEAD "Hexahedra\n1\n1 2 3 4 1 2 3 4 0\n", "cells other than tetrahedra");
  check_medit_refused("MeshVersionFormatted 2\nTetrahedra\n1\n", "before the vertices");
  check_medit_refused("MeshVersionFormatted 2\nVertices\n4\n0 0 inf 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n", "\"inf\"");
}

static gsize lines_of(const char *text) {
  gsize lines = 0;
  for (; *text; text++) lines += *text == '\n';
  return lines;
}

/* Others read these; here: the counts and the corners of the last cell, numbered from 1 and from 0. */
static void test_written_for_others(void) {
  SporeTetrahedralMesh mesh = {0};
  shape_tetrahedral_box(&mesh, 1, 1);
  g_assert_cmpuint(mesh.vertex_count, ==, 8);
  g_assert_cmpuint(mesh.tetrahedron_count, ==, 6);
  gsize size;
  const guint32 *last = mesh.tetrahedra + 20;
  char *gmsh = spore_gmsh_format(&mesh, &size);
  char *cell =
      g_strdup_printf("\n6 4 2 1 1 %u %u %u %u\n$EndElements\n", last[0] + 1, last[1] + 1, last[2] + 1, last[3] + 1);
  g_assert_true(g_str_has_suffix(gmsh, cell));
  g_assert_nonnull(strstr(gmsh, "$Nodes\n8\n1 "));
  g_assert_cmpuint(lines_of(gmsh), ==, 3 + 2 + 8 + 1 + 2 + 6 + 1);
  g_assert_cmpuint(size, ==, strlen(gmsh));
  g_free(cell);
  g_free(gmsh);
  char *vtu = spore_vtu_format(&mesh, &size);
  cell = g_strdup_printf("\n%u %u %u %u\n</DataArray>\n", last[0], last[1], last[2], last[3]);
  g_assert_nonnull(strstr(vtu, cell));
  g_assert_nonnull(strstr(vtu, "NumberOfPoints=\"8\" NumberOfCells=\"6\""));
  g_assert_nonnull(strstr(vtu, "\n20\n24\n</DataArray>"));
  g_assert_cmpuint(size, ==, strlen(vtu));
  g_free(cell);
  g_free(vtu);
  spore_tetrahedral_mesh_clear(&mesh);
}

static void test_off(void) {
  SporeTriangleMesh mesh = {0}, again = {0};
  shape_ball(&mesh, 1. / 3, 4);
  gsize size;
  char *text = spore_off_format(&mesh, &size);
  GError *error = NULL;
  g_assert_true(spore_mesh_decode("a.off", "a.off", text, size, 0, 0, &again, NULL, &error));
  g_assert_no_error(error);
  g_assert_cmpmem(mesh.vertices, mesh.vertex_count * 3 * sizeof(double), again.vertices,
                  again.vertex_count * 3 * sizeof(double));
  g_assert_cmpmem(mesh.triangles, mesh.triangle_count * 3 * sizeof(guint32), again.triangles,
                  again.triangle_count * 3 * sizeof(guint32));
  g_free(text);
  spore_triangle_mesh_clear(&mesh);
  spore_triangle_mesh_clear(&again);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/text-formats/spheres", test_spheres);
  g_test_add_func("/text-formats/spheres-weights", test_spheres_weights);
  g_test_add_func("/text-formats/spheres-level", test_spheres_level);
  g_test_add_func("/text-formats/spheres-layout", test_spheres_layout);
  g_test_add_func("/text-formats/spheres-refused", test_spheres_refused);
  g_test_add_func("/text-formats/curve", test_curve);
  g_test_add_func("/text-formats/curve-refused", test_curve_refused);
  g_test_add_func("/text-formats/medit", test_medit);
  g_test_add_func("/text-formats/medit-of-others", test_medit_of_others);
  g_test_add_func("/text-formats/medit-refused", test_medit_refused);
  g_test_add_func("/text-formats/written-for-others", test_written_for_others);
  g_test_add_func("/text-formats/off", test_off);
  return g_test_run();
}
