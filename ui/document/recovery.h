/* Unsaved work: a folder for each window under $XDG_STATE_HOME/spore/recovery. The owner locks the folder as long as it
 * runs. No GTK. */
#ifndef SPORE_UI_DOCUMENT_RECOVERY_H
#define SPORE_UI_DOCUMENT_RECOVERY_H

#include "ui/document/spore-editor-document.h"

typedef struct SporeRecovery SporeRecovery;
SporeRecovery *spore_recovery_new(void);
/* Forgets what was kept. */
void spore_recovery_free(SporeRecovery *recovery);
/* Keeps a copy of the document with its assets. Forgets the copy when nothing is unsaved. Cheap when nothing has
 * changed. */
gboolean spore_recovery_keep(SporeRecovery *recovery, SporeEditorDocument *document, GError **error);
void spore_recovery_forget(SporeRecovery *recovery);
/* Continues in the folder of a leftover whose scene was opened. */
void spore_recovery_adopt(SporeRecovery *recovery, const char *folder);

/* Work that was left by a program which has ended. */
typedef struct SporeLeftover {
  char *folder, *scene;
  char *original; /* file it was made from, NULL: it was never saved */
  gint64 kept_s;  /* when it was kept last, since 1970 */
} SporeLeftover;
/* The newest that lies in none of these folders (of char *); NULL: none. */
SporeLeftover *spore_leftover_find(const GPtrArray *passed_over);
void spore_leftover_remove(const SporeLeftover *leftover);
void spore_leftover_free(SporeLeftover *leftover);

#endif
