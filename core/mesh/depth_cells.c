/* Depths by cubes of space, each with the triangles that can be nearest to a place in it. */
#include "core/mesh/depth_cells.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/bvh_node.h"
#include "core/mesh/common.h"

#define MOST_NEAR 48       /* triangles of a cube */
#define MOST_CELLS 2000000 /* cubes with triangles */
#define BIAS (1 << 20)     /* cubes on each side of the origin, along an axis */
#define ROUND (1 + 1e-9)
#define SEEN UINT32_MAX           /* of a key: one place in the cube was asked about */
#define TOO_MANY (UINT32_MAX - 1) /* of a key: too many triangles are near, or there was no memory for them */

typedef struct Cell {
  SporeVec3 centre;
  double depth;          /* m, of the centre */
  uint32_t first, count; /* of its triangles, the nearest to the centre first */
} Cell;

struct SporeDepthCells {
  const SporeBvh *bvh;
  double side;
  uint64_t *keys; /* of a hash table: 1 + the cube's three numbers; 0: none */
  uint32_t *values;
  size_t slots, used;
  Cell *cells;
  size_t count, capacity;
  SporeBvhNear *near;
  size_t near_count, near_capacity;
};

SporeDepthCells *spore_depth_cells_create(const SporeBvh *bvh, double side) {
  assert(side > 0);
  SporeDepthCells *cells = SPORE_NEW_ARRAY(SporeDepthCells, 1);
  if (cells) *cells = (SporeDepthCells){.bvh = bvh, .side = side};
  return cells;
}

void spore_depth_cells_free(SporeDepthCells *cells) {
  if (!cells) return;
  spore_free(cells->keys);
  spore_free(cells->values);
  spore_free(cells->cells);
  spore_free(cells->near);
  spore_free(cells);
}

static size_t slot_of(const uint64_t *keys, size_t slots, uint64_t key) {
  uint64_t mixed = (key ^ key >> 31) * UINT64_C(0x9e3779b97f4a7c15);
  size_t slot = (size_t)(mixed >> 24) & (slots - 1);
  while (keys[slot] && keys[slot] != key) slot = (slot + 1) & (slots - 1);
  return slot;
}

/* False: no memory; the table is as it was. */
static bool widen(SporeDepthCells *cells) {
  size_t slots = cells->slots ? 2 * cells->slots : 4096;
  uint64_t *keys = SPORE_NEW_ARRAY(uint64_t, slots);
  uint32_t *values = SPORE_NEW_ARRAY(uint32_t, slots);
  if (!keys || !values) {
    spore_free(keys);
    spore_free(values);
    return false;
  }
  memset(keys, 0, slots * sizeof *keys);
  for (size_t i = 0; i < cells->slots; i++) {
    if (!cells->keys[i]) continue;
    size_t slot = slot_of(keys, slots, cells->keys[i]);
    keys[slot] = cells->keys[i];
    values[slot] = cells->values[i];
  }
  spore_free(cells->keys);
  spore_free(cells->values);
  cells->keys = keys, cells->values = values, cells->slots = slots;
  return true;
}

/* The number of the cube that holds p, and the cube's centre; 0: too far from the origin. */
static uint64_t key_of(const SporeDepthCells *cells, SporeVec3 p, SporeVec3 *centre) {
  const double x[3] = {floor(p.x / cells->side), floor(p.y / cells->side), floor(p.z / cells->side)};
  uint64_t key = 0;
  for (int k = 0; k < 3; k++) {
    if (!(fabs(x[k]) < BIAS - 1)) return 0;
    key = key << 21 | (uint64_t)(x[k] + BIAS);
  }
  *centre = spore_vec3((x[0] + 0.5) * cells->side, (x[1] + 0.5) * cells->side, (x[2] + 0.5) * cells->side);
  return key + 1;
}

static void sort_near(SporeBvhNear *near, size_t count) {
  for (size_t i = 1; i < count; i++) {
    SporeBvhNear moved = near[i];
    size_t at = i;
    for (; at > 0 && near[at - 1].distance > moved.distance; at--) near[at] = near[at - 1];
    near[at] = moved;
  }
}

static bool keep(SporeDepthCells *cells, const Cell *cell, const SporeBvhNear *near) {
  Cell *all = spore_room_for_one(cells->cells, cells->count, &cells->capacity, 4096, sizeof *all);
  if (!all) return false;
  cells->cells = all;
  for (uint32_t i = 0; i < cell->count; i++) {
    SporeBvhNear *its =
        spore_room_for_one(cells->near, cells->near_count + i, &cells->near_capacity, 4096, sizeof *its);
    if (!its) return false;
    cells->near = its;
    its[cells->near_count + i] = near[i];
  }
  all[cells->count] = *cell;
  all[cells->count++].first = (uint32_t)cells->near_count;
  cells->near_count += cell->count;
  return true;
}

/* Fills a cube: a triangle that is nearest to a place in it is no farther from the centre than the surface and the
 * cube's diagonal. The cube's number, or why it has none. */
static uint32_t fill(SporeDepthCells *cells, SporeVec3 centre, const SporeBvhKnown *known) {
  SporeBvhNear near[MOST_NEAR];
  if (cells->count >= MOST_CELLS) return TOO_MANY;
  Cell cell = {.centre = centre, .depth = spore_bvh_depth_beside(cells->bvh, centre, known).depth};
  size_t count =
      spore_bvh_near(cells->bvh, centre, ROUND * (fabs(cell.depth) + sqrt(3) * cells->side), near, MOST_NEAR);
  if (count > MOST_NEAR) return TOO_MANY;
  cell.count = (uint32_t)count;
  sort_near(near, count);
  return keep(cells, &cell, near) ? (uint32_t)cells->count - 1 : TOO_MANY;
}

/* The filled cube that holds p; NULL: there is none. */
static const Cell *cell_of(SporeDepthCells *cells, SporeVec3 p, const SporeBvhKnown *known) {
  SporeVec3 centre;
  uint64_t key = key_of(cells, p, &centre);
  if (!key || (2 * cells->used >= cells->slots && !widen(cells))) return NULL;
  size_t slot = slot_of(cells->keys, cells->slots, key);
  if (!cells->keys[slot]) {
    cells->keys[slot] = key;
    cells->values[slot] = SEEN;
    cells->used++;
    return NULL;
  }
  if (cells->values[slot] == SEEN) cells->values[slot] = fill(cells, centre, known);
  return cells->values[slot] == TOO_MANY ? NULL : &cells->cells[cells->values[slot]];
}

SporeBvhKnown spore_depth_cells_beside(SporeDepthCells *cells, SporeVec3 p, const SporeBvhKnown *known) {
  const Cell *cell = cell_of(cells, p, known);
  if (!cell) return spore_bvh_depth_beside(cells->bvh, p, known);
  SporeBvhKnown here = {.place = p, .nearest = p};
  const SporeBvhNear *near = cells->near + cell->first;
  double best = HUGE_VAL, shift = spore_vec3_distance(p, cell->centre), far = HUGE_VAL;
  for (uint32_t i = 0; i < cell->count && near[i].distance <= far; i++) {
    SporeVec3 q = spore_triangle_nearest(p, cells->bvh->corners + 9 * (size_t)near[i].place),
              gap = spore_vec3_sub(p, q);
    double square = spore_vec3_dot(gap, gap);
    if (square >= best) continue;
    best = square, here.nearest = q, here.depth = sqrt(square);
    far = ROUND * (here.depth + shift);
  }
  bool inside = shift < fabs(cell->depth) ? cell->depth > 0 : spore_bvh_inside(cells->bvh, p);
  if (!inside) here.depth = -here.depth;
  return here;
}
