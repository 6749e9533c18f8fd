/* Why a helper failed. */
#include "app/helpers/failure.h"

#include <stdarg.h>
#include <stdio.h>

bool spore_helper_fail(SporeHelperFailure *failure, const char *message, const char *detail, ...) {
  va_list arguments;
  va_start(arguments, detail);
  failure->code = SPORE_ERROR_INPUT;
  failure->message = message;
  vsnprintf(failure->detail, sizeof failure->detail, detail, arguments);
  va_end(arguments);
  return false;
}
