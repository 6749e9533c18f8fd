/* Which bodies of a scene are locked in the view, kept in the user's data folder for the next time that the scene is
 * opened: how the user works on a scene is no part of it. No GTK. */
#ifndef SPORE_UI_DOCUMENT_LOCKS_H
#define SPORE_UI_DOCUMENT_LOCKS_H

#include "core/scene/document.h"

/* The bodies of the document that were locked when the scene's file was worked on last: of SporeObject *, borrowed. A
 * body that has another name since is not among them. */
GPtrArray *spore_locks_read(const char *scene, const SporeDocument *document);
/* Keeps these (ids as pointers) for the scene's file. FALSE with a GError: the file cannot be written. */
gboolean spore_locks_keep(const char *scene, const SporeDocument *document, GHashTable *locked, GError **error);

#endif
