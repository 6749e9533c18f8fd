/* Tetrahedra in sound and in dirty surfaces: the method that must be used, the number of cells, their quality, volume.
 */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/profile.h"
#include "core/generate/tetrahedra.h"
#include "tests/mesh/shapes.h"

#define CHAIN .method = SPORE_TETRAHEDRA_METHODS

typedef struct {
  SporeTetrahedralMesh mesh;
  SporeTetrahedraReport report;
} Result;

static const double low[3] = {0, 0, 0}, high[3] = {0.1, 0.1, 0.1};

/* Meshes and checks what holds for every result; clears the surface. */
static Result fill(SporeTriangleMesh *surface, SporeTetrahedraOptions options, const char *method) {
  Result result;
  GError *error = NULL;
  gboolean done = spore_tetrahedra_from_mesh("organ", surface, &options, &result.mesh, &result.report, NULL, &error);
  if (!SPORE_HAVE_CGAL && options.method == SPORE_TETRAHEDRA_METHODS) method = "voxels";
  g_assert_no_error(error);
  g_assert_true(done);
  SporeError invalid = SPORE_ERROR_INIT;
  g_assert_true(spore_tetrahedral_mesh_validate(&result.mesh, &invalid));
  g_test_message("%s: %" G_GSIZE_FORMAT " cells, least angle %.1f, Hausdorff %.2f%%, volume %+.1f%%",
                 spore_tetrahedra_method_names[result.report.method], result.mesh.tetrahedron_count,
                 result.report.quality.min_dihedral_deg, 100 * result.report.hausdorff,
                 100 * result.report.volume_change);
  g_assert_cmpstr(spore_tetrahedra_method_names[result.report.method], ==, method);
  g_assert_cmpfloat(result.report.quality.min_dihedral_deg, >=, 10);
  g_assert_cmpfloat(result.report.seconds, >, 0);
  spore_triangle_mesh_clear(surface);
  return result;
}

static void check_refused(SporeTriangleMesh *surface, SporeTetrahedraOptions options, int code, const char *words) {
  SporeTetrahedralMesh mesh;
  GError *error = NULL;
  g_assert_false(spore_tetrahedra_from_mesh("organ", surface, &options, &mesh, NULL, NULL, &error));
  g_assert_error(error, SPORE_ERROR, code);
  if (!strstr(error->message, words)) g_error("\"%s\" does not say \"%s\"", error->message, words);
  g_assert_true(g_str_has_prefix(error->message, "organ: "));
  g_assert_null(strchr(error->message, '\n'));
  g_assert_null(mesh.vertices);
  g_test_message("%s", error->message);
  g_error_free(error);
}

static void check_cells(Result *result, double wanted) {
  g_assert_cmpfloat((double)result->mesh.tetrahedron_count, >=, 0.88 * wanted);
  g_assert_cmpfloat((double)result->mesh.tetrahedron_count, <=, 1.12 * wanted);
}

static void test_ball(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 12);
  shape_move(&surface, 1, -2, 3); /* far from the origin */
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 1000}, "direct");
  check_cells(&result, 1000);
  g_assert_cmpfloat(result.report.hausdorff, <, 0.02);
  g_assert_cmpfloat(fabs(result.report.volume_change), <, 0.05);
  for (gsize i = 0; i < result.mesh.vertex_count; i++) {
    SporeVec3 p = spore_vec3_load(result.mesh.vertices + 3 * i);
    g_assert_cmpfloat(spore_vec3_distance(p, spore_vec3(1, -2, 3)), <=, 0.05 * 1.02);
  }
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* The same in millimetres: the mesh is the same, a thousand times as large. */
static void test_scale(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 50, 12);
  Result large = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 500}, "direct");
  check_cells(&large, 500);
  spore_tetrahedral_mesh_clear(&large.mesh);
}

static void test_cube(void) {
  SporeTriangleMesh surface = {0};
  shape_box(&surface, low, high, 4);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 2000, .tolerance = 0.06}, "direct");
  check_cells(&result, 2000);
  g_assert_cmpfloat(result.report.hausdorff, <, 0.06); /* corners are cut */
  spore_tetrahedral_mesh_clear(&result.mesh);
}

static void test_torus(void) {
  SporeTriangleMesh surface = {0};
  shape_torus(&surface, 0.05, 0.02, 40, 20);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 1500}, "direct");
  check_cells(&result, 1500);
  g_assert_cmpfloat(fabs(result.report.volume_change), <, 0.12);
  uint32_t *triangles;
  size_t count, edges;
  uint32_t *pairs;
  g_assert_true(spore_tetrahedral_mesh_boundary(&result.mesh, &triangles, &count));
  g_assert_true(spore_edges_of_triangles(triangles, count, &pairs, &edges));
  gsize outer = 0;
  char *seen = g_malloc0(result.mesh.vertex_count);
  for (gsize i = 0; i < 3 * count; i++) outer += !seen[triangles[i]], seen[triangles[i]] = 1;
  g_assert_cmpint((int)outer - (int)edges + (int)count, ==, 0); /* the hole is still there */
  g_free(seen);
  spore_free(pairs);
  spore_free(triangles);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* By size: edges of about that length. */
static void test_size(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 12);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .size = 0.015}, "direct");
  uint32_t *pairs;
  size_t edges;
  double sum = 0;
  g_assert_true(spore_edges_of_tetrahedra(result.mesh.tetrahedra, result.mesh.tetrahedron_count, &pairs, &edges));
  for (gsize i = 0; i < edges; i++)
    sum += spore_vec3_distance(spore_vec3_load(result.mesh.vertices + 3 * (gsize)pairs[2 * i]),
                               spore_vec3_load(result.mesh.vertices + 3 * (gsize)pairs[2 * i + 1]));
  g_assert_cmpfloat(sum / (double)edges, >, 0.75 * 0.015);
  g_assert_cmpfloat(sum / (double)edges, <, 1.25 * 0.015);
  spore_free(pairs);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* A surface turned inside out bounds the same solid. */
static void test_inside_out(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 8);
  shape_turn(&surface);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 500}, "direct");
  check_cells(&result, 500);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* A cavity stays one. */
static void test_cavity(void) {
  SporeTriangleMesh surface = {0}, cavity = {0};
  shape_ball(&surface, 0.05, 12);
  shape_ball(&cavity, 0.03, 12);
  shape_turn(&cavity);
  shape_append(&surface, &cavity);
  spore_triangle_mesh_clear(&cavity);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 3000}, "direct");
  g_assert_cmpfloat(fabs(result.report.volume_change), <, 0.1);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* Two cubes that overlap by a half: one solid of one and a half. */
static void test_overlapping_cubes(void) {
  const double shifted_low[3] = {0.05, 0.013, 0.017}, shifted_high[3] = {0.15, 0.113, 0.117};
  SporeTriangleMesh surface = {0}, other = {0};
  shape_box(&surface, low, high, 3);
  shape_box(&other, shifted_low, shifted_high, 3);
  shape_append(&surface, &other);
  spore_triangle_mesh_clear(&other);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 2000, .tolerance = 0.06}, "wrapped");
  check_cells(&result, 2000);
  const double both = 2e-3 - 0.05 * 0.087 * 0.083;
  g_assert_cmpfloat(fabs(result.report.quality.volume / both - 1), <, 0.1);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* A box without one triangle is closed again. */
static void test_hole(void) {
  SporeTriangleMesh surface = {0};
  shape_box(&surface, low, high, 4);
  surface.triangle_count--;
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 1000, .tolerance = 0.1}, "repaired");
  check_cells(&result, 1000);
  g_assert_cmpfloat(fabs(result.report.quality.volume / 1e-3 - 1), <, 0.1);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* No two triangles share a vertex, and some are turned over: as STL from a bad exporter. */
static void test_soup(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 8);
  shape_unweld(&surface);
  for (gsize i = 0; i < surface.triangle_count; i += 5) {
    uint32_t *corner = surface.triangles + 3 * i, kept = corner[1];
    corner[1] = corner[2], corner[2] = kept;
  }
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 500}, "direct");
  check_cells(&result, 500);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

static void test_repeatable(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 8);
  const double scale[3] = {1, 0.7, 0.4};
  for (gsize i = 0; i < 3 * surface.vertex_count; i++) surface.vertices[i] *= scale[i % 3];
  SporeTriangleMesh same = {0};
  g_assert_true(spore_triangle_mesh_copy(&same, &surface, NULL));
  Result a = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 600, .tolerance = 0.03}, "direct");
  Result b = fill(&same, (SporeTetrahedraOptions){CHAIN, .cells = 600, .tolerance = 0.03}, "direct");
  g_assert_cmpmem(a.mesh.vertices, a.mesh.vertex_count * 24, b.mesh.vertices, b.mesh.vertex_count * 24);
  g_assert_cmpmem(a.mesh.tetrahedra, a.mesh.tetrahedron_count * 16, b.mesh.tetrahedra, b.mesh.tetrahedron_count * 16);
  g_assert_cmpfloat(a.report.hausdorff, ==, b.report.hausdorff);
  spore_tetrahedral_mesh_clear(&a.mesh);
  spore_tetrahedral_mesh_clear(&b.mesh);
}

static void test_refused(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 4);
  check_refused(&surface, (SporeTetrahedraOptions){CHAIN}, SPORE_ERROR_INPUT, "or a number of cells");
  check_refused(&surface, (SporeTetrahedraOptions){CHAIN, .size = -1}, SPORE_ERROR_INPUT, "expected a length above 0");
  check_refused(&surface, (SporeTetrahedraOptions){CHAIN, .size = NAN}, SPORE_ERROR_INPUT, "expected a length above 0");
  check_refused(&surface, (SporeTetrahedraOptions){CHAIN, .size = 1e-6}, SPORE_ERROR_INPUT, "expected at most 5000000");
  check_refused(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 1000000000}, SPORE_ERROR_INPUT,
                "expected at most 5000000");
  surface.vertices[4] = NAN;
  check_refused(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 100}, SPORE_ERROR_INPUT, "vertex 1");
  spore_triangle_mesh_clear(&surface);
}

typedef struct {
  guint calls, cancel_at;
  double last;
  gboolean falls;
  guint64 cancelled_ns;
} Watch;

static bool watch(void *data, double fraction, const char *stage) {
  Watch *seen = data;
  if (fraction > 1 || !(fraction >= 0)) seen->falls = TRUE;
  seen->last = fraction;
  if (++seen->calls < seen->cancel_at || !seen->cancel_at) return true;
  if (!seen->cancelled_ns) seen->cancelled_ns = spore_clock_ns();
  return false;
}

/* Cells for minutes of work; the wish to cancel must not wait for them. */
static void test_cancel(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 12);
  Watch seen = {.cancel_at = 10};
  SporeProgress progress = {watch, &seen};
  SporeTetrahedraOptions options = {CHAIN, .cells = 2000000};
  SporeTetrahedralMesh mesh;
  GError *error = NULL;
  g_assert_false(spore_tetrahedra_from_mesh("organ", &surface, &options, &mesh, NULL, &progress, &error));
  g_assert_cmpuint(spore_clock_ns() - seen.cancelled_ns, <, (guint64)5 * 1000000000);
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_CANCELLED);
  g_assert_cmpuint(seen.calls, ==, 10);
  g_error_free(error);
  spore_triangle_mesh_clear(&surface);
}

static void test_progress(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 8);
  Watch seen = {0};
  SporeProgress progress = {watch, &seen};
  SporeTetrahedraOptions options = {CHAIN, .cells = 300};
  SporeTetrahedralMesh mesh;
  GError *error = NULL;
  g_assert_true(spore_tetrahedra_from_mesh("organ", &surface, &options, &mesh, NULL, &progress, &error));
  g_assert_no_error(error);
  g_assert_false(seen.falls);
  g_assert_cmpfloat(seen.last, >, 0.9);
  spore_tetrahedral_mesh_clear(&mesh);
  spore_triangle_mesh_clear(&surface);
}

/* Cancelled while the result is measured, after the helper has ended. */
static bool stop_measuring(void *data, double fraction, const char *stage) { return fraction < 0.95; }

static void test_cancel_late(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 8);
  SporeProgress progress = {stop_measuring, NULL};
  SporeTetrahedraOptions options = {CHAIN, .cells = 300};
  SporeTetrahedralMesh mesh;
  GError *error = NULL;
  g_assert_false(spore_tetrahedra_from_mesh("organ", &surface, &options, &mesh, NULL, &progress, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_CANCELLED);
  g_assert_null(mesh.vertices);
  g_error_free(error);
  spore_triangle_mesh_clear(&surface);
}

/* A hollow ring whose wall is thinner than its cells would be: the mesher's cells are far from it, the coarsened
 * lattice's are nearer, and that is said. */
static void test_thin_wall(void) {
  SporeTriangleMesh surface = {0}, lumen = {0};
  shape_torus(&surface, 0.03, 0.012, 32, 16);
  shape_torus(&lumen, 0.03, 0.008, 32, 16);
  shape_turn(&lumen);
  shape_append(&surface, &lumen);
  spore_triangle_mesh_clear(&lumen);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 1200}, "voxels");
  check_cells(&result, 1200);
  g_assert_cmpfloat(result.report.hausdorff, <, 0.01);
  g_assert_cmpfloat(fabs(result.report.volume_change), <, 0.1);
  if (SPORE_HAVE_CGAL) g_assert_true(*result.report.refused[SPORE_TETRAHEDRA_DIRECT]);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* The lattice alone: angles that the method proves, the volume of a ball, nothing outside. */
static void test_voxels(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 16);
  shape_move(&surface, 0.3, 0, 0);
  Result result = fill(&surface, (SporeTetrahedraOptions){.method = SPORE_TETRAHEDRA_VOXELS, .cells = 3000}, "voxels");
  check_cells(&result, 3000);
  g_assert_cmpfloat(result.report.quality.min_dihedral_deg, >=, 10.7);
  g_assert_cmpfloat(result.report.hausdorff, <, 0.01);
  g_assert_cmpfloat(fabs(result.report.volume_change), <, 0.03);
  g_assert_cmpfloat(fabs(result.report.area_change), <, 0.03);
  for (gsize i = 0; i < result.mesh.vertex_count; i++) {
    SporeVec3 p = spore_vec3_load(result.mesh.vertices + 3 * i);
    g_assert_cmpfloat(spore_vec3_distance(p, spore_vec3(0.3, 0, 0)), <=, 0.05 * 1.02);
  }
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* The angles hold wherever the solid lies in the lattice, creases and thin walls included; and each face of a cell is
 * that of one other cell, or of the boundary, which is closed. */
static void test_voxel_angles(void) {
  for (int i = 0; i < 9; i += 4) {
    SporeTriangleMesh surface = {0};
    if (i % 3 == 0) shape_box(&surface, low, high, 2);
    else if (i % 3 == 1) shape_torus(&surface, 0.05, 0.008 + 0.001 * i, 24, 12);
    else shape_capsule(&surface, 0.02, 0.05, 6);
    const double angle = 0.37 * i, c = cos(angle), s = sin(angle);
    for (gsize v = 0; v < surface.vertex_count; v++) {
      double *x = surface.vertices + 3 * v, y = c * x[1] - s * x[2], z = s * x[1] + c * x[2];
      x[1] = y, x[2] = z, y = c * x[0] - s * x[1], x[1] = s * x[0] + c * x[1], x[0] = y;
    }
    Result result = fill(
        &surface, (SporeTetrahedraOptions){.method = SPORE_TETRAHEDRA_VOXELS, .cells = 400 + 100 * (gsize)i}, "voxels");
    g_assert_cmpfloat(result.report.quality.min_dihedral_deg, >=, 10.7);
    uint32_t *triangles;
    size_t count;
    g_assert_true(spore_tetrahedral_mesh_boundary(&result.mesh, &triangles, &count));
    SporeTriangleMesh boundary = {result.mesh.vertex_count, count, result.mesh.vertices, triangles, false};
    SporeMeshReport shape;
    g_assert_true(spore_triangle_mesh_report(&boundary, &shape, NULL));
    g_assert_cmpuint(shape.boundary_edges, ==, 0);
    g_assert_cmpuint(shape.nonmanifold_edges, ==, 0);
    g_assert_cmpfloat(fabs(shape.volume / result.report.volume - 1), <, 1e-9);
    spore_free(triangles);
    spore_tetrahedral_mesh_clear(&result.mesh);
  }
}

/* A hollow ball: filled, it has the volume of a whole one; else of the shell. By each method that may do it. */
static void test_fill(void) {
  for (int i = 0; i < 4; i++) {
    const SporeTetrahedraMethod method = i < 2 ? SPORE_TETRAHEDRA_VOXELS : SPORE_TETRAHEDRA_METHODS;
    SporeTriangleMesh surface = {0}, cavity = {0};
    shape_ball(&surface, 0.05, 10);
    shape_ball(&cavity, 0.025, 10);
    shape_turn(&cavity);
    shape_append(&surface, &cavity);
    spore_triangle_mesh_clear(&cavity);
    Result result = fill(&surface, (SporeTetrahedraOptions){.method = method, .cells = 800, .fill = i % 2},
                         i < 2 ? "voxels" : "direct");
    const double whole = 1.0 / (1 - 0.125); /* of the shell's volume */
    g_assert_cmpfloat_with_epsilon(result.report.volume_change, i % 2 ? whole - 1 : 0, 0.06);
    g_assert_cmpfloat(result.report.hausdorff, <, 0.02); /* a cavity that is filled does not count */
    spore_tetrahedral_mesh_clear(&result.mesh);
  }
}

/* A sheet of no thickness, an open cup, one triangle, two parts: each is made by a method, or refused in words. */
static void test_open_shapes(void) {
  SporeTriangleMesh plate = {0}, cup = {0}, parts = {0}, other = {0};
  shape_box(&plate, low, high, 4);
  gsize kept = 0; /* of a box, the triangles of the side z = 0 */
  for (gsize t = 0; t < plate.triangle_count; t++) {
    const uint32_t *c = plate.triangles + 3 * t;
    if (plate.vertices[3 * c[0] + 2] + plate.vertices[3 * c[1] + 2] + plate.vertices[3 * c[2] + 2] > 0) continue;
    memmove(plate.triangles + 3 * kept++, c, 12);
  }
  plate.triangle_count = kept;
  check_refused(&plate, (SporeTetrahedraOptions){CHAIN, .cells = 500}, SPORE_ERROR_INPUT, "encloses nothing");
  plate.triangle_count = 1;
  check_refused(&plate, (SporeTetrahedraOptions){CHAIN, .cells = 500}, SPORE_ERROR_INPUT, "encloses nothing");
  spore_triangle_mesh_clear(&plate);

  shape_ball(&cup, 0.05, 10);
  kept = 0;
  for (gsize t = 0; t < cup.triangle_count; t++)
    if (cup.vertices[3 * cup.triangles[3 * t] + 2] <= 0.01)
      memmove(cup.triangles + 3 * kept++, cup.triangles + 3 * t, 12);
  cup.triangle_count = kept;
  Result result = fill(&cup, (SporeTetrahedraOptions){CHAIN, .cells = 800, .tolerance = 0.1}, "repaired");
  g_assert_cmpfloat(result.report.volume, >, 2e-4);
  g_assert_cmpfloat(result.report.volume, <, 4.5e-4);
  spore_tetrahedral_mesh_clear(&result.mesh);

  shape_ball(&parts, 0.03, 6);
  shape_ball(&other, 0.03, 6);
  shape_move(&other, 0.1, 0, 0);
  shape_append(&parts, &other);
  spore_triangle_mesh_clear(&other);
  result = fill(&parts, (SporeTetrahedraOptions){CHAIN, .cells = 800}, "direct");
  g_assert_cmpfloat(fabs(result.report.volume_change), <, 0.08);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* Mean length of the edges whose middles are `inside` a place, or not. */
static double mean_edge(const SporeTetrahedralMesh *mesh, gboolean (*inside)(SporeVec3 p), gboolean wanted) {
  uint32_t *pairs;
  size_t edges, count = 0;
  double sum = 0;
  g_assert_true(spore_edges_of_tetrahedra(mesh->tetrahedra, mesh->tetrahedron_count, &pairs, &edges));
  for (gsize i = 0; i < edges; i++) {
    SporeVec3 a = spore_vec3_load(mesh->vertices + 3 * (gsize)pairs[2 * i]);
    SporeVec3 b = spore_vec3_load(mesh->vertices + 3 * (gsize)pairs[2 * i + 1]);
    if (inside(spore_vec3_scale(0.5, spore_vec3_add(a, b))) != wanted) continue;
    sum += spore_vec3_distance(a, b);
    count++;
  }
  spore_free(pairs);
  g_assert_cmpuint(count, >, 20);
  return sum / (double)count;
}

static gboolean in_region(SporeVec3 p) { return spore_vec3_distance(p, spore_vec3(0.05, 0, 0)) < 0.02; }

/* Edges of 6 mm in a ball at the pole of another one of 20 mm; with the same number of cells, those elsewhere grow. */
static void test_region(void) {
  const SporeTetrahedraRegion region = {{0.05, 0, 0}, 0.02, 0.006};
  SporeTriangleMesh surface = {0}, same = {0};
  shape_ball(&surface, 0.05, 12);
  g_assert_true(spore_triangle_mesh_copy(&same, &surface, NULL));
  SporeTetrahedraOptions options = {CHAIN, .size = 0.02, .regions = &region, .region_count = 1};
  Result result = fill(&surface, options, "direct");
  double inside = mean_edge(&result.mesh, in_region, TRUE), outside = mean_edge(&result.mesh, in_region, FALSE);
  g_test_message("edges of %.1f mm in the region, %.1f mm elsewhere", 1e3 * inside, 1e3 * outside);
  g_assert_cmpfloat_with_epsilon(inside, 0.006, 0.25 * 0.006);
  g_assert_cmpfloat(outside, >, 1.6 * inside);
  spore_tetrahedral_mesh_clear(&result.mesh);
  options.size = 0;
  options.cells = 3000;
  result = fill(&same, options, "direct");
  check_cells(&result, 3000);
  g_assert_cmpfloat_with_epsilon(mean_edge(&result.mesh, in_region, TRUE), 0.006, 0.25 * 0.006);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

static gboolean near_tip(SporeVec3 p) { return fabs(p.x) > 0.04; }

/* A long ellipsoid bends most at its tips: with --curvature its cells are finer there, without they are as elsewhere.
 */
static void test_curvature(void) {
  double ratio[2];
  for (int i = 0; i < 2; i++) {
    SporeTriangleMesh surface = {0};
    shape_ball(&surface, 0.05, 16);
    for (gsize v = 0; v < 3 * surface.vertex_count; v++) surface.vertices[v] *= v % 3 ? 0.4 : 1;
    SporeTetrahedraOptions options = {CHAIN, .cells = 1500, .tolerance = 0.1, .curvature = i ? 30 : 0};
    Result result = fill(&surface, options, "direct");
    check_cells(&result, 1500);
    ratio[i] = mean_edge(&result.mesh, near_tip, TRUE) / mean_edge(&result.mesh, near_tip, FALSE);
    spore_tetrahedral_mesh_clear(&result.mesh);
  }
  g_test_message("edges at the tips: %.2f of those elsewhere, %.2f with curvature", ratio[0], ratio[1]);
  g_assert_cmpfloat(ratio[0], >, 0.8);
  g_assert_cmpfloat(ratio[1], <, 0.8 * ratio[0]);
}

/* Which methods were refused before, and one that is asked for and cannot: no other is taken. */
static void test_method(void) {
  SporeTriangleMesh surface = {0};
  shape_box(&surface, low, high, 4);
  surface.triangle_count--;
  check_refused(&surface, (SporeTetrahedraOptions){.method = SPORE_TETRAHEDRA_DIRECT, .cells = 500},
                SPORE_ERROR_NUMERICAL, SPORE_HAVE_CGAL ? "direct: the surface is not closed" : "without CGAL");
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 500, .tolerance = 0.1}, "repaired");
  g_assert_nonnull(strstr(result.report.refused[SPORE_TETRAHEDRA_DIRECT], SPORE_HAVE_CGAL ? "not closed" : "CGAL"));
  g_assert_cmpstr(result.report.refused[SPORE_TETRAHEDRA_WRAPPED], ==,
                  SPORE_HAVE_CGAL ? "" : result.report.refused[SPORE_TETRAHEDRA_DIRECT]);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

static void add_tests(void) {
  g_test_add_func("/tetrahedra/ball", test_ball);
  g_test_add_func("/tetrahedra/scale", test_scale);
  g_test_add_func("/tetrahedra/cube", test_cube);
  g_test_add_func("/tetrahedra/torus", test_torus);
  g_test_add_func("/tetrahedra/size", test_size);
  g_test_add_func("/tetrahedra/inside-out", test_inside_out);
  g_test_add_func("/tetrahedra/cavity", test_cavity);
  g_test_add_func("/tetrahedra/overlapping-cubes", test_overlapping_cubes);
  g_test_add_func("/tetrahedra/hole", test_hole);
  g_test_add_func("/tetrahedra/soup", test_soup);
  g_test_add_func("/tetrahedra/region", test_region);
  g_test_add_func("/tetrahedra/curvature", test_curvature);
  g_test_add_func("/tetrahedra/repeatable", test_repeatable);
  g_test_add_func("/tetrahedra/cancel", test_cancel);
  g_test_add_func("/tetrahedra/cancel-late", test_cancel_late);
  g_test_add_func("/tetrahedra/progress", test_progress);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  if (SPORE_HAVE_CGAL) add_tests();
  g_test_add_func("/tetrahedra/method", test_method);
  g_test_add_func("/tetrahedra/thin-wall", test_thin_wall);
  g_test_add_func("/tetrahedra/voxels", test_voxels);
  g_test_add_func("/tetrahedra/voxel-angles", test_voxel_angles);
  g_test_add_func("/tetrahedra/fill", test_fill);
  g_test_add_func("/tetrahedra/open-shapes", test_open_shapes);
  g_test_add_func("/tetrahedra/refused", test_refused);
  return g_test_run();
}
