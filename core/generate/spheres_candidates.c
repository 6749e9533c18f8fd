#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres_parts.h"

#define SHRINK_ROUNDS 24
#define COVER_TOLERANCE 0.12 /* of the typical radius: how far outside a ball a sample counts as held */

/* Largest ball that touches the surface at p from inside (Ma, Bae and Choi 2012: shrink it until its nearest surface
 * point is p itself). False: none, as on a wall without thickness. */
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
  return reach > 1e-6 * solid->diagonal && spore_bvh_winding(solid->bvh, *centre) > 0.5;
}

/* One in four candidates is a plain interior point with its depth, for solids whose surface tells too little. */
bool spore_candidates_create(SporeBalls *candidates, const SporeSolid *solid, size_t count, SporeRandom *random,
                             const SporeProgressPart *progress, SporeError *error) {
  size_t medial = count - count / 4, found = 0;
  double *points = SPORE_NEW_ARRAY(double, 3 * count);
  SporeVec3 *normals = SPORE_NEW_ARRAY(SporeVec3, count);
  bool done = spore_balls_create(candidates, count) && points && normals;
  if (!done) spore_spheres_no_memory(error);
  if (done) {
    spore_solid_surface(solid, medial, random, points, normals);
    spore_solid_interior(solid, count - medial, random, points + 3 * medial);
  }
  for (size_t i = 0; done && i < count; i++) {
    SporeVec3 centre = spore_vec3_load(points + 3 * i);
    double radius;
    if (i % 256 == 0 && !spore_progress_part(progress, (double)i / (double)count, _("Finding candidates"), error))
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

/* Which samples are held, with a count a block, so that a ball over a whole block need not look inside. */
typedef struct Cover {
  const SporePoints *points;
  const double *depth;
  double tolerance;
  bool *open;           /* interior sample not yet held */
  uint16_t *open_count; /* block_count */
} Cover;

/* Counts the open samples in the ball; where `take` is set, closes them. */
static size_t cover_ball(Cover *cover, const SporeBalls *balls, size_t ball, bool take) {
  double x = balls->x[ball], y = balls->y[ball], z = balls->z[ball], r = balls->r[ball] + cover->tolerance;
  size_t sum = 0;
  for (size_t b = 0; b < cover->points->block_count; b++) {
    if (!cover->open_count[b]) continue;
    const double *block = cover->points->block + 4 * b;
    double dx = block[0] - x, dy = block[1] - y, dz = block[2] - z, d2 = dx * dx + dy * dy + dz * dz;
    double outer = r + block[3], inner = r - block[3];
    if (d2 > outer * outer) continue;
    if (inner > 0 && d2 <= inner * inner && !take) {
      sum += cover->open_count[b];
      continue;
    }
    for (size_t k = b * SPORE_BLOCK; k < (b + 1) * SPORE_BLOCK; k++) {
      double px = cover->points->x[k] - x, py = cover->points->y[k] - y, pz = cover->points->z[k] - z;
      bool held = cover->open[k] && px * px + py * py + pz * pz <= r * r;
      sum += held;
      if (take && held) cover->open[k] = false, cover->open_count[b]--;
    }
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
  *cover =
      (Cover){points, samples->depth, COVER_TOLERANCE * samples->typical,
              SPORE_NEW_ARRAY(bool, points->block_count *SPORE_BLOCK), SPORE_NEW_ARRAY(uint16_t, points->block_count)};
  if (!cover->open || !cover->open_count) return false;
  for (size_t i = 0; i < points->count; i++)
    if (samples->depth[i] > 0) cover->open[i] = true, cover->open_count[i / SPORE_BLOCK]++;
  return true;
}

static bool fill_heap(Heap *heap, Cover *cover, const SporeBalls *candidates) {
  *heap = (Heap){SPORE_NEW_ARRAY(uint32_t, candidates->count), SPORE_NEW_ARRAY(double, candidates->count),
                 candidates->count};
  if (!heap->item || !heap->gain) return false;
  for (size_t i = 0; i < candidates->count; i++) {
    heap->item[i] = (uint32_t)i;
    heap->gain[i] = (double)cover_ball(cover, candidates, i, false);
  }
  for (size_t i = heap->count / 2; i-- > 0;) heap_sink(heap, i);
  return true;
}

/* Takes the best candidate while any adds something: a stale gain only ever shrinks, so the top that stays on top after
 * being counted again is the best of all. */
static size_t take_best(Heap *heap, Cover *cover, const SporeBalls *candidates, SporeBalls *balls) {
  size_t taken = 0;
  while (taken < balls->count && heap->count && heap->gain[heap->item[0]] > 0) {
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
  return taken;
}

bool spore_candidates_cover(const SporeBalls *candidates, const SporeSamples *samples, SporeBalls *balls,
                            const SporeProgressPart *progress, SporeError *error) {
  Cover cover;
  Heap heap = {0};
  bool done = open_cover(&cover, samples) && fill_heap(&heap, &cover, candidates);
  if (!done) spore_spheres_no_memory(error);
  if (done) {
    size_t taken = take_best(&heap, &cover, candidates, balls);
    /* more were asked than are needed: the rest starts on the remaining candidates, and the fit finds them work */
    for (size_t i = 0; taken < balls->count; i++) {
      size_t c = heap.count ? heap.item[i % heap.count] : i % candidates->count;
      spore_balls_set(balls, taken++, spore_vec3(candidates->x[c], candidates->y[c], candidates->z[c]),
                      candidates->r[c]);
    }
    done = spore_progress_part(progress, 1, _("Finding candidates"), error);
  }
  spore_free(cover.open);
  spore_free(cover.open_count);
  spore_free(heap.item);
  spore_free(heap.gain);
  return done;
}
