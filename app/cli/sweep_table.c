/* Numbers out of the results of a sweep. */
#include "app/cli/sweep_table.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/number.h"

#define QUANTITIES_MAXIMUM 200

int spore_sweep_index(char *const *names, const char *name) {
  for (int i = 0; names[i]; i++)
    if (g_str_equal(names[i], name)) return i;
  return -1;
}

static gboolean is_number(JsonNode *node) {
  GType type = JSON_NODE_HOLDS_VALUE(node) ? json_node_get_value_type(node) : G_TYPE_INVALID;
  return type == G_TYPE_INT64 || type == G_TYPE_DOUBLE || type == G_TYPE_BOOLEAN;
}

static double number_of(JsonNode *node) {
  if (json_node_get_value_type(node) == G_TYPE_BOOLEAN) return json_node_get_boolean(node);
  return json_node_get_double(node);
}

/* An element of an array: the one of that name, else the one of that number; NULL: there is none. */
static JsonNode *element_of(JsonArray *array, const char *word) {
  for (guint i = 0; i < json_array_get_length(array); i++) {
    JsonNode *element = json_array_get_element(array, i);
    JsonObject *object = JSON_NODE_HOLDS_OBJECT(element) ? json_node_get_object(element) : NULL;
    if (object && g_strcmp0(json_object_get_string_member_with_default(object, "name", NULL), word) == 0)
      return element;
  }
  guint64 number;
  gboolean numbered = json_array_get_length(array) > 0 &&
                      g_ascii_string_to_unsigned(word, 10, 0, json_array_get_length(array) - 1, &number, NULL);
  return numbered ? json_array_get_element(array, (guint)number) : NULL;
}

static double find_number(JsonNode *node, const char *path) {
  g_auto(GStrv) words = g_strsplit(path, ".", 0);
  for (char **word = words; *word && node; word++) {
    if (JSON_NODE_HOLDS_OBJECT(node)) node = json_object_get_member(json_node_get_object(node), *word);
    else if (JSON_NODE_HOLDS_ARRAY(node)) node = element_of(json_node_get_array(node), *word);
    else node = NULL;
  }
  return node && is_number(node) ? number_of(node) : NAN;
}

/* Adds the numbers of an object and of the objects in it, each name once. */
static void add_names(GPtrArray *names, JsonObject *object, const char *before) {
  g_autoptr(GList) members = json_object_get_members(object);
  for (GList *member = members; member; member = member->next) {
    JsonNode *node = json_object_get_member(object, member->data);
    g_autofree char *name = before ? g_strconcat(before, ".", member->data, NULL) : g_strdup(member->data);
    if (!before && JSON_NODE_HOLDS_OBJECT(node)) add_names(names, json_node_get_object(node), name);
    else if (is_number(node) && names->len < QUANTITIES_MAXIMUM &&
             !g_ptr_array_find_with_equal_func(names, name, g_str_equal, NULL))
      g_ptr_array_add(names, g_steal_pointer(&name));
  }
}

static char **all_names(const SporeSweepTable *table) {
  g_autoptr(GPtrArray) names = g_ptr_array_new();
  for (guint i = 0; i < table->sweep->cases->len; i++)
    if (table->results[i] && table->results[i]->output)
      add_names(names, json_node_get_object(table->results[i]->output), NULL);
  g_ptr_array_add(names, NULL);
  return (char **)g_ptr_array_steal(names, NULL);
}

static void fill_values(SporeSweepTable *table) {
  guint columns = g_strv_length(table->quantities);
  table->values = g_new(double, MAX(1, table->sweep->cases->len * columns));
  for (guint i = 0; i < table->sweep->cases->len; i++)
    for (guint k = 0; k < columns; k++) {
      const SporeSweepResult *result = table->results[i];
      table->values[i * columns + k] =
          result && result->output ? find_number(result->output, table->quantities[k]) : NAN;
    }
}

/* A quantity that was asked for is in some result, unless there is no result yet. */
static gboolean check_quantities(const SporeSweepTable *table, GError **error) {
  guint columns = g_strv_length(table->quantities), outputs = 0;
  for (guint i = 0; i < table->sweep->cases->len; i++) outputs += table->results[i] && table->results[i]->output;
  for (guint k = 0; outputs > 0 && k < columns; k++) {
    gboolean known = FALSE;
    for (guint i = 0; i < table->sweep->cases->len; i++) known |= !isnan(table->values[i * columns + k]);
    if (known) continue;
    g_auto(GStrv) names = all_names(table);
    g_autofree char *list = g_strjoinv(", ", names);
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--quantities",
                             _("no result has a number \"%s\"; expected such as %s; correct it"), table->quantities[k],
                             list);
  }
  return TRUE;
}

SporeSweepTable *spore_sweep_table_read(const SporeManifest *sweep, const char *quantities, GError **error) {
  g_autoptr(SporeSweepTable) table = g_new0(SporeSweepTable, 1);
  table->sweep = sweep;
  table->results = g_new0(SporeSweepResult *, sweep->cases->len);
  for (guint i = 0; i < sweep->cases->len; i++) {
    GError *damage = NULL;
    table->results[i] = spore_sweep_result_read(sweep, g_ptr_array_index(sweep->cases, i), &damage);
    if (!damage) continue;
    g_propagate_error(error, damage);
    return NULL;
  }
  table->quantities = quantities ? g_strsplit(quantities, ",", 0) : all_names(table);
  for (char **name = table->quantities; *name; name++) g_strstrip(*name);
  fill_values(table);
  return !quantities || check_quantities(table, error) ? g_steal_pointer(&table) : NULL;
}

void spore_sweep_table_free(SporeSweepTable *table) {
  for (guint i = 0; i < table->sweep->cases->len; i++)
    if (table->results[i]) spore_sweep_result_free(table->results[i]);
  g_free(table->results);
  g_strfreev(table->quantities);
  g_free(table->values);
  g_free(table);
}

static void add_field(GString *csv, const char *text) {
  if (!strpbrk(text, ",\"\n")) {
    g_string_append_printf(csv, "%s,", text);
    return;
  }
  g_auto(GStrv) parts = g_strsplit(text, "\"", 0);
  g_autofree char *doubled = g_strjoinv("\"\"", parts);
  g_string_append_printf(csv, "\"%s\",", doubled);
}

static void end_row(GString *csv) { csv->str[csv->len - 1] = '\n'; }

char *spore_sweep_csv(const SporeSweepTable *table) {
  GString *csv = g_string_new("case,");
  const SporeManifest *sweep = table->sweep;
  guint columns = g_strv_length(table->quantities);
  for (char **axis = sweep->axes; *axis; axis++) add_field(csv, *axis);
  g_string_append(csv, "status,seconds,host,core,");
  for (char **quantity = table->quantities; *quantity; quantity++) add_field(csv, *quantity);
  end_row(csv);
  for (guint i = 0; i < sweep->cases->len; i++) {
    const SporeSweepCase *one = g_ptr_array_index(sweep->cases, i);
    const SporeSweepResult *result = table->results[i];
    if (!result) continue;
    g_string_append_printf(csv, "%u,", i);
    for (char **value = one->values; *value; value++) add_field(csv, *value);
    char digits[SPORE_NUMBER_TEXT];
    spore_number_format(result->seconds, digits);
    g_string_append_printf(csv, "%" G_GINT64_FORMAT ",%s,", result->status, digits);
    add_field(csv, result->host);
    g_string_append_printf(csv, "%" G_GINT64_FORMAT ",", result->core);
    for (guint k = 0; k < columns; k++) {
      double value = table->values[i * columns + k];
      spore_number_format(value, digits);
      g_string_append_printf(csv, "%s,", isnan(value) ? "" : digits);
    }
    end_row(csv);
  }
  return g_string_free(csv, FALSE);
}
