/* Devices that go mad: cases 19 and 20. And springs to what does not move: case 32. */
#include <math.h>
#include <string.h>

#include "core/haptic/guard.h"
#include "tests/stability/rig.h"

typedef enum Madness { NOT_A_NUMBER, INFINITE, ZERO_QUATERNION, JUMP, SILENT, MADNESS_COUNT } Madness;
static const char *const madness_names[] = {"NaN", "infinity", "a quaternion of no length", "a jump of 1 m", "silence"};

/* Stands still, is mad from step 20 to 29, and keeps the greatest force it was told. */
typedef struct MadDevice {
  SporeDevice base;
  Madness madness;
  unsigned calls;
  double force;
  gboolean finite;
} MadDevice;

static bool mad_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                         SporeDeviceState *state) {
  MadDevice *mad = (MadDevice *)device;
  SporeVec3 force = spore_vec3_load(command->force);
  mad->force = fmax(mad->force, spore_vec3_length(force));
  mad->finite = mad->finite && isfinite(force.x + force.y + force.z);
  *state = (SporeDeviceState){.position = {0, 0.005, 0}, .orientation = {1, 0, 0, 0}};
  unsigned call = mad->calls++;
  if (call < 20 || call >= 30) return true;
  if (mad->madness == NOT_A_NUMBER) state->position[call % 3] = NAN, state->velocity[0] = NAN;
  if (mad->madness == INFINITE) state->position[call % 3] = call % 2 ? INFINITY : -INFINITY;
  if (mad->madness == ZERO_QUATERNION) state->orientation[0] = 0;
  if (mad->madness == JUMP) state->position[1] = -1;
  return mad->madness != SILENT;
}

static void mad_close(SporeDevice *device) {}
static const SporeDeviceType mad_type = {.name = "mad", .doc = "", .exchange = mad_exchange, .close = mad_close};

/* A probe rests on a block of tissue. */
static void mad(Madness madness, const char *label) {
  SporeTetrahedralMesh block;
  shape_block(&block, 4, 2, 4, spore_vec3(0.04, 0.02, 0.04));
  Rig *rig = rig_new();
  const SporeSphereSet *spheres = rig_spheres(rig, block.vertices, block.vertex_count, 0.005);
  SporeBodyDescription *tissue = rig_passive(rig, "tissue", rig_tetrahedra_model(&block, NULL), spheres);
  tissue->pose.position = spore_vec3(-0.02, -0.024, -0.02);
  for (int i = 0; i < 25; i++) rig_pin(rig, 0, spore_vec3(0.01 * (i % 5) - 0.02, -0.024, 0.01 * (i / 5) - 0.02), 1e-4);
  SporeBodyDescription *probe = rig_active(rig, "probe", rig_sphere(rig, 0.005));
  probe->pose.position = spore_vec3(0, 0.005, 0);
  MadDevice device = {.base = {&mad_type}, .madness = madness, .finite = TRUE};
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 1, &device.base);
  double most = 0;
  for (int i = 0; i < 100; i++) {
    spore_world_step(world);
    most = fmax(most, spore_world_energy(world).kinetic);
  }
  const SporeMonitor *monitor = spore_world_monitor(world);
  g_test_message("%s: %s: %u inputs held, force at most %.2f N, kinetic energy at most %.2e J; %s", label,
                 madness_names[madness], (unsigned)monitor->held_inputs, device.force, most, rig_last_message(world));
  g_assert_true(rig_finite(world));
  g_assert_false(rig_any_frozen(world));
  g_assert_true(device.finite);
  g_assert_cmpfloat(device.force, <=, SPORE_GUARD_LIMITS.force * (1 + 1e-12));
  if (madness != SILENT) {
    g_assert_cmpuint(monitor->held_inputs, >, 0);
    g_assert_true(rig_said(world, "probe: "));
  }
  /* No more than if the whole tissue went along with a tool at the guard's limit. */
  double mass = spore_model_total_mass(spore_world_body_model(world, 0));
  g_assert_cmpfloat(most, <, 0.5 * mass * SPORE_GUARD_LIMITS.speed * SPORE_GUARD_LIMITS.speed);
  rig_free(rig);
}

static void case_19(void) {
  mad(NOT_A_NUMBER, "case 19");
  mad(INFINITE, "case 19");
  mad(ZERO_QUATERNION, "case 19");
  mad(SILENT, "case 19");
}

static void case_20(void) { mad(JUMP, "case 20"); }

static void tie(Rig *rig, guint a, guint b, SporeVec3 at, double stiffness) {
  SporeLinkDescription link = {.name = "tie",
                               .type = &spore_link_spring,
                               .body_a = a,
                               .body_b = b,
                               .point_a = at,
                               .point_b = at,
                               .stiffness = stiffness,
                               .damping = 0.1,
                               .rest_length = 0};
  g_array_append_val(rig->links, link);
}

/* Case 32: tissue tied by springs of no length to an unmovable body, to the world and to a frozen neighbour. */
static void case_32(void) {
  for (int decade = 1; decade <= 7; decade += 3) {
    Rig *rig = rig_new();
    rig->description.gravity = spore_vec3(0, -9.81, 0);
    for (int i = 0; i < 2; i++) {
      SporeTetrahedralMesh block;
      shape_block(&block, 2, 2, 2, spore_vec3(0.02, 0.02, 0.02));
      SporeBodyDescription *body = rig_passive(rig, i ? "right" : "left", rig_tetrahedra_model(&block, NULL), NULL);
      body->pose.position = spore_vec3(0.02 * i, 0, 0);
    }
    rig_unmovable(rig, "wall", NULL);
    tie(rig, 0, 2, spore_vec3(0, 0.02, 0), pow(10, decade));
    tie(rig, 0, SPORE_NO_BODY, spore_vec3(0, 0, 0.02), pow(10, decade));
    tie(rig, 0, 1, spore_vec3(0.02, 0.02, 0.02), pow(10, decade));
    SporeWorld *world = rig_build(rig);
    double start = rig_energy(world), most = -HUGE_VAL;
    for (int i = 0; i < 500; i++) {
      spore_world_step(world);
      most = fmax(most, rig_energy(world));
    }
    g_test_message("case 32: ties of 1e%d N/m: energy at most %+.1e J above the start, %u not converged", decade,
                   most - start, (unsigned)spore_world_monitor(world)->not_converged);
    g_assert_true(rig_finite(world));
    g_assert_false(rig_any_frozen(world));
    g_assert_cmpfloat(most - start, <, 1e-9);
    rig_free(rig);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/19_not_finite_device", case_19);
  g_test_add_func("/stability/20_jumping_device", case_20);
  g_test_add_func("/stability/32_anchors", case_32);
  return g_test_run();
}
