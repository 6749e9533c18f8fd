/* Balls inside the solid that touch the surface. A fit starts from those that contain most samples. */
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres/private.h"

#define SHRINK_ROUNDS 24
#define REPORT_EVERY 8       /* candidates */
#define COVER_TOLERANCE 0.12 /* of the typical radius: a sample this far outside a ball still counts as contained */

/* Largest ball that touches the surface at p from inside (Ma, Bae and Choi 2012: shrink the ball until its nearest
 * surface point is p itself). False: there is none, as on a wall without thickness. */
static bool shrink_ball(const SporeSolid *solid, SporeVec3 p, SporeVec3 inward, SporeVec3 *centre, double *radius) {
  double r = solid->diagonal / 2, reach = 0;
  for (int round = 0; round < SHRINK_ROUNDS; round++) {
    SporeVec3 nearest;
    *centre = spore_vec3_add_scaled(p, r, inward);
    reach = spore_bvh_distance(solid->bvh, *centre, &nearest, NULL);
    if (reach >= r * (1 - 1e-3)) break;
    SporeVec3 chord = spore_vec3_sub(p, nearest);
    double along = -2 * spore_vec3_dot(chord, inward);
    r = along > 0 ? fmin(spore_vec3_dot(chord, chord) / along, 0.999 * r) : reach;
  }
  *centre = spore_vec3_add_scaled(p, r, inward);
  *radius = reach;
  return reach > 1e-6 * solid->diagonal && spore_bvh_inside(solid->bvh, *centre);
}

/* One candidate in four is a random interior point with its depth as radius, for solids whose surface points give too
 * few good balls. */
bool spore_candidates_create(SporeBalls *candidates, const SporeSolid *solid, size_t count, SporeRandom *random,
                             const SporeProgressPart *progress, SporeError *error) {
  size_t medial = count - count / 4, found = 0;
  double *points = SPORE_NEW_ARRAY(double, 3 * count);
  SporeVec3 *normals = SPORE_NEW_ARRAY(SporeVec3, count);
  bool done = spore_balls_create(candidates, count) && points && normals;
  if (!done) spore_generate_no_memory(error);
  if (done) {
    spore_solid_surface(solid, medial, random, points, normals);
    done = spore_solid_interior(solid, count - medial, random, points + 3 * medial, progress, error);
  }
  for (size_t i = 0; done && i < count; i++) {
    SporeVec3 centre = spore_vec3_load(points + 3 * i);
    double radius;
    if (i % REPORT_EVERY == 0 &&
        !spore_progress_part(progress, (double)i / (double)count, _("Finding candidates"), error))
      done = false;
    else if (i >= medial)
      spore_balls_set(candidates, found++, centre, spore_bvh_distance(solid->bvh, centre, NULL, NULL));
    else if (shrink_ball(solid, centre, spore_vec3_scale(-1, normals[i]), &centre, &radius))
      spore_balls_set(candidates, found++, centre, radius);
  }
  spore_free(points);
  spore_free(normals);
  for (size_t i = 0; i < found; i++)
    spore_balls_set(candidates, i, spore_symmetry_fold(&solid->symmetry, spore_balls_centre(candidates, i)),
                    candidates->r[i]);
  candidates->count = found;
  if (!done) spore_balls_clear(candidates);
  return done;
}

/* Which samples are contained in a chosen ball. Counts by block avoid a look at each sample where a ball contains a
 * whole block. */
typedef struct Cover {
  const SporePoints *points;
  const double *depth;
  double tolerance;
  bool *open;           /* interior sample that no chosen ball contains yet */
  uint16_t *open_count; /* block_count */
  uint16_t *open_group; /* group_count: sums of open_count */
} Cover;

/* As cover_ball, for one block. */
static size_t cover_block(Cover *cover, size_t b, SporeVec3 c, double r, bool take) {
  const double *block = cover->points->block + 4 * b;
  double dx = block[0] - c.x, dy = block[1] - c.y, dz = block[2] - c.z, d2 = dx * dx + dy * dy + dz * dz;
  double outer = r + block[3], inner = r - block[3];
  size_t sum = 0;
  if (d2 > outer * outer) return 0;
  if (inner > 0 && d2 <= inner * inner && !take) return cover->open_count[b];
  for (size_t k = b * SPORE_BLOCK; k < (b + 1) * SPORE_BLOCK; k++) {
    double px = cover->points->x[k] - c.x, py = cover->points->y[k] - c.y, pz = cover->points->z[k] - c.z;
    bool held = cover->open[k] && px * px + py * py + pz * pz <= r * r;
    sum += held;
    if (take && held) cover->open[k] = false, cover->open_count[b]--, cover->open_group[b / SPORE_GROUP]--;
  }
  return sum;
}

/* Counts the open samples in the ball; where `take` is set, closes them. */
static size_t cover_ball(Cover *cover, const SporeBalls *balls, size_t ball, bool take) {
  SporeVec3 c = spore_balls_centre(balls, ball);
  double r = balls->r[ball] + cover->tolerance;
  size_t sum = 0;
  for (size_t g = 0; g < cover->points->group_count; g++) {
    const double *group = cover->points->group + 4 * g;
    if (!cover->open_group[g] || spore_vec3_distance(spore_vec3_load(group), c) > r + group[3]) continue;
    size_t end =
        (g + 1) * SPORE_GROUP < cover->points->block_count ? (g + 1) * SPORE_GROUP : cover->points->block_count;
    for (size_t b = g * SPORE_GROUP; b < end; b++)
      if (cover->open_count[b]) sum += cover_block(cover, b, c, r, take);
  }
  return sum;
}

/* A heap with the largest gain on top; of equal ones the first candidate. */
typedef struct Heap {
  uint32_t *item;
  double *gain; /* by candidate */
  size_t count;
} Heap;

static bool heap_before(const Heap *heap, uint32_t a, uint32_t b) {
  return heap->gain[a] > heap->gain[b] || (heap->gain[a] == heap->gain[b] && a < b);
}

static void heap_sink(Heap *heap, size_t at) {
  for (;;) {
    size_t child = 2 * at + 1;
    if (child >= heap->count) return;
    if (child + 1 < heap->count && heap_before(heap, heap->item[child + 1], heap->item[child])) child++;
    if (!heap_before(heap, heap->item[child], heap->item[at])) return;
    uint32_t swap = heap->item[at];
    heap->item[at] = heap->item[child];
    heap->item[child] = swap;
    at = child;
  }
}

static bool open_cover(Cover *cover, const SporeSamples *samples) {
  const SporePoints *points = &samples->points;
  *cover = (Cover){points,
                   samples->depth,
                   COVER_TOLERANCE * samples->typical,
                   SPORE_NEW_ARRAY(bool, points->block_count *SPORE_BLOCK),
                   SPORE_NEW_ARRAY(uint16_t, points->block_count),
                   SPORE_NEW_ARRAY(uint16_t, points->group_count)};
  if (!cover->open || !cover->open_count || !cover->open_group) return false;
  for (size_t i = 0; i < points->count; i++)
    if (samples->depth[i] > 0) {
      cover->open[i] = true;
      cover->open_count[i / SPORE_BLOCK]++, cover->open_group[i / (SPORE_BLOCK * SPORE_GROUP)]++;
    }
  return true;
}

/* False: cancelled. */
static bool go_on(const Heap *heap, size_t taken, const SporeProgressPart *progress, SporeError *error) {
  double fraction = heap->count ? (double)taken / (double)(taken + heap->count) : 1;
  return spore_progress_part(progress, fraction, _("Choosing candidates"), error);
}

static bool open_heap(Heap *heap, const SporeBalls *candidates) {
  *heap = (Heap){SPORE_NEW_ARRAY(uint32_t, candidates->count), SPORE_NEW_ARRAY(double, candidates->count),
                 candidates->count};
  return heap->item && heap->gain;
}

static bool fill_heap(Heap *heap, Cover *cover, const SporeBalls *candidates, const SporeProgressPart *progress,
                      SporeError *error) {
  for (size_t i = 0; i < candidates->count; i++) {
    if (i % REPORT_EVERY == 0 && !go_on(heap, 0, progress, error)) return false;
    heap->item[i] = (uint32_t)i;
    heap->gain[i] = (double)cover_ball(cover, candidates, i, false);
  }
  for (size_t i = heap->count / 2; i-- > 0;) heap_sink(heap, i);
  return true;
}

/* Takes the best candidate as long as one has a gain. Gains only ever shrink, so a top candidate whose gain is
 * unchanged after a new count is the best of all. False: cancelled. */
static bool take_best(Heap *heap, Cover *cover, const SporeBalls *candidates, SporeBalls *balls, size_t *taken_count,
                      const SporeProgressPart *progress, SporeError *error) {
  size_t taken = 0;
  for (size_t turn = 0; taken < balls->count && heap->count && heap->gain[heap->item[0]] > 0; turn++) {
    if (turn % REPORT_EVERY == 0 && !go_on(heap, taken, progress, error)) return false;
    uint32_t top = heap->item[0];
    double gain = (double)cover_ball(cover, candidates, top, false);
    if (gain < heap->gain[top]) {
      heap->gain[top] = gain;
      heap_sink(heap, 0);
      continue;
    }
    cover_ball(cover, candidates, top, true);
    spore_balls_set(balls, taken++, spore_vec3(candidates->x[top], candidates->y[top], candidates->z[top]),
                    candidates->r[top] + 0.5 * cover->tolerance);
    heap->item[0] = heap->item[--heap->count];
    heap_sink(heap, 0);
  }
  *taken_count = taken;
  return true;
}

bool spore_candidates_cover(const SporeBalls *candidates, const SporeSamples *samples, SporeBalls *balls,
                            const SporeProgressPart *progress, SporeError *error) {
  Cover cover;
  Heap heap = {0};
  size_t taken = 0;
  bool done = (open_cover(&cover, samples) && open_heap(&heap, candidates)) || spore_generate_no_memory(error);
  done = done && fill_heap(&heap, &cover, candidates, progress, error) &&
         take_best(&heap, &cover, candidates, balls, &taken, progress, error);
  if (done) {
    /* more balls were asked for than are needed: the rest starts on the remaining candidates, and the fit relocates
     * them */
    for (size_t i = 0; taken < balls->count; i++) {
      size_t c = heap.count ? heap.item[i % heap.count] : i % candidates->count;
      spore_balls_set(balls, taken++, spore_vec3(candidates->x[c], candidates->y[c], candidates->z[c]),
                      candidates->r[c]);
    }
    done = spore_progress_part(progress, 1, _("Choosing candidates"), error);
  }
  spore_free(cover.open);
  spore_free(cover.open_count);
  spore_free(cover.open_group);
  spore_free(heap.item);
  spore_free(heap.gain);
  return done;
}
