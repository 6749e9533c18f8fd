/* The inspector of several bodies: what is done to all of them, and the properties that are set for all at once. */
#include "ui/panels/batch.h"

#include <glib/gi18n.h>

#include "ui/panels/spore-property-row.h"

GtkWidget *spore_action_button_new(const char *label, const char *action, const char *hint) {
  GtkWidget *button = gtk_button_new_with_label(label);
  gtk_widget_set_tooltip_text(button, hint);
  gtk_actionable_set_detailed_action_name(GTK_ACTIONABLE(button), action);
  return button;
}

GtkWidget *spore_soft_button_new(void) {
  return spore_action_button_new(_("Make soft"), "win.make-soft",
                                 _("Tetrahedra, collision spheres, the tissue that the name says and a pin, in one "
                                   "step"));
}

char *spore_batch_names(const GPtrArray *bodies) {
  GString *names = g_string_new(NULL);
  for (guint i = 0; i < bodies->len; i++)
    g_string_append_printf(names, names->len ? ", %s" : "%s", spore_object_name(bodies->pdata[i]));
  return g_string_free(names, FALSE);
}

static void add_commands(GtkBox *box) {
  GtkWidget *grid = gtk_grid_new();
  gtk_grid_set_column_homogeneous(GTK_GRID(grid), TRUE);
  gtk_grid_set_column_spacing(GTK_GRID(grid), 6);
  gtk_grid_set_row_spacing(GTK_GRID(grid), 6);
  GtkWidget *buttons[] = {
      spore_soft_button_new(),
      spore_action_button_new(_("Hold"), "win.add-pin", _("Pin each where it lies lowest and farthest behind")),
      spore_action_button_new(_("Hide"), "win.hide", _("Hide them in the view (H)")),
      spore_action_button_new(_("Show only these"), "win.isolate", _("Hide all others in the view (I)")),
  };
  for (int i = 0; i < (int)G_N_ELEMENTS(buttons); i++) gtk_grid_attach(GTK_GRID(grid), buttons[i], i % 2, i / 2, 1, 1);
  gtk_container_add(GTK_CONTAINER(box), grid);
}

/* A section with a property of a unit that each body has or gets. */
static void add_unit(SporeSectionList *sections, SporeEditorDocument *document, const GPtrArray *bodies,
                     const char *title, const char *unit, const char *property) {
  g_autofree char *names = spore_batch_names(bodies);
  GtkBox *box = spore_section_list_add(sections, title, names, NULL);
  if (!box) return;
  const SporeObjectType *type = spore_object_type_child(spore_object_type(bodies->pdata[0]), unit);
  const int index = spore_parameter_find(type->table, property);
  g_autoptr(GPtrArray) paths = g_ptr_array_new_with_free_func(g_free);
  for (guint i = 0; i < bodies->len; i++) {
    g_autofree char *path = spore_object_path(bodies->pdata[i]);
    g_ptr_array_add(paths, g_strconcat(path, "/", unit, NULL));
  }
  g_ptr_array_add(paths, NULL);
  GtkWidget *row = spore_property_row_new_of_several(document, (const char *const *)paths->pdata, type, (guint)index);
  gtk_container_add(GTK_CONTAINER(box), row);
  g_ptr_array_add(spore_section_rows(box), row);
}

static gboolean all_have_models(const GPtrArray *bodies) {
  for (guint i = 0; i < bodies->len; i++)
    if (!spore_body_model_object(bodies->pdata[i])) return FALSE;
  return TRUE;
}

void spore_add_batch(SporeSectionList *sections, SporeEditorDocument *document, const GPtrArray *bodies) {
  g_autofree char *names = spore_batch_names(bodies);
  GtkBox *commands = spore_section_list_add(sections, _("All of them"), names, NULL);
  if (commands) add_commands(commands);
  add_unit(sections, document, bodies, _("Visual mesh"), "visual", "colour");
  if (all_have_models(bodies)) add_unit(sections, document, bodies, _("Mechanical unit"), "mechanical", "material");
  add_unit(sections, document, bodies, _("Fidelity"), "fidelity", "mode");
}
