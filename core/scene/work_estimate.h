/* What takes long, said beforehand. */
#ifndef SPORE_SCENE_WORK_ESTIMATE_H
#define SPORE_SCENE_WORK_ESTIMATE_H

#include <glib.h>

#include "core/sim/world.h"

/* Calls `say` with each sentence (translated) about what of the body takes longer than a second to make or to
 * factorise, or longer than its time step to run, and with the remedy. By counts of blocks: see SporeBodyWork. */
typedef void (*SporeWorkSay)(gpointer data, const char *sentence, const char *remedy);
void spore_body_say_work(const SporeWorld *world, guint32 body, SporeWorkSay say, gpointer data);

#endif
