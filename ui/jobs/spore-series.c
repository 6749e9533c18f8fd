#include "ui/jobs/spore-series.h"

#include <glib/gi18n.h>

#include "core/generate/spheres_series.h"

static const size_t usual_counts[SPORE_SERIES_POINTS] = {8, 16, 32, 64, 128, 256, 512};

typedef struct {
  SporeGenerateWork *source;
  GMutex mutex; /* over what follows */
  gsize measured;
  SporeSpheresReport reports[SPORE_SERIES_POINTS];
} Measurement;

struct _SporeSeries {
  GObject parent;
  SporeJob *job;
  Measurement *measurement; /* of the job, or of the last one */
};

G_DEFINE_FINAL_TYPE(SporeSeries, spore_series, G_TYPE_OBJECT)

enum { CHANGED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

static void clear_measurement(gpointer data) {
  Measurement *measurement = data;
  spore_generate_work_unref(measurement->source);
  g_mutex_clear(&measurement->mutex);
}

static void unref_measurement(gpointer data) { g_atomic_rc_box_release_full(data, clear_measurement); }

static void measured(void *data, size_t point, const SporeSpheresReport *report) {
  Measurement *measurement = data;
  g_mutex_lock(&measurement->mutex);
  measurement->reports[point] = *report;
  measurement->measured = point + 1;
  g_mutex_unlock(&measurement->mutex);
}

static gboolean run(gpointer data, const SporeProgress *progress, GError **error) {
  Measurement *measurement = data;
  SporeSpheresReport reports[SPORE_SERIES_POINTS];
  SporeError failure = SPORE_ERROR_INIT;
  SporeSpheresSource source = {.solid = &measurement->source->mesh};
  return spore_spheres_series(&source, &measurement->source->options.spheres, usual_counts, SPORE_SERIES_POINTS,
                              reports, measured, measurement, progress, &failure) ||
         spore_error_propagate(&failure, error);
}

static void tell(SporeSeries *self) { g_signal_emit(self, signals[CHANGED], 0); }

static void done(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeSeries *self = owner;
  if (self->job != job) return;
  g_clear_object(&self->job);
  tell(self);
}

void spore_series_stop(SporeSeries *self) {
  if (!self->job) return;
  g_signal_handlers_disconnect_by_data(self->job, self);
  spore_job_cancel(self->job);
  g_clear_object(&self->job);
  tell(self);
}

void spore_series_clear(SporeSeries *self) {
  spore_series_stop(self);
  g_clear_pointer(&self->measurement, unref_measurement);
  tell(self);
}

gboolean spore_series_start(SporeSeries *self, SporeDocument *document, SporeObject *body,
                            const SporeGenerateOptions *options, GError **error) {
  SporeGenerateWork *source = spore_generate_work_new(document, body, options, error);
  if (!source) return FALSE;
  spore_series_clear(self);
  self->measurement = g_atomic_rc_box_new0(Measurement);
  self->measurement->source = source;
  g_mutex_init(&self->measurement->mutex);
  self->job = spore_job_start(_("Measuring numbers of spheres"), run, g_atomic_rc_box_acquire(self->measurement),
                              unref_measurement, done, G_OBJECT(self));
  g_signal_connect_object(self->job, "progressed", G_CALLBACK(tell), self, G_CONNECT_SWAPPED);
  tell(self);
  return TRUE;
}

gboolean spore_series_is_running(SporeSeries *self) { return self->job != NULL; }

static gsize copy_reports(SporeSeries *self, SporeSpheresReport reports[SPORE_SERIES_POINTS]) {
  if (!self->measurement) return 0;
  g_mutex_lock(&self->measurement->mutex);
  gsize count = self->measurement->measured;
  memcpy(reports, self->measurement->reports, count * sizeof *reports);
  g_mutex_unlock(&self->measurement->mutex);
  return count;
}

gsize spore_series_get_points(SporeSeries *self, size_t counts[SPORE_SERIES_POINTS],
                              double errors[SPORE_SERIES_POINTS]) {
  SporeSpheresReport reports[SPORE_SERIES_POINTS];
  gsize count = copy_reports(self, reports);
  for (gsize i = 0; i < count; i++) {
    counts[i] = usual_counts[i];
    errors[i] = 100 * reports[i].depth_error;
  }
  return count;
}

size_t spore_series_get_enough(SporeSeries *self) {
  SporeSpheresReport reports[SPORE_SERIES_POINTS];
  gsize count = copy_reports(self, reports);
  size_t enough = count < 2 ? count : spore_spheres_enough(usual_counts, reports, count, SPORE_SPHERES_WORTH);
  return enough < count ? usual_counts[enough] : 0;
}

static void spore_series_dispose(GObject *object) {
  SporeSeries *self = SPORE_SERIES(object);
  spore_series_stop(self);
  g_clear_pointer(&self->measurement, unref_measurement);
  G_OBJECT_CLASS(spore_series_parent_class)->dispose(object);
}

static void spore_series_class_init(SporeSeriesClass *class) {
  G_OBJECT_CLASS(class)->dispose = spore_series_dispose;
  signals[CHANGED] =
      g_signal_new("changed", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
}

static void spore_series_init(SporeSeries *self) {}

SporeSeries *spore_series_new(void) { return g_object_new(SPORE_TYPE_SERIES, NULL); }
