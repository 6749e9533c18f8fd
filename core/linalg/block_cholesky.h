/* Sparse Cholesky factor L L^T of a symmetric positive definite matrix of 3x3 blocks.
 *
 * Chains and what is like them are kept as a band (block_band.h). Of others the pattern is analysed once:
 * fill-reducing order, elimination tree, supernodes. Numbers are then put in as often as
 * they change, by dense fronts from the leaves of the tree to its root (multifrontal method: J. W. H. Liu, "The
 * multifrontal method for sparse matrix solution", SIAM Review 34, 1992). */
#ifndef SPORE_LINALG_BLOCK_CHOLESKY_H
#define SPORE_LINALG_BLOCK_CHOLESKY_H

#include "core/base/cancel.h"
#include "core/linalg/block_band.h"

/* Columns `first`.. of L that are kept together as one dense panel. */
typedef struct SporeSupernode {
  uint32_t first, column_count;    /* in elimination order */
  uint32_t row_start, row_count;   /* in `rows`: the rows below those columns */
  uint32_t child_count, inside;    /* inside: rows that are columns of the parent */
  uint32_t parent;                 /* UINT32_MAX: none */
  uint32_t sibling;                /* the child of the same parent before this one */
  uint32_t entry_start, entry_end; /* in `entries` */
  size_t panel;                    /* in `values`: L11^-1 and L21, as in core/linalg/cholesky_kernels.h */
  size_t update;                   /* in `updates`: what it takes from its parent's front */
  bool rounded;                    /* to floats, in the same place */
  bool asked;                      /* the solution is asked for in its columns, or below them in the tree */
} SporeSupernode;

/* A block of the matrix and where it goes in a panel. */
typedef struct SporeFactorEntry {
  uint32_t block;       /* of the matrix */
  uint32_t row, column; /* of the matrix, in blocks */
  size_t target;        /* in `front` */
} SporeFactorEntry;

typedef enum SporeFactorLayout {
  SPORE_FACTOR_AUTOMATIC, /* a band where that is narrow and no dearer, by counted work */
  SPORE_FACTOR_SPARSE,
  SPORE_FACTOR_BANDED /* a band where that is narrow */
} SporeFactorLayout;

typedef struct SporeBlockCholesky {
  size_t block_count; /* 0: there is no factor */
  double factor_flops, solve_flops;
  const SporeCancel *cancel; /* of the analysis and of each factorisation; borrowed; NULL: none */
  /* Of a matrix of blocks B with a direction: the factor is that of B, and by Sherman and Morrison's formula
   * (B + d d^T)^-1 b = z - w (d . z) / (1 + d . w), z = B^-1 b, w = B^-1 d. */
  double *direction, *response; /* d and w, 3 block_count each; NULL: the pattern has none */
  double inverse;               /* 1 / (1 + d . w) */
  bool directed;
  SporeBlockBand band; /* block_count 0: it is not banded; else nothing below is used */
  size_t supernode_count;
  SporeSupernode *supernodes; /* children before parents */
  uint32_t *order;            /* block_count: the matrix's block that is eliminated at each place */
  uint32_t *rows;             /* in elimination order */
  uint32_t *targets;          /* as rows: where a row lies in the parent's front, in blocks */
  uint32_t *runs;             /* as rows: how many from there on lie side by side in the parent's front, too */
  SporeFactorEntry *entries;
  double *values;      /* panels */
  double *front;       /* the panel that is being eliminated, where it is rounded then */
  double *updates;     /* matrices that wait for their parents: two stacks, for one generation and the next */
  size_t most_rows;    /* of a panel's L21, padded */
  size_t most_columns; /* of a panel, padded */
  double *work;        /* SPORE_LANES times: 3 block_count and padding, most_rows, and most_columns three times */
} SporeBlockCholesky;

/* Analyses the pattern and takes all memory that factorising and solving need. Where factorising would take more than
 * about most_flops there is no factor: true, and block_count 0. cancel: ends the analysis, and later factorisations;
 * borrowed as long as the factor lives; may be NULL. False: no memory, or cancelled. */
bool spore_block_cholesky_create(SporeBlockCholesky *factor, const SporeBlockMatrix *pattern, SporeFactorLayout layout,
                                 double most_flops, const SporeCancel *cancel);
/* spore_block_band_lay_out, where the factor is a band; else there is none then. */
bool spore_block_cholesky_lay_out(SporeBlockCholesky *factor, const SporeBlockMatrix *pattern);
void spore_block_cholesky_clear(SporeBlockCholesky *factor);
/* Factorises the matrix, of the pattern analysed, with its diagonal blocks replaced by `diagonal` (9 a block) unless
 * that is NULL, and with rows and columns of held blocks (a flag a block, or NULL) replaced by those of the identity.
 * False, and no factor to solve with, where a pivot is not positive or the work was cancelled. Reads one triangle.
 * may_round: what does not lose by it is stored in single precision, which is solved with in half the time; good for a
 * preconditioner. A band is not rounded. */
bool spore_block_cholesky_factorise(SporeBlockCholesky *factor, const SporeBlockMatrix *matrix, const double *diagonal,
                                    const uint8_t *held, bool may_round);
/* x = A^-1 b; may be the same vector. */
void spore_block_cholesky_solve(SporeBlockCholesky *factor, const double *b, double *x);
/* Where spore_block_cholesky_solve_many gives solutions from here on: in blocks with a flag, one a block. */
void spore_block_cholesky_ask(SporeBlockCholesky *factor, const uint8_t *asked);
/* The same in place for SPORE_LANES vectors, `apart` doubles from one to the next. Elsewhere than asked the vectors are
 * then undefined. Blocks of zeros, and blocks that are not asked for, save work. */
void spore_block_cholesky_solve_many(SporeBlockCholesky *factor, double *vectors, size_t apart);

#endif
