/* Elements in batches of which no two have a node in common, so that their lanes may be computed at once, one batch
 * after the other. */
#ifndef SPORE_MODELS_COMMON_BATCHES_H
#define SPORE_MODELS_COMMON_BATCHES_H

#include <stddef.h>
#include <stdint.h>

/* Of elements of `corners` nodes each, count x corners numbers below node_count: batch x lane: the number of an
 * element; the elements of a batch come first in it, behind them UINT32_MAX. *batches: how many. Of spore_allocate;
 * NULL: no memory. Elements get the first colour that no element with a node in common has, in their order. */
uint32_t *spore_batches_order(const uint32_t *nodes, size_t corners, size_t count, size_t node_count, size_t *batches);

#endif
