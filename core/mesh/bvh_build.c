/* Building a bounding volume hierarchy over triangles, with the moments for winding numbers. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/mesh/bvh_node.h"
#include "core/mesh/common.h"

#define BINS 16
#define HALVING_DEPTH 48 /* deeper nodes are split in the middle of the list, which bounds the depth */
#define FAR_FACTOR 2.2   /* from a distance of so many radii a node is replaced by its moments */

typedef struct Box {
  double lower[3], upper[3];
} Box;

typedef struct Builder {
  SporeBvh *bvh;
  const SporeTriangleMesh *mesh;
  Box *boxes;     /* of each triangle */
  double *centre; /* triangle_count x 3: middle of the box */
} Builder;

static Box empty_box(void) { return (Box){{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}}; }
static void box_add(Box *box, const Box *other) {
  for (int k = 0; k < 3; k++) {
    box->lower[k] = other->lower[k] < box->lower[k] ? other->lower[k] : box->lower[k];
    box->upper[k] = other->upper[k] > box->upper[k] ? other->upper[k] : box->upper[k];
  }
}
static double box_half_area(const Box *box) {
  double x = box->upper[0] - box->lower[0], y = box->upper[1] - box->lower[1], z = box->upper[2] - box->lower[2];
  return x < 0 ? 0 : x * y + y * z + z * x;
}

static int longest_axis(const double extent[3]) {
  return extent[0] >= extent[1] ? (extent[0] >= extent[2] ? 0 : 2) : (extent[1] >= extent[2] ? 1 : 2);
}

/* Position of the best split plane by the surface area heuristic over BINS bins of the centres; false: no use. */
static int best_bin(const Builder *b, size_t first, size_t count, int axis, double low, double scale) {
  Box bins[BINS], right[BINS];
  size_t held[BINS] = {0};
  for (int i = 0; i < BINS; i++) bins[i] = empty_box();
  for (size_t i = first; i < first + count; i++) {
    uint32_t t = b->bvh->triangles[i];
    int bin = (int)((b->centre[3 * (size_t)t + axis] - low) * scale);
    bin = bin < BINS ? bin : BINS - 1;
    held[bin]++;
    box_add(&bins[bin], &b->boxes[t]);
  }
  right[BINS - 1] = bins[BINS - 1];
  for (int i = BINS - 2; i > 0; i--) {
    right[i] = right[i + 1];
    box_add(&right[i], &bins[i]);
  }
  Box left = empty_box();
  size_t left_count = 0;
  int best = 0;
  double best_cost = HUGE_VAL;
  for (int i = 1; i < BINS; i++) {
    box_add(&left, &bins[i - 1]);
    left_count += held[i - 1];
    double cost = box_half_area(&left) * (double)left_count + box_half_area(&right[i]) * (double)(count - left_count);
    if (left_count && left_count < count && cost < best_cost) best_cost = cost, best = i;
  }
  return best;
}

/* Divides the triangles first .. first + count - 1 into two groups; returns the size n of the left group, 0 < n <
 * count. */
static size_t part(const Builder *b, size_t first, size_t count, int depth) {
  assert(count > 1 && depth >= 0);
  uint32_t *list = b->bvh->triangles + first;
  double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, extent[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (size_t i = 0; i < count; i++)
    for (int k = 0; k < 3; k++) {
      double x = b->centre[3 * (size_t)list[i] + k];
      low[k] = x < low[k] ? x : low[k];
      extent[k] = x > extent[k] ? x : extent[k];
    }
  for (int k = 0; k < 3; k++) extent[k] -= low[k];
  int axis = longest_axis(extent);
  double scale = BINS / extent[axis];
  if (depth >= HALVING_DEPTH || !isfinite(scale)) return count / 2;
  int split = best_bin(b, first, count, axis, low[axis], scale);
  if (!split) return count / 2;
  size_t left = 0;
  for (size_t i = 0; i < count; i++) {
    int bin = (int)((b->centre[3 * (size_t)list[i] + axis] - low[axis]) * scale);
    if ((bin < BINS ? bin : BINS - 1) >= split) continue;
    uint32_t swap = list[left];
    list[left++] = list[i];
    list[i] = swap;
  }
  return left;
}

static void build_node(Builder *b, size_t first, size_t count, int depth) {
  assert(count > 0);
  size_t index = b->bvh->node_count++;
  Box box = empty_box();
  for (size_t i = first; i < first + count; i++) box_add(&box, &b->boxes[b->bvh->triangles[i]]);
  SporeBvhNode *node = b->bvh->nodes + index;
  memcpy(node->lower, box.lower, sizeof box.lower);
  memcpy(node->upper, box.upper, sizeof box.upper);
  node->first = (uint32_t)first;
  node->count = (uint32_t)count;
  if (count <= SPORE_BVH_LEAF) return;
  size_t left = part(b, first, count, depth);
  node->count = 0;
  build_node(b, first, left, depth + 1);
  node->first = (uint32_t)b->bvh->node_count;
  build_node(b, first + left, count - left, depth + 1);
}

static void copy_corners(const Builder *b) {
  for (size_t i = 0; i < b->bvh->triangle_count; i++)
    for (size_t k = 0; k < 3; k++)
      memcpy(b->bvh->corners + 9 * i + 3 * k,
             b->mesh->vertices + 3 * (size_t)b->mesh->triangles[3 * (size_t)b->bvh->triangles[i] + k],
             3 * sizeof(double));
}

static void add_first_moment(double first[9], SporeVec3 position, SporeVec3 area) {
  double x[3], n[3];
  spore_vec3_store(x, position);
  spore_vec3_store(n, area);
  for (int r = 0; r < 3; r++)
    for (int s = 0; s < 3; s++) first[3 * r + s] += x[r] * n[s];
}

static SporeVec3 weighted_centre(double weight_a, SporeVec3 a, double weight_b, SporeVec3 b) {
  double share = weight_a + weight_b > 0 ? weight_b / (weight_a + weight_b) : 0.5;
  return spore_vec3_add_scaled(a, share, spore_vec3_sub(b, a));
}

/* Returns the area. */
static double leaf_moment(const SporeBvh *bvh, const SporeBvhNode *node, SporeBvhMoment *m) {
  SporeVec3 centroid[SPORE_BVH_LEAF], normal[SPORE_BVH_LEAF];
  double area = 0;
  *m = (SporeBvhMoment){0};
  for (size_t i = 0; i < node->count; i++) {
    const double *c = bvh->corners + 9 * (node->first + i);
    SporeVec3 p[3] = {spore_vec3_load(c), spore_vec3_load(c + 3), spore_vec3_load(c + 6)};
    normal[i] = spore_mesh_area_vector(p[0], p[1], p[2]);
    centroid[i] = spore_vec3_scale(1. / 3, spore_vec3_add(p[0], spore_vec3_add(p[1], p[2])));
    double a = spore_vec3_length(normal[i]);
    m->centre = i ? weighted_centre(area, m->centre, a, centroid[i]) : centroid[i];
    m->dipole = spore_vec3_add(m->dipole, normal[i]);
    area += a;
  }
  for (size_t i = 0; i < node->count; i++)
    add_first_moment(m->first, spore_vec3_sub(centroid[i], m->centre), normal[i]);
  return area;
}

static void join_moments(const SporeBvhMoment *l, double l_area, const SporeBvhMoment *r, double r_area,
                         SporeBvhMoment *m) {
  *m = (SporeBvhMoment){.centre = weighted_centre(l_area, l->centre, r_area, r->centre),
                        .dipole = spore_vec3_add(l->dipole, r->dipole)};
  for (int k = 0; k < 9; k++) m->first[k] = l->first[k] + r->first[k];
  add_first_moment(m->first, spore_vec3_sub(l->centre, m->centre), l->dipole);
  add_first_moment(m->first, spore_vec3_sub(r->centre, m->centre), r->dipole);
}

static double far_squared(const SporeBvhNode *node, SporeVec3 centre) {
  double x[3], radius_squared = 0;
  spore_vec3_store(x, centre);
  for (int k = 0; k < 3; k++) {
    double reach = fmax(x[k] - node->lower[k], node->upper[k] - x[k]);
    radius_squared += reach * reach;
  }
  return FAR_FACTOR * FAR_FACTOR * radius_squared;
}

/* Computes the moments from the leaves up: children lie behind their parent in the array. */
static bool build_moments(SporeBvh *bvh) {
  double *area = SPORE_NEW_ARRAY(double, bvh->node_count);
  if (!area) return false;
  for (size_t i = bvh->node_count; i-- > 0;) {
    const SporeBvhNode *node = bvh->nodes + i;
    SporeBvhMoment *m = bvh->moments + i;
    if (node->count) {
      area[i] = leaf_moment(bvh, node, m);
    } else {
      join_moments(m + 1, area[i + 1], bvh->moments + node->first, area[node->first], m);
      area[i] = area[i + 1] + area[node->first];
    }
    m->far_squared = far_squared(node, m->centre);
  }
  spore_free(area);
  return true;
}

static bool allocate_builder(Builder *b) {
  size_t n = b->mesh->triangle_count;
  b->boxes = SPORE_NEW_ARRAY(Box, n);
  b->centre = SPORE_NEW_ARRAY(double, 3 * n);
  b->bvh->nodes = SPORE_NEW_ARRAY(SporeBvhNode, 2 * n);
  b->bvh->moments = SPORE_NEW_ARRAY(SporeBvhMoment, 2 * n);
  b->bvh->corners = SPORE_NEW_ARRAY(double, 9 * n);
  b->bvh->triangles = SPORE_NEW_ARRAY(uint32_t, n);
  return b->boxes && b->centre && b->bvh->nodes && b->bvh->moments && b->bvh->corners && b->bvh->triangles;
}

static void find_boxes(Builder *b) {
  for (size_t t = 0; t < b->mesh->triangle_count; t++) {
    b->bvh->triangles[t] = (uint32_t)t;
    b->boxes[t] = empty_box();
    for (size_t i = 0; i < 3; i++) {
      const double *x = b->mesh->vertices + 3 * (size_t)b->mesh->triangles[3 * t + i];
      Box point = {{x[0], x[1], x[2]}, {x[0], x[1], x[2]}};
      box_add(&b->boxes[t], &point);
    }
    for (int k = 0; k < 3; k++) b->centre[3 * t + k] = 0.5 * (b->boxes[t].lower[k] + b->boxes[t].upper[k]);
  }
}

SporeBvh *spore_bvh_create(const SporeTriangleMesh *mesh, SporeError *error) {
  SporeBvh *bvh = SPORE_NEW(SporeBvh);
  if (bvh) {
    Builder b = {.bvh = bvh, .mesh = mesh};
    bvh->triangle_count = mesh->triangle_count;
    bool done = allocate_builder(&b);
    if (done) {
      find_boxes(&b);
      build_node(&b, 0, mesh->triangle_count, 0);
      copy_corners(&b);
      bvh->closed = spore_bvh_is_closed(bvh);
      done = build_moments(bvh);
    }
    spore_free(b.boxes);
    spore_free(b.centre);
    if (done) return bvh;
  }
  spore_bvh_free(bvh);
  spore_mesh_no_memory(error);
  return NULL;
}

void spore_bvh_free(SporeBvh *bvh) {
  if (!bvh) return;
  spore_free(bvh->nodes);
  spore_free(bvh->moments);
  spore_free(bvh->corners);
  spore_free(bvh->triangles);
  spore_free(bvh);
}
