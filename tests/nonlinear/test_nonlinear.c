/* Newton and Broyden on systems whose answers are known. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/nonlinear/system.h"

#define N 30

/* r_i = b_i - (x_i + strength x_i^3) - coupling of neighbours: the gradient of a convex function, negated. */
typedef struct Cubic {
  double b[N], strength, coupling;
  double diagonal[N]; /* of A, at the last linearisation */
  bool may_reuse;
  double stale_factor; /* how wrong the linearisation that may be used again is */
  int linearisations, evaluations;
} Cubic;

static void residual(void *data, const double *x, double *r) {
  Cubic *cubic = data;
  cubic->evaluations++;
  for (int i = 0; i < N; i++) {
    double sides = 2 * x[i] - (i > 0 ? x[i - 1] : 0) - (i < N - 1 ? x[i + 1] : 0);
    r[i] = cubic->b[i] - x[i] - cubic->strength * x[i] * x[i] * x[i] - cubic->coupling * sides;
  }
}

static void fill(Cubic *cubic, const double *x, double factor) {
  for (int i = 0; i < N; i++)
    cubic->diagonal[i] = factor * (1 + 3 * cubic->strength * x[i] * x[i] + 2 * cubic->coupling);
}

static void linearise(void *data, const double *x, const double *from) {
  Cubic *cubic = data;
  cubic->linearisations++;
  fill(cubic, x, 1);
}

static bool reuse(void *data, const double *x) {
  Cubic *cubic = data;
  if (cubic->may_reuse) fill(cubic, x, cubic->stale_factor);
  return cubic->may_reuse;
}

static void multiply(void *data, const double *x, double *y) {
  Cubic *cubic = data;
  for (int i = 0; i < N; i++)
    y[i] = cubic->diagonal[i] * x[i] - cubic->coupling * ((i > 0 ? x[i - 1] : 0) + (i < N - 1 ? x[i + 1] : 0));
}

static void precondition(void *data, const double *r, double *z) {
  Cubic *cubic = data;
  for (int i = 0; i < N; i++) z[i] = r[i] / cubic->diagonal[i];
}

static SporeLinearResult solve(void *data, const double *r, double tolerance, double *dx) {
  double scratch[SPORE_PCG_SCRATCH * N];
  SporeLinearOperator operator= {data, N, multiply, precondition};
  return spore_pcg(&operator, r, tolerance, 500, dx, scratch);
}

static SporeLinearResult approximate(void *data, const double *r, double *dx) { return solve(data, r, 1e-3, dx); }
static double linearisation_cost(void *data) { return 3; }
static void weigh(void *data, const double *x, double *y) { memcpy(y, x, N * sizeof *x); }

static double dot(void *data, const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < N; i++) sum += a[i] * b[i];
  return sum;
}

static double norm(void *data, const double *r) { return sqrt(dot(data, r, r)); }
static double rounding(void *data, const double *x, bool stiff_axes) { return 1e-15; }

static double coarse_rounding(void *data, const double *x, bool stiff_axes) { return stiff_axes ? 1e-4 : 1e-15; }

static SporeSystem make(Cubic *cubic) {
  for (int i = 0; i < N; i++) cubic->b[i] = 3 * sin(i * 0.7) + 1;
  return (SporeSystem){.data = cubic,
                       .count = N,
                       .residual = residual,
                       .linearise = linearise,
                       .reuse = reuse,
                       .solve = solve,
                       .approximate = approximate,
                       .linearisation_cost = linearisation_cost,
                       .dot = dot,
                       .weigh = weigh,
                       .norm = norm,
                       .rounding = rounding};
}

typedef SporeNonlinearResult Solver(const SporeSystem *system, const SporeNonlinearOptions *options, double *x,
                                    double *r, double *scratch);

/* The guess's residual counts as an evaluation too. */
static SporeNonlinearResult run(Solver solver, const SporeSystem *system, const SporeNonlinearOptions *options,
                                double *x, double *scratch) {
  double r[N];
  system->residual(system->data, x, r);
  SporeNonlinearResult result = solver(system, options, x, r, scratch);
  result.evaluations++;
  return result;
}

static SporeNonlinearResult newton(const SporeSystem *system, const SporeNonlinearOptions *options, double *x,
                                   double *scratch) {
  return run(spore_newton, system, options, x, scratch);
}

static SporeNonlinearResult broyden(const SporeSystem *system, const SporeNonlinearOptions *options, double *x,
                                    double *scratch) {
  return run(spore_broyden, system, options, x, scratch);
}

static void test_newton(void) {
  Cubic cubic = {.strength = 5, .coupling = 2};
  SporeSystem system = make(&cubic);
  SporeNonlinearOptions options = {50, 1e-10};
  double x[N] = {0}, r[N], scratch[SPORE_NEWTON_SCRATCH * N];
  SporeNonlinearResult result = newton(&system, &options, x, scratch);
  g_assert_true(result.converged);
  g_assert_true(result.finite);
  g_assert_false(result.indefinite);
  g_assert_cmpuint(result.iterations, <, 12);
  g_assert_cmpint((int)result.evaluations, ==, cubic.evaluations);
  g_assert_cmpint((int)result.linearisations, ==, cubic.linearisations);
  residual(&cubic, x, r);
  g_assert_cmpfloat(norm(NULL, r), <, 1e-9 * norm(NULL, cubic.b));
}

/* Rounding along stiff axes stops nobody, but counts at the end. */
static void test_rounding(void) {
  bool reached = false;
  for (size_t iterations = 1; !reached; iterations++) {
    Cubic cubic = {.strength = 5, .coupling = 2};
    SporeSystem system = make(&cubic);
    system.rounding = coarse_rounding;
    SporeNonlinearOptions options = {iterations, 1e-10};
    double x[N] = {0}, r[N], scratch[SPORE_NEWTON_SCRATCH * N];
    SporeNonlinearResult result = newton(&system, &options, x, scratch);
    residual(&cubic, x, r);
    reached = norm(NULL, r) <= 1e-4;
    g_assert_cmpuint(result.iterations, ==, iterations);
    g_assert_cmpint(result.converged, ==, reached);
  }
}

static double hopeless_rounding(void *data, const double *x, bool stiff_axes) { return 1e6; }

/* As if x had few digits. */
static void coarse_residual(void *data, const double *x, double *r) {
  double rounded[N];
  for (int i = 0; i < N; i++) rounded[i] = round(x[i] * 1e3) * 1e-3;
  residual(data, rounded, r);
}

/* An estimate of rounding is not believed: where the residual still falls, the iteration goes on, and solves. Where it
 * has ceased to fall, the iteration ends at the least residual, and says how much that is. */
static void test_hopeless(void) {
  Solver *solvers[] = {spore_newton, spore_broyden};
  for (size_t s = 0; s < G_N_ELEMENTS(solvers); s++) {
    Cubic cubic = {.strength = 5, .coupling = 2};
    SporeSystem system = make(&cubic);
    system.rounding = hopeless_rounding;
    SporeNonlinearOptions options = {50, 1e-10};
    double x[N] = {0}, r[N];
    static double scratch[SPORE_BROYDEN_SCRATCH * N];
    SporeNonlinearResult result = run(solvers[s], &system, &options, x, scratch);
    g_assert_true(result.converged);
    g_assert_cmpfloat(result.residual, <=, 1e-10);
    memset(x, 0, sizeof x);
    system.residual = coarse_residual;
    result = run(solvers[s], &system, &options, x, scratch);
    g_assert_true(result.converged);
    g_assert_cmpuint(result.iterations, <, 20);
    g_assert_cmpfloat(result.residual, >, 1e-6);
    g_assert_cmpfloat(result.residual, <, 0.1);
    coarse_residual(&cubic, x, r);
    g_assert_cmpfloat(norm(NULL, r), ==, result.residual * result.load);
  }
}

/* From far away full steps overshoot: the line search brings it home. */
static void test_line_search(void) {
  Cubic cubic = {.strength = 100, .coupling = 0.1};
  SporeSystem system = make(&cubic);
  SporeNonlinearOptions options = {100, 1e-10};
  double x[N], scratch[SPORE_NEWTON_SCRATCH * N];
  for (int i = 0; i < N; i++) x[i] = i % 2 ? 1e4 : -1e4;
  SporeNonlinearResult result = newton(&system, &options, x, scratch);
  g_assert_true(result.converged);
}

static void solve_by_broyden(Cubic *cubic, double *x, SporeNonlinearResult *result) {
  SporeSystem system = make(cubic);
  SporeNonlinearOptions options = {60, 1e-10};
  static double scratch[SPORE_BROYDEN_SCRATCH * N];
  memset(x, 0, N * sizeof *x);
  *result = broyden(&system, &options, x, scratch);
}

static void test_broyden(void) {
  Cubic newton_cubic = {.strength = 5, .coupling = 2}, cubic = newton_cubic;
  SporeSystem system = make(&newton_cubic);
  SporeNonlinearOptions options = {50, 1e-10};
  double exact[N] = {0}, x[N], scratch[SPORE_NEWTON_SCRATCH * N];
  SporeNonlinearResult direct = newton(&system, &options, exact, scratch), result;
  g_assert_true(direct.converged);
  solve_by_broyden(&cubic, x, &result);
  g_assert_true(result.converged);
  for (int i = 0; i < N; i++) g_assert_cmpfloat_with_epsilon(x[i], exact[i], 1e-8);
}

/* A linearisation that is twice too stiff: its updates make up for it, without a new one. */
static void test_broyden_stale(void) {
  Cubic cubic = {.strength = 0.05, .coupling = 0.05, .may_reuse = true, .stale_factor = 1.6};
  double x[N], r[N];
  SporeNonlinearResult result;
  solve_by_broyden(&cubic, x, &result);
  g_assert_true(result.converged);
  residual(&cubic, x, r);
  g_assert_cmpfloat(norm(NULL, r), <, 1e-9 * norm(NULL, cubic.b));
  g_assert_cmpint(cubic.linearisations, <=, 1);
  /* Without updates each iteration would leave 0.6 / 1.6 of the error: 24 iterations to 1e-10. */
  g_assert_cmpuint(result.iterations, <, 15);
}

/* Far too soft a one does not contract: it is renewed. */
static void test_broyden_renews(void) {
  Cubic cubic = {.strength = 5, .coupling = 2, .may_reuse = true, .stale_factor = 40};
  double x[N];
  SporeNonlinearResult result;
  solve_by_broyden(&cubic, x, &result);
  g_assert_true(result.converged);
  g_assert_cmpint(cubic.linearisations, >=, 1);
}

static void test_bad(void) {
  Cubic cubic = {.strength = 5, .coupling = 2};
  SporeSystem system = make(&cubic);
  SporeNonlinearOptions options = {50, 1e-10};
  double x[N] = {0}, scratch[SPORE_BROYDEN_SCRATCH * N];
  cubic.b[3] = NAN;
  SporeNonlinearResult result = newton(&system, &options, x, scratch);
  g_assert_false(result.converged);
  g_assert_false(result.finite);
  result = broyden(&system, &options, x, scratch);
  g_assert_false(result.converged);
  g_assert_false(result.finite);
  system = make(&cubic);
  options.iterations = 1;
  memset(x, 0, sizeof x);
  result = newton(&system, &options, x, scratch);
  g_assert_false(result.converged);
  g_assert_true(result.finite);
  g_assert_cmpfloat(result.residual, >, 1e-10);
  for (int i = 0; i < N; i++) g_assert_true(isfinite(x[i]));
}

/* The guess is the answer: nothing to do. */
static void test_solved_already(void) {
  Cubic cubic = {.strength = 5, .coupling = 2};
  SporeSystem system = make(&cubic);
  memset(cubic.b, 0, sizeof cubic.b);
  SporeNonlinearOptions options = {50, 1e-10};
  double x[N] = {0}, scratch[SPORE_NEWTON_SCRATCH * N];
  SporeNonlinearResult result = newton(&system, &options, x, scratch);
  g_assert_true(result.converged);
  g_assert_cmpuint(result.iterations, ==, 0);
  g_assert_cmpfloat(result.residual, ==, 0);
}

/* A weight of 1 on a stiff spring of rest length 1 about the origin, not under it: a full step leaves the circle and
 * stretches the spring by far more than any force there was. */
typedef struct Pendulum {
  double stiffness, a[3]; /* of the matrix: xx, xy, yy */
} Pendulum;

static void pull(void *data, const double *x, double *r) {
  Pendulum *pendulum = data;
  double length = hypot(x[0], x[1]), pull = pendulum->stiffness * (1 - 1 / length);
  r[0] = -pull * x[0];
  r[1] = -pull * x[1] - 1;
}

static void pull_matrix(void *data, const double *x, const double *from) {
  Pendulum *pendulum = data;
  double length = hypot(x[0], x[1]), c = x[0] / length, s = x[1] / length;
  double across = pendulum->stiffness * fmax(1 - 1 / length, 0), along = pendulum->stiffness - across;
  pendulum->a[0] = 1e-3 + across + along * c * c;
  pendulum->a[1] = along * c * s;
  pendulum->a[2] = 1e-3 + across + along * s * s;
}

static SporeLinearResult pull_solve(void *data, const double *r, double tolerance, double *dx) {
  const double *a = ((Pendulum *)data)->a;
  double determinant = a[0] * a[2] - a[1] * a[1];
  dx[0] = (a[2] * r[0] - a[1] * r[1]) / determinant;
  dx[1] = (a[0] * r[1] - a[1] * r[0]) / determinant;
  return (SporeLinearResult){SPORE_LINEAR_CONVERGED, 1, 0};
}

static double pull_dot(void *data, const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1]; }
static double pull_norm(void *data, const double *r) { return hypot(r[0], r[1]); }

static void test_stiff_path(void) {
  for (int decade = 2; decade <= 8; decade++) {
    Pendulum pendulum = {.stiffness = pow(10, decade)};
    SporeSystem system = {.data = &pendulum,
                          .count = 2,
                          .residual = pull,
                          .linearise = pull_matrix,
                          .solve = pull_solve,
                          .dot = pull_dot,
                          .norm = pull_norm,
                          .scale_x = 1,
                          .scale_r = 1,
                          .rounding = rounding};
    SporeNonlinearOptions options = {20, 1e-8};
    double length = 1 + 1 / pendulum.stiffness; /* it pulls with the weight already */
    double x[2] = {length * sin(0.3), -length * cos(0.3)}, scratch[SPORE_NEWTON_SCRATCH * 2];
    SporeNonlinearResult result = newton(&system, &options, x, scratch);
    g_test_message("stiffness 1e%d: %zu iterations, residual %.1e, at (%.2e, %.6f)", decade, result.iterations,
                   result.residual, x[0], x[1]);
    g_assert_true(result.converged);
    g_assert_cmpfloat_with_epsilon(x[0], 0, 1e-6);
    g_assert_cmpfloat_with_epsilon(x[1], -1 - 1 / pendulum.stiffness, 1e-6);
  }
}

/* A guess within the tolerance of what there is to solve takes no iteration, and is as near to the answer as was asked
 * for; one just outside is solved, and so is one where no size of load or change is known. */
static void test_good_guess(void) {
  const double tolerance = 1e-3;
  for (int i = 0; i < 8; i++) {
    Solver *solver = i % 2 ? spore_broyden : spore_newton;
    Cubic cubic = {.strength = 5, .coupling = 2};
    SporeSystem system = make(&cubic);
    double exact[N] = {0}, x[N], r[N], scratch[SPORE_BROYDEN_SCRATCH * N], load = norm(NULL, cubic.b);
    g_assert_true(newton(&system, &(SporeNonlinearOptions){50, 1e-13}, exact, scratch).converged);
    memcpy(x, exact, sizeof x);
    x[N / 2] += 1e-6;
    residual(&cubic, x, r);
    double wanted = norm(NULL, r) / tolerance, further = 0;
    system.scale_r = i == 4 || i == 5 ? 0 : wanted * (i < 2 ? 1.01 : 0.99);
    system.scale_x = i >= 6 ? 0 : load;
    SporeNonlinearResult result = run(solver, &system, &(SporeNonlinearOptions){50, tolerance}, x, scratch);
    g_assert_true(result.converged);
    g_assert_cmpint(result.iterations == 0, ==, i < 2);
    g_assert_cmpint(result.linearisations == 0, ==, i < 2);
    for (int k = 0; k < N; k++) further += (x[k] - exact[k]) * (x[k] - exact[k]);
    g_assert_cmpfloat(sqrt(further), <=, i < 2 ? norm(NULL, r) : 1e-7); /* a tenth of what the guess missed */
    if (i < 2) g_assert_cmpfloat(fabs(result.residual / tolerance - 1 / 1.01), <, 1e-9);
  }
}

/* A force that is no load, whatever the guess is: a residual within tolerance of that is solved, though nothing else
 * loads the system; one just outside is not, and is told against it as long as it is less. */
static void test_least(void) {
  const double tolerance = 1e-3;
  Solver *solvers[] = {spore_newton, spore_broyden};
  for (size_t s = 0; s < G_N_ELEMENTS(solvers); s++) {
    for (int inside = 0; inside < 2; inside++) {
      Cubic cubic = {.strength = 5, .coupling = 2};
      SporeSystem system = make(&cubic);
      double x[N] = {0}, r[N];
      static double scratch[SPORE_BROYDEN_SCRATCH * N];
      residual(&cubic, x, r);
      system.least = norm(NULL, r) / tolerance * (inside ? 1.01 : 0.99);
      SporeNonlinearResult result = run(solvers[s], &system, &(SporeNonlinearOptions){50, tolerance}, x, scratch);
      g_assert_true(result.converged);
      g_assert_cmpint(result.iterations == 0, ==, inside);
      g_assert_cmpfloat(result.load, ==, system.least);
      residual(&cubic, x, r);
      g_assert_cmpfloat_with_epsilon(result.residual, norm(NULL, r) / system.least, 1e-12);
      g_assert_cmpfloat(result.residual, <=, tolerance);
    }
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/nonlinear/newton", test_newton);
  g_test_add_func("/nonlinear/rounding", test_rounding);
  g_test_add_func("/nonlinear/hopeless", test_hopeless);
  g_test_add_func("/nonlinear/line-search", test_line_search);
  g_test_add_func("/nonlinear/broyden", test_broyden);
  g_test_add_func("/nonlinear/broyden-stale", test_broyden_stale);
  g_test_add_func("/nonlinear/broyden-renews", test_broyden_renews);
  g_test_add_func("/nonlinear/stiff-path", test_stiff_path);
  g_test_add_func("/nonlinear/bad", test_bad);
  g_test_add_func("/nonlinear/solved-already", test_solved_already);
  g_test_add_func("/nonlinear/good-guess", test_good_guess);
  g_test_add_func("/nonlinear/least", test_least);
  return g_test_run();
}
