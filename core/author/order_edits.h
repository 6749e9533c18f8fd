/* The order in which a scene lists its objects, and the folders in which its bodies are listed. No GTK. */
#ifndef SPORE_AUTHOR_ORDER_EDITS_H
#define SPORE_AUTHOR_ORDER_EDITS_H

#include "core/scene/document.h"

/* Moves the objects of these ids (of guint32), which belong to the section of the target, to stand just before it
 * (after: just behind it), in the order that they have; one undo step. The target may be one of them. FALSE with a
 * GError: nothing was moved, since one of them belongs elsewhere. */
gboolean spore_edit_reorder(SporeDocument *document, const GArray *ids, SporeObject *target, gboolean after,
                            GError **error);

/* Folder that the object is listed in; NULL: none. Only bodies are in folders. */
const char *spore_folder_of(const SporeObject *object);
/* A folder's name that the scene does not have yet. g_free. */
char *spore_folder_new_name(SporeDocument *document);
/* Puts the bodies among the objects of these ids (of guint32) into a folder; NULL: into none; one undo step. */
gboolean spore_edit_put_in_folder(SporeDocument *document, const GArray *ids, const char *folder, GError **error);
/* Gives a folder another name; NULL: its bodies are listed by themselves again. One undo step. */
gboolean spore_edit_rename_folder(SporeDocument *document, const char *folder, const char *name, GError **error);

#endif
