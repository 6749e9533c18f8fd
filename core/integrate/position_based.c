/* Position-based dynamics with compliance, one sweep a step. */
#include <assert.h>
#include <string.h>

#include "core/base/text.h"
#include "core/integrate/integrator.h"

/* Forces that no sweep meets move the bodies as in symplectic Euler: v = v0 + h M^-1 f(q0, v0), q = q0 + h v. The
 * elements of bodies that can be met so are met one after the other, each implicitly by itself (SporeModelSweep), after
 * a part s of the step: q_s = q0 + s h (v0 + s (v - v0)) is where the other forces led, and the elements move it. What
 * comes out is followed on: u = (q_s - q0)/(s h), q1 = q0 + h u, v1 = v0 + (u - v0)/s. There, at the end of the step,
 * contacts are met. That is a splitting of the equations of motion: of first order, and nothing is solved. At s = 1/2
 * the method would be of second order, and at 1 it would damp most: s is as little as bears any step of what is stiff,
 * found by trial for each kind of elements, see tests/stability/test_position_based.c. */
static SporeStepResult step(const SporeDynamics *dynamics, const SporeSolverFields *fields, SporeHistory *history,
                            double h, const double *q0, const double *v0, double *q1, double *v1, double *scratch) {
  assert(h > 0 && q0 != q1 && v0 != v1);
  void *data = dynamics->data;
  size_t n = 3 * dynamics->block_count;
  double *force = scratch, *kicked = scratch + n, *rows = kicked + n;
  if (dynamics->loose_force) dynamics->loose_force(data, q0, v0, force);
  else dynamics->force(data, q0, v0, force);
  memcpy(kicked, v0, n * sizeof *v0);
  dynamics->kick(data, force, h, kicked);
  dynamics->drift(data, q0, kicked, h, q1, v1);
  if (dynamics->sweep) dynamics->sweep(data, h, q0, v0, q1, v1, rows);
  return (SporeStepResult){.converged = true, .force_evaluations = 1};
}

const SporeIntegrator spore_position_based = {
    .name = "position_based",
    .doc =
        N_("First order, one sweep over the elements of a body a step, each, or each row of a net's springs, met "
           "implicitly by itself, or all at once by a matrix that is factorised beforehand: the quickest to a rough "
           "answer where the body is stiff, and no step is too large for it. For nets, linear neo-Hookean tetrahedra, "
           "and linear corotational ones without stiffness_damping, and their contacts with each other, with "
           "tools and with what does not move; all else moves "
           "as by symplectic_euler, or by implicit_euler in contacts and links that a step does not resolve."),
    .swings = true,
    .sweeps = true,
    .stable_square = 4,
    .stable_damping = 2,
    .shift = 1,
    .scratch = 3 * 2 + 4,
    .step = step,
};
