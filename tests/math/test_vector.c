/* Vector kernels: right, and the same bits with every instruction set that this machine has. */
#include <float.h>
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/math/vector.h"

enum { LONGEST = 133 };

static GRand *random_source;

static void fill(double *x) {
  for (size_t i = 0; i < LONGEST; i++)
    x[i] = g_rand_double_range(random_source, -1, 1) * pow(10, g_rand_double_range(random_source, -8, 8));
}

static void test_names(void) {
  spore_cpu_limit(SPORE_CPU_BASELINE);
  g_assert_cmpint(spore_cpu_level(), ==, SPORE_CPU_BASELINE);
  for (int level = 0; level < SPORE_CPU_LEVELS; level++) {
    spore_cpu_limit(level);
    g_test_message("%s: %s", spore_cpu_level_name(level), (int)spore_cpu_level() == level ? "tried" : "not here");
    g_assert_cmpint(spore_cpu_level(), <=, level);
  }
}

static void check_values(void) {
  double a[LONGEST], b[LONGEST], y[LONGEST];
  for (size_t n = 0; n <= LONGEST; n++) {
    fill(a);
    fill(b);
    long double sum = 0, size = 0;
    for (size_t i = 0; i < n; i++) sum += (long double)a[i] * b[i], size += fabsl((long double)a[i] * b[i]);
    g_assert_cmpfloat(fabs((double)(sum - spore_vector_dot(n, a, b))), <=, 1e-15 * (double)size);
    memcpy(y, b, sizeof y);
    spore_vector_add_scaled(n, y, 0.3, a);
    for (size_t i = 0; i < LONGEST; i++) g_assert_true(y[i] == (i < n ? b[i] + 0.3 * a[i] : b[i]));
    memcpy(y, b, sizeof y);
    spore_vector_scale_add(n, y, 0.3, a);
    for (size_t i = 0; i < LONGEST; i++) g_assert_true(y[i] == (i < n ? 0.3 * b[i] + a[i] : b[i]));
  }
}

static void check_nodes(void) {
  double a[LONGEST], b[LONGEST], w[LONGEST], y[LONGEST];
  const double g[3] = {0.1, -9.81, 3};
  for (size_t nodes = 0; 3 * nodes <= LONGEST; nodes++) {
    fill(a);
    fill(b);
    fill(w);
    spore_vector_move(3 * nodes, y, a, 0.3, b);
    for (size_t i = 0; i < 3 * nodes; i++) g_assert_true(y[i] == a[i] + 0.3 * b[i]);
    memcpy(y, b, sizeof y);
    spore_nodes_weigh(nodes, y, w, a);
    for (size_t i = 0; i < LONGEST; i++) g_assert_true(y[i] == (i < 3 * nodes ? w[i / 3] * a[i] : b[i]));
    memcpy(y, b, sizeof y);
    spore_nodes_kick(nodes, y, 0.3, a, w);
    for (size_t i = 0; i < LONGEST; i++) g_assert_true(y[i] == (i < 3 * nodes ? b[i] + a[i] * (0.3 / w[i / 3]) : b[i]));
    long double sum = 0;
    for (size_t i = 0; i < LONGEST; i++) w[i] = fabs(w[i]);
    for (size_t i = 0; i < 3 * nodes; i++) sum += (long double)a[i] * a[i] / w[i / 3];
    g_assert_cmpfloat(fabs((double)(sum - spore_nodes_dual(nodes, a, w))), <=, 1e-15 * (double)sum);
    for (size_t i = 0; i < nodes; i++) {
      double weight = w[i], x[LONGEST];
      memcpy(x, a, sizeof x);
      w[i] = x[3 * i] = x[3 * i + 1] = x[3 * i + 2] = 0;
      g_assert_true(isfinite(spore_nodes_dual(nodes, x, w)));
      w[i] = weight;
      x[3 * i + 1] = NAN;
      g_assert_true(isnan(spore_nodes_dual(nodes, x, w)));
    }
    memcpy(y, b, sizeof y);
    spore_nodes_pull(nodes, y, w, g);
    for (size_t i = 0; i < LONGEST; i++) g_assert_true(y[i] == (i < 3 * nodes ? b[i] + w[i / 3] * g[i % 3] : b[i]));
  }
}

/* Rows behind the last node stay as they are. */
static void check_rows(void) {
  enum { NODES = LONGEST / 3 };
  double x0[LONGEST], v0[LONGEST], v[LONGEST], w[LONGEST], x1[LONGEST], v1[LONGEST], rows[4 * NODES];
  const double part = 0.8, h = 0.01, reach = part * h;
  for (size_t nodes = 0; nodes <= NODES; nodes++) {
    fill(x0);
    fill(v0);
    fill(v);
    fill(w);
    memcpy(v1, v, sizeof v);
    for (size_t i = 0; i < 4 * NODES; i++) rows[i] = 7;
    for (size_t i = 0; i < LONGEST; i++) x1[i] = 7;
    const SporeRowsStep step = {part, h, x0, v0, x1, v1};
    spore_rows_predict(nodes, rows, &step, w);
    for (size_t i = 0; i < 3 * NODES; i++) {
      double *row = &rows[i / 3 * 4 + i % 3];
      g_assert_true(*row == (i < 3 * nodes ? x0[i] + reach * (v0[i] + part * (v[i] - v0[i])) : 7));
      if (i < 3 * nodes) *row += 0.1 * w[i];
    }
    for (size_t i = 0; i < NODES; i++) g_assert_true(rows[4 * i + 3] == (i < nodes ? 1 / w[i] : 7));
    spore_rows_follow(nodes, rows, &step);
    for (size_t i = 0; i < LONGEST; i++) {
      double speed = v0[i] + part * (v[i] - v0[i]), moved = i < 3 * nodes ? rows[i / 3 * 4 + i % 3] : 0;
      speed += 1 / reach * (moved - (x0[i] + reach * speed));
      g_assert_true(x1[i] == (i < 3 * nodes ? x0[i] + h * speed : 7));
      g_assert_true(v1[i] == (i < 3 * nodes ? v0[i] + 1 / part * (speed - v0[i]) : v[i]));
    }
  }
}

static void check_within(void) {
  const double bad[] = {NAN, INFINITY, -INFINITY, 2.5, -2.5};
  double x[LONGEST] = {0};
  for (size_t n = 1; n <= LONGEST; n++)
    for (size_t i = 0; i < n; i++) {
      for (size_t k = 0; k < G_N_ELEMENTS(bad); k++) {
        x[i] = bad[k];
        g_assert_false(spore_vector_within(n, x, 2));
        g_assert_true(spore_vector_within(n, x, DBL_MAX) == (isfinite(bad[k]) != 0));
      }
      x[i] = -2;
      g_assert_true(spore_vector_within(n, x, 2));
      x[i] = 0;
    }
}

static void at_each_level(void (*check)(void)) {
  for (int level = 0; level < SPORE_CPU_LEVELS; level++) {
    spore_cpu_limit(level);
    check();
  }
}

static void test_values(void) { at_each_level(check_values); }
static void test_nodes(void) { at_each_level(check_nodes); }
static void test_rows(void) { at_each_level(check_rows); }
static void test_within(void) { at_each_level(check_within); }

static void test_instruction_sets(void) {
  double a[LONGEST], b[LONGEST], y[2][LONGEST];
  for (size_t n = 0; n <= LONGEST; n++) {
    fill(a);
    fill(b);
    double dot = 0;
    for (int level = 0; level < SPORE_CPU_LEVELS; level++) {
      spore_cpu_limit(level);
      double *result = y[level > 0], sum = spore_vector_dot(n, a, b) + spore_nodes_dual(n / 3, a, b);
      memcpy(result, b, sizeof y[0]);
      spore_vector_add_scaled(n, result, 0.7, a);
      spore_vector_scale_add(n, result, -1.3, a);
      if (level == 0) dot = sum;
      g_assert_cmpmem(&dot, sizeof dot, &sum, sizeof sum);
      g_assert_cmpmem(y[0], sizeof y[0], result, sizeof y[0]);
    }
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  random_source = g_rand_new_with_seed(1);
  g_test_add_func("/vector/names", test_names);
  g_test_add_func("/vector/values", test_values);
  g_test_add_func("/vector/nodes", test_nodes);
  g_test_add_func("/vector/rows", test_rows);
  g_test_add_func("/vector/within", test_within);
  g_test_add_func("/vector/instruction-sets", test_instruction_sets);
  int status = g_test_run();
  g_rand_free(random_source);
  return status;
}
