/* Shapes for the tests of meshes: box, ball, torus and capsule, and ways to spoil a mesh. */
#include "tests/mesh/shapes.h"

#include <glib.h>
#include <math.h>
#include <string.h>

static void grid_face(SporeTriangleMesh *mesh, const double lower[3], const double upper[3], size_t n, int axis,
                      bool top) {
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  size_t base = mesh->vertex_count;
  for (size_t j = 0; j <= n; j++)
    for (size_t i = 0; i <= n; i++) {
      double *p = mesh->vertices + 3 * mesh->vertex_count++;
      p[axis] = top ? upper[axis] : lower[axis];
      p[u] = lower[u] + (upper[u] - lower[u]) * (double)i / (double)n;
      p[v] = lower[v] + (upper[v] - lower[v]) * (double)j / (double)n;
    }
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++) {
      uint32_t a = (uint32_t)(base + j * (n + 1) + i), b = a + 1, c = a + (uint32_t)n + 1, d = c + 1;
      uint32_t up[6] = {a, b, d, a, d, c}, down[6] = {a, d, b, a, c, d};
      memcpy(mesh->triangles + 3 * mesh->triangle_count, top ? up : down, sizeof up);
      mesh->triangle_count += 2;
    }
}

void shape_box(SporeTriangleMesh *mesh, const double lower[3], const double upper[3], size_t n) {
  g_assert_true(spore_triangle_mesh_allocate(mesh, 6 * (n + 1) * (n + 1), 12 * n * n, NULL));
  mesh->vertex_count = mesh->triangle_count = 0;
  for (int axis = 0; axis < 3; axis++)
    for (int top = 0; top < 2; top++) grid_face(mesh, lower, upper, n, axis, top);
  g_assert_true(spore_triangle_mesh_weld(mesh, 1e-9, NULL));
}

void shape_ball(SporeTriangleMesh *mesh, double radius, size_t n) {
  const double lower[3] = {-1, -1, -1}, upper[3] = {1, 1, 1};
  shape_box(mesh, lower, upper, n);
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    double *p = mesh->vertices + 3 * i;
    for (int k = 0; k < 3; k++) p[k] = tan(p[k] * G_PI / 4); /* evener triangles */
    SporeVec3 unit = spore_vec3_normalise(spore_vec3_load(p), spore_vec3(0, 0, 1));
    spore_vec3_store(p, spore_vec3_scale(radius, unit));
  }
}

void shape_torus(SporeTriangleMesh *mesh, double major, double minor, size_t around, size_t across) {
  g_assert_true(spore_triangle_mesh_allocate(mesh, around * across, 2 * around * across, NULL));
  for (size_t i = 0; i < around; i++)
    for (size_t j = 0; j < across; j++) {
      double a = 2 * G_PI * (double)i / (double)around, b = 2 * G_PI * (double)j / (double)across;
      double ring = major + minor * cos(b);
      spore_vec3_store(mesh->vertices + 3 * (i * across + j), spore_vec3(ring * cos(a), ring * sin(a), minor * sin(b)));
      uint32_t p = (uint32_t)(i * across + j), q = (uint32_t)((i + 1) % around * across + j);
      uint32_t r = (uint32_t)(i * across + (j + 1) % across),
               s = (uint32_t)((i + 1) % around * across + (j + 1) % across);
      uint32_t two[6] = {p, q, s, p, s, r};
      memcpy(mesh->triangles + 6 * (i * across + j), two, sizeof two);
    }
}

void shape_capsule(SporeTriangleMesh *mesh, double radius, double half, size_t n) {
  shape_ball(mesh, radius, 2 * n); /* even, so that the equator is a row of vertices */
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    double *z = mesh->vertices + 3 * i + 2;
    *z += *z > 1e-9 * radius ? half : *z < -1e-9 * radius ? -half : 0;
  }
}

void shape_append(SporeTriangleMesh *a, const SporeTriangleMesh *b) {
  SporeTriangleMesh both;
  g_assert_true(spore_triangle_mesh_allocate(&both, a->vertex_count + b->vertex_count,
                                             a->triangle_count + b->triangle_count, NULL));
  if (a->vertex_count) memcpy(both.vertices, a->vertices, 3 * a->vertex_count * sizeof(double));
  memcpy(both.vertices + 3 * a->vertex_count, b->vertices, 3 * b->vertex_count * sizeof(double));
  if (a->triangle_count) memcpy(both.triangles, a->triangles, 3 * a->triangle_count * sizeof(uint32_t));
  for (size_t i = 0; i < 3 * b->triangle_count; i++)
    both.triangles[3 * a->triangle_count + i] = b->triangles[i] + (uint32_t)a->vertex_count;
  spore_triangle_mesh_clear(a);
  *a = both;
}

void shape_move(SporeTriangleMesh *mesh, double x, double y, double z) {
  for (size_t i = 0; i < mesh->vertex_count; i++) spore_vec3_accumulate(mesh->vertices + 3 * i, spore_vec3(x, y, z));
}

void shape_turn(SporeTriangleMesh *mesh) {
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    uint32_t swap = mesh->triangles[3 * t];
    mesh->triangles[3 * t] = mesh->triangles[3 * t + 1];
    mesh->triangles[3 * t + 1] = swap;
  }
}

void shape_unweld(SporeTriangleMesh *mesh) {
  SporeTriangleMesh soup;
  g_assert_true(spore_triangle_mesh_allocate(&soup, 3 * mesh->triangle_count, mesh->triangle_count, NULL));
  for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
    memcpy(soup.vertices + 3 * i, mesh->vertices + 3 * (size_t)mesh->triangles[i], 3 * sizeof(double));
    soup.triangles[i] = (uint32_t)i;
  }
  spore_triangle_mesh_clear(mesh);
  *mesh = soup;
}

void shape_tetrahedral_box(SporeTetrahedralMesh *mesh, size_t n, double edge) {
  static const int steps[6][2] = {{1, 2}, {2, 4}, {4, 1},
                                  {1, 4}, {4, 2}, {2, 1}}; /* two corners on the way from 0 to 7 */
  size_t m = n + 1, count = 0;
  g_assert_true(spore_tetrahedral_mesh_allocate(mesh, m * m * m, 6 * n * n * n, NULL));
  for (size_t i = 0; i < m * m * m; i++)
    spore_vec3_store(mesh->vertices + 3 * i,
                     spore_vec3(edge * (double)(i % m), edge * (double)(i / m % m), edge * (double)(i / m / m)));
  for (size_t z = 0; z < n; z++)
    for (size_t y = 0; y < n; y++)
      for (size_t x = 0; x < n; x++)
        for (int s = 0; s < 6; s++) {
          uint32_t corner[8];
          for (size_t c = 0; c < 8; c++)
            corner[c] = (uint32_t)(((z + (c >> 2)) * m + y + (c >> 1 & 1)) * m + x + (c & 1));
          int first = steps[s][0], second = first + steps[s][1];
          uint32_t even[4] = {corner[0], corner[first], corner[second], corner[7]};
          uint32_t odd[4] = {corner[0], corner[second], corner[first], corner[7]};
          memcpy(mesh->tetrahedra + 4 * count++, s < 3 ? even : odd, sizeof even);
        }
}
