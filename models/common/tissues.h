/* Stiffness of organs, for the solids of this program. */
#ifndef SPORE_MODELS_COMMON_TISSUES_H
#define SPORE_MODELS_COMMON_TISSUES_H

#include "core/base/text.h"
#include "core/body/model.h"
#include "models/common/fields.h"

/* Of models with young_modulus, poisson_ratio and density: the tissues of core/sim/tissue.h. */
extern const SporePreset spore_tissue_presets[];

/* Entries of their parameter tables that they have in common; young_modulus, poisson_ratio, then the rest. */
#define SPORE_TISSUE_YOUNG_MODULUS(Fields)                                                                             \
  SPORE_REAL_FIELD(                                                                                                    \
      Fields, young_modulus, "Pa", 1e-3, 1e15, 5000, SPORE_CHANGE_LIVE,                                                \
      N_("Young's modulus, 2 (1 + Poisson's ratio) times the shear modulus; the presets give some for organs."))
#define SPORE_TISSUE_DENSITY_AND_DAMPING(Fields)                                                                       \
  SPORE_REAL_FIELD(Fields, density, "kg/m^3", 1e-3, 1e6, 1060, SPORE_CHANGE_REBUILD,                                   \
                   N_("Mass per volume; 1060 is soft tissue.")),                                                       \
      SPORE_REAL_FIELD(Fields, mass_damping, "1/s", 0, 1e6, 0, SPORE_CHANGE_LIVE,                                      \
                       N_("Damping of all motion, as by a surrounding fluid: force per mass and speed.")),             \
      SPORE_REAL_FIELD(Fields, stiffness_damping, "s", 0, 1e3, 0.01, SPORE_CHANGE_LIVE,                                \
                       N_("Damping of deformation: viscous stress is this time times the stress of the strain rate."))

#endif
