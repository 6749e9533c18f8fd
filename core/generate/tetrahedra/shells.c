/* The pieces of a surface, and which of them lie inside another one. */
#include "core/generate/tetrahedra/shells.h"

#include <math.h>

#include "core/base/memory.h"
#include "core/generate/common/common.h"
#include "core/mesh/common.h"
#include "core/mesh/edit.h"
#include "core/mesh/half_edges.h"

/* Numbers the sets of triangles in the order of their first triangles. Returns how many there are. */
static size_t number_sets(uint32_t *parent, size_t count, uint32_t *number) {
  size_t sets = 0;
  for (size_t t = 0; t < count; t++) {
    uint32_t first = spore_set_find(parent, (uint32_t)t); /* the least member */
    number[t] = first == t ? (uint32_t)sets++ : number[first];
  }
  return sets;
}

/* Joins triangles of one part across edges. rim: joins the vertices of open edges. */
static void join(const SporeHalfEdges *halves, const uint32_t *parts, const uint32_t *triangles, uint32_t *parent,
                 uint32_t *rim) {
  for (size_t i = 0, end; i < halves->count; i = end) {
    end = spore_half_edges_end(halves, i);
    for (size_t j = i; j < end; j++)
      for (size_t k = i; k < j; k++) {
        uint32_t a = halves->half[j] / 3, b = halves->half[k] / 3;
        if (!parts || parts[a] == parts[b]) spore_set_join(parent, a, b);
      }
    uint32_t h = halves->half[i];
    if (end == i + 1) spore_set_join(rim, triangles[h], triangles[h % 3 == 2 ? h - 2 : h + 1]);
  }
}

/* Whether an odd number of the triangles at an edge are of the same piece as the one of half-edge `one`. */
static bool is_odd(const SporeHalfEdges *halves, size_t begin, size_t end, size_t one, const uint32_t *of) {
  size_t mates = 0;
  for (size_t i = begin; i < end; i++) mates += of[halves->half[i] / 3] == of[halves->half[one] / 3];
  return mates % 2 == 1;
}

/* Finds which pieces are closed, and counts open edges of each piece, and their rims. A rim counts for the piece of its
 * first edge. */
static void find_rims(const SporeHalfEdges *halves, const uint32_t *triangles, uint32_t *rim, bool *counted,
                      SporePieces *pieces) {
  for (size_t i = 0, end; i < halves->count; i = end) {
    end = spore_half_edges_end(halves, i);
    for (size_t j = i; j < end; j++)
      if (is_odd(halves, i, end, j, pieces->of)) pieces->pieces[pieces->of[halves->half[j] / 3]].closed = false;
    if (end > i + 1) continue;
    SporePiece *piece = pieces->pieces + pieces->of[halves->half[i] / 3];
    uint32_t root = spore_set_find(rim, triangles[halves->half[i]]);
    piece->open_edges++;
    if (counted[root]) continue;
    counted[root] = true;
    piece->holes++;
  }
}

static void measure(SporePieces *pieces, const SporeTriangleMesh *mesh, const uint32_t *parts) {
  for (size_t p = 0; p < pieces->count; p++)
    pieces->pieces[p] = (SporePiece){
        .lower = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, .upper = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, .closed = true};
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    SporePiece *piece = pieces->pieces + pieces->of[t];
    SporeVec3 corner[3];
    piece->triangles++;
    piece->part = parts ? parts[t] : 0;
    for (size_t i = 0; i < 3; i++) {
      const double *x = mesh->vertices + 3 * (size_t)mesh->triangles[3 * t + i];
      corner[i] = spore_vec3_load(x);
      for (int k = 0; k < 3; k++) {
        piece->lower[k] = fmin(piece->lower[k], x[k]);
        piece->upper[k] = fmax(piece->upper[k], x[k]);
      }
    }
    piece->area += spore_vec3_length(spore_mesh_area_vector(corner[0], corner[1], corner[2]));
    piece->volume += spore_vec3_dot(corner[0], spore_vec3_cross(corner[1], corner[2])) / 6;
  }
}

bool spore_pieces_find(SporePieces *pieces, const SporeTriangleMesh *mesh, const uint32_t *parts, SporeError *error) {
  const size_t n = mesh->triangle_count;
  SporeHalfEdges halves = {0};
  uint32_t *parent = SPORE_NEW_ARRAY(uint32_t, n), *rim = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count);
  bool *counted = SPORE_NEW_ARRAY(bool, mesh->vertex_count);
  *pieces = (SporePieces){.of = SPORE_NEW_ARRAY(uint32_t, n)};
  bool done = parent && rim && counted && pieces->of && spore_half_edges_create(&halves, mesh->triangles, n);
  if (done) {
    for (size_t t = 0; t < n; t++) parent[t] = (uint32_t)t;
    for (size_t i = 0; i < mesh->vertex_count; i++) rim[i] = (uint32_t)i;
    join(&halves, parts, mesh->triangles, parent, rim);
    pieces->count = number_sets(parent, n, pieces->of);
    done = (pieces->pieces = SPORE_NEW_ARRAY(SporePiece, pieces->count)) != NULL;
  }
  if (done) {
    measure(pieces, mesh, parts);
    find_rims(&halves, mesh->triangles, rim, counted, pieces);
  } else spore_pieces_clear(pieces);
  spore_half_edges_clear(&halves);
  spore_free(parent);
  spore_free(rim);
  spore_free(counted);
  return done || spore_mesh_no_memory(error);
}

void spore_pieces_clear(SporePieces *pieces) {
  spore_free(pieces->pieces);
  spore_free(pieces->of);
  *pieces = (SporePieces){0};
}

bool spore_piece_shell(SporePieceShell *shell, const SporeTriangleMesh *mesh, const SporePieces *pieces, size_t piece,
                       SporeError *error) {
  SporeTriangleMesh part = {0};
  uint32_t triangles[SPORE_PIECE_SAMPLES];
  shell->tree = NULL;
  if (!spore_triangle_mesh_extract(mesh, pieces->of, (uint32_t)piece, &part, error)) return false;
  shell->tree = spore_bvh_create(&part, error);
  spore_surface_samples(&part, SPORE_PIECE_SAMPLES, shell->points, triangles);
  for (size_t i = 0; i < SPORE_PIECE_SAMPLES; i++) {
    const uint32_t *corner = part.triangles + 3 * (size_t)triangles[i];
    SporeVec3 area =
        spore_mesh_area_vector(spore_mesh_vertex(part.vertices, corner[0]), spore_mesh_vertex(part.vertices, corner[1]),
                               spore_mesh_vertex(part.vertices, corner[2]));
    shell->normals[i] = spore_vec3_normalise(area, spore_vec3(0, 0, 0));
  }
  spore_triangle_mesh_clear(&part);
  return shell->tree != NULL;
}

void spore_piece_shell_clear(SporePieceShell *shell) {
  spore_bvh_free(shell->tree);
  shell->tree = NULL;
}

size_t spore_piece_points_in(const SporePieceShell *shell, const SporePieceShell *other) {
  size_t inside = 0;
  for (size_t i = 0; i < SPORE_PIECE_SAMPLES; i++)
    inside += fabs(spore_bvh_winding(other->tree, spore_vec3_load(shell->points + 3 * i))) > 0.5;
  return inside;
}

bool spore_piece_fits(const SporePiece *piece, const SporePiece *other) {
  for (int k = 0; k < 3; k++)
    if (!(piece->lower[k] > other->lower[k] && piece->upper[k] < other->upper[k])) return false;
  return true;
}
