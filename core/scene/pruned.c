/* Leaves out what no run of a scene needs. */
#include "core/scene/pruned.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/needs.h"
#include "core/sim/lod/lod_type.h"

/* Levels. */

/* Whether a run changes the level of the body by itself. */
static gboolean is_by_hand(const SporeObject *fidelity) {
  return (int)spore_object_number(fidelity, "automatic") == SPORE_LOD_BY_HAND;
}

static gboolean drop_levels_of(SporeDocument *document, SporeObject *body, GPtrArray *left_out, GError **error) {
  SporeObject *fidelity = spore_object_child_of(body, "fidelity");
  if (!fidelity || !is_by_hand(fidelity)) return TRUE;
  const char *used = spore_lod_names[(int)spore_object_number(fidelity, "level")];
  for (guint i = spore_object_child_count(fidelity); i > 0; i--) {
    SporeObject *level = spore_object_child(fidelity, i - 1);
    const char *name = spore_object_type(level)->element;
    if (strcmp(name, used) == 0) continue;
    g_ptr_array_add(left_out, g_strdup_printf(_("%s: its level %s, which no run changes to by itself"),
                                              spore_object_name(body), name));
    if (!spore_document_remove(document, level, error)) return FALSE;
  }
  return TRUE;
}

static gboolean drop_levels(SporeDocument *document, GPtrArray *left_out, GError **error) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    if (!drop_levels_of(document, spore_object_child(bodies, i), left_out, error)) return FALSE;
  return TRUE;
}

/* Files. */

static char *describe_file(const SporeObject *object, gsize bytes, const char *reason) {
  return g_strdup_printf(_("%s (%s): %zu bytes; %s"), spore_object_text(object, "file"), spore_object_name(object),
                         bytes, reason);
}

static gboolean drop_assets(SporeDocument *document, GPtrArray *left_out, GError **error) {
  g_autoptr(GArray) needs = spore_document_asset_needs(document);
  for (guint i = 0; i < needs->len; i++) {
    const SporeAssetNeed *need = &g_array_index(needs, SporeAssetNeed, i);
    if (need->use != SPORE_ASSET_UNUSED && need->use != SPORE_ASSET_SOURCE) continue;
    const char *reason = need->use == SPORE_ASSET_SOURCE ? _("a run reads what was generated from it")
                                                         : _("nothing that runs or is drawn names it");
    g_ptr_array_add(left_out, describe_file(need->asset, need->bytes, reason));
    if (!spore_document_remove(document, need->asset, error)) return FALSE;
  }
  return TRUE;
}

static gboolean drop_tracks(SporeDocument *document, GPtrArray *left_out, GError **error) {
  SporeObject *devices = spore_document_section(document, "devices");
  SporeObject *tools = spore_document_section(document, "tools");
  for (guint i = spore_object_child_count(devices); i > 0; i--) {
    SporeObject *device = spore_object_child(devices, i - 1);
    gboolean track = strcmp(spore_object_type(device)->element, "track") == 0, used = !track;
    for (guint k = 0; !used && k < spore_object_child_count(tools); k++)
      used = spore_object_refers_to(spore_object_child(tools, k), device);
    if (used) continue;
    g_autoptr(GBytes) content = spore_document_read_asset(document, spore_object_text(device, "file"), NULL);
    g_ptr_array_add(left_out,
                    describe_file(device, content ? g_bytes_get_size(content) : 0, _("the track moves nothing")));
    if (!spore_document_remove(document, device, error)) return FALSE;
  }
  return TRUE;
}

/* What the author noted. */

/* How the asset was made: the rest is where its content is, and how that is read. */
static gboolean drop_origin(SporeDocument *document, SporeObject *asset, GError **error) {
  static const char *const kept[] = {"name", "file", "unit", "frame", NULL};
  const SporeParameterTable *table = spore_object_type(asset)->table;
  for (guint i = 0; i < table->count; i++)
    if (spore_object_is_set(asset, i) && !g_strv_contains(kept, table->parameters[i].name) &&
        !spore_document_unset(document, asset, i, error))
      return FALSE;
  while (spore_object_child_count(asset) > 0)
    if (!spore_document_remove(document, spore_object_child(asset, 0), error)) return FALSE;
  return TRUE;
}

static gboolean drop_notes(SporeDocument *document, GError **error) {
  SporeObject *assets = spore_document_section(document, "assets");
  for (guint i = 0; i < spore_object_child_count(assets); i++)
    if (!drop_origin(document, spore_object_child(assets, i), error)) return FALSE;
  SporeObject *measured = spore_object_child_of(spore_document_section(document, "meta"), "measured");
  return !measured || spore_document_remove(document, measured, error);
}

SporeDocument *spore_document_pruned(SporeDocument *document, GPtrArray *left_out, GError **error) {
  SporeDocument *pruned = spore_document_copy(document);
  if (drop_levels(pruned, left_out, error) && drop_assets(pruned, left_out, error) &&
      drop_tracks(pruned, left_out, error) && drop_notes(pruned, error))
    return pruned;
  spore_document_free(pruned);
  return NULL;
}
