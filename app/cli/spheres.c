/* spore spheres: a sphere set from a mesh. */
#include <glib/gi18n.h>

#include "app/cli/cli.h"
#include "core/generate/spheres.h"
#include "core/io/mesh_import.h"
#include "core/io/scene_xml.h"

static void report(SporeCli *cli, const SporeSphereSet *set, const SporeSpheresReport *report) {
  spore_cli_count(cli, "count", (gint64)set->count);
  spore_cli_number(cli, "coverage", report->coverage);
  spore_cli_number(cli, "outside", report->outside);
  spore_cli_open(cli, "distance");
  spore_cli_number(cli, "mean", report->distance_mean);
  spore_cli_number(cli, "max", report->distance_max);
  spore_cli_close(cli);
  spore_cli_number(cli, "depth_error", report->depth_error);
  spore_cli_number(cli, "seconds", report->seconds);
  spore_cli_say(cli,
                _("%zu spheres: coverage %.1f %%, outside %.1f %%, distance %.3f %% (largest %.2f %%) of the diagonal, "
                  "depth error %.3f, %.2f s\n"),
                set->count, 100 * report->coverage, 100 * report->outside, 100 * report->distance_mean,
                100 * report->distance_max, report->depth_error, report->seconds);
}

/* A .mesh file holds tetrahedra, in metres; everything else is a surface. */
static gboolean from_tetrahedra(SporeCli *cli, const char *file, const SporeSpheresOptions *options,
                                SporeSphereSet *set, SporeSpheresReport *figures, GError **error) {
  g_autoptr(GBytes) content = spore_cli_read_file(file, _("a mesh"), error);
  if (!content) return FALSE;
  SporeError fault = SPORE_ERROR_INIT;
  SporeTetrahedralMesh mesh = {0};
  gsize size = 0;
  const char *text = g_bytes_get_data(content, &size);
  gboolean done = spore_medit_parse(file, text, size, &mesh, error);
  if (done && !spore_spheres_from_tetrahedra(&mesh, options, set, figures, spore_cli_progress(cli), &fault)) {
    spore_error_at(&fault, file);
    done = spore_error_propagate(&fault, error);
  }
  spore_tetrahedral_mesh_clear(&mesh);
  return done;
}

static gboolean from_surface(SporeCli *cli, const char *file, const SporeSpheresOptions *options, const char *unit,
                             const char *frame, SporeSphereSet *set, SporeSpheresReport *figures, GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  SporeTriangleMesh mesh = {0};
  gboolean done = spore_cli_read_mesh(cli, file, unit, frame, &mesh, NULL, NULL, NULL, error);
  if (done && !spore_spheres_from_mesh(&mesh, options, set, figures, spore_cli_progress(cli), &fault)) {
    spore_error_at(&fault, file);
    done = spore_error_propagate(&fault, error);
  }
  spore_triangle_mesh_clear(&mesh);
  return done;
}

static int generate(SporeCli *cli, const char *file, const SporeSpheresOptions *options, const char *unit,
                    const char *frame, const char *output) {
  GError *error = NULL;
  SporeSphereSet set = {0};
  SporeSpheresReport figures = {0};
  gboolean done = !output || spore_cli_keeps(output, file, &error);
  if (done)
    done = g_str_has_suffix(file, ".mesh") ? from_tetrahedra(cli, file, options, &set, &figures, &error)
                                           : from_surface(cli, file, options, unit, frame, &set, &figures, &error);
  if (done && output) {
    gsize size = 0;
    g_autofree char *text = spore_spheres_format(&set, &size);
    done = spore_write_file(output, text, size, &error);
  }
  if (done) report(cli, &set, &figures);
  spore_sphere_set_clear(&set);
  return done ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

int spore_command_spheres(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"count", N_("of spheres")},
      {"coverage", N_("share of the inside that lies in a sphere")},
      {"outside", N_("volume of the spheres that lies outside, of the mesh's volume")},
      {"distance", N_("between surface and spheres, of the diagonal: mean, max")},
      {"depth_error", N_("of the depth that is felt, of the largest depth")},
      {"seconds", N_("that it took")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {
      "spheres", "MESH", N_("Fits collision spheres to a mesh, or to the tetrahedra of a .mesh file."), 1, 1, members};
  char *unit = NULL, *frame = NULL, *output = NULL, *mode = NULL;
  gint64 count = 0, seed = 1;
  double tolerance = 0;
  const GOptionEntry entries[] = {
      {"count", 'n', 0, G_OPTION_ARG_INT64, &count, N_("Number of spheres"), "N"},
      {"tolerance", 't', 0, G_OPTION_ARG_DOUBLE, &tolerance,
       N_("Mean distance allowed, of the diagonal: as many spheres as that takes"), "D"},
      {"mode", 'm', 0, G_OPTION_ARG_STRING, &mode,
       N_("What the spheres are to be good at: balanced (default) fits the depth inside"), "MODE"},
      {"unit", 'u', 0, G_OPTION_ARG_STRING, &unit, N_("Unit of the mesh: m, cm, mm, um, in (default m)"), "UNIT"},
      {"frame", 'f', 0, G_OPTION_ARG_STRING, &frame, N_("Axes of the mesh: Y_UP, RAS, LPS"), "FRAME"},
      {"seed", 0, 0, G_OPTION_ARG_INT64, &seed, N_("Seed: the same one gives the same spheres (default 1)"), "N"},
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &output, N_("File to write, x y z r a line"), "F.spheres"},
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) {
    SporeSpheresOptions options = {.count = (size_t)MAX(count, 0), .tolerance = tolerance, .seed = (uint64_t)seed};
    GError *error = NULL;
    int chosen = mode ? spore_cli_choice("--mode", mode, spore_spheres_mode_names, &error) : SPORE_SPHERES_BALANCED;
    if (chosen >= 0) options.mode = (SporeSpheresMode)chosen;
    if (chosen < 0) status = spore_cli_fail(error);
    else if (count < 0 || count > SPORE_SPHERES_MAXIMUM || (count == 0) == !(tolerance >= 1e-4 && tolerance < 1))
      status = spore_cli_usage(_("spore spheres: neither number of spheres nor tolerance is one; expected either "
                                 "--count 1 to %d or --tolerance "
                                 "0.0001 to 1; give one of them"),
                               SPORE_SPHERES_MAXIMUM);
    else status = generate(cli, argv[1], &options, unit, frame, output);
  }
  g_free(unit);
  g_free(frame);
  g_free(output);
  g_free(mode);
  return status;
}
