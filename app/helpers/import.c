/* spore-import: decodes a mesh file's bytes, in the sandbox. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/helpers/import_assimp.h"
#include "core/io/helper.h"
#include "core/io/import_wire.h"
#include "core/io/mesh_format.h"

static const char *const extensions[SPORE_MESH_FORMAT_COUNT] = {[SPORE_MESH_STL] = "stl",
                                                                [SPORE_MESH_OBJ] = "obj",
                                                                [SPORE_MESH_PLY] = "ply",
                                                                [SPORE_MESH_GLTF] = "gltf",
                                                                [SPORE_MESH_GLB] = "glb"};

int main(int argc, char **argv) {
  spore_helper_start(argc, argv);
  void *request, *answer;
  size_t size, answer_size;
  SporeImportRequest head;
  if (!spore_helper_read_request(&request, &size) || size < sizeof head) _exit(1);
  memcpy(&head, request, sizeof head);
  if (head.format >= SPORE_MESH_FORMAT_COUNT || !extensions[head.format]) _exit(1);
  SporeHelperFailure failure;
  if (spore_import_assimp(extensions[head.format], (const char *)request + sizeof head, size - sizeof head, &answer,
                          &answer_size, &failure))
    spore_helper_send_answer(answer, answer_size);
  else spore_helper_send_error(failure.code, failure.message, failure.detail);
  _exit(0);
}
