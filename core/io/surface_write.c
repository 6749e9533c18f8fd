/* OBJ, PLY and STL of the surfaces of a scene. */
#include "core/io/surface_write.h"

#include <math.h>
#include <string.h>

#include "core/io/scanner.h"
#include "core/io/surface_split.h"

#define STL_HEAD 80

void spore_named_surface_clear(SporeNamedSurface *surface) {
  spore_triangle_mesh_clear(&surface->mesh);
  g_clear_pointer(&surface->picture, g_bytes_unref);
  g_clear_pointer(&surface->places, g_free);
}

/* OBJ. */

/* Places count from below there. Returns how many there are. */
static gsize append_places(GString *text, const SporeSurfaceSplit *split) {
  for (gsize i = 0; split->places && i < split->count; i++) {
    const double place[2] = {(double)split->places[2 * i], 1 - (double)split->places[2 * i + 1]};
    g_string_append(text, "vt ");
    spore_append_reals(text, place, 1, 2, "");
  }
  return split->places ? split->count : 0;
}

/* vertex, place: number of the object's first one. */
static void append_faces(GString *text, const SporeSurfaceSplit *split, gsize triangles, gsize vertex, gsize place) {
  for (gsize i = 0; i < 3 * triangles; i++) {
    guint32 corner = split->triangles[i];
    g_string_append_printf(text, "%s%zu", i % 3 ? " " : "f ", vertex + split->vertices[corner]);
    if (split->places) g_string_append_printf(text, "/%zu", place + corner);
    if (i % 3 == 2) g_string_append_c(text, '\n');
  }
}

char *spore_obj_format_scene(const SporeNamedSurface *surfaces, gsize count, const char *materials, gsize *size) {
  GString *text = g_string_new("# SPORE: unit metre\n");
  gsize before = 1, placed = 1; /* vertices and places count from 1 in all objects together */
  g_string_append_printf(text, "mtllib %s\n", materials);
  for (gsize s = 0; s < count; s++) {
    const SporeTriangleMesh *mesh = &surfaces[s].mesh;
    g_string_append_printf(text, "o %s\nusemtl %s\n", surfaces[s].name, surfaces[s].name);
    for (gsize i = 0; i < mesh->vertex_count; i++) {
      g_string_append(text, "v ");
      spore_append_reals(text, mesh->vertices + 3 * i, 1, 3, "");
    }
    SporeSurfaceSplit split;
    spore_surface_split_init(&split, &surfaces[s]);
    gsize places = append_places(text, &split);
    append_faces(text, &split, mesh->triangle_count, before, placed);
    spore_surface_split_clear(&split);
    before += mesh->vertex_count;
    placed += places;
  }
  *size = text->len;
  return g_string_free(text, FALSE);
}

char *spore_mtl_format(const SporeNamedSurface *surfaces, gsize count, char *const *pictures, gsize *size) {
  GString *text = g_string_new("# SPORE: colours in sRGB\n");
  for (gsize s = 0; s < count; s++) {
    g_string_append_printf(text, "newmtl %s\nKd ", surfaces[s].name);
    spore_append_reals(text, surfaces[s].colour, 1, 3, "");
    if (surfaces[s].opacity < 1) {
      g_string_append(text, "d ");
      spore_append_reals(text, &surfaces[s].opacity, 1, 1, "");
    }
    if (pictures[s]) g_string_append_printf(text, "map_Kd %s\n", pictures[s]);
  }
  *size = text->len;
  return g_string_free(text, FALSE);
}

/* Binary files. */

static void append_float(GByteArray *file, double value) {
  float number = (float)value;
  guint32 bits;
  memcpy(&bits, &number, sizeof bits);
  bits = GUINT32_TO_LE(bits);
  g_byte_array_append(file, (const guint8 *)&bits, sizeof bits);
}

static void append_vector(GByteArray *file, SporeVec3 v) {
  append_float(file, v.x), append_float(file, v.y), append_float(file, v.z);
}

static void append_index(GByteArray *file, gsize value) {
  guint32 bits = GUINT32_TO_LE((guint32)value);
  g_byte_array_append(file, (const guint8 *)&bits, sizeof bits);
}

static void count_all(const SporeNamedSurface *surfaces, gsize count, gsize *vertices, gsize *triangles) {
  *vertices = *triangles = 0;
  for (gsize s = 0; s < count; s++) {
    *vertices += surfaces[s].mesh.vertex_count;
    *triangles += surfaces[s].mesh.triangle_count;
  }
}

GByteArray *spore_ply_format(const SporeNamedSurface *surfaces, gsize count) {
  gsize vertices, triangles, before = 0;
  count_all(surfaces, count, &vertices, &triangles);
  g_autofree char *head = g_strdup_printf(
      "ply\nformat binary_little_endian 1.0\ncomment SPORE: unit metre\nelement vertex %zu\nproperty float x\nproperty "
      "float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face %zu\n"
      "property list uchar int vertex_indices\nend_header\n",
      vertices, triangles);
  GByteArray *file = g_byte_array_new();
  g_byte_array_append(file, (const guint8 *)head, (guint)strlen(head));
  for (gsize s = 0; s < count; s++) {
    const SporeNamedSurface *surface = &surfaces[s];
    guint8 colour[3];
    for (int k = 0; k < 3; k++) colour[k] = (guint8)lround(255 * surface->colour[k]);
    for (gsize i = 0; i < surface->mesh.vertex_count; i++) {
      append_vector(file, spore_vec3_load(surface->mesh.vertices + 3 * i));
      g_byte_array_append(file, colour, sizeof colour);
    }
  }
  for (gsize s = 0; s < count; s++) {
    const SporeTriangleMesh *mesh = &surfaces[s].mesh;
    for (gsize i = 0; i < mesh->triangle_count; i++) {
      static const guint8 three = 3;
      g_byte_array_append(file, &three, 1);
      for (int k = 0; k < 3; k++) append_index(file, before + mesh->triangles[3 * i + (gsize)k]);
    }
    before += mesh->vertex_count;
  }
  return file;
}

GByteArray *spore_stl_format(const SporeNamedSurface *surfaces, gsize count) {
  gsize vertices, triangles;
  count_all(surfaces, count, &vertices, &triangles);
  char head[STL_HEAD] = "SPORE: unit metre"; /* "solid" would begin a text */
  GByteArray *file = g_byte_array_new();
  g_byte_array_append(file, (const guint8 *)head, sizeof head);
  append_index(file, triangles);
  for (gsize s = 0; s < count; s++) {
    const SporeTriangleMesh *mesh = &surfaces[s].mesh;
    for (gsize i = 0; i < mesh->triangle_count; i++) {
      static const guint8 attributes[2] = {0};
      SporeVec3 corner[3];
      for (int k = 0; k < 3; k++)
        corner[k] = spore_vec3_load(mesh->vertices + 3 * (gsize)mesh->triangles[3 * i + (gsize)k]);
      SporeVec3 normal = spore_vec3_cross(spore_vec3_sub(corner[1], corner[0]), spore_vec3_sub(corner[2], corner[0]));
      append_vector(file, spore_vec3_normalise(normal, spore_vec3(0, 0, 0)));
      for (int k = 0; k < 3; k++) append_vector(file, corner[k]);
      g_byte_array_append(file, attributes, sizeof attributes);
    }
  }
  return file;
}
