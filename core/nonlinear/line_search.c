#include "core/nonlinear/line_search.h"

#include <math.h>

#define HALVINGS 12

static double slope(size_t n, const double *r, const double *d) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += r[i] * d[i];
  return sum;
}

double spore_line_search(const SporeSystem *system, const double *x, const double *d, const double *r, double norm,
                         double *trial, double *trial_r, double *trial_norm, size_t *evaluations) {
  size_t n = system->count;
  double downhill = slope(n, r, d), length = 1;
  for (int k = 0; k <= HALVINGS; k++, length /= 2) {
    for (size_t i = 0; i < n; i++) trial[i] = x[i] + length * d[i];
    system->residual(system->data, trial, trial_r);
    ++*evaluations;
    *trial_norm = system->norm(system->data, trial_r);
    if (!isfinite(*trial_norm)) continue;
    if (*trial_norm <= 0.5 * norm) return length;
    bool helps = downhill > 0 ? slope(n, trial_r, d) >= -0.5 * downhill : *trial_norm <= (1 - 1e-4 * length) * norm;
    if (helps) return length;
  }
  return 0;
}
