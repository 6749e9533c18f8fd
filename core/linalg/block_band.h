/* Factor of a symmetric positive definite matrix whose 3x3 blocks lie near its diagonal: chains and splines.
 *
 * The factor is L D L^T in blocks: L has identities on its diagonal, D has 3x3 blocks S. For each column S^-1 and the
 * blocks of L are stored, so that a solution waits for one product from block to block. Columns are eliminated from
 * both ends at once, which the processor overlaps; the columns where the two ends meet come last (S. Parter's "burn at
 * both ends"; J. J. Dongarra and others, LINPACK Users' Guide, 1979, chapter 7). There are no lists of rows, and no
 * zeros but those of the band. */
#ifndef SPORE_LINALG_BLOCK_BAND_H
#define SPORE_LINALG_BLOCK_BAND_H

#include "core/linalg/block_matrix.h"

#define SPORE_BAND_WIDEST 3 /* blocks beside the diagonal */

/* A block of the matrix where the factor needs one. */
typedef struct SporeBandEntry {
  uint32_t block; /* (column, row) of the matrix, whose rows are the columns of (row, column); UINT32_MAX: zeros */
  uint32_t row;   /* of the matrix */
} SporeBandEntry;

typedef struct SporeBlockBand {
  size_t block_count;      /* 0: there is no factor */
  size_t block_room;       /* as the matrix's */
  size_t width;            /* blocks below the diagonal in a column, at most SPORE_BAND_WIDEST */
  size_t top, bottom;      /* columns eliminated from either end; at most `width` are left between them */
  uint32_t *order;         /* block_count: the matrix's block that is eliminated at each place: top, bottom, between */
  SporeBandEntry *entries; /* block_count x (width + 1): of a column, from its diagonal on */
  double *values;          /* as entries, 12 each: S^-1 or blocks of L, by columns of three and a zero */
  double *work;            /* 4 block_count */
  double factor_flops, solve_flops;
} SporeBlockBand;

/* Analyses the pattern: in its own order, or by Cuthill and McKee's reversed where that is not narrow enough. Where the
 * band is too wide either way there is no factor: true, and block_count 0. False: no memory. */
bool spore_block_band_create(SporeBlockBand *band, const SporeBlockMatrix *pattern);
/* The factor of another pattern, in its own order, with a band as wide, within the room of the matrix that the factor
 * was made for; allocates nothing. False: it is none such, and there is no factor. */
bool spore_block_band_lay_out(SporeBlockBand *band, const SporeBlockMatrix *pattern);
void spore_block_band_clear(SporeBlockBand *band);
/* As spore_block_cholesky_factorise and _solve. */
bool spore_block_band_factorise(SporeBlockBand *band, const SporeBlockMatrix *matrix, const double *diagonal,
                                const uint8_t *held);
void spore_block_band_solve(SporeBlockBand *band, const double *b, double *x);

#endif
