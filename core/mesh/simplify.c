/* Simplifies a surface by collapsing edges, the cheapest first. */
#include "core/mesh/simplify.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/math/mat3.h"
#include "core/mesh/bvh.h"
#include "core/mesh/common.h"
#include "core/mesh/simplify_parts.h"

#define ATTRACTION 1e-4 /* weight of the squared distance from the edge's midpoint when a point is placed */
#define LENGTH 1e-4     /* weight of an edge's squared length in its cost; without it, flat parts would get slivers */
#define LINE_WEIGHT 10  /* weight of a plane along a feature edge, relative to the planes of triangles */
#define LEAST_QUALITY 0.002 /* least quality of a triangle after a collapse, unless its quality was lower before */
#define GOOD_QUALITY 0.4    /* below it, a collapse costs more */
#define SMALL 0.05          /* of the wanted edge length: smaller features are ignored */
#define LIKELY 0.2          /* estimated share of the vertices that remain under a limit */
#define STEPS_A_REPORT 1024 /* collapses */

typedef struct Candidate {
  double cost;
  uint32_t a, b, stamp; /* stamp: sum of both vertices' when it was made; another: it is out of date */
  bool put_off;
} Candidate;

typedef struct Collapser {
  SporeShell *shell;
  SporeQuadric *quadric;
  uint32_t *stamp;
  Candidate *heap;
  size_t count, capacity;
  double edge; /* length wanted */
  SporeShellNeighbours near;
  SporeShellLimit limit; /* its limit NULL: there is no limit */
  bool crossing;         /* intersections are allowed */
} Collapser;

/* Quadrics. */

static void add_plane(SporeQuadric *quadric, SporeVec3 normal, SporeVec3 on, double weight) {
  double offset = -spore_vec3_dot(normal, on);
  quadric->a = spore_mat3_add(quadric->a, spore_mat3_scale(weight, spore_mat3_outer(normal, normal)));
  quadric->b = spore_vec3_add_scaled(quadric->b, weight * offset, normal);
  quadric->c += weight * offset * offset;
}

static SporeQuadric sum_of(const SporeQuadric *one, const SporeQuadric *other) {
  return (SporeQuadric){spore_mat3_add(one->a, other->a), spore_vec3_add(one->b, other->b), one->c + other->c,
                        one->weight + other->weight};
}

/* The plane through a feature edge across its triangle. */
static void add_line(Collapser *work, uint32_t corner, SporeVec3 normal) {
  const SporeShell *shell = work->shell;
  uint32_t ends[2] = {shell->corner[corner], shell->corner[spore_shell_after(corner)]};
  SporeVec3 from = spore_shell_at(shell, ends[0]), side = spore_vec3_sub(spore_shell_at(shell, ends[1]), from);
  SporeVec3 across = spore_vec3_normalise(spore_vec3_cross(side, normal), spore_vec3(0, 0, 0));
  for (int e = 0; e < 2; e++)
    add_plane(&work->quadric[ends[e]], across, from, LINE_WEIGHT * spore_vec3_dot(side, side));
}

/* The area of all triangles. */
static double make_quadrics(Collapser *work) {
  double all = 0;
  const SporeShell *shell = work->shell;
  memset(work->quadric, 0, shell->vertex_count * sizeof *work->quadric);
  for (uint32_t t = 0; t < shell->triangle_count; t++) {
    const uint32_t *n = shell->corner + 3 * (size_t)t;
    if (n[0] == SPORE_SHELL_NONE) continue;
    SporeVec3 twice = spore_shell_normal(shell, t), normal = spore_vec3_normalise(twice, spore_vec3(0, 0, 0));
    double area = 0.5 * spore_vec3_length(twice);
    all += area;
    for (uint32_t k = 0; k < 3; k++) {
      add_plane(&work->quadric[n[k]], normal, spore_shell_at(shell, n[0]), area);
      work->quadric[n[k]].weight += area;
      if (shell->feature[3 * t + k]) add_line(work, 3 * t + k, normal);
    }
  }
  return all;
}

/* Adds the triangles at a vertex that lack `except`: 2 area n and 6 times the volume to the origin. */
static void add_star(const SporeShell *shell, uint32_t vertex, uint32_t except, SporeVec3 *normal, double *volume) {
  SporeVec3 at = spore_shell_at(shell, vertex);
  for (uint32_t c = shell->head[vertex]; c != SPORE_SHELL_NONE; c = shell->next[c]) {
    uint32_t n[2] = {shell->corner[spore_shell_after(c)], shell->corner[spore_shell_before(c)]};
    if (n[0] == except || n[1] == except) continue;
    SporeVec3 p = spore_shell_at(shell, n[0]), q = spore_shell_at(shell, n[1]);
    *normal = spore_vec3_add(*normal, spore_vec3_cross(spore_vec3_sub(p, at), spore_vec3_sub(q, at)));
    *volume += spore_vec3_dot(at, spore_vec3_cross(p, q));
  }
}

/* Moves the optimal place to the plane in which the volume below the surface does not change (Lindstrom and Turk 1998).
 */
static void keep_volume(const SporeShell *shell, uint32_t a, uint32_t b, const SporeMat3 *inverse, SporeVec3 *x) {
  SporeVec3 normal = {0, 0, 0};
  double volume = 0;
  add_star(shell, a, SPORE_SHELL_NONE, &normal, &volume);
  add_star(shell, b, a, &normal, &volume);
  SporeVec3 along = spore_mat3_apply(*inverse, normal);
  double stiff = spore_vec3_dot(normal, along);
  if (stiff > 0) *x = spore_vec3_add_scaled(*x, (volume - spore_vec3_dot(normal, *x)) / stiff, along);
}

/* The place of the collapsed vertex; false: the edge must not be collapsed. */
static bool place(const Collapser *work, uint32_t a, uint32_t b, const SporeQuadric *both, SporeVec3 *x) {
  const SporeShell *shell = work->shell;
  SporeVec3 from = spore_shell_at(shell, a), to = spore_shell_at(shell, b);
  bool lined = shell->kind[b] == SPORE_SHELL_LINE && spore_shell_is_feature(shell, a, b);
  bool small = spore_vec3_distance(from, to) < SMALL * work->edge;
  if (shell->kind[b] != SPORE_SHELL_SMOOTH && !lined && !small) return false;
  if (shell->kind[a] > shell->kind[b] ||
      (shell->kind[b] != SPORE_SHELL_SMOOTH && !lined)) { /* the vertex that may move less stays */
    *x = from;
    return true;
  }
  SporeVec3 middle = spore_vec3_scale(0.5, spore_vec3_add(from, to));
  double pull = ATTRACTION * both->weight;
  SporeMat3 matrix = both->a, inverse;
  for (int k = 0; k < 3; k++) matrix.m[4 * k] += pull;
  SporeVec3 right = spore_vec3_sub(spore_vec3_scale(pull, middle), both->b);
  *x = middle;
  if (spore_mat3_invert(matrix, &inverse)) {
    *x = spore_mat3_apply(inverse, right);
    if (shell->kind[a] == SPORE_SHELL_SMOOTH) keep_volume(shell, a, b, &inverse, x);
  }
  if (spore_vec3_distance(*x, middle) > spore_vec3_distance(from, to)) *x = middle;
  return true;
}

/* The heap: cheapest first. */

static bool is_before(const Candidate *one, const Candidate *other) {
  if (one->cost != other->cost) return one->cost < other->cost;
  return one->a != other->a ? one->a < other->a : one->b < other->b;
}

static bool push(Collapser *work, Candidate candidate) {
  Candidate *heap = spore_room_for_one(work->heap, work->count, &work->capacity, 64, sizeof *heap);
  if (!heap) return false;
  work->heap = heap;
  size_t at = work->count++;
  for (; at > 0 && is_before(&candidate, &work->heap[(at - 1) / 2]); at = (at - 1) / 2)
    work->heap[at] = work->heap[(at - 1) / 2];
  work->heap[at] = candidate;
  return true;
}

static Candidate pop(Collapser *work) {
  assert(work->count > 0);
  Candidate first = work->heap[0], last = work->heap[--work->count];
  size_t at = 0;
  for (size_t child; (child = 2 * at + 1) < work->count; at = child) {
    if (child + 1 < work->count && is_before(&work->heap[child + 1], &work->heap[child])) child++;
    if (!is_before(&work->heap[child], &last)) break;
    work->heap[at] = work->heap[child];
  }
  work->heap[at] = last;
  return first;
}

/* Adds the edge to the heap. The vertex that may move less is a; it stays in the lists. */
static bool consider(Collapser *work, uint32_t a, uint32_t b) {
  const SporeShell *shell = work->shell;
  if (shell->kind[a] < shell->kind[b] || (shell->kind[a] == shell->kind[b] && a > b)) {
    uint32_t swap = a;
    a = b, b = swap;
  }
  SporeQuadric both = sum_of(&work->quadric[a], &work->quadric[b]);
  SporeVec3 x, side = spore_vec3_sub(spore_shell_at(shell, a), spore_shell_at(shell, b));
  if (!place(work, a, b, &both, &x)) return true;
  double cost = spore_quadric_at(&both, x) + LENGTH * both.weight * spore_vec3_dot(side, side);
  return push(work, (Candidate){cost, a, b, work->stamp[a] + work->stamp[b], false});
}

static bool consider_around(Collapser *work, uint32_t a, bool all) {
  SporeShell *shell = work->shell;
  uint32_t done = ++shell->marked;
  for (uint32_t c = shell->head[a]; c != SPORE_SHELL_NONE; c = shell->next[c]) {
    uint32_t ends[2] = {shell->corner[spore_shell_after(c)], shell->corner[spore_shell_before(c)]};
    for (int e = 0; e < 2; e++) {
      if (shell->mark[ends[e]] == done || (!all && ends[e] < a)) continue;
      shell->mark[ends[e]] = done;
      if (!consider(work, a, ends[e])) return false;
    }
  }
  return true;
}

/* Whether the triangles at a vertex do not close around it. Then its first and last neighbours occur once, not twice.
 */
static bool is_open(const SporeShell *shell, uint32_t vertex) {
  uint32_t unpaired = 0;
  for (uint32_t c = shell->head[vertex]; c != SPORE_SHELL_NONE; c = shell->next[c])
    unpaired ^= shell->corner[spore_shell_after(c)] ^ shell->corner[spore_shell_before(c)];
  return unpaired != 0;
}

/* Whether a collapse keeps the topology: the common neighbours of both vertices are exactly the corners of the
 * triangles at their edge, and none of them loses its connection. */
static bool keeps_shape(SporeShell *shell, uint32_t a, uint32_t b) {
  uint32_t corners[2], near_a = spore_shell_mark(shell, a), common = 0;
  size_t count = spore_shell_between(shell, a, b, corners);
  if (count == 0 || count > 2) return false;
  uint32_t seen = ++shell->marked;
  for (uint32_t c = shell->head[b]; c != SPORE_SHELL_NONE; c = shell->next[c]) {
    uint32_t ends[2] = {shell->corner[spore_shell_after(c)], shell->corner[spore_shell_before(c)]};
    for (int e = 0; e < 2; e++) {
      common += shell->mark[ends[e]] == near_a;
      shell->mark[ends[e]] = seen;
    }
  }
  if (common != count) return false;
  for (size_t i = 0; i < count; i++) {
    const uint32_t *n = shell->corner + 3 * (size_t)(corners[i] / 3);
    uint32_t c = n[0] ^ n[1] ^ n[2] ^ a ^ b;
    if (spore_shell_count(shell, c) <= (is_open(shell, c) ? 1 : 3)) return false;
  }
  return true;
}

/* Collapses an edge. A collapse that would make narrow triangles is postponed until all other collapses cost as much.
 * False: no memory. */
static bool collapse(Collapser *work, const Candidate *candidate) {
  assert(candidate->a != candidate->b);
  SporeShell *shell = work->shell;
  uint32_t a = candidate->a, b = candidate->b;
  SporeQuadric both = sum_of(&work->quadric[a], &work->quadric[b]);
  SporeVec3 x;
  if (!place(work, a, b, &both, &x) || !keeps_shape(shell, a, b)) return true;
  double quality = fmin(spore_shell_moved_quality(shell, a, x, b), spore_shell_moved_quality(shell, b, x, a));
  if (quality < LEAST_QUALITY) return true;
  if (quality < GOOD_QUALITY && !candidate->put_off) {
    Candidate later = *candidate;
    later.put_off = true;
    later.cost *= pow(GOOD_QUALITY / quality, 3);
    return push(work, later);
  }
  if (work->limit.limit && !spore_shell_limit_allows(&work->limit, shell, a, b, x)) return true;
  if (!work->crossing && spore_shell_would_cross(&work->near, shell, a, b, x)) return true;
  if (!work->crossing) spore_shell_neighbours_drop(&work->near, shell, a, b);
  spore_shell_collapse(shell, a, b, x);
  if (work->limit.limit) spore_shell_limit_moved(&work->limit, shell, a);
  if (!work->crossing && !spore_shell_neighbours_add_ring(&work->near, shell, a)) return false;
  work->quadric[a] = both;
  work->stamp[a]++;
  work->stamp[b]++;
  return consider_around(work, a, true);
}

static bool collapse_to(Collapser *work, size_t vertices, const SporeProgress *progress, SporeError *error) {
  size_t from = work->shell->live, step = 0;
  work->count = 0;
  for (uint32_t i = 0; i < work->shell->vertex_count; i++)
    if (!consider_around(work, i, false)) return spore_mesh_no_memory(error);
  while (work->count > 0 && work->shell->live > vertices) {
    Candidate next = pop(work);
    if (next.stamp != work->stamp[next.a] + work->stamp[next.b]) continue;
    if (!collapse(work, &next)) return spore_mesh_no_memory(error);
    if (step++ % STEPS_A_REPORT == 0 &&
        !spore_progress_step(progress, 0.5 * (double)(from - work->shell->live) / (double)(from - vertices),
                             _("collapsing edges"), error))
      return false;
  }
  return true;
}

bool spore_shell_collapse_to(SporeShell *shell, size_t vertices, const SporeSurfaceLimit *limit,
                             const SporeProgress *progress, SporeError *error) {
  Collapser work = {.shell = shell,
                    .quadric = SPORE_NEW_ARRAY(SporeQuadric, shell->vertex_count),
                    .stamp = SPORE_NEW_ARRAY(uint32_t, shell->vertex_count)};
  bool done = (work.quadric && work.stamp && (!limit || spore_shell_limit_create(&work.limit, shell, limit))) ||
              spore_mesh_no_memory(error);
  double likely = limit ? LIKELY * (double)shell->live : (double)vertices;
  if (done) work.edge = sqrt(make_quadrics(&work) / (sqrt(3) / 2 * likely));
  /* The size of the grid's cells lies between the present and the final size of the triangles. */
  double cell = work.edge * pow(likely / (double)(shell->live + 1), 0.25);
  if (done && shell->live > vertices) {
    done = spore_shell_neighbours_create(&work.near, shell, cell) || spore_mesh_no_memory(error);
    done = done && collapse_to(&work, vertices, progress, error);
    work.crossing = true; /* the number of vertices is reached even at the price of intersections */
    done = done && (limit || shell->live <= vertices || collapse_to(&work, vertices, progress, error));
    spore_shell_neighbours_clear(&work.near);
  }
  done = done &&
         (limit || spore_shell_neighbours_create(&work.near, shell, work.edge) || spore_mesh_no_memory(error)) &&
         (limit || spore_shell_improve(shell, work.quadric, &work.near, progress, error));
  spore_shell_neighbours_clear(&work.near);
  spore_shell_limit_clear(&work.limit);
  spore_free(work.quadric);
  spore_free(work.stamp);
  spore_free(work.heap);
  return done;
}
