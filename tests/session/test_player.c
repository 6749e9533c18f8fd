/* The player prepares simulations apart from the thread that asks for them: what is asked meanwhile is done, an edit
 * begins anew, and a cancel or a close leaves no thread. No display. */
#include <string.h>

#include "core/author/edits.h"
#include "core/author/generator.h"
#include "core/io/scene_xml.h"
#include "models/registry.h"
#include "ui/jobs/under-way.h"
#include "ui/sim/spore-player.h"

/* A stone that falls. */
static const char stone_text[] =
    "<spore version=\"1.0\"><solver time_step=\"0.001\"/><assets><mesh name=\"cube\" file=\"cube.off\"/></assets>"
    "<bodies><body name=\"stone\"><mechanical geometry=\"cube\"><rigid_body/></mechanical></body></bodies></spore>";
/* A fluid whose preparing takes a minute or more: each of 40,000 spheres is compared with each of 100,000 particles. */
static const char fluid_text[] =
    "<spore version=\"1.0\"><solver time_step=\"0.00005\"/><assets><mesh name=\"cube\" file=\"cube.off\"/>"
    "<spheres name=\"many\" file=\"many.spheres\"/><spheres name=\"one\" file=\"one.spheres\"/></assets><bodies>"
    "<body name=\"blood\"><mechanical geometry=\"cube\"><lennard_jones particles=\"100000\"/></mechanical>"
    "<collision spheres=\"many\"/></body></bodies></spore>";
/* A sheet of 10,000 points whose first step takes minutes. */
static const char sheet_text[] =
    "<spore version=\"1.0\"><solver integrator=\"static\" linear=\"conjugate_gradients\"/>"
    "<assets><mesh name=\"sheet\" file=\"sheet.off\"/></assets><bodies><body name=\"sheet\">"
    "<mechanical geometry=\"sheet\"><spline_2d control_points_u=\"100\" control_points_v=\"100\"/></mechanical>"
    "</body></bodies><links><pin name=\"corner\" body=\"sheet\" point=\"0 0 0\" radius=\"0.01\"/></links></spore>";

static const char cube_off[] =
    "OFF\n8 12 0\n-.05 -.05 -.05\n.05 -.05 -.05\n.05 .05 -.05\n-.05 .05 -.05\n-.05 -.05 .05\n.05 -.05 .05\n.05 .05 "
    ".05\n"
    "-.05 .05 .05\n3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 2 3 7\n3 2 7 6\n3 1 2 6\n3 1 6 5\n3 0 4 7\n"
    "3 0 7 3\n";

#define SPHERES 40000

typedef struct {
  SporeSchema *schema;
  SporeDocument *document; /* of the editor */
  SporeEditorDocument *editor;
  SporePlayer *player;
  guint progressed, replaced, failed; /* signals so far */
} Fixture;

static void put(SporeDocument *document, const char *file, const char *text) {
  g_autoptr(GBytes) content = g_bytes_new(text, strlen(text));
  spore_document_put_blob(document, file, content);
}

static char *many_spheres(void) {
  GString *text = g_string_new(NULL);
  for (int i = 0; i < SPHERES; i++) g_string_append_printf(text, "%g 0.01 0.003 0.001\n", 0.04 * i / SPHERES);
  return g_string_free(text, FALSE);
}

static void count(guint *counter) { (*counter)++; }
static void count_failure(SporePlayer *player, const char *text, guint *counter) { (*counter)++; }

static void set_up(Fixture *fixture, gconstpointer scene) {
  GError *error = NULL;
  g_autofree char *many = many_spheres();
  fixture->schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  fixture->document = spore_scene_parse(fixture->schema, NULL, scene, strlen(scene), &error);
  g_assert_no_error(error);
  put(fixture->document, "cube.off", cube_off);
  put(fixture->document, "many.spheres", many);
  put(fixture->document, "one.spheres", "0 0 0 0.01\n");
  put(fixture->document, "sheet.off", "OFF\n4 2 0\n0 0 0\n.1 0 0\n.1 .1 0\n0 .1 0\n3 0 1 2\n3 0 2 3\n");
  fixture->editor = spore_editor_document_new(fixture->document);
  fixture->player = spore_player_new(fixture->editor);
  g_signal_connect_swapped(fixture->player, "progressed", G_CALLBACK(count), &fixture->progressed);
  g_signal_connect_swapped(fixture->player, "replaced", G_CALLBACK(count), &fixture->replaced);
  g_signal_connect(fixture->player, "failed", G_CALLBACK(count_failure), &fixture->failed);
}

/* Closes the player whatever it does; nothing is under way afterwards. */
static void tear_down(Fixture *fixture, gconstpointer scene) {
  spore_player_close(fixture->player);
  g_clear_object(&fixture->player);
  g_object_unref(fixture->editor);
  spore_works_wait();
  spore_schema_free(fixture->schema);
}

static void settle(const Fixture *fixture) {
  while (spore_player_is_making(fixture->player)) g_main_context_iteration(NULL, TRUE);
}

static guint64 step_of(const Fixture *fixture) {
  return spore_session_snapshot(spore_player_get_session(fixture->player))->step;
}

static double height_of(const Fixture *fixture) {
  return spore_session_snapshot(spore_player_get_session(fixture->player))->q[1];
}

static void wait_for_step(const Fixture *fixture, guint64 step) {
  while (step_of(fixture) < step) g_main_context_iteration(NULL, FALSE);
}

static void set(const Fixture *fixture, const char *path, const char *name, const char *value) {
  GError *error = NULL;
  spore_edit_set_property(fixture->document, path, name, value, &error);
  g_assert_no_error(error);
}

/* Steps are kept until there is something that makes them. */
static void test_steps_wait(Fixture *fixture, gconstpointer scene) {
  g_assert_null(spore_player_get_session(fixture->player));
  for (int i = 0; i < 3; i++) spore_player_step(fixture->player);
  g_assert_true(spore_player_is_making(fixture->player));
  g_assert_null(spore_player_get_session(fixture->player));
  settle(fixture);
  wait_for_step(fixture, 3);
  g_assert_cmpuint(fixture->replaced, ==, 1);
  while (!spore_session_stands(spore_player_get_session(fixture->player))) g_main_context_iteration(NULL, FALSE);
  g_assert_cmpuint(step_of(fixture), ==, 3);
}

static void test_play_waits(Fixture *fixture, gconstpointer scene) {
  spore_player_set_speed(fixture->player, 0);
  spore_player_play(fixture->player);
  g_assert_true(spore_player_is_playing(fixture->player));
  settle(fixture);
  g_assert_true(spore_player_is_playing(fixture->player));
  wait_for_step(fixture, 20);
  spore_player_pause(fixture->player);
  g_assert_false(spore_player_is_playing(fixture->player));
}

/* A pause takes the wish back, and not the making. */
static void test_pause_while_making(Fixture *fixture, gconstpointer scene) {
  spore_player_play(fixture->player);
  spore_player_pause(fixture->player);
  g_assert_false(spore_player_is_playing(fixture->player));
  settle(fixture);
  g_assert_false(spore_player_is_playing(fixture->player));
  g_assert_cmpuint(step_of(fixture), ==, 0);
}

static void take_steps(const Fixture *fixture, guint64 steps) {
  spore_player_step(fixture->player);
  settle(fixture);
  spore_session_step(spore_player_get_session(fixture->player), (guint)steps - 1);
  wait_for_step(fixture, steps);
  spore_session_pause(spore_player_get_session(fixture->player));
}

/* A live property goes into the running world, another one makes a new world in the same state, and the run before is
 * there until then. At the start, an edit ends the simulation: what is seen is the scene. */
static void test_follows_edits(Fixture *fixture, gconstpointer scene) {
  take_steps(fixture, 5);
  SporeSession *session = spore_player_get_session(fixture->player);
  set(fixture, "environment", "gravity", "0 -1 0");
  g_assert_false(spore_player_is_making(fixture->player));
  double height = height_of(fixture);
  g_assert_cmpfloat(height, <, 0);
  set(fixture, "solver", "time_step", "0.003");
  g_assert_true(spore_player_is_making(fixture->player));
  g_assert_true(spore_player_get_session(fixture->player) == session);
  settle(fixture);
  g_assert_cmpuint(fixture->replaced, ==, 2);
  g_assert_cmpfloat(height_of(fixture), ==, height);
  spore_player_reset(fixture->player);
  g_assert_cmpuint(step_of(fixture), ==, 0);
  spore_document_undo(fixture->document);
  g_assert_null(spore_player_get_session(fixture->player));
  g_assert_false(spore_player_is_making(fixture->player));
}

/* Back to the start, while the world of an edit is made: the new world is at its start, too. */
static void test_reset_while_making(Fixture *fixture, gconstpointer scene) {
  take_steps(fixture, 5);
  set(fixture, "solver", "time_step", "0.003");
  spore_player_reset(fixture->player);
  settle(fixture);
  g_assert_cmpuint(fixture->replaced, ==, 2);
  g_assert_cmpfloat(height_of(fixture), ==, 0);
}

static void test_refuses(Fixture *fixture, gconstpointer scene) {
  SporeObject *mechanical = spore_document_by_path(fixture->document, "bodies/stone/mechanical");
  g_assert_true(spore_document_remove(fixture->document, mechanical, NULL));
  spore_player_play(fixture->player);
  settle(fixture);
  g_assert_cmpuint(fixture->failed, ==, 1);
  g_assert_null(spore_player_get_session(fixture->player));
  g_assert_false(spore_player_is_playing(fixture->player));
}

/* The main loop turns while the world is made: it tells of progress. */
static void wait_for_progress(const Fixture *fixture) {
  guint before = fixture->progressed;
  while (fixture->progressed < before + 2) g_main_context_iteration(NULL, TRUE);
  g_assert_null(spore_player_get_session(fixture->player));
  g_assert_true(spore_player_is_making(fixture->player));
}

static void test_cancel(Fixture *fixture, gconstpointer scene) {
  spore_player_play(fixture->player);
  wait_for_progress(fixture);
  spore_player_cancel(fixture->player);
  g_assert_false(spore_player_is_making(fixture->player));
  g_assert_false(spore_player_is_playing(fixture->player));
  g_assert_null(spore_player_get_job(fixture->player));
  spore_works_wait();
  g_assert_null(spore_player_get_session(fixture->player));
  g_assert_cmpuint(fixture->failed, ==, 0);
}

/* The scene as edited is made, and not the one before: that one would take a minute. What was asked for stays. */
static void test_edit_while_making(Fixture *fixture, gconstpointer scene) {
  spore_player_step(fixture->player);
  wait_for_progress(fixture);
  set(fixture, "bodies/blood/collision", "spheres", "one");
  set(fixture, "bodies/blood/mechanical/lennard_jones", "particles", "30");
  settle(fixture);
  g_assert_cmpuint(fixture->failed, ==, 0);
  wait_for_step(fixture, 1);
}

static void test_close_while_making(Fixture *fixture, gconstpointer scene) {
  spore_player_play(fixture->player);
  wait_for_progress(fixture); /* and now it is torn down */
}

static void begin_long_step(Fixture *fixture) {
  spore_player_step(fixture->player);
  settle(fixture);
  SporeSession *session = spore_player_get_session(fixture->player);
  while (spore_session_stands(session)) g_main_context_iteration(NULL, FALSE);
}

static void test_close_in_long_step(Fixture *fixture, gconstpointer scene) { begin_long_step(fixture); }

/* Neither an edit nor a reset waits for the step. */
static void test_edit_in_long_step(Fixture *fixture, gconstpointer scene) {
  begin_long_step(fixture);
  SporeSession *session = spore_player_get_session(fixture->player);
  set(fixture, "bodies/sheet/mechanical/spline_2d", "control_points_u", "8");
  set(fixture, "bodies/sheet/mechanical/spline_2d", "control_points_v", "8");
  if (spore_player_is_making(fixture->player)) settle(fixture);
  g_assert_true(spore_player_get_session(fixture->player) != session);
}

static void test_reset_in_long_step(Fixture *fixture, gconstpointer scene) {
  begin_long_step(fixture);
  SporeSession *session = spore_player_get_session(fixture->player);
  spore_player_reset(fixture->player);
  while (!spore_session_stands(session)) g_main_context_iteration(NULL, FALSE);
  g_assert_cmpuint(step_of(fixture), ==, 0);
  g_assert_false(spore_world_cancelled(spore_session_simulation(session)->world));
}

int main(int argc, char **argv) {
  static const struct {
    const char *name, *scene;
    void (*run)(Fixture *fixture, gconstpointer scene);
  } tests[] = {
      {"steps-wait", stone_text, test_steps_wait},
      {"play-waits", stone_text, test_play_waits},
      {"pause-while-making", stone_text, test_pause_while_making},
      {"follows-edits", stone_text, test_follows_edits},
      {"reset-while-making", stone_text, test_reset_while_making},
      {"refuses", stone_text, test_refuses},
      {"cancel", fluid_text, test_cancel},
      {"edit-while-making", fluid_text, test_edit_while_making},
      {"close-while-making", fluid_text, test_close_while_making},
      {"close-in-long-step", sheet_text, test_close_in_long_step},
      {"edit-in-long-step", sheet_text, test_edit_in_long_step},
      {"reset-in-long-step", sheet_text, test_reset_in_long_step},
  };
  g_test_init(&argc, &argv, NULL);
  for (gsize i = 0; i < G_N_ELEMENTS(tests); i++) {
    g_autofree char *path = g_strconcat("/player/", tests[i].name, NULL);
    g_test_add(path, Fixture, tests[i].scene, set_up, tests[i].run, tear_down);
  }
  return g_test_run();
}
