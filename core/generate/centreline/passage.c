/* Straight ways inside of an organ: whether a segment crosses a wall. */
#include <math.h>

#include "core/base/memory.h"
#include "core/generate/centreline/private.h"
#include "core/mesh/half_edges.h"

#define BEYOND 1e-7 /* of the segment: a hit nearer than this to the hit before belongs to the same wall */
#define NEARLY 0.98 /* of the area: specks beside the piece with this share do not count as walls */

SporeVec3 spore_triangle_across(const SporeTriangleMesh *mesh, uint32_t triangle) {
  SporeVec3 corner[3];
  for (size_t k = 0; k < 3; k++)
    corner[k] = spore_vec3_load(mesh->vertices + 3 * (size_t)mesh->triangles[3 * (size_t)triangle + k]);
  return spore_vec3_cross(spore_vec3_sub(corner[1], corner[0]), spore_vec3_sub(corner[2], corner[0]));
}

/* Which triangles belong to the piece of the surface with the largest area, if that is nearly all of the surface. */
bool spore_passage_know_piece(SporeVoxelTube *tube, SporeError *error) {
  const SporeTriangleMesh *mesh = &tube->solid->mesh;
  uint32_t *piece = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count), largest = 0;
  double *area = SPORE_NEW_ARRAY(double, mesh->vertex_count), all = 0;
  tube->of_piece = SPORE_NEW_ARRAY(bool, mesh->triangle_count);
  bool room = piece && area && tube->of_piece;
  for (uint32_t i = 0; room && i < mesh->vertex_count; i++) piece[i] = i;
  for (size_t i = 0; room && i < 3 * mesh->triangle_count; i++)
    spore_set_join(piece, mesh->triangles[i - i % 3], mesh->triangles[i]);
  for (size_t t = 0; room && t < mesh->triangle_count; t++) {
    double share = spore_vec3_length(spore_triangle_across(mesh, (uint32_t)t));
    uint32_t in = spore_set_find(piece, mesh->triangles[3 * t]);
    area[in] += share;
    all += share;
    if (area[in] > area[largest]) largest = in;
  }
  tube->of_one_piece = room && area[largest] >= NEARLY * all;
  for (size_t t = 0; room && t < mesh->triangle_count; t++)
    tube->of_piece[t] = spore_set_find(piece, mesh->triangles[3 * t]) == largest;
  spore_free(piece);
  spore_free(area);
  return room || spore_generate_no_memory(error);
}

/* Whether the way leaves the organ at a hit: through the front of the one piece that the surface is, or to where the
 * winding number says outside. */
static bool is_left(const SporeVoxelTube *tube, SporeVec3 d, uint32_t triangle, SporeVec3 behind) {
  if (!tube->of_one_piece) return !spore_bvh_inside(tube->solid->bvh, behind);
  return tube->of_piece[triangle] && spore_vec3_dot(spore_triangle_across(&tube->solid->mesh, triangle), d) > 0;
}

bool spore_passage_open(const SporeVoxelTube *tube, SporeVec3 a, SporeVec3 b) {
  const SporeBvh *bvh = tube->solid->bvh;
  double whole = spore_vec3_distance(a, b), gone = 0, t;
  uint32_t triangle;
  if (!(whole > 0)) return true;
  SporeVec3 d = spore_vec3_scale(1 / whole, spore_vec3_sub(b, a));
  bool hit = spore_bvh_ray(bvh, a, d, &t, &triangle) && t < whole;
  while (hit) {
    uint32_t here = triangle;
    double at = gone + t, from = at + BEYOND * whole;
    hit = spore_bvh_ray(bvh, spore_vec3_add_scaled(a, from, d), d, &t, &triangle) && from + t < whole;
    if (is_left(tube, d, here, spore_vec3_add_scaled(a, 0.5 * (at + (hit ? from + t : whole)), d))) return false;
    gone = from;
  }
  return true;
}
