/* Marked bodies of a scene, as a file with a name on each line. */
#include "ui/document/kept-bodies.h"

#include <errno.h>
#include <glib/gi18n.h>
#include <glib/gstdio.h>

#include "core/scene/error.h"
#include "ui/document/scene-place.h"

#define FOLDER_MODE 0700

GPtrArray *spore_kept_bodies_read(const char *scene, const char *mark, const SporeDocument *document) {
  GPtrArray *bodies = g_ptr_array_new();
  g_autofree char *file = spore_scene_place(scene, mark, ".txt"), *text = NULL;
  if (!g_file_get_contents(file, &text, NULL, NULL)) return bodies;
  g_auto(GStrv) names = g_strsplit(text, "\n", -1);
  for (char **name = names; *name; name++) {
    SporeObject *body = **name ? spore_document_find(document, "body", *name) : NULL;
    if (body) g_ptr_array_add(bodies, body);
  }
  return bodies;
}

gboolean spore_kept_bodies_write(const char *scene, const char *mark, const SporeDocument *document, GHashTable *marked,
                                 GError **error) {
  const SporeObject *bodies = spore_document_section(document, "bodies");
  g_autofree char *file = spore_scene_place(scene, mark, ".txt"), *folder = g_path_get_dirname(file);
  g_autoptr(GString) text = g_string_new(NULL);
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const SporeObject *body = spore_object_child(bodies, i);
    if (g_hash_table_contains(marked, GUINT_TO_POINTER(spore_object_id(body))))
      g_string_append_printf(text, "%s\n", spore_object_name(body));
  }
  if (text->len == 0) return g_unlink(file) == 0 || errno == ENOENT;
  g_autoptr(GError) fault = NULL;
  if (g_mkdir_with_parents(folder, FOLDER_MODE) == 0 && g_file_set_contents(file, text->str, -1, &fault)) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, file,
                           _("%s; what is locked or hidden is not kept; make room, or free the folder"),
                           fault ? fault->message : g_strerror(errno));
}
