/* Bounding volume hierarchy: nearest points, winding numbers and rays against exact results. */
#include <glib.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/mesh/bvh.h"
#include "core/mesh/depth_cells.h"
#include "tests/mesh/shapes.h"

#define CLOSE(a, b, tolerance) g_assert_cmpfloat_with_epsilon(a, b, tolerance)

static GRand *generator; /* of a fixed seed: the winding number is an approximation */

static SporeVec3 random_point(double reach) {
  return spore_vec3(g_rand_double_range(generator, -reach, reach), g_rand_double_range(generator, -reach, reach),
                    g_rand_double_range(generator, -reach, reach));
}

/* Distance to the box [-1, 1]^3, positive inside. */
static double box_depth(SporeVec3 p) {
  double x = fabs(p.x) - 1, y = fabs(p.y) - 1, z = fabs(p.z) - 1;
  double inside = -fmax(x, fmax(y, z));
  return inside > 0 ? inside : -spore_vec3_length(spore_vec3(fmax(x, 0), fmax(y, 0), fmax(z, 0)));
}

static void test_box(void) {
  const double lower[3] = {-1, -1, -1}, upper[3] = {1, 1, 1};
  SporeTriangleMesh box;
  shape_box(&box, lower, upper, 9);
  SporeBvh *bvh = spore_bvh_create(&box, NULL);
  for (int i = 0; i < 5000; i++) {
    SporeVec3 p = random_point(2), nearest;
    uint32_t triangle;
    double depth = box_depth(p), distance = spore_bvh_distance(bvh, p, &nearest, &triangle);
    CLOSE(distance, fabs(depth), 1e-12);
    CLOSE(spore_vec3_distance(p, nearest), distance, 1e-12);
    g_assert_cmpuint(triangle, <, box.triangle_count);
    CLOSE(spore_bvh_depth(bvh, p), depth, 1e-12);
    CLOSE(spore_bvh_winding(bvh, p), depth > 0 ? 1 : 0, 0.05);
  }
  spore_bvh_free(bvh);
  spore_triangle_mesh_clear(&box);
}

/* The named triangle holds the nearest point. */
static void test_nearest_triangle(void) {
  SporeTriangleMesh torus;
  shape_torus(&torus, 1, 0.4, 31, 17);
  SporeBvh *bvh = spore_bvh_create(&torus, NULL);
  for (int i = 0; i < 500; i++) {
    SporeVec3 p = random_point(1.6);
    uint32_t triangle;
    double distance = spore_bvh_distance(bvh, p, NULL, &triangle), alone;
    SporeTriangleMesh one = {torus.vertex_count, 1, torus.vertices, torus.triangles + 3 * triangle};
    SporeBvh *single = spore_bvh_create(&one, NULL);
    alone = spore_bvh_distance(single, p, NULL, NULL);
    CLOSE(alone, distance, 1e-14);
    spore_bvh_free(single);
  }
  spore_bvh_free(bvh);
  spore_triangle_mesh_clear(&torus);
}

static double exact_winding(const SporeTriangleMesh *mesh, SporeVec3 p) {
  double sum = 0;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    SporeVec3 v[3];
    double l[3];
    for (int k = 0; k < 3; k++) {
      v[k] = spore_vec3_sub(spore_vec3_load(mesh->vertices + 3 * (size_t)mesh->triangles[3 * t + k]), p);
      l[k] = spore_vec3_length(v[k]);
    }
    sum += 2 * atan2(spore_vec3_dot(v[0], spore_vec3_cross(v[1], v[2])),
                     l[0] * l[1] * l[2] + spore_vec3_dot(v[0], v[1]) * l[2] + spore_vec3_dot(v[1], v[2]) * l[0] +
                         spore_vec3_dot(v[2], v[0]) * l[1]);
  }
  return sum / (4 * G_PI);
}

/* Closed, open, and three shells: against the sum over all triangles. */
static void test_winding(void) {
  SporeTriangleMesh mesh, ball;
  shape_torus(&mesh, 1, 0.4, 60, 30);
  for (int kind = 0; kind < 3; kind++) {
    if (kind == 1) mesh.triangle_count -= 300;
    if (kind == 2) {
      shape_ball(&ball, 1.2, 12);
      shape_append(&mesh, &ball);
      shape_append(&mesh, &ball);
      spore_triangle_mesh_clear(&ball);
    }
    SporeBvh *bvh = spore_bvh_create(&mesh, NULL);
    for (int i = 0; i < 1000; i++) {
      SporeVec3 p = random_point(1.8);
      CLOSE(spore_bvh_winding(bvh, p), exact_winding(&mesh, p), kind == 2 ? 3 * 0.04 : 0.04);
    }
    spore_bvh_free(bvh);
  }
  spore_triangle_mesh_clear(&mesh);
}

/* Closed, open, shells in each other, one of them turned inside out, corners in several copies: as the sum over all
 * triangles says. */
static void test_inside(void) {
  for (int kind = 0; kind < 5; kind++) {
    SporeTriangleMesh mesh, ball;
    size_t inside = 0;
    shape_torus(&mesh, 1, 0.4, 24, 12);
    if (kind == 1) mesh.triangle_count -= 60;
    if (kind >= 2) {
      shape_ball(&ball, 1.2, 5);
      if (kind == 3) shape_turn(&ball);
      shape_append(&mesh, &ball);
      spore_triangle_mesh_clear(&ball);
    }
    if (kind == 4) shape_unweld(&mesh);
    SporeBvh *bvh = spore_bvh_create(&mesh, NULL);
    for (int i = 0; i < 600; i++) {
      SporeVec3 p = random_point(1.5);
      double winding = exact_winding(&mesh, p);
      if (kind == 1 && fabs(winding - 0.5) < 0.05) continue; /* an open one is looked at by the approximation */
      g_assert_cmpint(spore_bvh_inside(bvh, p), ==, winding > 0.5);
      inside += winding > 0.5;
    }
    g_assert_cmpuint(inside, >, 10);
    spore_bvh_free(bvh);
    spore_triangle_mesh_clear(&mesh);
  }
}

/* Rays from places of a lattice meet corners and edges of the box's triangles, where a crossing tells nothing. */
static void test_inside_below_corners(void) {
  const double lower[3] = {-1, -1, -1}, upper[3] = {1, 1, 1};
  SporeTriangleMesh box;
  shape_box(&box, lower, upper, 8);
  SporeBvh *bvh = spore_bvh_create(&box, NULL);
  for (int i = 0; i < 11 * 11 * 11; i++) {
    SporeVec3 p = spore_vec3(i % 11 * 0.25 - 1.25, i / 11 % 11 * 0.25 - 1.25, i / 121 * 0.25 - 1.25);
    if (box_depth(p) != 0) g_assert_cmpint(spore_bvh_inside(bvh, p), ==, box_depth(p) > 0);
  }
  g_assert_false(spore_bvh_inside(bvh, spore_vec3(NAN, 0, 0)));
  spore_bvh_free(bvh);
  spore_triangle_mesh_clear(&box);
}

static void test_ray(void) {
  SporeTriangleMesh ball;
  shape_ball(&ball, 1, 24);
  SporeBvh *bvh = spore_bvh_create(&ball, NULL);
  double t;
  uint32_t triangle;
  for (int i = 0; i < 2000; i++) {
    SporeVec3 p = random_point(0.5), d = random_point(1);
    g_assert_true(spore_bvh_ray(bvh, p, d, &t, &triangle)); /* from inside it must leave */
    SporeVec3 hit = spore_vec3_add_scaled(p, t, d);
    CLOSE(spore_vec3_length(hit), 1, 0.005);
    CLOSE(spore_bvh_distance(bvh, hit, NULL, NULL), 0, 1e-9);
  }
  g_assert_true(spore_bvh_ray(bvh, spore_vec3(0, 0, -5), spore_vec3(0, 0, 1), &t, &triangle));
  CLOSE(t, 4, 0.005); /* the near side, not the far one */
  g_assert_false(spore_bvh_ray(bvh, spore_vec3(0, 0, -5), spore_vec3(0, 0, -1), &t, &triangle));
  g_assert_false(spore_bvh_ray(bvh, spore_vec3(0, 2, -5), spore_vec3(0, 0, 1), NULL, NULL));
  spore_bvh_free(bvh);
  spore_triangle_mesh_clear(&ball);
}

/* Triangles that are points, lines, or all in one place neither break the tree nor the answers. */
static void test_degenerate(void) {
  double vertices[] = {0, 0, 0, 1, 0, 0, 2, 0, 0};
  uint32_t triangles[3 * 64];
  for (int i = 0; i < 64; i++)
    triangles[3 * i] = 0, triangles[3 * i + 1] = i % 2 ? 0 : 1, triangles[3 * i + 2] = i % 2 ? 0 : 2;
  SporeTriangleMesh mesh = {3, 64, vertices, triangles};
  SporeBvh *bvh = spore_bvh_create(&mesh, NULL);
  CLOSE(spore_bvh_distance(bvh, spore_vec3(1.5, 1, 0), NULL, NULL), 1, 1e-12);
  CLOSE(spore_bvh_distance(bvh, spore_vec3(-3, 4, 0), NULL, NULL), 5, 1e-12);
  CLOSE(spore_bvh_winding(bvh, spore_vec3(0.5, 1, 0)), 0, 1e-12);
  g_assert_true(isfinite(spore_bvh_winding(bvh, spore_vec3(0, 0, 0))));
  g_assert_false(spore_bvh_ray(bvh, spore_vec3(0.5, 1, 0.1), spore_vec3(0, -1, 0), NULL, NULL));
  spore_bvh_free(bvh);
}

static void test_no_memory(void) {
  SporeTriangleMesh ball;
  SporeBvh *bvh = NULL;
  shape_ball(&ball, 1, 3);
  for (uint64_t n = 1; !bvh; n++) {
    SporeError error = SPORE_ERROR_INIT;
    spore_allocation_fail_at(n);
    bvh = spore_bvh_create(&ball, &error);
    spore_allocation_fail_at(0);
    g_assert_cmpint(error.code, ==, bvh ? SPORE_ERROR_NONE : SPORE_ERROR_MEMORY);
    g_assert_cmpuint(n, <, 20);
  }
  spore_bvh_free(bvh);
  spore_bvh_free(NULL);
  spore_triangle_mesh_clear(&ball);
}

/* Cubes that are small, or wider than the surface; places in a lump, so that cubes are used, and far away, where no
 * cube is; so many triangles that no cube can hold them. The depth is the same to the bit, and what is called nearest
 * lies at that distance. */
static void test_depth_cells(void) {
  const double sides[3] = {0.02, 0.11, 3};
  for (int shape = 0; shape < 6; shape++) {
    SporeTriangleMesh mesh;
    shape_torus(&mesh, 1, 0.4, shape < 3 ? 31 : 300, shape < 3 ? 17 : 120);
    SporeBvh *bvh = spore_bvh_create(&mesh, NULL);
    SporeDepthCells *cells = spore_depth_cells_create(bvh, sides[shape % 3]);
    SporeBvhKnown known = {.depth = 0};
    for (int i = 0; i < 20000; i++) {
      SporeVec3 at = i % 5 ? random_point(0.15) : random_point(i % 10 ? 1.6 : 1e8);
      if (i % 5) at.x += 0.85;
      known = spore_depth_cells_beside(cells, at, &known);
      g_assert_true(known.depth == spore_bvh_depth(bvh, at));
      CLOSE(spore_vec3_distance(at, known.nearest), fabs(known.depth), 1e-14 + 1e-14 * fabs(known.depth));
    }
    spore_depth_cells_free(cells);
    spore_bvh_free(bvh);
    spore_triangle_mesh_clear(&mesh);
  }
}

/* Without memory for the cubes the depths are the same. */
static void test_depth_cells_without_memory(void) {
  SporeTriangleMesh torus;
  shape_torus(&torus, 1, 0.4, 31, 17);
  SporeBvh *bvh = spore_bvh_create(&torus, NULL);
  spore_allocation_fail_at(1);
  g_assert_null(spore_depth_cells_create(bvh, 0.1));
  for (uint64_t n = 1; n < 12; n++) {
    SporeDepthCells *cells = spore_depth_cells_create(bvh, 0.1);
    SporeBvhKnown known = {.depth = 0};
    uint64_t before = spore_allocation_count();
    spore_allocation_fail_at(n);
    for (int i = 0; i < 20000; i++) {
      SporeVec3 at = random_point(1.2);
      known = spore_depth_cells_beside(cells, at, &known);
      g_assert_true(known.depth == spore_bvh_depth(bvh, at));
    }
    spore_allocation_fail_at(0);
    g_assert_cmpuint(spore_allocation_count() - before, >=, n);
    spore_depth_cells_free(cells);
  }
  spore_bvh_free(bvh);
  spore_triangle_mesh_clear(&torus);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/mesh/bvh/box", test_box);
  g_test_add_func("/mesh/bvh/nearest-triangle", test_nearest_triangle);
  g_test_add_func("/mesh/bvh/winding", test_winding);
  g_test_add_func("/mesh/bvh/inside", test_inside);
  g_test_add_func("/mesh/bvh/inside-below-corners", test_inside_below_corners);
  g_test_add_func("/mesh/bvh/ray", test_ray);
  g_test_add_func("/mesh/bvh/degenerate", test_degenerate);
  g_test_add_func("/mesh/bvh/depth-cells", test_depth_cells);
  g_test_add_func("/mesh/bvh/depth-cells-without-memory", test_depth_cells_without_memory);
  g_test_add_func("/mesh/bvh/no-memory", test_no_memory);
  generator = g_rand_new_with_seed(7);
  int status = g_test_run();
  g_rand_free(generator);
  return status;
}
