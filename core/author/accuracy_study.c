/* Makes an accuracy study of a document, and gives the document a point of the study. */
#include "core/author/accuracy_study.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/author/accuracy_source.h"
#include "core/author/edits.h"
#include "core/scene/run_hash.h"
#include "core/scene/variation.h"

/* The study. */

/* The name of a choice; NULL where the solver has it already, so that it is not written into the scene. */
static const char *other_than(SporeDocument *document, const char *property, const char *const *names, int choice) {
  SporeObject *solver = spore_document_section(document, "solver");
  return (int)spore_object_number(solver, property) == choice ? NULL : names[choice];
}

/* What the point changes in the document; the texts are constants, or the study's. */
static SporeVariation variation_of(const SporeAccuracyStudy *study, gsize index, SporeDocument *document) {
  const SporeAccuracyPoint *point = &study->report->points[index];
  const SporeAccuracyMethod *method = &study->report->methods[point->method].method;
  int nonlinear = method->nonlinear < 0 ? study->nonlinear : method->nonlinear;
  int linear = method->linear < 0 ? study->linear : method->linear;
  return (SporeVariation){.body = study->body,
                          .integrator = spore_integrator_names[method->integrator],
                          .nonlinear = other_than(document, "nonlinear", spore_nonlinear_names, nonlinear),
                          .linear = other_than(document, "linear", spore_linear_names, linear),
                          .level = point->level < 0 ? NULL : spore_lod_names[point->level],
                          .dt_s = point->dt_s};
}

/* Whether the integrator is that of every body that physics moves. */
static gboolean moves_all(SporeDocument *document, const char *integrator) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i), *mechanical = spore_object_child_of(body, "mechanical");
    if ((int)spore_object_number(body, "role") != SPORE_PASSIVE || !mechanical) continue;
    int own = (int)spore_object_number(mechanical, "integrator") - 1;
    if (own < 0 || !g_str_equal(spore_integrator_names[own], integrator)) return FALSE;
  }
  return TRUE;
}

/* Sets the point in the document. The solver names the integrator, too, where no body keeps another one: a body that is
 * added later gets the integrator from there. */
static gboolean settle(const SporeAccuracyStudy *study, gsize index, SporeDocument *document, GError **error) {
  const SporeVariation variation = variation_of(study, index, document);
  SporeObject *solver = spore_document_section(document, "solver");
  return spore_variation_set(document, &variation, error) &&
         (!moves_all(document, variation.integrator) ||
          spore_document_set_text(document, solver, "integrator", variation.integrator, error));
}

/* Of the scene as the point sets it; 0: it cannot be set. */
static guint64 hash_settled(const SporeAccuracyStudy *study, gsize index, const SporeDocument *document) {
  SporeDocument *copy = spore_document_copy(document);
  guint64 hash = settle(study, index, copy, NULL) ? spore_document_run_hash(copy) : 0;
  spore_document_free(copy);
  return hash;
}

SporeAccuracyStudy *spore_accuracy_study_new(SporeDocument *document, const SporeSimulation *simulation,
                                             SporePool *pool, const SporeTrack *input,
                                             const SporeAccuracyOptions *options, GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  SporeObject *solver = spore_document_section(document, "solver");
  SporeAccuracySource *source =
      spore_accuracy_source_new(document, simulation, pool, input, options->cancel, options->body);
  const SporeAccuracyScene scene = spore_accuracy_source_scene(source);
  gboolean made =
      spore_accuracy_source_vary_spheres(source, options->spheres, options->sphere_count, options->progress, error);
  SporeAccuracyReport *report = made ? spore_accuracy_study(&scene, options, &fault) : NULL;
  spore_accuracy_source_free(source);
  if (!made) return NULL;
  if (!report) {
    const char *file = spore_document_file(document);
    if (file) spore_error_at(&fault, file);
    spore_error_propagate(&fault, error);
    return NULL;
  }
  SporeAccuracyStudy *study = g_new(SporeAccuracyStudy, 1);
  *study = (SporeAccuracyStudy){.report = report,
                                .body = g_strdup(options->body),
                                .nonlinear = (int)spore_object_number(solver, "nonlinear"),
                                .linear = (int)spore_object_number(solver, "linear"),
                                .time = g_get_real_time() / G_USEC_PER_SEC,
                                .hashes = g_new(guint64, report->point_count)};
  for (gsize i = 0; i < report->point_count; i++) study->hashes[i] = hash_settled(study, i, document);
  return study;
}

void spore_accuracy_study_free(SporeAccuracyStudy *study) {
  if (!study) return;
  spore_accuracy_report_free(study->report);
  g_free(study->body);
  g_free(study->hashes);
  g_free(study);
}

gboolean spore_accuracy_study_holds(const SporeAccuracyStudy *study, const SporeDocument *document) {
  return study->report->point_count > 0 && hash_settled(study, 0, document) == study->hashes[0];
}

gssize spore_accuracy_study_find(const SporeAccuracyStudy *study, guint64 run_hash) {
  for (gsize i = 0; i < study->report->point_count; i++)
    if (study->hashes[i] == run_hash) return (gssize)i;
  return -1;
}

/* What the scene remembers. */

/* A figure to four digits: more are noise. What is not finite is left out. */
static gboolean set_figure(SporeDocument *document, SporeObject *measured, const char *property, double value,
                           GError **error) {
  char text[G_ASCII_DTOSTR_BUF_SIZE];
  if (!isfinite(value)) return TRUE;
  return spore_document_set_text(document, measured, property, g_ascii_formatd(text, sizeof text, "%.4g", value),
                                 error);
}

static gboolean set_text(SporeDocument *document, SporeObject *measured, const char *property, const char *text,
                         GError **error) {
  return !text || spore_document_set_text(document, measured, property, text, error);
}

static gboolean set_step(SporeDocument *document, SporeObject *measured, double step_s, GError **error) {
  int property = spore_parameter_find(spore_object_type(measured)->table, "time_step");
  const SporeValue value = {.type = SPORE_REAL, .number = {step_s}};
  return spore_document_set(document, measured, (guint)property, &value, error);
}

static char *date_of(gint64 unix_s) {
  g_autoptr(GDateTime) time = g_date_time_new_from_unix_utc(unix_s);
  return g_date_time_format(time, "%Y-%m-%dT%H:%M:%SZ");
}

/* A new element, so that nothing of an older study stays. */
static SporeObject *renew(SporeDocument *document, GError **error) {
  SporeObject *meta = spore_document_section(document, "meta"), *old = spore_object_child_of(meta, "measured");
  if (old && !spore_document_remove(document, old, error)) return NULL;
  return spore_document_insert(document, meta, "measured", NULL, G_MAXUINT, error);
}

gboolean spore_measured_remember(SporeDocument *document, const SporeMeasurement *what, GError **error) {
  const SporeAccuracyReport *report = what->report;
  SporeObject *measured = renew(document, error);
  const SporeAccuracyReference *reference = &report->reference;
  g_autofree char *date = date_of(what->time),
                  *hash = g_strdup_printf("%016" G_GINT64_MODIFIER "x", spore_document_run_hash(document));
  return measured && set_text(document, measured, "method", what->method, error) &&
         set_step(document, measured, what->dt_s, error) && set_text(document, measured, "level", what->level, error) &&
         set_text(document, measured, "body", what->body, error) &&
         set_figure(document, measured, "error", what->error, error) &&
         set_figure(document, measured, "floor", what->floor, error) &&
         set_figure(document, measured, "step_cost", what->step_s, error) &&
         (!report->statistics || set_text(document, measured, "statistics", "true", error)) &&
         set_text(document, measured, "reference", report->methods[reference->method].label, error) &&
         set_figure(document, measured, "reference_step", reference->dt_s, error) &&
         set_figure(document, measured, "reference_error", reference->own_error, error) &&
         set_figure(document, measured, "start", report->start_s, error) &&
         set_figure(document, measured, "duration", report->time_s, error) &&
         set_text(document, measured, "date", date, error) && set_text(document, measured, "scene_hash", hash, error);
}

static gboolean remember(const SporeAccuracyStudy *study, gsize index, SporeDocument *document, GError **error) {
  const SporeAccuracyReport *report = study->report;
  const SporeAccuracyPoint *point = &report->points[index];
  const SporeMeasurement what = {.method = report->methods[point->method].label,
                                 .dt_s = point->dt_s,
                                 .level = point->level < 0 ? NULL : spore_lod_names[point->level],
                                 .body = study->body,
                                 .error = point->error,
                                 .floor = report->floor,
                                 .step_s = 1e-6 * point->us_per_step,
                                 .report = report,
                                 .time = study->time};
  return spore_measured_remember(document, &what, error);
}

gboolean spore_accuracy_study_apply(const SporeAccuracyStudy *study, gsize point, SporeDocument *document,
                                    GError **error) {
  g_autofree char *name = spore_accuracy_point_name(study->report, &study->report->points[point]);
  if (!study->report->points[point].stable)
    return spore_error_raise(error, SPORE_ERROR_INPUT, NULL,
                             _("%s is not stable in this scene; expected a stable point; choose another one"), name);
  g_autofree char *label = g_strdup_printf(_("Apply %s"), name);
  spore_document_begin(document, label);
  return spore_edit_finish(document, settle(study, point, document, error) && remember(study, point, document, error));
}

static SporeObject *find_measured(const SporeDocument *document) {
  return spore_object_child_of(spore_document_section(document, "meta"), "measured");
}

SporeMeasured spore_measured_state(const SporeDocument *document, guint64 run_hash) {
  const SporeObject *measured = find_measured(document);
  const char *then = measured ? spore_object_text(measured, "scene_hash") : NULL;
  if (!measured) return SPORE_MEASURED_NOT;
  guint64 hash = then ? g_ascii_strtoull(then, NULL, 16) : 0;
  return hash == run_hash ? SPORE_MEASURED_FRESH : SPORE_MEASURED_STALE;
}

/* Words. */

static char *figures(double error, double floor, double step_s) {
  if (error < floor) return g_strdup_printf(_("less than %.2g %% off, %.2g ms a step"), 100 * floor, 1e3 * step_s);
  return g_strdup_printf(_("%.2g %% off, %.2g ms a step"), 100 * error, 1e3 * step_s);
}

static char *name_of(const char *method, double step_s, const char *level, const char *body) {
  GString *name = g_string_new(NULL);
  if (body) g_string_append_printf(name, "%s: ", body);
  g_string_append_printf(name, _("%s at %.3g ms"), method, 1e3 * step_s);
  if (level) g_string_append_printf(name, ", %s", level);
  return g_string_free(name, FALSE);
}

char *spore_accuracy_point_figures(const SporeAccuracyReport *report, const SporeAccuracyPoint *point) {
  if (!point->stable) return g_strdup_printf(_("not stable, %.2g ms a step"), 1e-3 * point->us_per_step);
  return figures(point->error, report->floor, 1e-6 * point->us_per_step);
}

char *spore_accuracy_point_name(const SporeAccuracyReport *report, const SporeAccuracyPoint *point) {
  return name_of(report->methods[point->method].label, point->dt_s,
                 point->level < 0 ? NULL : spore_lod_names[point->level], NULL);
}

char *spore_measured_figures(const SporeDocument *document) {
  const SporeObject *measured = find_measured(document);
  if (!measured) return NULL;
  return figures(spore_object_number(measured, "error"), spore_object_number(measured, "floor"),
                 spore_object_number(measured, "step_cost"));
}

char *spore_measured_text(const SporeDocument *document) {
  const SporeObject *measured = find_measured(document);
  const char *method = measured ? spore_object_text(measured, "method") : NULL;
  if (!measured) return NULL;
  g_autofree char *values = spore_measured_figures(document);
  g_autofree char *name = name_of(method ? method : "?", spore_object_number(measured, "time_step"),
                                  spore_object_text(measured, "level"), spore_object_text(measured, "body"));
  return g_strdup_printf(_("measured: %s (%s)"), values, name);
}

char *spore_measured_source(const SporeDocument *document) {
  const SporeObject *measured = find_measured(document);
  if (!measured) return NULL;
  const char *reference = spore_object_text(measured, "reference"), *date = spore_object_text(measured, "date");
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("%.3g s of the input from %.3g s on"), spore_object_number(measured, "duration"),
                         spore_object_number(measured, "start"));
  g_string_append_c(text, '\n');
  if (reference) {
    g_string_append_printf(text, _("against %s at %.3g ms, itself %.2g %% off at most"), reference,
                           1e3 * spore_object_number(measured, "reference_step"),
                           100 * spore_object_number(measured, "reference_error"));
    g_string_append_c(text, '\n');
  }
  if (spore_object_number(measured, "statistics") != 0) {
    g_string_append(text, _("chaotic: the error is of mean places"));
    g_string_append_c(text, '\n');
  }
  if (date) g_string_append_printf(text, _("measured on %s"), date);
  return g_string_free(text, FALSE);
}
