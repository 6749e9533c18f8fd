/* A body-centred cubic lattice around a solid: its nodes are snapped to the surface, and the surface cuts its edges. */
#include "core/generate/tetrahedra/lattice.h"

#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/mesh/common.h"

#define LONG_SNAP 0.24999    /* of an edge along an axis */
#define SHORT_SNAP 0.41189   /* of an edge along a diagonal */
#define MOST_NODES 100000000 /* of a lattice */
#define CUT_TOLERANCE 1e-4   /* of an edge */
#define CUT_STEPS 12
#define AXES 6 /* neighbours along the axes */

const int8_t spore_bcc_steps[SPORE_BCC_NEIGHBOURS][3] = {{2, 0, 0},  {-2, 0, 0},  {0, 2, 0},   {0, -2, 0},  {0, 0, 2},
                                                         {0, 0, -2}, {1, 1, 1},   {1, 1, -1},  {1, -1, 1},  {1, -1, -1},
                                                         {-1, 1, 1}, {-1, 1, -1}, {-1, -1, 1}, {-1, -1, -1}};

static SporeVec3 regular_place(const SporeBcc *lattice, SporeBccNode node) {
  double half = 0.5 * lattice->edge;
  return spore_vec3(lattice->lower[0] + half * node.x, lattice->lower[1] + half * node.y,
                    lattice->lower[2] + half * node.z);
}

SporeVec3 spore_bcc_place(const SporeBcc *lattice, SporeBccNode node) {
  uint32_t moved = lattice->moved[spore_bcc_index(lattice, node)];
  return moved ? spore_vec3_load(lattice->places + 3 * (size_t)(moved - 1)) : regular_place(lattice, node);
}

/* Classifies the nodes along rows. One distance decides a run of nodes far from the surface. */
static bool classify(SporeBcc *lattice, const SporeTetrahedraWork *work, SporeError *error) {
  for (size_t z = 0; z < lattice->layers; z++) {
    if (!spore_tetrahedra_progress(work, 0.4 * (double)z / (double)lattice->layers, _("filling a lattice"), error))
      return false;
    for (size_t y = 0; y < lattice->rows; y++)
      for (size_t x = 0; x < lattice->columns;) {
        int kind = (int)(z & 1);
        SporeBccNode node = {(int32_t)(2 * x) + kind, (int32_t)(2 * y) + kind, (int32_t)z};
        double depth = spore_tetrahedra_depth(work, regular_place(lattice, node));
        size_t run = 1 + (size_t)fmin(fabs(depth) / lattice->edge, (double)(lattice->columns - x - 1));
        for (size_t first = spore_bcc_index(lattice, node); run; run--, x++)
          lattice->value[first++] = depth > 0 ? 1 : -1;
      }
  }
  return true;
}

static SporeBccNode node_of(const SporeBcc *lattice, size_t index) {
  int32_t z = (int32_t)(index / (lattice->rows * lattice->columns)), kind = z & 1;
  return (SporeBccNode){2 * (int32_t)(index % lattice->columns) + kind,
                        2 * (int32_t)(index / lattice->columns % lattice->rows) + kind, z};
}

/* Nodes that cannot be reached from the lattice's corner are set inside. */
static bool fill_cavities(SporeBcc *lattice, size_t count, SporeError *error) {
  uint32_t *stack = SPORE_NEW_ARRAY(uint32_t, count);
  if (!stack) return spore_mesh_no_memory(error);
  size_t waiting = 1; /* node 0, which is outside; value 0 marks reached nodes */
  lattice->value[0] = 0;
  while (waiting) {
    SporeBccNode node = node_of(lattice, stack[--waiting]);
    for (int n = 0; n < SPORE_BCC_NEIGHBOURS; n++) {
      SporeBccNode other = spore_bcc_neighbour(node, n);
      if (!spore_bcc_has(lattice, other)) continue;
      size_t index = spore_bcc_index(lattice, other);
      if (lattice->value[index] < 0) lattice->value[index] = 0, stack[waiting++] = (uint32_t)index;
    }
  }
  size_t filled = 0;
  for (size_t i = 0; i < count; i++) {
    filled += lattice->value[i] < 0;
    lattice->value[i] = lattice->value[i] ? 1 : -1;
  }
  lattice->filled = 0.5 * (double)filled * pow(lattice->edge, 3); /* two nodes a cube */
  spore_free(stack);
  return true;
}

static SporeBccCut *slot_of(const SporeBcc *lattice, uint64_t key) {
  size_t mask = lattice->cut_room - 1, at = (size_t)(key * UINT64_C(0x9e3779b97f4a7c15) >> 20) & mask;
  while (lattice->cuts[at].key && lattice->cuts[at].key != key) at = (at + 1) & mask;
  return lattice->cuts + at;
}

static bool grow_cuts(SporeBcc *lattice) {
  SporeBcc grown = *lattice;
  grown.cut_room = lattice->cut_room ? 2 * lattice->cut_room : 1024;
  grown.cuts = SPORE_NEW_ARRAY(SporeBccCut, grown.cut_room);
  if (!grown.cuts) return false;
  for (size_t i = 0; i < lattice->cut_room; i++)
    if (lattice->cuts[i].key) *slot_of(&grown, lattice->cuts[i].key) = lattice->cuts[i];
  spore_free(lattice->cuts);
  *lattice = grown;
  return true;
}

/* By false position, with bisection where the depth is far from linear. */
static double find_cut(const SporeBcc *lattice, const SporeTetrahedraWork *work, SporeVec3 a, SporeVec3 b) {
  double low = 0, high = 1, f_low = fmax(spore_tetrahedra_depth(work, a), 0),
         f_high = fmin(spore_tetrahedra_depth(work, b), 0);
  for (int i = 0; i < CUT_STEPS && high - low > CUT_TOLERANCE; i++) {
    double t = f_low - f_high > 0 ? low + (high - low) * f_low / (f_low - f_high) : 0.5 * (low + high);
    if (i % 3 == 2 || !(t > low && t < high)) t = 0.5 * (low + high);
    double f = spore_tetrahedra_depth(work, spore_vec3_add_scaled(a, t, spore_vec3_sub(b, a)));
    if (fabs(f) < CUT_TOLERANCE * lattice->edge) return t;
    if (f > 0) low = t, f_low = f;
    else high = t, f_high = f;
  }
  return 0.5 * (low + high);
}

SporeBccCut *spore_bcc_cut(SporeBcc *lattice, const SporeTetrahedraWork *work, SporeBccNode inside, int neighbour) {
  uint64_t key = (uint64_t)spore_bcc_index(lattice, inside) * SPORE_BCC_NEIGHBOURS + (uint64_t)neighbour + 1;
  if (2 * lattice->cut_count >= lattice->cut_room && !grow_cuts(lattice)) return NULL;
  SporeBccCut *cut = slot_of(lattice, key);
  if (cut->key) return cut;
  SporeBccNode outside = spore_bcc_neighbour(inside, neighbour);
  *cut = (SporeBccCut){
      .key = key, .share = find_cut(lattice, work, regular_place(lattice, inside), regular_place(lattice, outside))};
  lattice->cut_count++;
  return cut;
}

/* The index of the opposite step: from the neighbour back to the node. */
static int back(int neighbour) { return neighbour < AXES ? neighbour ^ 1 : AXES + 7 - (neighbour - AXES); }

/* Moves a node to the cut of its edges that is nearest in units of the snapping share, if one is within that share. */
static bool snap(SporeBcc *lattice, const SporeTetrahedraWork *work, SporeBccNode node) {
  size_t index = spore_bcc_index(lattice, node);
  double best = HUGE_VAL;
  SporeVec3 place = {0, 0, 0}, here = regular_place(lattice, node);
  for (int n = 0; n < SPORE_BCC_NEIGHBOURS; n++) {
    SporeBccNode other = spore_bcc_neighbour(node, n);
    if (!spore_bcc_has(lattice, other)) continue;
    int8_t value = lattice->value[index];
    if (value * lattice->value[spore_bcc_index(lattice, other)] >= 0) continue;
    SporeBccCut *cut = value > 0 ? spore_bcc_cut(lattice, work, node, n) : spore_bcc_cut(lattice, work, other, back(n));
    if (!cut) return false;
    double share = value > 0 ? cut->share : 1 - cut->share, most = n < AXES ? LONG_SNAP : SHORT_SNAP;
    if (share >= most || share / most >= best) continue;
    best = share / most;
    place = spore_vec3_add_scaled(here, share, spore_vec3_sub(regular_place(lattice, other), here));
  }
  if (!(best < HUGE_VAL)) return true;
  double *places =
      spore_room_for_one(lattice->places, lattice->place_count, &lattice->place_room, 1024, 3 * sizeof *places);
  if (!places) return false;
  lattice->places = places;
  spore_vec3_store(lattice->places + 3 * lattice->place_count, place);
  lattice->moved[index] = (uint32_t)++lattice->place_count;
  lattice->value[index] = 0;
  return true;
}

static bool snap_all(SporeBcc *lattice, const SporeTetrahedraWork *work, size_t count, SporeError *error) {
  for (size_t i = 0; i < count; i++) {
    if (i % 65536 == 0 &&
        !spore_tetrahedra_progress(work, 0.4 + 0.4 * (double)i / (double)count, _("filling a lattice"), error))
      return false;
    if (!snap(lattice, work, node_of(lattice, i))) return spore_mesh_no_memory(error);
  }
  return true;
}

bool spore_bcc_create(SporeBcc *lattice, const SporeTetrahedraWork *work, double edge, SporeError *error) {
  double lower[3], upper[3], extent[3];
  *lattice = (SporeBcc){.edge = edge};
  spore_mesh_bounds(work->surface.vertices, work->surface.vertex_count, 3, lower, upper);
  for (int k = 0; k < 3; k++) {
    lattice->lower[k] = lower[k] - 1.25 * edge; /* no node lies in a plane that the bounds touch */
    extent[k] = ceil((upper[k] - lower[k]) / edge) + 4;
  }
  double nodes = 2 * extent[0] * extent[1] * extent[2];
  if (!(nodes < MOST_NODES))
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("a lattice of such cells has %.0f nodes; expected at most %d; ask for larger cells"),
                           nodes, MOST_NODES);
  lattice->columns = (size_t)extent[0], lattice->rows = (size_t)extent[1], lattice->layers = 2 * (size_t)extent[2];
  size_t count = lattice->columns * lattice->rows * lattice->layers;
  lattice->value = SPORE_NEW_ARRAY(int8_t, count);
  lattice->moved = SPORE_NEW_ARRAY(uint32_t, count);
  lattice->vertex = SPORE_NEW_ARRAY(uint32_t, count);
  bool done = (lattice->value && lattice->moved && lattice->vertex) || spore_mesh_no_memory(error);
  done = done && classify(lattice, work, error) && (!work->options.fill || fill_cavities(lattice, count, error)) &&
         snap_all(lattice, work, count, error);
  if (!done) spore_bcc_clear(lattice);
  return done;
}

void spore_bcc_clear(SporeBcc *lattice) {
  spore_free(lattice->value);
  spore_free(lattice->moved);
  spore_free(lattice->vertex);
  spore_free(lattice->places);
  spore_free(lattice->cuts);
  *lattice = (SporeBcc){0};
}
