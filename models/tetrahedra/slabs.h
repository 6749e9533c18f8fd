/* Division of a tetrahedral mesh into slabs whose every second has no node in common. */
#ifndef SPORE_MODELS_TETRAHEDRA_SLABS_H
#define SPORE_MODELS_TETRAHEDRA_SLABS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct SporeSlabs {
  size_t count;
  uint32_t *start; /* count + 1: a slab's first in `order` */
  uint32_t *order; /* tetrahedra: those of a slab one after the other, ascending */
} SporeSlabs;

/* corners: count x 4 numbers below node_count, count above 0. No more slabs than `wanted`, of about as many tetrahedra
 * each as the mesh allows; one at least. False: no memory. */
bool spore_slabs_create(SporeSlabs *slabs, const uint32_t *corners, size_t count, size_t node_count, size_t wanted);
void spore_slabs_clear(SporeSlabs *slabs);

#endif
