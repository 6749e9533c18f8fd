#include <assert.h>
#include <string.h>

#include "core/base/text.h"
#include "core/integrate/tr_bdf2.h"

/* With momentum p, m its mean over the last step, and F = p':
 *   p_2 = p_1 + (p_1 - p_0)/3 + 2h/3 F_2,   q moves freely with m for h/3 and with p_2 for 2h/3.
 * Where q' = v that is q_2 = q_1 + (q_1 - q_0)/3 + 2h/3 v_2. The history is a = m - p_1 and b = p_1 - p_0, as
 * velocities; it starts with a step of TR-BDF2, which is of second order too. */
static SporeStepResult step(const SporeDynamics *dynamics, const SporeSolverFields *fields, SporeHistory *history,
                            double h, const double *q0, const double *v0, double *q1, double *v1, double *scratch) {
  assert(h > 0 && q0 != q1 && v0 != v1);
  assert(history->a && history->b);
  void *data = dynamics->data;
  size_t n = 3 * dynamics->block_count;
  if (history->step_s != h) {
    history->step_s = h;
    const SporeTrBdf2Extra extra = {.mean = history->a, .change = history->b};
    return spore_tr_bdf2_step(dynamics, fields, &extra, h, q0, v0, q1, v1, scratch);
  }
  double *qa = scratch, *va = qa + 2 * n, *v = va + n, *mean = v + n, *start = mean + n, *work = start + n;
  for (size_t i = 0; i < n; i++) work[i] = v0[i] + history->a[i];
  dynamics->drift(data, q0, work, h / 3, qa, mean);
  memcpy(start, mean, n * sizeof *start);
  for (size_t i = 0; i < n; i++) work[i] = -history->a[i];
  dynamics->carry(data, work, qa, start); /* p_1 at qa */
  memcpy(va, start, n * sizeof *va);
  for (size_t i = 0; i < n; i++) work[i] = history->b[i] / 3;
  dynamics->carry(data, work, qa, va);
  dynamics->set_time(data, h);
  dynamics->set_mass(data, qa);
  SporeStepResult result = spore_stage_solve(dynamics, fields, 2 * h / 3, qa, va, NULL, v, work);
  dynamics->drift(data, qa, v, 2 * h / 3, q1, v1);
  for (size_t i = 0; i < n; i++) work[i] = v[i] - start[i];
  memset(history->b, 0, n * sizeof *work);
  dynamics->carry(data, work, q1, history->b);
  for (size_t i = 0; i < n; i++) work[i] = (mean[i] - v[i]) / 3; /* the mean is now m/3 + 2/3 p_2 */
  memset(history->a, 0, n * sizeof *work);
  dynamics->carry(data, work, q1, history->a);
  return result;
}

const SporeIntegrator spore_bdf2 = {
    .name = "bdf2",
    .doc = N_("Second order, stable at any step and damps what it cannot resolve; one system a step, from the last "
              "two states. Implicit Euler steps in where contacts are stiff."),
    .implicit = true,
    .remembers = true,
    .damping = SPORE_DAMPING_FAST,
    .scratch = 3 * SPORE_TR_BDF2_SCRATCH,
    .step = step,
};
