/* The list of models. */
#include "models/registry.h"

const SporeModelType *const spore_model_registry[] = {&spore_rigid_body,
                                                      &spore_mass_spring_net,
                                                      &spore_neo_hookean_tetrahedra,
                                                      &spore_corotational_tetrahedra,
                                                      &spore_saint_venant_kirchhoff_tetrahedra,
                                                      &spore_linear_tetrahedra,
                                                      &spore_condensed_tetrahedra,
                                                      &spore_deformable_surface,
                                                      &spore_lennard_jones,
                                                      &spore_smoke,
                                                      &spore_spline_1d,
                                                      &spore_intestine,
                                                      &spore_finite_differences,
                                                      &spore_spline_2d,
                                                      NULL};
