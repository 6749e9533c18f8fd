/* The dialog of an export, and the one of its report. */
#include "ui/dialogs/spore-export-dialog.h"

#include <glib/gi18n.h>

#include "ui/jobs/film-work.h"
#include "ui/panels/report.h"

#define DOC_CHARS 72
#define MOST_S 3600
#define USUAL_S 1
#define USUAL_EVERY_S 0.04 /* 25 moments a second */
#define REPORT_WIDTH 560
#define REPORT_HEIGHT 360

typedef struct Choice {
  GtkWidget *times, *every_label, *played;
  GtkSpinButton *time_s, *every_s;
  const SporeExportFormat *format;
  double played_s;
} Choice;

static Choice *choice_of(GtkWidget *dialog) { return g_object_get_data(G_OBJECT(dialog), "spore-choice"); }

/* A run is asked for where the format shows one. */
static void show_options(Choice *choice) {
  SporeExportMoments moments = choice->format->moments;
  gboolean played = gtk_toggle_button_get_active(GTK_TOGGLE_BUTTON(choice->played));
  gtk_widget_set_sensitive(choice->times, moments != SPORE_EXPORT_NO_MOMENT);
  gtk_widget_set_visible(GTK_WIDGET(choice->every_s), moments == SPORE_EXPORT_SERIES);
  gtk_widget_set_visible(choice->every_label, moments == SPORE_EXPORT_SERIES);
  gtk_widget_set_sensitive(choice->played, moments != SPORE_EXPORT_NO_MOMENT && choice->played_s > 0);
  gtk_spin_button_set_range(choice->time_s, 0, played ? choice->played_s : MOST_S);
}

static void format_chosen(GtkToggleButton *button, Choice *choice) {
  if (!gtk_toggle_button_get_active(button)) return;
  choice->format = g_object_get_data(G_OBJECT(button), "spore-format");
  show_options(choice);
}

static void played_toggled(GtkToggleButton *button, Choice *choice) {
  if (gtk_toggle_button_get_active(button)) gtk_spin_button_set_value(choice->time_s, choice->played_s);
  show_options(choice);
}

static GtkWidget *label_of(const char *text, gboolean dim) {
  GtkWidget *label = gtk_label_new(text);
  gtk_label_set_xalign(GTK_LABEL(label), 0);
  gtk_label_set_line_wrap(GTK_LABEL(label), TRUE);
  gtk_label_set_width_chars(GTK_LABEL(label), DOC_CHARS); /* its height is that of this width */
  gtk_label_set_max_width_chars(GTK_LABEL(label), DOC_CHARS);
  if (dim) gtk_style_context_add_class(gtk_widget_get_style_context(label), GTK_STYLE_CLASS_DIM_LABEL);
  return label;
}

/* Adds a row for each format. *group: one of the buttons; NULL at first. */
static void add_formats(Choice *choice, GtkContainer *rows, const SporeExportFormat *formats, GtkRadioButton **group) {
  for (const SporeExportFormat *format = formats; format->name; format++) {
    GtkWidget *button = gtk_radio_button_new_with_label_from_widget(*group, _(format->label));
    GtkWidget *doc = label_of(_(format->doc), TRUE);
    *group = GTK_RADIO_BUTTON(button);
    g_object_set_data(G_OBJECT(button), "spore-format", (gpointer)(guintptr)format);
    gtk_widget_set_valign(button, GTK_ALIGN_START);
    atk_object_set_description(gtk_widget_get_accessible(button), _(format->doc));
    g_signal_connect(button, "toggled", G_CALLBACK(format_chosen), choice);
    gtk_grid_attach_next_to(GTK_GRID(rows), button, NULL, GTK_POS_BOTTOM, 1, 1);
    gtk_grid_attach_next_to(GTK_GRID(rows), doc, button, GTK_POS_RIGHT, 1, 1);
  }
}

static GtkWidget *formats_new(Choice *choice) {
  GtkWidget *box = gtk_grid_new();
  GtkRadioButton *group = NULL;
  gtk_grid_set_column_spacing(GTK_GRID(box), 12);
  gtk_grid_set_row_spacing(GTK_GRID(box), 4);
  add_formats(choice, GTK_CONTAINER(box), spore_export_formats, &group);
  add_formats(choice, GTK_CONTAINER(box), spore_film_formats, &group);
  return box;
}

static GtkSpinButton *seconds_new(const char *name, double least, double usual) {
  GtkWidget *spin = gtk_spin_button_new_with_range(least, MOST_S, 0.1);
  gtk_spin_button_set_digits(GTK_SPIN_BUTTON(spin), 3);
  gtk_spin_button_set_value(GTK_SPIN_BUTTON(spin), usual);
  gtk_entry_set_activates_default(GTK_ENTRY(spin), TRUE);
  atk_object_set_name(gtk_widget_get_accessible(spin), name);
  spore_ignore_wheel(spin);
  return GTK_SPIN_BUTTON(spin);
}

static void add_times(Choice *choice, GtkWidget *box) {
  gboolean has_run = choice->played_s > 0;
  choice->times = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 8);
  choice->time_s = seconds_new(_("Simulated time, s"), 0, has_run ? choice->played_s : USUAL_S);
  choice->every_s = seconds_new(_("Time between moments, s"), 0.001, USUAL_EVERY_S);
  choice->every_label = gtk_label_new(_("Time between moments, s"));
  choice->played = gtk_check_button_new_with_label(_("With the input of the run that was played"));
  gtk_toggle_button_set_active(GTK_TOGGLE_BUTTON(choice->played), has_run);
  g_signal_connect(choice->played, "toggled", G_CALLBACK(played_toggled), choice);
  GtkWidget *parts[] = {gtk_label_new(_("Simulated time, s")), GTK_WIDGET(choice->time_s), choice->every_label,
                        GTK_WIDGET(choice->every_s)};
  for (gsize i = 0; i < G_N_ELEMENTS(parts); i++) gtk_container_add(GTK_CONTAINER(choice->times), parts[i]);
  gtk_container_add(GTK_CONTAINER(box), choice->times);
  gtk_container_add(GTK_CONTAINER(box), choice->played);
}

GtkWidget *spore_export_dialog_new(GtkWindow *parent, double played_s) {
  GtkWidget *dialog =
      gtk_dialog_new_with_buttons(_("Export"), parent, GTK_DIALOG_MODAL | GTK_DIALOG_USE_HEADER_BAR, _("_Cancel"),
                                  GTK_RESPONSE_CANCEL, _("_Export…"), GTK_RESPONSE_ACCEPT, NULL);
  GtkWidget *box = gtk_dialog_get_content_area(GTK_DIALOG(dialog));
  gtk_window_set_resizable(GTK_WINDOW(dialog), FALSE);
  Choice *choice = g_new0(Choice, 1);
  *choice = (Choice){.format = &spore_export_formats[0], .played_s = played_s};
  g_object_set_data_full(G_OBJECT(dialog), "spore-choice", choice, g_free);
  gtk_container_set_border_width(GTK_CONTAINER(box), 18);
  gtk_box_set_spacing(GTK_BOX(box), 12);
  gtk_container_add(GTK_CONTAINER(box), formats_new(choice));
  add_times(choice, box);
  gtk_dialog_set_default_response(GTK_DIALOG(dialog), GTK_RESPONSE_ACCEPT);
  gtk_widget_show_all(box);
  show_options(choice);
  return dialog;
}

const SporeExportFormat *spore_export_dialog_get_format(GtkWidget *dialog) { return choice_of(dialog)->format; }

double spore_export_dialog_get_time_s(GtkWidget *dialog) {
  return gtk_spin_button_get_value(choice_of(dialog)->time_s);
}

double spore_export_dialog_get_every_s(GtkWidget *dialog) {
  return gtk_spin_button_get_value(choice_of(dialog)->every_s);
}

gboolean spore_export_dialog_get_as_played(GtkWidget *dialog) {
  const Choice *choice = choice_of(dialog);
  return choice->format->moments != SPORE_EXPORT_NO_MOMENT && choice->played_s > 0 &&
         gtk_toggle_button_get_active(GTK_TOGGLE_BUTTON(choice->played));
}

void spore_export_report_show(GtkWindow *parent, const char *markup) {
  GtkWidget *dialog =
      gtk_dialog_new_with_buttons(_("Exported"), parent, GTK_DIALOG_DESTROY_WITH_PARENT | GTK_DIALOG_USE_HEADER_BAR,
                                  _("_Close"), GTK_RESPONSE_CLOSE, NULL);
  GtkWidget *scrolled = gtk_scrolled_window_new(NULL, NULL), *text = label_of(NULL, FALSE);
  gtk_label_set_markup(GTK_LABEL(text), markup);
  gtk_label_set_selectable(GTK_LABEL(text), TRUE);
  gtk_widget_set_valign(text, GTK_ALIGN_START);
  gtk_container_set_border_width(GTK_CONTAINER(scrolled), 12);
  gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scrolled), GTK_POLICY_NEVER, GTK_POLICY_AUTOMATIC);
  gtk_container_add(GTK_CONTAINER(scrolled), text);
  gtk_box_pack_start(GTK_BOX(gtk_dialog_get_content_area(GTK_DIALOG(dialog))), scrolled, TRUE, TRUE, 0);
  gtk_window_set_default_size(GTK_WINDOW(dialog), REPORT_WIDTH, REPORT_HEIGHT);
  g_signal_connect(dialog, "response", G_CALLBACK(gtk_widget_destroy), NULL);
  gtk_widget_show_all(dialog);
}
