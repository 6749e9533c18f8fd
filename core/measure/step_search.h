/* Search for the largest step that is safe, by bisection. */
#ifndef SPORE_MEASURE_STEP_SEARCH_H
#define SPORE_MEASURE_STEP_SEARCH_H

#include <stdbool.h>
#include <stddef.h>

/* Where to look. */
typedef struct SporeStepSearch {
  double predicted_s; /* the expected answer; infinite: every step is expected to be safe; 0: none is */
  double usual_s;     /* a step that is tried where nothing is predicted */
  double largest_s;   /* no step above it is tried */
  size_t cuts;        /* of the range between a safe step and one of twice its size, or less, that is not */
} SporeStepSearch;

/* What was found. */
typedef struct SporeStepFound {
  double safe_s;   /* the largest step that was tried and safe; 0: none was */
  double unsafe_s; /* the smallest step that was tried and not safe; infinite: none was */
  size_t tries;
} SporeStepFound;

/* Calls `is_safe` for the predicted step, for others each twice or half as large until one is safe and one is not, and
 * for steps between these, each in the middle of the ratios, until the range is cut. `is_safe` returns 1 where the step
 * is safe, 0 where it is not, and less than 0 to end the search: what was found until then is returned. */
SporeStepFound spore_step_search(const SporeStepSearch *search, int (*is_safe)(void *data, double step_s), void *data);

#endif
