/* Measures the damping of the selected body's slowest swing on a worker, and keeps the last figure. */
#include "ui/jobs/spore-swing-measures.h"

#include <glib/gi18n.h>

#include "core/scene/compile.h"
#include "ui/jobs/spore-job.h"

#define LEAST_SHARE 0.001 /* a second: less is not told apart */

/* The scene as it was, and the body; what came of it. */
typedef struct Work {
  SporeDocument *document; /* a copy, the worker's own */
  guint64 revision;
  guint32 body;
  gboolean known;
  double share;
} Work;

struct _SporeSwingMeasures {
  GObject parent;
  guint64 revision; /* of the scene that `text` is of */
  guint32 body;     /* its id; 0: none was measured yet */
  char *text;
  gboolean busy;
};

G_DEFINE_FINAL_TYPE(SporeSwingMeasures, spore_swing_measures, G_TYPE_OBJECT)

static guint measured_signal;

static bool asked(void *data) { return !spore_progress(data, 0.5, _("Measuring the method")); }

/* A scene that cannot run has no figure: that it cannot is told elsewhere. */
static gboolean measure(gpointer data, const SporeProgress *progress, GError **error) {
  Work *work = data;
  const SporeCancel cancel = {asked, (void *)(guintptr)progress};
  SporeObject *body = spore_document_by_id(work->document, work->body);
  SporeSimulation *simulation = spore_simulation_new(work->document, NULL, NULL, &cancel, NULL);
  guint32 index = simulation ? spore_simulation_body_of(simulation, body) : SPORE_NO_BODY;
  if (index != SPORE_NO_BODY) work->known = spore_world_body_damping(simulation->world, index, &work->share);
  spore_simulation_free(simulation);
  return TRUE;
}

static void free_work(gpointer data) {
  Work *work = data;
  spore_document_free(work->document);
  g_free(work);
}

static char *text_of(const Work *work) {
  if (!work->known) return g_strdup("");
  if (work->share < LEAST_SHARE)
    return g_strdup(_("Its method takes less than 0.1 % of the energy of its slowest swing in a second"));
  return g_strdup_printf(_("Its method takes %.3g %% of the energy of its slowest swing in a second"),
                         100 * work->share);
}

static void measured(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeSwingMeasures *self = owner;
  const Work *work = data;
  self->busy = FALSE;
  if (work) {
    self->revision = work->revision;
    self->body = work->body;
    g_free(self->text);
    self->text = text_of(work);
  }
  g_signal_emit(self, measured_signal, 0);
}

static void start(SporeSwingMeasures *self, const SporeDocument *document, const SporeObject *body) {
  Work *work = g_new0(Work, 1);
  work->document = spore_document_copy(document);
  work->revision = spore_document_revision(document);
  work->body = spore_object_id(body);
  self->busy = TRUE;
  g_object_unref(spore_job_start(_("Measuring the method"), measure, work, free_work, measured, G_OBJECT(self)));
}

const char *spore_swing_measures_text(SporeSwingMeasures *self, const SporeDocument *document,
                                      const SporeObject *body) {
  gboolean holds = self->revision == spore_document_revision(document) && self->body == spore_object_id(body);
  if (holds && self->text) return self->text;
  if (!self->busy) start(self, document, body);
  return NULL;
}

static void spore_swing_measures_finalize(GObject *object) {
  g_free(SPORE_SWING_MEASURES(object)->text);
  G_OBJECT_CLASS(spore_swing_measures_parent_class)->finalize(object);
}

static void spore_swing_measures_class_init(SporeSwingMeasuresClass *class) {
  G_OBJECT_CLASS(class)->finalize = spore_swing_measures_finalize;
  measured_signal =
      g_signal_new("measured", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
}

static void spore_swing_measures_init(SporeSwingMeasures *self) {}

SporeSwingMeasures *spore_swing_measures_new(void) { return g_object_new(SPORE_TYPE_SWING_MEASURES, NULL); }
