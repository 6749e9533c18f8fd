/* Contacts side by side, at every instruction set, against the same contacts one by one. */
#include <math.h>
#include <string.h>

#include "core/sim/solve/island_system.h"
#include "tests/stability/rig.h"

#define BALLS 40

static void add_floor(Rig *rig, double friction) {
  SporeBodyDescription *wall = rig_unmovable(rig, "floor", rig_floor(rig, 12, 12, 0.05, 0.04));
  wall->contact.friction = friction;
}

/* A heap of balls that overlap, of two spheres each, so that levers are not trivial. */
static Rig *make_balls(double friction) {
  Rig *rig = rig_new();
  GRand *random = g_rand_new_with_seed(5);
  const double points[6] = {0.01, 0, 0, -0.015, 0.005, 0};
  add_floor(rig, friction);
  for (int i = 0; i < BALLS; i++) {
    SporeTriangleMesh cube;
    shape_box(&cube, spore_vec3(0, 0, 0), spore_vec3(0.03, 0.05, 0.04));
    SporeModel *model = rig_surface_model(&spore_rigid_body, &cube, "density", 1000., NULL);
    g_autofree char *name = g_strdup_printf("ball%d", i);
    SporeBodyDescription *ball = rig_passive(rig, g_intern_string(name), model, rig_spheres(rig, points, 2, 0.03));
    ball->contact.friction = friction;
    ball->pose.position = spore_vec3_add(spore_vec3(0, 0.06, 0), shape_random_vector(random, 0.1));
    ball->pose.position.y = 0.02 + 0.5 * fabs(ball->pose.position.y);
    ball->pose.orientation = spore_quat_from_rotation_vector(shape_random_vector(random, 2));
    ball->velocity = shape_random_vector(random, 2);
    ball->spin = shape_random_vector(random, 5);
  }
  g_rand_free(random);
  return rig;
}

/* A net that lies in the floor. */
static Rig *make_net(double friction) {
  Rig *rig = rig_new();
  SporeTriangleMesh sheet;
  add_floor(rig, friction);
  shape_sheet(&sheet, 10, 10, 0.045, TRUE);
  const SporeSphereSet *spheres = rig_spheres(rig, sheet.vertices, sheet.vertex_count, 0.012);
  SporeBodyDescription *net = rig_passive(rig, "net", rig_surface_model(&spore_mass_spring_net, &sheet, NULL), spheres);
  net->contact.friction = friction;
  net->pose = (SporePose){{-0.2, 0.004, -0.2}, spore_quat_from_rotation_vector(spore_vec3(0.5 * G_PI, 0, 0))};
  net->velocity = spore_vec3(0.3, -0.5, 0.2);
  return rig;
}

/* A state a little after the one that the step began with. */
static void perturb(const SporeWorld *world, const SporeIsland *island, GRand *random, double *q, double *v) {
  for (size_t i = 0; i < island->q_count; i++) q[i] = island->q0[i] + g_rand_double_range(random, -1e-3, 1e-3);
  for (size_t i = 0; i < island->v_count; i++) v[i] = island->v0[i] + g_rand_double_range(random, -0.5, 0.5);
  for (size_t b = 0; b < island->kept_count; b++) {
    uint32_t index = world->solve.island_bodies[island->body_start + b];
    if (!spore_model_is_rigid(world->bodies[index].model)) continue;
    double *orientation = q + world->solve.local_sites[index].q + 3;
    spore_quat_store(orientation, spore_quat_normalise(spore_quat_load(orientation)));
  }
}

static double *one_by_one(const SporeIslandSystem *system, const double *q, const double *v) {
  double *f = g_new0(double, system->island->v_count);
  for (size_t i = 0; i < system->island->contact_count; i++)
    spore_contact_term_force(spore_island_system_contact(system, i), system->world->solve.local_sites, q, v,
                             system->now_s, f);
  return f;
}

static double largest(const double *x, size_t count) {
  double most = 0;
  for (size_t i = 0; i < count; i++) most = fmax(most, fabs(x[i]));
  return most;
}

static void compare(SporeIslandSystem *system, const double *q, const double *v) {
  size_t n = system->island->v_count;
  g_autofree double *expected = one_by_one(system, q, v), *first = NULL;
  for (SporeCpuLevel level = 0; level < SPORE_CPU_LEVELS; level++) {
    spore_cpu_limit(level);
    double *f = g_new0(double, n);
    spore_island_system_add_contact_forces(system, q, v, f);
    if (first) g_assert_cmpmem(f, n * sizeof *f, first, n * sizeof *f);
    for (size_t i = 0; i < n; i++) g_assert_cmpfloat_with_epsilon(f[i], expected[i], 1e-9 * largest(expected, n));
    g_free(first);
    first = f;
  }
  for (size_t i = 0; i < system->island->contact_count; i++) {
    SporeContactTerm *term = spore_island_system_contact(system, i), alone = *term;
    spore_island_system_keep_contacts(system);
    g_assert_cmpfloat_with_epsilon(term->pressing, alone.pressing, 1e-9 * (1 + alone.pressing));
    g_assert_cmpfloat(spore_vec3_distance(term->force, alone.force), <=, 1e-9 * (1 + spore_vec3_length(alone.force)));
    *term = alone;
  }
}

/* As if some had met in this step. */
static void vary(SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->contact_count; i++) {
    SporeContactTerm *term = &world->contact.terms[world->contact.order[island->contact_start + i]];
    if (i % 3 == 0) term->depth = -1e-4;
  }
}

static void test_rig(Rig *rig, SporeLanesKind kind) {
  SporeWorld *world = rig_build(rig);
  GRand *random = g_rand_new_with_seed(9);
  rig_run(world, 3); /* friction holds something */
  spore_world_map_spheres(world);
  spore_world_detect(world);
  spore_world_respond(world);
  spore_world_link(world);
  spore_world_find_islands(world);
  size_t compared = 0;
  for (size_t i = 0; i < world->solve.island_count; i++) {
    SporeIsland *island = &world->solve.islands[i];
    if (island->contact_count == 0) continue;
    spore_island_gather(world, island);
    vary(world, island);
    SporeIslandSystem system = {.world = world, .island = island, .now_s = -1};
    SporeDynamics dynamics = spore_island_system_dynamics(&system);
    dynamics.set_time(&system, 1e-3);
    g_assert_cmpint(world->contact.lanes[island->lanes_start].kind, ==, kind);
    g_autofree double *q = g_new(double, island->q_count), *v = g_new(double, island->v_count);
    for (int k = 0; k < 5; k++) {
      perturb(world, island, random, q, v);
      compare(&system, q, v);
    }
    compared += island->contact_count;
  }
  g_test_message("%zu contacts", compared);
  g_assert_cmpuint(compared, >, 30);
  g_rand_free(random);
  rig_free(rig);
}

static void test_balls(void) {
  for (int rubs = 0; rubs < 2; rubs++) test_rig(make_balls(0.4 * rubs), SPORE_LANES_FRAMES);
}

static void test_net(void) {
  for (int rubs = 0; rubs < 2; rubs++) test_rig(make_net(0.4 * rubs), SPORE_LANES_NODES);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/contact_lanes/balls", test_balls);
  g_test_add_func("/stability/contact_lanes/net", test_net);
  return g_test_run();
}
