/* assimp behind C: one importer, one block of memory, and no file. */
#ifndef SPORE_HELPERS_IMPORT_ASSIMP_H
#define SPORE_HELPERS_IMPORT_ASSIMP_H

#include <stdbool.h>
#include <stddef.h>

#include "core/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SporeImportFailure {
  SporeErrorCode code;
  const char *message; /* marked for translation */
  char detail[256];    /* what the library said; may be empty */
} SporeImportFailure;

/* Decodes `content` by the importer of that extension ("stl", "obj", "ply", "gltf", "glb"): node transforms applied,
 * meshes joined, polygons cut into triangles. *answer: SporeImportAnswer with its arrays, malloc'ed. */
bool spore_import_assimp(const char *extension, const void *content, size_t size, void **answer, size_t *answer_size,
                         SporeImportFailure *failure);

#ifdef __cplusplus
}
#endif

#endif
