/* What the files that make sphere sets share. */
#ifndef SPORE_GENERATE_SPHERES_PRIVATE_H
#define SPORE_GENERATE_SPHERES_PRIVATE_H

#include "core/generate/spheres/spheres.h"

/* Points in space-filling order, in blocks and groups of blocks. Each block and group has a bounding sphere, which
 * rules out most balls for the whole block or group at once. */
#define SPORE_BLOCK 32
#define SPORE_GROUP 16 /* blocks */
typedef struct SporePoints {
  size_t count, block_count, group_count;
  double *x, *y, *z;  /* count, padded to whole blocks with the last point */
  double *block;      /* block_count x 4: centre and radius */
  double *group;      /* group_count x 4: centre and radius */
  float *local;       /* block_count x 3 x SPORE_BLOCK: columns relative to the block's middle */
  uint32_t *original; /* count: number before sorting */
} SporePoints;
bool spore_points_create(SporePoints *points, const double *xyz, size_t count);
void spore_points_clear(SporePoints *points);

/* Spheres as columns. */
typedef struct SporeBalls {
  size_t count;
  double *x, *y, *z, *r;
} SporeBalls;
bool spore_balls_create(SporeBalls *balls, size_t count);
void spore_balls_clear(SporeBalls *balls);
void spore_balls_copy(SporeBalls *to, const SporeBalls *from);
static inline void spore_balls_set(SporeBalls *balls, size_t i, SporeVec3 centre, double radius) {
  balls->x[i] = centre.x, balls->y[i] = centre.y, balls->z[i] = centre.z, balls->r[i] = radius;
}
static inline SporeVec3 spore_balls_centre(const SporeBalls *balls, size_t i) {
  return spore_vec3(balls->x[i], balls->y[i], balls->z[i]);
}
/* Passes the current balls to the progress callback, to display a long fit. Costs nothing without a callback. */
void spore_progress_show_balls(const SporeProgressPart *part, const SporeBalls *balls);

/* max_i (r_i - |p - c_i|) at each point: the largest value, the ball that has it, and the second largest value
 * (-HUGE_VAL where there is one sphere). Arrays are padded to whole blocks. */
typedef struct SporeField {
  double *best, *second;
  uint32_t *owner;
  double *value;    /* scratch, balls */
  SporeBalls near;  /* scratch: the balls that may own a point of a group */
  uint32_t *number; /* balls: indices of the near balls */
  uint32_t *listed; /* scratch, balls: which of the near balls may own a point of a block */
  float *local;     /* scratch: 5 columns of `capacity` */
  size_t capacity;  /* balls */
} SporeField;
bool spore_field_create(SporeField *field, const SporePoints *points, size_t ball_count);
void spore_field_clear(SporeField *field);
void spore_field_evaluate(SporeField *field, const SporePoints *points, const SporeBalls *balls);
/* The same for one group. Returns the least value that a ball must have at the middle of the group to be best or second
 * best anywhere in the group. */
double spore_field_evaluate_group(SporeField *field, const SporePoints *points, const SporeBalls *balls, size_t group);
/* held: the number of balls that contain each point, padded. */
void spore_field_multiplicity(SporeField *field, const SporePoints *points, const SporeBalls *balls, uint32_t *held);

/* Samples of the signed depth: inside, on the surface, and in a band outside, in that order of kinds before sorting. */
typedef struct SporeSamples {
  SporePoints points;
  double *depth, *weight; /* padded; the padding has weight 0 */
  double band;            /* m: about how far outside the samples go */
  double typical;         /* m: radius of one of `count` equal balls that fill the volume */
} SporeSamples;
bool spore_samples_create(SporeSamples *samples, const SporeSolid *solid, size_t count, SporeRandom *random,
                          const SporeProgressPart *progress, SporeError *error);
/* Another kind of samples: one in each of many small cells, densest at the surface, to samples->band outside. The
 * weights are the cells' volumes (m^3). count: number of balls to fit; typical: as in SporeSamples. */
bool spore_samples_create_graded(SporeSamples *samples, const SporeSolid *solid, size_t count, double typical,
                                 SporeRandom *random, const SporeProgressPart *progress, SporeError *error);
void spore_samples_clear(SporeSamples *samples);

/* Balls inside the solid that touch the surface, most of them on the medial axis. */
bool spore_candidates_create(SporeBalls *candidates, const SporeSolid *solid, size_t count, SporeRandom *random,
                             const SporeProgressPart *progress, SporeError *error);
/* Picks balls->count candidates: each time the one that contains most samples not yet contained. Grows them a little.
 */
bool spore_candidates_cover(const SporeBalls *candidates, const SporeSamples *samples, SporeBalls *balls,
                            const SporeProgressPart *progress, SporeError *error);

/* Moves the balls so that their field matches the samples' depth. `candidates`: places to which balls may be relocated.
 * `bound`: for each ball, the bits of the mirror planes that its centre stays on; NULL: none. `rough`: a shorter fit,
 * as the start of another search. */
bool spore_spheres_fit(const SporeSolid *solid, const SporeSamples *samples, const SporeBalls *candidates,
                       SporeBalls *balls, const uint8_t *bound, bool rough, uint64_t seed,
                       const SporeProgressPart *progress, SporeError *error);

/* Improves the balls of a fit, all together, by the volumes and the depth error that a set is judged by. typical: as in
 * SporeSamples; bound: as above. */
bool spore_spheres_polish(const SporeSolid *solid, SporeBalls *balls, const uint8_t *bound, double typical,
                          uint64_t seed, const SporeProgressPart *progress, SporeError *error);

/* The balls and their images in the planes to which the balls are not bound (bound: as for spore_spheres_fit), x y z r
 * each. spheres: NULL to count only. Returns the number of balls and images. */
size_t spore_balls_images(const SporeSymmetry *symmetry, const SporeBalls *balls, const uint8_t *bound,
                          double *spheres);
/* As spore_progress_show_balls, with all images. */
void spore_progress_show_images(const SporeProgressPart *part, const SporeSymmetry *symmetry, const SporeBalls *balls,
                                const uint8_t *bound);

/* False: a target is out of range, or there is no target; see *error. */
bool spore_targets_check(const SporeSpheresTargets *targets, SporeError *error);
/* Returns false; *error says by how much the largest set misses the targets. */
bool spore_targets_out_of_reach(const SporeSpheresTargets *targets, const SporeSpheresReport *report,
                                SporeError *error);

/* Counts of spheres tried so far; starts all zero. few: the largest count that is too small; enough: the smallest count
 * that reaches the targets (0: none); excess: error over allowed error of these two sets. */
typedef struct SporeTargetSearch {
  size_t few, enough, trials;
  double few_excess, enough_excess;
} SporeTargetSearch;
/* The number to try next. */
size_t spore_target_search_next(const SporeTargetSearch *search);
/* Records the report of a set of `count` spheres. True: the set reaches the targets. */
bool spore_target_search_add(SporeTargetSearch *search, size_t count, const SporeSpheresTargets *targets,
                             const SporeSpheresReport *report);
bool spore_target_search_done(const SporeTargetSearch *search);
bool spore_target_search_failed(const SporeTargetSearch *search);

/* Measures balls against a union of other balls, as spore_spheres_measure does against a solid. */
bool spore_balls_compare(const SporeBalls *whole, const SporeBalls *balls, SporeSpheresReport *report,
                         const SporeProgressPart *progress, SporeError *error);

/* As spore_spheres_from_source, for a curve or a sheet, exactly `count` spheres. */
bool spore_spheres_along(const SporeCurve *curve, size_t count, SporeSphereSet *set, SporeSpheresReport *report,
                         const SporeProgressPart *progress, SporeError *error);
bool spore_spheres_over(const SporeTriangleMesh *sheet, size_t count, const SporeSpheresOptions *options,
                        SporeSphereSet *set, SporeSpheresReport *report, const SporeProgressPart *progress,
                        SporeError *error);

/* (sum_i w_i (r_i - |p - c_i|)+ - level)+ for a set with weights. */
double spore_spheres_weighted_depth(const SporeSphereSet *set, const double p[3]);
/* As spore_spheres_measure, for an existing SporeSolid. */
bool spore_solid_measure(const SporeSolid *solid, const SporeSphereSet *set, SporeSpheresReport *report,
                         const SporeProgressPart *progress, SporeError *error);

#endif
