/* Bisection for the largest safe step, around the step that is predicted. */
#include "core/measure/step_search.h"

#include <assert.h>
#include <math.h>

#define DOUBLINGS 6 /* up or down, until there is a safe step and one that is not */

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

/* Steps twice as large each, until one is not safe. */
static void rise(Search *search, double step_s, double largest_s) {
  for (int i = 0; i < DOUBLINGS && step_s < largest_s; i++) {
    step_s = fmin(2 * step_s, largest_s);
    if (!try_step(search, step_s)) return;
  }
}

/* Steps half as large each, until one is safe. */
static void fall(Search *search, double step_s) {
  for (int i = 0; i < DOUBLINGS && !search->ended; i++)
    if (try_step(search, step_s *= 0.5)) return;
}

static void cut(Search *search, size_t cuts) {
  if (search->found.safe_s == 0 || isinf(search->found.unsafe_s)) return;
  double low = search->found.safe_s, high = search->found.unsafe_s;
  for (size_t i = 0; i < cuts && !search->ended; i++) {
    double middle = sqrt(low * high);
    if (try_step(search, middle)) low = middle;
    else high = middle;
  }
}

SporeStepFound spore_step_search(const SporeStepSearch *search, int (*is_safe)(void *data, double step_s), void *data) {
  assert(search->usual_s > 0 && search->largest_s >= search->usual_s && is_safe);
  Search state = {.found = {.unsafe_s = HUGE_VAL}, .is_safe = is_safe, .data = data};
  double largest = search->largest_s, first = search->predicted_s > 0 ? search->predicted_s : search->usual_s;
  /* Where all steps are expected to be safe, the largest one shows that at once. */
  if (first >= largest && try_step(&state, largest)) return state.found;
  if (first >= largest) first = search->usual_s;
  if (try_step(&state, first)) rise(&state, first, largest);
  else fall(&state, first);
  cut(&state, search->cuts);
  return state.found;
}
