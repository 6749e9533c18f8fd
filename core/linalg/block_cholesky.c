/* Numbers of a sparse factor: assembling fronts, eliminating them, solving. */
#include "core/linalg/block_cholesky.h"

#include <assert.h>
#include <string.h>

#include "core/linalg/cholesky_kernels.h"
#include "core/math/vector.h"

static size_t columns_of(const SporeSupernode *node) { return 3 * (size_t)node->column_count; }
static size_t rows_of(const SporeSupernode *node) { return 3 * (size_t)node->row_count; }

static void subtract_three(double *to, const double *from) {
  to[0] -= from[0];
  to[1] -= from[1];
  to[2] -= from[2];
}

/* Adds columns first .. end of a child's update, its rows below the diagonal from row_first to row_end, to a matrix of
 * the parent's front that begins at its block (column, row). */
static void add_update(const SporeBlockCholesky *factor, const SporeSupernode *child, size_t first, size_t end,
                       size_t row_first, size_t row_end, double *to, size_t ld, size_t column, size_t row) {
  assert(first <= end && end <= child->row_count && row_end <= child->row_count);
  const uint32_t *target = factor->targets + child->row_start, *run = factor->runs + child->row_start;
  size_t lead = spore_cholesky_pad(rows_of(child));
  for (size_t j = first; j < end; j++)
    for (size_t c = 0; c < 3; c++) {
      const double *from = factor->updates + child->update + (3 * j + c) * lead;
      double *into = to + (3 * (target[j] - column) + c) * ld;
      for (size_t i = j > row_first ? j : row_first; i < row_end; i += run[i]) {
        double *place = into + 3 * (target[i] - row);
        for (size_t k = 0; k < 3 * run[i]; k++) place[k] += from[3 * i + k];
      }
    }
}

static void assemble(const SporeBlockCholesky *factor, const SporeSupernode *node, const SporeBlockMatrix *matrix,
                     const double *diagonal, const uint8_t *held, double *front) {
  static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  size_t columns = columns_of(node), ldt = spore_cholesky_pad(columns), ld = spore_cholesky_pad(rows_of(node));
  memset(front, 0, (ldt + ld) * columns * sizeof(double));
  for (uint32_t e = node->entry_start; e < node->entry_end; e++) {
    const SporeFactorEntry *entry = &factor->entries[e];
    const double *block = matrix->values + 9 * (size_t)entry->block;
    bool on_diagonal = entry->row == entry->column;
    if (on_diagonal && diagonal) block = diagonal + 9 * (size_t)entry->row;
    if (held && (held[entry->row] || held[entry->column])) {
      if (!on_diagonal) continue;
      block = identity;
    }
    double *target = front + entry->target;
    size_t lead = entry->target < ldt * columns ? ldt : ld;
    for (size_t c = 0; c < 3; c++)
      for (size_t r = 0; r < 3; r++) target[c * lead + r] = block[3 * r + c];
  }
}

/* How much of a pivot may have cancelled, so that single precision still holds the rest. */
#define CANCELLED 1e-4

/* Stores an eliminated front, rounded to single precision where its pivots are not small against the diagonal they came
 * from. */
static void keep(SporeBlockCholesky *factor, SporeSupernode *node, const double *diagonal) {
  size_t columns = columns_of(node), ldt = spore_cholesky_pad(columns);
  size_t size = columns * (ldt + spore_cholesky_pad(rows_of(node)));
  double *values = factor->values + node->panel;
  node->rounded = true;
  for (size_t j = 0; j < columns && node->rounded; j++) {
    double inverse = factor->front[j * ldt + j];
    node->rounded = CANCELLED * diagonal[j] * inverse * inverse < 1;
  }
  if (node->rounded) SPORE_KERNEL(spore_cholesky_round)(size, factor->front, (float *)(void *)values);
  else memcpy(values, factor->front, size * sizeof *values);
}

static const SporeSupernode *child_before(const SporeBlockCholesky *factor, const SporeSupernode *child) {
  return child->sibling == UINT32_MAX ? NULL : factor->supernodes + child->sibling;
}

/* The updates of the children that fall into this front are added before the front is eliminated; the rest goes into
 * the update of this front afterwards. */
static bool eliminate(SporeBlockCholesky *factor, const SporeSupernode *node, double *t) {
  size_t columns = node->column_count, ldt = spore_cholesky_pad(columns_of(node)),
         ld = spore_cholesky_pad(rows_of(node));
  double *b = t + columns_of(node) * ldt, *update = factor->updates + node->update;
  const SporeSupernode *last = node->child_count > 0 ? node - 1 : NULL;
  for (const SporeSupernode *child = last; child; child = child_before(factor, child)) {
    add_update(factor, child, 0, child->inside, 0, child->inside, t, ldt, 0, 0);
    add_update(factor, child, 0, child->inside, child->inside, child->row_count, b, ld, 0, columns);
  }
  if (!SPORE_KERNEL(spore_cholesky_eliminate)(columns_of(node), rows_of(node), t, b, update, factor->work,
                                              factor->cancel))
    return false;
  for (const SporeSupernode *child = last; child; child = child_before(factor, child))
    add_update(factor, child, child->inside, child->row_count, child->inside, child->row_count, update, ld, columns,
               columns);
  return true;
}

static bool factorise_blocks(SporeBlockCholesky *factor, const SporeBlockMatrix *matrix, const double *diagonal,
                             const uint8_t *held, bool may_round) {
  if (factor->band.block_count > 0) return spore_block_band_factorise(&factor->band, matrix, diagonal, held);
  for (size_t s = 0; s < factor->supernode_count; s++) {
    SporeSupernode *node = &factor->supernodes[s];
    size_t columns = columns_of(node), ldt = spore_cholesky_pad(columns);
    double *t = may_round ? factor->front : factor->values + node->panel, *before = factor->work + 3 * columns;
    assemble(factor, node, matrix, diagonal, held, t);
    for (size_t j = 0; j < columns; j++) before[j] = t[j * ldt + j];
    if (!eliminate(factor, node, t)) return false;
    node->rounded = false;
    if (may_round) keep(factor, node, before);
  }
  return true;
}

/* Where L21 of a supernode lies; L11^-1 is before it. */
static const void *below_of(const SporeSupernode *node, const double *values) {
  size_t before = columns_of(node) * spore_cholesky_pad(columns_of(node));
  return node->rounded ? (const void *)((const float *)(const void *)values + before) : values + before;
}

static void solve_blocks(SporeBlockCholesky *factor, const double *b, double *x) {
  if (factor->band.block_count > 0) {
    spore_block_band_solve(&factor->band, b, x);
    return;
  }
  size_t n = factor->block_count;
  double *y = factor->work, *below = y + 3 * n + SPORE_LANES, *spare = below + factor->most_rows;
  void (*forward)(size_t, size_t, const void *, const void *, bool, double *, double *, double *) =
      SPORE_KERNEL(spore_cholesky_forward);
  void (*backward)(size_t, size_t, const void *, const void *, bool, double *, const double *, double *) =
      SPORE_KERNEL(spore_cholesky_backward);
  for (size_t i = 0; i < n; i++) memcpy(y + 3 * i, b + 3 * (size_t)factor->order[i], 3 * sizeof *b);
  for (size_t s = 0; s < factor->supernode_count; s++) {
    const SporeSupernode *node = &factor->supernodes[s];
    const uint32_t *row = factor->rows + node->row_start;
    const double *values = factor->values + node->panel;
    forward(columns_of(node), rows_of(node), values, below_of(node, values), node->rounded, y + 3 * (size_t)node->first,
            below, spare);
    for (size_t i = 0; i < node->row_count; i++) subtract_three(y + 3 * (size_t)row[i], below + 3 * i);
  }
  for (size_t s = factor->supernode_count; s-- > 0;) {
    const SporeSupernode *node = &factor->supernodes[s];
    const uint32_t *row = factor->rows + node->row_start;
    size_t rows = rows_of(node);
    const double *values = factor->values + node->panel;
    for (size_t i = 0; i < node->row_count; i++) memcpy(below + 3 * i, y + 3 * (size_t)row[i], 3 * sizeof *y);
    for (size_t i = rows; i < spore_cholesky_pad(rows); i++) below[i] = 0;
    backward(columns_of(node), rows, values, below_of(node, values), node->rounded, y + 3 * (size_t)node->first, below,
             spare);
  }
  for (size_t i = 0; i < n; i++) memcpy(x + 3 * (size_t)factor->order[i], y + 3 * i, 3 * sizeof *x);
}

/* Vectors side by side: the lanes of a row lie next to each other. */
static void gather_lanes(const SporeBlockCholesky *factor, const double *vectors, size_t apart, double *y) {
  for (size_t i = 0; i < factor->block_count; i++) {
    const double *from = vectors + 3 * (size_t)factor->order[i];
    for (size_t e = 0; e < 3; e++, y += SPORE_LANES)
      for (size_t lane = 0; lane < SPORE_LANES; lane++) y[lane] = from[lane * apart + e];
  }
}

static void scatter_lanes(const SporeBlockCholesky *factor, const double *y, double *vectors, size_t apart) {
  for (size_t i = 0; i < factor->block_count; i++) {
    double *to = vectors + 3 * (size_t)factor->order[i];
    for (size_t e = 0; e < 3; e++, y += SPORE_LANES)
      for (size_t lane = 0; lane < SPORE_LANES; lane++) to[lane * apart + e] = y[lane];
  }
}

void spore_block_cholesky_ask(SporeBlockCholesky *factor, const uint8_t *asked) {
  if (factor->band.block_count > 0) return;
  for (size_t s = 0; s < factor->supernode_count; s++) factor->supernodes[s].asked = false;
  for (size_t s = 0; s < factor->supernode_count; s++) {
    SporeSupernode *node = &factor->supernodes[s];
    for (size_t j = 0; j < node->column_count; j++) node->asked |= asked[factor->order[node->first + j]] != 0;
    if (node->asked && node->parent != UINT32_MAX) factor->supernodes[node->parent].asked = true;
  }
}

static bool is_zero(size_t n, const double *x) {
  for (size_t i = 0; i < n; i++)
    if (x[i] != 0) return false;
  return true;
}

static void solve_lanes(SporeBlockCholesky *factor) {
  const size_t block = 3 * SPORE_LANES;
  double *y = factor->work, *below = y + block * factor->block_count + SPORE_LANES,
         *spare = below + SPORE_LANES * factor->most_rows;
  for (size_t s = 0; s < factor->supernode_count; s++) {
    const SporeSupernode *node = &factor->supernodes[s];
    const uint32_t *row = factor->rows + node->row_start;
    const double *values = factor->values + node->panel;
    if (is_zero(block * node->column_count, y + block * node->first)) continue;
    SPORE_KERNEL(spore_cholesky_forward_many)
    (columns_of(node), rows_of(node), values, below_of(node, values), node->rounded, y + block * node->first, below,
     spare);
    for (size_t i = 0; i < node->row_count; i++)
      for (size_t k = 0; k < block; k++) y[block * row[i] + k] -= below[block * i + k];
  }
  for (size_t s = factor->supernode_count; s-- > 0;) {
    const SporeSupernode *node = &factor->supernodes[s];
    const uint32_t *row = factor->rows + node->row_start;
    const double *values = factor->values + node->panel;
    if (!node->asked) continue;
    for (size_t i = 0; i < node->row_count; i++) memcpy(below + block * i, y + block * row[i], block * sizeof *y);
    SPORE_KERNEL(spore_cholesky_backward_many)
    (columns_of(node), rows_of(node), values, below_of(node, values), node->rounded, y + block * node->first, below,
     spare);
  }
}

/* Whether the matrix has as many blocks as the pattern that was analysed. */
static inline bool is_of_pattern(const SporeBlockCholesky *factor, const SporeBlockMatrix *matrix) {
  size_t n = factor->block_count;
  if (n == 0 || n != matrix->block_count) return false;
  return factor->band.block_count == n ||
         factor->supernodes[factor->supernode_count - 1].entry_end == (matrix->row_start[n] + n) / 2;
}

static bool factorise_direction(SporeBlockCholesky *factor, const double *direction, const uint8_t *held) {
  assert(factor->direction && direction);
  size_t n = factor->block_count;
  memcpy(factor->direction, direction, 3 * n * sizeof *direction);
  for (size_t i = 0; held && i < n; i++)
    if (held[i]) memset(factor->direction + 3 * i, 0, 3 * sizeof *direction);
  solve_blocks(factor, factor->direction, factor->response);
  factor->inverse = 1 / (1 + spore_vector_dot(3 * n, factor->direction, factor->response));
  return factor->inverse > 0;
}

bool spore_block_cholesky_factorise(SporeBlockCholesky *factor, const SporeBlockMatrix *matrix, const double *diagonal,
                                    const uint8_t *held, bool may_round) {
  assert(is_of_pattern(factor, matrix));
  assert(!matrix->directed || factor->direction);
  factor->directed = matrix->directed;
  return factorise_blocks(factor, matrix, diagonal, held, may_round) &&
         (!factor->directed || factorise_direction(factor, matrix->direction, held));
}

/* x is the solution by the blocks alone. */
static void add_direction(const SporeBlockCholesky *factor, double *x) {
  size_t n = 3 * factor->block_count;
  if (!factor->directed) return;
  spore_vector_add_scaled(n, x, -factor->inverse * spore_vector_dot(n, factor->direction, x), factor->response);
}

void spore_block_cholesky_solve(SporeBlockCholesky *factor, const double *b, double *x) {
  assert(factor->block_count > 0);
  assert(b && x);
  solve_blocks(factor, b, x);
  add_direction(factor, x);
}

void spore_block_cholesky_solve_many(SporeBlockCholesky *factor, double *vectors, size_t apart) {
  assert(factor->block_count > 0);
  assert(vectors && apart >= 3 * factor->block_count);
  if (factor->band.block_count == 0) {
    gather_lanes(factor, vectors, apart, factor->work);
    solve_lanes(factor);
    scatter_lanes(factor, factor->work, vectors, apart);
  }
  for (size_t lane = 0; lane < SPORE_LANES; lane++) {
    double *x = vectors + lane * apart;
    if (factor->band.block_count > 0) spore_block_band_solve(&factor->band, x, x);
    add_direction(factor, x);
  }
}
