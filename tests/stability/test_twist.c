/* Twist of the spline against the theory of thin rods (A. E. H. Love 1927, "A treatise on the mathematical theory of
 * elasticity", chapters 18 and 19): each figure with more control points, until it is the theory's. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "models/spline/spline.h"
#include "tests/stability/rig.h"
#include "tests/stability/statics.h"

#define YOUNG 1e7
#define SHEAR 4e6
#define DENSITY 1000.0
#define RADIUS 0.001

static const double bending = YOUNG * 0.25 * G_PI * RADIUS * RADIUS * RADIUS * RADIUS;
static const double torsion = SHEAR * 0.5 * G_PI * RADIUS * RADIUS * RADIUS * RADIUS;

/* Straight at rest, with control points along the curve, which is cleared. */
static SporeModel *thread_new(SporeCurve *curve, int points, double turns) {
  return rig_curve_model(&spore_spline_1d, curve, "control_points", (double)points, "young_modulus", YOUNG,
                         "twist_modulus", SHEAR, "density", DENSITY, "straight_at_rest", 1.0, "turns", turns, NULL);
}

/* Of so many points, each at(data, 0..1). */
static SporeModel *thread_along(SporeVec3 (*at)(const double *data, double part), const double *data, int points,
                                double turns) {
  enum { COUNT = 400 };
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, COUNT + 1, NULL));
  for (unsigned i = 0; i <= COUNT; i++) {
    spore_vec3_store(curve.points + 4 * i, at(data, (double)i / COUNT));
    curve.points[4 * i + 3] = RADIUS;
  }
  return thread_new(&curve, points, turns);
}

static SporeVec3 on_line(const double *length, double part) { return spore_vec3(part * length[0], 0, 0); }
static SporeVec3 on_ring(const double *radius, double part) {
  return spore_vec3(radius[0] * sin(2 * G_PI * part), radius[0] * (1 - cos(2 * G_PI * part)), 0);
}
/* data: radius, angle that it winds about z, length along z. */
static SporeVec3 on_helix(const double *data, double part) {
  return spore_vec3(data[0] * cos(data[1] * part), data[0] * sin(data[1] * part), data[2] * part);
}

/* Clamped at both ends: two control points, and an arm where the end cannot turn. */
static Statics clamped(SporeModel *model, gboolean front_turns, gboolean back_turns) {
  Statics statics = statics_new(model);
  size_t count = model->node_count / 2 + 1; /* control points; two less arms */
  statics.held[0] = statics.held[1] = statics.held[count - 1] = statics.held[count - 2] = TRUE;
  statics.held[count] = !front_turns, statics.held[2 * count - 3] = !back_turns;
  return statics;
}

/* Force and moment about the origin that the first or last end's held points bear: what they put on the line. */
static void reaction(const Statics *statics, gboolean back, SporeVec3 *force, SporeVec3 *moment) {
  size_t count = statics->model->node_count / 2 + 1;
  size_t nodes[3] = {back ? count - 1 : 0, back ? count - 2 : 1, back ? 2 * count - 3 : count};
  double *f = g_new0(double, statics->n);
  statics->model->type->force(statics->model, statics->q, statics->q, statics->still, f);
  *force = *moment = spore_vec3(0, 0, 0);
  for (int i = 0; i < 3; i++) {
    SporeVec3 fi = spore_vec3_scale(-1, spore_vec3_load(f + 3 * nodes[i]));
    *force = spore_vec3_add(*force, fi);
    *moment = spore_vec3_add(*moment, spore_vec3_cross(spore_vec3_load(statics->q + 3 * nodes[i]), fi));
  }
  g_free(f);
}

/* A rod twisted by turns bears G J times the angle over its length, and one that may turn untwists. */
static void end_torque(void) {
  double length = 0.2, turns = 0.7, expected = torsion * 2 * G_PI * turns / length;
  for (int free = 0; free < 2; free++) {
    Statics statics = clamped(thread_along(on_line, &length, 12, turns), FALSE, free);
    double before = statics.model->type->potential(statics.model, statics.q), left = statics_balance(&statics);
    SporeVec3 force, moment;
    reaction(&statics, FALSE, &force, &moment);
    double after = statics.model->type->potential(statics.model, statics.q);
    g_test_message("%s: moment %.9e N m of %.9e N m, energy %.2e of %.2e J; force left %.0e",
                   free ? "an end turns" : "clamped", moment.x, expected, after, before, left);
    if (free) g_assert_cmpfloat(after, <, 1e-6 * before);
    else g_assert_cmpfloat(fabs(fabs(moment.x) / expected - 1), <, 1e-9);
    if (!free) g_assert_cmpfloat(moment.x, <, 0); /* a right-handed screw: its beginning is turned backward */
    statics_free(&statics);
  }
}

/* omega = pi / 2 L sqrt(G / rho), of a rod held at one end that only turns. */
static void first_mode(void) {
  double length = 0.2, expected = 0.5 * G_PI / length * sqrt(SHEAR / DENSITY), error = 1;
  for (int points = 8; points <= 32; points *= 2) {
    Statics statics = clamped(thread_along(on_line, &length, points, 0), FALSE, TRUE);
    for (int i = 0; i < points; i++) statics.held[i] = TRUE;
    double found = statics_lowest_frequency(&statics, 1), now = fabs(found / expected - 1);
    statics_free(&statics);
    g_test_message("%d control points: first mode of twist %.4f rad/s of %.4f rad/s: %+.1e", points, found, expected,
                   found / expected - 1);
    g_assert_cmpfloat(now, <, 0.4 * error);
    error = now;
  }
  g_assert_cmpfloat(error, <, 1e-3);
}

/* Love's helix: a thread that is straight at rest is held in a helix by a force along its axis and a torque about it,
 *   N = (G J w cos a - E I k sin a) / R,  K = E I k cos a + G J w sin a,  k = cos^2 a / R
 * with w its twist, a its rise over the plane and R its radius. */
static void helix(void) {
  double data[3] = {0.08, 2 * G_PI, 0.24}, turns = 0.4, error = 1;
  double rise = atan2(data[2], data[0] * data[1]), length = data[2] / sin(rise), twist = 2 * G_PI * turns / length;
  double curvature = cos(rise) * cos(rise) / data[0];
  double pull = (torsion * twist * cos(rise) - bending * curvature * sin(rise)) / data[0];
  double torque = bending * curvature * cos(rise) + torsion * twist * sin(rise);
  for (int points = 20; points <= 80; points *= 2) {
    Statics statics = clamped(thread_along(on_helix, data, points, turns), FALSE, FALSE);
    double left = statics_balance(&statics);
    SporeVec3 force, moment;
    reaction(&statics, TRUE, &force, &moment);
    double now = fmax(fabs(force.z / pull - 1), fabs(moment.z / torque - 1));
    double aside = hypot(force.x, force.y) / fabs(pull);
    g_test_message("%d control points: pull %.6e N of %.6e N, torque %.6e N m of %.6e N m; aside %.1e; force left %.0e",
                   points, force.z, pull, moment.z, torque, aside, left);
    g_assert_cmpfloat(left, <, 1e-6);
    g_assert_cmpfloat(now, <, error);
    error = now / 2;
    statics_free(&statics);
  }
  g_assert_cmpfloat(error, <, 1e-2);
}

/* Whether the energy has a minimum where the thread is, by differences of its force over what is not held. `prop`: a
 * spring holds its middle in the plane. */
static gboolean is_stable(const Statics *statics, double prop) {
  size_t n = statics->n;
  double *a = g_new0(double, n *n), *ahead = g_new(double, n), *behind = g_new(double, n), step = 1e-7;
  const SporeModel *model = statics->model;
  for (size_t j = 0; j < n; j++) {
    if (statics->held[j / 3]) continue;
    double was = statics->q[j];
    memset(ahead, 0, n * sizeof *ahead);
    memset(behind, 0, n * sizeof *behind);
    statics->q[j] = was + step;
    model->type->force(model, statics->q, statics->q, statics->still, ahead);
    statics->q[j] = was - step;
    model->type->force(model, statics->q, statics->q, statics->still, behind);
    statics->q[j] = was;
    for (size_t i = 0; i < n; i++) a[i * n + j] = statics->held[i / 3] ? 0 : -(ahead[i] - behind[i]) / (2 * step);
  }
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++) a[i * n + j] = a[j * n + i] = 0.5 * (a[i * n + j] + a[j * n + i]);
  size_t middle = 3 * (statics->model->node_count / 4) + 2;
  a[middle * n + middle] += prop;
  gboolean stable = TRUE;
  for (size_t j = 0; stable && j < n; j++) {
    if (statics->held[j / 3]) continue;
    for (size_t k = 0; k < j; k++) a[j * n + j] -= a[j * n + k] * a[j * n + k];
    stable = a[j * n + j] > 0;
    a[j * n + j] = sqrt(a[j * n + j]);
    for (size_t i = j + 1; i < n; i++) {
      for (size_t k = 0; k < j; k++) a[i * n + j] -= a[i * n + k] * a[j * n + k];
      a[i * n + j] /= a[j * n + j];
    }
  }
  g_free(a);
  g_free(ahead);
  g_free(behind);
  return stable;
}

/* Turns the arms of a thread that is not twisted, each by its share of the angle, about the line. */
static void twist(Statics *statics, double angle) {
  size_t count = statics->model->node_count / 2 + 1, spans = count - 3;
  for (size_t knot = 1; knot <= spans; knot++) {
    size_t span;
    SporeSplineBasis basis = spore_spline_basis(spore_spline_uniform(spans), (double)knot, &span);
    SporeVec3 at = {0, 0, 0}, along = {0, 0, 0};
    for (size_t k = 0; k < 4; k++) {
      SporeVec3 control = spore_vec3_load(statics->q + 3 * (span + k));
      at = spore_vec3_add_scaled(at, basis.value[k], control);
      along = spore_vec3_add_scaled(along, basis.first[k], control);
    }
    along = spore_vec3_scale(angle * (double)knot / (double)spans, spore_vec3_normalise(along, along));
    double *arm = statics->q + 3 * (count + knot);
    SporeVec3 turned =
        spore_quat_rotate(spore_quat_from_rotation_vector(along), spore_vec3_sub(spore_vec3_load(arm), at));
    spore_vec3_store(arm, spore_vec3_add(at, turned));
  }
}

/* The angle, rad, up to which a thread along a curve bears twist before it leaves its shape. */
static double threshold(SporeVec3 (*at)(const double *data, double part), const double *data, int points, double prop,
                        double low, double high) {
  Statics statics = clamped(thread_along(at, data, points, 0), FALSE, FALSE);
  statics_balance(&statics);
  double *plain = g_memdup2(statics.q, statics.n * sizeof *plain);
  for (int round = 0; round < 12; round++) {
    double middle = 0.5 * (low + high);
    memcpy(statics.q, plain, statics.n * sizeof *plain);
    twist(&statics, middle);
    if (is_stable(&statics, prop)) low = middle;
    else high = middle;
  }
  g_free(plain);
  statics_free(&statics);
  return 0.5 * (low + high);
}

static void check_threshold(const char *name, SporeVec3 (*at)(const double *data, double part), double size,
                            double prop, double expected, double allowed) {
  double error = 1;
  for (int points = 12; points <= 48; points *= 2) {
    double found = threshold(at, &size, points, prop, 0.6 * expected, 1.4 * expected), now = fabs(found / expected - 1);
    g_test_message("%s, %d control points: leaves its shape at %.4f rad of %.4f rad: %+.1e", name, points, found,
                   expected, found / expected - 1);
    g_assert_cmpfloat(now, <, error);
    error = now;
  }
  g_assert_cmpfloat(error, <, allowed);
}

/* A straight rod clamped at both ends: half of M L / E I is the least root of tan x = x (A. G. Greenhill 1883; Love,
 * article 272). */
static void greenhill(void) {
  check_threshold("straight", on_line, 0.6, 0, 2 * 4.493409457909064 * bending / torsion, 0.02);
}

/* A ring leaves its plane at 2 pi sqrt 3 E I / G J of twist (J. H. Michell 1889; E. E. Zajac 1962). It may turn about
 * its tangent where it is held, at no cost: a spring at its middle takes that away, and nothing else. */
static void michell(void) {
  double radius = 0.1;
  check_threshold("ring", on_ring, radius, bending / pow(radius, 3), 2 * G_PI * sqrt(3) * bending / torsion, 0.02);
}

/* Turns about x by so much in its first second, then comes nearer by `nearer` over two more. */
typedef struct Driver {
  SporeDevice base;
  double angle, from, nearer;
} Driver;

static bool driver_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                            SporeDeviceState *state) {
  const Driver *driver = (const Driver *)device;
  double turned = 0.5 * driver->angle * fmin(time_s, 1), come = fmin(fmax(0.5 * (time_s - 1), 0), 1);
  *state = (SporeDeviceState){.position = {driver->from - come * driver->nearer, 0, 0},
                              .orientation = {cos(turned), sin(turned), 0, 0}};
  return true;
}
static void driver_close(SporeDevice *device) {}
static const SporeDeviceType driver_type = {
    .name = "driver", .doc = "", .exchange = driver_exchange, .close = driver_close};

/* A thread along x, its beginning held, its end welded to what a device moves. `radius` of the pin: with or without the
 * arm. */
static Rig *held_thread(double length, int points, double radius) {
  Rig *rig = rig_new();
  rig->description.solver.time_step = 0.004;
  rig->description.solver.tolerance = 1e-4;
  rig_passive(rig, "thread", thread_along(on_line, &length, points, 0), NULL);
  rig_active(rig, "driver", NULL)->pose.position = spore_vec3(length, 0, 0);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), radius);
  SporeLinkDescription weld = {.name = "weld",
                               .type = &spore_link_weld,
                               .body_a = 0,
                               .body_b = 1,
                               .point_a = spore_vec3(length, 0, 0),
                               .point_b = spore_vec3(length, 0, 0),
                               .length = 0.005,
                               .stiffness = 1e4,
                               .damping = -1};
  g_array_append_val(rig->links, weld);
  return rig;
}

static double internal_energy(const SporeWorld *world) {
  return spore_world_body_model(world, 0)->type->potential(spore_world_body_model(world, 0), spore_world_q(world, 0));
}

static void run_to(SporeWorld *world, double time_s) {
  while (spore_world_time_s(world) < time_s - 1e-9) spore_world_step(world);
  g_assert_true(rig_finite(world));
}

/* A quarter of a turn of the driver twists a thread whose pin takes in its arm, and turns the other as a whole. */
static void driven(void) {
  double length = 0.2, angle = 0.5 * G_PI, expected = 0.5 * torsion * angle * angle / length;
  for (int free = 0; free < 2; free++) {
    Driver driver = {.base = {&driver_type}, .angle = angle, .from = length};
    Rig *rig = held_thread(length, 60, free ? 0.0005 : 0.006);
    SporeWorld *world = rig_build(rig);
    spore_world_set_device(world, 1, &driver.base);
    run_to(world, 2);
    double energy = internal_energy(world), torque = spore_world_snapshot_acquire(world)->reaction[6 + 3];
    g_test_message("%s: energy %.4e J of %.4e J, torque on the driver %.4e N m of %.4e N m; %s",
                   free ? "free to turn" : "held", energy, expected, torque, -torsion * angle / length,
                   rig_last_message(world));
    if (free) g_assert_cmpfloat(energy, <, 1e-3 * expected);
    else g_assert_cmpfloat(fabs(energy / expected - 1), <, 0.04); /* the weld stiffens a piece of it */
    if (!free) g_assert_cmpfloat(fabs(torque * length / (torsion * angle) + 1), <, 0.04);
    rig_free(rig);
  }
}

/* Twisted by two turns and slackened, a thread leaves the plane in which one that is not twisted sags, and so gives
 * part of its twist up. */
static void coils(void) {
  double length = 0.2, aside[2], torque[2] = {0, 0};
  for (int turns = 0; turns <= 2; turns += 2) {
    Driver driver = {.base = {&driver_type}, .angle = 2 * G_PI * turns, .from = length, .nearer = 0.2 * length};
    Rig *rig = held_thread(length, 30, 0.01);
    rig->description.gravity = spore_vec3(0, -1, 0);
    SporeWorld *world = rig_build(rig);
    spore_world_set_device(world, 1, &driver.base);
    run_to(world, 1);
    torque[0] = spore_world_snapshot_acquire(world)->reaction[6 + 3];
    run_to(world, 4);
    torque[1] = spore_world_snapshot_acquire(world)->reaction[6 + 3];
    double *least = &aside[turns > 0];
    *least = 0;
    for (size_t i = 0; i < 30; i++) *least = fmax(*least, fabs(spore_world_q(world, 0)[3 * i + 2]));
    const SporeMonitor *monitor = spore_world_monitor(world);
    g_test_message("%d turns: out of the plane by %.3g mm, torque %.3e N m, then %.3e N m; %u steps not solved; %s",
                   turns, 1e3 * *least, torque[0], torque[1], (unsigned)monitor->not_converged,
                   rig_last_message(world));
    g_assert_cmpuint(monitor->not_converged, <=, turns > 0 ? 0 : 5);
    rig_free(rig);
  }
  g_assert_cmpfloat(aside[0], <, 0.02 * length);
  g_assert_cmpfloat(aside[1], >, 0.1 * length);
  g_assert_cmpfloat(fabs(torque[1]), <, 0.9 * fabs(torque[0]));
}

/* What a twisted thread cannot be is refused, and the remedy serves. */
static void refused(void) {
  static const struct {
    double points, modulus, turns;
    const char *says;
  } cases[] = {{10, 0, 1, "twist_modulus"}, {10, SHEAR, 5, "set 19 control points"}, {19, SHEAR, 5, NULL}};
  for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
    SporeError error = SPORE_ERROR_INIT;
    double ends[8] = {0, 0, 0, RADIUS, 0.2, 0, 0, RADIUS};
    SporeCurve curve = {2, ends};
    void *fields = rig_fields(&spore_spline_1d, "control_points", cases[i].points, "twist_modulus", cases[i].modulus,
                              "turns", cases[i].turns, NULL);
    SporeModel *model = spore_spline_1d.create(&(SporeGeometry){.curve = &curve}, fields, &error);
    g_test_message("%g points, %g Pa, %g turns: %s", cases[i].points, cases[i].modulus, cases[i].turns, error.message);
    g_assert_true((model != NULL) == (cases[i].says == NULL));
    if (cases[i].says) g_assert_nonnull(strstr(error.message, cases[i].says));
    if (model) spore_spline_1d.destroy(model);
    spore_free(fields);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/twist/end-torque", end_torque);
  g_test_add_func("/twist/first-mode", first_mode);
  g_test_add_func("/twist/helix", helix);
  g_test_add_func("/twist/greenhill", greenhill);
  g_test_add_func("/twist/michell", michell);
  g_test_add_func("/twist/driven", driven);
  g_test_add_func("/twist/coils", coils);
  g_test_add_func("/twist/refused", refused);
  return g_test_run();
}
