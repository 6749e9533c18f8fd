/* The readers of assets that a document uses. */
#include "core/io/mesh_import.h"
#include "core/io/scene_xml.h"

static gboolean read_mesh(const char *place, const char *file, GBytes *content, int unit, int frame,
                          SporeTriangleMesh *mesh, GError **error) {
  gsize size;
  const void *bytes = g_bytes_get_data(content, &size);
  return spore_mesh_decode(place, file, bytes, size, unit, frame, mesh, NULL, error);
}

static gboolean read_spheres(const char *place, const char *file, GBytes *content, SporeSphereSet *set,
                             GError **error) {
  gsize size;
  const char *text = g_bytes_get_data(content, &size);
  return spore_spheres_parse(place, text, size, set, error);
}

static gboolean read_tetrahedra(const char *place, const char *file, GBytes *content, SporeTetrahedralMesh *mesh,
                                GError **error) {
  gsize size;
  const char *text = g_bytes_get_data(content, &size);
  return spore_medit_parse(place, text, size, mesh, error);
}

static gboolean read_curve(const char *place, const char *file, GBytes *content, SporeCurve *curve, GError **error) {
  gsize size;
  const char *text = g_bytes_get_data(content, &size);
  return spore_curve_parse(place, text, size, curve, error);
}

const SporeAssetReaders spore_io_readers = {
    .mesh = read_mesh, .spheres = read_spheres, .tetrahedra = read_tetrahedra, .curve = read_curve};
