#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres_parts.h"

#define ROUNDS 120
#define LAST_ROUNDS 24 /* without relocation */
#define RELOCATE_EVERY 6
#define SMOOTHING 0.02    /* of the typical radius: below it the loss is quadratic, above it linear */
#define LEAST_RADIUS 0.02 /* of the typical radius */
#define LONGEST_STEP 0.3  /* of the typical radius */
#define DAMPING_INITIAL 1e-2
#define SCORED_CANDIDATES 1500

typedef struct Fit {
  const SporeSolid *solid;
  const SporeSamples *samples;
  const SporeBalls *candidates;
  SporeBalls balls, trial, best;
  SporeField field, trial_field;
  double *normal;  /* balls x 14: lower triangle of the 4x4 matrix, and the right-hand side */
  double *gain;    /* balls: loss that its removal adds */
  uint32_t *order; /* balls */
  double *score;   /* scored candidates */
  uint32_t *scored, *score_order;
  size_t scored_count;
  double smoothing, loss, best_loss, damping;
} Fit;

static double loss_of(const Fit *fit, const SporeField *field) {
  const SporeSamples *s = fit->samples;
  double sum = 0, eps2 = fit->smoothing * fit->smoothing;
  for (size_t i = 0; i < s->points.count; i++) {
    double e = field->best[i] - s->depth[i];
    sum += s->weight[i] * sqrt(e * e + eps2);
  }
  return sum;
}

/* Normal equations of each ball over the samples it owns, weighted so that a least-squares step follows the
 * nearly linear loss. */
static void accumulate(Fit *fit) {
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
static void step_balls(Fit *fit) {
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

static void evaluate(Fit *fit) {
  spore_field_evaluate(&fit->field, &fit->samples->points, &fit->balls);
  fit->loss = loss_of(fit, &fit->field);
}

static void keep_best(Fit *fit) {
  if (!(fit->loss < fit->best_loss)) return;
  fit->best_loss = fit->loss;
  spore_balls_copy(&fit->best, &fit->balls);
}

static void take_round(Fit *fit) {
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

/* What each ball is worth: the loss its removal would add, its samples going to the second best. */
static void score_balls(Fit *fit) {
  const SporeSamples *s = fit->samples;
  memset(fit->gain, 0, fit->balls.count * sizeof *fit->gain);
  for (size_t i = 0; i < s->points.count; i++) {
    double now = fabs(fit->field.best[i] - s->depth[i]), then = fabs(fit->field.second[i] - s->depth[i]);
    fit->gain[fit->field.owner[i]] += s->weight[i] * (fmin(then, 1e30) - now);
  }
}

/* Deficit that a candidate would fill: sum of weight x (its value - the field) where that is positive. */
static double deficit_in(const Fit *fit, size_t candidate) {
  const SporePoints *points = &fit->samples->points;
  double x = fit->candidates->x[candidate], y = fit->candidates->y[candidate], z = fit->candidates->z[candidate];
  double r = fit->candidates->r[candidate], sum = 0;
  for (size_t b = 0; b < points->block_count; b++) {
    const double *block = points->block + 4 * b;
    double dx = block[0] - x, dy = block[1] - y, dz = block[2] - z, reach = r + block[3];
    if (dx * dx + dy * dy + dz * dz > reach * reach) continue;
    for (size_t k = b * SPORE_BLOCK; k < (b + 1) * SPORE_BLOCK; k++) {
      double px = points->x[k] - x, py = points->y[k] - y, pz = points->z[k] - z;
      double value = r - sqrt(px * px + py * py + pz * pz), more = value - fit->field.best[k];
      sum += value > 0 && more > 0 ? fit->samples->weight[k] * more : 0;
    }
  }
  return sum;
}

/* Numbers 0 .. count - 1 by ascending sign x value, equal ones in order (shell sort: counts are small). */
static void order_by(const double *value, double sign, uint32_t *order, size_t count) {
  for (size_t i = 0; i < count; i++) order[i] = (uint32_t)i;
  size_t gap = 1;
  while (gap < count / 3) gap = 3 * gap + 1;
  for (; gap; gap /= 3)
    for (size_t i = gap; i < count; i++) {
      uint32_t item = order[i];
      size_t j = i;
      for (; j >= gap; j -= gap) {
        uint32_t other = order[j - gap];
        double difference = sign * (value[item] - value[other]);
        if (difference > 0 || (difference == 0 && item > other)) break;
        order[j] = other;
      }
      order[j] = item;
    }
}

static bool near_taken(const Fit *fit, const size_t *taken, size_t count, size_t c) {
  const SporeBalls *k = fit->candidates;
  for (size_t i = 0; i < count; i++) {
    size_t t = taken[i];
    double dx = k->x[c] - k->x[t], dy = k->y[c] - k->y[t], dz = k->z[c] - k->z[t], r = 0.7 * fmax(k->r[c], k->r[t]);
    if (dx * dx + dy * dy + dz * dz <= r * r) return true;
  }
  return false;
}

#define MOST_MOVED 256

/* Moves the balls that are worth least to where most depth is missing. */
static void relocate(Fit *fit) {
  size_t wanted = fit->balls.count / 25 > 1 ? fit->balls.count / 25 : 1, moved = 0, taken[MOST_MOVED];
  if (wanted > MOST_MOVED) wanted = MOST_MOVED;
  score_balls(fit);
  order_by(fit->gain, 1, fit->order, fit->balls.count);
  for (size_t i = 0; i < fit->scored_count; i++) fit->score[i] = deficit_in(fit, fit->scored[i]);
  order_by(fit->score, -1, fit->score_order, fit->scored_count);
  for (size_t i = 0; i < fit->scored_count && moved < wanted; i++) {
    uint32_t at = fit->score_order[i];
    size_t c = fit->scored[at], ball = fit->order[moved];
    if (near_taken(fit, taken, moved, c)) continue;
    if (!(fit->gain[ball] < fit->score[at])) break;
    fit->balls.x[ball] = fit->candidates->x[c], fit->balls.y[ball] = fit->candidates->y[c];
    fit->balls.z[ball] = fit->candidates->z[c], fit->balls.r[ball] = fit->candidates->r[c];
    taken[moved++] = c;
  }
  if (!moved) return;
  evaluate(fit);
  fit->damping = DAMPING_INITIAL;
  keep_best(fit);
}

/* A fresh spread of candidates to score, the same number each time. */
static void choose_scored(Fit *fit, int round) {
  size_t total = fit->candidates->count;
  for (size_t i = 0; i < fit->scored_count; i++)
    fit->scored[i] = (uint32_t)((i * total / fit->scored_count + (size_t)round * 7919u) % total);
}

static bool open_fit(Fit *fit, SporeBalls *balls) {
  size_t n = balls->count,
         scored = fit->candidates->count < SCORED_CANDIDATES ? fit->candidates->count : SCORED_CANDIDATES;
  fit->scored_count = scored;
  fit->normal = SPORE_NEW_ARRAY(double, 14 * n);
  fit->gain = SPORE_NEW_ARRAY(double, n);
  fit->order = SPORE_NEW_ARRAY(uint32_t, n);
  fit->score = SPORE_NEW_ARRAY(double, scored);
  fit->scored = SPORE_NEW_ARRAY(uint32_t, scored);
  fit->score_order = SPORE_NEW_ARRAY(uint32_t, scored);
  return fit->normal && fit->gain && fit->order && fit->score && fit->scored && fit->score_order &&
         spore_balls_create(&fit->balls, n) && spore_balls_create(&fit->trial, n) &&
         spore_balls_create(&fit->best, n) && spore_field_create(&fit->field, &fit->samples->points, n) &&
         spore_field_create(&fit->trial_field, &fit->samples->points, n);
}

static void close_fit(Fit *fit) {
  spore_free(fit->normal);
  spore_free(fit->gain);
  spore_free(fit->order);
  spore_free(fit->score);
  spore_free(fit->scored);
  spore_free(fit->score_order);
  spore_balls_clear(&fit->balls);
  spore_balls_clear(&fit->trial);
  spore_balls_clear(&fit->best);
  spore_field_clear(&fit->field);
  spore_field_clear(&fit->trial_field);
}

bool spore_spheres_fit(const SporeSolid *solid, const SporeSamples *samples, const SporeBalls *candidates,
                       SporeBalls *balls, const SporeProgressPart *progress, SporeError *error) {
  Fit fit = {.solid = solid,
             .samples = samples,
             .candidates = candidates,
             .smoothing = SMOOTHING * samples->typical,
             .best_loss = HUGE_VAL,
             .damping = DAMPING_INITIAL};
  bool done = open_fit(&fit, balls);
  if (!done) spore_spheres_no_memory(error);
  if (done) {
    spore_balls_copy(&fit.balls, balls);
    evaluate(&fit);
    keep_best(&fit);
  }
  for (int round = 0; done && round < ROUNDS; round++) {
    done = spore_progress_part(progress, (double)round / ROUNDS, _("Fitting spheres"), error);
    if (!done) break;
    take_round(&fit);
    if (round % RELOCATE_EVERY == RELOCATE_EVERY - 1 && round < ROUNDS - LAST_ROUNDS) {
      choose_scored(&fit, round);
      relocate(&fit);
    }
  }
  if (done) spore_balls_copy(balls, &fit.best);
  close_fit(&fit);
  return done;
}
