/* Compiles a document into a world that runs. */
#ifndef SPORE_SCENE_COMPILE_H
#define SPORE_SCENE_COMPILE_H

#include "core/exercise/exercise.h"
#include "core/haptic/track.h"
#include "core/scene/document.h"
#include "core/sim/world.h"

/* A running copy of a document. The simulation never changes the document. */
typedef struct SporeSimulation {
  SporeWorld *world;
  SporeExercise *exercise; /* of the world; whoever steps the world has to let it watch; NULL: the scene has none */
  SporeTrack *track;       /* merged input: tracks named by the scene's devices; NULL: none */
  GPtrArray *devices;      /* SporeDevice *, closed with the simulation */
  guint32 *body_object;    /* world body index -> object id */
} SporeSimulation;

/* Compiles the document. The pool is borrowed. `input` replaces the scene's own tracks by body name, and is borrowed
 * for the simulation's life; NULL: the scene's tracks are used. cancel: ends the compilation and later steps, and is
 * borrowed for the simulation's life; NULL: none. Returns NULL with a GError (place "FILE:LINE:COLUMN" or object path)
 * when the scene cannot run, and when the compilation was cancelled. */
SporeSimulation *spore_simulation_new(SporeDocument *document, SporePool *pool, const SporeTrack *input,
                                      const SporeCancel *cancel, GError **error);
/* As spore_simulation_new, of a world that leaves nothing out: SporeWorldDescription.unpruned. */
SporeSimulation *spore_simulation_new_unpruned(SporeDocument *document, SporePool *pool, const SporeTrack *input,
                                               const SporeCancel *cancel, GError **error);
void spore_simulation_free(SporeSimulation *simulation);
/* Frees an input that GLib allocated; NULL: nothing. */
void spore_input_free(SporeTrack *input);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(SporeSimulation, spore_simulation_free)
/* Whether the body collides with its model's own spheres: its collision unit names no sphere set. */
gboolean spore_body_has_own_spheres(const SporeObject *body);
/* Whether emitters keep back a fluid until it flows, so that nothing of it is there at the start. FALSE for what is no
 * fluid. */
gboolean spore_body_is_kept_back(SporeDocument *document, const SporeObject *body);
/* Where the author puts a body at the start. */
SporePose spore_body_pose(const SporeObject *body);
/* Index in the world of the body that the object is or belongs to, or SPORE_NO_BODY. */
guint32 spore_simulation_body_of(const SporeSimulation *simulation, SporeObject *object);
/* Copies state from an older world to bodies of the same name whose degrees of freedom agree. */
void spore_simulation_carry_over(SporeSimulation *to, const SporeSimulation *from);
/* Sends a changed property of the document to the running world as a command. FALSE: the world cannot take the change;
 * compile again. */
gboolean spore_simulation_apply(SporeSimulation *simulation, SporeDocument *document, SporeObject *object,
                                guint property);

#endif
