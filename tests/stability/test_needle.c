/* A needle and its thread through two flaps of tissue: what it pierces when, and that the thread draws them together.
 */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/stability/rig.h"

enum { RIGHT, LEFT, NEEDLE, THREAD };
#define COLUMNS 10
#define ROWS 9
#define SPACING 0.003
#define GAP 0.006
#define RADIUS 0.007
#define HEIGHT 0.002 /* of the circle's middle above the flaps */
#define LENGTH 0.1   /* of the thread */

/* Turns the needle once about the middle of its circle, clockwise; then draws it up. */
typedef struct Hand {
  SporeDevice base;
  double turn_s, draw_s, drawn; /* turning; drawing, and how far, m */
} Hand;

static bool hand_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                          SporeDeviceState *state) {
  const Hand *hand = (const Hand *)device;
  double turned = fmin(time_s / hand->turn_s, 1), drawn = fmin(fmax((time_s - hand->turn_s) / hand->draw_s, 0), 1);
  SporeQuat orientation = spore_quat_from_rotation_vector(spore_vec3(0, 0, -2.05 * G_PI * turned));
  *state = (SporeDeviceState){.position = {0, HEIGHT + hand->drawn * drawn, 0}};
  spore_quat_store(state->orientation, orientation);
  return true;
}
static void hand_close(SporeDevice *device) {}
static const SporeDeviceType hand_type = {.name = "hand", .doc = "", .exchange = hand_exchange, .close = hand_close};

static SporeVec3 on_circle(double degrees) {
  double angle = degrees * G_PI / 180;
  return spore_vec3(RADIUS * cos(angle), HEIGHT + RADIUS * sin(angle), 0);
}

static void add_flap(Rig *rig, const char *name, double x) {
  SporeTriangleMesh sheet;
  shape_sheet(&sheet, COLUMNS, ROWS, SPACING, TRUE);
  SporeBodyDescription *flap = rig_passive(rig, name, rig_surface_model(&spore_mass_spring_net, &sheet, NULL), NULL);
  flap->pose.position = spore_vec3(x, 0, -0.5 * (ROWS - 1) * SPACING);
  flap->pose.orientation = spore_quat_from_rotation_vector(spore_vec3(0.5 * G_PI, 0, 0));
}

/* Two flaps, whose free edges are a wound along z; held at their other three. A needle of half a circle above them. */
static Rig *wound(void) {
  double width = (COLUMNS - 1) * SPACING;
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, 0, 0);
  rig->description.solver.time_step = 1e-3;
  add_flap(rig, "right", 0.5 * GAP);
  add_flap(rig, "left", -0.5 * GAP - width);
  for (int i = 0; i < ROWS; i++) {
    double z = (i - 0.5 * (ROWS - 1)) * SPACING;
    rig_pin(rig, RIGHT, spore_vec3(0.5 * GAP + width, 0, z), 1e-4);
    rig_pin(rig, LEFT, spore_vec3(-0.5 * GAP - width, 0, z), 1e-4);
  }
  for (int i = 0; i < 2 * COLUMNS; i++) {
    double x = (i < COLUMNS ? 1 : -1) * (0.5 * GAP + (i % COLUMNS) * SPACING), z = 0.5 * (ROWS - 1) * SPACING;
    rig_pin(rig, i < COLUMNS ? RIGHT : LEFT, spore_vec3(x, 0, z), 1e-4);
    rig_pin(rig, i < COLUMNS ? RIGHT : LEFT, spore_vec3(x, 0, -z), 1e-4);
  }
  rig_active(rig, "needle", NULL)->pose.position = spore_vec3(0, HEIGHT, 0);
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, 2, NULL));
  SporeVec3 swage = on_circle(190);
  const double points[8] = {swage.x, swage.y, 0, 2e-4, swage.x, swage.y + LENGTH, 0, 2e-4};
  memcpy(curve.points, points, sizeof points);
  rig_passive(rig, "thread",
              rig_curve_model(&spore_spline_1d, &curve, "control_points", 70.0, "young_modulus", 4e8, "bending_scale",
                              1.0, "straight_at_rest", 1.0, NULL),
              NULL);
  SporeToolDescription *tool = rig_tool(rig, &spore_needle, "suture", NEEDLE);
  tool->bodies[SPORE_TOOL_THREAD] = THREAD;
  SporeNeedleFields *fields = rig_tool_fields(tool);
  spore_vec3_store(fields->tip, on_circle(10));
  spore_vec3_store(fields->middle, on_circle(100));
  spore_vec3_store(fields->swage, swage);
  return rig;
}

static SporeToolDescription *tool_of(const Rig *rig) { return &g_array_index(rig->tools, SporeToolDescription, 0); }

static void run_to(SporeWorld *world, double time_s) {
  while (spore_world_time_s(world) < time_s - 1e-9) spore_world_step(world);
}

/* Between the middles of the two edges. */
static double gap(const SporeWorld *world) {
  size_t right = ROWS / 2 * COLUMNS, left = right + COLUMNS - 1;
  return spore_vec3_distance(spore_vec3_load(spore_world_q(world, RIGHT) + 3 * right),
                             spore_vec3_load(spore_world_q(world, LEFT) + 3 * left));
}

static void say(const SporeWorld *world) {
  SporeToolState state = spore_world_tool_state(world, 0);
  g_test_message("%.2f s: %zu pierced, %zu stitches; edges %.2f mm apart; %llu not solved; %s",
                 spore_world_time_s(world), state.pierced, state.stitches, 1e3 * gap(world),
                 (unsigned long long)spore_world_monitor(world)->not_converged, rig_last_message(world));
}

/* It goes through both flaps and draws the thread after it; the knot holds at the first, and the edges come together.
 */
static void test_suture(void) {
  Hand hand = {.base = {&hand_type}, .turn_s = 1, .draw_s = 1.15, .drawn = 0.115};
  Rig *rig = wound();
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, NEEDLE, &hand.base);
  g_assert_cmpfloat_with_epsilon(gap(world), GAP, 1e-9);
  run_to(world, 0.3);
  say(world);
  g_assert_cmpuint(spore_world_tool_state(world, 0).pierced, ==, 1);
  g_assert_true(rig_said(world, "suture: pierced right"));
  uint64_t before = spore_allocation_count();
  run_to(world, 1);
  say(world);
  g_assert_cmpuint(spore_world_tool_state(world, 0).pierced, ==, 2);
  g_assert_cmpuint(spore_world_tool_state(world, 0).stitches, ==, 2);
  g_assert_true(rig_said(world, "suture: pierced left"));
  run_to(world, 2.3);
  say(world);
  g_assert_cmpuint(spore_allocation_count(), ==, before);
  g_assert_cmpuint(spore_world_tool_state(world, 0).stitches, ==, 2);
  g_assert_cmpfloat(gap(world), <, 0.6 * GAP);
  g_assert_false(rig_any_frozen(world));
  rig_free(rig);
}

/* What it does with the first flap within `time_s`, by how the needle is. */
static SporeToolState first_flap(SporeNeedleFields change, bool thread, double time_s, double *when_s) {
  Hand hand = {.base = {&hand_type}, .turn_s = 1, .draw_s = 1, .drawn = 0};
  Rig *rig = wound();
  SporeToolDescription *tool = tool_of(rig);
  SporeNeedleFields *fields = rig_tool_fields(tool);
  if (change.force > 0) fields->force = change.force;
  if (change.depth > 0) fields->depth = change.depth;
  fields->strength = change.strength;
  if (!thread) tool->bodies[SPORE_TOOL_THREAD] = SPORE_NO_BODY;
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, NEEDLE, &hand.base);
  *when_s = 0;
  while (spore_world_time_s(world) < time_s) {
    spore_world_step(world);
    if (*when_s == 0 && spore_world_tool_state(world, 0).pierced > 0) *when_s = spore_world_time_s(world);
  }
  SporeToolState state = spore_world_tool_state(world, 0);
  state.name = NULL;
  rig_free(rig);
  return state;
}

/* It pierces by force, or by depth, whichever comes first; the blunter, the later. */
static void test_threshold(void) {
  double sharp, blunt, deep, when;
  first_flap((SporeNeedleFields){.force = 0.02, .depth = 1}, true, 0.5, &sharp);
  first_flap((SporeNeedleFields){.force = 0.1, .depth = 1}, true, 0.5, &blunt);
  first_flap((SporeNeedleFields){.force = 100, .depth = 0.002}, true, 0.5, &deep);
  g_test_message("pierced at %.3f s by 0.02 N, %.3f s by 0.1 N, %.3f s by 2 mm", sharp, blunt, deep);
  g_assert_cmpfloat(sharp, >, 0.05);
  g_assert_cmpfloat(blunt, >, sharp);
  /* The tip meets the flap where the circle does, and goes on at 2.05 pi R a second. */
  double meets = (10 + asin(HEIGHT / RADIUS) * 180 / G_PI) / 369, speed = 2.05 * G_PI * RADIUS;
  g_assert_cmpfloat(deep, >, meets + 0.002 / speed - 0.002);
  g_assert_cmpfloat(deep, <, meets + 0.002 / speed + 0.02);
  SporeToolState state = first_flap((SporeNeedleFields){.force = 100, .depth = 1}, true, 0.5, &when);
  g_assert_cmpuint(state.pierced, ==, 0);
}

/* Without a thread it comes out behind; a stitch that can hold next to nothing tears out. */
static void test_comes_off(void) {
  double when;
  SporeToolState bare = first_flap((SporeNeedleFields){0}, false, 1, &when);
  g_test_message("without a thread: %zu pierced, %zu held", bare.pierced, bare.stitches);
  g_assert_cmpuint(bare.pierced, ==, 2);
  g_assert_cmpuint(bare.stitches, <, 2);
  SporeToolState weak = first_flap((SporeNeedleFields){.strength = 1e-6}, true, 0.4, &when);
  g_assert_cmpuint(weak.pierced, >, 0);
  g_assert_cmpuint(weak.stitches, ==, 0);
}

/* The same again after a reset, bit for bit. */
static void test_repeats(void) {
  Hand hand = {.base = {&hand_type}, .turn_s = 1, .draw_s = 1, .drawn = 0.1};
  Rig *rig = wound();
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, NEEDLE, &hand.base);
  run_to(world, 0.7);
  uint64_t hash = spore_world_hash(world);
  spore_world_reset(world);
  g_assert_cmpuint(spore_world_tool_state(world, 0).pierced, ==, 0);
  g_assert_cmpuint(spore_world_tool_state(world, 0).stitches, ==, 0);
  run_to(world, 0.7);
  g_assert_cmpuint(spore_world_hash(world), ==, hash);
  rig_free(rig);
}

static void test_refused(void) {
  static const char *const words[] = {"not active", "is no thread", "at the needle's swage", "along an arc"};
  for (int fault = 0; fault < 4; fault++) {
    Rig *rig = wound();
    SporeToolDescription *tool = tool_of(rig);
    SporeNeedleFields *fields = rig_tool_fields(tool);
    if (fault == 0) tool->bodies[0] = LEFT;
    if (fault == 1) tool->bodies[SPORE_TOOL_THREAD] = RIGHT;
    if (fault == 2) spore_vec3_store(fields->swage, on_circle(160));
    if (fault == 3) memcpy(fields->middle, fields->tip, sizeof fields->middle);
    SporeError error = SPORE_ERROR_INIT;
    g_assert_null(rig_try_build(rig, &error));
    g_test_message("%s: %s", error.place, error.message);
    g_assert_cmpstr(error.place, ==, "tools/suture");
    g_assert_nonnull(strstr(error.message, words[fault]));
    rig_free(rig);
  }
}

/* A ball of tetrahedra is pierced where the needle goes in, and where it comes out. */
static void test_solid(void) {
  Hand hand = {.base = {&hand_type}, .turn_s = 1, .draw_s = 1, .drawn = 0};
  Rig *rig = wound();
  SporeTetrahedralMesh block;
  shape_block(&block, 6, 3, 3, spore_vec3(0.008, 0.004, 0.006));
  SporeBodyDescription *body = &g_array_index(rig->bodies, SporeBodyDescription, RIGHT);
  body->model->type->destroy(body->model);
  body->model = rig_tetrahedra_model(&block, "young_modulus", 20000.0, NULL);
  body->pose = (SporePose){{-0.004, HEIGHT - RADIUS - 0.002, -0.003}, {1, 0, 0, 0}}; /* below, where it goes level */
  g_array_set_size(rig->links, 0);
  rig_pin(rig, RIGHT, spore_vec3(0, HEIGHT - RADIUS - 0.002, 0), 0.005);
  ((SporeNeedleFields *)rig_tool_fields(tool_of(rig)))->depth = 0.001;
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, NEEDLE, &hand.base);
  run_to(world, 0.4);
  say(world);
  g_assert_cmpuint(spore_world_tool_state(world, 0).pierced, ==, 2);
  g_assert_true(rig_finite(world));
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/needle/suture", test_suture);
  g_test_add_func("/needle/threshold", test_threshold);
  g_test_add_func("/needle/comes-off", test_comes_off);
  g_test_add_func("/needle/repeats", test_repeats);
  g_test_add_func("/needle/refused", test_refused);
  g_test_add_func("/needle/solid", test_solid);
  return g_test_run();
}
