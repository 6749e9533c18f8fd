/* Something that is found for the scene by a job and then applied: two buttons, the job, and what was found in words.
 * What was found can be applied to the scene that it was found for alone. */
#ifndef SPORE_UI_PANELS_SPORE_FINDING_H
#define SPORE_UI_PANELS_SPORE_FINDING_H

#include <gtk/gtk.h>

#include "ui/document/spore-editor-document.h"
#include "ui/jobs/spore-job.h"

G_BEGIN_DECLS

#define SPORE_TYPE_FINDING spore_finding_get_type()
G_DECLARE_FINAL_TYPE(SporeFindingBox, spore_finding, SPORE, FINDING, GtkBox)

/* A kind of finding. Texts are not translated yet. */
typedef struct SporeFindingKind {
  const char *find, *find_hint, *apply, *apply_hint; /* labels and tooltips of the buttons */
  const char *job, *under_way, *cancelled;           /* what is said meanwhile, and when it was cancelled */
  /* The data of the job: a copy of the scene. data: of spore_finding_new. */
  gpointer (*work_new)(const SporeDocument *document, gpointer data);
  SporeJobWork work_run;
  GDestroyNotify work_free;
  gpointer (*take)(gpointer work); /* out of a work that was done; what was found */
  GDestroyNotify found_free;
  char *(*describe)(gconstpointer found); /* g_free */
  gboolean (*applies)(gconstpointer found, SporeDocument *document);
  gboolean (*apply_to)(gconstpointer found, SporeDocument *document, GError **error); /* one step of undo */
} SporeFindingKind;

/* kind and data outlive it. */
GtkWidget *spore_finding_new(const SporeFindingKind *kind, gpointer data);
void spore_finding_set_document(SporeFindingBox *self, SporeEditorDocument *document);

G_END_DECLS
#endif
