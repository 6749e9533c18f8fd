/* Levels of detail that change by themselves: by error, by distance and by time. */
#include <math.h>
#include <string.h>

#include "core/sim/world_private.h"
#include "tests/stability/rig.h"

#define TOLERANCE 2e-3
#define WAIT_S 0.05
#define REACH_M 0.1

static SporeModel *bar(unsigned parts) {
  SporeTriangleMesh mesh;
  shape_box(&mesh, spore_vec3(0.1, 0, 0), spore_vec3(0.2, 0.05, 0.05));
  return rig_surface_model(&spore_finite_differences, &mesh, "cells", (double)parts, "young_modulus", 2e4,
                           "mass_damping", 4., NULL);
}

/* A bar of three levels with spheres along it. */
static Rig *rig_of(SporeLodCause by) {
  static const double points[] = {0.02, 0, 0, 0.06, 0, 0, 0.1, 0, 0, 0.14, 0, 0, 0.18, 0, 0};
  Rig *rig = rig_new();
  SporeBodyDescription *body = rig_passive(rig, "bar", bar(16), rig_spheres(rig, points, 5, 0.02));
  body->lod = (SporeLodDescription){
      .model = {bar(4), bar(8)},
      .first = SPORE_LOD_FINE,
      .tolerance = TOLERANCE,
      .rule = {.by = by, .tool_distance = by == SPORE_LOD_BY_DISTANCE ? REACH_M : 0, .wait_s = WAIT_S}};
  rig->description.solver.sleep_speed = 0;
  return rig;
}

/* What the log has to say at every time. */
static void assert_log(const SporeWorld *world, SporeLodCause by) {
  for (uint64_t i = 0; i < spore_world_lod_change_count(world); i++) {
    SporeLodChange change = spore_world_lod_change(world, i);
    SporeLodGrade before = i ? spore_world_lod_change(world, i - 1).to : SPORE_LOD_FINE;
    g_test_message("%.3f s: %s to %s, %.4g", change.time_s, spore_lod_names[change.from], spore_lod_names[change.to],
                   change.figure);
    g_assert_cmpint((int)change.by, ==, (int)by);
    g_assert_cmpint((int)change.from, ==, (int)before);
    g_assert_cmpint((int)change.to, !=, (int)change.from);
    if (i) g_assert_cmpfloat(change.time_s - spore_world_lod_change(world, i - 1).time_s, >=, WAIT_S - 1e-9);
  }
}

static SporeLodState state_of(const SporeWorld *world) {
  SporeLodState state;
  g_assert_true(spore_world_lod_state(world, 0, &state));
  return state;
}

/* By distance: a probe passes by. */

#define SIDE_M 0.08 /* the probe passes at this distance from the bar's axis */

static Rig *passing(RigMover *mover, SporePool *pool) {
  Rig *rig = rig_of(SPORE_LOD_BY_DISTANCE);
  rig_active(rig, "probe", rig_sphere(rig, 0.01));
  SporeWorld *world = rig_build_on(rig, pool);
  *mover = (RigMover){{&rig_mover_type}, {-0.5, 0, SIDE_M}, {1, 0, 0}};
  spore_world_set_device(world, 1, &mover->base);
  return rig;
}

static void test_distance(void) {
  RigMover mover;
  Rig *rig = passing(&mover, NULL);
  SporeWorld *world = rig->world;
  g_assert_true(spore_world_is_repeatable(world));
  rig_run(world, (unsigned)round(1.2 / rig->description.solver.time_step));
  assert_log(world, SPORE_LOD_BY_DISTANCE);
  uint64_t count = spore_world_lod_change_count(world), finer = 0, last_finer = 0;
  g_assert_cmpuint(count, >=, 4);
  for (uint64_t i = 0; i < count; i++) {
    SporeLodChange change = spore_world_lod_change(world, i);
    if (change.to < change.from) continue;
    finer++, last_finer = i;
    g_assert_cmpfloat(change.figure, <=, 2 * REACH_M);
  }
  /* Coarse, then finer as the probe comes, then coarse as it leaves: not to and fro. */
  g_assert_cmpuint(finer, >=, 1);
  g_assert_cmpuint(finer, <=, 2);
  g_assert_cmpint((int)spore_world_lod_change(world, last_finer).to, ==, SPORE_LOD_FINE);
  g_assert_cmpfloat(spore_world_lod_change(world, last_finer).figure, <=, REACH_M);
  g_assert_cmpuint(count, <=, 6);
  g_assert_cmpint((int)state_of(world).level, ==, SPORE_LOD_COARSE);
  g_assert_cmpfloat(state_of(world).error, <=, TOLERANCE);
  g_assert_cmpuint(state_of(world).refused, ==, 0);
  rig_free(rig);
}

/* Eyes count as tools do: one that stands close keeps the bar fine, one far away does not. */
static void test_eye(void) {
  for (int near = 0; near < 2; near++) {
    Rig *rig = rig_of(SPORE_LOD_BY_DISTANCE);
    const SporeEyeDescription eye = {SPORE_NO_BODY, spore_vec3(0.1, near ? 0.1 : 3, 0)};
    g_array_index(rig->bodies, SporeBodyDescription, 0).lod.rule.view_distance = REACH_M;
    rig->description.eyes = &eye;
    rig->description.eye_count = 1;
    SporeWorld *world = rig_build(rig);
    rig_run(world, 100);
    g_assert_cmpint((int)state_of(world).level, ==, near ? SPORE_LOD_FINE : SPORE_LOD_COARSE);
    rig_free(rig);
  }
}

/* On several threads, and again from time 0: the same bits and the same log. */
static void test_same_bits(void) {
  uint64_t expected = 0, changes = 0;
  for (int threads = 1; threads <= 2; threads++) {
    SporePool *pool = spore_pool_create(threads);
    RigMover mover;
    Rig *rig = passing(&mover, pool);
    for (int run = 0; run < 2; run++) {
      rig_run(rig->world, 250);
      if (expected == 0) expected = spore_world_hash(rig->world), changes = spore_world_lod_change_count(rig->world);
      g_assert_cmphex(spore_world_hash(rig->world), ==, expected);
      g_assert_cmpuint(spore_world_lod_change_count(rig->world), ==, changes);
      spore_world_reset(rig->world);
      g_assert_cmpuint(spore_world_lod_change_count(rig->world), ==, 0);
    }
    rig_free(rig);
    spore_pool_free(pool);
  }
  g_assert_cmpuint(changes, >=, 2);
}

/* By error: a bar that is clamped at one end, loaded slowly and unloaded again. */

static Rig *clamped(SporeLodCause by, SporeLodGrade first) {
  Rig *rig = rig_of(by);
  g_array_index(rig->bodies, SporeBodyDescription, 0).lod.first = first;
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 0.036);
  return rig;
}

static void load(SporeWorld *world, double gravity) {
  SporeCommand command = {.kind = SPORE_COMMAND_GRAVITY, .vector = spore_vec3(0, 0, -gravity)};
  g_assert_true(spore_world_post(world, &command));
}

static void test_error(void) {
  Rig *rig = clamped(SPORE_LOD_BY_ERROR, SPORE_LOD_FINE);
  SporeWorld *world = rig_build(rig);
  rig_run(world, 100);
  g_assert_cmpint((int)state_of(world).level, ==, SPORE_LOD_COARSE);
  load(world, 4);
  rig_run(world, 400);
  g_assert_cmpint((int)state_of(world).level, ==, SPORE_LOD_FINE);
  uint64_t loaded = spore_world_lod_change_count(world);
  g_assert_cmpfloat(spore_world_lod_change(world, loaded - 1).figure, >, TOLERANCE);
  rig_run(world, 400);
  g_assert_cmpuint(spore_world_lod_change_count(world), <=, loaded + 1); /* it hangs still */
  load(world, 0);
  rig_run(world, 1500);
  g_test_message("bent %.3g m, refused %u", spore_lod_bent(world, &world->bodies[0]),
                 (unsigned)state_of(world).refused);
  assert_log(world, SPORE_LOD_BY_ERROR);
  g_assert_cmpint((int)state_of(world).level, ==, SPORE_LOD_COARSE);
  g_assert_cmpfloat(state_of(world).error, <=, TOLERANCE);
  rig_free(rig);
}

/* Where the tip of a clamped bar hangs at a level, m. */
static double tip(SporeLodGrade level, double *bent, double *estimate) {
  Rig *rig = clamped(SPORE_LOD_BY_ERROR, level);
  g_array_index(rig->bodies, SporeBodyDescription, 0).lod.rule.wait_s = 1000;
  g_array_index(rig->bodies, SporeBodyDescription, 0).lod.tolerance = 0.05;
  rig->description.solver.integrator = SPORE_INTEGRATOR_STATIC;
  rig->description.gravity = spore_vec3(0, 0, -1);
  SporeWorld *world = rig_build(rig);
  double end[] = {0.2, 0, 0};
  SporeMapping mapping;
  world->bodies[0].lod->automation.not_before = UINT64_MAX; /* it stays at the level */
  rig_run(world, 5);
  g_assert_cmpint((int)state_of(world).level, ==, (int)level);
  g_assert_true(spore_world_map(world, 0, end, 1, &mapping, NULL));
  double z = spore_mapping_position(&mapping, 0, spore_world_q(world, 0)).z;
  *bent = spore_lod_bent(world, &world->bodies[0]);
  *estimate = spore_lod_estimate(world->bodies[0].lod, level, *bent);
  spore_mapping_clear(&mapping);
  rig_free(rig);
  return z;
}

/* The estimate is of the size of what a level gets wrong: no less than a third of it, no more than three times it. */
static void test_estimate(void) {
  double bent, estimate, fine = tip(SPORE_LOD_FINE, &bent, &estimate);
  g_assert_cmpfloat(estimate, ==, 0);
  for (int level = 0; level < SPORE_LOD_FINE; level++) {
    double wrong = fabs(tip((SporeLodGrade)level, &bent, &estimate) - fine);
    g_test_message("%s: bent %.3e m, tip %.3e m wrong, estimated %.3e m", spore_lod_names[level], bent, wrong,
                   estimate);
    g_assert_cmpfloat(estimate, >=, wrong / 3);
    g_assert_cmpfloat(estimate, <=, 3 * wrong);
  }
}

/* By time, with times that the test makes up: a step takes `fine_us` at level fine, half at medium, a fifth at coarse.
 */

static void run_timed(SporeWorld *world, unsigned steps, double fine_us) {
  static const double share[] = {0.2, 0.5, 1};
  for (unsigned i = 0; i < steps; i++) {
    spore_world_step(world);
    world->schedule.step_us = fine_us * share[state_of(world).level];
  }
}

static void test_time(void) {
  Rig *rig = rig_of(SPORE_LOD_BY_TIME);
  SporeWorld *world = rig_build(rig);
  g_assert_false(spore_world_is_repeatable(world));
  spore_world_set_budget(world, 100);
  run_timed(world, 200, 95);
  g_assert_cmpuint(spore_world_lod_change_count(world), ==, 0);
  run_timed(world, 200, 150); /* 75 at medium: that is within the budget, and fine is not */
  g_assert_cmpint((int)state_of(world).level, ==, SPORE_LOD_MEDIUM);
  g_assert_cmpuint(spore_world_lod_change_count(world), ==, 1);
  g_assert_cmpfloat(spore_world_lod_change(world, 0).figure, ==, 150);
  run_timed(world, 400, 130); /* 65 at medium: short, but fine would take 65 + 75 */
  g_assert_cmpuint(spore_world_lod_change_count(world), ==, 1);
  run_timed(world, 200, 400); /* 80 at coarse */
  g_assert_cmpint((int)state_of(world).level, ==, SPORE_LOD_COARSE);
  run_timed(world, 400, 0.1); /* nothing else to do, but what it saved was 120 of 100: it stays */
  g_assert_cmpint((int)state_of(world).level, ==, SPORE_LOD_COARSE);
  assert_log(world, SPORE_LOD_BY_TIME);
  rig_free(rig);
}

/* What was saved fits again: it gets finer, once. */
static void test_time_back(void) {
  Rig *rig = rig_of(SPORE_LOD_BY_TIME);
  SporeWorld *world = rig_build(rig);
  spore_world_set_budget(world, 100);
  run_timed(world, 100, 110);
  g_assert_cmpint((int)state_of(world).level, ==, SPORE_LOD_MEDIUM);
  run_timed(world, 200, 40); /* 20 at medium, and fine cost 55 more */
  g_assert_cmpint((int)state_of(world).level, ==, SPORE_LOD_FINE);
  g_assert_cmpuint(spore_world_lod_change_count(world), ==, 2);
  rig_free(rig);
}

/* Nobody asks: no stage, no change. */
static void test_not_asked(void) {
  Rig *rig = rig_of(SPORE_LOD_BY_HAND);
  SporeWorld *world = rig_build(rig);
  const SporePlan *plan = spore_world_plan(world);
  for (size_t i = 0; i < plan->stage_count; i++)
    if (strcmp(plan->stages[i].name, "levels") == 0) g_assert_false(plan->stages[i].included);
  rig_run(world, 100);
  g_assert_cmpuint(spore_world_lod_change_count(world), ==, 0);
  g_assert_true(spore_world_is_repeatable(world));
  rig_free(rig);
}

/* A refused change is tried again later and later, and says nothing. */
static void test_refused(void) {
  Rig *rig = rig_of(SPORE_LOD_BY_DISTANCE);
  SporeBodyDescription *body = &g_array_index(rig->bodies, SporeBodyDescription, 0);
  body->lod.tolerance = 0; /* not even at rest */
  SporeWorld *world = rig_build(rig);
  uint64_t messages = spore_world_monitor(world)->message_count;
  rig_run(world, 500);
  SporeLodState state = state_of(world);
  g_test_message("%u refused in %g s", (unsigned)state.refused, spore_world_time_s(world));
  g_assert_cmpint((int)state.level, ==, SPORE_LOD_FINE);
  g_assert_cmpuint(state.refused, >=, 2);
  g_assert_cmpfloat((double)state.refused, <=, 2 + log2(spore_world_time_s(world) / WAIT_S));
  g_assert_cmpuint(spore_world_monitor(world)->message_count, ==, messages);
  rig_free(rig);
}

/* What may tear is never made coarser by error or time, which no coarse level could follow. */
static void test_torn(void) {
  SporeTriangleMesh fine, coarse;
  shape_sheet(&fine, 13, 13, 0.01, TRUE);
  shape_sheet(&coarse, 7, 7, 0.02, TRUE);
  Rig *rig = rig_new();
  SporeBodyDescription *body =
      rig_passive(rig, "net", rig_surface_model(&spore_mass_spring_net, &fine, "tear_strain", 0.5, NULL), NULL);
  body->lod =
      (SporeLodDescription){.model = {rig_surface_model(&spore_mass_spring_net, &coarse, "tear_strain", 0.5, NULL)},
                            .first = SPORE_LOD_FINE,
                            .tolerance = 0.01,
                            .rule = {.by = SPORE_LOD_BY_ERROR, .wait_s = WAIT_S}};
  rig->description.solver.sleep_speed = 0;
  SporeWorld *world = rig_build(rig);
  g_assert_true(spore_world_may_be_cut(world, 0));
  rig_run(world, 100);
  g_assert_cmpint((int)state_of(world).level, ==, SPORE_LOD_FINE);
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/automatic_levels/distance", test_distance);
  g_test_add_func("/automatic_levels/eye", test_eye);
  g_test_add_func("/automatic_levels/same-bits", test_same_bits);
  g_test_add_func("/automatic_levels/error", test_error);
  g_test_add_func("/automatic_levels/estimate", test_estimate);
  g_test_add_func("/automatic_levels/time", test_time);
  g_test_add_func("/automatic_levels/time-back", test_time_back);
  g_test_add_func("/automatic_levels/not-asked", test_not_asked);
  g_test_add_func("/automatic_levels/refused", test_refused);
  g_test_add_func("/automatic_levels/torn", test_torn);
  return g_test_run();
}
