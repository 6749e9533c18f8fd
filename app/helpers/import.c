/* spore-import: decodes a mesh file's bytes, in the sandbox. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/helpers/import_assimp.h"
#include "app/helpers/serve.h"
#include "app/helpers/vtk.h"
#include "core/io/import_wire.h"
#include "core/io/mesh_format.h"

static const char *const extensions[SPORE_MESH_FORMAT_COUNT] = {[SPORE_MESH_STL] = "stl",
                                                                [SPORE_MESH_OBJ] = "obj",
                                                                [SPORE_MESH_PLY] = "ply",
                                                                [SPORE_MESH_GLTF] = "gltf",
                                                                [SPORE_MESH_GLB] = "glb"};

#if SPORE_HAVE_ASSIMP
#define BY_ASSIMP spore_import_assimp
#else
#define BY_ASSIMP refuse
/* SPORE does not ask for these formats where they are not in the build. */
static bool refuse(const char *extension, const SporeImportRequest *head, const char *rest, void **answer,
                   size_t *answer_size, SporeHelperFailure *failure) {
  _exit(1);
}
#endif

static bool decode(const SporeImportRequest *head, const char *rest, void **answer, size_t *answer_size,
                   SporeHelperFailure *failure) {
  if (head->format == SPORE_MESH_VTK) return spore_vtk_legacy(rest, head->size, answer, answer_size, failure);
  if (head->format == SPORE_MESH_VTP) return spore_vtk_xml(rest, head->size, answer, answer_size, failure);
  if (head->format >= SPORE_MESH_FORMAT_COUNT || !extensions[head->format]) _exit(1);
  return BY_ASSIMP(extensions[head->format], head, rest, answer, answer_size, failure);
}

static bool answer(const uint8_t *request, size_t size, void **answer, size_t *answer_size,
                   SporeHelperFailure *failure) {
  SporeImportRequest head;
  if (size < sizeof head) _exit(1);
  memcpy(&head, request, sizeof head);
  return decode(&head, (const char *)request + sizeof head, answer, answer_size, failure);
}

int main(int argc, char **argv) { spore_helper_serve(argc, argv, answer); }
