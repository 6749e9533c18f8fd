/* Tetrahedral meshes: boundary, edges, quality, validation, faces of a cut mesh and pieces. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/cell_faces.h"
#include "tests/mesh/shapes.h"

#define CLOSE(a, b, tolerance) g_assert_cmpfloat_with_epsilon(a, b, tolerance)

static void test_boundary(void) {
  SporeTetrahedralMesh mesh;
  shape_tetrahedral_box(&mesh, 3, 0.5);
  g_assert_true(spore_tetrahedral_mesh_validate(&mesh, NULL));
  SporeTriangleMesh outer = {mesh.vertex_count, 0, mesh.vertices, NULL};
  g_assert_true(spore_tetrahedral_mesh_boundary(&mesh, &outer.triangles, &outer.triangle_count));
  g_assert_cmpuint(outer.triangle_count, ==, 6 * 9 * 2);
  SporeMeshReport report;
  g_assert_true(spore_triangle_mesh_report(&outer, &report, NULL));
  g_assert_true(report.closed);
  CLOSE(report.volume, 27 * 0.125, 1e-12);
  CLOSE(report.area, 6 * 9 * 0.25, 1e-12);
  spore_free(outer.triangles);
  spore_tetrahedral_mesh_clear(&mesh);
}

/* n^3 lattice edges along the axes, face diagonals and body diagonals of the six-tetrahedra cube. */
static void test_edges(void) {
  SporeTetrahedralMesh mesh;
  uint32_t *edges;
  size_t count, n = 3, m = n + 1;
  shape_tetrahedral_box(&mesh, n, 1);
  g_assert_true(spore_edges_of_tetrahedra(mesh.tetrahedra, mesh.tetrahedron_count, &edges, &count));
  g_assert_cmpuint(count, ==, 3 * n * m * m + 3 * n * n * m + n * n * n);
  spore_free(edges);
  spore_tetrahedral_mesh_clear(&mesh);
}

static void test_quality_regular(void) {
  double vertices[] = {1, 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1};
  uint32_t tetrahedra[] = {0, 1, 2, 3};
  SporeTetrahedralMesh mesh = {4, 1, vertices, tetrahedra};
  SporeTetrahedraQuality quality;
  if (!spore_tetrahedral_mesh_validate(&mesh, NULL)) tetrahedra[0] = 1, tetrahedra[1] = 0;
  g_assert_true(spore_tetrahedral_mesh_validate(&mesh, NULL));
  spore_tetrahedral_mesh_quality(&mesh, &quality);
  CLOSE(quality.volume, 8. / 3, 1e-12);
  CLOSE(quality.min_dihedral_deg, acos(1. / 3) * 180 / G_PI, 1e-9);
  CLOSE(quality.mean_dihedral_deg, quality.min_dihedral_deg, 1e-12);
  CLOSE(quality.worst_radius_ratio, 1, 1e-12);
}

/* The corner of a cube: angles of 90 and acos(1/sqrt 3); R = sqrt(3)/2, r = 1/(3 + sqrt 3). */
static void test_quality_corner(void) {
  double vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  uint32_t tetrahedra[] = {0, 1, 2, 3};
  SporeTetrahedralMesh mesh = {4, 1, vertices, tetrahedra};
  SporeTetrahedraQuality quality;
  spore_tetrahedral_mesh_quality(&mesh, &quality);
  CLOSE(quality.min_dihedral_deg, acos(1 / sqrt(3)) * 180 / G_PI, 1e-9);
  CLOSE(quality.worst_radius_ratio, sqrt(3) / 2 * (3 + sqrt(3)) / 3, 1e-12);
}

static void test_validate(void) {
  double vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0};
  uint32_t tetrahedra[] = {0, 1, 2, 3, 0, 2, 1, 3};
  SporeTetrahedralMesh mesh = {5, 1, vertices, tetrahedra};
  SporeError error = SPORE_ERROR_INIT;
  g_assert_true(spore_tetrahedral_mesh_validate(&mesh, NULL));
  mesh.tetrahedron_count = 2;
  g_assert_false(spore_tetrahedral_mesh_validate(&mesh, &error));
  g_assert_nonnull(strstr(error.message, "tetrahedron 1 is inside out"));
  tetrahedra[5] = 1, tetrahedra[6] = 2, tetrahedra[7] = 4;
  g_assert_false(spore_tetrahedral_mesh_validate(&mesh, &error));
  g_assert_nonnull(strstr(error.message, "tetrahedron 1 is flat"));
  tetrahedra[7] = 5;
  g_assert_false(spore_tetrahedral_mesh_validate(&mesh, &error));
  g_assert_nonnull(strstr(error.message, "tetrahedron 1 uses vertex 5"));
}

static double area_of(const SporeCellFaces *faces) {
  double area = 0;
  for (size_t i = 0; i < faces->triangle_count; i++) {
    const double *p = faces->vertices + 9 * i;
    SporeVec3 a = spore_vec3_load(p), b = spore_vec3_sub(spore_vec3_load(p + 3), a);
    area += 0.5 * spore_vec3_length(spore_vec3_cross(b, spore_vec3_sub(spore_vec3_load(p + 6), a)));
  }
  return area;
}

/* A box of 2 x 2 x 2 cubes is seen from outside, cut to one layer, drawn apart, and cut away. */
static void test_cell_faces(void) {
  static const struct {
    double beyond, shrink;
    size_t triangles;
    double area;
  } views[] = {{2, 1, 48, 24}, {1, 1, 32, 16}, {2, 0.5, 4 * 48, 0}, {0, 1, 0, 0}};
  SporeTetrahedralMesh mesh;
  shape_tetrahedral_box(&mesh, 2, 1);
  for (size_t i = 0; i < G_N_ELEMENTS(views); i++) {
    SporeCellFaces faces;
    SporeCellView view = {spore_vec3(1, 0, 0), views[i].beyond, views[i].shrink};
    g_assert_true(spore_cell_faces(&mesh, &view, &faces, NULL));
    g_assert_cmpuint(faces.triangle_count, ==, views[i].triangles);
    if (views[i].shrink == 1) CLOSE(area_of(&faces), views[i].area, 1e-12);
    for (size_t f = 0; f < faces.triangle_count; f++) g_assert_cmpuint(faces.cells[f], <, mesh.tetrahedron_count);
    spore_cell_faces_clear(&faces);
  }
  SporeCellFaces whole, apart;
  SporeCellView one = {{0, 0, 0}, 0, 1 - 1e-12}, half = {{0, 0, 0}, 0, 0.5};
  g_assert_true(spore_cell_faces(&mesh, &one, &whole, NULL) && spore_cell_faces(&mesh, &half, &apart, NULL));
  CLOSE(area_of(&apart), 0.25 * area_of(&whole), 1e-9);
  spore_cell_faces_clear(&whole);
  spore_cell_faces_clear(&apart);
  spore_tetrahedral_mesh_clear(&mesh);
}

/* Faces look out of what is left. */
static void test_cell_faces_outward(void) {
  SporeTetrahedralMesh mesh;
  SporeCellFaces faces;
  SporeCellView view = {spore_vec3(0, 1, 0), 1, 1};
  double volume = 0;
  shape_tetrahedral_box(&mesh, 3, 1);
  g_assert_true(spore_cell_faces(&mesh, &view, &faces, NULL));
  for (size_t i = 0; i < faces.triangle_count; i++) {
    const double *p = faces.vertices + 9 * i;
    volume += spore_vec3_dot(spore_vec3_load(p), spore_vec3_cross(spore_vec3_load(p + 3), spore_vec3_load(p + 6))) / 6;
  }
  CLOSE(volume, 9, 1e-12);
  spore_cell_faces_clear(&faces);
  spore_tetrahedral_mesh_clear(&mesh);
}

static void test_no_memory(void) {
  SporeTetrahedralMesh mesh;
  bool done = false;
  shape_tetrahedral_box(&mesh, 2, 1);
  for (uint64_t n = 1; !done; n++) {
    uint32_t *triangles;
    size_t count;
    spore_allocation_fail_at(n);
    done = spore_tetrahedral_mesh_boundary(&mesh, &triangles, &count);
    spore_allocation_fail_at(0);
    g_assert_true(done == (triangles != NULL));
    g_assert_cmpuint(n, <, 20);
    spore_free(triangles);
  }
  spore_tetrahedral_mesh_clear(&mesh);
}

/* Two that share a vertex are one piece, one by itself another. */
static void test_pieces(void) {
  SporeTetrahedralMesh mesh;
  g_assert_true(spore_tetrahedral_mesh_allocate(&mesh, 11, 3, NULL));
  const uint32_t corners[] = {0, 1, 2, 3, 7, 8, 9, 10, 3, 4, 5, 6};
  memcpy(mesh.tetrahedra, corners, sizeof corners);
  uint32_t *pieces;
  size_t count;
  g_assert_true(spore_tetrahedral_mesh_pieces(&mesh, &pieces, &count, NULL));
  g_assert_cmpuint(count, ==, 2);
  g_assert_cmpuint(pieces[0], ==, 0);
  g_assert_cmpuint(pieces[1], ==, 1);
  g_assert_cmpuint(pieces[2], ==, 0);
  spore_free(pieces);
  spore_tetrahedral_mesh_clear(&mesh);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/mesh/tetrahedral/boundary", test_boundary);
  g_test_add_func("/mesh/tetrahedral/edges", test_edges);
  g_test_add_func("/mesh/tetrahedral/quality-regular", test_quality_regular);
  g_test_add_func("/mesh/tetrahedral/quality-corner", test_quality_corner);
  g_test_add_func("/mesh/tetrahedral/validate", test_validate);
  g_test_add_func("/mesh/tetrahedral/cell-faces", test_cell_faces);
  g_test_add_func("/mesh/tetrahedral/cell-faces-outward", test_cell_faces_outward);
  g_test_add_func("/mesh/tetrahedral/no-memory", test_no_memory);
  g_test_add_func("/tetrahedral-mesh/pieces", test_pieces);
  return g_test_run();
}
