#include "core/integrate/integrator.h"

static const SporeIntegrator *const integrators[] = {&spore_symplectic_euler, &spore_implicit_euler};
#define INTEGRATOR_COUNT (sizeof integrators / sizeof *integrators)

const SporeIntegrator *spore_integrator(SporeIntegratorKind kind) { return integrators[kind]; }

size_t spore_integrator_scratch(void) {
  size_t most = 0;
  for (size_t i = 0; i < INTEGRATOR_COUNT; i++)
    if (integrators[i]->scratch > most) most = integrators[i]->scratch;
  return most;
}
