/* Fill-reducing ordering of a symmetric block pattern. */
#ifndef SPORE_LINALG_MINIMUM_DEGREE_H
#define SPORE_LINALG_MINIMUM_DEGREE_H

#include "core/base/cancel.h"
#include "core/linalg/block_matrix.h"

/* Of the factor, by column counts in blocks, diagonal included. */
typedef struct SporeFill {
  double squares; /* sum of their squares */
  size_t blocks;  /* their sum */
} SporeFill;

/* order: block_count entries, the blocks in the order of their elimination. Minimum degree on the quotient graph with
 * approximate degrees (P. Amestoy, T. Davis, I. Duff, "An approximate minimum degree ordering algorithm", SIAM J.
 * Matrix Anal. Appl. 17, 1996), without supervariables. It gives up, true and fill->squares above `most`, as soon as
 * that is exceeded. False: no memory, or `cancel` ended the work. */
bool spore_minimum_degree(const SporeBlockMatrix *pattern, double most, const SporeCancel *cancel, uint32_t *order,
                          SporeFill *fill);

#endif
