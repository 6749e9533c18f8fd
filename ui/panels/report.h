/* Small services that panels share. */
#ifndef SPORE_UI_PANELS_REPORT_H
#define SPORE_UI_PANELS_REPORT_H

#include <gtk/gtk.h>

#include "core/base/parameter.h"

/* Activates win.NAME of the window that holds the widget. Takes a floating parameter. */
void spore_activate(GtkWidget *widget, const char *name, GVariant *parameter);
/* Shows the message in the window's bar. */
void spore_report(GtkWidget *widget, const GError *error);
/* Puts children side by side where their minimum widths fit into `width`, else one below the other. */
void spore_box_fit(GtkBox *box, int width);
/* A combo box of texts that shows less of a long one where there is no room for it. */
void spore_combo_shrinks(GtkWidget *combo, int least_chars, int most_chars);
/* The wheel over this widget scrolls what holds it and never changes its value. */
void spore_ignore_wheel(GtkWidget *widget);
/* For a number where 0 means "not asked for": shows a dash at 0. Its hint says what happens then. */
void spore_spin_shows_none(GtkWidget *spin);
/* "Contact stiffness" of "contact_stiffness", translated. g_free. */
char *spore_label_of(const char *name);
/* "Implicit Euler" of "implicit_euler"; abbreviations such as mm or LPS stay as they are. g_free. */
char *spore_choice_label(const char *choice);
/* Whether the window shows the unit in degrees: "rad", "rad/s". */
gboolean spore_unit_is_angle(const char *unit);
/* Whether the window shows the unit in ml/min: "m^3/s". */
gboolean spore_unit_is_flow(const char *unit);
/* The unit that the window shows for one of the tables: "m/s²" of "m/s^2", "mm" of "m", "°" of "rad", "ml/min" of
 * "m^3/s". g_free. */
char *spore_unit_label(const char *unit);
/* How many of the units shown are one of the tables' units: 1e3 of "m", 57.3 of "rad", 6e7 of "m^3/s", else 1. */
double spore_unit_scale(const char *unit);
/* The value as the file would hold it. g_free. */
char *spore_value_text(const SporeParameter *parameter, const SporeValue *value);

#endif
