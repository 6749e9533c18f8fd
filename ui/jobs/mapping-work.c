#include "ui/jobs/mapping-work.h"

#include "core/io/scene_xml.h"

SporeMappingWork *spore_mapping_work_new(const SporeDocument *document, const SporeObject *body, GError **error) {
  SporeDocument *copy = spore_scene_copy(document, error);
  if (!copy) return NULL;
  SporeMappingWork *work = g_new0(SporeMappingWork, 1);
  work->document = copy;
  work->body = g_strdup(spore_object_name(body));
  work->report.body = spore_object_id(body);
  work->report.revision = spore_document_revision(document);
  return work;
}

gboolean spore_mapping_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeMappingWork *work = data;
  SporeObject *body = spore_document_find(work->document, "body", work->body);
  return spore_mapping_report_measure(&work->report, work->document, body, progress, error);
}

void spore_mapping_work_free(gpointer data) {
  SporeMappingWork *work = data;
  spore_mapping_report_clear(&work->report);
  spore_document_free(work->document);
  g_free(work->body);
  g_free(work);
}
