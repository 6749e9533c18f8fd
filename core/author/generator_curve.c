/* The generator of middle lines: its options, which are attributes of <curve>. */
#include "core/author/generator.h"

#include <string.h>

#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "core/author/generator_work.h"
#include "core/base/memory.h"
#include "core/scene/schema_tables.h"

static const SporeParameter curve_parameters[] = {
    NAME(SporeCurveFields, N_("Name by which bodies refer to the curve.")),
    {.name = "file",
     .type = SPORE_FILE,
     .unit = "",
     FIELD(SporeCurveFields, file),
     .required = true,
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("File of the curve, inside the scene's folder: x y z r a line, of a point and the radius there, m; # "
               "begins a comment.")},
    {.name = "source",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "mesh",
     FIELD(SporeCurveFields, source),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Mesh that the curve is the middle line of; none: made elsewhere.")},
    {.name = "points",
     .type = SPORE_INTEGER,
     .unit = "",
     0,
     100000,
     FIELD(SporeCurveFields, points),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Number of points to generate, evenly along the line; 0: as many as the tolerance takes.")},
    {.name = "tolerance",
     .type = SPORE_REAL,
     .unit = "",
     0.0001,
     0.9,
     .initial = {0.02},
     FIELD(SporeCurveFields, tolerance),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("How far straight pieces may leave the line, of the radius, where the number of points is 0.")},
    {.name = "first_place",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeCurveFields, first_place),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Place in or on the organ where the line begins; the same as the last place: at the organ's end.")},
    {.name = "last_place",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeCurveFields, last_place),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Place in or on the organ where the line ends; the same as the first place: at the organ's end.")},
    {.name = "root_degree",
     .type = SPORE_INTEGER,
     .unit = "",
     0,
     SPORE_CENTRELINE_ROOT_DEGREE,
     .initial = {3},
     FIELD(SporeCurveFields, root_degree),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("How closely the root that is proposed for the mesentery of an intestine follows its loops: degree of "
               "the curve, 1 straight; 0: no root, the mesentery draws the intestine to its place at rest.")},
    GENERATED(SporeCurveFields),
};

static const SporeElement elements[] = {
    {"curve", N_("Curve"), N_("The middle line of a thread or a tube, with its radius along it."),
     TABLE(curve_parameters, SporeCurveFields)},
    {NULL},
};

SporeCentrelineOptions spore_edit_centreline_options(const SporeCurveFields *fields) {
  SporeCentrelineOptions options = {.points = (size_t)fields->points, .tolerance = fields->tolerance};
  memcpy(options.ends[0], fields->first_place, sizeof options.ends[0]);
  memcpy(options.ends[1], fields->last_place, sizeof options.ends[1]);
  options.ends_given = memcmp(options.ends[0], options.ends[1], sizeof options.ends[0]) != 0;
  return options;
}

static const char *const uses[] = {"curve", "thread", "tube", "intestine", NULL};
static const SporeParameter purpose = SPORE_GENERATOR_PURPOSE(
    uses, N_("What Apply makes: the curve alone, or of the body a solid thread, a tube with a wall, or an intestine on "
             "its mesentery."));

/* Whether the result becomes an intestine. */
static gboolean is_bowel(const SporeGenerateWork *work) {
  return work->options.purpose == SPORE_CENTRELINE_INTESTINE + 1;
}

/* The root is proposed whatever the use, which may change afterwards. Loops without a root have none. */
static bool propose_root(SporeGenerateWork *work, SporeError *failure) {
  size_t degree = (size_t)work->options.fields.curve.root_degree;
  if (degree == 0) return true;
  if (!spore_centreline_root(&work->curve, degree, &work->root, failure)) return failure->code != SPORE_ERROR_MEMORY;
  return spore_centreline_root_measure(&work->curve, &work->root, &work->root_report, failure);
}

static gboolean run(SporeGenerateWork *work, const SporeProgress *progress, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeCentrelineOptions options = spore_edit_centreline_options(&work->options.fields.curve);
  options.way = work->curve_way = SPORE_NEW_ARRAY(double, work->mesh.vertex_count);
  if (!options.way) spore_error_set(&failure, SPORE_ERROR_MEMORY, NULL, "%s", _("not enough memory"));
  else if (spore_centreline_from_mesh(&work->mesh, &options, &work->curve, &work->curve_report, progress, &failure) &&
           propose_root(work, &failure))
    return TRUE;
  spore_error_at(&failure, work->source);
  return spore_error_propagate(&failure, error);
}

static gboolean apply(const SporeGenerateWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  const SporeGeneratedFrom from = spore_generate_work_from(work);
  const SporeCentrelineBodyOptions along = {.body = (SporeCentrelineBody)(work->options.purpose - 1),
                                            .root = is_bowel(work) && work->root.count ? &work->root : NULL};
  return spore_edit_use_curve(document, body, &from, &work->curve, work->options.purpose ? &along : NULL, error);
}

static char *facts(const SporeGenerateWork *work) {
  const SporeCentrelineReport *report = &work->curve_report;
  size_t loops = 0;
  for (size_t i = 0; i < MIN(report->branches, SPORE_CENTRELINE_NAMED); i++) loops += report->branch[i].returns;
  GString *text = g_string_new(NULL);
  g_string_append_printf(
      text, _("%zu points in %.1f s, %.1f mm long\nRadius %.2f mm (%.2f to %.2f)\nLoops left out: %zu, branches: %zu"),
      work->curve.count, report->seconds, 1e3 * report->length, 1e3 * report->radius_mean, 1e3 * report->radius_min,
      1e3 * report->radius_max, loops, report->branches - loops);
  g_string_append_printf(text, _("\nFollows %.1f %% of the surface"), 100 * report->cover);
  if (report->cover < SPORE_CENTRELINE_FOLLOWED)
    g_string_append(text, _("; Way to the line shows what is left out, two picked ends make another line"));
  if (report->components > 1)
    g_string_append_printf(text, _("\nOf the largest of %zu pieces, %.1f %% of the organ"), report->components,
                           100 * report->share);
  if (report->approach < 1) g_string_append(text, _("\nIts windings touch"));
  if (!is_bowel(work)) return g_string_free(text, FALSE);
  if (work->root.count)
    g_string_append_printf(text, _("\nRoot %.0f mm long, mesentery %.0f mm (%.0f to %.0f)"),
                           1e3 * work->root_report.length, 1e3 * work->root_report.mean,
                           1e3 * work->root_report.shortest, 1e3 * work->root_report.longest);
  else g_string_append(text, _("\nNo root: the mesentery draws it to its place at rest"));
  return g_string_free(text, FALSE);
}

static const char *const places[] = {"first_place", "last_place", NULL};
static const char *const hints[] = {N_("Click on the organ where its middle line begins; Escape picks no more"),
                                    N_("Click on the organ where its middle line ends; Escape picks no more")};
static const SporeGeneratorPlaces ends = {
    .options = places,
    .hints = hints,
    .pick = N_("Pick ends"),
    .pick_doc = N_("Click on the organ where the line shall begin, then where it shall end; drag an end to move it"),
    .automatic_doc = N_("From one end of the organ to the other, as it is found"),
};

const SporeGeneratorType spore_generator_curve = {
    .name = "curve",
    .command = "centreline",
    .element = "curve",
    .elements = elements,
    .count = "points",
    .ways = "points | tolerance",
    .purpose = &purpose,
    .target = spore_edit_body_curve,
    .shows = "curve",
    .title = N_("Middle line of %s"),
    .working = N_("Finding the middle line"),
    .count_label = N_("Points"),
    .unit = "mechanical",
    .offer = N_("Points of the middle line"),
    .places = &ends,
    .run = run,
    .apply = apply,
    .facts = facts,
};
