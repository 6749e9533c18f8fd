/* Quantiles of measured numbers. */
#ifndef SPORE_MEASURE_QUANTILE_H
#define SPORE_MEASURE_QUANTILE_H

#include <stddef.h>

/* The value below which a share (0..1) of the numbers lies, interpolated between two of them; 0.5: the median. Sorts
 * the numbers, which are not NAN. NAN where there are none. */
double spore_quantile(double *numbers, size_t count, double share);

#endif
