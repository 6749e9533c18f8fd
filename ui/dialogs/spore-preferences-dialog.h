/* The window of preferences: what is chosen holds at once, and is kept. */
#ifndef SPORE_UI_DIALOGS_SPORE_PREFERENCES_DIALOG_H
#define SPORE_UI_DIALOGS_SPORE_PREFERENCES_DIALOG_H

#include <gtk/gtk.h>

/* A dialog over the window, which works the actions of the application; it closes itself. */
GtkWidget *spore_preferences_dialog_new(GtkWindow *parent, GtkApplication *application);

#endif
