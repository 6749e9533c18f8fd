/* Decimal marks, lengths in mm, angles in degrees, and flows in ml/min. */
#include "ui/document/number-text.h"

#include <glib.h>
#include <locale.h>
#include <math.h>
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

/* Each word through `append`, which gives FALSE for one that is to stay. g_free. */
static char *each_word(const char *text, gboolean (*append)(GString *out, const char *word, gsize length, int argument),
                       int argument) {
  GString *out = g_string_new(NULL);
  while (*text) {
    gsize length = strcspn(text, " ");
    if (length > 0 && !append(out, text, length, argument)) g_string_append_len(out, text, (gssize)length);
    text += length;
    if (*text) g_string_append_c(out, *text++);
  }
  return g_string_free(out, FALSE);
}

char *spore_number_text_shift(const char *text, int digits) { return each_word(text, append_shifted, digits); }

/* Cuts the name from the end, and blanks before it; FALSE: it is not there. */
static gboolean cut(char *typed, const char *name) {
  if (!g_str_has_suffix(typed, name)) return FALSE;
  typed[strlen(typed) - strlen(name)] = '\0';
  g_strchomp(typed);
  return TRUE;
}

int spore_number_text_cut_length(char *typed) {
  static const struct {
    const char *name;
    int digits;
  } units[] = {{"cm", -2}, {"mm", -3}, {"um", -6}, {"µm", -6}, {"m", 0}};
  g_strchomp(typed);
  for (gsize i = 0; i < G_N_ELEMENTS(units); i++)
    if (cut(typed, units[i].name)) return units[i].digits;
  return -3;
}

/* Angles and flows. */

#define MOST_DECIMALS 12
#define ROUNDED_SHARE 1e-3 /* a rounded number is off by no more than this share of itself */

/* A unit that is no power of ten of that of the file. */
typedef enum Unit { DEGREE, MILLILITRE_A_MINUTE } Unit;
static const struct {
  double each;    /* in the unit of the file */
  double rounded; /* in the unit of the file: a rounded number is off by no more; of angles 0.02 degrees */
} units[] = {[DEGREE] = {G_PI / 180, 3.5e-4}, [MILLILITRE_A_MINUTE] = {1e-6 / 60, HUGE_VAL}};

static gboolean read_number(const char *word, gsize length, double *number) {
  char *end;
  *number = g_ascii_strtod(word, &end);
  return end == word + length && isfinite(*number);
}

/* Decimals that the number is written with: 4 of "0.5236", 4 of "1.5e-3". */
static int decimals_of(const char *word, gsize length) {
  const char *point = memchr(word, '.', length), *end = word + strcspn(word, "eE ");
  int power = end < word + length ? atoi(end + 1) : 0;
  return CLAMP((point ? (int)(end - point - 1) : 0) - power, 0, MOST_DECIMALS);
}

static gboolean append_shown(GString *out, const char *word, gsize length, int unit) {
  double number;
  char text[512], format[8];
  if (!read_number(word, length, &number)) return FALSE;
  double off = MIN(units[unit].rounded, ROUNDED_SHARE * fabs(number));
  off = MIN(off, 0.5 * pow(10, -decimals_of(word, length)));
  for (int decimals = 0; decimals <= MOST_DECIMALS + 4; decimals++) {
    g_snprintf(format, sizeof format, "%%.%df", decimals);
    g_ascii_formatd(text, sizeof text, format, number / units[unit].each);
    if (fabs(g_ascii_strtod(text, NULL) * units[unit].each - number) <= off) break;
  }
  g_string_append(out, text);
  return TRUE;
}

static gboolean append_kept(GString *out, const char *word, gsize length, int unit) {
  double shown;
  char text[G_ASCII_DTOSTR_BUF_SIZE];
  if (!read_number(word, length, &shown)) return FALSE;
  g_string_append(out, g_ascii_dtostr(text, sizeof text, shown * units[unit].each));
  return TRUE;
}

char *spore_number_text_degrees(const char *text) { return each_word(text, append_shown, DEGREE); }

char *spore_number_text_radians(const char *text) { return each_word(text, append_kept, DEGREE); }

char *spore_number_text_flow(const char *text) { return each_word(text, append_shown, MILLILITRE_A_MINUTE); }

char *spore_number_text_from_flow(const char *text) { return each_word(text, append_kept, MILLILITRE_A_MINUTE); }

int spore_number_text_cut_flow(char *typed) {
  g_strchomp(typed);
  if (cut(typed, "ml/min")) return 0;
  return cut(typed, "l/min") ? 3 : 0;
}

int spore_number_text_cut_angle(char *typed) {
  g_strchomp(typed);
  if (cut(typed, "rad")) return FALSE;
  (void)(cut(typed, "°") || cut(typed, "deg"));
  return TRUE;
}
