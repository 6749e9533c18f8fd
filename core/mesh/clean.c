/* Repairs triangles without area and duplicate vertices. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/mesh/common.h"
#include "core/mesh/edit.h"
#include "core/mesh/half_edges.h"

#define ROUNDS 20

/* The longest side of a triangle without area (as spore_triangle_mesh_report counts them), or -1. */
static int flat_side(const SporeTriangleMesh *mesh, size_t triangle) {
  const uint32_t *v = mesh->triangles + 3 * triangle;
  SporeVec3 p[3];
  double length[3];
  for (int k = 0; k < 3; k++) p[k] = spore_mesh_vertex(mesh->vertices, v[k]);
  for (int k = 0; k < 3; k++) length[k] = spore_vec3_distance(p[k], p[(k + 1) % 3]);
  int longest = length[0] >= length[1] ? (length[0] >= length[2] ? 0 : 2) : (length[1] >= length[2] ? 1 : 2);
  double area = spore_vec3_length(spore_mesh_area_vector(p[0], p[1], p[2]));
  return area <= SPORE_MESH_FLAT * length[longest] * length[longest] ? longest : -1;
}

static uint32_t corner(const SporeTriangleMesh *mesh, uint32_t half, uint32_t ahead) {
  assert(half < 3 * mesh->triangle_count);
  return mesh->triangles[half - half % 3 + (half % 3 + ahead) % 3];
}

/* Splits the triangle across `half` and gives one half to each side: p q r with the corner c on p-q becomes p c r and c
 * q r. Not done where c-r is an edge already: that edge would get more than two triangles. */
static bool split_across(SporeTriangleMesh *mesh, const SporeHalfEdges *halves, uint32_t flat_half, uint32_t half) {
  uint32_t p = corner(mesh, half, 0), q = corner(mesh, half, 1), r = corner(mesh, half, 2);
  uint32_t c = corner(mesh, flat_half, 2);
  if (c == r || spore_half_edges_have(halves, c, r)) return false;
  uint32_t *flat = mesh->triangles + 3 * (size_t)(flat_half / 3), *other = mesh->triangles + 3 * (size_t)(half / 3);
  const uint32_t first[3] = {p, c, r}, second[3] = {c, q, r};
  memcpy(flat, first, sizeof first);
  memcpy(other, second, sizeof second);
  return true;
}

/* Repairs each flat triangle whose neighbours were not changed in this round; true when there was one. */
static bool free_corners(SporeTriangleMesh *mesh, const SporeHalfEdges *halves, bool *touched) {
  bool changed = false;
  for (size_t i = 0, end; i < halves->count; i = end) {
    end = spore_half_edges_end(halves, i);
    for (size_t j = i; j < end && end - i <= 2; j++) {
      uint32_t half = halves->half[j], triangle = half / 3;
      if (touched[triangle] || flat_side(mesh, triangle) != (int)(half % 3)) continue;
      if (end - i == 1) { /* the weld that follows drops the triangle */
        for (int k = 1; k < 3; k++) mesh->triangles[3 * (size_t)triangle + (size_t)k] = mesh->triangles[3 * triangle];
        touched[triangle] = changed = true;
        continue;
      }
      uint32_t across = halves->half[i + end - 1 - j];
      if (touched[across / 3] || across / 3 == triangle || !split_across(mesh, halves, half, across)) continue;
      touched[triangle] = touched[across / 3] = changed = true;
    }
  }
  return changed;
}

static bool clean(SporeTriangleMesh *mesh, double relative, bool *touched, SporeError *error) {
  for (int round = 0; round < ROUNDS; round++) {
    SporeHalfEdges halves;
    if (!spore_triangle_mesh_weld(mesh, relative, error)) return false;
    if (!spore_half_edges_create(&halves, mesh->triangles, mesh->triangle_count)) return spore_mesh_no_memory(error);
    memset(touched, 0, mesh->triangle_count * sizeof *touched);
    bool changed = free_corners(mesh, &halves, touched);
    spore_half_edges_clear(&halves);
    if (!changed) return true;
  }
  return spore_triangle_mesh_weld(mesh, relative, error);
}

bool spore_triangle_mesh_clean(SporeTriangleMesh *mesh, double relative, SporeError *error) {
  assert(relative >= 0);
  SporeTriangleMesh copy = {0};
  if (!spore_triangle_mesh_copy(&copy, mesh, error)) return false;
  bool *touched = SPORE_NEW_ARRAY(bool, mesh->triangle_count);
  bool done = touched ? clean(&copy, relative, touched, error) : spore_mesh_no_memory(error);
  spore_free(touched);
  if (!done) {
    spore_triangle_mesh_clear(&copy);
    return false;
  }
  spore_triangle_mesh_clear(mesh);
  *mesh = copy;
  return true;
}
