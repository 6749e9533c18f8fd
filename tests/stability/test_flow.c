/* Particles that leave the world by suction and come into it from a wound. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/stability/rig.h"

#define PARTICLES 200
#define DRAG 5.0 /* 1/s */

/* A drop of blood, weightless, about the origin; `tools` and `emitters` may be 0. */
static Rig *drop(size_t tools, size_t emitters, int64_t reserve, double rate) {
  static SporeEmitterDescription wound;
  Rig *rig = rig_new();
  rig->description.solver.time_step = 5e-4;
  rig->description.gravity = spore_vec3(0, 0, 0);
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.01, 0.01, 0.01));
  rig_passive(rig, "blood", rig_fluid_model(&box, PARTICLES, "drag", DRAG, NULL), NULL);
  rig_active(rig, "sucker", rig_sphere(rig, 0.0005))->pose.position = spore_vec3(0, 0.02, 0);
  if (tools > 0) {
    SporeSuctionFields *fields = rig_tool_fields(rig_tool(rig, &spore_suction, "suction", 1));
    fields->rate = rate;
    fields->radius = 0.004;
  }
  wound = (SporeEmitterDescription){
      .name = "wound", .body = 0, .source = SPORE_NO_BODY, .point = {0.02, 0, 0}, .direction = {0, 1, 0}};
  spore_parameters_set_initial(&spore_emitter_parameters, &wound.fields);
  wound.fields.rate = rate;
  wound.fields.reserve = reserve;
  wound.fields.start = 0.1;
  rig->description.emitters = &wound;
  rig->description.emitter_count = emitters;
  return rig;
}

static size_t particles(const SporeWorld *world) { return spore_world_particle_count(world, 0); }

/* Fastest of the particles, m/s. */
static double fastest(const SporeWorld *world) {
  const double *v = spore_world_v(world, 0);
  double most = 0;
  for (size_t i = 0; i < spore_world_body_model(world, 0)->node_count; i++)
    most = fmax(most, spore_vec3_length(spore_vec3_load(v + 3 * i)));
  return most;
}

static void run_to(SporeWorld *world, double time_s) {
  while (spore_world_time_s(world) < time_s - 1e-9) spore_world_step(world);
  g_assert_true(rig_finite(world));
  g_assert_false(rig_any_frozen(world));
}

/* It takes as many as it can in a second, of those that are in its mouth, and the rest stays a drop. */
static void test_suction(void) {
  Rig *rig = drop(1, 0, 0, 100);
  SporeWorld *world = rig_build(rig);
  size_t start = particles(world);
  g_assert_cmpuint(start, ==, spore_world_body_model(world, 0)->node_count);
  run_to(world, 0.5);
  size_t taken = spore_world_tool_state(world, 0).taken;
  g_test_message("%zu of %zu particles taken in 0.5 s at 100 a second; fastest %.3f m/s; %s", taken, start,
                 fastest(world), rig_last_message(world));
  g_assert_cmpuint(taken, >=, 49);
  g_assert_cmpuint(taken, <=, 50);
  g_assert_cmpuint(particles(world), ==, start - taken);
  uint64_t before = spore_allocation_count();
  run_to(world, 0.6);
  g_assert_cmpuint(spore_allocation_count(), ==, before);
  uint64_t hash = spore_world_hash(world);
  spore_world_reset(world);
  g_assert_cmpuint(particles(world), ==, start);
  run_to(world, 0.6);
  g_assert_cmpuint(spore_world_hash(world), ==, hash);
  rig_free(rig);
}

/* A wound gives what was kept back, no faster than it may, and where it is free. */
static void test_emitter(void) {
  Rig *rig = drop(0, 1, 60, 100);
  SporeWorld *world = rig_build(rig);
  size_t all = spore_world_body_model(world, 0)->node_count;
  g_assert_cmpuint(particles(world), ==, all - 60);
  run_to(world, 0.09);
  g_assert_cmpuint(particles(world), ==, all - 60);
  run_to(world, 0.4);
  size_t come = particles(world) - (all - 60);
  g_test_message("%zu particles came in 0.3 s at 100 a second; fastest %.3f m/s; %s", come, fastest(world),
                 rig_last_message(world));
  g_assert_cmpuint(come, >=, 20);
  g_assert_cmpuint(come, <=, 31);
  g_assert_cmpfloat(fastest(world), <, 1);
  run_to(world, 3);
  g_test_message("%zu in the end", particles(world) - (all - 60));
  g_assert_cmpuint(particles(world), ==, all);
  rig_free(rig);
}

/* What is taken comes again: bleeding and suction together go on for ever. */
static void test_circle(void) {
  Rig *rig = drop(1, 1, 20, 200);
  SporeSuctionFields *suction = rig_tool_fields(&g_array_index(rig->tools, SporeToolDescription, 0));
  spore_vec3_store(suction->point, spore_vec3(0.02, 0.004, 0));
  SporeWorld *world = rig_build(rig);
  run_to(world, 2);
  size_t taken = spore_world_tool_state(world, 0).taken;
  g_test_message("%zu taken in 2 s, %zu of %zu in the world", taken, particles(world),
                 spore_world_body_model(world, 0)->node_count);
  g_assert_cmpuint(taken, >, 20); /* more than were kept back */
  rig_free(rig);
}

/* The message tells how many there are, and so many are taken. */
static void test_reserve(void) {
  Rig *rig = drop(0, 1, 10000, 100);
  SporeError error = SPORE_ERROR_INIT;
  g_assert_null(rig_try_build(rig, &error));
  g_assert_cmpstr(error.place, ==, "effects/wound");
  const char *most = strstr(error.message, "expected at most ");
  g_assert_nonnull(most);
  gint64 count = g_ascii_strtoll(most + strlen("expected at most "), NULL, 10);
  rig_free(rig);
  rig = drop(0, 1, count, 100);
  SporeWorld *world = rig_build(rig);
  g_assert_cmpuint(particles(world), ==, 0);
  run_to(world, 0.3);
  g_assert_cmpuint(particles(world), >, 5);
  rig_free(rig);
}

/* A spring to a drop whose particles may go is refused, to one whose particles stay it is not. */
static void test_links(void) {
  for (size_t goes = 0; goes < 3; goes++) {
    Rig *rig = drop(goes == 1, goes == 2, 10, 100);
    SporeLinkDescription spring = {.name = "cord",
                                   .type = &spore_link_spring,
                                   .body_b = SPORE_NO_BODY,
                                   .point_b = {0, -0.01, 0},
                                   .stiffness = 0.1,
                                   .rest_length = -1};
    g_array_append_val(rig->links, spring);
    SporeError error = SPORE_ERROR_INIT;
    g_assert_true((rig_try_build(rig, &error) != NULL) == (goes == 0));
    if (goes > 0) {
      g_test_message("%s: %s", error.place, error.message);
      g_assert_cmpstr(error.place, ==, "links/cord");
      g_assert_nonnull(strstr(error.message, goes == 1 ? "suction" : "emitter"));
    }
    rig_free(rig);
  }
}

/* The way that the first particle goes which comes out of a mouth on tissue, once that has turned by a quarter about z:
 * of a sheet, or of a thread. */
static SporeVec3 way_out(bool thread, bool turned) {
  Rig *rig = drop(0, 1, 10, 100);
  SporeTriangleMesh sheet;
  SporeEmitterDescription wound = rig->description.emitters[0];
  if (thread) {
    double *line = SPORE_NEW_ARRAY(double, 4 * 8);
    for (int i = 0; i < 8; i++)
      spore_vec3_store(line + 4 * i, spore_vec3(0.05 + 0.005 * i, 0, 0)), line[4 * i + 3] = 1e-3;
    rig_passive(rig, "tissue", rig_curve_model(&spore_spline_1d, &(SporeCurve){8, line}, NULL), NULL);
  } else {
    shape_level_sheet(&sheet, 5, 5, 0.005);
    rig_passive(rig, "tissue", rig_surface_model(&spore_mass_spring_net, &sheet, NULL), NULL);
  }
  wound.source = 2;
  wound.point = thread ? spore_vec3(0.07, 0.001, 0) : spore_vec3(0.01, 0.001, 0.01);
  wound.fields.start = 0;
  rig->description.emitters = &wound;
  SporeWorld *world = rig_build(rig);
  size_t count = spore_world_body_model(world, 2)->node_count, before = particles(world);
  g_autofree double *q = g_memdup2(spore_world_q(world, 2), 3 * count * sizeof *q), *v = g_new0(double, 3 * count);
  for (size_t i = 0; turned && i < count; i++) {
    double x = q[3 * i], y = q[3 * i + 1];
    q[3 * i] = 0.1 - y, q[3 * i + 1] = x;
  }
  spore_world_set_state(world, 2, q, v);
  while (particles(world) == before) spore_world_step(world);
  const double *speeds = spore_world_v(world, 0), *at = spore_world_q(world, 0);
  SporeVec3 way = {0, 0, 0};
  for (size_t i = 0; i < spore_world_body_model(world, 0)->node_count; i++)
    if (!spore_particle_is_out(at + 3 * i) && spore_vec3_length(spore_vec3_load(speeds + 3 * i)) > 0.04)
      way = spore_vec3_load(speeds + 3 * i);
  rig_free(rig);
  return way;
}

/* What bleeds out of tissue goes the way that the tissue has turned. */
static void test_mouth_turns(void) {
  for (int thread = 0; thread < 2; thread++) {
    SporeVec3 straight = way_out(thread, false), turned = way_out(thread, true);
    g_test_message("out at %.3f %.3f %.3f m/s, and %.3f %.3f %.3f once it has turned", straight.x, straight.y,
                   straight.z, turned.x, turned.y, turned.z);
    g_assert_cmpfloat(spore_vec3_distance(straight, spore_vec3(0, 0.05, 0)), <, 5e-3);
    g_assert_cmpfloat(spore_vec3_distance(turned, spore_vec3(-0.05, 0, 0)), <, 5e-3);
  }
}

#define FLOW 2e-6   /* m^3/s */
#define BORE 0.0008 /* m */

/* A device that stays where it is, with those buttons down for .2 s from .1 s on. */
typedef struct Pedal {
  SporeDevice base;
  uint32_t buttons;
} Pedal;

static bool press(SporeDevice *device, double time_s, const SporeDeviceCommand *command, SporeDeviceState *state) {
  (void)command;
  uint32_t buttons = ((const Pedal *)device)->buttons;
  *state = (SporeDeviceState){.position = {0, 0.02, 0}, .orientation = {1, 0, 0, 0}};
  state->buttons = time_s > 0.0999 && time_s < 0.2999 ? buttons : 0;
  return true;
}
static const SporeDeviceType pedal_type = {.name = "pedal", .exchange = press};

/* An instrument that sucks while its first button is down, and pours downward while the second one is. */
static Rig *irrigator(bool effect) {
  Rig *rig = drop(1, 1, 0, 1000);
  SporeEmitterDescription jet = rig->description.emitters[0];
  SporeSuctionFields *suction = rig_tool_fields(&g_array_index(rig->tools, SporeToolDescription, 0));
  SporeBodyDescription *water = &g_array_index(rig->bodies, SporeBodyDescription, 0);
  spore_vec3_store(suction->point, spore_vec3(0, 0.02, 0));
  suction->trigger = SPORE_FLOW_BUTTON;
  water->effect = effect;
  jet.source = 1, jet.point = spore_vec3(0, 0.02, 0), jet.direction = spore_vec3(0, -1, 0);
  jet.fields.flow = FLOW, jet.fields.radius = BORE, jet.fields.start = 0;
  jet.fields.trigger = SPORE_FLOW_SECOND_BUTTON;
  jet.fields.reserve = (int64_t)water->model->node_count;
  ((SporeEmitterDescription *)rig->description.emitters)[0] = jet;
  return rig;
}

/* The volume that comes out is the flow's, to within a particle, while the second button is down and no other; it goes
 * as fast as it must through the bore. */
static void test_irrigation(void) {
  for (int c = 0; c < 6; c++) {
    bool effect = c % 2;
    Pedal pedal = {{&pedal_type}, (uint32_t)c / 2};
    Rig *rig = irrigator(effect);
    SporeWorld *world = rig_build(rig);
    spore_world_set_device(world, 1, &pedal.base);
    double each = spore_world_body_model(world, 0)->particle_volume;
    g_assert_cmpfloat_with_epsilon(each * PARTICLES, 1e-6, 5e-8); /* of the box */
    run_to(world, 0.2);
    uint64_t before = spore_allocation_count();
    run_to(world, 0.35);
    g_assert_cmpuint(spore_allocation_count(), ==, before);
    SporeBodyMarks marks = spore_world_body_marks(world, 0);
    g_test_message("%s, buttons %u: %.2f ml came in 0.2 s; fastest %.3f m/s", effect ? "effect" : "physics",
                   pedal.buttons, 1e6 * each * (double)marks.poured, fastest(world));
    g_assert_cmpuint(particles(world) + marks.sucked, ==, marks.poured);
    if (pedal.buttons == 2) {
      g_assert_cmpfloat_with_epsilon(each * (double)marks.poured, 0.2 * FLOW, each);
      double speed = FLOW / (G_PI * BORE * BORE) * exp(-DRAG * 0.05); /* of the last of them */
      g_assert_cmpfloat_with_epsilon(fastest(world), speed, effect ? 0.01 : 0.2);
    } else {
      g_assert_cmpuint(marks.poured, ==, 0);
    }
    uint64_t hash = spore_world_hash(world);
    spore_world_reset(world);
    g_assert_cmpuint(spore_world_body_marks(world, 0).poured, ==, 0);
    run_to(world, 0.35);
    g_assert_cmphex(spore_world_hash(world), ==, hash);
    rig_free(rig);
  }
}

/* Both buttons: what is poured is sucked up again, and what is sucked up is poured again. */
static void test_rinsing(void) {
  Rig *rig = irrigator(true);
  Pedal pedal = {{&pedal_type}, 3};
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 1, &pedal.base);
  run_to(world, 0.35);
  SporeBodyMarks marks = spore_world_body_marks(world, 0);
  g_assert_cmpuint(marks.sucked, >, 40);
  g_assert_cmpuint(particles(world) + marks.sucked, ==, marks.poured);
  rig_free(rig);
}

/* Fluids that are out of the world are not in each other's way. */
static void test_parked(void) {
  Rig *rig = irrigator(false);
  const SporeEmitterDescription jet = rig->description.emitters[0];
  SporeEmitterDescription two[] = {jet, jet};
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.01, 0.01, 0.01));
  rig_passive(rig, "blood", rig_fluid_model(&box, PARTICLES, NULL), NULL);
  two[1].name = "other", two[1].body = 2;
  rig->description.emitters = two, rig->description.emitter_count = 2;
  SporeWorld *world = rig_build(rig);
  const double *one = spore_world_q(world, 0), *other = spore_world_q(world, 2);
  size_t count = spore_world_body_model(world, 0)->node_count;
  double least = INFINITY;
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < count; k++)
      least = fmin(least, spore_vec3_distance(spore_vec3_load(one + 3 * i), spore_vec3_load(other + 3 * k)));
  g_assert_cmpuint(particles(world) + spore_world_particle_count(world, 2), ==, 0);
  g_assert_cmpfloat(least, >, 0.01);
  rig_free(rig);
}

static void test_refused(void) {
  Rig *rig = drop(0, 1, 10, 100);
  SporeError error = SPORE_ERROR_INIT;
  SporeEmitterDescription wound = rig->description.emitters[0];
  wound.body = 1;
  rig->description.emitters = &wound;
  g_assert_null(rig_try_build(rig, &error));
  rig_free(rig);
  rig = irrigator(true);
  ((SporeEmitterDescription *)rig->description.emitters)[0].fields.radius = 0;
  g_assert_null(rig_try_build(rig, &error));
  g_assert_nonnull(strstr(error.message, "expected a radius above 0"));
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/flow/suction", test_suction);
  g_test_add_func("/flow/emitter", test_emitter);
  g_test_add_func("/flow/circle", test_circle);
  g_test_add_func("/flow/reserve", test_reserve);
  g_test_add_func("/flow/links", test_links);
  g_test_add_func("/flow/mouth-turns", test_mouth_turns);
  g_test_add_func("/flow/irrigation", test_irrigation);
  g_test_add_func("/flow/rinsing", test_rinsing);
  g_test_add_func("/flow/parked", test_parked);
  g_test_add_func("/flow/refused", test_refused);
  return g_test_run();
}
