/* Attempts at the exercise of a scene, kept in the user's data folder: one file for each scene, one line for each run
 * that ended. No GTK. */
#ifndef SPORE_UI_DOCUMENT_ATTEMPTS_H
#define SPORE_UI_DOCUMENT_ATTEMPTS_H

#include <glib.h>

#include "core/exercise/exercise.h"

typedef struct SporeAttempt {
  gint64 when; /* it ended, s since 1970 */
  guint64 steps, steps_done;
  double time_s, score; /* on the exercise's clock; 0 to 100 */
  gboolean passed;
} SporeAttempt;

/* An exercise that has ended, as an attempt that ends now. */
SporeAttempt spore_attempt_of(const SporeExerciseState *state);
/* GArray of SporeAttempt, oldest first. scene: the scene's file; NULL: none. Lines that cannot be understood are left
 * out. */
GArray *spore_attempts_read(const char *scene);
/* Appends an attempt to those of the scene's file; what is there stays, whatever happens. FALSE with a GError: the file
 * cannot be written. */
gboolean spore_attempts_add(const char *scene, const SporeAttempt *attempt, GError **error);

#endif
