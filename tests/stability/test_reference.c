/* Bending and stretch against beam theory and closed solutions. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/stability/rig.h"

/* A static problem: nodes are held or loaded, everything else finds its place. */
typedef struct Statics {
  const SporeModel *model;
  SporeBlockMatrix matrix;
  gboolean *held; /* block_count */
  double *load;   /* 3 block_count, N */
  double *q;
} Statics;

static void filter(const Statics *statics, double *vector) {
  for (size_t i = 0; i < statics->model->block_count; i++)
    if (statics->held[i]) memset(vector + 3 * i, 0, 3 * sizeof(double));
}

/* Conjugate gradients with the inverse diagonal; x = 0 at held nodes. */
static void solve(const Statics *statics, const double *b, double *x) {
  size_t n = 3 * statics->model->block_count;
  double *r = g_memdup2(b, n * sizeof(double)), *z = g_new(double, n), *p = g_new0(double, n), *a = g_new(double, n);
  double old = 0, start = 0;
  memset(x, 0, n * sizeof(double));
  for (size_t iteration = 0; iteration < 20 * n; iteration++) {
    double rz = 0, pa = 0;
    for (size_t i = 0; i < n; i++) {
      z[i] = r[i] / statics->matrix.values[9 * (size_t)statics->matrix.diagonal[i / 3] + 4 * (i % 3)];
      rz += r[i] * z[i];
    }
    if (iteration == 0) start = rz;
    if (rz <= 1e-24 * start || rz == 0) break;
    for (size_t i = 0; i < n; i++) p[i] = z[i] + (old > 0 ? rz / old : 0) * p[i];
    memset(a, 0, n * sizeof(double));
    spore_block_matrix_multiply_add(&statics->matrix, p, a);
    filter(statics, a);
    for (size_t i = 0; i < n; i++) pa += p[i] * a[i];
    for (size_t i = 0; i < n; i++) x[i] += rz / pa * p[i], r[i] -= rz / pa * a[i];
    old = rz;
  }
  g_free(r);
  g_free(z);
  g_free(p);
  g_free(a);
}

/* Newton's iterations until the forces balance; returns what is left of them, relative to the load. */
static double balance(Statics *statics) {
  size_t n = 3 * statics->model->block_count;
  double *f = g_new(double, n), *step = g_new(double, n), *still = g_new0(double, n), left = 1, load = 0;
  SporeBlockPattern pattern;
  spore_block_pattern_init(&pattern, statics->model->block_count);
  g_assert_true(statics->model->type->pattern(statics->model, &pattern));
  g_assert_true(spore_block_matrix_create(&statics->matrix, &pattern));
  spore_block_pattern_clear(&pattern);
  for (size_t i = 0; i < n; i++) load += statics->load[i] * statics->load[i];
  for (int iteration = 0; iteration < 20 && left > 1e-8; iteration++) {
    spore_block_matrix_zero(&statics->matrix);
    statics->model->type->jacobian(statics->model, statics->q, statics->q, still, 1, 0, &statics->matrix);
    memcpy(f, statics->load, n * sizeof(double));
    statics->model->type->force(statics->model, statics->q, statics->q, still, f);
    filter(statics, f);
    left = 0;
    for (size_t i = 0; i < n; i++) left += f[i] * f[i] / load;
    left = sqrt(left);
    if (left <= 1e-8) break;
    solve(statics, f, step);
    for (size_t i = 0; i < n; i++) statics->q[i] += step[i];
  }
  spore_block_matrix_clear(&statics->matrix);
  g_free(f);
  g_free(step);
  g_free(still);
  return left;
}

/* Tip deflection (m) of the bar of numerics.md: 1 x 0.2 x 0.2 m, E 1e5 Pa, clamped at x = 0, 0.1 N down over the tip
 * face. */
static double cantilever(unsigned along, unsigned across, double poisson) {
  SporeTetrahedralMesh bar;
  shape_block(&bar, along, across, across, spore_vec3(1, 0.2, 0.2));
  size_t nodes = bar.vertex_count;
  Statics statics = {.held = g_new0(gboolean, nodes), .load = g_new0(double, 3 * nodes)};
  statics.q = g_memdup2(bar.vertices, 3 * nodes * sizeof(double));
  size_t face = (size_t)(across + 1) * (across + 1);
  for (size_t i = 0; i < face; i++) statics.held[i] = TRUE;
  for (size_t i = nodes - face; i < nodes; i++) { /* as a constant traction: half at an edge, a quarter at a corner */
    size_t j = (i - (nodes - face)) / (across + 1), k = (i - (nodes - face)) % (across + 1);
    double share = (j % across ? 1 : 0.5) * (k % across ? 1 : 0.5);
    statics.load[3 * i + 1] = -0.1 * share / (across * across);
  }
  statics.model = rig_tetrahedra_model(&bar, "young_modulus", 1e5, "poisson_ratio", poisson, NULL);
  double left = balance(&statics), tip = 0;
  g_assert_cmpfloat(left, <, 1e-7);
  for (size_t i = nodes - face; i < nodes; i++) {
    size_t j = (i - (nodes - face)) / (across + 1);
    tip += (0.2 * (double)j / across - statics.q[3 * i + 1]) / (double)face;
  }
  statics.model->type->destroy((SporeModel *)statics.model);
  g_free(statics.held);
  g_free(statics.load);
  g_free(statics.q);
  return tip;
}

/* The table of numerics.md: linear tetrahedra lock; this is by how much, and it goes away with refinement. */
static void locking(void) {
  static const struct {
    unsigned along, across;
    double poisson, expected, tolerance;
  } cases[] = {
      {10, 2, 0.3, -0.49, 0.04}, {20, 4, 0.3, -0.21, 0.04}, {40, 8, 0.3, -0.06, 0.03}, {10, 2, 0.499, -0.92, 0.04}};
  const double reference = 2.54e-3;
  for (unsigned i = 0; i < G_N_ELEMENTS(cases); i++) {
    double tip = cantilever(cases[i].along, cases[i].across, cases[i].poisson), error = tip / reference - 1;
    g_test_message("cantilever %u x %u^2, nu %g: tip %.3e m of %.3e m: %+.1f%% (table %+.0f%%)", cases[i].along,
                   cases[i].across, cases[i].poisson, tip, reference, 100 * error, 100 * cases[i].expected);
    g_assert_cmpfloat(fabs(error - cases[i].expected), <, cases[i].tolerance);
  }
}

/* Homogeneous stretch: a bar pulled along x by the stress that corotated elasticity gives for stretches (a, b, b):
 * sigma_x = 2 mu (a - 1) + lambda (a + 2 b - 3), with b from no stress across. Linear tetrahedra hold it exactly. */
static void stretch(void) {
  double young = 1e5, nu = 0.3, a = 1.3;
  double mu = young / (2 * (1 + nu)), lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
  double b = 1 - lambda * (a - 1) / (2 * (mu + lambda));
  double stress = 2 * mu * (a - 1) + lambda * (a + 2 * b - 3), worst = 0, most = 0;
  SporeTetrahedralMesh bar;
  shape_block(&bar, 4, 2, 2, spore_vec3(0.4, 0.2, 0.2));
  size_t nodes = bar.vertex_count, face = 9;
  double *q = g_memdup2(bar.vertices, 3 * nodes * sizeof(double)), *v = g_new0(double, 3 * nodes),
         *f = g_new0(double, 3 * nodes);
  for (size_t i = 0; i < nodes; i++) q[3 * i] *= a, q[3 * i + 1] *= b, q[3 * i + 2] *= b;
  SporeModel *model = rig_tetrahedra_model(&bar, "young_modulus", young, "poisson_ratio", nu, NULL);
  model->type->force(model, q, q, v, f);
  double pull = 0;
  for (size_t i = 0; i < nodes; i++) {
    gboolean end = i < face || i >= nodes - face;
    if (i >= nodes - face) pull -= f[3 * i];
    for (int k = 0; k < 3; k++) {
      most = fmax(most, fabs(f[3 * i + k]));
      if (k > 0 || !end) worst = fmax(worst, fabs(f[3 * i + k]));
    }
  }
  double energy =
      0.4 * 0.2 * 0.2 * (mu * ((a - 1) * (a - 1) + 2 * (b - 1) * (b - 1)) + 0.5 * lambda * pow(a + 2 * b - 3, 2));
  g_test_message("stretch by %g: pull %.12g N of %.12g N, energy %.12g J of %.12g J, stray force %.1e of %.1e N", a,
                 pull, stress * 0.04, model->type->potential(model, q), energy, worst, most);
  g_assert_cmpfloat(fabs(pull / (stress * 0.04) - 1), <, 1e-12);
  g_assert_cmpfloat(fabs(model->type->potential(model, q) / energy - 1), <, 1e-12);
  g_assert_cmpfloat(worst, <, 1e-12 * most);
  model->type->destroy(model);
  g_free(q);
  g_free(v);
  g_free(f);
}

/* The bar, clamped at one end, rings along its length: w = pi/2 sqrt(E / rho) / L, and in `along` slabs of lumped mass
 * w = 2 n sqrt(E / rho) / L sin(pi / 4n). Without damping the energy stays. */
static void ringing(void) {
  const unsigned along = 10, across = 2;
  const double h = 5e-4;
  SporeTetrahedralMesh bar;
  shape_block(&bar, along, across, across, spore_vec3(1, 0.2, 0.2));
  size_t nodes = bar.vertex_count, face = (size_t)(across + 1) * (across + 1);
  Rig *rig = rig_new();
  rig->description.solver.integrator = SPORE_INTEGRATOR_SYMPLECTIC_EULER;
  rig->description.solver.time_step = h;
  SporeModel *model = rig_tetrahedra_model(&bar, "young_modulus", 1e5, "poisson_ratio", 0.0, "density", 1000.0,
                                           "stiffness_damping", 0.0, NULL);
  rig_passive(rig, "bar", model, NULL);
  for (size_t i = 0; i < face; i++)
    rig_pin(rig, 0, spore_vec3(0, 0.1 * (double)(i / (across + 1)), 0.1 * (double)(i % (across + 1))), 1e-4);
  SporeWorld *world = rig_build(rig);
  double *q = g_memdup2(spore_world_q(world, 0), 3 * nodes * sizeof(double)), *v = g_new0(double, 3 * nodes);
  for (size_t i = 0; i < nodes; i++) v[3 * i] = 1e-3 * sin(0.5 * G_PI * q[3 * i]);
  spore_world_set_state(world, 0, q, v);
  double energy = rig_energy(world), drift = 0, first = 0, last = 0, before = 0;
  int crossings = 0;
  for (int i = 1; crossings < 21 && i < 20000; i++) {
    spore_world_step(world);
    drift = fmax(drift, fabs(rig_energy(world) / energy - 1));
    double now = 0;
    for (size_t n = nodes - face; n < nodes; n++) now += (spore_world_q(world, 0)[3 * n] - q[3 * n]) / (double)face;
    if (i > 1 && now * before < 0) {
      last = (i - now / (now - before)) * h;
      if (!crossings++) first = last;
    }
    before = now;
  }
  double measured = 20 * G_PI / (last - first), expected = 2 * along * 10 * sin(0.25 * G_PI / along);
  g_test_message("bar rings at %.4f rad/s, expected %.4f rad/s (%+.2f%%), energy within %.1e", measured, expected,
                 100 * (measured / expected - 1), drift);
  g_assert_cmpfloat(fabs(measured / expected - 1), <, 0.01);
  g_assert_cmpfloat(drift, <, 0.02);
  g_free(q);
  g_free(v);
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/reference/cantilever", locking);
  g_test_add_func("/reference/stretch", stretch);
  g_test_add_func("/reference/ringing", ringing);
  return g_test_run();
}
