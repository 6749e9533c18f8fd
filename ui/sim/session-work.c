/* Makes and frees sessions on threads of their own. */
#include "ui/sim/session-work.h"

#include "ui/document/attempts.h"
#include "ui/jobs/under-way.h"

#define MOST_THREADS 8

SporeSessionWork *spore_session_work_new(const SporeDocument *document, const char *repeated) {
  SporeSessionWork *work = g_new0(SporeSessionWork, 1);
  work->document = spore_document_copy(document);
  work->repeated = g_strdup(repeated);
  spore_work_begin();
  return work;
}

static bool is_cancelled(void *data) { return !spore_progress(data, 0, NULL); }

gboolean spore_session_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeSessionWork *work = data;
  const SporeCancel cancel = {is_cancelled, (void *)(guintptr)progress};
  int threads = (int)CLAMP(g_get_num_processors() / 2, 1, MOST_THREADS);
  SporeTrack *input = work->repeated ? spore_attempts_read_track(work->repeated, error) : NULL;
  if (work->repeated && !input) return FALSE;
  work->session = spore_session_new(work->document, threads, input, &cancel, error);
  if (work->session && input) spore_session_repeat(work->session, g_steal_pointer(&input));
  spore_input_free(input);
  return work->session != NULL;
}

/* The session too where nobody took it. */
void spore_session_work_free(gpointer data) {
  SporeSessionWork *work = data;
  spore_session_free(work->session);
  spore_document_free(work->document);
  g_free(work->repeated);
  g_free(work);
  spore_work_end();
}

static gpointer free_session(gpointer session) {
  spore_session_free(session);
  spore_work_end();
  return NULL;
}

void spore_session_retire(SporeSession *session) {
  spore_work_begin();
  GThread *thread = g_thread_try_new("end of a run", free_session, session, NULL);
  if (thread) g_thread_unref(thread);
  else free_session(session);
}
