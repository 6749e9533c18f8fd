/* Reads the assets of documents, and keeps the meshes that a job has decoded for the GTK thread. */
#include "ui/document/asset-readers.h"

#include <string.h>

#include "core/io/scene_xml.h"

#define KEPT 8

typedef struct {
  GBytes *content;
  int unit, frame;
  SporeTriangleMesh mesh;
  SporeMeshReport report;
} Decoded;

static GMutex mutex;
static Decoded decoded[KEPT];
static guint next;

void spore_editor_readers_remember(GBytes *content, int unit, int frame, const SporeTriangleMesh *mesh) {
  SporeTriangleMesh copy = {0};
  SporeMeshReport report;
  if (!spore_triangle_mesh_report(mesh, &report, NULL) || !spore_triangle_mesh_copy(&copy, mesh, NULL)) return;
  g_mutex_lock(&mutex);
  Decoded *slot = &decoded[next++ % KEPT];
  if (slot->content) g_bytes_unref(slot->content);
  spore_triangle_mesh_clear(&slot->mesh);
  *slot = (Decoded){g_bytes_ref(content), unit, frame, copy, report};
  g_mutex_unlock(&mutex);
}

static gboolean recall(GBytes *content, int unit, int frame, SporeTriangleMesh *mesh) {
  gboolean found = FALSE;
  g_mutex_lock(&mutex);
  for (guint i = 0; i < KEPT && !found; i++)
    found = decoded[i].content && decoded[i].unit == unit && decoded[i].frame == frame &&
            g_bytes_equal(decoded[i].content, content) && spore_triangle_mesh_copy(mesh, &decoded[i].mesh, NULL);
  g_mutex_unlock(&mutex);
  return found;
}

static gboolean are_equal(const SporeTriangleMesh *a, const SporeTriangleMesh *b) {
  return a->vertex_count == b->vertex_count && a->triangle_count == b->triangle_count &&
         memcmp(a->vertices, b->vertices, 3 * a->vertex_count * sizeof *a->vertices) == 0 &&
         memcmp(a->triangles, b->triangles, 3 * a->triangle_count * sizeof *a->triangles) == 0;
}

gboolean spore_editor_mesh_report(const SporeTriangleMesh *mesh, SporeMeshReport *report) {
  gboolean found = FALSE;
  g_mutex_lock(&mutex);
  for (guint i = 0; i < KEPT && !found; i++)
    if (decoded[i].content && are_equal(&decoded[i].mesh, mesh)) *report = decoded[i].report, found = TRUE;
  g_mutex_unlock(&mutex);
  return found || spore_triangle_mesh_report(mesh, report, NULL);
}

static gboolean read_mesh(const char *place, const char *file, GBytes *content, int unit, int frame,
                          SporeTriangleMesh *mesh, GError **error) {
  return recall(content, unit, frame, mesh) || spore_io_readers.mesh(place, file, content, unit, frame, mesh, error);
}

static gboolean read_spheres(const char *place, const char *file, GBytes *content, SporeSphereSet *set,
                             GError **error) {
  return spore_io_readers.spheres(place, file, content, set, error);
}

static gboolean read_tetrahedra(const char *place, const char *file, GBytes *content, SporeTetrahedralMesh *mesh,
                                GError **error) {
  return spore_io_readers.tetrahedra(place, file, content, mesh, error);
}

static gboolean read_curve(const char *place, const char *file, GBytes *content, SporeCurve *curve, GError **error) {
  return spore_io_readers.curve(place, file, content, curve, error);
}

const SporeAssetReaders spore_editor_readers = {
    .mesh = read_mesh, .spheres = read_spheres, .tetrahedra = read_tetrahedra, .curve = read_curve};
