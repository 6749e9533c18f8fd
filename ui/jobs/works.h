/* Long works of the editor, as data for a SporeJob: input and output. No GTK. */
#ifndef SPORE_UI_JOBS_WORKS_H
#define SPORE_UI_JOBS_WORKS_H

#include "core/base/progress.h"
#include "core/author/generator_work.h"
#include "core/scene/check.h"
#include "core/scene/document.h"
#include "ui/document/mapping-report.h"

/* Reads a scene and decodes its assets. */
typedef struct SporeOpenWork {
  const SporeSchema *schema;
  char *file;
  char *original; /* of a recovered scene, or NULL */
  gboolean recovered, untitled;
  SporeDocument *document; /* out; taken by setting it to NULL */
} SporeOpenWork;
SporeOpenWork *spore_open_work_new(const SporeSchema *schema, const char *file);
gboolean spore_open_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_open_work_free(gpointer work);

/* Measures how well the sphere set of a SporeGenerateWork fits its mesh. */
gboolean spore_measure_work_run(gpointer work, const SporeProgress *progress, GError **error);

/* Checks a scene. */
typedef struct SporeCheckWork {
  SporeDocument *document; /* a copy of the scene, the worker's own */
  guint64 revision;        /* of the scene then */
  GPtrArray *found;        /* out: of SporeDiagnostic *; taken by setting it to NULL */
} SporeCheckWork;
SporeCheckWork *spore_check_work_new(const SporeDocument *document);
gboolean spore_check_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_check_work_free(gpointer work);

/* Measures how far what is drawn of a body, and its spheres, lies off where the body moves it. */
typedef struct SporeMappingWork {
  SporeDocument *document;   /* a copy of the scene, the worker's own */
  SporeMappingReport report; /* out, of the body and the revision that it began with; taken by setting it to zero */
} SporeMappingWork;
SporeMappingWork *spore_mapping_work_new(const SporeDocument *document, const SporeObject *body);
gboolean spore_mapping_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_mapping_work_free(gpointer work);

#endif
