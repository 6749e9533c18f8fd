/* Sphere sets from a surface. */
#include <glib/gi18n.h>

#include "core/author/generated_edits.h"
#include "ui/jobs/generate-types.h"

static SporeSpheresOptions options_of(const SporeGenerateWork *work) {
  return spore_edit_spheres_options(&work->options.fields.spheres, work->regions, work->region_count);
}

static gboolean run(SporeGenerateWork *work, const SporeProgress *progress, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeSpheresOptions options = options_of(work);
  return (spore_spheres_from_mesh(&work->mesh, &options, &work->spheres, &work->spheres_report, progress, &failure) &&
          spore_spheres_quality(&work->mesh, &work->spheres, &work->spheres_quality, progress, &failure)) ||
         spore_error_propagate(&failure, error);
}

static gboolean price(const SporeGenerateWork *work, size_t count, double *error_percent, const SporeProgress *progress,
                      GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeSpheresOptions options = options_of(work);
  SporeSpheresReport report;
  SporeSphereSet set;
  options.count = count;
  if (!spore_spheres_from_mesh(&work->mesh, &options, &set, &report, progress, &failure))
    return spore_error_propagate(&failure, error);
  spore_sphere_set_clear(&set);
  *error_percent = 100 * spore_spheres_felt_error(&report);
  return TRUE;
}

static gboolean apply(const SporeGenerateWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  const SporeGeneratedFrom from = {work->source, work->source_hash, &work->options.fields};
  return spore_edit_use_spheres(document, body, &from, &work->spheres, error);
}

static char *facts(const SporeGenerateWork *work) {
  const SporeSpheresReport *spheres = &work->spheres_report;
  return g_strdup_printf(_("%zu spheres in %.1f s\nCoverage %.1f %%, outside %.1f %%\n"
                           "Depth error %.1f %%, distance %.2f %%"),
                         work->spheres.count, spheres->seconds, 100 * spheres->coverage, 100 * spheres->outside,
                         100 * spore_spheres_felt_error(spheres), 100 * spheres->distance_mean);
}

/* Qualities. */

static void show_set(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  spore_generate_show_spheres(&work->spheres, places, candidate);
}

static void show_mesh(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  spore_generate_show_surface(&work->mesh, places, candidate);
}

static void measure_distance(const SporeGenerateWork *work, SporeQuality *quality) {
  const SporeSpheresQuality *found = &work->spheres_quality;
  quality->count = found->vertex_count;
  quality->values = spore_generate_scaled(found->distance, quality->count, 1, 1e3);
  quality->weights = g_memdup2(found->area, quality->count * sizeof(double));
}

static void measure_outside(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->spheres_quality.sphere_count;
  quality->values = spore_generate_scaled(work->spheres_quality.outside, quality->count, 1, 100);
}

static void measure_depth(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->spheres_quality.sphere_count;
  quality->values = spore_generate_scaled(work->spheres_quality.depth_error, quality->count, 1, 1e3);
}

static void measure_radius(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->spheres.count;
  quality->values = spore_generate_scaled(work->spheres.spheres + 3, quality->count, 4, 1e3);
}

static const SporeGenerateQuality qualities[] = {
    {N_("Surface distance"), "mm", FALSE, measure_distance, show_mesh},
    {N_("Outside share"), "%", FALSE, measure_outside, show_set},
    {N_("Depth error"), "mm", FALSE, measure_depth, show_set},
    {N_("Radius"), "mm", FALSE, measure_radius, show_set},
};

const SporeGenerateType spore_generate_spheres = {
    .generator = &spore_generator_spheres,
    .title = N_("Spheres of %s"),
    .working = N_("Generating spheres"),
    .count_label = N_("Spheres"),
    .counts = (const size_t[]){8, 16, 32, 64, 128, 256, 512, 0},
    .error_label = N_("Depth error"),
    .worth = 1,
    .price = price,
    .qualities = qualities,
    .quality_count = G_N_ELEMENTS(qualities),
    .run = run,
    .apply = apply,
    .facts = facts,
};
