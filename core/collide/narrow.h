/* Narrow phase: the contact of two spheres. */
#ifndef SPORE_COLLIDE_NARROW_H
#define SPORE_COLLIDE_NARROW_H

#include <stdbool.h>

#include "core/collide/sphere.h"

/* Contact of spheres a < b as spore_grid_detect defines it; false: none. soft: one of the two bodies is. */
bool spore_narrow_contact(const SporeSpheres *spheres, uint32_t a, uint32_t b, double dt_s, bool soft,
                          SporeContact *contact);
/* Whether spheres a < b passed in the step before, as spore_grid_passed defines it. */
bool spore_narrow_passed(const SporeSpheres *spheres, uint32_t a, uint32_t b, double dt_s, SporeContact *contact);

#endif
