/* Puts a surface together from the points and faces of a VTK file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/helpers/vtk.h"
#include "core/io/import_wire.h"

#define N_(text) text
#define MOST_ELEMENTS 20000000u /* as SPORE_MESH_MAXIMUM */

void spore_vtk_clear(SporeVtkSurface *surface) {
  free(surface->vertices);
  free(surface->triangles);
  *surface = (SporeVtkSurface){0};
}

/* Makes room for `more` elements of `bytes` bytes behind `count`. */
static bool grow(void **array, size_t count, size_t more, size_t *room, size_t bytes, SporeHelperFailure *failure) {
  if (more > MOST_ELEMENTS || count + more > MOST_ELEMENTS)
    return spore_helper_fail(failure,
                             N_("the mesh is too large; expected at most 20 million vertices and as many "
                                "triangles; decimate it first"),
                             "%s", "");
  if (count + more <= *room) return true;
  const size_t wanted = count + more > 2 * *room ? count + more : 2 * *room;
  void *grown = realloc(*array, wanted * bytes);
  if (!grown) {
    free(spore_vtk_room(SIZE_MAX, failure));
    return false;
  }
  *array = grown;
  *room = wanted;
  return true;
}

bool spore_vtk_add_points(SporeVtkSurface *surface, const double *points, size_t count, SporeHelperFailure *failure) {
  if (!grow((void **)&surface->vertices, surface->vertex_count, count, &surface->vertex_room, 3 * sizeof(double),
            failure))
    return false;
  if (count) memcpy(surface->vertices + 3 * surface->vertex_count, points, 3 * count * sizeof *points);
  surface->vertex_count += count;
  return true;
}

static bool check_corner(const SporeVtkSurface *surface, size_t first, double corner, SporeHelperFailure *failure) {
  if (corner >= 0 && corner < (double)(surface->vertex_count - first) && corner == floor(corner)) return true;
  return spore_helper_fail(failure,
                           N_("a face names a vertex that is not there; expected indices of the mesh's own "
                              "vertices; repair or export the mesh again"),
                           "vertex %.17g of %zu", corner, surface->vertex_count - first);
}

static void add_triangle(SporeVtkSurface *surface, uint32_t a, uint32_t b, uint32_t c) {
  uint32_t *triangle = surface->triangles + 3 * surface->triangle_count++;
  triangle[0] = a, triangle[1] = b, triangle[2] = c;
}

/* The part along `normal` of the area of a triangle, twice. */
static double area_along(const SporeVtkSurface *surface, uint32_t a, uint32_t b, uint32_t c, const double normal[3]) {
  const double *p = surface->vertices + 3 * (size_t)a, *q = surface->vertices + 3 * (size_t)b,
               *r = surface->vertices + 3 * (size_t)c;
  double sum = 0;
  for (int k = 0; k < 3; k++) {
    const int l = (k + 1) % 3, m = (k + 2) % 3;
    sum += normal[k] * ((q[l] - p[l]) * (r[m] - p[m]) - (q[m] - p[m]) * (r[l] - p[l]));
  }
  return sum;
}

/* The normal of a polygon (Newell's sum of the areas of a fan). */
static void normal_of(const SporeVtkSurface *surface, const uint32_t *corners, size_t count, double normal[3]) {
  for (int k = 0; k < 3; k++) {
    const double axis[3] = {k == 0, k == 1, k == 2};
    normal[k] = 0;
    for (size_t i = 1; i + 1 < count; i++)
      normal[k] += area_along(surface, corners[0], corners[i], corners[i + 1], axis);
  }
}

/* Whether the corner i of the polygon can be cut off: it turns to the polygon's side, and no other corner lies in it.
 */
static bool is_ear(const SporeVtkSurface *surface, const uint32_t *corners, size_t count, size_t i,
                   const double normal[3]) {
  const uint32_t a = corners[(i + count - 1) % count], b = corners[i], c = corners[(i + 1) % count];
  if (area_along(surface, a, b, c, normal) <= 0) return false;
  for (size_t j = 0; j < count; j++) {
    const uint32_t p = corners[j];
    if (p == a || p == b || p == c) continue;
    if (area_along(surface, a, b, p, normal) >= 0 && area_along(surface, b, c, p, normal) >= 0 &&
        area_along(surface, c, a, p, normal) >= 0)
      return false;
  }
  return true;
}

/* Cuts a polygon into triangles, one corner after the other. A corner that is no ear is cut off where there is none:
 * the polygon crosses itself there. */
static void cut_polygon(SporeVtkSurface *surface, uint32_t *corners, size_t count) {
  double normal[3];
  normal_of(surface, corners, count, normal);
  size_t at = 0;
  while (count > 3) {
    size_t tried = 0;
    while (tried < count && !is_ear(surface, corners, count, (at + tried) % count, normal)) tried++;
    at = (at + (tried < count ? tried : 0)) % count;
    add_triangle(surface, corners[(at + count - 1) % count], corners[at], corners[(at + 1) % count]);
    memmove(corners + at, corners + at + 1, (count - at - 1) * sizeof *corners);
    if (at >= --count) at = 0;
  }
  add_triangle(surface, corners[0], corners[1], corners[2]);
}

static void add_strip(SporeVtkSurface *surface, const uint32_t *corners, size_t count) {
  for (size_t i = 0; i + 2 < count; i++)
    add_triangle(surface, corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
}

bool spore_vtk_add_face(SporeVtkSurface *surface, size_t first, const double *corners, size_t count, bool strip,
                        SporeHelperFailure *failure) {
  if (count < 3) {
    surface->passed_over++;
    return true;
  }
  if (!strip && count > SPORE_FACE_CORNERS_MAXIMUM)
    return spore_helper_fail(failure,
                             N_("a face has too many corners; expected at most 10000; cut it into triangles first"),
                             "%zu corners", count);
  if (!grow((void **)&surface->triangles, surface->triangle_count, count - 2, &surface->triangle_room,
            3 * sizeof(uint32_t), failure))
    return false;
  for (size_t i = 0; i < count; i++)
    if (!check_corner(surface, first, corners[i], failure)) return false;
  uint32_t few[16], *own = count <= 16 ? few : (uint32_t *)spore_vtk_room(count, failure);
  if (!own) return false;
  for (size_t i = 0; i < count; i++) own[i] = (uint32_t)(first + (size_t)corners[i]);
  (strip ? add_strip(surface, own, count) : cut_polygon(surface, own, count));
  if (own != few) free(own);
  return true;
}

bool spore_vtk_add_faces(SporeVtkSurface *surface, size_t first, const double *corners, size_t corner_count,
                         const double *ends, size_t count, bool strips, SporeHelperFailure *failure) {
  double start = 0;
  for (size_t i = 0; i < count; i++) {
    if (!(ends[i] >= start && ends[i] <= (double)corner_count) || ends[i] != floor(ends[i]))
      return spore_vtk_fail_word(failure, "offsets");
    if (!spore_vtk_add_face(surface, first, corners + (size_t)start, (size_t)(ends[i] - start), strips, failure))
      return false;
    start = ends[i];
  }
  return true;
}

bool spore_vtk_answer(const SporeVtkSurface *surface, void **answer, size_t *answer_size, SporeHelperFailure *failure) {
  const SporeImportAnswer head = {1, surface->vertex_count, surface->triangle_count, surface->passed_over};
  const SporeImportPart part = {.triangle_count = surface->triangle_count};
  const size_t vertices = 3 * surface->vertex_count * sizeof(double),
               triangles = 3 * surface->triangle_count * sizeof(uint32_t);
  if (!surface->triangle_count)
    return spore_helper_fail(
        failure,
        surface->vertex_count ? N_("there are only points or lines in the file; expected triangles; export the surface")
                              : N_("there is no mesh in the file; expected triangles; export it again"),
        "%s", "");
  *answer_size = sizeof head + sizeof part + vertices + triangles;
  char *at = *answer = spore_vtk_room(*answer_size / 8 + 1, failure);
  if (!at) return false;
  memcpy(at, &head, sizeof head);
  memcpy(at += sizeof head, &part, sizeof part);
  memcpy(at += sizeof part, surface->vertices, vertices);
  memcpy(at + vertices, surface->triangles, triangles);
  return true;
}
