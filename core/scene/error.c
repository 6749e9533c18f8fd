/* Makes GErrors of the kernel's errors, and exit statuses of GErrors. */
#include "core/scene/error.h"

#include <stdarg.h>
#include <string.h>

G_DEFINE_QUARK(spore - error - quark, spore_error)

/* A line may quote a name of any length from a file. Its beginning says what is wrong, and its end what to do. */
#define LONGEST 5000 /* bytes; the longest path of a file is 4096 */
#define BEGINNING 700
#define ENDING 300

static char *without_middle(char *line) {
  gsize length = strlen(line);
  if (length <= LONGEST) return line;
  const char *middle = g_utf8_find_prev_char(line, line + BEGINNING + 1);
  const char *rest = g_utf8_find_next_char(line + length - ENDING - 1, NULL);
  char *shorter = g_strdup_printf("%.*s … %s", (int)(middle - line), line, rest);
  g_free(line);
  return shorter;
}

/* A line may quote any bytes of a file. */
char *spore_error_line(char *text) {
  char *valid = g_utf8_make_valid(text, -1);
  g_free(text);
  for (char *c = valid; *c; c++)
    if ((unsigned char)*c < ' ' || *c == 127) *c = ' ';
  return without_middle(valid);
}

gboolean spore_error_propagate(const SporeError *from, GError **error) {
  return spore_error_raise(error, from->code, from->place, "%s", from->message);
}

gboolean spore_error_raise(GError **error, SporeErrorCode code, const char *place, const char *format, ...) {
  if (!error) return FALSE;
  va_list arguments;
  va_start(arguments, format);
  char *message = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  gboolean placed = place && *place;
  g_autofree char *line = spore_error_line(placed ? g_strdup_printf("%s: %s", place, message) : g_strdup(message));
  g_free(message);
  g_set_error_literal(error, SPORE_ERROR, (int)code, line);
  return FALSE;
}

int spore_error_exit_status(const GError *error) {
  if (error->domain != SPORE_ERROR)
    return 2; /* an error of a library: about files or options, which the user can mend */
  switch ((SporeErrorCode)error->code) {
  case SPORE_ERROR_NUMERICAL:
  case SPORE_ERROR_CANCELLED:
    return 1;
  case SPORE_ERROR_NONE:
  case SPORE_ERROR_INTERNAL:
    return 3;
  default:
    return 2;
  }
}
