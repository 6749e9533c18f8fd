/* The models of this program. */
#ifndef SPORE_MODELS_REGISTRY_H
#define SPORE_MODELS_REGISTRY_H

#include "core/body/model.h"

extern const SporeModelType spore_rigid_body, spore_mass_spring_net, spore_corotational_tetrahedra,
    spore_neo_hookean_tetrahedra, spore_saint_venant_kirchhoff_tetrahedra, spore_linear_tetrahedra,
    spore_condensed_tetrahedra, spore_deformable_surface, spore_lennard_jones, spore_smoke, spore_spline_1d,
    spore_intestine, spore_spline_2d, spore_finite_differences;

/* NULL-terminated. The first that takes a kind of geometry is the usual choice for it. */
extern const SporeModelType *const spore_model_registry[];

#endif
