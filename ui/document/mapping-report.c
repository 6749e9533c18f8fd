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
  for (int unit = 0; !trouble && unit < SPORE_CARRIED_COUNT; unit++) {
    if (!goes_on(progress, 0.5 + 0.25 * unit, _(stages[unit]), error)) return FALSE;
    report->known[unit] =
        spore_carried_measure(simulation, document, body, (SporeCarriedUnit)unit, &report->carried[unit], &trouble);
  }
  if (trouble) report->trouble = g_strdup(trouble->message);
  return TRUE;
}

gboolean spore_mapping_report_measure(SporeMappingReport *report, SporeDocument *document, SporeObject *body,
                                      const SporeProgress *progress, GError **error) {
  g_autoptr(GError) trouble = NULL;
  if (!goes_on(progress, 0, _("Compiling the scene"), error)) return FALSE;
  SporeSimulation *simulation = spore_simulation_new(document, NULL, NULL, &trouble);
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

static void append_unit(GString *text, SporeCarriedUnit unit, const SporeCarried *carried) {
  if (text->len) g_string_append_c(text, '\n');
  g_string_append_printf(
      text, unit == SPORE_CARRIED_VISUAL ? _("Visual mesh: %zu vertices") : _("Spheres: %zu centres"), carried->count);
  g_string_append_c(text, '\n');
  if (carried->off)
    g_string_append_printf(text, _("%zu extrapolated, the worst %.3g mm off (marked in the view)"), carried->off,
                           1e3 * carried->farthest);
  else g_string_append(text, _("none extrapolated"));
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Error at rest %.2g mm, turned and moved %.2g mm"), 1e3 * carried->error.rest,
                         1e3 * carried->error.rigid);
  if (!isfinite(carried->error.bend)) return;
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("stretched %.2g mm, bent by a tenth %.2g mm"), 1e3 * carried->error.affine,
                         1e3 * carried->error.bend);
}

char *spore_mapping_report_text(const SporeMappingReport *report) {
  if (report->trouble) return g_strdup_printf(_("It cannot be measured: %s"), report->trouble);
  GString *text = g_string_new(NULL);
  for (int unit = 0; unit < SPORE_CARRIED_COUNT; unit++)
    if (report->known[unit]) append_unit(text, (SporeCarriedUnit)unit, &report->carried[unit]);
  if (!text->len) g_string_append(text, _("Nothing is mapped: what is drawn and felt is what moves"));
  return g_string_free(text, FALSE);
}

gboolean spore_mapping_report_worst(const SporeMappingReport *report, SporeVec3 *place, double *size) {
  double farthest = 0;
  for (int unit = 0; unit < SPORE_CARRIED_COUNT; unit++) {
    const SporeCarried *carried = &report->carried[unit];
    if (!report->known[unit] || !carried->off || carried->farthest <= farthest) continue;
    farthest = carried->farthest;
    *place = carried->place;
    *size = carried->size;
  }
  return farthest > 0;
}
