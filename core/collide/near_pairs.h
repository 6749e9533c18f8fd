/* Pairs of spheres that are near each other, found once: for measuring and for making bodies, not for steps. */
#ifndef SPORE_COLLIDE_NEAR_PAIRS_H
#define SPORE_COLLIDE_NEAR_PAIRS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Calls `found` once for each pair a < b of spheres (centre: count x 3, radius: count, m) whose distance is below the
 * sum of their radii times `scale` (above 0) and `reach` (m) more. Each sphere is compared with those near it along the
 * axis on which the centres spread the farthest. False: no memory, or `found` said false, which ends it. */
typedef bool (*SporeNearPairFound)(void *data, uint32_t a, uint32_t b);
bool spore_near_pairs(const double *centre, const double *radius, size_t count, double scale, double reach,
                      SporeNearPairFound found, void *data);

#endif
