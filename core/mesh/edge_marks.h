/* Whether directed edges cancel, by a sum of random numbers: the sum over all edges of the number of an edge's ends,
 * with the sign of its direction, is 0 if all cancel; and else only by a chance of 2^-64. */
#ifndef SPORE_MESH_EDGE_MARKS_H
#define SPORE_MESH_EDGE_MARKS_H

#include <stdint.h>

/* Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators": the mixing of 64 bits. */
static inline uint64_t spore_mark_mix(uint64_t x) {
  x = (x ^ x >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  x = (x ^ x >> 27) * UINT64_C(0x94d049bb133111eb);
  return x ^ x >> 31;
}

/* The signed number of the edge between two ends, by a number of each. */
static inline uint64_t spore_edge_mark(uint64_t from, uint64_t to) {
  return from < to   ? spore_mark_mix(spore_mark_mix(from) + to)
         : from > to ? -spore_mark_mix(spore_mark_mix(to) + from)
                     : 0;
}

#endif
