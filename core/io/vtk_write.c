/* VTK's XML files of surfaces, tetrahedra, lines and points. A file is a head in XML, which says where each array
 * begins, and the arrays, each behind its size in bytes. */
#include "core/io/vtk_write.h"

#include <string.h>

#include "core/math/mat3.h"

#define VTK_TETRA 10

static const char *byte_order(void) { return G_BYTE_ORDER == G_LITTLE_ENDIAN ? "LittleEndian" : "BigEndian"; }

const char *spore_vtk_suffix(const SporeDrawnPart *part) { return part->kind == SPORE_PART_CELLS ? "vtu" : "vtp"; }

/* A file under way. */
typedef struct Writer {
  GString *head;
  GByteArray *arrays;
} Writer;

/* data: `bytes` of numbers of the type, components of a tuple in turn. */
static void add_array(Writer *writer, const char *type, const char *name, guint components, gconstpointer data,
                      gsize bytes) {
  guint64 size = bytes;
  g_string_append_printf(writer->head,
                         "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%u\" format=\"appended\" "
                         "offset=\"%u\"/>\n",
                         type, name, components, writer->arrays->len);
  g_byte_array_append(writer->arrays, (const guint8 *)&size, sizeof size);
  g_byte_array_append(writer->arrays, data, (guint)bytes);
}

/* As floats: what is looked at needs no more digits. */
static void add_floats(Writer *writer, const char *name, guint components, const double *numbers, gsize count) {
  g_autofree float *rounded = g_new(float, count + 1);
  for (gsize i = 0; i < count; i++) rounded[i] = (float)numbers[i];
  add_array(writer, "Float32", name, components, rounded, count * sizeof *rounded);
}

/* Elements of `width` points each, one after the other. */
static void add_elements(Writer *writer, const guint32 *points, gsize count, guint width) {
  g_autofree gint32 *ends = g_new(gint32, count + 1);
  for (gsize i = 0; i < count; i++) ends[i] = (gint32)((i + 1) * width);
  add_array(writer, "Int32", "connectivity", 1, points, count * width * sizeof *points);
  add_array(writer, "Int32", "offsets", 1, ends, count * sizeof *ends);
}

/* The points 0, 1, ... in elements of `width`. */
static void add_in_turn(Writer *writer, gsize count, guint width) {
  g_autofree guint32 *points = g_new(guint32, count * width + 1);
  for (gsize i = 0; i < count * width; i++) points[i] = (guint32)i;
  add_elements(writer, points, count, width);
}

/* Deformation. */

/* Edges of a tetrahedron from its first corner, as columns. */
static SporeMat3 edges_of(const double *points, const guint32 *corner) {
  SporeVec3 first = spore_vec3_load(points + 3 * (gsize)corner[0]), edge[3];
  for (int i = 0; i < 3; i++) edge[i] = spore_vec3_sub(spore_vec3_load(points + 3 * (gsize)corner[i + 1]), first);
  return spore_mat3_from_columns(edge[0], edge[1], edge[2]);
}

/* E = (F^T F - 1) / 2, Green's strain, and det F of the deformation F of each tetrahedron. A tetrahedron that is flat
 * at rest has none: zeros. */
static void add_strains(Writer *writer, const SporeDrawnPart *part) {
  g_autofree double *strains = g_new0(double, 6 * part->element_count + 1);
  g_autofree double *ratios = g_new0(double, part->element_count + 1);
  for (gsize i = 0; i < part->element_count; i++) {
    const guint32 *corner = part->elements + 4 * i;
    SporeMat3 inverse;
    if (!spore_mat3_invert(edges_of(part->rest, corner), &inverse)) continue;
    SporeMat3 deformation = spore_mat3_multiply(edges_of(part->positions, corner), inverse);
    const double *c = spore_mat3_multiply(spore_mat3_transpose(deformation), deformation).m;
    const double strain[] = {(c[0] - 1) / 2, (c[4] - 1) / 2, (c[8] - 1) / 2, c[1] / 2, c[5] / 2, c[2] / 2};
    memcpy(strains + 6 * i, strain, sizeof strain);
    ratios[i] = spore_mat3_determinant(deformation);
  }
  add_floats(writer, "strain", 6, strains, 6 * part->element_count);
  add_floats(writer, "volume_ratio", 1, ratios, part->element_count);
}

static void add_displacements(Writer *writer, const SporeDrawnPart *part) {
  g_autofree double *moved = g_new(double, 3 * part->count + 1);
  for (gsize i = 0; i < 3 * part->count; i++) moved[i] = part->positions[i] - part->rest[i];
  add_floats(writer, "displacement", 3, moved, 3 * part->count);
}

/* Files. */

static void add_points(Writer *writer, const SporeDrawnPart *part) {
  g_string_append(writer->head, "<PointData Vectors=\"velocity\">\n");
  add_floats(writer, "velocity", 3, part->velocities, 3 * part->count);
  if (part->rest) add_displacements(writer, part);
  if (part->radii) add_floats(writer, "radius", 1, part->radii, part->count);
  g_string_append(writer->head, "</PointData>\n<CellData>\n");
  if (part->rest) add_strains(writer, part);
  g_string_append(writer->head, "</CellData>\n<Points>\n");
  add_array(writer, "Float64", "positions", 3, part->positions, 3 * part->count * sizeof *part->positions);
  g_string_append(writer->head, "</Points>\n");
}

static void begin_grid(Writer *writer, const char *grid, double time_s) {
  char time[G_ASCII_DTOSTR_BUF_SIZE];
  g_string_append_printf(writer->head,
                         "<?xml version=\"1.0\"?>\n<VTKFile type=\"%s\" version=\"1.0\" byte_order=\"%s\" "
                         "header_type=\"UInt64\">\n<%s>\n<FieldData>\n"
                         "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
                         "format=\"ascii\">%s</DataArray>\n</FieldData>\n",
                         grid, byte_order(), grid, g_ascii_dtostr(time, sizeof time, time_s));
}

static void add_cells(Writer *writer, const SporeDrawnPart *part) {
  g_autofree guint8 *types = g_malloc(part->element_count + 1);
  memset(types, VTK_TETRA, part->element_count);
  g_string_append_printf(writer->head, "<Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n", part->count,
                         part->element_count);
  add_points(writer, part);
  g_string_append(writer->head, "<Cells>\n");
  add_elements(writer, part->elements, part->element_count, 4);
  add_array(writer, "UInt8", "types", 1, types, part->element_count);
  g_string_append(writer->head, "</Cells>\n</Piece>\n");
}

static void add_poly_data(Writer *writer, const SporeDrawnPart *part) {
  gsize verts = part->kind == SPORE_PART_POINTS ? part->count : 0;
  gsize lines = part->kind == SPORE_PART_LINE ? 1 : 0;
  gsize polys = part->kind == SPORE_PART_SURFACE ? part->element_count : 0;
  g_string_append_printf(writer->head,
                         "<Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" NumberOfLines=\"%zu\" "
                         "NumberOfStrips=\"0\" NumberOfPolys=\"%zu\">\n",
                         part->count, verts, lines, polys);
  add_points(writer, part);
  g_string_append(writer->head, "<Verts>\n");
  add_in_turn(writer, verts, 1);
  g_string_append(writer->head, "</Verts>\n<Lines>\n");
  add_in_turn(writer, lines, (guint)part->count);
  g_string_append(writer->head, "</Lines>\n<Polys>\n");
  add_elements(writer, part->elements, polys, 3);
  g_string_append(writer->head, "</Polys>\n</Piece>\n");
}

GByteArray *spore_vtk_format(const SporeDrawnPart *part, double time_s) {
  gboolean cells = part->kind == SPORE_PART_CELLS;
  const char *grid = cells ? "UnstructuredGrid" : "PolyData";
  g_autoptr(GString) head = g_string_new(NULL);
  g_autoptr(GByteArray) arrays = g_byte_array_new();
  Writer writer = {head, arrays};
  begin_grid(&writer, grid, time_s);
  if (cells) add_cells(&writer, part);
  else add_poly_data(&writer, part);
  g_string_append_printf(head, "</%s>\n<AppendedData encoding=\"raw\">\n_", grid);
  GByteArray *file = g_byte_array_new();
  static const char end[] = "\n</AppendedData>\n</VTKFile>\n";
  g_byte_array_append(file, (const guint8 *)head->str, (guint)head->len);
  g_byte_array_append(file, arrays->data, arrays->len);
  g_byte_array_append(file, (const guint8 *)end, sizeof end - 1);
  return file;
}

char *spore_vtk_format_blocks(const GPtrArray *names, const GPtrArray *files) {
  GString *text = g_string_new(NULL);
  g_string_append_printf(text,
                         "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" "
                         "byte_order=\"%s\">\n<vtkMultiBlockDataSet>\n",
                         byte_order());
  for (guint i = 0; i < names->len; i++) {
    g_autofree char *block = g_markup_printf_escaped("<DataSet index=\"%u\" name=\"%s\" file=\"%s\"/>\n", i,
                                                     (const char *)names->pdata[i], (const char *)files->pdata[i]);
    g_string_append(text, block);
  }
  g_string_append(text, "</vtkMultiBlockDataSet>\n</VTKFile>\n");
  return g_string_free(text, FALSE);
}

char *spore_vtk_format_series(const double *times, const GPtrArray *files) {
  GString *text = g_string_new(NULL);
  g_string_append_printf(
      text, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"%s\">\n<Collection>\n",
      byte_order());
  for (guint i = 0; i < files->len; i++) {
    char time[G_ASCII_DTOSTR_BUF_SIZE];
    g_autofree char *moment =
        g_markup_printf_escaped("<DataSet timestep=\"%s\" group=\"\" part=\"0\" file=\"%s\"/>\n",
                                g_ascii_dtostr(time, sizeof time, times[i]), (const char *)files->pdata[i]);
    g_string_append(text, moment);
  }
  g_string_append(text, "</Collection>\n</VTKFile>\n");
  return g_string_free(text, FALSE);
}
