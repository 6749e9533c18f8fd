/* Recognises the format of a mesh file by its content, and refuses files that were cut short. */
#include "core/io/mesh_format.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/io/gltf_check.h"
#include "core/io/off.h"
#include "core/io/ply_check.h"

const char *const spore_mesh_format_names[SPORE_MESH_FORMAT_COUNT] = {"STL",  "OBJ", "PLY", "OFF",
                                                                      "glTF", "GLB", "VTK", "VTP"};

#define STL_HEADER 84
#define STL_FACET 50

typedef struct {
  const char *place, *file;
  const char *bytes;
  gsize size;
} Content;

static guint32 read_u32(const Content *content, gsize offset) {
  guint32 value;
  memcpy(&value, content->bytes + offset, sizeof value);
  return GUINT32_FROM_LE(value);
}

static gboolean begins(const Content *content, const char *text) {
  return content->size >= strlen(text) && !memcmp(content->bytes, text, strlen(text));
}

static gboolean has_within(const Content *content, gsize limit, const char *text) {
  return memmem(content->bytes, MIN(content->size, limit), text, strlen(text)) != NULL;
}

static gboolean named(const Content *content, const char *extension) {
  gsize length = strlen(content->file), tail = strlen(extension);
  return length >= tail && !g_ascii_strcasecmp(content->file + length - tail, extension);
}

static gboolean is_text(const Content *content) { return !memchr(content->bytes, 0, MIN(content->size, 4096)); }

static guint64 stl_size(const Content *content) {
  return STL_HEADER + STL_FACET * (guint64)read_u32(content, STL_HEADER - 4);
}

static gboolean is_stl(const Content *content) {
  if (content->size > STL_HEADER && stl_size(content) == content->size) return TRUE;
  if (is_text(content)) return begins(content, "solid") && has_within(content, 1 << 16, "facet");
  /* Some programs write more bytes behind the facets. Only the name can tell such a file from other content. */
  return named(content, ".stl") && content->size > STL_HEADER && stl_size(content) > STL_HEADER &&
         stl_size(content) < content->size;
}

static gboolean is_ply(const Content *content) { return begins(content, "ply\n") || begins(content, "ply\r"); }

/* A line "v NUMBER": nothing else marks OBJ. */
static gboolean is_obj(const Content *content) {
  if (!is_text(content)) return FALSE;
  const char *at = content->bytes, *end = at + content->size;
  while (at && end - at > 3) {
    while (end - at > 3 && (*at == ' ' || *at == '\t')) at++;
    if (at[0] == 'v' && (at[1] == ' ' || at[1] == '\t')) {
      const char *value = at + 2;
      while (value < end && (*value == ' ' || *value == '\t')) value++;
      return value < end && (g_ascii_isdigit(*value) || strchr("+-.nNiI", *value) != NULL);
    }
    at = memchr(at, '\n', (gsize)(end - at));
    if (at) at++;
  }
  return FALSE;
}

/* Whether the text begins with that character, after white space. */
static gboolean is_text_head(const Content *content, char head) {
  gsize start = 0;
  while (start < content->size && g_ascii_isspace(content->bytes[start])) start++;
  return start < content->size && content->bytes[start] == head;
}

static gboolean is_gltf(const Content *content) {
  return is_text_head(content, '{') && has_within(content, content->size, "\"asset\"");
}

static gboolean fail_short(const Content *content, const char *format, guint64 said, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, content->place,
                           _("the %s file is cut short: it says it has %llu bytes but has %zu; expected the whole "
                             "file; copy or export it again"),
                           format, (unsigned long long)said, content->size);
}

/* Lengths of the container and of its chunks (glTF 2.0, "GLB file format specification"), and the JSON in the first. */
static gboolean check_glb(const Content *content, GError **error) {
  if (content->size < 20) return fail_short(content, "GLB", 20, error);
  if (read_u32(content, 4) != 2)
    return spore_error_raise(error, SPORE_ERROR_INPUT, content->place,
                             _("the GLB file is of version %u; expected version 2; export it again as glTF 2.0"),
                             read_u32(content, 4));
  guint64 length = read_u32(content, 8);
  if (length > content->size) return fail_short(content, "GLB", length, error);
  for (guint64 at = 12; at + 8 <= length;) {
    guint64 next = at + 8 + read_u32(content, (gsize)at);
    if (next > length)
      return spore_error_raise(
          error, SPORE_ERROR_INPUT, content->place,
          _("a part of the GLB file reaches beyond its end; expected parts that fit; export it again"));
    at = next;
  }
  guint32 text_size = read_u32(content, 12);
  if (read_u32(content, 16) != 0x4E4F534A || text_size > content->size - 20)
    return spore_error_raise(error, SPORE_ERROR_INPUT, content->place,
                             _("the GLB file does not begin with its JSON; expected glTF 2.0; export it again"));
  return spore_gltf_check(content->place, content->bytes + 20, text_size, error);
}

/* A text that was cut short would still be read, with fewer facets. */
static gboolean check_stl(const Content *content, GError **error) {
  gsize tail = MIN(content->size, 1024);
  if (!is_text(content) || (content->size > STL_HEADER && stl_size(content) == content->size) ||
      memmem(content->bytes + content->size - tail, tail, "endsolid", strlen("endsolid")))
    return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, content->place,
                           _("the STL text is cut short: expected \"endsolid\" at its end; copy or export it again"));
}

static gboolean fail_unknown(const Content *content, GError **error) {
  if (named(content, ".stl") && !is_text(content)) {
    if (content->size < STL_HEADER) return fail_short(content, "STL", STL_HEADER, error);
    if (stl_size(content) > content->size) return fail_short(content, "STL", stl_size(content), error);
    return spore_error_raise(error, SPORE_ERROR_INPUT, content->place,
                             _("the STL file holds no triangles; expected at least one; export the mesh again"));
  }
  return spore_error_raise(error, SPORE_ERROR_INPUT, content->place,
                           is_text(content)
                               ? _("this is text, but no mesh; expected STL, OBJ, PLY, OFF, glTF, GLB or VTK; "
                                   "export the mesh again in one of these, the name alone does not matter")
                               : _("this is no mesh that SPORE knows; expected STL, OBJ, PLY, OFF, glTF, "
                                   "GLB or VTK; export the mesh again in one of these"));
}

gboolean spore_mesh_format_find(const char *place, const char *file, const void *bytes, gsize size,
                                SporeMeshFormat *format, GError **error) {
  Content content = {place ? place : "", file ? file : "", bytes, size};
  if (!size)
    return spore_error_raise(error, SPORE_ERROR_INPUT, content.place,
                             _("the file is empty; expected a mesh; copy or export it again"));
  if (begins(&content, "glTF")) {
    *format = SPORE_MESH_GLB;
    return check_glb(&content, error);
  }
  if (is_stl(&content)) {
    *format = SPORE_MESH_STL;
    return check_stl(&content, error);
  }
  if (is_ply(&content)) {
    *format = SPORE_MESH_PLY;
    return spore_ply_check(content.place, content.bytes, size, error);
  }
  if (is_gltf(&content)) {
    *format = SPORE_MESH_GLTF;
    return spore_gltf_check(content.place, content.bytes, size, error);
  }
  if (begins(&content, "# vtk DataFile")) *format = SPORE_MESH_VTK;
  else if (is_text_head(&content, '<') && has_within(&content, 4096, "<VTKFile")) *format = SPORE_MESH_VTP;
  else if (spore_off_is(content.bytes, size)) *format = SPORE_MESH_OFF;
  else if (is_obj(&content)) *format = SPORE_MESH_OBJ;
  else return fail_unknown(&content, error);
  return TRUE;
}

gsize spore_mesh_format_extent(SporeMeshFormat format, const void *bytes, gsize size) {
  Content content = {"", "", bytes, size};
  return format == SPORE_MESH_STL && !is_text(&content) ? (gsize)stl_size(&content) : size;
}
