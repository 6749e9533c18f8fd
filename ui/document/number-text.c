/* Decimal marks. */
#include "ui/document/number-text.h"

#include <glib.h>
#include <locale.h>
#include <string.h>

const char *spore_number_mark(void) {
  const char *mark = localeconv()->decimal_point;
  return mark && *mark ? mark : ".";
}

static gboolean is_between_digits(const char *text, gsize at) {
  return at > 0 && g_ascii_isdigit(text[at - 1]) && g_ascii_isdigit(text[at + 1]);
}

/* Whether all commas stand between the numbers of a vector: a point is the decimal mark, or there is no blank that
 * parts three numbers. */
static gboolean are_apart(const char *text) {
  const char *first = strchr(text, ',');
  gboolean several = first && strchr(first + 1, ',');
  return strchr(text, '.') || (several && !strpbrk(text, " \t"));
}

/* A comma parts numbers where another number follows; else it is left for whoever reads the number. */
static gboolean parts_numbers(const char *text, gsize at, gboolean apart) {
  return at > 0 && text[at + 1] && (apart || g_ascii_isspace(text[at + 1]));
}

char *spore_number_text_read(const char *typed, const char *mark) {
  char *text = g_strstrip(g_strdup(typed));
  gboolean comma = strcmp(mark, ",") == 0, apart = are_apart(text), vector = apart || strpbrk(text, " \t");
  for (gsize i = 0; text[i]; i++) {
    if (text[i] != ',') continue;
    if (comma && !apart && is_between_digits(text, i)) text[i] = '.';
    else if (vector && parts_numbers(text, i, apart)) text[i] = ' ';
  }
  return text;
}

char *spore_number_text_show(const char *text, const char *mark) {
  g_auto(GStrv) parts = g_strsplit(text, ".", -1);
  return g_strjoinv(mark, parts);
}
