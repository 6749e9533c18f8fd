/* Joint fit of centres, radii and weights: Adam (Kingma and Ba 2015) minimises the mean absolute error of depth. The
 * error is smoothed more at first, so that large errors dominate. Meanwhile, balls of little worth are relocated. */
#include "core/generate/spheres/weighted_parts.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"

#define ROUNDS 1000
#define FIRST_TRIAL 150 /* first round with relocations; then every TRIAL_ROUNDS rounds */
#define TRIAL_ROUNDS 50
#define LAST_TRIAL 700
#define MOST_REPLACED 10 /* at most one ball in this many, in a trial */
#define SAMPLES 4        /* times the samples of a balanced fit, as a ball has a fifth unknown */
#define WHOLE 60000      /* samples: up to this many are all evaluated in a round */
#define PART 35000       /* of more samples, about how many are evaluated in a round */
#define START_LEVEL 0.4  /* of the typical radius */
#define SMOOTHING_FIRST 0.2
#define SMOOTHING_LAST 0.01
#define STEP_FIRST 0.03 /* of the typical radius, and of weights */
#define STEP_LAST 0.0005
#define KEEP_SLOPE 0.9 /* Adam's two rates */
#define KEEP_SQUARE 0.98
#define LEAST_RADIUS 0.05 /* of the typical radius */
#define SURFACE_SHARE 0.3 /* of the weight of surface samples in a balanced fit */
#define START_WEIGHT 0.6
#define START_GROWTH 0.15 /* of the typical radius */

/* The radius within its limits. The depth is computed again only if needed: it changes by no more than the centre
 * moves. */
static double limit(SporeWeightedFit *fit, size_t ball, SporeVec3 centre, double radius) {
  double *known = fit->known + 4 * ball, reach = spore_weighted_reach(fit);
  double least = fmax(known[3] - spore_vec3_distance(centre, spore_vec3_load(known)), 0);
  if (radius > least + reach) {
    spore_vec3_store(known, centre);
    least = known[3] = fmax(spore_bvh_depth(fit->solid->bvh, centre), 0);
  }
  return fmin(fmax(radius, LEAST_RADIUS * fit->samples.typical), least + reach);
}

/* Step length of a round, and Adam's corrections of the running means for the number of rounds so far. */
typedef struct Pace {
  double rate, slopes, squares;
} Pace;

/* The change of one unknown. Updates its running means. */
static double change_of(double slope, double *mean, Pace pace) {
  mean[0] = KEEP_SLOPE * mean[0] + (1 - KEEP_SLOPE) * slope;
  mean[1] = KEEP_SQUARE * mean[1] + (1 - KEEP_SQUARE) * slope * slope;
  return pace.rate * mean[0] / pace.slopes / (sqrt(mean[1] / pace.squares) + 1e-12);
}

/* done: rounds before this one. */
static void step(SporeWeightedFit *fit, int done, double rate) {
  Pace pace = {rate, 1 - pow(KEEP_SLOPE, done + 1), 1 - pow(KEEP_SQUARE, done + 1)};
  double typical = fit->samples.typical;
  for (size_t i = 0; i < fit->balls.count; i++) {
    double change[SPORE_WEIGHTED_UNKNOWNS];
    for (size_t k = 0; k < SPORE_WEIGHTED_UNKNOWNS; k++) {
      size_t unknown = SPORE_WEIGHTED_UNKNOWNS * i + k;
      change[k] = change_of(fit->slope[unknown], fit->running + 2 * unknown, pace);
    }
    SporeVec3 c = spore_vec3_add_scaled(spore_balls_centre(&fit->balls, i), -typical, spore_vec3_load(change));
    c = spore_weighted_confine(fit, i, c);
    spore_balls_set(&fit->balls, i, c, limit(fit, i, c, fit->balls.r[i] - typical * change[3]));
    fit->weights[i] = fmax(fit->weights[i] - change[4], SPORE_WEIGHT_LEAST);
  }
  if (!fit->levelled) return;
  fit->level = fmax(fit->level - typical * change_of(fit->level_slope, fit->level_running, pace), 0);
}

static bool fit_rounds(SporeWeightedFit *fit, const SporeProgressPart *progress, SporeError *error) {
  size_t samples = fit->samples.points.count, parts = samples < WHOLE ? 1 : 1 + samples / PART;
  size_t most = fit->balls.count / MOST_REPLACED + 1;
  for (int round = 0; round < ROUNDS; round++) {
    double share = (double)round / ROUNDS, typical = fit->samples.typical;
    if (!spore_progress_part(progress, share, _("Weighing spheres"), error)) return false;
    fit->smoothing = typical * SMOOTHING_FIRST * pow(SMOOTHING_LAST / SMOOTHING_FIRST, share);
    bool trial = round >= FIRST_TRIAL && round <= LAST_TRIAL && round % TRIAL_ROUNDS == 0 && fit->balls.count > 1;
    if (trial) {
      spore_weighted_evaluate(fit, 0, 1);
      if (!spore_weighted_replace(fit, most)) return spore_generate_no_memory(error);
    }
    spore_weighted_evaluate(fit, (size_t)round % parts, parts);
    step(fit, round, STEP_FIRST * pow(STEP_LAST / STEP_FIRST, share));
    if (round % 8 == 0) spore_progress_show_images(progress, &fit->solid->symmetry, &fit->balls, fit->bound);
  }
  return true;
}

/* Sets the weights of the samples. Samples inside weigh 1 together. Samples outside weigh more where the ratio of
 * surface to volume is larger, as in thin shapes. Otherwise a small gain inside would outweigh a positive depth
 * outside. */
static void share_out(SporeSamples *samples, const SporeSolid *solid) {
  double inside = 0, area = solid->triangle_end[solid->mesh.triangle_count - 1];
  for (size_t k = 0; k < samples->points.count; k++) {
    if (samples->depth[k] > 0) inside += samples->weight[k];
    else samples->weight[k] *= samples->depth[k] < 0 ? area * samples->typical / solid->volume : SURFACE_SHARE;
  }
  for (size_t k = 0; k < samples->points.count; k++) samples->weight[k] /= inside;
}

static bool open_fit(SporeWeightedFit *fit, const SporeBalls *balls) {
  size_t n = balls->count, unknowns = SPORE_WEIGHTED_UNKNOWNS * n;
  size_t images = fit->image_count = n << fit->solid->symmetry.count;
  fit->weights = SPORE_NEW_ARRAY(double, n);
  fit->sum = SPORE_NEW_ARRAY(double, fit->samples.points.block_count *SPORE_BLOCK);
  fit->slope = SPORE_NEW_ARRAY(double, unknowns);
  fit->running = SPORE_NEW_ARRAY(double, 2 * unknowns);
  fit->known = SPORE_NEW_ARRAY(double, 4 * n);
  fit->reaches = SPORE_NEW_ARRAY(uint8_t, images);
  fit->region = SPORE_NEW_ARRAY(double, 4 * (fit->samples.points.group_count / SPORE_WEIGHTED_REGION + 1));
  fit->listed = SPORE_NEW_ARRAY(uint32_t, images);
  fit->loaded = SPORE_NEW_ARRAY(float, fit->samples.points.block_count *SPORE_WEIGHTED_COLUMNS *SPORE_BLOCK);
  fit->distance = SPORE_NEW_ARRAY(float, images *SPORE_BLOCK);
  fit->columns = SPORE_NEW_ARRAY(float, SPORE_WEIGHTED_UNKNOWNS *images);
  fit->slopes = SPORE_NEW_ARRAY(float, SPORE_WEIGHTED_UNKNOWNS *images + 1);
  if (!spore_balls_create(&fit->balls, n) || !fit->weights || !fit->sum || !fit->slope || !fit->running ||
      !fit->known || !fit->reaches || !fit->listed || !fit->region || !fit->loaded || !fit->distance || !fit->columns ||
      !fit->slopes || !spore_weighted_images_create(&fit->images, images) ||
      !spore_weighted_images_create(&fit->near_region, images) ||
      !spore_weighted_images_create(&fit->near_group, images) ||
      !spore_weighted_images_create(&fit->near_block, images))
    return false;
  share_out(&fit->samples, fit->solid);
  spore_weighted_load_samples(fit);
  spore_weighted_bound_regions(fit);
  spore_balls_copy(&fit->balls, balls);
  for (size_t i = 0; i < n; i++) {
    fit->weights[i] = n > 1 ? START_WEIGHT : 1;
    if (n > 1) fit->balls.r[i] += START_GROWTH * fit->samples.typical;
  }
  return true;
}

static void close_fit(SporeWeightedFit *fit) {
  double *const arrays[] = {fit->region, fit->weights, fit->sum, fit->slope, fit->running, fit->known};
  for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) spore_free(arrays[k]);
  spore_weighted_images_clear(&fit->images);
  spore_weighted_images_clear(&fit->near_region);
  spore_weighted_images_clear(&fit->near_group);
  spore_weighted_images_clear(&fit->near_block);
  spore_free(fit->reaches);
  spore_free(fit->listed);
  spore_free(fit->loaded);
  spore_free(fit->distance);
  spore_free(fit->columns);
  spore_free(fit->slopes);
  spore_balls_clear(&fit->balls);
  spore_samples_clear(&fit->samples);
}

bool spore_spheres_weigh(const SporeSolid *solid, SporeBalls *balls, const uint8_t *bound, double *weights,
                         double *level, uint64_t seed, const SporeProgressPart *progress, SporeError *error) {
  SporeRandom random = {seed ^ UINT64_C(0x2545f4914f6cdd1d)};
  SporeProgressPart sampling = {progress->whole, progress->first, 0.2 * progress->share},
                    fitting = {progress->whole, progress->first + 0.2 * progress->share, 0.8 * progress->share};
  SporeWeightedFit fit = {.solid = solid, .bound = bound, .random = {seed}};
  size_t images = spore_balls_images(&solid->symmetry, balls, bound, NULL);
  bool done = spore_samples_create(&fit.samples, solid, SAMPLES * images, &random, &sampling, error);
  if (done) {
    fit.samples.typical *= cbrt(SAMPLES), fit.samples.band *= cbrt(SAMPLES);
    fit.levelled = balls->count > 1; /* for one ball, a level equals a smaller radius */
    fit.level = fit.levelled ? START_LEVEL * fit.samples.typical : 0;
    done = open_fit(&fit, balls) || spore_generate_no_memory(error);
  }
  done = done && fit_rounds(&fit, &fitting, error);
  if (done) spore_balls_copy(balls, &fit.balls);
  if (done) memcpy(weights, fit.weights, balls->count * sizeof *weights);
  *level = fit.level;
  close_fit(&fit);
  return done;
}
