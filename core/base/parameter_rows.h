/* Rows that many parameter tables share. For C files that declare a table; N_ marks the texts. */
#ifndef SPORE_BASE_PARAMETER_ROWS_H
#define SPORE_BASE_PARAMETER_ROWS_H

#include <stddef.h>

#include "core/base/parameter.h"

#define SPORE_POSITION_MAXIMUM_M 1e6 /* beyond it a double no longer resolves a nanometre */

/* Type: the structure that the table describes. field: its member, named as in the file; where the member's name
 * differs, it follows. */
#define SPORE_ROW_NAME(Type, member, text)                                                                             \
  { .name = "name", .type = SPORE_NAME, .unit = "", .offset = offsetof(Type, member), .required = true, .doc = text }
#define SPORE_ROW_REFERENCE(Type, field, member, elements, text)                                                       \
  {                                                                                                                    \
    .name = #field, .type = SPORE_REFERENCE, .unit = "", .references = elements, .offset = offsetof(Type, member),     \
    .change = SPORE_CHANGE_REBUILD, .doc = text                                                                        \
  }
#define SPORE_ROW_BODY(Type, field, member, text) SPORE_ROW_REFERENCE(Type, field, member, "body", text)
/* The device of a tool, whose fields begin with SporeToolFields. */
#define SPORE_ROW_DEVICE(Type)                                                                                         \
  SPORE_ROW_REFERENCE(Type, device, tool.device, "mouse|track", N_("Device that moves the tool."))
#define SPORE_ROW_PLACE(Type, field, text) SPORE_ROW_PLACE_AT(Type, field, field, text)
#define SPORE_ROW_PLACE_AT(Type, field, member, text)                                                                  \
  {                                                                                                                    \
    .name = #field, .type = SPORE_VECTOR, .unit = "m", .minimum = -SPORE_POSITION_MAXIMUM_M,                           \
    .maximum = SPORE_POSITION_MAXIMUM_M, .offset = offsetof(Type, member), .change = SPORE_CHANGE_REBUILD, .doc = text \
  }
#define SPORE_ROW_DIRECTION(Type, field, x, y, z, text)                                                                \
  {                                                                                                                    \
    .name = #field, .type = SPORE_VECTOR, .unit = "", .minimum = -SPORE_POSITION_MAXIMUM_M,                            \
    .maximum = SPORE_POSITION_MAXIMUM_M, .initial = {x, y, z}, .offset = offsetof(Type, field),                        \
    .change = SPORE_CHANGE_REBUILD, .doc = text                                                                        \
  }
#define SPORE_ROW_REAL(Type, field, unit_text, least, most, start, text)                                               \
  {                                                                                                                    \
    .name = #field, .type = SPORE_REAL, .unit = unit_text, .minimum = least, .maximum = most, .initial = {start},      \
    .offset = offsetof(Type, field), .change = SPORE_CHANGE_REBUILD, .doc = text                                       \
  }
#define SPORE_ROW_COUNT(Type, field, least, most, start, text)                                                         \
  {                                                                                                                    \
    .name = #field, .type = SPORE_INTEGER, .unit = "", .minimum = least, .maximum = most, .initial = {start},          \
    .offset = offsetof(Type, field), .change = SPORE_CHANGE_REBUILD, .doc = text                                       \
  }
#define SPORE_ROW_CHOICE(Type, field, names, text)                                                                     \
  {                                                                                                                    \
    .name = #field, .type = SPORE_CHOICE, .unit = "", .minimum = 0, .maximum = sizeof names / sizeof *names - 2,       \
    .choices = names, .offset = offsetof(Type, field), .change = SPORE_CHANGE_REBUILD, .doc = text                     \
  }
/* A table of all rows of an array. */
#define SPORE_TABLE(rows, Type)                                                                                        \
  { rows, sizeof rows / sizeof *rows, sizeof(Type) }

#endif
