/* Runs a choice for a budget, and remembers what was run. */
#include "core/author/budget_private.h"

gboolean spore_budget_measure(SporeBudgetSearch *search, SporeBudgetChoice *choice, gboolean timed_only,
                              SporeAccuracyPoint *point, SporeError *error) {
  g_autofree SporeBodySetting *settings = g_new(SporeBodySetting, search->count);
  const SporeVariation variation = spore_budget_choice_variation(search, choice, settings);
  const SporeAccuracyWorld world = {.level = -1, .dt_s = choice->dt_s, .choice = &variation};
  return spore_accuracy_measure_more(search->report, &world, timed_only, point, error);
}

gboolean spore_budget_was_tried(const SporeBudgetSearch *search, const SporeBudgetChoice *choice) {
  for (guint i = 0; i < search->tried->len; i++)
    if (spore_budget_choice_equal(search, choice, search->tried->pdata[i])) return TRUE;
  return FALSE;
}

gboolean spore_budget_try(SporeBudgetSearch *search, SporeBudgetChoice *choice, SporeBudgetChoice **best,
                          SporeError *error) {
  gboolean known = spore_budget_was_tried(search, choice);
  if (known || search->ended || (search->ended = spore_processor_s() > search->until_s)) {
    spore_budget_choice_free(choice);
    return TRUE;
  }
  if (!search->measure(search, choice, FALSE, &choice->point, error)) {
    spore_budget_choice_free(choice);
    return FALSE;
  }
  g_ptr_array_add(search->tried, choice);
  search->result->tried++;
  if (spore_budget_choice_is_better(search, choice, *best)) *best = choice;
  return TRUE;
}
