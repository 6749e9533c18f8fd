/* spore tetrahedra: a tetrahedral mesh in a surface. */
#include <glib/gi18n.h>

#include "app/cli/cli.h"
#include "core/generate/tetrahedra.h"
#include "core/io/mesh_import.h"
#include "core/io/scene_xml.h"

typedef char *(*Formatter)(const SporeTetrahedralMesh *mesh, gsize *size);

static Formatter formatter_of(const char *file) {
  if (g_str_has_suffix(file, ".vtu")) return spore_vtu_format;
  if (g_str_has_suffix(file, ".msh")) return spore_gmsh_format;
  return g_str_has_suffix(file, ".mesh") ? spore_medit_format : NULL;
}

static void report(SporeCli *cli, const SporeTetrahedralMesh *mesh, const SporeTetrahedraReport *report) {
  spore_cli_count(cli, "nodes", (gint64)mesh->vertex_count);
  spore_cli_count(cli, "tetrahedra", (gint64)mesh->tetrahedron_count);
  spore_cli_number(cli, "min_dihedral_deg", report->quality.min_dihedral_deg);
  spore_cli_number(cli, "mean_dihedral_deg", report->quality.mean_dihedral_deg);
  spore_cli_number(cli, "hausdorff", report->hausdorff);
  spore_cli_number(cli, "volume_change", report->volume_change);
  spore_cli_text(cli, "method", report->method);
  spore_cli_number(cli, "seconds", report->seconds);
  spore_cli_say(
      cli,
      _("%zu tetrahedra, %zu nodes: least dihedral angle %.1f degrees (mean of minima %.1f), distance %.2f %% of "
        "the diagonal, volume %+.1f %%, %s, %.1f s\n"),
      mesh->tetrahedron_count, mesh->vertex_count, report->quality.min_dihedral_deg, report->quality.mean_dihedral_deg,
      100 * report->hausdorff, 100 * report->volume_change, report->method, report->seconds);
}

static int generate(SporeCli *cli, const char *file, const SporeTetrahedraOptions *options, const char *unit,
                    const char *frame, const char *output) {
  GError *error = NULL;
  SporeTriangleMesh surface = {0};
  SporeTetrahedralMesh mesh = {0};
  SporeTetrahedraReport figures = {0};
  gboolean done = (!output || spore_cli_keeps(output, file, &error)) &&
                  spore_cli_read_mesh(cli, file, unit, frame, &surface, NULL, NULL, NULL, &error) &&
                  spore_tetrahedra_from_mesh(file, &surface, options, &mesh, &figures, spore_cli_progress(cli), &error);
  if (done && output) {
    gsize size = 0;
    g_autofree char *text = formatter_of(output)(&mesh, &size);
    done = spore_write_file(output, text, size, &error);
  }
  if (done) report(cli, &mesh, &figures);
  spore_triangle_mesh_clear(&surface);
  spore_tetrahedral_mesh_clear(&mesh);
  return done ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

int spore_command_tetrahedra(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {{"nodes", N_("number of nodes")},
                                              {"tetrahedra", N_("number of tetrahedra")},
                                              {"min_dihedral_deg", N_("least angle between two faces of any, degrees")},
                                              {"mean_dihedral_deg", N_("mean of the least angles, degrees")},
                                              {"hausdorff", N_("largest distance to the surface, of the diagonal")},
                                              {"volume_change", N_("share of the volume that was gained")},
                                              {"method", N_("direct, repaired or wrapped: what the surface needed")},
                                              {"seconds", N_("that it took")},
                                              {NULL, NULL}};
  static const SporeCommandInfo info = {"tetrahedra", "MESH", N_("Fills a mesh with tetrahedra."), 1, 1, members};
  char *unit = NULL, *frame = NULL, *output = NULL;
  gint64 cells = 0;
  double size = 0;
  const GOptionEntry entries[] = {
      {"cells", 'n', 0, G_OPTION_ARG_INT64, &cells, N_("Number of tetrahedra, about"), "N"},
      {"size", 's', 0, G_OPTION_ARG_DOUBLE, &size, N_("Edge length, m"), "D"},
      {"unit", 'u', 0, G_OPTION_ARG_STRING, &unit, N_("Unit of the mesh: m, cm, mm, um, in (default m)"), "UNIT"},
      {"frame", 'f', 0, G_OPTION_ARG_STRING, &frame, N_("Axes of the mesh: Y_UP, RAS, LPS"), "FRAME"},
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &output, N_("File to write: .vtu, .msh or .mesh"), "F"},
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) {
    SporeTetrahedraOptions options = {.cells = (size_t)MAX(cells, 0), .size = size};
    if (cells < 0 || cells > 5000000 || (cells == 0) == !(size > 0))
      status = spore_cli_usage(_("spore tetrahedra: neither number of cells nor size is one; expected either --cells 1 "
                                 "to 5000000 or --size in "
                                 "metres above 0; give one of them"));
    else if (output && !formatter_of(output))
      status =
          spore_cli_usage(_("-o %s: the format is not known; expected a name ending in .vtu, .msh or .mesh"), output);
    else status = generate(cli, argv[1], &options, unit, frame, output);
  }
  g_free(unit);
  g_free(frame);
  g_free(output);
  return status;
}
