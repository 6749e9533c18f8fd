/* Writes several files together: all of them, or none. Each is written to a temporary file beside its target and synced
 * before the first one is renamed. A rename that fails takes back the earlier ones. */
#ifndef SPORE_IO_FILE_BATCH_H
#define SPORE_IO_FILE_BATCH_H

#include <glib.h>

#include "core/scene/error.h"

typedef struct SporeFileBatch SporeFileBatch;

SporeFileBatch *spore_file_batch_new(void);

/* Says why the file cannot be written: `fault` is an errno. Returns FALSE. */
gboolean spore_file_refuse(int fault, const char *place, GError **error);
/* Takes back what was not committed. */
void spore_file_batch_free(SporeFileBatch *batch);
/* Takes back what was not committed in all batches, without freeing anything: for a program that ends at once, perhaps
 * for want of memory. */
void spore_file_batches_withdraw(void);
/* The same for a handler of signals: FALSE where a batch is at work just now, and nothing was taken back; try again
 * soon. TRUE: no batch does any work from now on; end the program. */
gboolean spore_file_batches_end(void);

/* Adds a file `name` below the open folder `directory`. The name is a relative path; missing folders are made, and no
 * name leads out of `directory`. An existing file's permissions are kept. `place` begins the message of a failure. */
gboolean spore_file_batch_add(SporeFileBatch *batch, int directory, const char *place, const char *name,
                              const void *content, gsize size, GError **error);
/* Adds the file of that path, whose folder is there. */
gboolean spore_file_batch_add_path(SporeFileBatch *batch, const char *file, const void *content, gsize size,
                                   GError **error);
/* Lets whoever may read the file that was added last run it, too. */
gboolean spore_file_batch_let_run(SporeFileBatch *batch, GError **error);
/* The real target of a file name. Symbolic links are followed, so that they stay links. g_free. */
char *spore_file_target(const char *file);
/* Opens the folder that the file lies in. -1 with the error. */
int spore_file_open_folder(const char *file, GError **error);
/* Renames, in the order added. On failure everything is as before. */
gboolean spore_file_batch_commit(SporeFileBatch *batch, GError **error);

#endif
