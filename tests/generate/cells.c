/* What the tests of tetrahedra share: a run of the generator, and the checks of its result. */
#include "cells.h"

#include <string.h>

Result fill(SporeTriangleMesh *surface, SporeTetrahedraOptions options, const char *method) {
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

void check_refused(SporeTriangleMesh *surface, SporeTetrahedraOptions options, int code, const char *words) {
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

void check_cells(Result *result, double wanted) {
  g_assert_cmpfloat((double)result->mesh.tetrahedron_count, >=, 0.88 * wanted);
  g_assert_cmpfloat((double)result->mesh.tetrahedron_count, <=, 1.12 * wanted);
}
