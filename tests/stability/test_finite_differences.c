/* Finite differences on a regular grid against closed and manufactured solutions: the order of convergence in space and
 * time, bending, and what is refused. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/linalg/block_cholesky.h"
#include "tests/stability/rig.h"

#define YOUNG 1e5
#define POISSON 0.3
#define DENSITY 1000.0

/* A linear static problem of a model at rest: some nodes are held where they are put, the others loaded. */
typedef struct Linear {
  SporeModel *model;
  size_t n;
  double *x; /* n x 3: places at rest, m */
  SporeBlockMatrix matrix;
  guint8 *held;
  double *u, *load; /* 3 n: displacement, m, given where held; N */
} Linear;

static SporeModel *grid_model(SporeTriangleMesh *surface, unsigned cells, double poisson) {
  return rig_surface_model(&spore_finite_differences, surface, "cells", (double)cells, "young_modulus", YOUNG,
                           "poisson_ratio", poisson, "density", DENSITY, "stiffness_damping", 0.0, NULL);
}

static Linear linear_new(SporeModel *model) {
  Linear linear = {.model = model, .n = model->node_count};
  const SporeVec3 still = {0, 0, 0};
  double *v = g_new0(double, 3 * linear.n);
  linear.x = g_new0(double, 3 * linear.n), linear.u = g_new0(double, 3 * linear.n);
  linear.load = g_new0(double, 3 * linear.n), linear.held = g_new0(guint8, linear.n);
  model->type->place(model, spore_pose_identity(), still, still, linear.x, v);
  g_assert_true(spore_model_matrix_create(model, &linear.matrix));
  model->type->jacobian(model, linear.x, linear.x, v, 1, 0, &linear.matrix);
  g_free(v);
  return linear;
}

static void linear_free(Linear *linear) {
  linear->model->type->destroy(linear->model);
  spore_block_matrix_clear(&linear->matrix);
  g_free(linear->x);
  g_free(linear->u);
  g_free(linear->load);
  g_free(linear->held);
}

static void linear_solve(Linear *linear) {
  SporeBlockCholesky factor;
  double *f = g_new0(double, 3 * linear->n);
  spore_block_matrix_multiply_add(&linear->matrix, linear->u, f);
  for (size_t i = 0; i < 3 * linear->n; i++) f[i] = linear->held[i / 3] ? 0 : linear->load[i] - f[i];
  g_assert_true(spore_block_cholesky_create(&factor, &linear->matrix, SPORE_FACTOR_AUTOMATIC, HUGE_VAL, NULL));
  g_assert_true(spore_block_cholesky_factorise(&factor, &linear->matrix, NULL, linear->held, false));
  spore_block_cholesky_solve(&factor, f, f);
  for (size_t i = 0; i < 3 * linear->n; i++) linear->u[i] += f[i];
  spore_block_cholesky_clear(&factor);
  g_free(f);
}

/* Order from errors on grids, each twice as fine as the one before: from the last two. */
static double order_of(const double *error, unsigned levels) { return log2(error[levels - 2] / error[levels - 1]); }

/* The bar of numerics.md: 1 x 0.2 x 0.2 m, clamped at x = 0, 0.1 N down over the face at the tip. */
static double cantilever(unsigned along, double poisson) {
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0.5, 0.1, 0.1), spore_vec3(1, 0.2, 0.2));
  Linear bar = linear_new(grid_model(&box, along, poisson));
  double shares = 0, tip = 0;
  for (int pass = 0; pass < 2; pass++)
    for (size_t i = 0; i < bar.n; i++) {
      const double *x = bar.x + 3 * i;
      double share = 1;
      bar.held[i] = x[0] < 1e-9;
      if (x[0] < 1 - 1e-9) continue;
      for (int k = 1; k < 3; k++) share *= fabs(x[k] - 0.1) > 0.1 - 1e-9 ? 0.5 : 1;
      if (pass == 0) shares += share;
      else bar.load[3 * i + 1] = -0.1 * share / shares;
    }
  linear_solve(&bar);
  for (size_t i = 0; i < bar.n; i++) tip += bar.load[3 * i + 1] * bar.u[3 * i + 1] / 0.1;
  linear_free(&bar);
  return tip;
}

/* References: numerics.md at 0.3, test_locking.c from 0.499 on. */
static void bending(void) {
  static const double ratios[] = {0.3, 0.499, 0.49999}, references[] = {2.54e-3, 2.497e-3, 2.497e-3};
  static const double most[] = {0.3, 0.03, 0.02}; /* with 1, 2 and 4 cells across */
  for (unsigned r = 0; r < G_N_ELEMENTS(ratios); r++)
    for (unsigned level = 0, along = 5; level < 3; level++, along *= 2) {
      double tip = cantilever(along, ratios[r]), error = tip / references[r] - 1;
      g_test_message("cantilever %u x %u^2, nu %g: tip %.5e m (%+.2f %%)", along, along / 5, ratios[r], tip,
                     100 * error);
      g_assert_cmpfloat(fabs(error), <, most[level]);
    }
}

/* u = sum of waves d sin(k.x + phase), with the force that it takes: (lambda + mu) k (k.d) + mu |k|^2 d. */
typedef struct Wave {
  SporeVec3 along, k;
  double phase;
} Wave;
static const Wave waves[] = {{{1, 0.4, -0.3}, {9, 4, -6}, 0.3}, {{-0.2, 0.7, 0.5}, {-5, 8, 3}, 1.1}};

static SporeVec3 manufactured(SporeVec3 x, SporeVec3 *force) {
  double mu = YOUNG / (2 * (1 + POISSON)), lambda = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON));
  SporeVec3 u = {0, 0, 0};
  *force = u;
  for (unsigned w = 0; w < G_N_ELEMENTS(waves); w++) {
    SporeVec3 d = waves[w].along, k = waves[w].k;
    double s = sin(spore_vec3_dot(k, x) + waves[w].phase);
    u = spore_vec3_add_scaled(u, s, d);
    *force = spore_vec3_add_scaled(*force, s * (lambda + mu) * spore_vec3_dot(k, d), k);
    *force = spore_vec3_add_scaled(*force, s * mu * spore_vec3_dot(k, k), d);
  }
  return u;
}

/* Root of the mean square of the displacement's error over that of the displacement. */
static double manufactured_error(unsigned cells) {
  static const double sides[3] = {0.4, 0.3, 0.2};
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0.2, 0.15, 0.1), spore_vec3(sides[0], sides[1], sides[2]));
  Linear linear = linear_new(grid_model(&box, cells, POISSON));
  double *exact = g_new(double, 3 * linear.n), error = 0, size = 0;
  for (size_t i = 0; i < linear.n; i++) {
    SporeVec3 force, x = spore_vec3_load(linear.x + 3 * i), u = manufactured(x, &force);
    spore_vec3_store(exact + 3 * i, u);
    for (int k = 0; k < 3; k++) linear.held[i] |= linear.x[3 * i + k] < 1e-9 || linear.x[3 * i + k] > sides[k] - 1e-9;
    if (linear.held[i]) spore_vec3_store(linear.u + 3 * i, u);
    spore_vec3_store(linear.load + 3 * i, spore_vec3_scale(linear.model->block_mass[i] / DENSITY, force));
  }
  linear_solve(&linear);
  for (size_t i = 0; i < 3 * linear.n; i++) {
    error += (linear.u[i] - exact[i]) * (linear.u[i] - exact[i]);
    size += exact[i] * exact[i];
  }
  g_free(exact);
  linear_free(&linear);
  return sqrt(error / size);
}

static void order_in_a_box(void) {
  double error[3];
  for (unsigned level = 0; level < 3; level++) error[level] = manufactured_error(4u << level);
  g_test_message("manufactured solution in a box: off by %.3e, %.3e, %.3e at 4, 8, 16 cells: order %.3f, %.3f",
                 error[0], error[1], error[2], log2(error[0] / error[1]), order_of(error, 3));
  g_assert_cmpfloat_with_epsilon(order_of(error, 3), 2, 0.2);
}

/* A cube in the sphere of radius 1: its surface carried out to it, and scaled so that it holds the ball's volume. */
static void ball_surface(SporeTriangleMesh *mesh, double radius) {
  SporeMeshReport report;
  shape_block_surface(mesh, 24, 24, 24, spore_vec3(2, 2, 2));
  for (int pass = 0; pass < 2; pass++) {
    double scale = radius;
    if (pass == 1) {
      g_assert_true(spore_triangle_mesh_report(mesh, &report, NULL));
      scale *= cbrt(4 * G_PI / 3 * radius * radius * radius / fabs(report.volume));
    }
    for (size_t i = 0; i < mesh->vertex_count; i++) {
      SporeVec3 p = spore_vec3_load(mesh->vertices + 3 * i);
      if (pass == 0) p = spore_vec3_sub(p, spore_vec3(1, 1, 1));
      spore_vec3_store(mesh->vertices + 3 * i, spore_vec3_scale(scale / fmax(spore_vec3_length(p), 1e-3), p));
    }
  }
}

/* A free ball that swells: u = (a - b r^2) x with no traction at the radius R,
 * (lambda + 2 mu)(a - 3 b R^2) + 2 lambda (a - b R^2) = 0, takes the force 10 b (lambda + 2 mu) x. */
static double ball_error(unsigned cells, double *mass_error) {
  double mu = YOUNG / (2 * (1 + POISSON)), lambda = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON));
  double radius = 0.1, b = 1, m = lambda + 2 * mu, error = 0, size = 0, second = 0;
  double a = b * radius * radius * (3 * m + 2 * lambda) / (m + 2 * lambda);
  SporeTriangleMesh mesh;
  ball_surface(&mesh, radius);
  Linear linear = linear_new(grid_model(&mesh, cells, POISSON));
  for (size_t i = 0; i < linear.n; i++) { /* light springs to where it is keep it from turning; they pull little */
    double mass = linear.model->block_mass[i];
    SporeVec3 x = spore_vec3_load(linear.x + 3 * i);
    spore_vec3_store(linear.load + 3 * i, spore_vec3_scale(10 * b * m * mass / DENSITY, x));
    for (int k = 0; k < 3; k++) linear.matrix.values[9 * (size_t)linear.matrix.diagonal[i] + 4 * k] += 1 * mass;
    second += mass * spore_vec3_dot(x, x);
  }
  linear_solve(&linear);
  for (size_t i = 0; i < linear.n; i++) {
    SporeVec3 x = spore_vec3_load(linear.x + 3 * i);
    SporeVec3 exact = spore_vec3_scale(a - b * spore_vec3_dot(x, x), x);
    double mass = linear.model->block_mass[i], off = spore_vec3_distance(exact, spore_vec3_load(linear.u + 3 * i));
    error += mass * off * off, size += mass * spore_vec3_dot(exact, exact);
  }
  *mass_error = second / (0.6 * spore_model_total_mass(linear.model) * radius * radius) - 1;
  linear_free(&linear);
  return sqrt(error / size);
}

static void order_in_a_ball(void) {
  double error[3], second[3];
  for (unsigned level = 0; level < 3; level++) {
    error[level] = ball_error(4u << level, second + level);
    g_test_message("free ball, %u cells: off by %.3e, second moment by %.1e", 4u << level, error[level], second[level]);
  }
  g_test_message("order in a ball: %.3f, %.3f, of its second moment %.3f", log2(error[0] / error[1]),
                 order_of(error, 3), order_of(second, 3));
  g_assert_cmpfloat(order_of(error, 3), >, 1.8);
  g_assert_cmpfloat(error[2], <, 0.05);
}

/* Lame's mode of a free cube: u = A (cos x sin y, -sin x cos y, 0), x and y in pi over the side, without traction on
 * any face; it swings at pi sqrt(2 mu / rho) over the side. */
static double lame_error(unsigned cells, SporeIntegratorKind kind, unsigned steps) {
  double side = 0.1, amplitude = 1e-6, mu = YOUNG / (2 * (1 + POISSON));
  double omega = G_PI * sqrt(2 * mu / DENSITY) / side, time = 0.9 * 2 * G_PI / omega, error = 0, size = 0;
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(side / 2, side / 2, side / 2), spore_vec3(side, side, side));
  Rig *rig = rig_new();
  rig->description.solver.time_step = time / steps;
  rig->description.solver.integrator = kind;
  rig->description.solver.tolerance = 1e-12;
  SporeModel *model = grid_model(&box, cells, POISSON);
  size_t n = model->node_count;
  rig_passive(rig, "cube", model, NULL);
  SporeWorld *world = rig_build(rig);
  double *x = g_memdup2(spore_world_q(world, 0), 3 * n * sizeof(double)), *u = g_new0(double, 3 * n);
  double *q = g_new(double, 3 * n), *v = g_new0(double, 3 * n);
  for (size_t i = 0; i < n; i++) {
    double a = G_PI * x[3 * i] / side, b = G_PI * x[3 * i + 1] / side;
    u[3 * i] = amplitude * cos(a) * sin(b), u[3 * i + 1] = -amplitude * sin(a) * cos(b);
  }
  for (size_t i = 0; i < 3 * n; i++) q[i] = x[i] + u[i];
  spore_world_set_state(world, 0, q, v);
  rig_run(world, steps);
  for (size_t i = 0; i < 3 * n; i++) {
    double off = spore_world_q(world, 0)[i] - x[i] - cos(omega * time) * u[i];
    error += off * off, size += u[i] * u[i];
  }
  g_free(x);
  g_free(u);
  g_free(q);
  g_free(v);
  rig_free(rig);
  return sqrt(error / size);
}

static void order_in_time(void) {
  static const SporeIntegratorKind kinds[] = {SPORE_INTEGRATOR_VERLET, SPORE_INTEGRATOR_IMPLICIT_MIDPOINT};
  static const unsigned cells[] = {4, 2}, steps[] = {25, 6};
  for (unsigned k = 0; k < G_N_ELEMENTS(kinds); k++) {
    double error[3];
    for (unsigned level = 0; level < 3; level++)
      error[level] = lame_error(cells[k] << level, kinds[k], steps[k] << level);
    g_test_message("Lame's mode, %s: off by %.3e, %.3e, %.3e at %u cells and more: order %.3f, %.3f",
                   spore_integrator_names[kinds[k]], error[0], error[1], error[2], cells[k], log2(error[0] / error[1]),
                   order_of(error, 3));
    g_assert_cmpfloat(order_of(error, 3), >, 1.8);
  }
}

/* Greatest change of the distance between two nodes, over that at rest. */
static double shape_error(const double *q, const double *rest, size_t n) {
  double worst = 0;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++) {
      double then = spore_vec3_distance(spore_vec3_load(rest + 3 * i), spore_vec3_load(rest + 3 * j));
      double now = spore_vec3_distance(spore_vec3_load(q + 3 * i), spore_vec3_load(q + 3 * j));
      worst = fmax(worst, fabs(now / then - 1));
    }
  return worst;
}

typedef enum Crush { CORNER, PLANE, POINT, HEAP } Crush;

static void crush(Crush kind, double *q, size_t n, GRand *random) {
  for (size_t i = 0; i < 3 * n; i++) {
    if (kind == CORNER && i >= 3 * (n - 1)) q[i] -= 0.03;
    if (kind == PLANE && i % 3 == 1) q[i] = 0.02;
    if (kind == POINT) q[i] = 0.02 + g_rand_double_range(random, -1e-5, 1e-5);
    if (kind == HEAP) q[i] = g_rand_double_range(random, 0, 0.04);
  }
}

/* What is left of the error after 6 s. */
static double recover(Crush kind, guint32 seed) {
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0.02, 0.02, 0.02), spore_vec3(0.04, 0.04, 0.04));
  Rig *rig = rig_new();
  rig->description.solver.time_step = 0.01;
  SporeModel *model =
      rig_surface_model(&spore_finite_differences, &box, "cells", 2.0, "poisson_ratio", 0.3, "mass_damping", 5.0, NULL);
  rig_passive(rig, "block", model, NULL);
  SporeWorld *world = rig_build(rig);
  GRand *random = g_rand_new_with_seed(seed);
  size_t n = model->node_count;
  double *rest = g_memdup2(spore_world_q(world, 0), 3 * n * sizeof(double));
  double *q = g_memdup2(rest, 3 * n * sizeof(double)), *v = g_new0(double, 3 * n);
  crush(kind, q, n, random);
  spore_world_set_state(world, 0, q, v);
  double start = rig_energy(world), most = start;
  for (unsigned i = 0; i < 600; i++) {
    spore_world_step(world);
    most = fmax(most, rig_energy(world));
  }
  double error = shape_error(spore_world_q(world, 0), rest, n);
  g_assert_true(rig_finite(world));
  g_assert_false(rig_any_frozen(world));
  g_assert_cmpfloat(most, <=, start * (1 + 1e-3)); /* from a point 1e-4 more */
  g_rand_free(random);
  g_free(rest);
  g_free(q);
  g_free(v);
  rig_free(rig);
  return error;
}

/* Cases 8, 10, 11 and 9 of numerics.md. F at a cell's middle does not know of a corner that went through another, so
 * that most heaps stay tangled. */
static void recovers(void) {
  enum { HEAPS = 12, RECOVERED = 4 };
  static const char *const names[] = {"a corner inside out", "collapsed to a plane", "collapsed to a point"};
  unsigned recovered = 0;
  for (Crush kind = CORNER; kind < HEAP; kind++) {
    double error = recover(kind, 8);
    g_test_message("%s: off by %.1e after 6 s", names[kind], error);
    g_assert_cmpfloat(error, <, 1e-6);
  }
  for (guint32 seed = 1; seed <= HEAPS; seed++) {
    double error = recover(HEAP, seed);
    if (error < 1e-4) recovered++;
    else g_test_message("heap %u: off by %.3g after 6 s", seed, error);
  }
  g_test_message("%u of %u heaps recovered", recovered, (unsigned)HEAPS);
  g_assert_cmpuint(recovered, >=, RECOVERED);
}

static void refuse(SporeTriangleMesh *surface, double cells, const char *says) {
  void *fields = rig_fields(&spore_finite_differences, "cells", cells, NULL);
  SporeError error = SPORE_ERROR_INIT;
  g_assert_null(spore_finite_differences.create(&(SporeGeometry){.surface = surface}, fields, &error));
  g_test_message("refused: %s", error.message);
  g_assert_nonnull(strstr(error.message, says));
  spore_free(fields);
  spore_triangle_mesh_clear(surface);
}

/* Two pyramids of 3 m, back to back 8 m apart, that a bar of 3 cm joins. */
static void dumb_bell(SporeTriangleMesh *mesh) {
  shape_block_surface(mesh, 3, 3, 3, spore_vec3(3, 3, 3));
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    double *x = mesh->vertices + 3 * i;
    gboolean between = x[0] > 0.5 && x[0] < 2.5;
    x[0] = x[0] < 0.5 ? 0 : x[0] < 1.5 ? 1 : x[0] < 2.5 ? 9 : 10;
    if (!between) continue;
    x[1] = 1.5 + 0.01 * (x[1] - 1.5), x[2] = 1.5 + 0.01 * (x[2] - 1.5);
  }
}

/* Two boxes. */
static void apart(SporeTriangleMesh *mesh) {
  SporeTriangleMesh boxes[2];
  for (int b = 0; b < 2; b++) shape_box(boxes + b, spore_vec3(2 * b, 0, 0), spore_vec3(1, 1, 1));
  size_t n = boxes[0].vertex_count, t = boxes[0].triangle_count;
  g_assert_true(spore_triangle_mesh_allocate(mesh, 2 * n, 2 * t, NULL));
  for (size_t b = 0; b < 2; b++) {
    memcpy(mesh->vertices + 3 * n * b, boxes[b].vertices, 3 * n * sizeof(double));
    for (size_t c = 0; c < 3 * t; c++) mesh->triangles[3 * t * b + c] = boxes[b].triangles[c] + (uint32_t)(n * b);
    spore_triangle_mesh_clear(boxes + b);
  }
}

static void refused(void) {
  SporeTriangleMesh mesh;
  shape_sheet(&mesh, 5, 5, 0.01, FALSE);
  refuse(&mesh, 10, "closed");
  shape_box(&mesh, spore_vec3(0, 0, 0), spore_vec3(1e-3, 2e-3, 0.5));
  refuse(&mesh, 10, "at least 500 cells");
  shape_box(&mesh, spore_vec3(0, 0, 0), spore_vec3(1, 1, 1));
  refuse(&mesh, 300, "fewer cells");
  shape_box(&mesh, spore_vec3(0, 0, 0), spore_vec3(1, 1, 1));
  refuse(&mesh, 60, "2.2e+05 inside");
  apart(&mesh);
  refuse(&mesh, 12, "has 2 parts");
  dumb_bell(&mesh);
  refuse(&mesh, 10, "2 parts");
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/finite_differences/bending", bending);
  g_test_add_func("/finite_differences/order_in_a_box", order_in_a_box);
  g_test_add_func("/finite_differences/order_in_a_ball", order_in_a_ball);
  g_test_add_func("/finite_differences/order_in_time", order_in_time);
  g_test_add_func("/finite_differences/recovers", recovers);
  g_test_add_func("/finite_differences/refused", refused);
  return g_test_run();
}
