#include "models/net/ties.h"

#include <assert.h>
#include <string.h>

#include "core/base/memory.h"

static uint32_t lower(uint32_t a, uint32_t b) { return a < b ? a : b; }
static uint32_t higher(uint32_t a, uint32_t b) { return a < b ? b : a; }

static bool are_tied(const SporeNetTies *ties, uint32_t a, uint32_t b) {
  return spore_springs_tie(&ties->springs[SPORE_NET_EDGES], &ties->whole[SPORE_NET_EDGES], a, b);
}

/* How many triangles the edge has left. */
static uint32_t *left_at(const SporeNetTies *ties, uint32_t a, uint32_t b) {
  assert(are_tied(ties, a, b) || spore_net_ties_between(ties, a, b) == SPORE_TIE_GONE);
  return &ties->left[spore_springs_find(&ties->springs[SPORE_NET_EDGES], &ties->whole[SPORE_NET_EDGES], lower(a, b),
                                        higher(a, b))];
}

/* Side k of triangle t; false: it is none. */
static bool side_of(const SporeTriangleMesh *mesh, size_t t, int k, uint32_t *a, uint32_t *b) {
  assert(t < mesh->triangle_count && k >= 0 && k < 3);
  *a = mesh->triangles[3 * t + (size_t)k];
  *b = mesh->triangles[3 * t + (size_t)(k + 1) % 3];
  return *a != *b;
}

static void count_triangles(SporeNetTies *ties) {
  const SporeSprings *edges = &ties->springs[SPORE_NET_EDGES];
  uint32_t a, b;
  memset(ties->left, 0, SPORE_LANES * (size_t)edges->slot_start[edges->group_count] * sizeof *ties->left);
  for (size_t t = 0; t < ties->mesh->triangle_count; t++)
    for (int k = 0; k < 3; k++)
      if (side_of(ties->mesh, t, k, &a, &b)) ++*left_at(ties, a, b);
}

bool spore_net_ties_create(SporeNetTies *ties, SporeSprings *springs, const SporeTriangleMesh *mesh) {
  *ties = (SporeNetTies){.springs = springs, .mesh = mesh};
  size_t nodes = mesh->vertex_count, room = 0;
  for (int kind = 0; kind < SPORE_NET_KINDS; kind++) {
    if (!spore_springs_keep(&springs[kind], nodes, &ties->whole[kind])) return false;
    if (kind != SPORE_NET_BENDING) room += SPORE_LANES * (size_t)springs[kind].slot_start[springs[kind].group_count];
  }
  const SporeSprings *edges = &springs[SPORE_NET_EDGES];
  ties->left = SPORE_NEW_ARRAY(uint32_t, SPORE_LANES * (size_t)edges->slot_start[edges->group_count]);
  ties->gone = SPORE_NEW_ARRAY(bool, mesh->triangle_count);
  ties->frayed = SPORE_NEW_ARRAY(bool, nodes);
  ties->lost = SPORE_NEW_ARRAY(bool, nodes);
  ties->strained = SPORE_NEW_ARRAY(SporeNetStrained, room / 2); /* each comes at both of its ends */
  ties->most = SPORE_NEW_ARRAY(uint32_t, nodes);
  if (!ties->left || !ties->gone || !ties->frayed || !ties->lost || !ties->strained || !ties->most) return false;
  count_triangles(ties);
  return true;
}

void spore_net_ties_clear(SporeNetTies *ties) {
  for (int kind = 0; kind < SPORE_NET_KINDS; kind++) spore_springs_forget(&ties->whole[kind]);
  spore_free(ties->left);
  spore_free(ties->gone);
  spore_free(ties->frayed);
  spore_free(ties->lost);
  spore_free(ties->strained);
  spore_free(ties->most);
  *ties = (SporeNetTies){0};
}

void spore_net_ties_mend(SporeNetTies *ties) {
  for (int kind = 0; kind < SPORE_NET_KINDS; kind++) spore_springs_restore(&ties->springs[kind], &ties->whole[kind]);
  memset(ties->gone, 0, ties->mesh->triangle_count * sizeof *ties->gone);
  memset(ties->frayed, 0, ties->mesh->vertex_count * sizeof *ties->frayed);
  count_triangles(ties);
}

SporeTie spore_net_ties_between(const SporeNetTies *ties, uint32_t a, uint32_t b) {
  assert(a < ties->mesh->vertex_count && b < ties->mesh->vertex_count);
  size_t at = spore_springs_find(&ties->springs[SPORE_NET_EDGES], &ties->whole[SPORE_NET_EDGES], a, b);
  if (at == SPORE_NO_SPRING) return SPORE_TIE_NONE;
  return ties->springs[SPORE_NET_EDGES].neighbour[at] == b ? SPORE_TIE_HOLDS : SPORE_TIE_GONE;
}

size_t spore_net_ties_part(SporeNetTies *ties, uint32_t a, uint32_t b, uint32_t body, SporeCuts *cuts) {
  assert(a < ties->mesh->vertex_count && b < ties->mesh->vertex_count);
  assert(cuts->count <= cuts->capacity);
  if (!spore_springs_part(&ties->springs[SPORE_NET_EDGES], &ties->whole[SPORE_NET_EDGES], a, b)) return 0;
  ties->lost[a] = ties->lost[b] = true;
  if (cuts->count < cuts->capacity) cuts->edges[cuts->count++] = (SporeCutEdge){body, lower(a, b), higher(a, b)};
  return 1;
}

static bool lost_side(const SporeNetTies *ties, size_t t) {
  assert(t < ties->mesh->triangle_count);
  const uint32_t *n = ties->mesh->triangles + 3 * t;
  uint32_t a, b;
  if (ties->lost[n[0]] + ties->lost[n[1]] + ties->lost[n[2]] < 2) return false;
  for (int k = 0; k < 3; k++)
    if (side_of(ties->mesh, t, k, &a, &b) && !are_tied(ties, a, b)) return true;
  return false;
}

static void drop_triangle(SporeNetTies *ties, size_t t) {
  uint32_t a, b;
  ties->gone[t] = true;
  for (int k = 0; k < 3; k++) {
    ties->frayed[ties->mesh->triangles[3 * t + (size_t)k]] = true;
    if (side_of(ties->mesh, t, k, &a, &b)) --*left_at(ties, a, b);
  }
}

static bool hang_together(const SporeNetTies *ties, uint32_t a, uint32_t b) {
  assert(ties->whole[SPORE_NET_EDGES].place[a] != UINT32_MAX);
  const SporeSprings *edges = &ties->springs[SPORE_NET_EDGES];
  uint32_t place = ties->whole[SPORE_NET_EDGES].place[a];
  for (size_t s = edges->slot_start[place / SPORE_LANES]; s < edges->slot_start[place / SPORE_LANES + 1]; s++) {
    uint32_t between = edges->neighbour[s * SPORE_LANES + place % SPORE_LANES];
    if (between != a && are_tied(ties, between, b)) return true;
  }
  return false;
}

typedef struct Search {
  SporeNetTies *ties;
  const double *q;
  const SporeVec3 *triangle;
  uint32_t body;
  SporeCuts *cuts;
  int kind;
  size_t count;
} Search;

static void drop_kind(Search *search, uint32_t a, uint32_t b) {
  SporeNetTies *ties = search->ties;
  int kind = search->kind;
  if (kind == SPORE_NET_EDGES) search->count += spore_net_ties_part(ties, a, b, search->body, search->cuts);
  else search->count += spore_springs_part(&ties->springs[kind], &ties->whole[kind], a, b);
}

static void drop_loose(void *data, uint32_t a, uint32_t b, double length) {
  const Search *search = data;
  if ((search->ties->lost[a] || search->ties->lost[b]) && !hang_together(search->ties, a, b)) drop_kind(data, a, b);
}

size_t spore_net_ties_settle(SporeNetTies *ties, uint32_t body, SporeCuts *cuts) {
  assert(ties->gone);
  Search search = {.ties = ties, .body = body, .cuts = cuts};
  const SporeTriangleMesh *mesh = ties->mesh;
  uint32_t a, b;
  for (size_t t = 0; t < mesh->triangle_count; t++)
    if (!ties->gone[t] && lost_side(ties, t)) drop_triangle(ties, t);
  for (size_t t = 0; t < mesh->triangle_count; t++)
    for (int k = 0; ties->gone[t] && k < 3; k++)
      if (side_of(mesh, t, k, &a, &b) && *left_at(ties, a, b) == 0)
        search.count += spore_net_ties_part(ties, a, b, body, cuts);
  for (search.kind = SPORE_NET_SHEAR; search.kind < SPORE_NET_KINDS; search.kind++)
    spore_springs_visit(&ties->springs[search.kind], drop_loose, &search);
  memset(ties->lost, 0, mesh->vertex_count * sizeof *ties->lost);
  return search.count;
}

static void drop_crossing(void *data, uint32_t a, uint32_t b, double length) {
  const Search *search = data;
  const SporeVec3 *corner = search->triangle;
  if (spore_vec3_crosses(spore_vec3_load(search->q + 3 * (size_t)a), spore_vec3_load(search->q + 3 * (size_t)b),
                         corner[0], corner[1], corner[2]))
    drop_kind(data, a, b);
}

size_t spore_net_ties_cut(SporeNetTies *ties, const double *q, const SporeVec3 triangle[3], uint32_t body,
                          SporeCuts *cuts) {
  assert(ties->gone && q);
  Search search = {.ties = ties, .q = q, .triangle = triangle, .body = body, .cuts = cuts};
  for (; search.kind < SPORE_NET_KINDS; search.kind++)
    spore_springs_visit(&ties->springs[search.kind], drop_crossing, &search);
  return search.count > 0 ? search.count + spore_net_ties_settle(ties, body, cuts) : 0;
}
