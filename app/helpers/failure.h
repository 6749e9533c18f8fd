/* Why a library failed, passed from C++ to C. */
#ifndef SPORE_HELPERS_FAILURE_H
#define SPORE_HELPERS_FAILURE_H

#include <stdbool.h>

#include "core/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SporeHelperFailure {
  SporeErrorCode code;
  const char *message; /* marked for translation */
  char detail[256];    /* message of the library; may be empty */
} SporeHelperFailure;

/* Fills the failure, as one of the input, and returns false. detail: a format, may be "". */
bool spore_helper_fail(SporeHelperFailure *failure, const char *message, const char *detail, ...)
    __attribute__((format(printf, 3, 4)));

#ifdef __cplusplus
}
#endif

#endif
