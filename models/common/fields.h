/* Short forms for the models' parameter tables. */
#ifndef SPORE_MODELS_COMMON_FIELDS_H
#define SPORE_MODELS_COMMON_FIELDS_H

#include "core/base/parameter.h"

/* Entry of a parameter table for a double that is named like its field. */
#define SPORE_REAL_FIELD(Fields, field, unit_, minimum_, maximum_, initial_, change_, doc_)                            \
  {                                                                                                                    \
    .name = #field, .type = SPORE_REAL, .unit = unit_, .minimum = minimum_, .maximum = maximum_,                       \
    .initial = {initial_}, .offset = offsetof(Fields, field), .change = change_, .doc = doc_                           \
  }

/* The same for an int64_t. */
#define SPORE_INTEGER_FIELD(Fields, field, minimum_, maximum_, initial_, change_, doc_)                                \
  {                                                                                                                    \
    .name = #field, .type = SPORE_INTEGER, .unit = "", .minimum = minimum_, .maximum = maximum_,                       \
    .initial = {initial_}, .offset = offsetof(Fields, field), .change = change_, .doc = doc_                           \
  }

#endif
