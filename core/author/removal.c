/* Deletes objects. What else goes is found by what names them. */
#include "core/author/removal.h"

#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/author/exercise_edits.h"
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

static void free_along(gpointer data) {
  SporeAlong *along = data;
  g_free(along->path);
  g_free(along->text);
  g_free(along);
}

GPtrArray *spore_along_new(void) { return g_ptr_array_new_with_free_func(free_along); }

/* Notes what will be removed; along NULL: it goes without saying. */
static void note(GPtrArray *along, const SporeObject *object) {
  if (!along) return;
  SporeAlong *noted = g_new(SporeAlong, 1);
  noted->path = spore_object_path(object);
  noted->text = g_strdup_printf("%s %s", _(spore_object_type(object)->label), spore_object_name(object));
  g_ptr_array_add(along, noted);
}

/* Adds what of a section names one of the targets. */
static void add_naming(SporeDocument *document, const char *element, const GPtrArray *targets, GPtrArray *naming) {
  const SporeObject *section = spore_document_section(document, element);
  for (guint i = 0; i < spore_object_child_count(section); i++) {
    SporeObject *object = spore_object_child(section, i);
    if (names_any(object, targets)) g_ptr_array_add(naming, object);
  }
}

/* Assets. */

/* Assets that the object and its units name. */
static void add_assets(const SporeObject *object, GPtrArray *assets) {
  for (guint i = 0; i < spore_object_type(object)->table->count; i++) {
    SporeObject *named = spore_object_asset(object, i);
    if (named && !g_ptr_array_find(assets, named, NULL)) g_ptr_array_add(assets, named);
  }
  for (guint i = 0; i < spore_object_child_count(object); i++) add_assets(spore_object_child(object, i), assets);
}

static SporeObject *source_of(const SporeObject *asset) {
  gboolean made = spore_parameter_find(spore_object_type(asset)->table, "source") >= 0;
  return made ? spore_object_reference(asset, "source") : NULL;
}

/* Assets that were made from this one; NULL: something else uses it, or one of those. g_ptr_array_unref. */
static GPtrArray *made_of(SporeDocument *document, const SporeObject *asset) {
  const SporeObject *root = spore_document_root(document);
  const SporeObject *assets = spore_document_section(document, "assets");
  g_autoptr(GPtrArray) made = g_ptr_array_new();
  for (guint i = 0; i < spore_object_child_count(root); i++) {
    const SporeObject *section = spore_object_child(root, i);
    if (section != assets && spore_object_refers_to(section, asset)) return NULL;
  }
  for (guint i = 0; i < spore_object_child_count(assets); i++) {
    SporeObject *other = spore_object_child(assets, i);
    if (!spore_object_refers_to(other, asset)) continue;
    if (source_of(other) != asset || spore_edit_is_used(document, other)) return NULL;
    g_ptr_array_add(made, other);
  }
  return g_steal_pointer(&made);
}

static gboolean remove_asset(SporeDocument *document, GPtrArray *assets, SporeObject *asset, GPtrArray *along,
                             GError **error) {
  note(along, asset);
  g_ptr_array_remove(assets, asset);
  return spore_document_remove(document, asset, error);
}

/* Removes those of the assets that nothing uses any more, with what was made from them, and then what they were made
 * from. Empties the array of what is removed. */
static gboolean remove_unused(SporeDocument *document, GPtrArray *assets, GPtrArray *along, GError **error) {
  for (guint i = 0; i < assets->len;) {
    SporeObject *asset = assets->pdata[i], *source = source_of(asset);
    g_autoptr(GPtrArray) made = made_of(document, asset);
    if (!made) {
      i++;
      continue;
    }
    g_ptr_array_add(made, asset);
    for (guint k = 0; k < made->len; k++)
      if (!remove_asset(document, assets, made->pdata[k], along, error)) return FALSE;
    if (source && !g_ptr_array_find(assets, source, NULL)) g_ptr_array_add(assets, source);
    i = 0; /* what was kept before may be free now */
  }
  return TRUE;
}

/* Objects. */

/* Steps and metrics that name what goes; who waits for such a step waits for what that waited for. */
static gboolean remove_parts(SporeDocument *document, const GPtrArray *going, GPtrArray *along, GError **error) {
  g_autoptr(GPtrArray) parts = g_ptr_array_new();
  add_naming(document, "exercise", going, parts);
  for (guint i = 0; i < parts->len; i++) {
    note(along, parts->pdata[i]);
    if (!spore_edit_remove_part(document, parts->pdata[i], error)) return FALSE;
  }
  return TRUE;
}

/* going: the bodies of one organ or instrument; gets what goes with them. */
static gboolean remove_bodies(SporeDocument *document, GPtrArray *going, gboolean instrument, gboolean alone,
                              GPtrArray *along, GError **error) {
  g_autoptr(GPtrArray) assets = g_ptr_array_new();
  guint bodies = going->len;
  for (guint i = 0; (instrument || !alone) && i < bodies; i++) add_assets(going->pdata[i], assets);
  add_naming(document, "links", going, going);
  add_naming(document, "effects", going, going);
  if (instrument) add_naming(document, "tools", going, going);
  if (!alone && !remove_parts(document, going, along, error)) return FALSE;
  for (guint i = going->len; i > 0; i--)
    if (!spore_document_remove(document, going->pdata[i - 1], error)) return FALSE;
  return remove_unused(document, assets, instrument ? NULL : along, error);
}

static gboolean remove_object(SporeDocument *document, SporeObject *object, gboolean alone, GPtrArray *along,
                              GError **error) {
  if (!g_str_equal(spore_object_type(object)->element, "body")) return spore_document_remove(document, object, error);
  g_autoptr(GPtrArray) bodies = bodies_with(document, object);
  return remove_bodies(document, bodies, is_instrument(object), alone, along, error);
}

gboolean spore_edit_delete(SporeDocument *document, const GArray *ids, gboolean alone, GPtrArray *along,
                           GError **error) {
  gboolean done = TRUE;
  spore_document_begin(document, _("Delete"));
  for (guint i = 0; done && i < ids->len; i++) {
    SporeObject *object = spore_document_by_id(document, g_array_index(ids, guint32, i));
    if (object && spore_object_name(object)) done = remove_object(document, object, alone, along, error);
  }
  return spore_edit_finish(document, done);
}
