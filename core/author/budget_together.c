/* Several changes of a choice at once. Two bodies that share a budget may have to change together: the one to what
 * costs less, the other to what is nearer, where either change alone is no better. What each change did alone tells
 * what several of them do: errors of bodies add up by their squares, costs of bodies add up, and a step or a solver
 * multiplies the cost. That is a forecast. The best few forecasts are run, and the runs decide. */
#include <math.h>

#include "core/author/budget_private.h"

#define WIDTH 32 /* sets of changes that are kept while the beam grows */
#define RUNS 6   /* sets that are run */

/* What a choice sets: levels of the bodies, then their integrators, then these of the whole scene. */
enum { STEP, NONLINEAR, LINEAR, WHOLE_COUNT };

static gboolean is_of_body(const SporeBudgetSearch *search, gsize field) { return field < 2 * search->count; }

/* The setting of a field that is no step. */
static int *setting_of(const SporeBudgetSearch *search, SporeBudgetChoice *choice, gsize field) {
  if (field < search->count) return &choice->level[field];
  if (is_of_body(search, field)) return &choice->integrator[field - search->count];
  return field - 2 * search->count == NONLINEAR ? &choice->nonlinear : &choice->linear;
}

/* Gives a choice what another one sets in a field. TRUE: that is something else. */
static gboolean take(const SporeBudgetSearch *search, SporeBudgetChoice *to, SporeBudgetChoice *from, gsize field) {
  if (field == 2 * search->count + STEP) {
    gboolean other = fabs(to->dt_s / from->dt_s - 1) > 1e-9;
    to->dt_s = from->dt_s;
    return other;
  }
  int *setting = setting_of(search, to, field), wanted = *setting_of(search, from, field);
  gboolean other = *setting != wanted;
  *setting = wanted;
  return other;
}

/* The one field in which a choice differs from the base. -1: in none, or in several. */
static gssize only_field(const SporeBudgetSearch *search, SporeBudgetChoice *base, SporeBudgetChoice *choice) {
  SporeBudgetChoice *copy = spore_budget_choice_copy(search, base);
  gssize found = -1;
  gsize changes = 0;
  for (gsize field = 0; field < 2 * search->count + WHOLE_COUNT; field++)
    if (take(search, copy, choice, field)) found = (gssize)field, changes++;
  spore_budget_choice_free(copy);
  return changes == 1 ? found : -1;
}

/* A set of changes of the base, and what they do by forecast. */
typedef struct Set {
  SporeBudgetChoice *choice;
  guint changes;
  double square; /* of the error */
  double more;   /* cost of bodies beyond the base's, s on the processor for a simulated s */
  double factor; /* of step and solvers on the cost */
} Set;

static void clear_set(gpointer data) { spore_budget_choice_free(((Set *)data)->choice); }

static double cost_of(const SporeBudgetChoice *base, const Set *set) {
  return (base->point.cost + set->more) * set->factor;
}

static double square_of(const SporeBudgetSearch *search, const SporeAccuracyPoint *point) {
  double error = fmax(point->error, search->report->floor);
  return error * error;
}

/* The set with one more change. */
static Set with(const SporeBudgetSearch *search, const SporeBudgetChoice *base, const Set *set,
                SporeBudgetChoice *change, gsize field) {
  Set more = *set;
  double floor = search->report->floor;
  more.choice = spore_budget_choice_copy(search, set->choice);
  more.changes++;
  take(search, more.choice, change, field);
  more.square += square_of(search, &change->point) - square_of(search, &base->point);
  more.square = fmax(more.square, floor * floor);
  if (is_of_body(search, field)) more.more += change->point.cost - base->point.cost;
  else more.factor *= change->point.cost / base->point.cost;
  return more;
}

static int compare_costs(gconstpointer a, gconstpointer b, gpointer base) {
  double x = cost_of(base, a), y = cost_of(base, b);
  return (x > y) - (x < y);
}

/* Leaves of the sets those than which no other is forecast to be nearer and cheaper, and of these WIDTH at most, evenly
 * from the cheapest to the nearest. */
static void thin(GArray *sets, SporeBudgetChoice *base) {
  double least = HUGE_VAL;
  g_array_sort_with_data(sets, compare_costs, base);
  for (guint i = 0; i < sets->len;) {
    double square = g_array_index(sets, Set, i).square;
    if (square < least) least = square, i++;
    else g_array_remove_index(sets, i);
  }
  if (sets->len <= WIDTH) return;
  Set *all = (Set *)(gpointer)sets->data;
  for (guint i = 0; i < WIDTH; i++) {
    guint from = i * (sets->len - 1) / (WIDTH - 1);
    const Set kept = all[from];
    all[from] = all[i];
    all[i] = kept;
  }
  g_array_set_size(sets, WIDTH);
}

/* Grows the beam by all changes of one field that were run alone. */
static void grow(const SporeBudgetSearch *search, SporeBudgetChoice *base, gsize field, GArray *sets) {
  guint before = sets->len;
  for (guint i = 0; i < search->tried->len; i++) {
    SporeBudgetChoice *change = search->tried->pdata[i];
    if (only_field(search, base, change) != (gssize)field || !spore_budget_choice_is_valid(search, change)) continue;
    for (guint k = 0; k < before; k++) {
      const Set more = with(search, base, &g_array_index(sets, Set, k), change, field);
      g_array_append_val(sets, more);
    }
  }
  thin(sets, base);
}

/* The set of several changes with the best forecast that was not tried; NULL: none is forecast to be better. */
static const Set *best_forecast(const SporeBudgetSearch *search, const SporeBudgetChoice *base, const GArray *sets) {
  const Set *best = NULL;
  for (guint i = 0; i < sets->len; i++) {
    const Set *set = &g_array_index(sets, Set, i);
    SporeBudgetChoice *choice = set->choice;
    if (set->changes < 2 || spore_budget_was_tried(search, choice)) continue;
    choice->point =
        (SporeAccuracyPoint){.error = sqrt(set->square), .cost = cost_of(base, set), .stable = true, .sound = true};
    if (!spore_budget_choice_is_better(search, choice, best ? best->choice : base)) continue;
    best = set;
  }
  return best;
}

gboolean spore_budget_try_together(SporeBudgetSearch *search, SporeBudgetChoice **best, SporeError *error) {
  SporeBudgetChoice *base = *best;
  if (!isfinite(base->point.error)) return TRUE;
  const Set start = {
      .choice = spore_budget_choice_copy(search, base), .square = square_of(search, &base->point), .factor = 1};
  g_autoptr(GArray) sets = g_array_new(FALSE, FALSE, sizeof(Set));
  g_array_set_clear_func(sets, clear_set);
  g_array_append_val(sets, start);
  for (gsize field = 0; field < 2 * search->count + WHOLE_COUNT; field++) grow(search, base, field, sets);
  for (int run = 0; run < RUNS; run++) {
    const Set *set = best_forecast(search, base, sets);
    guint before = search->result->tried;
    if (!set) break;
    if (!spore_budget_try(search, spore_budget_choice_copy(search, set->choice), best, error)) return FALSE;
    if (search->result->tried == before) break; /* no time is left */
    search->result->together++;
  }
  return TRUE;
}
