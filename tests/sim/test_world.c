/* The world around the step: islands, threads, reset, plan, commands, refusals. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/sim/chain_model.h"

#define GRAVITY ((SporeVec3){0, -9.81, 0})

static SporeWorld *create(SporeWorldDescription *description, SporePool *pool) {
  SporeError error = SPORE_ERROR_INIT;
  SporeWorld *world = spore_world_create(description, pool, &error);
  if (!world) g_error("%s: %s", error.place, error.message);
  return world;
}

static SporeModel *chain(int count, double poison_at) {
  return chain_create((ChainFields){
      .count = count, .mass = 0.1, .spacing = 0.25, .stiffness = 300, .damping = 0.05, .poison_at = poison_at});
}

static void run(SporeWorld *world, int steps) {
  for (int i = 0; i < steps; i++) spore_world_step(world);
}

/* Spheres at the particles of a chain. */
static double chain_spheres[8 * 4], floor_spheres[1600 * 4];
static SporeSphereSet chain_set = {8, chain_spheres}, floor_set = {1600, floor_spheres};

static void fill_spheres(void) {
  for (int i = 0; i < 8; i++) {
    double sphere[4] = {0.25 * i, 0, 0, 0.1};
    memcpy(chain_spheres + 4 * i, sphere, sizeof sphere);
  }
  for (int i = 0; i < 1600; i++) {
    double sphere[4] = {0.2 * (i % 40), -0.2, 0.2 * (i / 40), 0.2};
    memcpy(floor_spheres + 4 * i, sphere, sizeof sphere);
  }
}

enum { PILE = 12 };

/* Chains over each other that fall on a floor and into each other, some far apart. */
static SporeWorld *pile(SporeIntegratorKind integrator, SporePool *pool) {
  static SporeBodyDescription bodies[PILE + 1];
  static const char *const names[PILE] = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l"};
  for (int i = 0; i < PILE; i++) {
    bodies[i] =
        passive_body(names[i], chain(8, HUGE_VAL), (SporeVec3){2.5 * (i % 3), 0.15 + 0.25 * (i / 6), 2.0 * (i % 2)});
    bodies[i].pose.orientation = spore_quat_from_rotation_vector((SporeVec3){0, 0.3 * (i % 6), 0.1});
    bodies[i].spheres = &chain_set;
  }
  bodies[PILE] = (SporeBodyDescription){.name = "floor",
                                        .role = SPORE_UNMOVABLE,
                                        .pose = spore_pose_identity(),
                                        .spheres = &floor_set,
                                        .contact = bodies[0].contact};
  SporeWorldDescription description = world_description(bodies, PILE + 1);
  description.gravity = GRAVITY;
  description.solver.integrator = integrator;
  return create(&description, pool);
}

static void test_threads(gconstpointer data) {
  uint64_t expected = 0;
  for (int threads = 1; threads <= 4; threads *= 2) {
    SporePool *pool = spore_pool_create(threads);
    SporeWorld *world = pile(GPOINTER_TO_INT(data), pool);
    run(world, 300);
    g_assert_cmpuint(spore_world_counts(world).contacts, >, 10);
    g_assert_cmpuint(spore_world_counts(world).islands, >, 1);
    g_assert_cmpuint(spore_world_counts(world).islands, <, PILE);
    if (threads == 1) expected = spore_world_hash(world);
    g_assert_cmpuint(spore_world_hash(world), ==, expected);
    g_assert_cmpuint(spore_snapshot_hash(spore_world_snapshot_acquire(world)), ==, expected);
    spore_world_free(world);
    spore_pool_free(pool);
  }
}

static void test_reset(gconstpointer data) {
  SporeWorld *world = pile(GPOINTER_TO_INT(data), NULL);
  uint64_t start = spore_world_hash(world);
  run(world, 150);
  uint64_t end = spore_world_hash(world);
  g_assert_cmpuint(end, !=, start);
  spore_world_reset(world);
  g_assert_cmpuint(spore_world_hash(world), ==, start);
  g_assert_cmpuint(spore_world_snapshot_acquire(world)->step, ==, 0);
  run(world, 150);
  g_assert_cmpuint(spore_world_hash(world), ==, end);
  spore_world_free(world);
}

static void test_no_allocation(gconstpointer data) {
  SporePool *pool = spore_pool_create(2);
  SporeWorld *world = pile(GPOINTER_TO_INT(data), pool);
  run(world, 5);
  uint64_t before = spore_allocation_count();
  run(world, 200);
  g_assert_cmpuint(spore_allocation_count(), ==, before);
  spore_world_free(world);
  spore_pool_free(pool);
}

/* Two bodies that do not touch move as each does alone. */
static void test_islands_alone(void) {
  const double height[2] = {0, 5};
  double together[2][24], alone[24];
  SporeBodyDescription bodies[2];
  for (int i = 0; i < 2; i++) {
    bodies[i] = passive_body(i ? "b" : "a", chain(8, HUGE_VAL), (SporeVec3){0, height[i], 0});
    bodies[i].spin = (SporeVec3){0, 1, 2};
  }
  SporeLinkDescription pin = {.name = "p", .type = &spore_link_pin, .body_a = 1, .point_a = {0, 5, 0}, .radius = 0.1};
  SporeWorldDescription description = world_description(bodies, 2);
  description.gravity = GRAVITY;
  description.links = &pin;
  description.link_count = 1;
  SporeWorld *world = create(&description, NULL);
  run(world, 100);
  for (uint32_t i = 0; i < 2; i++) memcpy(together[i], spore_world_q(world, i), sizeof together[i]);
  spore_world_free(world);
  for (int i = 0; i < 2; i++) {
    SporeBodyDescription body = passive_body("one", chain(8, HUGE_VAL), (SporeVec3){0, height[i], 0});
    body.spin = (SporeVec3){0, 1, 2};
    pin.body_a = 0;
    description = world_description(&body, 1);
    description.gravity = GRAVITY;
    description.links = &pin;
    description.link_count = i == 1;
    world = create(&description, NULL);
    run(world, 100);
    memcpy(alone, spore_world_q(world, 0), sizeof alone);
    g_assert_cmpmem(alone, sizeof alone, together[i], sizeof alone);
    spore_world_free(world);
  }
}

static const SporePlanStage *stage(const SporePlan *plan, const char *name) {
  for (size_t i = 0; i < plan->stage_count; i++)
    if (!strcmp(plan->stages[i].name, name)) return &plan->stages[i];
  g_error("no stage %s", name);
}

static void test_plan(void) {
  SporeBodyDescription body = passive_body("alone", chain(8, HUGE_VAL), (SporeVec3){0, 0, 0});
  body.spheres = &chain_set;
  SporeWorldDescription description = world_description(&body, 1);
  SporeWorld *world = create(&description, NULL);
  run(world, 3);
  const SporePlan *plan = spore_world_plan(world);
  const char *const out[] = {"device_input", "tools", "map", "detect", "respond", "link", "reactions", "feedback"};
  const char *const in[] = {"commands", "islands", "integrate", "accept", "advance", "publish"};
  for (size_t i = 0; i < G_N_ELEMENTS(out); i++) {
    g_assert_false(stage(plan, out[i])->included);
    g_assert_null(stage(plan, out[i])->profile);
    g_assert_cmpstr(stage(plan, out[i])->reason, !=, "");
  }
  for (size_t i = 0; i < G_N_ELEMENTS(in); i++) {
    g_assert_true(stage(plan, in[i])->included);
    g_assert_cmpuint(stage(plan, in[i])->profile->count, ==, 3);
  }
  g_assert_cmpuint(stage(plan, "integrate")->items, ==, 24);
  g_assert_cmpuint(plan->left_out_count, ==, 5);
  g_assert_cmpuint(spore_world_profile(world)->count, ==, 3);
  const SporeCommand pull = {.kind = SPORE_COMMAND_PULL, .vector = {0, 1, 0}, .number = 10},
                     let_go = {SPORE_COMMAND_RELEASE};
  g_assert_true(spore_world_post(world, &pull));
  run(world, 2);
  g_assert_true(stage(spore_world_plan(world), "link")->included);
  g_assert_cmpuint(stage(plan, "link")->profile->count, ==, 2);
  g_assert_true(spore_world_post(world, &let_go));
  run(world, 1);
  g_assert_false(stage(spore_world_plan(world), "link")->included);
  spore_world_free(world);

  world = pile(SPORE_INTEGRATOR_SYMPLECTIC_EULER, NULL);
  run(world, 100);
  plan = spore_world_plan(world);
  g_assert_true(stage(plan, "detect")->included);
  g_assert_cmpuint(stage(plan, "respond")->items, ==, spore_world_counts(world).contacts);
  g_assert_cmpuint(stage(plan, "map")->items, ==, 8 * PILE);
  spore_world_free(world);
}

/* A model whose forces stop being numbers: it is frozen and named, and the body it hangs on goes on. */
static void test_freeze(gconstpointer data) {
  SporeBodyDescription bodies[2] = {passive_body("sick", chain(3, HUGE_VAL), (SporeVec3){0, 0, 0}),
                                    passive_body("well", chain(3, HUGE_VAL), (SporeVec3){0, -1, 0})};
  bodies[0].velocity = (SporeVec3){0, 4, 0};
  SporeLinkDescription spring = {.name = "s",
                                 .type = &spore_link_spring,
                                 .body_a = 0,
                                 .body_b = 1,
                                 .point_b = {0, -1, 0},
                                 .stiffness = 10,
                                 .rest_length = -1};
  SporeWorldDescription description = world_description(bodies, 2);
  description.gravity = GRAVITY;
  description.links = &spring;
  description.link_count = 1;
  description.solver.integrator = GPOINTER_TO_INT(data);
  SporeWorld *world = create(&description, NULL);
  run(world, 20);
  ChainFields *fields = SPORE_NEW(ChainFields);
  *fields = (ChainFields){.count = 3, .mass = 0.1, .spacing = 0.25, .stiffness = 300, .poison_at = -1e300};
  SporeCommand poison = {.kind = SPORE_COMMAND_RETUNE, .body = 0, .fields = fields};
  g_assert_true(spore_world_post(world, &poison));
  for (int i = 0; i < 400; i++) {
    spore_world_step(world);
    for (int k = 0; k < 9; k++) {
      g_assert_true(isfinite(spore_world_q(world, 0)[k]));
      g_assert_true(isfinite(spore_world_q(world, 1)[k]));
    }
  }
  g_assert_true(spore_world_body_frozen(world, 0));
  g_assert_false(spore_world_body_frozen(world, 1));
  g_assert_cmpfloat(spore_world_v(world, 0)[1], ==, 0);
  g_assert_cmpfloat(fabs(spore_world_v(world, 1)[1]), >, 0.01);
  const SporeMonitor *monitor = spore_world_monitor(world);
  g_assert_cmpuint(monitor->not_finite, >=, 1);
  g_assert_cmpuint(monitor->message_count, >=, 1);
  const char *last = monitor->messages[monitor->message_count - 1].text;
  g_assert_nonnull(strstr(last, "sick"));
  g_assert_nonnull(strstr(last, "frozen"));
  g_assert_nonnull(strstr(last, "not finite"));
  SporeCommand thaw = {.kind = SPORE_COMMAND_THAW, .body = 0};
  g_assert_true(spore_world_post(world, &thaw));
  spore_world_step(world);
  spore_world_reset(world);
  g_assert_false(spore_world_body_frozen(world, 0));
  spore_world_free(world);
}

static void test_speed_limit(void) {
  SporeBodyDescription bodies[2] = {passive_body("fast", chain(1, HUGE_VAL), (SporeVec3){0, 0, 0}),
                                    passive_body("slow", chain(1, HUGE_VAL), (SporeVec3){5, 0, 0})};
  bodies[0].velocity = (SporeVec3){0, -2.0, 0};
  SporeWorldDescription description = world_description(bodies, 2);
  description.gravity = GRAVITY;
  description.solver.maximum_speed = 2.5;
  SporeWorld *world = create(&description, NULL);
  run(world, 100);
  g_assert_true(spore_world_body_frozen(world, 0));
  g_assert_false(spore_world_body_frozen(world, 1));
  g_assert_cmpuint(spore_world_monitor(world)->too_fast, ==, 1);
  g_assert_nonnull(strstr(spore_world_monitor(world)->messages[0].text, "fast"));
  spore_world_free(world);
}

/* Gravity, pull and release, retune. */
static void test_commands(gconstpointer data) {
  SporeBodyDescription body = passive_body("chain", chain(3, HUGE_VAL), (SporeVec3){0, 0, 0});
  SporeWorldDescription description = world_description(&body, 1);
  description.solver.integrator = GPOINTER_TO_INT(data);
  SporeWorld *world = create(&description, NULL);
  run(world, 10);
  g_assert_cmpfloat(fabs(spore_world_q(world, 0)[1]), ==, 0);
  SporeCommand pull = {
      .kind = SPORE_COMMAND_PULL, .body = 0, .point = {0.52, 0.01, 0}, .vector = {0.5, 0.3, 0}, .number = 200};
  g_assert_true(spore_world_post(world, &pull));
  run(world, 4000);
  const double *q = spore_world_q(world, 0);
  g_assert_cmpfloat_with_epsilon(q[6], 0.5, 1e-3);
  g_assert_cmpfloat_with_epsilon(q[7], 0.3, 1e-3);
  SporeCommand release = {.kind = SPORE_COMMAND_RELEASE, .body = 0};
  SporeCommand gravity = {.kind = SPORE_COMMAND_GRAVITY, .vector = {0, 0, -1}};
  ChainFields *fields = SPORE_NEW(ChainFields);
  *fields = (ChainFields){.count = 3, .mass = 0.1, .spacing = 0.5, .stiffness = 300, .damping = 1, .poison_at = 1e300};
  SporeCommand retune = {.kind = SPORE_COMMAND_RETUNE, .body = 0, .fields = fields};
  g_assert_true(spore_world_post(world, &release));
  g_assert_true(spore_world_post(world, &gravity));
  g_assert_true(spore_world_post(world, &retune));
  run(world, 4000);
  q = spore_world_q(world, 0);
  double length = hypot(q[3] - q[0], hypot(q[4] - q[1], q[5] - q[2]));
  g_assert_cmpfloat_with_epsilon(length, 0.5, 1e-3);
  g_assert_cmpfloat_with_epsilon(spore_world_v(world, 0)[2], -0.1, 1e-3);
  SporeCommand bad = {.kind = SPORE_COMMAND_GRAVITY, .vector = {0, NAN, 0}};
  uint64_t messages = spore_world_monitor(world)->message_count;
  g_assert_true(spore_world_post(world, &bad));
  bad = (SporeCommand){.kind = SPORE_COMMAND_THAW, .body = 77};
  g_assert_true(spore_world_post(world, &bad));
  spore_world_step(world);
  g_assert_cmpuint(spore_world_monitor(world)->message_count, ==, messages + 1);
  for (int i = 0; i < 1024; i++) g_assert_true(spore_world_post(world, &gravity));
  g_assert_false(spore_world_post(world, &gravity));
  spore_world_free(world);
}

static void refuse(SporeWorldDescription *description, const char *place, const char *word) {
  SporeError error = SPORE_ERROR_INIT;
  g_assert_null(spore_world_create(description, NULL, &error));
  g_assert_cmpstr(error.place, ==, place);
  g_assert_nonnull(strstr(error.message, word));
}

static void test_refusals(void) {
  SporeModel *model = chain(3, HUGE_VAL);
  SporeBodyDescription bodies[2] = {passive_body("soft", model, (SporeVec3){0, 0, 0}),
                                    {.name = "wall", .role = SPORE_UNMOVABLE, .pose = spore_pose_identity()}};
  SporeWorldDescription description = world_description(bodies, 2);
  SporeLinkDescription link = {.name = "l", .type = &spore_link_pin, .body_a = 0, .point_a = {0, 9, 0}, .radius = 0.1};
  description.links = &link;
  description.link_count = 1;
  refuse(&description, "links/l", "radius");
  link.body_a = 1;
  refuse(&description, "links/l", "passive");
  link = (SporeLinkDescription){
      .name = "l", .type = &spore_link_spring, .body_a = 1, .body_b = SPORE_NO_BODY, .stiffness = 1};
  refuse(&description, "links/l", "passive");
  link.body_a = 0;
  link.stiffness = NAN;
  refuse(&description, "links/l", "finite");
  description.link_count = 0;
  bodies[0].pose.position.x = INFINITY;
  refuse(&description, "bodies/soft", "finite");
  bodies[0].pose.position.x = 0;
  description.solver.time_step = -1;
  refuse(&description, "solver", "time_step");
  description.solver.integrator = SPORE_INTEGRATOR_SYMPLECTIC_EULER;
  description.solver.time_step = 0.1;
  refuse(&description, "bodies/soft", "expected at most 0.0"); /* w^2 = 3 k / m: the limit is 1.73 / 95 s */
  model->type->destroy(model);
}

/* Every allocation of create may fail, and nothing leaks (the sanitizer looks). */
static void check_create_without_memory(int surface) {
  SporeModel *model = chain(8, HUGE_VAL);
  SporeBodyDescription bodies[2] = {
      passive_body("soft", model, (SporeVec3){0, 0, 0}),
      {.name = "floor", .role = SPORE_UNMOVABLE, .pose = spore_pose_identity(), .spheres = &floor_set}};
  bodies[0].spheres = &chain_set;
  bodies[1].contact = bodies[0].contact;
  bodies[1].contact.surface = surface;
  SporeLinkDescription spring = {
      .name = "s", .type = &spore_link_spring, .body_a = 0, .body_b = SPORE_NO_BODY, .stiffness = 1};
  SporeWorldDescription description = world_description(bodies, 2);
  description.links = &spring;
  description.link_count = 1;
  SporeWorld *world = NULL;
  for (uint64_t n = 1; !world && n < 1000; n++) {
    SporeError error = SPORE_ERROR_INIT;
    spore_allocation_fail_at(n);
    world = spore_world_create(&description, NULL, &error);
    spore_allocation_fail_at(0);
    if (!world) g_assert_cmpint(error.code, ==, SPORE_ERROR_MEMORY);
  }
  g_assert_nonnull(world);
  run(world, 3);
  spore_world_free(world);
}

static void test_create_without_memory(void) {
  check_create_without_memory(SPORE_SURFACE_SPHERES);
  check_create_without_memory(SPORE_SURFACE_DEPTH_FIELD);
}

/* A chain in the midst of unmovable spheres: many more contacts than there is room for at first. */
static SporeWorld *crowd(void) {
  enum { CROWD = 100 };
  static double spheres[4 * 8 * CROWD];
  static const SporeSphereSet set = {8 * CROWD, spheres};
  for (int i = 0; i < 8 * CROWD; i++) {
    const double sphere[4] = {0.25 * (i % 8), 0.11 + 1e-4 * (i / 8), 0, 0.03};
    memcpy(spheres + 4 * i, sphere, sizeof sphere);
  }
  SporeBodyDescription bodies[2] = {
      passive_body("soft", chain(8, HUGE_VAL), (SporeVec3){0, 0, 0}),
      {.name = "crowd", .role = SPORE_UNMOVABLE, .pose = spore_pose_identity(), .spheres = &set}};
  bodies[0].spheres = &chain_set;
  bodies[1].contact = bodies[0].contact;
  SporeWorldDescription description = world_description(bodies, 2);
  return create(&description, NULL);
}

/* Each allocation by which room for contacts grows may fail, in several steps one after the other. These steps leave
 * contacts out and count as unsolved; with memory again, the world goes on with all of them. */
static void test_contacts_without_memory(void) {
  SporeWorld *world = crowd();
  uint64_t before = spore_allocation_count();
  spore_world_step(world);
  uint64_t needed = spore_allocation_count() - before;
  size_t all = spore_world_counts(world).contacts;
  g_assert_cmpuint(needed, >, 0);
  g_assert_cmpuint(spore_world_unsolved_count(world), ==, 0);
  spore_world_free(world);
  for (uint64_t n = 1; n <= needed; n++) {
    world = crowd();
    uint64_t failed = 0; /* steps; what has grown in one step need not grow in the next */
    for (int step = 0; step < 3; step++) {
      before = spore_allocation_count();
      spore_allocation_fail_at(n);
      spore_world_step(world);
      spore_allocation_fail_at(0);
      failed += spore_allocation_count() - before >= n;
      g_assert_cmpuint(spore_world_counts(world).contacts < all, ==, failed == (uint64_t)step + 1);
      g_assert_cmpuint(spore_world_unsolved_count(world), ==, 1);
      g_assert_cmpuint(spore_world_unsolved(world, 0).steps, ==, failed);
      g_assert_cmpfloat(spore_world_unsolved(world, 0).worst, >, 0);
    }
    run(world, 3);
    g_assert_cmpuint(spore_world_unsolved(world, 0).steps, ==, failed);
    spore_world_free(world);
  }
}

/* A device that follows a script, and a probe that presses on a body. */
typedef struct ScriptedDevice {
  SporeDevice base;
  int calls;
  double force; /* the last it was told, along y */
} ScriptedDevice;

static bool exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command, SporeDeviceState *state) {
  ScriptedDevice *scripted = (ScriptedDevice *)device;
  scripted->calls++;
  scripted->force = command->force[1];
  *state = (SporeDeviceState){.orientation = {1, 0, 0, 0}};
  state->position[1] = fmax(0.15, 0.3 - time_s);
  if (scripted->calls == 50) state->position[0] = NAN;
  return true;
}

static void test_device(gconstpointer data) {
  static const SporeDeviceType type = {.name = "script", .exchange = exchange};
  ScriptedDevice device = {.base.type = &type};
  static double sphere[4] = {0, 0, 0, 0.1};
  SporeSphereSet set = {1, sphere};
  SporeBodyDescription bodies[2] = {
      passive_body("organ",
                   chain_create((ChainFields){
                       .count = 1, .mass = 0.1, .spacing = 1, .anchor = 200, .damping = 2, .poison_at = HUGE_VAL}),
                   (SporeVec3){0, 0, 0}),
      {.name = "probe", .role = SPORE_ACTIVE, .pose = spore_pose_identity(), .spheres = &set}};
  bodies[0].spheres = &set;
  bodies[1].contact = bodies[0].contact;
  bodies[1].pose.position.y = 0.3;
  SporeWorldDescription description = world_description(bodies, 2);
  description.solver.integrator = GPOINTER_TO_INT(data);
  SporeWorld *world = create(&description, NULL);
  double time_s;
  g_assert_null(spore_world_input(world, 1, &time_s));
  spore_world_set_device(world, 1, &device.base);
  run(world, 2000);
  /* Overlap d + sink s = 0.05, 500 d = 200 s. */
  double sink = 0.05 * 500 / 700;
  g_assert_cmpfloat_with_epsilon(spore_world_q(world, 0)[1], -sink, 1e-4);
  g_assert_cmpfloat_with_epsilon(device.force, 200 * sink, 1e-2);
  g_assert_cmpuint(spore_world_monitor(world)->held_inputs, ==, 1);
  const SporeDeviceState *input = spore_world_input(world, 1, &time_s);
  g_assert_cmpfloat(input->position[1], ==, 0.15);
  g_assert_cmpfloat_with_epsilon(time_s, spore_world_time_s(world), 1e-12);
  spore_world_free(world);
}

/* The probe on a body that nothing moves, where nothing is passive: it feels it all the same. */
static void test_wall(void) {
  static const SporeDeviceType type = {.name = "script", .exchange = exchange};
  ScriptedDevice device = {.base.type = &type};
  static double sphere[4] = {0, 0, 0, 0.1};
  SporeSphereSet set = {1, sphere};
  const SporeContactFields contact = {.stiffness = 200, .damping = 0.5, .friction = 0.3}; /* two in series: 100 N/m */
  SporeBodyDescription bodies[3] = {
      {"probe", SPORE_ACTIVE, .pose = spore_pose_identity(), .spheres = &set, .contact = contact},
      {"wall", SPORE_UNMOVABLE, .pose = spore_pose_identity(), .spheres = &set, .contact = contact},
      {"other probe", SPORE_ACTIVE, .pose = spore_pose_identity(), .spheres = &set, .contact = contact}};
  bodies[0].pose.position.y = bodies[2].pose.position.y = 0.3;
  SporeWorldDescription description = world_description(bodies, 2);
  SporeWorld *world = create(&description, NULL);
  spore_world_set_device(world, 0, &device.base);
  run(world, 50);
  g_assert_cmpfloat(device.force, ==, 0); /* not there yet */
  run(world, 1000);
  g_assert_cmpfloat_with_epsilon(device.force, 100 * 0.05, 1e-9);
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(world);
  g_assert_cmpuint(snapshot->contact_count, ==, 1);
  g_assert_cmpfloat_with_epsilon(snapshot->reaction[1], 5, 1e-9);
  g_assert_cmpfloat_with_epsilon(snapshot->reaction[6 + 1], -5, 1e-9);
  const SporePlan *plan = spore_world_plan(world);
  const char *const in[] = {"device_input", "map", "detect", "respond", "reactions", "feedback"};
  const char *const out[] = {"wake", "link", "islands", "integrate"};
  for (size_t i = 0; i < G_N_ELEMENTS(in); i++) g_assert_true(stage(plan, in[i])->included);
  for (size_t i = 0; i < G_N_ELEMENTS(out); i++) g_assert_false(stage(plan, out[i])->included);
  spore_world_free(world);

  bodies[0].contact.group = bodies[1].contact.group = 1; /* never touch */
  world = create(&description, NULL);
  g_assert_false(stage(spore_world_plan(world), "detect")->included);
  spore_world_free(world);
  bodies[1] = bodies[2]; /* neither gives way to the other, and no wall is there */
  bodies[0].contact.group = 0;
  world = create(&description, NULL);
  g_assert_false(stage(spore_world_plan(world), "detect")->included);
  g_assert_false(stage(spore_world_plan(world), "reactions")->included);
  spore_world_free(world);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  fill_spheres();
  gconstpointer symplectic = GINT_TO_POINTER(SPORE_INTEGRATOR_SYMPLECTIC_EULER);
  gconstpointer implicit = GINT_TO_POINTER(SPORE_INTEGRATOR_IMPLICIT_EULER);
  g_test_add_data_func("/sim/world/threads/symplectic", symplectic, test_threads);
  g_test_add_data_func("/sim/world/threads/implicit", implicit, test_threads);
  g_test_add_data_func("/sim/world/reset/symplectic", symplectic, test_reset);
  g_test_add_data_func("/sim/world/reset/implicit", implicit, test_reset);
  g_test_add_func("/sim/world/contacts-without-memory", test_contacts_without_memory);
  g_test_add_data_func("/sim/world/no-allocation/symplectic", symplectic, test_no_allocation);
  g_test_add_data_func("/sim/world/no-allocation/implicit", implicit, test_no_allocation);
  g_test_add_func("/sim/world/islands-alone", test_islands_alone);
  g_test_add_func("/sim/world/plan", test_plan);
  g_test_add_data_func("/sim/world/freeze/symplectic", symplectic, test_freeze);
  g_test_add_data_func("/sim/world/freeze/implicit", implicit, test_freeze);
  g_test_add_func("/sim/world/speed-limit", test_speed_limit);
  g_test_add_data_func("/sim/world/commands/symplectic", symplectic, test_commands);
  g_test_add_data_func("/sim/world/commands/implicit", implicit, test_commands);
  g_test_add_func("/sim/world/refusals", test_refusals);
  g_test_add_func("/sim/world/create-without-memory", test_create_without_memory);
  g_test_add_data_func("/sim/world/device/symplectic", symplectic, test_device);
  g_test_add_data_func("/sim/world/device/implicit", implicit, test_device);
  g_test_add_func("/sim/world/wall", test_wall);
  return g_test_run();
}
