#include "models/common/tissues.h"

#include "core/body/tissue.h"

/* Of the quantities, those that solids have, as the file writes them. */
#define SETTING_young_modulus(value) "young_modulus", #value,
#define SETTING_poisson_ratio(value) "poisson_ratio", #value,
#define SETTING_density(value) "density", #value,
#define SETTING_stiffness_damping(value) "stiffness_damping", #value,
#define SETTING_tear_strain(value)
#define SETTING_friction(value)
#define Q(quantity, typical, minimum, maximum, source) SETTING_##quantity(typical)
#define T(name, label, source, quantities) {#name, label, source, {quantities NULL}},

const SporePreset spore_tissue_presets[] = {SPORE_TISSUES{0}};
