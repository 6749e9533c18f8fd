/* Document to world. */
#ifndef SPORE_SCENE_COMPILE_H
#define SPORE_SCENE_COMPILE_H

#include "core/haptic/track.h"
#include "core/scene/document.h"
#include "core/sim/world.h"

/* A running copy of a document: nothing that happens in it leaks into the scene. */
typedef struct SporeSimulation {
  SporeWorld *world;
  SporeTrack *track;    /* merged input: tracks named by the scene's devices; NULL: none */
  GPtrArray *devices;   /* SporeDevice *, closed with the simulation */
  guint32 *body_object; /* world body index -> object id */
} SporeSimulation;

/* Compiles; pool borrowed. `input`: replaces the scene's own tracks by body name; borrowed for the simulation's life;
 * NULL: the scene's. NULL with a GError (place "FILE:LINE:COLUMN" or object path) when the scene cannot run. */
SporeSimulation *spore_simulation_new(SporeDocument *document, SporePool *pool, const SporeTrack *input,
                                      GError **error);
void spore_simulation_free(SporeSimulation *simulation);
/* Whether the body collides with its model's own spheres: it has a collision unit, and that names none. */
gboolean spore_body_has_own_spheres(const SporeObject *body);
/* Where the author puts a body at the start. */
SporePose spore_body_pose(const SporeObject *body);
/* World body of an object (itself or an ancestor is a body), or SPORE_NO_BODY. */
guint32 spore_simulation_body_of(const SporeSimulation *simulation, SporeObject *object);
/* Carries state over from an older world by body name where the degrees of freedom agree. */
void spore_simulation_carry_over(SporeSimulation *to, const SporeSimulation *from);
/* A changed property of the document as a command of the running world. FALSE: it cannot take it, compile again. */
gboolean spore_simulation_apply(SporeSimulation *simulation, SporeDocument *document, SporeObject *object,
                                guint property);

#endif
