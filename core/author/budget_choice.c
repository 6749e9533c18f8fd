/* Choices for a scene within a budget: made, compared, and written as variations of the scene. */
#include <math.h>

#include "core/author/budget_private.h"
#include "core/integrate/integrator.h"

#define NEARER 0.97  /* of the error: less than that is nearer */
#define CHEAPER 0.95 /* of the cost: less than that is cheaper */

gboolean spore_budget_may_pay(int integrator) {
  return integrator != SPORE_INTEGRATOR_STATIC && integrator != SPORE_INTEGRATOR_EXPLICIT_EULER;
}

SporeBudgetChoice *spore_budget_choice_new(const SporeBudgetSearch *search, double dt_s) {
  SporeBudgetChoice *choice = g_new0(SporeBudgetChoice, 1);
  choice->dt_s = dt_s;
  choice->nonlinear = choice->linear = -1;
  choice->integrator = g_new(int, search->count);
  choice->level = g_new(int, search->count);
  for (gsize i = 0; i < search->count; i++) choice->integrator[i] = choice->level[i] = -1;
  return choice;
}

SporeBudgetChoice *spore_budget_choice_copy(const SporeBudgetSearch *search, const SporeBudgetChoice *choice) {
  SporeBudgetChoice *copy = g_memdup2(choice, sizeof *choice);
  copy->integrator = g_memdup2(choice->integrator, search->count * sizeof(int));
  copy->level = g_memdup2(choice->level, search->count * sizeof(int));
  return copy;
}

void spore_budget_choice_free(gpointer data) {
  SporeBudgetChoice *choice = data;
  g_free(choice->integrator);
  g_free(choice->level);
  g_free(choice);
}

gboolean spore_budget_choice_equal(const SporeBudgetSearch *search, const SporeBudgetChoice *a,
                                   const SporeBudgetChoice *b) {
  if (fabs(a->dt_s / b->dt_s - 1) > 1e-9 || a->nonlinear != b->nonlinear || a->linear != b->linear) return FALSE;
  for (gsize i = 0; i < search->count; i++)
    if (a->integrator[i] != b->integrator[i] || a->level[i] != b->level[i]) return FALSE;
  return TRUE;
}

/* The integrator as a choice for a body: -1 where it is the body's own, or one that the body does not take. */
static int integrator_for(const SporeBudgetSubject *subject, SporeIntegratorKind kind) {
  if (subject->keeps_integrator || (subject->particles && spore_integrator(kind)->implicit)) return -1;
  return kind == subject->integrator && subject->substeps == 1 ? -1 : (int)kind;
}

SporeBudgetChoice *spore_budget_choice_of_point(const SporeBudgetSearch *search, const SporeAccuracyPoint *point) {
  const SporeAccuracyMethod *method = &search->report->methods[point->method].method;
  SporeBudgetChoice *choice = spore_budget_choice_new(search, point->dt_s);
  choice->point = *point;
  choice->nonlinear = method->nonlinear;
  choice->linear = method->linear;
  for (gsize i = 0; i < search->count; i++) {
    const SporeBudgetSubject *subject = &search->subjects[i];
    choice->integrator[i] = integrator_for(subject, method->integrator);
    gboolean has = point->level >= 0 && subject->levels[point->level] && !subject->keeps_level;
    choice->level[i] = has && point->level != subject->level ? point->level : -1;
  }
  return choice;
}

/* The name of a choice; NULL: as it is. */
static const char *name_of(const char *const *names, int choice) { return choice < 0 ? NULL : names[choice]; }

SporeVariation spore_budget_choice_variation(const SporeBudgetSearch *search, const SporeBudgetChoice *choice,
                                             SporeBodySetting *settings) {
  for (gsize i = 0; i < search->count; i++)
    settings[i] = (SporeBodySetting){search->subjects[i].name, name_of(spore_integrator_names, choice->integrator[i]),
                                     name_of(spore_lod_names, choice->level[i])};
  return (SporeVariation){.settings = settings,
                          .setting_count = search->count,
                          .dt_s = choice->dt_s,
                          .nonlinear = name_of(spore_nonlinear_names, choice->nonlinear),
                          .linear = name_of(spore_linear_names, choice->linear)};
}

gboolean spore_budget_choice_is_valid(const SporeBudgetSearch *search, const SporeBudgetChoice *choice) {
  const SporeBudgetChoice *own = search->tried->pdata[0];
  if (choice == own) return isfinite(own->point.cost);
  const SporeAccuracyPoint *point = &choice->point;
  return point->stable && isfinite(point->error) && (point->sound || !own->point.sound);
}

gboolean spore_budget_choice_fits(const SporeBudgetSearch *search, const SporeBudgetChoice *choice) {
  return spore_budget_choice_is_valid(search, choice) && choice->point.cost <= search->limit;
}

gboolean spore_budget_choice_is_better(const SporeBudgetSearch *search, const SporeBudgetChoice *a,
                                       const SporeBudgetChoice *b) {
  gboolean fits = spore_budget_choice_fits(search, a);
  if (!spore_budget_choice_is_valid(search, a)) return FALSE;
  if (!spore_budget_choice_is_valid(search, b)) return TRUE;
  if (fits != spore_budget_choice_fits(search, b)) return fits;
  if (!fits) return a->point.cost < CHEAPER * b->point.cost;
  double error = fmax(a->point.error, search->report->floor), other = fmax(b->point.error, search->report->floor);
  if (error < NEARER * other) return TRUE;
  /* What fits as it is stays unless something is nearer. */
  return b != search->tried->pdata[0] && error <= other && a->point.cost < CHEAPER * b->point.cost;
}
