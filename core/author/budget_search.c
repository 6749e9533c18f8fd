/* Searches for the choice of least error that fits a budget. */
#include <glib/gi18n.h>
#include <math.h>

#include "core/author/budget_private.h"
#include "core/integrate/integrator.h"
#include "core/measure/quantile.h"

#define ROUNDS 2  /* of single changes, and then of several at once */
#define PASSES 4  /* over all single changes, a round */
#define METHODS 3 /* integrators of the study that are tried on single bodies */
#define CHECKS 4  /* choices that are timed again before one is promised */
#define TIMED_RUNS 3

/* Moves: each changes one thing of the best choice so far. */

static gboolean move_level(SporeBudgetSearch *search, gsize subject, SporeBudgetChoice **best, SporeError *error) {
  const SporeBudgetSubject *body = &search->subjects[subject];
  for (int level = 0; level < SPORE_LOD_COUNT && !body->keeps_level; level++) {
    if (!body->levels[level]) continue;
    SporeBudgetChoice *choice = spore_budget_choice_copy(search, *best);
    choice->level[subject] = level == body->level ? -1 : level;
    if (!spore_budget_try(search, choice, best, error)) return FALSE;
  }
  return TRUE;
}

static gboolean is_known(const int *kinds, gsize count, int kind) {
  for (gsize k = 0; k < count; k++)
    if (kinds[k] == kind) return TRUE;
  return FALSE;
}

/* Integrators of the study's Pareto set, those that cost least first; -1: as it is. */
static gsize usual_integrators(const SporeBudgetSearch *search, int *kinds) {
  gsize count = 0;
  double after = 0;
  kinds[count++] = -1;
  while (count <= METHODS) {
    const SporeAccuracyPoint *next = NULL;
    for (gsize i = 0; i < search->report->point_count; i++) {
      const SporeAccuracyPoint *point = &search->report->points[i];
      if (point->pareto && point->cost > after && (!next || point->cost < next->cost)) next = point;
    }
    if (!next) return count;
    after = next->cost;
    int kind = (int)search->report->methods[next->method].method.integrator;
    if (!is_known(kinds, count, kind)) kinds[count++] = kind;
  }
  return count;
}

/* Adds what may do for this body though not for all of them: explicit methods that bear the step. */
static gsize add_explicit(const SporeBudgetSubject *body, double dt_s, int *kinds, gsize count) {
  for (int kind = 0; kind < SPORE_INTEGRATOR_COUNT; kind++) {
    const SporeIntegrator *integrator = spore_integrator((SporeIntegratorKind)kind);
    gboolean bears = spore_budget_may_pay(kind) && (body->sweeps || !integrator->sweeps) && body->limit_s[kind] >= dt_s;
    if (!integrator->implicit && bears && !is_known(kinds, count, kind)) kinds[count++] = kind;
  }
  return count;
}

static gboolean move_integrator(SporeBudgetSearch *search, gsize subject, SporeBudgetChoice **best, SporeError *error) {
  const SporeBudgetSubject *body = &search->subjects[subject];
  int kinds[METHODS + 1 + SPORE_INTEGRATOR_COUNT];
  gsize count = body->keeps_integrator || search->count == 1 ? 0 : usual_integrators(search, kinds);
  if (count > 0) count = add_explicit(body, (*best)->dt_s, kinds, count);
  for (gsize k = 0; k < count; k++) {
    gboolean own = kinds[k] == (int)body->integrator && body->substeps == 1;
    if (own || (kinds[k] >= 0 && body->particles && spore_integrator((SporeIntegratorKind)kinds[k])->implicit))
      continue;
    SporeBudgetChoice *choice = spore_budget_choice_copy(search, *best);
    choice->integrator[subject] = kinds[k];
    if (!spore_budget_try(search, choice, best, error)) return FALSE;
  }
  return TRUE;
}

static gboolean is_implicit(const SporeBudgetSearch *search, const SporeBudgetChoice *choice) {
  for (gsize i = 0; i < search->count; i++) {
    SporeIntegratorKind kind =
        choice->integrator[i] < 0 ? search->subjects[i].integrator : (SporeIntegratorKind)choice->integrator[i];
    if (spore_integrator(kind)->implicit) return TRUE;
  }
  return FALSE;
}

static gboolean move_solvers(SporeBudgetSearch *search, SporeBudgetChoice **best, SporeError *error) {
  for (int kind = SPORE_NONLINEAR_NEWTON; is_implicit(search, *best) && spore_nonlinear_names[kind]; kind++) {
    SporeBudgetChoice *choice = spore_budget_choice_copy(search, *best);
    choice->nonlinear = kind;
    if (!spore_budget_try(search, choice, best, error)) return FALSE;
  }
  for (int kind = SPORE_LINEAR_CONJUGATE_GRADIENTS; is_implicit(search, *best) && kind <= SPORE_LINEAR_CHOLESKY;
       kind++) {
    SporeBudgetChoice *choice = spore_budget_choice_copy(search, *best);
    choice->linear = kind;
    if (!spore_budget_try(search, choice, best, error)) return FALSE;
  }
  return TRUE;
}

/* Steps between those of the study would not end at its looks. */
static gboolean move_step(SporeBudgetSearch *search, SporeBudgetChoice **best, SporeError *error) {
  double interval_s = search->report->interval_s, longest_s = 0;
  for (gsize i = 0; i < search->report->point_count; i++) longest_s = fmax(longest_s, search->report->points[i].dt_s);
  const double wanted[] = {2 * (*best)->dt_s, 0.5 * (*best)->dt_s, 2. / 3 * (*best)->dt_s};
  for (gsize k = 0; k < G_N_ELEMENTS(wanted); k++) {
    double dt_s = spore_trial_step(interval_s, fmin(wanted[k], longest_s));
    SporeBudgetChoice *choice = spore_budget_choice_copy(search, *best);
    choice->dt_s = dt_s;
    if (!spore_budget_try(search, choice, best, error)) return FALSE;
  }
  return TRUE;
}

/* Single changes, each of the best choice so far. */
static gboolean climb(SporeBudgetSearch *search, SporeBudgetChoice **best, SporeError *error) {
  for (int pass = 0; pass < PASSES; pass++) {
    const SporeBudgetChoice *before = *best;
    for (gsize i = 0; i < search->count; i++)
      if (!move_level(search, i, best, error) || !move_integrator(search, i, best, error)) return FALSE;
    if (!move_solvers(search, best, error) || !move_step(search, best, error)) return FALSE;
    if (*best == before) break;
  }
  return TRUE;
}

static gboolean improve(SporeBudgetSearch *search, SporeBudgetChoice **best, SporeError *error) {
  for (int round = 0; round < ROUNDS; round++) {
    if (!climb(search, best, error)) return FALSE;
    const SporeBudgetChoice *before = *best;
    if (!spore_budget_try_together(search, best, error)) return FALSE;
    if (*best == before) break;
  }
  return TRUE;
}

static SporeBudgetChoice *best_of(const SporeBudgetSearch *search) {
  SporeBudgetChoice *best = search->tried->pdata[0];
  for (guint i = 1; i < search->tried->len; i++)
    if (spore_budget_choice_is_better(search, search->tried->pdata[i], best)) best = search->tried->pdata[i];
  return best;
}

/* Times a choice again: its cost is the median of a few runs. */
static gboolean time_again(SporeBudgetSearch *search, SporeBudgetChoice *choice, SporeError *error) {
  double costs[TIMED_RUNS];
  for (int i = 0; i < TIMED_RUNS; i++) {
    SporeAccuracyPoint point;
    if (!search->measure(search, choice, TRUE, &point, error)) return FALSE;
    costs[i] = point.cost;
  }
  choice->point.cost = spore_quantile(costs, TIMED_RUNS, 0.5);
  return TRUE;
}

SporeBudgetChoice *spore_budget_search(SporeBudgetSearch *search, SporeError *error) {
  for (gsize i = 0; i < search->report->point_count; i++) {
    SporeBudgetChoice *choice = spore_budget_choice_of_point(search, &search->report->points[i]);
    if (spore_budget_was_tried(search, choice)) spore_budget_choice_free(choice);
    else g_ptr_array_add(search->tried, choice);
  }
  SporeBudgetChoice *best = best_of(search);
  if (!improve(search, &best, error)) return NULL;
  /* Runs of the search may have been lucky: what is promised was timed apart. */
  for (int check = 0; check < CHECKS; check++) {
    if (!time_again(search, best, error)) return NULL;
    SporeBudgetChoice *again = best_of(search);
    if (again == best) break;
    best = again;
  }
  return best;
}
