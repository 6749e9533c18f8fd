/* Stiffness and mass of very different size in one body: cases 1, 2, 12, 28. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/stability/chain.h"
#include "tests/stability/rig.h"

#define LINKS 12
#define G 9.81

/* Largest distance of a chain from where it should hang, m. */
static double hang_error(const SporeWorld *world, const double *height) {
  const double *q = spore_world_q(world, 0);
  double worst = 0;
  for (size_t i = 0; i <= LINKS; i++)
    worst = fmax(worst, spore_vec3_distance(spore_vec3_load(q + 3 * i), spore_vec3(0, height[i], 0)));
  return worst;
}

/* Case 1: springs from 1 N/m to 1 N/m times the ratio, mixed, in one chain; 16 ms. */
static void case_1_chain(void) {
  for (int decade = 0; decade <= 12; decade += 3) {
    double stiffness[LINKS], mass[LINKS + 1], height[LINKS + 1];
    for (int i = 0; i < LINKS; i++) stiffness[i] = pow(10, decade * ((5 * i) % LINKS) / (LINKS - 1.0));
    for (int i = 0; i <= LINKS; i++) mass[i] = 1e-3;
    Rig *rig = rig_new();
    rig->description.gravity = spore_vec3(0, -G, 0);
    rig->description.solver.time_step = 0.016;
    rig_passive(rig, "chain", chain_new(LINKS, 0.1, stiffness, mass, 0.5), NULL);
    rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-3);
    SporeWorld *world = rig_build(rig);
    rig_run(world, 600);
    chain_hang(LINKS, 0.1, stiffness, mass, G, height);
    double error = hang_error(world, height) / -height[LINKS];
    g_test_message("case 1: ratio 1e%d at 16 ms: static error %.2e, recoveries %u, not converged %u, %s", decade, error,
                   (unsigned)spore_world_monitor(world)->recoveries,
                   (unsigned)spore_world_monitor(world)->not_converged, rig_last_message(world));
    g_assert_false(rig_any_frozen(world));
    g_assert_cmpfloat(error, <, 1e-6);
    rig_free(rig);
  }
}

/* Case 1: a net with stiff edges and soft diagonals, held at two corners, swings at 16 ms. Every step is solved, as far
 * as the digits of its positions allow, and what they do not allow is said. Its energy may only fall, and what does not
 * stretch comes down by its 5 cm; how well the stiffest springs are solved shows in their stretch. */
static void case_1_net(void) {
  const unsigned side = 6, edges = 2 * side * (side - 1) + (side - 1) * (side - 1);
  for (int decade = 0; decade <= 12; decade += 2) {
    SporeTriangleMesh sheet;
    shape_sheet(&sheet, side, side, 0.01, TRUE);
    Rig *rig = rig_new();
    rig->description.gravity = spore_vec3(0, 0, -G);
    rig->description.solver.time_step = 0.016;
    rig->description.solver.newton_iterations = 40; /* with 20 a few steps at 1e8 and above are taken in smaller ones */
    rig_passive(rig, "net",
                rig_surface_model(&spore_mass_spring_net, &sheet, "structural_stiffness", pow(10, decade),
                                  "shear_stiffness", 1.0, "bending_stiffness", 1.0, NULL),
                NULL);
    rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-3);
    rig_pin(rig, 0, spore_vec3(0.01 * (side - 1), 0, 0), 1e-3);
    SporeWorld *world = rig_build(rig);
    double start = rig_energy(world), total = -HUGE_VAL, stored = 0;
    for (int i = 0; i < 80; i++) {
      spore_world_step(world);
      SporeEnergy energy = spore_world_energy(world);
      total = fmax(total, energy.kinetic + energy.gravity + energy.internal - start);
      stored = fmax(stored, energy.internal);
    }
    double stretch = sqrt(2 * stored / pow(10, decade) / edges) / 0.01;
    double fallen = -spore_world_q(world, 0)[3 * (side * side - 1) + 2];
    g_test_message("case 1: net, ratio 1e%d at 16 ms: energy at most %.2e J above the start, mean "
                   "stretch of the stiff edges at most %.1e, fallen %.2e m, not converged %u",
                   decade, total, stretch, fallen, (unsigned)spore_world_monitor(world)->not_converged);
    g_assert_true(rig_finite(world));
    g_assert_false(rig_any_frozen(world));
    g_assert_cmpfloat(total, <, 1e-12);
    if (decade <= 6) g_assert_cmpuint(spore_world_unsolved_count(world), ==, 0);
    for (size_t i = 0; i < spore_world_unsolved_count(world); i++)
      g_assert_nonnull(strstr(spore_world_unsolved(world, i).cause, "rounding"));
    if (decade >= 4) g_assert_cmpfloat(stretch, <, 1e-3);
    if (decade >= 4) g_assert_cmpfloat_with_epsilon(fallen, 0.01 * (side - 1), 2e-4);
    rig_free(rig);
  }
}

/* Case 2: a chain of 1 g links with a weight of up to 1e6 times that at its end. */
static void case_2(void) {
  for (int decade = 0; decade <= 6; decade++) {
    double stiffness[LINKS], mass[LINKS + 1], height[LINKS + 1];
    for (int i = 0; i <= LINKS; i++) mass[i] = 1e-3;
    mass[LINKS] *= pow(10, decade);
    for (int i = 0; i < LINKS; i++) stiffness[i] = 1e3 * mass[LINKS] / 1e-3;
    double damping = 2 * sqrt(stiffness[0] * mass[LINKS] * LINKS);
    Rig *rig = rig_new();
    rig->description.gravity = spore_vec3(0, -G, 0);
    rig_passive(rig, "chain", chain_new(LINKS, 0.1, stiffness, mass, damping), NULL);
    rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-3);
    SporeWorld *world = rig_build(rig);
    rig_run(world, 1000);
    chain_hang(LINKS, 0.1, stiffness, mass, G, height);
    double stretch = -spore_world_q(world, 0)[3 * LINKS + 1] - 0.1 * LINKS, expected = -height[LINKS] - 0.1 * LINKS;
    g_test_message("case 2: mass ratio 1e%d: stretch %.4e m, expected %.4e m (off by %.1e), not converged %u", decade,
                   stretch, expected, stretch / expected - 1, (unsigned)spore_world_monitor(world)->not_converged);
    g_assert_cmpfloat(fabs(stretch / expected - 1), <, 0.01);
    rig_free(rig);
  }
}

/* Case 12: springs of no rest length, and springs squeezed to none; the stiffness stays finite, and a collapsed net
 * opens again. */
static void case_12(void) {
  SporeTriangleMesh sheet;
  shape_sheet(&sheet, 6, 6, 0.01, FALSE);
  /* A seam: two vertices at one place, so that an edge of the mesh has no length. */
  memcpy(sheet.vertices + 3 * 7, sheet.vertices + 3 * 14, 3 * sizeof(double));
  Rig *rig = rig_new();
  rig_passive(rig, "net", rig_surface_model(&spore_mass_spring_net, &sheet, NULL), NULL);
  SporeWorld *world = rig_build(rig);
  const SporeModel *model = spore_world_body_model(world, 0);
  size_t n = model->q_count;
  double *q = g_memdup2(spore_world_q(world, 0), n * sizeof(double)), *v = g_new0(double, n);
  double size = spore_vec3_distance(spore_vec3_load(q), spore_vec3_load(q + 3 * 35));
  for (size_t i = 0; i < n; i++) q[i] = 0.02; /* to a point */
  spore_world_set_state(world, 0, q, v);
  rig_run(world, 2000);
  double after =
      spore_vec3_distance(spore_vec3_load(spore_world_q(world, 0)), spore_vec3_load(spore_world_q(world, 0) + 3 * 35));
  g_test_message("case 12: collapsed to a point, the net opens to %.3f of its diagonal, energy %.2e J, frozen %d",
                 after / size, rig_energy(world), rig_any_frozen(world));
  g_assert_true(rig_finite(world));
  g_assert_false(rig_any_frozen(world));
  g_assert_cmpfloat(after / size, >, 0.5);
  g_free(q);
  g_free(v);
  rig_free(rig);
}

/* Case 28: stiffness times 1e6 while a stretched body swings. */
static void retuned(const char *name, SporeModel *soft, const char *stiffness, double value) {
  Rig *rig = rig_new();
  rig_passive(rig, name, soft, NULL);
  SporeWorld *world = rig_build(rig);
  const SporeModel *model = spore_world_body_model(world, 0);
  size_t n = model->q_count;
  double *q = g_memdup2(spore_world_q(world, 0), n * sizeof(double)), *v = g_new0(double, n);
  for (size_t i = 0; i < n; i++) q[i] *= i % 3 ? 0.95 : 1.2;
  spore_world_set_state(world, 0, q, v);
  rig_run(world, 20);
  double before = rig_energy(world);
  SporeEnergy old = spore_world_energy(world);
  SporeCommand command = {
      .kind = SPORE_COMMAND_RETUNE, .body = 0, .fields = rig_fields(model->type, stiffness, 1e6 * value, NULL)};
  /* What the change itself puts in: U of the present shape under the new stiffness. */
  SporeModel *mutable_model = (SporeModel *)model; /* the world's; put back at once */
  g_assert_true(model->type->retune(mutable_model, command.fields, NULL));
  double put_in = model->type->potential(model, spore_world_q(world, 0)) - old.internal, most = -HUGE_VAL;
  void *back = rig_fields(model->type, stiffness, value, NULL);
  g_assert_true(model->type->retune(mutable_model, back, NULL));
  spore_free(back);
  g_assert_true(spore_world_post(world, &command));
  for (int i = 0; i < 200; i++) {
    spore_world_step(world);
    most = fmax(most, rig_energy(world));
  }
  g_test_message("case 28: %s, %s x 1e6: energy %.3e J, put in %.3e J, afterwards at most %.3e J, frozen %d", name,
                 stiffness, before, put_in, most, rig_any_frozen(world));
  g_assert_true(rig_finite(world));
  g_assert_cmpfloat(most, <=, (before + put_in) * (1 + 1e-6));
  g_free(q);
  g_free(v);
  rig_free(rig);
}

static void case_28(void) {
  SporeTriangleMesh sheet;
  SporeTetrahedralMesh block;
  shape_sheet(&sheet, 8, 8, 0.01, TRUE);
  retuned("net", rig_surface_model(&spore_mass_spring_net, &sheet, NULL), "structural_stiffness", 100);
  shape_block(&block, 4, 2, 2, spore_vec3(0.04, 0.02, 0.02));
  retuned("tetrahedra", rig_tetrahedra_model(&block, NULL), "young_modulus", 5000);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/01_stiffness_ratio/chain", case_1_chain);
  g_test_add_func("/stability/01_stiffness_ratio/net", case_1_net);
  g_test_add_func("/stability/02_mass_ratio", case_2);
  g_test_add_func("/stability/12_no_length", case_12);
  g_test_add_func("/stability/28_retuned", case_28);
  return g_test_run();
}
