/* Numbers over time: rows of a measurement, and the files made of them. */
#ifndef SPORE_MEASURE_SERIES_H
#define SPORE_MEASURE_SERIES_H

#include "core/measure/quantities.h"

/* Rows in the order in which they were added; all zero but for `measurement` is an empty series. */
typedef struct SporeSeries {
  SporeMeasurement *measurement; /* borrowed */
  size_t row_count, capacity;
  double *values; /* row_count x number of columns */
} SporeSeries;

/* Measures the present state into a new row. False: no memory; the rows so far stay. */
bool spore_series_add(SporeSeries *series);
void spore_series_clear(SporeSeries *series);

/* The series as text, to be freed with spore_free; numbers are in the C locale, the shortest that read back to the same
 * bits. NULL: no memory. */
/* CSV as RFC 4180 has it: a line of names, each with its unit ("energy.total [J]"), then a line a row. What is not
 * finite is nan, inf or -inf. */
char *spore_series_csv(const SporeSeries *series, size_t *size);
/* A JSON object: scene, dt_s, columns[{name, unit}], rows[[...]]; null for what is not finite. scene: UTF-8. */
char *spore_series_json(const SporeSeries *series, const char *scene, double dt_s, size_t *size);

#endif
