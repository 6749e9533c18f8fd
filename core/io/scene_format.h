/* Where the objects of a scene stand in the text that is written of it. */
#ifndef SPORE_IO_SCENE_FORMAT_H
#define SPORE_IO_SCENE_FORMAT_H

#include "core/scene/document_private.h"

typedef struct SporeObjectPlace {
  SporeObject *object;
  int line, column;
} SporeObjectPlace;

/* As spore_scene_format; appends the objects' places to `places` (of SporeObjectPlace; may be NULL). */
char *spore_scene_format_places(const SporeDocument *document, gsize *size, GArray *places);

#endif
