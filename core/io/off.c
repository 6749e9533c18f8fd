/* Reads and writes OFF, the one mesh format without a helper process (Princeton's description, with the prefixes of
 * Geomview; colours, normals and texture coordinates are skipped). */
#include "core/io/off.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/io/import_wire.h"
#include "core/io/mesh_import.h"
#include "core/io/scanner.h"

static gboolean is_header(const SporeScanner *scanner) {
  static const char *const headers[] = {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STNOFF", "STCOFF", "STCNOFF"};
  for (gsize i = 0; i < G_N_ELEMENTS(headers); i++)
    if (scanner->length == strlen(headers[i]) && !memcmp(scanner->word, headers[i], scanner->length)) return TRUE;
  return FALSE;
}

gboolean spore_off_is(const char *text, gsize size) {
  SporeScanner scanner;
  spore_scanner_init(&scanner, NULL, text, size);
  return spore_scanner_next(&scanner) && is_header(&scanner);
}

static gboolean read_vertices(SporeScanner *scanner, gsize count, GArray *vertices, GError **error) {
  for (gsize i = 0; i < count; i++) {
    double position[3];
    for (int axis = 0; axis < 3; axis++)
      if (!spore_scanner_real(scanner, _("a coordinate of a vertex"), &position[axis], error)) return FALSE;
    g_array_append_vals(vertices, position, 3);
    spore_scanner_skip_line(scanner);
  }
  return TRUE;
}

/* Reads a face with any number of corners as a fan of triangles. A face with fewer than three corners is skipped. */
static gboolean read_face(SporeScanner *scanner, gsize vertex_count, GArray *triangles, GError **error) {
  guint64 corners, index;
  guint32 corner[3];
  if (!spore_scanner_integer(scanner, _("the number of a face's corners"), 1, SPORE_FACE_CORNERS_MAXIMUM, &corners,
                             error))
    return FALSE;
  for (guint64 i = 0; i < corners; i++) {
    if (!spore_scanner_integer(scanner, _("the index of a vertex"), 0, vertex_count - 1, &index, error)) return FALSE;
    corner[MIN(i, 2)] = (guint32)index;
    if (i < 2) continue;
    g_array_append_vals(triangles, corner, 3);
    corner[1] = corner[2];
  }
  spore_scanner_skip_line(scanner);
  if (triangles->len / 3 > SPORE_MESH_MAXIMUM)
    return spore_scanner_fail(scanner, error,
                              _("there are more than %u triangles; expected fewer; decimate the mesh first"),
                              SPORE_MESH_MAXIMUM);
  return TRUE;
}

static gboolean read_body(SporeScanner *scanner, GArray *vertices, GArray *triangles, GError **error) {
  gsize vertex_count, face_count;
  guint64 edge_count;
  if (!spore_scanner_next(scanner) || !is_header(scanner))
    return spore_scanner_fail(scanner, error, _("this is not OFF; expected \"OFF\" first; give a file in that format"));
  if (!spore_scanner_count(scanner, _("a number of vertices"), 6, &vertex_count, error) ||
      !spore_scanner_count(scanner, _("a number of faces"), 4, &face_count, error) ||
      !spore_scanner_integer(scanner, _("a number of edges"), 0, G_MAXUINT32, &edge_count, error))
    return FALSE;
  if (!vertex_count || !face_count)
    return spore_scanner_fail(
        scanner, error,
        _("the file has %zu vertices and %zu faces; expected a surface; export it again with its faces"), vertex_count,
        face_count);
  if (!read_vertices(scanner, vertex_count, vertices, error)) return FALSE;
  for (gsize i = 0; i < face_count; i++)
    if (!read_face(scanner, vertex_count, triangles, error)) return FALSE;
  if (!triangles->len)
    return spore_scanner_fail(scanner, error,
                              _("no face has three corners; expected a surface; export it again with its faces"));
  return TRUE;
}

gboolean spore_off_parse(const char *place, const char *text, gsize size, SporeTriangleMesh *mesh, GError **error) {
  SporeScanner scanner;
  spore_scanner_init(&scanner, place, text, size);
  GArray *vertices = g_array_new(FALSE, FALSE, sizeof(double));
  GArray *triangles = g_array_new(FALSE, FALSE, sizeof(guint32));
  SporeError failure = SPORE_ERROR_INIT;
  gboolean done = read_body(&scanner, vertices, triangles, error);
  if (done && !spore_triangle_mesh_allocate(mesh, vertices->len / 3, triangles->len / 3, &failure)) {
    spore_error_at(&failure, scanner.place);
    done = spore_error_propagate(&failure, error);
  }
  if (done) {
    memcpy(mesh->vertices, vertices->data, vertices->len * sizeof(double));
    memcpy(mesh->triangles, triangles->data, triangles->len * sizeof(guint32));
  }
  g_array_unref(vertices);
  g_array_unref(triangles);
  return done;
}

char *spore_off_format(const SporeTriangleMesh *mesh, gsize *size) {
  GString *text = g_string_sized_new(64 * mesh->vertex_count + 24 * mesh->triangle_count + 64);
  g_string_append_printf(text, "OFF\n%" G_GSIZE_FORMAT " %" G_GSIZE_FORMAT " 0\n", mesh->vertex_count,
                         mesh->triangle_count);
  spore_append_reals(text, mesh->vertices, mesh->vertex_count, 3, "");
  for (gsize i = 0; i < mesh->triangle_count; i++) {
    const guint32 *corner = mesh->triangles + 3 * i;
    g_string_append_printf(text, "3 %u %u %u\n", corner[0], corner[1], corner[2]);
  }
  if (size) *size = text->len;
  return g_string_free(text, FALSE);
}

char *spore_obj_format(const SporeTriangleMesh *mesh, gsize *size) {
  GString *text = g_string_sized_new(64 * mesh->vertex_count + 24 * mesh->triangle_count + 64);
  for (gsize i = 0; i < mesh->vertex_count; i++) {
    g_string_append(text, "v ");
    spore_append_reals(text, mesh->vertices + 3 * i, 1, 3, "");
  }
  for (gsize i = 0; i < mesh->triangle_count; i++) {
    const guint32 *corner = mesh->triangles + 3 * i;
    g_string_append_printf(text, "f %u %u %u\n", corner[0] + 1, corner[1] + 1, corner[2] + 1);
  }
  if (size) *size = text->len;
  return g_string_free(text, FALSE);
}
