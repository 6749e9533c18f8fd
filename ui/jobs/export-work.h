/* An export of a scene, as data for a SporeJob. It counts as under way (ui/jobs/under-way.h). No GTK. */
#ifndef SPORE_UI_JOBS_EXPORT_WORK_H
#define SPORE_UI_JOBS_EXPORT_WORK_H

#include "ui/export/export.h"

typedef struct SporeExportWork {
  SporeDocument *document; /* a copy of the scene, the worker's own */
  const SporeExportFormat *format;
  char *output;
  SporeTrack *input;  /* owned; NULL: the scene's own */
  SporeExport export; /* out: what came of it */
} SporeExportWork;

/* time_s and every_s count where the format shows moments of a run: rounded to whole steps; every_s 0: the end alone.
 * Takes the input. */
SporeExportWork *spore_export_work_new(const SporeDocument *document, const SporeExportFormat *format,
                                       const char *output, SporeTrack *input, double time_s, double every_s);
gboolean spore_export_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_export_work_free(gpointer work);
/* The report in words, with markup. g_free. */
char *spore_export_work_report(const SporeExportWork *work);

#endif
