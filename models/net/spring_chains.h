/* Springs that lie end to end, to be met at once. */
#ifndef SPORE_MODELS_NET_SPRING_CHAINS_H
#define SPORE_MODELS_NET_SPRING_CHAINS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct SporeSpringPair { /* a spring: its nodes a < b, and where it lies in the slots at its node a */
  uint32_t a, b, slot;
} SporeSpringPair;

/* Each spring is in one chain, each node at most once in a chain. Chain c has the springs start[c] to start[c + 1], and
 * one node more than springs, from node[start[c] + c] on: spring k of it leads from its node k to the one after. */
typedef struct SporeSpringChains {
  size_t count;
  uint32_t *start;  /* count + 1 */
  uint32_t *spring; /* numbers of pairs */
  uint32_t *node;
  uint8_t
      *colour; /* count: those of a colour have no node in common, but for SPORE_CHAIN_COLOURS - 1, where they may */
} SporeSpringChains;

#define SPORE_CHAIN_COLOURS 64

/* Chains as long and as straight at rest as they come: where more than one spring leads on, the straightest does, and
 * none that turns by more than 45 degrees. rest: node_count x 3. False: no memory; to be cleared all the same. */
bool spore_spring_chains_find(SporeSpringChains *chains, const SporeSpringPair *pairs, size_t count, const double *rest,
                              size_t node_count);
void spore_spring_chains_clear(SporeSpringChains *chains);

static inline size_t spore_spring_chain_length(const SporeSpringChains *chains, size_t chain) {
  return chains->start[chain + 1] - chains->start[chain];
}

#endif
