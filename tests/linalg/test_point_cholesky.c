/* Factors that act on all coordinates alike: their solutions solve, and are the same bits with every instruction set.
 */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/cpu.h"
#include "core/linalg/point_cholesky.h"

typedef struct Problem {
  SporeBlockMatrix matrix;
  double *numbers; /* one a block */
} Problem;

static void put(Problem *problem, uint32_t i, uint32_t j, double value) {
  problem->numbers[spore_block_matrix_find(&problem->matrix, i, j)] += value;
}

/* A grid of `across` points a side, each tied to its neighbours by a number of its own, and to points drawn at random.
 */
static Problem problem_new(uint32_t across, unsigned more, uint32_t seed) {
  Problem problem;
  SporeBlockPattern pattern;
  GRand *random = g_rand_new_with_seed(seed);
  uint32_t n = across * across;
  spore_block_pattern_init(&pattern, n);
  for (uint32_t i = 0; i < n; i++) {
    if (i % across + 1 < across) g_assert_true(spore_block_pattern_add(&pattern, i, i + 1));
    if (i + across < n) g_assert_true(spore_block_pattern_add(&pattern, i, i + across));
  }
  for (unsigned k = 0; k < more; k++) {
    uint32_t a = (uint32_t)g_rand_int_range(random, 0, (int)n), b = (uint32_t)g_rand_int_range(random, 0, (int)n);
    if (a != b) g_assert_true(spore_block_pattern_add(&pattern, a, b));
  }
  g_assert_true(spore_block_matrix_create(&problem.matrix, &pattern));
  spore_block_pattern_clear(&pattern);
  problem.numbers = g_new0(double, problem.matrix.row_start[n]);
  for (uint32_t i = 0; i < n; i++) {
    put(&problem, i, i, 0.1);
    for (uint32_t k = problem.matrix.row_start[i]; k < problem.matrix.row_start[i + 1]; k++) {
      uint32_t j = problem.matrix.column[k];
      double value = g_rand_double_range(random, 0.1, 2);
      if (j <= i) continue;
      put(&problem, i, i, value), put(&problem, j, j, value);
      put(&problem, i, j, -value), put(&problem, j, i, -value);
    }
  }
  g_rand_free(random);
  return problem;
}

static void problem_clear(Problem *problem) {
  spore_block_matrix_clear(&problem->matrix);
  g_free(problem->numbers);
}

/* Largest entry of A x - b over that of b; x, b: four numbers a place. */
static double left(const Problem *problem, const SporePointPattern *pattern, const double *x, const double *b) {
  double worst = 0, most = 0;
  for (size_t j = 0; j < pattern->count; j++) {
    uint32_t point = pattern->order[j];
    for (size_t c = 0; c < 4; c++) {
      double sum = -b[4 * j + c];
      for (uint32_t k = problem->matrix.row_start[point]; k < problem->matrix.row_start[point + 1]; k++)
        sum += problem->numbers[k] * x[4 * pattern->place[problem->matrix.column[k]] + c];
      worst = fmax(worst, fabs(sum)), most = fmax(most, fabs(b[4 * j + c]));
    }
  }
  return worst / most;
}

static void check_solutions(uint32_t across, unsigned more) {
  Problem problem = problem_new(across, more, across);
  SporePointPattern pattern;
  SporePointFactor factor;
  g_assert_true(spore_point_pattern_create(&pattern, &problem.matrix, NULL));
  g_assert_true(spore_point_factor_create(&factor, &pattern));
  g_assert_true(spore_point_factorise(&factor, &pattern, &problem.matrix, problem.numbers, NULL));
  size_t count = 4 * pattern.count;
  g_autofree double *b = g_new(double, count), *x = g_new(double, count), *expected = g_new(double, count);
  for (size_t i = 0; i < count; i++) b[i] = sin((double)i);
  for (int level = 0; level < SPORE_CPU_LEVELS; level++) {
    spore_cpu_limit(level);
    memcpy(x, b, count * sizeof *x);
    spore_point_solve(&factor, &pattern, x);
    if (level == 0) memcpy(expected, x, count * sizeof *x);
    g_assert_cmpmem(expected, count * sizeof *x, x, count * sizeof *x);
  }
  g_test_message("%zu points, %zu numbers, %zu groups: %.2g left", pattern.count, pattern.start[pattern.count],
                 pattern.group_count, left(&problem, &pattern, x, b));
  g_assert_cmpfloat(left(&problem, &pattern, x, b), <, 1e-11);
  spore_point_factor_clear(&factor);
  spore_point_pattern_clear(&pattern);
  problem_clear(&problem);
}

static void solves(void) {
  check_solutions(1, 0);
  check_solutions(2, 0);
  check_solutions(17, 0);
  check_solutions(17, 60);
  check_solutions(8, 2000);
}

static bool always(void *data) { return true; }

/* A matrix that is not positive definite has no factor; cancelled work gives none. */
static void refuses(void) {
  Problem problem = problem_new(5, 0, 1);
  SporePointPattern pattern;
  SporePointFactor factor;
  const SporeCancel cancel = {always, NULL};
  g_assert_true(spore_point_pattern_create(&pattern, &problem.matrix, NULL));
  g_assert_true(spore_point_factor_create(&factor, &pattern));
  g_assert_false(spore_point_factorise(&factor, &pattern, &problem.matrix, problem.numbers, &cancel));
  g_assert_true(spore_point_factorise(&factor, &pattern, &problem.matrix, problem.numbers, NULL));
  put(&problem, 12, 12, -100);
  g_assert_false(spore_point_factorise(&factor, &pattern, &problem.matrix, problem.numbers, NULL));
  spore_point_factor_clear(&factor);
  spore_point_pattern_clear(&pattern);
  problem_clear(&problem);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/point_cholesky/solves", solves);
  g_test_add_func("/point_cholesky/refuses", refuses);
  return g_test_run();
}
