/* What a user chose for all scenes, kept in the folder of the user's settings: $XDG_CONFIG_HOME/spore/editor.ini. */
#ifndef SPORE_UI_DOCUMENT_PREFERENCES_H
#define SPORE_UI_DOCUMENT_PREFERENCES_H

#include <glib.h>

/* What was kept under that name. g_free; NULL: nothing was, or the file cannot be read. */
char *spore_preference_get(const char *name);
/* Keeps the text, and with it whatever else the file holds. FALSE: the file cannot be written. */
gboolean spore_preference_set(const char *name, const char *text, GError **error);

#endif
