/* Reading files while memory runs short: each allocation that rooms with GLib take by g_try_ fails once, and the reader
 * says so. The functions of GLib are replaced by those here. */
#include <fcntl.h>
#include <glib/gstdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/author/generator.h"
#include "core/generate/labels/labels.h"
#include "core/io/gltf_check.h"
#include "core/io/mesh_import.h"
#include "core/io/scene_xml.h"
#include "core/scene/schema.h"
#include "models/registry.h"
#include "tests/io/mesh_files.h"
#include "tests/mesh/shapes.h"

static guint taken, failing; /* the allocation of that number fails; 0: none */

static gpointer take(gsize count, gsize size) {
  gsize bytes;
  if (++taken == failing || __builtin_mul_overflow(count, size, &bytes)) return NULL;
  return calloc(1, MAX(bytes, 1));
}

#undef g_try_malloc
#undef g_try_malloc0
#undef g_try_malloc_n
#undef g_try_malloc0_n
gpointer g_try_malloc(gsize size) { return take(1, size); }
gpointer g_try_malloc0(gsize size) { return take(1, size); }
gpointer g_try_malloc_n(gsize count, gsize size) { return take(count, size); }
gpointer g_try_malloc0_n(gsize count, gsize size) { return take(count, size); }

typedef gboolean Reading(GError **error);

static gboolean read_glb(GError **error) {
  SporeTriangleMesh ball = {0}, mesh;
  shape_ball(&ball, 0.05, 8);
  g_autoptr(GByteArray) file = file_glb(&ball);
  spore_triangle_mesh_clear(&ball);
  if (!SPORE_HAVE_ASSIMP) return spore_gltf_check("ball.glb", (const char *)file->data + 20, file->len - 20, error);
  gboolean done = spore_mesh_decode("ball.glb", "ball.glb", file->data, file->len, 0, 0, &mesh, NULL, error);
  spore_triangle_mesh_clear(&mesh);
  return done;
}

static gboolean read_tetrahedra(GError **error) {
  static const char text[] = "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
                             "Tetrahedra\n1\n1 2 3 4 0\nEnd\n";
  SporeTetrahedralMesh mesh = {0};
  g_autoptr(GBytes) content = g_bytes_new_static(text, strlen(text));
  gboolean done = spore_io_readers.tetrahedra("one.mesh", "one.mesh", content, &mesh, error);
  spore_tetrahedral_mesh_clear(&mesh);
  return done;
}

static gboolean read_label(GError **error) {
  uint16_t labels[5 * 5 * 5] = {0};
  labels[62] = 1; /* the middle */
  const SporeLabelMap map = {.size = {5, 5, 5}, .axes = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, .labels = labels};
  SporeTriangleMesh mesh = {0};
  SporeError fault = SPORE_ERROR_INIT;
  gboolean done = spore_label_surface(&map, 1, &mesh, NULL, &fault);
  spore_triangle_mesh_clear(&mesh);
  return done || spore_error_propagate(&fault, error);
}

/* A file of the scene's folder. */
static gboolean read_asset(GError **error) {
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  SporeDocument *document = spore_scene_load(schema, SPORE_SCENES "/minimal.spore", error);
  g_autoptr(GBytes) content = document ? spore_document_read_asset(document, "minimal.spore", error) : NULL;
  g_clear_pointer(&document, spore_document_free);
  spore_schema_free(schema);
  return content != NULL;
}

static const struct {
  const char *name;
  Reading *read;
} readings[] = {{"/try/glb", read_glb},
                {"/try/tetrahedra", read_tetrahedra},
                {"/try/label", read_label},
                {"/try/asset", read_asset}};

static void test_reading(gconstpointer data) {
  Reading *read = readings[GPOINTER_TO_UINT(data)].read;
  GError *error = NULL;
  failing = taken = 0;
  g_assert_true(read(&error));
  guint needed = taken;
  g_assert_cmpuint(needed, >, 0);
  for (guint n = 1; n <= needed; n++) {
    failing = n, taken = 0;
    g_assert_false(read(&error));
    g_assert_error(error, SPORE_ERROR, SPORE_ERROR_MEMORY);
    g_clear_error(&error);
  }
  failing = 0;
  g_test_message("%u allocations", needed);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  for (guint i = 0; i < G_N_ELEMENTS(readings); i++)
    g_test_add_data_func(readings[i].name, GUINT_TO_POINTER(i), test_reading);
  return g_test_run();
}
