/* spore spline: a spline sheet of the patch of an organ between four corners. */
#include <glib/gi18n.h>
#include <string.h>

#include "app/cli/generate.h"
#include "app/cli/scene.h"
#include "core/io/organ.h"
#include "core/io/scene_xml.h"
#include "core/scene/sheet_corners.h"

/* The report. */

static void report_corners(SporeCli *cli, const SporeSheetReport *sheet) {
  spore_cli_open_array(cli, "corners");
  for (gsize k = 0; k < 4; k++) {
    const double *at = sheet->corners[k];
    spore_cli_open(cli, NULL);
    spore_cli_open_array(cli, "place_m");
    for (int e = 0; e < 3; e++) spore_cli_number(cli, NULL, at[e]);
    spore_cli_close_array(cli);
    spore_cli_number(cli, "moved_m", sheet->corner_distance[k]);
    spore_cli_close(cli);
    spore_cli_say(cli, _("corner %zu lies at %.5g,%.5g,%.5g m, %.3g mm from where it was given\n"), k + 1, at[0], at[1],
                  at[2], 1e3 * sheet->corner_distance[k]);
  }
  spore_cli_close_array(cli);
}

static void report_sides(SporeCli *cli, const SporeSheetReport *sheet) {
  spore_cli_open_array(cli, "sides");
  for (gsize k = 0; k < 4; k++) {
    spore_cli_open(cli, NULL);
    spore_cli_number(cli, "length_m", sheet->side[k]);
    spore_cli_flag(cli, "open_edge", sheet->follows_edge[k]);
    spore_cli_close(cli);
    spore_cli_say(cli,
                  sheet->follows_edge[k] ? _("side %zu to %zu: %.4g mm along the open edge\n")
                                         : _("side %zu to %zu: %.4g mm, the shortest way over the surface\n"),
                  k + 1, (k + 1) % 4 + 1, 1e3 * sheet->side[k]);
  }
  spore_cli_close_array(cli);
}

static void report_distance(SporeCli *cli, const char *member, const SporeSheetReport *sheet, int way) {
  spore_cli_open(cli, member);
  spore_cli_number(cli, "rms", sheet->rms[way]);
  spore_cli_number(cli, "max", sheet->largest[way]);
  spore_cli_close(cli);
}

static void report(SporeCli *cli, const SporeGenerateWork *work) {
  const SporeSheetReport *sheet = &work->sheet_report;
  double largest = MAX(sheet->largest[0], sheet->largest[1]);
  spore_cli_open_array(cli, "control_points");
  for (int way = 0; way < 2; way++) spore_cli_count(cli, NULL, (gint64)sheet->control_points[way]);
  spore_cli_close_array(cli);
  spore_cli_count(cli, "triangles", (gint64)work->surface.triangle_count);
  spore_cli_number(cli, "area_m2", sheet->area);
  spore_cli_number(cli, "diagonal_m", sheet->diagonal);
  report_distance(cli, "patch_to_sheet_m", sheet, 0);
  report_distance(cli, "sheet_to_patch_m", sheet, 1);
  spore_cli_number(cli, "share", largest / sheet->diagonal);
  spore_cli_number(cli, "area_kept", sheet->area_kept);
  spore_cli_count(cli, "fold_overs", (gint64)sheet->fold_overs);
  spore_cli_flag(cli, "reached", sheet->reached);
  spore_cli_number(cli, "seconds", sheet->seconds);
  if (spore_edit_sheet_options(&work->options.fields.surface).corners_given) {
    report_corners(cli, sheet);
    report_sides(cli, sheet);
  }
  spore_cli_say(cli,
                _("%zu x %zu control points on %zu triangles: from the patch to the sheet %.3g mm (root mean square), "
                  "%.3g mm at most; from the sheet to the patch %.3g and %.3g mm; %.2f %% of the patch's diagonal; "
                  "%.1f %% of its area; fold-overs: %zu; %.2f s\n"),
                sheet->control_points[0], sheet->control_points[1], work->surface.triangle_count, 1e3 * sheet->rms[0],
                1e3 * sheet->largest[0], 1e3 * sheet->rms[1], 1e3 * sheet->largest[1], 100 * largest / sheet->diagonal,
                100 * sheet->area_kept, sheet->fold_overs, sheet->seconds);
  if (!sheet->reached)
    spore_cli_say(cli,
                  _("no number of control points up to %d reaches the tolerance: the best one is taken; smooth the "
                    "surface, or ask for less\n"),
                  SPORE_SHEET_MOST_POINTS);
}

/* Of a mesh file. */

typedef struct Files {
  const char *patch, *scene; /* to write; NULL: none */
} Files;

static gboolean check_room(const Files *files, const char *input, GError **error) {
  return (!files->patch || spore_cli_has_room(files->patch, input, error)) &&
         (!files->scene || spore_cli_has_room_for_scene(files->scene, input, error));
}

/* The organ's body in a new scene. */
static SporeObject *insert_organ(SporeCli *cli, SporeDocument *document, const char *file, const char *unit,
                                 const char *frame, GError **error) {
  SporeTriangleMesh mesh = {0};
  g_autoptr(GBytes) content = NULL;
  int unit_index = 0, frame_index = 0;
  if (!spore_cli_read_mesh(cli, file, unit, frame, &mesh, &content, &unit_index, &frame_index, error)) return NULL;
  spore_triangle_mesh_clear(&mesh);
  return spore_organ_insert(document, NULL, file, content, unit_index, frame_index, error);
}

static gboolean write_results(SporeCli *cli, const SporeGenerateWork *work, SporeDocument *document, const Files *files,
                              GError **error) {
  if (files->patch && !spore_cli_write_mesh(files->patch, &work->surface, error)) return FALSE;
  if (!files->scene) return TRUE;
  if (!spore_generate_work_apply(work, document, error) || !spore_cli_save_scene(document, files->scene, error))
    return FALSE;
  spore_cli_say(cli, _("%s: written\n"), files->scene);
  return TRUE;
}

static gboolean make(SporeCli *cli, const char *file, const SporeCliOptions *asked, const char *unit, const char *frame,
                     const Files *files, SporeDocument *document, GError **error) {
  SporeGenerateOptions options = {.kind = SPORE_GENERATE_SHEET, .purpose = MAX(asked->purpose, 0)};
  spore_generate_set_initial(&options);
  spore_cli_options_fill(asked, &options.fields);
  if (!check_room(files, file, error)) return FALSE;
  SporeObject *organ = insert_organ(cli, document, file, unit, frame, error);
  SporeGenerateWork *work = organ ? spore_generate_work_new(document, organ, &options, error) : NULL;
  gboolean done = work && spore_generate_work_run(work, spore_cli_progress(cli), error) &&
                  write_results(cli, work, document, files, error);
  if (done) report(cli, work);
  if (work) spore_generate_work_unref(work);
  return done;
}

static gboolean generate(SporeCli *cli, const char *file, const SporeCliOptions *asked, const char *unit,
                         const char *frame, const Files *files, GError **error) {
  SporeDocument *document = spore_cli_new_scene(cli, files->scene);
  gboolean done = make(cli, file, asked, unit, frame, files, document, error);
  spore_document_free(document);
  return done;
}

/* The command line. */

/* --corners A B C D stands for the four options of the corners. Strings of the result are borrowed but for the names;
 * NULL with a message: there are not four. */
static GPtrArray *spell_corners(int argc, char **argv) {
  GPtrArray *spelled = g_ptr_array_new();
  for (int i = 0; i < argc; i++) {
    if (strcmp(argv[i], "--corners") != 0) {
      g_ptr_array_add(spelled, argv[i]);
      continue;
    }
    for (int k = 0; k < 4; k++) {
      if (++i == argc || strchr(argv[i], ',') == NULL) {
        spore_cli_usage(
            _("spore spline: --corners is followed by %d places; expected four, each X,Y,Z in metres, in turn "
              "around the patch; give the others"),
            k);
        g_ptr_array_unref(spelled);
        return NULL;
      }
      static const char *const options[4] = {"--first-corner", "--second-corner", "--third-corner", "--fourth-corner"};
      g_ptr_array_add(spelled, (gpointer)options[k]);
      g_ptr_array_add(spelled, argv[i]);
    }
  }
  g_ptr_array_add(spelled, NULL);
  return spelled;
}

static int check(const SporeCliOptions *options, const Files *files, gboolean scene, const char *body,
                 gboolean others) {
  gsize given = 0;
  for (gsize k = 0; k < 4; k++) given += spore_cli_options_has(options, spore_sheet_corner_names[k]);
  if (given % 4 != 0)
    return spore_cli_usage(_("spore spline: %zu corners are given; expected four, or none of an open sheet; give the "
                             "others"),
                           given);
  if (!scene && body)
    return spore_cli_usage(_("spore spline: --body is for scenes; expected a file F.spore with it; leave it out"));
  if (scene && others)
    return spore_cli_usage(_("spore spline: a scene says unit and axes, and takes the sheet itself; expected none of "
                             "--unit, --frame, --scene and --output with it; leave them out, or give the mesh's file"));
  if (!scene && !files->scene && options->purpose >= 0)
    return spore_cli_usage(_("spore spline: --as says what becomes of the sheet in a scene; expected --scene F.spore "
                             "too; name it"));
  return files->patch && !spore_cli_knows_mesh(files->patch) ? SPORE_EXIT_INPUT : SPORE_EXIT_DONE;
}

static int parse_and_run(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"control_points", N_("number along the longer sides, and across")},
      {"triangles", N_("of the patch")},
      {"area_m2", N_("of the patch")},
      {"diagonal_m", N_("of the patch's box")},
      {"patch_to_sheet_m", N_("distance of the patch from the sheet: rms, max")},
      {"sheet_to_patch_m", N_("distance of the sheet from the patch: rms, max")},
      {"share", N_("the larger max, of the diagonal")},
      {"area_kept", N_("area of the sheet, of the patch's")},
      {"fold_overs", N_("triangles of the patch over which the sheet faces the other way")},
      {"reached", N_("false: no number of control points reaches the tolerance, and the best one was taken")},
      {"seconds", N_("that it took")},
      {"corners", N_("where they lie on the surface, place_m, and moved_m, how far from the given places")},
      {"sides", N_("from each corner to the next: length_m, open_edge (true where the side runs along one)")},
      {"scene", N_("that was given: as written, and the name of the body it was made from: body")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {
      "spline",
      "MESH|SCENE",
      N_("Makes a spline sheet of the patch of a surface between four corners: a broad ligament, a mesentery, a "
         "bladder's "
         "wall. --corners X,Y,Z X,Y,Z X,Y,Z X,Y,Z names all four, on the surface or near it, in turn around the patch. "
         "Sides are the shortest ways over the surface, or run along an open edge that has both corners. Without "
         "corners: of an open sheet. Of a scene (F.spore): from the mesh that a body of it shows."),
      1,
      1,
      members};
  char *unit = NULL, *frame = NULL, *patch = NULL, *output = NULL, *body = NULL;
  const GOptionEntry entries[] = {
      {"unit", 'u', 0, G_OPTION_ARG_STRING, &unit, N_("Unit of the mesh: m, cm, mm, um, in (default m)"), "UNIT"},
      {"frame", 'f', 0, G_OPTION_ARG_STRING, &frame, N_("Axes of the mesh: Y_UP, RAS, LPS"), "FRAME"},
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &patch, N_("File to write the patch to, in metres: .off or .obj"), "F"},
      {"scene", 's', 0, G_OPTION_ARG_FILENAME, &output, N_("Scene to write, with the organ and the sheet"), "F.spore"},
      SPORE_SCENE_BODY_ENTRY(&body),
      G_OPTION_ENTRY_NULL};
  GError *error = NULL;
  g_auto(SporeCliOptions) options = {0};
  int status = spore_cli_options_parse(&options, cli, &spore_generator_sheet, "n=control_points t=tolerance", &info,
                                       entries, &argc, &argv);
  gboolean scene = status == SPORE_EXIT_DONE && spore_cli_is_scene(argv[1]), done = FALSE;
  const Files files = {patch, output};
  if (status == SPORE_EXIT_DONE) status = check(&options, &files, scene, body, unit || frame || patch || output);
  if (status == SPORE_EXIT_DONE) {
    done = scene ? spore_cli_generate(cli, &options, argv[1], body, report, &error)
                 : generate(cli, argv[1], &options, unit, frame, &files, &error);
    status = done ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
  }
  g_free(unit);
  g_free(frame);
  g_free(patch);
  g_free(output);
  g_free(body);
  return status;
}

int spore_command_spline(SporeCli *cli, int argc, char **argv) {
  g_autoptr(GPtrArray) spelled = spell_corners(argc, argv);
  return spelled ? parse_and_run(cli, (int)spelled->len - 1, (char **)spelled->pdata) : SPORE_EXIT_INPUT;
}
