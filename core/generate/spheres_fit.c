#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres_fit.h"

#define SMOOTHING 0.02    /* of the typical radius: below it the loss is quadratic, above it linear */
#define LEAST_RADIUS 0.02 /* of the typical radius */
#define LONGEST_STEP 0.3  /* of the typical radius */
#define DAMPING_INITIAL 1e-2
#define SCORED_CANDIDATES 1500
#define FIRST_ROUNDS 60
#define FILL_EVERY 6
#define TRIALS 60       /* relocations tried, at most */
#define TRIAL_WORK 6000 /* and at most this over the number of balls */
#define TRIAL_ROUNDS 10
#define PATIENCE 12 /* trials in vain, after which no more are made */
#define LAST_ROUNDS 24
#define SETTLED 1e-5 /* relative change of the loss in a round below which the last rounds end */

static double loss_of(const SporeFit *fit, const SporeField *field) {
  const SporeSamples *s = fit->samples;
  double sum = 0;
  for (size_t i = 0; i < s->points.count; i++)
    sum += s->weight[i] * spore_fit_sample_loss(fit, field->best[i] - s->depth[i]);
  return sum;
}

/* Normal equations of each ball over the samples it owns, weighted so that a least-squares step follows the
 * nearly linear loss. */
static void accumulate(SporeFit *fit) {
  const SporeSamples *s = fit->samples;
  double eps2 = fit->smoothing * fit->smoothing;
  memset(fit->normal, 0, 14 * fit->balls.count * sizeof *fit->normal);
  for (size_t i = 0; i < s->points.count; i++) {
    size_t ball = fit->field.owner[i];
    double *m = fit->normal + 14 * ball;
    double e = fit->field.best[i] - s->depth[i], w = s->weight[i] / sqrt(e * e + eps2);
    double u[4] = {s->points.x[i] - fit->balls.x[ball], s->points.y[i] - fit->balls.y[ball],
                   s->points.z[i] - fit->balls.z[ball], 1};
    double length = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]), inverse = length > 1e-300 ? 1 / length : 0;
    for (int k = 0; k < 3; k++) u[k] *= inverse;
    for (int r = 0, at = 0; r < 4; r++) {
      for (int c = 0; c <= r; c++) m[at++] += w * u[r] * u[c];
      m[10 + r] -= w * u[r] * e;
    }
  }
}

/* Solves (A + shift I) x = b by Cholesky; A is the packed lower triangle m[0..9], b is m[10..13]. */
static void solve_damped(const double *m, double shift, double x[4]) {
  double l[10], y[4];
  for (int r = 0, at = 0; r < 4; r++)
    for (int c = 0; c <= r; c++, at++) {
      double sum = m[at] + (r == c ? shift : 0);
      for (int k = 0; k < c; k++) sum -= l[r * (r + 1) / 2 + k] * l[c * (c + 1) / 2 + k];
      l[at] = r == c ? sqrt(fmax(sum, 1e-300)) : sum / l[c * (c + 1) / 2 + c];
    }
  for (int r = 0; r < 4; r++) {
    y[r] = m[10 + r];
    for (int k = 0; k < r; k++) y[r] -= l[r * (r + 1) / 2 + k] * y[k];
    y[r] /= l[r * (r + 1) / 2 + r];
  }
  for (int r = 3; r >= 0; r--) {
    x[r] = y[r];
    for (int k = r + 1; k < 4; k++) x[r] -= l[k * (k + 1) / 2 + r] * x[k];
    x[r] /= l[r * (r + 1) / 2 + r];
  }
}

/* The balls after a damped step, kept from ballooning: no deeper out than the band. */
static void step_balls(SporeFit *fit) {
  double typical = fit->samples->typical, largest = 0;
  for (size_t i = 0; i < fit->balls.count; i++) {
    const double *m = fit->normal + 14 * i;
    largest = fmax(largest, m[0] + m[2] + m[5] + m[9]);
  }
  for (size_t i = 0; i < fit->balls.count; i++) {
    const double *m = fit->normal + 14 * i;
    double x[4];
    solve_damped(m, fit->damping * (m[0] + m[2] + m[5] + m[9] + 1e-12 * largest), x);
    double length = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]);
    double scale = fmin(1, LONGEST_STEP * typical / fmax(length, 1e-300));
    SporeVec3 c =
        spore_vec3(fit->balls.x[i] + scale * x[0], fit->balls.y[i] + scale * x[1], fit->balls.z[i] + scale * x[2]);
    double most = fmax(spore_bvh_depth(fit->solid->bvh, c), 0) + fit->samples->band;
    fit->trial.x[i] = c.x, fit->trial.y[i] = c.y, fit->trial.z[i] = c.z;
    fit->trial.r[i] = fmin(fmax(fit->balls.r[i] + scale * x[3], LEAST_RADIUS * typical), most);
  }
}

static void evaluate(SporeFit *fit) {
  spore_field_evaluate(&fit->field, &fit->samples->points, &fit->balls);
  fit->loss = loss_of(fit, &fit->field);
}

static void keep_best(SporeFit *fit) {
  if (!(fit->loss < fit->best_loss)) return;
  fit->best_loss = fit->loss;
  spore_balls_copy(&fit->best, &fit->balls);
}

static void take_round(SporeFit *fit) {
  accumulate(fit);
  step_balls(fit);
  spore_field_evaluate(&fit->trial_field, &fit->samples->points, &fit->trial);
  double loss = loss_of(fit, &fit->trial_field);
  if (loss >= 1.002 * fit->loss) { /* a little uphill is let pass: owners change */
    fit->damping = fmin(4 * fit->damping, 10);
    return;
  }
  SporeBalls balls = fit->balls;
  SporeField field = fit->field;
  fit->balls = fit->trial, fit->trial = balls;
  fit->field = fit->trial_field, fit->trial_field = field;
  fit->loss = loss;
  fit->damping = fmax(0.6 * fit->damping, 1e-4);
  keep_best(fit);
}

/* Relocates, refits for a few rounds, and goes back to the best when that did not help. Fewer are moved each time it
 * fails, and the choice is blurred so that it differs. */
static bool try_relocation(SporeFit *fit, size_t *wanted, double *shake) {
  spore_balls_copy(&fit->balls, &fit->best);
  evaluate(fit);
  double before = fit->best_loss;
  size_t moved = spore_fit_relocate(fit, *wanted, *shake);
  if (moved) {
    evaluate(fit);
    fit->damping = DAMPING_INITIAL;
    for (int round = 0; round < TRIAL_ROUNDS; round++) take_round(fit);
  }
  if (moved && fit->best_loss < before) return true;
  *wanted = *wanted > 1 ? *wanted * 2 / 3 : 1;
  *shake = fmin(*shake + 0.1, 0.6);
  return false;
}

static bool open_fit(SporeFit *fit, const SporeBalls *balls) {
  size_t n = balls->count;
  fit->normal = SPORE_NEW_ARRAY(double, 14 * n);
  fit->worth = SPORE_NEW_ARRAY(double, n);
  fit->burden = SPORE_NEW_ARRAY(double, n);
  fit->spread = SPORE_NEW_ARRAY(double, 10 * n);
  fit->order = SPORE_NEW_ARRAY(uint32_t, n);
  fit->heaviest = SPORE_NEW_ARRAY(uint32_t, n);
  fit->marked = SPORE_NEW_ARRAY(bool, n);
  fit->scored_count = fit->candidates->count < SCORED_CANDIDATES ? fit->candidates->count : SCORED_CANDIDATES;
  fit->missing = SPORE_NEW_ARRAY(double, fit->scored_count);
  fit->scored = SPORE_NEW_ARRAY(uint32_t, fit->scored_count);
  fit->by_missing = SPORE_NEW_ARRAY(uint32_t, fit->scored_count);
  return fit->normal && fit->worth && fit->burden && fit->spread && fit->order && fit->heaviest && fit->marked &&
         fit->missing && fit->scored && fit->by_missing && spore_balls_create(&fit->balls, n) &&
         spore_balls_create(&fit->trial, n) && spore_balls_create(&fit->best, n) &&
         spore_field_create(&fit->field, &fit->samples->points, n) &&
         spore_field_create(&fit->trial_field, &fit->samples->points, n);
}

static void close_fit(SporeFit *fit) {
  spore_free(fit->normal);
  spore_free(fit->worth);
  spore_free(fit->burden);
  spore_free(fit->spread);
  spore_free(fit->order);
  spore_free(fit->heaviest);
  spore_free(fit->marked);
  spore_free(fit->missing);
  spore_free(fit->scored);
  spore_free(fit->by_missing);
  spore_balls_clear(&fit->balls);
  spore_balls_clear(&fit->trial);
  spore_balls_clear(&fit->best);
  spore_field_clear(&fit->field);
  spore_field_clear(&fit->trial_field);
}

/* The last round was taken, and changed next to nothing. */
static bool settled(const SporeFit *fit, double before) {
  return fit->loss != before && fabs(fit->loss - before) < SETTLED * before;
}

/* Rounds in which balls of little worth go where depth is missing. */
static bool fill(SporeFit *fit, const SporeProgressPart *progress, double from, double to, SporeError *error) {
  for (int round = 0; round < FIRST_ROUNDS; round++) {
    double fraction = from + (to - from) * round / FIRST_ROUNDS;
    if (!spore_progress_part(progress, fraction, _("Fitting spheres"), error)) return false;
    double before = fit->loss;
    take_round(fit);
    spore_progress_show_balls(progress, &fit->best);
    if (round % FILL_EVERY != FILL_EVERY - 1) continue;
    if (!spore_fit_fill(fit, (size_t)round)) {
      if (settled(fit, before)) break;
      continue;
    }
    evaluate(fit);
    keep_best(fit);
    fit->damping = DAMPING_INITIAL;
  }
  return true;
}

/* Rounds from the best so far, until the loss settles. */
static bool settle(SporeFit *fit, int rounds, const SporeProgressPart *progress, double from, double to,
                   SporeError *error) {
  spore_balls_copy(&fit->balls, &fit->best);
  evaluate(fit);
  fit->damping = DAMPING_INITIAL;
  for (int round = 0; round < rounds; round++) {
    double fraction = from + (to - from) * round / rounds, before = fit->loss;
    if (!spore_progress_part(progress, fraction, _("Fitting spheres"), error)) return false;
    take_round(fit);
    if (settled(fit, before)) break;
  }
  return true;
}

static bool relocate_all(SporeFit *fit, const SporeProgressPart *progress, double from, double to, SporeError *error) {
  size_t wanted = fit->balls.count / 10 + 1;
  int failures = 0;
  double shake = 0;
  if (fit->balls.count < 2) return true;
  size_t trials = TRIAL_WORK / fit->balls.count < TRIALS ? TRIAL_WORK / fit->balls.count : TRIALS;
  for (size_t trial = 0; trial < trials && failures < PATIENCE; trial++) {
    double fraction = from + (to - from) * (double)trial / (double)trials;
    if (!spore_progress_part(progress, fraction, _("Fitting spheres"), error)) return false;
    failures = try_relocation(fit, &wanted, &shake) ? 0 : failures + 1;
    spore_progress_show_balls(progress, &fit->best);
  }
  return true;
}

bool spore_spheres_fit(const SporeSolid *solid, const SporeSamples *samples, const SporeBalls *candidates,
                       SporeBalls *balls, uint64_t seed, const SporeProgressPart *progress, SporeError *error) {
  SporeFit fit = {.solid = solid,
                  .samples = samples,
                  .candidates = candidates,
                  .smoothing = SMOOTHING * samples->typical,
                  .best_loss = HUGE_VAL,
                  .damping = DAMPING_INITIAL,
                  .random = {seed}};
  bool done = open_fit(&fit, balls);
  if (!done) spore_spheres_no_memory(error);
  if (done) {
    spore_balls_copy(&fit.balls, balls);
    evaluate(&fit);
    keep_best(&fit);
  }
  done = done && fill(&fit, progress, 0, 0.2, error) && relocate_all(&fit, progress, 0.2, 0.9, error) &&
         settle(&fit, LAST_ROUNDS, progress, 0.9, 1, error);
  if (done) spore_balls_copy(balls, &fit.best);
  close_fit(&fit);
  return done;
}
