/* Edits of the meshes of a scene, each one undo step. No GTK. */
#ifndef SPORE_AUTHOR_MESH_EDITS_H
#define SPORE_AUTHOR_MESH_EDITS_H

#include "core/author/organ_import.h"

/* Inserts bodies for an import. Returns the bodies, of SporeObject *, one or more (g_ptr_array_unref); NULL with an
 * error: nothing was inserted. */
GPtrArray *spore_edit_import(SporeDocument *document, const SporeImport *import, GError **error);

/* Replaces the mesh of an asset by the content of an OFF file, in m and in SPORE's axes. label: name of the undo step,
 * translated. */
gboolean spore_edit_change_mesh(SporeDocument *document, SporeObject *asset, const char *label, GBytes *content,
                                GError **error);

#endif
