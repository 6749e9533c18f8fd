#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/centreline_search.h"

/* The cost of a way falls with this power of the depth, so that it keeps to the middle and does not take the narrow
 * neck where two loops touch. Each is tried, and the way that covers most of the organ is kept: a low power takes too
 * many necks, a high one shuns narrows that are the organ's own. */
static const double powers[] = {3, 6, 12};
#define POWERS (sizeof powers / sizeof *powers)
#define MUCH 0.85    /* of the volume that a way may hold: with more than that it is compared by length */
#define ENOUGH 0.995 /* share covered, with which no other power is tried */

static void set_costs(SporeVoxelSearch *search, double power) {
  double deepest = 0;
  for (size_t i = 0; i < search->tube->count; i++) deepest = fmax(deepest, search->tube->depth[i]);
  for (size_t i = 0; i < search->tube->count; i++) search->cost[i] = pow(deepest / search->tube->depth[i], power);
}

static bool is_end(const SporeVoxelSearch *search, uint32_t voxel) {
  const uint32_t *near = search->tube->neighbour + SPORE_VOXEL_NEIGHBOURS * (size_t)voxel;
  if (search->from[voxel] == SPORE_NO_VOXEL) return false;
  for (int k = 0; k < SPORE_VOXEL_NEIGHBOURS; k++)
    if (near[k] != SPORE_NO_VOXEL && search->length[near[k]] > search->length[voxel]) return false;
  return true;
}

/* The end of the longest of the cheapest ways. Ways that run round the organ and end where they meet are long too, so
 * it must hold about as much as any other way. */
static uint32_t farthest(const SporeVoxelSearch *search) {
  uint32_t far = 0, count = (uint32_t)search->tube->count;
  double most = 0, length = -1;
  for (uint32_t i = 0; i < count; i++)
    if (is_end(search, i)) most = fmax(most, search->volume[i]);
  for (uint32_t i = 0; i < count; i++)
    if (is_end(search, i) && search->volume[i] >= MUCH * most && search->length[i] > length)
      length = search->length[i], far = i;
  return far;
}

static uint32_t deepest(const SporeVoxelTube *tube) {
  uint32_t deep = 0;
  double most = -1;
  for (uint32_t i = 0; i < tube->count; i++)
    if (tube->component[i] == 0 && tube->depth[i] > most) most = tube->depth[i], deep = i;
  return deep;
}

void spore_voxel_path_clear(SporeVoxelPath *path) {
  spore_free(path->voxel);
  *path = (SporeVoxelPath){0};
}

/* The way by which the search came to `end`. */
static bool trace(const SporeVoxelSearch *search, uint32_t end, SporeVoxelPath *path) {
  size_t count = 1;
  for (uint32_t i = end; search->from[i] != i; i = search->from[i]) count++;
  *path = (SporeVoxelPath){count, SPORE_NEW_ARRAY(uint32_t, count)};
  if (!path->voxel) return false;
  for (size_t i = count; i-- > 0; end = search->from[end]) path->voxel[i] = end;
  return true;
}

static bool find_way(SporeVoxelSearch *search, const uint32_t *ends, SporeVoxelPath *path, SporeError *error) {
  uint32_t start = ends ? ends[0] : deepest(search->tube);
  if (!spore_voxel_search_spread(search, &start, 1, error)) return false;
  for (int sweep = 0; !ends && sweep < 2; sweep++) {
    start = farthest(search);
    if (!spore_voxel_search_spread(search, &start, 1, error)) return false;
  }
  return trace(search, ends ? ends[1] : farthest(search), path) || spore_centreline_no_memory(error);
}

bool spore_voxel_path_find(SporeVoxelPath *path, const SporeVoxelTube *tube, const uint32_t *ends,
                           SporeCentrelineReport *report, const SporeProgressPart *progress, SporeError *error) {
  SporeVoxelSearch search;
  const SporeCentrelineReport clean = *report;
  double best = -1;
  *path = (SporeVoxelPath){0};
  if (!spore_voxel_search_create(&search, tube, progress, error)) return false;
  bool done = true;
  for (size_t i = 0; done && i < POWERS && best < ENOUGH; i++) {
    SporeVoxelPath way = {0};
    SporeCentrelineReport left = clean;
    double cover = 0;
    set_costs(&search, powers[i]);
    done = find_way(&search, ends, &way, error) && spore_voxel_search_leftovers(&search, &way, &left, &cover, error);
    if (done && cover > best) {
      spore_voxel_path_clear(path);
      *path = way, *report = left, best = cover;
    } else spore_voxel_path_clear(&way);
  }
  spore_voxel_search_clear(&search);
  if (!done) spore_voxel_path_clear(path);
  return done;
}
