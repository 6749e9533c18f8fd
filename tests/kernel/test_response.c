/* The contact law: bounds, limits and its derivatives. */
#include <glib.h>
#include <math.h>

#include "core/collide/response.h"

static GRand *random_source;

static double uniform(double low, double high) { return g_rand_double_range(random_source, low, high); }

static SporeVec3 random_vec3(double size) {
  return (SporeVec3){uniform(-size, size), uniform(-size, size), uniform(-size, size)};
}

static const SporeContactLaw law = {.stiffness = 1000, .damping = 2, .friction = 0.4, .damping_depth = 5e-4};

static void test_law(void) {
  SporeContactMaterial soft = {100, 1, 0.2}, hard = {300, 3, 0.5}, smooth = {100, 0, 0};
  SporeContactLaw pair = spore_contact_law(&soft, &hard, 0.01, 0.02),
                  other = spore_contact_law(&hard, &soft, 0.02, 0.01);
  g_assert_cmpfloat(fabs(pair.stiffness - 75), <, 1e-12);
  g_assert_cmpfloat(fabs(pair.damping - 0.75), <, 1e-12);
  g_assert_cmpfloat(pair.friction, ==, 0.2);
  g_assert_cmpfloat(pair.damping_depth, ==, SPORE_CONTACT_DAMPING_DEPTH * 0.01);
  g_assert_cmpmem(&pair, sizeof pair, &other, sizeof other);
  pair = spore_contact_law(&soft, &smooth, 0.01, 0.01);
  g_assert_cmpfloat(pair.damping, ==, 0);
  g_assert_cmpfloat(pair.friction, ==, 0);
}

static void test_spring(void) {
  SporeVec3 up = {0, 1, 0}, still = {0, 0, 0};
  SporeVec3 force = spore_contact_force(&law, up, 2e-3, still);
  g_assert_cmpfloat(fabs(force.y - 2), <, 1e-12);
  g_assert_cmpfloat(force.x, ==, 0);
  static const double none[] = {0, -1e-3, NAN};
  for (size_t i = 0; i < G_N_ELEMENTS(none); i++) {
    force = spore_contact_force(&law, up, none[i], (SporeVec3){1, -1, 0});
    g_assert_cmpfloat(spore_vec3_length(force), ==, 0);
  }
  g_assert_cmpfloat(spore_contact_potential(&law, 2e-3), ==, 2e-3);
  g_assert_cmpfloat(spore_contact_potential(&law, -1), ==, 0);
}

/* Never attractive, friction inside the cone and against the slip, energy only ever taken. */
static void test_bounds(void) {
  for (int i = 0; i < 20000; i++) {
    SporeVec3 normal = spore_vec3_normalise(random_vec3(1), (SporeVec3){0, 1, 0});
    SporeVec3 velocity = random_vec3(pow(10, uniform(-5, 1)));
    double depth = uniform(-1e-3, 5e-3), gap_speed = spore_vec3_dot(normal, velocity);
    SporeVec3 force = spore_contact_force(&law, normal, depth, velocity);
    double pressing = spore_vec3_dot(force, normal);
    SporeVec3 friction = spore_vec3_add_scaled(force, -pressing, normal);
    SporeVec3 slip = spore_vec3_add_scaled(velocity, -gap_speed, normal);
    g_assert_cmpfloat(pressing, >=, -1e-14);
    g_assert_cmpfloat(spore_vec3_length(friction), <=, law.friction * pressing * (1 + 1e-9) + 1e-14);
    g_assert_cmpfloat(spore_vec3_dot(friction, slip), <=, 1e-14);
    double spring = law.stiffness * fmax(depth, 0);
    g_assert_cmpfloat((pressing - spring) * gap_speed, <=, 1e-12); /* power beyond the spring's */
  }
}

static void test_friction(void) {
  SporeVec3 up = {0, 1, 0};
  SporeVec3 slow = spore_contact_force(&law, up, 1e-3, (SporeVec3){0.25 * SPORE_CONTACT_SLIP_SPEED, 0, 0});
  g_assert_cmpfloat(fabs(slow.x + 0.25 * 0.4), <, 1e-12);
  SporeVec3 fast = spore_contact_force(&law, up, 1e-3, (SporeVec3){0, 0, 3});
  g_assert_cmpfloat(fabs(fast.z + 0.4), <, 1e-12);
}

/* The force starts from nothing at first touch, however fast, and has no jump anywhere. */
static void test_continuous(void) {
  SporeVec3 up = {0, 1, 0};
  for (double speed = -10; speed <= 3; speed += 0.01) {
    double before = spore_contact_force(&law, up, 1e-12, (SporeVec3){0, speed, 0}).y;
    g_assert_cmpfloat(before, <, 1e-8);
    double after = 0;
    for (double depth = 1e-12; depth < 2e-3; depth += 1e-6) {
      after = spore_contact_force(&law, up, depth, (SporeVec3){0, speed, 0}).y;
      /* k plus c s'(d) |g|, over one interval */
      g_assert_cmpfloat(fabs(after - before), <=,
                        1e-6 * (law.stiffness + 1.5 * law.damping / law.damping_depth * fabs(speed)) + 1e-9);
      before = after;
    }
  }
}

/* A point thrown out by a contact that overlaps by 90 % at the start. */
static void test_exit_speed(void) {
  for (double stiffness = 1; stiffness < 5e5; stiffness *= 10)
    for (double damping = 0; damping < 2; damping++) {
      SporeContactLaw pair = {stiffness, damping, 0, 5e-4};
      double mass = 1e-3, depth = 18e-3, speed = 0, dt_s = 1e-3 / sqrt(stiffness / mass), energy;
      double start = spore_contact_potential(&pair, depth);
      for (int step = 0; step < 200000 && depth > 0; step++) {
        speed += dt_s * spore_contact_force(&pair, (SporeVec3){0, 1, 0}, depth, (SporeVec3){0, speed, 0}).y / mass;
        depth -= dt_s * speed;
        energy = 0.5 * mass * speed * speed + spore_contact_potential(&pair, depth);
        g_assert_cmpfloat(energy, <=, start * 1.001);
        g_assert_cmpfloat(speed, <=, SPORE_CONTACT_EXIT_SPEED);
      }
      g_assert_cmpfloat(depth, <=, 0);
    }
}

static gboolean is_positive_semidefinite(SporeMat3 a) {
  double values[3], scale = spore_mat3_trace(a);
  SporeMat3 vectors;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      if (fabs(a.m[3 * i + j] - a.m[3 * j + i]) > 1e-12 * (scale + 1)) return FALSE;
  spore_mat3_eigen_symmetric(a, values, &vectors);
  return values[0] >= -1e-12 * (scale + 1);
}

static void test_semidefinite(void) {
  for (int i = 0; i < 20000; i++) {
    SporeVec3 normal = spore_vec3_normalise(random_vec3(1), (SporeVec3){0, 1, 0});
    SporeMat3 stiffness, damping;
    spore_contact_jacobian(&law, normal, uniform(-1e-3, 5e-3), random_vec3(pow(10, uniform(-5, 1))), &stiffness,
                           &damping);
    g_assert_true(is_positive_semidefinite(stiffness));
    g_assert_true(is_positive_semidefinite(damping));
  }
}

/* Against differences of the force: damping in full, stiffness along the normal (friction's change with N is left
 * out, so without friction). */
static void test_jacobian(void) {
  for (int i = 0; i < 5000; i++) {
    SporeContactLaw frictionless = law;
    frictionless.friction = 0;
    SporeVec3 normal = spore_vec3_normalise(random_vec3(1), (SporeVec3){0, 1, 0});
    SporeVec3 slip = random_vec3(pow(10, uniform(-4, 0)));
    double depth = uniform(1e-5, 3e-3), gap_speed = uniform(-1, 0); /* approaching: nothing is clamped */
    slip = spore_vec3_add_scaled(slip, -spore_vec3_dot(slip, normal), normal);
    if (fabs(spore_vec3_length(slip) - SPORE_CONTACT_SLIP_SPEED) < 1e-5) continue; /* the kink of the friction law */
    SporeVec3 velocity = spore_vec3_add_scaled(slip, gap_speed, normal);
    SporeMat3 stiffness, damping, frictionless_stiffness, unused;
    spore_contact_jacobian(&law, normal, depth, velocity, &stiffness, &damping);
    spore_contact_jacobian(&frictionless, normal, depth, velocity, &frictionless_stiffness, &unused);
    for (int axis = 0; axis < 3; axis++) {
      SporeVec3 step = {axis == 0, axis == 1, axis == 2};
      double h = 1e-9;
      SporeVec3 ahead = spore_contact_force(&frictionless, normal, depth - h * spore_vec3_dot(normal, step), velocity);
      SporeVec3 behind = spore_contact_force(&frictionless, normal, depth + h * spore_vec3_dot(normal, step), velocity);
      SporeVec3 slope = spore_vec3_scale(-0.5 / h, spore_vec3_sub(ahead, behind));
      g_assert_cmpfloat(spore_vec3_distance(slope, spore_mat3_column(frictionless_stiffness, axis)), <, 0.5);
      /* Tangential parts only: N itself changes with the approach, and friction with it. */
      SporeVec3 across = spore_vec3_add_scaled(step, -spore_vec3_dot(step, normal), normal);
      double dv = 1e-8;
      ahead = spore_contact_force(&law, normal, depth, spore_vec3_add_scaled(velocity, dv, across));
      behind = spore_contact_force(&law, normal, depth, spore_vec3_add_scaled(velocity, -dv, across));
      slope = spore_vec3_scale(-0.5 / dv, spore_vec3_sub(ahead, behind));
      g_assert_cmpfloat(spore_vec3_distance(slope, spore_mat3_apply(damping, across)), <,
                        1e-4 * (1 + spore_mat3_trace(damping)));
    }
    double dv = 1e-7;
    double ahead =
        spore_vec3_dot(normal, spore_contact_force(&law, normal, depth, spore_vec3_add_scaled(velocity, dv, normal)));
    double behind =
        spore_vec3_dot(normal, spore_contact_force(&law, normal, depth, spore_vec3_add_scaled(velocity, -dv, normal)));
    double along = spore_vec3_dot(normal, spore_mat3_apply(damping, normal));
    g_assert_cmpfloat(fabs(-0.5 / dv * (ahead - behind) - along), <, 1e-5 * (1 + along));
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  random_source = g_rand_new_with_seed(5);
  g_test_add_func("/response/law", test_law);
  g_test_add_func("/response/spring", test_spring);
  g_test_add_func("/response/bounds", test_bounds);
  g_test_add_func("/response/friction", test_friction);
  g_test_add_func("/response/continuous", test_continuous);
  g_test_add_func("/response/exit-speed", test_exit_speed);
  g_test_add_func("/response/semidefinite", test_semidefinite);
  g_test_add_func("/response/jacobian", test_jacobian);
  int status = g_test_run();
  g_rand_free(random_source);
  return status;
}
