/* What the files of this room share. */
#ifndef SPORE_RUNTIME_PRIVATE_H
#define SPORE_RUNTIME_PRIVATE_H

#include "core/runtime/codec.h"

/* The mapping of a visual mesh to its body at one level of detail; made when it is first asked for. */
typedef struct SporeRuntimeMap {
  SporeMapping mapping;
  bool made;
  uint64_t knots; /* SporeLines.number that it is adapted to */
} SporeRuntimeMap;

struct SporeRuntime {
  SporeArena arena; /* all that `scene` points to */
  SporeRuntimeScene scene;
  SporeWorld *world;
  SporeExercise *exercise; /* NULL: there is none */
  SporeDevice **devices;   /* scene.track.channel_count; NULL: not opened yet */
  SporeRuntimeMap *maps;   /* scene.visual_count x SPORE_LOD_COUNT */
};

/* Reads the content over an empty scene. False with the error. */
bool spore_runtime_read(SporeRuntime *runtime, const void *content, size_t size, SporeModelRegistry registry,
                        SporeError *error);

#endif
