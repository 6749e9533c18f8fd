/* Block matrix and conjugate gradients against dense arithmetic. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/linalg/block_matrix.h"
#include "core/linalg/bicgstab.h"

#define BLOCKS 20
#define N (3 * BLOCKS)

/* A symmetric positive definite matrix: the graph of a ring with chords, and a copy of it that is dense. */
static void make(SporeBlockMatrix *matrix, double dense[N][N], double shift) {
  SporeBlockPattern pattern;
  spore_block_pattern_init(&pattern, BLOCKS);
  memset(dense, 0, N * N * sizeof(double));
  for (uint32_t i = 0; i < BLOCKS; i++) {
    g_assert_true(spore_block_pattern_add(&pattern, i, (i + 1) % BLOCKS));
    g_assert_true(spore_block_pattern_add(&pattern, (i + 1) % BLOCKS, i)); /* repeats are harmless */
    g_assert_true(spore_block_pattern_add(&pattern, i, (i + 7) % BLOCKS));
  }
  g_assert_false(spore_block_pattern_add(&pattern, 0, BLOCKS));
  g_assert_true(spore_block_matrix_create(matrix, &pattern));
  spore_block_pattern_clear(&pattern);
  for (uint32_t i = 0; i < BLOCKS; i++) {
    for (int step = 0; step < 2; step++) {
      uint32_t j = (i + (step ? 7 : 1)) % BLOCKS;
      SporeVec3 n = spore_vec3_normalise((SporeVec3){sin(i + 1.0), cos(3.0 * i), 0.3 + step}, (SporeVec3){1, 0, 0});
      SporeMat3 k = spore_mat3_scale(1 + i, spore_mat3_outer(n, n)), minus = spore_mat3_scale(-1, k);
      spore_block_matrix_add(matrix, i, i, k.m);
      spore_block_matrix_add(matrix, j, j, k.m);
      spore_block_matrix_add(matrix, i, j, minus.m);
      spore_block_matrix_add(matrix, j, i, minus.m);
      for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
          dense[3 * i + r][3 * i + c] += k.m[3 * r + c], dense[3 * j + r][3 * j + c] += k.m[3 * r + c];
          dense[3 * i + r][3 * j + c] -= k.m[3 * r + c], dense[3 * j + r][3 * i + c] -= k.m[3 * r + c];
        }
    }
    SporeMat3 own = spore_mat3_diagonal(shift, shift, shift);
    spore_block_matrix_add(matrix, i, i, own.m);
    for (int r = 0; r < 3; r++) dense[3 * i + r][3 * i + r] += shift;
  }
}

static void test_matrix(void) {
  static double dense[N][N];
  SporeBlockMatrix matrix;
  make(&matrix, dense, 0.5);
  g_assert_cmpuint(matrix.row_start[BLOCKS], ==, 5 * BLOCKS);
  for (uint32_t i = 0; i < BLOCKS; i++) {
    g_assert_cmpuint(matrix.column[matrix.diagonal[i]], ==, i);
    g_assert_cmpuint(spore_block_matrix_find(&matrix, i, i), ==, matrix.diagonal[i]);
    for (uint32_t k = matrix.row_start[i] + 1; k < matrix.row_start[i + 1]; k++)
      g_assert_cmpuint(matrix.column[k - 1], <, matrix.column[k]);
  }
  g_assert_true(spore_block_matrix_find(&matrix, 0, 3) == SIZE_MAX);
  g_assert_true(spore_block_matrix_find(&matrix, BLOCKS, 0) == SIZE_MAX);
  double x[N], y[N];
  for (int i = 0; i < N; i++) x[i] = sin(i * 1.7), y[i] = i;
  spore_block_matrix_multiply_add(&matrix, x, y);
  for (int i = 0; i < N; i++) {
    double sum = i;
    for (int j = 0; j < N; j++) sum += dense[i][j] * x[j];
    g_assert_cmpfloat_with_epsilon(y[i], sum, 1e-12 * (1 + fabs(sum)));
  }
  spore_block_matrix_zero(&matrix);
  memset(y, 0, sizeof y);
  spore_block_matrix_multiply_add(&matrix, x, y);
  for (int i = 0; i < N; i++) g_assert_cmpfloat(y[i], ==, 0);
  spore_block_matrix_clear(&matrix);
}

static void test_matrix_without_memory(void) {
  SporeBlockPattern pattern;
  spore_block_pattern_init(&pattern, 3);
  spore_block_pattern_add(&pattern, 0, 1);
  SporeBlockMatrix matrix;
  bool made = false;
  for (uint64_t n = 1; !made; n++) {
    spore_allocation_fail_at(n);
    made = spore_block_matrix_create(&matrix, &pattern);
    spore_allocation_fail_at(0);
    g_assert_cmpuint(n, <, 20);
  }
  spore_block_matrix_clear(&matrix);
  spore_block_pattern_clear(&pattern);
}

static void multiply(void *data, const double *x, double *y) {
  memset(y, 0, N * sizeof *y);
  spore_block_matrix_multiply_add(data, x, y);
}

static void by_diagonal(void *data, const double *r, double *z) {
  const SporeBlockMatrix *matrix = data;
  for (int i = 0; i < N; i++) {
    double d = matrix->values[9 * matrix->diagonal[i / 3] + 4 * (size_t)(i % 3)];
    z[i] = r[i] / fabs(d);
  }
}

static void test_pcg(void) {
  static double dense[N][N];
  SporeBlockMatrix matrix;
  make(&matrix, dense, 0.01);
  SporeLinearOperator operator= {&matrix, N, multiply, by_diagonal};
  double x[N], b[N] = {0}, exact[N], scratch[SPORE_PCG_SCRATCH * N];
  for (int i = 0; i < N; i++) exact[i] = cos(i * 0.9);
  spore_block_matrix_multiply_add(&matrix, exact, b);
  SporeLinearResult result = spore_pcg(&operator, b, 1e-12, 1000, x, scratch);
  g_assert_cmpint(result.status, ==, SPORE_LINEAR_CONVERGED);
  g_assert_cmpfloat(result.residual, <=, 1e-12);
  for (int i = 0; i < N; i++) g_assert_cmpfloat_with_epsilon(x[i], exact[i], 1e-7);

  SporeLinearResult few = spore_pcg(&operator, b, 1e-12, 5, x, scratch);
  g_assert_cmpint(few.status, ==, SPORE_LINEAR_TOO_MANY);
  g_assert_cmpuint(few.iterations, ==, 5);
  g_assert_cmpfloat(few.residual, >, 1e-12);

  memset(b, 0, sizeof b);
  result = spore_pcg(&operator, b, 1e-12, 1000, x, scratch);
  g_assert_cmpint(result.status, ==, SPORE_LINEAR_CONVERGED);
  g_assert_cmpuint(result.iterations, ==, 0);
  for (int i = 0; i < N; i++) g_assert_cmpfloat(x[i], ==, 0);

  b[7] = NAN;
  result = spore_pcg(&operator, b, 1e-12, 1000, x, scratch);
  g_assert_cmpint(result.status, ==, SPORE_LINEAR_BREAKDOWN);
  for (int i = 0; i < N; i++) g_assert_cmpfloat(x[i], ==, 0);
  spore_block_matrix_clear(&matrix);
}

/* The matrix with what turns each entry against the next: far from symmetric. */
static void multiply_turned(void *data, const double *x, double *y) {
  multiply(data, x, y);
  for (int i = 0; i + 1 < N; i++) y[i] += 20 * x[i + 1], y[i + 1] -= 20 * x[i];
}

static void test_bicgstab(void) {
  static double dense[N][N];
  SporeBlockMatrix matrix;
  make(&matrix, dense, 0.01);
  SporeLinearOperator operator= {&matrix, N, multiply_turned, by_diagonal};
  double x[N], b[N], exact[N], scratch[SPORE_BICGSTAB_SCRATCH * N];
  for (int i = 0; i < N; i++) exact[i] = cos(i * 0.9);
  multiply_turned(&matrix, exact, b);
  SporeLinearResult result = spore_bicgstab(&operator, b, 1e-12, 1000, x, scratch);
  g_assert_cmpint(result.status, ==, SPORE_LINEAR_CONVERGED);
  g_assert_cmpfloat(result.residual, <=, 1e-12);
  for (int i = 0; i < N; i++) g_assert_cmpfloat_with_epsilon(x[i], exact[i], 1e-7);

  SporeLinearResult few = spore_bicgstab(&operator, b, 1e-12, 3, x, scratch);
  g_assert_cmpint(few.status, ==, SPORE_LINEAR_TOO_MANY);

  memset(b, 0, sizeof b);
  result = spore_bicgstab(&operator, b, 1e-12, 1000, x, scratch);
  g_assert_cmpint(result.status, ==, SPORE_LINEAR_CONVERGED);
  for (int i = 0; i < N; i++) g_assert_cmpfloat(x[i], ==, 0);

  b[7] = NAN;
  result = spore_bicgstab(&operator, b, 1e-12, 1000, x, scratch);
  g_assert_cmpint(result.status, ==, SPORE_LINEAR_BREAKDOWN);
  spore_block_matrix_clear(&matrix);
}

/* A solution is given up where it has far to go, not where it is all but there, and not for good. */
static void test_patience(void) {
  SporePatience never = {0}, some = {10, 5};
  g_assert_false(spore_patience_ends(&never, 1000, 2, 1e-3));
  g_assert_false(spore_patience_ends(&some, 9, 2, 1e-3));
  g_assert_true(spore_patience_ends(&some, 10, 1, 1e-3));
  g_assert_true(spore_patience_ends(&some, 10, INFINITY, 1e-3));
  g_assert_false(spore_patience_ends(&some, 10, 9e-3, 1e-3)); /* 14.7 in all, at this rate */
  g_assert_true(spore_patience_ends(&some, 10, 3e-2, 1e-3));
  g_assert_true(spore_patience_ends(&some, 15, 1.1e-3, 1e-3));
}

static void test_given_up(void) {
  static double dense[N][N];
  SporeBlockMatrix matrix;
  make(&matrix, dense, 0.01);
  SporeLinearOperator operator= {&matrix, N, multiply, by_diagonal};
  double x[N], b[N], scratch[SPORE_BICGSTAB_SCRATCH * N];
  for (int i = 0; i < N; i++) b[i] = sin(i + 0.5);
  size_t free = spore_pcg(&operator, b, 1e-10, 1000, x, scratch).iterations;
  operator.patience =(SporePatience){2, 1};
  SporeLinearResult result = spore_pcg(&operator, b, 1e-10, 1000, x, scratch);
  g_assert_cmpint(result.status, ==, SPORE_LINEAR_TOO_MANY);
  g_assert_cmpuint(result.iterations, <=, 3);
  result = spore_bicgstab(&operator, b, 1e-10, 1000, x, scratch);
  g_assert_cmpint(result.status, ==, SPORE_LINEAR_TOO_MANY);
  g_assert_cmpuint(result.iterations, <=, 3);
  operator.patience =(SporePatience){free - 2, free};
  result = spore_pcg(&operator, b, 1e-10, 1000, x, scratch);
  g_assert_cmpint(result.status, ==, SPORE_LINEAR_CONVERGED);
  g_assert_cmpuint(result.iterations, ==, free);
  spore_block_matrix_clear(&matrix);
}

/* A matrix with a negative eigenvalue is found out, and what comes back still goes downhill: b.x > 0. */
static void test_indefinite(void) {
  static double dense[N][N];
  SporeBlockMatrix matrix;
  make(&matrix, dense, -3);
  SporeLinearOperator operator= {&matrix, N, multiply, by_diagonal};
  double x[N], b[N], scratch[SPORE_PCG_SCRATCH * N], downhill = 0;
  for (int i = 0; i < N; i++) b[i] = sin(i + 0.5);
  SporeLinearResult result = spore_pcg(&operator, b, 1e-12, 1000, x, scratch);
  g_assert_cmpint(result.status, ==, SPORE_LINEAR_INDEFINITE);
  for (int i = 0; i < N; i++) downhill += b[i] * x[i];
  g_assert_cmpfloat(downhill, >, 0);

  spore_block_matrix_clear(&matrix);
  make(&matrix, dense, -1e4); /* negative from the first direction on */
  result = spore_pcg(&operator, b, 1e-12, 1000, x, scratch);
  g_assert_cmpint(result.status, ==, SPORE_LINEAR_INDEFINITE);
  g_assert_cmpuint(result.iterations, ==, 0);
  downhill = 0;
  for (int i = 0; i < N; i++) downhill += b[i] * x[i];
  g_assert_cmpfloat(downhill, >, 0);
  spore_block_matrix_clear(&matrix);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/linalg/matrix", test_matrix);
  g_test_add_func("/linalg/matrix-without-memory", test_matrix_without_memory);
  g_test_add_func("/linalg/pcg", test_pcg);
  g_test_add_func("/linalg/bicgstab", test_bicgstab);
  g_test_add_func("/linalg/patience", test_patience);
  g_test_add_func("/linalg/given-up", test_given_up);
  g_test_add_func("/linalg/indefinite", test_indefinite);
  return g_test_run();
}
