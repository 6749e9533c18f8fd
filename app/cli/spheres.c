/* spore spheres: a sphere set from a mesh, tetrahedra or a curve. */
#include <glib/gi18n.h>
#include <math.h>

#include "app/cli/generate.h"
#include "app/cli/spheres_series.h"
#include "core/author/generated_edits.h"
#include "core/author/verdict.h"
#include "core/io/mesh_import.h"
#include "core/io/scene_xml.h"

#define THIN 0.6 /* a lower coverage gets a warning */

/* The options of the command line. */
typedef struct Request {
  SporeCliOptions options;
  char *unit, *frame, *output, *counts, *svg, *csv, *body;
  double worth, thickness; /* thickness: < 0 where not given */
  gboolean asymmetric;
} Request;

static void clear_request(Request *request) {
  char *const texts[] = {request->unit, request->frame, request->output, request->counts,
                         request->svg,  request->csv,   request->body};
  for (guint i = 0; i < G_N_ELEMENTS(texts); i++) g_free(texts[i]);
  spore_cli_options_clear(&request->options);
}

static void say_solid(SporeCli *cli, const SporeSphereSet *set, const SporeSpheresReport *report,
                      const SporeSpheresOptions *options) {
  spore_cli_say(cli,
                _("%zu spheres: coverage %.1f %%, outside %.1f %%, distance %.3f %% (largest %.2f %%) of the diagonal, "
                  "depth error %.3f, %.2f s\n"),
                set->count, 100 * report->coverage, 100 * report->outside, 100 * report->distance_mean,
                100 * report->distance_max, spore_spheres_felt_error(report), report->seconds);
  if (report->mirrors)
    spore_cli_say(cli,
                  ngettext("The mesh is its own image in %zu plane; so is the set.\n",
                           "The mesh is its own image in %zu planes; so is the set.\n", report->mirrors),
                  report->mirrors);
  g_autofree char *verdict = spore_spheres_verdict(options, report, set->count);
  if (verdict) spore_cli_say(cli, "%s.\n", verdict);
}

static void say_sheet(SporeCli *cli, const SporeSphereSet *set, const SporeSpheresReport *report, gboolean thick) {
  spore_cli_say(
      cli,
      thick ? _("%zu spheres: they hold %.1f %% of the area, gaps %.3f %% (largest %.2f %%) of the diagonal, "
                "%.2f s\n")
            : _("%zu spheres: they hold %.1f %% of the area, radii %.3f %% (largest %.2f %%) of the diagonal, "
                "%.2f s\n"),
      set->count, 100 * report->coverage, 100 * report->distance_mean, 100 * report->distance_max, report->seconds);
}

/* The content of the file, and the part of it that the spheres are made from. */
typedef struct Read {
  SporeTriangleMesh surface;
  SporeTetrahedralMesh tetrahedra;
  SporeCurve curve;
  SporeSpheresSource source;
} Read;

static void clear_read(Read *read) {
  spore_triangle_mesh_clear(&read->surface);
  spore_tetrahedral_mesh_clear(&read->tetrahedra);
  spore_curve_clear(&read->curve);
}

/* A .mesh file holds tetrahedra and a .curve file a curve, in metres; everything else is a surface. */
static gboolean read_source(SporeCli *cli, const char *file, const Request *request, Read *read, GError **error) {
  gboolean cells = g_str_has_suffix(file, ".mesh"), curve = g_str_has_suffix(file, ".curve");
  if (!cells && !curve) {
    const SporeTriangleMesh *surface = &read->surface;
    read->source =
        request->thickness >= 0 ? (SporeSpheresSource){.sheet = surface} : (SporeSpheresSource){.solid = surface};
    return spore_cli_read_mesh(cli, file, request->unit, request->frame, &read->surface, NULL, NULL, NULL, error);
  }
  if (request->unit || request->frame || request->thickness >= 0)
    return spore_error_raise(error, SPORE_ERROR_INPUT, file,
                             _("has metres and SPORE's axes, and is no surface; expected none of --unit, --frame and "
                               "--thickness with it; leave them out"));
  g_autoptr(GBytes) content = spore_cli_read_file(file, cells ? _("a mesh") : _("a curve"), error);
  if (!content) return FALSE;
  gsize size = 0;
  const char *text = g_bytes_get_data(content, &size);
  read->source =
      cells ? (SporeSpheresSource){.tetrahedra = &read->tetrahedra} : (SporeSpheresSource){.curve = &read->curve};
  return cells ? spore_medit_parse(file, text, size, &read->tetrahedra, error)
               : spore_curve_parse(file, text, size, &read->curve, error);
}

static gboolean make_set(SporeCli *cli, const char *file, const SporeSpheresSource *source,
                         const SporeSpheresOptions *options, SporeSphereSet *set, SporeSpheresReport *report,
                         GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  if (spore_spheres_from_source(source, options, set, report, spore_cli_progress(cli), &fault)) return TRUE;
  spore_error_at(&fault, file);
  return spore_error_propagate(&fault, error);
}

static gboolean is_touched(const SporeGenerateRegion *ball, const SporeSphereSet *set) {
  for (gsize s = 0; s < set->count; s++)
    if (spore_vec3_distance(spore_vec3_load(set->spheres + 4 * s), spore_vec3_load(ball->centre)) <
        set->spheres[4 * s + 3] + ball->radius)
      return TRUE;
  return FALSE;
}

/* Reports regions that no sphere touches: these regions lie off the organ. */
static void report_regions(SporeCli *cli, const SporeSpheresOptions *options, const SporeSphereSet *set) {
  spore_cli_open_array(cli, "regions_missed");
  for (gsize i = 0, end; i < options->region_count; i = end) {
    const SporeGenerateRegion *region = &options->regions[i];
    gboolean touched = FALSE;
    for (end = i; end < options->region_count && options->regions[end].region == region->region; end++)
      touched = touched || is_touched(&options->regions[end], set);
    if (touched) continue;
    spore_cli_count(cli, NULL, (gint64)region->region);
    spore_cli_say(cli,
                  _("The region about %g,%g,%g of %g m lies off the organ and has no effect; give its place in metres "
                    "and SPORE's axes, as spore import says them.\n"),
                  region->centre[0], region->centre[1], region->centre[2], region->radius);
  }
  spore_cli_close_array(cli);
}

/* The other way for what has tetrahedra, beside the one that was chosen. solid: that both are measured against; NULL:
 * the boundary of the cells. */
static gboolean report_other(SporeCli *cli, const SporeTetrahedralMesh *cells, const SporeTriangleMesh *solid,
                             const SporeSpheresOptions *options, GError **error) {
  const SporeSpheresSource source =
      solid ? (SporeSpheresSource){.solid = solid} : (SporeSpheresSource){.tetrahedra = cells};
  SporeSpheresOptions other = *options;
  SporeSphereSet set;
  SporeSpheresReport report;
  SporeError fault = SPORE_ERROR_INIT;
  other.each_cell = !options->each_cell;
  if (!cells || cells->tetrahedron_count > SPORE_SPHERES_MAXIMUM) {
    spore_cli_text(cli, "other", NULL);
    return TRUE;
  }
  bool done = other.each_cell
                  ? spore_spheres_of_cells(cells, solid, &set, &report, &fault)
                  : spore_spheres_from_source(&source, &other, &set, &report, spore_cli_progress(cli), &fault);
  if (!done) return spore_error_propagate(&fault, error);
  spore_cli_open(cli, "other");
  spore_cli_spheres_members(cli, set.count, &report);
  spore_cli_close(cli);
  g_autofree char *text = spore_spheres_other_text(options->each_cell, set.count, &report);
  spore_cli_say(cli, "%s.\n", text);
  spore_sphere_set_clear(&set);
  return TRUE;
}

static void report_set(SporeCli *cli, const SporeSpheresSource *source, const SporeSpheresOptions *options,
                       const SporeSphereSet *set, const SporeSpheresReport *report) {
  const char *hardest = options->count ? NULL : spore_spheres_hardest_target(&options->targets, report, NULL);
  spore_cli_spheres_members(cli, set->count, report);
  spore_cli_text(cli, "hardest", hardest);
  if (source->sheet) say_sheet(cli, set, report, options->thickness > 0);
  else say_solid(cli, set, report, options);
  if (hardest) spore_cli_say(cli, _("Hardest to reach of what was asked for: %s.\n"), hardest);
  if (!source->sheet && !source->curve && report->coverage < THIN)
    spore_cli_say(cli,
                  _("They hold little of the inside: walls are thin beside the spheres. Ask for more, or take it for "
                    "a sheet by --thickness; of a hollow organ that is felt from outside alone, fill the lumen by "
                    "spore tetrahedra --fill, and make spheres of that.\n"));
  report_regions(cli, options, set);
  if (set->weights)
    spore_cli_say(cli, _("weighted sum: depth error %.4f, felt at %.1f %% of the places just outside\n"),
                  report->weighted_depth_error, 100 * report->felt_outside);
}

static gboolean write_set(SporeCli *cli, const char *file, const Request *request, const SporeSpheresSource *source,
                          const SporeSpheresOptions *options, GError **error) {
  SporeSphereSet set = {0};
  SporeSpheresReport report = {0};
  gboolean done = make_set(cli, file, source, options, &set, &report, error);
  if (done && request->output) {
    gsize size = 0;
    g_autofree char *text = spore_spheres_format(&set, &size);
    done = spore_write_file(request->output, text, size, error);
  }
  if (done) {
    report_set(cli, source, options, &set, &report);
    done = report_other(cli, source->tetrahedra, NULL, options, error);
  }
  spore_sphere_set_clear(&set);
  return done;
}

/* The outputs do not overwrite the input. */
static gboolean keeps_input(const Request *request, const char *file, GError **error) {
  const char *const outputs[] = {request->output, request->svg, request->csv};
  for (guint i = 0; i < G_N_ELEMENTS(outputs); i++)
    if (outputs[i] && !spore_cli_has_room(outputs[i], file, error)) return FALSE;
  return TRUE;
}

static gboolean generate(SporeCli *cli, const char *file, const Request *request, GError **error) {
  Read read = {0};
  SporeSpheresFields fields;
  const GArray *regions = request->options.regions;
  g_autoptr(GArray) counts = NULL;
  if (!keeps_input(request, file, error)) return FALSE;
  if (request->counts && !(counts = spore_cli_counts(request->counts, error))) return FALSE;
  spore_parameters_set_initial(&request->options.table, &fields);
  spore_cli_options_fill(&request->options, &fields);
  SporeSpheresOptions options =
      spore_edit_spheres_options(&fields, (const SporeGenerateRegion *)(gconstpointer)regions->data, regions->len);
  options.asymmetric = request->asymmetric;
  options.each_cell = options.each_cell && !counts;
  options.thickness = fmax(request->thickness, 0);
  gboolean done = read_source(cli, file, request, &read, error);
  if (done && counts)
    done = spore_cli_spheres_series(cli, file, &read.source, &options, counts, request->worth, request->svg,
                                    request->csv, error);
  else done = done && write_set(cli, file, request, &read.source, &options, error);
  clear_read(&read);
  return done;
}

/* Round each of the body's cells they are measured against its mesh all the same. */
static gboolean make_in(SporeCli *cli, const char *file, const SporeSpheresSource *source,
                        const SporeTetrahedralMesh *cells, const SporeSpheresOptions *options, SporeSphereSet *set,
                        SporeSpheresReport *report, GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  if (!options->each_cell || !cells) return make_set(cli, file, source, options, set, report, error);
  return spore_spheres_of_cells(cells, source->solid, set, report, &fault) || spore_error_propagate(&fault, error);
}

static gboolean generate_in(SporeCli *cli, const char *file, const Request *request, SporeSceneBody *scene,
                            GError **error) {
  SporeSpheresFields fields;
  SporeSphereSet set = {0};
  SporeSpheresReport report = {0};
  if (!spore_cli_open_body(cli, file, request->body, &request->options, scene, &fields, error)) return FALSE;
  const SporeSpheresOptions options = spore_edit_spheres_options(&fields, scene->regions, scene->region_count);
  const SporeSpheresSource source = {.solid = scene->mesh};
  const SporeGeneratedFrom from = spore_cli_generated_from(scene, &fields);
  const SporeTetrahedralMesh *cells = spore_edit_body_cells(scene->document, scene->body);
  gboolean done = make_in(cli, file, &source, cells, &options, &set, &report, error) &&
                  report_other(cli, cells, scene->mesh, &options, error) &&
                  spore_edit_use_spheres(scene->document, scene->body, &from, &set, error);
  if (done) {
    report_set(cli, &source, &options, &set, &report);
    done = spore_cli_save_body(cli, scene, file, error);
  }
  spore_sphere_set_clear(&set);
  return done;
}

static gboolean generate_any(SporeCli *cli, const char *file, const Request *request, GError **error) {
  if (!spore_cli_is_scene(file)) return generate(cli, file, request, error);
  SporeSceneBody scene = {0};
  gboolean done = generate_in(cli, file, request, &scene, error);
  spore_cli_close_body(&scene);
  return done;
}

/* Options that the asset of a scene cannot store. */
static int check_scene(const Request *request) {
  if (request->unit || request->frame || request->output || request->counts || request->asymmetric ||
      request->thickness >= 0)
    return spore_cli_usage(
        _("spore spheres: a scene says unit and axes, and takes the spheres itself; expected none of "
          "--unit, --frame, --output, --counts, --asymmetric and --thickness with it; leave them "
          "out, or give the mesh's file"));
  return SPORE_EXIT_DONE;
}

/* SPORE_EXIT_DONE: go on. */
static int check_request(const Request *request, gboolean scene) {
  if (!scene && request->body)
    return spore_cli_usage(_("spore spheres: --body is for scenes; expected a file F.spore with it; leave it out"));
  if (scene && check_scene(request) != SPORE_EXIT_DONE) return SPORE_EXIT_INPUT;
  int ways = (spore_cli_options_way(&request->options) >= 0) + (request->counts != NULL);
  g_autofree char *all = spore_cli_options_ways(&request->options);
  SporeSpheresFields fields;
  spore_parameters_set_initial(&request->options.table, &fields);
  spore_cli_options_fill(&request->options, &fields);
  gboolean each = spore_edit_spheres_options(&fields, NULL, 0).each_cell;
  if (scene || each ? ways > 1 : ways != 1)
    return spore_cli_usage(_("spore spheres: neither a number of spheres nor what they are to reach is given, or both; "
                             "expected one of %s, or --counts with several numbers; give one of them"),
                           all);
  if (!request->counts && (request->svg || request->csv))
    return spore_cli_usage(_("spore spheres: --svg and --csv show several numbers of spheres; expected --counts with "
                             "them; give it"));
  if (request->counts && request->output)
    return spore_cli_usage(
        _("spore spheres: --output holds one set; expected --count or what they are to reach with it; "
          "leave out --counts"));
  if (!(request->worth > 0 && request->worth < 1))
    return spore_cli_usage(_("spore spheres: --worth is %g; expected a share of the largest depth between 0 and 1; "
                             "correct it"),
                           request->worth);
  return SPORE_EXIT_DONE;
}

int spore_command_spheres(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"count", N_("of spheres")},
      {"coverage", N_("share of the inside that lies in a sphere; of a sheet, of its area")},
      {"outside", N_("volume of the spheres that lies outside, of the mesh's volume; null for a sheet")},
      {"distance", N_("between surface and spheres, of the diagonal: mean, max; of a sheet see --thickness")},
      {"depth_error", N_("of the depth that is felt, of the largest depth; null for a sheet")},
      {"weighted_depth_error", N_("the same of the weighted sum of the spheres' depths; 0 without weights")},
      {"felt_outside", N_("share of places up to 0.02 diagonals outside where that sum is not 0")},
      {"certified", N_("whether it is proven that all of the inside lies in a sphere")},
      {"regions_missed", N_("which of the regions (from 0, those of the scene first) lie off the organ: no effect")},
      {"seconds", N_("that it took")},
      {"mirrors", N_("planes that mesh and spheres are symmetric about")},
      {"hardest", N_("of what was asked for, what takes so many: coverage, outside, distance or depth_error; null: "
                     "nothing was but a number")},
      {"other", N_("of what has tetrahedra: the members count to mirrors of spheres made the other way, fitted or one "
                   "round each; else null")},
      {"points", N_("with --counts, instead of all above: each number with the members above")},
      {"enough", N_("with --counts: the number from which on more spheres do not pay; null: all pay")},
      {"worth", N_("with --counts: as given")},
      {"scene", N_("that was given: as written, and the name of the body that has the spheres: body")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {
      "spheres",
      "FILE",
      N_("Fits collision spheres to a mesh, to the boundary of the tetrahedra of a .mesh file, or "
         "along a .curve file; or, of a scene (F.spore), to the mesh that a body of "
         "it shows, and gives them to that body."),
      1,
      1,
      members};
  Request r = {.thickness = -1, .worth = SPORE_SPHERES_WORTH};
  const GOptionEntry entries[] = {
      {"counts", 0, 0, G_OPTION_ARG_STRING, &r.counts, N_("Measure sets of several numbers of spheres"), "N,N,..."},
      {"svg", 0, 0, G_OPTION_ARG_FILENAME, &r.svg, N_("With --counts: plot of error against number and time"), "F.svg"},
      {"csv", 0, 0, G_OPTION_ARG_FILENAME, &r.csv, N_("With --counts: table of the same"), "F.csv"},
      {"worth", 0, 0, G_OPTION_ARG_DOUBLE, &r.worth,
       N_("With --counts: what twice as many spheres have to take off the depth error to pay, of the largest depth "
          "(default 0.01)"),
       "D"},
      {"asymmetric", 0, 0, G_OPTION_ARG_NONE, &r.asymmetric, N_("Leave out that a symmetric mesh gets a symmetric set"),
       NULL},
      {"thickness", 0, 0, G_OPTION_ARG_DOUBLE, &r.thickness,
       N_("Take the mesh for a sheet, that many metres thick: spheres on it of that diameter, distance is the gaps "
          "between them; 0: as wide as it takes to leave none, distance is their radii"),
       "D"},
      {"unit", 'u', 0, G_OPTION_ARG_STRING, &r.unit, N_("Unit of the mesh: m, cm, mm, um, in (default m)"), "UNIT"},
      {"frame", 'f', 0, G_OPTION_ARG_STRING, &r.frame, N_("Axes of the mesh: Y_UP, RAS, LPS"), "FRAME"},
      SPORE_SCENE_BODY_ENTRY(&r.body),
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &r.output, N_("File to write, x y z r a line, with weights x y z r w"),
       "F.spheres"},
      G_OPTION_ENTRY_NULL};
  GError *error = NULL;
  int status = spore_cli_options_parse(&r.options, cli, &spore_generator_spheres, "n=count t=tolerance m=method", &info,
                                       entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) status = check_request(&r, spore_cli_is_scene(argv[1]));
  if (status == SPORE_EXIT_DONE)
    status = generate_any(cli, argv[1], &r, &error) ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
  clear_request(&r);
  return status;
}
