/* Measures how well the mappings of a body follow it, and says the result in words. */
#include "ui/document/mapping-report.h"

#include <glib/gi18n.h>
#include <math.h>

void spore_mapping_report_clear(SporeMappingReport *report) {
  g_free(report->trouble);
  *report = (SporeMappingReport){0};
}

static gboolean goes_on(const SporeProgress *progress, double fraction, const char *stage, GError **error) {
  return spore_progress(progress, fraction, stage) ||
         spore_error_raise(error, SPORE_ERROR_CANCELLED, NULL, "%s", _("cancelled"));
}

static gboolean measure_units(SporeMappingReport *report, const SporeSimulation *simulation, SporeDocument *document,
                              SporeObject *body, const SporeProgress *progress, GError **error) {
  static const char *const stages[] = {N_("Measuring the visual mesh"), N_("Measuring the spheres")};
  g_autoptr(GError) trouble = NULL;
  for (int unit = 0; !trouble && unit < SPORE_MAPPED_UNITS; unit++) {
    if (!goes_on(progress, 0.5 + 0.25 * unit, _(stages[unit]), error)) return FALSE;
    report->known[unit] = spore_mapping_quality_measure(simulation, document, body, (SporeMappedUnit)unit,
                                                        &report->quality[unit], &trouble);
  }
  if (trouble) report->trouble = g_strdup(trouble->message);
  return TRUE;
}

gboolean spore_mapping_report_measure(SporeMappingReport *report, SporeDocument *document, SporeObject *body,
                                      const SporeProgress *progress, GError **error) {
  g_autoptr(GError) trouble = NULL;
  if (!goes_on(progress, 0, _("Compiling the scene"), error)) return FALSE;
  SporeSimulation *simulation = spore_simulation_new(document, NULL, NULL, NULL, &trouble);
  if (!simulation) {
    report->trouble = g_strdup(trouble->message);
    return TRUE;
  }
  gboolean done = measure_units(report, simulation, document, body, progress, error);
  spore_simulation_free(simulation);
  return done;
}

gboolean spore_mapping_report_holds(const SporeMappingReport *report, const SporeDocument *document,
                                    const SporeObject *body) {
  return report->body == spore_object_id(body) && report->revision == spore_document_revision(document);
}

static void append_unit(GString *text, SporeMappedUnit unit, const SporeMappingQuality *quality) {
  if (text->len) g_string_append_c(text, '\n');
  g_string_append_printf(text, unit == SPORE_MAPPED_VISUAL ? _("Visual mesh: %zu vertices") : _("Spheres: %zu centres"),
                         quality->count);
  g_string_append_c(text, '\n');
  if (quality->off)
    g_string_append_printf(text, _("%zu extrapolated, the worst %.3g mm off (marked in the view)"), quality->off,
                           1e3 * quality->farthest);
  else g_string_append(text, _("none extrapolated"));
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Error at rest %.2g mm, turned and moved %.2g mm"), 1e3 * quality->error.rest,
                         1e3 * quality->error.rigid);
  if (!isfinite(quality->error.bend)) return;
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("stretched %.2g mm, bent by a tenth %.2g mm"), 1e3 * quality->error.affine,
                         1e3 * quality->error.bend);
}

char *spore_mapping_report_text(const SporeMappingReport *report) {
  if (report->trouble) return g_strdup_printf(_("It cannot be measured: %s"), report->trouble);
  GString *text = g_string_new(NULL);
  for (int unit = 0; unit < SPORE_MAPPED_UNITS; unit++)
    if (report->known[unit]) append_unit(text, (SporeMappedUnit)unit, &report->quality[unit]);
  if (!text->len) g_string_append(text, _("Nothing is mapped: what is drawn and felt is what moves"));
  return g_string_free(text, FALSE);
}

gboolean spore_mapping_report_worst(const SporeMappingReport *report, SporeVec3 *place, double *size) {
  double farthest = 0;
  for (int unit = 0; unit < SPORE_MAPPED_UNITS; unit++) {
    const SporeMappingQuality *quality = &report->quality[unit];
    if (!report->known[unit] || !quality->off || quality->farthest <= farthest) continue;
    farthest = quality->farthest;
    *place = quality->place;
    *size = quality->size;
  }
  return farthest > 0;
}
