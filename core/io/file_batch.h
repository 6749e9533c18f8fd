/* Several files written together: all of them, or none. Each goes to a temporary file beside its target and is synced
 * before the first one is renamed; a rename that fails takes back those before it. */
#ifndef SPORE_IO_FILE_BATCH_H
#define SPORE_IO_FILE_BATCH_H

#include <glib.h>

#include "core/scene/error.h"

typedef struct SporeFileBatch SporeFileBatch;

SporeFileBatch *spore_file_batch_new(void);
/* Takes back what was not committed. */
void spore_file_batch_free(SporeFileBatch *batch);

/* A file `name` (a relative path, its folders made where they are missing, never left) below the open folder
 * `directory`; keeps the permissions of the file that is there. `place` begins the message of a failure. */
gboolean spore_file_batch_add(SporeFileBatch *batch, int directory, const char *place, const char *name,
                              const void *content, gsize size, GError **error);
/* Renames, in the order added. On failure everything is as before. */
gboolean spore_file_batch_commit(SporeFileBatch *batch, GError **error);

#endif
