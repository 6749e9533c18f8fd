/* Imports and changes meshes of a scene, each as one undo step. */
#include "core/author/mesh_edits.h"

#include <glib/gi18n.h>

#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/author/edits.h"

GPtrArray *spore_edit_import(SporeDocument *document, const SporeImport *import, GError **error) {
  g_autoptr(GPtrArray) bodies = NULL;
  const SporeImportFile *first = g_ptr_array_index(import->files, 0);
  g_autofree char *base = g_path_get_basename(first->file);
  g_autofree char *label = import->files->len > 1 ? g_strdup_printf(_("Import %u meshes"), import->files->len)
                                                  : g_strdup_printf(_("Import %s"), base);
  spore_document_begin(document, label);
  const gboolean done = spore_edit_finish(document, spore_import_insert(document, import, &bodies, error));
  return done ? g_steal_pointer(&bodies) : NULL;
}

gboolean spore_edit_change_mesh(SporeDocument *document, SporeObject *asset, const char *label, GBytes *content,
                                GError **error) {
  gsize size;
  const char *text = g_bytes_get_data(content, &size);
  g_autofree char *file = spore_content_file_name(spore_object_name(asset), "off", text, size);
  spore_document_put_blob(document, file, content);
  spore_document_begin(document, label);
  gboolean done = spore_document_set_text(document, asset, "file", file, error) &&
                  spore_document_set_text(document, asset, "unit", spore_length_units[0], error) &&
                  spore_document_set_text(document, asset, "frame", spore_mesh_frames[0], error);
  return spore_edit_finish(document, done);
}
