/* Deletes objects. What else goes is found by what names them. */
#include "core/author/removal.h"

#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/author/placement.h"
#include "core/scene/compile.h"

static gboolean is_instrument(const SporeObject *body) {
  return g_str_equal(spore_object_type(body)->element, "body") &&
         (SporeRole)spore_object_number(body, "role") == SPORE_ACTIVE;
}

/* The body, of an instrument all its bodies; of SporeObject *. */
static GPtrArray *bodies_with(SporeDocument *document, SporeObject *body) {
  g_autoptr(GPtrArray) one = g_ptr_array_new();
  g_ptr_array_add(one, body);
  if (!is_instrument(body)) return g_steal_pointer(&one);
  g_autoptr(SporePlacement) placement = spore_placement_new(document, one);
  return spore_placement_bodies(placement);
}

static gboolean names_any(const SporeObject *object, const GPtrArray *targets) {
  for (guint i = 0; i < targets->len; i++)
    if (spore_object_refers_to(object, targets->pdata[i])) return TRUE;
  return FALSE;
}

/* Removes what names one of the bodies. */
static gboolean remove_of_section(SporeDocument *document, const char *element, const GPtrArray *bodies,
                                  GError **error) {
  const SporeObject *section = spore_document_section(document, element);
  for (guint i = spore_object_child_count(section); i > 0; i--) {
    SporeObject *object = spore_object_child(section, i - 1);
    if (names_any(object, bodies) && !spore_document_remove(document, object, error)) return FALSE;
  }
  return TRUE;
}

/* Assets that the object and its units name. */
static void add_assets(const SporeObject *object, GPtrArray *assets) {
  for (guint i = 0; i < spore_object_type(object)->table->count; i++) {
    SporeObject *named = spore_object_asset(object, i);
    if (named && !g_ptr_array_find(assets, named, NULL)) g_ptr_array_add(assets, named);
  }
  for (guint i = 0; i < spore_object_child_count(object); i++) add_assets(spore_object_child(object, i), assets);
}

static gboolean remove_bodies(SporeDocument *document, const GPtrArray *bodies, gboolean instrument, GError **error) {
  g_autoptr(GPtrArray) assets = g_ptr_array_new();
  if (!remove_of_section(document, "links", bodies, error) || !remove_of_section(document, "effects", bodies, error) ||
      (instrument && !remove_of_section(document, "tools", bodies, error)))
    return FALSE;
  for (guint i = 0; i < bodies->len; i++) {
    if (instrument) add_assets(bodies->pdata[i], assets);
    if (!spore_document_remove(document, bodies->pdata[i], error)) return FALSE;
  }
  for (guint i = 0; i < assets->len; i++)
    if (!spore_edit_is_used(document, assets->pdata[i]) && !spore_document_remove(document, assets->pdata[i], error))
      return FALSE;
  return TRUE;
}

static gboolean remove_object(SporeDocument *document, SporeObject *object, GError **error) {
  if (!g_str_equal(spore_object_type(object)->element, "body")) return spore_document_remove(document, object, error);
  g_autoptr(GPtrArray) bodies = bodies_with(document, object);
  return remove_bodies(document, bodies, is_instrument(object), error);
}

gboolean spore_edit_delete(SporeDocument *document, const GArray *ids, GError **error) {
  gboolean done = TRUE;
  spore_document_begin(document, _("Delete"));
  for (guint i = 0; done && i < ids->len; i++) {
    SporeObject *object = spore_document_by_id(document, g_array_index(ids, guint32, i));
    if (object && spore_object_name(object)) done = remove_object(document, object, error);
  }
  return spore_edit_finish(document, done);
}
