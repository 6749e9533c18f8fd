/* The sparse factor against a dense one. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/cpu.h"
#include "core/base/memory.h"
#include "core/linalg/block_cholesky.h"

/* Weakly dominant, so positive definite: the block (i, j) is a random one, the diagonal outweighs its row. */
static void fill_matrix(SporeBlockMatrix *matrix, GRand *random) {
  for (uint32_t i = 0; i < matrix->block_count; i++)
    for (uint32_t k = matrix->row_start[i]; k < matrix->row_start[i + 1]; k++) {
      uint32_t j = matrix->column[k];
      if (j >= i) continue;
      double *lower = matrix->values + 9 * (size_t)k;
      double *upper = matrix->values + 9 * spore_block_matrix_find(matrix, j, i);
      double *di = matrix->values + 9 * (size_t)matrix->diagonal[i],
             *dj = matrix->values + 9 * (size_t)matrix->diagonal[j];
      for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
          double a = g_rand_double_range(random, -1, 1);
          lower[3 * r + c] = upper[3 * c + r] = a;
          di[4 * r] += fabs(a);
          dj[4 * c] += fabs(a);
        }
    }
  for (uint32_t i = 0; i < matrix->block_count; i++)
    for (int r = 0; r < 3; r++) matrix->values[9 * (size_t)matrix->diagonal[i] + 4 * (size_t)r] += 1e-3;
}

/* Dense Cholesky, in place of x. */
static void dense_solve(const SporeBlockMatrix *matrix, double *x) {
  size_t n = 3 * matrix->block_count;
  double *a = g_new0(double, n *n);
  for (uint32_t i = 0; i < matrix->block_count; i++)
    for (uint32_t k = matrix->row_start[i]; k < matrix->row_start[i + 1]; k++)
      for (size_t e = 0; e < 9; e++)
        a[(3 * i + e / 3) * n + 3 * matrix->column[k] + e % 3] = matrix->values[9 * (size_t)k + e];
  for (size_t j = 0; j < n; j++) {
    for (size_t k = 0; k < j; k++)
      for (size_t i = j; i < n; i++) a[i * n + j] -= a[i * n + k] * a[j * n + k];
    double root = sqrt(a[j * n + j]);
    for (size_t i = j; i < n; i++) a[i * n + j] /= root;
  }
  for (size_t j = 0; j < n; j++) {
    for (size_t k = 0; k < j; k++) x[j] -= a[j * n + k] * x[k];
    x[j] /= a[j * n + j];
  }
  for (size_t j = n; j-- > 0;) {
    for (size_t i = j + 1; i < n; i++) x[j] -= a[i * n + j] * x[i];
    x[j] /= a[j * n + j];
  }
  g_free(a);
}

static double farthest(size_t n, const double *a, const double *b) {
  double worst = 0;
  for (size_t i = 0; i < n; i++) worst = fmax(worst, fabs(a[i] - b[i]));
  return worst;
}

/* Every instruction set gives the same bits. */
static void same_at_every_level(SporeBlockCholesky *factor, const SporeBlockMatrix *matrix, const double *b,
                                const double *x, const double *rounded) {
  size_t n = 3 * matrix->block_count;
  double *again = g_new(double, n);
  for (SporeCpuLevel level = 0; level < SPORE_CPU_LEVELS; level++) {
    spore_cpu_limit(level);
    g_assert_true(spore_block_cholesky_factorise(factor, matrix, NULL, NULL, true));
    spore_block_cholesky_solve(factor, b, again);
    g_assert_cmpmem(again, n * sizeof *x, rounded, n * sizeof *x);
    g_assert_true(spore_block_cholesky_factorise(factor, matrix, NULL, NULL, false));
    spore_block_cholesky_solve(factor, b, again);
    g_assert_cmpmem(again, n * sizeof *x, x, n * sizeof *x);
  }
  g_free(again);
}

/* Factorises twice, with other numbers, and solves against the dense factor; no memory is taken meanwhile. */
static void compare(const char *name, SporeBlockPattern *pattern, SporeFactorLayout layout) {
  SporeBlockMatrix matrix;
  SporeBlockCholesky factor;
  GRand *random = g_rand_new_with_seed(7);
  g_assert_true(spore_block_matrix_create(&matrix, pattern));
  g_assert_true(spore_block_cholesky_create(&factor, &matrix, layout, HUGE_VAL, NULL));
  g_assert_cmpuint(factor.block_count, ==, matrix.block_count);
  if (layout != SPORE_FACTOR_AUTOMATIC)
    g_assert_cmpuint(factor.band.block_count, ==, layout == SPORE_FACTOR_BANDED ? matrix.block_count : 0);
  size_t n = 3 * matrix.block_count;
  double *b = g_new(double, n), *x = g_new(double, n), *dense = g_new(double, n), *rounded = g_new(double, n);
  for (int pass = 0; pass < 2; pass++) {
    spore_block_matrix_zero(&matrix);
    fill_matrix(&matrix, random);
    for (size_t i = 0; i < n; i++) dense[i] = b[i] = g_rand_double_range(random, -1, 1);
    uint64_t allocations = spore_allocation_count();
    g_assert_true(spore_block_cholesky_factorise(&factor, &matrix, NULL, NULL, false));
    spore_block_cholesky_solve(&factor, b, x);
    g_assert_cmpuint(spore_allocation_count(), ==, allocations);
    dense_solve(&matrix, dense);
    double size = 0;
    for (size_t i = 0; i < n; i++) size = fmax(size, fabs(dense[i]));
    double error = farthest(n, x, dense) / size;
    g_test_message("%s: %zu blocks, %zu supernodes, %.3g flops, %.3g a solve, off by %.1e", name, matrix.block_count,
                   factor.supernode_count, factor.factor_flops, factor.solve_flops, error);
    g_assert_cmpfloat(error, <, 1e-10);
    g_assert_true(spore_block_cholesky_factorise(&factor, &matrix, NULL, NULL, true));
    spore_block_cholesky_solve(&factor, b, rounded);
    g_assert_cmpfloat(farthest(n, rounded, x) / size, <, 2e-4);
    same_at_every_level(&factor, &matrix, b, x, rounded);
    spore_block_cholesky_solve(&factor, b, b);
    g_assert_cmpfloat(farthest(n, x, b), ==, 0);
  }
  g_free(b);
  g_free(x);
  g_free(dense);
  g_free(rounded);
  g_rand_free(random);
  spore_block_cholesky_clear(&factor);
  spore_block_matrix_clear(&matrix);
  spore_block_pattern_clear(pattern);
}

static void tie(SporeBlockPattern *pattern, size_t i, size_t j) {
  g_assert_true(spore_block_pattern_add(pattern, (uint32_t)i, (uint32_t)j));
}

/* A net of side x side nodes with diagonals and springs over two edges. */
static void net_pattern(SporeBlockPattern *pattern, size_t side) {
  spore_block_pattern_init(pattern, side * side);
  for (size_t i = 0; i < side * side; i++) {
    size_t x = i % side, y = i / side;
    if (x + 1 < side) tie(pattern, i, i + 1);
    if (y + 1 < side) tie(pattern, i, i + side);
    if (x + 1 < side && y + 1 < side) tie(pattern, i, i + side + 1);
    if (x + 2 < side) tie(pattern, i, i + 2);
    if (y + 2 < side) tie(pattern, i, i + 2 * side);
  }
}

static void test_shapes(void) {
  SporeBlockPattern pattern;
  spore_block_pattern_init(&pattern, 1);
  compare("one", &pattern, SPORE_FACTOR_SPARSE);
  spore_block_pattern_init(&pattern, 40);
  compare("diagonal", &pattern, SPORE_FACTOR_SPARSE);
  spore_block_pattern_init(&pattern, 100);
  for (size_t i = 0; i + 1 < 100; i++) tie(&pattern, i, i + 1);
  compare("chain", &pattern, SPORE_FACTOR_SPARSE);
  net_pattern(&pattern, 10);
  compare("grid", &pattern, SPORE_FACTOR_SPARSE);
  spore_block_pattern_init(&pattern, 20);
  for (size_t i = 0; i < 20; i++)
    for (size_t j = 0; j < i; j++) tie(&pattern, i, j);
  compare("dense", &pattern, SPORE_FACTOR_SPARSE);
  spore_block_pattern_init(&pattern, 60); /* everything hangs on one block */
  for (size_t i = 1; i < 60; i++) tie(&pattern, 0, i);
  compare("star", &pattern, SPORE_FACTOR_SPARSE);
}

static void test_random(void) {
  GRand *random = g_rand_new_with_seed(11);
  for (size_t k = 0; k < 60; k++) {
    SporeBlockPattern pattern;
    size_t n = 1 + (size_t)g_rand_int_range(random, 0, 70);
    spore_block_pattern_init(&pattern, n);
    size_t pairs = (size_t)g_rand_int_range(random, 0, (gint32)(3 * n));
    for (size_t p = 0; p < pairs; p++)
      tie(&pattern, (size_t)g_rand_int_range(random, 0, (gint32)n), (size_t)g_rand_int_range(random, 0, (gint32)n));
    compare("random", &pattern, k % 2 ? SPORE_FACTOR_SPARSE : SPORE_FACTOR_AUTOMATIC);
  }
  g_rand_free(random);
}

/* Blocks tied to the `width` next ones; shuffled: numbered at random. */
static void band_pattern(SporeBlockPattern *pattern, size_t n, size_t width, GRand *shuffled) {
  uint32_t *number = g_new(uint32_t, n);
  for (size_t i = 0; i < n; i++) number[i] = (uint32_t)i;
  for (size_t i = n; shuffled && i-- > 1;) {
    size_t j = (size_t)g_rand_int_range(shuffled, 0, (gint32)i + 1);
    uint32_t swap = number[i];
    number[i] = number[j], number[j] = swap;
  }
  spore_block_pattern_init(pattern, n);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 1; k <= width && i + k < n; k++) tie(pattern, number[i], number[i + k]);
  g_free(number);
}

static void test_band(void) {
  SporeBlockPattern pattern;
  GRand *random = g_rand_new_with_seed(19);
  for (size_t width = 1; width <= SPORE_BAND_WIDEST; width++)
    for (size_t n = 1; n < 80; n += n < 16 ? 1 : 21) {
      band_pattern(&pattern, n, width, NULL);
      compare("band", &pattern, SPORE_FACTOR_BANDED);
      band_pattern(&pattern, n, width, random);
      compare("shuffled band", &pattern, SPORE_FACTOR_BANDED);
    }
  spore_block_pattern_init(&pattern, 7);
  compare("diagonal", &pattern, SPORE_FACTOR_BANDED);
  spore_block_pattern_init(&pattern, 50); /* two chains, one of them closed */
  for (size_t i = 0; i + 1 < 50; i++)
    if (i != 29) tie(&pattern, i, i + 1);
  tie(&pattern, 0, 29);
  compare("ring and chain", &pattern, SPORE_FACTOR_BANDED);
  g_rand_free(random);
}

/* What is too wide for a band is kept sparse, asked for or not; of a chain a band is made. */
static void test_layout(void) {
  SporeBlockPattern pattern;
  SporeBlockMatrix matrix;
  SporeBlockCholesky factor;
  for (SporeFactorLayout layout = SPORE_FACTOR_AUTOMATIC; layout <= SPORE_FACTOR_BANDED; layout++)
    for (size_t width = 1; width <= SPORE_BAND_WIDEST + 1; width++) {
      band_pattern(&pattern, 60, width, NULL);
      g_assert_true(spore_block_matrix_create(&matrix, &pattern));
      g_assert_true(spore_block_cholesky_create(&factor, &matrix, layout, HUGE_VAL, NULL));
      g_assert_cmpuint(factor.block_count, ==, 60);
      bool banded = layout != SPORE_FACTOR_SPARSE && width <= SPORE_BAND_WIDEST;
      g_assert_cmpuint(factor.band.block_count, ==, banded ? 60 : 0);
      spore_block_cholesky_clear(&factor);
      spore_block_matrix_clear(&matrix);
      spore_block_pattern_clear(&pattern);
    }
}

/* A net or, for a band, a chain. */
static void pattern_for(SporeFactorLayout layout, SporeBlockPattern *pattern, size_t side) {
  if (layout == SPORE_FACTOR_BANDED) band_pattern(pattern, side * side, SPORE_BAND_WIDEST, NULL);
  else net_pattern(pattern, side);
}

/* Of the order of a net: the elimination of 1600 blocks in their natural order would take 27 x 80^2 x 1600 flops. */
static void test_fill(void) {
  SporeBlockPattern pattern;
  SporeBlockMatrix matrix;
  SporeBlockCholesky factor;
  net_pattern(&pattern, 40);
  g_assert_true(spore_block_matrix_create(&matrix, &pattern));
  g_assert_true(spore_block_cholesky_create(&factor, &matrix, SPORE_FACTOR_SPARSE, HUGE_VAL, NULL));
  g_test_message("net of 40 x 40: %.3g flops, %.3g a solve", factor.factor_flops, factor.solve_flops);
  g_assert_cmpfloat(factor.factor_flops, <, 0.5 * 27 * 80 * 80 * 1600);
  double flops = factor.factor_flops;
  spore_block_cholesky_clear(&factor);
  g_assert_true(spore_block_cholesky_create(&factor, &matrix, SPORE_FACTOR_SPARSE, flops / 10,
                                            NULL)); /* too dear: no factor, no error */
  g_assert_cmpuint(factor.block_count, ==, 0);
  spore_block_matrix_clear(&matrix);
  spore_block_pattern_clear(&pattern);
}

/* Control points of a sheet: each is tied to those up to three away in both directions. */
static void sheet_pattern(SporeBlockPattern *pattern, size_t side) {
  spore_block_pattern_init(pattern, side * side);
  for (size_t i = 0; i < side * side; i++)
    for (size_t j = i + 1; j < side * side && j <= i + 3 * side + 3; j++) {
      size_t across = i % side > j % side ? i % side - j % side : j % side - i % side;
      if (across <= 3 && j / side - i / side <= 3) tie(pattern, i, j);
    }
}

/* Nested dissection takes work by the cube of the side (A. George, SIAM J. Numer. Anal. 10, 1973): eight times as much
 * for a sheet of twice the side. Sixteen times is the fourth power. */
static void test_sheet_fill(void) {
  double flops[2];
  for (size_t k = 0; k < 2; k++) {
    SporeBlockPattern pattern;
    SporeBlockMatrix matrix;
    SporeBlockCholesky factor;
    sheet_pattern(&pattern, k == 0 ? 60 : 120);
    g_assert_true(spore_block_matrix_create(&matrix, &pattern));
    g_assert_true(spore_block_cholesky_create(&factor, &matrix, SPORE_FACTOR_SPARSE, HUGE_VAL, NULL));
    flops[k] = factor.factor_flops;
    spore_block_cholesky_clear(&factor);
    spore_block_matrix_clear(&matrix);
    spore_block_pattern_clear(&pattern);
  }
  g_test_message("sheets of 60 x 60 and 120 x 120: %.3g and %.3g flops", flops[0], flops[1]);
  g_assert_cmpfloat(flops[1], <, 12 * flops[0]);
}

typedef struct Asker {
  size_t asked, at; /* yes from the question number `at` on */
} Asker;

static bool answer(void *data) {
  Asker *asker = data;
  return ++asker->asked >= asker->at;
}

/* A factorisation asks after every so many operations at the most, on the average: some 5 ms of them. */
#define OPERATIONS_A_QUESTION 2e7

/* A front of 900 columns: the largest piece of a factorisation is one dense block. */
static void test_cancel(void) {
  SporeBlockPattern pattern;
  SporeBlockMatrix matrix;
  SporeBlockCholesky factor;
  Asker asker = {0, SIZE_MAX};
  const SporeCancel cancel = {answer, &asker};
  size_t n = 300;
  spore_block_pattern_init(&pattern, n);
  for (size_t i = 0; i < n; i++)
    for (size_t j = i + 1; j < n; j++) tie(&pattern, i, j);
  g_assert_true(spore_block_matrix_create(&matrix, &pattern));
  for (size_t i = 0; i < n; i++)
    for (size_t e = 0; e < 9; e += 4) matrix.values[9 * (size_t)matrix.diagonal[i] + e] = 1;
  g_assert_true(spore_block_cholesky_create(&factor, &matrix, SPORE_FACTOR_SPARSE, HUGE_VAL, &cancel));
  g_assert_cmpuint(asker.asked, >=, n);
  asker.asked = 0;
  g_assert_true(spore_block_cholesky_factorise(&factor, &matrix, NULL, NULL, false));
  size_t whole = asker.asked;
  g_test_message("%.3g operations, asked %zu times", factor.factor_flops, whole);
  g_assert_cmpfloat(factor.factor_flops / (double)whole, <, OPERATIONS_A_QUESTION);
  for (size_t at = 1; at <= whole; at += (whole - 1) / 3) {
    asker = (Asker){0, at};
    g_assert_false(spore_block_cholesky_factorise(&factor, &matrix, NULL, NULL, false));
    g_assert_cmpuint(asker.asked, ==, at);
  }
  spore_block_cholesky_clear(&factor);
  asker = (Asker){0, n / 2};
  g_assert_false(spore_block_cholesky_create(&factor, &matrix, SPORE_FACTOR_SPARSE, HUGE_VAL, &cancel));
  spore_block_matrix_clear(&matrix);
  spore_block_pattern_clear(&pattern);
}

/* Diagonal blocks and held blocks in place of the matrix's own. */
static void test_replaced(gconstpointer data) {
  SporeFactorLayout layout = *(const SporeFactorLayout *)data;
  SporeBlockPattern pattern;
  SporeBlockMatrix matrix;
  SporeBlockCholesky factor;
  GRand *random = g_rand_new_with_seed(3);
  pattern_for(layout, &pattern, 5);
  g_assert_true(spore_block_matrix_create(&matrix, &pattern));
  g_assert_true(spore_block_cholesky_create(&factor, &matrix, layout, HUGE_VAL, NULL));
  fill_matrix(&matrix, random);
  double diagonal[25 * 9], b[75], x[75], product[75] = {0};
  uint8_t held[25] = {0};
  held[3] = held[12] = 1;
  for (size_t i = 0; i < 25; i++)
    for (size_t e = 0; e < 9; e++)
      diagonal[9 * i + e] = matrix.values[9 * (size_t)matrix.diagonal[i] + e] + (e % 4 == 0 ? (double)i : 0);
  for (size_t i = 0; i < 75; i++) b[i] = held[i / 3] ? 0 : g_rand_double_range(random, -1, 1);
  g_assert_true(spore_block_cholesky_factorise(&factor, &matrix, diagonal, held, false));
  spore_block_cholesky_solve(&factor, b, x);
  for (size_t i = 0; i < 25; i++)
    memcpy(matrix.values + 9 * (size_t)matrix.diagonal[i], diagonal + 9 * i, 9 * sizeof(double));
  spore_block_matrix_multiply_add(&matrix, x, product);
  for (size_t i = 0; i < 75; i++) {
    if (held[i / 3]) g_assert_cmpfloat(x[i], ==, 0);
    else g_assert_cmpfloat(fabs(product[i] - b[i]), <, 1e-12);
  }
  g_rand_free(random);
  spore_block_cholesky_clear(&factor);
  spore_block_matrix_clear(&matrix);
  spore_block_pattern_clear(&pattern);
}

/* What is not positive definite is refused, wherever it shows; afterwards the factor works again. */
static void test_not_positive(gconstpointer data) {
  SporeFactorLayout layout = *(const SporeFactorLayout *)data;
  SporeBlockPattern pattern;
  SporeBlockMatrix matrix;
  SporeBlockCholesky factor;
  GRand *random = g_rand_new_with_seed(5);
  pattern_for(layout, &pattern, 6);
  g_assert_true(spore_block_matrix_create(&matrix, &pattern));
  g_assert_true(spore_block_cholesky_create(&factor, &matrix, layout, HUGE_VAL, NULL));
  fill_matrix(&matrix, random);
  const double bad[] = {-1e3, -INFINITY, INFINITY, NAN};
  for (size_t i = 0; i < 36; i++)
    for (size_t axis = 0; axis < 3; axis++)
      for (size_t k = 0; k < 4; k++) {
        double *entry = &matrix.values[9 * (size_t)matrix.diagonal[i] + 4 * axis], kept = *entry;
        *entry = bad[k];
        g_assert_false(spore_block_cholesky_factorise(&factor, &matrix, NULL, NULL, false));
        *entry = kept;
      }
  g_assert_true(spore_block_cholesky_factorise(&factor, &matrix, NULL, NULL, false));
  g_rand_free(random);
  spore_block_cholesky_clear(&factor);
  spore_block_matrix_clear(&matrix);
  spore_block_pattern_clear(&pattern);
}

static void test_without_memory(gconstpointer data) {
  SporeFactorLayout layout = *(const SporeFactorLayout *)data;
  SporeBlockPattern pattern;
  SporeBlockMatrix matrix;
  SporeBlockCholesky factor;
  pattern_for(layout, &pattern, 6);
  g_assert_true(spore_block_matrix_create(&matrix, &pattern));
  bool made = false;
  uint64_t refused = 0;
  while (!made) {
    spore_allocation_fail_at(++refused);
    made = spore_block_cholesky_create(&factor, &matrix, layout, HUGE_VAL, NULL);
    spore_allocation_fail_at(0);
    if (!made) g_assert_null(factor.order);
    if (!made) g_assert_null(factor.band.order);
  }
  g_assert_cmpuint(refused, >, 4);
  spore_block_cholesky_clear(&factor);
  spore_block_matrix_clear(&matrix);
  spore_block_pattern_clear(&pattern);
}

int main(int argc, char **argv) {
  static const SporeFactorLayout sparse = SPORE_FACTOR_SPARSE, banded = SPORE_FACTOR_BANDED;
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/cholesky/shapes", test_shapes);
  g_test_add_func("/cholesky/random", test_random);
  g_test_add_func("/cholesky/band", test_band);
  g_test_add_func("/cholesky/layout", test_layout);
  g_test_add_func("/cholesky/fill", test_fill);
  g_test_add_func("/cholesky/sheet-fill", test_sheet_fill);
  g_test_add_func("/cholesky/cancel", test_cancel);
  g_test_add_data_func("/cholesky/replaced", &sparse, test_replaced);
  g_test_add_data_func("/cholesky/replaced/banded", &banded, test_replaced);
  g_test_add_data_func("/cholesky/not-positive", &sparse, test_not_positive);
  g_test_add_data_func("/cholesky/not-positive/banded", &banded, test_not_positive);
  g_test_add_data_func("/cholesky/without-memory", &sparse, test_without_memory);
  g_test_add_data_func("/cholesky/without-memory/banded", &banded, test_without_memory);
  return g_test_run();
}
