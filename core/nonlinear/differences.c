/* Differences of the last iterations, and the step that they make of the next one's. */
#include "core/nonlinear/differences.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/math/vector.h"

#define MEMORY SPORE_DIFFERENCES
#define SINGULAR 1e-12 /* of a pivot: a difference that the newer ones span already */

/* The k-th newest. */
static size_t place_of(const SporeDifferences *differences, size_t k) {
  assert(k < MEMORY);
  return (differences->next + 2 * MEMORY - 1 - k) % MEMORY;
}

void spore_differences_begin(SporeDifferences *differences, const SporeSystem *system, double *scratch) {
  assert(system->weigh);
  size_t n = system->count;
  *differences = (SporeDifferences){.system = system, .weights = scratch, .weights_before = scratch + n};
  for (size_t k = 0; k < MEMORY; k++) {
    differences->change[k] = scratch + (2 + 2 * k) * n;
    differences->path[k] = scratch + (3 + 2 * k) * n;
  }
}

void spore_differences_forget(SporeDifferences *differences) {
  differences->count = 0;
  differences->pending = false;
}

/* The change that `next` holds, begun by the g before, is finished: products with it are entered. */
static void remember(SporeDifferences *differences) {
  assert(differences->next < MEMORY);
  size_t n = differences->system->count, at = differences->next;
  const double *change = differences->change[at];
  for (size_t k = 0; k < differences->count; k++) {
    size_t other = place_of(differences, k);
    if (other == at) continue;
    double product = spore_vector_dot(n, differences->change[other], differences->weights) - differences->along[other];
    differences->gram[at][other] = differences->gram[other][at] = product;
  }
  differences->gram[at][at] =
      spore_vector_dot(n, change, differences->weights) - spore_vector_dot(n, change, differences->weights_before);
  differences->next = (at + 1) % MEMORY;
  if (differences->count < MEMORY) differences->count++;
}

void spore_differences_meet(SporeDifferences *differences, const double *g) {
  size_t n = differences->system->count;
  differences->system->weigh(differences->system->data, g, differences->weights);
  if (differences->pending) {
    double *change = differences->change[differences->next], *path = differences->path[differences->next];
    spore_vector_scale_add(n, change, -1, g); /* it held the g before */
    spore_vector_add_scaled(n, path, 1, change);
    remember(differences);
    differences->pending = false;
  }
  for (size_t k = 0; k < differences->count; k++) {
    size_t at = place_of(differences, k);
    differences->along[at] = spore_vector_dot(n, differences->change[at], differences->weights);
  }
}

/* How much of each difference, newest first, leaves least of g: normal equations by Cholesky's method, leaving out what
 * is nearly spanned. */
static void least_squares(const SporeDifferences *differences, double *share) {
  assert(differences->count <= MEMORY);
  size_t m = differences->count;
  double l[MEMORY][MEMORY], y[MEMORY];
  bool used[MEMORY];
  for (size_t i = 0; i < m; i++) {
    size_t at = place_of(differences, i);
    for (size_t j = 0; j <= i; j++) {
      double sum = differences->gram[at][place_of(differences, j)];
      for (size_t k = 0; k < j; k++)
        if (used[k]) sum -= l[i][k] * l[j][k];
      if (j < i) l[i][j] = used[j] ? sum / l[j][j] : 0;
      else used[i] = sum > SINGULAR * differences->gram[at][at], l[i][i] = used[i] ? sqrt(sum) : 1;
    }
    y[i] = used[i] ? differences->along[at] : 0;
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

void spore_differences_accelerate(SporeDifferences *differences, const double *g, double *d) {
  assert(g != d || differences->system->count == 0);
  size_t n = differences->system->count;
  double share[MEMORY];
  least_squares(differences, share);
  memcpy(d, g, n * sizeof *d);
  for (size_t k = 0; k < differences->count; k++)
    if (share[k] != 0) spore_vector_add_scaled(n, d, -share[k], differences->path[place_of(differences, k)]);
}

void spore_differences_leave(SporeDifferences *differences, const double *g, double length, const double *d) {
  size_t n = differences->system->count;
  memcpy(differences->change[differences->next], g, n * sizeof *g);
  memset(differences->path[differences->next], 0, n * sizeof *d);
  spore_vector_add_scaled(n, differences->path[differences->next], length, d);
  double *swap = differences->weights;
  differences->weights = differences->weights_before;
  differences->weights_before = swap;
  differences->pending = true;
}
