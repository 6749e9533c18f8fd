/* Progress of a job, and a button that cancels the job. Hidden while there is none. */
#ifndef SPORE_UI_PANELS_SPORE_JOB_BAR_H
#define SPORE_UI_PANELS_SPORE_JOB_BAR_H

#include <gtk/gtk.h>

#include "ui/jobs/spore-job.h"

G_BEGIN_DECLS

#define SPORE_TYPE_JOB_BAR spore_job_bar_get_type()
G_DECLARE_FINAL_TYPE(SporeJobBar, spore_job_bar, SPORE, JOB_BAR, GtkBox)

/* NULL: none any more. */
void spore_job_bar_set_job(SporeJobBar *self, SporeJob *job);

G_END_DECLS
#endif
