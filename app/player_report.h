/* What spore-player tells of a run. */
#ifndef SPORE_APP_PLAYER_REPORT_H
#define SPORE_APP_PLAYER_REPORT_H

#include "models/spore.h"

/* Says steps, time, hash, what was not solved and the exercise, to people. */
void spore_player_say(SporeRuntime *runtime);
/* Prints the same as one JSON object, with the names of bodies, tools and visual meshes. Members are those of
 * `spore run --json`, and numbers come back to the same bits. */
void spore_player_print(SporeRuntime *runtime, const char *file);

#endif
