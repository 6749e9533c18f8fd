/* Decimal marks, and lengths in mm. */
#include "ui/document/number-text.h"

#include <glib.h>
#include <locale.h>
#include <stdlib.h>
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

#define LEAST_EXPONENT (-9) /* numbers below 1e-9 are written with an exponent */
#define MOST_EXPONENT 12

/* Appends digits x 10^exponent, the digits without zeros at either end. */
static void append_decimal(GString *out, const char *digits, int count, int exponent) {
  int whole = count + exponent; /* digits before the point */
  if (count == 0) {
    g_string_append_c(out, '0');
  } else if (whole <= LEAST_EXPONENT || whole > MOST_EXPONENT) {
    g_string_append_c(out, digits[0]);
    if (count > 1) g_string_append_printf(out, ".%.*s", count - 1, digits + 1);
    g_string_append_printf(out, "e%d", whole - 1);
  } else if (whole <= 0) {
    g_string_append_printf(out, "0.%.*s%.*s", -whole, "0000000000", count, digits);
  } else {
    for (int i = 0; i < MAX(whole, count); i++) {
      if (i == whole) g_string_append_c(out, '.');
      g_string_append_c(out, i < count ? digits[i] : '0');
    }
  }
}

/* Appends a number without blanks, shifted; FALSE: the word is no decimal number. */
static gboolean append_shifted(GString *out, const char *word, gsize length, int shift) {
  g_autoptr(GString) digits = g_string_new(NULL);
  gsize at = word[0] == '-' || word[0] == '+', seen = 0;
  int exponent = shift;
  gboolean fraction = FALSE;
  for (; at < length && (g_ascii_isdigit(word[at]) || (word[at] == '.' && !fraction)); at++) {
    if (word[at] == '.') {
      fraction = TRUE;
      continue;
    }
    exponent -= fraction;
    seen++;
    if (digits->len > 0 || word[at] != '0') g_string_append_c(digits, word[at]);
  }
  if (seen == 0) return FALSE;
  if (at < length && (word[at] == 'e' || word[at] == 'E')) {
    char *end;
    long power = strtol(word + at + 1, &end, 10);
    if (end == word + at + 1 || labs(power) > 400) return FALSE;
    exponent += (int)power;
    at = (gsize)(end - word);
  }
  if (at != length) return FALSE;
  while (digits->len > 0 && digits->str[digits->len - 1] == '0') {
    g_string_truncate(digits, digits->len - 1);
    exponent++;
  }
  if (word[0] == '-') g_string_append_c(out, '-');
  append_decimal(out, digits->str, (int)digits->len, exponent);
  return TRUE;
}

char *spore_number_text_shift(const char *text, int digits) {
  GString *out = g_string_new(NULL);
  while (*text) {
    gsize length = strcspn(text, " ");
    if (length > 0 && !append_shifted(out, text, length, digits)) g_string_append_len(out, text, (gssize)length);
    text += length;
    if (*text) g_string_append_c(out, *text++);
  }
  return g_string_free(out, FALSE);
}

int spore_number_text_cut_length(char *typed) {
  static const struct {
    const char *name;
    int digits;
  } units[] = {{"cm", -2}, {"mm", -3}, {"um", -6}, {"µm", -6}, {"m", 0}};
  g_strchomp(typed);
  for (gsize i = 0; i < G_N_ELEMENTS(units); i++) {
    if (!g_str_has_suffix(typed, units[i].name)) continue;
    typed[strlen(typed) - strlen(units[i].name)] = '\0';
    g_strchomp(typed);
    return units[i].digits;
  }
  return -3;
}
