/* Pieces, flaws, holes and smoothing of meshes whose figures are known. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/edit.h"
#include "tests/mesh/shapes.h"

static SporeMeshReport report_of(const SporeTriangleMesh *mesh) {
  SporeMeshReport report;
  g_assert_true(spore_triangle_mesh_validate(mesh, NULL));
  g_assert_true(spore_triangle_mesh_report(mesh, &report, NULL));
  return report;
}

static SporeTriangleMesh box(double x, double size, size_t n) {
  SporeTriangleMesh mesh = {0};
  const double lower[3] = {x, 0, 0}, upper[3] = {x + size, size, size};
  shape_box(&mesh, lower, upper, n);
  return mesh;
}

/* Without the triangles whose middle lies nearer than `radius` to a point. */
static void cut_hole(SporeTriangleMesh *mesh, SporeVec3 centre, double radius) {
  size_t kept = 0;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    SporeVec3 middle = {0, 0, 0};
    for (size_t k = 0; k < 3; k++)
      middle = spore_vec3_add_scaled(middle, 1. / 3,
                                     spore_vec3_load(mesh->vertices + 3 * (size_t)mesh->triangles[3 * t + k]));
    if (spore_vec3_distance(middle, centre) < radius) continue;
    memmove(mesh->triangles + 3 * kept++, mesh->triangles + 3 * t, 3 * sizeof *mesh->triangles);
  }
  g_assert_cmpuint(kept, <, mesh->triangle_count);
  mesh->triangle_count = kept;
}

static void test_pieces(void) {
  SporeTriangleMesh mesh = box(0, 1, 3), other = box(2, 2, 2), part, whole = {0};
  size_t first = mesh.triangle_count, second = other.triangle_count, count;
  shape_append(&mesh, &other);
  uint32_t *pieces;
  g_assert_true(spore_triangle_mesh_pieces(&mesh, &pieces, &count, NULL));
  g_assert_cmpuint(count, ==, 2);
  for (size_t p = 0; p < 2; p++) {
    g_assert_true(spore_triangle_mesh_extract(&mesh, pieces, (uint32_t)p, &part, NULL));
    SporeMeshReport report = report_of(&part);
    g_assert_cmpuint(part.triangle_count, ==, p ? second : first);
    g_assert_true(report.closed);
    g_assert_cmpfloat_with_epsilon(report.volume, p ? 8 : 1, 1e-12);
    g_assert_true(spore_triangle_mesh_append(&whole, &part, NULL));
    spore_triangle_mesh_clear(&part);
  }
  g_assert_cmpuint(whole.triangle_count, ==, mesh.triangle_count);
  g_assert_cmpfloat_with_epsilon(report_of(&whole).volume, 9, 1e-12);
  spore_free(pieces);
  spore_triangle_mesh_clear(&mesh);
  spore_triangle_mesh_clear(&other);
  spore_triangle_mesh_clear(&whole);
}

/* A flat triangle between two others (its corner in the middle of their edge), one over an open edge, a duplicate. */
static void test_clean(void) {
  SporeTriangleMesh mesh = box(0, 1, 1);
  SporeMeshReport before = report_of(&mesh);
  uint32_t a = mesh.triangles[0], b = mesh.triangles[1], c = mesh.triangles[2], m = (uint32_t)mesh.vertex_count;
  SporeTriangleMesh more = {0};
  g_assert_true(spore_triangle_mesh_allocate(&more, 1, 3, NULL));
  SporeVec3 middle = spore_vec3_scale(
      0.5, spore_vec3_add(spore_vec3_load(mesh.vertices + 3 * a), spore_vec3_load(mesh.vertices + 3 * b)));
  spore_vec3_store(more.vertices, middle);
  size_t t = mesh.triangle_count;
  shape_append(&mesh, &more);
  /* a b c becomes a m c and m b c; a b m, flat, closes them toward the neighbour across a-b; then m b c once more. */
  const uint32_t corners[4][3] = {{m, b, c}, {a, b, m}, {b, c, m}, {a, m, c}};
  memcpy(mesh.triangles + 3 * t, corners, 9 * sizeof(uint32_t));
  memcpy(mesh.triangles, corners[3], 3 * sizeof(uint32_t));
  SporeMeshReport spoilt = report_of(&mesh);
  g_assert_cmpuint(spoilt.degenerate_triangles, ==, 1);
  g_assert_false(spoilt.closed);
  g_assert_true(spore_triangle_mesh_clean(&mesh, 1e-6, NULL));
  SporeMeshReport after = report_of(&mesh);
  g_assert_cmpuint(after.degenerate_triangles, ==, 0);
  g_assert_true(after.closed);
  g_assert_cmpuint(mesh.triangle_count, ==, t + 2);
  g_assert_cmpfloat_with_epsilon(after.volume, before.volume, 1e-12);
  g_assert_cmpfloat_with_epsilon(after.area, before.area, 1e-12);
  spore_triangle_mesh_clear(&mesh);
  spore_triangle_mesh_clear(&more);
}

/* All triangles on top of one face: flat holes are filled flat, volume and area come back exactly. */
static void test_flat_hole(void) {
  SporeTriangleMesh mesh = box(0, 1, 6);
  SporeMeshReport before = report_of(&mesh);
  cut_hole(&mesh, spore_vec3(0.5, 1, 0.5), 0.3);
  g_assert_cmpuint(report_of(&mesh).boundary_edges, >, 4);
  g_assert_true(spore_triangle_mesh_fill_holes(&mesh, 0, NULL, NULL));
  SporeMeshReport after = report_of(&mesh);
  g_assert_true(after.closed);
  g_assert_cmpfloat_with_epsilon(after.volume, before.volume, 1e-12);
  g_assert_cmpfloat_with_epsilon(after.area, before.area, 1e-12);
  spore_triangle_mesh_clear(&mesh);
}

/* Two holes in a ball, of which the limit lets one be; a hole of many edges. */
static void test_hole_sizes(void) {
  SporeTriangleMesh mesh = {0};
  shape_ball(&mesh, 1, 20);
  cut_hole(&mesh, spore_vec3(1, 0, 0), 0.15);
  size_t small = report_of(&mesh).boundary_edges;
  cut_hole(&mesh, spore_vec3(-1, 0, 0), 0.6);
  size_t both = report_of(&mesh).boundary_edges;
  g_assert_cmpuint(both, >, 2 * small);
  g_assert_true(spore_triangle_mesh_fill_holes(&mesh, small, NULL, NULL));
  g_assert_cmpuint(report_of(&mesh).boundary_edges, ==, both - small);
  g_assert_true(spore_triangle_mesh_fill_holes(&mesh, 0, NULL, NULL));
  g_assert_true(report_of(&mesh).closed);
  spore_triangle_mesh_clear(&mesh);
  shape_ball(&mesh, 1, 100);
  cut_hole(&mesh, spore_vec3(0, 0, 1), 1.2);
  g_assert_cmpuint(report_of(&mesh).boundary_edges, >, 300);
  g_assert_true(spore_triangle_mesh_fill_holes(&mesh, 0, NULL, NULL));
  g_assert_true(report_of(&mesh).closed);
  spore_triangle_mesh_clear(&mesh);
}

/* An open tetrahedron whose fourth face is there twice as an edge only: what would make a third triangle stays open. */
static void test_hole_that_stays(void) {
  SporeTriangleMesh mesh = {0};
  g_assert_true(spore_triangle_mesh_allocate(&mesh, 4, 2, NULL));
  const double vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
  memcpy(mesh.vertices, vertices, sizeof vertices);
  memcpy(mesh.triangles, triangles, sizeof triangles);
  g_assert_true(
      spore_triangle_mesh_fill_holes(&mesh, 0, NULL, NULL)); /* the loop 0 1 2 3: only the diagonal 1-3 is free */
  SporeMeshReport report = report_of(&mesh);
  g_assert_true(report.closed);
  g_assert_cmpuint(mesh.triangle_count, ==, 4);
  g_assert_cmpfloat_with_epsilon(fabs(report.volume), 1. / 6, 1e-12);
  mesh.triangle_count = 1;
  g_assert_true(spore_triangle_mesh_fill_holes(&mesh, 0, NULL, NULL)); /* a sheet: its own back would close it */
  g_assert_cmpuint(report_of(&mesh).nonmanifold_edges, ==, 0);
  spore_triangle_mesh_clear(&mesh);
}

/* Roughness: RMS of the radius about its mean. */
static double roughness(const SporeTriangleMesh *mesh) {
  double sum = 0, squares = 0;
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    double r = spore_vec3_length(spore_vec3_load(mesh->vertices + 3 * i));
    sum += r;
    squares += r * r;
  }
  double n = (double)mesh->vertex_count;
  return sqrt(fmax(squares / n - sum / n * (sum / n), 0));
}

static void test_smooth(void) {
  SporeTriangleMesh mesh = {0};
  shape_ball(&mesh, 1, 12);
  GRand *rand = g_rand_new_with_seed(7);
  for (size_t i = 0; i < mesh.vertex_count; i++)
    spore_vec3_store(mesh.vertices + 3 * i, spore_vec3_scale(1 + g_rand_double_range(rand, -0.03, 0.03),
                                                             spore_vec3_load(mesh.vertices + 3 * i)));
  g_rand_free(rand);
  double rough = roughness(&mesh), volume = report_of(&mesh).volume;
  g_assert_true(spore_triangle_mesh_smooth(&mesh, 20, NULL, NULL));
  g_test_message("roughness %.4f to %.4f", rough, roughness(&mesh));
  g_assert_cmpfloat(roughness(&mesh), <, 0.5 * rough);
  g_assert_cmpfloat_with_epsilon(report_of(&mesh).volume, volume, 1e-9 * volume);
  spore_triangle_mesh_clear(&mesh);
}

/* A plate of two layers of corners collapses under many rounds: it stays as it came instead, whatever is beside it. */
static void test_smooth_thin(void) {
  SporeTriangleMesh plate = {0}, both = {0};
  const double lower[3] = {3, 0, 0}, upper[3] = {3.001, 1, 1};
  shape_ball(&both, 1, 8);
  shape_box(&plate, lower, upper, 1);
  shape_append(&both, &plate);
  double volume = report_of(&both).volume, area = report_of(&both).area;
  g_assert_true(spore_triangle_mesh_smooth(&both, 1000, NULL, NULL));
  SporeMeshReport report = report_of(&both);
  g_assert_cmpfloat_with_epsilon(report.volume, volume, 0.01 * volume);
  g_assert_cmpfloat(report.area, <, 1.2 * area);
  g_assert_cmpfloat(report.diagonal, <, 6);
  spore_triangle_mesh_clear(&plate);
  spore_triangle_mesh_clear(&both);
}

/* A flat sheet with a straight rim stays where it is, its rim in its own lines. */
static void test_smooth_rim(void) {
  SporeTriangleMesh mesh = box(0, 1, 6);
  size_t kept = 0;
  for (size_t t = 0; t < mesh.triangle_count; t++) {
    bool top = true;
    for (size_t k = 0; k < 3; k++) top &= mesh.vertices[3 * (size_t)mesh.triangles[3 * t + k] + 1] == 1;
    if (top) memmove(mesh.triangles + 3 * kept++, mesh.triangles + 3 * t, 3 * sizeof *mesh.triangles);
  }
  mesh.triangle_count = kept;
  g_assert_true(spore_triangle_mesh_weld(&mesh, 1e-6, NULL));
  g_assert_true(spore_triangle_mesh_smooth(&mesh, 10, NULL, NULL));
  for (size_t i = 0; i < mesh.vertex_count; i++) g_assert_cmpfloat_with_epsilon(mesh.vertices[3 * i + 1], 1, 1e-12);
  SporeMeshReport report = report_of(&mesh);
  g_assert_cmpfloat(report.area, >, 0.9);
  spore_triangle_mesh_clear(&mesh);
}

static bool refuse(void *data, double fraction, const char *stage) { return false; }

static void test_cancel(void) {
  SporeTriangleMesh mesh = {0}, copy;
  shape_ball(&mesh, 1, 8);
  cut_hole(&mesh, spore_vec3(0, 0, 1), 0.3);
  g_assert_true(spore_triangle_mesh_copy(&copy, &mesh, NULL));
  SporeProgress progress = {.report = refuse};
  SporeError error = SPORE_ERROR_INIT;
  g_assert_false(spore_triangle_mesh_smooth(&mesh, 5, &progress, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_CANCELLED);
  g_assert_false(spore_triangle_mesh_fill_holes(&mesh, 0, &progress, &error));
  g_assert_cmpuint(mesh.triangle_count, ==, copy.triangle_count);
  g_assert_cmpmem(mesh.vertices, 24 * mesh.vertex_count, copy.vertices, 24 * copy.vertex_count);
  spore_triangle_mesh_clear(&mesh);
  spore_triangle_mesh_clear(&copy);
}

/* Each allocation refused in turn: an error, or the whole result; never a crash or a half-done mesh. */
static void test_no_memory(void) {
  bool through = false;
  for (uint64_t n = 1; !through; n++) {
    SporeTriangleMesh mesh = {0};
    shape_ball(&mesh, 1, 4);
    cut_hole(&mesh, spore_vec3(0, 0, 1), 0.5);
    SporeError error = SPORE_ERROR_INIT;
    spore_allocation_fail_at(n);
    through = spore_triangle_mesh_clean(&mesh, 1e-6, &error) &&
              spore_triangle_mesh_fill_holes(&mesh, 0, NULL, &error) &&
              spore_triangle_mesh_smooth(&mesh, 2, NULL, &error);
    spore_allocation_fail_at(0);
    report_of(&mesh);
    g_assert_true(through || error.code == SPORE_ERROR_MEMORY);
    spore_triangle_mesh_clear(&mesh);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/mesh-edit/pieces", test_pieces);
  g_test_add_func("/mesh-edit/clean", test_clean);
  g_test_add_func("/mesh-edit/flat-hole", test_flat_hole);
  g_test_add_func("/mesh-edit/hole-sizes", test_hole_sizes);
  g_test_add_func("/mesh-edit/hole-that-stays", test_hole_that_stays);
  g_test_add_func("/mesh-edit/smooth", test_smooth);
  g_test_add_func("/mesh-edit/smooth-thin", test_smooth_thin);
  g_test_add_func("/mesh-edit/smooth-rim", test_smooth_rim);
  g_test_add_func("/mesh-edit/cancel", test_cancel);
  g_test_add_func("/mesh-edit/no-memory", test_no_memory);
  return g_test_run();
}
