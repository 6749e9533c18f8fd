/* Joint fit of centres, radii and weights by damped least squares (Levenberg and Marquardt), each step by conjugate
 * gradients on the normal equations; samples are weighted anew each round so that the sum follows the absolute error.
 */
#include "core/generate/spheres_weighted.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"

#define UNKNOWNS 5 /* of a ball: centre, radius, weight */
#define ROUNDS 120
#define WEIGHT_ROUNDS 8 /* first, in which only weights change */
#define CONJUGATE_STEPS 20
#define CONJUGATE_TOLERANCE 1e-2
#define SMOOTHING 0.02      /* of the typical radius: below it the loss is quadratic, above it linear; at the end */
#define SMOOTHING_FIRST 0.3 /* at first */
#define SMOOTHING_FALL 0.93 /* a round */
#define LEAST_WEIGHT 0.01
#define LEAST_RADIUS 0.05 /* of the typical radius */
#define LONGEST_STEP 0.3  /* of the typical radius, of a centre or radius in a round */
#define OUTSIDE_SHARE 0.5 /* of what the samples weigh there in a balanced fit: the sum cannot meet both as well */
#define START_WEIGHT 0.6
#define START_GROWTH 0.15 /* of the typical radius */
#define DAMPING_INITIAL 1e-2
#define SETTLED 2e-5 /* relative change of the loss in a round, below which it ends */

/* Where a ball says something: a sample in it. */
typedef struct Pair {
  uint32_t sample, ball;
  float out[3]; /* from the centre to the sample, of length 1 */
  float depth;  /* m */
} Pair;

typedef struct Fit {
  const SporeSolid *solid;
  SporeSamples samples;
  SporeBalls balls, trial;
  double *weights, *trial_weights;
  Pair *pairs;
  size_t pair_count, pair_capacity;
  double *sum, *importance, *along;                                    /* a sample: f; weight of its square; scratch */
  double *gradient, *diagonal, *step, *residual, *direction, *product; /* UNKNOWNS x balls */
  double smoothing, damping, loss;
  bool weights_only;
} Fit;

static bool add_pair(Fit *fit, size_t sample, size_t ball, SporeVec3 offset, double distance, double radius) {
  if (fit->pair_count == fit->pair_capacity) {
    size_t capacity = fit->pair_capacity ? 2 * fit->pair_capacity : 262144;
    Pair *grown = spore_reallocate(fit->pairs, fit->pair_capacity, capacity, sizeof *grown);
    if (!grown) return false;
    fit->pairs = grown;
    fit->pair_capacity = capacity;
  }
  double inverse = distance > 0 ? 1 / distance : 0;
  fit->pairs[fit->pair_count++] =
      (Pair){(uint32_t)sample,
             (uint32_t)ball,
             {(float)(offset.x * inverse), (float)(offset.y * inverse), (float)(offset.z * inverse)},
             (float)(radius - distance)};
  return true;
}

static bool find_pairs_of(Fit *fit, const SporeBalls *balls, size_t ball) {
  const SporePoints *points = &fit->samples.points;
  SporeVec3 c = spore_balls_centre(balls, ball);
  double r = balls->r[ball];
  for (size_t b = 0; b < points->block_count; b++) {
    const double *block = points->block + 4 * b;
    if (spore_vec3_distance(spore_vec3_load(block), c) >= r + block[3]) continue;
    size_t end = (b + 1) * SPORE_BLOCK < points->count ? (b + 1) * SPORE_BLOCK : points->count;
    for (size_t k = b * SPORE_BLOCK; k < end; k++) {
      SporeVec3 offset = spore_vec3_sub(spore_vec3(points->x[k], points->y[k], points->z[k]), c);
      double d2 = spore_vec3_dot(offset, offset);
      if (d2 < r * r && !add_pair(fit, k, ball, offset, sqrt(d2), r)) return false;
    }
  }
  return true;
}

/* Of f against the depth; weighs the samples on the way. */
static double loss_of(Fit *fit) {
  double loss = 0, least = fit->smoothing * fit->smoothing;
  for (size_t k = 0; k < fit->samples.points.count; k++) {
    double wrong = fit->sum[k] - fmax(fit->samples.depth[k], 0), size = sqrt(wrong * wrong + least);
    fit->importance[k] = fit->samples.weight[k] / size;
    loss += fit->samples.weight[k] * size;
  }
  return loss;
}

/* Pairs, f and the loss of the balls. False: no memory. */
static bool evaluate(Fit *fit, const SporeBalls *balls, const double *weights) {
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
static void slopes(const Fit *fit, const Pair *pair, double slope[UNKNOWNS]) {
  double scale = fit->weights_only ? 0 : fit->weights[pair->ball] * fit->samples.typical;
  for (int k = 0; k < 3; k++) slope[k] = scale * (double)pair->out[k];
  slope[3] = scale;
  slope[4] = (double)pair->depth;
}

static void find_gradient(Fit *fit) {
  size_t unknowns = UNKNOWNS * fit->balls.count;
  memset(fit->gradient, 0, unknowns * sizeof *fit->gradient);
  memset(fit->diagonal, 0, unknowns * sizeof *fit->diagonal);
  for (size_t p = 0; p < fit->pair_count; p++) {
    const Pair *pair = &fit->pairs[p];
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
static void multiply(Fit *fit) {
  size_t unknowns = UNKNOWNS * fit->balls.count;
  memset(fit->along, 0, fit->samples.points.count * sizeof *fit->along);
  for (size_t p = 0; p < fit->pair_count; p++) {
    const Pair *pair = &fit->pairs[p];
    const double *direction = fit->direction + UNKNOWNS * pair->ball;
    double slope[UNKNOWNS], sum = 0;
    slopes(fit, pair, slope);
    for (int k = 0; k < UNKNOWNS; k++) sum += slope[k] * direction[k];
    fit->along[pair->sample] += sum;
  }
  for (size_t i = 0; i < unknowns; i++) fit->product[i] = fit->damping * fit->diagonal[i] * fit->direction[i];
  for (size_t p = 0; p < fit->pair_count; p++) {
    const Pair *pair = &fit->pairs[p];
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
static void solve(Fit *fit) {
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

/* The balls after the step; no deeper out than the band of the samples outside, which would not see it. */
static void take_step(Fit *fit) {
  double typical = fit->samples.typical;
  for (size_t i = 0; i < fit->balls.count; i++) {
    const double *s = fit->step + UNKNOWNS * i;
    SporeVec3 move = spore_vec3_scale(typical, spore_vec3(s[0], s[1], s[2]));
    double length = fmax(spore_vec3_length(move), fabs(s[3]) * typical);
    double part = fmin(1, LONGEST_STEP * typical / fmax(length, 1e-300));
    SporeVec3 c = spore_vec3_add_scaled(spore_balls_centre(&fit->balls, i), part, move);
    double most = fmax(spore_bvh_depth(fit->solid->bvh, c), 0) + fit->samples.band;
    double radius = fit->balls.r[i] + part * s[3] * typical;
    spore_balls_set(&fit->trial, i, c, fmin(fmax(radius, LEAST_RADIUS * typical), most));
    fit->trial_weights[i] = fmax(fit->weights[i] + s[4], fmax(LEAST_WEIGHT, 0.3 * fit->weights[i]));
  }
}

/* False: no memory. */
static bool take_round(Fit *fit) {
  double before = fit->loss;
  find_gradient(fit);
  solve(fit);
  take_step(fit);
  if (!evaluate(fit, &fit->trial, fit->trial_weights)) return false;
  if (fit->loss >= before) {
    fit->damping = fmin(5 * fit->damping, 1e3);
    return evaluate(fit, &fit->balls, fit->weights);
  }
  SporeBalls balls = fit->balls;
  double *weights = fit->weights;
  fit->balls = fit->trial, fit->trial = balls;
  fit->weights = fit->trial_weights, fit->trial_weights = weights;
  fit->damping = fmax(0.4 * fit->damping, 1e-5);
  return true;
}

static bool fit_rounds(Fit *fit, const SporeProgressPart *progress, SporeError *error) {
  int settled = 0;
  for (int round = 0; round < ROUNDS && settled < 4; round++) {
    if (!spore_progress_part(progress, (double)round / ROUNDS, _("Weighing spheres"), error)) return false;
    fit->weights_only = round < WEIGHT_ROUNDS;
    fit->smoothing = fmax(SMOOTHING, SMOOTHING_FIRST * pow(SMOOTHING_FALL, round)) * fit->samples.typical;
    fit->loss = loss_of(fit);
    double before = fit->loss;
    if (!take_round(fit)) return spore_spheres_no_memory(error);
    settled = round > 40 && before - fit->loss < SETTLED * before ? settled + 1 : 0;
    spore_progress_show_balls(progress, &fit->balls);
  }
  return true;
}

static bool open_fit(Fit *fit, const SporeBalls *balls) {
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
  return evaluate(fit, &fit->balls, fit->weights);
}

static void close_fit(Fit *fit) {
  double *const arrays[] = {fit->gradient,      fit->diagonal,   fit->step,    fit->residual,
                            fit->direction,     fit->product,    fit->weights, fit->sum,
                            fit->trial_weights, fit->importance, fit->along};
  for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) spore_free(arrays[k]);
  spore_free(fit->pairs);
  spore_balls_clear(&fit->balls);
  spore_balls_clear(&fit->trial);
  spore_samples_clear(&fit->samples);
}

bool spore_spheres_weigh(const SporeSolid *solid, SporeBalls *balls, double *weights, uint64_t seed,
                         const SporeProgressPart *progress, SporeError *error) {
  SporeRandom random = {seed ^ UINT64_C(0x2545f4914f6cdd1d)};
  SporeProgressPart sampling = {progress->whole, progress->first, 0.1 * progress->share},
                    fitting = {progress->whole, progress->first + 0.1 * progress->share, 0.9 * progress->share};
  Fit fit = {.solid = solid, .damping = DAMPING_INITIAL};
  if (!spore_samples_create(&fit.samples, solid, balls->count, &random, &sampling, error)) return false;
  fit.smoothing = SMOOTHING_FIRST * fit.samples.typical;
  bool done = open_fit(&fit, balls) || spore_spheres_no_memory(error);
  done = done && fit_rounds(&fit, &fitting, error);
  if (done) spore_balls_copy(balls, &fit.balls);
  if (done) memcpy(weights, fit.weights, balls->count * sizeof *weights);
  close_fit(&fit);
  return done;
}
