#include "ui/jobs/mapping-work.h"

SporeMappingWork *spore_mapping_work_new(const SporeDocument *document, const SporeObject *body) {
  SporeMappingWork *work = g_new0(SporeMappingWork, 1);
  work->document = spore_document_copy(document);
  work->report.body = spore_object_id(body);
  work->report.revision = spore_document_revision(document);
  return work;
}

gboolean spore_mapping_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeMappingWork *work = data;
  SporeObject *body = spore_document_by_id(work->document, work->report.body);
  return spore_mapping_report_measure(&work->report, work->document, body, progress, error);
}

void spore_mapping_work_free(gpointer data) {
  SporeMappingWork *work = data;
  spore_mapping_report_clear(&work->report);
  spore_document_free(work->document);
  g_free(work);
}
