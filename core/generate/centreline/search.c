/* Cheapest paths from voxel to voxel by Dijkstra's algorithm, with costs that favour deep voxels. */
#include "core/generate/centreline/search.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"

#define REPORT_EACH 8192

static bool before(const SporeVoxelQueue *queue, uint32_t a, uint32_t b) {
  return queue->distance[a] < queue->distance[b] || (queue->distance[a] == queue->distance[b] && a < b);
}

static void rise(SporeVoxelQueue *queue, size_t at) {
  uint32_t voxel = queue->voxel[at];
  for (; at > 0 && before(queue, voxel, queue->voxel[(at - 1) / 2]); at = (at - 1) / 2) {
    queue->voxel[at] = queue->voxel[(at - 1) / 2];
    queue->place[queue->voxel[at]] = (uint32_t)at;
  }
  queue->voxel[at] = voxel;
  queue->place[voxel] = (uint32_t)at;
}

/* Inserts a new voxel, or moves one whose distance decreased. */
static void put(SporeVoxelQueue *queue, uint32_t voxel, bool is_new) {
  if (is_new) queue->voxel[queue->count] = voxel, queue->place[voxel] = (uint32_t)queue->count++;
  rise(queue, queue->place[voxel]);
}

static uint32_t take(SporeVoxelQueue *queue) {
  uint32_t first = queue->voxel[0], last = queue->voxel[--queue->count];
  size_t at = 0, child;
  while ((child = 2 * at + 1) < queue->count) {
    if (child + 1 < queue->count && before(queue, queue->voxel[child + 1], queue->voxel[child])) child++;
    if (!before(queue, queue->voxel[child], last)) break;
    queue->voxel[at] = queue->voxel[child];
    queue->place[queue->voxel[at]] = (uint32_t)at;
    at = child;
  }
  queue->voxel[at] = last;
  queue->place[last] = (uint32_t)at;
  return first;
}

void spore_voxel_search_clear(SporeVoxelSearch *search) {
  spore_free(search->queue.voxel);
  spore_free(search->queue.place);
  spore_free(search->cost);
  spore_free(search->cut);
  spore_free(search->distance);
  spore_free(search->length);
  spore_free(search->volume);
  spore_free(search->from);
}

bool spore_voxel_search_create(SporeVoxelSearch *search, const SporeVoxelTube *tube, const SporeProgressPart *progress,
                               SporeError *error) {
  size_t count = tube->count;
  *search = (SporeVoxelSearch){.tube = tube, .progress = progress};
  search->queue.voxel = SPORE_NEW_ARRAY(uint32_t, count);
  search->queue.place = SPORE_NEW_ARRAY(uint32_t, count);
  search->cost = SPORE_NEW_ARRAY(double, count);
  search->queue.distance = search->distance = SPORE_NEW_ARRAY(double, count);
  search->length = SPORE_NEW_ARRAY(double, count);
  search->volume = SPORE_NEW_ARRAY(double, count);
  search->cut = SPORE_NEW_ARRAY(bool, count);
  search->from = SPORE_NEW_ARRAY(uint32_t, count);
  if (search->queue.voxel && search->queue.place && search->cost && search->distance && search->length &&
      search->volume && search->from && search->cut)
    return true;
  spore_voxel_search_clear(search);
  return spore_generate_no_memory(error);
}

/* Dijkstra 1959. */
bool spore_voxel_search_spread(SporeVoxelSearch *search, const uint32_t *starts, size_t start_count,
                               SporeError *error) {
  const SporeVoxelTube *tube = search->tube;
  double step[SPORE_VOXEL_NEIGHBOURS];
  for (int k = 0; k < SPORE_VOXEL_NEIGHBOURS; k++) {
    int offset[3];
    spore_voxel_offset(k, offset);
    step[k] = tube->edge * sqrt(offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]);
  }
  for (size_t i = 0; i < tube->count; i++) search->distance[i] = HUGE_VAL, search->length[i] = search->volume[i] = 0;
  memset(search->from, 0xff, tube->count * sizeof *search->from);
  for (size_t i = 0; i < start_count; i++) {
    if (search->distance[starts[i]] == 0) continue;
    search->distance[starts[i]] = 0;
    search->from[starts[i]] = starts[i];
    put(&search->queue, starts[i], true);
  }
  for (size_t taken = 0; search->queue.count; taken++) {
    if (taken % REPORT_EACH == 0 &&
        !spore_progress_part(search->progress, (double)taken / (double)tube->count, _("finding the way"), error))
      return false;
    uint32_t here = take(&search->queue);
    const uint32_t *near = tube->neighbour + SPORE_VOXEL_NEIGHBOURS * (size_t)here;
    for (int k = 0; k < SPORE_VOXEL_NEIGHBOURS; k++) {
      uint32_t next = near[k];
      if (next == SPORE_NO_VOXEL) continue;
      double distance = search->distance[here] + 0.5 * (search->cost[here] + search->cost[next]) * step[k];
      if (!(distance < search->distance[next])) continue;
      bool is_new = search->from[next] == SPORE_NO_VOXEL;
      search->distance[next] = distance;
      search->length[next] = search->length[here] + step[k];
      search->volume[next] = search->volume[here] + tube->depth[next] * tube->depth[next] * step[k];
      search->from[next] = here;
      put(&search->queue, next, is_new);
    }
  }
  return true;
}
