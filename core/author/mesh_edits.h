/* What an author does to the meshes of a scene, each one undo step. No GTK. */
#ifndef SPORE_AUTHOR_MESH_EDITS_H
#define SPORE_AUTHOR_MESH_EDITS_H

#include "core/author/organ_import.h"

/* Bodies for what was read in `unit`. Returns the first; NULL with an error: nothing was inserted. */
SporeObject *spore_edit_import(SporeDocument *document, const SporeImport *import, GError **error);

/* The asset holds another mesh from now on: content of an OFF file in m, in SPORE's axes. label: of the step,
 * translated. */
gboolean spore_edit_change_mesh(SporeDocument *document, SporeObject *asset, const char *label, GBytes *content,
                                GError **error);

#endif
