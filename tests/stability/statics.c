/* Static balance of a model under a load, and its lowest natural frequency, by dense matrices. */
#include "tests/stability/statics.h"

#include <math.h>
#include <string.h>

#define PATIENCE 100 /* rounds that may pass while the force left does not halve: rounding */
#define TRACE 1e-11  /* N/m on the diagonal: a matrix that is barely definite is one in floating point */

Statics statics_new(SporeModel *model) {
  size_t n = 3 * model->block_count;
  Statics statics = {model,
                     n,
                     g_new0(gboolean, model->block_count),
                     g_new0(double, n),
                     g_new0(double, model->q_count),
                     g_new0(double, n),
                     g_new0(double, n *n)};
  SporePose pose = {{0, 0, 0}, {1, 0, 0, 0}};
  model->type->place(model, pose, spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), statics.q, statics.still);
  return statics;
}

void statics_free(Statics *statics) {
  statics->model->type->destroy(statics->model);
  g_free(statics->held);
  g_free(statics->load);
  g_free(statics->q);
  g_free(statics->still);
  g_free(statics->matrix);
}

/* The stiffness, factored as L L^T; held points have a row of their own. */
static void factor(Statics *statics) {
  SporeBlockMatrix blocks;
  size_t n = statics->n;
  double *a = statics->matrix;
  g_assert_true(spore_model_matrix_create(statics->model, &blocks));
  statics->model->type->jacobian(statics->model, statics->q, statics->q, statics->still, 1, 0, &blocks);
  memset(a, 0, n * n * sizeof *a);
  for (size_t i = 0; i < blocks.block_count; i++)
    for (uint32_t k = blocks.row_start[i]; k < blocks.row_start[i + 1]; k++)
      for (size_t e = 0; e < 9 && !statics->held[i] && !statics->held[blocks.column[k]]; e++)
        a[(3 * i + e / 3) * n + 3 * (size_t)blocks.column[k] + e % 3] = blocks.values[9 * (size_t)k + e];
  spore_block_matrix_clear(&blocks);
  for (size_t i = 0; i < n; i++) a[i * n + i] += statics->held[i / 3] ? 1 : TRACE;
  for (size_t j = 0; j < n; j++) {
    for (size_t k = 0; k < j; k++) a[j * n + j] -= a[j * n + k] * a[j * n + k];
    g_assert_cmpfloat(a[j * n + j], >, 0);
    a[j * n + j] = sqrt(a[j * n + j]);
    for (size_t i = j + 1; i < n; i++) {
      for (size_t k = 0; k < j; k++) a[i * n + j] -= a[i * n + k] * a[j * n + k];
      a[i * n + j] /= a[j * n + j];
    }
  }
}

static void solve(const Statics *statics, double *x) {
  size_t n = statics->n;
  const double *a = statics->matrix;
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < i; k++) x[i] -= a[i * n + k] * x[k];
    x[i] /= a[i * n + i];
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t k = i + 1; k < n; k++) x[i] -= a[k * n + i] * x[k];
    x[i] /= a[i * n + i];
  }
}

static double energy(const Statics *statics, const double *q) {
  double sum = statics->model->type->potential(statics->model, q);
  for (size_t i = 0; i < statics->n; i++) sum -= statics->load[i] * q[i];
  return sum;
}

double statics_balance(Statics *statics) {
  size_t n = statics->n;
  double *step = g_new(double, n), *next = g_memdup2(statics->q, statics->model->q_count * sizeof *next), left = 1,
         least = 1;
  for (int round = 0, since = 0; round < 2000 && since < PATIENCE; round++, since++) {
    double squares = 0, load = 0, before = energy(statics, statics->q), share = 1;
    memcpy(step, statics->load, n * sizeof *step);
    statics->model->type->force(statics->model, statics->q, statics->q, statics->still, step);
    for (size_t i = 0; i < n; i++) {
      load += statics->load[i] * statics->load[i];
      if (!statics->held[i / 3]) continue;
      load += step[i] * step[i];
      step[i] = 0;
    }
    for (size_t i = 0; i < n; i++) {
      squares += step[i] * step[i];
    }
    left = load > 0 ? sqrt(squares / load) : 0;
    if (left <= 1e-9) break;
    if (left < 0.5 * least) least = left, since = 0;
    factor(statics);
    solve(statics, step);
    for (int half = 0; half < 40; half++, share *= 0.5) {
      for (size_t i = 0; i < n; i++) next[i] = statics->q[i] + share * step[i];
      if (energy(statics, next) <= before + 1e-12 * fabs(before)) break; /* rounding */
    }
    memcpy(statics->q, next, n * sizeof *next);
  }
  g_free(step);
  g_free(next);
  return left;
}

double statics_lowest_frequency(Statics *statics, size_t axis) {
  double *x = g_new0(double, statics->n), *force = g_new0(double, statics->n), square = 0;
  const double *mass = statics->model->block_mass;
  factor(statics);
  for (size_t i = 0; i < statics->n / 3; i++) x[3 * i + axis] = statics->held[i] ? 0 : 1;
  for (int round = 0; round < 60; round++) {
    double kinetic = 0, work = 0;
    for (size_t i = 0; i < statics->n; i++) force[i] = x[i] = x[i] * mass[i / 3];
    solve(statics, x);
    for (size_t i = 0; i < statics->n; i++) {
      if (statics->held[i / 3]) x[i] = 0;
      kinetic += mass[i / 3] * x[i] * x[i];
      work += force[i] * x[i];
    }
    square = work / kinetic;
    for (size_t i = 0; i < statics->n; i++) x[i] /= sqrt(kinetic);
  }
  g_free(x);
  g_free(force);
  return sqrt(square);
}
