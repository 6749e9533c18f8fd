/* A series: the results for several numbers of a generator, measured one after the other. */
#include "ui/jobs/spore-series.h"

#include <glib/gi18n.h>

#include "core/generate/spheres/spheres.h"
#include "ui/jobs/generate-types.h"

typedef struct {
  SporeGenerateWork *source;
  GMutex mutex; /* over what follows */
  gsize measured;
  double errors[SPORE_SERIES_POINTS]; /* % */
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

static void measured(Measurement *measurement, gsize point, double error) {
  g_mutex_lock(&measurement->mutex);
  measurement->errors[point] = error;
  measurement->measured = point + 1;
  g_mutex_unlock(&measurement->mutex);
}

static const SporeGenerateType *type_of(const Measurement *measurement) {
  return spore_generate_type(measurement->source->options.kind);
}

static gboolean run(gpointer data, const SporeProgress *progress, GError **error) {
  Measurement *measurement = data;
  const size_t *counts = type_of(measurement)->counts;
  double sum = 0;
  for (gsize i = 0; counts[i]; i++) sum += (double)counts[i];
  SporeProgressShare part = {.whole = progress};
  for (gsize i = 0; counts[i]; i++) {
    double found = 0;
    part.done += part.share;
    part.share = (double)counts[i] / sum;
    SporeProgress inner = spore_progress_of_share(&part);
    if (!spore_generators[measurement->source->options.kind]->error_of(measurement->source, counts[i], &found, &inner,
                                                                       error))
      return FALSE;
    measured(measurement, i, found);
  }
  return TRUE;
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
  SporeGenerateOptions by_number = spore_generate_by_number(options);
  SporeGenerateWork *source = spore_generate_work_new(document, body, &by_number, error);
  if (!source) return FALSE;
  spore_series_clear(self);
  self->measurement = g_atomic_rc_box_new0(Measurement);
  self->measurement->source = source;
  g_mutex_init(&self->measurement->mutex);
  self->job = spore_job_start(_("Measuring numbers"), run, g_atomic_rc_box_acquire(self->measurement),
                              unref_measurement, done, G_OBJECT(self));
  g_signal_connect_object(self->job, "progressed", G_CALLBACK(tell), self, G_CONNECT_SWAPPED);
  tell(self);
  return TRUE;
}

gboolean spore_series_is_of(SporeSeries *self, SporeDocument *document, SporeObject *body,
                            const SporeGenerateOptions *options) {
  if (!self->measurement) return TRUE;
  const SporeGenerateWork *source = self->measurement->source;
  return body && spore_generate_differ_by_number(&source->options, options) &&
         spore_generate_work_body(source, document) == body;
}

gboolean spore_series_is_running(SporeSeries *self) { return self->job != NULL; }

gsize spore_series_get_points(SporeSeries *self, size_t counts[SPORE_SERIES_POINTS],
                              double errors[SPORE_SERIES_POINTS]) {
  if (!self->measurement) return 0;
  g_mutex_lock(&self->measurement->mutex);
  gsize count = self->measurement->measured;
  memcpy(errors, self->measurement->errors, count * sizeof *errors);
  g_mutex_unlock(&self->measurement->mutex);
  memcpy(counts, type_of(self->measurement)->counts, count * sizeof *counts);
  return count;
}

size_t spore_series_get_enough(SporeSeries *self) {
  size_t counts[SPORE_SERIES_POINTS];
  double errors[SPORE_SERIES_POINTS];
  gsize count = spore_series_get_points(self, counts, errors);
  size_t enough = count < 2 ? count : spore_enough(counts, errors, count, type_of(self->measurement)->worth);
  return enough < count ? counts[enough] : 0;
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
