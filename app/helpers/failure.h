/* Why a library failed, passed from C++ to C. */
#ifndef SPORE_HELPERS_FAILURE_H
#define SPORE_HELPERS_FAILURE_H

#include "core/base/error.h"

typedef struct SporeHelperFailure {
  SporeErrorCode code;
  const char *message; /* marked for translation */
  char detail[256];    /* message of the library; may be empty */
} SporeHelperFailure;

#endif
