/* An interface in C to assimp: one importer, one block of memory, and no file. */
#ifndef SPORE_HELPERS_IMPORT_ASSIMP_H
#define SPORE_HELPERS_IMPORT_ASSIMP_H

#include <stdbool.h>
#include <stddef.h>

#include "app/helpers/failure.h"
#include "core/io/import_wire.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Decodes what stands behind the head of a request, by the importer of that extension ("stl", "obj", "ply", "gltf",
 * "glb"). Node transforms are applied, meshes are joined, each node with a mesh is a part, and polygons are cut into
 * triangles. *answer: SporeImportAnswer with its arrays, malloc'ed. */
bool spore_import_assimp(const char *extension, const SporeImportRequest *head, const char *rest, void **answer,
                         size_t *answer_size, SporeHelperFailure *failure);

#ifdef __cplusplus
}
#endif

#endif
