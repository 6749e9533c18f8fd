/* Broyden's method with limited memory. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/math/vector.h"
#include "core/nonlinear/convergence.h"
#include "core/nonlinear/line_search.h"

#define MEMORY SPORE_BROYDEN_MEMORY
#define SINGULAR 1e-12        /* of a pivot: a difference that the newer ones span already */
#define FRESH_CONTRACTION 0.3 /* what a new linearisation promises of an iteration */
#define SETTLED 2             /* iterations before the contraction is judged */
#define SHORT 0.3             /* Newton's step cut to less says that iterations with one linearisation will not do */

/* Differences of the last iterations, in a ring: of g = A^-1 r, and of x + g. */
typedef struct History {
  const SporeSystem *system;
  size_t count, next; /* kept; place of the next */
  double *change[MEMORY], *path[MEMORY];
  double gram[MEMORY][MEMORY]; /* inner products of the changes */
  double along[MEMORY];        /* of the changes with the g before */
} History;

/* The k-th newest. */
static size_t place_of(const History *history, size_t k) {
  assert(k < MEMORY);
  return (history->next + 2 * MEMORY - 1 - k) % MEMORY;
}

/* weights = M g; the change that `next` holds, begun by the g before, is finished: products with it are entered. */
static void remember(History *history, const double *weights, const double *weights_before) {
  assert(history->next < MEMORY);
  size_t n = history->system->count, at = history->next;
  const double *change = history->change[at];
  for (size_t k = 0; k < history->count; k++) {
    size_t other = place_of(history, k);
    if (other == at) continue;
    double product = spore_vector_dot(n, history->change[other], weights) - history->along[other];
    history->gram[at][other] = history->gram[other][at] = product;
  }
  history->gram[at][at] = spore_vector_dot(n, change, weights) - spore_vector_dot(n, change, weights_before);
  history->next = (at + 1) % MEMORY;
  if (history->count < MEMORY) history->count++;
}

/* How much of each difference, newest first, leaves least of g: normal equations by Cholesky's method, leaving out what
 * is nearly spanned. */
static void least_squares(const History *history, double *share) {
  assert(history->count <= MEMORY);
  size_t m = history->count;
  double l[MEMORY][MEMORY], y[MEMORY];
  bool used[MEMORY];
  for (size_t i = 0; i < m; i++) {
    size_t at = place_of(history, i);
    for (size_t j = 0; j <= i; j++) {
      double sum = history->gram[at][place_of(history, j)];
      for (size_t k = 0; k < j; k++)
        if (used[k]) sum -= l[i][k] * l[j][k];
      if (j < i) l[i][j] = used[j] ? sum / l[j][j] : 0;
      else used[i] = sum > SINGULAR * history->gram[at][at], l[i][i] = used[i] ? sqrt(sum) : 1;
    }
    y[i] = used[i] ? history->along[at] : 0;
    for (size_t k = 0; used[i] && k < i; k++)
      if (used[k]) y[i] -= l[i][k] * y[k];
    y[i] /= l[i][i];
  }
  for (size_t i = m; i-- > 0;) {
    for (size_t k = i + 1; k < m; k++)
      if (used[k]) y[i] -= l[k][i] * share[k];
    share[i] = used[i] ? y[i] / l[i][i] : 0;
  }
}

/* d = g less what the differences explain. */
static void accelerate(History *history, const double *g, const double *weights, double *d) {
  size_t n = history->system->count;
  double share[MEMORY];
  for (size_t k = 0; k < history->count; k++) {
    size_t at = place_of(history, k);
    history->along[at] = spore_vector_dot(n, history->change[at], weights);
  }
  least_squares(history, share);
  memcpy(d, g, n * sizeof *d);
  for (size_t k = 0; k < history->count; k++)
    if (share[k] != 0) spore_vector_add_scaled(n, d, -share[k], history->path[place_of(history, k)]);
}

/* Newton takes over where Broyden stood, with the iterations that are left: those until now cost half as much. */
static SporeNonlinearResult hand_over(const SporeSystem *system, const SporeNonlinearOptions *options, double *x,
                                      double *r, double *scratch, SporeNonlinearResult so_far) {
  SporeNonlinearResult result = spore_newton(system, options, x, r, scratch);
  result.iterations += so_far.iterations;
  result.linear_iterations += so_far.linear_iterations;
  result.evaluations += so_far.evaluations;
  result.linearisations += so_far.linearisations;
  result.unsolved += so_far.unsolved;
  result.indefinite |= so_far.indefinite;
  return result;
}

static bool approximate(const SporeSystem *system, const double *r, double *g, SporeNonlinearResult *result) {
  SporeLinearResult linear = system->approximate(system->data, r, g);
  result->linear_iterations += linear.iterations;
  result->unsolved += linear.status != SPORE_LINEAR_CONVERGED;
  result->indefinite |= linear.status == SPORE_LINEAR_INDEFINITE;
  return linear.status != SPORE_LINEAR_BREAKDOWN;
}

/* Whether a new linearisation costs less than the iterations that it saves, by how the residual shrank in the last
 * `iterations` of them. */
static bool worth_linearising(const SporeSystem *system, double start, double norm, double target, size_t iterations) {
  if (iterations < SETTLED || !(norm > target)) return false;
  double rate = log(start / norm) / (double)iterations, missing = log(norm / target);
  if (rate <= 0) return true;
  return missing / rate > missing / -log(FRESH_CONTRACTION) + system->linearisation_cost(system->data);
}

SporeNonlinearResult spore_broyden(const SporeSystem *system, const SporeNonlinearOptions *options, double *x,
                                   double *r, double *scratch) {
  assert(system->approximate && system->weigh && system->reuse && system->linearisation_cost);
  assert(options->tolerance > 0);
  assert(x != r || system->count == 0);
  size_t n = system->count, since = 0;
  double *d = scratch, *trial = scratch + n, *trial_r = scratch + 2 * n;
  double *g = scratch + 3 * n, *weights = scratch + 4 * n, *weights_before = scratch + 5 * n;
  double *best = scratch + 6 * n; /* x of the least residual */
  History history = {.system = system};
  for (size_t k = 0; k < MEMORY; k++) {
    history.change[k] = scratch + (7 + 2 * k) * n;
    history.path[k] = scratch + (8 + 2 * k) * n;
  }
  SporeNonlinearResult result = {0};
  SporeConvergence test;
  if (!spore_convergence_begin(&test, system, options, system->norm(system->data, r), &result)) return result;
  if (result.converged) return result;
  memcpy(best, x, n * sizeof *x);
  bool fresh = !system->reuse(system->data, x), pending = false;
  if (fresh) {
    system->linearise(system->data, x, NULL);
    result.linearisations++;
  }
  if (spore_convergence_rounding(&test, system, x, &result)) return result;
  double near = spore_convergence_near(&test, system), start = test.norm, target = test.tolerance * test.scale_r;
  while (!result.converged && result.iterations < options->iterations && !spore_cancel_asked(system->cancel)) {
    if (!approximate(system, r, g, &result)) break;
    system->weigh(system->data, g, weights);
    if (pending) {
      double *change = history.change[history.next], *path = history.path[history.next];
      spore_vector_scale_add(n, change, -1, g); /* it held the g before */
      spore_vector_add_scaled(n, path, 1, change);
      remember(&history, weights, weights_before);
      pending = false;
    }
    accelerate(&history, g, weights, d);
    double trial_norm = 0;
    double length =
        spore_line_search(system, x, d, r, test.norm, false, near, trial, trial_r, &trial_norm, &result.evaluations);
    if (length == 0 && history.count > 0) {
      history.count = 0;
      length =
          spore_line_search(system, x, g, r, test.norm, false, near, trial, trial_r, &trial_norm, &result.evaluations);
      memcpy(d, g, n * sizeof *d);
    }
    if (fresh && since == 0 && length < SHORT) break;
    if (length > 0) {
      memcpy(history.change[history.next], g, n * sizeof *g);
      memset(history.path[history.next], 0, n * sizeof *d);
      spore_vector_add_scaled(n, history.path[history.next], length, d);
      double *swap = weights;
      weights = weights_before;
      weights_before = swap;
      pending = true;
      memcpy(x, trial, n * sizeof *x);
      memcpy(r, trial_r, n * sizeof *r);
      spore_convergence_step(&test, system, x, d, length, trial_norm, &result);
      if (test.norm <= test.least) memcpy(best, x, n * sizeof *x);
      since++;
      if (result.converged) break;
    }
    if (length == 0 || worth_linearising(system, start, test.norm, target, since)) {
      system->linearise(system->data, x, NULL);
      result.linearisations++;
      if (spore_convergence_rounding(&test, system, x, &result)) break;
      history.count = 0;
      pending = false;
      fresh = true;
      since = 0;
      start = test.norm;
    }
  }
  if (result.converged && test.norm > test.least) spore_convergence_return(&test, n, best, test.least, x, &result);
  if (result.converged || !result.finite) return result;
  SporeNonlinearOptions left = *options;
  left.iterations -= result.iterations / 2;
  left.linearised = fresh && since == 0;
  left.load = test.scale_r;
  return hand_over(system, &left, x, r, scratch, result);
}
