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

/* With friction's spring not stretched. */
static SporeVec3 push(const SporeContactLaw *pair, SporeVec3 normal, double depth, SporeVec3 velocity) {
  SporeContactState state = {.normal = normal, .depth = depth, .velocity = velocity};
  return spore_contact_force(pair, &state);
}

static double press(const SporeContactLaw *pair, double depth, double overlap, double gap_speed) {
  return spore_contact_normal(pair, depth, overlap, gap_speed).force;
}

static SporeVec3 across(SporeVec3 normal, SporeVec3 a) {
  return spore_vec3_add_scaled(a, -spore_vec3_dot(normal, a), normal);
}

static SporeContactState random_state(double slowest, double fastest) {
  SporeVec3 normal = spore_vec3_normalise(random_vec3(1), (SporeVec3){0, 1, 0});
  return (SporeContactState){normal, uniform(-1e-3, 5e-3), fmax(uniform(-5e-3, 5e-3), 0),
                             random_vec3(pow(10, uniform(slowest, fastest))),
                             across(normal, random_vec3(pow(10, uniform(-6, -3))))};
}

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
  SporeVec3 force = push(&law, up, 2e-3, still);
  g_assert_cmpfloat(fabs(force.y - 2), <, 1e-12);
  g_assert_cmpfloat(force.x, ==, 0);
  static const double none[] = {0, -1e-3, NAN};
  for (size_t i = 0; i < G_N_ELEMENTS(none); i++) {
    force = push(&law, up, none[i], (SporeVec3){1, -1, 0});
    g_assert_cmpfloat(spore_vec3_length(force), ==, 0);
  }
  g_assert_cmpfloat(spore_contact_potential(&law, 2e-3, still), ==, 2e-3);
  g_assert_cmpfloat(spore_contact_potential(&law, -1, still), ==, 0);
}

/* Never attractive, friction inside the cone and against the slip, energy only ever taken. */
static void test_bounds(void) {
  for (int i = 0; i < 20000; i++) {
    SporeVec3 normal = spore_vec3_normalise(random_vec3(1), (SporeVec3){0, 1, 0});
    SporeVec3 velocity = random_vec3(pow(10, uniform(-5, 1)));
    double depth = uniform(-1e-3, 5e-3), gap_speed = spore_vec3_dot(normal, velocity);
    SporeVec3 force = push(&law, normal, depth, velocity);
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

/* Holds to the border of the cone, and slips there; never more than the cone allows. */
static void test_friction(void) {
  SporeContactState state = {.normal = {0, 1, 0}, .depth = 1e-3, .stretch = {0.3e-3, 0, 0}};
  SporeVec3 held = spore_contact_force(&law, &state);
  g_assert_cmpfloat(fabs(held.x + 0.3), <, 1e-12);
  g_assert_cmpfloat(fabs(held.y - 1), <, 1e-12);
  state.stretch.x = 0.5e-3;
  g_assert_cmpfloat(fabs(spore_contact_force(&law, &state).x + 0.4), <, 1e-12);
  g_assert_cmpfloat(fabs(spore_contact_slip(&law, state.stretch, 1).x - 0.4e-3), <, 1e-12);
  g_assert_cmpfloat(spore_vec3_length(spore_contact_slip(&law, state.stretch, 0)), ==, 0);
  SporeVec3 fast = push(&law, state.normal, 1e-3, (SporeVec3){0, 0, 3});
  g_assert_cmpfloat(fabs(fast.z + 0.4), <, 1e-12);
  for (int i = 0; i < 20000; i++) {
    state = random_state(-5, 1);
    SporeVec3 force = spore_contact_force(&law, &state);
    double pressing = spore_vec3_dot(force, state.normal);
    g_assert_cmpfloat(pressing, >=, -1e-14);
    g_assert_cmpfloat(spore_vec3_length(across(state.normal, force)), <=, law.friction * pressing * (1 + 1e-9) + 1e-14);
  }
}

/* The force starts from nothing at first touch, however fast, and has no jump anywhere. */
static void test_continuous(void) {
  SporeVec3 up = {0, 1, 0};
  for (double speed = -10; speed <= 3; speed += 0.01) {
    double before = push(&law, up, 1e-12, (SporeVec3){0, speed, 0}).y;
    g_assert_cmpfloat(before, <, 1e-8);
    double after = 0;
    for (double depth = 1e-12; depth < 2e-3; depth += 1e-6) {
      after = push(&law, up, depth, (SporeVec3){0, speed, 0}).y;
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
      double start = spore_contact_potential(&pair, depth, (SporeVec3){0, 0, 0});
      for (int step = 0; step < 200000 && depth > 0; step++) {
        speed += dt_s * press(&pair, depth, depth, speed) / mass;
        depth -= dt_s * speed;
        energy = 0.5 * mass * speed * speed + spore_contact_potential(&pair, depth, (SporeVec3){0, 0, 0});
        g_assert_cmpfloat(energy, <=, start * 1.001);
        g_assert_cmpfloat(speed, <=, SPORE_CONTACT_EXIT_SPEED);
      }
      g_assert_cmpfloat(depth, <=, 0);
    }
}

/* A point that comes from outside, taken to where it turns or leaves; the depth that it reached. */
static double meet(const SporeContactLaw *pair, double mass, double *speed, double *overlap) {
  double depth = 0, most = 0, dt_s = 1e-4 / (sqrt(pair->stiffness / mass) + pair->damping / mass);
  for (int step = 0; step < 2000000 && depth >= 0; step++) {
    double half = depth - 0.5 * dt_s * *speed;
    *speed += dt_s * press(pair, half, *overlap, *speed) / mass;
    depth = half - 0.5 * dt_s * *speed;
    *overlap = fmin(*overlap, fmax(depth, 0));
    most = fmax(most, depth);
    if (pair->damping > 0 && *speed > 0) break;
  }
  return most;
}

/* What motion entered comes back as it went in, at any speed; of an overlap only the part beyond it does. */
static void test_elastic(void) {
  for (double came = 0.1; came < 2000; came *= 10) {
    SporeContactLaw pair = {1e5, 0, 0, 5e-4};
    double speed = -came, overlap = 0, mass = 0.03;
    double depth = meet(&pair, mass, &speed, &overlap), expected = came / sqrt(pair.stiffness / mass);
    g_assert_cmpfloat(fabs(speed / came - 1), <, 1e-3);
    g_assert_cmpfloat(fabs(depth / expected - 1), <, 1e-3);
  }
  SporeContactLaw pair = {1e5, 0, 0, 5e-4};
  g_assert_cmpfloat(press(&pair, 3e-3, 0, 3), ==, 300);
  g_assert_cmpfloat(press(&pair, 3e-3, 1e-3, 3), ==, 200);
  g_assert_cmpfloat(press(&pair, 3e-3, 5e-3, 3), ==, 0);
}

/* The speed that is stopped within a depth, against the motion itself: without damping, little, critical and much. */
static void test_stops(void) {
  static const double ratios[] = {0, 0.1, 0.7, 1, 1.5, 6};
  for (unsigned i = 0; i < G_N_ELEMENTS(ratios); i++) {
    double mass = 0.02, depth = 5e-3, none = 0;
    SporeContactLaw pair = {1e4, 2 * ratios[i] * sqrt(1e4 * mass), 0, 1e-9}; /* damping from the first touch on */
    double stops = spore_contact_stops(&pair, 1 / mass, depth), below = -0.99 * stops, above = -1.01 * stops;
    if (ratios[i] == 0) g_assert_cmpfloat(fabs(stops - depth * sqrt(1e4 / mass)), <, 1e-12);
    g_test_message("damping ratio %g: stops %.4g m/s", ratios[i], stops);
    g_assert_cmpfloat(meet(&pair, mass, &below, &none), <, depth);
    g_assert_cmpfloat(meet(&pair, mass, &above, &none), >, depth);
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
    SporeContactState state = random_state(-5, 1);
    SporeMat3 stiffness, damping;
    SporeVec3 drag;
    stiffness = spore_contact_jacobian(&law, &state, 1, 0, &drag);
    damping = spore_contact_jacobian(&law, &state, 0, 1, &drag);
    g_assert_true(is_positive_semidefinite(stiffness));
    g_assert_true(is_positive_semidefinite(damping));
  }
}

/* Slope of the force against motion of a, by differences: its position when `by_velocity` is false. */
static SporeVec3 slope(const SporeContactLaw *pair, const SporeContactState *state, SporeVec3 step, double h,
                       gboolean by_velocity) {
  SporeVec3 force[2];
  for (int i = 0; i < 2; i++) {
    SporeVec3 move = spore_vec3_scale(i ? h : -h, step);
    SporeContactState moved = *state;
    if (by_velocity) moved.velocity = spore_vec3_add(state->velocity, move);
    else {
      moved.depth -= spore_vec3_dot(move, state->normal);
      moved.stretch = spore_vec3_add(state->stretch, across(state->normal, move));
    }
    force[i] = spore_contact_force(pair, &moved);
  }
  return spore_vec3_scale(-0.5 / h, spore_vec3_sub(force[1], force[0]));
}

/* Whether the contact is at the border between holding and slipping, where the law has a kink. */
static gboolean at_border(const SporeContactState *state) {
  double damping, most = law.friction * spore_vec3_dot(state->normal, spore_contact_force(&law, state));
  double hold = spore_vec3_length(spore_contact_hold(&law, state, &damping));
  return fabs(hold - most) < 1e-3 * most;
}

/* Against differences of the force; along the normal with what the drag adds. */
static void test_jacobian(void) {
  SporeContactLaw frictionless = law;
  frictionless.friction = 0;
  size_t held = 0, slipped = 0;
  for (int i = 0; i < 5000; i++) {
    SporeContactState state = random_state(-4, 0);
    state.depth = uniform(1e-5, 3e-3);
    double gap_speed = uniform(-1, 0); /* approaching: nothing is clamped */
    state.velocity = spore_vec3_add_scaled(across(state.normal, state.velocity), gap_speed, state.normal);
    if (at_border(&state)) continue;
    SporeVec3 force = spore_contact_force(&law, &state);
    double most = law.friction * spore_vec3_dot(force, state.normal);
    if (spore_vec3_length(across(state.normal, force)) < 0.999 * most) held++;
    else slipped++;
    SporeMat3 stiffness, damping;
    SporeVec3 drag;
    stiffness = spore_contact_jacobian(&law, &state, 1, 0, &drag);
    damping = spore_contact_jacobian(&law, &state, 0, 1, &drag);
    for (int axis = 0; axis < 3; axis++) {
      SporeVec3 step = across(state.normal, (SporeVec3){axis == 0, axis == 1, axis == 2});
      SporeVec3 by_position = slope(&law, &state, step, 1e-9, FALSE),
                by_velocity = slope(&law, &state, step, 1e-7, TRUE);
      g_assert_cmpfloat(spore_vec3_distance(by_position, spore_mat3_apply(stiffness, step)), <, 0.5);
      g_assert_cmpfloat(spore_vec3_distance(by_velocity, spore_mat3_apply(damping, step)), <, 1e-2);
    }
    if (state.depth > law.damping_depth && spore_vec3_length(across(state.normal, force)) >= 0.999 * most) {
      stiffness = spore_contact_jacobian(&law, &state, 1, 0, &drag);
      SporeVec3 whole = spore_vec3_sub(spore_mat3_apply(stiffness, state.normal), drag);
      g_assert_cmpfloat(spore_vec3_distance(slope(&law, &state, state.normal, 1e-9, FALSE), whole), <, 0.5);
      g_assert_cmpfloat(spore_vec3_length(drag), >, 0);
    }
    stiffness = spore_contact_jacobian(&frictionless, &state, 1, 0, &drag);
    damping = spore_contact_jacobian(&frictionless, &state, 0, 1, &drag);
    SporeVec3 by_position = slope(&frictionless, &state, state.normal, 1e-9, FALSE);
    SporeVec3 by_velocity = slope(&frictionless, &state, state.normal, 1e-7, TRUE);
    g_assert_cmpfloat(spore_vec3_distance(by_position, spore_mat3_apply(stiffness, state.normal)), <, 0.5);
    g_assert_cmpfloat(spore_vec3_distance(by_velocity, spore_mat3_apply(damping, state.normal)), <, 1e-2);
  }
  g_assert_cmpuint(held, >, 100);
  g_assert_cmpuint(slipped, >, 100);
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
  g_test_add_func("/response/elastic", test_elastic);
  g_test_add_func("/response/stops", test_stops);
  g_test_add_func("/response/semidefinite", test_semidefinite);
  g_test_add_func("/response/jacobian", test_jacobian);
  int status = g_test_run();
  g_rand_free(random_source);
  return status;
}
