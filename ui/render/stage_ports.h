/* What instruments reach through their ports, shown on a stage: cones, and a tint on the tissue beyond them. */
#ifndef SPORE_UI_RENDER_STAGE_PORTS_H
#define SPORE_UI_RENDER_STAGE_PORTS_H

#include "core/scene/port_reach.h"
#include "ui/render/stage.h"

#define SPORE_STAGE_ALL_PORTS "all"

/* The ports of that name, or all that an instrument passes through: an array of SporePortReach, never empty. NULL with
 * a GError: there is none. */
GArray *spore_stage_find_ports(SporeDocument *document, const char *name, GError **error);
/* Shows the cones, and tints the tissue that lies in none of those that tint; where none does, nothing is tinted. Only
 * the places are kept of the ports; count 0: none. Of more than SPORE_CONES_MOST that tint, the first do. */
typedef struct SporeStagePort {
  SporePortReach reach;
  gboolean tints;
} SporeStagePort;
void spore_stage_set_ports(SporeStage *stage, const SporeStagePort *ports, guint count);

/* What the tint of so many ports says, as in spore_stage_legend; name: of the one. count 0: FALSE, nothing is tinted.
 */
gboolean spore_stage_reach_legend(guint count, const char *name, SporeStageLegend *legend);

#endif
