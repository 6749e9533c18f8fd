#include "models/tetrahedra/cut.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/memory.h"
#include "models/tetrahedra/map.h"

#define NONE UINT32_MAX

/* Setting up. */

typedef struct Face {
  uint32_t node[3]; /* ascending */
  uint32_t place;   /* tetrahedron and corner against it */
} Face;

static void exchange(uint32_t *a, uint32_t *b) {
  uint32_t kept = *a;
  *a = *b;
  *b = kept;
}

static Face face_of(const uint32_t *corners, uint32_t place) {
  Face face = {.place = place};
  for (uint32_t a = 0, n = 0; a < 4; a++)
    if (a != place % 4) face.node[n++] = corners[a];
  if (face.node[0] > face.node[1]) exchange(&face.node[0], &face.node[1]);
  if (face.node[1] > face.node[2]) exchange(&face.node[1], &face.node[2]);
  if (face.node[0] > face.node[1]) exchange(&face.node[0], &face.node[1]);
  return face;
}

static int compare_faces(const void *a, const void *b) {
  const Face *x = a, *y = b;
  for (int k = 0; k < 3; k++)
    if (x->node[k] != y->node[k]) return x->node[k] < y->node[k] ? -1 : 1;
  return (x->place > y->place) - (x->place < y->place);
}

static bool find_neighbours(SporeTetrahedraCut *cut) {
  uint32_t count = (uint32_t)(4 * cut->count);
  Face *faces = SPORE_NEW_ARRAY(Face, count);
  if (!faces) return false;
  for (uint32_t i = 0; i < count; i++) {
    faces[i] = face_of(cut->corner + 4 * (size_t)(i / 4), i);
    cut->neighbour[i] = NONE;
  }
  qsort(faces, count, sizeof *faces, compare_faces);
  for (uint32_t i = 0; i + 1 < count; i++) {
    if (memcmp(faces[i].node, faces[i + 1].node, sizeof faces[i].node) != 0) continue;
    cut->neighbour[faces[i].place] = faces[i + 1].place / 4;
    cut->neighbour[faces[i + 1].place] = faces[i].place / 4;
  }
  spore_free(faces);
  return true;
}

static bool find_fans(SporeTetrahedraCut *cut) {
  uint32_t longest = 0, *start = cut->fan_start;
  for (size_t i = 0; i < 4 * cut->count; i++) start[cut->corner[i] + 2]++;
  for (size_t i = 0; i < cut->node_count; i++) {
    if (start[i + 2] > longest) longest = start[i + 2];
    start[i + 2] += start[i + 1];
  }
  for (size_t i = 0; i < 4 * cut->count; i++) cut->fan[start[cut->corner[i] + 1]++] = (uint32_t)(i / 4);
  cut->part = SPORE_NEW_ARRAY(uint32_t, longest);
  return cut->part != NULL;
}

/* Elements come into lanes in an order of their own: found by their nodes, which no two have in common. */
static int compare_nodes(const uint32_t *a, const uint32_t *b) { return memcmp(a, b, 4 * sizeof *a); }

typedef struct Lane {
  uint32_t node[4], place;
} Lane;

static int compare_lanes(const void *a, const void *b) {
  return compare_nodes(((const Lane *)a)->node, ((const Lane *)b)->node);
}

static bool find_lanes(SporeTetrahedraCut *cut, const SporeTetrahedra *tetrahedra) {
  Lane *lanes = SPORE_NEW_ARRAY(Lane, cut->count);
  if (!lanes) return false;
  size_t filled = 0;
  for (size_t n = 0; n < tetrahedra->batch_count; n++)
    for (uint32_t i = 0; i < tetrahedra->lanes[n]; i++, filled++) {
      for (int k = 0; k < 4; k++) lanes[filled].node[k] = tetrahedra->batches[n].node[k][i];
      lanes[filled].place = (uint32_t)n * SPORE_LANES + i;
    }
  qsort(lanes, cut->count, sizeof *lanes, compare_lanes);
  for (size_t t = 0; t < cut->count; t++) {
    Lane wanted;
    memcpy(wanted.node, cut->corner + 4 * t, sizeof wanted.node);
    const Lane *found = bsearch(&wanted, lanes, cut->count, sizeof *lanes, compare_lanes);
    cut->lane[t] = found->place;
  }
  spore_free(lanes);
  return true;
}

static void set_masses(SporeTetrahedraCut *cut, const SporeTetrahedronNodes *nodes, double density) {
  for (size_t t = 0; t < cut->count; t++) {
    SporeVec3 gradient[3];
    cut->mass[t] = 0.25 * (density / 6 * spore_tetrahedron_gradients(nodes->rest, nodes->nodes + 4 * t, gradient) *
                           spore_tetrahedron_factors(nodes, t).density);
  }
}

bool spore_tetrahedra_cut_create(SporeTetrahedraCut *cut, const SporeTetrahedronNodes *nodes,
                                 const SporeTetrahedra *tetrahedra, double density, size_t spare_count) {
  assert(nodes->per_element == 4);
  size_t count = nodes->mesh.tetrahedron_count;
  *cut = (SporeTetrahedraCut){
      .count = count, .node_count = nodes->count, .spare_count = spare_count, .whole = nodes->nodes};
  cut->corner = SPORE_NEW_ARRAY(uint32_t, 4 * count);
  cut->neighbour = SPORE_NEW_ARRAY(uint32_t, 4 * count);
  cut->open = SPORE_NEW_ARRAY(uint8_t, count);
  cut->fan_start = SPORE_NEW_ARRAY(uint32_t, nodes->count + 2);
  cut->fan = SPORE_NEW_ARRAY(uint32_t, 4 * count);
  cut->lane = SPORE_NEW_ARRAY(uint32_t, count);
  cut->from = SPORE_NEW_ARRAY(uint32_t, spare_count);
  cut->mass = SPORE_NEW_ARRAY(double, count);
  cut->middle = SPORE_NEW_ARRAY(double, 3 * count);
  cut->touched = SPORE_NEW_ARRAY(uint8_t, nodes->count);
  if (!cut->corner || !cut->neighbour || !cut->open || !cut->fan_start || !cut->fan || !cut->lane || !cut->from ||
      !cut->mass || !cut->middle || !cut->touched)
    return false;
  memcpy(cut->corner, nodes->nodes, 4 * count * sizeof *cut->corner);
  set_masses(cut, nodes, density);
  return find_neighbours(cut) && find_fans(cut) && find_lanes(cut, tetrahedra);
}

void spore_tetrahedra_cut_clear(SporeTetrahedraCut *cut) {
  void *arrays[] = {cut->corner, cut->neighbour, cut->open, cut->fan_start, cut->fan,    cut->lane,
                    cut->from,   cut->mass,      cut->part, cut->middle,    cut->touched};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) spore_free(arrays[i]);
  *cut = (SporeTetrahedraCut){0};
}

/* Opening faces. */

/* A triangle that is none opens nothing. What lies just on its plane counts as above it, so that of the faces around
 * some are opened. */
static bool crosses(SporeVec3 p, SporeVec3 r, const SporeVec3 corner[3]) {
  const SporeVec3 a = corner[0], b = corner[1], c = corner[2];
  if ((spore_vec3_volume(a, b, c, p) >= 0) == (spore_vec3_volume(a, b, c, r) >= 0)) return false;
  double u = spore_vec3_volume(p, r, a, b), v = spore_vec3_volume(p, r, b, c), w = spore_vec3_volume(p, r, c, a);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

static uint32_t side_against(const SporeTetrahedraCut *cut, uint32_t tetrahedron, uint32_t other) {
  assert(tetrahedron < cut->count && other < cut->count);
  uint32_t k = 0;
  while (k < 3 && cut->neighbour[4 * (size_t)tetrahedron + k] != other) k++;
  return k;
}

static bool is_closed(const SporeTetrahedraCut *cut, uint32_t tetrahedron, uint32_t k) {
  assert(tetrahedron < cut->count && k < 4);
  return cut->neighbour[4 * (size_t)tetrahedron + k] != NONE && !(cut->open[tetrahedron] >> k & 1);
}

static bool keeps_another(const SporeTetrahedraCut *cut, uint32_t tetrahedron, uint32_t k) {
  for (uint32_t j = 0; j < 4; j++)
    if (j != k && is_closed(cut, tetrahedron, j)) return true;
  return false;
}

static bool open_face(SporeTetrahedraCut *cut, uint32_t a, uint32_t k) {
  assert(is_closed(cut, a, k));
  uint32_t b = cut->neighbour[4 * (size_t)a + k], l = side_against(cut, b, a);
  if (!keeps_another(cut, a, k) || !keeps_another(cut, b, l)) return false;
  cut->open[a] |= (uint8_t)(1u << k);
  cut->open[b] |= (uint8_t)(1u << l);
  for (uint32_t j = 0; j < 4; j++)
    if (j != k) cut->touched[cut->whole[4 * (size_t)a + j]] = 1;
  return true;
}

static void find_middles(SporeTetrahedraCut *cut, const double *q) {
  for (size_t t = 0; t < cut->count; t++) {
    SporeVec3 sum = {0, 0, 0};
    for (int k = 0; k < 4; k++) sum = spore_vec3_add(sum, spore_vec3_load(q + 3 * (size_t)cut->corner[4 * t + k]));
    spore_vec3_store(cut->middle + 3 * t, spore_vec3_scale(0.25, sum));
  }
}

/* Whether the line between two points keeps to one side of the triangle's bounding box. */
static bool is_beside(const double *p, const double *r, const double *triangle) {
  for (int axis = 0; axis < 3; axis++) {
    double least = triangle[axis], most = least;
    for (int k = 3; k < 9; k += 3) {
      least = triangle[axis + k] < least ? triangle[axis + k] : least;
      most = triangle[axis + k] > most ? triangle[axis + k] : most;
    }
    if ((p[axis] < least && r[axis] < least) || (p[axis] > most && r[axis] > most)) return true;
  }
  return false;
}

size_t spore_tetrahedra_cut_open(SporeTetrahedraCut *cut, const double *q, const double *triangle) {
  assert(cut->count > 0 && q && triangle);
  const SporeVec3 corners[3] = {spore_vec3_load(triangle), spore_vec3_load(triangle + 3),
                                spore_vec3_load(triangle + 6)};
  size_t opened = 0;
  find_middles(cut, q);
  for (uint32_t t = 0; t < cut->count; t++)
    for (uint32_t k = 0; k < 4; k++) {
      uint32_t other = cut->neighbour[4 * (size_t)t + k];
      if (other < t || !is_closed(cut, t, k)) continue; /* each face once */
      const double *p = cut->middle + 3 * (size_t)t, *r = cut->middle + 3 * (size_t)other;
      if (!is_beside(p, r, triangle) && crosses(spore_vec3_load(p), spore_vec3_load(r), corners))
        opened += open_face(cut, t, k);
    }
  return opened;
}

/* Parting. */

static uint32_t corner_of(const SporeTetrahedraCut *cut, uint32_t tetrahedron, uint32_t node) {
  assert(tetrahedron < cut->count && node < cut->node_count);
  uint32_t k = 0;
  while (k < 3 && cut->whole[4 * (size_t)tetrahedron + k] != node) k++;
  return k;
}

typedef struct Fan {
  SporeTetrahedraCut *cut;
  uint32_t node, count; /* of the whole mesh */
  const uint32_t *tetrahedra;
  uint32_t *part; /* the first of those that it hangs together with */
} Fan;

static Fan fan_of(SporeTetrahedraCut *cut, uint32_t node) {
  assert(node < cut->node_count);
  uint32_t start = cut->fan_start[node], count = cut->fan_start[node + 1] - start;
  return (Fan){cut, node, count, cut->fan + start, cut->part};
}

static uint32_t copy_in(const Fan *fan, uint32_t i) {
  assert(i < fan->count);
  uint32_t t = fan->tetrahedra[i];
  return fan->cut->corner[4 * (size_t)t + corner_of(fan->cut, t, fan->node)];
}

static uint32_t place_in(const Fan *fan, uint32_t tetrahedron) {
  uint32_t i = 0;
  while (i < fan->count && fan->tetrahedra[i] != tetrahedron) i++;
  return i;
}

/* Gives the i-th and all that it hangs together with the number of the first. */
static void spread(const Fan *fan, uint32_t i, uint32_t first) {
  assert(fan->part[i] == NONE);
  uint32_t t = fan->tetrahedra[i], own = corner_of(fan->cut, t, fan->node);
  fan->part[i] = first;
  for (uint32_t k = 0; k < 4; k++) {
    if (k == own || !is_closed(fan->cut, t, k)) continue;
    uint32_t j = place_in(fan, fan->cut->neighbour[4 * (size_t)t + k]);
    if (fan->part[j] == NONE) spread(fan, j, first);
  }
}

static uint32_t size_of(const Fan *fan, uint32_t first) {
  uint32_t size = 0;
  for (uint32_t i = 0; i < fan->count; i++) size += fan->part[i] == first;
  return size;
}

/* Whether the part keeps the node that it has: no other with the same is larger, or as large and before it. */
static bool keeps_node(const Fan *fan, uint32_t first) {
  uint32_t copy = copy_in(fan, first), size = size_of(fan, first);
  for (uint32_t i = 0; i < fan->count; i++) {
    if (fan->part[i] != i || i == first || copy_in(fan, i) != copy) continue;
    uint32_t other = size_of(fan, i);
    if (other > size || (other == size && i < first)) return false;
  }
  return true;
}

/* In the tables and the batches, there also in the lanes without a tetrahedron, which repeat the first. */
static void set_corner(SporeTetrahedraCut *cut, SporeTetrahedra *tetrahedra, uint32_t t, uint32_t k, uint32_t node) {
  assert(t < cut->count && k < 4);
  uint32_t batch = cut->lane[t] / SPORE_LANES, lane = cut->lane[t] % SPORE_LANES;
  cut->corner[4 * (size_t)t + k] = node;
  tetrahedra->batches[batch].node[k][lane] = node;
  for (uint32_t free = tetrahedra->lanes[batch]; lane == 0 && free < SPORE_LANES; free++)
    tetrahedra->batches[batch].node[k][free] = node;
}

static void give_node(const Fan *fan, SporeTetrahedra *tetrahedra, uint32_t first, uint32_t node) {
  for (uint32_t i = 0; i < fan->count; i++) {
    uint32_t t = fan->tetrahedra[i];
    if (fan->part[i] == first) set_corner(fan->cut, tetrahedra, t, corner_of(fan->cut, t, fan->node), node);
  }
}

/* In the order of the mesh, as when it was whole. */
static void weigh(const Fan *fan, double *masses) {
  for (uint32_t i = 0; i < fan->count; i++) masses[copy_in(fan, i)] = 0;
  for (uint32_t i = 0; i < fan->count; i++) masses[copy_in(fan, i)] += fan->cut->mass[fan->tetrahedra[i]];
}

/* A node for each part that keeps none: the largest of those that have one in common is never among them. */
static size_t part_fan(const Fan *fan, SporeTetrahedra *tetrahedra, double *q, double *v) {
  SporeTetrahedraCut *cut = fan->cut;
  size_t before = cut->made;
  for (uint32_t i = 0; i < fan->count; i++) fan->part[i] = NONE;
  for (uint32_t i = 0; i < fan->count; i++)
    if (fan->part[i] == NONE) spread(fan, i, i);
  for (uint32_t i = 0; i < fan->count; i++) {
    if (fan->part[i] != i || keeps_node(fan, i)) continue;
    if (cut->made == cut->spare_count) {
      cut->full = true;
      continue;
    }
    uint32_t from = copy_in(fan, i), node = (uint32_t)(cut->node_count + cut->made);
    cut->from[cut->made++] = from;
    memcpy(q + 3 * (size_t)node, q + 3 * (size_t)from, 3 * sizeof *q);
    memcpy(v + 3 * (size_t)node, v + 3 * (size_t)from, 3 * sizeof *v);
    give_node(fan, tetrahedra, i, node);
  }
  return cut->made - before;
}

size_t spore_tetrahedra_cut_part(SporeTetrahedraCut *cut, SporeTetrahedra *tetrahedra, double *masses, double *q,
                                 double *v) {
  assert(cut->count > 0);
  assert(masses && q && v);
  size_t made = 0;
  for (uint32_t node = 0; node < cut->node_count; node++) {
    if (!cut->touched[node]) continue;
    Fan fan = fan_of(cut, node);
    size_t more = part_fan(&fan, tetrahedra, q, v);
    if (more > 0) weigh(&fan, masses);
    cut->touched[node] = 0;
    made += more;
  }
  return made;
}

void spore_tetrahedra_cut_mend(SporeTetrahedraCut *cut, SporeTetrahedra *tetrahedra, double *masses) {
  if (cut->count == 0) return; /* nothing can cut it */
  for (uint32_t t = 0; t < cut->count; t++)
    for (uint32_t k = 0; k < 4; k++) set_corner(cut, tetrahedra, t, k, cut->whole[4 * (size_t)t + k]);
  for (uint32_t node = 0; node < cut->node_count; node++) {
    const Fan fan = fan_of(cut, node);
    if (cut->made > 0) weigh(&fan, masses);
  }
  memset(cut->open, 0, cut->count);
  memset(cut->touched, 0, cut->node_count);
  cut->made = 0;
  cut->full = false;
}

bool spore_tetrahedra_cut_pattern(const SporeTetrahedraCut *cut, SporeBlockPattern *pattern) {
  for (size_t t = 0; t < cut->count; t++)
    for (size_t a = 0; a < 4; a++)
      for (size_t b = 0; b < a; b++)
        if (!spore_block_pattern_add(pattern, cut->corner[4 * t + a], cut->corner[4 * t + b])) return false;
  return true;
}
