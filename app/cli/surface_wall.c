#include "app/cli/surface_wall.h"

#include <glib/gi18n.h>

#include "core/generate/surface/surface.h"
#include "core/io/scene_xml.h"

static void report(SporeCli *cli, const SporeTriangleMesh *inner, const SporeWallOptions *options,
                   const SporeWallReport *report) {
  SporeVec3 at = report->error_at;
  spore_cli_open(cli, "wall");
  spore_cli_open(cli, "thickness_m");
  spore_cli_number(cli, "min", report->thickness_min);
  spore_cli_number(cli, "mean", report->thickness_mean);
  spore_cli_number(cli, "max", report->thickness_max);
  spore_cli_close(cli);
  spore_cli_open(cli, "inner_m");
  spore_cli_number(cli, "min", report->inner_min);
  spore_cli_number(cli, "max", report->inner_max);
  spore_cli_close(cli);
  spore_cli_number(cli, "error", report->error);
  spore_cli_open_array(cli, "error_at_m");
  for (int e = 0; e < 3; e++) spore_cli_number(cli, NULL, ((const double[3]){at.x, at.y, at.z})[e]);
  spore_cli_close_array(cli);
  spore_cli_number(cli, "volume_m3", report->wall_volume);
  spore_cli_number(cli, "lumen_m3", report->lumen_volume);
  spore_cli_count(cli, "pieces", (gint64)report->pieces);
  spore_cli_count(cli, "nodes", (gint64)inner->vertex_count);
  spore_cli_count(cli, "triangles", (gint64)inner->triangle_count);
  spore_cli_number(cli, "step_m", report->step);
  spore_cli_number(cli, "seconds", report->seconds);
  spore_cli_close(cli);
  spore_cli_say(cli,
                _("wall: %.4g m thick (%.4g to %.4g from the outside), %.4g m^3; lumen: %.4g m^3 in %zu pieces, %zu "
                  "nodes, %.4g to %.4g m from the outer surface; %.2f s\n"),
                report->thickness_mean, report->thickness_min, report->thickness_max, report->wall_volume,
                report->lumen_volume, report->pieces, inner->vertex_count, report->inner_min, report->inner_max,
                report->seconds);
  spore_cli_say(cli,
                _("farthest off the thickness asked for: %.1f %%, at (%.4g %.4g %.4g) m; a --detail above %d would "
                  "have it nearer, in more nodes\n"),
                100 * report->error, at.x, at.y, at.z, options->detail > 0 ? (int)options->detail : SPORE_WALL_DETAIL);
}

static gboolean write_mesh(const char *file, const SporeTriangleMesh *mesh, GError **error) {
  gsize size = 0;
  g_autofree char *text = spore_surface_formatter(file)(mesh, &size);
  return spore_write_file(file, text, size, error);
}

gboolean spore_surface_make_wall(SporeCli *cli, const char *file, const SporeTriangleMesh *outer,
                                 const SporeWallOptions *options, SporeTriangleMesh *made, GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  SporeTriangleMesh inner = {0}, wall = {0};
  SporeWallReport figures;
  gboolean done = spore_wall_inner(outer, options->thickness, (double)options->detail, &inner, &figures,
                                   spore_cli_progress(cli), &fault) &&
                  spore_wall_solid(outer, &inner, &wall, &fault);
  if (!done) {
    spore_error_at(&fault, file);
    spore_error_propagate(&fault, error);
  }
  done = done && (!options->wall || write_mesh(options->wall, &wall, error)) &&
         (!options->inner || write_mesh(options->inner, &inner, error));
  if (done) report(cli, &inner, options, &figures);
  spore_triangle_mesh_clear(&inner);
  if (done && made) *made = wall;
  else spore_triangle_mesh_clear(&wall);
  return done;
}
