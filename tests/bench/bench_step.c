/* What a step costs beside physics: an empty world, a net's step without its force, a pile that sleeps, many islands on
 * several threads, large bodies on several threads. Least of several runs, in CPU time of the thread but for threads,
 * where the clock counts. */
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "tests/stability/rig.h"

#define RUNS 20

static double now_us(clockid_t clock) {
  struct timespec now;
  clock_gettime(clock, &now);
  return (double)now.tv_sec * 1e6 + (double)now.tv_nsec * 1e-3;
}

static double step_us(SporeWorld *world, unsigned steps, clockid_t clock) {
  double least = 1e30;
  for (int run = 0; run < RUNS; run++) {
    double start = now_us(clock);
    rig_run(world, steps);
    least = MIN(least, (now_us(clock) - start) / steps);
  }
  return least;
}

static void say(const char *name, double us) { printf("%s: %.3f us\n", name, us); }

static void empty_world(void) {
  Rig *rig = rig_new();
  say("empty world", step_us(rig_build(rig), 10000, CLOCK_THREAD_CPUTIME_ID));
  rig_free(rig);
}

static void add_net(Rig *rig, guint index) {
  SporeTriangleMesh sheet;
  shape_sheet(&sheet, 20, 20, 1. / 19, FALSE);
  SporeModel *model = rig_surface_model(&spore_mass_spring_net, &sheet, NULL);
  g_autofree char *name = g_strdup_printf("net%u", index);
  rig_passive(rig, g_intern_string(name), model, NULL)->pose.position.z = index;
  rig_pin(rig, index, spore_vec3(0, 0, index), 1e-3);
}

static Rig *nets(guint count) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = 1e-4;
  rig->description.solver.integrator = SPORE_INTEGRATOR_SYMPLECTIC_EULER;
  for (guint i = 0; i < count; i++) add_net(rig, i);
  return rig;
}

static double force_us(const SporeWorld *world) {
  const SporeModel *model = spore_world_body_model(world, 0);
  const double *q = spore_world_q(world, 0), *v = spore_world_v(world, 0);
  double least = 1e30, *f = g_new0(double, 3 * model->block_count);
  for (int run = 0; run < RUNS; run++) {
    double start = now_us(CLOCK_THREAD_CPUTIME_ID);
    for (int i = 0; i < 1000; i++) model->type->force(model, q, q, v, f);
    least = MIN(least, (now_us(CLOCK_THREAD_CPUTIME_ID) - start) / 1000);
  }
  g_free(f);
  return least;
}

static void net_beside_force(void) {
  Rig *rig = nets(1);
  SporeWorld *world = rig_build(rig);
  rig_run(world, 1000);
  double step = step_us(world, 1000, CLOCK_THREAD_CPUTIME_ID);
  say("20x20 net, symplectic Euler, step less force", step - force_us(world));
  rig_free(rig);
}

static void build(Rig *rig, SporePool *pool) {
  rig->description.bodies = (const SporeBodyDescription *)(const void *)rig->bodies->data;
  rig->description.body_count = rig->bodies->len;
  rig->description.links = (const SporeLinkDescription *)(const void *)rig->links->data;
  rig->description.link_count = rig->links->len;
  rig->world = spore_world_create(&rig->description, pool, NULL);
}

static void many_nets(int threads) {
  Rig *rig = nets(100);
  SporePool *pool = spore_pool_create(threads);
  build(rig, pool);
  rig_run(rig->world, 20);
  g_autofree char *name = g_strdup_printf("100 nets of 20x20, symplectic Euler, %d threads, by the clock", threads);
  say(name, step_us(rig->world, 20, CLOCK_MONOTONIC));
  rig_free(rig);
  spore_pool_free(pool);
}

/* One body whose loops go over the pool. The calling thread's CPU time falls by what others do for it; the process's,
 * which has their waiting in it, says what that costs. */
static void large_body(const char *name, SporeModel *model, SporeIntegratorKind integrator, double time_step,
                       int threads) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = time_step;
  rig->description.solver.integrator = integrator;
  rig_passive(rig, "body", model, NULL);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 0.015);
  SporePool *pool = spore_pool_create(threads);
  build(rig, pool);
  static const struct {
    clockid_t id;
    const char *name;
  } clocks[] = {{CLOCK_MONOTONIC, "by the clock"},
                {CLOCK_THREAD_CPUTIME_ID, "CPU time of the caller"},
                {CLOCK_PROCESS_CPUTIME_ID, "CPU time of all"}};
  double least[3] = {1e30, 1e30, 1e30}, start[3];
  for (int step = 0; step < 2 * RUNS; step++) {
    for (int c = 0; c < 3; c++) start[c] = now_us(clocks[c].id);
    spore_world_step(rig->world);
    for (int c = 0; c < 3 && step >= 5; c++) least[c] = MIN(least[c], now_us(clocks[c].id) - start[c]);
  }
  for (int c = 0; c < 3; c++) {
    g_autofree char *what = g_strdup_printf("%s, %d threads, %s", name, threads, clocks[c].name);
    say(what, least[c]);
  }
  rig_free(rig);
  spore_pool_free(pool);
}

static void large_bodies(int threads) {
  SporeTriangleMesh sheet;
  SporeTetrahedralMesh block;
  shape_sheet(&sheet, 100, 100, 0.01, FALSE);
  large_body("100x100 net, symplectic Euler", rig_surface_model(&spore_mass_spring_net, &sheet, NULL),
             SPORE_INTEGRATOR_SYMPLECTIC_EULER, 1e-4, threads);
  shape_sheet(&sheet, 100, 100, 0.01, FALSE);
  large_body("100x100 net, implicit Euler", rig_surface_model(&spore_mass_spring_net, &sheet, NULL),
             SPORE_INTEGRATOR_IMPLICIT_EULER, 5e-3, threads);
  shape_block(&block, 40, 8, 8, spore_vec3(0.4, 0.08, 0.08));
  large_body("15360 tetrahedra, symplectic Euler", rig_tetrahedra_model(&block, NULL),
             SPORE_INTEGRATOR_SYMPLECTIC_EULER, 1e-4, threads);
  shape_block(&block, 40, 8, 8, spore_vec3(0.4, 0.08, 0.08));
  large_body("15360 tetrahedra, implicit Euler", rig_tetrahedra_model(&block, NULL), SPORE_INTEGRATOR_IMPLICIT_EULER,
             5e-3, threads);
}

/* Balls in the dimples of a floor. */
static void pile(gboolean sleeps) {
  enum { SIDE = 22 };
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  if (!sleeps) rig->description.solver.sleep_speed = 0;
  rig_unmovable(rig, "floor", rig_floor(rig, SIDE + 1, SIDE + 1, 0.04, 0.03))->contact.friction = 0;
  for (int i = 0; i < SIDE * SIDE; i++) {
    SporeTriangleMesh box;
    shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.03, 0.03, 0.03));
    g_autofree char *name = g_strdup_printf("ball%d", i);
    SporeModel *model = rig_surface_model(&spore_rigid_body, &box, "mass", 0.03, NULL);
    SporeBodyDescription *ball = rig_passive(rig, g_intern_string(name), model, rig_sphere(rig, 0.02));
    ball->pose.position =
        spore_vec3((i % SIDE - 0.5 * (SIDE - 1)) * 0.04, 0.0105, (i / SIDE - 0.5 * (SIDE - 1)) * 0.04);
    ball->contact.damping = 5;
    ball->contact.friction = 0;
  }
  SporeWorld *world = rig_build(rig);
  rig_run(world, 1500);
  say(sleeps ? "484 balls asleep" : "484 balls at rest, kept awake", step_us(world, 50, CLOCK_THREAD_CPUTIME_ID));
  rig_free(rig);
}

int main(void) {
  empty_world();
  net_beside_force();
  pile(TRUE);
  pile(FALSE);
  for (int threads = 1; threads <= (int)MIN(g_get_num_processors(), 8); threads *= 2) {
    many_nets(threads);
    large_bodies(threads);
  }
  return 0;
}
