/* What a user chose for all scenes, kept in the folder of the user's settings: $XDG_CONFIG_HOME/spore/editor.ini. */
#ifndef SPORE_UI_DOCUMENT_PREFERENCES_H
#define SPORE_UI_DOCUMENT_PREFERENCES_H

#include <glib.h>

#define SPORE_PREFERENCE_CHOICES 6

/* The table is the only place that knows them: the actions of the program, the window and the file follow it. */
typedef struct SporePreference {
  const char *name;       /* in the file, and of the program's action */
  const char *label;      /* translatable */
  const char *doc;        /* translatable */
  gboolean at_next_start; /* it holds from the next start of the program on */
  guint preset;           /* index of the choice that holds where nothing was chosen */
  struct {
    const char *name, *label;          /* label: translatable */
  } choices[SPORE_PREFERENCE_CHOICES]; /* name NULL behind the last */
} SporePreference;

extern const SporePreference spore_preferences[]; /* name NULL behind the last */

/* The preference of that name; NULL: there is none. */
const SporePreference *spore_preference_find(const char *name);
/* Index of the choice of that name; -1: there is none. */
int spore_preference_choice(const SporePreference *preference, const char *choice);
/* Name of the choice that was kept, where it is one of the table; else of the preset. */
const char *spore_preference_get(const SporePreference *preference);
/* Keeps the choice, and with it whatever else the file holds. FALSE: the file cannot be written. */
gboolean spore_preference_set(const SporePreference *preference, const char *choice, GError **error);

#endif
