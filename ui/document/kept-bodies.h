/* Which bodies of a scene are marked in the view, kept in the user's data folder for the next time that the scene is
 * opened: how the user works on a scene is no part of it. No GTK. */
#ifndef SPORE_UI_DOCUMENT_KEPT_BODIES_H
#define SPORE_UI_DOCUMENT_KEPT_BODIES_H

#include "core/scene/document.h"

/* The marks, each of which has a file of its own. */
#define SPORE_KEPT_LOCKED "locks"
#define SPORE_KEPT_HIDDEN "hidden"

/* The bodies of the document that were marked when the scene's file was worked on last: of SporeObject *, borrowed. A
 * body that has another name since is not among them. */
GPtrArray *spore_kept_bodies_read(const char *scene, const char *mark, const SporeDocument *document);
/* Keeps these (ids as pointers) for the scene's file. FALSE with a GError: the file cannot be written. */
gboolean spore_kept_bodies_write(const char *scene, const char *mark, const SporeDocument *document, GHashTable *marked,
                                 GError **error);

#endif
