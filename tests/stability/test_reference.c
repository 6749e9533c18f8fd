/* Stretch and vibration against closed solutions. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/stability/rig.h"

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
  g_test_add_func("/reference/stretch", stretch);
  g_test_add_func("/reference/ringing", ringing);
  return g_test_run();
}
