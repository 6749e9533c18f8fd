/* Symmetric-pattern sparse matrix of 3x3 blocks (block CSR), rows sorted, diagonal always present. */
#ifndef SPORE_LINALG_BLOCK_MATRIX_H
#define SPORE_LINALG_BLOCK_MATRIX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/math/mat3.h"

/* Collects the off-diagonal blocks before a matrix is made. */
typedef struct SporeBlockPattern {
  size_t block_count, pair_count, pair_capacity;
  uint32_t *pairs; /* pair_count x 2 */
  bool direction;  /* the matrix has one, see there */
} SporeBlockPattern;

/* A pattern of the diagonal alone; takes no memory yet. */
void spore_block_pattern_init(SporeBlockPattern *pattern, size_t block_count);
/* Both (i, j) and (j, i) will exist; repeats are harmless. False: no memory or an index out of range. */
bool spore_block_pattern_add(SporeBlockPattern *pattern, uint32_t i, uint32_t j);
/* Without pairs; keeps its memory. */
static inline void spore_block_pattern_empty(SporeBlockPattern *pattern) { pattern->pair_count = 0; }
/* Memory for so many pairs, which adding them then does not take. False: no memory. */
bool spore_block_pattern_reserve(SporeBlockPattern *pattern, size_t pairs);
/* Frees the pairs and zeroes the pattern. */
void spore_block_pattern_clear(SporeBlockPattern *pattern);

/* The matrix; block k of `values` is in column[k]. */
typedef struct SporeBlockMatrix {
  size_t block_count;
  size_t block_room;   /* blocks that there is memory for: more where the pattern may change */
  uint32_t *row_start; /* block_count + 1 */
  uint32_t *column;    /* row_start[block_count] */
  uint32_t *diagonal;  /* index of each row's diagonal block */
  double *values;      /* 9 a block, row-major */
  /* What is stiff against one motion of all blocks together, as a volume is, has no place among them: the matrix is
   * that of its blocks plus d d^T. */
  double *direction; /* d, 3 a block; NULL: its pattern has none */
  bool directed;     /* d is not 0 */
} SporeBlockMatrix;

/* A zero matrix of the pattern, which may be cleared then. False: no memory; the matrix is then empty. */
bool spore_block_matrix_create(SporeBlockMatrix *matrix, const SporeBlockPattern *pattern);
/* Frees the arrays and zeroes the matrix. */
void spore_block_matrix_clear(SporeBlockMatrix *matrix);

/* What laying out a pattern needs meanwhile, for patterns that change while they run. */
typedef struct SporeBlockRoom {
  size_t pair_capacity;
  uint32_t *row_start, *column, *sorted, *fill;
} SporeBlockRoom;
/* A matrix with room for any pattern of at most so many blocks and pairs, repeats and all. False: no memory; both are
 * then empty. */
bool spore_block_matrix_create_roomy(SporeBlockMatrix *matrix, const SporeBlockPattern *pattern, size_t blocks,
                                     size_t pairs, SporeBlockRoom *room);
/* Frees the arrays and zeroes the room. */
void spore_block_room_clear(SporeBlockRoom *room);
/* Gives such a matrix another pattern; its values are left open. Allocates nothing. False, and nothing changed: the
 * pattern has more blocks or pairs. */
bool spore_block_matrix_lay_out(SporeBlockMatrix *matrix, const SporeBlockPattern *pattern, SporeBlockRoom *room);

/* Sets all values to 0, and the direction too. */
void spore_block_matrix_zero(SporeBlockMatrix *matrix);
/* Position of block (i, j) in values, in blocks; SIZE_MAX where the pattern has none. Models look their blocks up
 * once, at create: the pattern of a model is its own, rows 0..block_count-1. */
size_t spore_block_matrix_find(const SporeBlockMatrix *matrix, uint32_t i, uint32_t j);
/* Adds k to block (i, j), which must exist. */
void spore_block_matrix_add(SporeBlockMatrix *matrix, uint32_t i, uint32_t j, const double k[9]);
/* y += A x */
void spore_block_matrix_multiply_add(const SporeBlockMatrix *matrix, const double *x, double *y);

#endif
