/* Curves with radii, and the tube around a curve. */
#include <assert.h>
#include <math.h>

#include "core/base/text.h"
#include "core/mesh/common.h"

bool spore_curve_allocate(SporeCurve *curve, size_t count, SporeError *error) {
  *curve = (SporeCurve){0};
  if (count > SPORE_MESH_MAXIMUM) return spore_mesh_too_large(error, count);
  *curve = (SporeCurve){count, SPORE_NEW_ARRAY(double, 4 * count)};
  if (curve->points) return true;
  *curve = (SporeCurve){0};
  return spore_mesh_no_memory(error);
}

void spore_curve_clear(SporeCurve *curve) {
  spore_free(curve->points);
  *curve = (SporeCurve){0};
}

static SporeVec3 point(const SporeCurve *curve, size_t i) { return spore_vec3_load(curve->points + 4 * i); }

bool spore_curve_validate(const SporeCurve *curve, SporeError *error) {
  if (curve->count > SPORE_MESH_MAXIMUM) return spore_mesh_too_large(error, curve->count);
  if (curve->count < 2)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the curve has %zu points; at least two were expected; add points"), curve->count);
  if (!spore_mesh_check_points(curve->points, curve->count, 4, _("point"), error)) return false;
  for (size_t i = 0; i < curve->count; i++) {
    double radius = curve->points[4 * i + 3];
    if (!(radius > 0 && radius <= SPORE_MESH_COORDINATE_MAXIMUM))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("point %zu has the radius %g; a number above 0 and at most %g m was expected; correct "
                               "or remove that point"),
                             i, radius, SPORE_MESH_COORDINATE_MAXIMUM);
    if (i > 0 && spore_vec3_distance(point(curve, i - 1), point(curve, i)) == 0)
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("point %zu lies where the one before it does; two different places were expected; "
                               "remove one of them"),
                             i);
  }
  return true;
}

double spore_curve_length(const SporeCurve *curve) {
  double length = 0;
  for (size_t i = 1; i < curve->count; i++) length += spore_vec3_distance(point(curve, i - 1), point(curve, i));
  return length;
}

/* The direction of the curve at point i. Where the curve turns back, it is the direction of the part before the point.
 */
static SporeVec3 tangent(const SporeCurve *curve, size_t i) {
  assert(i < curve->count && curve->count > 1);
  size_t before = i > 0 ? i - 1 : 0, after = i + 1 < curve->count ? i + 1 : i;
  SporeVec3 across = spore_vec3_sub(point(curve, after), point(curve, before));
  if (spore_vec3_length(across) == 0) across = spore_vec3_sub(point(curve, i), point(curve, before));
  return spore_vec3_normalise(across, spore_vec3(1, 0, 0));
}

static void put_rings(const SporeCurve *curve, size_t sectors, double *vertices) {
  SporeVec3 before = tangent(curve, 0), side = spore_vec3_any_across(before);
  for (size_t i = 0; i < curve->count; i++) {
    SporeVec3 t = tangent(curve, i), other;
    side = spore_vec3_transport(side, before, t);
    other = spore_vec3_cross(t, side);
    before = t;
    for (size_t k = 0; k < sectors; k++) {
      double angle = 2 * M_PI * (double)k / (double)sectors, radius = curve->points[4 * i + 3];
      SporeVec3 ring = spore_vec3_add_scaled(point(curve, i), radius * cos(angle), side);
      spore_vec3_store(vertices + 3 * (i * sectors + k), spore_vec3_add_scaled(ring, radius * sin(angle), other));
    }
  }
}

static void put_triangle(uint32_t **at, size_t a, size_t b, size_t c) {
  *(*at)++ = (uint32_t)a;
  *(*at)++ = (uint32_t)b;
  *(*at)++ = (uint32_t)c;
}

bool spore_curve_tube(const SporeCurve *curve, size_t sectors, SporeTriangleMesh *mesh, SporeError *error) {
  assert(sectors >= 3);
  size_t rings = curve->count, first = rings * sectors, last = first + 1;
  if (!spore_triangle_mesh_allocate(mesh, last + 1, 2 * sectors * rings, error)) return false;
  put_rings(curve, sectors, mesh->vertices);
  spore_vec3_store(mesh->vertices + 3 * first, point(curve, 0));
  spore_vec3_store(mesh->vertices + 3 * last, point(curve, rings - 1));
  uint32_t *at = mesh->triangles;
  for (size_t k = 0; k < sectors; k++) {
    size_t next = (k + 1) % sectors, end = (rings - 1) * sectors;
    put_triangle(&at, first, next, k);
    for (size_t i = 0; i + 1 < rings; i++) {
      size_t a = i * sectors, b = a + sectors;
      put_triangle(&at, a + k, a + next, b + next);
      put_triangle(&at, a + k, b + next, b + k);
    }
    put_triangle(&at, last, end + k, end + next);
  }
  return true;
}
