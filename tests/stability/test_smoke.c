/* Smoke: rises at its speed, loses what it has to the air alone, dissolves, and comes out while a button is down. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/stability/rig.h"

#define DRAG 100.0
#define BUOYANCY 3.0

/* A cloud about the origin. */
static SporeModel *cloud(const char *name, double value) {
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.01, 0.01, 0.01));
  return rig_surface_model(&spore_smoke, &box, "drag", DRAG, "buoyancy", BUOYANCY, name, value, NULL);
}

static Rig *sky(const char *name, double value) {
  Rig *rig = rig_new();
  rig->description.solver.time_step = 2e-3;
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig_passive(rig, "smoke", cloud(name, value), NULL);
  return rig;
}

static SporeVec3 mean_speed(const SporeWorld *world) {
  size_t count = spore_world_body_model(world, 0)->node_count;
  SporeVec3 sum = {0, 0, 0};
  for (size_t i = 0; i < count; i++) sum = spore_vec3_add(sum, spore_vec3_load(spore_world_v(world, 0) + 3 * i));
  return spore_vec3_scale(1 / (double)count, sum);
}

/* In still air: v' = (b - 1) g - d v. */
static void test_rises(void) {
  Rig *rig = sky("swirl", 0);
  rig->description.solver.time_step = 1e-3;
  SporeBodyDescription *smoke = &g_array_index(rig->bodies, SporeBodyDescription, 0);
  smoke->velocity = spore_vec3(0.3, 0, 0);
  SporeWorld *world = rig_build(rig);
  double terminal = (BUOYANCY - 1) * 9.81 / DRAG, worst = 0;
  for (int i = 0; i < 100; i++) {
    spore_world_step(world);
    double left = exp(-DRAG * spore_world_time_s(world));
    SporeVec3 v = mean_speed(world);
    worst = fmax(worst, hypot(v.x - 0.3 * left, v.y - terminal * (1 - left)));
  }
  g_test_message("rises at %.4f m/s in the end, %.4f by formula; on the way off by %.2e m/s at most",
                 mean_speed(world).y, terminal, worst);
  g_assert_cmpfloat(fabs(mean_speed(world).y / terminal - 1), <, 1e-3);
  g_assert_cmpfloat(worst, <, 0.01);
  rig_free(rig);
}

/* In uneven air it neither stops nor runs away. */
static void test_swirls(void) {
  Rig *rig = sky("swirl", 0.01);
  SporeWorld *world = rig_build(rig);
  double terminal = (BUOYANCY - 1) * 9.81 / DRAG, most = 0;
  for (int i = 0; i < 500; i++) {
    spore_world_step(world);
    const double *v = spore_world_v(world, 0);
    for (size_t k = 0; k < spore_world_body_model(world, 0)->node_count; k++)
      most = fmax(most, hypot(v[3 * k], v[3 * k + 2]));
  }
  g_test_message("sideways at up to %.4f m/s, upward %.4f of %.4f m/s", most, mean_speed(world).y, terminal);
  g_assert_cmpfloat(most, >, 0.005);
  g_assert_cmpfloat(most, <, 2.01 * 0.01);
  g_assert_cmpfloat(fabs(mean_speed(world).y / terminal - 1), <, 0.1);
  rig_free(rig);
}

/* All of it is gone after its life, not before; a reset brings it back. */
static void test_dissolves(void) {
  Rig *rig = sky("life", 0.25);
  SporeWorld *world = rig_build(rig);
  size_t all = spore_world_particle_count(world, 0);
  while (spore_world_time_s(world) < 0.247) spore_world_step(world);
  g_assert_cmpuint(spore_world_particle_count(world, 0), ==, all);
  for (int i = 0; i < 3; i++) spore_world_step(world);
  g_assert_cmpuint(spore_world_particle_count(world, 0), ==, 0);
  for (int i = 0; i < 300; i++) spore_world_step(world);
  g_assert_true(rig_finite(world) && !rig_any_frozen(world));
  spore_world_reset(world);
  g_assert_cmpuint(spore_world_particle_count(world, 0), ==, all);
  rig_free(rig);
}

/* Its button is down for half a second. */
static bool press(SporeDevice *device, double time_s, const SporeDeviceCommand *command, SporeDeviceState *state) {
  (void)device;
  (void)command;
  *state = (SporeDeviceState){.orientation = {1, 0, 0, 0}, .buttons = time_s < 0.5};
  return true;
}

/* Out of the instrument while its button is down, as many as may in a second; each is gone after its life, and comes
 * again. */
static void test_emitted(void) {
  Rig *rig = sky("life", 0.25);
  static const SporeDeviceType button = {.name = "button", .exchange = press};
  SporeDevice device = {.type = &button};
  size_t all = g_array_index(rig->bodies, SporeBodyDescription, 0).model->node_count;
  rig_active(rig, "tip", rig_sphere(rig, 0.0005));
  SporeEmitterDescription mouth = {.name = "steam", .body = 0, .source = 1, .direction = {0, 1, 0}};
  spore_parameters_set_initial(&spore_emitter_parameters, &mouth.fields);
  mouth.fields.reserve = (int64_t)all;
  mouth.fields.rate = 100;
  mouth.fields.trigger = SPORE_FLOW_BUTTON;
  rig->description.emitters = &mouth;
  rig->description.emitter_count = 1;
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 1, &device);
  g_assert_cmpuint(spore_world_particle_count(world, 0), ==, 0);
  size_t most = 0;
  while (spore_world_time_s(world) < 0.5) {
    spore_world_step(world);
    most = MAX(most, spore_world_particle_count(world, 0));
  }
  g_test_message("at most %zu puffs at once, of %zu", most, all);
  g_assert_cmpuint(most, >=, 24);
  g_assert_cmpuint(most, <=, 26);
  uint64_t before = spore_allocation_count();
  while (spore_world_time_s(world) < 0.8) spore_world_step(world);
  g_assert_cmpuint(spore_allocation_count(), ==, before);
  g_assert_cmpuint(spore_world_particle_count(world, 0), ==, 0);
  rig_free(rig);
}

static void test_refused(void) {
  Rig *rig = sky("life", 1);
  SporeError error = SPORE_ERROR_INIT;
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 0.02);
  g_assert_null(rig_try_build(rig, &error));
  g_test_message("%s: %s", error.place, error.message);
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/smoke/rises", test_rises);
  g_test_add_func("/smoke/swirls", test_swirls);
  g_test_add_func("/smoke/dissolves", test_dissolves);
  g_test_add_func("/smoke/emitted", test_emitted);
  g_test_add_func("/smoke/refused", test_refused);
  return g_test_run();
}
