/* Whether a scene that was read from a file may be handed to models and world. */
#ifndef SPORE_RUNTIME_TRUST_H
#define SPORE_RUNTIME_TRUST_H

#include "core/runtime/runtime.h"

/* Checks what models and world take for granted: meshes, curves and spheres are sound, what has a count is there,
 * models have the geometry of their types, links and their bodies, the order of recorded input, and that the exercise
 * names what is there. False with the
 * error, whose place is the object. */
bool spore_runtime_trust(const SporeRuntimeScene *scene, SporeError *error);

#endif
