/* Sphere sets that tests of the generators begin with. */
#ifndef SPORE_TESTS_GENERATE_SETS_H
#define SPORE_TESTS_GENERATE_SETS_H

#include "core/generate/spheres/spheres.h"

/* A set of options.count spheres, made without a message and valid; what it measured goes to the log. */
SporeSphereSet make_set(const SporeTriangleMesh *mesh, SporeSpheresOptions options, SporeSpheresReport *report);
/* Whether the set holds a sphere there, to `tolerance`; `weight` NULL: of any weight. */
bool set_holds(const SporeSphereSet *set, const double sphere[4], const double *weight, double tolerance);
/* In how many of the planes x = middle[0], y = middle[1], z = middle[2] the set, weights too, is its own image, to
 * 1e-12. */
size_t count_mirrors(const SporeSphereSet *set, const double middle[3]);

#endif
