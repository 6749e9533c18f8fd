/* Meshes as other programs write them: buffers in files of their own, other encodings, blank lines, VTK. */
#include <fcntl.h>
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/memory.h"
#include "core/io/mesh_import.h"
#include "core/mesh/common.h"
#include "tests/io/mesh_files.h"
#include "tests/mesh/shapes.h"

static SporeTriangleMesh ball(void) {
  SporeTriangleMesh mesh = {0};
  shape_ball(&mesh, 0.05, 8);
  return mesh;
}

/* The content decodes to a closed ball of `stretch` times its volume. */
static void check_ball(const char *file, const void *content, gsize size, double stretch) {
  GError *error = NULL;
  SporeTriangleMesh given = ball(), mesh;
  SporeMeshReport was, is;
  gboolean done = spore_mesh_decode(file, file, content, size, 0, 0, &mesh, NULL, &error);
  g_assert_no_error(error);
  g_assert_true(done);
  g_assert_true(spore_triangle_mesh_report(&given, &was, NULL) && spore_triangle_mesh_report(&mesh, &is, NULL));
  g_assert_cmpuint(mesh.triangle_count, ==, given.triangle_count);
  g_assert_true(is.closed);
  g_assert_cmpfloat_with_epsilon(is.volume / was.volume, stretch, 1e-5);
  spore_triangle_mesh_clear(&given);
  spore_triangle_mesh_clear(&mesh);
}

/* A folder with the buffer of a ball, "ball data.bin". */
typedef struct Folder {
  char *path, *file, *buffer;
} Folder;

static void set_up(Folder *folder, gconstpointer data) {
  SporeTriangleMesh mesh = ball();
  GByteArray *buffer = file_gltf_buffer(&mesh);
  folder->path = g_dir_make_tmp("spore-beside-XXXXXX", NULL);
  folder->file = g_build_filename(folder->path, "ball.gltf", NULL);
  folder->buffer = g_build_filename(folder->path, "ball data.bin", NULL);
  g_assert_true(g_file_set_contents(folder->buffer, (const char *)buffer->data, buffer->len, NULL));
  g_byte_array_unref(buffer);
  spore_triangle_mesh_clear(&mesh);
}

static void tear_down(Folder *folder, gconstpointer data) {
  g_unlink(folder->buffer);
  g_rmdir(folder->path);
  g_free(folder->path);
  g_free(folder->file);
  g_free(folder->buffer);
}

/* The whole file, of which a buffer is in `uri`; NULL with an error. */
static GBytes *whole(Folder *folder, const char *uri, GError **error) {
  SporeTriangleMesh mesh = ball();
  g_autoptr(GBytes) content = g_byte_array_free_to_bytes(file_gltf(&mesh, uri));
  spore_triangle_mesh_clear(&mesh);
  return spore_mesh_whole(folder->file, content, error);
}

static void check_refused(Folder *folder, const char *uri, const char *words) {
  g_autoptr(GError) error = NULL;
  g_autoptr(GBytes) content = whole(folder, uri, &error);
  g_assert_null(content);
  g_test_message("%s", error->message);
  g_assert_true(g_str_has_prefix(error->message, folder->file));
  if (!strstr(error->message, words)) g_error("\"%s\" does not say \"%s\"", error->message, words);
}

/* The node of these files doubles x. */
static void test_beside(Folder *folder, gconstpointer data) {
  static const char *const names[] = {"ball data.bin", "ball%20data.bin", "./ball%20data.bin"};
  for (gsize i = 0; i < G_N_ELEMENTS(names); i++) {
    g_autoptr(GError) error = NULL;
    g_autoptr(GBytes) content = whole(folder, names[i], &error);
    g_assert_no_error(error);
    gsize size;
    const void *bytes = g_bytes_get_data(content, &size);
    if (SPORE_HAVE_ASSIMP) check_ball("ball.gltf", bytes, size, 2);
  }
  g_autoptr(GBytes) embedded = whole(folder, NULL, NULL), other = g_bytes_new_static("{\"buffers\":[", 12);
  g_autoptr(GBytes) same = spore_mesh_whole(folder->file, embedded, NULL),
                    kept = spore_mesh_whole("a.obj", other, NULL);
  g_assert_true(same == embedded && kept == other);
}

static void test_outside(Folder *folder, gconstpointer data) {
  g_autofree char *link = g_build_filename(folder->path, "link.bin", NULL),
                  *pipe = g_build_filename(folder->path, "pipe.bin", NULL);
  g_assert_cmpint(symlink(folder->buffer, link), ==, 0);
  g_assert_cmpint(mkfifo(pipe, 0600), ==, 0);
  check_refused(folder, "/etc/passwd", "a file in the same folder or below");
  check_refused(folder, "../ball.bin", "a file in the same folder or below");
  check_refused(folder, "..%2Fball.bin", "a file in the same folder or below");
  check_refused(folder, "..", "a file in the same folder or below");
  check_refused(folder, "file:ball.bin", "is not there");
  check_refused(folder, "https://example.org/ball.bin", "a file in the same folder or below");
  check_refused(folder, "ball\\u002ebin", "a file in the same folder or below");
  check_refused(folder, "", "a file in the same folder or below");
  check_refused(folder, "none.bin", "is not there");
  check_refused(folder, "link.bin", "is no regular file");
  check_refused(folder, "pipe.bin", "is no regular file");
  g_unlink(link);
  g_unlink(pipe);
}

/* A folder below is entered, and no link that stands for a folder. */
static void test_below(Folder *folder, gconstpointer data) {
  g_autofree char *below = g_build_filename(folder->path, "below", NULL),
                  *link = g_build_filename(folder->path, "link", NULL),
                  *moved = g_build_filename(below, "ball.bin", NULL);
  g_autoptr(GError) error = NULL;
  g_assert_cmpint(g_mkdir(below, 0700), ==, 0);
  g_assert_cmpint(symlink(below, link), ==, 0);
  g_assert_cmpint(g_rename(folder->buffer, moved), ==, 0);
  g_autoptr(GBytes) content = whole(folder, "below/ball.bin", &error);
  g_assert_no_error(error);
  check_refused(folder, "link/ball.bin", "link/ball.bin");
  check_refused(folder, "below//ball.bin", "a file in the same folder or below");
  check_refused(folder, "below/./ball.bin", "a file in the same folder or below");
  check_refused(folder, "below", "is no regular file");
  check_refused(folder, "below/ball.bin/a", "below/ball.bin/a");
  g_unlink(moved);
  g_unlink(link);
  g_rmdir(below);
}

/* A buffer that was cut short is refused, and padding behind the buffer is passed over. */
static void test_length(Folder *folder, gconstpointer data) {
  g_autofree char *held = NULL;
  gsize size;
  g_assert_true(g_file_get_contents(folder->buffer, &held, &size, NULL));
  held = g_realloc(held, size + 3);
  g_assert_true(g_file_set_contents(folder->buffer, held, (gssize)size + 3, NULL));
  test_beside(folder, NULL);
  g_assert_true(g_file_set_contents(folder->buffer, held, (gssize)size - 1, NULL));
  check_refused(folder, "ball data.bin", "bytes, and");
}

/* The same text in UTF-16. */
static GByteArray *utf16(const GByteArray *text, gboolean big) {
  GByteArray *coded = g_byte_array_new();
  const guint8 mark[2] = {big ? 0xFE : 0xFF, big ? 0xFF : 0xFE};
  g_byte_array_append(coded, mark, 2);
  for (guint i = 0; i < text->len; i++) {
    const guint8 unit[2] = {big ? 0 : text->data[i], big ? text->data[i] : 0};
    g_byte_array_append(coded, unit, 2);
  }
  return coded;
}

static void test_encodings(void) {
  SporeTriangleMesh mesh = ball();
  GByteArray *texts[] = {file_obj(&mesh, "o ball\n"), file_ply_text(&mesh), file_stl_text(&mesh)};
  for (gsize i = 0; i < G_N_ELEMENTS(texts); i++) {
    GByteArray *big = utf16(texts[i], TRUE), *little = utf16(texts[i], FALSE), *marked = g_byte_array_new();
    g_byte_array_append(marked, (const guint8 *)"\xEF\xBB\xBF", 3);
    g_byte_array_append(marked, texts[i]->data, texts[i]->len);
    check_ball("ball", big->data, big->len, 1);
    check_ball("ball", little->data, little->len, 1);
    check_ball("ball", marked->data, marked->len, 1);
    g_byte_array_unref(big);
    g_byte_array_unref(little);
    g_byte_array_unref(marked);
    g_byte_array_unref(texts[i]);
  }
  spore_triangle_mesh_clear(&mesh);
}

/* Blank lines before the first word of a PLY, and between the lines of its header. */
static void test_blank_lines(void) {
  SporeTriangleMesh mesh = ball();
  GByteArray *files[] = {file_ply_text(&mesh), file_ply(&mesh)};
  for (gsize i = 0; i < G_N_ELEMENTS(files); i++) {
    GByteArray *first = g_byte_array_new(), *second = g_byte_array_new();
    g_byte_array_append(first, (const guint8 *)"\n \r\n", 4);
    g_byte_array_append(first, files[i]->data, files[i]->len);
    g_byte_array_append(second, (const guint8 *)"ply\n\n", 5);
    g_byte_array_append(second, files[i]->data + 4, files[i]->len - 4);
    check_ball("ball.ply", first->data, first->len, 1);
    check_ball("ball.ply", second->data, second->len, 1);
    g_byte_array_unref(first);
    g_byte_array_unref(second);
    g_byte_array_unref(files[i]);
  }
  spore_triangle_mesh_clear(&mesh);
}

/* The buffer of a tetrahedron: corners, then indices. */
static char *tetrahedron_buffer(gsize *size) {
  static const float corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  static const guint16 faces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  guchar bytes[sizeof corners + sizeof faces];
  memcpy(bytes, corners, sizeof corners);
  memcpy(bytes + sizeof corners, faces, sizeof faces);
  *size = sizeof bytes;
  return g_base64_encode(bytes, sizeof bytes);
}

/* Three nodes in a node: with a name and a colour, with the name of its mesh, with a material and no colour. */
static char *tree_text(void) {
  gsize size;
  g_autofree char *buffer = tetrahedron_buffer(&size);
  return g_strdup_printf(
      "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"name\":\"kidney\","
      "\"children\":[1,2],\"scale\":[0.1,0.1,0.1]},{\"mesh\":0,\"name\":\"cortex\"},{\"children\":[3],\"name\":"
      "\"vessels\"},{\"mesh\":1}],\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,0,1]}}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":0}]},{\"name\":"
      "\"vein\","
      "\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],\"buffers\":[{\"byteLength\":%zu,\"uri\":"
      "\"data:application/"
      "octet-stream;base64,%s\"}],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},"
      "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":24}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
      "\"count\":4,\"type\":\"VEC3\"},{\"bufferView\":1,\"componentType\":5123,\"count\":12,\"type\":\"SCALAR\"}]}",
      size, buffer);
}

/* Colours are those of sRGB: .735 and .537 for .5 and .25 of the light (IEC 61966-2-1). */
static void test_tree(void) {
  GError *error = NULL;
  g_autofree char *text = tree_text();
  guint count;
  GPtrArray *parts = spore_mesh_decode_parts("tree.gltf", text, strlen(text), NULL, 0, 0, TRUE, &count, NULL, &error);
  g_assert_no_error(error);
  g_assert_cmpuint(parts->len, ==, 2);
  const SporeMeshPart *cortex = g_ptr_array_index(parts, 0), *vein = g_ptr_array_index(parts, 1);
  g_assert_cmpstr(cortex->name, ==, "cortex");
  g_assert_cmpstr(cortex->group, ==, "kidney");
  g_assert_true(cortex->coloured);
  g_assert_cmpfloat_with_epsilon(cortex->colour[0], 0.735, 1e-3);
  g_assert_cmpfloat_with_epsilon(cortex->colour[1], 0.537, 1e-3);
  g_assert_cmpfloat(cortex->colour[2], ==, 0);
  g_assert_cmpstr(vein->name, ==, "vein");
  g_assert_cmpstr(vein->group, ==, "kidney/vessels");
  g_assert_false(vein->coloured);
  g_assert_cmpfloat_with_epsilon(spore_mesh_diagonal(vein->mesh.vertices, 4, 3), 0.1 * sqrt(3), 1e-7);
  g_ptr_array_unref(parts);
}

/* The joined mesh keeps of each triangle its part. Both parts of the tree lie in the same place: the first has what
 * both have. */
static void test_tagged(void) {
  GError *error = NULL;
  g_autofree char *text = tree_text();
  guint32 *parts = NULL;
  g_auto(GStrv) names = NULL;
  SporeTriangleMesh mesh;
  g_assert_true(spore_mesh_decode_tagged("tree.gltf", "tree.gltf", text, strlen(text), 0, 0, &mesh, &parts, &names,
                                         NULL, &error));
  g_assert_no_error(error);
  g_assert_cmpuint(g_strv_length(names), ==, 2);
  g_assert_cmpstr(names[0], ==, "cortex");
  g_assert_cmpstr(names[1], ==, "vein");
  g_assert_cmpuint(mesh.triangle_count, ==, 4);
  for (gsize t = 0; t < 4; t++) g_assert_cmpuint(parts[t], ==, 0);
  spore_free(parts);
  spore_triangle_mesh_clear(&mesh);

  const char *off = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
  guint32 *none;
  char **no_names;
  g_assert_true(
      spore_mesh_decode_tagged("a.off", "a.off", off, strlen(off), 0, 0, &mesh, &none, &no_names, NULL, &error));
  g_assert_null(none);
  g_assert_null(no_names);
  spore_triangle_mesh_clear(&mesh);
}

#define CORPUS SPORE_SOURCE "/tests/fuzz/corpus/vtk/"

/* The same tetrahedron in each form: legacy by lists and by offsets, XML as text, base64, and compressed bytes. */
static void test_vtk_forms(void) {
  static const char *const files[] = {"ascii.vtk", "binary.vtk", "ascii.vtp", "base64.vtp", "appended.vtp"};
  for (gsize i = 0; i < G_N_ELEMENTS(files) - !SPORE_HAVE_ZLIB; i++) {
    g_autoptr(GError) error = NULL;
    g_autofree char *path = g_strconcat(CORPUS, files[i], NULL), *content = NULL;
    gsize size;
    SporeTriangleMesh mesh;
    SporeMeshReport report;
    g_assert_true(g_file_get_contents(path, &content, &size, NULL));
    gboolean done = spore_mesh_decode(files[i], "mesh", content, size, 0, 0, &mesh, NULL, &error);
    g_assert_no_error(error);
    g_assert_true(done && spore_triangle_mesh_report(&mesh, &report, NULL));
    g_assert_true(report.closed);
    g_assert_cmpfloat_with_epsilon(report.volume, 1.0 / 6, 1e-12);
    spore_triangle_mesh_clear(&mesh);
  }
}

#define LEGACY "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET POLYDATA\nPOINTS 6 float\n"

/* Triangles cover an area; strips and polygons with a corner that turns in cover the same area as their outline. */
static void check_area(const char *text, gsize triangles, double area) {
  g_autoptr(GError) error = NULL;
  SporeTriangleMesh mesh;
  SporeMeshReport report;
  gboolean done = spore_mesh_decode("a.vtk", "a.vtk", text, strlen(text), 0, 0, &mesh, NULL, &error);
  g_assert_no_error(error);
  g_assert_true(done && spore_triangle_mesh_report(&mesh, &report, NULL));
  g_assert_cmpuint(mesh.triangle_count, ==, triangles);
  g_assert_cmpfloat_with_epsilon(report.area, area, 1e-9);
  spore_triangle_mesh_clear(&mesh);
}

static void test_vtk_faces(void) {
  check_area(LEGACY "0 0 0 1 0 0 0 1 0 1 1 0 0 2 0 1 2 0\nTRIANGLE_STRIPS 1 7\n6 0 1 2 3 4 5\n", 4, 2);
  check_area(LEGACY "0 0 0 2 0 0 2 2 0 1 2 0 1 1 0 0 1 0\nPOLYGONS 1 7\n6 0 1 2 3 4 5\n", 4, 3);
  check_area(LEGACY "0 0 0 2 0 0 2 2 0 1 2 0 1 1 0 0 1 0\nLINES 1 3\n2 0 1\nPOLYGONS 1 7\n6 4 5 0 1 2 3\n", 4, 3);
}

static void check_vtk_refused(const char *text, const char *words) {
  g_autoptr(GError) error = NULL;
  SporeTriangleMesh mesh;
  g_assert_false(spore_mesh_decode("a.vtk", "a.vtk", text, strlen(text), 0, 0, &mesh, NULL, &error));
  g_test_message("%s", error->message);
  if (!strstr(error->message, words)) g_error("\"%s\" does not say \"%s\"", error->message, words);
}

static void test_vtk_refused(void) {
  check_vtk_refused(LEGACY "0 0 0 1 0 0\n", "cut short");
  check_vtk_refused(LEGACY "0 0 0 1 0 0 0 1 0 1 1 0 0 2 0 1 2 0\n", "only points or lines");
  check_vtk_refused(LEGACY "0 0 0 1 0 0 0 1 0 1 1 0 0 2 0 1 2 0\nPOLYGONS 1 4\n3 0 1 6\n", "vertex 6 of 6");
  check_vtk_refused(LEGACY "0 0 0 1 0 0 0 1 0 1 1 0 0 2 0 1 2 0\nPOLYGONS 1 4\n9 0 1 2\n", "POLYGONS");
  check_vtk_refused("# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n", "STRUCTURED_POINTS");
  check_vtk_refused("<VTKFile type=\"ImageData\"></VTKFile>", "ImageData");
  check_vtk_refused("<!DOCTYPE a><VTKFile type=\"PolyData\"></VTKFile>", "<!");
  check_vtk_refused("<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"></VTKFile>",
                    "vtkLZ4DataCompressor");
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add("/mesh-origins/beside", Folder, NULL, set_up, test_beside, tear_down);
  g_test_add("/mesh-origins/outside", Folder, NULL, set_up, test_outside, tear_down);
  g_test_add("/mesh-origins/below", Folder, NULL, set_up, test_below, tear_down);
  g_test_add("/mesh-origins/length", Folder, NULL, set_up, test_length, tear_down);
  if (SPORE_HAVE_ASSIMP) g_test_add_func("/mesh-origins/encodings", test_encodings);
  if (SPORE_HAVE_ASSIMP) g_test_add_func("/mesh-origins/blank-lines", test_blank_lines);
  if (SPORE_HAVE_ASSIMP) g_test_add_func("/mesh-origins/tree", test_tree);
  if (SPORE_HAVE_ASSIMP) g_test_add_func("/mesh-origins/tagged", test_tagged);
  g_test_add_func("/mesh-origins/vtk-forms", test_vtk_forms);
  g_test_add_func("/mesh-origins/vtk-faces", test_vtk_faces);
  g_test_add_func("/mesh-origins/vtk-refused", test_vtk_refused);
  return g_test_run();
}
