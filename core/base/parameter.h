/* The one table. A model, link, effect, integrator, generator, device or scene object declares each of its
 * parameters once; the file format, schema, command line, inspector, undo and documentation all read it here. */
#ifndef SPORE_BASE_PARAMETER_H
#define SPORE_BASE_PARAMETER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/base/error.h"

/* What a parameter holds, and the C type of its field. */
typedef enum SporeParameterType {
  SPORE_REAL,      /* double */
  SPORE_INTEGER,   /* int64_t */
  SPORE_BOOLEAN,   /* bool */
  SPORE_VECTOR,    /* double[3] */
  SPORE_CHOICE,    /* int: index into choices */
  SPORE_TEXT,      /* const char *: free text; the struct borrows it from whoever filled it */
  SPORE_FILE,      /* const char *: a path inside the scene's folder */
  SPORE_REFERENCE, /* const char *: the name of another object; `references` says of which kinds */
  SPORE_NAME       /* const char *: the object's own name: [A-Za-z_][A-Za-z0-9_.-]*, unique per kind */
} SporeParameterType;

/* What a change needs while a simulation runs. */
typedef enum SporeParameterChange {
  SPORE_CHANGE_LIVE,    /* the running world takes it */
  SPORE_CHANGE_REBUILD, /* the world is compiled again, the state carried over */
  SPORE_CHANGE_RESTART  /* the simulation starts again from time 0 */
} SporeParameterChange;

/* One parameter: a row of the table. */
typedef struct SporeParameter {
  const char *name; /* as in the file: lower case, words joined by _ */
  SporeParameterType type;
  const char *unit;           /* "m", "N/m", "kg/m^3", ...; "" without a unit */
  double minimum, maximum;    /* inclusive, for numbers and each component of a vector; -HUGE_VAL, HUGE_VAL: open */
  double initial[3];          /* default: [0] for a number, boolean or choice */
  const char *initial_text;   /* default of a text; NULL: none, and required where `required` */
  const char *const *choices; /* NULL-terminated, for SPORE_CHOICE */
  const char *references;     /* element names joined by |, for SPORE_REFERENCE, e.g. "mesh|tetrahedra" */
  size_t offset;              /* of the field in the structure that the table describes */
  bool required;              /* the author must set it: there is no sensible default */
  SporeParameterChange change;
  const char *doc; /* one sentence, translatable (N_) */
} SporeParameter;

/* All parameters of one structure. */
typedef struct SporeParameterTable {
  const SporeParameter *parameters;
  size_t count;
  size_t size; /* sizeof the described structure */
} SporeParameterTable;

/* A value apart from any structure. text is owned by the value: from spore_allocate, given back by
 * spore_value_clear. */
typedef struct SporeValue {
  SporeParameterType type;
  double number[3]; /* real, vector; integer, boolean and choice in [0], exactly */
  char *text;
} SporeValue;

/* Index of the parameter of that name, or -1. */
int spore_parameter_find(const SporeParameterTable *table, const char *name);
/* The name in the table nearest to `name` by edit distance, or NULL when none is near. */
const char *spore_parameter_nearest(const SporeParameterTable *table, const char *name);

/* Frees the text; the value is then free to be overwritten. */
void spore_value_clear(SporeValue *value);
bool spore_value_copy(SporeValue *to, const SporeValue *from);    /* `to` holds nothing before; false: no memory */
bool spore_value_equal(const SporeValue *a, const SporeValue *b); /* bitwise for numbers */

/* The default of a parameter. */
bool spore_parameter_initial(const SporeParameter *parameter, SporeValue *value);
/* Reads text as it stands in a file and checks it against type, range and choices. Numbers are decimal in the C
 * locale's form, those of a vector apart by blanks; an integer has neither point nor exponent and lies within +-2^53;
 * a boolean is true or false; blanks around anything but free text do not count.
 * On success *value is overwritten (what it held is not freed). On failure *value is untouched and the message says
 * value, range with unit and nearest choice. */
bool spore_parameter_parse(const SporeParameter *parameter, const char *text, SporeValue *value, SporeError *error);
/* Checks a value that did not come from text (inspector, API): finite, in range, of the right type. */
bool spore_parameter_check(const SporeParameter *parameter, const SporeValue *value, SporeError *error);
/* Writes the shortest text that spore_parameter_parse reads back to the same bits. Returns its length as
 * snprintf does. */
int spore_parameter_format(const SporeParameter *parameter, const SporeValue *value, char *text, size_t size);

/* Structure side: `fields` points to a structure of table->size bytes. */
void spore_parameters_set_initial(const SporeParameterTable *table, void *fields); /* texts: initial_text */
void spore_parameter_store(const SporeParameter *parameter, const SporeValue *value, void *fields); /* borrows text */
SporeValue spore_parameter_load(const SporeParameter *parameter, const void *fields);               /* borrowing text */
/* spore_parameter_check of every field of the structure; the message names the parameter. */
bool spore_parameters_check(const SporeParameterTable *table, const void *fields, SporeError *error);

#endif
