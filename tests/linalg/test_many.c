/* Solutions for several right-hand sides at once, and the dense factor: against one at a time, and against products. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/linalg/block_cholesky.h"
#include "core/linalg/dense.h"

#define SIDE 9
#define BLOCKS (SIDE * SIDE)
#define SIZE (3 * BLOCKS)

/* A net of springs, or a chain: stiff, and held by a little mass. */
static void make(gboolean chain, SporeBlockMatrix *matrix) {
  SporeBlockPattern pattern;
  spore_block_pattern_init(&pattern, BLOCKS);
  for (uint32_t i = 0; i < BLOCKS; i++) {
    if (i + 1 < BLOCKS && (chain || i % SIDE + 1 < SIDE)) g_assert_true(spore_block_pattern_add(&pattern, i, i + 1));
    if (!chain && i + SIDE < BLOCKS) g_assert_true(spore_block_pattern_add(&pattern, i, i + SIDE));
  }
  g_assert_true(spore_block_matrix_create(matrix, &pattern));
  spore_block_pattern_clear(&pattern);
  for (uint32_t i = 0; i < BLOCKS; i++)
    for (uint32_t k = matrix->row_start[i]; k < matrix->row_start[i + 1]; k++)
      for (size_t e = 0; e < 3; e++) {
        uint32_t j = matrix->column[k];
        if (j == i) matrix->values[9 * k + 4 * e] += 0.5;
        else {
          matrix->values[9 * k + 4 * e] -= 1 + 0.1 * (double)e;
          matrix->values[9 * matrix->diagonal[i] + 4 * e] += 1 + 0.1 * (double)e;
        }
      }
}

/* Few entries are not zero, as where a contact pushes; asked for in a few places. */
static void test_many(gconstpointer data) {
  SporeBlockMatrix matrix;
  SporeBlockCholesky factor;
  make(GPOINTER_TO_INT(data), &matrix);
  g_assert_true(spore_block_cholesky_create(&factor, &matrix, SPORE_FACTOR_AUTOMATIC, HUGE_VAL, NULL));
  g_assert_cmpint(factor.band.block_count > 0, ==, GPOINTER_TO_INT(data));
  for (int rounded = 0; rounded < 2; rounded++) {
    g_assert_true(spore_block_cholesky_factorise(&factor, &matrix, NULL, NULL, rounded));
    double vectors[SPORE_LANES][SIZE] = {{0}}, alone[SIZE];
    uint8_t asked[BLOCKS] = {[3] = 1, [40] = 1, [BLOCKS - 1] = 1};
    for (size_t lane = 0; lane < SPORE_LANES; lane++)
      for (size_t e = 0; e < 3; e++) vectors[lane][3 * (7 * lane + 2) + e] = 1 + (double)(lane + e);
    spore_block_cholesky_ask(&factor, asked);
    double before[SPORE_LANES][SIZE];
    memcpy(before, vectors, sizeof before);
    spore_block_cholesky_solve_many(&factor, vectors[0], SIZE);
    for (size_t lane = 0; lane < SPORE_LANES; lane++) {
      spore_block_cholesky_solve(&factor, before[lane], alone);
      for (size_t i = 0; i < BLOCKS; i++)
        for (size_t e = 0; asked[i] && e < 3; e++)
          g_assert_cmpfloat(fabs(vectors[lane][3 * i + e] - alone[3 * i + e]), <, rounded ? 1e-5 : 1e-12);
    }
  }
  spore_block_cholesky_clear(&factor);
  spore_block_matrix_clear(&matrix);
}

#define DENSE 21
#define APART 24

static void test_dense(void) {
  g_autoptr(GRand) random = g_rand_new_with_seed(5);
  double a[DENSE * APART] = {0}, factor[DENSE * APART], x[DENSE], b[DENSE] = {0};
  uint32_t order[DENSE];
  for (size_t i = 0; i < DENSE; i++) {
    x[i] = g_rand_double_range(random, -1, 1);
    for (size_t j = 0; j < DENSE; j++) a[i * APART + j] = g_rand_double_range(random, -1, 1);
    a[i * APART + i] = 0; /* rows have to change places */
  }
  for (size_t i = 0; i < DENSE; i++)
    for (size_t j = 0; j < DENSE; j++) b[i] += a[i * APART + j] * x[j];
  memcpy(factor, a, sizeof a);
  g_assert_true(SPORE_KERNEL(spore_dense_factorise)(DENSE, APART, factor, order));
  SPORE_KERNEL(spore_dense_solve)(DENSE, APART, factor, order, b);
  for (size_t i = 0; i < DENSE; i++) g_assert_cmpfloat(fabs(b[i] - x[i]), <, 1e-12);
  memset(a + 3 * APART, 0, APART * sizeof *a);
  g_assert_false(SPORE_KERNEL(spore_dense_factorise)(DENSE, APART, a, order));
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_data_func("/many/net", GINT_TO_POINTER(FALSE), test_many);
  g_test_add_data_func("/many/chain", GINT_TO_POINTER(TRUE), test_many);
  g_test_add_func("/many/dense", test_dense);
  return g_test_run();
}
