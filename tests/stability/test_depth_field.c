/* Bodies that are felt as one depth field: forces that belong together, friction that holds, sides of a corner, and
 * sleep. */
#include <math.h>
#include <string.h>

#include "core/sim/solve/island_system.h"
#include "tests/stability/rig.h"

#define SIDE 0.06 /* of a brick, m */

/* A brick of 4 x 4 x 4 spheres, 15 mm apart, that just fill it, felt as one. */
static SporeBodyDescription *add_brick(Rig *rig, const char *name, SporeVec3 at, double friction) {
  double points[3 * 64], *point = points;
  for (int i = 0; i < 64; i++, point += 3)
    spore_vec3_store(point, spore_vec3(0.015 * (i % 4 - 1.5), 0.015 * (i / 4 % 4 - 1.5), 0.015 * (i / 16 - 1.5)));
  const SporeSphereSet *spheres = rig_spheres(rig, points, 64, 0.0075);
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(SIDE, SIDE, SIDE));
  SporeBodyDescription *body =
      rig_passive(rig, name, rig_surface_model(&spore_rigid_body, &box, "mass", 0.2, NULL), spheres);
  body->pose.position = at;
  body->contact.surface = SPORE_SURFACE_DEPTH_FIELD;
  body->contact.stiffness = 1e4;
  body->contact.damping = 5;
  body->contact.friction = friction;
  return body;
}

/* Two bricks that fly into each other, off centre, turning. */
static Rig *collision(SporeIntegratorKind integrator, double time_step) {
  Rig *rig = rig_new();
  rig->description.solver.integrator = (int)integrator;
  rig->description.solver.time_step = time_step;
  rig->description.solver.tolerance = 1e-12;
  SporeBodyDescription *a = add_brick(rig, "a", spore_vec3(0, 0.1, 0.1), 0.4);
  a->velocity = spore_vec3(0.3, 0, 0.1);
  SporeBodyDescription *b = add_brick(rig, "b", spore_vec3(0.07, 0.12, 0.09), 0.4);
  b->pose.orientation = spore_quat_from_rotation_vector(spore_vec3(0.3, 0.5, 0.2));
  return rig;
}

typedef struct Momentum {
  SporeVec3 linear, angular; /* about the origin */
} Momentum;

static Momentum momentum_of(const SporeWorld *world) {
  Momentum sum = {{0, 0, 0}, {0, 0, 0}};
  for (uint32_t b = 0; b < spore_world_body_count(world); b++) {
    const double *q = spore_world_q(world, b), *v = spore_world_v(world, b);
    const double mass = 0.2, inertia = mass * SIDE * SIDE / 6; /* of a cube, about any axis */
    SporeVec3 p = spore_vec3_scale(mass, spore_vec3_load(v));
    sum.linear = spore_vec3_add(sum.linear, p);
    sum.angular = spore_vec3_add(sum.angular, spore_vec3_cross(spore_vec3_load(q), p));
    sum.angular = spore_vec3_add_scaled(sum.angular, inertia, spore_vec3_load(v + 3));
  }
  return sum;
}

/* The spheres overlap, and bring weights of their own. */
static void give_weights(Rig *rig) {
  for (guint s = 0; s < rig->sets->len; s++) {
    SporeSphereSet *set = g_ptr_array_index(rig->sets, s);
    g_assert_true(spore_sphere_set_add_weights(set, NULL));
    for (size_t i = 0; i < set->count; i++) {
      set->spheres[4 * i + 3] *= 1.5;
      set->weights[i] = 0.5 + 0.1 * (double)(i % 3);
    }
  }
}

static void run_to_contact(SporeWorld *world) {
  while (spore_world_counts(world).contacts == 0 || world->contact.terms[0].depth < 1e-4) {
    g_assert_cmpfloat(spore_world_time_s(world), <, 1);
    spore_world_step(world);
  }
}

/* Field against field, by a method that keeps what forces keep; from touch on, as the step that finds it is taken
 * implicitly. */
static void check_momentum(gboolean weighted) {
  Rig *rig = collision(SPORE_INTEGRATOR_SYMPLECTIC_EULER, 1e-4);
  if (weighted) give_weights(rig);
  SporeWorld *world = rig_build(rig);
  run_to_contact(world);
  Momentum before = momentum_of(world);
  size_t contacts = 0;
  for (int i = 0; i < 500; i++) {
    spore_world_step(world);
    contacts = MAX(contacts, spore_world_counts(world).contacts);
  }
  Momentum after = momentum_of(world);
  double lost = spore_vec3_distance(before.linear, after.linear) / spore_vec3_length(before.linear);
  double turned = spore_vec3_distance(before.angular, after.angular) / spore_vec3_length(before.angular);
  double spin = spore_vec3_length(spore_vec3_load(spore_world_v(world, 1) + 3));
  g_test_message("momentum: up to %u contacts, one turns at %.2f rad/s after; momentum off by %.1e, angular by %.1e",
                 (unsigned)contacts, spin, lost, turned);
  g_assert_cmpuint(contacts, >, 0);
  g_assert_cmpfloat(spin, >, 0.1);
  g_assert_cmpfloat(lost, <, 1e-12);
  g_assert_cmpfloat(turned, <, 1e-12);
  rig_free(rig);
}

static void test_momentum(void) { check_momentum(FALSE); }
static void test_weighted_momentum(void) { check_momentum(TRUE); }

/* The island of both bricks while they press on each other, ready for its forces to be asked for. */
static SporeIsland *pressed_island(SporeWorld *world) {
  run_to_contact(world);
  spore_world_map_spheres(world);
  spore_world_detect(world);
  spore_world_respond(world);
  spore_world_link(world);
  spore_world_find_islands(world);
  g_assert_cmpuint(world->solve.island_count, ==, 1);
  spore_island_gather(world, &world->solve.islands[0]);
  return &world->solve.islands[0];
}

#define Q 14
#define V 12

/* Forces at a state that is moved by velocity x: positions by x for a second, or velocities. */
static void force_at(const SporeDynamics *dynamics, const SporeIsland *island, const double *x, gboolean moved,
                     double *f) {
  double q[Q], v[V];
  memcpy(q, island->q0, sizeof q);
  memcpy(v, island->v0, sizeof v);
  if (moved) dynamics->drift(dynamics->data, island->q0, x, 1, q, (double[V]){0});
  else
    for (int i = 0; i < V; i++) v[i] += x[i];
  memset(f, 0, V * sizeof *f);
  dynamics->term_force(dynamics->data, q, v, f);
}

/* Forces of a field contact belong together wherever the bodies have come to in the step, and their change is that of
 * the matrix. */
static void test_forces(void) {
  Rig *rig = collision(SPORE_INTEGRATOR_IMPLICIT_EULER, 5e-4);
  for (guint b = 0; b < 2; b++) g_array_index(rig->bodies, SporeBodyDescription, b).contact.friction = 0;
  SporeWorld *world = rig_build(rig);
  SporeIsland *island = pressed_island(world);
  SporeIslandSystem system = {world, island};
  SporeDynamics dynamics = spore_island_system_dynamics(&system);
  double away[V], f[V], q[Q];
  for (int i = 0; i < V; i++) away[i] = 1e-4 * sin(3 * i) * (i % 6 < 3 ? 1 : 100);
  force_at(&dynamics, island, away, TRUE, f);
  dynamics.drift(dynamics.data, island->q0, away, 1, q, (double[V]){0});
  SporeVec3 sum = spore_vec3_add(spore_vec3_load(f), spore_vec3_load(f + 6));
  SporeVec3 torque = spore_vec3_add(spore_vec3_load(f + 3), spore_vec3_load(f + 9));
  for (int b = 0; b < 2; b++)
    torque = spore_vec3_add(torque, spore_vec3_cross(spore_vec3_load(q + 7 * b), spore_vec3_load(f + 6 * b)));
  g_test_message("forces: %.3f N at a place moved by 0.1 mm and 0.01 rad, sum %.1e N, torques %.1e N m",
                 spore_vec3_length(spore_vec3_load(f)), spore_vec3_length(sum), spore_vec3_length(torque));
  g_assert_cmpfloat(spore_vec3_length(spore_vec3_load(f)), >, 0.1);
  g_assert_cmpfloat(spore_vec3_length(sum), <, 1e-14);
  g_assert_cmpfloat(spore_vec3_length(torque), <, 1e-14);
  const double c = 1e-3, c2 = 1e-6;
  dynamics.linearise(dynamics.data, island->q0, NULL, island->v0, c, c2);
  double worst = 0, largest = 0;
  for (int j = 0; j < V; j++) {
    double unit[V] = {0}, back[V] = {0}, product[V], mass[V], ahead[V], behind[V], faster[V], slower[V];
    unit[j] = 1;
    dynamics.multiply(dynamics.data, unit, product);
    dynamics.mass_multiply(dynamics.data, unit, mass);
    unit[j] = 1e-7, back[j] = -1e-7;
    force_at(&dynamics, island, unit, TRUE, ahead), force_at(&dynamics, island, back, TRUE, behind);
    force_at(&dynamics, island, unit, FALSE, faster), force_at(&dynamics, island, back, FALSE, slower);
    for (int i = 0; i < V; i++) {
      double change = c2 * (behind[i] - ahead[i]) / 2e-7 + c * (slower[i] - faster[i]) / 2e-7;
      worst = fmax(worst, fabs(product[i] - mass[i] - change));
      largest = fmax(largest, fabs(change));
    }
  }
  g_test_message("forces: matrix against differences: off by %.1e of %.1e", worst, largest);
  g_assert_cmpfloat(worst, <, 0.02 * largest); /* forces that turn with the bodies are left out, as of all contacts */
  rig_free(rig);
}

/* Rows of spheres that fill a plane to y = 0, felt as one. */
static SporeBodyDescription *add_floor(Rig *rig, double friction) {
  SporeBodyDescription *floor = rig_unmovable(rig, "floor", rig_floor(rig, 61, 31, 0.01, 0.01));
  floor->contact.surface = SPORE_SURFACE_DEPTH_FIELD;
  floor->contact.stiffness = 1e4;
  floor->contact.damping = 50;
  floor->contact.friction = friction;
  return floor;
}

/* Gravity as on a slope that falls by `slope` along x. */
static SporeVec3 gravity_on_slope(double slope) {
  return spore_vec3(9.81 * sin(atan(slope)), -9.81 * cos(atan(slope)), 0);
}

static Rig *slope_rig(double slope, SporeIntegratorKind integrator) {
  Rig *rig = rig_new();
  rig->description.gravity = gravity_on_slope(slope);
  rig->description.solver.integrator = (int)integrator;
  rig->description.solver.time_step = integrator == SPORE_INTEGRATOR_SYMPLECTIC_EULER ? 2e-4 : 2e-3;
  rig->description.solver.sleep_speed = 0;
  return rig;
}

typedef struct Ground {
  const char *name;
  gboolean field_floor; /* else a sphere so large that it is flat */
  gboolean field_brick; /* else its corners alone */
} Ground;

/* What a brick that has come to rest moves in a second on a slope that was tilted under it within half a second; and
 * what it should, in *expected. */
static double slide(const Ground *ground, double slope, double friction, SporeIntegratorKind integrator,
                    double *expected) {
  Rig *rig = slope_rig(0, integrator);
  if (ground->field_floor) {
    add_floor(rig, friction);
  } else {
    SporeBodyDescription *plane = rig_unmovable(rig, "plane", rig_sphere(rig, 1e4));
    plane->pose.position.y = -1e4;
    plane->contact.friction = friction;
    plane->contact.stiffness = 1e4;
    plane->contact.damping = 50;
  }
  SporeBodyDescription *brick = add_brick(rig, "brick", spore_vec3(-0.2, 0.5 * SIDE, 0.0013), friction);
  brick->contact.damping = 50;
  if (!ground->field_brick) {
    double corners[24];
    for (int i = 0; i < 8; i++)
      spore_vec3_store(corners + 3 * i, spore_vec3(i & 1 ? 0.02 : -0.02, i & 2 ? 0.02 : -0.02, i & 4 ? 0.02 : -0.02));
    brick->spheres = rig_spheres(rig, corners, 8, 0.01);
    brick->contact.surface = SPORE_SURFACE_SPHERES;
  }
  SporeWorld *world = rig_build(rig);
  const unsigned second = (unsigned)lround(1 / rig->description.solver.time_step);
  rig_run(world, second);
  for (unsigned i = 1; i <= 50; i++) {
    SporeCommand tilt = {.kind = SPORE_COMMAND_GRAVITY, .vector = gravity_on_slope(slope * i / 50)};
    g_assert_true(spore_world_post(world, &tilt));
    rig_run(world, second / 100);
  }
  const double time = friction > slope ? 1 : 0.2;
  if (friction > slope) rig_run(world, 2 * second);
  double start = spore_world_q(world, 1)[0], speed = spore_world_v(world, 1)[0];
  rig_run(world, (unsigned)lround(time * second));
  SporeVec3 gravity = gravity_on_slope(slope);
  double pull = gravity.x + friction * gravity.y;
  *expected = friction > slope ? 0 : speed * time + 0.5 * pull * time * time;
  double moved = spore_world_q(world, 1)[0] - start;
  rig_free(rig);
  return moved;
}

/* Case 34 over again: spheres that slide over a field keep their grip, whatever sphere of it is nearest. Closer to the
 * cone a brick whose contacts are damped as little as these flutters, on a plane as on a field. */
static void test_friction(void) {
  static const Ground grounds[] = {
      {"corners on a field", TRUE, FALSE}, {"field on a plane", FALSE, TRUE}, {"field on a field", TRUE, TRUE}};
  static const SporeIntegratorKind kinds[] = {SPORE_INTEGRATOR_SYMPLECTIC_EULER, SPORE_INTEGRATOR_IMPLICIT_EULER};
  for (unsigned g = 0; g < G_N_ELEMENTS(grounds); g++)
    for (unsigned k = 0; k < G_N_ELEMENTS(kinds); k++) {
      double none, expected, held = slide(&grounds[g], 0.4, 0.5, kinds[k], &none);
      double moved = slide(&grounds[g], 0.6, 0.4, kinds[k], &expected);
      g_test_message("friction: %s, %s: held moves %.1e m in a second; slides %.5f m, should %.5f m", grounds[g].name,
                     spore_integrator_names[kinds[k]], held, moved, expected);
      g_assert_cmpfloat(fabs(held), <, 1e-6);
      g_assert_cmpfloat(fabs(moved - expected), <, 0.02 * expected);
    }
}

/* A brick that lies on a floor, both felt as one, falls asleep there. */
static void test_sleep(void) {
  Rig *rig = slope_rig(0.2, SPORE_INTEGRATOR_IMPLICIT_EULER);
  rig->description.solver.sleep_speed = 1e-5;
  add_floor(rig, 0.5);
  add_brick(rig, "brick", spore_vec3(0.003, 0.035, 0.001), 0.5)->pose.orientation =
      spore_quat_from_rotation_vector(spore_vec3(0.05, 0.7, 0.02));
  SporeWorld *world = rig_build(rig);
  while (!spore_world_body_asleep(world, 1) && spore_world_time_s(world) < 10) spore_world_step(world);
  g_test_message("sleep: brick on floor, field on field: asleep after %.2f s", spore_world_time_s(world));
  g_assert_true(spore_world_body_asleep(world, 1));
  rig_free(rig);
}

/* A ball in the corner of one body: it leans on both of its sides. */
static void test_corner(void) {
  Rig *rig = slope_rig(0.7, SPORE_INTEGRATOR_IMPLICIT_EULER);
  double points[3 * 31 * 40], *point = points;
  for (int x = 0; x < 31; x++)
    for (int z = 0; z < 20; z++, point += 3) spore_vec3_store(point, spore_vec3(-0.008 * x, -0.008, 0.008 * (z - 10)));
  for (int y = 0; y < 31; y++)
    for (int z = 0; z < 20; z++, point += 3)
      spore_vec3_store(point, spore_vec3(0.008, 0.008 * (y - 1), 0.008 * (z - 10)));
  SporeBodyDescription *corner =
      rig_unmovable(rig, "corner", rig_spheres(rig, points, G_N_ELEMENTS(points) / 3, 0.008));
  corner->contact.surface = SPORE_SURFACE_DEPTH_FIELD;
  corner->contact.stiffness = 1e5;
  corner->contact.friction = 0.2;
  corner->contact.damping = 50;
  const double radius = 0.03;
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.04, 0.04, 0.04));
  SporeModel *model = rig_surface_model(&spore_rigid_body, &box, "mass", 0.1, NULL);
  SporeBodyDescription *ball = rig_passive(rig, "ball", model, rig_sphere(rig, radius));
  ball->contact.stiffness = 1e5;
  ball->contact.damping = 50;
  ball->contact.friction = 0.2;
  ball->pose.position = spore_vec3(-0.1, 0.03, 0.004); /* over a dip: on a bump it would roll */
  SporeWorld *world = rig_build(rig);
  rig_run(world, 2000);
  const double *q = spore_world_q(world, 1), *v = spore_world_v(world, 1);
  double x = -q[0] / radius, y = q[1] / radius, speed = hypot(v[0], v[1]); /* along the corner it may roll */
  double slope = 0.004 / 0.038;                                            /* of a bump, at most */
  g_test_message("corner: ball rests %.4f and %.4f of its radius from the sides on %u contacts, at %.1e m/s, and %.1e "
                 "along them",
                 x, y, (unsigned)spore_world_counts(world).contacts, speed, v[2]);
  g_assert_cmpuint(spore_world_counts(world).contacts, ==, 2);
  g_assert_cmpfloat(fabs(x - 1), <, 0.02);
  g_assert_cmpfloat(fabs(y - 1), <, 0.02);
  g_assert_cmpfloat(fabs(v[2]), <, 1e-2);
  g_assert_cmpfloat(speed, <, 1e-6 + slope * fabs(v[2]));
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/depth_field/momentum", test_momentum);
  g_test_add_func("/stability/depth_field/weighted-momentum", test_weighted_momentum);
  g_test_add_func("/stability/depth_field/forces", test_forces);
  g_test_add_func("/stability/depth_field/friction", test_friction);
  g_test_add_func("/stability/depth_field/sleep", test_sleep);
  g_test_add_func("/stability/depth_field/corner", test_corner);
  return g_test_run();
}
