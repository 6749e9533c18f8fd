/* Makes GErrors of the kernel's errors, and exit statuses of GErrors. */
#include "core/scene/error.h"

#include <stdarg.h>

G_DEFINE_QUARK(spore - error - quark, spore_error)

/* Makes a message one line of valid text, since it may quote any bytes of a file. Takes ownership of the message. */
static char *one_line(char *message) {
  char *valid = g_utf8_make_valid(message, -1);
  g_free(message);
  for (char *c = valid; *c; c++)
    if ((unsigned char)*c < ' ' || *c == 127) *c = ' ';
  return valid;
}

gboolean spore_error_propagate(const SporeError *from, GError **error) {
  return spore_error_raise(error, from->code, from->place, "%s", from->message);
}

gboolean spore_error_raise(GError **error, SporeErrorCode code, const char *place, const char *format, ...) {
  if (!error) return FALSE;
  va_list arguments;
  va_start(arguments, format);
  g_autofree char *message = one_line(g_strdup_vprintf(format, arguments));
  va_end(arguments);
  if (place && *place) g_set_error(error, SPORE_ERROR, (int)code, "%s: %s", place, message);
  else g_set_error_literal(error, SPORE_ERROR, (int)code, message);
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
