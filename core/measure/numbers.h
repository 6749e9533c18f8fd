/* Numbers over time: rows of a measurement, and the files made of them. */
#ifndef SPORE_MEASURE_NUMBERS_H
#define SPORE_MEASURE_NUMBERS_H

#include "core/measure/quantities.h"

/* Rows in the order in which they were added. All zero but for `measurement`: no rows. */
typedef struct SporeNumbers {
  SporeMeasurement *measurement; /* borrowed */
  size_t row_count, capacity;
  double *values; /* row_count x number of columns */
} SporeNumbers;

/* Measures the present state into a new row. False: no memory; the rows so far stay. */
bool spore_numbers_add(SporeNumbers *numbers);
/* Adds a row that was measured already. False: no memory. */
bool spore_numbers_add_row(SporeNumbers *numbers, const double *row);
/* Keeps the first row and every second one after it. */
void spore_numbers_thin(SporeNumbers *numbers);
void spore_numbers_clear(SporeNumbers *numbers);

/* The numbers as text, to be freed with spore_free; numbers are in the C locale, the shortest that read back to the
 * same bits. NULL: no memory. */
/* CSV as RFC 4180 has it: a line of names, each with its unit ("energy.total [J]"), then a line a row. What is not
 * finite is nan, inf or -inf. */
char *spore_numbers_csv(const SporeNumbers *numbers, size_t *size);
/* A JSON object: scene, dt_s, columns[{name, unit}], rows[[...]]; null for what is not finite. scene: UTF-8. */
char *spore_numbers_json(const SporeNumbers *numbers, const char *scene, double dt_s, size_t *size);

#endif
