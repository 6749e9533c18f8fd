/* A search for what can be done: a line to type into, and the commands that match it. */
#ifndef SPORE_UI_DIALOGS_SPORE_SEARCH_H
#define SPORE_UI_DIALOGS_SPORE_SEARCH_H

#include <gtk/gtk.h>

typedef struct SporeSearchHit {
  char *action;        /* detailed, of "win." or "app." */
  char *label;         /* for people */
  char *keys;          /* for people, or NULL */
  const char *missing; /* why it cannot be done now, translated, borrowed; NULL: it can */
} SporeSearchHit;

/* A dialog over the window, which runs what is chosen there. Takes commands, of SporeSearchHit *. */
GtkWidget *spore_search_new(GtkWindow *window, GPtrArray *commands);

#endif
