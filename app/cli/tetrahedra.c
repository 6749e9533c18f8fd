/* spore tetrahedra: a tetrahedral mesh in a surface. */
#include <glib/gi18n.h>

#include "app/cli/generate.h"
#include "app/cli/tetrahedra_labels.h"
#include "app/cli/tetrahedra_list.h"
#include "app/cli/tetrahedra_parts.h"
#include "app/cli/tetrahedra_surroundings.h"
#include "core/author/generated_edits.h"
#include "core/base/memory.h"
#include "core/generate/tetrahedra/tetrahedra.h"
#include "core/io/mesh_import.h"
#include "core/io/scene_xml.h"

#define MANY 1.1 /* times as many cells as were asked for */

typedef char *(*Formatter)(const SporeTetrahedralMesh *mesh, gsize *size);

static Formatter formatter_of(const char *file) {
  if (g_str_has_suffix(file, ".vtu")) return spore_vtu_format;
  if (g_str_has_suffix(file, ".msh")) return spore_gmsh_format;
  return g_str_has_suffix(file, ".mesh") ? spore_medit_format : NULL;
}

/* A figure of the result, the same figure of the given surface, and the change from one to the other. */
static void report_change(SporeCli *cli, const char *name, double result, double given, double change) {
  spore_cli_open(cli, name);
  spore_cli_number(cli, "given", given);
  spore_cli_number(cli, "result", result);
  spore_cli_number(cli, "change", change);
  spore_cli_close(cli);
}

/* Each method that was tried before, and why it failed. */
static void report_refused(SporeCli *cli, const SporeTetrahedraReport *report) {
  spore_cli_open_array(cli, "refused");
  for (int i = 0; i < SPORE_TETRAHEDRA_METHODS; i++) {
    if (!*report->refused[i]) continue;
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "method", spore_tetrahedra_method_names[i]);
    spore_cli_text(cli, "reason", report->refused[i]);
    spore_cli_close(cli);
    spore_cli_say(cli, _("not %s: %s\n"), spore_tetrahedra_method_names[i], report->refused[i]);
  }
  spore_cli_close_array(cli);
}

static void report(SporeCli *cli, const SporeTetrahedralMesh *mesh, const SporeTetrahedraOptions *options,
                   const SporeTetrahedraReport *report) {
  const char *method = spore_tetrahedra_method_names[report->method];
  spore_cli_count(cli, "nodes", (gint64)mesh->vertex_count);
  spore_cli_count(cli, "tetrahedra", (gint64)mesh->tetrahedron_count);
  spore_cli_number(cli, "min_dihedral_deg", report->quality.min_dihedral_deg);
  spore_cli_number(cli, "mean_dihedral_deg", report->quality.mean_dihedral_deg);
  spore_cli_number(cli, "hausdorff", report->hausdorff);
  spore_cli_number(cli, "inner_distance", report->inner_distance);
  spore_cli_number(cli, "inner_share", report->inner_share);
  spore_cli_number(cli, "thickened", report->thickened);
  spore_cli_number(cli, "widened", report->widened);
  spore_cli_number(cli, "thickness_m", report->thickness);
  spore_cli_number(cli, "volume_change", report->volume_change);
  report_change(cli, "volume", report->volume, report->volume_given, report->volume_change);
  report_change(cli, "area", report->area, report->area_given, report->area_change);
  spore_cli_number(cli, "filled_m3", report->filled);
  if (options->apart) {
    spore_cli_count(cli, "shared_faces", (gint64)report->shared_faces);
    spore_cli_number(cli, "border_lost", report->border_lost);
    spore_cli_number(cli, "border_distance", report->border_distance);
  }
  spore_cli_count(cli, "pieces", (gint64)report->pieces);
  spore_cli_count(cli, "pieces_given", (gint64)report->pieces_given);
  spore_cli_number(cli, "crumbs", report->small_components);
  spore_cli_report_parts(cli, report);
  spore_cli_text(cli, "method", method);
  report_refused(cli, report);
  spore_cli_number(cli, "seconds", report->seconds);
  spore_cli_say(
      cli,
      _("%zu tetrahedra, %zu nodes: least dihedral angle %.1f degrees (mean of minima %.1f), distance %.2f %% of "
        "the diagonal, volume %+.1f %%, surface %+.1f %%, %s, %.1f s\n"),
      mesh->tetrahedron_count, mesh->vertex_count, report->quality.min_dihedral_deg, report->quality.mean_dihedral_deg,
      100 * report->hausdorff, 100 * report->volume_change, 100 * report->area_change, method, report->seconds);
  g_autofree char *remarks = spore_tetrahedra_remarks(mesh, options, report);
  spore_cli_say(cli, "%s", remarks);
}

/* wanted: names of parts, NULL: all of the file. */
static int generate(SporeCli *cli, const char *file, const SporeCliOptions *asked, const char *unit, const char *frame,
                    const char *wanted, const char *output) {
  SporeTetrahedraFields fields;
  spore_parameters_set_initial(&asked->table, &fields);
  spore_cli_options_fill(asked, &fields);
  SporeTetrahedraOptions options = spore_edit_tetrahedra_options(
      &fields, (const SporeGenerateRegion *)(gconstpointer)asked->regions->data, asked->regions->len);
  guint32 *parts = NULL;
  g_auto(GStrv) names = NULL;
  GError *error = NULL;
  SporeTriangleMesh surface = {0};
  SporeTetrahedralMesh mesh = {0};
  SporeTetrahedraReport figures = {0};
  gboolean done = spore_cli_read_parts(cli, file, unit, frame, &surface, &parts, &names, &error);
  done = done && (!wanted || spore_cli_keep_parts(file, wanted, &surface, parts, names, &error));
  options.parts = parts;
  options.part_names = (const char *const *)names;
  done = done && spore_tetrahedra_from_mesh(file, &surface, &options, &mesh, &figures, spore_cli_progress(cli), &error);
  if (done && output) {
    gsize size = 0;
    g_autofree char *text = formatter_of(output)(&mesh, &size);
    done = spore_write_file(output, text, size, &error);
  }
  if (done) report(cli, &mesh, &options, &figures);
  spore_free(parts);
  spore_triangle_mesh_clear(&surface);
  spore_tetrahedral_mesh_clear(&mesh);
  return done ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

static void report_work(SporeCli *cli, const SporeGenerateWork *work) {
  const SporeTetrahedraOptions options =
      spore_edit_tetrahedra_options(&work->options.fields.tetrahedra, work->regions, work->region_count);
  report(cli, &work->tetrahedra, &options, &work->tetrahedra_report);
}

/* Works from the mesh that a body of a scene shows, and gives the result to that body. */
static int generate_in(SporeCli *cli, const char *file, const char *body, const SporeCliOptions *options) {
  GError *error = NULL;
  return spore_cli_generate(cli, options, file, body, report_work, &error) ? spore_cli_finish(cli, SPORE_EXIT_DONE)
                                                                           : spore_cli_fail(error);
}

/* What is asked of a label map. */
typedef struct LabelWish {
  char *labels; /* by number or name; NULL: all */
  gboolean list, surroundings;
} LabelWish;

/* A label map and what is made of it. */
typedef struct LabelWork {
  const char *file, *output;
  GBytes *content;
  const SporeLabelSurvey *survey;
  const GArray *chosen; /* of guint16; empty: all */
  gboolean surroundings;
  SporeTetrahedraFields fields;
  SporeLabelMap map;
  SporeTetrahedralMesh mesh;
  SporeLabelTetrahedraReport figures;
} LabelWork;

static gboolean save_scene(SporeCli *cli, const LabelWork *work, GError **error) {
  const SporeLabelBodies organs = {.file = work->file,
                                   .content =
                                       g_bytes_get_size(work->content) <= SPORE_LABEL_MAP_KEPT ? work->content : NULL,
                                   .fields = &work->fields,
                                   .mesh = &work->mesh,
                                   .use = SPORE_LABELS_LINKED};
  g_autoptr(GArray) rest = NULL;
  if (work->surroundings) rest = spore_cli_surroundings(cli, &work->map, work->survey, work->chosen, error);
  if (work->surroundings && !rest) return FALSE;
  if (rest) spore_cli_report_surroundings(cli, rest, work->survey);
  return spore_cli_save_labels(cli, work->output, &organs, &work->figures, work->survey, rest, error);
}

static gboolean write_cells(const LabelWork *work, GError **error) {
  gsize size = 0;
  g_autofree char *text = formatter_of(work->output)(&work->mesh, &size);
  return spore_write_file(work->output, text, size, error);
}

/* Says where many more cells than asked for were needed. */
static void say_many(SporeCli *cli, const LabelWork *work) {
  const size_t asked = (size_t)work->fields.cells, made = work->mesh.tetrahedron_count;
  if (work->fields.size > 0 || (double)made <= MANY * (double)asked) return;
  spore_cli_say(cli,
                _("%zu cells were asked for: fewer than %zu would make cells too flat, or join what the labels part; "
                  "ask for more, or clean and smooth the labels\n"),
                asked, made);
}

/* Meshes the labels chosen of a map; its file states the unit and the axes. */
static gboolean generate_labels(SporeCli *cli, LabelWork *work, GError **error) {
  gsize size;
  const void *bytes = g_bytes_get_data(work->content, &size);
  if (!spore_label_map_decode(work->file, bytes, size, &work->map, spore_cli_progress(cli), error) ||
      !spore_cli_label_tetrahedra(cli, work->file, &work->map, work->chosen, work->survey, &work->fields, &work->mesh,
                                  &work->figures, error))
    return FALSE;
  spore_cli_report_labels(cli, &work->mesh, &work->figures, work->survey);
  say_many(cli, work);
  if (!work->output) return TRUE;
  return spore_cli_is_scene(work->output) ? save_scene(cli, work, error) : write_cells(work, error);
}

static GArray *all_labels(const SporeLabelSurvey *survey) {
  GArray *labels = g_array_new(FALSE, FALSE, sizeof(guint16));
  for (guint i = 0; i < survey->entries->len; i++)
    g_array_append_val(labels, g_array_index(survey->entries, SporeLabelEntry, i).label);
  return labels;
}

/* Lists the labels of a map, or meshes them. */
static int use_labels(SporeCli *cli, const char *file, GBytes *content, const SporeCliOptions *options,
                      const LabelWish *wish, const char *output) {
  GError *error = NULL;
  g_autoptr(SporeLabelSurvey) survey = spore_label_survey(file, content, spore_cli_progress(cli), &error);
  if (!survey) return spore_cli_fail(error);
  if (wish->list) {
    spore_cli_report_list(cli, survey);
    return spore_cli_finish(cli, SPORE_EXIT_DONE);
  }
  g_autoptr(GArray) chosen =
      wish->labels ? spore_label_survey_choose(survey, wish->labels, &error) : all_labels(survey);
  if (!chosen) return spore_cli_fail(error);
  LabelWork work = {.file = file,
                    .output = output,
                    .content = content,
                    .survey = survey,
                    .chosen = chosen,
                    .surroundings = wish->surroundings};
  spore_parameters_set_initial(&options->table, &work.fields);
  spore_cli_options_fill(options, &work.fields);
  gboolean done = generate_labels(cli, &work, &error);
  spore_label_map_clear(&work.map);
  g_clear_pointer(&work.figures.labels, g_array_unref);
  spore_tetrahedral_mesh_clear(&work.mesh);
  return done ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

/* Meshes a surface or a label map, whichever the file holds. */
static int generate_any(SporeCli *cli, const char *file, const SporeCliOptions *options, const char *unit,
                        const char *frame, const LabelWish *wish, const char *parts, const char *output) {
  GError *error = NULL;
  if (output && !(spore_cli_is_scene(output) ? spore_cli_has_room_for_scene : spore_cli_has_room)(output, file, &error))
    return spore_cli_fail(error);
  g_autoptr(GBytes) given = spore_cli_read_file(file, _("a mesh or a label map"), &error);
  g_autoptr(GBytes) content = given ? spore_label_map_whole(file, given, &error) : NULL;
  if (!content) return spore_cli_fail(error);
  gsize size;
  const void *bytes = g_bytes_get_data(content, &size);
  gboolean is_map = spore_label_map_is(file, bytes, size);
  if (is_map && (unit || frame))
    return spore_cli_usage(_("spore tetrahedra: --unit and --frame are for surfaces; a label map says both in its "
                             "header; leave them out"));
  g_autofree char *foreign = is_map ? spore_cli_options_foreign(options, &spore_generator_labels) : NULL;
  if (foreign)
    return spore_cli_usage(_("spore tetrahedra: %s is for surfaces; %s is a label map; leave it out"), foreign, file);
  if (is_map && parts)
    return spore_cli_usage(_("spore tetrahedra: --parts is for surfaces; %s is a label map; use --labels"), file);
  if (is_map) return use_labels(cli, file, content, options, wish, output);
  if (wish->list)
    return spore_cli_usage(_("spore tetrahedra: --list is for label maps; %s is none; leave it out"), file);
  if (output && spore_cli_is_scene(output))
    return spore_cli_usage(_("-o %s: a scene is made of a label map, and %s is a surface; expected a name ending in "
                             ".vtu, .msh or .mesh; or make a scene by spore import, and give it --body"),
                           output, file);
  if (wish->labels)
    return spore_cli_usage(_("spore tetrahedra: --labels is for label maps; %s is none; leave it out"), file);
  return generate(cli, file, options, unit, frame, parts, output);
}

/* Checks the options and prints its own message. scene: the asset holds the values that are not given. */
static int check(const SporeCliOptions *options, const char *output, gboolean scene, const LabelWish *wish) {
  if (wish->list && output) return spore_cli_usage(_("spore tetrahedra: --list writes no file; leave out -o"));
  if (wish->surroundings && (!wish->labels || !output || !spore_cli_is_scene(output)))
    return spore_cli_usage(_("spore tetrahedra: --surroundings adds the labels that --labels leaves out to a scene; "
                             "expected both --labels and -o F.spore; give them"));
  if (!scene && !wish->list && spore_cli_options_way(options) < 0)
    return spore_cli_usage(
        _("spore tetrahedra: neither number of cells nor size is given; expected either --cells 1 to "
          "%u or --size in metres above 0; give one of them"),
        SPORE_TETRAHEDRA_CELLS);
  if (output && !formatter_of(output) && !spore_cli_is_scene(output))
    return spore_cli_usage(_("-o %s: the format is not known; expected a name ending in .vtu, .msh or .mesh, or in "
                             ".spore for the organs of a label map"),
                           output);
  return SPORE_EXIT_DONE;
}

static const SporeReportMember members[] = {
    {"nodes", N_("number of nodes")},
    {"tetrahedra", N_("number of tetrahedra")},
    {"min_dihedral_deg", N_("least angle between two faces of any, degrees")},
    {"mean_dihedral_deg", N_("mean of the least angles, degrees")},
    {"hausdorff", N_("largest distance between the mesh and what of the surface bounds its solid, of the diagonal")},
    {"inner_distance", N_("the same from walls inside the solid: double walls, overlapping parts; 0 where none are")},
    {"inner_share", N_("share of the surface that lies inside the solid, which is filled there")},
    {"thickened", N_("share of the surface that bounds walls which the cells of the lattice had missed")},
    {"widened", N_("the same of slits")},
    {"thickness_m", N_("how wide such walls and slits are made, about, m; 0: there are none")},
    {"volume_change", N_("share of the volume that was gained")},
    {"volume", N_("m^3: given (where the winding number is over one half), result, change")},
    {"area", N_("of what bounds it, m^2: given, result, change")},
    {"filled_m3", N_("volume of cavities that --fill filled, m^3")},
    {"pieces", N_("that do not hang together")},
    {"pieces_given", N_("the same of the surface; with more of them than that nothing holds one to the other")},
    {"parts",
     N_("of the surface, the largest area first, at most 64: name, role (bounds the solid; merged with what it lies "
        "in; "
        "inside: left out; cavity; sheet), wall (of one wholly inside another one: open, lumen, doubled, closed, "
        "turned; none: it is no such wall), in (index of the part in which most of what lies inside does, -1: none), "
        "triangles, holes, open_edges, area_m2, inside_share, least_depth_m, most_depth_m (below the surface of that "
        "part), cells (with --pieces apart: of its own; the tag of these in the file is 1 + its index here), "
        "thickness_m (about, where it is closed, or with --pieces apart of the place that it has; 0: unknown), "
        "merged_with (with --pieces apart: index of the part that its cells went to, as it is too thin for so few; "
        "-1: none)")},
    {"crumbs",
     N_("share of the volume that was left out: small pieces that came off where a part is thinner than a cell")},
    {"method", N_("direct, repaired, wrapped or voxels: what the surface needed; labels: of a label map")},
    {"refused", N_("methods that were tried before: method, reason")},
    {"seconds", N_("that it took")},
    {"shared_faces", N_("of a label map, or with --pieces apart: between two organs or pieces")},
    {"border_lost",
     N_("with --pieces apart: share of the surfaces between pieces where a piece is too thin for faces")},
    {"border_distance",
     N_("with --pieces apart: largest distance of the rest of these surfaces from these faces, of the diagonal")},
    {"labels",
     N_("of a label map, of each organ: label, name, cells, weight (cells wanted for its volume: more where its name "
        "says a soft tissue), share (of all cells), volume_m3, voxel_volume_m3, volume_change, "
        "min_dihedral_deg, cut; with --list: label, name, named (file, sidecar, guessed), voxels, volume_m3, size_m "
        "(along the map's axes), cut (sides of the volume that it reaches: i- i+ j- j+ k- k+)")},
    {"surroundings",
     N_("of a label map, with --surroundings, of each: label, name, triangles, triangles_before (before they were made "
        "fewer), off_voxels (largest distance found from the faces of its voxels), cut")},
    {"surroundings_seconds", N_("that the surroundings took")},
    {"seams", N_("of a label map, with -o F.spore: between bodies that share faces")},
    {"scene", N_("that was given: as written, and the name of the body that has the tetrahedra: body")},
    {NULL, NULL}};

/* A scene states the unit and the axes of its meshes, and keeps the result; the options for these are for files. */
static int check_scene(gboolean scene, const char *body, gboolean others) {
  if (!scene && body)
    return spore_cli_usage(_("spore tetrahedra: --body is for scenes; expected a file F.spore with it; leave it out"));
  if (scene && others)
    return spore_cli_usage(_("spore tetrahedra: a scene says unit and axes, and takes the tetrahedra itself; expected "
                             "none of --unit, --frame, --labels, --parts, --list, --surroundings and --output with it; "
                             "leave them out, or give the "
                             "mesh's file"));
  return SPORE_EXIT_DONE;
}

int spore_command_tetrahedra(SporeCli *cli, int argc, char **argv) {
  static const SporeCommandInfo info = {"tetrahedra",
                                        "MESH|LABELS|SCENE",
                                        N_("Fills a mesh, or all organs of a label map (NIfTI, NRRD), with "
                                           "tetrahedra; organs share the faces where they touch. Of a scene (F.spore): "
                                           "the mesh that a body of it shows, which becomes soft."),
                                        1,
                                        1,
                                        members};
  char *unit = NULL, *frame = NULL, *output = NULL, *parts = NULL, *body = NULL;
  LabelWish wish = {0};
  const GOptionEntry entries[] = {
      {"unit", 'u', 0, G_OPTION_ARG_STRING, &unit, N_("Unit of the mesh: m, cm, mm, um, in (default m)"), "UNIT"},
      {"frame", 'f', 0, G_OPTION_ARG_STRING, &frame, N_("Axes of the mesh: Y_UP, RAS, LPS"), "FRAME"},
      {"labels", 'l', 0, G_OPTION_ARG_STRING, &wish.labels,
       N_("Labels wanted of a label map, by number or name (default: all above 0)"), "1,liver,5"},
      {"parts", 'p', 0, G_OPTION_ARG_STRING, &parts,
       N_("Parts wanted of a mesh, by the names of its objects or nodes (default: all of them, merged)"),
       "kidney,ureter"},
      {"list", 0, 0, G_OPTION_ARG_NONE, &wish.list,
       N_("List the labels of a label map, and mesh nothing: name (in the file's own table, or in a file of its name "
          "beside it: .json, .txt, .ctbl, .label; else guessed by its number), volume, size, and whether the edge of "
          "the "
          "volume may cut it"),
       NULL},
      {"surroundings", 0, 0, G_OPTION_ARG_NONE, &wish.surroundings,
       N_("With --labels and -o F.spore: add the other labels as unmovable surfaces of few triangles, within half a "
          "voxel of their voxels"),
       NULL},
      SPORE_SCENE_BODY_ENTRY(&body),
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &output,
       N_("File to write: .vtu, .msh or .mesh; of a label map also F.spore, a new scene with a soft body of each "
          "organ, "
          "joined by seams where they share faces"),
       "F"},
      G_OPTION_ENTRY_NULL};
  g_auto(SporeCliOptions) options = {0};
  int status =
      spore_cli_options_parse(&options, cli, &spore_generator_tetrahedra,
                              "n=cells s=size t=tolerance c=curvature m=method g=gap", &info, entries, &argc, &argv);
  gboolean scene = status == SPORE_EXIT_DONE && spore_cli_is_scene(argv[1]);
  if (status == SPORE_EXIT_DONE)
    status =
        check_scene(scene, body, unit || frame || wish.labels || parts || wish.list || wish.surroundings || output);
  if (status == SPORE_EXIT_DONE) status = check(&options, output, scene, &wish);
  if (status == SPORE_EXIT_DONE)
    status = scene ? generate_in(cli, argv[1], body, &options)
                   : generate_any(cli, argv[1], &options, unit, frame, &wish, parts, output);
  g_free(body);
  g_free(parts);
  g_free(unit);
  g_free(frame);
  g_free(output);
  g_free(wish.labels);
  return status;
}
