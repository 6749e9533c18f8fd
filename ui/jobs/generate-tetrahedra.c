/* Tetrahedra in a surface. */
#include <glib/gi18n.h>

#include "ui/document/generated-edits.h"
#include "ui/jobs/generate-types.h"

static SporeTetrahedraOptions options_of(const SporeGenerateWork *work) {
  const SporeTetrahedraFields *fields = &work->options.fields.tetrahedra;
  return (SporeTetrahedraOptions){.method = fields->method ? (SporeTetrahedraMethod)(fields->method - 1)
                                                           : SPORE_TETRAHEDRA_METHODS,
                                  .cells = fields->size > 0 ? 0 : (size_t)fields->cells,
                                  .size = fields->size,
                                  .tolerance = fields->tolerance,
                                  .curvature = fields->curvature,
                                  .fill = fields->fill,
                                  .gap = fields->gap};
}

static gboolean run(SporeGenerateWork *work, const SporeProgress *progress, GError **error) {
  SporeTetrahedraOptions options = options_of(work);
  return spore_tetrahedra_from_mesh(work->source, &work->mesh, &options, &work->tetrahedra, &work->tetrahedra_report,
                                    progress, error);
}

static gboolean price(const SporeGenerateWork *work, size_t count, double *error_percent, const SporeProgress *progress,
                      GError **error) {
  SporeTetrahedraOptions options = options_of(work);
  SporeTetrahedralMesh mesh = {0};
  SporeTetrahedraReport report;
  options.cells = count;
  gboolean done = spore_tetrahedra_from_mesh(work->source, &work->mesh, &options, &mesh, &report, progress, error);
  spore_tetrahedral_mesh_clear(&mesh);
  if (done) *error_percent = 100 * report.hausdorff;
  return done;
}

static gboolean apply(const SporeGenerateWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  const SporeGeneratedFrom from = {work->source, work->source_hash, &work->options.fields};
  return spore_edit_use_tetrahedra(document, body, &from, &work->tetrahedra, error);
}

static char *facts(const SporeGenerateWork *work) {
  const SporeTetrahedraReport *tetrahedra = &work->tetrahedra_report;
  return g_strdup_printf(_("%zu tetrahedra in %.1f s\nLeast angle %.1f°, mean %.1f°\nError %.2f %%"),
                         work->tetrahedra.tetrahedron_count, tetrahedra->seconds, tetrahedra->quality.min_dihedral_deg,
                         tetrahedra->quality.mean_dihedral_deg, 100 * tetrahedra->hausdorff);
}

static void measure_angles(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->tetrahedra.tetrahedron_count;
  quality->values = g_new(double, quality->count);
  for (gsize i = 0; i < quality->count; i++) {
    SporeTetrahedralMesh one = {work->tetrahedra.vertex_count, 1, work->tetrahedra.vertices,
                                work->tetrahedra.tetrahedra + 4 * i};
    SporeTetrahedraQuality found;
    spore_tetrahedral_mesh_quality(&one, &found);
    quality->values[i] = found.min_dihedral_deg;
  }
}

/* In the histogram alone. */
static void show_nothing(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  g_free(places);
}

static const SporeGenerateQuality qualities[] = {{N_("Least angle"), "°", measure_angles, show_nothing}};

const SporeGenerateType spore_generate_tetrahedra = {
    .name = "tetrahedra",
    .element = "tetrahedra",
    .title = N_("Tetrahedra of %s"),
    .working = N_("Generating tetrahedra"),
    .count = "cells",
    .count_label = N_("Tetrahedra"),
    .counts = (const size_t[]){300, 600, 1200, 2500, 5000, 10000, 0},
    .error_label = N_("Distance"),
    .worth = 0.1,
    .price = price,
    .qualities = qualities,
    .quality_count = G_N_ELEMENTS(qualities),
    .target = spore_edit_body_tetrahedra,
    .run = run,
    .apply = apply,
    .facts = facts,
};
