/* Joint fit of centres, radii and weights by damped least squares (Levenberg and Marquardt), each step by conjugate
 * gradients on the normal equations; samples are weighted anew each round so that the sum follows the absolute error.
 */
#include "core/generate/spheres_weighted_parts.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"

#define UNKNOWNS 5 /* of a ball: centre, radius, weight */
#define ROUNDS 200
#define FIRST_TRIAL 45 /* round: of relocations; then one every so many rounds */
#define TRIAL_ROUNDS 15
#define LAST_TRIAL 150
#define SAMPLES 2       /* times as many as a balanced fit takes: there is a fifth unknown, and fewer overlap */
#define WEIGHT_ROUNDS 8 /* first, in which only weights change */
#define CONJUGATE_STEPS 20
#define CONJUGATE_TOLERANCE 1e-2
#define SMOOTHING 0.02      /* of the typical radius: below it the loss is quadratic, above it linear; at the end */
#define SMOOTHING_FIRST 0.3 /* at first */
#define SMOOTHING_FALL 0.93 /* a round */
#define LEAST_RADIUS 0.05   /* of the typical radius */
#define LONGEST_STEP 0.3    /* of the typical radius, of a centre or radius in a round */
#define OUTSIDE_SHARE 0.35  /* of what the samples weigh there in a balanced fit: the sum cannot meet both as well */
#define START_WEIGHT 0.6
#define START_GROWTH 0.15 /* of the typical radius */
#define DAMPING_INITIAL 1e-2

static bool add_pair(SporeWeightedFit *fit, size_t sample, size_t ball, SporeVec3 offset, double distance,
                     double radius) {
  SporeWeightedPair *pairs =
      spore_room_for_one(fit->pairs, fit->pair_count, &fit->pair_capacity, 262144, sizeof *pairs);
  if (!pairs) return false;
  fit->pairs = pairs;
  double inverse = distance > 0 ? 1 / distance : 0;
  fit->pairs[fit->pair_count++] =
      (SporeWeightedPair){(uint32_t)sample,
                          (uint32_t)ball,
                          {(float)(offset.x * inverse), (float)(offset.y * inverse), (float)(offset.z * inverse)},
                          (float)(radius - distance)};
  return true;
}

/* Of the ball's image in the planes: a sample is as far from it as the sample's image is from the ball. */
static bool find_pairs_of_image(SporeWeightedFit *fit, const SporeBalls *balls, size_t ball, unsigned planes) {
  const SporePoints *points = &fit->samples.points;
  const SporeSymmetry *symmetry = &fit->solid->symmetry;
  SporeVec3 c = spore_balls_centre(balls, ball), image = spore_symmetry_mirror(symmetry, planes, c);
  double r = balls->r[ball];
  for (size_t b = 0; b < points->block_count; b++) {
    const double *block = points->block + 4 * b;
    if (spore_vec3_distance(spore_vec3_load(block), image) >= r + block[3]) continue;
    size_t end = (b + 1) * SPORE_BLOCK < points->count ? (b + 1) * SPORE_BLOCK : points->count;
    for (size_t k = b * SPORE_BLOCK; k < end; k++) {
      SporeVec3 p = spore_vec3(points->x[k], points->y[k], points->z[k]);
      SporeVec3 offset = spore_vec3_sub(planes ? spore_symmetry_mirror(symmetry, planes, p) : p, c);
      double d2 = spore_vec3_dot(offset, offset);
      if (d2 < r * r && !add_pair(fit, k, ball, offset, sqrt(d2), r)) return false;
    }
  }
  return true;
}

static bool find_pairs_of(SporeWeightedFit *fit, const SporeBalls *balls, size_t ball) {
  for (unsigned planes = 0; planes < 1u << fit->solid->symmetry.count; planes++)
    if (!(planes & fit->bound[ball]) && !find_pairs_of_image(fit, balls, ball, planes)) return false;
  return true;
}

/* Of f against the depth; weighs the samples on the way. */
static double loss_of(SporeWeightedFit *fit) {
  double loss = 0, least = fit->smoothing * fit->smoothing;
  for (size_t k = 0; k < fit->samples.points.count; k++) {
    double wrong = fit->sum[k] - fmax(fit->samples.depth[k], 0), size = sqrt(wrong * wrong + least);
    fit->importance[k] = fit->samples.weight[k] / size;
    loss += fit->samples.weight[k] * size;
  }
  return loss;
}

bool spore_weighted_evaluate(SporeWeightedFit *fit, const SporeBalls *balls, const double *weights) {
  size_t count = fit->samples.points.count;
  fit->pair_count = 0;
  for (size_t i = 0; i < balls->count; i++)
    if (!find_pairs_of(fit, balls, i)) return false;
  memset(fit->sum, 0, count * sizeof *fit->sum);
  for (size_t p = 0; p < fit->pair_count; p++)
    fit->sum[fit->pairs[p].sample] += weights[fit->pairs[p].ball] * (double)fit->pairs[p].depth;
  fit->loss = loss_of(fit);
  return true;
}

/* Slopes of f at the pair's sample by the unknowns of its ball; lengths count in typical radii. */
static void slopes(const SporeWeightedFit *fit, const SporeWeightedPair *pair, double slope[UNKNOWNS]) {
  double scale = fit->weights_only ? 0 : fit->weights[pair->ball] * fit->samples.typical;
  for (int k = 0; k < 3; k++) slope[k] = scale * (double)pair->out[k];
  slope[3] = scale;
  slope[4] = (double)pair->depth;
}

static void find_gradient(SporeWeightedFit *fit) {
  size_t unknowns = UNKNOWNS * fit->balls.count;
  memset(fit->gradient, 0, unknowns * sizeof *fit->gradient);
  memset(fit->diagonal, 0, unknowns * sizeof *fit->diagonal);
  for (size_t p = 0; p < fit->pair_count; p++) {
    const SporeWeightedPair *pair = &fit->pairs[p];
    double slope[UNKNOWNS], importance = fit->importance[pair->sample];
    double wrong = fit->sum[pair->sample] - fmax(fit->samples.depth[pair->sample], 0);
    slopes(fit, pair, slope);
    for (int k = 0; k < UNKNOWNS; k++) {
      fit->gradient[UNKNOWNS * pair->ball + (size_t)k] += importance * wrong * slope[k];
      fit->diagonal[UNKNOWNS * pair->ball + (size_t)k] += importance * slope[k] * slope[k];
    }
  }
  double largest = 0;
  for (size_t i = 0; i < unknowns; i++) largest = fmax(largest, fit->diagonal[i]);
  for (size_t i = 0; i < unknowns; i++) fit->diagonal[i] += 1e-9 * largest;
}

/* product = (J^T W J + damping * diagonal) direction */
static void multiply(SporeWeightedFit *fit) {
  size_t unknowns = UNKNOWNS * fit->balls.count;
  memset(fit->along, 0, fit->samples.points.count * sizeof *fit->along);
  for (size_t p = 0; p < fit->pair_count; p++) {
    const SporeWeightedPair *pair = &fit->pairs[p];
    const double *direction = fit->direction + UNKNOWNS * pair->ball;
    double slope[UNKNOWNS], sum = 0;
    slopes(fit, pair, slope);
    for (int k = 0; k < UNKNOWNS; k++) sum += slope[k] * direction[k];
    fit->along[pair->sample] += sum;
  }
  for (size_t i = 0; i < unknowns; i++) fit->product[i] = fit->damping * fit->diagonal[i] * fit->direction[i];
  for (size_t p = 0; p < fit->pair_count; p++) {
    const SporeWeightedPair *pair = &fit->pairs[p];
    double slope[UNKNOWNS], along = fit->importance[pair->sample] * fit->along[pair->sample];
    slopes(fit, pair, slope);
    for (int k = 0; k < UNKNOWNS; k++) fit->product[UNKNOWNS * pair->ball + (size_t)k] += along * slope[k];
  }
}

static double dot(const double *a, const double *b, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += a[i] * b[i];
  return sum;
}

/* Conjugate gradients with the diagonal before: step = -(J^T W J + damping * diagonal)^-1 gradient. */
static void solve(SporeWeightedFit *fit) {
  size_t n = UNKNOWNS * fit->balls.count;
  double square = 0, first;
  memset(fit->step, 0, n * sizeof *fit->step);
  for (size_t i = 0; i < n; i++) {
    fit->residual[i] = -fit->gradient[i];
    fit->direction[i] = fit->residual[i] / fit->diagonal[i];
    square += fit->residual[i] * fit->direction[i];
  }
  first = square;
  for (int k = 0; k < CONJUGATE_STEPS && square > CONJUGATE_TOLERANCE * CONJUGATE_TOLERANCE * first; k++) {
    multiply(fit);
    double alpha = square / dot(fit->direction, fit->product, n), before = square;
    square = 0;
    for (size_t i = 0; i < n; i++) {
      fit->step[i] += alpha * fit->direction[i];
      fit->residual[i] -= alpha * fit->product[i];
      square += fit->residual[i] * fit->residual[i] / fit->diagonal[i];
    }
    for (size_t i = 0; i < n; i++)
      fit->direction[i] = fit->residual[i] / fit->diagonal[i] + square / before * fit->direction[i];
  }
}

SporeVec3 spore_weighted_confine(const SporeWeightedFit *fit, size_t ball, SporeVec3 centre) {
  const SporeSymmetry *symmetry = &fit->solid->symmetry;
  if (!symmetry->count) return centre;
  return spore_symmetry_bind(symmetry, fit->bound[ball], spore_symmetry_fold(symmetry, centre));
}

/* The balls after the step; no deeper out than the band of the samples outside, which would not see it. */
static void take_step(SporeWeightedFit *fit) {
  double typical = fit->samples.typical;
  for (size_t i = 0; i < fit->balls.count; i++) {
    const double *s = fit->step + UNKNOWNS * i;
    SporeVec3 move = spore_vec3_scale(typical, spore_vec3(s[0], s[1], s[2]));
    double length = fmax(spore_vec3_length(move), fabs(s[3]) * typical);
    double part = fmin(1, LONGEST_STEP * typical / fmax(length, 1e-300));
    SporeVec3 c = spore_vec3_add_scaled(spore_balls_centre(&fit->balls, i), part, move);
    c = spore_weighted_confine(fit, i, c);
    double most = fmax(spore_bvh_depth(fit->solid->bvh, c), 0) + fit->samples.band;
    double radius = fit->balls.r[i] + part * s[3] * typical;
    spore_balls_set(&fit->trial, i, c, fmin(fmax(radius, LEAST_RADIUS * typical), most));
    fit->trial_weights[i] = fmax(fit->weights[i] + s[4], fmax(SPORE_WEIGHT_LEAST, 0.3 * fit->weights[i]));
  }
}

/* False: no memory. */
static bool take_round(SporeWeightedFit *fit) {
  double before = fit->loss;
  find_gradient(fit);
  solve(fit);
  take_step(fit);
  if (!spore_weighted_evaluate(fit, &fit->trial, fit->trial_weights)) return false;
  if (fit->loss >= before) {
    fit->damping = fmin(5 * fit->damping, 1e3);
    return spore_weighted_evaluate(fit, &fit->balls, fit->weights);
  }
  SporeBalls balls = fit->balls;
  double *weights = fit->weights;
  fit->balls = fit->trial, fit->trial = balls;
  fit->weights = fit->trial_weights, fit->trial_weights = weights;
  fit->damping = fmax(0.4 * fit->damping, 1e-5);
  return true;
}

/* The loss and what had it. */
typedef struct Kept {
  SporeBalls balls;
  double *weights, loss;
} Kept;

static void keep(Kept *kept, const SporeWeightedFit *fit) {
  spore_balls_copy(&kept->balls, &fit->balls);
  memcpy(kept->weights, fit->weights, fit->balls.count * sizeof *kept->weights);
  kept->loss = fit->loss;
}

/* Ends a trial of relocations, of which those that did not pay are undone, and begins another. False: no memory. */
static bool relocate(SporeWeightedFit *fit, Kept *kept, size_t *most) {
  size_t replaced;
  if (kept->loss > 0 && fit->loss >= kept->loss) {
    spore_balls_copy(&fit->balls, &kept->balls);
    memcpy(fit->weights, kept->weights, fit->balls.count * sizeof *kept->weights);
    *most = (*most + 1) / 2;
    if (!spore_weighted_evaluate(fit, &fit->balls, fit->weights)) return false;
  }
  keep(kept, fit);
  fit->damping = DAMPING_INITIAL;
  return spore_weighted_replace(fit, *most, &replaced) &&
         (!replaced || spore_weighted_evaluate(fit, &fit->balls, fit->weights));
}

static bool fit_rounds(SporeWeightedFit *fit, Kept *kept, const SporeProgressPart *progress, SporeError *error) {
  size_t most = fit->balls.count / 10 + 1;
  for (int round = 0; round < ROUNDS; round++) {
    if (!spore_progress_part(progress, (double)round / ROUNDS, _("Weighing spheres"), error)) return false;
    fit->weights_only = round < WEIGHT_ROUNDS;
    fit->smoothing = fmax(SMOOTHING, SMOOTHING_FIRST * pow(SMOOTHING_FALL, round)) * fit->samples.typical;
    fit->loss = loss_of(fit);
    bool trial = round >= FIRST_TRIAL && round <= LAST_TRIAL && (round - FIRST_TRIAL) % TRIAL_ROUNDS == 0;
    if (trial && fit->balls.count > 1 && !relocate(fit, kept, &most)) return spore_spheres_no_memory(error);
    if (!take_round(fit)) return spore_spheres_no_memory(error);
    spore_progress_show_images(progress, &fit->solid->symmetry, &fit->balls, fit->bound);
  }
  if (kept->loss > 0 && fit->loss > kept->loss) {
    spore_balls_copy(&fit->balls, &kept->balls);
    memcpy(fit->weights, kept->weights, fit->balls.count * sizeof *kept->weights);
  }
  return true;
}

static bool open_fit(SporeWeightedFit *fit, const SporeBalls *balls) {
  size_t n = balls->count, unknowns = UNKNOWNS * n, samples = fit->samples.points.block_count * SPORE_BLOCK;
  double **const rows[] = {&fit->gradient, &fit->diagonal, &fit->step, &fit->residual, &fit->direction, &fit->product};
  bool done = spore_balls_create(&fit->balls, n) && spore_balls_create(&fit->trial, n);
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) done = (*rows[k] = SPORE_NEW_ARRAY(double, unknowns)) && done;
  fit->weights = SPORE_NEW_ARRAY(double, n);
  fit->trial_weights = SPORE_NEW_ARRAY(double, n);
  fit->sum = SPORE_NEW_ARRAY(double, samples);
  fit->importance = SPORE_NEW_ARRAY(double, samples);
  fit->along = SPORE_NEW_ARRAY(double, samples);
  if (!done || !fit->weights || !fit->trial_weights || !fit->sum || !fit->importance || !fit->along) return false;
  for (size_t k = 0; k < fit->samples.points.count; k++)
    if (fit->samples.depth[k] <= 0) fit->samples.weight[k] *= OUTSIDE_SHARE;
  spore_balls_copy(&fit->balls, balls);
  for (size_t i = 0; i < n; i++) {
    fit->weights[i] = n > 1 ? START_WEIGHT : 1;
    if (n > 1) fit->balls.r[i] += START_GROWTH * fit->samples.typical;
  }
  return spore_weighted_evaluate(fit, &fit->balls, fit->weights);
}

static void close_fit(SporeWeightedFit *fit) {
  double *const arrays[] = {fit->gradient,      fit->diagonal,   fit->step,    fit->residual,
                            fit->direction,     fit->product,    fit->weights, fit->sum,
                            fit->trial_weights, fit->importance, fit->along};
  for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) spore_free(arrays[k]);
  spore_free(fit->pairs);
  spore_balls_clear(&fit->balls);
  spore_balls_clear(&fit->trial);
  spore_samples_clear(&fit->samples);
}

bool spore_spheres_weigh(const SporeSolid *solid, SporeBalls *balls, const uint8_t *bound, double *weights,
                         uint64_t seed, const SporeProgressPart *progress, SporeError *error) {
  SporeRandom random = {seed ^ UINT64_C(0x2545f4914f6cdd1d)};
  SporeProgressPart sampling = {progress->whole, progress->first, 0.1 * progress->share},
                    fitting = {progress->whole, progress->first + 0.1 * progress->share, 0.9 * progress->share};
  SporeWeightedFit fit = {.solid = solid, .bound = bound, .damping = DAMPING_INITIAL, .random = {seed}};
  Kept kept = {.weights = SPORE_NEW_ARRAY(double, balls->count)};
  bool done = spore_samples_create(&fit.samples, solid, SAMPLES * balls->count, &random, &sampling, error);
  if (done) {
    fit.samples.typical *= cbrt(SAMPLES), fit.samples.band *= cbrt(SAMPLES);
    fit.smoothing = SMOOTHING_FIRST * fit.samples.typical;
    done = (spore_balls_create(&kept.balls, balls->count) && kept.weights && open_fit(&fit, balls)) ||
           spore_spheres_no_memory(error);
  }
  done = done && fit_rounds(&fit, &kept, &fitting, error);
  if (done) spore_balls_copy(balls, &fit.balls);
  if (done) memcpy(weights, fit.weights, balls->count * sizeof *weights);
  spore_balls_clear(&kept.balls);
  spore_free(kept.weights);
  close_fit(&fit);
  return done;
}
