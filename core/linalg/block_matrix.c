#include "core/linalg/block_matrix.h"

#include <assert.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/linalg/block_matrix_kernels.h"
#include "core/math/vector.h"

/* Whether the pairs name blocks that the pattern has. */
static inline bool pairs_exist(const SporeBlockPattern *pattern) {
  for (size_t p = 0; p < 2 * pattern->pair_count; p++)
    if (pattern->pairs[p] >= pattern->block_count) return false;
  return true;
}

void spore_block_pattern_init(SporeBlockPattern *pattern, size_t block_count) {
  assert(block_count < UINT32_MAX);
  *pattern = (SporeBlockPattern){.block_count = block_count};
}

bool spore_block_pattern_reserve(SporeBlockPattern *pattern, size_t capacity) {
  if (capacity <= pattern->pair_capacity) return true;
  uint32_t *pairs = spore_reallocate(pattern->pairs, 2 * pattern->pair_capacity, 2 * capacity, sizeof *pairs);
  if (!pairs) return false;
  pattern->pairs = pairs;
  pattern->pair_capacity = capacity;
  return true;
}

bool spore_block_pattern_add(SporeBlockPattern *pattern, uint32_t i, uint32_t j) {
  if (i >= pattern->block_count || j >= pattern->block_count) return false;
  if (i == j) return true;
  bool full = pattern->pair_count == pattern->pair_capacity;
  if (full && !spore_block_pattern_reserve(pattern, pattern->pair_capacity ? 2 * pattern->pair_capacity : 256))
    return false;
  pattern->pairs[2 * pattern->pair_count] = i;
  pattern->pairs[2 * pattern->pair_count + 1] = j;
  pattern->pair_count++;
  return true;
}

void spore_block_pattern_clear(SporeBlockPattern *pattern) {
  spore_free(pattern->pairs);
  *pattern = (SporeBlockPattern){0};
}

/* Rows with repeats, in any order: row_start (block_count + 1) and column. */
static void scatter_pairs(const SporeBlockPattern *pattern, uint32_t *row_start, uint32_t *column, uint32_t *fill) {
  size_t n = pattern->block_count;
  for (size_t i = 0; i <= n; i++) row_start[i] = 0;
  for (size_t i = 0; i < n; i++) row_start[i + 1] = 1;
  for (size_t p = 0; p < 2 * pattern->pair_count; p++) row_start[pattern->pairs[p] + 1]++;
  for (size_t i = 0; i < n; i++) row_start[i + 1] += row_start[i];
  for (size_t i = 0; i < n; i++) {
    fill[i] = row_start[i];
    column[fill[i]++] = (uint32_t)i;
  }
  for (size_t p = 0; p < pattern->pair_count; p++) {
    uint32_t i = pattern->pairs[2 * p], j = pattern->pairs[2 * p + 1];
    column[fill[i]++] = j;
    column[fill[j]++] = i;
  }
}

/* Transposing a pattern sorts its rows; doing so to a symmetric one changes nothing else. */
static void sort_rows(size_t n, const uint32_t *row_start, const uint32_t *column, uint32_t *sorted, uint32_t *fill) {
  memcpy(fill, row_start, n * sizeof *fill);
  for (size_t i = 0; i < n; i++)
    for (uint32_t k = row_start[i]; k < row_start[i + 1]; k++) sorted[fill[column[k]]++] = (uint32_t)i;
}

/* Drops repeats from sorted rows, in place. */
static void unique_rows(SporeBlockMatrix *matrix, const uint32_t *row_start, const uint32_t *sorted) {
  uint32_t count = 0;
  for (size_t i = 0; i < matrix->block_count; i++) {
    matrix->row_start[i] = count;
    for (uint32_t k = row_start[i]; k < row_start[i + 1]; k++) {
      if (k > row_start[i] && sorted[k] == sorted[k - 1]) continue;
      if (sorted[k] == i) matrix->diagonal[i] = count;
      matrix->column[count++] = sorted[k];
    }
  }
  matrix->row_start[matrix->block_count] = count;
}

static bool make_room(SporeBlockRoom *room, size_t n, size_t pairs) {
  size_t entries = n + 2 * pairs;
  *room = (SporeBlockRoom){.pair_capacity = pairs};
  if (entries > UINT32_MAX) return false;
  room->row_start = SPORE_NEW_ARRAY(uint32_t, n + 1);
  room->column = SPORE_NEW_ARRAY(uint32_t, entries);
  room->sorted = SPORE_NEW_ARRAY(uint32_t, entries);
  room->fill = SPORE_NEW_ARRAY(uint32_t, n);
  return room->row_start && room->column && room->sorted && room->fill;
}

void spore_block_room_clear(SporeBlockRoom *room) {
  spore_free(room->row_start);
  spore_free(room->column);
  spore_free(room->sorted);
  spore_free(room->fill);
  *room = (SporeBlockRoom){0};
}

/* All but the values. */
static bool make_rows(SporeBlockMatrix *matrix, const SporeBlockPattern *pattern, size_t blocks, size_t pairs,
                      SporeBlockRoom *room) {
  *matrix = (SporeBlockMatrix){.block_room = blocks};
  if (!make_room(room, blocks, pairs)) return false;
  matrix->row_start = SPORE_NEW_ARRAY(uint32_t, blocks + 1);
  matrix->column = SPORE_NEW_ARRAY(uint32_t, blocks + 2 * pairs);
  matrix->diagonal = SPORE_NEW_ARRAY(uint32_t, blocks);
  if (pattern->direction) matrix->direction = spore_allocate(blocks, 3 * sizeof *matrix->direction);
  return matrix->row_start && matrix->column && matrix->diagonal && (matrix->direction || !pattern->direction) &&
         spore_block_matrix_lay_out(matrix, pattern, room);
}

bool spore_block_matrix_lay_out(SporeBlockMatrix *matrix, const SporeBlockPattern *pattern, SporeBlockRoom *room) {
  assert(!pattern->direction || matrix->direction);
  assert(pairs_exist(pattern));
  if (pattern->block_count > matrix->block_room || pattern->pair_count > room->pair_capacity) return false;
  matrix->block_count = pattern->block_count;
  scatter_pairs(pattern, room->row_start, room->column, room->fill);
  sort_rows(pattern->block_count, room->row_start, room->column, room->sorted, room->fill);
  unique_rows(matrix, room->row_start, room->sorted);
  return true;
}

bool spore_block_matrix_create(SporeBlockMatrix *matrix, const SporeBlockPattern *pattern) {
  SporeBlockRoom room;
  bool made = make_rows(matrix, pattern, pattern->block_count, pattern->pair_count, &room);
  if (made) matrix->values = spore_allocate(matrix->row_start[matrix->block_count], 9 * sizeof *matrix->values);
  spore_block_room_clear(&room);
  if (!matrix->values) spore_block_matrix_clear(matrix);
  return made && matrix->values;
}

bool spore_block_matrix_create_roomy(SporeBlockMatrix *matrix, const SporeBlockPattern *pattern, size_t blocks,
                                     size_t pairs, SporeBlockRoom *room) {
  assert(pattern->block_count <= blocks && pattern->pair_count <= pairs);
  bool made = make_rows(matrix, pattern, blocks, pairs, room);
  if (made) matrix->values = spore_allocate(blocks + 2 * pairs, 9 * sizeof *matrix->values);
  if (made && matrix->values) return true;
  spore_block_matrix_clear(matrix);
  spore_block_room_clear(room);
  return false;
}

void spore_block_matrix_clear(SporeBlockMatrix *matrix) {
  spore_free(matrix->row_start);
  spore_free(matrix->column);
  spore_free(matrix->diagonal);
  spore_free(matrix->values);
  spore_free(matrix->direction);
  *matrix = (SporeBlockMatrix){0};
}

void spore_block_matrix_zero(SporeBlockMatrix *matrix) {
  assert(matrix->block_count == 0 || matrix->values);
  matrix->directed = false;
  if (matrix->block_count) memset(matrix->values, 0, 9 * sizeof(double) * matrix->row_start[matrix->block_count]);
}

size_t spore_block_matrix_find(const SporeBlockMatrix *matrix, uint32_t i, uint32_t j) {
  if (i >= matrix->block_count) return SIZE_MAX;
  uint32_t low = matrix->row_start[i], high = matrix->row_start[i + 1];
  while (low < high) {
    uint32_t middle = low + (high - low) / 2;
    if (matrix->column[middle] < j) low = middle + 1;
    else high = middle;
  }
  return low < matrix->row_start[i + 1] && matrix->column[low] == j ? low : SIZE_MAX;
}

void spore_block_matrix_add(SporeBlockMatrix *matrix, uint32_t i, uint32_t j, const double k[9]) {
  assert(spore_block_matrix_find(matrix, i, j) != SIZE_MAX);
  double *block = matrix->values + 9 * spore_block_matrix_find(matrix, i, j);
  for (int e = 0; e < 9; e++) block[e] += k[e];
}

void spore_block_matrix_multiply_add(const SporeBlockMatrix *matrix, const double *x, double *y) {
  assert(!matrix->directed || matrix->direction);
  SPORE_KERNEL(spore_block_matrix_multiply)(matrix, x, y);
  size_t n = 3 * matrix->block_count;
  if (matrix->directed) spore_vector_add_scaled(n, y, spore_vector_dot(n, matrix->direction, x), matrix->direction);
}
