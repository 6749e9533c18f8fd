/* The island's matrix, put together from models and terms without ever being formed, against a dense one by finite
 * differences of its forces. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/linalg/pcg.h"
#include "core/sim/solve/island_system.h"
#include "tests/sim/chain_model.h"

#define PARTICLES 4
#define N (2 * 3 * PARTICLES)

static double sphere_a[4 * PARTICLES], sphere_b[4 * PARTICLES];

/* Two chains in contact along their length, tied by a spring, one of them pinned at an end. */
static SporeWorld *make(void) {
  static SporeSphereSet sets[2] = {{PARTICLES, sphere_a}, {PARTICLES, sphere_b}};
  SporeBodyDescription bodies[2];
  for (int i = 0; i < PARTICLES; i++) {
    double sphere[4] = {i, 0, 0, 0.3};
    memcpy(sphere_a + 4 * i, sphere, sizeof sphere);
    memcpy(sphere_b + 4 * i, sphere, sizeof sphere);
  }
  for (int b = 0; b < 2; b++) {
    SporeModel *model = chain_create((ChainFields){
        .count = PARTICLES, .mass = 0.5 + b, .spacing = 1, .stiffness = 80, .damping = 0.7, .poison_at = HUGE_VAL});
    bodies[b] = passive_body(b ? "b" : "a", model, (SporeVec3){0.1 * b, 0.5 * b, 0.02 * b});
    /* Together: how a damper's direction turns with its ends is left out of A too. */
    bodies[b].velocity = (SporeVec3){0.2, -0.4, 0};
    bodies[b].spheres = &sets[b];
    bodies[b].contact.friction = 0; /* its change with the normal force is left out of A, which is to stay symmetric */
  }
  static const SporeLinkDescription links[2] = {
      {.name = "s",
       .type = &spore_link_spring,
       .body_a = 0,
       .body_b = 1,
       .point_a = {1, 0, 0},
       .point_b = {3, 0.5, 0},
       .stiffness = 30,
       .damping = 2,
       .rest_length = 1.5},
      {.name = "p", .type = &spore_link_pin, .body_a = 0, .point_a = {3, 0, 0}, .radius = 0.1}};
  SporeWorldDescription description = world_description(bodies, 2);
  description.links = links;
  description.link_count = 2;
  SporeWorld *world = spore_world_create(&description, NULL, NULL);
  g_assert_nonnull(world);
  /* The phases up to grouping, by hand. */
  spore_world_map_spheres(world);
  spore_world_detect(world);
  spore_world_respond(world);
  spore_world_link(world);
  spore_world_find_islands(world);
  g_assert_cmpuint(world->solve.island_count, ==, 1);
  g_assert_cmpuint(world->contact.count, >=, PARTICLES);
  spore_island_gather(world, &world->solve.islands[0]);
  return world;
}

/* -df/dx of all forces along x by central differences; x is q or v. */
static void column(const SporeDynamics *dynamics, int count, double *q, double *v, double *x, int j, double *out) {
  double plus[N], minus[N], keep = x[j], step = 1e-6;
  x[j] = keep + step;
  dynamics->force(dynamics->data, q, v, plus);
  x[j] = keep - step;
  dynamics->force(dynamics->data, q, v, minus);
  x[j] = keep;
  for (int i = 0; i < count; i++) out[i] = (minus[i] - plus[i]) / (2 * step);
}

static void test_dense(void) {
  SporeWorld *world = make();
  SporeIsland *island = &world->solve.islands[0];
  SporeIslandSystem system = {world, island};
  SporeDynamics dynamics = spore_island_system_dynamics(&system);
  g_assert_cmpuint(3 * dynamics.block_count, ==, N);
  double q[N], v[N];
  memcpy(q, island->q0, sizeof q);
  memcpy(v, island->v0, sizeof v);
  const double c = 0.03, c2 = 0.002;
  dynamics.linearise(dynamics.data, q, NULL, v, c, c2);
  double worst = 0, largest = 0, asymmetry = 0, dense[N][N];
  for (int j = 0; j < N; j++) {
    double unit[N] = {0}, product[N], mass[N], stiffness[N], damping[N];
    unit[j] = 1;
    dynamics.multiply(dynamics.data, unit, product);
    dynamics.mass_multiply(dynamics.data, unit, mass);
    column(&dynamics, N, q, v, q, j, stiffness);
    column(&dynamics, N, q, v, v, j, damping);
    for (int i = 0; i < N; i++) {
      dense[i][j] = product[i];
      bool held_i = i >= 9 && i < 12, held_j = j >= 9 && j < 12;
      double expected = held_i ? 0 : mass[i] + c * damping[i] + c2 * stiffness[i];
      if (held_j) continue; /* held blocks never move, so their columns do not matter */
      worst = fmax(worst, fabs(product[i] - expected));
      largest = fmax(largest, fabs(expected));
    }
  }
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      if (!((i >= 9 && i < 12) || (j >= 9 && j < 12))) asymmetry = fmax(asymmetry, fabs(dense[i][j] - dense[j][i]));
  g_assert_cmpfloat(asymmetry, <, 1e-12 * largest);
  g_assert_cmpfloat(worst, <, 1e-5 * largest);
  spore_world_free(world);
}

/* P^-1 undoes the diagonal blocks of A. */
static void test_preconditioner(void) {
  SporeWorld *world = make();
  SporeIslandSystem system = {world, &world->solve.islands[0]};
  SporeDynamics dynamics = spore_island_system_dynamics(&system);
  for (int b = 0; b < 2; b++) world->bodies[b].preconditioner.choice.factorised = false;
  dynamics.linearise(dynamics.data, world->solve.islands[0].q0, NULL, world->solve.islands[0].v0, 0.03, 0.002);
  for (int j = 0; j < N; j++) {
    if (j >= 9 && j < 12) continue;
    double unit[N] = {0}, product[N], block[N] = {0}, back[N];
    unit[j] = 1;
    dynamics.multiply(dynamics.data, unit, product);
    for (int k = 0; k < 3; k++) block[3 * (j / 3) + k] = product[3 * (j / 3) + k];
    dynamics.precondition(dynamics.data, block, back);
    for (int i = 0; i < N; i++) g_assert_cmpfloat_with_epsilon(back[i], unit[i], 1e-12);
  }
  spore_world_free(world);
}

/* With a factor P^-1 undoes all of A but what ties one body to another. */
static void test_factor(void) {
  SporeWorld *world = make();
  SporeIslandSystem system = {world, &world->solve.islands[0]};
  SporeDynamics dynamics = spore_island_system_dynamics(&system);
  for (int b = 0; b < 2; b++) world->bodies[b].preconditioner.choice.factorised = true;
  dynamics.linearise(dynamics.data, world->solve.islands[0].q0, NULL, world->solve.islands[0].v0, 0.03, 0.002);
  for (int b = 0; b < 2; b++) g_assert_true(world->bodies[b].preconditioner.factor_ready);
  for (int j = 0; j < N; j++) {
    if (j >= 9 && j < 12) continue;
    double unit[N] = {0}, product[N], back[N];
    unit[j] = 1;
    dynamics.multiply(dynamics.data, unit, product);
    for (int i = 0; i < N; i++)
      if (i / (N / 2) != j / (N / 2)) product[i] = 0;
    dynamics.precondition(dynamics.data, product, back);
    for (int i = 0; i < N; i++) g_assert_cmpfloat_with_epsilon(back[i], unit[i], 1e-12);
  }
  spore_world_free(world);
}

#define ALONE (3 * PARTICLES)

/* What hangs on one body alone is in its matrix, so that its factor undoes all of A: contacts with what does not move,
 * a link to the world, and, where two nodes that touch are neighbours, its contact with itself. */
static void test_local_assembly(void) {
  SporeWorld *world = make();
  SporeBody *other = &world->bodies[1];
  other->frozen = true; /* the contacts and the spring of the first one end on it as on what does not move */
  spore_world_respond(world);
  spore_world_link(world);
  spore_world_find_islands(world);
  g_assert_cmpuint(world->solve.island_count, ==, 1);
  SporeIsland *island = &world->solve.islands[0];
  spore_island_gather(world, island);
  g_assert_cmpuint(island->v_count, ==, ALONE);
  g_assert_cmpuint(island->contact_count, >=, PARTICLES);
  g_assert_cmpuint(island->spring_count, ==, 1);
  SporeIslandSystem system = {world, island};
  SporeDynamics dynamics = spore_island_system_dynamics(&system);
  SporeBody *body = &world->bodies[0];
  body->preconditioner.choice.factorised = true;
  const double c = 0.03, c2 = 0.002;
  /* Still: how a damper's direction turns with its ends is left out of A. */
  double q[ALONE], v[ALONE] = {0}, worst = 0, largest = 0;
  memcpy(q, island->q0, sizeof q);
  dynamics.linearise(dynamics.data, q, NULL, v, c, c2);
  g_assert_cmpuint(system.contact_couplings + system.spring_couplings, ==, 0);
  g_assert_true(body->preconditioner.factor_ready);
  g_assert_cmpfloat(dynamics.factor_cost(dynamics.data), >, 0);
  for (int j = 0; j < ALONE; j++) {
    double unit[N] = {0}, product[N], back[N], stiffness[N], damping[N], mass[N];
    if (j >= 9 && j < 12) continue;
    unit[j] = 1;
    dynamics.multiply(dynamics.data, unit, product);
    dynamics.mass_multiply(dynamics.data, unit, mass);
    column(&dynamics, ALONE, q, v, q, j, stiffness);
    column(&dynamics, ALONE, q, v, v, j, damping);
    dynamics.precondition(dynamics.data, product, back);
    for (int i = 0; i < ALONE; i++) {
      g_assert_cmpfloat_with_epsilon(back[i], unit[i], 1e-12);
      if (i >= 9 && i < 12) continue;
      double expected = mass[i] + c * damping[i] + c2 * stiffness[i];
      worst = fmax(worst, fabs(product[i] - expected));
      largest = fmax(largest, fabs(expected));
    }
  }
  g_assert_cmpfloat(worst, <, 1e-5 * largest);
  /* Kept, it is as it was: terms are not added twice. */
  double unit[ALONE] = {1, 2, 3}, before[ALONE], after[ALONE];
  dynamics.multiply(dynamics.data, unit, before);
  g_assert_true(dynamics.reuse(dynamics.data, q, v, c, c2));
  dynamics.multiply(dynamics.data, unit, after);
  g_assert_cmpmem(before, sizeof before, after, sizeof after);
  spore_world_free(world);
}

/* Among couplings the factor of an earlier matrix of the same c and c2 stays, until it is given up or they change. */
static void test_kept_factor(void) {
  SporeWorld *world = make();
  SporeIsland *island = &world->solve.islands[0];
  SporeIslandSystem system = {world, island};
  SporeDynamics dynamics = spore_island_system_dynamics(&system);
  const double *v = island->v0, c = 0.03;
  double q[N], shifted[N], r[N] = {0}, first[N], later[N], solved[N], back[N], scratch[SPORE_PCG_SCRATCH * N];
  memcpy(q, island->q0, sizeof q);
  memcpy(shifted, q, sizeof q);
  for (int i = 0; i < N; i++) shifted[i] += 0.02 * sin(i), r[i] = i >= 9 && i < 12 ? 0 : cos(i);
  for (int b = 0; b < 2; b++) world->bodies[b].preconditioner.choice.factorised = true;
  dynamics.linearise(dynamics.data, q, NULL, v, c, 0.002);
  g_assert_cmpuint(system.contact_couplings, >, 0);
  dynamics.precondition(dynamics.data, r, first);
  dynamics.linearise(dynamics.data, shifted, NULL, v, c, 0.002);
  dynamics.precondition(dynamics.data, r, later);
  g_assert_cmpmem(first, sizeof first, later, sizeof later);
  for (int b = 0; b < 2; b++) g_assert_cmpuint(world->bodies[b].preconditioner.choice.factors, ==, 1);
  /* A itself is that of the present. */
  SporeLinearOperator operator= {dynamics.data, N, dynamics.multiply, dynamics.precondition};
  SporeLinearResult result = spore_pcg(&operator, r, 1e-10, 100, solved, scratch);
  g_assert_cmpint(result.status, ==, SPORE_LINEAR_CONVERGED);
  world->bodies[0].preconditioner.factor_kept = false;
  dynamics.linearise(dynamics.data, shifted, NULL, v, c, 0.002);
  g_assert_cmpuint(world->bodies[0].preconditioner.choice.factors, ==, 2);
  g_assert_cmpuint(world->bodies[1].preconditioner.choice.factors, ==, 1);
  dynamics.multiply(dynamics.data, solved, back);
  for (int i = 0; i < N; i++) g_assert_cmpfloat_with_epsilon(back[i], r[i], 1e-7);
  dynamics.linearise(dynamics.data, shifted, NULL, v, c, 0.003);
  for (int b = 0; b < 2; b++) g_assert_cmpuint(world->bodies[b].preconditioner.choice.factors, ==, 3 - b);
  spore_world_free(world);
}

/* How far A P^-1 r is from r, at most. */
static double missed(const SporeDynamics *dynamics, const double *r) {
  double solved[N], back[N], worst = 0;
  dynamics->precondition(dynamics->data, r, solved);
  dynamics->multiply(dynamics->data, solved, back);
  for (int i = 0; i < N; i++) worst = fmax(worst, fabs(back[i] - r[i]));
  return worst;
}

/* Coupled, the preconditioner is A's inverse where its factors are those of the present, and nothing is left to take
 * in; before, it lacks the couplings, and other places need another factor. */
static void test_coupled(void) {
  SporeWorld *world = make();
  SporeIsland *island = &world->solve.islands[0];
  SporeIslandSystem system = {world, island};
  SporeDynamics dynamics = spore_island_system_dynamics(&system);
  const double *v = island->v0;
  double q[N], r[N] = {0};
  memcpy(q, island->q0, sizeof q);
  for (int i = 0; i < N; i++) r[i] = i >= 9 && i < 12 ? 0 : cos(i);
  dynamics.linearise(dynamics.data, q, NULL, v, 0.03, 0.002);
  g_assert_cmpuint(system.contact_couplings, >, 0);
  g_assert_cmpuint(dynamics.coupling_patience(dynamics.data).least, >, 0);
  g_assert_cmpuint(dynamics.coupling_patience(dynamics.data).more, >, 0);
  g_assert_cmpfloat(missed(&dynamics, r), >, 1e-2);
  g_assert_true(dynamics.couple(dynamics.data));
  g_test_message("coupled: %.1e", missed(&dynamics, r));
  g_assert_cmpfloat(missed(&dynamics, r), <, 1e-9);
  g_assert_cmpuint(dynamics.coupling_patience(dynamics.data).least, ==, 0);
  for (int i = 0; i < N; i++) q[i] += 0.02 * sin(i);
  dynamics.linearise(dynamics.data, q, NULL, v, 0.03, 0.002);
  g_assert_cmpfloat(missed(&dynamics, r), >, 1e-6);
  g_assert_true(dynamics.couple(dynamics.data));
  g_assert_cmpfloat(missed(&dynamics, r), <, 1e-9);
  spore_world_free(world);
}

static void begin_step(SporeIslandSystem *system, SporeWorld *world, double c) {
  world->state.step++;
  *system = (SporeIslandSystem){world, &world->solve.islands[0]};
  const SporeIsland *island = system->island;
  spore_island_system_linearise(system, island->q0, NULL, island->v0, c, 0.002);
}

/* The next step begins with that preconditioner, as it is, until the bodies' factors are others; a contact that is new
 * is taken in, and what one left is not. */
static void test_coupled_recalled(void) {
  SporeWorld *world = make();
  SporeIsland *island = &world->solve.islands[0];
  SporeIslandSystem system;
  double r[N] = {0};
  for (int i = 0; i < N; i++) r[i] = i >= 9 && i < 12 ? 0 : cos(i);
  size_t contacts = island->contact_count;
  island->contact_count = contacts - 1;
  begin_step(&system, world, 0.03);
  g_assert_false(system.coupled);
  g_assert_true(spore_island_system_couple(&system));
  uint64_t made = world->bodies[0].preconditioner.factors_made;
  for (int i = 0; i < 3; i++) {
    island->contact_count = contacts - 1 + (i == 1);
    begin_step(&system, world, 0.03);
    SporeDynamics dynamics = spore_island_system_dynamics(&system);
    g_assert_true(system.coupled);
    g_assert_cmpfloat(missed(&dynamics, r), <, 1e-9);
    g_assert_cmpuint(world->bodies[0].preconditioner.factors_made, ==, made);
  }
  begin_step(&system, world, 0.04);
  g_assert_false(system.coupled);
  spore_body_forget_steps(world, &world->bodies[0]);
  begin_step(&system, world, 0.03);
  g_assert_false(system.coupled);
  spore_world_free(world);
}

/* Takes steps of this work with and without that preconditioner, made as soon as it may be, until it is given up;
 * returns the number of steps with it. before: steps without it. */
static size_t serve(SporeWorld *world, double with, double without, size_t *before) {
  size_t steps = 0;
  bool recalled = true;
  *before = 0;
  while (steps == 0 || (recalled && steps < 2000)) {
    SporeIslandSystem system;
    begin_step(&system, world, 0.03);
    recalled = system.coupled;
    *system.work += recalled ? with : without;
    if (!recalled) g_assert_true(spore_island_system_couple(&system));
    steps += recalled;
    *before += steps == 0;
  }
  return steps;
}

/* It is recalled as long as it saves work. Where it does not, that is found soon, and tried ever more rarely; where it
 * does, that is asked again from time to time. */
static void test_coupled_trial(void) {
  SporeWorld *world = make();
  size_t before[5], steps[5];
  for (int k = 0; k < 3; k++) steps[k] = serve(world, 3e9, 1e9, &before[k]);
  g_assert_cmpuint(steps[0], <, 8);
  g_assert_cmpuint(steps[2], <, 8);
  g_assert_cmpuint(before[2], >, before[1] + 1);
  spore_body_forget_steps(world, &world->bodies[0]);
  for (int k = 3; k < 5; k++) steps[k] = serve(world, 1e9, 2e9, &before[k]);
  g_test_message(
      "steps with it, after steps without: %zu, %zu, %zu and %zu, %zu, %zu where it costs, %zu, %zu and %zu, "
      "%zu where it saves",
      steps[0], steps[1], steps[2], before[0], before[1], before[2], steps[3], steps[4], before[3], before[4]);
  g_assert_cmpuint(steps[4], >, 32);
  g_assert_cmpuint(steps[4], <, 2000);
  g_assert_cmpuint(before[4], <, 5);
  spore_world_free(world);
}

/* What may buckle has no factor: a solution that goes slowly is then given up, however much the step has taken. */
static void test_coupled_whole(void) {
  SporeWorld *world = make();
  SporeIsland *island = &world->solve.islands[0];
  SporeIslandSystem system = {world, island};
  SporeDynamics dynamics = spore_island_system_dynamics(&system);
  dynamics.linearise(dynamics.data, island->q0, NULL, island->v0, 0.03, 0.002);
  size_t fresh = dynamics.coupling_patience(dynamics.data).least;
  system.products = 1000;
  g_assert_cmpuint(dynamics.coupling_patience(dynamics.data).least, <, fresh);
  dynamics.take_tangent(dynamics.data, SPORE_TANGENT_WHOLE);
  dynamics.linearise(dynamics.data, island->q0, NULL, island->v0, 0.03, 0.002);
  dynamics.take_tangent(dynamics.data, SPORE_TANGENT_USUAL);
  system.products = 1000;
  g_assert_cmpuint(dynamics.coupling_patience(dynamics.data).least, ==, fresh);
  spore_world_free(world);
}

#define STIFF_CHAINS 3
#define WIDE (SPORE_BAND_WIDEST + 1)

/* Chains apart from each other, so stiff for the step that conjugate gradients alone go on and on. */
static SporeWorld *make_stiff(SporePool *pool, double stiffness, int reach, SporeNonlinearKind nonlinear) {
  SporeBodyDescription bodies[STIFF_CHAINS];
  SporeLinkDescription links[STIFF_CHAINS];
  static const char *const names[STIFF_CHAINS] = {"a", "b", "c"};
  for (int b = 0; b < STIFF_CHAINS; b++) {
    SporeModel *model = chain_create((ChainFields){.count = 60 + 20 * b,
                                                   .reach = reach,
                                                   .mass = 0.01,
                                                   .spacing = 0.1,
                                                   .stiffness = stiffness,
                                                   .damping = 0.01,
                                                   .poison_at = HUGE_VAL});
    bodies[b] = passive_body(names[b], model, (SporeVec3){0, 0, b});
    bodies[b].velocity = (SporeVec3){1 + b, 0.1, 0};
    links[b] = (SporeLinkDescription){
        .name = names[b], .type = &spore_link_pin, .body_a = (uint32_t)b, .point_a = {0, 0, b}, .radius = 0.05};
  }
  SporeWorldDescription description = world_description(bodies, STIFF_CHAINS);
  description.solver.nonlinear = (int)nonlinear;
  description.gravity = (SporeVec3){0, -9.81, 0};
  description.links = links;
  description.link_count = STIFF_CHAINS;
  SporeWorld *world = spore_world_create(&description, pool, NULL);
  g_assert_nonnull(world);
  return world;
}

static void run(SporeWorld *world, int steps) {
  for (int i = 0; i < steps; i++) spore_world_step(world);
}

/* A band is always factorised. Of others stiff bodies get a factor, soft ones do not; the choice takes no memory, and
 * is the same on any number of threads and again after a reset. */
static void test_choice(void) {
  SporeWorld *soft = make_stiff(NULL, 1, WIDE, SPORE_NONLINEAR_NEWTON);
  run(soft, 40);
  for (int b = 0; b < STIFF_CHAINS; b++) g_assert_false(soft->bodies[b].preconditioner.choice.factorised);
  spore_world_free(soft);
  SporeWorld *narrow = make_stiff(NULL, 1, 1, SPORE_NONLINEAR_NEWTON);
  run(narrow, 40);
  for (int b = 0; b < STIFF_CHAINS; b++) g_assert_true(narrow->bodies[b].preconditioner.choice.factorised);
  spore_world_free(narrow);
  uint64_t expected = 0;
  for (int threads = 1; threads <= 2; threads++) {
    SporePool *pool = spore_pool_create(threads);
    SporeWorld *world = make_stiff(pool, 1e7, WIDE, SPORE_NONLINEAR_AUTOMATIC);
    uint64_t allocations = spore_allocation_count();
    run(world, 40);
    g_assert_cmpuint(spore_allocation_count(), ==, allocations);
    SporeStepCounts counts = spore_world_counts(world);
    g_test_message("%zu Newton and %zu linear iterations with factors", (size_t)counts.newton_iterations,
                   (size_t)counts.linear_iterations);
    for (int b = 0; b < STIFF_CHAINS; b++) g_assert_true(world->bodies[b].preconditioner.choice.factorised);
    g_assert_cmpuint(counts.linear_iterations, <=, 4 * counts.newton_iterations);
    if (threads == 1) expected = spore_world_hash(world);
    g_assert_cmpuint(spore_world_hash(world), ==, expected);
    spore_world_reset(world);
    for (int b = 0; b < STIFF_CHAINS; b++) g_assert_false(world->bodies[b].preconditioner.choice.factorised);
    run(world, 40);
    g_assert_cmpuint(spore_world_hash(world), ==, expected);
    spore_world_free(world);
    spore_pool_free(pool);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/sim/operator/dense", test_dense);
  g_test_add_func("/sim/operator/preconditioner", test_preconditioner);
  g_test_add_func("/sim/operator/factor", test_factor);
  g_test_add_func("/sim/operator/local-assembly", test_local_assembly);
  g_test_add_func("/sim/operator/kept-factor", test_kept_factor);
  g_test_add_func("/sim/operator/coupled", test_coupled);
  g_test_add_func("/sim/operator/coupled-recalled", test_coupled_recalled);
  g_test_add_func("/sim/operator/coupled-trial", test_coupled_trial);
  g_test_add_func("/sim/operator/coupled-whole", test_coupled_whole);
  g_test_add_func("/sim/operator/choice", test_choice);
  return g_test_run();
}
