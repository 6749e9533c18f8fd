/* Reads tables of the names of labels: JSON of either direction, and lines as ITK-SNAP and 3D Slicer write them. */
#include <string.h>

#include "core/io/json_scan.h"
#include "core/io/label_survey.h"

#define DEEPEST 4

static void add(GHashTable *names, const char *number, gsize digits, const char *name, gsize length) {
  g_autofree char *label = g_strndup(number, digits), *text = g_strndup(name, length);
  guint64 value;
  if (!g_ascii_string_to_unsigned(label, 10, 1, 65535, &value, NULL)) return;
  if (!length || !g_utf8_validate(text, -1, NULL) || strchr(text, '\\')) return;
  for (char *c = text; *c; c++)
    if (g_ascii_iscntrl(*c)) *c = ' ';
  g_hash_table_insert(names, GUINT_TO_POINTER((guint)value), g_steal_pointer(&text));
}

static gboolean next_is(const SporeJson *json, char wanted) {
  const char *at = json->at;
  while (at < json->end && g_ascii_isspace(*at)) at++;
  return !json->bad && at < json->end && *at == wanted;
}

/* {"1": "liver"} and {"liver": 1}. Other values are passed over. */
static void read_members(SporeJson *json, GHashTable *names) {
  SporeJsonText key, value;
  gsize count = 0;
  if (!spore_json_take(json, '{')) return;
  while (spore_json_next_member(json, &count, &key)) {
    if (next_is(json, '"')) {
      if (spore_json_string(json, &value)) add(names, key.text, key.length, value.text, value.length);
    } else if (next_is(json, '{') || next_is(json, '[')) spore_json_skip(json, DEEPEST);
    else {
      while (json->at < json->end && g_ascii_isspace(*json->at)) json->at++;
      if (spore_json_scalar(json, &value)) add(names, value.text, value.length, key.text, key.length);
    }
  }
}

/* The members of "labels" where there are such, else those of the whole. */
static void read_json(const char *text, gsize size, GHashTable *names) {
  SporeJson json = {text, text + size, FALSE};
  SporeJsonText key;
  gsize count = 0;
  if (!spore_json_take(&json, '{')) return;
  while (spore_json_next_member(&json, &count, &key)) {
    if (key.length == 6 && memcmp(key.text, "labels", 6) == 0 && next_is(&json, '{')) {
      read_members(&json, names);
      return;
    }
    spore_json_skip(&json, 0);
  }
  json = (SporeJson){text, text + size, FALSE};
  read_members(&json, names);
}

static gboolean is_number(const char *word) {
  char *end;
  g_ascii_strtod(word, &end);
  return end > word && !*end;
}

/* "3 255 0 0 1 1 1 "liver"", "3 liver 255 0 0 255" or "3, liver": a number, then a name in quotes or the words before
 * the next number. */
static void read_line(char *line, GHashTable *names) {
  char *rest = line + strspn(line, " \t");
  const gsize digits = strspn(rest, "0123456789");
  if (!digits || !strchr(" \t,:;=", rest[digits])) return;
  char *name = rest + digits + strspn(rest + digits, " \t,:;="), *quote = strchr(name, '"');
  if (quote) {
    const char *close = strchr(quote + 1, '"');
    if (close) add(names, rest, digits, quote + 1, (gsize)(close - quote - 1));
    return;
  }
  g_auto(GStrv) words = g_strsplit_set(name, " \t,;", -1);
  g_autoptr(GString) kept = g_string_new(NULL);
  for (char **word = words; *word && !is_number(*word); word++)
    if (**word) g_string_append_printf(kept, "%s%s", kept->len ? " " : "", *word);
  add(names, rest, digits, kept->str, kept->len);
}

void spore_label_table_read(const char *text, gsize size, gboolean json, GHashTable *names) {
  if (json) {
    read_json(text, size, names);
    return;
  }
  g_autofree char *whole = g_strndup(text, size);
  g_auto(GStrv) lines = g_strsplit(whole, "\n", -1);
  for (char **line = lines; *line; line++) read_line(g_strchomp(*line), names);
}
