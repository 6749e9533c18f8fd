#include <math.h>
#include <string.h>

#include "core/nonlinear/convergence.h"
#include "core/nonlinear/line_search.h"

#define INNER_TOLERANCE 1e-3 /* of A^-1 r: rougher and the updates learn its error, finer and nothing is gained */
#define CONTRACTION 0.5

/* Steps s_k taken so far, their lengths along the directions found, and their squared sizes. */
typedef struct History {
  const SporeSystem *system;
  size_t count;
  double *steps;
  double length[SPORE_BROYDEN_MEMORY + 1], square[SPORE_BROYDEN_MEMORY + 1];
} History;

static double *step_at(const History *history, size_t k) { return history->steps + k * history->system->count; }

static double dot(const History *history, const double *a, const double *b) {
  return history->system->dot(history->system->data, a, b);
}

/* z <- B_last^-1 r, given z = A^-1 r. With step s_k = l_k d_k the update of B_k^-1 is, for any z,
 *   z <- z + (s_k.z / |s_k|^2) (l_k / l_k+1 s_k+1 - (1 - l_k) s_k). */
static void apply_updates(const History *history, double *z) {
  size_t n = history->system->count;
  for (size_t k = 0; k + 1 < history->count; k++) {
    const double *s = step_at(history, k), *next = step_at(history, k + 1);
    double length = history->length[k], next_length = history->length[k + 1];
    double factor = dot(history, s, z) / history->square[k];
    double a = factor * length / next_length, b = factor * (length - 1);
    for (size_t i = 0; i < n; i++) z[i] += a * next[i] + b * s[i];
  }
}

/* The new direction d solves d = z + (length d - (1 - length) s) (s.z) / |s|^2 for the last step s, so that one vector
 * is kept a step. False where the update is singular. */
static bool direction(const History *history, double *z) {
  size_t n = history->system->count, last = history->count - 1;
  const double *s = step_at(history, last);
  double length = history->length[last], factor = dot(history, s, z) / history->square[last];
  double divisor = 1 - length * factor;
  if (!isfinite(divisor) || fabs(divisor) < 1e-2) return false;
  double b = (1 - length) * factor;
  for (size_t i = 0; i < n; i++) z[i] = (z[i] - b * s[i]) / divisor;
  return true;
}

/* d ~ B^-1 r into the place behind the last step; false where Broyden's matrix is of no use. */
static bool next_direction(History *history, const double *r, SporeNonlinearResult *result) {
  const SporeSystem *system = history->system;
  double *d = step_at(history, history->count);
  SporeLinearResult linear = system->solve(system->data, r, INNER_TOLERANCE, d);
  result->linear_iterations += linear.iterations;
  result->unsolved += linear.status != SPORE_LINEAR_CONVERGED;
  result->indefinite |= linear.status == SPORE_LINEAR_INDEFINITE;
  if (linear.status == SPORE_LINEAR_BREAKDOWN) return false;
  if (history->count == 0) return true;
  apply_updates(history, d);
  return direction(history, d);
}

static void refresh(History *history, const double *x, SporeNonlinearResult *result) {
  history->system->linearise(history->system->data, x);
  result->linearisations++;
  history->count = 0;
}

/* Newton takes over where Broyden stood, with the iterations that are left. */
static SporeNonlinearResult hand_over(const SporeSystem *system, const SporeNonlinearOptions *options, double *x,
                                      double *scratch, SporeNonlinearResult so_far) {
  SporeNonlinearResult result = spore_newton(system, options, x, scratch);
  result.iterations += so_far.iterations;
  result.linear_iterations += so_far.linear_iterations;
  result.evaluations += so_far.evaluations;
  result.linearisations += so_far.linearisations;
  result.unsolved += so_far.unsolved;
  result.indefinite |= so_far.indefinite;
  return result;
}

SporeNonlinearResult spore_broyden(const SporeSystem *system, const SporeNonlinearOptions *options, double *x,
                                   double *scratch) {
  size_t n = system->count;
  double *r = scratch, *trial = scratch + n, *trial_r = scratch + 2 * n;
  History history = {.system = system, .steps = scratch + SPORE_NEWTON_SCRATCH * n};
  SporeNonlinearResult result = {0};
  SporeConvergence test;
  system->residual(system->data, x, r);
  result.evaluations++;
  if (!spore_convergence_begin(&test, system, options, system->norm(system->data, r), &result)) return result;
  if (result.converged) return result;
  if (!system->reuse(system->data, x)) refresh(&history, x, &result);
  if (spore_convergence_rounding(&test, system, x, &result)) return result;
  bool stale = result.linearisations == 0;
  while (!result.converged && result.iterations < options->iterations) {
    double trial_norm, length = 0;
    double *d = step_at(&history, history.count);
    if (next_direction(&history, r, &result))
      length = spore_line_search(system, x, d, r, test.norm, trial, trial_r, &trial_norm, &result.evaluations);
    if (length == 0) {
      if (!stale && history.count == 0) return hand_over(system, options, x, scratch, result);
      refresh(&history, x, &result);
      stale = false;
      continue;
    }
    memcpy(x, trial, n * sizeof *x);
    memcpy(r, trial_r, n * sizeof *r);
    double contraction = trial_norm / test.norm;
    spore_convergence_step(&test, system, x, d, length, trial_norm, &result);
    for (size_t i = 0; i < n; i++) d[i] *= length;
    history.length[history.count] = length;
    history.square[history.count] = dot(&history, d, d);
    bool useless = history.square[history.count] == 0;
    history.count++;
    if (result.converged) break;
    if (contraction > CONTRACTION || history.count == SPORE_BROYDEN_MEMORY || useless) {
      refresh(&history, x, &result);
      stale = false;
      if (spore_convergence_rounding(&test, system, x, &result)) break;
    }
  }
  if (result.converged || !result.finite) return result;
  return hand_over(system, options, x, scratch, result);
}
