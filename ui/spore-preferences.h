/* What a user chose for all scenes, as actions of the program. */
#ifndef SPORE_UI_SPORE_PREFERENCES_H
#define SPORE_UI_SPORE_PREFERENCES_H

#include <gtk/gtk.h>

/* Adds an action to the application for each preference of the table (state: name of the choice), and
 * reset-preferences. A choice is kept as soon as it is made. */
void spore_preferences_add(GtkApplication *application);
/* Name of the choice that holds now. g_free. */
char *spore_preferences_state(GtkApplication *application, const char *name);

#endif
