/* Stiffness of organs, for the solids of this program. */
#ifndef SPORE_MODELS_TISSUES_H
#define SPORE_MODELS_TISSUES_H

#include "core/sim/model.h"

/* Of models with young_modulus, poisson_ratio and density. Young's modulus is 2 (1 + Poisson's ratio) times the shear
 * modulus that was measured; the ratio is 0.45, up to which linear elements are right. */
extern const SporePreset spore_tissues[];

#endif
