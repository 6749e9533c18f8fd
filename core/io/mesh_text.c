/* Undoes what programs do to a text before its first word: other encodings, marks and blank lines. */
#include "core/io/mesh_text.h"

#include <string.h>

#include "core/base/memory.h"

static guint unit_at(const guchar *bytes, gsize i, gboolean big) {
  return big ? (guint)bytes[i] << 8 | bytes[i + 1] : (guint)bytes[i + 1] << 8 | bytes[i];
}

/* The character that begins at *i, which moves behind the character; U+FFFD in place of half a pair. */
static gunichar next_character(const guchar *bytes, gsize size, gsize *i, gboolean big) {
  const guint first = unit_at(bytes, *i, big);
  *i += 2;
  if (first < 0xD800 || first > 0xDFFF) return first;
  const guint second = first < 0xDC00 && *i + 1 < size ? unit_at(bytes, *i, big) : 0;
  if (second < 0xDC00 || second > 0xDFFF) return 0xFFFD;
  *i += 2;
  return 0x10000 + ((first - 0xD800) << 10) + (second - 0xDC00);
}

/* A unit of two bytes takes three bytes at most. */
static char *from_utf16(const guchar *bytes, gsize size, gboolean big, gsize *length) {
  char *text = SPORE_NEW_ARRAY(char, size / 2 * 3 + 1);
  *length = 0;
  for (gsize i = 2; text && i + 1 < size;)
    *length += (gsize)g_unichar_to_utf8(next_character(bytes, size, &i, big), text + *length);
  return text;
}

gboolean spore_mesh_text(const char **content, gsize *size, char **held) {
  const guchar *bytes = (const guchar *)*content;
  *held = NULL;
  const gboolean big = *size >= 2 && bytes[0] == 0xFE && bytes[1] == 0xFF,
                 little = *size >= 2 && bytes[0] == 0xFF && bytes[1] == 0xFE;
  if (big || little) {
    *held = from_utf16(bytes, *size, big, size);
    *content = *held;
  } else if (*size >= 3 && memcmp(bytes, "\xEF\xBB\xBF", 3) == 0) *content += 3, *size -= 3;
  if ((big || little) && !*held) return FALSE;
  gsize blank = 0;
  while (blank < *size && g_ascii_isspace((*content)[blank])) blank++;
  if (*size - blank >= 4 && memcmp(*content + blank, "ply", 3) == 0) *content += blank, *size -= blank;
  return TRUE;
}
