/* Tetrahedra in a surface. */
#include <glib/gi18n.h>

#include "core/author/generated_edits.h"
#include "core/generate/tetrahedra/tetrahedra.h"
#include "ui/jobs/generate-types.h"

static SporeTetrahedraOptions options_of(const SporeGenerateWork *work) {
  return spore_edit_tetrahedra_options(&work->options.fields.tetrahedra, work->regions, work->region_count);
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

/* What the mesh needed, and what of it that changed. */
static const char *method_text(SporeTetrahedraMethod method) {
  static const char *const texts[] = {N_("the mesh"), N_("the mesh repaired"), N_("a wrap of it"), N_("a lattice")};
  return _(texts[method]);
}

/* As the command line says them, a line each. */
static void append_remarks(GString *text, const SporeGenerateWork *work) {
  SporeTetrahedraOptions options = options_of(work);
  g_autofree char *remarks = spore_tetrahedra_remarks(&work->tetrahedra, &options, &work->tetrahedra_report);
  if (*remarks) g_string_append_printf(text, "\n%s", g_strchomp(remarks));
}

static char *facts(const SporeGenerateWork *work) {
  const SporeTetrahedraReport *report = &work->tetrahedra_report;
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("%zu tetrahedra in %.1f s, of %s"), work->tetrahedra.tetrahedron_count,
                         report->seconds, method_text(report->method));
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Least angle %.1f°, mean %.1f°"), report->quality.min_dihedral_deg,
                         report->quality.mean_dihedral_deg);
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Error %.2f %%, volume %+.1f %%"), 100 * report->hausdorff,
                         100 * report->volume_change);
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Surface %+.1f %%"), 100 * report->area_change);
  append_remarks(text, work);
  for (int i = 0; i < SPORE_TETRAHEDRA_METHODS; i++)
    if (*report->refused[i]) {
      g_string_append_c(text, '\n');
      g_string_append_printf(text, _("Not %s: %s"), method_text((SporeTetrahedraMethod)i), report->refused[i]);
    }
  return g_string_free(text, FALSE);
}

/* Qualities. */

static void measure_cells(const SporeGenerateWork *work, SporeQuality *quality,
                          double (*figure)(const SporeTetrahedraQuality *found)) {
  quality->count = work->tetrahedra.tetrahedron_count;
  quality->values = g_new(double, quality->count);
  for (gsize i = 0; i < quality->count; i++) {
    SporeTetrahedralMesh one = {work->tetrahedra.vertex_count, 1, work->tetrahedra.vertices,
                                work->tetrahedra.tetrahedra + 4 * i};
    SporeTetrahedraQuality found;
    spore_tetrahedral_mesh_quality(&one, &found);
    quality->values[i] = figure(&found);
  }
}

static double angle(const SporeTetrahedraQuality *found) { return found->min_dihedral_deg; }
static double radius_ratio(const SporeTetrahedraQuality *found) { return found->worst_radius_ratio; }
static double volume(const SporeTetrahedraQuality *found) { return 1e9 * found->volume; }

void spore_generate_measure_angles(const SporeGenerateWork *work, SporeQuality *quality) {
  measure_cells(work, quality, angle);
}
static void measure_ratios(const SporeGenerateWork *work, SporeQuality *quality) {
  measure_cells(work, quality, radius_ratio);
}
static void measure_volumes(const SporeGenerateWork *work, SporeQuality *quality) {
  measure_cells(work, quality, volume);
}

static void show_cells(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  spore_generate_show_cells(&work->tetrahedra, places, candidate);
}

static const SporeGenerateQuality qualities[] = {
    {N_("Least angle"), "°", FALSE, spore_generate_measure_angles, show_cells},
    {N_("Radius ratio"), "", FALSE, measure_ratios, show_cells},
    {N_("Volume"), "mm³", FALSE, measure_volumes, show_cells},
};

const SporeGenerateType spore_generate_tetrahedra = {
    .generator = &spore_generator_tetrahedra,
    .title = N_("Tetrahedra of %s"),
    .working = N_("Generating tetrahedra"),
    .count_label = N_("Tetrahedra"),
    .counts = (const size_t[]){300, 600, 1200, 2500, 5000, 10000, 0},
    .error_label = N_("Distance"),
    .worth = 0.1,
    .price = price,
    .cells = TRUE,
    .qualities = qualities,
    .quality_count = G_N_ELEMENTS(qualities),
    .run = run,
    .apply = apply,
    .facts = facts,
};
