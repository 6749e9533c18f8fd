/* What helps where Newton's method creeps: differences of the last steps, and the search into a switch. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/nonlinear/differences.h"
#include "core/nonlinear/line_search.h"

#define N 6

static void weigh(void *data, const double *x, double *y) { memcpy(y, x, N * sizeof *x); }

/* x -> g = B (answer - x), B diagonal with three values: three differences tell all of it. */
static void step_at(const double *answer, const double *x, double *g) {
  static const double b[N] = {1, 0.2, 0.05, 1, 0.2, 0.05};
  for (int i = 0; i < N; i++) g[i] = b[i] * (answer[i] - x[i]);
}

static double walk(int steps, gboolean forget) {
  const double answer[N] = {1, -2, 3, -4, 5, -6};
  double scratch[SPORE_DIFFERENCES_SCRATCH * N], x[N] = {0}, g[N], d[N];
  SporeSystem system = {.count = N, .weigh = weigh};
  SporeDifferences differences;
  spore_differences_begin(&differences, &system, scratch);
  for (int k = 0; k < steps; k++) {
    step_at(answer, x, g);
    if (forget) spore_differences_forget(&differences);
    spore_differences_meet(&differences, g);
    spore_differences_accelerate(&differences, g, d);
    for (int i = 0; i < N; i++) x[i] += d[i];
    spore_differences_leave(&differences, g, 1, d);
  }
  double worst = 0;
  for (int i = 0; i < N; i++) worst = fmax(worst, fabs(x[i] - answer[i]));
  return worst;
}

/* A linear system of three values is solved in a few steps with differences, and creeps without. */
static void test_differences(void) {
  g_assert_cmpfloat(walk(5, FALSE), <, 1e-9);
  g_assert_cmpfloat(walk(5, TRUE), >, 4);
}

/* More steps than are kept: the ring goes round, and what is spanned already does no harm. */
static void test_ring(void) { g_assert_cmpfloat(walk(3 * SPORE_DIFFERENCES, FALSE), <, 1e-9); }

/* Dry friction on a weak spring: r = 1 - soft x - force, where the force turns from -1 to 1 at x = `at`, over `wide`.
 */
typedef struct Dry {
  double soft, at, wide, turn;
} Dry;

static void dry_residual(void *data, const double *x, double *r) {
  const Dry *dry = data;
  r[0] = 1 - dry->soft * x[0] - dry->turn * fmin(fmax((x[0] - dry->at) / dry->wide, 0), 1);
}

/* Across the line, something is left whatever the length is. */
static double dry_norm(void *data, const double *r) { return hypot(r[0], 0.8); }

static double search(Dry *dry, gboolean switches, double *norm) {
  double x = 0, d = 1, r, trial, trial_r;
  size_t evaluations = 0;
  SporeSystem system = {.data = dry, .count = 1, .switches = switches, .residual = dry_residual, .norm = dry_norm};
  dry_residual(dry, &x, &r);
  return spore_line_search(&system, &x, &d, &r, dry_norm(dry, &r), false, HUGE_VAL, &trial, &trial_r, norm,
                           &evaluations);
}

/* The full step goes past the switch: the search ends inside it, unless the system has none. */
static void test_switch(void) {
  Dry dry = {.soft = 0.3, .at = 0.4, .wide = 0.1, .turn = 1.19};
  double norm, length = search(&dry, TRUE, &norm);
  g_test_message("ended at %.3f, the switch lies between %.3f and %.3f", length, dry.at, dry.at + dry.wide);
  g_assert_true(length >= dry.at && length <= dry.at + dry.wide);
  g_assert_cmpfloat(search(&dry, FALSE, &norm), ==, 1);
}

/* Where nothing has fallen in excess of the promise, the full step stands. */
static void test_no_switch(void) {
  Dry dry = {.soft = 1, .at = 10, .wide = 0.1, .turn = 1};
  double norm;
  g_assert_cmpfloat(search(&dry, TRUE, &norm), ==, 1);
}

/* r = 1 - x by an A four times too stiff, so that each step leaves three quarters, and by what calls itself the whole
 * and leads uphill. */
typedef struct Creeping {
  gboolean lost; /* A leads uphill, too, but at the guess */
  int whole, plain;
} Creeping;

static void creeping_residual(void *data, const double *x, double *r) { r[0] = 1 - x[0]; }
static double creeping_norm(void *data, const double *r) { return fabs(r[0]); }
static double creeping_dot(void *data, const double *a, const double *b) { return a[0] * b[0]; }
static double creeping_rounding(void *data, const double *x, bool stiff_axes) { return 0; }
static void creeping_linearise(void *data, const double *x, const double *from) {}

static SporeLinearResult creeping_solve(void *data, const double *r, double tolerance, double *dx) {
  Creeping *creeping = data;
  dx[0] = creeping->plain++ > 0 && creeping->lost ? -r[0] : r[0] / 4;
  return (SporeLinearResult){SPORE_LINEAR_CONVERGED, 1, 0};
}

static SporeLinearResult creeping_whole(void *data, const double *r, double tolerance, double *dx) {
  ((Creeping *)data)->whole++;
  dx[0] = -r[0];
  return (SporeLinearResult){SPORE_LINEAR_CONVERGED, 1, 0};
}

static SporeNonlinearResult creep(Creeping *creeping) {
  double x = 0, r = 1, scratch[SPORE_NEWTON_SCRATCH];
  SporeSystem system = {.data = creeping,
                        .count = 1,
                        .switches = true,
                        .residual = creeping_residual,
                        .linearise = creeping_linearise,
                        .solve = creeping_solve,
                        .solve_whole = creeping_whole,
                        .dot = creeping_dot,
                        .norm = creeping_norm,
                        .scale_x = 1,
                        .scale_r = 1,
                        .rounding = creeping_rounding};
  return spore_newton(&system, &(SporeNonlinearOptions){.iterations = 60, .tolerance = 0.01}, &x, &r, scratch);
}

/* Where the whole Jacobian leads nowhere, A goes on; where A does not either, the method ends. */
static void test_fall_back(void) {
  Creeping creeping = {0};
  SporeNonlinearResult result = creep(&creeping);
  g_test_message("%zu iterations, %d by the whole", result.iterations, creeping.whole);
  g_assert_true(result.converged);
  g_assert_cmpint(creeping.whole, >, 0);
  creeping = (Creeping){.lost = TRUE};
  result = creep(&creeping);
  g_assert_false(result.converged);
  g_assert_cmpuint(result.iterations, ==, 1);
  g_assert_cmpint(creeping.plain, ==, 2);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/creep/differences", test_differences);
  g_test_add_func("/creep/ring", test_ring);
  g_test_add_func("/creep/switch", test_switch);
  g_test_add_func("/creep/no-switch", test_no_switch);
  g_test_add_func("/creep/fall-back", test_fall_back);
  return g_test_run();
}
