/* Quantiles of measured numbers, by sorting. */
#include "core/measure/quantile.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

static int compare_numbers(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

double spore_quantile(double *numbers, size_t count, double share) {
  assert(share >= 0 && share <= 1);
  if (count == 0) return NAN;
  qsort(numbers, count, sizeof *numbers, compare_numbers);
  double at = share * (double)(count - 1);
  size_t low = (size_t)at, high = low + 1 < count ? low + 1 : low;
  return numbers[low] + (at - (double)low) * (numbers[high] - numbers[low]);
}
