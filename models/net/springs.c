/* Making springs, laid out by node, and their loops over chunks of nodes. */
#include "models/net/springs.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"

static void free_lines(SporeSpringsLines *lines) {
  if (!lines) return;
  spore_free(lines->shape);
  spore_free(lines->along);
  spore_free(lines);
}

void spore_springs_clear(SporeSprings *springs) {
  free_lines(springs->lines);
  spore_free(springs->chunk_start);
  spore_free(springs->node);
  spore_free(springs->lanes);
  spore_free(springs->slot_start);
  spore_free(springs->neighbour);
  spore_free(springs->is_run);
  spore_free(springs->node_is_run);
  spore_free(springs->length);
  spore_free(springs->block);
  spore_free(springs->diagonal);
  spore_free(springs->share);
  spore_free(springs->dose);
  spore_springs_sweep_clear(&springs->sweep);
  *springs = (SporeSprings){0};
}

static uint32_t first_of(uint64_t key) { return (uint32_t)(key >> 32); }
static uint32_t second_of(uint64_t key) { return (uint32_t)key; }

/* Whether each key names two different nodes, the lower one first. */
static inline bool keys_are_pairs(const uint64_t *keys, size_t count, size_t node_count) {
  for (size_t k = 0; k < count; k++)
    if (first_of(keys[k]) >= second_of(keys[k]) || second_of(keys[k]) >= node_count) return false;
  return true;
}

/* Where the nodes of each chunk that have springs begin among the groups. */
static bool make_groups(SporeSprings *springs, const uint32_t *valence, size_t count) {
  springs->chunk_count = (count + SPORE_SPRINGS_CHUNK - 1) / SPORE_SPRINGS_CHUNK;
  springs->chunk_start = SPORE_NEW_ARRAY(uint32_t, springs->chunk_count + 1);
  if (!springs->chunk_start) return false;
  for (size_t i = 0; i < count; i++)
    if (valence[i] > 0) springs->chunk_start[i / SPORE_SPRINGS_CHUNK + 1]++;
  for (size_t c = 0; c < springs->chunk_count; c++)
    springs->chunk_start[c + 1] =
        springs->chunk_start[c] + (springs->chunk_start[c + 1] + SPORE_LANES - 1) / SPORE_LANES;
  springs->group_count = springs->chunk_start[springs->chunk_count];
  springs->node = SPORE_NEW_ARRAY(uint32_t, springs->group_count * SPORE_LANES);
  springs->lanes = SPORE_NEW_ARRAY(uint8_t, springs->group_count);
  return springs->node && springs->lanes;
}

/* Orders the nodes first..end-1 that have springs: those with the most springs first, else in the order of their
 * numbers. The ordered nodes begin at `start`; place[i] is the place of node i. next: scratch, one number a valence,
 * zero. */
static void order_nodes(SporeSprings *springs, const uint32_t *valence, size_t first, size_t end, uint32_t start,
                        uint32_t most, uint32_t *next, uint32_t *place) {
  assert(first <= end);
  for (size_t i = first; i < end; i++)
    if (valence[i] > 0) next[valence[i] - 1]++;
  for (size_t v = most; v-- > 0;) next[v] += next[v + 1];
  for (size_t i = first; i < end; i++) {
    if (valence[i] == 0) continue;
    place[i] = start + next[valence[i]]++;
    springs->node[place[i]] = (uint32_t)i;
    springs->lanes[place[i] / SPORE_LANES]++;
  }
  for (size_t v = 0; v <= most; v++) next[v] = 0;
}

static bool order_chunks(SporeSprings *springs, const uint32_t *valence, size_t count, uint32_t *place) {
  uint32_t most = 0;
  for (size_t i = 0; i < count; i++)
    if (valence[i] > most) most = valence[i];
  uint32_t *next = SPORE_NEW_ARRAY(uint32_t, (size_t)most + 1);
  if (!next) return false;
  for (size_t c = 0; c < springs->chunk_count; c++) {
    size_t first = c * SPORE_SPRINGS_CHUNK, left = count - first;
    order_nodes(springs, valence, first, first + (left < SPORE_SPRINGS_CHUNK ? left : SPORE_SPRINGS_CHUNK),
                springs->chunk_start[c] * SPORE_LANES, most, next, place);
  }
  spore_free(next);
  return true;
}

/* A group has as many slots as its first node has springs; all are empty. */
static bool make_slots(SporeSprings *springs, const uint32_t *valence) {
  springs->slot_start = SPORE_NEW_ARRAY(uint32_t, springs->group_count + 1);
  if (!springs->slot_start) return false;
  for (size_t g = 0; g < springs->group_count; g++)
    springs->slot_start[g + 1] = springs->slot_start[g] + valence[springs->node[g * SPORE_LANES]];
  size_t lanes = SPORE_LANES * (size_t)springs->slot_start[springs->group_count];
  springs->neighbour = SPORE_NEW_ARRAY(uint32_t, lanes);
  springs->is_run = SPORE_NEW_ARRAY(bool, springs->slot_start[springs->group_count]);
  springs->node_is_run = SPORE_NEW_ARRAY(bool, springs->group_count);
  springs->length = SPORE_NEW_ARRAY(double, lanes);
  springs->block = SPORE_NEW_ARRAY(uint32_t, lanes);
  springs->diagonal = SPORE_NEW_ARRAY(uint32_t, springs->group_count * SPORE_LANES);
  if (!springs->neighbour || !springs->is_run || !springs->node_is_run || !springs->length || !springs->block ||
      !springs->diagonal)
    return false;
  for (size_t g = 0; g < springs->group_count; g++)
    for (size_t i = SPORE_LANES * (size_t)springs->slot_start[g]; i < SPORE_LANES * (size_t)springs->slot_start[g + 1];
         i++) {
      springs->neighbour[i] = springs->node[g * SPORE_LANES + i % SPORE_LANES];
      springs->length[i] = -0.0;
    }
  return true;
}

static bool make_lines(SporeSprings *springs, size_t node_count) {
  springs->lines = SPORE_NEW(SporeSpringsLines);
  if (!springs->lines) return false;
  springs->lines->count = 3 * node_count;
  springs->lines->shape = SPORE_NEW_ARRAY(double, 3 * node_count);
  springs->lines->along = SPORE_NEW_ARRAY(double, 4 * SPORE_LANES * (size_t)springs->slot_start[springs->group_count]);
  return springs->lines->shape && springs->lines->along;
}

static void put(SporeSprings *springs, uint32_t place, uint32_t slot, uint32_t neighbour, double length) {
  assert(place / SPORE_LANES < springs->group_count);
  size_t at = ((size_t)springs->slot_start[place / SPORE_LANES] + slot) * SPORE_LANES + place % SPORE_LANES;
  springs->neighbour[at] = neighbour;
  springs->length[at] = length;
}

static void fill_slots(SporeSprings *springs, const uint64_t *keys, size_t count, const uint32_t *place,
                       uint32_t *valence, size_t node_count) {
  for (size_t i = 0; i < node_count; i++) valence[i] = 0; /* counted up again as the springs come */
  for (size_t k = 0; k < count; k++) {
    uint32_t a = first_of(keys[k]), b = second_of(keys[k]);
    double length = spore_vec3_distance(spore_vec3_load(springs->rest + 3 * (size_t)a),
                                        spore_vec3_load(springs->rest + 3 * (size_t)b));
    put(springs, place[a], valence[a]++, b, length);
    put(springs, place[b], valence[b]++, a, length);
  }
}

static bool is_run(const uint32_t number[SPORE_LANES]) {
  for (uint32_t i = 1; i < SPORE_LANES; i++)
    if (number[i] != number[0] + i) return false;
  return true;
}

static void find_runs(SporeSprings *springs) {
  for (size_t g = 0; g < springs->group_count; g++) springs->node_is_run[g] = is_run(springs->node + g * SPORE_LANES);
  for (size_t s = 0; s < springs->slot_start[springs->group_count]; s++)
    springs->is_run[s] = is_run(springs->neighbour + s * SPORE_LANES);
}

bool spore_springs_create(SporeSprings *springs, const uint64_t *keys, size_t count, const double *rest,
                          size_t node_count) {
  assert(node_count == 0 || rest);
  assert(keys_are_pairs(keys, count, node_count));
  *springs = (SporeSprings){.rest = rest};
  uint32_t *valence = SPORE_NEW_ARRAY(uint32_t, node_count), *place = SPORE_NEW_ARRAY(uint32_t, node_count);
  bool made = valence && place && count <= UINT32_MAX / 2;
  for (size_t k = 0; made && k < count; k++) valence[first_of(keys[k])]++, valence[second_of(keys[k])]++;
  made = made && make_groups(springs, valence, node_count) && order_chunks(springs, valence, node_count, place) &&
         make_slots(springs, valence) && make_lines(springs, node_count);
  if (made) fill_slots(springs, keys, count, place, valence, node_count);
  if (made) find_runs(springs);
  spore_free(valence);
  spore_free(place);
  return made;
}

bool spore_springs_pattern(const SporeSprings *springs, SporeBlockPattern *pattern) {
  assert(springs->slot_start);
  for (size_t g = 0; g < springs->group_count; g++)
    for (size_t i = SPORE_LANES * (size_t)springs->slot_start[g]; i < SPORE_LANES * (size_t)springs->slot_start[g + 1];
         i++) {
      uint32_t a = springs->node[g * SPORE_LANES + i % SPORE_LANES], b = springs->neighbour[i];
      if (a < b && !spore_block_pattern_add(pattern, a, b)) return false;
    }
  return true;
}

void spore_springs_find_blocks(SporeSprings *springs, const SporeBlockMatrix *matrix) {
  assert(springs->group_count == 0 || matrix->block_count > 0);
  for (size_t g = 0; g < springs->group_count; g++) {
    const uint32_t *node = springs->node + g * SPORE_LANES;
    for (size_t i = 0; i < SPORE_LANES; i++) springs->diagonal[g * SPORE_LANES + i] = matrix->diagonal[node[i]];
    for (size_t i = SPORE_LANES * (size_t)springs->slot_start[g]; i < SPORE_LANES * (size_t)springs->slot_start[g + 1];
         i++)
      springs->block[i] = (uint32_t)spore_block_matrix_find(matrix, node[i % SPORE_LANES], springs->neighbour[i]);
  }
}

/* A force takes roughly 10 ns a slot. */
static size_t slot_count(const SporeSprings *springs, size_t kinds) {
  size_t count = 0;
  for (size_t k = 0; k < kinds; k++)
    if (springs[k].stiffness > 0) count += springs[k].slot_start[springs[k].group_count];
  return count;
}

typedef struct Loop {
  const SporeSprings *springs;
  size_t kinds;
  const double *q, *shape, *v;
  double h;
  double *f;
  const SporeTangent *at;
  SporeBlockMatrix *matrix;
} Loop;

static bool damps_along_lines(const SporeSprings *springs, const double *q, const double *shape) {
  return springs->stiffness > 0 && springs->damping > 0 && shape != q;
}

/* Copies the shape, unless the lines are those of this shape already. */
static void begin_lines(const Loop *loop) {
  for (size_t k = 0; k < loop->kinds; k++) {
    SporeSpringsLines *lines = loop->springs[k].lines;
    if (!damps_along_lines(&loop->springs[k], loop->q, loop->shape)) continue;
    lines->ready = lines->ready && memcmp(lines->shape, loop->shape, lines->count * sizeof *lines->shape) == 0;
    if (!lines->ready) memcpy(lines->shape, loop->shape, lines->count * sizeof *lines->shape);
  }
}

static void end_lines(const Loop *loop) {
  for (size_t k = 0; k < loop->kinds; k++)
    if (damps_along_lines(&loop->springs[k], loop->q, loop->shape)) loop->springs[k].lines->ready = true;
}

/* Whether the springs of a kind in a chunk are damped along the lines of the shape. Finds these lines where they are
 * not known. */
static bool find_lines(const Loop *loop, const SporeSprings *springs, size_t chunk) {
  if (!damps_along_lines(springs, loop->q, loop->shape)) return false;
  if (!springs->lines->ready) SPORE_KERNEL(spore_springs_chunk_lines)(springs, chunk, loop->shape);
  return true;
}

static void add_forces(void *data, size_t chunk) {
  const Loop *loop = data;
  for (size_t k = 0; k < loop->kinds; k++) {
    const SporeSprings *springs = &loop->springs[k];
    if (!(springs->stiffness > 0)) continue;
    bool along_lines = find_lines(loop, springs, chunk);
    SPORE_KERNEL(spore_springs_chunk_force)(springs, chunk, loop->q, loop->v, along_lines, loop->h, loop->f);
  }
}

void spore_springs_force(const SporeSprings *springs, size_t kinds, SporePool *pool, const double *q,
                         const double *shape, const double *v, double h, double *f) {
  assert(kinds > 0 && h >= 0);
  assert(f != q && f != v);
  Loop loop = {.springs = springs, .kinds = kinds, .q = q, .shape = shape, .v = v, .h = h, .f = f};
  begin_lines(&loop);
  spore_pool_run(spore_pool_for(pool, slot_count(springs, kinds)), springs->chunk_count, add_forces, &loop);
  end_lines(&loop);
}

static void add_jacobian(void *data, size_t chunk) {
  const Loop *loop = data;
  for (size_t k = 0; k < loop->kinds; k++) {
    const SporeSprings *springs = &loop->springs[k];
    if (!(springs->stiffness > 0)) continue;
    bool along_lines = find_lines(loop, springs, chunk);
    SPORE_KERNEL(spore_springs_chunk_jacobian)(springs, chunk, loop->at, along_lines, loop->matrix);
  }
}

void spore_springs_jacobian(const SporeSprings *springs, size_t kinds, SporePool *pool, const SporeTangent *at,
                            SporeBlockMatrix *matrix) {
  assert(kinds > 0);
  assert(at->stiffness_scale >= 0);
  Loop loop = {.springs = springs, .kinds = kinds, .q = at->q, .shape = at->shape, .at = at, .matrix = matrix};
  begin_lines(&loop);
  spore_pool_run(spore_pool_for(pool, 4 * slot_count(springs, kinds)), springs->chunk_count, add_jacobian, &loop);
  end_lines(&loop);
}

/* The square of the largest length over its length at rest, among the springs of a group. */
static double stretch_of_group(const SporeSprings *springs, size_t group, const double *q) {
  double most = 0;
  for (size_t slot = springs->slot_start[group]; slot < springs->slot_start[group + 1]; slot++) {
    for (size_t lane = 0; lane < springs->lanes[group]; lane++) {
      size_t at = slot * SPORE_LANES + lane, node = springs->node[group * SPORE_LANES + lane];
      double rest = springs->length[at];
      SporeVec3 line =
          spore_vec3_sub(spore_vec3_load(q + 3 * (size_t)springs->neighbour[at]), spore_vec3_load(q + 3 * node));
      if (rest > 0) most = fmax(most, spore_vec3_dot(line, line) / (rest * rest));
    }
  }
  return most;
}

double spore_springs_strain(const SporeSprings *springs, size_t kinds, const double *q) {
  assert(kinds > 0);
  double most = 0;
  for (size_t k = 0; k < kinds; k++)
    for (size_t group = 0; group < springs[k].group_count; group++)
      most = fmax(most, stretch_of_group(&springs[k], group, q));
  return sqrt(most) - 1;
}
