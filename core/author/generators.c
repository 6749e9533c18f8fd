/* The registry of generators. */
#include "core/author/generator.h"

const SporeGeneratorType *const spore_generators[] = {
    &spore_generator_spheres,
    &spore_generator_tetrahedra,
    &spore_generator_surface,
    &spore_generator_curve,
    &spore_generator_labels,
    &spore_generator_sheet,
    NULL,
};
