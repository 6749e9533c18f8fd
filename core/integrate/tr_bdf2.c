/* TR-BDF2: the trapezoidal rule and BDF2 in one step, with an error estimate and adaptive parts. */
#include "core/integrate/tr_bdf2.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/text.h"

#define D (1 - M_SQRT1_2)  /* the stages' c / h; the first ends at 2 D h */
#define W (0.25 * M_SQRT2) /* weight of start and middle: 2 W + D = 1 */
#define PARTS_MAXIMUM 1024 /* of a step, adaptive */
#define SAFETY 0.9         /* of the step that would just meet the tolerance */
#define GROWTH_MAXIMUM 2.5
#define SHRINKING_MAXIMUM 0.2

/* With momentum p and F = p': the trapezoidal rule to the middle m,
 *   p_m = p_0 + D h (F_0 + F_m),   then   p_1 = p_0 + (W/D) (p_m - p_0) + D h F_1,
 * and q moves freely with p_0 and p_m for D h each; then, from q_0 again, with (p_0 + p_m)/2 for 2 W h and with p_1 for
 * D h. */
SporeStepResult spore_tr_bdf2_step(const SporeDynamics *dynamics, const SporeSolverFields *fields,
                                   const SporeTrBdf2Extra *extra, double h, const double *q0, const double *v0,
                                   double *q1, double *v1, double *scratch) {
  assert(h > 0);
  assert(q0 != q1 && v0 != v1);
  assert(!extra->change == !extra->mean);
  void *data = dynamics->data;
  size_t n = 3 * dynamics->block_count;
  double *qa = scratch, *va = qa + 2 * n, *v = va + n, *start = v + n, *middle = start + n, *work = middle + n;

  dynamics->set_time(data, extra->start_s);
  dynamics->force(data, q0, v0, work);
  memset(middle, 0, n * sizeof *middle);
  dynamics->kick(data, work, D * h, middle);
  dynamics->drift(data, q0, v0, D * h, qa, start);
  memcpy(va, start, n * sizeof *va);
  dynamics->carry(data, middle, qa, va);
  dynamics->set_time(data, extra->start_s + 2 * D * h);
  dynamics->set_mass(data, qa);
  SporeStepResult result = spore_stage_solve(dynamics, fields, D * h, qa, va, NULL, v, work);
  result.force_evaluations++;
  for (size_t i = 0; i < n; i++) work[i] = v[i] - start[i];
  memset(middle, 0, n * sizeof *middle); /* p_m - p_0 at q0 */
  dynamics->carry(data, work, q0, middle);

  dynamics->set_mass(data, q0);
  for (size_t i = 0; i < n; i++) work[i] = v0[i] + 0.5 * middle[i];
  dynamics->drift(data, q0, work, 2 * W * h, qa, va);
  memcpy(start, va, n * sizeof *start);
  for (size_t i = 0; i < n; i++) work[i] = -0.5 * middle[i];
  dynamics->carry(data, work, qa, start); /* p_0 at qa */
  for (size_t i = 0; i < n; i++) work[i] = (W / D - 0.5) * middle[i];
  dynamics->carry(data, work, qa, va);
  dynamics->set_time(data, extra->start_s + h);
  dynamics->set_mass(data, qa);
  SporeStepResult second = spore_stage_solve(dynamics, fields, D * h, qa, va, NULL, v, work);
  spore_step_result_add(&result, &second);
  dynamics->drift(data, qa, v, D * h, q1, v1);

  /* va - start is W/D (p_m - p_0), and v - start p_1 - p_0, at qa. */
  if (extra->change) {
    memset(extra->change, 0, n * sizeof *extra->change);
    memset(extra->mean, 0, n * sizeof *extra->mean);
    for (size_t i = 0; i < n; i++) work[i] = v[i] - start[i];
    dynamics->carry(data, work, q1, extra->change);
    for (size_t i = 0; i < n; i++) work[i] = D * (va[i] - start[i]) - 2 * W * (v[i] - start[i]);
    dynamics->carry(data, work, q1, extra->mean);
  }
  /* The error against the third-order formula with weights (1 - W)/3, (3 W + 1)/3, D/3. No filter for stiff components
   * is needed: the terms are velocities, which stay bounded. */
  if (extra->error)
    for (size_t i = 0; i < n; i++)
      extra->error[i] = h * (2 * D / 3 * (v[i] - start[i]) - D / (3 * W) * (va[i] - start[i]));
  return result;
}

/* Takes the step in parts, each as large as its share of the tolerance allows. The estimate is of third order, so that
 * the estimate of a part against its share is of second order. Where not even the smallest part is solved, the rest of
 * the step is one part: a thousand more that are not solved would tell no more. */
static SporeStepResult adaptive_step(const SporeDynamics *dynamics, const SporeSolverFields *fields,
                                     SporeHistory *history, double h, const double *q0, const double *v0, double *q1,
                                     double *v1, double *scratch) {
  assert(fields->error_tolerance > 0);
  size_t n = 3 * dynamics->block_count;
  double *q = scratch, *v = q + 2 * n, *error = v + n, *work = error + n;
  memcpy(q, q0, dynamics->q_count * sizeof *q);
  memcpy(v, v0, n * sizeof *v);
  double done = 0, size = history->step_s > 0 ? fmin(history->step_s, h) : h, smallest = h / PARTS_MAXIMUM;
  SporeStepResult total = {.converged = true};
  for (bool last = false, hopeless = false; !last;) {
    double left = h - done;
    last = hopeless || size >= left || spore_cancel_asked(dynamics->cancel);
    double part = last ? left : fmin(size, 0.5 * left);
    SporeTrBdf2Extra extra = {.start_s = done, .error = error};
    SporeStepResult result = spore_tr_bdf2_step(dynamics, fields, &extra, part, q, v, q1, v1, work);
    double ratio = dynamics->distance(dynamics->data, error) / (fields->error_tolerance * part / h);
    bool good = result.converged && ratio <= 1, small = part <= smallest;
    double factor = result.converged && isfinite(ratio) ? SAFETY / sqrt(fmax(ratio, 1e-12)) : 0;
    factor = fmin(fmax(factor, SHRINKING_MAXIMUM), GROWTH_MAXIMUM);
    bool solved = result.converged;
    result.converged = true;
    spore_step_result_add(&total, &result);
    if (!good && !small && !hopeless && !spore_cancel_asked(dynamics->cancel)) {
      size = fmax(part * fmin(factor, SAFETY), smallest);
      last = false;
      dynamics->set_mass(dynamics->data, q);
      continue;
    }
    hopeless |= !solved;
    total.converged &= good || (solved && isfinite(ratio));
    size = fmax(part * factor, last ? size : smallest);
    if (last) break;
    done += part;
    memcpy(q, q1, dynamics->q_count * sizeof *q);
    memcpy(v, v1, n * sizeof *v);
    dynamics->set_mass(dynamics->data, q);
  }
  history->step_s = size;
  return total;
}

static SporeStepResult step(const SporeDynamics *dynamics, const SporeSolverFields *fields, SporeHistory *history,
                            double h, const double *q0, const double *v0, double *q1, double *v1, double *scratch) {
  if (fields->error_tolerance > 0) return adaptive_step(dynamics, fields, history, h, q0, v0, q1, v1, scratch);
  const SporeTrBdf2Extra nothing = {0};
  return spore_tr_bdf2_step(dynamics, fields, &nothing, h, q0, v0, q1, v1, scratch);
}

const SporeIntegrator spore_tr_bdf2 = {
    .name = "tr_bdf2",
    .doc = N_("Second order, stable at any step and damps what it cannot resolve; two systems a step. Chooses its own "
              "parts of a step where error_tolerance is set; else implicit Euler steps in where contacts are stiff."),
    .implicit = true,
    .remembers = true,
    .chooses_step = true,
    .damping = SPORE_DAMPING_FAST,
    .scratch = 3 * (4 + SPORE_TR_BDF2_SCRATCH),
    .step = step,
};
