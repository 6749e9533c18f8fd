/* Moves objects within the list of their section, and bodies between folders. */
#include "core/author/order_edits.h"

#include <glib/gi18n.h>

#include "core/author/edits.h"

static guint index_of(const SporeObject *object) {
  const SporeObject *parent = spore_object_parent(object);
  guint index = 0;
  while (spore_object_child(parent, index) != object) index++;
  return index;
}

static int by_index(gconstpointer a, gconstpointer b) {
  guint first = index_of(*(SporeObject *const *)a), second = index_of(*(SporeObject *const *)b);
  return first < second ? -1 : first > second;
}

/* The objects in the order of the scene; NULL with an error: one of them belongs elsewhere. g_ptr_array_unref. */
static GPtrArray *siblings(SporeDocument *document, const GArray *ids, const SporeObject *target, GError **error) {
  g_autoptr(GPtrArray) objects = g_ptr_array_new();
  for (guint i = 0; i < ids->len; i++) {
    SporeObject *object = spore_document_by_id(document, g_array_index(ids, guint32, i));
    if (!object || spore_object_parent(object) != spore_object_parent(target)) {
      spore_error_raise(error, SPORE_ERROR_INPUT, spore_object_name(target), "%s",
                        _("only what belongs to one list can be ordered there; choose things of one kind"));
      return NULL;
    }
    g_ptr_array_add(objects, object);
  }
  g_ptr_array_sort(objects, by_index);
  return g_steal_pointer(&objects);
}

/* The place is that of the list without the object. */
static gboolean put(SporeDocument *document, SporeObject *object, const SporeObject *beside, gboolean after,
                    GError **error) {
  guint from = index_of(object), to = index_of(beside);
  if (from < to) to--;
  return spore_document_move(document, object, spore_object_parent(object), to + (after ? 1 : 0), error);
}

/* Each stands behind the one before it, the first one beside the target. */
static gboolean reorder(SporeDocument *document, const GPtrArray *objects, SporeObject *target, gboolean after,
                        GError **error) {
  SporeObject *beside = target;
  for (guint i = 0; i < objects->len; i++) {
    SporeObject *object = objects->pdata[i];
    if (object != beside && !put(document, object, beside, after || i > 0, error)) return FALSE;
    beside = object;
  }
  return TRUE;
}

gboolean spore_edit_reorder(SporeDocument *document, const GArray *ids, SporeObject *target, gboolean after,
                            GError **error) {
  g_autoptr(GPtrArray) objects = siblings(document, ids, target, error);
  if (!objects) return FALSE;
  spore_document_begin(document, _("Change the order"));
  return spore_edit_finish(document, reorder(document, objects, target, after, error));
}

/* Folders. */

const char *spore_folder_of(const SporeObject *object) {
  if (spore_parameter_find(spore_object_type(object)->table, "folder") < 0) return NULL;
  const char *folder = spore_object_text(object, "folder");
  return folder && *folder ? folder : NULL;
}

static gboolean has_folder(SporeDocument *document, const char *folder) {
  const SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    if (g_strcmp0(spore_folder_of(spore_object_child(bodies, i)), folder) == 0) return TRUE;
  return FALSE;
}

char *spore_folder_new_name(SporeDocument *document) {
  char *name = g_strdup(_("Folder"));
  for (guint i = 2; has_folder(document, name); i++) {
    g_free(name);
    name = g_strdup_printf("%s %u", _("Folder"), i);
  }
  return name;
}

static gboolean put_in(SporeDocument *document, SporeObject *object, const char *folder, GError **error) {
  int property = spore_parameter_find(spore_object_type(object)->table, "folder");
  if (property < 0) return TRUE;
  return folder && *folder ? spore_document_set_text(document, object, "folder", folder, error)
                           : spore_document_unset(document, object, (guint)property, error);
}

static gboolean put_all_in(SporeDocument *document, const GArray *ids, const char *folder, GError **error) {
  for (guint i = 0; i < ids->len; i++) {
    SporeObject *object = spore_document_by_id(document, g_array_index(ids, guint32, i));
    if (object && !put_in(document, object, folder, error)) return FALSE;
  }
  return TRUE;
}

gboolean spore_edit_put_in_folder(SporeDocument *document, const GArray *ids, const char *folder, GError **error) {
  spore_document_begin(document, folder ? _("Put into a folder") : _("Take out of the folder"));
  return spore_edit_finish(document, put_all_in(document, ids, folder, error));
}

gboolean spore_edit_rename_folder(SporeDocument *document, const char *folder, const char *name, GError **error) {
  const SporeObject *bodies = spore_document_section(document, "bodies");
  g_autoptr(GArray) ids = g_array_new(FALSE, FALSE, sizeof(guint32));
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const SporeObject *body = spore_object_child(bodies, i);
    guint32 id = spore_object_id(body);
    if (g_strcmp0(spore_folder_of(body), folder) == 0) g_array_append_val(ids, id);
  }
  spore_document_begin(document, name ? _("Rename the folder") : _("Take the folder apart"));
  return spore_edit_finish(document, put_all_in(document, ids, name, error));
}
