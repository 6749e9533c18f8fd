/* Whether the windows are dark or light: as the system has it, or as the user chose. */
#ifndef SPORE_UI_SPORE_LOOK_H
#define SPORE_UI_SPORE_LOOK_H

#include <gtk/gtk.h>

typedef struct SporeLook SporeLook;

/* Follows the application's action "look". The application has its display and its preferences, and outlives the
 * look. */
SporeLook *spore_look_new(GApplication *application);
void spore_look_free(SporeLook *look);

#endif
