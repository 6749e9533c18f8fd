/* The path through the voxels of an organ that covers most of it, between two far ends or two given ones. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/centreline/search.h"

/* The cost of a path falls with this power of the depth, so that the path keeps to the middle and avoids the narrow
 * neck where two loops touch. Each power is tried, and the path that covers most of the organ is kept. A low power
 * takes too many necks; a high power avoids narrow parts that belong to the organ. */
static const double powers[] = {3, 6, 12};
#define POWERS (sizeof powers / sizeof *powers)
#define MUCH 0.85    /* of the largest volume of a path: paths with more than this are compared by length */
#define ENOUGH 0.995 /* covered share above which no other power is tried */
#define LEAST 0.4    /* covered share below which the organ is no tube, and what is narrow in it no neck */
#define LONGER 2.0   /* mean radii by which a branch must be longer than the end that it replaces: a diameter */
#define MOST_CHANGES 4
#define CUT 1e9 /* what a section that is closed costs, over what it would cost */
#define MOST_CUTS 64
#define MOST_IN_VAIN 8 /* cuts that gain nothing, in a row */
#define GAIN 0.002     /* share of the organ that a cut must gain */

static void set_costs(SporeVoxelSearch *search, double power) {
  double deepest = 0;
  for (size_t i = 0; i < search->tube->count; i++) deepest = fmax(deepest, search->tube->depth[i]);
  for (size_t i = 0; i < search->tube->count; i++)
    search->cost[i] = pow(deepest / search->tube->depth[i], power) * (search->cut[i] ? CUT : 1);
}

static bool is_end(const SporeVoxelSearch *search, uint32_t voxel) {
  const uint32_t *near = search->tube->neighbour + SPORE_VOXEL_NEIGHBOURS * (size_t)voxel;
  if (search->from[voxel] == SPORE_NO_VOXEL) return false;
  for (int k = 0; k < SPORE_VOXEL_NEIGHBOURS; k++)
    if (near[k] != SPORE_NO_VOXEL && search->length[near[k]] > search->length[voxel]) return false;
  return true;
}

/* The end of the longest of the cheapest paths. Paths that run around the organ and end where they meet are long
 * too, so the volume of the path must be nearly the largest. */
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
  spore_free(path->near);
  spore_free(path->way);
  *path = (SporeVoxelPath){0};
}

/* The path by which the search reached `end`. */
static bool trace(const SporeVoxelSearch *search, uint32_t end, SporeVoxelPath *path) {
  size_t count = 1;
  for (uint32_t i = end; search->from[i] != i; i = search->from[i]) count++;
  *path = (SporeVoxelPath){.count = count, .voxel = SPORE_NEW_ARRAY(uint32_t, count)};
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
  return trace(search, ends ? ends[1] : farthest(search), path) || spore_generate_no_memory(error);
}

static double length_of(const SporeVoxelTube *tube, const SporeVoxelPath *path, size_t from, size_t to) {
  double length = 0;
  for (size_t i = from; i < to; i++)
    length +=
        spore_vec3_distance(spore_voxel_middle(tube, path->voxel[i]), spore_voxel_middle(tube, path->voxel[i + 1]));
  return length;
}

static double mean_depth(const SporeVoxelTube *tube, const SporeVoxelPath *path) {
  double sum = 0;
  for (size_t i = 0; i < path->count; i++) sum += tube->depth[path->voxel[i]];
  return sum / (double)path->count;
}

/* Length of the path from the joint to its front or its other end. The last part, which runs into the corner of a
 * wide end, is subtracted: the largest depth of the outer half. */
static double length_to_end(const SporeVoxelTube *tube, const SporeVoxelPath *path, size_t joint, bool front) {
  size_t from = front ? 0 : joint, to = front ? joint : path->count - 1, half = (to - from) / 2;
  double corner = 0;
  for (size_t i = 0; i <= half; i++) corner = fmax(corner, tube->depth[path->voxel[front ? from + i : to - i]]);
  return length_of(tube, path, from, to) - corner;
}

/* The path with a branch that replaces one end, from the joint on. front: the front end is replaced. */
static bool join_branch(const SporeVoxelPath *way, const SporeVoxelPath *branch, size_t joint, bool front,
                        SporeVoxelPath *joined) {
  size_t kept = front ? way->count - joint : joint + 1, count = kept + branch->count - 1;
  *joined = (SporeVoxelPath){.count = count, .voxel = SPORE_NEW_ARRAY(uint32_t, count)};
  if (!joined->voxel) return false;
  for (size_t i = 0; i < kept; i++) joined->voxel[i] = way->voxel[front ? way->count - 1 - i : i];
  memcpy(joined->voxel + kept, branch->voxel + 1, (branch->count - 1) * sizeof *branch->voxel);
  return true;
}

/* Lets the path end in this branch if the branch is longer than the path from the joint to its nearer end. */
static bool take_branch(SporeVoxelSearch *search, double power, const SporeCentrelineBranch *branch,
                        SporeVoxelPath *path, bool *taken, SporeError *error) {
  SporeVoxelPath side, joined;
  uint32_t end = spore_voxel_nearest(search->tube, spore_vec3_load(branch->end));
  size_t joint = 0;
  set_costs(search, power);
  if (!spore_voxel_search_spread(search, path->voxel, path->count, error)) return false;
  if (!trace(search, end, &side)) return spore_generate_no_memory(error);
  while (path->voxel[joint] != side.voxel[0]) joint++;
  double before = length_to_end(search->tube, path, joint, true);
  double behind = length_to_end(search->tube, path, joint, false);
  bool done = true;
  *taken =
      length_to_end(search->tube, &side, 0, false) > fmin(before, behind) + LONGER * mean_depth(search->tube, path);
  if (*taken) {
    done = join_branch(path, &side, joint, before < behind, &joined) || spore_generate_no_memory(error);
    if (done) {
      spore_voxel_path_clear(path);
      *path = joined;
    }
  }
  spore_voxel_path_clear(&side);
  return done;
}

/* The cheapest path to a far end is not always the longest: a branch of the path may be longer than the end itself. */
static bool take_longer_ends(SporeVoxelSearch *search, double power, SporeVoxelPath *path,
                             SporeCentrelineReport *report, const SporeCentrelineReport *clean, SporeError *error) {
  for (int change = 0; change < MOST_CHANGES; change++) {
    bool taken = false;
    for (size_t i = 0; !taken && i < SPORE_CENTRELINE_NAMED && i < report->branches; i++)
      if (!report->branch[i].returns && !take_branch(search, power, &report->branch[i], path, &taken, error))
        return false;
    if (!taken) return true;
    *report = *clean;
    if (!spore_voxel_search_leftovers(search, path, report, error)) return false;
  }
  return true;
}

/* The path by one power of the costs, with what it leaves out. */
static bool find_by(SporeVoxelSearch *search, double power, const uint32_t *ends, SporeVoxelPath *way,
                    SporeCentrelineReport *left, const SporeCentrelineReport *clean, SporeError *error) {
  *left = *clean;
  set_costs(search, power);
  return find_way(search, ends, way, error) && spore_voxel_search_leftovers(search, way, left, error) &&
         (ends || take_longer_ends(search, power, way, left, clean, error));
}

/* Whether another path is better: it follows more, and between given ends, where nothing says that all of the organ is
 * meant, it also passes no narrower neck. */
static bool is_better(const SporeVoxelSearch *search, const SporeVoxelPath *other, const SporeVoxelPath *path,
                      bool given, bool *better, SporeError *error) {
  double narrow[2];
  *better = other->followed > path->followed + GAIN;
  if (*better && !spore_voxel_path_is_sound(other, search->tube, search->cut, better, error)) return false;
  if (!*better || !given) return true;
  if (!spore_voxel_path_narrowest(other, search->tube, &narrow[0], error) ||
      !spore_voxel_path_narrowest(path, search->tube, &narrow[1], error))
    return false;
  *better = narrow[0] > narrow[1];
  return true;
}

/* A path with one more cut, beside a piece that the path left out; kept if it is better. */
static bool try_cut(SporeVoxelSearch *search, double power, const uint32_t *ends, size_t piece, SporeVoxelPath *path,
                    SporeCentrelineReport *report, const SporeCentrelineReport *clean, bool *better,
                    SporeError *error) {
  size_t size = search->tube->count * sizeof *search->cut;
  bool *before = SPORE_NEW_ARRAY(bool, search->tube->count), marked = false;
  SporeVoxelPath other = {0};
  SporeCentrelineReport left;
  *better = false;
  if (!before) return spore_generate_no_memory(error);
  memcpy(before, search->cut, size);
  bool done = spore_voxel_path_mark_neck(path, search->tube, piece, search->cut, &marked, error);
  if (done && marked)
    done = find_by(search, power, ends, &other, &left, clean, error) &&
           is_better(search, &other, path, ends, better, error);
  if (done && *better) {
    spore_voxel_path_clear(path);
    *path = other, *report = left;
  } else {
    memcpy(search->cut, before, size);
    spore_voxel_path_clear(&other);
  }
  spore_free(before);
  return done;
}

/* Closes necks, one by one, while the path gains by it. */
static bool cut_necks(SporeVoxelSearch *search, double power, const uint32_t *ends, SporeVoxelPath *path,
                      SporeCentrelineReport *report, const SporeCentrelineReport *clean, SporeError *error) {
  size_t piece = 0, vain = 0;
  for (size_t cuts = 0; cuts < MOST_CUTS && vain < MOST_IN_VAIN; cuts++) {
    bool better;
    if (piece >= SPORE_CENTRELINE_NAMED || piece >= report->branches) return true;
    if (!try_cut(search, power, ends, piece, path, report, clean, &better, error)) return false;
    piece = better ? 0 : piece + 1;
    vain = better ? 0 : vain + 1;
  }
  return true;
}

bool spore_voxel_path_find(SporeVoxelPath *path, const SporeVoxelTube *tube, const uint32_t *ends,
                           SporeCentrelineReport *report, const SporeProgressPart *progress, SporeError *error) {
  SporeVoxelSearch search;
  const SporeCentrelineReport clean = *report;
  double power = powers[0];
  *path = (SporeVoxelPath){0};
  if (!spore_voxel_search_create(&search, tube, progress, error)) return false;
  bool done = true;
  for (size_t i = 0; done && i < POWERS && path->followed < ENOUGH; i++) {
    SporeVoxelPath way = {0};
    SporeCentrelineReport left;
    done = find_by(&search, powers[i], ends, &way, &left, &clean, error);
    if (done && way.followed > path->followed) {
      spore_voxel_path_clear(path);
      *path = way, *report = left, power = powers[i];
    } else spore_voxel_path_clear(&way);
  }
  done = done && (path->followed >= ENOUGH || path->followed < LEAST ||
                  cut_necks(&search, power, ends, path, report, &clean, error));
  spore_voxel_search_clear(&search);
  if (!done) spore_voxel_path_clear(path);
  return done;
}
