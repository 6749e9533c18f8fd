/* Curve joints: a bead slides along a wire, a thread slides through rings. */
#include <math.h>
#include <string.h>

#include "core/sim/solve/island_system.h"
#include "tests/stability/rig.h"

static SporeModel *box(double side, double mass) {
  SporeTriangleMesh mesh;
  shape_box(&mesh, spore_vec3(0, 0, 0), spore_vec3(side, side, side));
  return rig_surface_model(&spore_rigid_body, &mesh, "mass", mass, NULL);
}

/* From `at(0)` to `at(1)`. */
static SporeModel *thread(SporeVec3 (*at)(double), int points, double young, double bending, double density,
                          double damping) {
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, (size_t)points, NULL));
  for (int i = 0; i < points; i++) {
    spore_vec3_store(curve.points + 4 * i, at((double)i / (points - 1)));
    curve.points[4 * i + 3] = 0.0005;
  }
  return rig_curve_model(&spore_spline_1d, &curve, "control_points", (double)points, "young_modulus", young, "density",
                         density, "bending_scale", bending, "straight_at_rest", 1.0, "damping", damping, NULL);
}

/* Three turns, about the vertical, downward. */
#define HELIX_RADIUS 0.02
#define HELIX_PITCH 0.02
#define HELIX_TURNS 3

static SporeVec3 helix(double t) {
  double angle = 2 * G_PI * HELIX_TURNS * t;
  return spore_vec3(HELIX_RADIUS * cos(angle), -HELIX_PITCH * HELIX_TURNS * t, HELIX_RADIUS * sin(angle));
}

/* How far a bead runs along a helix in `time_s`, beside it by `off` at most. */
static double run_down(SporeIntegratorKind integrator, double h, double time_s, double *off, double *energy) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = h;
  rig->description.solver.integrator = integrator;
  SporeBodyDescription *bead = rig_passive(rig, "bead", box(0.002, 0.001), NULL);
  bead->pose.position = helix(0.02);
  rig_passive(rig, "wire", thread(helix, 120, 1e9, 1, 1000, 0), NULL);
  rig_pin(rig, 1, helix(0.5), 1);
  rig_link(rig, "bead", &spore_link_slide, 0, 1, helix(0.02));
  SporeWorld *world = rig_build(rig);
  double start = rig_energy(world);
  *off = *energy = 0;
  for (int i = 0; i < (int)lround(time_s / h); i++) {
    spore_world_step(world);
    SporeVec3 p = spore_vec3_load(spore_world_q(world, 0));
    *off = fmax(*off, fabs(hypot(p.x, p.z) - HELIX_RADIUS));
    *energy = fmax(*energy, fabs(rig_energy(world) - start));
  }
  double fallen = helix(0.02).y - spore_world_q(world, 0)[1];
  *energy /= 0.001 * 9.81 * fallen;
  g_assert_cmpuint(spore_world_monitor(world)->not_converged, ==, 0);
  rig_free(rig);
  return fallen * hypot(2 * G_PI * HELIX_RADIUS, HELIX_PITCH) / HELIX_PITCH;
}

/* s = g sin(slope) t^2 / 2, however the wire turns, and no energy is lost to the wire, but by the method: to its order.
 */
static void test_helix(void) {
  static const struct {
    SporeIntegratorKind kind;
    double error, falls; /* at 1 ms; by what half the step is better, at least */
  } methods[] = {{SPORE_INTEGRATOR_IMPLICIT_EULER, 0.1, 1.5},
                 {SPORE_INTEGRATOR_BDF2, 3e-3, 3},
                 {SPORE_INTEGRATOR_TR_BDF2, 5e-4, 3},
                 {SPORE_INTEGRATOR_SYMPLECTIC_EULER, 0.1, 1.5}};
  double slope = HELIX_PITCH / hypot(2 * G_PI * HELIX_RADIUS, HELIX_PITCH), time_s = 0.6;
  double exact = 0.5 * 9.81 * slope * time_s * time_s;
  for (size_t m = 0; m < G_N_ELEMENTS(methods); m++) {
    double error[2], off, energy;
    for (int i = 0; i < 2; i++) {
      double h = i ? 1e-3 : 2e-3, run = run_down(methods[m].kind, h, time_s, &off, &energy);
      error[i] = fabs(run / exact - 1);
      g_test_message("%s, %g ms: ran %.5f m, exact %.5f m (%.1e); beside the wire by %.1f um at most; energy to %.1e",
                     spore_integrator(methods[m].kind)->name, 1e3 * h, run, exact, run / exact - 1, 1e6 * off, energy);
      g_assert_cmpfloat(off, <, 5e-6);
    }
    g_assert_cmpfloat(error[1], <, methods[m].error);
    g_assert_cmpfloat(error[1] * methods[m].falls, <, error[0]);
  }
}

/* Up to a pulley, half around it, down. */
#define THREAD_LENGTH 0.12
#define THREAD_DENSITY 100.
#define PULLEY_RADIUS 0.01
#define RINGS 13

static SporeVec3 over_pulley(double t) {
  double arc = G_PI * PULLEY_RADIUS, straight = 0.5 * (THREAD_LENGTH - arc), s = t * THREAD_LENGTH;
  if (s < straight) return spore_vec3(-PULLEY_RADIUS, s - straight, 0);
  if (s > straight + arc) return spore_vec3(PULLEY_RADIUS, straight + arc - s, 0);
  double angle = (s - straight) / PULLEY_RADIUS;
  return spore_vec3(-PULLEY_RADIUS * cos(angle), PULLEY_RADIUS * sin(angle), 0);
}

/* Two weights on a light thread through rings that stand around half a pulley. */
static Rig *pulley(double light, double heavy, double friction, double damping) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.integrator = SPORE_INTEGRATOR_TR_BDF2;
  rig->description.solver.time_step = 1e-3;
  rig_passive(rig, "thread", thread(over_pulley, 96, 1e8, 0.02, THREAD_DENSITY, damping), NULL);
  rig_passive(rig, "light", box(0.002, light), NULL)->pose.position = over_pulley(0);
  rig_passive(rig, "heavy", box(0.002, heavy), NULL)->pose.position = over_pulley(1);
  rig_link(rig, "knot 1", &spore_link_ball, 1, 0, over_pulley(0));
  rig_link(rig, "knot 2", &spore_link_ball, 2, 0, over_pulley(1));
  double share = G_PI * PULLEY_RADIUS / THREAD_LENGTH;
  for (int i = 0; i < RINGS; i++) {
    double t = 0.5 + share * ((double)i / (RINGS - 1) - 0.5);
    rig_link(rig, "ring", &spore_link_port, 0, SPORE_NO_BODY, over_pulley(t))->friction = friction;
  }
  return rig;
}

/* (m1 - m2) g / (m1 + m2); and without friction the thread pulls as much on either side, as much as that leaves. */
static void test_atwood(void) {
  const double heavy = 0.012, light = 0.008, time_s = 0.15;
  Rig *rig = pulley(light, heavy, 0, 0);
  SporeWorld *world = rig_build(rig);
  double mass = G_PI * 2.5e-7 * THREAD_LENGTH * THREAD_DENSITY, mean[2] = {0, 0};
  double exact = 0.5 * time_s * time_s * (heavy - light) * 9.81 / (heavy + light + mass);
  for (int i = 0; i < 150; i++) {
    spore_world_step(world);
    for (size_t k = 0; i >= 50 && k < 2; k++) mean[k] += spore_world_link_state(world, k).force.y / 100;
  }
  double fallen = over_pulley(1).y - spore_world_q(world, 2)[1], tension = 2 * heavy * light * 9.81 / (heavy + light);
  g_test_message("fell %.5f m, by the formula %.5f m; pulled by %.4f and %.4f N, by the formula %.4f N", fallen, exact,
                 mean[0], mean[1], tension);
  g_assert_cmpfloat_with_epsilon(fallen, exact, 0.015 * exact);
  g_assert_cmpfloat_with_epsilon(mean[0], mean[1], 0.005 * tension);
  g_assert_cmpfloat_with_epsilon(mean[0], tension, 0.02 * tension);
  g_assert_cmpuint(spore_world_monitor(world)->not_converged, ==, 0);
  rig_free(rig);
}

/* How far the heavier weight gets in 0.2 s, how fast it is then, and as what the thread pulls at the two. */
static double capstan(double weights, double friction, double *speed, double *pulls) {
  Rig *rig = pulley(0.008, weights * 0.008, friction, 0.02);
  SporeWorld *world = rig_build(rig);
  rig_run(world, 200);
  double fallen = over_pulley(1).y - spore_world_q(world, 2)[1];
  *speed = spore_world_v(world, 2)[1];
  *pulls = spore_world_link_state(world, 1).force.y / spore_world_link_state(world, 0).force.y;
  rig_free(rig);
  return fallen;
}

/* Around half a turn a thread holds e^(mu pi) times what pulls on its other side, and slides with what is above. */
static void test_capstan(void) {
  const double friction = 0.2, most = exp(friction * G_PI);
  static const double parts[] = {0.95, 1.1, 1.2};
  for (size_t i = 0; i < G_N_ELEMENTS(parts); i++) {
    double weights = parts[i] * most, speed, pulls, fallen = capstan(weights, friction, &speed, &pulls);
    double exact = 0.5 * 0.04 * 9.81 * (weights - most) / (weights + most);
    g_test_message("weights as %.3f, the most %.3f: fell by %.5f m, by the formula %.5f m; at %.1e m/s; pulls as %.3f",
                   weights, most, fallen, fmax(exact, 0), speed, pulls);
    if (parts[i] < 1) {
      g_assert_cmpfloat(fallen, <, 2e-4); /* what the thread stretches */
      g_assert_cmpfloat(fabs(speed), <, 1e-6);
      continue;
    }
    g_assert_cmpfloat_with_epsilon(fallen, exact, 0.05 * exact);
    g_assert_cmpfloat_with_epsilon(pulls, most, 0.04 * most);
  }
}

/* A bead on an arc of thread; moving: thrown and turning, and held beside its middle. */
static SporeVec3 arc(double t) { return spore_vec3(0.05 * cos(2 * t), 0.05 * sin(2 * t), 0.01 * t); }

static Rig *thrown(SporeIntegratorKind integrator, double h, double stiffness, bool moving) {
  Rig *rig = rig_new();
  rig->description.solver.integrator = integrator;
  rig->description.solver.time_step = h;
  rig->description.solver.tolerance = 1e-10;
  SporeBodyDescription *bead = rig_passive(rig, "bead", box(0.01, 0.002), NULL);
  bead->pose.position = moving ? spore_vec3_add(arc(0.4), spore_vec3(0.003, 0, 0.002)) : arc(0.4);
  bead->velocity = moving ? spore_vec3(-0.3, 0.4, 0.1) : spore_vec3(0, 0, 0);
  bead->spin = moving ? spore_vec3(1, 3, -2) : spore_vec3(0, 0, 0);
  SporeBodyDescription *line = rig_passive(rig, "thread", thread(arc, 12, 1e6, 1, 1000, 0.01), NULL);
  line->velocity = moving ? spore_vec3(0.1, 0.1, 0) : spore_vec3(0, 0, 0);
  line->spin = moving ? spore_vec3(0, 1, 2) : spore_vec3(0, 0, 0);
  rig_link(rig, "slide", &spore_link_slide, 0, 1, arc(0.4))->stiffness = stiffness;
  return rig;
}

static void momenta(const SporeWorld *world, const double *q, const double *v, SporeVec3 *linear, SporeVec3 *angular) {
  *linear = *angular = spore_vec3(0, 0, 0);
  for (uint32_t b = 0; b < 2; b++) {
    const SporeModel *model = world->bodies[b].model;
    const double *x = q + world->bodies[b].q_offset, *w = v + world->bodies[b].v_offset;
    for (size_t i = 0; i < model->node_count; i++) {
      SporeVec3 p = spore_vec3_scale(model->block_mass[i], spore_vec3_load(w + 3 * i));
      *linear = spore_vec3_add(*linear, p);
      *angular = spore_vec3_add(*angular, spore_vec3_cross(spore_vec3_load(x + 3 * i), p));
    }
    if (spore_model_is_nodal(model)) continue;
    SporeMat3 inertia = model->type->inertia(model, x);
    *angular = spore_vec3_add(*angular, spore_mat3_apply(inertia, spore_vec3_load(w + 3)));
  }
}

/* All methods keep the linear one, and the angular one to their order. */
static void test_momentum(void) {
  static const struct {
    SporeIntegratorKind kind;
    double falls; /* by what half the step is better, at least */
  } methods[] = {{SPORE_INTEGRATOR_IMPLICIT_EULER, 1.5}, {SPORE_INTEGRATOR_TR_BDF2, 2.5}};
  for (size_t m = 0; m < G_N_ELEMENTS(methods); m++) {
    double off[2] = {0, 0}, linear = 0;
    for (int i = 0; i < 2; i++) {
      double h = i ? 2.5e-4 : 5e-4;
      Rig *rig = thrown(methods[m].kind, h, 1e4, true);
      SporeWorld *world = rig_build(rig);
      SporeVec3 p0, l0, p, l;
      momenta(world, world->state.q, world->state.v, &p0, &l0);
      for (int k = 0; k < (int)lround(0.1 / h); k++) {
        spore_world_step(world);
        momenta(world, world->state.q, world->state.v, &p, &l);
        linear = fmax(linear, spore_vec3_distance(p, p0) / spore_vec3_length(p0));
        off[i] = fmax(off[i], spore_vec3_distance(l, l0) / spore_vec3_length(l0));
      }
      double slid = fabs(spore_world_link_state(world, 0).along - 0.4);
      g_assert_cmpfloat(slid, >, 0.05);
      rig_free(rig);
    }
    g_test_message("%s: momentum to %.1e, angular to %.1e at 0.5 ms, %.1e at 0.25 ms",
                   spore_integrator(methods[m].kind)->name, linear, off[0], off[1]);
    g_assert_cmpfloat(linear, <, 1e-9);
    g_assert_cmpfloat(off[1] * methods[m].falls, <, off[0]);
  }
}

/* The one island of a world, as its integrator sees it at the start; the bead a millimetre off the thread where
 * `loaded`. */
typedef struct Island {
  SporeIslandSystem system;
  SporeDynamics dynamics;
  double q[7 + 36];
} Island;
#define DOFS (6 + 36)

static void island_of(Island *island, SporeWorld *world, bool loaded) {
  spore_world_link(world);
  spore_world_find_islands(world);
  g_assert_cmpuint(world->solve.island_count, ==, 1);
  spore_island_gather(world, &world->solve.islands[0]);
  island->system = (SporeIslandSystem){world, &world->solve.islands[0]};
  island->dynamics = spore_island_system_dynamics(&island->system);
  memcpy(island->q, world->solve.islands[0].q0, sizeof island->q);
  SporeVec3 off = loaded ? spore_vec3(0.0008, -0.0006, 0.0007) : spore_vec3(0, 0, 0);
  spore_vec3_accumulate(island->q, off);
}

/* Whatever the friction, a link gives as much as it takes; and turns nothing by itself, where nothing drags. */
static void test_opposite(void) {
  Rig *rig = thrown(SPORE_INTEGRATOR_IMPLICIT_EULER, 1e-3, 1e3, false);
  g_array_index(rig->links, SporeLinkDescription, 0).damping = 0;
  SporeWorld *world = rig_build(rig);
  Island island;
  island_of(&island, world, true);
  double v[DOFS] = {0}, f[DOFS] = {0};
  island.dynamics.term_force(island.dynamics.data, island.q, v, f);
  SporeVec3 sum = {0, 0, 0}, torque = spore_vec3_load(f + 3);
  for (int i = 0; i < 13; i++) {
    SporeVec3 force = spore_vec3_load(f + (i ? 3 + 3 * i : 0)), at = spore_vec3_load(island.q + (i ? 4 + 3 * i : 0));
    sum = spore_vec3_add(sum, force);
    torque = spore_vec3_add(torque, spore_vec3_cross(at, force));
  }
  double size = spore_vec3_length(spore_vec3_load(f));
  g_test_message("%.3f N; together %.1e N, %.1e N m", size, spore_vec3_length(sum), spore_vec3_length(torque));
  g_assert_cmpfloat(size, >, 0.1);
  g_assert_cmpfloat(spore_vec3_length(sum), <, 1e-13 * size);
  g_assert_cmpfloat(spore_vec3_length(torque), <, 1e-12 * size);
  rig_free(rig);
}

static void nudge(const SporeWorld *world, const double *q, int j, double step, double *out) {
  double v[DOFS] = {0}, v1[DOFS];
  v[j] = step;
  spore_body_drift(&world->bodies[0], q, v, 1, out, v1);
  spore_body_drift(&world->bodies[1], q + 7, v + 6, 1, out + 7, v1 + 6);
}

/* The island's matrix against central differences of its forces, by position and by velocity. */
static double matrix_error(bool loaded) {
  const double c = 0.03, c2 = 0.002, step = 1e-7;
  Rig *rig = thrown(SPORE_INTEGRATOR_IMPLICIT_EULER, 1e-3, 1e3, false);
  SporeWorld *world = rig_build(rig);
  Island island;
  island_of(&island, world, loaded);
  SporeDynamics *dynamics = &island.dynamics;
  double v[DOFS] = {0}, worst = 0, largest = 0, moved[7 + 36];
  dynamics->force(dynamics->data, island.q, v, (double[DOFS]){0});
  dynamics->linearise(dynamics->data, island.q, NULL, v, c, c2);
  for (int j = 0; j < DOFS; j++) {
    double unit[DOFS] = {0}, product[DOFS], mass[DOFS], plus[DOFS], minus[DOFS], faster[DOFS], slower[DOFS];
    unit[j] = 1;
    dynamics->multiply(dynamics->data, unit, product);
    dynamics->mass_multiply(dynamics->data, unit, mass);
    nudge(world, island.q, j, step, moved);
    dynamics->force(dynamics->data, moved, v, plus);
    nudge(world, island.q, j, -step, moved);
    dynamics->force(dynamics->data, moved, v, minus);
    v[j] = step;
    dynamics->force(dynamics->data, island.q, v, faster);
    v[j] = -step;
    dynamics->force(dynamics->data, island.q, v, slower);
    v[j] = 0;
    for (int i = 0; i < DOFS; i++) {
      double expected = mass[i] + (c2 * (minus[i] - plus[i]) + c * (slower[i] - faster[i])) / (2 * step);
      worst = fmax(worst, fabs(product[i] - expected));
      largest = fmax(largest, fabs(expected));
    }
  }
  rig_free(rig);
  return worst / largest;
}

static void test_jacobian(void) {
  double free = matrix_error(false), loaded = matrix_error(true);
  g_test_message("matrix to %.1e of its largest element, %.1e where the link bears a load", free, loaded);
  g_assert_cmpfloat(free, <, 1e-6);
  g_assert_cmpfloat(loaded, <, 1e-6);
}

/* A bead on a straight thread that is held at both ends and inclined: it stops at the end, or slips off. */
static SporeVec3 incline(double t) { return spore_vec3(0.1 * t, -0.1 * t, 0); }

static void test_ends(void) {
  for (int ends = 0; ends < 2; ends++) {
    Rig *rig = rig_new();
    rig->description.gravity = spore_vec3(0, -9.81, 0);
    rig_passive(rig, "bead", box(0.002, 0.001), NULL)->pose.position = incline(0.7);
    rig_passive(rig, "wire", thread(incline, 20, 1e9, 1, 1000, 0.01), NULL);
    rig_pin(rig, 1, incline(0.5), 1);
    rig_link(rig, "bead", &spore_link_slide, 0, 1, incline(0.7))->ends = ends;
    SporeWorld *world = rig_build(rig);
    rig_run(world, 50);
    g_assert_false(spore_world_link_state(world, 0).broken);
    rig_run(world, 450);
    SporeVec3 at = spore_vec3_load(spore_world_q(world, 0));
    g_test_message("at (%.4f, %.4f); %s", at.x, at.y, rig_last_message(world));
    g_assert_cmpint(spore_world_link_state(world, 0).broken, ==, ends == SPORE_ENDS_SLIP_OFF);
    if (ends == SPORE_ENDS_STOP) {
      g_assert_cmpfloat(spore_vec3_distance(at, incline(1)), <, 1e-5);
      g_assert_cmpfloat(spore_world_link_state(world, 0).along, ==, 1);
    } else {
      g_assert_cmpfloat(at.y, <, -0.3);
      g_assert_true(rig_said(world, "bead: slipped off"));
    }
    uint64_t hash = spore_world_hash(world);
    spore_world_reset(world);
    g_assert_cmpfloat_with_epsilon(spore_world_link_state(world, 0).along, 0.7, 1e-3);
    rig_run(world, 500);
    g_assert_cmpuint(spore_world_hash(world), ==, hash);
    rig_free(rig);
  }
}

/* A bead that is set elsewhere on its thread is found there. */
static void test_state_carried_over(void) {
  Rig *rig = thrown(SPORE_INTEGRATOR_IMPLICIT_EULER, 1e-3, 1e4, false);
  SporeWorld *world = rig_build(rig);
  double q[7] = {0, 0, 0, 1, 0, 0, 0}, v[6] = {0};
  spore_vec3_store(q, arc(0.9));
  spore_world_set_state(world, 0, q, v);
  g_assert_cmpfloat_with_epsilon(spore_world_link_state(world, 0).along, 0.9, 0.02);
  g_assert_cmpfloat(spore_world_link_state(world, 0).drift, <, 1e-4);
  rig_free(rig);
}

static void test_refused(void) {
  static const char *const words[] = {"off the line", "must not be negative", "has none of its own"};
  for (int fault = 0; fault < 3; fault++) {
    Rig *rig = thrown(SPORE_INTEGRATOR_IMPLICIT_EULER, 1e-3, 1e4, false);
    SporeTetrahedralMesh block;
    shape_block(&block, 1, 1, 1, spore_vec3(0.01, 0.01, 0.01));
    rig_passive(rig, "tissue", rig_tetrahedra_model(&block, NULL), NULL);
    SporeLinkDescription *link = &g_array_index(rig->links, SporeLinkDescription, 0);
    if (fault == 0) link->point_a = spore_vec3_add(link->point_a, spore_vec3(0.01, 0, 0));
    if (fault == 1) link->friction = -1;
    if (fault == 2) link->body_b = 2;
    SporeError error = SPORE_ERROR_INIT;
    g_assert_null(rig_try_build(rig, &error));
    g_test_message("%s: %s", error.place, error.message);
    g_assert_cmpstr(error.place, ==, "links/slide");
    g_assert_nonnull(strstr(error.message, words[fault]));
    rig_free(rig);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/curve_joint/helix", test_helix);
  g_test_add_func("/curve_joint/atwood", test_atwood);
  g_test_add_func("/curve_joint/capstan", test_capstan);
  g_test_add_func("/curve_joint/momentum", test_momentum);
  g_test_add_func("/curve_joint/opposite", test_opposite);
  g_test_add_func("/curve_joint/jacobian", test_jacobian);
  g_test_add_func("/curve_joint/ends", test_ends);
  g_test_add_func("/curve_joint/state-carried-over", test_state_carried_over);
  g_test_add_func("/curve_joint/refused", test_refused);
  return g_test_run();
}
