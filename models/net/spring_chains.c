/* Springs that lie end to end: straight rows of a grid, and what is as near to that as a mesh has. */
#include "models/net/spring_chains.h"

#include <assert.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/math/vec3.h"

#define STRAIGHT 0.7 /* least cosine of the angle by which a chain turns */
#define NONE UINT32_MAX

/* What a search goes through. */
typedef struct Search {
  const SporeSpringPair *pairs;
  const double *rest;
  uint32_t *first, *at_node; /* springs of node n: at_node[first[n]] to at_node[first[n + 1]] */
  uint32_t *met;             /* node: the last chain that it is in */
  bool *taken;               /* spring */
  uint32_t *trail;           /* springs of one chain */
} Search;

static void clear_search(Search *search) {
  spore_free(search->first);
  spore_free(search->at_node);
  spore_free(search->met);
  spore_free(search->taken);
  spore_free(search->trail);
}

static void list_at_nodes(Search *search, size_t count, size_t node_count) {
  uint32_t *first = search->first;
  for (size_t s = 0; s < count; s++) first[search->pairs[s].a + 2]++, first[search->pairs[s].b + 2]++;
  for (size_t n = 1; n < node_count; n++) first[n + 1] += first[n];
  for (uint32_t s = 0; s < count; s++) {
    search->at_node[first[search->pairs[s].a + 1]++] = s;
    search->at_node[first[search->pairs[s].b + 1]++] = s;
  }
  for (size_t n = 0; n < node_count; n++) search->met[n] = NONE;
}

static bool begin(Search *search, size_t count, size_t node_count) {
  search->first = SPORE_NEW_ARRAY(uint32_t, node_count + 2);
  search->at_node = SPORE_NEW_ARRAY(uint32_t, 2 * count);
  search->met = SPORE_NEW_ARRAY(uint32_t, node_count);
  search->taken = SPORE_NEW_ARRAY(bool, count);
  search->trail = SPORE_NEW_ARRAY(uint32_t, count);
  if (!search->first || !search->at_node || !search->met || !search->taken || !search->trail) return false;
  list_at_nodes(search, count, node_count);
  return true;
}

static uint32_t other_end(const SporeSpringPair *pair, uint32_t node) { return pair->a == node ? pair->b : pair->a; }

static SporeVec3 along(const Search *search, uint32_t from, uint32_t to) {
  SporeVec3 line =
      spore_vec3_sub(spore_vec3_load(search->rest + 3 * (size_t)to), spore_vec3_load(search->rest + 3 * (size_t)from));
  return spore_vec3_normalise(line, (SporeVec3){0, 0, 0});
}

/* The spring that leads straight on from a node that was reached along `line`. */
static uint32_t next_spring(const Search *search, uint32_t chain, uint32_t node, SporeVec3 line) {
  uint32_t best = NONE;
  double straightest = STRAIGHT;
  for (uint32_t i = search->first[node]; i < search->first[node + 1]; i++) {
    uint32_t spring = search->at_node[i], to = other_end(&search->pairs[spring], node);
    if (search->taken[spring] || search->met[to] == chain) continue;
    double straight = spore_vec3_dot(line, along(search, node, to));
    if (straight > straightest) straightest = straight, best = spring;
  }
  return best;
}

/* Takes springs on from `to`, which was reached from `from`; they are put to `trail`. Returns how many. */
static size_t walk(Search *search, uint32_t chain, uint32_t from, uint32_t to, uint32_t *trail) {
  size_t count = 0;
  for (;;) {
    uint32_t spring = next_spring(search, chain, to, along(search, from, to));
    if (spring == NONE) return count;
    trail[count++] = spring;
    search->taken[spring] = true;
    from = to;
    to = other_end(&search->pairs[spring], from);
    search->met[to] = chain;
  }
}

/* The chain that the spring is in, behind those that there are: first the way on from a, backward, then from b. */
static void add_chain(Search *search, SporeSpringChains *chains, uint32_t spring) {
  uint32_t chain = (uint32_t)chains->count++, begin = chains->start[chain];
  const SporeSpringPair *pair = &search->pairs[spring];
  search->taken[spring] = true;
  search->met[pair->a] = search->met[pair->b] = chain;
  uint32_t *springs = chains->spring + begin, *nodes = chains->node + begin + chain;
  size_t before = walk(search, chain, pair->b, pair->a, search->trail);
  for (size_t i = 0; i < before; i++) springs[i] = search->trail[before - 1 - i];
  springs[before] = spring;
  size_t count = before + 1 + walk(search, chain, pair->a, pair->b, springs + before + 1);
  nodes[before] = pair->a;
  for (size_t i = before; i-- > 0;) nodes[i] = other_end(&search->pairs[springs[i]], nodes[i + 1]);
  for (size_t i = before; i < count; i++) nodes[i + 1] = other_end(&search->pairs[springs[i]], nodes[i]);
  chains->start[chain + 1] = begin + (uint32_t)count;
}

/* The first colour that no chain with a node in common has. taken: a set of colours for each node, none at first. */
static void colour_chains(SporeSpringChains *chains, uint64_t *taken) {
  for (size_t c = 0; c < chains->count; c++) {
    const uint32_t *nodes = chains->node + chains->start[c] + c;
    size_t count = spore_spring_chain_length(chains, c) + 1;
    uint64_t all = 0;
    uint8_t colour = 0;
    for (size_t i = 0; i < count; i++) all |= taken[nodes[i]];
    while (colour < SPORE_CHAIN_COLOURS - 1 && all >> colour & 1) colour++;
    for (size_t i = 0; i < count; i++) taken[nodes[i]] |= (uint64_t)1 << colour;
    chains->colour[c] = colour;
  }
}

bool spore_spring_chains_find(SporeSpringChains *chains, const SporeSpringPair *pairs, size_t count, const double *rest,
                              size_t node_count) {
  assert(pairs || count == 0);
  *chains = (SporeSpringChains){.start = SPORE_NEW_ARRAY(uint32_t, count + 1),
                                .spring = SPORE_NEW_ARRAY(uint32_t, count),
                                .node = SPORE_NEW_ARRAY(uint32_t, 2 * count),
                                .colour = SPORE_NEW_ARRAY(uint8_t, count)};
  Search search = {.pairs = pairs, .rest = rest};
  uint64_t *colours = SPORE_NEW_ARRAY(uint64_t, node_count);
  bool made =
      chains->start && chains->spring && chains->node && chains->colour && colours && begin(&search, count, node_count);
  for (uint32_t s = 0; made && s < count; s++)
    if (!search.taken[s]) add_chain(&search, chains, s);
  if (made) colour_chains(chains, colours);
  spore_free(colours);
  clear_search(&search);
  return made;
}

void spore_spring_chains_clear(SporeSpringChains *chains) {
  spore_free(chains->start);
  spore_free(chains->spring);
  spore_free(chains->node);
  spore_free(chains->colour);
  *chains = (SporeSpringChains){0};
}
