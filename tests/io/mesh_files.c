/* Writes a mesh in each of the formats that SPORE imports. */
#include "tests/io/mesh_files.h"

#include <string.h>

static void add(GByteArray *file, const void *bytes, gsize size) { g_byte_array_append(file, bytes, (guint)size); }

static void print(GByteArray *file, const char *format, ...) G_GNUC_PRINTF(2, 3);
static void print(GByteArray *file, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  char *text = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  add(file, text, strlen(text));
  g_free(text);
}

static void add_u32(GByteArray *file, guint32 value) {
  value = GUINT32_TO_LE(value);
  add(file, &value, sizeof value);
}

static void add_f32(GByteArray *file, double value) {
  union {
    float number;
    guint32 bits;
  } as = {.number = (float)value};
  add_u32(file, as.bits);
}

static const double *corner(const SporeTriangleMesh *mesh, gsize triangle, gsize c) {
  return mesh->vertices + 3 * (gsize)mesh->triangles[3 * triangle + c];
}

GByteArray *file_stl_text(const SporeTriangleMesh *mesh) {
  GByteArray *file = g_byte_array_new();
  print(file, "solid organ\n");
  for (gsize i = 0; i < mesh->triangle_count; i++) {
    print(file, "facet normal 0 0 0\nouter loop\n");
    for (gsize c = 0; c < 3; c++) {
      const double *p = corner(mesh, i, c);
      print(file, "vertex %.9g %.9g %.9g\n", p[0], p[1], p[2]);
    }
    print(file, "endloop\nendfacet\n");
  }
  print(file, "endsolid organ\n");
  return file;
}

GByteArray *file_stl(const SporeTriangleMesh *mesh) {
  GByteArray *file = g_byte_array_new();
  char head[80] = "made by a test";
  add(file, head, sizeof head);
  add_u32(file, (guint32)mesh->triangle_count);
  for (gsize i = 0; i < mesh->triangle_count; i++) {
    for (int axis = 0; axis < 3; axis++) add_f32(file, 0);
    for (gsize c = 0; c < 3; c++)
      for (int axis = 0; axis < 3; axis++) add_f32(file, corner(mesh, i, c)[axis]);
    add(file, "\0", 2);
  }
  return file;
}

GByteArray *file_obj(const SporeTriangleMesh *mesh, const char *head) {
  GByteArray *file = g_byte_array_new();
  print(file, "%s", head);
  for (gsize i = 0; i < mesh->vertex_count; i++)
    print(file, "v %.9g %.9g %.9g\n", mesh->vertices[3 * i], mesh->vertices[3 * i + 1], mesh->vertices[3 * i + 2]);
  for (gsize i = 0; i < 3 * mesh->triangle_count; i += 3)
    print(file, "f %u %u %u\n", mesh->triangles[i] + 1, mesh->triangles[i + 1] + 1, mesh->triangles[i + 2] + 1);
  return file;
}

static GByteArray *ply_head(const SporeTriangleMesh *mesh, const char *format) {
  GByteArray *file = g_byte_array_new();
  print(file, "ply\nformat %s 1.0\ncomment made by a test\nelement vertex %" G_GSIZE_FORMAT "\n", format,
        mesh->vertex_count);
  print(file, "property float x\nproperty float y\nproperty float z\nelement face %" G_GSIZE_FORMAT "\n",
        mesh->triangle_count);
  print(file, "property list uchar int vertex_indices\nend_header\n");
  return file;
}

GByteArray *file_ply_text(const SporeTriangleMesh *mesh) {
  GByteArray *file = ply_head(mesh, "ascii");
  for (gsize i = 0; i < mesh->vertex_count; i++)
    print(file, "%.9g %.9g %.9g\n", mesh->vertices[3 * i], mesh->vertices[3 * i + 1], mesh->vertices[3 * i + 2]);
  for (gsize i = 0; i < 3 * mesh->triangle_count; i += 3)
    print(file, "3 %u %u %u\n", mesh->triangles[i], mesh->triangles[i + 1], mesh->triangles[i + 2]);
  return file;
}

GByteArray *file_ply(const SporeTriangleMesh *mesh) {
  GByteArray *file = ply_head(mesh, "binary_little_endian");
  for (gsize i = 0; i < 3 * mesh->vertex_count; i++) add_f32(file, mesh->vertices[i]);
  for (gsize i = 0; i < 3 * mesh->triangle_count; i++) {
    if (i % 3 == 0) add(file, "\3", 1);
    add_u32(file, mesh->triangles[i]);
  }
  return file;
}

/* Positions, then indices. */
GByteArray *file_gltf_buffer(const SporeTriangleMesh *mesh) {
  GByteArray *buffer = g_byte_array_new();
  for (gsize i = 0; i < 3 * mesh->vertex_count; i++) add_f32(buffer, mesh->vertices[i]);
  for (gsize i = 0; i < 3 * mesh->triangle_count; i++) add_u32(buffer, mesh->triangles[i]);
  return buffer;
}

static char *gltf_text(const SporeTriangleMesh *mesh, const char *uri) {
  gsize positions = 12 * mesh->vertex_count, indices = 12 * mesh->triangle_count;
  char *at = uri ? g_strdup_printf(",\"uri\":\"%s\"", uri) : g_strdup("");
  char *text = g_strdup_printf(
      "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
      "\"nodes\":[{\"mesh\":0,\"translation\":[1,2,3],\"scale\":[2,1,1]}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
      "\"buffers\":[{\"byteLength\":%" G_GSIZE_FORMAT "%s}],"
      "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":%" G_GSIZE_FORMAT "},"
      "{\"buffer\":0,\"byteOffset\":%" G_GSIZE_FORMAT ",\"byteLength\":%" G_GSIZE_FORMAT "}],"
      "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":%" G_GSIZE_FORMAT ",\"type\":\"VEC3\"},"
      "{\"bufferView\":1,\"componentType\":5125,\"count\":%" G_GSIZE_FORMAT ",\"type\":\"SCALAR\"}]}",
      positions + indices, at, positions, positions, indices, mesh->vertex_count, 3 * mesh->triangle_count);
  g_free(at);
  return text;
}

GByteArray *file_gltf(const SporeTriangleMesh *mesh, const char *uri) {
  GByteArray *buffer = file_gltf_buffer(mesh), *file = g_byte_array_new();
  char *coded = g_base64_encode(buffer->data, buffer->len);
  char *embedded = g_strconcat("data:application/octet-stream;base64,", coded, NULL);
  char *text = gltf_text(mesh, uri ? uri : embedded);
  add(file, text, strlen(text));
  g_free(text);
  g_free(embedded);
  g_free(coded);
  g_byte_array_unref(buffer);
  return file;
}

GByteArray *file_glb(const SporeTriangleMesh *mesh) {
  GByteArray *buffer = file_gltf_buffer(mesh), *file = g_byte_array_new();
  char *text = gltf_text(mesh, NULL);
  guint32 length = (guint32)strlen(text), padding = (4 - length % 4) % 4;
  add(file, "glTF", 4);
  add_u32(file, 2);
  add_u32(file, 12 + 8 + length + padding + 8 + buffer->len);
  add_u32(file, length + padding);
  add(file, "JSON", 4);
  add(file, text, length);
  add(file, "   ", padding);
  add_u32(file, buffer->len);
  add(file, "BIN\0", 4);
  add(file, buffer->data, buffer->len);
  g_free(text);
  g_byte_array_unref(buffer);
  return file;
}
