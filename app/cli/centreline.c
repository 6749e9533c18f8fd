/* spore centreline: the middle line of a tubular organ. */
#include <glib/gi18n.h>
#include <string.h>

#include "app/cli/scene.h"
#include "app/cli/generate.h"
#include "core/author/generated_edits.h"
#include "core/author/centreline_body.h"
#include "core/generate/centreline/centreline.h"
#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/io/scene_xml.h"

/* Where the results go. */
typedef struct Output {
  char *curve, *scene, *root;
  int kind; /* SporeCentrelineBody; -1: none, the curve alone */
  gint64 control_points;
} Output;

/* What is made: the line, and the root of the mesentery of an intestine. */
typedef struct Result {
  SporeCurve curve, root;
  SporeCentrelineReport figures;
  SporeCentrelineRoot mesentery;
} Result;

static void clear_result(Result *result) {
  spore_curve_clear(&result->curve);
  spore_curve_clear(&result->root);
}

static gboolean read_root(const char *file, SporeCurve *root, GError **error) {
  g_autoptr(GBytes) content = spore_cli_read_file(file, _("a curve"), error);
  gsize size = 0;
  const char *text = content ? g_bytes_get_data(content, &size) : NULL;
  return content && spore_curve_parse(file, text, size, root, error);
}

/* The root that is given, or else one that is proposed, of an intestine. */
static gboolean find_root(const Output *output, gint64 degree, Result *result, GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  if (output->kind != SPORE_CENTRELINE_INTESTINE || (!output->root && degree == 0)) return TRUE;
  if (output->root && !read_root(output->root, &result->root, error)) return FALSE;
  if ((output->root || spore_centreline_root(&result->curve, (size_t)degree, &result->root, &fault)) &&
      spore_centreline_root_measure(&result->curve, &result->root, &result->mesentery, &fault))
    return TRUE;
  spore_error_at(&fault, "--root-degree");
  return spore_error_propagate(&fault, error);
}

static gboolean make_line(SporeCli *cli, const SporeTriangleMesh *mesh, const char *place,
                          const SporeCurveFields *fields, const Output *output, Result *result, GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  const SporeCentrelineOptions options = spore_edit_centreline_options(fields);
  if (spore_centreline_from_mesh(mesh, &options, &result->curve, &result->figures, spore_cli_progress(cli), &fault))
    return find_root(output, fields->root_degree, result, error);
  spore_error_at(&fault, place);
  return spore_error_propagate(&fault, error);
}

static SporeCentrelineBodyOptions body_options(const Output *output, const Result *result) {
  return (SporeCentrelineBodyOptions){.body = (SporeCentrelineBody)output->kind,
                                      .control_points = (size_t)output->control_points,
                                      .root = result->root.count ? &result->root : NULL};
}

static void report_root(SporeCli *cli, const Output *output, const Result *result) {
  const SporeCentrelineRoot *mesentery = &result->mesentery;
  if (result->root.count == 0) return;
  spore_cli_open(cli, "root");
  spore_cli_text(cli, "from", output->root ? output->root : "proposed");
  spore_cli_number(cli, "length", mesentery->length);
  spore_cli_number(cli, "mesentery_min", mesentery->shortest);
  spore_cli_number(cli, "mesentery_mean", mesentery->mean);
  spore_cli_number(cli, "mesentery_max", mesentery->longest);
  spore_cli_close(cli);
  spore_cli_say(cli,
                output->root
                    ? _("the mesentery begins at the root that was given, %.3g m long: %.3g m from there to the "
                        "line (%.3g to %.3g)\n")
                    : _("the mesentery begins at a root through the middle of the loops, proposed, %.3g m long: "
                        "%.3g m from there to the line (%.3g to %.3g); another one: --root F.curve\n"),
                mesentery->length, mesentery->mean, mesentery->shortest, mesentery->longest);
}

static void report_branches(SporeCli *cli, const SporeCentrelineReport *report) {
  spore_cli_count(cli, "branches", (gint64)report->branches);
  spore_cli_open_array(cli, "side_branches");
  for (gsize i = 0; i < MIN(report->branches, SPORE_CENTRELINE_NAMED); i++) {
    const SporeCentrelineBranch *branch = &report->branch[i];
    spore_cli_open(cli, NULL);
    spore_cli_number(cli, "from", branch->from);
    spore_cli_number(cli, "length", branch->length);
    spore_cli_open_array(cli, "end");
    for (int k = 0; k < 3; k++) spore_cli_number(cli, NULL, branch->end[k]);
    spore_cli_close_array(cli);
    spore_cli_text(cli, "kind", branch->returns ? "loop" : "branch");
    spore_cli_close(cli);
    spore_cli_say(cli,
                  branch->returns ? _("left out: a loop at %.4g m of the line, to %.4g m off it (%.4g,%.4g,%.4g)\n")
                                  : _("left out: a branch at %.4g m of the line, %.4g m long, to %.4g,%.4g,%.4g\n"),
                  branch->from, branch->length, branch->end[0], branch->end[1], branch->end[2]);
  }
  spore_cli_close_array(cli);
}

static void report(SporeCli *cli, const Output *output, const Result *result) {
  const SporeCurve *curve = &result->curve;
  const SporeCentrelineReport *report = &result->figures;
  spore_cli_count(cli, "points", (gint64)curve->count);
  spore_cli_number(cli, "length", report->length);
  spore_cli_open(cli, "radius");
  spore_cli_number(cli, "mean", report->radius_mean);
  spore_cli_number(cli, "min", report->radius_min);
  spore_cli_number(cli, "max", report->radius_max);
  spore_cli_close(cli);
  spore_cli_count(cli, "components", (gint64)report->components);
  spore_cli_number(cli, "share", report->share);
  spore_cli_number(cli, "cover", report->cover);
  spore_cli_number(cli, "inner_wall", report->inner_wall);
  spore_cli_number(cli, "offset", report->offset);
  spore_cli_number(cli, "outside", report->outside);
  spore_cli_number(cli, "approach", report->approach);
  spore_cli_number(cli, "seconds", report->seconds);
  spore_cli_say(cli,
                _("%zu points, %.4g m long, radius %.3g m (%.3g to %.3g), %.2f radii off the middle of its sections, "
                  "%.1f %% of the surface within its reach, %.2f s\n"),
                curve->count, report->length, report->radius_mean, report->radius_min, report->radius_max,
                report->offset, 100 * report->cover, report->seconds);
  if (report->components > 1)
    spore_cli_say(cli, _("the organ is in %zu pieces; the line is that of the largest, %.1f %% of it\n"),
                  report->components, 100 * report->share);
  if (report->inner_wall > 0)
    spore_cli_say(cli, _("the organ has a lumen, which counts as inside: %.0f %% of the surface is its wall\n"),
                  100 * report->inner_wall);
  if (report->cover < SPORE_CENTRELINE_FOLLOWED)
    spore_cli_say(cli,
                  _("%.1f %% of the surface is not followed; name two ends to follow another way, or take off what is "
                    "no part of the tube\n"),
                  100 * (1 - report->cover));
  if (report->approach < 1) spore_cli_say(cli, _("loops of the organ touch: they overlap as tubes of its radius\n"));
  report_root(cli, output, result);
  report_branches(cli, report);
}

/* The mesh that the body shows: the organ's own surface. */
static SporeObject *insert_mesh(SporeDocument *document, const char *name, const char *file, GBytes *content, int unit,
                                int frame, GError **error) {
  SporeObject *shown = spore_organ_insert(document, name, file, content, unit, frame, error);
  if (!shown || !spore_document_remove(document, shown, error)) return NULL;
  SporeObject *assets = spore_document_section(document, "assets");
  return spore_object_child(assets, spore_object_child_count(assets) - 1);
}

/* A mesh file that was read. */
typedef struct Input {
  const char *file;
  GBytes *content;
  int unit, frame;
  SporeTriangleMesh mesh;
} Input;

static gboolean make_body(SporeDocument *document, const Input *input, const SporeCurve *curve,
                          const SporeCentrelineBodyOptions *options, bool carried, GError **error) {
  g_autofree char *base = g_path_get_basename(input->file);
  char *dot = strrchr(base, '.');
  if (dot && dot != base) *dot = '\0';
  g_autofree char *name = spore_organ_name(base);
  SporeObject *mesh = NULL;
  if (carried) {
    mesh = insert_mesh(document, name, input->file, input->content, input->unit, input->frame, error);
    if (!mesh) return FALSE;
  }
  return spore_centreline_body_insert(document, name, curve, options, mesh, error) != NULL;
}

static gboolean write_scene(SporeCli *cli, const Input *input, const Result *result, const Output *output,
                            GError **error) {
  SporeCentrelineBodyOptions options = body_options(output, result);
  bool carried = spore_centreline_carries(&result->curve, &input->mesh);
  SporeDocument *document = spore_cli_new_scene(cli, output->scene);
  gboolean done = make_body(document, input, &result->curve, &options, carried, error) &&
                  spore_cli_save_scene(document, output->scene, error);
  spore_document_free(document);
  if (!done) return FALSE;
  spore_cli_text(cli, "skin", carried ? "mesh" : "own");
  spore_cli_say(cli,
                carried ? _("%s: written; the body carries the mesh\n")
                        : _("%s: written; the body shows a skin of its own\n"),
                output->scene);
  return TRUE;
}

static gboolean write_curve(const char *file, const SporeCurve *curve, GError **error) {
  gsize size = 0;
  g_autofree char *text = spore_curve_format(curve, &size);
  return spore_write_file(file, text, size, error);
}

static gboolean write_results(SporeCli *cli, const Input *input, const Result *result, const Output *output,
                              GError **error) {
  return (!output->curve || write_curve(output->curve, &result->curve, error)) &&
         (!output->scene || write_scene(cli, input, result, output, error));
}

static int generate(SporeCli *cli, const char *file, const SporeCliOptions *asked, const char *unit, const char *frame,
                    const Output *output) {
  SporeCurveFields fields;
  spore_parameters_set_initial(&asked->table, &fields);
  spore_cli_options_fill(asked, &fields);
  GError *error = NULL;
  Input input = {.file = file};
  Result result = {0};
  gboolean done =
      (!output->curve || spore_cli_has_room(output->curve, file, &error)) &&
      (!output->scene || spore_cli_has_room_for_scene(output->scene, file, &error)) &&
      spore_cli_read_mesh(cli, file, unit, frame, &input.mesh, &input.content, &input.unit, &input.frame, &error);
  done = done && make_line(cli, &input.mesh, file, &fields, output, &result, &error) &&
         write_results(cli, &input, &result, output, &error);
  if (done) report(cli, output, &result);
  spore_triangle_mesh_clear(&input.mesh);
  if (input.content) g_bytes_unref(input.content);
  clear_result(&result);
  return done ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

/* Works from the mesh that a body of a scene shows, and gives the result to that body. */
static gboolean make_in(SporeCli *cli, const char *file, const char *body, const SporeCliOptions *asked,
                        const Output *output, SporeSceneBody *scene, GError **error) {
  SporeCurveFields fields;
  Result result = {0};
  if (!spore_cli_open_body(cli, file, body, asked, scene, &fields, error)) return FALSE;
  gboolean done = make_line(cli, scene->mesh, spore_object_name(scene->source), &fields, output, &result, error);
  const SporeGeneratedFrom from = spore_cli_generated_from(scene, &fields);
  const SporeCentrelineBodyOptions along = body_options(output, &result);
  done = done && spore_edit_use_curve(scene->document, scene->body, &from, &result.curve,
                                      output->kind < 0 ? NULL : &along, error);
  if (done) {
    report(cli, output, &result);
    done = spore_cli_save_body(cli, scene, file, error);
  }
  clear_result(&result);
  return done;
}

static int generate_in(SporeCli *cli, const char *file, const char *body, const SporeCliOptions *options,
                       const Output *output) {
  GError *error = NULL;
  SporeSceneBody scene = {0};
  gboolean done = make_in(cli, file, body, options, output, &scene, &error);
  spore_cli_close_body(&scene);
  return done ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

/* A scene states the unit and the axes of its meshes, and keeps the line; the options for these are for files. */
static int check_scene(gboolean scene, const char *body, gboolean others) {
  if (!scene && body)
    return spore_cli_usage(_("spore centreline: --body is for scenes; expected a file F.spore with it; leave it out"));
  if (scene && others)
    return spore_cli_usage(_("spore centreline: a scene says unit and axes, and takes the line itself; expected none "
                             "of --unit, --frame, --scene and --output with it; leave them out, or give the mesh's "
                             "file"));
  return SPORE_EXIT_DONE;
}

/* Checks what the command line asks for, and prints its own message. scene: the file is a scene. */
static int check(const SporeCliOptions *options, const Output *output, gboolean scene) {
  if (spore_cli_options_has(options, "first_place") != spore_cli_options_has(options, "last_place"))
    return spore_cli_usage(
        _("spore centreline: one end is given; expected both --first-place and --last-place, X,Y,Z in "
          "metres, or none; give the other"));
  if (!scene && !output->scene && (options->purpose >= 0 || output->control_points))
    return spore_cli_usage(_("spore centreline: --as and --control-points say what scene to write; expected --scene "
                             "F.spore too; name it"));
  if (output->scene && output->kind < 0)
    return spore_cli_usage(_("spore centreline: --as curve makes no body; expected thread, tube or intestine with "
                             "--scene; leave --scene out, or choose one of them"));
  if (output->root && output->kind != SPORE_CENTRELINE_INTESTINE)
    return spore_cli_usage(
        _("spore centreline: --root is of an intestine's mesentery; expected --as intestine with it; "
          "leave it out, or make an intestine"));
  if (output->control_points != 0 && (output->control_points < 4 || output->control_points > 100000))
    return spore_cli_usage(_("spore centreline: --control-points %lld; expected 4 to 100000; give another number"),
                           (long long)output->control_points);
  return SPORE_EXIT_DONE;
}

int spore_command_centreline(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"points", N_("of the curve")},
      {"length", N_("of the line, m")},
      {"radius", N_("distance to the surface, m: mean, min, max")},
      {"components", N_("pieces of the organ; the line is that of the largest")},
      {"share", N_("of the organ's volume, of the piece that has the line")},
      {"cover", N_("share of the surface, by area, within two radii of the line through the inside")},
      {"inner_wall", N_("share of the surface that is the wall of a lumen; the lumen counts as inside")},
      {"offset", N_("mean distance of the line from the middle of its sections, of the radius (an estimate)")},
      {"outside", N_("share of the points that lie outside of the organ")},
      {"approach", N_("least distance of two loops, of the sum of their radii; below 1 they touch, null: no loops")},
      {"seconds", N_("that it took")},
      {"root", N_("of an intestine's mesentery: from (a file, or proposed), length, and mesentery_min, mesentery_mean, "
                  "mesentery_max: from there to the line, m")},
      {"branches", N_("number of branches left out: the line takes the longest way")},
      {"side_branches", N_("the longest of them: from (m along the line), length (m), end (m), kind (branch or loop)")},
      {"skin", N_("with --scene: mesh where the body carries the mesh, own where it shows a tube around the line")},
      {"scene", N_("that was given: as written, and the name of the body along the line: body")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {"centreline",
                                        "MESH|SCENE",
                                        N_("Finds the middle line of a tubular organ, with its radius. Of a scene "
                                           "(F.spore): from the mesh that a body of "
                                           "it shows, which becomes a thread, tube or intestine."),
                                        1,
                                        1,
                                        members};
  char *unit = NULL, *frame = NULL, *body = NULL;
  Output output = {0};
  const GOptionEntry entries[] = {
      {"unit", 'u', 0, G_OPTION_ARG_STRING, &unit, N_("Unit of the mesh: m, cm, mm, um, in (default m)"), "UNIT"},
      {"frame", 'f', 0, G_OPTION_ARG_STRING, &frame, N_("Axes of the mesh: Y_UP, RAS, LPS"), "FRAME"},
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &output.curve, N_("File to write, x y z r a line"), "F.curve"},
      {"scene", 's', 0, G_OPTION_ARG_FILENAME, &output.scene, N_("Scene to write, with a body along the line"),
       "F.spore"},
      {"root", 0, 0, G_OPTION_ARG_FILENAME, &output.root,
       N_("Root of an intestine's mesentery, x y z r a line, m (default: proposed, through the middle of the loops)"),
       "F.curve"},
      SPORE_SCENE_BODY_ENTRY(&body),
      {"control-points", 0, 0, G_OPTION_ARG_INT64, &output.control_points,
       N_("Control points of the body (default: one each two radii)"), "N"},
      G_OPTION_ENTRY_NULL};
  g_auto(SporeCliOptions) options = {0};
  int status = spore_cli_options_parse(&options, cli, &spore_generator_curve, "n=points t=tolerance", &info, entries,
                                       &argc, &argv);
  gboolean scene = status == SPORE_EXIT_DONE && spore_cli_is_scene(argv[1]);
  output.kind = options.purpose < 0 ? SPORE_CENTRELINE_TUBE : options.purpose - 1;
  if (status == SPORE_EXIT_DONE) status = check_scene(scene, body, unit || frame || output.curve || output.scene);
  if (status == SPORE_EXIT_DONE) status = check(&options, &output, scene);
  if (status == SPORE_EXIT_DONE)
    status = scene ? generate_in(cli, argv[1], body, &options, &output)
                   : generate(cli, argv[1], &options, unit, frame, &output);
  g_free(unit);
  g_free(frame);
  g_free(output.curve);
  g_free(output.scene);
  g_free(output.root);
  g_free(body);
  return status;
}
