/* Sorts triangles into the cells of a grid, to find changes after which triangles would intersect. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/simplify_parts.h"

#define MOST_CELLS 256 /* a side */
#define MOST_RING 32   /* triangles looked at together */
#define NONE UINT32_MAX

bool spore_shell_neighbours_create(SporeShellNeighbours *near, const SporeShell *shell, double edge) {
  size_t side = (size_t)fmin(fmax(ceil(1 / edge), 1), MOST_CELLS);
  *near = (SporeShellNeighbours){.side = side};
  near->head = SPORE_NEW_ARRAY(uint32_t, side * side * side);
  near->triangles = SPORE_NEW_ARRAY(SporeNearTriangle, shell->triangle_count);
  if (!near->head || !near->triangles) return false;
  memset(near->head, 0xff, side * side * side * sizeof *near->head);
  for (uint32_t t = 0; t < shell->triangle_count; t++)
    if (shell->corner[3 * (size_t)t] != SPORE_SHELL_NONE && !spore_shell_neighbours_add(near, shell, t)) return false;
  return true;
}

void spore_shell_neighbours_clear(SporeShellNeighbours *near) {
  spore_free(near->head);
  spore_free(near->triangles);
  spore_free(near->entries);
  *near = (SporeShellNeighbours){0};
}

typedef struct Box {
  double lower[3], upper[3];
} Box;

static Box box_of(const SporeVec3 p[3]) {
  Box box;
  for (size_t k = 0; k < 3; k++) {
    double x[3];
    spore_vec3_store(x, p[k]);
    for (size_t e = 0; e < 3; e++) {
      box.lower[e] = k && box.lower[e] < x[e] ? box.lower[e] : x[e];
      box.upper[e] = k && box.upper[e] > x[e] ? box.upper[e] : x[e];
    }
  }
  return box;
}

static bool boxes_meet(const Box *a, const Box *b) {
  for (size_t e = 0; e < 3; e++)
    if (a->lower[e] > b->upper[e] || b->lower[e] > a->upper[e]) return false;
  return true;
}

/* Cells that a box reaches into: from[e] .. to[e]. */
static void cells_of(const SporeShellNeighbours *near, const Box *box, size_t from[3], size_t to[3]) {
  double most = (double)near->side - 1;
  for (size_t e = 0; e < 3; e++) {
    from[e] = (size_t)fmin(fmax((box->lower[e] + 0.5) * (double)near->side, 0), most);
    to[e] = (size_t)fmin(fmax((box->upper[e] + 0.5) * (double)near->side, 0), most);
  }
}

static void corners_of(const SporeShell *shell, uint32_t triangle, SporeVec3 p[3]) {
  for (size_t k = 0; k < 3; k++) p[k] = spore_shell_at(shell, shell->corner[3 * (size_t)triangle + k]);
}

static bool add_to_cell(SporeShellNeighbours *near, size_t cell, uint32_t triangle) {
  uint32_t *entries = spore_room_for_one(near->entries, near->count, &near->capacity, 4096, 2 * sizeof *entries);
  if (!entries) return false;
  near->entries = entries;
  near->entries[2 * near->count] = triangle;
  near->entries[2 * near->count + 1] = near->head[cell];
  near->head[cell] = (uint32_t)near->count++;
  return true;
}

static void set_box(SporeNearTriangle *triangle, const Box *box) {
  for (size_t e = 0; e < 3; e++) {
    float lower = (float)box->lower[e], upper = (float)box->upper[e];
    triangle->lower[e] = lower > box->lower[e] ? nextafterf(lower, -HUGE_VALF) : lower;
    triangle->upper[e] = upper < box->upper[e] ? nextafterf(upper, HUGE_VALF) : upper;
  }
}

static bool box_meets(const Box *box, const SporeNearTriangle *triangle) {
  for (size_t e = 0; e < 3; e++)
    if (box->lower[e] > triangle->upper[e] || triangle->lower[e] > box->upper[e]) return false;
  return true;
}

void spore_shell_neighbours_drop(SporeShellNeighbours *near, const SporeShell *shell, uint32_t a, uint32_t b) {
  uint32_t corners[2];
  size_t count = spore_shell_between(shell, a, b, corners);
  for (size_t i = 0; i < count && i < 2; i++) near->triangles[corners[i] / 3].gone = true;
}

bool spore_shell_neighbours_add(SporeShellNeighbours *near, const SporeShell *shell, uint32_t triangle) {
  SporeVec3 p[3];
  size_t from[3], to[3];
  corners_of(shell, triangle, p);
  Box box = box_of(p);
  cells_of(near, &box, from, to);
  set_box(&near->triangles[triangle], &box);
  for (size_t x = from[0]; x <= to[0]; x++)
    for (size_t y = from[1]; y <= to[1]; y++)
      for (size_t z = from[2]; z <= to[2]; z++)
        if (!add_to_cell(near, (x * near->side + y) * near->side + z, triangle)) return false;
  return true;
}

static bool has(const uint32_t n[3], uint32_t vertex) { return n[0] == vertex || n[1] == vertex || n[2] == vertex; }

/* Whether an edge of one triangle intersects another triangle that has neither end of the edge. */
static bool edge_through(const uint32_t n[3], const SporeVec3 p[3], const uint32_t m[3], const SporeVec3 q[3]) {
  for (size_t k = 0; k < 3; k++) {
    size_t next = (k + 1) % 3;
    if (!has(m, n[k]) && !has(m, n[next]) && spore_vec3_crosses(p[k], p[next], q[0], q[1], q[2])) return true;
  }
  return false;
}

/* Triangles as they would be, looked at together. */
typedef struct Ring {
  const uint32_t *corner[MOST_RING];
  SporeVec3 p[MOST_RING][3];
  Box box[MOST_RING], whole;
  size_t count;
} Ring;

static void add_to_ring(Ring *ring, const uint32_t *corner, const SporeVec3 p[3]) {
  assert(ring->count < MOST_RING);
  const Box box = box_of(p);
  ring->corner[ring->count] = corner;
  memcpy(ring->p[ring->count], p, sizeof ring->p[0]);
  ring->box[ring->count] = box;
  if (ring->count++ == 0) ring->whole = box;
  for (size_t e = 0; e < 3; e++) {
    if (box.lower[e] < ring->whole.lower[e]) ring->whole.lower[e] = box.lower[e];
    if (box.upper[e] > ring->whole.upper[e]) ring->whole.upper[e] = box.upper[e];
  }
}

/* Whether a triangle of the shell intersects one of the ring. */
static bool meets_ring(const SporeShell *shell, const Ring *ring, uint32_t other) {
  const uint32_t *m = shell->corner + 3 * (size_t)other;
  SporeVec3 q[3];
  corners_of(shell, other, q);
  const Box its = box_of(q);
  if (!boxes_meet(&ring->whole, &its)) return false;
  for (size_t i = 0; i < ring->count; i++)
    if (boxes_meet(&ring->box[i], &its) &&
        (edge_through(ring->corner[i], ring->p[i], m, q) || edge_through(m, q, ring->corner[i], ring->p[i])))
      return true;
  return false;
}

/* Whether a triangle of the ring intersects any triangle that has neither a nor b. Empties the ring. */
static bool goes_through(SporeShellNeighbours *near, const SporeShell *shell, Ring *ring, uint32_t a, uint32_t b) {
  if (ring->count == 0) return false;
  size_t from[3], to[3];
  cells_of(near, &ring->whole, from, to);
  uint32_t first = near->asked + 1;
  for (size_t x = from[0]; x <= to[0]; x++)
    for (size_t y = from[1]; y <= to[1]; y++)
      for (size_t z = from[2]; z <= to[2]; z++) {
        near->asked++; /* in each cell, entries that occur twice or are removed triangles are taken out */
        uint32_t *link = &near->head[(x * near->side + y) * near->side + z];
        while (*link != NONE) {
          uint32_t other = near->entries[2 * (size_t)*link], *next = &near->entries[2 * (size_t)*link + 1];
          SporeNearTriangle *triangle = &near->triangles[other];
          bool met = triangle->seen >= first;
          if (triangle->seen == near->asked || triangle->gone) {
            *link = *next;
            continue;
          }
          link = next;
          triangle->seen = near->asked;
          if (met || !box_meets(&ring->whole, triangle)) continue;
          const uint32_t *m = shell->corner + 3 * (size_t)other;
          if (!has(m, a) && !has(m, b) && meets_ring(shell, ring, other)) return true;
        }
      }
  ring->count = 0;
  return false;
}

/* Adds the triangles around a vertex as they are with the vertex at x; those that also have `except` are left out.
 * True: the ring was full, and what it held intersects others. */
static bool add_around(SporeShellNeighbours *near, const SporeShell *shell, Ring *ring, uint32_t vertex, SporeVec3 x,
                       uint32_t except) {
  for (uint32_t c = shell->head[vertex]; c != SPORE_SHELL_NONE; c = shell->next[c]) {
    const uint32_t *n = shell->corner + 3 * (size_t)(c / 3);
    if (has(n, except)) continue;
    SporeVec3 p[3];
    corners_of(shell, c / 3, p);
    p[c % 3] = x;
    if (ring->count == MOST_RING && goes_through(near, shell, ring, vertex, except)) return true;
    add_to_ring(ring, n, p);
  }
  return false;
}

/* Whether the triangles around a vertex intersect others when the vertex is at x. */
static bool ring_goes_through(SporeShellNeighbours *near, const SporeShell *shell, uint32_t vertex, SporeVec3 x) {
  Ring ring;
  ring.count = 0;
  return add_around(near, shell, &ring, vertex, x, SPORE_SHELL_NONE) ||
         goes_through(near, shell, &ring, vertex, SPORE_SHELL_NONE);
}

bool spore_shell_would_cross(SporeShellNeighbours *near, const SporeShell *shell, uint32_t a, uint32_t b, SporeVec3 x) {
  Ring ring;
  ring.count = 0;
  if (!add_around(near, shell, &ring, a, x, b) && !add_around(near, shell, &ring, b, x, a) &&
      !goes_through(near, shell, &ring, a, b))
    return false;
  return !ring_goes_through(near, shell, a, spore_shell_at(shell, a)) &&
         !ring_goes_through(near, shell, b, spore_shell_at(shell, b));
}

bool spore_shell_move_crosses(SporeShellNeighbours *near, const SporeShell *shell, uint32_t vertex, SporeVec3 x) {
  return ring_goes_through(near, shell, vertex, x) &&
         !ring_goes_through(near, shell, vertex, spore_shell_at(shell, vertex));
}

bool spore_shell_triangle_crosses(SporeShellNeighbours *near, const SporeShell *shell, const uint32_t corner[3]) {
  Ring ring;
  SporeVec3 p[3];
  for (size_t k = 0; k < 3; k++) p[k] = spore_shell_at(shell, corner[k]);
  ring.count = 0;
  add_to_ring(&ring, corner, p);
  return goes_through(near, shell, &ring, SPORE_SHELL_NONE, SPORE_SHELL_NONE);
}

bool spore_shell_neighbours_add_ring(SporeShellNeighbours *near, const SporeShell *shell, uint32_t vertex) {
  for (uint32_t c = shell->head[vertex]; c != SPORE_SHELL_NONE; c = shell->next[c])
    if (!spore_shell_neighbours_add(near, shell, c / 3)) return false;
  return true;
}
