/* Attempts at the exercise of a scene, kept in the user's data folder: one file for each scene, one line for each run
 * that ended, and beside it what moved the instruments in the newest of them. No GTK. */
#ifndef SPORE_UI_DOCUMENT_ATTEMPTS_H
#define SPORE_UI_DOCUMENT_ATTEMPTS_H

#include <glib.h>

#include "core/exercise/exercise.h"
#include "core/haptic/track.h"

#define SPORE_ATTEMPTS_WITH_TRACKS 20 /* of a scene: of older ones the line alone is kept */

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
/* Where the input of an attempt is kept, if it is. g_free. */
char *spore_attempts_track_file(const char *scene, const SporeAttempt *attempt);
/* Reads such a file. NULL with a GError; free with spore_track_clear and g_free. Any thread. */
SporeTrack *spore_attempts_read_track(const char *file, GError **error);
/* Keeps the input of an attempt, and takes away that of the oldest where there are too many. Any thread. FALSE with a
 * GError: the file cannot be written. */
gboolean spore_attempts_add_track(const char *scene, const SporeAttempt *attempt, const SporeTrack *input,
                                  GError **error);

#endif
