/* Where a net tears. Its strain is known at the beginning of a step: after the first spring gave way it is another one.
 * So a tear begins in one place at a time, where the strain is most, and goes on at its ends by one edge a step, where
 * the strain there is most: a line, and not all that a pull has strained. */
#include <assert.h>
#include <string.h>

#include "models/net/ties.h"

typedef struct Search {
  SporeNetTies *ties;
  const double *q;
  double strain;
  size_t count; /* shear springs that went by themselves */
} Search;

/* Negative: of no length at rest, which has no strain. */
static double strain_of(const double *q, uint32_t a, uint32_t b, double length) {
  if (!(length > 0)) return -1;
  return spore_vec3_distance(spore_vec3_load(q + 3 * (size_t)a), spore_vec3_load(q + 3 * (size_t)b)) / length - 1;
}

static void add(SporeNetTies *ties, uint32_t a, uint32_t b, double strain) {
  ties->strained[ties->strained_count++] = (SporeNetStrained){a, b, strain};
}

static void find_edge(void *data, uint32_t a, uint32_t b, double length) {
  const Search *search = data;
  double strain = strain_of(search->q, a, b, length);
  if (strain > search->strain) add(search->ties, a, b, strain);
}

/* The nodes of the edge that the shear spring between a and b crosses, and that still is tied to both. */
static bool edge_under(const SporeNetTies *ties, uint32_t a, uint32_t b, uint32_t edge[2]) {
  const SporeSprings *edges = &ties->springs[SPORE_NET_EDGES];
  const SporeSpringsWhole *whole = &ties->whole[SPORE_NET_EDGES];
  uint32_t place = whole->place[a], lane = place % SPORE_LANES, group = place / SPORE_LANES;
  for (size_t i = edges->slot_start[group]; i < edges->slot_start[group + 1]; i++)
    for (size_t j = edges->slot_start[group]; j < i; j++) {
      edge[0] = edges->neighbour[i * SPORE_LANES + lane], edge[1] = edges->neighbour[j * SPORE_LANES + lane];
      if (spore_springs_tie(edges, whole, edge[0], edge[1]) && spore_springs_tie(edges, whole, edge[0], b) &&
          spore_springs_tie(edges, whole, edge[1], b))
        return true;
    }
  return false;
}

static void find_sheared(void *data, uint32_t a, uint32_t b, double length) {
  Search *search = data;
  SporeNetTies *ties = search->ties;
  double strain = strain_of(search->q, a, b, length);
  uint32_t edge[2];
  if (!(strain > search->strain)) return;
  if (edge_under(ties, a, b, edge)) add(ties, edge[0], edge[1], strain);
  else search->count += spore_springs_part(&ties->springs[SPORE_NET_SHEAR], &ties->whole[SPORE_NET_SHEAR], a, b);
}

static bool is_more(const SporeNetTies *ties, uint32_t i, uint32_t than) {
  assert(i > 0 && i <= ties->strained_count && than > 0 && than <= ties->strained_count);
  return ties->strained[i - 1].strain > ties->strained[than - 1].strain;
}

/* Of those at each node the one strained most, the first of equal ones. */
static void find_most(SporeNetTies *ties) {
  memset(ties->most, 0, ties->mesh->vertex_count * sizeof *ties->most);
  for (uint32_t i = 1; i <= ties->strained_count; i++) {
    const uint32_t nodes[2] = {ties->strained[i - 1].a, ties->strained[i - 1].b};
    for (int k = 0; k < 2; k++)
      if (ties->most[nodes[k]] == 0 || is_more(ties, i, ties->most[nodes[k]])) ties->most[nodes[k]] = i;
  }
}

/* Whether nothing at the node, nor at those that edges tie to it, is strained more than i; of what is strained alike
 * the first. */
static bool is_most_around(const SporeNetTies *ties, uint32_t node, uint32_t i) {
  assert(ties->whole[SPORE_NET_EDGES].place[node] != UINT32_MAX);
  const SporeSprings *edges = &ties->springs[SPORE_NET_EDGES];
  uint32_t place = ties->whole[SPORE_NET_EDGES].place[node];
  for (size_t s = edges->slot_start[place / SPORE_LANES]; s < edges->slot_start[place / SPORE_LANES + 1]; s++) {
    uint32_t other = ties->most[edges->neighbour[s * SPORE_LANES + place % SPORE_LANES]];
    if (other != 0 && other != i && (is_more(ties, other, i) || (other < i && !is_more(ties, i, other)))) return false;
  }
  return ties->most[node] == i;
}

static size_t grow(SporeNetTies *ties, uint32_t body, SporeCuts *cuts) {
  size_t count = 0;
  for (uint32_t i = 1; i <= ties->strained_count; i++) {
    uint32_t a = ties->strained[i - 1].a, b = ties->strained[i - 1].b;
    if ((ties->frayed[a] || ties->frayed[b]) && is_most_around(ties, a, i) && is_most_around(ties, b, i))
      count += spore_net_ties_part(ties, a, b, body, cuts);
  }
  return count;
}

static size_t begin(SporeNetTies *ties, uint32_t body, SporeCuts *cuts) {
  assert(ties->strained_count > 0);
  const SporeNetStrained *most = ties->strained;
  for (size_t i = 1; i < ties->strained_count; i++)
    if (ties->strained[i].strain > most->strain) most = &ties->strained[i];
  return spore_net_ties_part(ties, most->a, most->b, body, cuts);
}

size_t spore_net_ties_tear(SporeNetTies *ties, const double *q, double strain, uint32_t body, SporeCuts *cuts) {
  assert(ties->gone);
  assert(strain > 0);
  const SporeSprings *springs = ties->springs;
  Search search = {.ties = ties, .q = q, .strain = strain};
  if (!SPORE_KERNEL(spore_springs_exceed)(&springs[SPORE_NET_EDGES], q, strain) &&
      !SPORE_KERNEL(spore_springs_exceed)(&springs[SPORE_NET_SHEAR], q, strain))
    return 0;
  ties->strained_count = 0;
  spore_springs_visit(&springs[SPORE_NET_EDGES], find_edge, &search);
  spore_springs_visit(&springs[SPORE_NET_SHEAR], find_sheared, &search);
  if (ties->strained_count == 0) return search.count;
  find_most(ties);
  size_t torn = grow(ties, body, cuts);
  if (torn == 0) torn = begin(ties, body, cuts);
  return search.count + torn + spore_net_ties_settle(ties, body, cuts);
}
