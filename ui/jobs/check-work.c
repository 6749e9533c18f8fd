#include "ui/jobs/check-work.h"

SporeCheckWork *spore_check_work_new(const SporeDocument *document) {
  SporeCheckWork *work = g_new0(SporeCheckWork, 1);
  work->document = spore_document_copy(document);
  work->revision = spore_document_revision(document);
  return work;
}

gboolean spore_check_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeCheckWork *work = data;
  work->found = spore_document_check(work->document);
  return TRUE;
}

void spore_check_work_free(gpointer data) {
  SporeCheckWork *work = data;
  g_clear_pointer(&work->found, g_ptr_array_unref);
  spore_document_free(work->document);
  g_free(work);
}
