/* The paper's spheres of a deformable body: the least one round each of its tetrahedra, measured against their boundary
 * as `spore spheres` measures its own. The argument is a .mesh file; the answer is JSON on a line. */
#include <glib.h>
#include <stdio.h>

#include "core/generate/spheres/spheres.h"
#include "core/io/mesh_import.h"

int main(int argc, char **argv) {
  SporeTetrahedralMesh cells = {0};
  SporeSphereSet set;
  SporeSpheresReport report;
  g_autofree char *text = NULL;
  gsize size;
  g_autoptr(GError) error = NULL;
  g_assert_cmpint(argc, ==, 2);
  if (!g_file_get_contents(argv[1], &text, &size, &error) || !spore_medit_parse(argv[1], text, size, &cells, &error))
    g_error("%s", error->message);
  g_assert_true(spore_spheres_of_cells(&cells, NULL, &set, &report, NULL));
  printf("{\"count\": %zu, \"coverage\": %.6g, \"outside\": %.6g, \"distance\": {\"mean\": %.6g}, \"depth_error\": "
         "%.6g}\n",
         set.count, report.coverage, report.outside, report.distance_mean, report.depth_error);
  spore_sphere_set_clear(&set);
  spore_tetrahedral_mesh_clear(&cells);
  return 0;
}
