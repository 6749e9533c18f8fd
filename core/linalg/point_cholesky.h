/* Sparse Cholesky factors L L^T of symmetric positive definite matrices with one number for each pair of points, which
 * act on x, y and z of the points alike: a ninth of the numbers of block_cholesky.h, where that is all there is.
 *
 * The pattern is that of a matrix of blocks. It is analysed once: fill-reducing order and rows of each column. Numbers
 * are put in column by column, each from the columns before it that reach it (left-looking; A. George and J. W. H. Liu,
 * "Computer Solution of Large Sparse Positive Definite Systems", 1981, chapter 5). */
#ifndef SPORE_LINALG_POINT_CHOLESKY_H
#define SPORE_LINALG_POINT_CHOLESKY_H

#include "core/base/cancel.h"
#include "core/linalg/block_matrix.h"

#define SPORE_POINT_GROUP 4

typedef struct SporePointPattern {
  size_t count;    /* points; 0: there is none */
  uint32_t *order; /* the point that is eliminated at each place */
  uint32_t *place; /* the other way round */
  size_t *start;   /* count + 1: where the rows below the diagonal of each column begin */
  uint32_t *row;   /* places, ascending in a column */
  /* Columns that lie side by side and have the same rows below them, no more than SPORE_POINT_GROUP: the first of each
   * group, and `count`. */
  size_t group_count;
  uint32_t *group;
  double *column;    /* scratch of a factorisation, with the next three: count each */
  size_t *next;      /* entry of a column that comes next */
  uint32_t *chain;   /* the column after it that reaches the same row next */
  uint32_t *waiting; /* row: the first column that reaches it next */
} SporePointPattern;

typedef struct SporePointFactor {
  double *value;   /* L below its diagonal, as `row` */
  double *inverse; /* of the diagonal of L */
} SporePointFactor;

/* False: no memory, or cancelled; to be cleared all the same. */
bool spore_point_pattern_create(SporePointPattern *pattern, const SporeBlockMatrix *matrix, const SporeCancel *cancel);
void spore_point_pattern_clear(SporePointPattern *pattern);
bool spore_point_factor_create(SporePointFactor *factor, const SporePointPattern *pattern);
void spore_point_factor_clear(SporePointFactor *factor);
/* Numbers of the matrix that the pattern was made of: one for each of its blocks, of which one triangle is read.
 * Allocates nothing. False: a pivot is not positive, or cancelled; the factor is then of no use. */
bool spore_point_factorise(SporePointFactor *factor, SporePointPattern *pattern, const SporeBlockMatrix *matrix,
                           const double *numbers, const SporeCancel *cancel);
/* rows: four for each place, points in the order of elimination; in place, x = A^-1 b in each of the four. */
void spore_point_solve(const SporePointFactor *factor, const SporePointPattern *pattern, double *rows);

#endif
