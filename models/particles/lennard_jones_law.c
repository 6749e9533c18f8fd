#include "models/particles/lennard_jones_law.h"

#include <assert.h>
#include <math.h>

SporeLennardJonesLaw spore_lennard_jones_law(double sigma, double epsilon, double cutoff, double core) {
  assert(sigma > 0 && epsilon > 0);
  assert(0 < core && core < cutoff);
  double s6 = pow(sigma, 6), c2 = 1 / (cutoff * cutoff), c6 = c2 * c2 * c2, k2 = 1 / (core * core), k6 = k2 * k2 * k2;
  SporeLennardJonesLaw law = {.cutoff2 = cutoff * cutoff, .core2 = core * core};
  law.e6 = 4 * epsilon * s6;
  law.e12 = law.e6 * s6;
  law.f6 = 6 * law.e6;
  law.f12 = 12 * law.e12;
  law.shift = (law.f12 * c6 - law.f6) * c6 * c2;
  law.level = (law.e12 * c6 - law.e6) * c6 + 0.5 * law.shift * law.cutoff2;
  law.core_stiffness = (law.f12 * k6 - law.f6) * k6 * k2 - law.shift;
  return law;
}
