/* What an implicit step costs, and what its parts cost: force, matrix, factor, solve. CHOLMOD factorises the same
 * matrices in the same run, where it is there. CPU time of this thread; the least of several repeats. One JSON object a
 * line. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#ifdef HAVE_CHOLMOD
#include <suitesparse/cholmod.h>
#endif

#include "core/linalg/block_cholesky.h"
#include "tests/stability/chain.h"
#include "tests/stability/rig.h"

#define REPEATS 7

static double now_us(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

#define LEAST(best, runs, code)                                                                                        \
  do {                                                                                                                 \
    for (int repeat_ = 0; repeat_ < REPEATS; repeat_++) {                                                              \
      double start_ = now_us();                                                                                        \
      for (int run_ = 0; run_ < (runs); run_++) code;                                                                  \
      (best) = fmin((best), (now_us() - start_) / (runs));                                                             \
    }                                                                                                                  \
  } while (0)

typedef struct Case {
  const char *name;
  SporeModel *model;
  double time_step;
  SporeVec3 pins[2];
  double pin_radius;
  SporeVec3 gravity; /* 0: down */
} Case;

enum { CASES = 8, FIRST_CHAIN = 5 };

#ifdef HAVE_CHOLMOD
static void cholmod(const SporeBlockMatrix *matrix, double *factor_us, double *solve_us) {
  cholmod_common common;
  cholmod_start(&common);
  size_t n = 3 * matrix->block_count;
  cholmod_triplet *triplet =
      cholmod_allocate_triplet(n, n, 9 * matrix->row_start[matrix->block_count], -1, CHOLMOD_REAL, &common);
  int *row = triplet->i, *column = triplet->j;
  double *value = triplet->x;
  for (uint32_t i = 0; i < matrix->block_count; i++)
    for (uint32_t k = matrix->row_start[i]; k < matrix->row_start[i + 1]; k++)
      for (uint32_t e = 0; e < 9; e++) {
        uint32_t r = 3 * i + e / 3, c = 3 * matrix->column[k] + e % 3;
        if (r < c) continue;
        row[triplet->nnz] = (int)r, column[triplet->nnz] = (int)c;
        value[triplet->nnz++] = matrix->values[9 * (size_t)k + e];
      }
  cholmod_sparse *a = cholmod_triplet_to_sparse(triplet, 0, &common);
  cholmod_factor *factor = cholmod_analyze(a, &common);
  cholmod_dense *b = cholmod_ones(n, 1, CHOLMOD_REAL, &common), *x = NULL, *y = NULL, *z = NULL;
  *factor_us = *solve_us = HUGE_VAL;
  LEAST(*factor_us, 5, cholmod_factorize(a, factor, &common));
  LEAST(*solve_us, 5, cholmod_solve2(CHOLMOD_A, factor, b, NULL, &x, NULL, &y, &z, &common));
  cholmod_free_dense(&x, &common);
  cholmod_free_dense(&y, &common);
  cholmod_free_dense(&z, &common);
  cholmod_free_dense(&b, &common);
  cholmod_free_factor(&factor, &common);
  cholmod_free_sparse(&a, &common);
  cholmod_free_triplet(&triplet, &common);
  cholmod_finish(&common);
}
#endif

/* The stage matrix M + h2 K of the model at rest, factorised. */
static void bench_factor(const Case *c, SporeFactorLayout layout) {
  const SporeModel *model = c->model;
  const SporeModelType *type = model->type;
  size_t n = model->block_count;
  double *q = g_new0(double, model->q_count), *v = g_new0(double, 3 * n), *f = g_new0(double, 3 * n);
  double *mass = g_new0(double, 9 * n), *b = g_new(double, 3 * n), *x = g_new(double, 3 * n);
  SporeBlockPattern pattern;
  SporeBlockMatrix matrix;
  SporeBlockCholesky factor;
  spore_block_pattern_init(&pattern, n);
  g_assert_true(type->pattern(model, &pattern) && spore_block_matrix_create(&matrix, &pattern));
  type->place(model, spore_pose_identity(), (SporeVec3){0, 0, 0}, (SporeVec3){0, 0, 0}, q, v);
  spore_model_mass(model, q, mass);
  double h = c->time_step, force_us = HUGE_VAL, jacobian_us = HUGE_VAL, factor_us = HUGE_VAL, solve_us = HUGE_VAL,
         multiply_us = HUGE_VAL, analyse_us = now_us();
  g_assert_true(spore_block_cholesky_create(&factor, &matrix, layout, HUGE_VAL, NULL));
  analyse_us = now_us() - analyse_us;
  bool banded = factor.band.block_count > 0;
  LEAST(force_us, 20, type->force(model, q, q, v, f));
  LEAST(jacobian_us, 5, {
    spore_block_matrix_zero(&matrix);
    type->jacobian(model, q, q, v, h * h, h, &matrix);
  });
  for (size_t i = 0; i < n; i++)
    for (size_t e = 0; e < 9; e++) matrix.values[9 * (size_t)matrix.diagonal[i] + e] += mass[9 * i + e];
  for (size_t i = 0; i < 3 * n; i++) b[i] = 1;
  LEAST(factor_us, 3, spore_block_cholesky_factorise(&factor, &matrix, NULL, NULL, true));
  LEAST(solve_us, 20, spore_block_cholesky_solve(&factor, b, x));
  memset(f, 0, 3 * n * sizeof *f);
  LEAST(multiply_us, 20, spore_block_matrix_multiply_add(&matrix, x, f));
  printf("{\"bench\": \"factor\", \"case\": \"%s\", \"layout\": \"%s\", \"blocks\": %zu, \"analyse_us\": %.0f, "
         "\"factor_us\": %.1f, "
         "\"solve_us\": %.2f, "
         "\"force_us\": %.2f, \"jacobian_us\": %.1f, \"multiply_us\": %.2f, \"mflop\": %.2f, \"mflop_solve\": %.3f",
         c->name, banded ? "banded" : "sparse", n, analyse_us, factor_us, solve_us, force_us, jacobian_us, multiply_us,
         factor.factor_flops * 1e-6, factor.solve_flops * 1e-6);
#ifdef HAVE_CHOLMOD
  double cholmod_factor_us, cholmod_solve_us;
  cholmod(&matrix, &cholmod_factor_us, &cholmod_solve_us);
  printf(", \"cholmod_factor_us\": %.1f, \"cholmod_solve_us\": %.2f", cholmod_factor_us, cholmod_solve_us);
#endif
  printf("}\n");
  spore_block_cholesky_clear(&factor);
  spore_block_matrix_clear(&matrix);
  spore_block_pattern_clear(&pattern);
  g_free(q), g_free(v), g_free(f), g_free(mass), g_free(b), g_free(x);
}

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void bench_step(const Case *c, unsigned steps) {
  Rig *rig = rig_new();
  bool down = spore_vec3_length(c->gravity) == 0;
  rig->description.gravity = down ? spore_vec3(0, -9.81, 0) : c->gravity;
  rig->description.solver.time_step = c->time_step;
  rig_passive(rig, "body", c->model, NULL);
  for (int p = 0; p < 2; p++) rig_pin(rig, 0, c->pins[p], c->pin_radius);
  SporeWorld *world = rig_build(rig);
  double *us = g_new(double, steps), total = 0, residual = 0;
  size_t newton = 0, linear = 0, evaluations = 0;
  for (unsigned i = 0; i < steps; i++) {
    double start = now_us();
    spore_world_step(world);
    total += us[i] = now_us() - start;
    SporeStepCounts counts = spore_world_counts(world);
    newton += counts.newton_iterations, linear += counts.linear_iterations, evaluations += counts.force_evaluations;
    residual = fmax(residual, counts.residual);
  }
  qsort(us, steps, sizeof *us, by_size);
  size_t n = c->model->q_count;
  printf("{\"bench\": \"step\", \"case\": \"%s\", \"step_us\": {\"median\": %.1f, \"mean\": %.1f, \"max\": %.1f}, "
         "\"newton\": %.2f, "
         "\"linear\": %.2f, \"evaluations\": %.2f, \"residual\": %.1e, \"not_converged\": %u, \"last_y\": %.9f}\n",
         c->name, us[steps / 2], total / steps, us[steps - 1], (double)newton / steps, (double)linear / steps,
         (double)evaluations / steps, residual, (unsigned)spore_world_monitor(world)->not_converged,
         spore_world_q(world, 0)[n - 2]);
  g_free(us);
  rig_free(rig);
}

/* SOFA's net: side 1 m, 0.1 kg, k = 10 / L0, held at two corners. Rayleigh damping is not ours: springs have theirs. */
static Case net(const char *name, unsigned side) {
  SporeTriangleMesh sheet;
  double spacing = 1.0 / (side - 1), k = 10 / spacing;
  shape_sheet(&sheet, side, side, spacing, FALSE);
  for (size_t i = 0; i < sheet.vertex_count; i++) {
    double *p = sheet.vertices + 3 * i;
    p[2] = p[1], p[1] = 0;
  }
  return (Case){name,
                rig_surface_model(&spore_mass_spring_net, &sheet, "mass", 0.1, "structural_stiffness", k,
                                  "shear_stiffness", k / sqrt(2), "bending_stiffness", 0.0, "damping", 0.01 * k, NULL),
                0.01,
                {{0, 0, 0}, {1, 0, 0}},
                1e-3};
}

static Case bar(const char *name, unsigned nx, unsigned ny, unsigned nz, SporeVec3 size, double e, double nu,
                double density, double h) {
  SporeTetrahedralMesh block;
  shape_block(&block, nx, ny, nz, size);
  return (Case){name,
                rig_tetrahedra_model(&block, "young_modulus", e, "poisson_ratio", nu, "density", density,
                                     "stiffness_damping", 0.01, NULL),
                h,
                {{0, size.y / 2, size.z / 2}, {0, size.y / 2, size.z / 2}},
                0.71 * fmax(size.y, size.z) + 1e-9};
}

/* SOFA's rod: 1 m long, radius .01 m, its first two control points held. */
static Case rod(const char *name, unsigned nodes) {
  SporeCurve curve;
  const double points[] = {0, 0, 0, 0.01, 1, 0, 0, 0.01};
  g_assert_true(spore_curve_allocate(&curve, 2, NULL));
  memcpy(curve.points, points, sizeof points);
  return (Case){name,
                rig_curve_model(&spore_spline_1d, &curve, "control_points", (double)nodes, "young_modulus", 1e7,
                                "density", 1000., "damping", 0., NULL),
                0.01,
                {{0, 0, 0}, {0, 0, 0}},
                0.4 / (nodes - 3)};
}

/* Bullet's rope hung up by its upper end, and let go a little off the vertical: 1 m, .1 kg, springs of 2e5 N/m. */
static Case rope(const char *name, unsigned nodes) {
  double *stiffness = g_new(double, nodes), *mass = g_new(double, nodes);
  for (unsigned i = 0; i < nodes; i++) stiffness[i] = 2e5, mass[i] = 0.1 / nodes;
  SporeModel *model = chain_new(nodes - 1, 1. / (nodes - 1), stiffness, mass, 0);
  g_free(stiffness), g_free(mass);
  return (Case){name, model, 0.001, {{0, 0, 0}, {0, 0, 0}}, 1e-3, .gravity = {3, -9.3, 0}};
}

static Case make(int index) {
  switch (index) {
  case 0:
    return net("net 20x20", 20);
  case 1:
    return net("net 40x40", 40);
  case 2:
    return bar("525 nodes, 1920 tetrahedra", 20, 4, 4, spore_vec3(1, 0.2, 0.2), 1e5, 0.3, 1000, 0.02);
  case 4:
    return bar("936 nodes, 3750 tetrahedra", 25, 5, 5, spore_vec3(1, 0.2, 0.2), 1e5, 0.45, 1000, 0.01);
  case 5:
    return rod("rod of 21", 21);
  case 6:
    return rod("rod of 101", 101);
  case 7:
    return rope("rope of 64", 64);
  default:
    return bar("3321 nodes, 15360 tetrahedra", 40, 8, 8, spore_vec3(1, 0.2, 0.2), 1e5, 0.45, 1000, 0.01);
  }
}

int main(int argc, char **argv) {
  for (int i = 0; i < CASES; i++) {
    if (argc > 1 && atoi(argv[1]) != i) continue;
    Case c = make(i);
    bench_factor(&c, SPORE_FACTOR_SPARSE);
    if (i >= FIRST_CHAIN) bench_factor(&c, SPORE_FACTOR_BANDED);
    fflush(stdout);
    bench_step(&c, i == 3 ? 40 : 200);
    fflush(stdout);
  }
}
