/* The faces that bound the cells of a label, and the sample points of a surface that belong to each face. */
#include "core/generate/common/skin.h"

#include <math.h>
#include <string.h>

#include "core/mesh/common.h"

static uint32_t label_of(const SporeTetrahedralMesh *mesh, uint32_t cell) {
  return cell == UINT32_MAX ? 0 : mesh->labels ? mesh->labels[cell] : 1;
}

/* Lists the faces between two labels, each once, outward from the higher label. */
static bool list_faces(SporeSkin *skin, const SporeTetrahedralMesh *mesh) {
  uint32_t *neighbours;
  if (!spore_tetrahedral_mesh_neighbours(mesh, &neighbours)) return false;
  bool done = true;
  for (int pass = 0; pass < 2 && done; pass++) {
    skin->face_count = 0;
    for (size_t i = 0; i < 4 * mesh->tetrahedron_count; i++) {
      uint32_t inner = label_of(mesh, (uint32_t)(i / 4)), outer = label_of(mesh, neighbours[i]);
      if (inner <= outer) continue;
      size_t f = skin->face_count++;
      if (!pass) continue;
      skin->sides[2 * f] = inner, skin->sides[2 * f + 1] = outer;
      for (int k = 0; k < 3; k++)
        skin->corners[3 * f + (size_t)k] = mesh->tetrahedra[i / 4 * 4 + spore_tetrahedron_faces[i % 4][k]];
    }
    if (pass) break;
    skin->corners = SPORE_NEW_ARRAY(uint32_t, 3 * skin->face_count);
    skin->sides = SPORE_NEW_ARRAY(uint32_t, 2 * skin->face_count);
    done = skin->corners && skin->sides;
  }
  spore_free(neighbours);
  return done;
}

/* Sorts items by their holder (counting sort over `count` holders). first: count + 2, zero. */
static void share_out(const uint32_t *holders, size_t items, size_t each, size_t count, size_t *first,
                      uint32_t *result) {
  for (size_t i = 0; i < items; i++) first[holders[i] + 2]++;
  for (size_t h = 2; h < count + 2; h++) first[h] += first[h - 1];
  for (size_t i = 0; i < items; i++) result[first[holders[i] + 1]++] = (uint32_t)(i / each);
}

static bool has_corners(const uint32_t *face, const uint32_t *host) {
  for (int k = 0; k < 3; k++)
    if (face[0] != host[k] && face[1] != host[k] && face[2] != host[k]) return false;
  return true;
}

static double distance_to_face(const SporeTetrahedralMesh *mesh, const uint32_t *corner, SporeVec3 p) {
  double corners[9];
  for (int k = 0; k < 3; k++) memcpy(corners + 3 * k, mesh->vertices + 3 * (size_t)corner[k], 3 * sizeof(double));
  return spore_vec3_distance(p, spore_triangle_nearest(p, corners));
}

/* The host face of a point; if it is gone, the nearest face at the host's vertices. */
static uint32_t face_of(const SporeSkin *skin, const SporeTetrahedralMesh *mesh, const SporeSkinPoints *points,
                        size_t point) {
  const uint32_t *host = points->hosts + 3 * point;
  SporeVec3 p = spore_vec3_load(points->places + 3 * point);
  double least = HUGE_VAL;
  uint32_t nearest = 0;
  for (int k = 0; k < 3; k++)
    for (size_t i = skin->first[host[k]]; i < skin->first[host[k] + 1]; i++) {
      const uint32_t *corner = skin->corners + 3 * (size_t)skin->faces[i];
      if (k == 0 && has_corners(corner, host)) return skin->faces[i];
      double distance = distance_to_face(mesh, corner, p);
      if (distance < least) least = distance, nearest = skin->faces[i];
    }
  return nearest;
}

bool spore_skin_create(SporeSkin *skin, const SporeTetrahedralMesh *mesh, SporeSkinPoints *points, SporeError *error) {
  *skin = (SporeSkin){.first = SPORE_NEW_ARRAY(size_t, mesh->vertex_count + 2),
                      .points = SPORE_NEW_ARRAY(uint32_t, points->count)};
  uint32_t *holders = SPORE_NEW_ARRAY(uint32_t, points->count);
  bool done = skin->first && skin->points && holders && list_faces(skin, mesh);
  done = done && (skin->faces = SPORE_NEW_ARRAY(uint32_t, 3 * skin->face_count)) &&
         (skin->first_point = SPORE_NEW_ARRAY(size_t, skin->face_count + 2));
  if (done) {
    share_out(skin->corners, 3 * skin->face_count, 3, mesh->vertex_count, skin->first, skin->faces);
    for (size_t i = 0; i < points->count; i++) {
      holders[i] = face_of(skin, mesh, points, i);
      const uint32_t *corner = skin->corners + 3 * (size_t)holders[i];
      memcpy(points->hosts + 3 * i, corner, 3 * sizeof *corner);
      points->off[i] = distance_to_face(mesh, corner, spore_vec3_load(points->places + 3 * i));
    }
    share_out(holders, points->count, 1, skin->face_count, skin->first_point, skin->points);
  } else spore_skin_clear(skin);
  spore_free(holders);
  return done || spore_mesh_no_memory(error);
}

void spore_skin_clear(SporeSkin *skin) {
  spore_free(skin->corners);
  spore_free(skin->sides);
  spore_free(skin->first);
  spore_free(skin->faces);
  spore_free(skin->first_point);
  spore_free(skin->points);
  *skin = (SporeSkin){0};
}

/* Appends places whose hosts are the nearest of the triangles, which are faces of the mesh. */
static bool add_points(SporeSkinPoints *points, const SporeTriangleMesh *faces, const double *places, size_t count,
                       size_t most, SporeError *error) {
  const size_t taken = count < most ? count : most, had = points->count, all = had + taken;
  double *to = spore_reallocate(points->places, 3 * had, 3 * all, sizeof *to);
  if (to) points->places = to;
  uint32_t *hosts = to ? spore_reallocate(points->hosts, 3 * had, 3 * all, sizeof *hosts) : NULL;
  if (hosts) points->hosts = hosts;
  double *off = hosts ? spore_reallocate(points->off, had, all, sizeof *off) : NULL;
  if (off) points->off = off;
  SporeBvh *tree = off ? spore_bvh_create(faces, error) : NULL;
  if (!tree) return off ? false : spore_mesh_no_memory(error);
  for (size_t i = 0; i < taken; i++) {
    uint32_t triangle = 0;
    memcpy(to + 3 * (had + i), places + 3 * (i * count / taken), 3 * sizeof *to);
    off[had + i] = spore_bvh_distance(tree, spore_vec3_load(to + 3 * (had + i)), NULL, &triangle);
    memcpy(hosts + 3 * (had + i), faces->triangles + 3 * (size_t)triangle, 3 * sizeof *hosts);
  }
  points->count = all;
  spore_bvh_free(tree);
  return true;
}

bool spore_skin_points_create(SporeSkinPoints *points, const SporeTetrahedralMesh *mesh, const double *places,
                              size_t count, size_t most, SporeError *error) {
  SporeTriangleMesh boundary = {.vertex_count = mesh->vertex_count, .vertices = mesh->vertices};
  *points = (SporeSkinPoints){0};
  bool done = (spore_tetrahedral_mesh_boundary(mesh, &boundary.triangles, &boundary.triangle_count) ||
               spore_mesh_no_memory(error)) &&
              add_points(points, &boundary, places, count, most, error);
  spore_free(boundary.triangles);
  if (!done) spore_skin_points_clear(points);
  return done;
}

bool spore_tetrahedral_mesh_borders(const SporeTetrahedralMesh *mesh, uint32_t **triangles, size_t *count,
                                    SporeError *error) {
  SporeSkin skin = {0};
  const bool done = list_faces(&skin, mesh) || spore_mesh_no_memory(error);
  *count = 0;
  for (size_t f = 0; done && f < skin.face_count; f++)
    if (skin.sides[2 * f + 1]) memmove(skin.corners + 3 * (*count)++, skin.corners + 3 * f, 3 * sizeof *skin.corners);
  *triangles = done ? skin.corners : NULL;
  if (done) skin.corners = NULL;
  spore_skin_clear(&skin);
  return done;
}

bool spore_skin_points_add_borders(SporeSkinPoints *points, const SporeTetrahedralMesh *mesh, const double *places,
                                   size_t count, size_t most, SporeError *error) {
  SporeTriangleMesh borders = {.vertex_count = mesh->vertex_count, .vertices = mesh->vertices};
  if (!spore_tetrahedral_mesh_borders(mesh, &borders.triangles, &borders.triangle_count, error)) return false;
  const bool done =
      borders.triangle_count == 0 || count == 0 || add_points(points, &borders, places, count, most, error);
  spore_free(borders.triangles);
  return done;
}

void spore_skin_points_clear(SporeSkinPoints *points) {
  spore_free(points->places);
  spore_free(points->hosts);
  spore_free(points->off);
  *points = (SporeSkinPoints){0};
}

static int add_side(uint32_t labels[SPORE_SKIN_SIDES], int count, uint32_t label) {
  int at = 0;
  if (count > SPORE_SKIN_SIDES) return count;
  while (at < count && labels[at] < label) at++;
  if (at < count && labels[at] == label) return count;
  if (count == SPORE_SKIN_SIDES) return count + 1;
  memmove(labels + at + 1, labels + at, (size_t)(count - at) * sizeof *labels);
  labels[at] = label;
  return count + 1;
}

int spore_skin_sides(const SporeSkin *skin, uint32_t v, uint32_t other, uint32_t labels[SPORE_SKIN_SIDES]) {
  int count = 0;
  for (size_t i = skin->first[v]; i < skin->first[v + 1]; i++) {
    const uint32_t *corner = skin->corners + 3 * (size_t)skin->faces[i];
    if (other != UINT32_MAX && corner[0] != other && corner[1] != other && corner[2] != other) continue;
    for (int k = 0; k < 2; k++) count = add_side(labels, count, skin->sides[2 * (size_t)skin->faces[i] + (size_t)k]);
  }
  return count;
}
