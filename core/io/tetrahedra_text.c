/* Tetrahedral meshes as text: reads and writes Medit (.mesh), writes Gmsh 2.2 (.msh) and VTK (.vtu). */
#include <glib/gi18n.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/mesh_import.h"
#include "core/io/scanner.h"

/* The content of a Medit file, as far as it is read; corners count from 0. */
typedef struct {
  gboolean has_vertices, has_tetrahedra;
  GArray *vertices, *tetrahedra; /* double, guint32 */
} MeditContent;

static gboolean read_dimension(SporeScanner *scanner, GError **error) {
  guint64 dimension;
  if (!spore_scanner_integer(scanner, _("a dimension"), 1, 3, &dimension, error)) return FALSE;
  if (dimension != 3)
    return spore_scanner_fail(scanner, error, _("the mesh is flat; expected dimension 3; give a mesh of tetrahedra"));
  return TRUE;
}

static gboolean read_vertices(SporeScanner *scanner, MeditContent *content, GError **error) {
  gsize count;
  if (!spore_scanner_count(scanner, _("a number of vertices"), 8, &count, error)) return FALSE;
  for (gsize i = 0; i < count; i++) {
    double position[3], reference;
    for (int axis = 0; axis < 3; axis++)
      if (!spore_scanner_real(scanner, _("a coordinate of a vertex"), &position[axis], error)) return FALSE;
    if (!spore_scanner_real(scanner, _("the reference of a vertex"), &reference, error)) return FALSE;
    g_array_append_vals(content->vertices, position, 3);
  }
  return content->has_vertices = TRUE;
}

static gboolean read_tetrahedra(SporeScanner *scanner, MeditContent *content, GError **error) {
  gsize count;
  if (!content->has_vertices)
    return spore_scanner_fail(scanner, error,
                              _("tetrahedra come before the vertices; expected Vertices first; save it again"));
  if (!spore_scanner_count(scanner, _("a number of tetrahedra"), 10, &count, error)) return FALSE;
  for (gsize i = 0; i < count; i++) {
    guint32 corner[4];
    double reference;
    for (int c = 0; c < 4; c++) {
      guint64 index;
      if (!spore_scanner_integer(scanner, _("the number of a vertex"), 1, content->vertices->len / 3, &index, error))
        return FALSE;
      corner[c] = (guint32)(index - 1);
    }
    if (!spore_scanner_real(scanner, _("the reference of a tetrahedron"), &reference, error)) return FALSE;
    g_array_append_vals(content->tetrahedra, corner, 4);
  }
  return content->has_tetrahedra = TRUE;
}

static gboolean read_medit(SporeScanner *scanner, MeditContent *content, GError **error) {
  if (!spore_scanner_next(scanner) || scanner->length < 20 ||
      g_ascii_strncasecmp(scanner->word, "MeshVersionFormatted", 20))
    return spore_scanner_fail(
        scanner, error,
        _("this is not a Medit mesh; expected \"MeshVersionFormatted\" first; give an ASCII .mesh file"));
  while (spore_scanner_next(scanner) && !spore_scanner_is(scanner, "End")) {
    gboolean read = TRUE;
    if (spore_scanner_is(scanner, "Dimension")) read = read_dimension(scanner, error);
    else if (spore_scanner_is(scanner, "Vertices")) read = read_vertices(scanner, content, error);
    else if (spore_scanner_is(scanner, "Tetrahedra")) read = read_tetrahedra(scanner, content, error);
    else if (spore_scanner_is(scanner, "Hexahedra") || spore_scanner_is(scanner, "Prisms"))
      read = spore_scanner_fail(
          scanner, error, _("the mesh holds cells other than tetrahedra; expected tetrahedra alone; split them first"));
    if (!read) return FALSE; /* every other section (triangles, edges, corners ...) is skipped word by word */
  }
  if (!content->tetrahedra->len)
    return spore_scanner_fail(scanner, error,
                              _("the file has no tetrahedra; expected a section Tetrahedra; give a mesh of a volume"));
  return TRUE;
}

/* Numbers the vertices that tetrahedra use from 0, in their order; number is all 0 before. Returns how many. */
static gsize number_used(const MeditContent *content, guint32 *number) {
  gsize total = content->vertices->len / 3, used = 0;
  const guint32 *corners = (const guint32 *)(const void *)content->tetrahedra->data;
  for (gsize i = 0; i < content->tetrahedra->len; i++) number[corners[i]] = 1;
  for (gsize i = 0; i < total; i++) number[i] = number[i] ? (guint32)used++ : G_MAXUINT32;
  return used;
}

/* Files disagree about the order of corners. Each tetrahedron is turned to a positive volume here, since a simulation
 * needs it. */
static void turn_positive(const double *vertices, guint32 *corner) {
  SporeVec3 a = spore_vec3_load(vertices + 3 * (gsize)corner[0]), b = spore_vec3_load(vertices + 3 * (gsize)corner[1]),
            c = spore_vec3_load(vertices + 3 * (gsize)corner[2]), d = spore_vec3_load(vertices + 3 * (gsize)corner[3]);
  SporeVec3 normal = spore_vec3_cross(spore_vec3_sub(b, a), spore_vec3_sub(c, a));
  if (spore_vec3_dot(normal, spore_vec3_sub(d, a)) >= 0) return;
  guint32 swap = corner[2];
  corner[2] = corner[3];
  corner[3] = swap;
}

static gboolean keep_tetrahedra(const char *place, const MeditContent *content, SporeTetrahedralMesh *mesh,
                                GError **error) {
  guint32 *number = SPORE_NEW_ARRAY(guint32, content->vertices->len / 3);
  if (!number)
    return spore_error_raise(error, SPORE_ERROR_MEMORY, place,
                             _("there is not enough memory to import it; close other programs"));
  gsize used = number_used(content, number), total = content->vertices->len / 3;
  const double *vertices = (const double *)(const void *)content->vertices->data;
  const guint32 *corners = (const guint32 *)(const void *)content->tetrahedra->data;
  SporeError failure = SPORE_ERROR_INIT;
  bool done = spore_tetrahedral_mesh_allocate(mesh, used, content->tetrahedra->len / 4, &failure);
  if (done) {
    for (gsize i = 0; i < total; i++)
      if (number[i] != G_MAXUINT32) memcpy(mesh->vertices + 3 * (gsize)number[i], vertices + 3 * i, 3 * sizeof(double));
    for (gsize i = 0; i < content->tetrahedra->len; i++) mesh->tetrahedra[i] = number[corners[i]];
    for (gsize i = 0; i < mesh->tetrahedron_count; i++) turn_positive(mesh->vertices, mesh->tetrahedra + 4 * i);
    done = spore_tetrahedral_mesh_validate(mesh, &failure);
    if (!done) spore_tetrahedral_mesh_clear(mesh);
  }
  spore_free(number);
  if (done) return TRUE;
  spore_error_at(&failure, place);
  return spore_error_propagate(&failure, error);
}

gboolean spore_medit_parse(const char *place, const char *text, gsize size, SporeTetrahedralMesh *mesh,
                           GError **error) {
  SporeScanner scanner;
  spore_scanner_init(&scanner, place, text, size);
  MeditContent content = {.vertices = g_array_new(FALSE, FALSE, sizeof(double)),
                          .tetrahedra = g_array_new(FALSE, FALSE, sizeof(guint32))};
  gboolean done = read_medit(&scanner, &content, error) && keep_tetrahedra(scanner.place, &content, mesh, error);
  g_array_unref(content.vertices);
  g_array_unref(content.tetrahedra);
  return done;
}

static guint label_of(const SporeTetrahedralMesh *mesh, gsize cell, guint otherwise) {
  return mesh->labels ? mesh->labels[cell] : otherwise;
}

static char *finish(GString *text, gsize *size) {
  if (size) *size = text->len;
  return g_string_free(text, FALSE);
}

char *spore_medit_format(const SporeTetrahedralMesh *mesh, gsize *size) {
  GString *text = g_string_new("MeshVersionFormatted 2\nDimension 3\n");
  g_string_append_printf(text, "Vertices\n%" G_GSIZE_FORMAT "\n", mesh->vertex_count);
  spore_append_reals(text, mesh->vertices, mesh->vertex_count, 3, " 0");
  g_string_append_printf(text, "Tetrahedra\n%" G_GSIZE_FORMAT "\n", mesh->tetrahedron_count);
  for (gsize i = 0; i < mesh->tetrahedron_count; i++) {
    const guint32 *corner = mesh->tetrahedra + 4 * i;
    g_string_append_printf(text, "%u %u %u %u %u\n", corner[0] + 1, corner[1] + 1, corner[2] + 1, corner[3] + 1,
                           label_of(mesh, i, 0));
  }
  g_string_append(text, "End\n");
  return finish(text, size);
}

char *spore_gmsh_format(const SporeTetrahedralMesh *mesh, gsize *size) {
  GString *text = g_string_new("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  g_string_append_printf(text, "$Nodes\n%" G_GSIZE_FORMAT "\n", mesh->vertex_count);
  for (gsize i = 0; i < mesh->vertex_count; i++) {
    g_string_append_printf(text, "%" G_GSIZE_FORMAT " ", i + 1);
    spore_append_reals(text, mesh->vertices + 3 * i, 1, 3, "");
  }
  g_string_append_printf(text, "$EndNodes\n$Elements\n%" G_GSIZE_FORMAT "\n", mesh->tetrahedron_count);
  for (gsize i = 0; i < mesh->tetrahedron_count; i++) { /* number, type 4 = tetrahedron, two tags, corners */
    const guint32 *corner = mesh->tetrahedra + 4 * i;
    g_string_append_printf(text, "%" G_GSIZE_FORMAT " 4 2 %u %u %u %u %u %u\n", i + 1, label_of(mesh, i, 1),
                           label_of(mesh, i, 1), corner[0] + 1, corner[1] + 1, corner[2] + 1, corner[3] + 1);
  }
  g_string_append(text, "$EndElements\n");
  return finish(text, size);
}

char *spore_vtu_format(const SporeTetrahedralMesh *mesh, gsize *size) {
  GString *text = g_string_new(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\">\n<UnstructuredGrid>\n");
  g_string_append_printf(text, "<Piece NumberOfPoints=\"%" G_GSIZE_FORMAT "\" NumberOfCells=\"%" G_GSIZE_FORMAT "\">\n",
                         mesh->vertex_count, mesh->tetrahedron_count);
  g_string_append(text, "<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n");
  spore_append_reals(text, mesh->vertices, mesh->vertex_count, 3, "");
  g_string_append(
      text, "</DataArray>\n</Points>\n<Cells>\n<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\n");
  for (gsize i = 0; i < mesh->tetrahedron_count; i++) {
    const guint32 *corner = mesh->tetrahedra + 4 * i;
    g_string_append_printf(text, "%u %u %u %u\n", corner[0], corner[1], corner[2], corner[3]);
  }
  g_string_append(text, "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n");
  for (gsize i = 0; i < mesh->tetrahedron_count; i++)
    g_string_append_printf(text, "%" G_GSIZE_FORMAT "\n", 4 * (i + 1));
  g_string_append(text, "</DataArray>\n<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n");
  for (gsize i = 0; i < mesh->tetrahedron_count; i++) g_string_append(text, "10\n"); /* VTK_TETRA */
  g_string_append(text, "</DataArray>\n</Cells>\n");
  if (mesh->labels) {
    g_string_append(text,
                    "<CellData Scalars=\"label\">\n<DataArray type=\"UInt32\" Name=\"label\" format=\"ascii\">\n");
    for (gsize i = 0; i < mesh->tetrahedron_count; i++) g_string_append_printf(text, "%u\n", mesh->labels[i]);
    g_string_append(text, "</DataArray>\n</CellData>\n");
  }
  g_string_append(text, "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
  return finish(text, size);
}
