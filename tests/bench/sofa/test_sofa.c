/* Every case of SOFA's comparison still builds and steps: what is measured cannot rot. No time is looked at. */
#include "tests/bench/sofa/cases.h"
#include "tests/bench/sofa/hardware.h"
#include "tests/bench/sofa/sofa_step.h"

enum { STEPS = 2 };

static Rig *start(const Case *self) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  self->build(rig, self);
  rig_build(rig);
  return rig;
}

static void steps(const void *data) {
  const Case *self = data;
  Rig *rig = start(self);
  rig_run(rig->world, STEPS);
  g_assert_true(rig_finite(rig->world));
  g_assert_false(rig_any_frozen(rig->world));
  g_assert_cmpuint(spore_world_counts(rig->world).force_evaluations, >, 0);
  g_assert_cmpfloat(spore_world_counts(rig->world).residual, <, 1e-3);
  rig_free(rig);
}

/* With iterations to spare SOFA's way differs from ours by one linearisation alone. */
static void truncated(const void *data) {
  const Case *self = data;
  Rig *rig = start(self);
  const SporeModel *model = spore_world_body_model(rig->world, 0);
  size_t n = model->q_count;
  double *q = g_memdup2(spore_world_q(rig->world, 0), n * sizeof *q), *v = g_new0(double, n);
  uint8_t *held = g_new0(uint8_t, n / 3);
  double h = rig->description.solver.time_step;
  double residual = sofa_run(model, rig->description.gravity, held, h, 1, 1000, q, v);
  g_assert_cmpfloat(residual, <=, SOFA_TOLERANCE);
  for (size_t i = 0; i < n; i += 3) g_assert_cmpfloat_with_epsilon(v[i + 1], -9.81 * h, 0.02 * 9.81 * h); /* falls */
  g_free(q);
  g_free(v);
  g_free(held);
  rig_free(rig);
}

static void add(const Case *cases) {
  for (; cases->name; cases++) {
    char *path = g_strdup_printf("/sofa/%s", cases->name);
    g_test_add_data_func(path, cases, steps);
    g_free(path);
    path = g_strdup_printf("/sofa/as SOFA steps it/%s", cases->name);
    if (cases->truncated) g_test_add_data_func(path, cases, truncated);
    g_free(path);
  }
}

static void hardware(void) {
  g_assert_cmpfloat(hardware_bandwidth(1 << 16), >, 0);
  g_assert_cmpfloat(hardware_peak(), >, 0);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  add(solid_cases);
  add(net_cases);
  add(rod_cases);
  add(contact_cases);
  g_test_add_func("/sofa/hardware", hardware);
  return g_test_run();
}
