/* Long works of the editor, as data that a SporeJob takes along: what goes in, what comes out. No GTK. */
#ifndef SPORE_UI_JOBS_WORKS_H
#define SPORE_UI_JOBS_WORKS_H

#include "core/base/progress.h"
#include "core/author/generator_work.h"
#include "core/scene/document.h"

/* Reads a scene and decodes its assets. */
typedef struct SporeOpenWork {
  const SporeSchema *schema;
  char *file;
  char *original; /* of a recovered scene, or NULL */
  gboolean recovered;
  SporeDocument *document; /* out; taken by setting it to NULL */
} SporeOpenWork;
SporeOpenWork *spore_open_work_new(const SporeSchema *schema, const char *file);
gboolean spore_open_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_open_work_free(gpointer work);

gboolean spore_measure_work_run(gpointer work, const SporeProgress *progress, GError **error);

#endif
