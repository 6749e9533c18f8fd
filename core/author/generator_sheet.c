/* The generator of spline sheets: the patch of a surface between four corners, and how near a sheet comes to it. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "core/author/generator.h"
#include "core/author/generator_work.h"

static const char *const options_taken[] = {"first_corner",  "second_corner", "third_corner",
                                            "fourth_corner", "inside",        "control_points",
                                            "tolerance",     "smoothing",     NULL};

SporeSheetOptions spore_edit_sheet_options(const SporeMeshFields *fields) {
  static const double nowhere[3] = {0, 0, 0};
  SporeSheetOptions options = {
      .control_points = (size_t)fields->control_points, .tolerance = fields->tolerance, .smoothing = fields->smoothing};
  const double *const corners[4] = {fields->first_corner, fields->second_corner, fields->third_corner,
                                    fields->fourth_corner};
  for (gsize k = 0; k < 4; k++) {
    memcpy(options.corners[k], corners[k], sizeof options.corners[k]);
    options.corners_given = options.corners_given || memcmp(corners[k], corners[0], sizeof options.corners[k]) != 0;
  }
  memcpy(options.inside, fields->inside, sizeof options.inside);
  options.inside_given = memcmp(fields->inside, nowhere, sizeof nowhere) != 0;
  return options;
}

static const char *const uses[] = {"body", "model", "asset", NULL}; /* as SporeSheetUse */
static const SporeParameter purpose = SPORE_GENERATOR_PURPOSE(
    uses, N_("What Apply makes: a body of the sheet beside the organ, of the organ's own body the sheet, or an asset "
             "alone. A body that is such a sheet already is made anew."));

static gboolean run(SporeGenerateWork *work, const SporeProgress *progress, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  const SporeSheetOptions options = spore_edit_sheet_options(&work->options.fields.surface);
  if (spore_sheet_from_mesh(&work->mesh, &options, &work->surface, &work->surface_distance, &work->sheet_report,
                            progress, &failure))
    return TRUE;
  spore_error_at(&failure, work->source);
  return spore_error_propagate(&failure, error);
}

static gboolean error_of(const SporeGenerateWork *work, size_t count, double *error_percent,
                         const SporeProgress *progress, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeSheetOptions options = spore_edit_sheet_options(&work->options.fields.surface);
  SporeTriangleMesh patch = {0};
  SporeSheetReport report;
  options.control_points = count;
  if (!spore_sheet_from_mesh(&work->mesh, &options, &patch, NULL, &report, progress, &failure))
    return spore_error_propagate(&failure, error);
  spore_triangle_mesh_clear(&patch);
  *error_percent = 100 * MAX(report.largest[0], report.largest[1]) / report.diagonal;
  return TRUE;
}

/* The asset remembers the corners as they lie on the surface: the model takes them from there. */
static gboolean apply(const SporeGenerateWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  SporeGenerateOptions options = work->options;
  SporeGeneratedFrom from = spore_generate_work_from(work);
  SporeMeshFields *fields = &options.fields.surface;
  double *const corners[4] = {fields->first_corner, fields->second_corner, fields->third_corner, fields->fourth_corner};
  for (gsize k = 0; k < 4; k++) memcpy(corners[k], work->sheet_report.corners[k], sizeof fields->first_corner);
  from.fields = fields;
  return spore_edit_use_sheet(document, body, &from, &work->surface, &work->sheet_report,
                              (SporeSheetUse)work->options.purpose, error);
}

static void add_corners(GString *text, const SporeSheetReport *report) {
  double farthest = 0;
  guint edges = 0;
  for (gsize k = 0; k < 4; k++) {
    farthest = MAX(farthest, report->corner_distance[k]);
    edges += report->follows_edge[k];
  }
  g_string_append_printf(text,
                         _("\nSides %.1f, %.1f, %.1f, %.1f mm, %u along an open edge; corners moved %.2f mm at most"),
                         1e3 * report->side[0], 1e3 * report->side[1], 1e3 * report->side[2], 1e3 * report->side[3],
                         edges, 1e3 * farthest);
}

static char *facts(const SporeGenerateWork *work) {
  const SporeSheetReport *report = &work->sheet_report;
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("%zu x %zu control points, %zu triangles in %.1f s"), report->control_points[0],
                         report->control_points[1], work->surface.triangle_count, report->seconds);
  g_string_append_printf(text, _("\nOff the sheet: %.3f mm (root mean square), %.3f mm at most: %.2f %% of the patch"),
                         1e3 * MAX(report->rms[0], report->rms[1]), 1e3 * MAX(report->largest[0], report->largest[1]),
                         100 * MAX(report->largest[0], report->largest[1]) / report->diagonal);
  g_string_append_printf(text, _("\nArea %.2f cm^2, of which the sheet has %.1f %%; fold-overs: %zu"),
                         1e4 * report->area, 100 * report->area_kept, report->fold_overs);
  if (report->fold_overs)
    g_string_append(text, _(" triangles; corners nearer together, or more control points, may unfold it"));
  if (spore_edit_sheet_options(&work->options.fields.surface).corners_given) add_corners(text, report);
  if (!report->reached) g_string_append(text, _("\nThe tolerance is not reached"));
  return g_string_free(text, FALSE);
}

static const char *const places[] = {"first_corner", "second_corner", "third_corner", "fourth_corner", NULL};
static const char *const hints[] = {
    N_("Click on the organ where the sheet has its first corner; Escape picks no more"),
    N_("Click where the sheet has its second corner: go around it; Escape picks no more"),
    N_("Click where the sheet has its third corner: go around it; Escape picks no more"),
    N_("Click where the sheet has its fourth and last corner; Escape picks no more"),
};
static const SporeGeneratorPlaces corners = {
    .options = places,
    .hints = hints,
    .pick = N_("Pick corners"),
    .pick_doc =
        N_("Click on the organ at four corners, in turn around the patch that becomes a sheet; drag a corner to "
           "move it"),
    .automatic_doc = N_("The corners of an open sheet, as they are found"),
    .asked = TRUE,
};

const SporeGeneratorType spore_generator_sheet = {
    .name = "sheet",
    .command = "spline",
    .element = "mesh",
    .only = options_taken,
    .count = "control_points",
    .ways = "control_points | tolerance",
    .purpose = &purpose,
    .target = spore_edit_body_sheet,
    .shows = "sheet",
    .title = N_("Spline sheet of %s"),
    .working = N_("Fitting a spline sheet"),
    .count_label = N_("Control points"),
    .unit = "mechanical",
    .offer = N_("Control points of a sheet"),
    .places = &corners,
    .error_of = error_of,
    .run = run,
    .apply = apply,
    .facts = facts,
};
