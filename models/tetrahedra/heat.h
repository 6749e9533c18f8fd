/* Tetrahedra that coagulate while they run: they get smaller at rest, and stiffer. */
#ifndef SPORE_MODELS_TETRAHEDRA_HEAT_H
#define SPORE_MODELS_TETRAHEDRA_HEAT_H

#include "core/body/model.h"
#include "models/tetrahedra/tetrahedra.h"

/* As they were, and what heat did since. An element's `volume` weighs its energy, and so takes its share of the
 * stiffness; its lengths at rest are in its inverse. */
typedef struct SporeTetrahedraHeat {
  SporeTetrahedronBatch *whole;      /* batch_count; NULL: never heated */
  double *dose, *length, *stiffness; /* batch_count x SPORE_LANES: 0 to 1; parts of what was */
} SporeTetrahedraHeat;

/* False: no memory; to be cleared all the same. */
bool spore_tetrahedra_heat_create(SporeTetrahedraHeat *heated, const SporeTetrahedra *tetrahedra);
void spore_tetrahedra_heat_clear(SporeTetrahedraHeat *heated);
/* Those whose corners' mean is in the heat; returns their number. */
size_t spore_tetrahedra_coagulate(SporeTetrahedra *tetrahedra, SporeTetrahedraHeat *heated, const double *q,
                                  const SporeHeat *heat);
void spore_tetrahedra_cool(SporeTetrahedra *tetrahedra, SporeTetrahedraHeat *heated);

#endif
