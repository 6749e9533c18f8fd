/* The window of preferences: a row for each of the table. */
#include "ui/dialogs/spore-preferences-dialog.h"

#include <glib/gi18n.h>

#include "ui/document/preferences.h"
#include "ui/panels/report.h"

#define DOC_CHARS 44
#define ROW_GAP 10
#define RESET 1

/* A row's choice and the action that it follows. */
typedef struct {
  const SporePreference *preference;
  GActionGroup *actions;
  GtkComboBox *combo;
} Row;

static void chosen(GtkComboBox *combo, Row *row) {
  const char *choice = row->preference->choices[gtk_combo_box_get_active(combo)].name;
  g_action_group_change_action_state(row->actions, row->preference->name, g_variant_new_string(choice));
}

static void show(GActionGroup *actions, const char *name, GVariant *state, Row *row) {
  if (!g_str_equal(name, row->preference->name)) return;
  g_signal_handlers_block_by_func(row->combo, chosen, row);
  gtk_combo_box_set_active(row->combo, spore_preference_choice(row->preference, g_variant_get_string(state, NULL)));
  g_signal_handlers_unblock_by_func(row->combo, chosen, row);
}

static void free_row(gpointer data) {
  Row *row = data;
  g_signal_handlers_disconnect_by_data(row->actions, row);
  g_object_unref(row->actions);
  g_free(row);
}

static GtkWidget *text_of(const char *text, gboolean dim) {
  GtkWidget *label = gtk_label_new(text);
  gtk_label_set_xalign(GTK_LABEL(label), 0);
  if (!dim) return label;
  gtk_label_set_line_wrap(GTK_LABEL(label), TRUE);
  gtk_label_set_max_width_chars(GTK_LABEL(label), DOC_CHARS);
  gtk_style_context_add_class(gtk_widget_get_style_context(label), GTK_STYLE_CLASS_DIM_LABEL);
  return label;
}

static void add_row(GtkGrid *grid, int at, const SporePreference *preference, GActionGroup *actions) {
  GtkWidget *label = text_of(_(preference->label), FALSE), *doc = text_of(_(preference->doc), TRUE);
  GtkWidget *combo = gtk_combo_box_text_new();
  for (int i = 0; i < SPORE_PREFERENCE_CHOICES && preference->choices[i].name; i++)
    gtk_combo_box_text_append_text(GTK_COMBO_BOX_TEXT(combo), _(preference->choices[i].label));
  Row *row = g_new(Row, 1);
  *row = (Row){preference, g_object_ref(actions), GTK_COMBO_BOX(combo)};
  g_object_set_data_full(G_OBJECT(combo), "spore-row", row, free_row);
  gtk_label_set_mnemonic_widget(GTK_LABEL(label), combo);
  atk_object_set_name(gtk_widget_get_accessible(combo), _(preference->label)); /* else it is that of the choice */
  atk_object_set_description(gtk_widget_get_accessible(combo), _(preference->doc));
  gtk_widget_set_valign(combo, GTK_ALIGN_CENTER);
  gtk_widget_set_margin_bottom(doc, ROW_GAP);
  spore_ignore_wheel(combo);
  g_signal_connect(combo, "changed", G_CALLBACK(chosen), row);
  g_signal_connect(actions, "action-state-changed", G_CALLBACK(show), row);
  g_autoptr(GVariant) state = g_action_group_get_action_state(actions, preference->name);
  show(actions, preference->name, state, row);
  gtk_grid_attach(grid, label, 0, 2 * at, 1, 1);
  gtk_grid_attach(grid, doc, 0, 2 * at + 1, 1, 1);
  gtk_grid_attach(grid, combo, 1, 2 * at, 1, 2);
}

static void answered(GtkDialog *dialog, int response, GActionGroup *actions) {
  if (response == RESET) g_action_group_activate_action(actions, "reset-preferences", NULL);
  else gtk_widget_destroy(GTK_WIDGET(dialog));
}

GtkWidget *spore_preferences_dialog_new(GtkWindow *parent, GtkApplication *application) {
  GtkWidget *dialog = gtk_dialog_new_with_buttons(
      _("Preferences"), parent, GTK_DIALOG_MODAL | GTK_DIALOG_DESTROY_WITH_PARENT | GTK_DIALOG_USE_HEADER_BAR,
      _("_Reset all"), RESET, NULL);
  GtkWidget *grid = gtk_grid_new();
  gtk_widget_set_tooltip_text(gtk_dialog_get_widget_for_response(GTK_DIALOG(dialog), RESET),
                              _("Choose everything as it was before you chose"));
  gtk_grid_set_column_spacing(GTK_GRID(grid), 24);
  gtk_grid_set_row_spacing(GTK_GRID(grid), 2);
  gtk_container_set_border_width(GTK_CONTAINER(grid), 18);
  for (int i = 0; spore_preferences[i].name; i++)
    add_row(GTK_GRID(grid), i, &spore_preferences[i], G_ACTION_GROUP(application));
  gtk_container_add(GTK_CONTAINER(gtk_dialog_get_content_area(GTK_DIALOG(dialog))), grid);
  gtk_window_set_resizable(GTK_WINDOW(dialog), FALSE);
  g_signal_connect(dialog, "response", G_CALLBACK(answered), application);
  gtk_widget_show_all(grid);
  return dialog;
}
