/* Tables of rows: what a runtime file keeps of each structure, member by member, for writing and reading alike. */
#ifndef SPORE_RUNTIME_ROWS_H
#define SPORE_RUNTIME_ROWS_H

#include "core/runtime/runtime.h"

/* What a member is. */
typedef enum SporeRowKind {
  SPORE_ROW_SKIPPED,     /* a pointer or number that is not kept: loading makes it anew */
  SPORE_ROW_OPTION,      /* the same of a flag */
  SPORE_ROW_REAL,        /* a double */
  SPORE_ROW_REALS,       /* a structure or array of `repeat` doubles */
  SPORE_ROW_WORD,        /* a uint32_t */
  SPORE_ROW_WIDE,        /* a uint64_t */
  SPORE_ROW_SIZE,        /* a size_t */
  SPORE_ROW_CHOICE,      /* an int or enum of least to most */
  SPORE_ROW_FLAG,        /* a bool */
  SPORE_ROW_BODY,        /* a uint32_t: a body, or SPORE_NO_BODY */
  SPORE_ROW_BODIES,      /* an array of `repeat` of these */
  SPORE_ROW_TEXT,        /* a pointer to text; NULL: none */
  SPORE_ROW_RECORD,      /* a structure of `table` */
  SPORE_ROW_FIELDS,      /* a structure of `parameters` */
  SPORE_ROW_TYPE,        /* a pointer to one of `types`; NULL: none */
  SPORE_ROW_TYPE_FIELDS, /* a pointer to a structure of the parameters of the type in the first member */
  SPORE_ROW_TYPE_VALUES, /* such a structure itself */
  SPORE_ROW_POINTER      /* a pointer to `repeat` elements (kind `element`) times the count at `count`; NULL: none */
} SporeRowKind;

#define SPORE_ROW_ONCE SIZE_MAX /* in place of the offset of a count: the elements are `repeat` */

/* How the types of a kind are found and named. */
typedef struct SporeRowTypes {
  const void *(*find)(SporeModelRegistry registry, const char *name);
  const char *(*name)(const void *type);
  const SporeParameterTable *(*parameters)(const void *type);
} SporeRowTypes;

typedef struct SporeRowTable SporeRowTable;
/* A member. */
typedef struct SporeRow {
  const char *name;
  SporeRowKind kind;
  size_t offset, repeat;
  int least, most;
  SporeRowKind element;
  size_t count; /* offset of a size_t in the same structure, or SPORE_ROW_ONCE */
  const SporeRowTable *table;
  const SporeParameterTable *parameters;
  const SporeRowTypes *types;
} SporeRow;
/* A structure: all its members, in their order. */
struct SporeRowTable {
  const char *name;
  size_t size, count;
  const SporeRow *rows;
};

extern const SporeRowTable spore_rows_scene; /* of SporeRuntimeScene */

/* Hash of all that the layout of a file follows from, but for parameter tables. */
uint64_t spore_rows_signature(void);
/* The same of a parameter table: names and types. */
uint64_t spore_parameters_signature(const SporeParameterTable *table);

#endif
