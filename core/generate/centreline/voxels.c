/* The inside of an organ as voxels: their positions, their neighbours, and the connected components. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/centreline/private.h"

#define WANTED 60000   /* voxels, about */
#define MOST 2000000   /* voxels */
#define AXIS_BITS 21   /* of a key */
#define SPECK 1e-3     /* of the voxels: a piece with less does not count, as where an organ overlaps itself */
#define REPORT_EACH 16 /* cells */
#define JOIN_EACH 1024 /* voxels */
#define JOINING 0.6    /* share of the work before neighbours are sought */

static uint64_t key_of(const uint64_t place[3]) { return place[0] << 2 * AXIS_BITS | place[1] << AXIS_BITS | place[2]; }

/* The offsets are in the order of the keys: the first 13 come before the voxel. */
void spore_voxel_offset(int k, int offset[3]) {
  int place = k < SPORE_VOXEL_NEIGHBOURS / 2 ? k : k + 1; /* 13 is the voxel itself */
  offset[0] = place / 9 - 1, offset[1] = place / 3 % 3 - 1, offset[2] = place % 3 - 1;
}

SporeVec3 spore_voxel_middle(const SporeVoxelTube *tube, uint32_t voxel) {
  uint64_t key = tube->key[voxel], mask = (UINT64_C(1) << AXIS_BITS) - 1;
  double place[3] = {(double)(key >> 2 * AXIS_BITS), (double)(key >> AXIS_BITS & mask), (double)(key & mask)};
  for (int k = 0; k < 3; k++) place[k] = tube->lower[k] + (place[k] + 0.5) * tube->edge;
  return spore_vec3_load(place);
}

typedef struct Voxel {
  uint64_t key;
  double depth;
} Voxel;

static int by_key(const void *a, const void *b) {
  uint64_t one = ((const Voxel *)a)->key, other = ((const Voxel *)b)->key;
  return (one > other) - (one < other);
}

typedef struct Filling {
  const SporeSolid *solid;
  SporeVoxelTube *tube;
  Voxel *voxels;
  size_t count, capacity;
} Filling;

static bool add_voxel(Filling *filling, uint64_t key, double depth) {
  Voxel *voxels = spore_room_for_one(filling->voxels, filling->count, &filling->capacity, 1 << 16, sizeof *voxels);
  if (!voxels) return false;
  filling->voxels = voxels;
  filling->voxels[filling->count++] = (Voxel){key, depth};
  return true;
}

static bool fill_cell(Filling *filling, size_t cell) {
  const double *corner = filling->solid->cells + 4 * cell;
  const SporeVoxelTube *tube = filling->tube;
  uint64_t first[3], width = (uint64_t)llround(corner[3] / tube->edge);
  SporeBvhKnown here = {.depth = 0};
  for (int k = 0; k < 3; k++) first[k] = (uint64_t)llround((corner[k] - tube->lower[k]) / tube->edge);
  for (uint64_t i = 0; i < width * width * width; i++) {
    uint64_t place[3] = {first[0] + i / (width * width), first[1] + i / width % width, first[2] + i % width};
    double at[3];
    for (int k = 0; k < 3; k++) at[k] = tube->lower[k] + ((double)place[k] + 0.5) * tube->edge;
    SporeVec3 p = spore_vec3_load(at);
    if (filling->solid->cell_inside[cell]) here.depth = spore_bvh_distance(filling->solid->bvh, p, NULL, NULL);
    else here = spore_bvh_depth_beside(filling->solid->bvh, p, &here);
    if (here.depth > 0 && !add_voxel(filling, key_of(place), here.depth)) return false;
  }
  return true;
}

/* Edge of the voxels: the edge of the smallest cell, divided so that the number of voxels is near WANTED. */
static double edge_of(const SporeSolid *solid) {
  double least = HUGE_VAL;
  for (size_t i = 0; i < solid->cell_count; i++) least = fmin(least, solid->cells[4 * i + 3]);
  return least / fmax(1, rint(least / cbrt(solid->volume / WANTED)));
}

double spore_voxel_tube_expected(const SporeSolid *solid) { return solid->volume / pow(edge_of(solid), 3); }

static bool choose_edge(SporeVoxelTube *tube, const SporeSolid *solid, SporeError *error) {
  for (int k = 0; k < 3; k++) tube->lower[k] = HUGE_VAL;
  for (size_t i = 0; i < solid->cell_count; i++)
    for (int k = 0; k < 3; k++) tube->lower[k] = fmin(tube->lower[k], solid->cells[4 * i + (size_t)k]);
  tube->edge = edge_of(solid);
  if (solid->volume / pow(tube->edge, 3) <= MOST && 2 * solid->diagonal / tube->edge < 1 << AXIS_BITS) return true;
  return spore_error_set(error, SPORE_ERROR_NUMERICAL, NULL,
                         _("the organ is too thin for its size; a tube at most some ten thousand times as long as it "
                           "is thick was expected; cut it into pieces"));
}

static bool fill(Filling *filling, const SporeProgressPart *progress, SporeError *error) {
  const SporeSolid *solid = filling->solid;
  for (size_t cell = 0; cell < solid->cell_count; cell++) {
    if (cell % REPORT_EACH == 0 && !spore_progress_part(progress, JOINING * (double)cell / (double)solid->cell_count,
                                                        _("measuring depths"), error))
      return false;
    if (!fill_cell(filling, cell)) return spore_generate_no_memory(error);
  }
  if (!filling->count)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the surface encloses nothing that is thick enough to hold a line; a tube was expected; "
                             "check the mesh"));
  qsort(filling->voxels, filling->count, sizeof *filling->voxels, by_key);
  SporeVoxelTube *tube = filling->tube;
  tube->count = filling->count;
  tube->key = SPORE_NEW_ARRAY(uint64_t, tube->count);
  tube->depth = SPORE_NEW_ARRAY(double, tube->count);
  tube->component = SPORE_NEW_ARRAY(uint32_t, tube->count);
  tube->neighbour = SPORE_NEW_ARRAY(uint32_t, SPORE_VOXEL_NEIGHBOURS * tube->count);
  if (!tube->key || !tube->depth || !tube->component || !tube->neighbour) return spore_generate_no_memory(error);
  for (size_t i = 0; i < tube->count; i++)
    tube->key[i] = filling->voxels[i].key, tube->depth[i] = filling->voxels[i].depth;
  return true;
}

/* Whether no wall lies between two voxels: balls of their depths that overlap hold the way between them. */
static bool are_joined(const SporeVoxelTube *tube, size_t a, size_t b) {
  SporeVec3 one = spore_voxel_middle(tube, (uint32_t)a), other = spore_voxel_middle(tube, (uint32_t)b);
  return tube->depth[a] + tube->depth[b] > spore_vec3_distance(one, other) || spore_passage_open(tube, one, other);
}

/* Keys ascend, and so do the keys of all neighbours along one offset. So two indices that only move forward find
 * them. */
static bool find_neighbours(SporeVoxelTube *tube, const SporeProgressPart *progress, SporeError *error) {
  memset(tube->neighbour, 0xff, SPORE_VOXEL_NEIGHBOURS * tube->count * sizeof *tube->neighbour);
  for (int k = SPORE_VOXEL_NEIGHBOURS / 2; k < SPORE_VOXEL_NEIGHBOURS; k++) {
    int offset[3];
    spore_voxel_offset(k, offset);
    int64_t ahead = ((int64_t)offset[0] * ((int64_t)1 << 2 * AXIS_BITS)) +
                    ((int64_t)offset[1] * ((int64_t)1 << AXIS_BITS)) + offset[2];
    size_t other = 0;
    for (size_t i = 0; i < tube->count; i++) {
      uint64_t key = tube->key[i] + (uint64_t)ahead;
      while (other < tube->count && tube->key[other] < key) other++;
      if (i % JOIN_EACH == 0 && !spore_progress_part(progress, JOINING, _("measuring depths"), error)) return false;
      if (other == tube->count || tube->key[other] != key || !are_joined(tube, i, other)) continue;
      tube->neighbour[SPORE_VOXEL_NEIGHBOURS * i + (size_t)k] = (uint32_t)other;
      tube->neighbour[SPORE_VOXEL_NEIGHBOURS * other + SPORE_VOXEL_NEIGHBOURS - 1 - (size_t)k] = (uint32_t)i;
    }
  }
  return true;
}

static size_t flood(SporeVoxelTube *tube, uint32_t *stack, uint32_t start, uint32_t number) {
  size_t waiting = 0, size = 0;
  stack[waiting++] = start;
  tube->component[start] = number;
  while (waiting) {
    const uint32_t *near = tube->neighbour + SPORE_VOXEL_NEIGHBOURS * (size_t)stack[--waiting];
    size++;
    for (int k = 0; k < SPORE_VOXEL_NEIGHBOURS; k++)
      if (near[k] != SPORE_NO_VOXEL && tube->component[near[k]] == SPORE_NO_VOXEL) {
        tube->component[near[k]] = number;
        stack[waiting++] = near[k];
      }
  }
  return size;
}

/* The largest becomes number 0. */
static bool find_components(SporeVoxelTube *tube) {
  uint32_t *stack = SPORE_NEW_ARRAY(uint32_t, tube->count), largest = 0, number = 0;
  size_t most = 0;
  if (!stack) return false;
  memset(tube->component, 0xff, tube->count * sizeof *tube->component);
  for (uint32_t i = 0; i < tube->count; i++) {
    if (tube->component[i] != SPORE_NO_VOXEL) continue;
    size_t size = flood(tube, stack, i, number);
    if (size > most) most = size, largest = number;
    tube->component_count += (double)size >= SPECK * (double)tube->count;
    number++;
  }
  for (size_t i = 0; i < tube->count; i++) {
    if (tube->component[i] == largest) tube->component[i] = 0;
    else if (tube->component[i] == 0) tube->component[i] = largest;
  }
  tube->share = (double)most / (double)tube->count;
  spore_free(stack);
  return true;
}

bool spore_voxel_tube_create(SporeVoxelTube *tube, const SporeSolid *solid, const SporeProgressPart *progress,
                             SporeError *error) {
  *tube = (SporeVoxelTube){.solid = solid};
  Filling filling = {.solid = solid, .tube = tube};
  bool done = choose_edge(tube, solid, error) && fill(&filling, progress, error);
  spore_free(filling.voxels);
  done = done && spore_passage_know_piece(tube, error) && find_neighbours(tube, progress, error) &&
         (find_components(tube) || spore_generate_no_memory(error));
  if (!done) spore_voxel_tube_clear(tube);
  return done;
}

void spore_voxel_tube_clear(SporeVoxelTube *tube) {
  spore_free(tube->key);
  spore_free(tube->depth);
  spore_free(tube->neighbour);
  spore_free(tube->component);
  spore_free(tube->of_piece);
  *tube = (SporeVoxelTube){0};
}

uint32_t spore_voxel_at(const SporeVoxelTube *tube, const int64_t place[3]) {
  size_t low = 0, high = tube->count;
  for (int k = 0; k < 3; k++)
    if (place[k] < 0 || place[k] >= 1 << AXIS_BITS) return SPORE_NO_VOXEL;
  uint64_t key = key_of((const uint64_t[3]){(uint64_t)place[0], (uint64_t)place[1], (uint64_t)place[2]});
  while (low < high) {
    size_t half = (low + high) / 2;
    if (tube->key[half] < key) low = half + 1;
    else high = half;
  }
  return low < tube->count && tube->key[low] == key ? (uint32_t)low : SPORE_NO_VOXEL;
}

uint32_t spore_voxel_nearest(const SporeVoxelTube *tube, SporeVec3 p) {
  uint32_t nearest = SPORE_NO_VOXEL;
  double least = HUGE_VAL;
  for (uint32_t i = 0; i < tube->count; i++) {
    if (tube->component[i]) continue;
    double distance = spore_vec3_distance(p, spore_voxel_middle(tube, i));
    if (distance < least) least = distance, nearest = i;
  }
  return nearest;
}
