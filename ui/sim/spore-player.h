/* Runs a compiled copy of the document, and keeps it in step with edits.
 *
 * Signals
 *   state-changed ()           playing, or whether a simulation exists, may differ
 *   replaced ()                the simulation is another one, or none: build what is drawn anew
 *   failed (const char *text)  it could not be compiled; translated                                                 */
#ifndef SPORE_UI_SIM_SPORE_PLAYER_H
#define SPORE_UI_SIM_SPORE_PLAYER_H

#include "ui/document/spore-editor-document.h"
#include "ui/sim/session.h"

G_BEGIN_DECLS

#define SPORE_TYPE_PLAYER spore_player_get_type()
G_DECLARE_FINAL_TYPE(SporePlayer, spore_player, SPORE, PLAYER, GObject)

SporePlayer *spore_player_new(SporeEditorDocument *document);
/* NULL while editing: nothing was compiled. */
SporeSession *spore_player_get_session(SporePlayer *self);

/* Compiles the document where that was not done yet. FALSE: it failed, which the signal tells. */
gboolean spore_player_prepare(SporePlayer *self);
void spore_player_play(SporePlayer *self);
void spore_player_pause(SporePlayer *self);
void spore_player_step(SporePlayer *self);
void spore_player_reset(SporePlayer *self);
gboolean spore_player_is_playing(SporePlayer *self);
void spore_player_set_speed(SporePlayer *self, double speed); /* 1: real time; 0: as fast as it goes */

G_END_DECLS
#endif
