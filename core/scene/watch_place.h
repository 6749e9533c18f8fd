/* A point of a body as people write it: liver@0.01,0,0.02. */
#ifndef SPORE_SCENE_WATCH_PLACE_H
#define SPORE_SCENE_WATCH_PLACE_H

#include "core/scene/compile.h"

/* Reads X,Y,Z: finite numbers and nothing else. FALSE: it is not of that form. */
gboolean spore_place_parse(const char *text, SporeVec3 *at);
/* Reads BODY@X,Y,Z: the body's name, and a place in the scene at time 0, m, at most one mean edge outside the body. To
 * be called before the first step of the simulation. FALSE with a GError, whose place is the text: it is not of that
 * form, the scene has no such body, or the body does not carry such a place; then its nearest point is said. */
gboolean spore_watch_place_parse(const SporeSimulation *simulation, SporeDocument *document, const char *text,
                                 guint32 *body, SporeVec3 *at, GError **error);

#endif
