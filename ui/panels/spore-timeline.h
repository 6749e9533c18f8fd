/* The run as a line in time: where it is, going back and forth, bookmarks, playing it once more. */
#ifndef SPORE_UI_PANELS_SPORE_TIMELINE_H
#define SPORE_UI_PANELS_SPORE_TIMELINE_H

#include "ui/sim/spore-player.h"

#include <gtk/gtk.h>

G_BEGIN_DECLS

#define SPORE_TYPE_TIMELINE spore_timeline_get_type()
G_DECLARE_FINAL_TYPE(SporeTimeline, spore_timeline, SPORE, TIMELINE, GtkBox)

void spore_timeline_set_player(SporeTimeline *self, SporePlayer *player);
/* Keeps the time that the run is at. FALSE: that time is kept already, or is the start. */
gboolean spore_timeline_bookmark(SporeTimeline *self);
/* Goes to the state that is nearest to the time, s, of those that the run reached; one step back; plays the run once
 * more. FALSE with a GError: the past of the run is not known. */
gboolean spore_timeline_go_to(SporeTimeline *self, double time_s, GError **error);
gboolean spore_timeline_step_back(SporeTimeline *self, GError **error);
gboolean spore_timeline_replay(SporeTimeline *self, GError **error);

G_END_DECLS
#endif
