/* Shapes that the conformance tests make models of: boxes, sheets, lines, helices and blocks. */
#include "tests/conformance/shapes.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"

static void put(uint32_t *to, uint32_t a, uint32_t b, uint32_t c) { to[0] = a, to[1] = b, to[2] = c; }

void shape_box(SporeTriangleMesh *mesh, SporeVec3 centre, SporeVec3 sides) {
  static const uint32_t quads[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                       {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  g_assert_true(spore_triangle_mesh_allocate(mesh, 8, 12, NULL));
  for (unsigned i = 0; i < 8; i++) {
    SporeVec3 half = {i & 4 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 1 ? 0.5 : -0.5};
    SporeVec3 corner = {half.x * sides.x, half.y * sides.y, half.z * sides.z};
    spore_vec3_store(mesh->vertices + 3 * i, spore_vec3_add(centre, corner));
  }
  for (unsigned f = 0; f < 6; f++) {
    put(mesh->triangles + 6 * f, quads[f][0], quads[f][1], quads[f][2]);
    put(mesh->triangles + 6 * f + 3, quads[f][0], quads[f][2], quads[f][3]);
  }
}

void shape_sheet(SporeTriangleMesh *mesh, unsigned columns, unsigned rows, double spacing, gboolean alternate) {
  g_assert_true(
      spore_triangle_mesh_allocate(mesh, (size_t)columns * rows, 2 * (size_t)(columns - 1) * (rows - 1), NULL));
  for (unsigned r = 0; r < rows; r++)
    for (unsigned c = 0; c < columns; c++)
      spore_vec3_store(mesh->vertices + 3 * (r * columns + c), spore_vec3(c * spacing, r * spacing, 0));
  uint32_t *t = mesh->triangles;
  for (unsigned r = 0; r + 1 < rows; r++)
    for (unsigned c = 0; c + 1 < columns; c++, t += 6) {
      uint32_t a = r * columns + c, b = a + 1, d = a + columns, e = d + 1;
      if (alternate && (r + c) % 2) put(t, a, b, d), put(t + 3, b, e, d);
      else put(t, a, b, e), put(t + 3, a, e, d);
    }
}

void shape_level_sheet(SporeTriangleMesh *mesh, unsigned columns, unsigned rows, double spacing) {
  shape_sheet(mesh, columns, rows, spacing, FALSE);
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    double *x = mesh->vertices + 3 * i;
    x[2] = x[1], x[1] = 0;
  }
}

void shape_line(SporeCurve *curve, unsigned count, double length, double radius) {
  g_assert_true(spore_curve_allocate(curve, count, NULL));
  for (unsigned i = 0; i < count; i++) {
    double s = length * i / (count - 1);
    spore_vec3_store(curve->points + 4 * i, spore_vec3(s / 3, 2 * s / 3, 2 * s / 3));
    curve->points[4 * i + 3] = radius;
  }
}

void shape_helix(SporeCurve *curve, unsigned count, double winding, double pitch, double radius) {
  g_assert_true(spore_curve_allocate(curve, count, NULL));
  for (unsigned i = 0; i < count; i++) {
    double turns = 1.5 * i / (count - 1), angle = 2 * G_PI * turns;
    spore_vec3_store(curve->points + 4 * i, spore_vec3(winding * cos(angle), pitch * turns, winding * sin(angle)));
    curve->points[4 * i + 3] = radius;
  }
}

/* The six paths from corner 0 to corner 7 of a cell, along its axes; every other one turns the other way. */
static void fill_cell(uint32_t *to, const uint32_t corner[8]) {
  static const unsigned paths[6][2] = {{4, 6}, {6, 2}, {2, 3}, {3, 1}, {1, 5}, {5, 4}};
  for (unsigned p = 0; p < 6; p++) {
    uint32_t tetrahedron[4] = {corner[0], corner[paths[p][0]], corner[paths[p][1]], corner[7]};
    for (unsigned k = 0; k < 4; k++) to[4 * p + k] = tetrahedron[k];
  }
}

void shape_block(SporeTetrahedralMesh *mesh, unsigned nx, unsigned ny, unsigned nz, SporeVec3 size) {
  size_t vertices = (size_t)(nx + 1) * (ny + 1) * (nz + 1), cells = (size_t)nx * ny * nz;
  g_assert_true(spore_tetrahedral_mesh_allocate(mesh, vertices, 6 * cells, NULL));
  double *x = mesh->vertices;
  for (unsigned i = 0; i <= nx; i++)
    for (unsigned j = 0; j <= ny; j++)
      for (unsigned k = 0; k <= nz; k++, x += 3)
        spore_vec3_store(x, spore_vec3(size.x * i / nx, size.y * j / ny, size.z * k / nz));
  uint32_t *t = mesh->tetrahedra;
  for (unsigned i = 0; i < nx; i++)
    for (unsigned j = 0; j < ny; j++)
      for (unsigned k = 0; k < nz; k++, t += 24) {
        uint32_t corner[8];
        for (unsigned n = 0; n < 8; n++)
          corner[n] = ((i + (n >> 2)) * (ny + 1) + j + (n >> 1 & 1)) * (nz + 1) + k + (n & 1);
        fill_cell(t, corner);
      }
}

void shape_block_surface(SporeTriangleMesh *mesh, unsigned nx, unsigned ny, unsigned nz, SporeVec3 size) {
  SporeTetrahedralMesh block;
  uint32_t *triangles;
  size_t count;
  shape_block(&block, nx, ny, nz, size);
  g_assert_true(spore_tetrahedral_mesh_boundary(&block, &triangles, &count));
  g_assert_true(spore_triangle_mesh_allocate(mesh, block.vertex_count, count, NULL));
  memcpy(mesh->vertices, block.vertices, 3 * block.vertex_count * sizeof(double));
  memcpy(mesh->triangles, triangles, 3 * count * sizeof(uint32_t));
  spore_free(triangles);
  spore_tetrahedral_mesh_clear(&block);
}

uint32_t *shape_order(size_t count, GRand *random) {
  uint32_t *order = g_new(uint32_t, count);
  for (size_t i = 0; i < count; i++) {
    size_t j = (size_t)g_rand_int_range(random, 0, (gint32)i + 1);
    order[i] = order[j];
    order[j] = (uint32_t)i;
  }
  return order;
}

static void relabel(const double *vertices, size_t vertex_count, const uint32_t *elements, size_t count, size_t corners,
                    const uint32_t *order, double *to_vertices, uint32_t *to_elements) {
  for (size_t i = 0; i < vertex_count; i++)
    for (size_t k = 0; k < 3; k++) to_vertices[3 * (size_t)order[i] + k] = vertices[3 * i + k];
  for (size_t e = 0; e < count; e++)
    for (size_t k = 0; k < corners; k++) to_elements[corners * (count - 1 - e) + k] = order[elements[corners * e + k]];
}

void shape_relabel_triangles(SporeTriangleMesh *to, const SporeTriangleMesh *from, const uint32_t *order) {
  g_assert_true(spore_triangle_mesh_allocate(to, from->vertex_count, from->triangle_count, NULL));
  relabel(from->vertices, from->vertex_count, from->triangles, from->triangle_count, 3, order, to->vertices,
          to->triangles);
}

void shape_relabel_tetrahedra(SporeTetrahedralMesh *to, const SporeTetrahedralMesh *from, const uint32_t *order) {
  g_assert_true(spore_tetrahedral_mesh_allocate(to, from->vertex_count, from->tetrahedron_count, NULL));
  relabel(from->vertices, from->vertex_count, from->tetrahedra, from->tetrahedron_count, 4, order, to->vertices,
          to->tetrahedra);
}

SporeVec3 shape_random_vector(GRand *random, double amplitude) {
  double x = g_rand_double_range(random, -amplitude, amplitude), y = g_rand_double_range(random, -amplitude, amplitude);
  return (SporeVec3){x, y, g_rand_double_range(random, -amplitude, amplitude)};
}

SporeQuat shape_random_rotation(GRand *random) {
  return spore_quat_from_rotation_vector(shape_random_vector(random, 3));
}
