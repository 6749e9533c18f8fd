/* What of a factorisation depends on the pattern alone. */
#include <assert.h>
#include <stdlib.h>

#include "core/base/memory.h"
#include "core/linalg/block_cholesky.h"
#include "core/linalg/cholesky_kernels.h"
#include "core/linalg/minimum_degree.h"

#define NONE UINT32_MAX
/* Zeros that a supernode may store so that it has more columns: in blocks, and as a part of all that it stores. */
#define ZEROS_ALLOWED 8
#define ZEROS_FRACTION 0.25

typedef struct Analysis {
  const SporeBlockMatrix *pattern;
  uint32_t count;
  uint32_t *place;           /* of the matrix's blocks in elimination order */
  uint32_t *parent;          /* in the elimination tree */
  uint32_t *child, *sibling; /* lists of children, ascending */
  uint32_t *other, *mark;
  size_t *start; /* count + 1: rows of each column of L below its diagonal, in `row` */
  uint32_t *row;
  uint32_t *owner; /* supernode of a column */
} Analysis;

static bool make(Analysis *analysis, const SporeBlockMatrix *pattern, size_t fill) {
  size_t n = pattern->block_count;
  uint32_t **arrays[] = {&analysis->place, &analysis->parent, &analysis->child, &analysis->sibling,
                         &analysis->other, &analysis->mark,   &analysis->owner};
  *analysis = (Analysis){.pattern = pattern, .count = (uint32_t)n};
  bool made = true;
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
    made = (*arrays[i] = SPORE_NEW_ARRAY(uint32_t, n)) != NULL && made;
  analysis->start = SPORE_NEW_ARRAY(size_t, n + 1);
  analysis->row = SPORE_NEW_ARRAY(uint32_t, fill);
  return made && analysis->start && analysis->row;
}

static void drop(Analysis *analysis) {
  void *arrays[] = {analysis->place, analysis->parent, analysis->child, analysis->sibling, analysis->other,
                    analysis->mark,  analysis->owner,  analysis->start, analysis->row};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) spore_free(arrays[i]);
}

static void place_blocks(Analysis *analysis, const uint32_t *order) {
  for (uint32_t j = 0; j < analysis->count; j++) analysis->place[order[j]] = j;
}

/* Elimination tree with path compression (J. W. H. Liu, 1986). */
static void find_parents(Analysis *analysis, const uint32_t *order) {
  uint32_t *ancestor = analysis->other;
  const SporeBlockMatrix *pattern = analysis->pattern;
  for (uint32_t j = 0; j < analysis->count; j++) {
    analysis->parent[j] = ancestor[j] = NONE;
    for (uint32_t k = pattern->row_start[order[j]]; k < pattern->row_start[order[j] + 1]; k++) {
      uint32_t i = analysis->place[pattern->column[k]];
      while (i < j && ancestor[i] != j) {
        uint32_t next = ancestor[i];
        ancestor[i] = j;
        if (next == NONE) analysis->parent[i] = j;
        i = next == NONE ? j : next;
      }
    }
  }
}

static void list_children(Analysis *analysis) {
  for (uint32_t j = 0; j < analysis->count; j++) analysis->child[j] = NONE;
  for (uint32_t j = analysis->count; j-- > 0;) {
    if (analysis->parent[j] == NONE) continue;
    analysis->sibling[j] = analysis->child[analysis->parent[j]];
    analysis->child[analysis->parent[j]] = j;
  }
}

/* Renumbers the tree from the root j so that each subtree is numbered without gaps, root last. */
static uint32_t number_tree(Analysis *analysis, uint32_t root, uint32_t next) {
  uint32_t j = root;
  for (;;) {
    while (analysis->child[j] != NONE) j = analysis->child[j];
    for (;;) {
      analysis->other[j] = next++;
      if (j == root) return next;
      if (analysis->sibling[j] != NONE) break;
      j = analysis->parent[j];
    }
    j = analysis->sibling[j];
  }
}

static void postorder(Analysis *analysis, uint32_t *order) {
  uint32_t n = analysis->count, next = 0, *number = analysis->other, *moved = analysis->mark;
  list_children(analysis);
  for (uint32_t j = 0; j < n; j++)
    if (analysis->parent[j] == NONE) next = number_tree(analysis, j, next);
  for (uint32_t j = 0; j < n; j++) moved[number[j]] = order[j];
  for (uint32_t j = 0; j < n; j++) order[j] = moved[j];
  for (uint32_t j = 0; j < n; j++) moved[number[j]] = analysis->parent[j] == NONE ? NONE : number[analysis->parent[j]];
  for (uint32_t j = 0; j < n; j++) analysis->parent[j] = moved[j];
  place_blocks(analysis, order);
  list_children(analysis);
}

static void add_row(Analysis *analysis, uint32_t column, uint32_t row) {
  assert(column < analysis->count && row < analysis->count);
  if (row <= column || analysis->mark[row] == column + 1) return;
  analysis->mark[row] = column + 1;
  analysis->row[analysis->start[column + 1]++] = row;
}

static int ascending(const void *a, const void *b) {
  uint32_t i = *(const uint32_t *)a, j = *(const uint32_t *)b;
  return (i > j) - (i < j);
}

/* A column of L has the rows of the matrix's column and those of its children in the tree. */
static bool find_rows(Analysis *analysis, const uint32_t *order, const SporeCancel *cancel) {
  const SporeBlockMatrix *pattern = analysis->pattern;
  for (uint32_t j = 0; j < analysis->count; j++) analysis->mark[j] = 0;
  for (uint32_t j = 0; j < analysis->count; j++) {
    if (spore_cancel_asked(cancel)) return false;
    analysis->start[j + 1] = analysis->start[j];
    for (uint32_t k = pattern->row_start[order[j]]; k < pattern->row_start[order[j] + 1]; k++)
      add_row(analysis, j, analysis->place[pattern->column[k]]);
    for (uint32_t c = analysis->child[j]; c != NONE; c = analysis->sibling[c])
      for (size_t k = analysis->start[c]; k < analysis->start[c + 1]; k++) add_row(analysis, j, analysis->row[k]);
    qsort(analysis->row + analysis->start[j], analysis->start[j + 1] - analysis->start[j], sizeof(uint32_t), ascending);
  }
  return true;
}

static size_t rows_below(const Analysis *analysis, uint32_t j) { return analysis->start[j + 1] - analysis->start[j]; }

/* Joins each column to the one before where that is its child and few zeros come in. */
static uint32_t find_supernodes(Analysis *analysis) {
  uint32_t count = 0;
  size_t width = 0, real = 0;
  for (uint32_t j = 0; j < analysis->count; j++) {
    size_t below = rows_below(analysis, j);
    size_t stored = (width + 1) * (width + 2) / 2 + (width + 1) * below, zeros = stored - (real + 1 + below);
    bool join = j > 0 && analysis->parent[j - 1] == j &&
                ((double)zeros <= ZEROS_FRACTION * (double)stored || zeros <= ZEROS_ALLOWED);
    if (!join) {
      count++;
      width = real = 0;
    }
    width++;
    real += 1 + below;
    analysis->owner[j] = count - 1;
  }
  return count;
}

static uint32_t row_in_front(const SporeBlockCholesky *factor, const SporeSupernode *node, uint32_t row) {
  assert(row >= node->first);
  if (row < node->first + node->column_count) return row - node->first;
  uint32_t low = 0, high = node->row_count;
  while (low < high) {
    uint32_t middle = low + (high - low) / 2;
    if (factor->rows[node->row_start + middle] < row) low = middle + 1;
    else high = middle;
  }
  return node->column_count + low;
}

static void fill_supernodes(const Analysis *analysis, SporeBlockCholesky *factor) {
  uint32_t rows = 0;
  for (uint32_t j = 0; j < analysis->count; j++) {
    SporeSupernode *node = &factor->supernodes[analysis->owner[j]];
    if (node->column_count++ == 0) *node = (SporeSupernode){.first = j, .column_count = 1, .sibling = NONE};
    bool last = j + 1 == analysis->count || analysis->owner[j + 1] != analysis->owner[j];
    if (!last) continue;
    node->row_start = rows;
    node->row_count = (uint32_t)rows_below(analysis, j);
    for (size_t k = analysis->start[j]; k < analysis->start[j + 1]; k++) factor->rows[rows++] = analysis->row[k];
  }
}

static size_t update_size(const SporeSupernode *node) {
  return 3 * (size_t)node->row_count * spore_cholesky_pad(3 * (size_t)node->row_count);
}

/* Where the rows of a supernode lie in its parent's front. */
static void find_targets(SporeBlockCholesky *factor, SporeSupernode *node, const SporeSupernode *parent) {
  assert(parent > node && parent->first >= node->first + node->column_count);
  uint32_t end = node->row_start + node->row_count;
  for (uint32_t k = node->row_start; k < end; k++) factor->targets[k] = row_in_front(factor, parent, factor->rows[k]);
  while (node->inside < node->row_count && factor->targets[node->row_start + node->inside] < parent->column_count)
    node->inside++;
  for (uint32_t k = end; k-- > node->row_start;) {
    bool next =
        k + 1 < end && k + 1 != node->row_start + node->inside && factor->targets[k + 1] == factor->targets[k] + 1;
    factor->runs[k] = next ? factor->runs[k + 1] + 1 : 1;
  }
}

static void tie_to_parents(const Analysis *analysis, SporeBlockCholesky *factor) {
  uint32_t *last_child = analysis->other;
  for (uint32_t s = 0; s < factor->supernode_count; s++) last_child[s] = NONE;
  for (uint32_t s = 0; s < factor->supernode_count; s++) {
    SporeSupernode *node = &factor->supernodes[s];
    node->parent = NONE;
    if (node->row_count == 0) continue;
    uint32_t parent = node->parent = analysis->owner[factor->rows[node->row_start]];
    find_targets(factor, node, &factor->supernodes[parent]);
    node->sibling = last_child[parent];
    last_child[parent] = s;
    factor->supernodes[parent].child_count++;
  }
}

/* Updates of one generation of the tree lie on one stack, those of the next generation on the other: the update of a
 * supernode is written while the updates of its children are still needed. Returns the size of both stacks. */
static size_t place_updates(const Analysis *analysis, SporeBlockCholesky *factor) {
  uint32_t *odd = analysis->mark;
  size_t height[2] = {0, 0}, most[2] = {0, 0};
  for (uint32_t s = (uint32_t)factor->supernode_count; s-- > 0;) {
    const SporeSupernode *node = &factor->supernodes[s];
    odd[s] = node->row_count > 0 && !odd[analysis->owner[factor->rows[node->row_start]]];
  }
  for (uint32_t s = 0; s < factor->supernode_count; s++) {
    SporeSupernode *node = &factor->supernodes[s];
    node->update = height[odd[s]];
    height[odd[s]] += update_size(node);
    if (height[odd[s]] > most[odd[s]]) most[odd[s]] = height[odd[s]];
    for (uint32_t c = node->child_count > 0 ? s - 1 : NONE; c != NONE; c = factor->supernodes[c].sibling)
      height[!odd[s]] -= update_size(&factor->supernodes[c]);
  }
  for (uint32_t s = 0; s < factor->supernode_count; s++)
    if (odd[s]) factor->supernodes[s].update += most[0];
  return most[0] + most[1];
}

/* Lays out the panels. Gives the sizes of values, front and work. */
static void lay_out(const Analysis *analysis, SporeBlockCholesky *factor, size_t *values, size_t *front, size_t *work) {
  *values = *front = 0;
  for (uint32_t s = 0; s < factor->supernode_count; s++) {
    SporeSupernode *node = &factor->supernodes[s];
    size_t columns = 3 * (size_t)node->column_count, rows = 3 * (size_t)node->row_count;
    size_t panel = columns * (spore_cholesky_pad(columns) + spore_cholesky_pad(rows));
    node->panel = *values;
    *values += panel;
    if (panel > *front) *front = panel;
    factor->solve_flops += 4.0 * (double)((columns / 2 + rows) * columns);
    for (size_t c = 0; c < columns; c++) factor->factor_flops += (double)((columns + rows - c) * (columns + rows - c));
    if (spore_cholesky_pad(columns) > factor->most_columns) factor->most_columns = spore_cholesky_pad(columns);
    if (spore_cholesky_pad(rows) > factor->most_rows) factor->most_rows = spore_cholesky_pad(rows);
  }
  *work = SPORE_LANES * (3 * (size_t)analysis->count + SPORE_LANES + factor->most_rows + 3 * factor->most_columns);
}

static void place_entries(const Analysis *analysis, SporeBlockCholesky *factor) {
  const SporeBlockMatrix *pattern = analysis->pattern;
  uint32_t count = 0;
  for (uint32_t s = 0; s < factor->supernode_count; s++) {
    SporeSupernode *node = &factor->supernodes[s];
    size_t columns = 3 * (size_t)node->column_count, ldt = spore_cholesky_pad(columns),
           ld = spore_cholesky_pad(3 * (size_t)node->row_count);
    node->entry_start = count;
    for (uint32_t j = 0; j < node->column_count; j++) {
      uint32_t column = factor->order[node->first + j];
      for (uint32_t k = pattern->row_start[column]; k < pattern->row_start[column + 1]; k++) {
        uint32_t row = pattern->column[k], place = analysis->place[row];
        if (place < node->first + j) continue;
        size_t at = row_in_front(factor, node, place);
        size_t target =

            (at < node->column_count ? 3 * (j * ldt + at) : columns * ldt + 3 * (j * ld + at - node->column_count));
        /* Block (row, column): the pattern is symmetric, so it exists. */
        uint32_t block = (uint32_t)spore_block_matrix_find(pattern, row, column);
        factor->entries[count++] = (SporeFactorEntry){block, row, column, target};
      }
    }
    node->entry_end = count;
  }
}

static size_t all_rows(const Analysis *analysis) {
  size_t rows = 0;
  for (uint32_t j = 0; j < analysis->count; j++)
    if (j + 1 == analysis->count || analysis->owner[j + 1] != analysis->owner[j]) rows += rows_below(analysis, j);
  return rows;
}

static bool build(Analysis *analysis, SporeBlockCholesky *factor) {
  const SporeBlockMatrix *pattern = analysis->pattern;
  size_t n = analysis->count, values, front, work;
  place_blocks(analysis, factor->order);
  find_parents(analysis, factor->order);
  postorder(analysis, factor->order);
  if (!find_rows(analysis, factor->order, factor->cancel)) return false;
  factor->block_count = n;
  factor->supernode_count = find_supernodes(analysis);
  factor->supernodes = SPORE_NEW_ARRAY(SporeSupernode, factor->supernode_count);
  factor->rows = SPORE_NEW_ARRAY(uint32_t, all_rows(analysis));
  factor->targets = SPORE_NEW_ARRAY(uint32_t, all_rows(analysis));
  factor->runs = SPORE_NEW_ARRAY(uint32_t, all_rows(analysis));
  factor->entries = SPORE_NEW_ARRAY(SporeFactorEntry, (pattern->row_start[n] + n) / 2);
  if (!factor->supernodes || !factor->rows || !factor->targets || !factor->runs || !factor->entries) return false;
  fill_supernodes(analysis, factor);
  tie_to_parents(analysis, factor);
  lay_out(analysis, factor, &values, &front, &work);
  place_entries(analysis, factor);
  factor->values = SPORE_NEW_ARRAY(double, values);
  factor->front = SPORE_NEW_ARRAY(double, front);
  factor->updates = SPORE_NEW_ARRAY(double, place_updates(analysis, factor));
  factor->work = SPORE_NEW_ARRAY(double, work);
  return factor->values && factor->front && factor->updates && factor->work;
}

static bool create_sparse(SporeBlockCholesky *factor, const SporeBlockMatrix *pattern, double most_flops) {
  const double flops_of_square = 27; /* three columns of 3 c numbers each, squared */
  SporeFill fill;
  factor->order = SPORE_NEW_ARRAY(uint32_t, pattern->block_count);
  bool made = factor->order &&
              spore_minimum_degree(pattern, most_flops / flops_of_square, factor->cancel, factor->order, &fill);
  bool wanted = made && fill.squares <= most_flops / flops_of_square;
  if (wanted) {
    Analysis analysis;
    made = make(&analysis, pattern, fill.blocks) && build(&analysis, factor);
    drop(&analysis);
  }
  if (!made || !wanted) spore_block_cholesky_clear(factor);
  return made;
}

/* A flop costs this part of its usual time in a band, where no supernodes are begun or added up. */
#define BAND_FLOP 0.4

static void count_band(SporeBlockCholesky *factor) {
  factor->block_count = factor->band.block_count;
  factor->factor_flops = BAND_FLOP * factor->band.factor_flops;
  factor->solve_flops = BAND_FLOP * factor->band.solve_flops;
}

static bool create_blocks(SporeBlockCholesky *factor, const SporeBlockMatrix *pattern, SporeFactorLayout layout,
                          double most_flops, const SporeCancel *cancel) {
  SporeBlockBand band = {0};
  *factor = (SporeBlockCholesky){.cancel = cancel};
  if (pattern->block_count == 0) return true;
  if (layout != SPORE_FACTOR_SPARSE && !spore_block_band_create(&band, pattern)) return false;
  bool banded = band.block_count > 0;
  if (!banded || layout != SPORE_FACTOR_BANDED) {
    if (!create_sparse(factor, pattern, most_flops)) {
      spore_block_band_clear(&band);
      return false;
    }
    banded = banded && (factor->block_count == 0 || BAND_FLOP * band.factor_flops <= factor->factor_flops);
  }
  if (!banded || band.factor_flops > most_flops) {
    spore_block_band_clear(&band);
    return true;
  }
  spore_block_cholesky_clear(factor);
  *factor = (SporeBlockCholesky){.band = band, .cancel = cancel};
  count_band(factor);
  return true;
}

bool spore_block_cholesky_lay_out(SporeBlockCholesky *factor, const SporeBlockMatrix *pattern) {
  bool fits = spore_block_band_lay_out(&factor->band, pattern);
  if (fits) count_band(factor);
  else factor->block_count = 0;
  return fits;
}

bool spore_block_cholesky_create(SporeBlockCholesky *factor, const SporeBlockMatrix *pattern, SporeFactorLayout layout,
                                 double most_flops, const SporeCancel *cancel) {
  assert(layout <= SPORE_FACTOR_BANDED && most_flops >= 0);
  if (!create_blocks(factor, pattern, layout, most_flops, cancel)) return false;
  if (!pattern->direction || factor->block_count == 0) return true;
  factor->direction = SPORE_NEW_ARRAY(double, 3 * factor->block_count);
  factor->response = SPORE_NEW_ARRAY(double, 3 * factor->block_count);
  if (factor->direction && factor->response) return true;
  spore_block_cholesky_clear(factor);
  return false;
}

void spore_block_cholesky_clear(SporeBlockCholesky *factor) {
  void *arrays[] = {factor->direction, factor->response, factor->supernodes, factor->order,
                    factor->rows,      factor->targets,  factor->runs,       factor->entries,
                    factor->values,    factor->updates,  factor->work,       factor->front};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) spore_free(arrays[i]);
  spore_block_band_clear(&factor->band);
  *factor = (SporeBlockCholesky){0};
}
