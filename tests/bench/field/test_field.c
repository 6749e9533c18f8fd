/* That the rivals are written well, as a rival written badly would be a lie in our favour. Run before every
 * measurement: forces are minus the gradient of the energy; a spring swings as its closed solution says, to the order
 * of the method; what is solved to its end gives one and the same implicit Euler step; padding and colours lose
 * nothing. */
#include <glib.h>

#include "tests/bench/field/cases.h"

static System *make(const char *name, const char *const words[]) {
  static char *arguments[8] = {"test", "case"};
  int count = 2;
  for (; words && *words; words++) arguments[count++] = (char *)*words;
  CaseRun run = {.argc = count, .argv = arguments};
  System *s = case_system(&run, name);
  g_assert_nonnull(s);
  return s;
}

static void run(System *s, const char *name, Options options, unsigned steps) {
  const Method *method = case_method(name);
  void *state = method->create(s, &options);
  for (unsigned i = 0; i < steps; i++) method->step(state, s);
  method->destroy(state);
}

/* Each node a little aside, always the same way. */
static void shake(System *s, double by) {
  GRand *random = g_rand_new_with_seed(1);
  for (size_t i = 0; i < s->node_count; i++)
    for (int e = 0; e < 3; e++) s->x[i][e] += g_rand_double_range(random, -by, by);
  g_rand_free(random);
}

static void check_gradient(const char *name, const char *const words[], double by) {
  System *s = make(name, words);
  const double h = 1e-6;
  shake(s, by);
  Lanes *f = clear_memory(s->node_count + 1, sizeof *f);
  system_force(s, s->x, s->v, f);
  double worst = 0, largest = 0;
  for (size_t i = 0; i < s->node_count; i += 7)
    for (int e = 0; e < 3; e++) {
      double x = s->x[i][e];
      s->x[i][e] = x + h;
      double more = system_potential(s, s->x);
      s->x[i][e] = x - h;
      double less = system_potential(s, s->x);
      s->x[i][e] = x;
      worst = MAX(worst, fabs(f[i][e] + (more - less) / (2 * h)));
      largest = MAX(largest, fabs(f[i][e]));
    }
  g_test_message("%s: force of up to %g N, %.1e of that beside minus the gradient", name, largest, worst / largest);
  g_assert_cmpfloat(largest, >, 0);
  g_assert_cmpfloat(worst, <, 1e-6 * largest);
  free(f);
  system_free(s);
}

static void test_gradient(void) {
  check_gradient("cloth", NULL, 0.01);
  check_gradient("net", NULL, 0.02); /* some nodes lie in the balls then */
  check_gradient("bar", (const char *const[]){"law=neo_hookean", "poisson_ratio=0.45", NULL}, 0.01);
  check_gradient("bar", (const char *const[]){"law=corotational", "poisson_ratio=0", NULL}, 0.01);
}

/* What a method does with one element alone, in steps so short that only the force counts: its speed after one step is
 * h times the acceleration. Finds a wrong constraint, which no force of system.c would show. */
static void check_push(const char *method, const char *law) {
  System *s = make("bar", (const char *const[]){law, "poisson_ratio=0.45", NULL});
  s->tetrahedron_count = 1;
  shake(s, 0.01);
  Lanes *f = clear_memory(s->node_count + 1, sizeof *f);
  system_force(s, s->x, s->v, f);
  const double h = 1e-6;
  run(s, method, (Options){.step_s = h, .iterations = 3}, 1);
  for (int c = 0; c < 4; c++) {
    uint32_t n = s->tetrahedra[0].corner[c];
    for (int e = 0; e < 3; e++) {
      double expected = s->x[n][3] * f[n][e] + s->acceleration[n][e], found = s->v[n][e] / h;
      g_assert_cmpfloat(fabs(found - expected), <, 1e-3 * fabs(expected) + 1);
    }
  }
  free(f);
  system_free(s);
}

static void test_push(void) {
  check_push("xpbd", "law=neo_hookean");
  check_push("vbd", "law=neo_hookean");
  check_push("pd", "law=corotational");
}

/* A mass on one spring along x, drawn out: x = L + a cos(w t). */
static double swing_error(const char *method, unsigned iterations, unsigned steps) {
  const double length = 0.5, out = 0.1, k = 100, mass = 0.25, time = 0.4;
  System *s = system_new(2, 1, 0);
  s->x[1] = (Lanes){length, 0, 0, 0};
  s->springs[0] = (Spring){.a = 0, .b = 1, .stiffness = k};
  s->mass[1] = mass;
  system_rest(s, 0);
  system_finish(s);
  s->acceleration[1] = lanes(0);
  s->x[1][0] = length + out;
  run(s, method, (Options){.step_s = time / steps, .iterations = iterations}, steps);
  double error = fabs(s->x[1][0] - length - out * cos(sqrt(k / mass) * time)) / out;
  system_free(s);
  return error;
}

static void check_swing(const char *method, unsigned iterations, double order) {
  double coarse = swing_error(method, iterations, 400), fine = swing_error(method, iterations, 800);
  double found = log2(coarse / fine);
  g_test_message("%s, %u iterations: error %.2e, then %.2e in half the step: order %.2f", method, iterations, coarse,
                 fine, found);
  g_assert_cmpfloat(fabs(found - order), <, 0.1);
  g_assert_cmpfloat(fine, <, 0.05);
}

static void test_swing(void) {
  check_swing("xpbd", 1, 1);
  check_swing("vbd", 1, 1);
  check_swing("pd", 1, 1);
  check_swing("rk4", 1, 4);
}

/* Root mean square of the distances between nodes. */
static double apart(const System *a, const System *b) {
  double sum = 0;
  for (size_t i = 0; i < a->node_count; i++)
    for (int e = 0; e < 3; e++) sum += (a->x[i][e] - b->x[i][e]) * (a->x[i][e] - b->x[i][e]);
  return sqrt(sum / (double)a->node_count);
}

/* Two methods that solve the same step differ by no more than they leave unsolved. */
static void check_same(const char *name, const char *const words[], const char *const method[2],
                       const unsigned iterations[2], double step_s, unsigned steps, double bound) {
  System *a = make(name, words), *b = make(name, words), *start = make(name, words);
  run(a, method[0], (Options){.step_s = step_s, .iterations = iterations[0]}, steps);
  run(b, method[1], (Options){.step_s = step_s, .iterations = iterations[1]}, steps);
  double way = apart(a, start), difference = apart(a, b);
  g_test_message("%s: %s and %s, %u steps of %g s: %.2g m on the way, %.2g of it apart", name, method[0], method[1],
                 steps, step_s, way, difference / way);
  g_assert_cmpfloat(way, >, 0);
  g_assert_cmpfloat(difference, <, bound * way);
  system_free(a), system_free(b), system_free(start);
}

static void test_implicit_euler(void) {
  const char *const descent_and_projection[2] = {"vbd", "pd"};
  check_same("cloth", NULL, descent_and_projection, (const unsigned[2]){300, 300}, 0.01, 10, 1e-6);
  /* Across itself the net is softer than the constant matrix takes it to be. */
  check_same("net", NULL, descent_and_projection, (const unsigned[2]){300, 600}, 0.01, 8, 1e-4);
}

/* How far from the fourth-order method, as a part of the way, in so many steps over the same time. */
static double distance_left(const char *name, const char *const words[], const char *method, unsigned iterations,
                            double time_s, unsigned steps, const System *exact) {
  System *s = make(name, words), *start = make(name, words);
  run(s, method, (Options){.step_s = time_s / steps, .iterations = iterations}, steps);
  double left = apart(s, exact) / apart(exact, start);
  system_free(s), system_free(start);
  return left;
}

static void check_limit(const char *name, const char *const words[], const char *method, unsigned iterations,
                        double time_s, unsigned steps) {
  System *exact = make(name, words);
  run(exact, "rk4", (Options){.step_s = time_s / (2 * steps)}, 2 * steps);
  double coarse = distance_left(name, words, method, iterations, time_s, steps, exact);
  double fine = distance_left(name, words, method, iterations, time_s, 2 * steps, exact);
  g_test_message("%s: %s, error %.2e of the way, %.2e in half the step", name, method, coarse, fine);
  g_assert_cmpfloat(coarse, <, 0.03);
  g_assert_cmpfloat(fabs(log2(coarse / fine) - 1), <, 0.2);
  system_free(exact);
}

/* All come to what the fourth-order method gives, at first order. */
static void test_limit(void) {
  const char *const neo_hookean[] = {"law=neo_hookean", "poisson_ratio=0.45", NULL}, *const corotational[] = {
                                                                                         "law=corotational",
                                                                                         "poisson_ratio=0", NULL};
  const char *const of_springs[] = {"cloth", "net"};
  for (int i = 0; i < 2; i++) {
    check_limit(of_springs[i], NULL, "xpbd", 1, 0.12, 300);
    check_limit(of_springs[i], NULL, "vbd", 3, 0.12, 300);
    check_limit(of_springs[i], NULL, "pd", 3, 0.12, 300);
  }
  check_limit("bar", neo_hookean, "xpbd", 1, 0.01, 50);
  check_limit("bar", neo_hookean, "vbd", 3, 0.01, 50);
  check_limit("bar", corotational, "pd", 3, 0.01, 50);
}

static void test_logarithm(void) {
  for (double x = 1e-3; x < 1e3; x *= 1.01) {
    Lanes found = lanes_log((Lanes){x, 1, 4, 1 / x});
    g_assert_cmpfloat(fabs(found[0] - log(x)), <, 1e-14 * MAX(1, fabs(log(x))));
    g_assert_cmpfloat(fabs(found[3] + log(x)), <, 1e-14 * MAX(1, fabs(log(x))));
    g_assert_cmpfloat(found[1], ==, 0);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/field/logarithm", test_logarithm);
  g_test_add_func("/field/gradient", test_gradient);
  g_test_add_func("/field/push", test_push);
  g_test_add_func("/field/swing", test_swing);
  g_test_add_func("/field/implicit_euler", test_implicit_euler);
  g_test_add_func("/field/limit", test_limit);
  return g_test_run();
}
