/* The classical Runge-Kutta method of fourth order, in momentum. */
#include <assert.h>
#include <string.h>

#include "core/base/text.h"
#include "core/integrate/integrator.h"

typedef struct Stage {
  const SporeDynamics *dynamics;
  size_t n;
  double *force, *change; /* work */
} Stage;

/* change = h M^-1 f at (q, v), a change of v at q0 */
static void evaluate(const Stage *stage, double time_s, double h, const double *q, const double *v, double *change) {
  void *data = stage->dynamics->data;
  stage->dynamics->set_time(data, time_s);
  stage->dynamics->force(data, q, v, stage->force);
  memset(change, 0, stage->n * sizeof *change);
  stage->dynamics->kick(data, stage->force, h, change);
}

/* v += the change a x + b y + c z of v at q0, carried to q */
static void carry(const Stage *stage, double a, const double *x, double b, const double *y, double c, const double *z,
                  const double *q, double *v) {
  for (size_t i = 0; i < stage->n; i++) stage->change[i] = a * x[i] + b * y[i] + c * z[i];
  stage->dynamics->carry(stage->dynamics->data, stage->change, q, v);
}

/* The classical method, and where q is turned, its form without commutators (Celledoni, Marthinsen and Owren 2003):
 * with p_i the momentum and F_i the force of stage i, q moves freely with p_1 or p_2 for h/2, to stages 2 and 3;   from
 * stage 2 with p_3 - p_1/2 for h, to stage 4; (3 p_1 + 2 p_2 + 2 p_3 - p_4)/12 for h and then (-p_1 + 2 p_2 + 2 p_3 + 3
 * p_4)/12 for h, to the end. p is a vector that forces add to, so that its steps are the classical ones. */
static SporeStepResult step(const SporeDynamics *dynamics, const SporeSolverFields *fields, SporeHistory *history,
                            double h, const double *q0, const double *v0, double *q1, double *v1, double *scratch) {
  assert(h > 0 && q0 != q1 && v0 != v1);
  void *data = dynamics->data;
  size_t n = 3 * dynamics->block_count;
  double *q = scratch, *q2 = q + 2 * n, *k1 = q2 + 2 * n, *k2 = k1 + n, *k3 = k2 + n, *k4 = k3 + n;
  double *v = k4 + n, *v2 = v + n, *free = v2 + n, *force = free + n, *change = force + n;
  Stage stage = {dynamics, n, force, change};
  evaluate(&stage, 0, h, q0, v0, k1);

  dynamics->drift(data, q0, v0, 0.5 * h, q2, free);
  memcpy(v2, free, n * sizeof *v2);
  carry(&stage, 0.5, k1, 0, k1, 0, k1, q2, v2);
  evaluate(&stage, 0.5 * h, h, q2, v2, k2);

  for (size_t i = 0; i < n; i++) v[i] = v0[i] + 0.5 * k1[i];
  dynamics->drift(data, q0, v, 0.5 * h, q, v);
  carry(&stage, -0.5, k1, 0.5, k2, 0, k2, q, v);
  evaluate(&stage, 0.5 * h, h, q, v, k3);

  for (size_t i = 0; i < n; i++) v[i] = 0.5 * free[i];
  carry(&stage, 0.5, k2, 0, k2, 0, k2, q2, v);
  dynamics->drift(data, q2, v, h, q, v);
  carry(&stage, 0.5, v0, 1, k3, -0.5, k2, q, v);
  evaluate(&stage, h, h, q, v, k4);

  for (size_t i = 0; i < n; i++) v[i] = 0.5 * v0[i] + (k1[i] + k2[i] - k3[i]) / 12;
  dynamics->drift(data, q0, v, h, q, v);
  carry(&stage, 1. / 3, k3, 0, k3, 0, k3, q, v);
  dynamics->drift(data, q, v, h, q1, v1);
  carry(&stage, 0.5, v0, 1. / 12, k1, 0.25, k2, q1, v1); /* v0 + (k1 + 2 k2 + 2 k3 + k4)/6 less what drifted */
  carry(&stage, 1. / 12, k3, 1. / 6, k4, 0, k4, q1, v1);
  return (SporeStepResult){.converged = true, .force_evaluations = 4};
}

const SporeIntegrator spore_rk4 = {
    .name = "rk4",
    .doc = N_("Fourth order, four force evaluations a step: the most exact for what is smooth and not stiff."),
    .stable_square = 8,
    .stable_damping = 3,
    .shift = 0.5,
    .scratch = 3 * 13,
    .step = step,
};
