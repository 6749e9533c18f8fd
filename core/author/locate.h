/* Files that a scene names and that are not at their place: meshes, pictures, recordings. They are found again where
 * they lie now. No GTK. */
#ifndef SPORE_AUTHOR_LOCATE_H
#define SPORE_AUTHOR_LOCATE_H

#include "core/base/progress.h"
#include "core/scene/document.h"

/* Names of the missing files as the scene has them, each once, in the order of the scene; of char *. g_ptr_array_unref.
 */
GPtrArray *spore_missing_files(SporeDocument *document);

/* Missing files that are looked for, as data, which any thread may do; one thread owns the document. */
typedef struct SporeLocateWork SporeLocateWork;

/* A missing file that lies elsewhere. */
typedef struct SporeLocatedFile {
  char *missing; /* as the scene names it */
  char *place;   /* where it was found */
  char *refused; /* why it is not taken, translated; NULL: it is taken */
} SporeLocatedFile;

/* missing: as the scene names it; file: where it lies now, which begins messages. */
SporeLocateWork *spore_locate_work_new(SporeDocument *document, const char *missing, const char *file);
void spore_locate_work_free(gpointer work);
/* Reads the file, and every other missing file that lies beside it as it lay in the scene's folder. FALSE with a
 * GError: the scene names no such file or has it, the file cannot be read, is not of the kind, or is not the one that
 * the scene was made with; or cancelled. A file beside it that does not fit is refused by itself. */
gboolean spore_locate_work_run(gpointer work, const SporeProgress *progress, GError **error);
/* What was found, of SporeLocatedFile *. Borrowed. */
const GPtrArray *spore_locate_work_found(const SporeLocateWork *work);
/* The scene uses what was found, as one undo step: a file inside its folder where the file lies, any other as content
 * that is saved with the scene. FALSE with a GError: nothing was changed; a file is not missing any more. */
gboolean spore_locate_work_apply(const SporeLocateWork *work, SporeDocument *document, GError **error);

#endif
