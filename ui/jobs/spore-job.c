/* Long work on a thread of its own, with progress and cancelling. */
#include "ui/jobs/spore-job.h"

#include "core/scene/error.h"
#include "ui/jobs/loop-gaps.h"

#define PROGRESS_INTERVAL_MS 100

struct _SporeJob {
  GObject parent;
  char *title;
  GCancellable *cancellable;
  SporeJobWork work;
  SporeJobDone done;
  GObject *owner;
  gboolean running;
  guint timer;

  GMutex mutex; /* over what the worker reports */
  double fraction;
  char stage[128];
  double *look; /* look_count x 4, or NULL */
  gsize look_count;
  guint look_serial;
};

G_DEFINE_FINAL_TYPE(SporeJob, spore_job, G_TYPE_OBJECT)

enum { PROGRESSED, FINISHED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

static void spore_job_finalize(GObject *object) {
  SporeJob *self = SPORE_JOB(object);
  g_free(self->title);
  g_free(self->look);
  g_clear_object(&self->cancellable);
  g_mutex_clear(&self->mutex);
  G_OBJECT_CLASS(spore_job_parent_class)->finalize(object);
}

static void spore_job_class_init(SporeJobClass *class) {
  GType type = G_TYPE_FROM_CLASS(class);
  G_OBJECT_CLASS(class)->finalize = spore_job_finalize;
  signals[PROGRESSED] = g_signal_new("progressed", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
  signals[FINISHED] = g_signal_new("finished", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
}

static void spore_job_init(SporeJob *self) {
  g_mutex_init(&self->mutex);
  self->cancellable = g_cancellable_new();
}

static bool report(void *data, double fraction, const char *stage) {
  SporeJob *self = data;
  g_mutex_lock(&self->mutex);
  self->fraction = CLAMP(fraction, 0, 1);
  if (stage) g_strlcpy(self->stage, stage, sizeof self->stage);
  g_mutex_unlock(&self->mutex);
  return !g_cancellable_is_cancelled(self->cancellable);
}

static void show(void *data, const double *spheres, size_t count) {
  SporeJob *self = data;
  double *look = g_memdup2(spheres, 4 * count * sizeof *spheres);
  g_mutex_lock(&self->mutex);
  g_free(self->look);
  self->look = look;
  self->look_count = count;
  self->look_serial++;
  g_mutex_unlock(&self->mutex);
}

static void run(GTask *task, gpointer source, gpointer data, GCancellable *cancellable) {
  SporeJob *self = source;
  SporeProgress progress = {report, self, show};
  GError *error = NULL;
  if (self->work(data, &progress, &error)) g_task_return_boolean(task, TRUE);
  else g_task_return_error(task, error);
}

static void finish(SporeJob *self, gpointer data, const GError *error) {
  self->running = FALSE;
  spore_gaps_leave(self->title);
  g_clear_handle_id(&self->timer, g_source_remove);
  self->done(self, data, error, self->owner);
  g_signal_emit(self, signals[FINISHED], 0);
  g_clear_object(&self->owner);
}

static void ended(GObject *source, GAsyncResult *result, gpointer user_data) {
  SporeJob *self = SPORE_JOB(source);
  g_autoptr(GError) error = NULL;
  g_task_propagate_boolean(G_TASK(result), &error);
  /* After a cancel, the result is not used. */
  if (!g_cancellable_is_cancelled(self->cancellable)) finish(self, g_task_get_task_data(G_TASK(result)), error);
}

static gboolean cancelled(gpointer data) {
  SporeJob *self = data;
  g_autoptr(GError) error = NULL;
  spore_error_raise(&error, SPORE_ERROR_CANCELLED, "", "cancelled");
  finish(self, NULL, error);
  return G_SOURCE_REMOVE;
}

static gboolean tick(gpointer data) {
  g_signal_emit(data, signals[PROGRESSED], 0);
  return G_SOURCE_CONTINUE;
}

SporeJob *spore_job_start(const char *title, SporeJobWork work, gpointer work_data, GDestroyNotify free_data,
                          SporeJobDone done, GObject *owner) {
  SporeJob *self = g_object_new(SPORE_TYPE_JOB, NULL);
  self->title = g_strdup(title);
  self->work = work;
  self->done = done;
  self->owner = g_object_ref(owner);
  self->running = TRUE;
  spore_gaps_enter(self->title);
  self->timer = g_timeout_add(PROGRESS_INTERVAL_MS, tick, self);
  g_autoptr(GTask) task = g_task_new(self, self->cancellable, ended, NULL);
  g_task_set_check_cancellable(task, FALSE);
  g_task_set_task_data(task, work_data, free_data);
  g_task_run_in_thread(task, run);
  return self;
}

/* Whoever waits for the job need not wait until the worker notices the cancel. */
void spore_job_cancel(SporeJob *self) {
  if (!self->running || g_cancellable_is_cancelled(self->cancellable)) return;
  g_cancellable_cancel(self->cancellable);
  g_idle_add_full(G_PRIORITY_HIGH_IDLE, cancelled, g_object_ref(self), g_object_unref);
}

gboolean spore_job_is_running(SporeJob *self) { return self->running; }

const char *spore_job_get_title(SporeJob *self) { return self->title; }

double spore_job_get_fraction(SporeJob *self) {
  g_mutex_lock(&self->mutex);
  double fraction = self->fraction;
  g_mutex_unlock(&self->mutex);
  return fraction;
}

char *spore_job_get_stage(SporeJob *self) {
  g_mutex_lock(&self->mutex);
  char *stage = g_strdup(self->stage);
  g_mutex_unlock(&self->mutex);
  return stage;
}

guint spore_job_get_look_serial(SporeJob *self) {
  g_mutex_lock(&self->mutex);
  guint serial = self->look_serial;
  g_mutex_unlock(&self->mutex);
  return serial;
}

double *spore_job_get_look(SporeJob *self, gsize *count) {
  g_mutex_lock(&self->mutex);
  *count = self->look_count;
  double *look = g_memdup2(self->look, 4 * self->look_count * sizeof *self->look);
  g_mutex_unlock(&self->mutex);
  return look;
}
