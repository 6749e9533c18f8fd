/* The list of attempts at an exercise, newest first. */
#ifndef SPORE_UI_PANELS_ATTEMPT_LIST_H
#define SPORE_UI_PANELS_ATTEMPT_LIST_H

#include <gtk/gtk.h>

/* Fills the box in place of what it shows. attempts: of SporeAttempt, oldest first. scene: its file, by which the input
 * of attempts is found; NULL: none. Those whose input is kept can be ticked, repeated and filmed (win.repeat-attempt,
 * win.film-attempts-dialog). */
void spore_fill_attempt_list(GtkBox *box, const char *scene, const GArray *attempts);

#endif
