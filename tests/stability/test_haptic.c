/* Case 23: a hand leans on a wall of 1e5 N/m through a device that is served once a millisecond. */
#include <math.h>
#include <string.h>

#include "tests/stability/rig.h"

#define TICK_S 1e-3
#define FINE 50 /* parts of a tick in which the device and the hand move */

typedef struct Hand {
  const char *name;
  double mass, damping, stiffness; /* kg, N s/m, N/m to where it wants to be */
} Hand;

/* A Touch as its maker describes it, in one direction: mass, viscous and dry friction, encoder, greatest force. */
typedef struct Simulated {
  SporeDevice base;
  Hand hand;
  gboolean guarded;
  double y, v, goal;   /* m, m/s; where the hand wants to be */
  double given, least; /* J that the simulation took from the hand; the least so far */
  double deepest, force;
} Simulated;

static const double mass = 0.045, viscous = 0.05, dry = 0.26, resolution = 55e-6, greatest = 3.3;

static void move(Simulated *device, double force) {
  double dt = TICK_S / FINE, total = mass + device->hand.mass;
  for (int i = 0; i < FINE; i++) {
    double push = force + device->hand.stiffness * (device->goal - device->y);
    double damping = viscous + device->hand.damping;
    double v = (total * device->v + dt * push) / (total + dt * damping);
    v = copysign(fmax(fabs(v) - dt * dry / total, 0), v);
    device->given -= force * dt * v;
    device->least = fmin(device->least, device->given);
    device->y += dt * v;
    device->v = v;
  }
}

/* Held until the next tick. */
static void push(SporeDevice *base, const SporeDeviceCommand *command) {
  Simulated *device = (Simulated *)base;
  device->force = fmax(fmin(command->force[1], greatest), -greatest);
}

static bool exchange(SporeDevice *base, double time_s, const SporeDeviceCommand *command, SporeDeviceState *state) {
  Simulated *device = (Simulated *)base;
  move(device, device->force); /* since the last tick */
  /* Comes from 1 cm above, leans on the wall, taps it five times a second, and leaves. */
  device->goal = time_s < 1   ? 0.01 - 0.015 * time_s
                 : time_s < 3 ? -0.005 + 0.004 * sin(10 * G_PI * time_s) * (time_s > 2)
                              : -0.005 + 0.015 * (time_s - 3);
  *state =
      (SporeDeviceState){.position = {0, resolution * round(device->y / resolution), 0}, .orientation = {1, 0, 0, 0}};
  device->deepest = fmax(device->deepest, 0.005 - device->y);
  if (!device->guarded) push(base, command);
  return true;
}

static void close_device(SporeDevice *device) {}
/* The world guards the one that it pushes; the other takes its force as it comes. */
static const SporeDeviceType simulated_types[] = {
    {.name = "simulated", .doc = "", .exchange = exchange, .close = close_device},
    {.name = "simulated", .doc = "", .exchange = exchange, .close = close_device, .push = push}};

/* Least energy that the simulation had taken from the hand at any time, J. */
static double lean(const Hand *hand, gboolean guarded) {
  Rig *rig = rig_new();
  rig->description.solver.time_step = TICK_S;
  SporeTriangleMesh block;
  shape_box(&block, spore_vec3(0, -0.05, 0), spore_vec3(0.1, 0.1, 0.1));
  const double top[3] = {0, -0.05, 0};
  SporeBodyDescription *wall = rig_passive(rig, "wall", rig_surface_model(&spore_rigid_body, &block, "mass", 1e8, NULL),
                                           rig_spheres(rig, top, 1, 0.05));
  wall->contact.stiffness = 2e5; /* two of them in series */
  wall->contact.damping = 0;
  SporeBodyDescription *probe = rig_active(rig, "probe", rig_sphere(rig, 0.005));
  probe->contact.stiffness = 2e5;
  probe->contact.damping = 0;
  probe->pose.position = spore_vec3(0, 0.015, 0);
  Simulated device = {.base = {&simulated_types[guarded], {greatest, mass, resolution, 2e-3}},
                      .hand = *hand,
                      .guarded = guarded,
                      .y = 0.015};
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 1, &device.base);
  double strongest = 0;
  for (int i = 0; i < 4000; i++) {
    spore_world_step(world);
    strongest = fmax(strongest, fabs(device.force));
  }
  g_test_message("case 23: %s hand, %s: takes %.2f mJ from the hand in the end, %.3f mJ at the least; up to %.2f N, "
                 "%.2f mm deep, %u of 4000 forces shortened",
                 hand->name, guarded ? "guarded" : "not guarded", 1e3 * device.given, 1e3 * device.least, strongest,
                 1e3 * device.deepest, (unsigned)spore_world_monitor(world)->shortened_forces);
  g_assert_true(rig_finite(world));
  g_assert_cmpfloat(strongest, >, 0);
  rig_free(rig);
  return device.least;
}

static void case_23(void) {
  const Hand hands[] = {{"loose", 0.05, 1.5, 100}, {"firm", 0.10, 5, 300}, {"light", 0.01, 0.3, 50}};
  double worst = 0;
  for (unsigned i = 0; i < G_N_ELEMENTS(hands); i++) {
    worst = fmin(worst, lean(&hands[i], FALSE));
    g_assert_cmpfloat(lean(&hands[i], TRUE), >, -1e-5);
  }
  g_assert_cmpfloat(worst, <, -1e-3); /* it is the guard that does it */
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/23_haptic_wall", case_23);
  return g_test_run();
}
