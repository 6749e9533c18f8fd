/* Finds pairs of triangles of one surface that intersect. */
#include "core/mesh/crossings.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/common.h"
#include "core/mesh/sort.h"

/* Boxes of triangles, sorted by their lower ends along the longest side of the mesh. */
typedef struct Sweep {
  const SporeTriangleMesh *mesh;
  size_t axis;
  uint64_t *key;
  uint32_t *order;
  double *box; /* of each triangle: lower, upper, 3 each */
} Sweep;

static SporeVec3 corner(const Sweep *sweep, uint32_t triangle, size_t k) {
  return spore_mesh_vertex(sweep->mesh->vertices, sweep->mesh->triangles[3 * (size_t)triangle + k]);
}

static void set_box(Sweep *sweep, uint32_t triangle) {
  double *box = sweep->box + 6 * (size_t)triangle;
  for (size_t k = 0; k < 3; k++) {
    double x[3];
    spore_vec3_store(x, corner(sweep, triangle, k));
    for (size_t e = 0; e < 3; e++) {
      box[e] = k ? fmin(box[e], x[e]) : x[e];
      box[3 + e] = k ? fmax(box[3 + e], x[e]) : x[e];
    }
  }
}

static bool prepare(Sweep *sweep) {
  size_t count = sweep->mesh->triangle_count;
  double lower[3], upper[3];
  sweep->key = SPORE_NEW_ARRAY(uint64_t, count);
  sweep->order = SPORE_NEW_ARRAY(uint32_t, count);
  sweep->box = SPORE_NEW_ARRAY(double, 6 * count);
  if (!sweep->key || !sweep->order || !sweep->box) return false;
  spore_mesh_bounds(sweep->mesh->vertices, sweep->mesh->vertex_count, 3, lower, upper);
  for (size_t e = 1; e < 3; e++)
    if (upper[e] - lower[e] > upper[sweep->axis] - lower[sweep->axis]) sweep->axis = e;
  for (uint32_t t = 0; t < count; t++) {
    set_box(sweep, t);
    double from = sweep->box[6 * (size_t)t + sweep->axis] - lower[sweep->axis];
    memcpy(&sweep->key[t], &from, sizeof from); /* doubles that are not negative have the order of their bits */
    sweep->order[t] = t;
  }
  return spore_sort_keys(sweep->key, sweep->order, count);
}

static bool boxes_meet(const double *a, const double *b) {
  for (size_t e = 0; e < 3; e++)
    if (a[e] > b[3 + e] || b[e] > a[3 + e]) return false;
  return true;
}

/* Whether an edge of `one` that shares no corner with `other` intersects `other`. */
static bool goes_through(const Sweep *sweep, uint32_t one, uint32_t other) {
  const uint32_t *n = sweep->mesh->triangles + 3 * (size_t)one, *m = sweep->mesh->triangles + 3 * (size_t)other;
  bool shared[3];
  for (size_t k = 0; k < 3; k++) shared[k] = n[k] == m[0] || n[k] == m[1] || n[k] == m[2];
  for (size_t k = 0; k < 3; k++) {
    size_t next = (k + 1) % 3;
    if (!shared[k] && !shared[next] &&
        spore_vec3_crosses(corner(sweep, one, k), corner(sweep, one, next), corner(sweep, other, 0),
                           corner(sweep, other, 1), corner(sweep, other, 2)))
      return true;
  }
  return false;
}

bool spore_triangle_mesh_crossings(const SporeTriangleMesh *mesh, size_t *count, bool *crossing) {
  Sweep sweep = {.mesh = mesh};
  bool made = prepare(&sweep);
  *count = 0;
  if (crossing) memset(crossing, 0, mesh->triangle_count * sizeof *crossing);
  for (size_t i = 0; made && i < mesh->triangle_count; i++) {
    uint32_t one = sweep.order[i];
    const double *box = sweep.box + 6 * (size_t)one;
    for (size_t j = i + 1; j < mesh->triangle_count; j++) {
      uint32_t other = sweep.order[j];
      const double *its = sweep.box + 6 * (size_t)other;
      if (its[sweep.axis] > box[3 + sweep.axis]) break;
      if (!boxes_meet(box, its) || (!goes_through(&sweep, one, other) && !goes_through(&sweep, other, one))) continue;
      (*count)++;
      if (crossing) crossing[one] = crossing[other] = true;
    }
  }
  spore_free(sweep.key);
  spore_free(sweep.order);
  spore_free(sweep.box);
  return made;
}
