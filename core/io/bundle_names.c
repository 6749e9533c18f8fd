/* Checks what a stranger's bundle says of itself. */
#include "core/io/bundle_names.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/io/bundle.h"

#define LONGEST_NAME 1024 /* bytes */
/* Of a zip, as its makers' note 4.3 gives them: the mark and the size of a row of the table, and of the table's end. */
#define ROW_MARK "PK\1\2"
#define ROW_SIZE 46u
#define END_MARK "PK\5\6"
#define END_SIZE 22u

gboolean spore_bundle_is_name(const char *file) { return g_str_has_suffix(file, ".sporez"); }

/* Names. */

static gboolean is_text(const char *name) {
  if (!g_utf8_validate(name, -1, NULL) || strlen(name) > LONGEST_NAME) return FALSE;
  for (const char *c = name; *c; c++)
    if ((guchar)*c < ' ' || *c == 127 || *c == '\\') return FALSE;
  return TRUE;
}

static gboolean is_plain(const char *name) {
  g_auto(GStrv) parts = g_strsplit(name, "/", -1);
  for (char **part = parts; *part; part++)
    if (**part == '\0' || strcmp(*part, ".") == 0 || strcmp(*part, "..") == 0) return FALSE;
  return *name != '\0';
}

gboolean spore_bundle_check_name(const char *place, const char *name, GError **error) {
  if (!name || !is_text(name))
    return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                             _("a file in the bundle is called \"%s\"; expected a path in UTF-8 of at most %d bytes, "
                               "with slashes; rename the file, or do not open the bundle"),
                             name ? name : "", LONGEST_NAME);
  return is_plain(name) ||
         spore_error_raise(error, SPORE_ERROR_INPUT, place,
                           _("a file in the bundle is called \"%s\"; expected a path below the bundle, without \".\" "
                             "and \"..\"; rename the file, or do not open the bundle"),
                           name);
}

/* Whether a folder on the way to the file is one of the names. */
static gboolean is_below_file(const char *name, GHashTable *names) {
  for (const char *slash = strchr(name, '/'); slash; slash = strchr(slash + 1, '/')) {
    g_autofree char *folder = g_strndup(name, (gsize)(slash - name));
    if (g_hash_table_contains(names, folder)) return TRUE;
  }
  return FALSE;
}

gboolean spore_bundle_check_folders(const char *place, GHashTable *names, GError **error) {
  GHashTableIter iterator;
  gpointer name;
  g_hash_table_iter_init(&iterator, names);
  while (g_hash_table_iter_next(&iterator, &name, NULL))
    if (is_below_file(name, names))
      return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                               _("\"%s\" lies in a folder that is a file of the bundle, too; expected the one or the "
                                 "other; make the bundle again"),
                               (const char *)name);
  return TRUE;
}

/* The table. */

static guint two_bytes(const guint8 *at) { return (guint)at[0] | (guint)at[1] << 8; }
static guint four_bytes(const guint8 *at) { return two_bytes(at) | two_bytes(at + 2) << 16; }

static gboolean refuse_damage(const char *place, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, place, "%s",
                           _("the bundle is damaged or cut short; expected a whole zip; copy it again"));
}

/* Goes through the rows, which must fill the place between `row` and `end`. */
static gboolean check_rows(const char *place, const guint8 *row, const guint8 *end, guint count, GError **error) {
  for (guint i = 0; i < count; i++) {
    if ((gsize)(end - row) < ROW_SIZE || memcmp(row, ROW_MARK, 4) != 0) return refuse_damage(place, error);
    gsize size = ROW_SIZE + two_bytes(row + 28) + two_bytes(row + 30) + two_bytes(row + 32); /* name, extra, comment */
    if ((gsize)(end - row) < size) return refuse_damage(place, error);
    row += size;
  }
  return row == end || refuse_damage(place, error);
}

gboolean spore_bundle_check_table(const char *place, const void *content, gsize size, GError **error) {
  const guint8 *bytes = content;
  if (size < 4 || memcmp(bytes, "PK", 2) != 0)
    return spore_error_raise(error, SPORE_ERROR_INPUT, place, "%s",
                             _("this is no bundle; expected a zip that spore export --format bundle wrote; choose "
                               "another file"));
  const guint8 *end = bytes + size - END_SIZE;
  if (size < END_SIZE || memcmp(end, END_MARK, 4) != 0) return refuse_damage(place, error);
  guint count = two_bytes(end + 10), length = four_bytes(end + 12), start = four_bytes(end + 16);
  if (count > SPORE_BUNDLE_FILES)
    return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                             _("the bundle holds over %u files; expected a scene and the files that it names; make "
                               "it with spore export"),
                             SPORE_BUNDLE_FILES);
  if (count == 0)
    return spore_error_raise(error, SPORE_ERROR_INPUT, place, "%s",
                             _("the bundle is empty; expected a scene and the files that it names; make it with spore "
                               "export"));
  if (start > size - END_SIZE || length != size - END_SIZE - start || two_bytes(end + 8) != count)
    return refuse_damage(place, error);
  return check_rows(place, bytes + start, end, count, error);
}
