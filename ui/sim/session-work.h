/* What may take long in the life of a session, apart from the GTK thread: its making, as data for a SporeJob, and its
 * end. Both count as under way (ui/jobs/under-way.h). No GTK. */
#ifndef SPORE_UI_SIM_SESSION_WORK_H
#define SPORE_UI_SIM_SESSION_WORK_H

#include "core/base/progress.h"
#include "ui/sim/session.h"

typedef struct SporeSessionWork {
  SporeDocument *document; /* a copy of the scene, the worker's own */
  char *repeated;          /* file with the input of an attempt to repeat; NULL: none */
  SporeSession *session;   /* out; taken by setting it to NULL */
} SporeSessionWork;

SporeSessionWork *spore_session_work_new(const SporeDocument *document, const char *repeated);
gboolean spore_session_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_session_work_free(gpointer work);
/* Takes the session and frees it on a thread of its own, since a step under way has to end first. */
void spore_session_retire(SporeSession *session);

#endif
