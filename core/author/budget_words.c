/* What a budget changes in a scene, in words. */
#include <glib/gi18n.h>
#include <math.h>

#include "core/author/budget.h"

char *spore_budget_error_text(const SporeBudgetForm *form) {
  if (!isfinite(form->error)) return g_strdup(_("not stable"));
  return form->resolved ? g_strdup_printf("%.2g %%", 100 * form->error)
                        : g_strdup_printf(_("below %.2g %%"), 100 * form->error);
}

char *spore_budget_body_change(const SporeBudgetBody *body) {
  gboolean integrator = !g_str_equal(body->integrator[0], body->integrator[1]);
  gboolean level = body->level[0] && !g_str_equal(body->level[0], body->level[1]);
  g_autofree char *first = level ? g_strdup_printf(_("level %s instead of %s"), body->level[1], body->level[0]) : NULL;
  g_autofree char *second =
      integrator ? g_strdup_printf(_("%s instead of %s"), body->integrator[1], body->integrator[0]) : NULL;
  if (first && second) return g_strdup_printf("%s, %s", first, second);
  return first ? g_steal_pointer(&first) : g_steal_pointer(&second);
}

/* Takes over the text; NULL: nothing changes. */
static void add(GArray *changes, const char *id, char *text) {
  if (!text) return;
  const SporeBudgetChange change = {g_strdup(id), text};
  g_array_append_val(changes, change);
}

static void clear_change(gpointer data) {
  SporeBudgetChange *change = data;
  g_free(change->id);
  g_free(change->text);
}

static char *instead(const char *chosen, const char *before) {
  return chosen == before ? NULL : g_strdup_printf(_("%s instead of %s"), chosen, before);
}

GArray *spore_budget_list_changes(const SporeBudget *budget) {
  const SporeBudgetForm *before = &budget->before, *chosen = &budget->chosen;
  GArray *changes = g_array_new(FALSE, FALSE, sizeof(SporeBudgetChange));
  g_array_set_clear_func(changes, clear_change);
  if (chosen->dt_s != before->dt_s)
    add(changes, "solver/time_step",
        g_strdup_printf(_("steps of %.4g ms instead of %.4g ms"), 1e3 * chosen->dt_s, 1e3 * before->dt_s));
  add(changes, "solver/nonlinear", instead(chosen->nonlinear, before->nonlinear));
  add(changes, "solver/linear", instead(chosen->linear, before->linear));
  for (gsize i = 0; i < budget->body_count; i++)
    add(changes, budget->bodies[i].name, spore_budget_body_change(&budget->bodies[i]));
  return changes;
}
