/* Sphere sets that tests of the generators begin with. */
#ifndef SPORE_TESTS_GENERATE_SETS_H
#define SPORE_TESTS_GENERATE_SETS_H

#include "core/generate/spheres.h"

/* A set of options.count spheres, made without a message and valid; what it measured goes to the log. */
SporeSphereSet make_set(const SporeTriangleMesh *mesh, SporeSpheresOptions options, SporeSpheresReport *report);

#endif
