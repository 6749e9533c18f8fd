/* Finds what was measured of the settings that the scene has. */
#include "ui/document/measured-facts.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#define MOST_ALTERNATIVES 10

/* What a study varies. */
typedef enum { VARIED_NOT, VARIED_STEP, VARIED_INTEGRATOR, VARIED_NONLINEAR, VARIED_LINEAR, VARIED_LEVEL } Varied;

/* Which setting it is, and the body that it is of; *body NULL: of the whole scene. */
static Varied varied(SporeEditorDocument *document, const char *path, const char *property, const char **body) {
  static const struct {
    const char *element, *property;
    Varied is;
  } settings[] = {{"solver", "time_step", VARIED_STEP},
                  {"solver", "integrator", VARIED_INTEGRATOR},
                  {"solver", "nonlinear", VARIED_NONLINEAR},
                  {"solver", "linear", VARIED_LINEAR},
                  {"mechanical", "integrator", VARIED_INTEGRATOR},
                  {"fidelity", "level", VARIED_LEVEL}};
  *body = NULL;
  for (gsize i = 0; i < G_N_ELEMENTS(settings); i++) {
    if (!g_str_equal(property, settings[i].property)) continue;
    SporeObject *object = spore_document_by_path(spore_editor_document_get(document), path);
    if (!object || !g_str_equal(spore_object_type(object)->element, settings[i].element)) continue;
    *body = spore_object_name(spore_object_parent(object));
    return settings[i].is;
  }
  return VARIED_NOT;
}

/* Whether what was measured by varying one body, or all, says something of the setting. */
static gboolean concerns(Varied is, const char *body, const char *studied) {
  if (body) return !studied || g_str_equal(body, studied);
  return is != VARIED_INTEGRATOR || !studied;
}

/* Whether two points differ in that setting alone. */
static gboolean differ_in(const SporeAccuracyReport *report, const SporeAccuracyPoint *a, const SporeAccuracyPoint *b,
                          Varied is) {
  const SporeAccuracyMethod *of_a = &report->methods[a->method].method, *of_b = &report->methods[b->method].method;
  return (is == VARIED_STEP || fabs(a->dt_s - b->dt_s) <= 1e-9 * b->dt_s) &&
         (is == VARIED_INTEGRATOR || of_a->integrator == of_b->integrator) &&
         (is == VARIED_NONLINEAR || of_a->nonlinear == of_b->nonlinear) &&
         (is == VARIED_LINEAR || of_a->linear == of_b->linear) && (is == VARIED_LEVEL || a->level == b->level);
}

/* The points that differ in that setting alone, a line each. */
static char *alternatives(const SporeAccuracyReport *report, gssize current, Varied is) {
  GString *text = g_string_new(_("Measured, of method, step, solvers and level together"));
  guint count = 0;
  for (gsize i = 0; i < report->point_count && count < MOST_ALTERNATIVES; i++) {
    const SporeAccuracyPoint *point = &report->points[i];
    if ((gssize)i == current || !differ_in(report, point, &report->points[current], is)) continue;
    g_autofree char *name = spore_accuracy_point_name(report, point);
    g_autofree char *figures = spore_accuracy_point_figures(report, point);
    g_string_append_printf(text, "\n%s: %s", name, figures);
    count++;
  }
  return g_string_free(text, FALSE);
}

static char *note_of_study(SporeEditorDocument *document, Varied is, const char *body, char **hint, gboolean *stale) {
  const SporeAccuracyStudy *study = spore_editor_document_get_study(document);
  gssize current = study ? spore_editor_document_get_point(document) : -1;
  if (current < 0 || !concerns(is, body, study->body)) return NULL;
  const SporeAccuracyPoint *point = &study->report->points[current];
  if (is == VARIED_LEVEL && point->level < 0) return NULL;
  *stale = !spore_editor_document_study_holds(document);
  *hint = alternatives(study->report, current, is);
  return spore_accuracy_point_figures(study->report, point);
}

static char *note_of_scene(SporeEditorDocument *document, Varied is, const char *body, char **hint, gboolean *stale) {
  SporeMeasured state = spore_editor_document_get_measured(document);
  SporeDocument *scene = spore_editor_document_get(document);
  if (state == SPORE_MEASURED_NOT) return NULL;
  const SporeObject *measured = spore_object_child_of(spore_document_section(scene, "meta"), "measured");
  if (!concerns(is, body, spore_object_text(measured, "body"))) return NULL;
  if (is == VARIED_LEVEL && !spore_object_text(measured, "level")) return NULL;
  *stale = state == SPORE_MEASURED_STALE;
  *hint = spore_measured_source(scene);
  return spore_measured_figures(scene);
}

char *spore_measured_note(SporeEditorDocument *document, const char *path, const char *property, char **hint,
                          gboolean *stale) {
  const char *body;
  Varied is = varied(document, path, property, &body);
  *hint = NULL;
  *stale = FALSE;
  if (is == VARIED_NOT) return NULL;
  char *note = note_of_study(document, is, body, hint, stale);
  return note ? note : note_of_scene(document, is, body, hint, stale);
}

char *spore_measured_sentence(SporeEditorDocument *document) {
  char *text = spore_measured_text(spore_editor_document_get(document));
  if (!text || spore_editor_document_get_measured(document) != SPORE_MEASURED_STALE) return text;
  g_autofree char *fresh = text;
  return g_strdup_printf(_("%s; stale: the scene has changed since"), fresh);
}
