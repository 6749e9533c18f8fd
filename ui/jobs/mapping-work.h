/* How well what a body carries along follows it, measured for a SporeJob. No GTK. */
#ifndef SPORE_UI_JOBS_MAPPING_WORK_H
#define SPORE_UI_JOBS_MAPPING_WORK_H

#include "core/base/progress.h"
#include "ui/document/mapping-report.h"

typedef struct SporeMappingWork {
  SporeDocument *document;   /* a copy of the scene, the worker's own */
  SporeMappingReport report; /* out, of the body and the revision that it began with; taken by setting it to zero */
} SporeMappingWork;
SporeMappingWork *spore_mapping_work_new(const SporeDocument *document, const SporeObject *body);
gboolean spore_mapping_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_mapping_work_free(gpointer work);

#endif
