/* Tells whether generated data still agree with their source and their options. */
#include "core/scene/generated.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/base/hash.h"

/* All parameters of a generated asset but these are options of its generator. */
gboolean spore_generated_is_option(const SporeParameter *parameter) {
  static const char *const others[] = {"name",        "file",         "unit",   "frame",  "source",
                                       "source_hash", "options_hash", "frozen", "edited", NULL};
  return !g_strv_contains(others, parameter->name);
}

static guint64 hash_text(guint64 hash, const char *text) { return spore_hash(hash, text, strlen(text) + 1); }

static guint64 hash_option(guint64 hash, const SporeParameter *parameter, const SporeValue *value) {
  char text[256];
  SporeValue initial = {0};
  gboolean known = spore_parameter_initial(parameter, &initial), same = known && spore_value_equal(&initial, value);
  if (known) spore_value_clear(&initial);
  if (same) return hash;
  spore_parameter_format(parameter, value, text, sizeof text);
  return hash_text(hash_text(hash, parameter->name), text);
}

static guint64 hash_options(guint64 hash, const SporeObject *object) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  for (guint i = 0; i < table->count; i++)
    if (spore_generated_is_option(&table->parameters[i]))
      hash = hash_option(hash, &table->parameters[i], spore_object_value(object, i));
  for (guint i = 0; i < spore_object_child_count(object); i++) {
    const SporeObject *region = spore_object_child(object, i);
    hash = hash_options(hash_text(hash, spore_object_type(region)->element), region);
  }
  return hash;
}

char *spore_generated_options_hash(const SporeObject *asset) {
  guint64 hash = hash_options(SPORE_HASH_INIT, asset);
  return g_strdup_printf("%016" G_GINT64_MODIFIER "x", hash);
}

gboolean spore_generated_is(const SporeObject *asset, const char *remark) {
  int property = spore_parameter_find(spore_object_type(asset)->table, remark);
  return property >= 0 && spore_object_value(asset, (guint)property)->number[0] != 0;
}

gboolean spore_generated_may_change(const SporeObject *asset, GError **error) {
  if (!spore_generated_is(asset, "frozen")) return TRUE;
  g_autofree char *path = spore_object_path(asset);
  return spore_error_raise(error, SPORE_ERROR_INPUT, path,
                           _("\"%s\" is frozen and stays as it is; unfreeze it first, then generate it again"),
                           spore_object_name(asset));
}

SporeGenerated spore_generated_state(SporeDocument *document, SporeObject *asset) {
  if (spore_parameter_find(spore_object_type(asset)->table, "source_hash") < 0) return SPORE_GENERATED_NOT;
  SporeObject *source = spore_object_reference(asset, "source");
  const char *source_then = spore_object_text(asset, "source_hash");
  const char *options_then = spore_object_text(asset, "options_hash");
  if (!source || !source_then) return SPORE_GENERATED_NOT;
  g_autofree char *source_now = spore_document_asset_hash(document, source);
  if (source_now && strcmp(source_now, source_then) != 0) return SPORE_GENERATED_SOURCE_CHANGED;
  g_autofree char *options_now = spore_generated_options_hash(asset);
  return options_then && strcmp(options_now, options_then) != 0 ? SPORE_GENERATED_OPTIONS_CHANGED
                                                                : SPORE_GENERATED_FRESH;
}
