/* Welding vertices that lie at the same place. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/hash.h"
#include "core/base/text.h"
#include "core/mesh/common.h"

/* A hash grid of the vertices kept so far, with chains through `next`. Cells are twice the tolerance wide, so that all
 * vertices near a point lie in the eight cells around it. */
typedef struct Weld {
  const double *vertices;
  const double *lower;
  double tolerance, cell;
  size_t mask;
  uint32_t *head, *next; /* index + 1; 0: none */
} Weld;

static size_t cell_slot(const Weld *weld, int64_t x, int64_t y, int64_t z) {
  uint64_t h = (uint64_t)x * UINT64_C(0x9e3779b97f4a7c15) ^ (uint64_t)y * UINT64_C(0xc2b2ae3d27d4eb4f) ^
               (uint64_t)z * UINT64_C(0x165667b19e3779f9);
  return (size_t)(h ^ h >> 29 ^ h >> 47) & weld->mask;
}

static uint32_t find_in_slot(const Weld *weld, size_t slot, SporeVec3 p, uint32_t found) {
  for (uint32_t i = weld->head[slot]; i; i = weld->next[i - 1])
    if (i - 1 < found && spore_vec3_distance(p, spore_mesh_vertex(weld->vertices, i - 1)) <= weld->tolerance)
      found = i - 1;
  return found;
}

/* The first kept vertex near vertex i, or i itself, which is then kept. */
static uint32_t weld_vertex(Weld *weld, uint32_t i) {
  SporeVec3 p = spore_mesh_vertex(weld->vertices, i);
  double at[3] = {(p.x - weld->lower[0]) / weld->cell, (p.y - weld->lower[1]) / weld->cell,
                  (p.z - weld->lower[2]) / weld->cell};
  int64_t home[3], side[3];
  for (int k = 0; k < 3; k++) {
    home[k] = (int64_t)floor(at[k]);
    side[k] = at[k] - (double)home[k] < 0.5 ? -1 : 1;
  }
  uint32_t found = i;
  for (int n = 0; n < 8; n++)
    found = find_in_slot(weld,
                         cell_slot(weld, home[0] + (n & 1 ? side[0] : 0), home[1] + (n & 2 ? side[1] : 0),
                                   home[2] + (n & 4 ? side[2] : 0)),
                         p, found);
  if (found == i) {
    size_t slot = cell_slot(weld, home[0], home[1], home[2]);
    weld->next[i] = weld->head[slot];
    weld->head[slot] = i + 1;
  }
  return found;
}

static bool find_targets(const SporeTriangleMesh *mesh, double relative, uint32_t *target) {
  double lower[3], upper[3], diagonal = spore_mesh_bounds(mesh->vertices, mesh->vertex_count, 3, lower, upper);
  size_t slots = 16;
  while (slots < 2 * mesh->vertex_count) slots *= 2;
  Weld weld = {.vertices = mesh->vertices,
               .lower = lower,
               .tolerance = fmax(relative, 0) * diagonal,
               .cell = fmax(2 * fmax(relative, 1e-9) * diagonal, 1e-300),
               .mask = slots - 1,
               .head = SPORE_NEW_ARRAY(uint32_t, slots),
               .next = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count)};
  bool done = weld.head && weld.next;
  for (size_t i = 0; done && i < mesh->vertex_count; i++) target[i] = weld_vertex(&weld, (uint32_t)i);
  spore_free(weld.head);
  spore_free(weld.next);
  return done;
}

static void order_corners(const uint32_t *corner, uint32_t ordered[3]) {
  memcpy(ordered, corner, 3 * sizeof *ordered);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2 - i; j++)
      if (ordered[j] > ordered[j + 1]) {
        uint32_t swap = ordered[j];
        ordered[j] = ordered[j + 1];
        ordered[j + 1] = swap;
      }
}

/* Open-addressing set of triangles by their ordered corners; slots hold index + 1. */
static bool insert_triangle(const uint32_t *triangles, uint32_t *slots, size_t mask, uint32_t index) {
  uint32_t key[3], other[3];
  order_corners(triangles + 3 * (size_t)index, key);
  size_t slot = (size_t)spore_hash(SPORE_HASH_INIT, key, sizeof key) & mask;
  for (; slots[slot]; slot = (slot + 1) & mask) {
    order_corners(triangles + 3 * (size_t)(slots[slot] - 1), other);
    if (!memcmp(key, other, sizeof key)) return false;
  }
  slots[slot] = index + 1;
  return true;
}

/* Moves the triangles that are kept to the front of `triangles`, and their tags; returns their number. */
static size_t keep_triangles(const SporeTriangleMesh *mesh, const uint32_t *target, uint32_t *triangles, uint32_t *tags,
                             uint32_t *slots, size_t mask) {
  size_t kept = 0;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    uint32_t a = target[mesh->triangles[3 * t]], b = target[mesh->triangles[3 * t + 1]],
             c = target[mesh->triangles[3 * t + 2]];
    if (a == b || b == c || c == a) continue;
    triangles[3 * kept] = a, triangles[3 * kept + 1] = b, triangles[3 * kept + 2] = c;
    if (!insert_triangle(triangles, slots, mask, (uint32_t)kept)) continue;
    if (tags) tags[kept] = tags[t];
    kept++;
  }
  return kept;
}

/* Renumbers so that only used vertices stay, in their order. `number` is scratch, vertex_count. */
static void drop_unused_vertices(SporeTriangleMesh *mesh, uint32_t *number) {
  memset(number, 0, mesh->vertex_count * sizeof *number);
  for (size_t i = 0; i < 3 * mesh->triangle_count; i++) number[mesh->triangles[i]] = 1;
  size_t kept = 0;
  for (size_t i = 0; i < mesh->vertex_count; i++)
    if (number[i]) {
      memmove(mesh->vertices + 3 * kept, mesh->vertices + 3 * i, 3 * sizeof(double));
      number[i] = (uint32_t)kept++;
    }
  for (size_t i = 0; i < 3 * mesh->triangle_count; i++) mesh->triangles[i] = number[mesh->triangles[i]];
  mesh->vertex_count = kept;
}

bool spore_triangle_mesh_weld(SporeTriangleMesh *mesh, double relative, SporeError *error) {
  return spore_triangle_mesh_weld_tagged(mesh, relative, NULL, error);
}

bool spore_triangle_mesh_weld_tagged(SporeTriangleMesh *mesh, double relative, uint32_t *tags, SporeError *error) {
  assert(relative >= 0);
  if (!mesh->vertex_count || !mesh->triangle_count) return true;
  size_t slots = 16;
  while (slots < 2 * mesh->triangle_count) slots *= 2;
  uint32_t *target = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count), *set = SPORE_NEW_ARRAY(uint32_t, slots);
  uint32_t *triangles = SPORE_NEW_ARRAY(uint32_t, 3 * mesh->triangle_count);
  bool done = target && set && triangles && find_targets(mesh, relative, target);
  size_t kept = done ? keep_triangles(mesh, target, triangles, tags, set, slots - 1) : 0;
  if (!done) {
    spore_mesh_no_memory(error);
  } else if (!kept) {
    done = spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("every triangle collapses when vertices nearer than %g of the size are merged; a surface "
                             "was expected; choose another file"),
                           relative);
  } else {
    memcpy(mesh->triangles, triangles, 3 * kept * sizeof *triangles);
    mesh->triangle_count = kept;
    drop_unused_vertices(mesh, target);
  }
  spore_free(target);
  spore_free(set);
  spore_free(triangles);
  return done;
}
