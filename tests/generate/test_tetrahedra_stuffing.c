/* The lattice as it is cut, before anything makes its cells better or fewer; cavities that are filled. */
#include <math.h>

#include "cells.h"
#include "core/base/memory.h"
#include "core/generate/tetrahedra/private.h"
#include "tests/mesh/shapes.h"

/* Cells of a lattice in a surface about the origin with a diagonal of about 1; clears the surface. */
static SporeTetrahedralMesh stuff(SporeTriangleMesh *surface, double edge, bool fill) {
  SporeTetrahedraWork work = {.options = {.fill = fill, .tolerance = 0.01}, .surface = *surface, .share = 1};
  SporeTetrahedralMesh mesh;
  g_assert_true(spore_tetrahedra_solid(&work, NULL));
  g_assert_true(spore_tetrahedra_stuff(&work, edge, &mesh, NULL));
  g_assert_true(spore_tetrahedral_mesh_validate(&mesh, NULL));
  spore_triangle_mesh_clear(&work.surface);
  spore_bvh_free(work.tree);
  spore_free(work.bounding);
  spore_free(work.inner);
  *surface = (SporeTriangleMesh){0};
  return mesh;
}

/* Nodes near the surface move onto it: with the shares that Labelle and Shewchuk (2007, section 4) give no dihedral
 * angle is below 10.7 degrees, wherever the solid lies. Cut where they are instead, cells are as thin as the surface
 * is near to a node: angles of about 0. */
static void test_angles(void) {
  for (int i = 0; i < 6; i++) {
    SporeTriangleMesh surface = {0};
    SporeTetrahedraQuality quality;
    if (i % 2) shape_torus(&surface, 0.3, 0.1, 24, 12);
    else shape_ball(&surface, 0.3, 10);
    shape_move(&surface, 0.013 * i, -0.007 * i, 0.019 * i);
    SporeTetrahedralMesh mesh = stuff(&surface, 0.09, false);
    spore_tetrahedral_mesh_quality(&mesh, &quality);
    g_assert_cmpuint(mesh.tetrahedron_count, >, 200);
    g_assert_cmpfloat(quality.min_dihedral_deg, >=, 10.7);
    spore_tetrahedral_mesh_clear(&mesh);
  }
}

/* A room of six walls that overlap: what they enclose is no part of the surface turned inside out, the lattice alone
 * knows that nothing leads there. Filled or not; a door keeps it as it is. */
static void test_rooms(void) {
  const double far = 0.25, thick = 0.06, inside = far - thick;
  for (int i = 0; i < 3; i++) {
    SporeTriangleMesh room = {0};
    SporeTetrahedraQuality quality;
    for (int wall = 0; wall < 6; wall++) {
      double low[3] = {-far, -far, -far}, high[3] = {far, far, far};
      if (wall % 2) low[wall / 2] = inside;
      else high[wall / 2] = -inside;
      if (i == 2 && wall == 5) high[0] = 0; /* a door of half a wall */
      SporeTriangleMesh box = {0};
      shape_box(&box, low, high, 2);
      shape_append(&room, &box);
      spore_triangle_mesh_clear(&box);
    }
    const double whole = pow(2 * far, 3), cavity = pow(2 * inside, 3);
    SporeTetrahedralMesh mesh = stuff(&room, 0.04, i > 0);
    spore_tetrahedral_mesh_quality(&mesh, &quality);
    if (i == 1) g_assert_cmpfloat_with_epsilon(quality.volume / whole, 1, 0.02);
    else g_assert_cmpfloat(quality.volume, <, whole - 0.95 * cavity);
    spore_tetrahedral_mesh_clear(&mesh);
  }
}

/* A hollow ball: filled, it has the volume of a whole one; else of the shell. By each method that may do it. */
static void test_fill(void) {
  for (int i = 0; i < 4; i++) {
    const SporeTetrahedraMethod method = i < 2 ? SPORE_TETRAHEDRA_VOXELS : SPORE_TETRAHEDRA_METHODS;
    SporeTriangleMesh surface = {0}, cavity = {0};
    shape_ball(&surface, 0.05, 6);
    shape_ball(&cavity, 0.025, 6);
    shape_turn(&cavity);
    shape_append(&surface, &cavity);
    spore_triangle_mesh_clear(&cavity);
    Result result = fill(&surface, (SporeTetrahedraOptions){.method = method, .cells = 400, .fill = i % 2},
                         i < 2 ? "voxels" : "direct");
    const double whole = 1.0 / (1 - 0.125); /* of the shell's volume */
    g_assert_cmpfloat_with_epsilon(result.report.volume_change, i % 2 ? whole - 1 : 0, 0.06);
    g_assert_cmpfloat(result.report.hausdorff, <, 0.02); /* a cavity that is filled does not count */
    spore_tetrahedral_mesh_clear(&result.mesh);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/tetrahedra/stuffing-angles", test_angles);
  g_test_add_func("/tetrahedra/stuffing-rooms", test_rooms);
  g_test_add_func("/tetrahedra/fill", test_fill);
  return g_test_run();
}
