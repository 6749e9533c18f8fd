/* spore surface: a surface of few, well-shaped triangles for a net, or a hollow organ, from any surface. */
#include <glib/gi18n.h>

#include "app/cli/generate.h"
#include "core/author/generated_edits.h"
#include "core/generate/surface/surface.h"
#include "core/scene/schema_fields.h"

typedef struct WallOptions {
  double thickness;         /* m */
  gint64 detail;            /* see spore_wall_inner; 0: SPORE_WALL_DETAIL */
  const char *wall, *inner; /* files to write, NULL: none; with a suffix that is known */
} WallOptions;

/* The surface. */

static void report_edges(SporeCli *cli, const SporeSurfaceReport *report) {
  spore_cli_open(cli, "edge_m");
  spore_cli_number(cli, "min", report->edge_min);
  spore_cli_number(cli, "mean", report->edge_mean);
  spore_cli_number(cli, "max", report->edge_max);
  spore_cli_close(cli);
}

static void report(SporeCli *cli, const SporeTriangleMesh *mesh, const SporeSurfaceReport *report) {
  const SporeSimplifyReport *simplify = &report->simplify;
  spore_cli_count(cli, "nodes", (gint64)mesh->vertex_count);
  spore_cli_count(cli, "triangles", (gint64)mesh->triangle_count);
  spore_cli_count(cli, "pieces", (gint64)report->pieces);
  spore_cli_count(cli, "open_edges", (gint64)report->open_edges);
  spore_cli_number(cli, "hausdorff", report->hausdorff);
  spore_cli_number(cli, "outline", report->outline);
  spore_cli_number(cli, "min_angle_deg", report->min_angle_deg);
  spore_cli_number(cli, "mean_angle_deg", report->mean_angle_deg);
  report_edges(cli, report);
  spore_cli_number(cli, "area_change", report->area_change);
  spore_cli_number(cli, "volume_change", report->volume_change);
  spore_cli_count(cli, "crossings_before", (gint64)simplify->crossings_before);
  spore_cli_count(cli, "crossings", (gint64)simplify->crossings);
  spore_cli_count(cli, "creases", (gint64)simplify->creases);
  spore_cli_flag(cli, "creases_kept", simplify->creases_kept);
  spore_cli_flag(cli, "reached", simplify->reached);
  spore_cli_number(cli, "seconds", report->seconds);
  spore_cli_say(cli,
                _("%zu nodes, %zu triangles: distance %.2f %% of the diagonal (outline %.2f %%), least angle %.1f "
                  "degrees (mean of least %.1f), edges %.3g m (%.3g to %.3g), %.2f s\n"),
                mesh->vertex_count, mesh->triangle_count, 100 * report->hausdorff, 100 * report->outline,
                report->min_angle_deg, report->mean_angle_deg, report->edge_mean, report->edge_min, report->edge_max,
                report->seconds);
  if (simplify->crossings + simplify->crossings_before > 0)
    spore_cli_say(cli, _("%zu pairs of triangles go through each other (%zu of the given surface)\n"),
                  simplify->crossings, simplify->crossings_before);
  if (!simplify->creases_kept)
    spore_cli_say(
        cli,
        _("so few nodes come nearer to the surface without its %zu creases: open edges alone are kept; ask for "
          "more nodes to have them\n"),
        simplify->creases);
  if (!simplify->reached)
    spore_cli_say(cli, _("fewer nodes would tear the surface, or close a hole or handle of it; weld it or mend it, if "
                         "it should hang together otherwise\n"));
}

/* The wall. */

static void report_wall(SporeCli *cli, const SporeTriangleMesh *inner, const WallOptions *options,
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
  spore_cli_say(
      cli,
      _("farthest off the thickness asked for: %.1f %%, at (%.4g %.4g %.4g) m; a --wall-detail above %d would "
        "have it nearer, in more nodes\n"),
      100 * report->error, at.x, at.y, at.z, options->detail > 0 ? (int)options->detail : SPORE_WALL_DETAIL);
}

/* Reports the wall, and writes the files. made: gets the wall, unless it is NULL; the caller's to clear. */
static gboolean make_wall(SporeCli *cli, const char *file, const SporeTriangleMesh *outer, const WallOptions *options,
                          SporeTriangleMesh *made, GError **error) {
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
  done = done && (!options->wall || spore_cli_write_mesh(options->wall, &wall, error)) &&
         (!options->inner || spore_cli_write_mesh(options->inner, &inner, error));
  if (done) report_wall(cli, &inner, options, &figures);
  spore_triangle_mesh_clear(&inner);
  if (done && made) *made = wall;
  else spore_triangle_mesh_clear(&wall);
  return done;
}

/* Both. */

/* With a wall, the surface is simplified only where that is asked for. made: gets the result, unless it is NULL. */
static gboolean make(SporeCli *cli, const char *file, const SporeTriangleMesh *surface,
                     const SporeSimplifyOptions *options, const WallOptions *wall, SporeTriangleMesh *made,
                     GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  SporeTriangleMesh mesh = {0};
  SporeSurfaceReport figures;
  gboolean thin = options->vertices > 0 || options->size > 0, done = TRUE;
  if (thin && !spore_surface_from_mesh(surface, options, &mesh, &figures, spore_cli_progress(cli), &fault)) {
    spore_error_at(&fault, file);
    return spore_error_propagate(&fault, error);
  }
  if (wall->thickness > 0) {
    done = make_wall(cli, file, thin ? &mesh : surface, wall, made, error);
  } else if (wall->wall) {
    done = spore_cli_write_mesh(wall->wall, &mesh, error);
  }
  if (done && thin) report(cli, &mesh, &figures);
  if (done && made && wall->thickness == 0) *made = mesh;
  else spore_triangle_mesh_clear(&mesh);
  return done;
}

/* Works from the mesh that a body of a scene shows, and gives the result to that body. */
static gboolean make_in(SporeCli *cli, const char *file, const char *body, const SporeCliOptions *asked,
                        SporeSceneBody *scene, GError **error) {
  SporeMeshFields fields;
  SporeTriangleMesh mesh = {0};
  int use = asked->purpose; /* as SporeSurfaceUse */
  if (!spore_cli_open_body(cli, file, body, asked, scene, &fields, error)) return FALSE;
  if (use < 0) use = fields.wall > 0 ? SPORE_SURFACE_SHOWN : SPORE_SURFACE_MODEL;
  const SporeSimplifyOptions options = spore_edit_surface_options(&fields);
  const WallOptions wall = {.thickness = fields.wall, .detail = fields.wall_detail};
  if (!options.vertices && !(options.size > 0) && !(wall.thickness > 0))
    return spore_error_raise(error, SPORE_ERROR_INPUT, file,
                             _("neither number of nodes nor size is known; expected --nodes, --size or --wall; give "
                               "one of them"));
  const SporeGeneratedFrom from = spore_cli_generated_from(scene, &fields);
  gboolean done = make(cli, from.source, scene->mesh, &options, &wall, &mesh, error) &&
                  spore_edit_use_surface(scene->document, scene->body, &from, &mesh, (SporeSurfaceUse)use, error);
  spore_triangle_mesh_clear(&mesh);
  return done && spore_cli_save_body(cli, scene, file, error);
}

static int generate_in(SporeCli *cli, const char *file, const char *body, const SporeCliOptions *options) {
  GError *error = NULL;
  SporeSceneBody scene = {0};
  gboolean done = make_in(cli, file, body, options, &scene, &error);
  spore_cli_close_body(&scene);
  return done ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

/* A scene states the unit and the axes of its meshes, and keeps the result; the options for these are for files. */
static int check_scene(gboolean scene, const char *body, gboolean as, gboolean others) {
  if (!scene && (body || as))
    return spore_cli_usage(
        _("spore surface: --body and --as are for scenes; expected a file F.spore with them; leave them out"));
  if (scene && others)
    return spore_cli_usage(_("spore surface: a scene says unit and axes, and takes the surface itself; expected none "
                             "of --unit, --frame, --inner and --output with it; leave them out, or give the mesh's "
                             "file"));
  return SPORE_EXIT_DONE;
}

/* files: to write. The options of the wall come from the command line. */
static int generate(SporeCli *cli, const char *file, const SporeCliOptions *asked, const char *unit, const char *frame,
                    const WallOptions *files) {
  SporeMeshFields fields;
  spore_parameters_set_initial(&asked->table, &fields);
  if (spore_cli_options_way(asked) < 0) fields.nodes = 0; /* a wall alone: the surface stays as it is */
  spore_cli_options_fill(asked, &fields);
  const SporeSimplifyOptions options = spore_edit_surface_options(&fields);
  const WallOptions whole = {fields.wall, fields.wall_detail, files->wall, files->inner}, *wall = &whole;
  GError *error = NULL;
  SporeTriangleMesh surface = {0};
  gboolean done = (!wall->wall || spore_cli_has_room(wall->wall, file, &error)) &&
                  (!wall->inner || spore_cli_has_room(wall->inner, file, &error)) &&
                  spore_cli_read_mesh(cli, file, unit, frame, &surface, NULL, NULL, NULL, &error) &&
                  make(cli, file, &surface, &options, wall, NULL, &error);
  spore_triangle_mesh_clear(&surface);
  return done ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

/* SPORE_EXIT_DONE where the options fit each other. */
static int check_options(const SporeCliOptions *options, const WallOptions *wall, gboolean scene) {
  gboolean walled = spore_cli_options_number(options, "wall") > 0;
  if (!scene && !walled && spore_cli_options_way(options) < 0)
    return spore_cli_usage(_("spore surface: nothing is asked for; expected either --nodes 1 to %u or --size in metres "
                             "above 0, or a --wall in metres; give one of them"),
                           SPORE_MESH_MAXIMUM);
  if (spore_cli_options_has(options, "wall_detail") && !walled)
    return spore_cli_usage(_("spore surface: --wall-detail says how near a wall is to its thickness; expected a --wall "
                             "with it; give both"));
  if (wall->inner && !walled)
    return spore_cli_usage(
        _("--inner %s: there is no inner surface; expected a --wall to have one; give its thickness"), wall->inner);
  const char *const files[] = {wall->wall, wall->inner};
  for (gsize i = 0; i < G_N_ELEMENTS(files); i++)
    if (files[i] && !spore_cli_knows_mesh(files[i])) return SPORE_EXIT_INPUT;
  return SPORE_EXIT_DONE;
}

int spore_command_surface(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"nodes", N_("number of nodes")},
      {"triangles", N_("number of triangles")},
      {"pieces", N_("that do not hang together: as many as before")},
      {"open_edges", N_("that only one triangle has")},
      {"crossings_before", N_("pairs of triangles of the given surface that go through each other")},
      {"crossings", N_("of the result: more where so few nodes cannot be had otherwise; ask for more nodes")},
      {"hausdorff", N_("largest distance to the surface, both ways, of the diagonal")},
      {"outline", N_("largest distance between the open edges of both, of the diagonal")},
      {"min_angle_deg", N_("least angle of any triangle, degrees")},
      {"mean_angle_deg", N_("mean of the least angles, degrees")},
      {"edge_m", N_("length of edges, m: min, mean, max")},
      {"area_change", N_("share of the area that was gained")},
      {"volume_change", N_("share of the volume that was gained; null where the surface is open")},
      {"creases", N_("edges at which the surface turns more than --keep-angle")},
      {"creases_kept", N_("false: so few nodes come nearer to the surface without")},
      {"reached", N_("false: fewer nodes would change what the surface hangs together like")},
      {"seconds", N_("that it took")},
      {"wall", N_("with --wall: thickness_m (min, mean, max: from the outer surface to the lumen; most where the lumen "
                  "ends short "
                  "of a narrow part), inner_m (min, max: from the lumen to the outer surface), error (largest "
                  "distance of inner_m from the thickness asked for, of it), error_at_m (where), volume_m3, lumen_m3, "
                  "pieces of the "
                  "lumen, its nodes and triangles, step_m (of the lattice that it was first found on), seconds")},
      {"scene", N_("that was given: as written, and the name of the body that has the surface: body")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {
      "surface",
      "MESH|SCENE",
      N_("Makes a surface of fewer, well-shaped triangles, for a net, a deformable surface or a spline. Open edges, "
         "creases, thin parts, holes and handles are kept. Or makes a closed organ hollow: a wall of given thickness "
         "around a lumen that does not cut itself. Of a scene (F.spore): from the mesh that a body of it shows, and "
         "for it."),
      1,
      1,
      members};
  char *unit = NULL, *frame = NULL, *output = NULL, *inner = NULL, *body = NULL;
  const GOptionEntry entries[] = {
      {"inner", 'i', 0, G_OPTION_ARG_FILENAME, &inner, N_("File to write the lumen's surface to: .off or .obj"), "F"},
      {"unit", 'u', 0, G_OPTION_ARG_STRING, &unit, N_("Unit of the mesh: m, cm, mm, um, in (default m)"), "UNIT"},
      {"frame", 'f', 0, G_OPTION_ARG_STRING, &frame, N_("Axes of the mesh: Y_UP, RAS, LPS"), "FRAME"},
      SPORE_SCENE_BODY_ENTRY(&body),
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &output, N_("File to write, in metres: .off or .obj"), "F"},
      G_OPTION_ENTRY_NULL};
  g_auto(SporeCliOptions) options = {0};
  int status =
      spore_cli_options_parse(&options, cli, &spore_generator_surface,
                              "n=nodes s=size k=keep_angle w=wall d=wall_detail", &info, entries, &argc, &argv);
  const WallOptions files = {.wall = output, .inner = inner};
  gboolean scene = status == SPORE_EXIT_DONE && spore_cli_is_scene(argv[1]);
  if (status == SPORE_EXIT_DONE)
    status = check_scene(scene, body, options.purpose >= 0, unit || frame || inner || output);
  if (status == SPORE_EXIT_DONE) status = check_options(&options, &files, scene);
  if (status == SPORE_EXIT_DONE)
    status = scene ? generate_in(cli, argv[1], body, &options) : generate(cli, argv[1], &options, unit, frame, &files);
  g_free(unit);
  g_free(frame);
  g_free(output);
  g_free(inner);
  g_free(body);
  return status;
}
