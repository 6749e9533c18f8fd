/* Checks PLY files (Turk 1994): a text header that names elements and their properties, then the elements as text or as
 * bytes. */
#include "core/io/ply_check.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/io/scanner.h"
#include "core/mesh/mesh.h"

typedef enum { PLY_TEXT, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN } PlyForm;

typedef struct {
  const char *name;
  gsize size;
  gboolean real, negative;
} PlyType;

static const PlyType ply_types[] = {
    {"char", 1, FALSE, TRUE},  {"int8", 1, FALSE, TRUE},   {"uchar", 1, FALSE, FALSE},  {"uint8", 1, FALSE, FALSE},
    {"short", 2, FALSE, TRUE}, {"int16", 2, FALSE, TRUE},  {"ushort", 2, FALSE, FALSE}, {"uint16", 2, FALSE, FALSE},
    {"int", 4, FALSE, TRUE},   {"int32", 4, FALSE, TRUE},  {"uint", 4, FALSE, FALSE},   {"uint32", 4, FALSE, FALSE},
    {"float", 4, TRUE, TRUE},  {"float32", 4, TRUE, TRUE}, {"double", 8, TRUE, TRUE},   {"float64", 8, TRUE, TRUE},
};

#define MOST_PROPERTIES 64
#define MOST_ELEMENTS 16

typedef struct {
  const PlyType *count, *value; /* count NULL: no list */
  gboolean is_corners;          /* a face's list of vertices */
} PlyProperty;

typedef struct {
  gboolean is_vertex, is_face;
  guint64 count;
  gsize property_count;
  PlyProperty properties[MOST_PROPERTIES];
} PlyElement;

typedef struct {
  SporeScanner scanner;
  PlyForm form;
  const char *body, *end; /* the unread rest of a binary body */
  guint64 vertex_count;
  gsize element_count;
  PlyElement elements[MOST_ELEMENTS];
  GError **error;
} Ply;

static gboolean fail_header(Ply *ply) {
  return spore_scanner_fail(
      &ply->scanner, ply->error,
      _("this is no line of a PLY header; expected format, element, property or end_header; export "
        "the mesh again"));
}

static gboolean fail_short(Ply *ply) {
  return spore_error_raise(ply->error, SPORE_ERROR_INPUT, ply->scanner.place,
                           _("the PLY file is cut short: its header promises more; copy or export it again"));
}

static const PlyType *read_type(Ply *ply) {
  if (spore_scanner_next(&ply->scanner))
    for (gsize i = 0; i < G_N_ELEMENTS(ply_types); i++)
      if (spore_scanner_is(&ply->scanner, ply_types[i].name)) return &ply_types[i];
  return NULL;
}

static gboolean read_form(Ply *ply) {
  if (!spore_scanner_next(&ply->scanner)) return fail_short(ply);
  if (spore_scanner_is(&ply->scanner, "ascii")) ply->form = PLY_TEXT;
  else if (spore_scanner_is(&ply->scanner, "binary_little_endian")) ply->form = PLY_LITTLE_ENDIAN;
  else if (spore_scanner_is(&ply->scanner, "binary_big_endian")) ply->form = PLY_BIG_ENDIAN;
  else return fail_header(ply);
  return TRUE;
}

static gboolean read_element(Ply *ply) {
  if (ply->element_count == MOST_ELEMENTS || !spore_scanner_next(&ply->scanner)) return fail_header(ply);
  PlyElement *element = &ply->elements[ply->element_count++];
  element->is_vertex = spore_scanner_is(&ply->scanner, "vertex");
  element->is_face = spore_scanner_is(&ply->scanner, "face");
  if (!spore_scanner_integer(&ply->scanner, _("a number of elements"), 0, SPORE_MESH_MAXIMUM, &element->count,
                             ply->error))
    return FALSE;
  if (element->is_vertex) ply->vertex_count = element->count;
  return TRUE;
}

static gboolean read_property(Ply *ply) {
  PlyElement *element = ply->element_count ? &ply->elements[ply->element_count - 1] : NULL;
  if (!element || element->property_count == MOST_PROPERTIES) return fail_header(ply);
  PlyProperty *property = &element->properties[element->property_count++];
  SporeScanner before = ply->scanner;
  if (spore_scanner_next(&ply->scanner) && spore_scanner_is(&ply->scanner, "list")) {
    property->count = read_type(ply);
    if (!property->count || property->count->real) return fail_header(ply);
  } else ply->scanner = before;
  property->value = read_type(ply);
  if (!property->value || !spore_scanner_next(&ply->scanner)) return fail_header(ply);
  property->is_corners =
      element->is_face && property->count && !property->value->real &&
      (spore_scanner_is(&ply->scanner, "vertex_indices") || spore_scanner_is(&ply->scanner, "vertex_index"));
  return TRUE;
}

static gboolean read_header(Ply *ply) {
  SporeScanner *scanner = &ply->scanner;
  spore_scanner_next(scanner); /* "ply" */
  while (spore_scanner_next(scanner)) {
    gboolean read = TRUE;
    if (spore_scanner_is(scanner, "end_header")) {
      spore_scanner_skip_line(scanner);
      ply->body = scanner->at + (scanner->at < scanner->end); /* behind the end of the line */
      ply->end = scanner->end;
      return TRUE;
    }
    if (spore_scanner_is(scanner, "format")) read = read_form(ply);
    else if (spore_scanner_is(scanner, "element")) read = read_element(ply);
    else if (spore_scanner_is(scanner, "property")) read = read_property(ply);
    else if (!spore_scanner_is(scanner, "comment") && !spore_scanner_is(scanner, "obj_info")) read = fail_header(ply);
    if (!read) return FALSE;
    spore_scanner_skip_line(scanner);
  }
  return fail_short(ply);
}

/* Reads one number of the body. Real numbers are skipped: their values are checked after the import. */
static gboolean read_number(Ply *ply, const PlyType *type, gint64 *value) {
  if (ply->form == PLY_TEXT) {
    if (!spore_scanner_next(&ply->scanner)) return fail_short(ply);
    *value = 0;
    if (type->real) return TRUE;
    char *text = g_strndup(ply->scanner.word, ply->scanner.length), *end;
    *value = g_ascii_strtoll(text, &end, 10);
    gboolean whole = end > text && !*end;
    g_free(text);
    return whole || spore_scanner_fail(&ply->scanner, ply->error,
                                       _("this is not a whole number; expected one; correct the file"));
  }
  if ((gsize)(ply->end - ply->body) < type->size) return fail_short(ply);
  guint64 bits = 0;
  for (gsize i = 0; i < type->size; i++) {
    gsize from = ply->form == PLY_LITTLE_ENDIAN ? type->size - 1 - i : i;
    bits = bits << 8 | (guint8)ply->body[from];
  }
  ply->body += type->size;
  guint64 sign = (guint64)1 << (8 * type->size - 1);
  *value = type->negative && (bits & sign) ? (gint64)(bits - 2 * sign) : (gint64)bits;
  return TRUE;
}

static gboolean check_property(Ply *ply, const PlyProperty *property, guint64 index) {
  gint64 count = 1, value = 0;
  if (property->count && !read_number(ply, property->count, &count)) return FALSE;
  for (gint64 i = 0; i < count; i++) {
    if (!read_number(ply, property->value, &value)) return FALSE;
    if (property->is_corners && (value < 0 || (guint64)value >= ply->vertex_count))
      return spore_error_raise(
          ply->error, SPORE_ERROR_INPUT, ply->scanner.place,
          _("face %llu names vertex %lld of %llu; expected the index of a vertex; repair or export the mesh again"),
          (unsigned long long)index, (long long)value, (unsigned long long)ply->vertex_count);
  }
  return TRUE;
}

gboolean spore_ply_check(const char *place, const char *content, gsize size, GError **error) {
  Ply *ply = g_new0(Ply, 1);
  ply->error = error;
  spore_scanner_init(&ply->scanner, place, content, size);
  gboolean sound = read_header(ply);
  for (gsize e = 0; sound && e < ply->element_count; e++) {
    const PlyElement *element = &ply->elements[e];
    for (guint64 i = 0; sound && i < element->count; i++)
      for (gsize p = 0; sound && p < element->property_count; p++)
        sound = check_property(ply, &element->properties[p], i);
  }
  g_free(ply);
  return sound;
}
