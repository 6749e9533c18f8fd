/* One step and many: motion against what is known about it. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/sim/chain_model.h"

#define GRAVITY ((SporeVec3){0, -9.81, 0})

static SporeWorld *create(SporeWorldDescription *description) {
  SporeError error = SPORE_ERROR_INIT;
  SporeWorld *world = spore_world_create(description, NULL, &error);
  if (!world) g_error("%s: %s", error.place, error.message);
  return world;
}

static SporeModel *particle(double mass) {
  return chain_create((ChainFields){.count = 1, .mass = mass, .spacing = 1, .poison_at = HUGE_VAL});
}

static void run(SporeWorld *world, int steps) {
  for (int i = 0; i < steps; i++) spore_world_step(world);
}

/* Symplectic Euler: v_n = n h g, x_n = x_0 + h^2 g n (n + 1) / 2; implicit Euler too, its force being constant. */
static void test_free_fall(gconstpointer data) {
  SporeBodyDescription body = passive_body("ball", particle(2), (SporeVec3){0, 1, 0});
  SporeWorldDescription description = world_description(&body, 1);
  description.gravity = GRAVITY;
  description.solver.integrator = GPOINTER_TO_INT(data);
  SporeWorld *world = create(&description);
  double h = description.solver.time_step;
  run(world, 100);
  const double *q = spore_world_q(world, 0), *v = spore_world_v(world, 0);
  g_assert_cmpfloat_with_epsilon(v[1], -9.81 * 100 * h, 1e-12);
  g_assert_cmpfloat_with_epsilon(q[1], 1 - 9.81 * h * h * 100 * 101 / 2, 1e-12);
  g_assert_cmpfloat(q[0], ==, 0);
  g_assert_cmpuint(spore_world_step_count(world), ==, 100);
  g_assert_cmpfloat_with_epsilon(spore_world_time_s(world), 100 * h, 1e-15);
  spore_world_free(world);
}

static SporeWorld *oscillator(SporeIntegratorKind integrator, double h, SporeNonlinearKind nonlinear,
                              SporeLinearKind linear) {
  SporeModel *model =
      chain_create((ChainFields){.count = 2, .mass = 0.5, .spacing = 1, .stiffness = 40, .poison_at = HUGE_VAL});
  SporeBodyDescription body = passive_body("pair", model, (SporeVec3){0, 0, 0});
  SporeWorldDescription description = world_description(&body, 1);
  description.solver.integrator = integrator;
  description.solver.nonlinear = nonlinear;
  description.solver.linear = linear;
  description.solver.tolerance = 1e-10;
  description.solver.time_step = h;
  SporeWorld *world = create(&description);
  const double q[6] = {-0.1, 0, 0, 1.1, 0, 0}, v[6] = {0, 0.3, 0, 0, -0.3, 0};
  spore_world_set_state(world, 0, q, v);
  return world;
}

static double total(const SporeWorld *world) {
  SporeEnergy energy = spore_world_energy(world);
  return energy.kinetic + energy.internal + energy.gravity + energy.contact;
}

static void test_oscillator_energy(void) {
  SporeWorld *world =
      oscillator(SPORE_INTEGRATOR_SYMPLECTIC_EULER, 0.002, SPORE_NONLINEAR_NEWTON, SPORE_LINEAR_AUTOMATIC);
  double start = total(world), worst = 0;
  for (int i = 0; i < 100000; i++) {
    spore_world_step(world);
    worst = fmax(worst, fabs(total(world) - start));
  }
  g_assert_cmpfloat(start, >, 0.5);
  g_assert_cmpfloat(worst, <, 0.03 * start); /* of order h omega, without drift */
  spore_world_free(world);
}

static void solved_state(SporeIntegratorKind integrator, double h, SporeNonlinearKind nonlinear, SporeLinearKind linear,
                         double *q) {
  SporeWorld *world = oscillator(integrator, h, nonlinear, linear);
  run(world, (int)lround(0.5 / h));
  memcpy(q, spore_world_q(world, 0), 6 * sizeof *q);
  spore_world_free(world);
}

static void final_state(SporeIntegratorKind integrator, double h, SporeNonlinearKind nonlinear, double *q) {
  solved_state(integrator, h, nonlinear, SPORE_LINEAR_AUTOMATIC, q);
}

static double distance(const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < 6; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sqrt(sum);
}

/* Both are of first order: halving the step halves the error. */
static void test_order(gconstpointer data) {
  SporeIntegratorKind integrator = (SporeIntegratorKind)GPOINTER_TO_INT(data);
  double exact[6], coarse[6], fine[6];
  final_state(SPORE_INTEGRATOR_SYMPLECTIC_EULER, 1e-6, SPORE_NONLINEAR_NEWTON, exact);
  final_state(integrator, 1e-3, SPORE_NONLINEAR_NEWTON, coarse);
  final_state(integrator, 5e-4, SPORE_NONLINEAR_NEWTON, fine);
  double slope = log2(distance(coarse, exact) / distance(fine, exact));
  g_assert_cmpfloat_with_epsilon(slope, 1, 0.1);
}

/* However it is solved, it is the same step. */
static void test_solvers_agree(void) {
  double first[6], other[6];
  solved_state(SPORE_INTEGRATOR_IMPLICIT_EULER, 0.01, SPORE_NONLINEAR_NEWTON, SPORE_LINEAR_CONJUGATE_GRADIENTS, first);
  for (SporeNonlinearKind nonlinear = SPORE_NONLINEAR_AUTOMATIC; nonlinear <= SPORE_NONLINEAR_BROYDEN; nonlinear++)
    for (SporeLinearKind linear = SPORE_LINEAR_AUTOMATIC; linear <= SPORE_LINEAR_BANDED; linear++) {
      solved_state(SPORE_INTEGRATOR_IMPLICIT_EULER, 0.01, nonlinear, linear, other);
      g_assert_cmpfloat(distance(first, other), <, 1e-7);
    }
}

/* A chain that hangs from its first particle: stretch of spring i = weight below it / k. */
static void test_pin(void) {
  SporeModel *model = chain_create(
      (ChainFields){.count = 6, .mass = 0.1, .spacing = 0.2, .stiffness = 500, .damping = 0.5, .poison_at = HUGE_VAL});
  SporeBodyDescription body = passive_body("chain", model, (SporeVec3){1, 2, 3});
  SporeLinkDescription pin = {
      .name = "hook", .type = &spore_link_pin, .body_a = 0, .point_a = {1, 2, 3}, .radius = 0.01};
  SporeWorldDescription description = world_description(&body, 1);
  description.gravity = GRAVITY;
  description.links = &pin;
  description.link_count = 1;
  description.solver.time_step = 0.02;
  SporeWorld *world = create(&description);
  g_assert_cmpuint(spore_world_dof(world), ==, 15);
  run(world, 1500);
  const double *q = spore_world_q(world, 0);
  g_assert_cmpfloat(q[0], ==, 1);
  g_assert_cmpfloat(q[1], ==, 2);
  g_assert_cmpfloat(q[2], ==, 3);
  for (int i = 1; i < 6; i++) {
    double length = q[3 * i - 2] - q[3 * i + 1];
    g_assert_cmpfloat_with_epsilon(length, 0.2 + (6 - i) * 0.1 * 9.81 / 500, 1e-6);
  }
  spore_world_free(world);
}

/* Two bodies and a spring between them: what one gains the other loses. */
static void test_spring_link(gconstpointer data) {
  SporeBodyDescription bodies[2] = {passive_body("a", particle(1), (SporeVec3){0, 0, 0}),
                                    passive_body("b", particle(3), (SporeVec3){1, 0, 0})};
  bodies[0].velocity = (SporeVec3){0.3, 1, -0.2};
  SporeLinkDescription spring = {.name = "s",
                                 .type = &spore_link_spring,
                                 .body_a = 0,
                                 .body_b = 1,
                                 .point_b = {1, 0, 0},
                                 .stiffness = 50,
                                 .damping = 0.1,
                                 .rest_length = -1};
  SporeWorldDescription description = world_description(bodies, 2);
  description.links = &spring;
  description.link_count = 1;
  description.solver.integrator = GPOINTER_TO_INT(data);
  description.solver.tolerance = 1e-12;
  SporeWorld *world = create(&description);
  double start = total(world);
  for (int i = 0; i < 500; i++) {
    spore_world_step(world);
    const double *a = spore_world_v(world, 0), *b = spore_world_v(world, 1);
    g_assert_cmpfloat_with_epsilon(a[0] + 3 * b[0], 0.3, 1e-9);
    g_assert_cmpfloat_with_epsilon(a[1] + 3 * b[1], 1, 1e-9);
    g_assert_cmpfloat_with_epsilon(a[2] + 3 * b[2], -0.2, 1e-9);
  }
  g_assert_cmpuint(spore_world_counts(world).islands, ==, 1);
  g_assert_cmpfloat(total(world), <, start);
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(world);
  for (int k = 0; k < 3; k++) g_assert_cmpfloat(snapshot->reaction[k], ==, -snapshot->reaction[6 + k]);
  spore_world_free(world);
}

static const double floor_sphere[4] = {0, -1, 0, 1}, ball_sphere[4] = {0, 0, 0, 0.1};

static SporeWorld *ball_on_floor(SporeIntegratorKind integrator, double height, double damping, double h) {
  SporeSphereSet floor_set = {1, (double *)(uintptr_t)floor_sphere}, ball_set = {1, (double *)(uintptr_t)ball_sphere};
  SporeBodyDescription bodies[2] = {passive_body("ball", particle(0.2), (SporeVec3){0, height, 0}),
                                    {.name = "floor", .role = SPORE_UNMOVABLE, .pose = spore_pose_identity()}};
  bodies[1].contact = bodies[0].contact;
  bodies[0].spheres = &ball_set;
  bodies[1].spheres = &floor_set;
  bodies[0].contact.damping = bodies[1].contact.damping = damping;
  SporeWorldDescription description = world_description(bodies, 2);
  description.gravity = GRAVITY;
  description.solver.integrator = integrator;
  description.solver.time_step = h;
  description.solver.sleep_speed = 0;
  return create(&description);
}

/* Rests where the springs in series, 500 N/m, carry its weight. */
static void test_contact_rests(gconstpointer data) {
  SporeWorld *world = ball_on_floor((SporeIntegratorKind)GPOINTER_TO_INT(data), 0.1, 10, 0.002);
  run(world, 3000);
  const double *q = spore_world_q(world, 0), *v = spore_world_v(world, 0);
  g_assert_cmpuint(spore_world_counts(world).contacts, ==, 1);
  g_assert_cmpfloat_with_epsilon(q[1], 0.1 - 0.2 * 9.81 / 500, 1e-6);
  g_assert_cmpfloat(fabs(v[1]), <, 1e-6);
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(world);
  g_assert_cmpfloat_with_epsilon(snapshot->reaction[1], 0.2 * 9.81, 1e-4);
  g_assert_cmpfloat_with_epsilon(snapshot->reaction[7], -0.2 * 9.81, 1e-4);
  g_assert_cmpuint(snapshot->contact_count, ==, 1);
  g_assert_cmpfloat_with_epsilon(snapshot->contacts[0].point.y, 0, 0.005);
  spore_world_free(world);
}

/* Undamped bounces of symplectic Euler keep their energy, contact spring included; damped ones only lose. */
static void test_contact_energy(void) {
  SporeWorld *world = ball_on_floor(SPORE_INTEGRATOR_SYMPLECTIC_EULER, 0.15, 0, 1e-4);
  double start = total(world), worst = 0;
  for (int i = 0; i < 20000; i++) {
    spore_world_step(world);
    worst = fmax(worst, fabs(total(world) - start));
  }
  g_assert_cmpfloat(worst, <, 0.02 * 0.2 * 9.81 * 0.05);
  spore_world_free(world);
  world = ball_on_floor(SPORE_INTEGRATOR_IMPLICIT_EULER, 0.15, 1, 1e-3);
  double last = total(world);
  for (int i = 0; i < 2000; i++) {
    spore_world_step(world);
    g_assert_cmpfloat(total(world), <=, last + 1e-6);
    last = total(world);
  }
  spore_world_free(world);
}

/* An explicit step against contacts far stiffer than it could resolve: no blow-up. */
static void test_stiff_contact_explicit(void) {
  SporeWorld *world = ball_on_floor(SPORE_INTEGRATOR_SYMPLECTIC_EULER, 0.1, 1e6, 0.01);
  SporeCommand command = {.kind = SPORE_COMMAND_CONTACT, .contact = {.stiffness = 1e9, .damping = 1e6, .friction = 1}};
  for (uint32_t b = 0; b < 2; b++) {
    command.body = b;
    g_assert_true(spore_world_post(world, &command));
  }
  for (int i = 0; i < 1000; i++) {
    spore_world_step(world);
    g_assert_cmpfloat(fabs(spore_world_v(world, 0)[1]), <, 1);
  }
  g_assert_cmpfloat_with_epsilon(spore_world_q(world, 0)[1], 0.1, 1e-3);
  g_assert_cmpuint(spore_world_monitor(world)->recoveries, ==, 0);
  spore_world_free(world);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  gconstpointer symplectic = GINT_TO_POINTER(SPORE_INTEGRATOR_SYMPLECTIC_EULER);
  gconstpointer implicit = GINT_TO_POINTER(SPORE_INTEGRATOR_IMPLICIT_EULER);
  g_test_add_data_func("/sim/step/free-fall/symplectic", symplectic, test_free_fall);
  g_test_add_data_func("/sim/step/free-fall/implicit", implicit, test_free_fall);
  g_test_add_func("/sim/step/oscillator-energy", test_oscillator_energy);
  g_test_add_data_func("/sim/step/order/symplectic", symplectic, test_order);
  g_test_add_data_func("/sim/step/order/implicit", implicit, test_order);
  g_test_add_func("/sim/step/newton-is-broyden", test_solvers_agree);
  g_test_add_func("/sim/step/pin", test_pin);
  g_test_add_data_func("/sim/step/spring-link/symplectic", symplectic, test_spring_link);
  g_test_add_data_func("/sim/step/spring-link/implicit", implicit, test_spring_link);
  g_test_add_data_func("/sim/step/contact-rests/symplectic", symplectic, test_contact_rests);
  g_test_add_data_func("/sim/step/contact-rests/implicit", implicit, test_contact_rests);
  g_test_add_func("/sim/step/contact-energy", test_contact_energy);
  g_test_add_func("/sim/step/stiff-contact-explicit", test_stiff_contact_explicit);
  return g_test_run();
}
