/* Reading and generating while memory runs short: each allocation of a size that comes from a file fails once. What
 * needs it is refused for want of memory, the scene stays as it was, and nothing leaks (the sanitizer looks). */
#include <glib/gstdio.h>
#include <string.h>

#include "core/author/generator_work.h"
#include "core/io/beside.h"
#include "core/io/gltf_check.h"
#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/io/scene_xml.h"
#include "models/registry.h"
#include "tests/io/mesh_files.h"
#include "tests/mesh/shapes.h"
#include "tests/ways.h"

/* Made before anything fails. */
static SporeTriangleMesh ball;
static GByteArray *glb, *wide; /* the ball, and an OFF text in UTF-16 */
static GBytes *tube;           /* OFF */
static char *vtk;
static gsize vtk_size;
static SporeSchema *schema;

static bool read_mesh(const char *file, const void *content, gsize size, GError **error) {
  SporeTriangleMesh mesh;
  bool done = spore_mesh_decode(file, file, content, size, 0, 0, &mesh, NULL, error);
  spore_triangle_mesh_clear(&mesh);
  return done;
}

static bool read_glb(GError **error) {
  if (!SPORE_HAVE_ASSIMP) return spore_gltf_check("ball.glb", (const char *)glb->data + 20, glb->len - 20, error);
  return read_mesh("ball.glb", glb->data, glb->len, error);
}

static bool read_vtk(GError **error) { return read_mesh("binary.vtk", vtk, vtk_size, error); }

static bool read_utf16(GError **error) { return read_mesh("wide.off", wide->data, wide->len, error); }

static bool read_tetrahedra(GError **error) {
  static const char text[] = "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
                             "Tetrahedra\n1\n1 2 3 4 0\nEnd\n";
  SporeTetrahedralMesh mesh = {0};
  g_autoptr(GBytes) content = g_bytes_new_static(text, strlen(text));
  bool done = spore_io_readers.tetrahedra("one.mesh", "one.mesh", content, &mesh, error);
  spore_tetrahedral_mesh_clear(&mesh);
  return done;
}

static bool read_beside(GError **error) {
  g_autoptr(GBytes) whole = spore_beside_read(SPORE_SCENES "/minimal.spore", "bag.spore", "head", 4, 1 << 20, error);
  return whole != NULL;
}

/* A file of the scene's folder. */
static bool read_asset(GError **error) {
  SporeDocument *document = spore_scene_load(schema, SPORE_SCENES "/minimal.spore", error);
  g_autoptr(GBytes) content = document ? spore_document_read_asset(document, "minimal.spore", error) : NULL;
  g_clear_pointer(&document, spore_document_free);
  return content != NULL;
}

/* A scene with the tube, of which the generator makes what its usual options say. */
static bool generate(SporeGenerateKind kind, size_t count, double wall, GError **error) {
  SporeDocument *document = spore_document_new(schema);
  spore_document_set_readers(document, &spore_io_readers);
  SporeObject *body = spore_organ_insert(document, "tube", "tube.off", tube, 0, 0, error);
  gsize size;
  g_autofree char *before = spore_scene_format(document, &size);
  SporeGenerateWork *work = NULL;
  if (body) {
    SporeGenerateOptions options = spore_generate_options_of(document, body, kind);
    spore_generate_set_count(&options, count);
    if (kind == SPORE_GENERATE_SURFACE) options.fields.surface.wall = wall;
    work = spore_generate_work_new(document, body, &options, error);
  }
  bool done = work && spore_generate_work_run(work, NULL, error) && spore_generate_work_apply(work, document, error);
  g_clear_pointer(&work, spore_generate_work_unref);
  g_autofree char *after = spore_scene_format(document, &size);
  g_assert_cmpint(g_str_equal(before, after), ==, !done);
  spore_document_free(document);
  return done;
}

static bool generate_surface(GError **error) { return generate(SPORE_GENERATE_SURFACE, 40, 0, error); }

static bool generate_curve(GError **error) { return generate(SPORE_GENERATE_CURVE, 5, 0, error); }

static const struct {
  const char *path;
  WaysWork *work;
  guint most; /* what takes long fails at a few */
} works[] = {{"/memory/glb", read_glb, G_MAXUINT},
             {"/memory/vtk", read_vtk, G_MAXUINT},
             {"/memory/utf16", read_utf16, G_MAXUINT},
             {"/memory/tetrahedra", read_tetrahedra, G_MAXUINT},
             {"/memory/beside", read_beside, G_MAXUINT},
             {"/memory/asset", read_asset, G_MAXUINT},
             {"/memory/surface", generate_surface, G_MAXUINT},
             {"/memory/curve", generate_curve, 40}};

static void test_work(gconstpointer data) {
  guint i = GPOINTER_TO_UINT(data);
  ways_fail_again(works[i].work, works[i].most);
}

static void make_inputs(void) {
  const double points[] = {0, 0, 0, 0.002, 0.04, 0, 0, 0.002, 0.08, 0, 0, 0.002};
  const SporeCurve line = {.count = 3, .points = (double *)points};
  SporeTriangleMesh mesh;
  gsize size;
  shape_ball(&ball, 0.05, 8);
  glb = file_glb(&ball);
  g_assert_true(spore_curve_tube(&line, 12, &mesh, NULL));
  char *text = spore_off_format(&mesh, &size);
  tube = g_bytes_new_take(text, size);
  spore_triangle_mesh_clear(&mesh);
  wide = g_byte_array_new();
  g_byte_array_append(wide, (const guint8 *)"\xFE\xFF", 2);
  for (gsize i = 0; i < size; i++) g_byte_array_append(wide, (const guint8[]){0, (guint8)text[i]}, 2);
  g_assert_true(g_file_get_contents(SPORE_SOURCE "/tests/fuzz/corpus/vtk/binary.vtk", &vtk, &vtk_size, NULL));
  schema = spore_schema_new(spore_model_registry, spore_generator_elements());
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  make_inputs();
  for (guint i = 0; i < G_N_ELEMENTS(works); i++) g_test_add_data_func(works[i].path, GUINT_TO_POINTER(i), test_work);
  int status = g_test_run();
  ways_clear();
  spore_schema_free(schema);
  spore_triangle_mesh_clear(&ball);
  g_byte_array_unref(glb);
  g_byte_array_unref(wide);
  g_bytes_unref(tube);
  g_free(vtk);
  return status;
}
