#include "core/nonlinear/line_search.h"

#include <math.h>
#include <string.h>

#include "core/math/vector.h"

#define HALVINGS 12

double spore_line_search(const SporeSystem *system, const double *x, const double *d, const double *r, double norm,
                         double *trial, double *trial_r, double *trial_norm, size_t *evaluations) {
  size_t n = system->count;
  double downhill = spore_vector_dot(n, r, d), length = 1;
  for (int k = 0; k <= HALVINGS; k++, length /= 2) {
    memcpy(trial, x, n * sizeof *x);
    spore_vector_add_scaled(n, trial, length, d);
    system->residual(system->data, trial, trial_r);
    ++*evaluations;
    *trial_norm = system->norm(system->data, trial_r);
    if (!isfinite(*trial_norm)) continue;
    if (*trial_norm <= 0.5 * norm) return length;
    bool helps =
        downhill > 0 ? spore_vector_dot(n, trial_r, d) >= -0.5 * downhill : *trial_norm <= (1 - 1e-4 * length) * norm;
    if (helps) return length;
  }
  return 0;
}
