/* Makes and frees sessions on threads of their own, and counts them, so that the program can end without any. */
#include "ui/sim/session-work.h"

#define MOST_THREADS 8

/* Sessions that are being made or freed, and results that nobody has taken yet; atomic. */
static int under_way;

static void begin(void) { g_atomic_int_inc(&under_way); }

static void end(void) {
  g_atomic_int_add(&under_way, -1);
  g_main_context_wakeup(NULL);
}

void spore_session_works_wait(void) {
  while (g_atomic_int_get(&under_way) > 0) g_main_context_iteration(NULL, TRUE);
}

/* Counted from here on, and not from when a thread is found for the work. */
SporeSessionWork *spore_session_work_new(const SporeDocument *document) {
  SporeSessionWork *work = g_new0(SporeSessionWork, 1);
  work->document = spore_document_copy(document);
  begin();
  return work;
}

static bool is_cancelled(void *data) { return !spore_progress(data, 0, NULL); }

gboolean spore_session_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeSessionWork *work = data;
  const SporeCancel cancel = {is_cancelled, (void *)(guintptr)progress};
  int threads = (int)CLAMP(g_get_num_processors() / 2, 1, MOST_THREADS);
  work->session = spore_session_new(work->document, threads, NULL, &cancel, error);
  return work->session != NULL;
}

/* The session too where nobody took it. */
void spore_session_work_free(gpointer data) {
  SporeSessionWork *work = data;
  spore_session_free(work->session);
  spore_document_free(work->document);
  g_free(work);
  end();
}

static gpointer free_session(gpointer session) {
  spore_session_free(session);
  end();
  return NULL;
}

void spore_session_retire(SporeSession *session) {
  begin();
  GThread *thread = g_thread_try_new("end of a run", free_session, session, NULL);
  if (thread) g_thread_unref(thread);
  else free_session(session);
}
