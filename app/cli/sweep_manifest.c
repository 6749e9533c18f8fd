/* The manifest of a sweep: lines of JSON, the first one about all, each other one a case. */
#include <glib/gi18n.h>
#include <string.h>

#include "app/cli/sweep.h"
#include "core/base/hash.h"
#include "core/scene/run_hash.h"

#include "app/cli/scene.h"

#define VERSION 1

SporeSweepCase *spore_sweep_case_new(guint number) {
  SporeSweepCase *one = g_new0(SporeSweepCase, 1);
  one->number = number;
  return one;
}

void spore_sweep_case_free(SporeSweepCase *one) {
  g_free(one->hash);
  g_free(one->scene);
  g_free(one->scene_hash);
  g_strfreev(one->arguments);
  g_strfreev(one->values);
  g_free(one);
}

void spore_sweep_free(SporeManifest *sweep) {
  g_free(sweep->file);
  g_free(sweep->folder);
  g_free(sweep->results);
  g_strfreev(sweep->axes);
  g_ptr_array_unref(sweep->cases);
  g_free(sweep);
}

char *spore_sweep_scene_hash(SporeCli *cli, const char *scene, GError **error) {
  static const SporeSceneOptions as_written = {0};
  g_autoptr(GBytes) text = spore_cli_read_file(scene, _("a scene"), error);
  SporeDocument *document = text ? spore_cli_load(cli, scene, &as_written, error) : NULL;
  if (!document) return NULL;
  gsize size;
  const void *bytes = g_bytes_get_data(text, &size);
  guint64 content = spore_document_run_hash(document);
  guint64 hash = spore_hash(spore_hash(SPORE_HASH_INIT, bytes, size), &content, sizeof content);
  spore_document_free(document);
  return g_strdup_printf("%016" G_GINT64_MODIFIER "x", hash);
}

char *spore_sweep_path_from(const char *folder, const char *file) {
  g_autofree char *base = g_canonicalize_filename(folder, NULL), *path = g_canonicalize_filename(file, NULL);
  gsize length = strlen(base);
  gboolean inside = g_str_has_prefix(path, base) && path[length] == G_DIR_SEPARATOR;
  return inside ? g_strdup(path + length + 1) : g_steal_pointer(&path);
}

/* Writing. */

static void add_texts(JsonBuilder *builder, const char *member, char *const *texts) {
  json_builder_set_member_name(builder, member);
  json_builder_begin_array(builder);
  for (; *texts; texts++) json_builder_add_string_value(builder, *texts);
  json_builder_end_array(builder);
}

void spore_sweep_add_text(JsonBuilder *builder, const char *member, const char *text) {
  json_builder_set_member_name(builder, member);
  if (text) json_builder_add_string_value(builder, text);
  else json_builder_add_null_value(builder);
}

static void add_line(GString *manifest, JsonBuilder *builder) {
  json_builder_end_object(builder);
  g_autoptr(JsonNode) root = json_builder_get_root(builder);
  g_autofree char *line = json_to_string(root, FALSE);
  g_string_append(manifest, line);
  g_string_append_c(manifest, '\n');
  json_builder_reset(builder);
}

void spore_sweep_add_count(JsonBuilder *builder, const char *member, gint64 count) {
  json_builder_set_member_name(builder, member);
  json_builder_add_int_value(builder, count);
}

char *spore_sweep_format(const SporeManifest *sweep) {
  GString *manifest = g_string_new(NULL);
  g_autoptr(JsonBuilder) builder = json_builder_new();
  json_builder_begin_object(builder);
  spore_sweep_add_count(builder, "spore_sweep", VERSION);
  spore_sweep_add_count(builder, "cases", sweep->cases->len);
  add_texts(builder, "axes", sweep->axes);
  add_line(manifest, builder);
  for (guint i = 0; i < sweep->cases->len; i++) {
    const SporeSweepCase *one = g_ptr_array_index(sweep->cases, i);
    json_builder_begin_object(builder);
    spore_sweep_add_count(builder, "case", one->number);
    spore_sweep_add_text(builder, "hash", one->hash);
    spore_sweep_add_text(builder, "scene", one->scene);
    spore_sweep_add_text(builder, "scene_hash", one->scene_hash);
    add_texts(builder, "arguments", one->arguments);
    add_texts(builder, "values", one->values);
    add_line(manifest, builder);
  }
  return g_string_free(manifest, FALSE);
}

/* Reading. */

static JsonObject *parse_line(JsonParser *parser, const char *line) {
  if (!json_parser_load_from_data(parser, line, -1, NULL)) return NULL;
  JsonNode *root = json_parser_get_root(parser);
  return root && JSON_NODE_HOLDS_OBJECT(root) ? json_node_get_object(root) : NULL;
}

static const char *text_of(JsonObject *object, const char *member) {
  JsonNode *node = json_object_get_member(object, member);
  return node && json_node_get_value_type(node) == G_TYPE_STRING ? json_node_get_string(node) : NULL;
}

static gint64 count_of(JsonObject *object, const char *member) {
  JsonNode *node = json_object_get_member(object, member);
  return node && json_node_get_value_type(node) == G_TYPE_INT64 ? json_node_get_int(node) : -1;
}

/* NULL: there is no such array of texts. */
static char **texts_of(JsonObject *object, const char *member) {
  JsonNode *node = json_object_get_member(object, member);
  if (!node || !JSON_NODE_HOLDS_ARRAY(node)) return NULL;
  JsonArray *array = json_node_get_array(node);
  g_autoptr(GStrvBuilder) texts = g_strv_builder_new();
  for (guint i = 0; i < json_array_get_length(array); i++) {
    JsonNode *element = json_array_get_element(array, i);
    if (json_node_get_value_type(element) != G_TYPE_STRING) return NULL;
    g_strv_builder_add(texts, json_node_get_string(element));
  }
  return g_strv_builder_end(texts);
}

/* The hash names a file. */
static gboolean is_hash(const char *text) {
  return text && strlen(text) == 16 && strspn(text, "0123456789abcdef") == 16;
}

static SporeSweepCase *read_case(JsonObject *object, guint number, guint axes) {
  SporeSweepCase *one = spore_sweep_case_new(number);
  one->hash = g_strdup(text_of(object, "hash"));
  one->scene = g_strdup(text_of(object, "scene"));
  one->scene_hash = g_strdup(text_of(object, "scene_hash"));
  one->arguments = texts_of(object, "arguments");
  one->values = texts_of(object, "values");
  if (count_of(object, "case") == number && is_hash(one->hash) && is_hash(one->scene_hash) && one->scene &&
      one->arguments && one->arguments[0] && one->values && g_strv_length(one->values) == axes)
    return one;
  spore_sweep_case_free(one);
  return NULL;
}

static gboolean refuse(const char *file, guint line, GError **error) {
  g_autofree char *place = g_strdup_printf("%s:%u", file, line);
  return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                           _("this is no line of a sweep's manifest; expected what `spore sweep plan` writes; plan "
                             "again"));
}

static gboolean read_lines(SporeManifest *sweep, char **lines, GError **error) {
  g_autoptr(JsonParser) parser = json_parser_new();
  JsonObject *head = lines[0] ? parse_line(parser, lines[0]) : NULL;
  gint64 count = head && count_of(head, "spore_sweep") == VERSION ? count_of(head, "cases") : -1;
  sweep->axes = head ? texts_of(head, "axes") : NULL;
  if (count < 1 || count > SPORE_SWEEP_CASES_MAXIMUM || !sweep->axes) return refuse(sweep->file, 1, error);
  for (guint i = 0; i < count; i++) {
    JsonObject *object = lines[i + 1] ? parse_line(parser, lines[i + 1]) : NULL;
    SporeSweepCase *one = object ? read_case(object, i, g_strv_length(sweep->axes)) : NULL;
    if (!one) return refuse(sweep->file, i + 2, error);
    g_ptr_array_add(sweep->cases, one);
  }
  return TRUE;
}

SporeManifest *spore_sweep_read(const char *file, const char *results, GError **error) {
  g_autoptr(GBytes) content = spore_cli_read_file(file, _("a sweep's manifest"), error);
  if (!content) return NULL;
  gsize size;
  const char *bytes = g_bytes_get_data(content, &size);
  g_autofree char *text = g_strndup(bytes ? bytes : "", size);
  g_auto(GStrv) lines = g_strsplit(text, "\n", SPORE_SWEEP_CASES_MAXIMUM + 2);
  g_autoptr(SporeManifest) sweep = g_new0(SporeManifest, 1);
  sweep->file = g_strdup(file);
  sweep->folder = g_path_get_dirname(file);
  sweep->results = results ? g_strdup(results) : g_strconcat(file, ".results", NULL);
  sweep->cases = g_ptr_array_new_with_free_func((GDestroyNotify)spore_sweep_case_free);
  return read_lines(sweep, lines, error) ? g_steal_pointer(&sweep) : NULL;
}

/* Results. */

char *spore_sweep_result_file(const SporeManifest *sweep, const SporeSweepCase *one) {
  g_autofree char *name = g_strconcat(one->hash, ".json", NULL);
  return g_build_filename(sweep->results, name, NULL);
}

void spore_sweep_result_free(SporeSweepResult *result) {
  g_free(result->host);
  g_free(result->said);
  g_clear_pointer(&result->output, json_node_unref);
  g_free(result);
}

static SporeSweepResult *take_result(JsonObject *object) {
  if (count_of(object, "status") < 0 || !text_of(object, "host")) return NULL;
  SporeSweepResult *result = g_new0(SporeSweepResult, 1);
  result->status = count_of(object, "status");
  result->core = count_of(object, "core");
  result->seconds = json_object_get_double_member_with_default(object, "seconds", 0);
  result->host = g_strdup(text_of(object, "host"));
  result->said = g_strdup(text_of(object, "said"));
  JsonNode *output = json_object_get_member(object, "result");
  if (output && JSON_NODE_HOLDS_OBJECT(output)) result->output = json_node_copy(output);
  return result;
}

SporeSweepResult *spore_sweep_result_read(const SporeManifest *sweep, const SporeSweepCase *one, GError **error) {
  g_autofree char *file = spore_sweep_result_file(sweep, one);
  if (!g_file_test(file, G_FILE_TEST_EXISTS)) return NULL;
  g_autoptr(JsonParser) parser = json_parser_new();
  g_autofree char *text = NULL;
  JsonObject *object = g_file_get_contents(file, &text, NULL, NULL) ? parse_line(parser, text) : NULL;
  gboolean mine = object && g_strcmp0(text_of(object, "hash"), one->hash) == 0;
  SporeSweepResult *result = mine ? take_result(object) : NULL;
  if (!result)
    spore_error_raise(error, SPORE_ERROR_INPUT, file,
                      _("this is no result of case %u; expected what `spore sweep run` writes; delete it, and run the "
                        "sweep again"),
                      one->number);
  return result;
}
