/* A surface that is cut: triangles with their neighbours, and what splits them. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/common/common.h"
#include "core/generate/sheet/private.h"
#include "core/mesh/bvh.h"
#include "core/mesh/half_edges.h"

#define NONE SPORE_SHEET_NONE
#define WELD 1e-9 /* of the diagonal: vertices that are one */

/* Room. */

static bool grow(void **array, size_t old, size_t room, size_t size) {
  void *grown = spore_reallocate(*array, old, room, size);
  if (grown) *array = grown;
  return grown != NULL;
}

static bool vertex_room(SporeSheetCut *cut) {
  size_t old = cut->vertex_room, room = 2 * old + 64;
  if (cut->vertex_count < old) return true;
  if (!grow((void **)&cut->vertices, 3 * old, 3 * room, sizeof *cut->vertices) ||
      !grow((void **)&cut->leaving, old, room, sizeof *cut->leaving) ||
      !grow((void **)&cut->sides, old, room, sizeof *cut->sides))
    return false;
  cut->vertex_room = room;
  return true;
}

/* For two more. */
static bool triangle_room(SporeSheetCut *cut) {
  size_t old = cut->triangle_room, room = 2 * old + 64;
  if (cut->triangle_count + 2 <= old) return true;
  if (!grow((void **)&cut->triangles, 3 * old, 3 * room, sizeof *cut->triangles) ||
      !grow((void **)&cut->across, 3 * old, 3 * room, sizeof *cut->across) ||
      !grow((void **)&cut->side, 3 * old, 3 * room, sizeof *cut->side))
    return false;
  cut->triangle_room = room;
  return true;
}

static bool add_vertex(SporeSheetCut *cut, SporeVec3 at, uint32_t *vertex) {
  if (!vertex_room(cut)) return false;
  *vertex = (uint32_t)cut->vertex_count++;
  spore_vec3_store(cut->vertices + 3 * (size_t)*vertex, at);
  cut->leaving[*vertex] = NONE;
  cut->sides[*vertex] = 0;
  return true;
}

static void link(SporeSheetCut *cut, uint32_t h, uint32_t other) {
  cut->across[h] = other;
  if (other != NONE) cut->across[other] = h;
}

static uint32_t add_triangle(SporeSheetCut *cut, uint32_t a, uint32_t b, uint32_t c) {
  uint32_t first = (uint32_t)(3 * cut->triangle_count++);
  const uint32_t corner[3] = {a, b, c};
  memcpy(cut->triangles + first, corner, sizeof corner);
  for (uint32_t k = 0; k < 3; k++) cut->across[first + k] = NONE, cut->side[first + k] = 0;
  return first;
}

/* What h was in its triangle is `to` now: from the same vertex along the same edge. */
static void move_half(SporeSheetCut *cut, uint32_t h, uint32_t to) {
  link(cut, to, cut->across[h]);
  cut->side[to] = cut->side[h];
  cut->side[h] = 0;
  uint32_t *leaving = &cut->leaving[cut->triangles[to]];
  if (*leaving == h) *leaving = to;
}

/* Making. */

/* Two half-edges are neighbours where they alone lie on an edge, and run against each other. */
static bool find_neighbours(SporeSheetCut *cut) {
  SporeHalfEdges halves;
  if (!spore_half_edges_create(&halves, cut->triangles, cut->triangle_count)) return false;
  memset(cut->across, 0xff, 3 * cut->triangle_count * sizeof *cut->across);
  for (size_t begin = 0, end; begin < halves.count; begin = end) {
    end = spore_half_edges_end(&halves, begin);
    if (end == begin + 2 && spore_half_edge_ascends(cut->triangles, halves.half[begin]) !=
                                spore_half_edge_ascends(cut->triangles, halves.half[begin + 1]))
      link(cut, halves.half[begin], halves.half[begin + 1]);
  }
  spore_half_edges_clear(&halves);
  return true;
}

/* The first half-edge of the fan of h about its start. */
static uint32_t fan_start(const SporeSheetCut *cut, uint32_t h) {
  for (uint32_t first = h, across = cut->across[h]; across != NONE; across = cut->across[first]) {
    first = spore_sheet_next(across);
    if (first == h) return h;
    if (cut->across[first] == NONE) return first;
  }
  return h;
}

/* A vertex keeps one fan; each other one gets a vertex of its own. */
static bool part_fans(SporeSheetCut *cut) {
  bool *seen = SPORE_NEW_ARRAY(bool, 3 * cut->triangle_count);
  bool good = seen != NULL;
  for (size_t v = 0; good && v < cut->vertex_count; v++) cut->leaving[v] = NONE;
  for (uint32_t h = 0; good && h < 3 * cut->triangle_count; h++) {
    if (seen[h]) continue;
    uint32_t vertex = cut->triangles[h], first = fan_start(cut, h);
    if (cut->leaving[vertex] != NONE) good = add_vertex(cut, spore_sheet_vertex(cut, vertex), &vertex);
    if (!good) break;
    cut->leaving[vertex] = first;
    uint32_t turn = first;
    do {
      seen[turn] = true;
      cut->triangles[turn] = vertex;
      turn = spore_sheet_turn(cut, turn);
    } while (turn != NONE && turn != first);
  }
  spore_free(seen);
  return good;
}

static bool take(SporeSheetCut *cut, SporeTriangleMesh *mesh) {
  cut->vertex_count = cut->vertex_room = mesh->vertex_count;
  cut->triangle_count = cut->triangle_room = mesh->triangle_count;
  cut->vertices = mesh->vertices, cut->triangles = mesh->triangles;
  *mesh = (SporeTriangleMesh){0};
  cut->across = SPORE_NEW_ARRAY(uint32_t, 3 * cut->triangle_count);
  cut->side = SPORE_NEW_ARRAY(uint8_t, 3 * cut->triangle_count);
  cut->leaving = SPORE_NEW_ARRAY(uint32_t, cut->vertex_count);
  cut->sides = SPORE_NEW_ARRAY(uint8_t, cut->vertex_count);
  return cut->across && cut->side && cut->leaving && cut->sides && find_neighbours(cut) && part_fans(cut);
}

bool spore_sheet_cut_create(SporeSheetCut *cut, const SporeTriangleMesh *mesh, SporeError *error) {
  SporeTriangleMesh copy = {0};
  *cut = (SporeSheetCut){0};
  bool good = spore_triangle_mesh_copy(&copy, mesh, error) && spore_triangle_mesh_weld(&copy, WELD, error) &&
              spore_triangle_mesh_orient(&copy, error) && (take(cut, &copy) || spore_generate_no_memory(error));
  spore_triangle_mesh_clear(&copy);
  return good;
}

void spore_sheet_cut_clear(SporeSheetCut *cut) {
  spore_free(cut->vertices);
  spore_free(cut->triangles);
  spore_free(cut->across);
  spore_free(cut->leaving);
  spore_free(cut->side);
  spore_free(cut->sides);
  *cut = (SporeSheetCut){0};
}

/* Splitting. */

/* Triangle (a, b, c) of h from a to b becomes (a, p, c), and (p, b, c) is new. Returns the half-edge from p to b. */
static uint32_t split_beside(SporeSheetCut *cut, uint32_t h, uint32_t p) {
  uint32_t next = spore_sheet_next(h), b = cut->triangles[next], c = cut->triangles[spore_sheet_before(h)];
  uint32_t made = add_triangle(cut, p, b, c);
  move_half(cut, next, made + 1);
  cut->triangles[next] = p;
  link(cut, next, made + 2);
  return made;
}

bool spore_sheet_cut_split_edge(SporeSheetCut *cut, uint32_t h, double share, uint32_t *vertex, SporeError *error) {
  uint32_t other = cut->across[h];
  SporeVec3 a = spore_sheet_vertex(cut, spore_sheet_from(cut, h)), b = spore_sheet_vertex(cut, spore_sheet_to(cut, h));
  SporeVec3 at = spore_vec3_add_scaled(a, share, spore_vec3_sub(b, a));
  if (!triangle_room(cut) || !add_vertex(cut, at, vertex)) return spore_generate_no_memory(error);
  uint32_t rest = split_beside(cut, h, *vertex), back = other == NONE ? NONE : split_beside(cut, other, *vertex);
  link(cut, h, back);
  link(cut, rest, other);
  cut->leaving[*vertex] = rest;
  return true;
}

bool spore_sheet_cut_split_triangle(SporeSheetCut *cut, uint32_t triangle, SporeVec3 at, uint32_t *vertex,
                                    SporeError *error) {
  if (!triangle_room(cut) || !add_vertex(cut, at, vertex)) return spore_generate_no_memory(error);
  uint32_t h = 3 * triangle, p = *vertex;
  const uint32_t corner[3] = {cut->triangles[h], cut->triangles[h + 1], cut->triangles[h + 2]};
  uint32_t second = add_triangle(cut, corner[1], corner[2], p), third = add_triangle(cut, corner[2], corner[0], p);
  move_half(cut, h + 1, second);
  move_half(cut, h + 2, third);
  cut->triangles[h + 2] = p;
  link(cut, h + 1, second + 2);
  link(cut, second + 1, third + 2);
  link(cut, third + 1, h + 2);
  cut->leaving[p] = h + 2;
  return true;
}

/* Looking. */

bool spore_sheet_cut_find(const SporeSheetCut *cut, uint32_t a, uint32_t b, uint32_t *h) {
  uint32_t first = cut->leaving[a], turn = first;
  if (first == NONE) return false;
  do {
    *h = turn;
    if (spore_sheet_to(cut, turn) == b) return true;
    turn = spore_sheet_turn(cut, turn);
  } while (turn != NONE && turn != first);
  *h = spore_sheet_before(*h);
  return turn == NONE && spore_sheet_from(cut, *h) == b;
}

uint32_t spore_sheet_cut_nearest(const SporeSheetCut *cut, SporeVec3 p, SporeVec3 *nearest) {
  double least = HUGE_VAL;
  uint32_t best = 0;
  for (uint32_t t = 0; t < cut->triangle_count; t++) {
    double corner[9];
    for (size_t k = 0; k < 3; k++)
      spore_vec3_store(corner + 3 * k, spore_sheet_vertex(cut, cut->triangles[3 * (size_t)t + k]));
    SporeVec3 there = spore_triangle_nearest(p, corner);
    double distance = spore_vec3_distance(p, there);
    if (distance < least) least = distance, best = t, *nearest = there;
  }
  return best;
}
