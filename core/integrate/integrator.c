/* The list of integrators. */
#include "core/integrate/integrator.h"

#include <assert.h>

static const SporeIntegrator *const integrators[SPORE_INTEGRATOR_COUNT] = {
    &spore_explicit_euler, &spore_symplectic_euler,  &spore_verlet, &spore_rk4,     &spore_position_based,
    &spore_implicit_euler, &spore_implicit_midpoint, &spore_bdf2,   &spore_tr_bdf2, &spore_static,
};

const SporeIntegrator *spore_integrator(SporeIntegratorKind kind) {
  assert(kind >= 0 && kind < SPORE_INTEGRATOR_COUNT);
  return integrators[kind];
}

size_t spore_integrator_scratch(void) {
  size_t most = 0;
  for (size_t i = 0; i < SPORE_INTEGRATOR_COUNT; i++)
    if (integrators[i]->scratch > most) most = integrators[i]->scratch;
  return most;
}
