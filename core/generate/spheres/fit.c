/* Fits balls to the depth of a solid by damped least squares, and relocates balls of little worth. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres/fit.h"

#define SMOOTHING 0.02 /* of the typical radius: below it the loss is quadratic, above it linear */
#define DAMPING_INITIAL 1e-2
#define SCORED_CANDIDATES 1500
#define FIRST_ROUNDS 60
#define FILL_EVERY 6
#define LAST_ROUNDS 24
#define SETTLED 1e-5 /* relative change of the loss in a round below which the last rounds end */

static double loss_of(const SporeFit *fit, const SporeField *field) {
  const SporeSamples *s = fit->samples;
  double sum = 0;
  for (size_t i = 0; i < s->points.count; i++)
    sum += s->weight[i] * spore_fit_sample_loss(fit, field->best[i] - s->depth[i]);
  return sum;
}

static void accumulate(SporeFit *fit) {
  memset(fit->normal, 0, 14 * fit->balls.count * sizeof *fit->normal);
  for (size_t i = 0; i < fit->samples->points.count; i++)
    spore_fit_add_normal(fit, i, fit->normal + 14 * (size_t)fit->field.owner[i]);
}

static void step_balls(SporeFit *fit) {
  for (size_t i = 0; i < fit->balls.count; i++) {
    double sphere[4];
    spore_fit_step_ball(fit, i, fit->normal + 14 * i, fit->damping, sphere);
    spore_balls_set(&fit->trial, i, spore_vec3_load(sphere), sphere[3]);
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
  if (loss >= 1.002 * fit->loss) { /* a small increase is accepted, as samples change owners */
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

static bool open_fit(SporeFit *fit, const SporeBalls *balls) {
  size_t n = balls->count;
  fit->normal = SPORE_NEW_ARRAY(double, 14 * n);
  fit->worth = SPORE_NEW_ARRAY(double, n);
  fit->burden = SPORE_NEW_ARRAY(double, n);
  fit->spread = SPORE_NEW_ARRAY(double, 10 * n);
  fit->known = SPORE_NEW_ARRAY(double, 4 * n);
  fit->order = SPORE_NEW_ARRAY(uint32_t, n);
  fit->heaviest = SPORE_NEW_ARRAY(uint32_t, n);
  fit->marked = SPORE_NEW_ARRAY(bool, 2 * n);
  fit->scored_count = fit->candidates->count < SCORED_CANDIDATES ? fit->candidates->count : SCORED_CANDIDATES;
  fit->missing = SPORE_NEW_ARRAY(double, fit->scored_count);
  fit->scored = SPORE_NEW_ARRAY(uint32_t, fit->scored_count);
  fit->by_missing = SPORE_NEW_ARRAY(uint32_t, fit->scored_count);
  return fit->normal && fit->worth && fit->burden && fit->spread && fit->known && fit->order && fit->heaviest &&
         fit->marked && fit->missing && fit->scored && fit->by_missing && spore_balls_create(&fit->balls, n) &&
         spore_balls_create(&fit->trial, n) && spore_balls_create(&fit->best, n) &&
         spore_field_create(&fit->field, &fit->samples->points, n) &&
         spore_field_create(&fit->trial_field, &fit->samples->points, n);
}

static void close_fit(SporeFit *fit) {
  spore_free(fit->normal);
  spore_free(fit->worth);
  spore_free(fit->burden);
  spore_free(fit->spread);
  spore_free(fit->known);
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

/* The last step was accepted and changed the loss by almost nothing. */
static bool settled(const SporeFit *fit, double before) {
  return fit->loss != before && fabs(fit->loss - before) < SETTLED * before;
}

/* Rounds of steps; every few rounds, balls of little worth move to where depth is missing. */
static bool fill(SporeFit *fit, const SporeProgressPart *progress, double from, double to, SporeError *error) {
  for (int round = 0; round < FIRST_ROUNDS; round++) {
    double fraction = from + (to - from) * round / FIRST_ROUNDS;
    if (!spore_progress_part(progress, fraction, _("Fitting spheres"), error)) return false;
    double before = fit->loss;
    take_round(fit);
    spore_progress_show_images(progress, &fit->solid->symmetry, &fit->best, fit->bound);
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

/* Rounds of steps from the best balls so far, until the loss settles. */
static bool settle(SporeFit *fit, int rounds, const SporeProgressPart *progress, double from, double to,
                   SporeError *error) {
  if (!spore_progress_part(progress, from, _("Fitting spheres"), error)) return false;
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

/* Trials of single relocations from the best balls so far. */
static bool relocate(SporeFit *fit, const SporeProgressPart *progress, double from, double to, SporeError *error) {
  SporeProgressPart part = {progress->whole, progress->first + progress->share * from, progress->share * (to - from)};
  if (fit->balls.count < 2) return true;
  spore_balls_copy(&fit->balls, &fit->best);
  evaluate(fit);
  if (!spore_fit_relocate(fit, &part, error)) return false;
  fit->loss = loss_of(fit, &fit->field);
  keep_best(fit);
  return true;
}

bool spore_spheres_fit(const SporeSolid *solid, const SporeSamples *samples, const SporeBalls *candidates,
                       SporeBalls *balls, const uint8_t *bound, bool rough, uint64_t seed,
                       const SporeProgressPart *progress, SporeError *error) {
  SporeFit fit = {.solid = solid,
                  .samples = samples,
                  .candidates = candidates,
                  .bound = bound,
                  .smoothing = SMOOTHING * samples->typical,
                  .best_loss = HUGE_VAL,
                  .damping = DAMPING_INITIAL,
                  .random = {seed}};
  bool done = open_fit(&fit, balls);
  if (!done) spore_generate_no_memory(error);
  if (done) {
    spore_balls_copy(&fit.balls, balls);
    evaluate(&fit);
    keep_best(&fit);
  }
  done = done && fill(&fit, progress, 0, rough ? 1 : 0.2, error);
  if (!rough)
    done = done && relocate(&fit, progress, 0.2, 0.7, error) && settle(&fit, LAST_ROUNDS, progress, 0.7, 0.75, error);
  if (done) spore_balls_copy(balls, &fit.best);
  close_fit(&fit);
  SporeProgressPart last = {progress->whole, progress->first + 0.75 * progress->share, 0.25 * progress->share};
  return done && (rough || spore_spheres_polish(solid, balls, bound, samples->typical, seed, &last, error));
}
