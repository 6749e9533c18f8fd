/* Reads what a mesh file of any format names. */
#include <string.h>

#include "core/base/memory.h"
#include "core/io/mesh_beside.h"
#include "core/io/mesh_format.h"
#include "core/io/mesh_text.h"

#define GLB_TEXT 20

/* The text of the format, in UTF-8, as its importer has it. */
static void read_text(SporeMeshBeside *beside, const char *file, const char *text, gsize size) {
  SporeMeshFormat format;
  if (!spore_mesh_format_find(file, file, text, size, &format, NULL)) return;
  if (format == SPORE_MESH_OBJ) spore_mesh_beside_materials(beside, file, text, size);
  if (format == SPORE_MESH_GLTF) spore_mesh_beside_images(beside, file, text, size);
  if (format != SPORE_MESH_GLB) return;
  guint32 length; /* within the content, as was found above */
  memcpy(&length, text + GLB_TEXT - 8, sizeof length);
  spore_mesh_beside_images(beside, file, text + GLB_TEXT, GUINT32_FROM_LE(length));
}

SporeMeshBeside *spore_mesh_beside_read(const char *file, GBytes *content) {
  SporeMeshBeside *beside = spore_mesh_beside_new();
  gsize size;
  const char *text = g_bytes_get_data(content, &size);
  char *held = NULL;
  if (size && spore_mesh_text(&text, &size, &held)) read_text(beside, file, text, size);
  spore_free(held);
  return beside;
}
