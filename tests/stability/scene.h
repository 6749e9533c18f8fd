/* Shipped scenes for the stability suite, with settings as `spore run --set` takes them. */
#ifndef SPORE_TESTS_SCENE_H
#define SPORE_TESTS_SCENE_H

#include "core/scene/compile.h"
#include "core/sim/world_private.h"

typedef struct Scene {
  SporeSchema *schema;
  SporeDocument *document;
  SporeSimulation *simulation;
  SporeWorld *world;
} Scene;

/* Never without a world. path, property, value: of one setting; NULL: the scene as it is. */
Scene scene_open(const char *file, const char *path, const char *property, const char *value);
void scene_close(Scene *scene);

#endif
