/* Reads names of labels from the header of an NRRD file, as 3D Slicer writes its segmentations: "Segment0_Name:=liver"
 * and "Segment0_LabelValue:=3" (3D Slicer's manual, Segmentations: file format). */
#include <glib/gi18n.h>
#include <string.h>

#include "core/io/label_map.h"

#define MOST_HEADER ((gsize)1 << 20)

/* Splits "Segment12_Name:=liver" into 12, "Name" and its value. */
static gboolean read_line(const char *line, guint *segment, const char **key, const char **value) {
  char *end;
  if (!g_str_has_prefix(line, "Segment")) return FALSE;
  guint64 number = g_ascii_strtoull(line + strlen("Segment"), &end, 10);
  const char *is = strstr(line, ":=");
  if (end == line + strlen("Segment") || *end != '_' || !is || number > 65535) return FALSE;
  *segment = (guint)number;
  *key = end + 1;
  *value = is + 2;
  return TRUE;
}

/* The name without control characters, which a terminal would obey. */
static char *printable(const char *name) {
  char *text = g_strdup(name);
  for (char *c = text; *c; c++)
    if (g_ascii_iscntrl(*c)) *c = ' ';
  return text;
}

char *spore_label_map_name(GHashTable *names, guint16 label) {
  const char *name = g_hash_table_lookup(names, GUINT_TO_POINTER((guint)label));
  return name ? g_strdup(name) : g_strdup_printf(_("label %u"), label);
}

GHashTable *spore_label_map_names(const void *content, gsize size) {
  GHashTable *names = g_hash_table_new_full(NULL, NULL, NULL, g_free);
  g_autoptr(GHashTable) of_segment = g_hash_table_new_full(NULL, NULL, NULL, g_free);
  if (size < 4 || memcmp(content, "NRRD", 4) != 0) return names;
  g_autofree char *text = g_strndup(content, MIN(size, MOST_HEADER));
  char *end = strstr(text, "\n\n"), *other = strstr(text, "\r\n\r\n");
  if (other && (!end || other < end)) end = other;
  if (end) *end = '\0';
  g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
  guint segment;
  const char *key, *value;
  for (char **line = lines; *line; line++)
    if (read_line(g_strchomp(*line), &segment, &key, &value) && g_str_has_prefix(key, "Name:=") && *value &&
        g_utf8_validate(value, -1, NULL))
      g_hash_table_insert(of_segment, GUINT_TO_POINTER(segment), g_strdup(value));
  for (char **line = lines; *line; line++) {
    guint64 label;
    if (!read_line(*line, &segment, &key, &value) || !g_str_has_prefix(key, "LabelValue:=") ||
        !g_ascii_string_to_unsigned(value, 10, 1, 65535, &label, NULL))
      continue;
    const char *name = g_hash_table_lookup(of_segment, GUINT_TO_POINTER(segment));
    if (name) g_hash_table_insert(names, GUINT_TO_POINTER((guint)label), printable(name));
  }
  return names;
}
