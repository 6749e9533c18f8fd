/* Pattern and numbers of factors that act on all coordinates alike. */
#include "core/linalg/point_cholesky.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/linalg/minimum_degree.h"
#include "core/linalg/point_cholesky_kernels.h"

#define NONE UINT32_MAX

void spore_point_pattern_clear(SporePointPattern *pattern) {
  spore_free(pattern->order);
  spore_free(pattern->place);
  spore_free(pattern->start);
  spore_free(pattern->row);
  spore_free(pattern->group);
  spore_free(pattern->column);
  spore_free(pattern->next);
  spore_free(pattern->chain);
  spore_free(pattern->waiting);
  *pattern = (SporePointPattern){0};
}

void spore_point_factor_clear(SporePointFactor *factor) {
  spore_free(factor->value);
  spore_free(factor->inverse);
  *factor = (SporePointFactor){0};
}

static int ascending(const void *a, const void *b) {
  uint32_t first = *(const uint32_t *)a, second = *(const uint32_t *)b;
  return (first > second) - (first < second);
}

/* Adds a row to the column, once. */
static void add_row(SporePointPattern *pattern, uint32_t column, uint32_t row, uint32_t *mark, size_t *end) {
  if (row <= column || mark[row] == column) return;
  mark[row] = column;
  pattern->row[(*end)++] = row;
}

/* Rows of the columns: those of the matrix, and those of the columns whose first row this is. child, sibling: lists of
 * those. mark: the last column that met a row. */
static void find_rows(SporePointPattern *pattern, const SporeBlockMatrix *matrix, uint32_t *child, uint32_t *sibling,
                      uint32_t *mark) {
  size_t end = 0;
  for (uint32_t j = 0; j < pattern->count; j++) child[j] = mark[j] = NONE;
  for (uint32_t j = 0; j < pattern->count; j++) {
    uint32_t point = pattern->order[j];
    pattern->start[j] = end;
    for (uint32_t k = matrix->row_start[point]; k < matrix->row_start[point + 1]; k++)
      add_row(pattern, j, pattern->place[matrix->column[k]], mark, &end);
    for (uint32_t c = child[j]; c != NONE; c = sibling[c])
      for (size_t i = pattern->start[c]; i < pattern->start[c + 1]; i++)
        add_row(pattern, j, pattern->row[i], mark, &end);
    pattern->start[j + 1] = end;
    if (end == pattern->start[j]) continue;
    qsort(pattern->row + pattern->start[j], end - pattern->start[j], sizeof *pattern->row, ascending);
    uint32_t parent = pattern->row[pattern->start[j]];
    sibling[j] = child[parent], child[parent] = j;
  }
}

/* Whether the column has the next one as its first row, and all rows of that. */
static bool goes_on(const SporePointPattern *pattern, size_t j) {
  size_t below = pattern->start[j + 1] - pattern->start[j];
  return below > 0 && pattern->row[pattern->start[j]] == j + 1 &&
         below == pattern->start[j + 2] - pattern->start[j + 1] + 1;
}

static void find_groups(SporePointPattern *pattern) {
  for (size_t j = 0; j < pattern->count;) {
    size_t end = j + 1;
    while (end < pattern->count && end - j < SPORE_POINT_GROUP && goes_on(pattern, end - 1)) end++;
    pattern->group[pattern->group_count++] = (uint32_t)j;
    j = end;
  }
  pattern->group[pattern->group_count] = (uint32_t)pattern->count;
}

/* What the pattern takes beside its rows. */
static bool allocate(SporePointPattern *pattern) {
  size_t n = pattern->count;
  pattern->order = SPORE_NEW_ARRAY(uint32_t, n);
  pattern->place = SPORE_NEW_ARRAY(uint32_t, n);
  pattern->start = SPORE_NEW_ARRAY(size_t, n + 1);
  pattern->group = SPORE_NEW_ARRAY(uint32_t, n + 1);
  pattern->column = SPORE_NEW_ARRAY(double, n);
  pattern->next = SPORE_NEW_ARRAY(size_t, n);
  pattern->chain = SPORE_NEW_ARRAY(uint32_t, n);
  pattern->waiting = SPORE_NEW_ARRAY(uint32_t, n);
  return pattern->order && pattern->place && pattern->start && pattern->group && pattern->column && pattern->next &&
         pattern->chain && pattern->waiting;
}

bool spore_point_pattern_create(SporePointPattern *pattern, const SporeBlockMatrix *matrix, const SporeCancel *cancel) {
  assert(matrix->block_count > 0 && matrix->block_count < NONE);
  size_t n = matrix->block_count;
  SporeFill fill;
  *pattern = (SporePointPattern){.count = n};
  if (!allocate(pattern) || !spore_minimum_degree(matrix, HUGE_VAL, cancel, pattern->order, &fill)) return false;
  for (uint32_t j = 0; j < n; j++) pattern->place[pattern->order[j]] = j;
  pattern->row = SPORE_NEW_ARRAY(uint32_t, fill.blocks);
  uint32_t *lists = SPORE_NEW_ARRAY(uint32_t, 3 * n);
  if (pattern->row && lists) find_rows(pattern, matrix, lists, lists + n, lists + 2 * n);
  assert(!pattern->row || !lists || pattern->start[n] <= fill.blocks);
  bool made = pattern->row && lists;
  if (made) find_groups(pattern);
  spore_free(lists);
  return made;
}

bool spore_point_factor_create(SporePointFactor *factor, const SporePointPattern *pattern) {
  assert(pattern->count > 0);
  factor->value = SPORE_NEW_ARRAY(double, pattern->start[pattern->count]);
  factor->inverse = SPORE_NEW_ARRAY(double, pattern->count);
  return factor->value && factor->inverse;
}

/* Puts the column into the list of the row that it reaches next. */
static void wait_for_row(SporePointPattern *pattern, uint32_t column) {
  if (pattern->next[column] == pattern->start[column + 1]) return;
  uint32_t row = pattern->row[pattern->next[column]];
  pattern->chain[column] = pattern->waiting[row], pattern->waiting[row] = column;
}

/* The column of the matrix less what the columns before it leave. */
static void gather_column(const SporePointFactor *factor, SporePointPattern *pattern, const SporeBlockMatrix *matrix,
                          const double *numbers, uint32_t j) {
  double *column = pattern->column;
  uint32_t point = pattern->order[j];
  column[j] = 0;
  for (size_t i = pattern->start[j]; i < pattern->start[j + 1]; i++) column[pattern->row[i]] = 0;
  for (uint32_t k = matrix->row_start[point]; k < matrix->row_start[point + 1]; k++) {
    uint32_t row = pattern->place[matrix->column[k]];
    if (row >= j) column[row] = numbers[k];
  }
  for (uint32_t c = pattern->waiting[j], then; c != NONE; c = then) {
    then = pattern->chain[c];
    size_t first = pattern->next[c]++;
    double by = factor->value[first];
    for (size_t i = first; i < pattern->start[c + 1]; i++) column[pattern->row[i]] -= by * factor->value[i];
    wait_for_row(pattern, c);
  }
}

bool spore_point_factorise(SporePointFactor *factor, SporePointPattern *pattern, const SporeBlockMatrix *matrix,
                           const double *numbers, const SporeCancel *cancel) {
  assert(matrix->block_count == pattern->count && factor->value);
  for (size_t j = 0; j < pattern->count; j++) pattern->waiting[j] = NONE;
  for (uint32_t j = 0; j < pattern->count; j++) {
    gather_column(factor, pattern, matrix, numbers, j);
    if (!(pattern->column[j] > 0) || spore_cancel_asked(cancel)) return false;
    double inverse = factor->inverse[j] = 1 / sqrt(pattern->column[j]);
    for (size_t i = pattern->start[j]; i < pattern->start[j + 1]; i++)
      factor->value[i] = pattern->column[pattern->row[i]] * inverse;
    pattern->next[j] = pattern->start[j];
    wait_for_row(pattern, j);
  }
  return true;
}

void spore_point_solve(const SporePointFactor *factor, const SporePointPattern *pattern, double *rows) {
  assert(factor->value && rows);
  SPORE_KERNEL(spore_point_solve_rows)(factor, pattern, rows);
}
