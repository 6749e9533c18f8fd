/* Long work apart from the GTK thread: progress to read, and cancel.
 *
 * Signals
 *   progressed ()   fraction or stage may have changed; on the GTK thread, at most ten times a second
 *   finished ()     after `done` was called                                                                         */
#ifndef SPORE_UI_JOBS_SPORE_JOB_H
#define SPORE_UI_JOBS_SPORE_JOB_H

#include <gio/gio.h>

#include "core/base/progress.h"

G_BEGIN_DECLS

#define SPORE_TYPE_JOB spore_job_get_type()
G_DECLARE_FINAL_TYPE(SporeJob, spore_job, SPORE, JOB, GObject)

/* On a worker thread; touches nothing but `work_data`. */
typedef gboolean (*SporeJobWork)(gpointer work_data, const SporeProgress *progress, GError **error);
/* On the GTK thread; error NULL: done; SPORE_ERROR_CANCELLED: the user stopped it, and work_data is NULL, since the
 * worker may still have it. */
typedef void (*SporeJobDone)(SporeJob *job, gpointer work_data, const GError *error, gpointer owner);

/* Starts at once. title: translated. work_data is freed by `free_data` when both sides are through. `owner` is kept
 * alive until `done` was called. Free the job with g_object_unref at any time; that does not stop it. */
SporeJob *spore_job_start(const char *title, SporeJobWork work, gpointer work_data, GDestroyNotify free_data,
                          SporeJobDone done, GObject *owner);
/* `done` follows at once, from the main loop; the worker ends when it notices. */
void spore_job_cancel(SporeJob *self);
gboolean spore_job_is_running(SporeJob *self);
const char *spore_job_get_title(SporeJob *self);
double spore_job_get_fraction(SporeJob *self);
/* A number that changes whenever the look of the work changes. */
guint spore_job_get_look_serial(SporeJob *self);
/* The look of the work so far: *count x 4 numbers (x y z r); NULL: none. g_free. */
double *spore_job_get_look(SporeJob *self, gsize *count);
char *spore_job_get_stage(SporeJob *self); /* g_free; "" when not stated */

G_END_DECLS
#endif
