/* Side branches and loops of an organ: the parts that the path through its middle leaves out, longest first. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/centreline/search.h"

#define SIDE 2.0   /* radii from the path within which a voxel belongs to it */
#define BRANCH 3.0 /* radii from the path to the tip of a branch, at least */
#define THIN 0.75  /* of the mean depth of the path */
#define APART 6.0  /* radii along the path between the two places that a loop joins, at least */

typedef struct Leftovers {
  const SporeVoxelSearch *search;
  const SporeVoxelPath *path;
  double *along;  /* path: m from the beginning */
  double *radius; /* path: the largest depth nearby, at least THIN of the mean */
  uint32_t *foot; /* voxel: index on the path of the nearest voxel of the path */
  bool *seen;     /* voxel: near the path, or counted */
  uint32_t *stack;
} Leftovers;

static void leftovers_clear(Leftovers *left) {
  spore_free(left->along);
  spore_free(left->radius);
  spore_free(left->foot);
  spore_free(left->seen);
  spore_free(left->stack);
}

static bool leftovers_create(Leftovers *left, const SporeVoxelSearch *search, const SporeVoxelPath *path) {
  size_t count = search->tube->count;
  *left = (Leftovers){.search = search, .path = path};
  left->along = SPORE_NEW_ARRAY(double, path->count);
  left->radius = SPORE_NEW_ARRAY(double, path->count);
  left->foot = SPORE_NEW_ARRAY(uint32_t, count);
  left->seen = SPORE_NEW_ARRAY(bool, count);
  left->stack = SPORE_NEW_ARRAY(uint32_t, count);
  return left->along && left->radius && left->foot && left->seen && left->stack;
}

/* The path begins and ends in a corner. So each point takes the largest depth nearby as its radius. */
static void measure_path(Leftovers *left) {
  const SporeVoxelTube *tube = left->search->tube;
  const SporeVoxelPath *path = left->path;
  double mean = 0;
  for (size_t i = 1; i < path->count; i++)
    left->along[i] = left->along[i - 1] + spore_vec3_distance(spore_voxel_middle(tube, path->voxel[i - 1]),
                                                              spore_voxel_middle(tube, path->voxel[i]));
  for (size_t i = 0; i < path->count; i++) {
    double depth = tube->depth[path->voxel[i]];
    for (size_t k = i; k < path->count && left->along[k] - left->along[i] <= 2 * depth; k++)
      left->radius[k] = fmax(left->radius[k], depth);
    for (size_t k = i + 1; k-- > 0 && left->along[i] - left->along[k] <= 2 * depth;)
      left->radius[k] = fmax(left->radius[k], depth);
    mean += depth / (double)path->count;
  }
  for (size_t i = 0; i < path->count; i++) left->radius[i] = fmax(left->radius[i], THIN * mean);
}

/* Each path is followed back only until a voxel whose foot is known; the foot of every voxel passed is stored. */
static void find_feet(Leftovers *left) {
  const SporeVoxelSearch *search = left->search;
  memset(left->foot, 0xff, search->tube->count * sizeof *left->foot);
  for (size_t i = 0; i < left->path->count; i++) left->foot[left->path->voxel[i]] = (uint32_t)i;
  for (uint32_t i = 0; i < search->tube->count; i++) {
    if (search->from[i] == SPORE_NO_VOXEL) continue;
    uint32_t known = i;
    while (left->foot[known] == SPORE_NO_VOXEL) known = search->from[known];
    for (uint32_t k = i; left->foot[k] == SPORE_NO_VOXEL; k = search->from[k]) left->foot[k] = left->foot[known];
  }
}

static double mark_near(Leftovers *left) {
  const SporeVoxelTube *tube = left->search->tube;
  size_t near = 0, all = 0;
  for (size_t i = 0; i < tube->count; i++) {
    if (tube->component[i]) continue;
    left->seen[i] = left->search->length[i] <= SIDE * left->radius[left->foot[i]] + tube->edge;
    near += left->seen[i];
    all++;
  }
  return (double)near / (double)all;
}

/* Collects one piece off the path: its farthest voxel, whether it rejoins the path elsewhere, and how far along. */
static uint32_t take_piece(Leftovers *left, uint32_t start, SporeVoxelStretch *beside, bool *returns, double *ring) {
  const SporeVoxelSearch *search = left->search;
  double first = HUGE_VAL, last = -HUGE_VAL, radius = 0, whole = left->along[left->path->count - 1];
  bool inner = false;
  size_t waiting = 0;
  uint32_t far = start;
  left->stack[waiting++] = start;
  left->seen[start] = true;
  while (waiting) {
    uint32_t here = left->stack[--waiting];
    if (search->length[here] > search->length[far]) far = here;
    for (int k = 0; k < SPORE_VOXEL_NEIGHBOURS; k++) {
      uint32_t next = search->tube->neighbour[SPORE_VOXEL_NEIGHBOURS * (size_t)here + (size_t)k];
      if (next == SPORE_NO_VOXEL) continue;
      double reach = left->radius[left->foot[next]];
      if (search->length[next] <= SIDE * reach + search->tube->edge) {
        double along = left->along[left->foot[next]];
        first = fmin(first, along);
        last = fmax(last, along);
        inner = inner || fabs(along / whole - 0.5) < 0.25;
        radius = fmax(radius, reach);
      } else if (!left->seen[next]) {
        left->seen[next] = true;
        left->stack[waiting++] = next;
      }
    }
  }
  *beside = (SporeVoxelStretch){first, last};
  *returns = last - first > APART * radius;
  if (!inner) *ring = fmax(*ring, (last - first) / whole);
  return far;
}

static void name_branch(SporeCentrelineReport *report, SporeVoxelPath *path, const SporeCentrelineBranch *branch,
                        const SporeVoxelStretch *beside) {
  size_t at = report->branches < SPORE_CENTRELINE_NAMED ? report->branches : SPORE_CENTRELINE_NAMED;
  report->branches++;
  while (at > 0 && report->branch[at - 1].length < branch->length) at--;
  if (at == SPORE_CENTRELINE_NAMED) return;
  memmove(report->branch + at + 1, report->branch + at, (SPORE_CENTRELINE_NAMED - at - 1) * sizeof *report->branch);
  memmove(path->beside + at + 1, path->beside + at, (SPORE_CENTRELINE_NAMED - at - 1) * sizeof *path->beside);
  report->branch[at] = *branch;
  path->beside[at] = *beside;
}

bool spore_voxel_search_leftovers(SporeVoxelSearch *search, SporeVoxelPath *path, SporeCentrelineReport *report,
                                  SporeError *error) {
  const SporeVoxelTube *tube = search->tube;
  Leftovers left;
  for (size_t i = 0; i < tube->count; i++) search->cost[i] = 1;
  if (!spore_voxel_search_spread(search, path->voxel, path->count, error)) return false;
  if (!path->near) path->near = SPORE_NEW_ARRAY(bool, tube->count);
  if (!path->way) path->way = SPORE_NEW_ARRAY(float, tube->count);
  bool room = leftovers_create(&left, search, path) && path->near && path->way;
  if (room) {
    measure_path(&left);
    find_feet(&left);
    path->ring = 0;
    path->followed = mark_near(&left);
    for (size_t i = 0; i < tube->count; i++)
      path->way[i] = search->from[i] == SPORE_NO_VOXEL ? INFINITY : (float)search->length[i];
    memcpy(path->near, left.seen, tube->count * sizeof *path->near);
  }
  for (uint32_t i = 0; room && i < tube->count; i++) {
    if (tube->component[i] || left.seen[i]) continue;
    SporeCentrelineBranch branch = {0};
    SporeVoxelStretch beside;
    uint32_t far = take_piece(&left, i, &beside, &branch.returns, &path->ring), foot = left.foot[far];
    branch.from = left.along[foot];
    branch.length = search->length[far] - left.radius[foot];
    spore_vec3_store(branch.foot, spore_voxel_middle(tube, path->voxel[foot]));
    spore_vec3_store(branch.end, spore_voxel_middle(tube, far));
    if (search->length[far] > BRANCH * left.radius[foot]) name_branch(report, path, &branch, &beside);
  }
  leftovers_clear(&left);
  return room || spore_generate_no_memory(error);
}
