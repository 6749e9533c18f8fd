/* Finds what each asset of a scene is for. */
#include "core/scene/needs.h"

#include <string.h>

const char *const spore_asset_use_names[] = {"unused", "source", "drawn", "simulated", NULL};

static SporeAssetUse use_by(const SporeObject *user) {
  const char *element = spore_object_type(user)->element;
  if (strcmp(element, "visual") == 0) return SPORE_ASSET_DRAWN;
  const SporeObject *parent = spore_object_parent(user);
  gboolean asset = parent && strcmp(spore_object_type(parent)->element, "assets") == 0;
  return asset ? SPORE_ASSET_SOURCE : SPORE_ASSET_SIMULATED;
}

/* Raises the use of what the object and its children name. uses: object -> SporeAssetUse. */
static void add_uses(SporeObject *object, GHashTable *uses) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  for (guint i = 0; table && i < table->count; i++) {
    if (table->parameters[i].type != SPORE_REFERENCE) continue;
    SporeObject *target = spore_object_reference(object, table->parameters[i].name);
    int use = (int)use_by(object);
    if (target && GPOINTER_TO_INT(g_hash_table_lookup(uses, target)) < use)
      g_hash_table_insert(uses, target, GINT_TO_POINTER(use));
  }
  for (guint i = 0; i < spore_object_child_count(object); i++) add_uses(spore_object_child(object, i), uses);
}

static gsize bytes_of(SporeDocument *document, const char *file) {
  g_autoptr(GBytes) content = spore_document_read_asset(document, file, NULL);
  return content ? g_bytes_get_size(content) : 0;
}

GArray *spore_document_asset_needs(SporeDocument *document) {
  g_autoptr(GHashTable) uses = g_hash_table_new(NULL, NULL);
  GArray *needs = g_array_new(FALSE, TRUE, sizeof(SporeAssetNeed));
  add_uses(spore_document_root(document), uses);
  const SporeObject *assets = spore_document_section(document, "assets");
  for (guint i = 0; i < spore_object_child_count(assets); i++) {
    SporeAssetNeed need = {.asset = spore_object_child(assets, i)};
    need.use = (SporeAssetUse)GPOINTER_TO_INT(g_hash_table_lookup(uses, need.asset));
    need.bytes = bytes_of(document, spore_object_text(need.asset, "file"));
    g_array_append_val(needs, need);
  }
  return needs;
}

static void clear_texture(gpointer data) { g_ptr_array_unref(((SporeTextureNeed *)data)->bodies); }

static void add_texture(SporeDocument *document, SporeObject *body, const char *file, GArray *needs) {
  for (guint i = 0; i < needs->len; i++) {
    SporeTextureNeed *known = &g_array_index(needs, SporeTextureNeed, i);
    if (strcmp(known->file, file) != 0) continue;
    if (!g_ptr_array_find(known->bodies, body, NULL)) g_ptr_array_add(known->bodies, body);
    return;
  }
  SporeTextureNeed need = {file, bytes_of(document, file), g_ptr_array_new()};
  g_ptr_array_add(need.bodies, body);
  g_array_append_val(needs, need);
}

GArray *spore_document_texture_needs(SporeDocument *document) {
  static const char *const files[] = {"texture", "texture_places"};
  GArray *needs = g_array_new(FALSE, TRUE, sizeof(SporeTextureNeed));
  g_array_set_clear_func(needs, clear_texture);
  const SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    const SporeObject *visual = spore_object_child_of(body, "visual");
    for (gsize k = 0; visual && k < G_N_ELEMENTS(files); k++) {
      const char *file = spore_object_text(visual, files[k]);
      if (file) add_texture(document, body, file, needs);
    }
  }
  return needs;
}

static void collect_files(SporeObject *object, GHashTable *files) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  for (guint i = 0; i < table->count; i++)
    if (table->parameters[i].type == SPORE_FILE && spore_object_is_set(object, i))
      g_hash_table_add(files, spore_object_value(object, i)->text);
  for (guint i = 0; i < spore_object_child_count(object); i++) collect_files(spore_object_child(object, i), files);
}

GHashTable *spore_document_files(const SporeDocument *document) {
  GHashTable *files = g_hash_table_new(g_str_hash, g_str_equal);
  collect_files(spore_document_root(document), files);
  return files;
}
