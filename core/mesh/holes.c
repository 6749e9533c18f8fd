/* Filling the holes of a surface. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/mesh/common.h"
#include "core/mesh/edit.h"
#include "core/mesh/half_edges.h"

#define EXACT_EDGES 300 /* the work grows with the cube of this number */
/* Weight of the squared sides, added to the area: of two fillings of about the same area, the one with rounder
 * triangles is chosen. */
#define ROUNDNESS 1e-3

typedef struct Filling {
  SporeTriangleMesh *mesh;
  SporeHalfEdges halves;
  uint32_t *twin;   /* half-edge across an edge of two triangles of the same orientation; else NONE, or OPEN where there
                       is one triangle */
  bool *seen;       /* of each half-edge: whether it is in a loop already */
  uint32_t *loop;   /* corners of the present loop, in the order of its filling */
  double *cost;     /* EXACT_EDGES squared */
  uint16_t *middle; /* EXACT_EDGES squared */
  uint32_t *added;  /* corners of new triangles */
  size_t added_count;
} Filling;

#define NONE UINT32_MAX
#define OPEN (UINT32_MAX - 1)

static void find_twins(Filling *f) {
  const uint32_t *half = f->halves.half;
  memset(f->twin, 0xff, 3 * f->mesh->triangle_count * sizeof *f->twin);
  for (size_t i = 0, end; i < f->halves.count; i = end) {
    end = spore_half_edges_end(&f->halves, i);
    if (end - i == 1) f->twin[half[i]] = OPEN;
    if (end - i != 2 || spore_half_edge_ascends(f->mesh->triangles, half[i]) ==
                            spore_half_edge_ascends(f->mesh->triangles, half[i + 1]))
      continue;
    f->twin[half[i]] = half[i + 1];
    f->twin[half[i + 1]] = half[i];
  }
}

/* The open half-edge that starts where `half` ends, found around that corner. NONE: other triangles are in the way. */
static uint32_t next_open(const Filling *f, uint32_t half) {
  uint32_t at = spore_half_edge_after(half);
  for (size_t turns = 0; turns < f->halves.count; turns++) {
    if (f->twin[at] == OPEN) return at;
    if (f->twin[at] == NONE) return NONE;
    at = spore_half_edge_after(f->twin[at]);
  }
  return NONE;
}

/* Walks the loop of open half-edges through `first`. The corners are left in f->loop, in the order of the filling.
 * Returns their number; 0: the loop does not close. */
static size_t walk(Filling *f, uint32_t first) {
  size_t count = 0;
  uint32_t at = first;
  do {
    f->seen[at] = true;
    f->loop[count++] = f->mesh->triangles[at];
    at = next_open(f, at);
    if (at == NONE || (at != first && f->seen[at])) return 0;
  } while (at != first);
  for (size_t i = 0; i < count / 2; i++) {
    uint32_t swap = f->loop[i];
    f->loop[i] = f->loop[count - 1 - i];
    f->loop[count - 1 - i] = swap;
  }
  return count;
}

/* Whether a diagonal of the loop may be an edge of the filling. */
static bool may_cut(const Filling *f, uint32_t a, uint32_t b) {
  return a != b && !spore_half_edges_have(&f->halves, a, b);
}

static double triangle_cost(const Filling *f, uint32_t a, uint32_t b, uint32_t c) {
  assert(a != b && b != c && c != a);
  SporeVec3 p = spore_mesh_vertex(f->mesh->vertices, a), q = spore_mesh_vertex(f->mesh->vertices, b),
            r = spore_mesh_vertex(f->mesh->vertices, c);
  SporeVec3 u = spore_vec3_sub(q, p), v = spore_vec3_sub(r, q), w = spore_vec3_sub(p, r);
  return spore_vec3_length(spore_mesh_area_vector(p, q, r)) +
         ROUNDNESS * (spore_vec3_dot(u, u) + spore_vec3_dot(v, v) + spore_vec3_dot(w, w));
}

static void add_triangle(Filling *f, uint32_t a, uint32_t b, uint32_t c) {
  uint32_t *to = f->added + 3 * f->added_count++;
  to[0] = a, to[1] = b, to[2] = c;
}

/* Cuts one corner off the loop of `count` corners; false: no corner can be cut off. */
static bool cut_corner(Filling *f, size_t count) {
  size_t best = count;
  double least = HUGE_VAL;
  for (size_t i = 0; i < count; i++) {
    uint32_t before = f->loop[(i + count - 1) % count], after = f->loop[(i + 1) % count];
    double length =
        spore_vec3_distance(spore_mesh_vertex(f->mesh->vertices, before), spore_mesh_vertex(f->mesh->vertices, after));
    if (length >= least || !may_cut(f, before, after)) continue;
    least = length;
    best = i;
  }
  if (best == count) return false;
  add_triangle(f, f->loop[(best + count - 1) % count], f->loop[best], f->loop[(best + 1) % count]);
  memmove(f->loop + best, f->loop + best + 1, (count - 1 - best) * sizeof *f->loop);
  return true;
}

/* Adds the triangles of the sub-loop from corner i to corner k. Its cost is computed already. */
static void add_exact(Filling *f, size_t n, size_t i, size_t k) {
  while (k - i >= 2) {
    size_t j = f->middle[i * n + k];
    add_triangle(f, f->loop[i], f->loop[j], f->loop[k]);
    add_exact(f, n, i, j);
    i = j;
  }
}

/* Least cost of all sub-loops, from short to long. */
static bool fill_exactly(Filling *f, size_t n) {
  for (size_t i = 0; i + 1 < n; i++) f->cost[i * n + i + 1] = 0;
  for (size_t span = 2; span < n; span++)
    for (size_t i = 0; i + span < n; i++) {
      size_t k = i + span;
      double least = HUGE_VAL;
      bool whole = span == n - 1; /* its closing side is an edge of the hole */
      for (size_t j = i + 1; j < k && (whole || may_cut(f, f->loop[i], f->loop[k])); j++) {
        double cost = f->cost[i * n + j] + f->cost[j * n + k];
        if (cost >= least) continue;
        cost += triangle_cost(f, f->loop[i], f->loop[j], f->loop[k]);
        if (cost >= least) continue;
        least = cost;
        f->middle[i * n + k] = (uint16_t)j;
      }
      f->cost[i * n + k] = least;
    }
  if (!(f->cost[n - 1] < HUGE_VAL)) return false;
  add_exact(f, n, 0, n - 1);
  return true;
}

static void fill(Filling *f, size_t count) {
  size_t added = f->added_count;
  bool done = true;
  while (done && count > EXACT_EDGES) done = cut_corner(f, count--);
  if (!done || !fill_exactly(f, count)) f->added_count = added;
}

static bool fill_all(Filling *f, size_t most_edges, const SporeProgress *progress, SporeError *error) {
  for (size_t i = 0; i < f->halves.count; i++) {
    uint32_t half = f->halves.half[i];
    if (f->twin[half] != OPEN || f->seen[half]) continue;
    if (!spore_progress_step(progress, (double)i / (double)f->halves.count, _("filling holes"), error)) return false;
    size_t count = walk(f, half);
    if (count >= 3 && (most_edges == 0 || count <= most_edges)) fill(f, count);
  }
  return true;
}

static bool take_added(Filling *f, SporeError *error) {
  SporeTriangleMesh more = {.triangle_count = f->added_count, .triangles = f->added};
  SporeTriangleMesh *mesh = f->mesh;
  if (mesh->triangle_count + more.triangle_count > SPORE_MESH_MAXIMUM)
    return spore_mesh_too_large(error, mesh->triangle_count + more.triangle_count);
  uint32_t *grown = spore_reallocate(mesh->triangles, 3 * mesh->triangle_count,
                                     3 * (mesh->triangle_count + more.triangle_count), sizeof *grown);
  if (!grown) return spore_mesh_no_memory(error);
  memcpy(grown + 3 * mesh->triangle_count, more.triangles, 3 * more.triangle_count * sizeof *grown);
  mesh->triangles = grown;
  mesh->triangle_count += more.triangle_count;
  return true;
}

bool spore_triangle_mesh_fill_holes(SporeTriangleMesh *mesh, size_t most_edges, const SporeProgress *progress,
                                    SporeError *error) {
  size_t sides = 3 * mesh->triangle_count;
  Filling f = {.mesh = mesh,
               .twin = SPORE_NEW_ARRAY(uint32_t, sides),
               .seen = SPORE_NEW_ARRAY(bool, sides),
               .loop = SPORE_NEW_ARRAY(uint32_t, sides),
               .cost = SPORE_NEW_ARRAY(double, EXACT_EDGES *EXACT_EDGES),
               .middle = SPORE_NEW_ARRAY(uint16_t, EXACT_EDGES * EXACT_EDGES),
               .added = SPORE_NEW_ARRAY(uint32_t, 3 * sides)}; /* a loop of n is filled by n - 2 */
  bool ready = f.twin && f.seen && f.loop && f.cost && f.middle && f.added &&
               spore_half_edges_create(&f.halves, mesh->triangles, mesh->triangle_count);
  bool done = ready || spore_mesh_no_memory(error);
  if (ready) {
    find_twins(&f);
    done = fill_all(&f, most_edges, progress, error) && (f.added_count == 0 || take_added(&f, error));
    spore_half_edges_clear(&f.halves);
  }
  spore_free(f.twin);
  spore_free(f.seen);
  spore_free(f.loop);
  spore_free(f.cost);
  spore_free(f.middle);
  spore_free(f.added);
  return done;
}
