/* Sorting of integer keys, for adjacency. */
#ifndef SPORE_MESH_SORT_H
#define SPORE_MESH_SORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Stable ascending radix sort of count keys, values carried along (values may be NULL). false: no memory, arrays as
 * they were. */
bool spore_sort_keys(uint64_t *keys, uint32_t *values, size_t count);

#endif
