/* Links: what they hold and how well, what they leave free, when they break. */
#include <math.h>
#include <string.h>

#include "core/sim/solve/island_system.h"
#include "tests/stability/rig.h"

#define KINDS 5
static const SporeLinkType *kinds[KINDS] = {&spore_link_ball, &spore_link_hinge, &spore_link_weld, &spore_link_slide,
                                            &spore_link_port};
static const char *const kind_names[KINDS] = {"ball", "hinge", "weld", "slide", "port"};

static SporeModel *box(SporeVec3 sides, double mass) {
  SporeTriangleMesh mesh;
  shape_box(&mesh, spore_vec3(0, 0, 0), sides);
  return rig_surface_model(&spore_rigid_body, &mesh, "mass", mass, NULL);
}

static SporeLinkDescription *add_link(Rig *rig, const char *name, const SporeLinkType *kind, uint32_t a, uint32_t b,
                                      SporeVec3 point, SporeVec3 direction) {
  SporeLinkDescription link = {.name = name,
                               .type = kind,
                               .body_a = a,
                               .body_b = b,
                               .point_a = point,
                               .point_b = point,
                               .direction = direction,
                               .length = 0.02,
                               .stiffness = 1e5,
                               .damping = -1};
  g_array_append_val(rig->links, link);
  return &g_array_index(rig->links, SporeLinkDescription, rig->links->len - 1);
}

/* Two boxes side by side, joined between, thrown and turning. */
static Rig *two_boxes(const SporeLinkType *kind, double stiffness) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, 0, 0);
  SporeBodyDescription *a = rig_passive(rig, "a", box(spore_vec3(0.03, 0.02, 0.01), 0.05), NULL);
  a->velocity = spore_vec3(0.2, -0.1, 0.05);
  a->spin = spore_vec3(1, 3, -2);
  SporeBodyDescription *b = rig_passive(rig, "b", box(spore_vec3(0.04, 0.02, 0.02), 0.1), NULL);
  b->pose.position = spore_vec3(0.04, 0.005, 0);
  b->spin = spore_vec3(-2, 1, 4);
  SporeLinkDescription *link = add_link(rig, "l", kind, 0, 1, spore_vec3(0.018, 0, 0), spore_vec3(1, 0.3, -0.2));
  link->stiffness = stiffness;
  return rig;
}

/* Linear momentum, and angular about the origin. */
static void momenta(const SporeWorld *world, SporeVec3 *linear, SporeVec3 *angular) {
  *linear = *angular = spore_vec3(0, 0, 0);
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    const double *q = spore_world_q(world, b), *v = spore_world_v(world, b);
    SporeVec3 p = spore_vec3_scale(body->total_mass, spore_vec3_load(v));
    SporeMat3 inertia = body->model->type->inertia(body->model, q);
    *linear = spore_vec3_add(*linear, p);
    *angular = spore_vec3_add(*angular, spore_vec3_cross(spore_vec3_load(q), p));
    *angular = spore_vec3_add(*angular, spore_mat3_apply(inertia, spore_vec3_load(v + 3)));
  }
}

static void momentum_of(int kind, SporeIntegratorKind integrator, double h, double *linear, double *angular) {
  Rig *rig = two_boxes(kinds[kind], 1e5);
  rig->description.solver.integrator = integrator;
  rig->description.solver.time_step = h;
  rig->description.solver.tolerance = 1e-10;
  SporeWorld *world = rig_build(rig);
  SporeVec3 p0, l0, p, l;
  momenta(world, &p0, &l0);
  *linear = *angular = 0;
  for (int i = 0; i < (int)lround(0.5 / h); i++) {
    spore_world_step(world);
    momenta(world, &p, &l);
    *linear = fmax(*linear, spore_vec3_distance(p, p0) / spore_vec3_length(p0));
    *angular = fmax(*angular, spore_vec3_distance(l, l0) / spore_vec3_length(l0));
  }
  rig_free(rig);
}

/* All methods keep the linear one, and the angular one to their order. */
static void test_momentum(void) {
  static const struct {
    SporeIntegratorKind kind;
    double falls; /* by what half the step is better, at least */
  } methods[] = {{SPORE_INTEGRATOR_SYMPLECTIC_EULER, 1.5},
                 {SPORE_INTEGRATOR_IMPLICIT_EULER, 1.5},
                 {SPORE_INTEGRATOR_TR_BDF2, 2.5}};
  for (int k = 0; k < KINDS; k++)
    for (size_t m = 0; m < G_N_ELEMENTS(methods); m++) {
      double linear, coarse, fine;
      momentum_of(k, methods[m].kind, 5e-4, &linear, &fine);
      momentum_of(k, methods[m].kind, 1e-3, &linear, &coarse);
      g_test_message("%s, %s: momentum to %.1e, angular to %.1e at 1 ms, %.1e at 0.5 ms", kind_names[k],
                     spore_integrator(methods[m].kind)->name, linear, coarse, fine);
      g_assert_cmpfloat(linear, <, 1e-9);
      g_assert_cmpfloat(fine * methods[m].falls, <, coarse);
    }
}

#define DOFS 12

/* The boxes moved along the j-th velocity component by `step`. */
static void nudge(const SporeWorld *world, const double *q, int j, double step, double *out) {
  double v[DOFS] = {0}, v1[DOFS];
  v[j] = step;
  for (int b = 0; b < 2; b++) spore_body_drift(&world->bodies[b], q + 7 * b, v + 6 * b, 1, out + 7 * b, v1 + 6 * b);
}

/* However the boxes stand and move, a link gives as much as it takes, and turns nothing by itself. */
static void test_opposite(void) {
  GRand *random = g_rand_new_with_seed(5);
  for (int k = 0; k < KINDS; k++) {
    Rig *rig = two_boxes(kinds[k], 1e3);
    SporeWorld *world = rig_build(rig);
    spore_world_link(world);
    spore_world_find_islands(world);
    spore_island_gather(world, &world->solve.islands[0]);
    SporeIslandSystem system = {world, &world->solve.islands[0]};
    SporeDynamics dynamics = spore_island_system_dynamics(&system);
    double q[14], v[DOFS], f[DOFS], largest = 0;
    memcpy(q, world->solve.islands[0].q0, sizeof q);
    for (int j = 0; j < DOFS; j++) nudge(world, q, j, g_rand_double_range(random, -0.01, 0.01), q);
    for (int j = 0; j < DOFS; j++) v[j] = g_rand_double_range(random, -1, 1);
    dynamics.term_force(dynamics.data, q, v, memset(f, 0, sizeof f));
    SporeVec3 sum = {0, 0, 0}, torque = {0, 0, 0};
    for (int b = 0; b < 2; b++) {
      SporeVec3 force = spore_vec3_load(f + 6 * b);
      largest = fmax(largest, spore_vec3_length(force));
      sum = spore_vec3_add(sum, force);
      torque = spore_vec3_add(torque, spore_vec3_load(f + 6 * b + 3));
      torque = spore_vec3_add(torque, spore_vec3_cross(spore_vec3_load(q + 7 * b), force));
    }
    g_assert_cmpfloat(largest, >, 0.1);
    g_assert_cmpfloat(spore_vec3_length(sum), <, 1e-13 * largest);
    g_assert_cmpfloat(spore_vec3_length(torque), <, 1e-14 * largest);
    rig_free(rig);
  }
  g_rand_free(random);
}

/* The island's matrix against central differences of its forces, where the link pulls at nothing. */
static void test_jacobian(void) {
  const double c = 0.03, c2 = 0.002;
  for (int k = 0; k < KINDS; k++) {
    Rig *rig = two_boxes(kinds[k], 1e3);
    for (guint b = 0; b < 2; b++) {
      SporeBodyDescription *body = &g_array_index(rig->bodies, SporeBodyDescription, b);
      body->velocity = body->spin = spore_vec3(0, 0, 0);
    }
    SporeWorld *world = rig_build(rig);
    spore_world_link(world);
    spore_world_find_islands(world);
    g_assert_cmpuint(world->solve.island_count, ==, 1);
    spore_island_gather(world, &world->solve.islands[0]);
    SporeIslandSystem system = {world, &world->solve.islands[0]};
    SporeDynamics dynamics = spore_island_system_dynamics(&system);
    double q[14], v[DOFS] = {0}, worst = 0, largest = 0;
    memcpy(q, world->solve.islands[0].q0, sizeof q);
    dynamics.force(dynamics.data, q, v, (double[DOFS]){0});
    dynamics.linearise(dynamics.data, q, NULL, v, c, c2);
    for (int j = 0; j < DOFS; j++) {
      double unit[DOFS] = {0}, product[DOFS], mass[DOFS], plus[DOFS], minus[DOFS], moved[14], step = 1e-6;
      unit[j] = 1;
      dynamics.multiply(dynamics.data, unit, product);
      dynamics.mass_multiply(dynamics.data, unit, mass);
      double expected[DOFS];
      nudge(world, q, j, step, moved);
      dynamics.force(dynamics.data, moved, v, plus);
      nudge(world, q, j, -step, moved);
      dynamics.force(dynamics.data, moved, v, minus);
      for (int i = 0; i < DOFS; i++) expected[i] = mass[i] + c2 * (minus[i] - plus[i]) / (2 * step);
      v[j] = step;
      dynamics.force(dynamics.data, q, v, plus);
      v[j] = -step;
      dynamics.force(dynamics.data, q, v, minus);
      v[j] = 0;
      for (int i = 0; i < DOFS; i++) {
        expected[i] += c * (minus[i] - plus[i]) / (2 * step);
        worst = fmax(worst, fabs(product[i] - expected[i]));
        largest = fmax(largest, fabs(expected[i]));
      }
    }
    g_test_message("%s: matrix to %.1e of its largest element", kind_names[k], worst / largest);
    g_assert_cmpfloat(worst, <, 1e-6 * largest);
    rig_free(rig);
  }
}

/* A rod of 0.1 kg and 0.1 m that hangs on a link of the world at its upper end and swings from the horizontal. */
static Rig *pendulum(const SporeLinkType *kind, SporeIntegratorKind integrator, double h) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.integrator = integrator;
  rig->description.solver.time_step = h;
  SporeBodyDescription *rod = rig_passive(rig, "rod", box(spore_vec3(0.1, 0.005, 0.005), 0.1), NULL);
  rod->pose.position = spore_vec3(0.05, 0, 0);
  add_link(rig, "joint", kind, 0, SPORE_NO_BODY, spore_vec3(0, 0, 0), spore_vec3(0, 0, 1));
  return rig;
}

static double largest_drift(SporeWorld *world, unsigned steps, double *load) {
  double drift = 0;
  *load = 0;
  for (unsigned i = 0; i < steps; i++) {
    spore_world_step(world);
    drift = fmax(drift, spore_world_link_state(world, 0).drift);
    *load = fmax(*load, spore_world_link_state(world, 0).load);
  }
  g_assert_true(rig_finite(world));
  return drift;
}

/* What is held together comes apart by no more than its load asks for. */
static void test_drift(void) {
  static const SporeIntegratorKind methods[] = {SPORE_INTEGRATOR_SYMPLECTIC_EULER, SPORE_INTEGRATOR_IMPLICIT_EULER,
                                                SPORE_INTEGRATOR_BDF2, SPORE_INTEGRATOR_TR_BDF2};
  static const double steps_s[] = {5e-4, 2e-3, 1e-2};
  for (int k = 0; k < 3; k++)
    for (size_t m = 0; m < G_N_ELEMENTS(methods); m++)
      for (size_t s = 0; s < G_N_ELEMENTS(steps_s); s++) {
        double load;
        Rig *rig = pendulum(kinds[k], methods[m], steps_s[s]);
        SporeWorld *world = rig_build(rig);
        double drift = largest_drift(world, (unsigned)lround(2 / steps_s[s]), &load);
        const SporeMonitor *monitor = spore_world_monitor(world);
        g_test_message("%s, %s, %g ms: apart by %.1f um at most under %.2f N (%.1f um at rest under the weight), "
                       "%llu steps not solved",
                       kind_names[k], spore_integrator(methods[m])->name, 1e3 * steps_s[s], 1e6 * drift, load,
                       1e6 * 0.981 / 1e5, (unsigned long long)monitor->not_converged);
        g_assert_cmpfloat(drift, <, 1e-3);
        g_assert_false(rig_any_frozen(world));
        rig_free(rig);
      }
}

/* The period of a rod that swings by little on a hinge: 2 pi (2 l / 3 g)^1/2. */
static void test_hinge_period(void) {
  Rig *rig = pendulum(&spore_link_hinge, SPORE_INTEGRATOR_TR_BDF2, 1e-3);
  SporeBodyDescription *rod = &g_array_index(rig->bodies, SporeBodyDescription, 0);
  double angle = -G_PI / 2 + 0.02;
  rod->pose.position = spore_vec3(0.05 * cos(angle), 0.05 * sin(angle), 0);
  rod->pose.orientation = spore_quat_from_rotation_vector(spore_vec3(0, 0, angle));
  SporeWorld *world = rig_build(rig);
  double before = spore_world_q(world, 0)[0], first = 0, last = 0;
  int crossings = 0;
  for (int i = 0; i < 4000; i++) {
    spore_world_step(world);
    double x = spore_world_q(world, 0)[0];
    if (before > 0 && x <= 0) {
      last = spore_world_time_s(world) - 1e-3 * (x / (x - before));
      if (crossings++ == 0) first = last;
    }
    before = x;
  }
  double period = (last - first) / (crossings - 1), exact = 2 * G_PI * sqrt(2 * 0.1 / (3 * 9.81));
  g_test_message("period %.6f s over %d swings, exact %.6f s", period, crossings - 1, exact);
  g_assert_cmpfloat_with_epsilon(period, exact, 1e-3 * exact);
  rig_free(rig);
}

/* A box on a line that is inclined by 30 degrees runs down it as on ice. */
static void test_slide(void) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = 1e-3;
  SporeBodyDescription *bead = rig_passive(rig, "bead", box(spore_vec3(0.01, 0.01, 0.01), 0.02), NULL);
  bead->spin = spore_vec3(0, 0, 0);
  SporeVec3 along = {sqrt(0.75), -0.5, 0};
  add_link(rig, "wire", &spore_link_slide, 0, SPORE_NO_BODY, spore_vec3(0, 0, 0), along);
  SporeWorld *world = rig_build(rig);
  rig_run(world, 500);
  SporeVec3 at = spore_vec3_load(spore_world_q(world, 0));
  double run = spore_vec3_dot(at, along), aside = spore_vec3_length(spore_vec3_add_scaled(at, -run, along));
  double exact = 0.5 * 9.81 * 0.5 * 0.25; /* g sin(30 deg) t^2 / 2 */
  g_test_message("ran %.5f m in 0.5 s, exact %.5f m; %.2e m beside the line", run, exact, aside);
  g_assert_cmpfloat_with_epsilon(run, exact, 0.003 * exact); /* implicit Euler: t h g sin / 2 */
  g_assert_cmpfloat(aside, <, 5e-6);
  rig_free(rig);
}

/* Distance of the pivot from the shaft, which is the body's z axis. */
static double miss(const SporeWorld *world, uint32_t body, SporeVec3 pivot) {
  const double *q = spore_world_q(world, body);
  SporeVec3 shaft = spore_quat_rotate(spore_quat_load(q + 3), spore_vec3(0, 0, 1));
  SporeVec3 to_pivot = spore_vec3_sub(pivot, spore_vec3_load(q));
  return spore_vec3_length(spore_vec3_cross(shaft, to_pivot));
}

typedef struct Hand {
  SporeDevice base;
  double time_s;
} Hand;

static SporeVec3 hand_at(double t) { return spore_vec3(0.03 * sin(3 * t), -0.05 * t, 0.02 * cos(5 * t) - 0.02); }

static bool hand_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                          SporeDeviceState *state) {
  *state = (SporeDeviceState){.orientation = {1, 0, 0, 0}};
  spore_vec3_store(state->position, hand_at(time_s));
  return true;
}
static void hand_close(SporeDevice *device) {}
static const SporeDeviceType hand_type = {.name = "hand", .doc = "", .exchange = hand_exchange, .close = hand_close};

/* What a device moves: its tip is where the device says, its shaft goes through the port. */
static void test_trocar_active(void) {
  const SporeVec3 pivot = {0, 0, 0.1};
  Rig *rig = rig_new();
  rig_active(rig, "grasper", rig_sphere(rig, 0.005));
  add_link(rig, "trocar", &spore_link_port, 0, SPORE_NO_BODY, pivot, spore_vec3(0, 0, 1));
  Hand hand = {.base = {&hand_type}};
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 0, &hand.base);
  double worst = 0, tip = 0;
  for (int i = 0; i < 500; i++) {
    spore_world_step(world);
    worst = fmax(worst, miss(world, 0, pivot));
    tip = fmax(tip, spore_vec3_distance(spore_vec3_load(spore_world_q(world, 0)), hand_at(spore_world_time_s(world))));
  }
  g_test_message("shaft beside the port by %.1e m, tip beside the hand by %.1e m at most", worst, tip);
  g_assert_cmpfloat(worst, <, 1e-12);
  g_assert_cmpfloat(tip, <, 1e-12);
  rig_free(rig);
}

/* A rod that falls through a port turns on it and slides through. */
static void test_trocar_passive(void) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0.5, 0, -9.81);
  rig->description.solver.time_step = 1e-3;
  SporeBodyDescription *rod = rig_passive(rig, "rod", box(spore_vec3(0.004, 0.004, 0.2), 0.1), NULL);
  rod->spin = spore_vec3(0.5, 0.3, 0);
  const SporeVec3 pivot = {0, 0, 0.02};
  add_link(rig, "trocar", &spore_link_port, 0, SPORE_NO_BODY, pivot, spore_vec3(0, 0, 1));
  SporeWorld *world = rig_build(rig);
  double worst = 0;
  for (int i = 0; i < 120; i++) {
    spore_world_step(world);
    worst = fmax(worst, miss(world, 0, pivot));
  }
  double fallen = -spore_world_q(world, 0)[2];
  g_test_message("fell %.4f m through the port, beside it by %.1e m at most", fallen, worst);
  g_assert_cmpfloat(fallen, >, 0.05);
  g_assert_cmpfloat(worst, <, 2e-5);
  rig_free(rig);
}

/* A box that hangs on a joint which holds more, or less, than its weight. */
static void test_breaking(void) {
  for (int k = 0; k < 3; k++)
    for (int weak = 0; weak < 2; weak++) {
      Rig *rig = rig_new();
      rig->description.gravity = spore_vec3(0, -9.81, 0);
      rig_passive(rig, "box", box(spore_vec3(0.02, 0.02, 0.02), 0.1), NULL);
      SporeLinkDescription *link =
          add_link(rig, "thread", kinds[k], 0, SPORE_NO_BODY, spore_vec3(0, 0.01, 0), spore_vec3(0, 0, 1));
      link->strength = weak ? 0.9 : 1.1; /* N; the weight is 0.981 N */
      SporeWorld *world = rig_build(rig);
      rig_run(world, 400);
      SporeLinkState state = spore_world_link_state(world, 0);
      g_assert_cmpint(state.broken, ==, weak);
      g_assert_cmpuint(spore_world_monitor(world)->broken_links, ==, (guint)weak);
      double y = spore_world_q(world, 0)[1];
      if (weak) {
        g_assert_true(rig_said(world, "thread: broke"));
        g_assert_cmpfloat(y, <, -1);
        spore_world_reset(world);
        g_assert_false(spore_world_link_state(world, 0).broken);
        spore_world_step(world);
        g_assert_cmpfloat_with_epsilon(spore_world_q(world, 0)[1], 0, 1e-4);
      } else {
        g_assert_cmpfloat_with_epsilon(state.load, 0.981, 1e-6);
        g_assert_cmpfloat_with_epsilon(state.force.y, 0.981, 1e-6);
        g_assert_cmpfloat_with_epsilon(state.drift, 0.981 / 1e5, 1e-8);
        g_assert_true(spore_world_body_asleep(world, 0));
      }
      rig_free(rig);
    }
}

/* Tissue and a stone that is welded to it are one island, and the stone keeps its orientation to the tissue. */
static void test_weld_tissue(void) {
  SporeTetrahedralMesh block;
  shape_block(&block, 4, 2, 2, spore_vec3(0.04, 0.02, 0.02));
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig_passive(rig, "tissue", rig_tetrahedra_model(&block, "young_modulus", 20000.0, NULL), NULL);
  for (int i = 0; i < 9; i++) rig_pin(rig, 0, spore_vec3(0, 0.01 * (i % 3), 0.01 * (i / 3)), 1e-4);
  SporeBodyDescription *stone = rig_passive(rig, "stone", box(spore_vec3(0.01, 0.01, 0.01), 0.005), NULL);
  stone->pose.position = spore_vec3(0.045, 0.01, 0.01);
  SporeLinkDescription *link =
      add_link(rig, "glue", &spore_link_weld, 1, 0, spore_vec3(0.038, 0.01, 0.01), spore_vec3(0, 0, 0));
  link->length = 0.008;
  SporeWorld *world = rig_build(rig);
  double load, drift = largest_drift(world, 500, &load);
  g_test_message("apart by %.1f um at most under %.3f N; %llu steps not solved", 1e6 * drift, load,
                 (unsigned long long)spore_world_monitor(world)->not_converged);
  g_assert_cmpfloat(drift, <, 5e-5);
  g_assert_cmpuint(spore_world_monitor(world)->not_converged, ==, 0);
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/links/momentum", test_momentum);
  g_test_add_func("/links/opposite", test_opposite);
  g_test_add_func("/links/jacobian", test_jacobian);
  g_test_add_func("/links/drift", test_drift);
  g_test_add_func("/links/hinge-period", test_hinge_period);
  g_test_add_func("/links/slide", test_slide);
  g_test_add_func("/links/trocar-active", test_trocar_active);
  g_test_add_func("/links/trocar-passive", test_trocar_passive);
  g_test_add_func("/links/breaking", test_breaking);
  g_test_add_func("/links/weld-tissue", test_weld_tissue);
  return g_test_run();
}
