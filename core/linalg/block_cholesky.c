#include "core/linalg/block_cholesky.h"

#include <math.h>
#include <string.h>

static size_t front_rows(const SporeSupernode *node) { return 3 * ((size_t)node->column_count + node->row_count); }

/* Subtracts from three columns t of `rows` rows the product of the columns of a, `depth` of them (a multiple of 3),
 * with the three first rows of a. */
static void subtract_product(size_t rows, size_t depth, const double *a, size_t lda, double *t, size_t ldt) {
  double *restrict t0 = t, *restrict t1 = t + ldt, *restrict t2 = t + 2 * ldt;
  for (size_t k = 0; k < depth; k += 3) {
    const double *a0 = a + k * lda, *a1 = a0 + lda, *a2 = a1 + lda;
    double x00 = a0[0], x01 = a0[1], x02 = a0[2], x10 = a1[0], x11 = a1[1], x12 = a1[2], x20 = a2[0], x21 = a2[1],
           x22 = a2[2];
    for (size_t i = 0; i < rows; i++) {
      double p = a0[i], q = a1[i], r = a2[i];
      t0[i] -= p * x00 + q * x10 + r * x20;
      t1[i] -= p * x01 + q * x11 + r * x21;
      t2[i] -= p * x02 + q * x12 + r * x22;
    }
  }
}

/* Scales three columns whose diagonal block stands on top; false where a pivot is not positive. */
static bool factorise_columns(size_t rows, double *t, size_t ldt) {
  double *restrict t0 = t, *restrict t1 = t + ldt, *restrict t2 = t + 2 * ldt;
  if (!(t0[0] > 0)) return false;
  double l00 = sqrt(t0[0]), l10 = t0[1] / l00, l20 = t0[2] / l00, d1 = t1[1] - l10 * l10;
  if (!(d1 > 0)) return false;
  double l11 = sqrt(d1), l21 = (t1[2] - l20 * l10) / l11, d2 = t2[2] - l20 * l20 - l21 * l21;
  if (!(d2 > 0) || !isfinite(l00 + l11 + d2)) return false;
  double l22 = sqrt(d2), i0 = 1 / l00, i1 = 1 / l11, i2 = 1 / l22;
  for (size_t i = 3; i < rows; i++) {
    double a = t0[i] * i0, b = (t1[i] - a * l10) * i1;
    t0[i] = a;
    t1[i] = b;
    t2[i] = (t2[i] - a * l20 - b * l21) * i2;
  }
  t0[0] = l00;
  t0[1] = l10;
  t0[2] = l20;
  t1[0] = t2[0] = t2[1] = 0;
  t1[1] = l11;
  t1[2] = l21;
  t2[2] = l22;
  return true;
}

static bool factorise_panel(const SporeSupernode *node, double *panel) {
  size_t ld = front_rows(node);
  for (size_t j = 0; j < 3 * (size_t)node->column_count; j += 3) {
    double *t = panel + j * ld + j;
    subtract_product(ld - j, j, panel + j, ld, t, ld);
    if (!factorise_columns(ld - j, t, ld)) return false;
  }
  return true;
}

/* What the panel's columns take from the rows below them. */
static void subtract_update(const SporeSupernode *node, const double *panel, double *update) {
  size_t ld = front_rows(node), columns = 3 * (size_t)node->column_count, rows = 3 * (size_t)node->row_count;
  for (size_t j = 0; j < rows; j += 3)
    subtract_product(rows - j, columns, panel + columns + j, ld, update + j * rows + j, rows);
}

/* Adds a child's update matrix to the front of its parent. */
static void extend_add(const SporeBlockCholesky *factor, const SporeSupernode *child, const double *from,
                       const SporeSupernode *node, double *panel, double *update) {
  const uint32_t *target = factor->targets + child->row_start;
  size_t rows = 3 * (size_t)child->row_count, columns = node->column_count, ld = front_rows(node),
         ldu = 3 * (size_t)node->row_count;
  for (size_t j = 0; j < child->row_count; j++) {
    bool inside = target[j] < columns;
    size_t lead = inside ? ld : ldu, shift = inside ? 0 : columns;
    double *to = (inside ? panel : update) + 3 * (target[j] - shift) * lead;
    for (size_t c = 0; c < 3; c++, to += lead) {
      const double *source = from + (3 * j + c) * rows;
      for (size_t i = j; i < child->row_count; i++) {
        double *place = to + 3 * (target[i] - shift);
        place[0] += source[3 * i];
        place[1] += source[3 * i + 1];
        place[2] += source[3 * i + 2];
      }
    }
  }
}

static void assemble(SporeBlockCholesky *factor, const SporeSupernode *node, const SporeBlockMatrix *matrix,
                     const double *diagonal, const uint8_t *held) {
  static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  size_t ld = front_rows(node);
  memset(factor->values + node->panel, 0, ld * 3 * node->column_count * sizeof(double));
  for (uint32_t e = node->entry_start; e < node->entry_end; e++) {
    const SporeFactorEntry *entry = &factor->entries[e];
    const double *block = matrix->values + 9 * (size_t)entry->block;
    bool on_diagonal = entry->row == entry->column;
    if (on_diagonal && diagonal) block = diagonal + 9 * (size_t)entry->row;
    if (held && (held[entry->row] || held[entry->column])) {
      if (!on_diagonal) continue;
      block = identity;
    }
    double *target = factor->values + entry->target;
    for (size_t c = 0; c < 3; c++)
      for (size_t r = 0; r < 3; r++) target[c * ld + r] = block[3 * r + c];
  }
}

bool spore_block_cholesky_factorise(SporeBlockCholesky *factor, const SporeBlockMatrix *matrix, const double *diagonal,
                                    const uint8_t *held) {
  double *top = factor->stack;
  for (size_t s = 0; s < factor->supernode_count; s++) {
    const SporeSupernode *node = &factor->supernodes[s], *child = node;
    double *panel = factor->values + node->panel, *update = top, *from = top;
    size_t size = 9 * (size_t)node->row_count * node->row_count;
    assemble(factor, node, matrix, diagonal, held);
    memset(update, 0, size * sizeof *update);
    /* The children's updates lie on top of the stack, the last child's uppermost. */
    for (uint32_t c = 0; c < node->child_count; c++) {
      child = factor->supernodes + (c == 0 ? s - 1 : child->sibling);
      from -= 9 * (size_t)child->row_count * child->row_count;
      extend_add(factor, child, from, node, panel, update);
    }
    if (!factorise_panel(node, panel)) return false;
    subtract_update(node, panel, update);
    memmove(from, update, size * sizeof *update);
    top = from + size;
  }
  return true;
}

/* Solves with the panel's triangle: y = L^-1 y for its own columns, and takes their part from the rows below. */
static void solve_forward(const SporeBlockCholesky *factor, const SporeSupernode *node, double *x, double *below) {
  size_t ld = front_rows(node), columns = 3 * (size_t)node->column_count, rows = ld - columns;
  const uint32_t *row = factor->rows + node->row_start;
  double *y = x + 3 * (size_t)node->first;
  memset(below, 0, rows * sizeof *below);
  for (size_t j = 0; j < columns; j++) {
    const double *l = factor->values + node->panel + j * ld;
    double yj = y[j] /= l[j];
    for (size_t i = j + 1; i < columns; i++) y[i] -= l[i] * yj;
    for (size_t i = 0; i < rows; i++) below[i] += l[columns + i] * yj;
  }
  for (size_t i = 0; i < rows; i++) x[3 * (size_t)row[i / 3] + i % 3] -= below[i];
}

static void solve_backward(const SporeBlockCholesky *factor, const SporeSupernode *node, double *x, double *below) {
  size_t ld = front_rows(node), columns = 3 * (size_t)node->column_count, rows = ld - columns;
  const uint32_t *row = factor->rows + node->row_start;
  double *y = x + 3 * (size_t)node->first;
  for (size_t i = 0; i < rows; i++) below[i] = x[3 * (size_t)row[i / 3] + i % 3];
  for (size_t j = columns; j-- > 0;) {
    const double *l = factor->values + node->panel + j * ld;
    double sum = 0;
    for (size_t i = j + 1; i < columns; i++) sum += l[i] * y[i];
    for (size_t i = 0; i < rows; i++) sum += l[columns + i] * below[i];
    y[j] = (y[j] - sum) / l[j];
  }
}

void spore_block_cholesky_solve(SporeBlockCholesky *factor, const double *b, double *x) {
  size_t n = factor->block_count;
  double *permuted = factor->work, *below = factor->work + 3 * n;
  for (size_t i = 0; i < n; i++) memcpy(permuted + 3 * i, b + 3 * (size_t)factor->order[i], 3 * sizeof *b);
  for (size_t s = 0; s < factor->supernode_count; s++) solve_forward(factor, &factor->supernodes[s], permuted, below);
  for (size_t s = factor->supernode_count; s-- > 0;) solve_backward(factor, &factor->supernodes[s], permuted, below);
  for (size_t i = 0; i < n; i++) memcpy(x + 3 * (size_t)factor->order[i], permuted + 3 * i, 3 * sizeof *x);
}
