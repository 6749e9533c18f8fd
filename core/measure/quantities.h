/* Quantities of a running world: one table, from which the command line, files of numbers and the editor's plots take
 * names, units, columns and explanations.
 *
 * A quantity has a few parts (of a force: x, y, z), and is measured once, or once for each item of a kind (link, body,
 * stage, watched point). Each part of each item is a column of numbers. */
#ifndef SPORE_MEASURE_QUANTITIES_H
#define SPORE_MEASURE_QUANTITIES_H

#include "core/measure/watch.h"

typedef struct SporeMeasurement SporeMeasurement;

/* When a quantity is measured. */
typedef enum SporeQuantityUse {
  SPORE_QUANTITY_ALWAYS, /* time alone */
  SPORE_QUANTITY_USUAL,  /* where nothing is chosen; these depend on the scene and its input, never on the clock */
  SPORE_QUANTITY_ASKED   /* only where it is chosen */
} SporeQuantityUse;

/* Name and unit of a part. unit: "" of a count or a ratio. */
typedef struct SporeQuantityPart {
  const char *name, *unit;
} SporeQuantityPart;

typedef struct SporeQuantity {
  const char *name; /* as in --quantities: "energy" */
  const char *doc;  /* translatable, without a full stop */
  SporeQuantityUse use;
  size_t part_count;
  const SporeQuantityPart *parts;
  /* Number of items, and the name of one, NULL where that item has no such quantity. NULL: measured once. */
  size_t (*items)(const SporeMeasurement *measurement);
  const char *(*item)(const SporeMeasurement *measurement, size_t i);
  /* Fills part_count values of item i. A value that is not known is not a number. */
  void (*measure)(SporeMeasurement *measurement, size_t i, double *values);
} SporeQuantity;

#define SPORE_QUANTITY_COUNT 14
extern const SporeQuantity spore_quantities[SPORE_QUANTITY_COUNT];

/* Index of the quantity of that name; SPORE_QUANTITY_COUNT: there is none. */
size_t spore_quantity_find(const char *name, size_t length);

/* A column: QUANTITY.ITEM.PART, such as "energy.kinetic" or "links.hinge.x". */
typedef struct SporeColumn {
  char *name;
  const char *unit;
  size_t quantity, item; /* index in spore_quantities; of the item of that quantity */
} SporeColumn;

/* A point to be watched, by the name that its columns get: "liver@0.01,0,0.02". */
typedef struct SporeWatchRequest {
  const char *name; /* copied */
  uint32_t body;
  SporeVec3 at; /* world at time 0, m */
} SporeWatchRequest;

/* Measures a world, which is borrowed, at time 0 now. chosen: one flag for each of spore_quantities; NULL: the usual
 * ones. Time is always measured, and so are the points. NULL with the error: no memory, or a body cannot carry its
 * point; the error's place is the point's name. */
SporeMeasurement *spore_measurement_create(const SporeWorld *world, const bool *chosen, const SporeWatchRequest *points,
                                           size_t point_count, SporeError *error);
void spore_measurement_free(SporeMeasurement *measurement); /* NULL is allowed */
/* The columns, in the order of the table; owned by the measurement. */
const SporeColumn *spore_measurement_columns(const SporeMeasurement *measurement, size_t *count);
/* Measures the present state, and what the last step did: one value a column. Belongs to the thread that steps. Takes
 * no memory. The energy costs as much as an evaluation of the forces. */
void spore_measurement_take(SporeMeasurement *measurement, double *row);

#endif
