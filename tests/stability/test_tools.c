/* Instruments: jaws that take hold of tissue, lift it, let it go, or lose it. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/stability/rig.h"

#define JAW_SPHERES 6
enum { TISSUE, SHAFT, JAW_A, JAW_B, FLOOR };

/* Opens above, goes down by 30 mm from 0.25 s to 0.55 s, closes at 0.6 s, lifts by as much from 1 s to 1.5 s, and opens
 * again at `open_s`. */
typedef struct Hand {
  SporeDevice base;
  double open_s;
  uint32_t buttons; /* after 2.5 s */
  double ahead_s;   /* of the world's time */
} Hand;

static bool hand_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                          SporeDeviceState *state) {
  const Hand *hand = (const Hand *)device;
  time_s += hand->ahead_s;
  double down = fmin(fmax((time_s - 0.25) / 0.3, 0), 1), up = fmin(fmax((time_s - 1) / 0.5, 0), 1);
  *state = (SporeDeviceState){.position = {0, 0.06 + 0.03 * (up - down), 0}, .orientation = {1, 0, 0, 0}};
  state->grip_rad = time_s < 0.6 || time_s > hand->open_s ? 1 : 0;
  state->buttons = time_s > 2.5 ? hand->buttons : 0;
  return true;
}
static void hand_close(SporeDevice *device) {}
static const SporeDeviceType hand_type = {.name = "hand", .doc = "", .exchange = hand_exchange, .close = hand_close};

/* A block of tissue of 10 x 20 x 10 mm on the floor, and jaws that reach down on both sides of it. */
static Rig *scene(const SporeToolType *type, double strength, SporePool *pool) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = 0.004;
  SporeTetrahedralMesh block;
  shape_block(&block, 2, 4, 2, spore_vec3(0.01, 0.02, 0.01));
  const SporeSphereSet *spheres = rig_spheres(rig, block.vertices, block.vertex_count, 0.002);
  SporeBodyDescription *tissue = rig_passive(
      rig, "tissue", rig_tetrahedra_model(&block, "young_modulus", 20000.0, "stiffness_damping", 0.01, NULL), spheres);
  tissue->pose.position = spore_vec3(-0.005, 0.002, -0.005);
  tissue->contact.friction = 0.2;
  double points[3 * JAW_SPHERES];
  for (int i = 0; i < JAW_SPHERES; i++) memcpy(points + 3 * i, (double[3]){0, -0.004 * (i + 1), 0}, 3 * sizeof *points);
  rig_active(rig, "shaft", NULL)->pose.position = spore_vec3(0, 0.06, 0);
  const SporeSphereSet *jaw = rig_spheres(rig, points, JAW_SPHERES, 0.002);
  rig_active(rig, "left", jaw)->pose.position = spore_vec3(0.002, 0.06, 0);
  rig_active(rig, "right", jaw)->pose.position = spore_vec3(-0.002, 0.06, 0);
  rig_unmovable(rig, "floor", rig_floor(rig, 8, 8, 0.004, 0.004));
  SporeToolDescription *tool = rig_tool(rig, type, "grasper", SHAFT);
  tool->bodies[SPORE_TOOL_JAW_A] = JAW_A;
  tool->bodies[SPORE_TOOL_JAW_B] = JAW_B;
  SporeJawFields *fields = rig_tool_fields(tool);
  spore_vec3_store(fields->hinge, spore_vec3(0, 0.06, 0));
  spore_vec3_store(fields->axis, spore_vec3(0, 0, 1));
  fields->strength = strength;
  fields->torque = 0.004;
  return rig;
}

static double height(const SporeWorld *world) {
  const double *q = spore_world_q(world, TISSUE);
  size_t count = spore_world_body_model(world, TISSUE)->node_count;
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += q[3 * i + 1];
  return sum / (double)count;
}

static void run_to(SporeWorld *world, double time_s) {
  while (spore_world_time_s(world) < time_s - 1e-9) spore_world_step(world);
  g_assert_true(rig_finite(world));
}

static void say(const SporeWorld *world, const char *when) {
  SporeToolState state = spore_world_tool_state(world, 0);
  g_test_message("%s, %.2f s: open by %.3f rad, %.4f N m, %zu held, %zu lost, tissue at %.1f mm; %s", when,
                 spore_world_time_s(world), state.opening, state.squeeze, state.held, state.lost, 1e3 * height(world),
                 rig_last_message(world));
}

static void test_grasper(void) {
  Hand hand = {.base = {&hand_type}, .open_s = 1.8};
  Rig *rig = scene(&spore_grasper, 2, NULL);
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, SHAFT, &hand.base);
  run_to(world, 0.5);
  say(world, "open");
  double low = height(world);
  g_assert_cmpfloat_with_epsilon(spore_world_tool_state(world, 0).opening, 1, 1e-9);
  SporeVec3 tip = spore_world_tool_tip(world, 0); /* as if the jaws were closed, and of the shaft as it stands */
  SporeVec3 hinge = spore_vec3_load(spore_world_q(world, SHAFT));
  g_assert_cmpfloat(spore_vec3_distance(tip, spore_vec3_sub(hinge, spore_vec3(0, 0.004 * JAW_SPHERES, 0))), <, 1e-9);
  run_to(world, 0.95);
  say(world, "closed");
  g_assert_cmpuint(spore_world_tool_state(world, 0).held, >, 0);
  g_assert_cmpfloat(spore_world_tool_state(world, 0).squeeze, <, 0.0044); /* of 0.004 N m at most */
  uint64_t before = spore_allocation_count();
  run_to(world, 1.7);
  say(world, "lifted");
  g_assert_cmpuint(spore_allocation_count(), ==, before);
  g_assert_cmpfloat(height(world), >, low + 0.027);
  g_assert_cmpuint(spore_world_monitor(world)->lost_holds, ==, 0);
  run_to(world, 3);
  say(world, "let go");
  g_assert_cmpuint(spore_world_tool_state(world, 0).held, ==, 0);
  g_assert_cmpfloat(height(world), <, low + 0.003);
  spore_world_reset(world);
  g_assert_cmpfloat(spore_world_tool_state(world, 0).opening, ==, 0);
  rig_free(rig);
}

#define TAKEN_S 0.4 /* the jaws are open, on their way down, and touch nothing */

/* A world of the scene whose hand is ahead by TAKEN_S. */
static Rig *build_ahead(Hand *hand) {
  *hand = (Hand){.base = {&hand_type}, .open_s = 1.8, .ahead_s = TAKEN_S};
  Rig *rig = scene(&spore_grasper, 2, NULL);
  spore_world_set_device(rig_build(rig), SHAFT, &hand->base);
  return rig;
}

/* A state that is taken over to another world goes on there: the tool is where it was, as far open as it was, and its
 * device did not jump. The device of a world that was given no state does. */
static void test_taken_over(void) {
  Hand hand = {.base = {&hand_type}, .open_s = 1.8}, ahead, jumping;
  Rig *rig = scene(&spore_grasper, 2, NULL), *other = build_ahead(&ahead), *bare = build_ahead(&jumping);
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, SHAFT, &hand.base);
  run_to(world, TAKEN_S);
  for (uint32_t body = 0; body <= FLOOR; body++)
    spore_world_set_state(other->world, body, spore_world_q(world, body), spore_world_v(world, body));
  g_assert_cmpfloat_with_epsilon(spore_world_tool_state(other->world, 0).opening, 1, 1e-9);
  for (int i = 0; i < 20; i++) {
    spore_world_step(world);
    spore_world_step(other->world);
    spore_world_step(bare->world);
    for (uint32_t body = SHAFT; body <= JAW_B; body++)
      for (int k = 0; k < 7; k++)
        g_assert_cmpfloat_with_epsilon(spore_world_q(other->world, body)[k], spore_world_q(world, body)[k], 1e-12);
  }
  g_assert_cmpfloat_with_epsilon(height(other->world), height(world), 1e-5); /* friction on the floor begins anew */
  g_assert_cmpuint(spore_world_monitor(other->world)->held_inputs, ==, 0);
  g_assert_cmpfloat(spore_world_tool_state(bare->world, 0).opening, <, 0.9);
  rig_free(rig);
  rig_free(other);
  rig_free(bare);
}

/* What can hold next to nothing loses it when it lifts. */
static void test_loses(void) {
  Hand hand = {.base = {&hand_type}, .open_s = 9};
  Rig *rig = scene(&spore_grasper, 1e-4, NULL);
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, SHAFT, &hand.base);
  run_to(world, 1.7);
  say(world, "lifted");
  g_assert_cmpuint(spore_world_monitor(world)->lost_holds, >, 0);
  g_assert_true(rig_said(world, "grasper: tissue tore away"));
  rig_free(rig);
}

/* A clamp stays closed though the hand opens, until its second button. */
static void test_clamp(void) {
  Hand hand = {.base = {&hand_type}, .open_s = 1.4, .buttons = 2};
  Rig *rig = scene(&spore_clamp, 2, NULL);
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, SHAFT, &hand.base);
  run_to(world, 0.5);
  double low = height(world);
  run_to(world, 2.4);
  say(world, "clamped");
  g_assert_cmpuint(spore_world_tool_state(world, 0).held, >, 0);
  g_assert_cmpfloat(height(world), >, low + 0.027);
  run_to(world, 2.9);
  say(world, "opened");
  g_assert_cmpuint(spore_world_tool_state(world, 0).held, ==, 0);
  rig_free(rig);
}

/* The same input gives the same bits, by any number of threads. */
static void test_repeats(void) {
  uint64_t hashes[2];
  for (int threads = 1; threads <= 2; threads++) {
    Hand hand = {.base = {&hand_type}, .open_s = 1.8};
    Rig *rig = scene(&spore_grasper, 2, NULL);
    SporePool *pool = threads > 1 ? spore_pool_create(threads) : NULL;
    rig_build_on(rig, pool);
    spore_world_set_device(rig->world, SHAFT, &hand.base);
    run_to(rig->world, 1.2);
    hashes[threads - 1] = spore_world_hash(rig->world);
    rig_free(rig);
    if (pool) spore_pool_free(pool);
  }
  g_assert_cmpuint(hashes[0], ==, hashes[1]);
}

static void test_refused(void) {
  for (int fault = 0; fault < 3; fault++) {
    Rig *rig = scene(&spore_grasper, 2, NULL);
    SporeToolDescription *tool = &g_array_index(rig->tools, SporeToolDescription, 0);
    if (fault == 0) tool->bodies[0] = TISSUE;
    if (fault == 1) tool->bodies[SPORE_TOOL_JAW_B] = JAW_A;
    if (fault == 2) spore_vec3_store(((SporeJawFields *)rig_tool_fields(tool))->axis, spore_vec3(0, 0, 0));
    SporeError error = SPORE_ERROR_INIT;
    g_assert_null(rig_try_build(rig, &error));
    g_assert_cmpstr(error.place, ==, "tools/grasper");
    rig_free(rig);
  }
}

#define COLUMNS 8

/* Opens, and closes each third of a second while it goes along the net. */
static bool cutter_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                            SporeDeviceState *state) {
  double cycle = fmod(time_s, 0.3);
  *state = (SporeDeviceState){.position = {0.035, -0.01 + 0.02 * floor(time_s / 0.3), 0}, .orientation = {1, 0, 0, 0}};
  state->grip_rad = cycle < 0.15 ? 1 : 0;
  return true;
}
static const SporeDeviceType cutter_type = {
    .name = "cutter", .doc = "", .exchange = cutter_exchange, .close = hand_close};

/* A net that is held at its left edge, with spheres between its nodes, and a tool on a shaft before it. */
static Rig *net_and_tool(const SporeToolType *type) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, 0, 0);
  rig->description.solver.time_step = 0.004;
  SporeTriangleMesh sheet;
  shape_sheet(&sheet, COLUMNS, COLUMNS, 0.01, TRUE);
  double points[3 * (COLUMNS - 1)];
  for (int i = 0; i + 1 < COLUMNS; i++)
    memcpy(points + 3 * i, (double[3]){0.01 * i + 0.006, 0.032, 0}, 3 * sizeof *points);
  rig_passive(rig, "net", rig_surface_model(&spore_mass_spring_net, &sheet, NULL),
              rig_spheres(rig, points, COLUMNS - 1, 0.002));
  for (int i = 0; i < COLUMNS; i++) rig_pin(rig, 0, spore_vec3(0, 0.01 * i, 0), 1e-4);
  rig_active(rig, "shaft", NULL)->pose.position = spore_vec3(0.035, -0.01, 0);
  rig_unmovable(rig, "far", rig_sphere(rig, 0.01))->pose.position = spore_vec3(1, 1, 1); /* something to touch */
  rig_tool(rig, type, "tool", 1);
  return rig;
}

/* Cut through, one half hangs on, and the other falls freely, with its spheres; whole again after a reset. */
static void test_scissors(void) {
  Rig *rig = net_and_tool(&spore_scissors);
  SporeJawFields *fields = rig_tool_fields(&g_array_index(rig->tools, SporeToolDescription, 0));
  spore_vec3_store(fields->hinge, spore_vec3(0.035, -0.01, 0));
  spore_vec3_store(fields->axis, spore_vec3(1, 0, 0));
  spore_vec3_store(fields->tip, spore_vec3(0.035, 0.025, 0));
  fields->speed = 20;
  SporeDevice cutter = {&cutter_type};
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 1, &cutter);
  run_to(world, 0.1);
  g_assert_cmpuint(spore_world_tool_state(world, 0).cut, ==, 0); /* opening cuts nothing */
  run_to(world, 0.3);
  size_t first = spore_world_tool_state(world, 0).cut;
  g_assert_cmpuint(first, >, 0);
  uint64_t before = spore_allocation_count();
  run_to(world, 1.4);
  g_assert_cmpuint(spore_allocation_count(), ==, before);
  const SporeCuts *cuts = &spore_world_snapshot_acquire(world)->cuts;
  g_assert_cmpuint(cuts->count, >=, COLUMNS); /* an edge of each row, and the diagonals between them */
  for (size_t i = 0; i < cuts->count; i++) {
    bool left = cuts->edges[i].a % COLUMNS < COLUMNS / 2, other = cuts->edges[i].b % COLUMNS < COLUMNS / 2;
    g_assert_true(left != other);
  }
  size_t cut = spore_world_tool_state(world, 0).cut;
  const SporeCommand gravity = {.kind = SPORE_COMMAND_GRAVITY, .vector = {0, 0, -9.81}};
  spore_world_post(world, &gravity);
  run_to(world, 2.4);
  const double *q = spore_world_q(world, 0), *v = spore_world_v(world, 0);
  double held = 0, fallen = -HUGE_VAL, apart = 0;
  for (int i = 0; i < COLUMNS * COLUMNS; i++) {
    bool left = i % COLUMNS < COLUMNS / 2;
    if (left) held = fmin(held, q[3 * i + 2]);
    else fallen = fmax(fallen, q[3 * i + 2]);
    if (!left) apart = fmax(apart, fabs(v[3 * i + 2] - v[3 * (COLUMNS - 1) + 2]));
  }
  const SporeSpheres *spheres = spore_world_spheres(world);
  double middle = spheres->centre[3 * (COLUMNS / 2) + 2]; /* behind the one of what stands still */
  g_test_message("%zu springs by the first cut, %zu in all; one half hangs at %.3f m, the other fell to %.2f m (its "
                 "speeds differ by %.2f m/s), the sphere between them to %.2f m; %s",
                 first, cut, held, fallen, apart, middle, rig_last_message(world));
  g_assert_cmpfloat(held, >, -0.2);
  g_assert_cmpfloat(fallen, <, -2);
  g_assert_cmpfloat(middle, <, -2); /* with the nodes that it lay nearest to */
  uint64_t hash = spore_world_hash(world);
  const SporeCommand none = {.kind = SPORE_COMMAND_GRAVITY};
  spore_world_reset(world);
  g_assert_cmpuint(spore_world_snapshot_acquire(world)->cuts.count, ==, 0);
  spore_world_post(world, &none);
  run_to(world, 1.4);
  g_assert_cmpuint(spore_world_tool_state(world, 0).cut, ==, cut);
  spore_world_post(world, &gravity);
  run_to(world, 2.4);
  g_assert_cmpuint(spore_world_hash(world), ==, hash);
  rig_free(rig);
}

static bool pedal_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                           SporeDeviceState *state) {
  *state = (SporeDeviceState){.position = {0.035, -0.01, 0}, .orientation = {1, 0, 0, 0}, .buttons = time_s > 0.1};
  return true;
}
static const SporeDeviceType pedal_type = {.name = "pedal", .doc = "", .exchange = pedal_exchange, .close = hand_close};

static double apart(const SporeWorld *world, int a, int b) {
  const double *q = spore_world_q(world, 0);
  return spore_vec3_distance(spore_vec3_load(q + 3 * a), spore_vec3_load(q + 3 * b));
}

/* A net shrinks where it is coagulated, to what is left of it and no more; elsewhere it keeps its length. */
static void test_bipolar(void) {
  Rig *rig = net_and_tool(&spore_bipolar);
  SporeBipolarFields *fields = rig_tool_fields(&g_array_index(rig->tools, SporeToolDescription, 0));
  spore_vec3_store(fields->point, spore_vec3(0.04, 0.03, 0));
  fields->radius = 0.015, fields->rate = 2, fields->least = 0.6, fields->stiffening = 3;
  SporeDevice pedal = {&pedal_type};
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 1, &pedal);
  int middle = 3 * COLUMNS + 4, corner = COLUMNS * COLUMNS - 1;
  run_to(world, 0.1);
  g_assert_cmpfloat_with_epsilon(apart(world, middle, middle + 1), 0.01, 1e-9);
  run_to(world, 0.2);
  g_assert_cmpuint(spore_world_tool_state(world, 0).coagulated, >, 0);
  run_to(world, 2);
  double near = apart(world, middle, middle + 1), far = apart(world, corner, corner - 1);
  g_test_message("10 mm between neighbours became %.2f mm at the forceps, %.2f mm far from them; %zu still change; %s",
                 1e3 * near, 1e3 * far, spore_world_tool_state(world, 0).coagulated, rig_last_message(world));
  g_assert_cmpuint(spore_world_tool_state(world, 0).coagulated, ==, 0); /* as short as they get */
  g_assert_cmpfloat(near, <, 0.0085);
  g_assert_cmpfloat(far, >, 0.0095);
  spore_world_reset(world);
  run_to(world, 0.1);
  g_assert_cmpfloat_with_epsilon(apart(world, middle, middle + 1), 0.01, 1e-9);
  rig_free(rig);
}

/* Height of the tissue's highest node. */
static double top(const SporeWorld *world) {
  double highest = -HUGE_VAL;
  for (size_t i = 0; i < spore_world_body_model(world, TISSUE)->node_count; i++)
    highest = fmax(highest, spore_world_q(world, TISSUE)[3 * i + 1]);
  return highest;
}

/* A clamp stops at tissue that is an effect, takes it along, and gives it back to its shape; beside it, it shuts. */
static void test_effect_is_clamped(void) {
  for (int beside = 0; beside < 2; beside++) {
    Hand hand = {.base = {&hand_type}, .open_s = 9, .buttons = 2};
    Rig *rig = scene(&spore_clamp, 2, NULL);
    SporeBodyDescription *tissue = &g_array_index(rig->bodies, SporeBodyDescription, TISSUE);
    tissue->effect = true;
    if (beside) tissue->pose.position.z += 0.1;
    SporeWorld *world = rig_build(rig);
    spore_world_set_device(world, SHAFT, &hand.base);
    double rest = top(world);
    run_to(world, 0.95);
    say(world, "closed");
    g_assert_cmpint(spore_world_tool_holds(world, 0, TISSUE) > 0, ==, !beside);
    g_assert_cmpint(spore_world_tool_state(world, 0).opening > 0.01, ==, !beside);
    uint64_t before = spore_allocation_count();
    run_to(world, 1.7);
    say(world, "lifted");
    g_assert_cmpuint(spore_allocation_count(), ==, before);
    g_test_message("its top rose by %.1f mm", 1e3 * (top(world) - rest));
    g_assert_cmpint(top(world) > rest + 0.02, ==, !beside);
    g_assert_cmpuint(spore_world_monitor(world)->lost_holds, ==, 0);
    run_to(world, 6);
    g_assert_cmpuint(spore_world_tool_holds(world, 0, TISSUE), ==, 0);
    g_assert_cmpfloat_with_epsilon(top(world), rest, 1e-9);
    rig_free(rig);
  }
}

/* Far above the tissue. */
static bool away_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                          SporeDeviceState *state) {
  *state = (SporeDeviceState){.position = {0, 0.2, 0}, .orientation = {1, 0, 0, 0}, .grip_rad = 1};
  return true;
}
static const SporeDeviceType away_type = {.name = "away", .doc = "", .exchange = away_exchange, .close = hand_close};

static Rig *clip_scene(SporeDevice *device, bool effect) {
  Rig *rig = scene(&spore_clamp, 2, NULL);
  g_array_index(rig->tools, SporeToolDescription, 0).effect = effect;
  spore_world_set_device(rig_build(rig), SHAFT, device);
  return rig;
}

static double shaft_height(const SporeWorld *world) { return spore_world_q(world, SHAFT)[1]; }

/* How far apart two points across the jaws are drawn that are `wide` apart, at a height above the jaws' tips. */
static double drawn_width(SporeWorld *world, double wide, double above) {
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(world);
  double y = shaft_height(world) - 0.024 + above, points[6] = {-0.5 * wide, y, 0, 0.5 * wide, y, 0};
  spore_squeeze_points(snapshot->squeezes, snapshot->squeeze_count, TISSUE, points, 2);
  return spore_vec3_distance(spore_vec3_load(points), spore_vec3_load(points + 3));
}

/* A clamp that is an effect closes on tissue, stays on it and not at its device, and lets go; the tissue is to the bit
 * what it is where no clamp comes near. Between the jaws it is drawn thinner, elsewhere as it is. */
static void test_clip(void) {
  Hand hand = {.base = {&hand_type}, .open_s = 9, .buttons = 2};
  SporeDevice away = {&away_type};
  Rig *rig = clip_scene(&hand.base, true), *bare = clip_scene(&away, false);
  SporeWorld *world = rig->world;
  run_to(world, 0.5);
  g_assert_cmpuint(spore_world_snapshot_acquire(world)->squeeze_count, ==, 0);
  double low = shaft_height(world);
  uint64_t before = spore_allocation_count();
  run_to(world, 1.7);
  g_assert_cmpuint(spore_allocation_count(), ==, before);
  say(world, "put on");
  run_to(bare->world, 1.7);
  g_assert_true(spore_world_tool_is_effect(world, 0));
  g_assert_cmpuint(spore_world_tool_holds(world, 0, TISSUE), >, 0);
  g_assert_cmpfloat(shaft_height(world), <, low + 0.005); /* and its device has gone 30 mm up */
  g_assert_cmphex(spore_world_body_hash(world, TISSUE), ==, spore_world_body_hash(bare->world, TISSUE));
  double squeezed = drawn_width(world, 0.01, 0.004), beyond = drawn_width(world, 0.01, 0.1);
  g_test_message("10 mm of tissue are drawn %.2f mm wide between the jaws, %.2f mm beside", 1e3 * squeezed,
                 1e3 * beyond);
  g_assert_cmpfloat(squeezed, <, 0.005);
  g_assert_cmpfloat(beyond, ==, 0.01);
  for (double wide = 0.001; wide < 0.1; wide += 0.001)
    g_assert_cmpfloat(drawn_width(world, wide, 0.004), <, drawn_width(world, wide + 0.001, 0.004));
  run_to(world, 6);
  run_to(bare->world, 6);
  say(world, "taken off");
  g_assert_cmpuint(spore_world_tool_holds(world, 0, TISSUE), ==, 0);
  g_assert_cmpuint(spore_world_snapshot_acquire(world)->squeeze_count, ==, 0);
  g_assert_cmpfloat_with_epsilon(shaft_height(world), 0.06, 1e-9); /* back at its device */
  g_assert_cmphex(spore_world_body_hash(world, TISSUE), ==, spore_world_body_hash(bare->world, TISSUE));
  rig_free(rig);
  rig_free(bare);
}

static void post_clip(SporeWorld *world, bool effect) {
  const SporeCommand command = {.kind = SPORE_COMMAND_TOOL_EFFECT, .number = 0, .effect = effect};
  g_assert_true(spore_world_post(world, &command));
}

/* What the clamp holds it keeps when it becomes an effect, and when it becomes physical again: then it lifts the tissue
 * to where its device is. A reset brings the form of time 0. */
static void test_clip_switched(void) {
  Hand hand = {.base = {&hand_type}, .open_s = 9, .buttons = 2};
  Rig *rig = clip_scene(&hand.base, false);
  SporeWorld *world = rig->world;
  run_to(world, 0.95);
  double low = height(world);
  size_t held = spore_world_tool_holds(world, 0, TISSUE);
  g_assert_cmpuint(held, >, 0);
  post_clip(world, true);
  run_to(world, 1.7);
  say(world, "effect");
  g_assert_cmpuint(spore_world_tool_holds(world, 0, TISSUE), ==, held);
  g_assert_cmpfloat(height(world), <, low + 0.002);
  post_clip(world, false);
  run_to(world, 2.4);
  say(world, "physical");
  g_assert_cmpuint(spore_world_tool_holds(world, 0, TISSUE), >, 0);
  g_assert_cmpfloat(height(world), >, low + 0.025);
  for (int i = 0; i < 40; i++) { /* to and fro: nothing is thrown */
    post_clip(world, i % 2 == 0);
    run_to(world, 2.4 + 0.002 * (i + 1));
  }
  const double *v = spore_world_v(world, TISSUE);
  for (size_t i = 0; i < spore_world_body_model(world, TISSUE)->node_count; i++)
    g_assert_cmpfloat(spore_vec3_length(spore_vec3_load(v + 3 * i)), <, 0.5);
  spore_world_reset(world);
  g_assert_false(spore_world_tool_is_effect(world, 0));
  g_assert_cmpuint(spore_world_tool_holds(world, 0, TISSUE), ==, 0);
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/tools/grasper", test_grasper);
  g_test_add_func("/tools/taken_over", test_taken_over);
  g_test_add_func("/tools/loses", test_loses);
  g_test_add_func("/tools/clamp", test_clamp);
  g_test_add_func("/tools/repeats", test_repeats);
  g_test_add_func("/tools/refused", test_refused);
  g_test_add_func("/tools/scissors", test_scissors);
  g_test_add_func("/tools/bipolar", test_bipolar);
  g_test_add_func("/tools/effect_is_clamped", test_effect_is_clamped);
  g_test_add_func("/tools/clip", test_clip);
  g_test_add_func("/tools/clip_switched", test_clip_switched);
  return g_test_run();
}
