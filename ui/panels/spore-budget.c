/* The box of the budget: the slider, and what was found for it. */
#include "ui/panels/spore-budget.h"

#include <glib/gi18n.h>
#include <math.h>

#include "ui/jobs/budget-work.h"
#include "ui/panels/report.h"
#include "ui/panels/spore-finding.h"

/* Powers of ten of a time in us. */
#define LEAST 0.
#define MOST 5.
#define FIRST 3.

struct _SporeBudgetBox {
  GtkBox parent;
  GtkWidget *slider, *finding;
};

G_DEFINE_FINAL_TYPE(SporeBudgetBox, spore_budget, GTK_TYPE_BOX)

static double budget_us(SporeBudgetBox *self) {
  double value = pow(10, gtk_range_get_value(GTK_RANGE(self->slider)));
  double unit = pow(10, floor(log10(value)) - 1);
  return unit * round(value / unit);
}

static char *format_value(GtkScale *scale, double value, gpointer self) {
  return g_strdup_printf(_("%g µs a step"), budget_us(self));
}

static gpointer work_new(const SporeDocument *document, gpointer self) {
  return spore_budget_work_new(document, budget_us(self));
}

static gpointer take(gpointer work) { return g_steal_pointer(&((SporeBudgetWork *)work)->budget); }

static void found_free(gpointer found) { spore_budget_free(found); }

static char *describe(gconstpointer data) {
  const SporeBudget *found = data;
  g_autofree char *before = spore_budget_error_text(&found->before), *chosen = spore_budget_error_text(&found->chosen);
  GString *text = g_string_new(NULL);
  if (found->chosen.median_us > 0)
    g_string_append_printf(text, _("As it is: error %s, %.4g µs. Chosen: error %s, %.4g µs, timed again %.4g µs (%s)"),
                           before, found->before.us, chosen, found->chosen.us, found->chosen.median_us,
                           found->kept_promise ? _("the promise held") : _("the promise did not hold"));
  else
    g_string_append_printf(text, _("It cannot be met: the nearest that was found takes %.4g µs, error %s"),
                           found->chosen.us, chosen);
  g_autoptr(GArray) changes = spore_budget_list_changes(found);
  for (guint i = 0; i < changes->len; i++) {
    const SporeBudgetChange *change = &g_array_index(changes, SporeBudgetChange, i);
    g_string_append_printf(text, "\n%s: %s", change->id, change->text);
  }
  if (found->happens) g_string_append_printf(text, _("\nIn one of the two alone %s"), found->happens);
  return g_string_free(text, FALSE);
}

static gboolean applies(gconstpointer data, SporeDocument *document) {
  const SporeBudget *found = data;
  return found->met && spore_budget_changes(found);
}

static gboolean apply_to(gconstpointer found, SporeDocument *document, GError **error) {
  return spore_budget_apply(found, document, error);
}

static const SporeFindingKind kind = {
    .find = N_("Fit budget"),
    .find_hint = N_("Choose level, integrator, step and solvers that cost no more, with the least error"),
    .apply = N_("Apply budget"),
    .apply_hint = N_("Give the scene what was chosen, as one step that can be undone"),
    .job = N_("Budget"),
    .under_way = N_("Running the scene by other settings …"),
    .cancelled = N_("Cancelled: nothing was chosen"),
    .work_new = work_new,
    .work_run = spore_budget_work_run,
    .work_free = spore_budget_work_free,
    .take = take,
    .found_free = found_free,
    .describe = describe,
    .applies = applies,
    .apply_to = apply_to};

void spore_budget_set_document(SporeBudgetBox *self, SporeEditorDocument *document) {
  spore_finding_set_document(SPORE_FINDING(self->finding), document);
}

static void spore_budget_class_init(SporeBudgetBoxClass *class) {}

static void spore_budget_init(SporeBudgetBox *self) {
  gtk_orientable_set_orientation(GTK_ORIENTABLE(self), GTK_ORIENTATION_VERTICAL);
  self->slider = gtk_scale_new_with_range(GTK_ORIENTATION_HORIZONTAL, LEAST, MOST, 0.05);
  gtk_scale_set_value_pos(GTK_SCALE(self->slider), GTK_POS_RIGHT);
  gtk_widget_set_tooltip_text(self->slider, _("What may be spent on the time that a step of the scene simulates now"));
  atk_object_set_name(gtk_widget_get_accessible(self->slider), _("Budget"));
  g_signal_connect(self->slider, "format-value", G_CALLBACK(format_value), self);
  gtk_range_set_value(GTK_RANGE(self->slider), FIRST);
  spore_ignore_wheel(self->slider);
  gtk_widget_show(self->slider);
  gtk_container_add(GTK_CONTAINER(self), self->slider);
  self->finding = spore_finding_new(&kind, self);
  gtk_container_add(GTK_CONTAINER(self), self->finding);
}
