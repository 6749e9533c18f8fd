/* Words and numbers of a text file, read one after the other, with their line and column for messages. */
#include "core/io/scanner.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/number.h"
#include "core/mesh/mesh.h"

void spore_scanner_init(SporeScanner *scanner, const char *place, const char *text, gsize size) {
  if (!text) text = "";
  *scanner = (SporeScanner){.place = place ? place : "",
                            .at = text,
                            .end = text + size,
                            .line_start = text,
                            .line = 1,
                            .word_line = 1,
                            .word_column = 1};
}

static gboolean is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

static void pass_newline(SporeScanner *scanner) {
  scanner->at++;
  scanner->line++;
  scanner->line_start = scanner->at;
}

static void skip_space(SporeScanner *scanner) {
  while (scanner->at < scanner->end) {
    if (*scanner->at == '\n') pass_newline(scanner);
    else if (is_space(*scanner->at)) scanner->at++;
    else if (*scanner->at == '#')
      while (scanner->at < scanner->end && *scanner->at != '\n') scanner->at++;
    else return;
  }
}

gboolean spore_scanner_next(SporeScanner *scanner) {
  skip_space(scanner);
  scanner->word_line = scanner->line;
  scanner->word_column = (unsigned)(scanner->at - scanner->line_start) + 1;
  scanner->word = NULL;
  scanner->length = 0;
  if (scanner->at == scanner->end) return FALSE;
  scanner->word = scanner->at;
  while (scanner->at < scanner->end && !is_space(*scanner->at) && *scanner->at != '#') scanner->at++;
  scanner->length = (gsize)(scanner->at - scanner->word);
  return TRUE;
}

gboolean spore_scanner_more_on_line(SporeScanner *scanner) {
  skip_space(scanner);
  return scanner->at < scanner->end && scanner->line == scanner->word_line;
}

gboolean spore_scanner_is(const SporeScanner *scanner, const char *text) {
  return scanner->word && scanner->length == strlen(text) && !g_ascii_strncasecmp(scanner->word, text, scanner->length);
}

void spore_scanner_skip_line(SporeScanner *scanner) {
  if (scanner->line != scanner->word_line) return;
  while (scanner->at < scanner->end && *scanner->at != '\n') scanner->at++;
}

static gsize bytes_left(const SporeScanner *scanner) { return (gsize)(scanner->end - scanner->at); }

gboolean spore_scanner_fail(const SporeScanner *scanner, GError **error, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  char *message = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  char *place = g_strdup_printf("%s:%u:%u", scanner->place, scanner->word_line, scanner->word_column);
  spore_error_raise(error, SPORE_ERROR_INPUT, place, "%s", message);
  g_free(place);
  g_free(message);
  return FALSE;
}

/* The last word as messages show it: short, and valid UTF-8 whatever the file holds. */
static char *shown_word(const SporeScanner *scanner) {
  char *shown = g_utf8_make_valid(scanner->word, (gssize)MIN(scanner->length, 40));
  for (char *c = shown; *c; c++)
    if ((unsigned char)*c < ' ') *c = '?';
  return shown;
}

static gboolean fail_at_word(const SporeScanner *scanner, const char *what, GError **error) {
  if (!scanner->word)
    return spore_scanner_fail(
        scanner, error, _("the file ends here; expected %s; write or copy the file again, it may be cut short"), what);
  char *shown = shown_word(scanner);
  spore_scanner_fail(scanner, error, _("\"%s\" is not %s; expected a finite number; correct the file"), shown, what);
  g_free(shown);
  return FALSE;
}

gboolean spore_scanner_real(SporeScanner *scanner, const char *what, double *value, GError **error) {
  double number;
  if (!spore_scanner_next(scanner) || spore_number_read(scanner->word, scanner->length, &number) != scanner->length ||
      !isfinite(number))
    return fail_at_word(scanner, what, error);
  *value = number;
  return TRUE;
}

gboolean spore_scanner_integer(SporeScanner *scanner, const char *what, guint64 minimum, guint64 maximum,
                               guint64 *value, GError **error) {
  guint64 number = 0;
  gboolean digits = spore_scanner_next(scanner) && scanner->length <= 18;
  for (gsize i = 0; digits && i < scanner->length; i++) {
    digits = g_ascii_isdigit(scanner->word[i]);
    number = number * 10 + (guint64)(scanner->word[i] - '0');
  }
  if (digits && number >= minimum && number <= maximum) {
    *value = number;
    return TRUE;
  }
  if (!scanner->word) return fail_at_word(scanner, what, error);
  char *shown = shown_word(scanner);
  if (maximum < minimum)
    spore_scanner_fail(scanner, error, _("\"%s\" is not %s; there is none that it could name; correct the file"), shown,
                       what);
  else
    spore_scanner_fail(scanner, error,
                       _("\"%s\" is not %s; expected a whole number from %llu to %llu; correct the file"), shown, what,
                       (unsigned long long)minimum, (unsigned long long)maximum);
  g_free(shown);
  return FALSE;
}

gboolean spore_scanner_count(SporeScanner *scanner, const char *what, gsize bytes, gsize *count, GError **error) {
  guint64 number;
  if (!spore_scanner_integer(scanner, what, 0, SPORE_MESH_MAXIMUM, &number, error)) return FALSE;
  if (number > bytes_left(scanner) / bytes + 1)
    return spore_scanner_fail(scanner, error,
                              _("the file is too short for %s of %llu; expected all of them; write or copy the file "
                                "again, it may be cut short"),
                              what, (unsigned long long)number);
  *count = (gsize)number;
  return TRUE;
}

void spore_append_reals(GString *text, const double *values, gsize rows, gsize width, const char *ending) {
  char number[SPORE_NUMBER_TEXT];
  for (gsize i = 0; i < rows * width; i++) {
    int length = spore_number_format(values[i], number);
    g_string_append_len(text, number, length);
    g_string_append(text, (i + 1) % width ? " " : ending);
    if ((i + 1) % width == 0) g_string_append_c(text, '\n');
  }
}
