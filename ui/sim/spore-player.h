/* Runs a compiled copy of the document, and keeps it in step with edits. The copy is made by a job; until the copy is
 * there, the run before goes on, where there is one.
 *
 * Signals
 *   state-changed ()           playing, or whether a simulation exists or is being made, may differ
 *   progressed ()              the job that makes the simulation has told how far it is
 *   replaced ()                the simulation is another one, or none: build what is drawn anew
 *   failed (const char *text)  it could not be compiled; translated                                                 */
#ifndef SPORE_UI_SIM_SPORE_PLAYER_H
#define SPORE_UI_SIM_SPORE_PLAYER_H

#include "ui/document/spore-editor-document.h"
#include "ui/jobs/spore-job.h"
#include "ui/sim/session.h"

G_BEGIN_DECLS

#define SPORE_TYPE_PLAYER spore_player_get_type()
G_DECLARE_FINAL_TYPE(SporePlayer, spore_player, SPORE, PLAYER, GObject)

SporePlayer *spore_player_new(SporeEditorDocument *document);
/* Ends the run and what is being made, and follows the document no more. A job that makes a simulation holds the
 * player, so that giving up the last reference of others is not enough. */
void spore_player_close(SporePlayer *self);
/* NULL while editing, and until the first simulation is made. */
SporeSession *spore_player_get_session(SporePlayer *self);
/* Whether a simulation is being made, or is about to be, or waits for the one before to end. */
gboolean spore_player_is_making(SporePlayer *self);
/* The job that makes a simulation; NULL: none does. */
SporeJob *spore_player_get_job(SporePlayer *self);
/* Ends the making, and the run that it was to take the place of: that one is of another scene by now. */
void spore_player_cancel(SporePlayer *self);

/* Begins to compile the document where there is no simulation; `replaced` follows, or `failed`. */
void spore_player_prepare(SporePlayer *self);
/* These are done once the simulation is there. */
void spore_player_play(SporePlayer *self);
void spore_player_pause(SporePlayer *self);
void spore_player_step(SporePlayer *self);
void spore_player_reset(SporePlayer *self); /* ends a repetition, too */
/* See spore_session_knows_past, _try_go_to, _try_replay, _is_going and _stay; fraction may be NULL. */
gboolean spore_player_knows_past(SporePlayer *self);
void spore_player_go_to(SporePlayer *self, guint64 step);
void spore_player_replay(SporePlayer *self);
gboolean spore_player_is_going(SporePlayer *self, double *fraction);
void spore_player_stay(SporePlayer *self);
/* Plays an attempt or what was recorded from time 0: the input is in that file. `failed` where it cannot be read. */
void spore_player_repeat(SporePlayer *self, const char *file);
gboolean spore_player_is_repeating(SporePlayer *self);
gboolean spore_player_is_playing(SporePlayer *self);          /* or will, once the simulation is there */
void spore_player_set_speed(SporePlayer *self, double speed); /* 1: real time; 0: as fast as it goes */

G_END_DECLS
#endif
