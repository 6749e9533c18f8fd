/* A simulation on a thread of its own, paced to real time or free. GLib, no GTK. */
#ifndef SPORE_UI_SIM_SESSION_H
#define SPORE_UI_SIM_SESSION_H

#include "core/measure/local_error.h"
#include "core/measure/numbers.h"
#include "core/scene/compile.h"

typedef struct SporeSession SporeSession;

/* Compiles the document and starts paused at time 0. The session owns its simulation. cancel: ends the making, and is
 * borrowed for this call; NULL: none. On any thread. */
SporeSession *spore_session_new(SporeDocument *document, int threads, const SporeTrack *input,
                                const SporeCancel *cancel, GError **error);
void spore_session_free(SporeSession *session); /* stops the thread and waits */
const SporeSimulation *spore_session_simulation(const SporeSession *session);

void spore_session_play(SporeSession *session);
void spore_session_pause(SporeSession *session); /* returns when the thread has stopped */
/* The same, but returns soon. FALSE: a step is still under way. */
gboolean spore_session_try_pause(SporeSession *session);
/* The same, where the session is to be freed next: ends a step under way, whose state is then the one before it. */
gboolean spore_session_try_give_up(SporeSession *session);
gboolean spore_session_stands(const SporeSession *session); /* paused, and no step is under way */
gboolean spore_session_is_playing(const SporeSession *session);
void spore_session_step(SporeSession *session, guint steps); /* while paused; returns when done */
/* The same, but returns soon. FALSE: the steps are still under way. */
gboolean spore_session_try_step(SporeSession *session, guint steps);
/* Time 0, paused or playing as before; ends a step under way. */
void spore_session_reset(SporeSession *session);
/* The same, but returns soon. FALSE: the session is still on its way to time 0. */
gboolean spore_session_try_reset(SporeSession *session);
/* Copies the state of bodies that both sessions have, by name, into a session that is not running. Its exercise is a
 * try-out. */
void spore_session_carry_over(SporeSession *to, const SporeSession *from);
/* Whether all is known that went into the run since time 0, so that the run can go back: not of a session that began
 * with a state carried over, or was changed. */
gboolean spore_session_knows_past(const SporeSession *session);
/* Steps of the run so far; after going back, those to which the run can go forward again. The next step of its own
 * forgets them. */
guint64 spore_session_reached(const SporeSession *session);
double spore_session_step_s(const SporeSession *session); /* s: of one step */
/* Goes to the state after `step` steps, or as far as the run reached, and pauses: computes the run anew, to the bit,
 * from time 0 or from where it stands, as fast as it goes. The exercise is a try-out then. Returns soon. FALSE: it is
 * on its way. Nothing happens where the past is not known. */
gboolean spore_session_try_go_to(SporeSession *session, guint64 step);
/* Plays all of the run once more from time 0, at the speed that is set, and pauses at its end. Otherwise the same. */
gboolean spore_session_try_replay(SporeSession *session);
/* Whether it is on its way, and how far: 0 to 1. For the GTK thread. */
gboolean spore_session_is_going(SporeSession *session, double *fraction);
/* Ends the way where it is now. */
void spore_session_stay(SporeSession *session);
void spore_session_set_speed(SporeSession *session, double speed); /* 1: real time; 0: as fast as it goes */
double spore_session_get_speed(const SporeSession *session);

/* Newest state. Valid until the next call. One reader: the GTK thread. */
const SporeSnapshot *spore_session_snapshot(SporeSession *session);
/* What a command does makes the exercise a try-out. FALSE: not taken, as on the way to another state. */
gboolean spore_session_post(SporeSession *session, const SporeCommand *command);
/* Where the mouse holds the active body `body`. From then on the mouse moves that body, and not its track, until a
 * reset. */
void spore_session_set_pointer(SporeSession *session, guint32 body, const SporeDeviceState *state);
/* The last state of a device of the active body `body`; before the first state, an open hand. */
SporeDeviceState spore_session_input(SporeSession *session, guint32 body);
/* Simulated seconds per second of clock over the last second. */
double spore_session_real_time_factor(const SporeSession *session);
/* Steps since playing began, and how many of them ended too late; 0 of 0 where steps are not paced. */
void spore_session_late_steps(const SporeSession *session, guint64 *late, guint64 *steps);
/* What is measured of a run beside its snapshots. */
typedef struct SporeSessionFigures {
  double local_error;     /* m: last estimate for the body that was worst (core/measure/local_error.h); NAN: none yet */
  guint32 error_body;     /* SPORE_NO_BODY: nothing moves */
  double energy_start;    /* J, in all, at time 0 */
  gsize unsolved_count;   /* bodies and causes: spore_world_unsolved_count */
  SporeUnsolved unsolved; /* the one with most steps; read only where the count is above 0 */
} SporeSessionFigures;
SporeSessionFigures spore_session_figures(SporeSession *session);

/* Hands the exercise of the scene to `read`, which finds all of it as it was after one step. FALSE: the scene has none.
 */
typedef void (*SporeExerciseReader)(const SporeExercise *exercise, gpointer data);
gboolean spore_session_read_exercise(SporeSession *session, SporeExerciseReader read, gpointer data);
/* How an attempt ended, once for each: an exercise from time 0 on that was no try-out. Of those that ended since the
 * last call, the last one. FALSE: none did. */
gboolean spore_session_take_attempt(SporeSession *session, SporeExerciseState *state);
/* The input that the session was made with is that of an attempt, which is repeated: no attempt comes of it. Takes the
 * track, which lives as long as the session. Before the first step. */
void spore_session_repeat(SporeSession *session, SporeTrack *input);
/* The exercise, if there is one, is a try-out until a reset. */
void spore_session_try_out(SporeSession *session);
/* The world was changed otherwise than by a command of spore_session_post: the same, and the past is not known. */
void spore_session_change(SporeSession *session);
/* spore_exercise_skip_to, between two steps. FALSE: the exercise has no such step. */
gboolean spore_session_skip_to(SporeSession *session, gsize step);

/* Numbers over time: all of spore_quantities, measured some 30 times a simulated second since time 0, and less often
 * once there are thousands of rows. The columns stay until points are watched. */
const SporeColumn *spore_session_columns(const SporeSession *session, gsize *count);
/* Copies `count` columns from `first` on of all rows: an array of row_count x count doubles, to be freed by g_free. */
double *spore_session_numbers(SporeSession *session, gsize first, gsize count, gsize *row_count);
/* All of them as CSV, to be freed by spore_free. NULL: no memory. */
char *spore_session_csv(SporeSession *session, size_t *size);
/* Watches these points and no others, from time 0 on, where the session goes back to. FALSE: a body cannot carry its
 * point; the points before are watched on. */
gboolean spore_session_watch(SporeSession *session, const SporeWatchRequest *points, gsize count, GError **error);

/* A copy of all device states so far; a lens that a command wiped is wiped in it by its device's button. Free with
 * spore_track_clear and g_free. */
SporeTrack *spore_session_recording(SporeSession *session);

#endif
