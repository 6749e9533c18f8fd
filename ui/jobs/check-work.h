/* Checks a scene for a SporeJob. No GTK. */
#ifndef SPORE_UI_JOBS_CHECK_WORK_H
#define SPORE_UI_JOBS_CHECK_WORK_H

#include "core/base/progress.h"
#include "core/scene/check.h"

typedef struct SporeCheckWork {
  SporeDocument *document; /* a copy of the scene, the worker's own */
  guint64 revision;        /* of the scene then */
  GPtrArray *found;        /* out: of SporeDiagnostic *; taken by setting it to NULL */
} SporeCheckWork;
SporeCheckWork *spore_check_work_new(const SporeDocument *document);
gboolean spore_check_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_check_work_free(gpointer work);

#endif
