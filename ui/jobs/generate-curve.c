/* The middle line of a tubular organ, and a body along it. */
#include <glib/gi18n.h>
#include <math.h>

#include "core/author/generated_edits.h"
#include "ui/jobs/generate-types.h"

static gboolean run(SporeGenerateWork *work, const SporeProgress *progress, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeCentrelineOptions options = spore_edit_centreline_options(&work->options.fields.curve);
  if (spore_centreline_from_mesh(&work->mesh, &options, &work->curve, &work->curve_report, progress, &failure))
    return TRUE;
  spore_error_at(&failure, work->source);
  return spore_error_propagate(&failure, error);
}

static gboolean apply(const SporeGenerateWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  const SporeGeneratedFrom from = {work->source, work->source_hash, &work->options.fields};
  const SporeCentrelineBodyOptions along = {.body = (SporeCentrelineBody)(work->options.purpose - 1),
                                            .loops_apart = work->curve_report.approach > SPORE_CENTRELINE_APART};
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
  if (report->components > 1)
    g_string_append_printf(text, _("\nOf the largest of %zu pieces, %.1f %% of the organ"), report->components,
                           100 * report->share);
  if (report->approach < 1) g_string_append(text, _("\nIts windings touch"));
  return g_string_free(text, FALSE);
}

/* Qualities. */

static SporeVec3 point(const SporeCurve *curve, gsize i) { return spore_vec3_load(curve->points + 4 * i); }

/* Each point stands for half of the line to either side of it. */
static void measure_radius(const SporeGenerateWork *work, SporeQuality *quality) {
  const SporeCurve *curve = &work->curve;
  quality->count = curve->count;
  quality->values = spore_generate_scaled(curve->points + 3, quality->count, 4, 1e3);
  quality->weights = g_new0(double, quality->count);
  for (gsize i = 0; i + 1 < curve->count; i++) {
    double half = 0.5 * spore_vec3_distance(point(curve, i), point(curve, i + 1));
    quality->weights[i] += half;
    quality->weights[i + 1] += half;
  }
}

/* The angle by which the line turns at each point. */
static void measure_bend(const SporeGenerateWork *work, SporeQuality *quality) {
  const SporeCurve *curve = &work->curve;
  quality->count = curve->count;
  quality->values = g_new0(double, quality->count);
  for (gsize i = 1; i + 1 < curve->count; i++) {
    SporeVec3 before = spore_vec3_sub(point(curve, i), point(curve, i - 1));
    SporeVec3 after = spore_vec3_sub(point(curve, i + 1), point(curve, i));
    double across = spore_vec3_length(spore_vec3_cross(before, after)), along = spore_vec3_dot(before, after);
    quality->values[i] = 180 / G_PI * atan2(across, along);
  }
}

static void show(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  const SporeSphereSet balls = {.count = work->curve.count, .spheres = work->curve.points};
  spore_generate_show_spheres(&balls, places, candidate);
  candidate->line_count = work->curve.count - 1;
  candidate->lines = g_new(double, 6 * candidate->line_count);
  for (gsize i = 0; i < candidate->line_count; i++) {
    spore_vec3_store(candidate->lines + 6 * i, point(&work->curve, i));
    spore_vec3_store(candidate->lines + 6 * i + 3, point(&work->curve, i + 1));
  }
}

static const SporeGenerateQuality qualities[] = {
    {N_("Radius"), "mm", FALSE, measure_radius, show},
    {N_("Bend"), "°", FALSE, measure_bend, show},
};

const SporeGenerateType spore_generate_curve = {
    .generator = &spore_generator_curve,
    .title = N_("Middle line of %s"),
    .working = N_("Finding the middle line"),
    .count_label = N_("Points"),
    .picks_ends = TRUE,
    .qualities = qualities,
    .quality_count = G_N_ELEMENTS(qualities),
    .run = run,
    .apply = apply,
    .facts = facts,
};
