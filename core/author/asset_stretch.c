/* Stretches assets: their points, radii and corners. */
#include "core/author/asset_stretch.h"

#include <math.h>

#include "core/io/mesh_import.h"

/* Points, `stride` doubles apart, whose fourth number is a radius. g_free. */
static double *stretched_points(const double *points, gsize count, gsize stride, const double factors[3]) {
  double *result = g_memdup2(points, stride * count * sizeof *points);
  double radial = cbrt(fabs(factors[0] * factors[1] * factors[2]));
  for (gsize i = 0; i < count; i++)
    for (gsize k = 0; k < stride; k++) result[stride * i + k] *= k < 3 ? factors[k] : radial;
  return result;
}

/* Mirrored elements would be inside out. g_free. */
static guint32 *turned(const guint32 *elements, gsize count, gsize corners, const double factors[3]) {
  guint32 *result = g_memdup2(elements, corners * count * sizeof *elements);
  for (gsize i = 0; factors[0] * factors[1] * factors[2] < 0 && i < count; i++) {
    guint32 kept = result[corners * i];
    result[corners * i] = result[corners * i + 1];
    result[corners * i + 1] = kept;
  }
  return result;
}

static char *stretched_surface(const SporeTriangleMesh *from, const double factors[3], gsize *size) {
  SporeTriangleMesh mesh = *from;
  g_autofree double *vertices = stretched_points(from->vertices, from->vertex_count, 3, factors);
  g_autofree guint32 *triangles = turned(from->triangles, from->triangle_count, 3, factors);
  mesh.vertices = vertices;
  mesh.triangles = triangles;
  return spore_off_format(&mesh, size);
}

static char *stretched_solid(const SporeTetrahedralMesh *from, const double factors[3], gsize *size) {
  SporeTetrahedralMesh mesh = *from;
  g_autofree double *vertices = stretched_points(from->vertices, from->vertex_count, 3, factors);
  g_autofree guint32 *cells = turned(from->tetrahedra, from->tetrahedron_count, 4, factors);
  mesh.vertices = vertices;
  mesh.tetrahedra = cells;
  return spore_medit_format(&mesh, size);
}

static char *stretched_spheres(const SporeSphereSet *from, const double factors[3], gsize *size) {
  SporeSphereSet set = *from;
  g_autofree double *spheres = stretched_points(from->spheres, from->count, 4, factors);
  set.spheres = spheres;
  set.level *= cbrt(fabs(factors[0] * factors[1] * factors[2])); /* a depth, m */
  return spore_spheres_format(&set, size);
}

static char *stretched_curve(const SporeCurve *from, const double factors[3], gsize *size) {
  SporeCurve curve = *from;
  g_autofree double *points = stretched_points(from->points, from->count, 4, factors);
  curve.points = points;
  return spore_curve_format(&curve, size);
}

gboolean spore_asset_is_stretchable(const SporeObject *asset) {
  static const char *const elements[] = {"mesh", "tetrahedra", "spheres", "curve", NULL};
  return g_strv_contains(elements, spore_object_type(asset)->element);
}

char *spore_asset_stretched(SporeDocument *document, SporeObject *asset, const double factors[3],
                            const char **extension, gsize *size, GError **error) {
  const char *element = spore_object_type(asset)->element;
  *extension = element;
  if (g_str_equal(element, "mesh")) {
    const SporeTriangleMesh *mesh = spore_document_mesh(document, asset, error);
    *extension = "off";
    return mesh ? stretched_surface(mesh, factors, size) : NULL;
  }
  if (g_str_equal(element, "tetrahedra")) {
    const SporeTetrahedralMesh *mesh = spore_document_tetrahedra(document, asset, error);
    *extension = "mesh";
    return mesh ? stretched_solid(mesh, factors, size) : NULL;
  }
  if (g_str_equal(element, "spheres")) {
    const SporeSphereSet *set = spore_document_spheres(document, asset, error);
    return set ? stretched_spheres(set, factors, size) : NULL;
  }
  const SporeCurve *curve = spore_document_curve(document, asset, error);
  return curve ? stretched_curve(curve, factors, size) : NULL;
}
