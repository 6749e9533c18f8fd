/* Places where two loops of an organ are grown together: necks that a path takes as a short cut, which leaves out the
 * loop between. Such a neck is closed to the path if the path then follows more of the organ. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/centreline/search.h"

#define BESIDE 3.0 /* radii along the path from what is left out: the neck lies within */
#define AHEAD 2.5  /* radii along the path on both sides of a neck: there the path is in the middle of a loop */
#define NARROW 0.9 /* of the least of the largest depths on both sides: a neck is narrower */
#define HALF 0.9   /* voxels: half the thickness of a cut, which no step from voxel to voxel crosses */
#define LOOP 3.0   /* sums of two depths along the path: farther places are of two loops */
#define SAME 0.6   /* sums of two depths: nearer places are in one section */
#define REACH 4.0  /* radii from the narrowest place: a neck is no longer along the loops */

/* The path with its measures. */
typedef struct Way {
  const SporeVoxelTube *tube;
  const SporeVoxelPath *path;
  double *along; /* m from the beginning */
} Way;

static double depth_at(const Way *way, size_t i) { return way->tube->depth[way->path->voxel[i]]; }

static SporeVec3 middle_at(const Way *way, size_t i) { return spore_voxel_middle(way->tube, way->path->voxel[i]); }

static bool way_create(Way *way, const SporeVoxelTube *tube, const SporeVoxelPath *path) {
  *way = (Way){tube, path, SPORE_NEW_ARRAY(double, path->count)};
  if (!way->along) return false;
  for (size_t i = 1; i < path->count; i++)
    way->along[i] = way->along[i - 1] + spore_vec3_distance(middle_at(way, i - 1), middle_at(way, i));
  return true;
}

/* The lesser of the largest depths on both sides of a point of the path, within `reach` (m). */
static double depth_beside(const Way *way, size_t i, double reach) {
  double before = 0, after = 0;
  for (size_t k = i + 1; k-- > 0 && way->along[i] - way->along[k] <= reach;) before = fmax(before, depth_at(way, k));
  for (size_t k = i; k < way->path->count && way->along[k] - way->along[i] <= reach; k++)
    after = fmax(after, depth_at(way, k));
  return fmin(before, after);
}

/* The narrowest place of the path between two distances, by its depth over that on both sides; the path's count: there
 * is no neck. */
static size_t find_neck(const Way *way, double from, double to, double radius, double *narrow) {
  size_t neck = way->path->count;
  *narrow = NARROW;
  for (size_t i = 0; i < way->path->count; i++) {
    if (way->along[i] < from || way->along[i] > to) continue;
    double share = depth_at(way, i) / depth_beside(way, i, AHEAD * radius);
    if (share < *narrow) *narrow = share, neck = i;
  }
  return neck;
}

static SporeVec3 direction_at(const Way *way, size_t i, double reach) {
  size_t before = i, after = i;
  while (before > 0 && way->along[i] - way->along[before] < reach) before--;
  while (after + 1 < way->path->count && way->along[after] - way->along[i] < reach) after++;
  return spore_vec3_normalise(spore_vec3_sub(middle_at(way, after), middle_at(way, before)), spore_vec3(1, 0, 0));
}

/* Marks the section of the organ through a neck, across the path: voxels that hang together in it. */
static void mark_section(const Way *way, size_t neck, double radius, bool *cut, uint32_t *stack) {
  const SporeVoxelTube *tube = way->tube;
  SporeVec3 centre = middle_at(way, neck), across = direction_at(way, neck, depth_at(way, neck));
  size_t waiting = 0;
  stack[waiting++] = way->path->voxel[neck];
  cut[way->path->voxel[neck]] = true;
  while (waiting) {
    const uint32_t *near = tube->neighbour + SPORE_VOXEL_NEIGHBOURS * (size_t)stack[--waiting];
    for (int k = 0; k < SPORE_VOXEL_NEIGHBOURS; k++) {
      if (near[k] == SPORE_NO_VOXEL || cut[near[k]] || tube->depth[near[k]] > NARROW * radius) continue;
      SporeVec3 away = spore_vec3_sub(spore_voxel_middle(tube, near[k]), centre);
      if (fabs(spore_vec3_dot(away, across)) > HALF * tube->edge || spore_vec3_length(away) > REACH * radius) continue;
      cut[near[k]] = true;
      stack[waiting++] = near[k];
    }
  }
}

static double mean_depth(const Way *way) {
  double sum = 0;
  for (size_t i = 0; i < way->path->count; i++) sum += depth_at(way, i);
  return sum / (double)way->path->count;
}

/* Marks the narrowest neck of the path beside one of the pieces that it leaves out. False: it has none there. */
static bool mark_neck(const Way *way, size_t piece, bool *cut, uint32_t *stack) {
  double radius = mean_depth(way), narrow;
  const SporeVoxelStretch *beside = &way->path->beside[piece];
  size_t neck = find_neck(way, beside->from - BESIDE * radius, beside->to + BESIDE * radius, radius, &narrow);
  if (neck == way->path->count) return false;
  mark_section(way, neck, depth_beside(way, neck, AHEAD * radius), cut, stack);
  return true;
}

bool spore_voxel_path_mark_neck(const SporeVoxelPath *path, const SporeVoxelTube *tube, size_t piece, bool *cut,
                                bool *marked, SporeError *error) {
  Way way;
  uint32_t *stack = SPORE_NEW_ARRAY(uint32_t, tube->count);
  bool room = way_create(&way, tube, path) && stack;
  *marked = room && mark_neck(&way, piece, cut, stack);
  spore_free(stack);
  spore_free(way.along);
  return room || spore_generate_no_memory(error);
}

bool spore_voxel_path_narrowest(const SporeVoxelPath *path, const SporeVoxelTube *tube, double *narrow,
                                SporeError *error) {
  Way way;
  if (!way_create(&way, tube, path)) return spore_generate_no_memory(error);
  double radius = mean_depth(&way);
  find_neck(&way, AHEAD * radius, way.along[path->count - 1] - AHEAD * radius, radius, narrow);
  spore_free(way.along);
  return true;
}

/* Whether two places of the path, farther from each other along it than a loop is thick, lie in the same section. */
static bool doubles_back(const Way *way) {
  for (size_t i = 0; i < way->path->count; i++) {
    double depth = depth_at(way, i);
    for (size_t k = i + 1; k < way->path->count; k++) {
      double both = depth + depth_at(way, k);
      if (way->along[k] - way->along[i] > LOOP * both &&
          spore_vec3_distance(middle_at(way, i), middle_at(way, k)) < SAME * both)
        return true;
    }
  }
  return false;
}

bool spore_voxel_path_is_sound(const SporeVoxelPath *path, const SporeVoxelTube *tube, const bool *cut, bool *sound,
                               SporeError *error) {
  Way way;
  if (!way_create(&way, tube, path)) return spore_generate_no_memory(error);
  *sound = !doubles_back(&way);
  for (size_t i = 0; i < path->count; i++) *sound = *sound && !cut[path->voxel[i]];
  spore_free(way.along);
  return true;
}
