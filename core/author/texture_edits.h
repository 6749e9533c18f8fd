/* A picture laid over an organ by hand. No GTK. */
#ifndef SPORE_AUTHOR_TEXTURE_EDITS_H
#define SPORE_AUTHOR_TEXTURE_EDITS_H

#include "core/base/progress.h"
#include "core/scene/document.h"

/* A new texture as data, which any thread may make; one thread owns the document. */
typedef struct SporeTextureWork SporeTextureWork;

/* Reads the picture, a PNG or a JPEG of at most 64 MiB. NULL with a GError: the picture cannot be read, or the body
 * shows no mesh. */
SporeTextureWork *spore_texture_work_new(SporeDocument *document, SporeObject *body, const char *file, GError **error);
void spore_texture_work_free(gpointer work);
/* Finds where the corners of the mesh lie in the picture: the places that the body has already, or those that the file
 * of its mesh gives (UV). FALSE with a GError: there are none, no picture can be drawn of the file, or cancelled. */
gboolean spore_texture_work_run(gpointer work, const SporeProgress *progress, GError **error);
/* Lays the picture over the body, as one undo step; a body that wore none gets white, the colour that the picture is
 * multiplied by. FALSE with a GError: nothing was changed; the mesh is another one by now. */
gboolean spore_texture_work_apply(const SporeTextureWork *work, SporeDocument *document, GError **error);

#endif
