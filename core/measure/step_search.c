/* Bisection for the largest safe step, around the step that is predicted. */
#include "core/measure/step_search.h"

#include <assert.h>
#include <math.h>

#define FALLS 6 /* steps below the range, each half of the one before, where no step of the range was safe */

typedef struct Search {
  SporeStepFound found;
  int (*is_safe)(void *data, double step_s);
  void *data;
  bool ended;
} Search;

/* True: the step is safe. */
static bool try_step(Search *search, double step_s) {
  if (search->ended) return false;
  int safe = search->is_safe(search->data, step_s);
  search->ended = safe < 0;
  if (search->ended) return false;
  search->found.tries++;
  if (safe) search->found.safe_s = fmax(search->found.safe_s, step_s);
  else search->found.unsafe_s = fmin(search->found.unsafe_s, step_s);
  return safe;
}

static void cut(Search *search, double low, double high, size_t cuts) {
  assert(low > 0 && high >= low);
  for (size_t i = 0; i < cuts && !search->ended; i++) {
    double middle = sqrt(low * high);
    if (try_step(search, middle)) low = middle;
    else high = middle;
  }
}

SporeStepFound spore_step_search(const SporeStepSearch *search, int (*is_safe)(void *data, double step_s), void *data) {
  assert(search->usual_s > 0 && search->largest_s >= search->usual_s && is_safe);
  Search state = {.found = {.unsafe_s = HUGE_VAL}, .is_safe = is_safe, .data = data};
  double largest = search->largest_s, predicted = search->predicted_s;
  bool bounded = predicted > 0 && predicted < largest;
  double low = bounded ? 0.5 * predicted : search->usual_s, high = bounded ? fmin(2 * predicted, largest) : largest;
  if (predicted > 0 && !bounded && try_step(&state, largest)) return state.found;
  if (predicted > 0) cut(&state, low, high, search->cuts);
  for (int i = 0; i < FALLS && state.found.safe_s == 0 && !state.ended; i++, low *= 0.5) try_step(&state, low);
  return state.found;
}
