/* A session steps like a plain loop over the world, whatever it is asked meanwhile, and its recording says the same
 * again. */
#include <math.h>
#include <string.h>

#include "core/author/exercise_report.h"
#include "core/author/generator.h"
#include "core/base/memory.h"
#include "core/io/scene_xml.h"
#include "models/registry.h"
#include "ui/sim/session.h"

static const char scene_text[] =
    "<spore version=\"1.0\">\n"
    "<solver time_step=\"0.001\"/>\n"
    "<assets><mesh name=\"cube\" file=\"cube.off\"/><spheres name=\"ball\" file=\"ball.spheres\"/>\n"
    "<spheres name=\"floor\" file=\"floor.spheres\"/><tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n"
    "<bodies>\n"
    "<body name=\"floor\" role=\"unmovable\" position=\"0 -0.1 0\"><collision spheres=\"floor\"/></body>\n"
    "<body name=\"organ\"><mechanical geometry=\"cells\"><corotational_tetrahedra/></mechanical>"
    "<collision spheres=\"ball\"/></body>\n"
    "<body name=\"stone\" position=\"0.01 0.12 0\" rotation=\"0.3 0.2 0.1\"><mechanical geometry=\"cube\"><rigid_body/>"
    "</mechanical><collision spheres=\"ball\"/></body>\n"
    "<body name=\"probe\" role=\"active\" position=\"0.2 0 0\" rotation=\"0.1 0.7 0.3\"><collision spheres=\"ball\"/>"
    "</body>\n"
    "</bodies>\n"
    "<tools><probe name=\"tool\" body=\"probe\" device=\"hand\"/><camera name=\"eye\" body=\"probe\" "
    "lens=\"0.005\"/></tools>\n"
    "<devices><mouse name=\"hand\"/></devices>\n"
    "</spore>\n";

#define CORNERS(end)                                                                                                   \
  "-.05 -.05 -.05" end "\n.05 -.05 -.05" end "\n.05 .05 -.05" end "\n-.05 .05 -.05" end "\n"                           \
  "-.05 -.05 .05" end "\n.05 -.05 .05" end "\n.05 .05 .05" end "\n-.05 .05 .05" end "\n"

static const char track_text[] =
    "spore-track 1\ndevice probe\n"
    "0 0.2 0 0 1 0 0 0 0 0\n0.05 0.08 0.01 0 0.8 0 0.6 0 0 0\n0.2 0.07 0 0.02 1 0 0 0 0 0\n";

static void put(SporeDocument *document, const char *file, char *text) {
  g_autoptr(GBytes) content = g_bytes_new_take(text, strlen(text));
  spore_document_put_blob(document, file, content);
}

static void put_assets(SporeDocument *document) {
  put(document, "cube.off",
      g_strdup("OFF\n8 12 0\n" CORNERS("") "3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 2 3 7\n3 2 7 6\n"
                                           "3 1 2 6\n3 1 6 5\n3 0 4 7\n3 0 7 3\n"));
  put(document, "cube.mesh",
      g_strdup("MeshVersionFormatted 2\nDimension 3\nVertices\n8\n" CORNERS(
          " 0") "Tetrahedra\n5\n1 2 3 6 0\n1 3 4 8 0\n1 6 8 5 0\n3 8 6 7 0\n1 3 8 6 0\nEnd\n"));
  put(document, "ball.spheres", g_strdup("0 0 0 0.05\n0.03 0.03 0.03 0.02\n"));
  put(document, "floor.spheres", g_strdup("0 0 0 0.05\n-0.06 0 0 0.05\n0.06 0 0 0.05\n"));
}

static SporeDocument *new_document(SporeSchema **schema) {
  GError *error = NULL;
  *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  SporeDocument *document = spore_scene_parse(*schema, NULL, scene_text, strlen(scene_text), &error);
  g_assert_no_error(error);
  put_assets(document);
  return document;
}

typedef struct {
  SporeSchema *schema;
  SporeDocument *document;
  SporeTrack track;
} Fixture;

static void set_up(Fixture *fixture, gconstpointer data) {
  SporeError error = SPORE_ERROR_INIT;
  fixture->document = new_document(&fixture->schema);
  if (!spore_track_parse(&fixture->track, "hand.track", track_text, strlen(track_text), &error))
    g_error("%s: %s", error.place, error.message);
}

static void tear_down(Fixture *fixture, gconstpointer data) {
  spore_track_clear(&fixture->track);
  spore_document_free(fixture->document);
  spore_schema_free(fixture->schema);
}

static guint64 loop_hash(Fixture *fixture, const SporeTrack *input, guint steps) {
  GError *error = NULL;
  SporeSimulation *simulation = spore_simulation_new(fixture->document, NULL, input, NULL, &error);
  g_assert_no_error(error);
  for (guint i = 0; i < steps; i++) spore_world_step(simulation->world);
  guint64 hash = spore_world_hash(simulation->world);
  spore_simulation_free(simulation);
  return hash;
}

static SporeSession *new_session(Fixture *fixture, int threads, const SporeTrack *input) {
  GError *error = NULL;
  SporeSession *session = spore_session_new(fixture->document, threads, input, NULL, &error);
  g_assert_no_error(error);
  return session;
}

/* Plays until the step is passed, pauses there or a little later, and gives the step it stands at. */
static guint play_past(SporeSession *session, guint steps) {
  spore_session_play(session);
  while (spore_session_snapshot(session)->step < steps) g_usleep(500);
  spore_session_pause(session);
  return (guint)spore_session_snapshot(session)->step;
}

#define STEPS 150

static void test_steps_equal_loop(Fixture *fixture, gconstpointer data) {
  guint64 expected = loop_hash(fixture, &fixture->track, STEPS);
  g_assert_cmphex(expected, !=, loop_hash(fixture, NULL, STEPS));
  for (int threads = 1; threads <= 2; threads++) {
    SporeSession *session = new_session(fixture, threads, &fixture->track);
    g_assert_cmpuint(spore_session_snapshot(session)->step, ==, 0);
    spore_session_step(session, 1);
    g_assert_cmpuint(spore_session_snapshot(session)->step, ==, 1);
    spore_session_step(session, STEPS - 1);
    g_assert_cmpuint(spore_session_snapshot(session)->step, ==, STEPS);
    g_assert_cmphex(spore_snapshot_hash(spore_session_snapshot(session)), ==, expected);
    spore_session_free(session);
  }
}

static void test_free_run_equals_loop(Fixture *fixture, gconstpointer data) {
  for (int threads = 1; threads <= 2; threads++) {
    SporeSession *session = new_session(fixture, threads, &fixture->track);
    spore_session_set_speed(session, 0);
    guint steps = play_past(session, STEPS);
    guint64 hash = spore_snapshot_hash(spore_session_snapshot(session));
    g_assert_cmphex(hash, ==, loop_hash(fixture, &fixture->track, steps));
    spore_session_free(session);
  }
}

static void test_paced_run_equals_loop(Fixture *fixture, gconstpointer data) {
  SporeSession *session = new_session(fixture, 1, &fixture->track);
  play_past(session, 20);
  spore_session_set_speed(session, 0.5);
  guint steps = play_past(session, 40);
  g_assert_cmphex(spore_snapshot_hash(spore_session_snapshot(session)), ==, loop_hash(fixture, &fixture->track, steps));
  spore_session_free(session);
}

static void test_pause_stands_still(Fixture *fixture, gconstpointer data) {
  SporeSession *session = new_session(fixture, 1, &fixture->track);
  g_assert_false(spore_session_is_playing(session));
  spore_session_set_speed(session, 0);
  guint steps = play_past(session, 10);
  g_assert_false(spore_session_is_playing(session));
  g_usleep(20000);
  g_assert_cmpuint(spore_session_snapshot(session)->step, ==, steps);
  spore_session_play(session);
  g_assert_true(spore_session_is_playing(session));
  spore_session_step(session, 5); /* refused while playing; must not hang */
  spore_session_free(session);
}

static void test_reset_goes_back(Fixture *fixture, gconstpointer data) {
  SporeSession *session = new_session(fixture, 1, &fixture->track);
  guint64 start = spore_snapshot_hash(spore_session_snapshot(session));
  spore_session_step(session, STEPS);
  guint64 end = spore_snapshot_hash(spore_session_snapshot(session));
  spore_session_reset(session);
  g_assert_cmpuint(spore_session_snapshot(session)->step, ==, 0);
  g_assert_cmphex(spore_snapshot_hash(spore_session_snapshot(session)), ==, start);
  spore_session_step(session, STEPS);
  g_assert_cmphex(spore_snapshot_hash(spore_session_snapshot(session)), ==, end);
  spore_session_play(session);
  spore_session_reset(session);
  g_assert_true(spore_session_is_playing(session));
  spore_session_free(session);
}

static const char exercise_parts[] =
    "<reached name=\"near\" tool=\"tool\" point=\"0.1 0.01 0\" radius=\"0.03\"/>"
    "<touched name=\"push\" tool=\"tool\" body=\"organ\" after=\"near\"/>"
    "<path_length name=\"path\" good=\"1 cm\" pass=\"1 m\"/><peak_force name=\"force\" good=\"1 N\" pass=\"900 N\"/>";

/* The fixture's scene with an exercise. */
static void add_exercise(Fixture *fixture) {
  static const char end[] = "</spore>\n";
  GError *error = NULL;
  g_autofree char *text = g_strdup_printf("%.*s<exercise>%s</exercise>%s", (int)(sizeof scene_text - sizeof end),
                                          scene_text, exercise_parts, end);
  SporeDocument *before = fixture->document;
  fixture->document = spore_scene_parse(fixture->schema, NULL, text, strlen(text), &error);
  g_assert_no_error(error);
  put_assets(fixture->document);
  spore_document_free(before);
}

static void keep_report(const SporeExercise *exercise, gpointer report) {
  *(char **)report = spore_exercise_report(exercise, "scene", ".json", NULL);
}

static char *report_of(SporeSession *session) {
  char *report = NULL;
  g_assert_true(spore_session_read_exercise(session, keep_report, &report));
  return report;
}

/* What a plain loop over the world says of its exercise. */
static char *loop_report(Fixture *fixture, guint steps) {
  GError *error = NULL;
  char *report;
  SporeSimulation *simulation = spore_simulation_new(fixture->document, NULL, &fixture->track, NULL, &error);
  g_assert_no_error(error);
  for (guint i = 0; i < steps; i++) {
    spore_world_step(simulation->world);
    spore_exercise_watch(simulation->exercise, simulation->world);
  }
  keep_report(simulation->exercise, &report);
  spore_simulation_free(simulation);
  return report;
}

/* The score of a session is that of a plain loop to the last digit, stepped or played, and again after a reset. */
static void test_exercise_equals_loop(Fixture *fixture, gconstpointer data) {
  add_exercise(fixture);
  g_autofree char *expected = loop_report(fixture, STEPS), *start = loop_report(fixture, 0);
  g_assert_nonnull(strstr(expected, "\"phase\" : \"done\",\n    \"time_s\""));
  SporeSession *session = new_session(fixture, 2, &fixture->track);
  spore_session_set_speed(session, 0);
  play_past(session, STEPS);
  g_autofree char *played = report_of(session);
  g_assert_cmpstr(played, ==, expected);
  SporeExerciseState attempt;
  g_assert_true(spore_session_take_attempt(session, &attempt));
  g_assert_cmpint(attempt.phase, ==, SPORE_EXERCISE_DONE);
  g_assert_false(spore_session_take_attempt(session, &attempt));
  spore_session_reset(session);
  g_autofree char *anew = report_of(session);
  g_assert_cmpstr(anew, ==, start);
  spore_session_step(session, STEPS);
  g_autofree char *stepped = report_of(session);
  g_assert_cmpstr(stepped, ==, expected);
  spore_session_free(session);
}

/* A session that repeats an attempt has its score, and is no attempt. */
static void test_exercise_is_repeated(Fixture *fixture, gconstpointer data) {
  add_exercise(fixture);
  g_autofree char *expected = loop_report(fixture, STEPS);
  SporeSession *first = new_session(fixture, 1, &fixture->track);
  spore_session_step(first, STEPS);
  SporeTrack *input = spore_session_recording(first);
  SporeSession *session = new_session(fixture, 1, input);
  spore_session_repeat(session, input);
  SporeExerciseState attempt;
  for (int i = 0; i < 2; i++) {
    spore_session_step(session, STEPS);
    g_autofree char *repeated = report_of(session);
    g_assert_cmpstr(repeated, ==, expected);
    g_assert_false(spore_session_take_attempt(session, &attempt));
    spore_session_reset(session);
  }
  g_assert_true(spore_session_take_attempt(first, &attempt));
  spore_session_free(session);
  spore_session_free(first);
}

/* A try-out is told from an attempt, and a new beginning is an attempt. */
static void test_exercise_is_tried(Fixture *fixture, gconstpointer data) {
  add_exercise(fixture);
  SporeSession *session = new_session(fixture, 1, NULL);
  g_assert_false(spore_session_skip_to(session, 2));
  g_assert_true(spore_session_skip_to(session, 1));
  g_autofree char *tried = report_of(session);
  g_assert_nonnull(strstr(tried, "\"tried\" : true"));
  spore_session_reset(session);
  g_autofree char *anew = report_of(session);
  g_assert_null(strstr(anew, "tried"));
  const SporeCommand pull = {.kind = SPORE_COMMAND_PULL, .body = 1, .number = 1};
  spore_session_post(session, &pull);
  g_autofree char *pulled = report_of(session);
  g_assert_nonnull(strstr(pulled, "\"tried\" : true"));
  spore_session_free(session);
}

/* The clock of an exercise begins where a session takes over the state of another one. */
static void test_exercise_carries_nothing_over(Fixture *fixture, gconstpointer data) {
  add_exercise(fixture);
  SporeSession *old = new_session(fixture, 1, &fixture->track), *new = new_session(fixture, 1, NULL);
  spore_session_step(old, STEPS);
  spore_session_carry_over(new, old);
  spore_session_step(new, 1);
  g_autofree char *report = report_of(new);
  SporeExerciseState attempt;
  g_assert_true(spore_session_take_attempt(old, &attempt));
  spore_session_step(new, STEPS);
  g_assert_false(spore_session_take_attempt(new, &attempt));
  g_assert_nonnull(strstr(report, "\"time_s\" : 0.001"));
  g_assert_nonnull(strstr(report, "\"tried\" : true"));
  spore_session_free(old);
  spore_session_free(new);
}

static void test_no_exercise(Fixture *fixture, gconstpointer data) {
  SporeSession *session = new_session(fixture, 1, NULL);
  g_assert_false(spore_session_read_exercise(session, keep_report, NULL));
  g_assert_false(spore_session_skip_to(session, 0));
  spore_session_free(session);
}

static guint32 probe_of(SporeSession *session) {
  return spore_world_find_body(spore_session_simulation(session)->world, "probe");
}

static const double *probe_q(SporeSession *session) {
  const SporeWorld *world = spore_session_simulation(session)->world;
  return spore_session_snapshot(session)->q + spore_world_q_offset(world, probe_of(session));
}

static void lead(SporeSession *session, double x, double y) {
  SporeDeviceState state = {.position = {x, y, 0.003}, .orientation = {0.8, 0.1, -0.2, 0.3}};
  spore_session_set_pointer(session, probe_of(session), &state);
}

static void test_pointer_leads_and_pushes(Fixture *fixture, gconstpointer data) {
  SporeSession *session = new_session(fixture, 1, NULL);
  spore_session_step(session, 20);
  g_assert_cmpfloat(probe_q(session)[0], ==, 0.2);
  lead(session, 0.07, 0);
  spore_session_step(session, 200);
  g_assert_cmpfloat_with_epsilon(probe_q(session)[0], 0.07, 1e-4);
  const double *reaction = spore_session_snapshot(session)->reaction + 6 * probe_of(session);
  g_assert_cmpfloat(hypot(hypot(reaction[0], reaction[1]), reaction[2]), >, 0.01);
  spore_session_free(session);
}

/* The mouse takes a body from its track until the reset. */
static void test_pointer_takes_over(Fixture *fixture, gconstpointer data) {
  SporeSession *session = new_session(fixture, 1, &fixture->track);
  g_assert_cmpfloat(spore_session_input(session, probe_of(session)).grip_rad, >, 1);
  spore_session_step(session, 60);
  g_assert_cmpfloat_with_epsilon(probe_q(session)[0], 0.08, 1e-3);
  g_assert_cmpfloat_with_epsilon(spore_session_input(session, probe_of(session)).position[0], 0.08, 1e-3);
  lead(session, 0.1, 0.02);
  spore_session_step(session, 140);
  g_assert_cmpfloat_with_epsilon(probe_q(session)[0], 0.1, 1e-4);
  spore_session_reset(session);
  spore_session_step(session, STEPS);
  g_assert_cmphex(spore_snapshot_hash(spore_session_snapshot(session)), ==, loop_hash(fixture, &fixture->track, STEPS));
  spore_session_free(session);
}

static void free_track(SporeTrack *track) {
  spore_track_clear(track);
  g_free(track);
}

/* A recording is input that leads to the same bits, with a track beneath or without one. */
static void test_recording_repeats(Fixture *fixture, gconstpointer data) {
  SporeSession *session = new_session(fixture, 1, data ? &fixture->track : NULL);
  spore_session_step(session, 30);
  lead(session, 0.08, 0.01);
  spore_session_step(session, 60);
  lead(session, 0.06, -0.01);
  spore_session_step(session, 60);
  guint64 expected = spore_snapshot_hash(spore_session_snapshot(session));
  SporeTrack *recording = spore_session_recording(session);
  spore_session_free(session);
  g_assert_cmphex(loop_hash(fixture, recording, 150), ==, expected);

  /* Through the file too. */
  size_t size;
  SporeTrack read = {0};
  SporeError error = SPORE_ERROR_INIT;
  char *text = spore_track_format(recording, &size);
  g_assert_true(spore_track_parse(&read, "recording.track", text, size, &error));
  g_assert_cmphex(loop_hash(fixture, &read, 150), ==, expected);
  spore_free(text);
  spore_track_clear(&read);
  free_track(recording);
}

/* What nobody took is recorded as its author wrote it. */
static void await_way(SporeSession *session) {
  double unused;
  while (spore_session_is_going(session, &unused)) g_usleep(500);
}

static guint64 hash_after(SporeSession *session, guint64 step) {
  spore_session_try_go_to(session, step);
  await_way(session);
  g_assert_cmpuint(spore_session_snapshot(session)->step, ==, step);
  return spore_snapshot_hash(spore_session_snapshot(session));
}

#define PULLED 40 /* steps before tissue is pulled; the probe is led before and after */
#define LET_GO 70

/* A run that the mouse leads and pulls. hashes: after each step. */
static void lead_and_pull(SporeSession *session, guint64 *hashes) {
  const SporeWorld *world = spore_session_simulation(session)->world;
  guint32 probe = spore_world_find_body(world, "probe"), stone = spore_world_find_body(world, "stone");
  for (guint step = 0; step < STEPS; step++) {
    SporeDeviceState hand = {.position = {0.2 - 0.001 * step, 0, 0}, .orientation = {1}, .grip_rad = 1};
    if (step % 7 == 0 && step < 100) spore_session_set_pointer(session, probe, &hand);
    SporeCommand pull = {.kind = SPORE_COMMAND_PULL, .body = stone, .vector = {0.1, 0.1, 0.1 * step}, .number = 50};
    if (step >= PULLED && step < LET_GO) g_assert_true(spore_session_post(session, &pull));
    SporeCommand let_go = {.kind = SPORE_COMMAND_RELEASE, .body = stone};
    if (step == LET_GO) g_assert_true(spore_session_post(session, &let_go));
    spore_session_step(session, 1);
    hashes[step + 1] = spore_snapshot_hash(spore_session_snapshot(session));
  }
}

/* Back and forth to any step, to the bit; what is played from there forgets what came after. */
static void test_goes_back(Fixture *fixture, gconstpointer data) {
  SporeSession *session = new_session(fixture, 1, data ? &fixture->track : NULL);
  guint64 hashes[STEPS + 1] = {spore_snapshot_hash(spore_session_snapshot(session))};
  lead_and_pull(session, hashes);
  g_assert_cmphex(hashes[LET_GO], !=, hashes[PULLED]);
  static const guint steps[] = {PULLED + 5, PULLED + 4, STEPS, 1, LET_GO + 1, 0, STEPS - 1};
  for (guint i = 0; i < G_N_ELEMENTS(steps); i++) g_assert_cmphex(hash_after(session, steps[i]), ==, hashes[steps[i]]);
  g_assert_cmpuint(spore_session_reached(session), ==, STEPS);
  g_assert_cmphex(hash_after(session, PULLED), ==, hashes[PULLED]);
  spore_session_step(session, 1); /* of its own: nothing pulls */
  g_assert_cmpuint(spore_session_reached(session), ==, PULLED + 1);
  g_assert_cmphex(spore_snapshot_hash(spore_session_snapshot(session)), !=, hashes[PULLED + 1]);
  guint64 own = spore_snapshot_hash(spore_session_snapshot(session));
  spore_session_try_go_to(session, STEPS);
  await_way(session);
  g_assert_cmpuint(spore_session_snapshot(session)->step, ==, PULLED + 1);
  g_assert_cmphex(hash_after(session, 3), ==, hashes[3]);
  g_assert_cmphex(hash_after(session, PULLED + 1), ==, own);
  spore_session_set_speed(session, 4);
  spore_session_try_replay(session);
  await_way(session);
  g_assert_cmphex(spore_snapshot_hash(spore_session_snapshot(session)), ==, own);
  spore_session_reset(session);
  g_assert_cmpuint(spore_session_reached(session), ==, 0);
  spore_session_free(session);
}

/* A way ends where it is when it is told to, and by a reset; of a world that was changed there is no way back. */
static void test_way_ends(Fixture *fixture, gconstpointer data) {
  SporeSession *session = new_session(fixture, 1, &fixture->track);
  spore_session_step(session, STEPS);
  spore_session_try_go_to(session, STEPS - 1);
  spore_session_stay(session);
  await_way(session);
  guint64 step = spore_session_snapshot(session)->step;
  g_assert_cmphex(spore_snapshot_hash(spore_session_snapshot(session)), ==,
                  loop_hash(fixture, &fixture->track, (guint)step));
  spore_session_try_go_to(session, 1);
  spore_session_reset(session);
  g_assert_cmpuint(spore_session_snapshot(session)->step, ==, 0);
  spore_session_step(session, 5);
  g_assert_true(spore_session_knows_past(session));
  spore_session_change(session);
  g_assert_false(spore_session_knows_past(session));
  spore_session_try_go_to(session, 2);
  g_assert_cmpuint(spore_session_snapshot(session)->step, ==, 5);
  spore_session_reset(session);
  g_assert_true(spore_session_knows_past(session));
  spore_session_try_go_to(session, 1);
  spore_session_free(session); /* at once */
}

/* How many samples press the button that wipes, all of them between the two times. */
static guint wiping_samples(SporeSession *session, double from_s, double to_s) {
  SporeTrack *recording = spore_session_recording(session);
  const SporeTrackChannel *channel = spore_track_channel(recording, "probe");
  guint wiping = 0;
  for (size_t i = 0; channel && i < channel->count; i++) {
    if (!(channel->states[i].buttons & SPORE_FIRST_BUTTON)) continue;
    g_assert_true(channel->time_s[i] >= from_s && channel->time_s[i] <= to_s);
    wiping++;
  }
  free_track(recording);
  return wiping;
}

/* A wipe by a command goes into the recording, also as the run is played once more, and moves nothing. A lens that
 * there is not leaves no trace. */
static void test_recording_wipes(Fixture *fixture, gconstpointer data) {
  SporeSession *session = new_session(fixture, 1, data ? &fixture->track : NULL);
  const SporeCommand other = {.kind = SPORE_COMMAND_WIPE, .number = 7}, wipe = {.kind = SPORE_COMMAND_WIPE};
  spore_session_step(session, 30);
  g_assert_true(spore_session_post(session, &other));
  spore_session_step(session, 10);
  g_assert_cmpuint(wiping_samples(session, 0, 0), ==, 0);
  g_assert_true(spore_session_post(session, &wipe));
  spore_session_step(session, 110);
  guint wiping = wiping_samples(session, 0.0399, 0.1401);
  guint64 expected = spore_snapshot_hash(spore_session_snapshot(session));
  g_assert_cmpuint(wiping, >=, 2);
  SporeTrack *recording = spore_session_recording(session);
  g_assert_cmphex(loop_hash(fixture, recording, 150), ==, expected);
  free_track(recording);
  hash_after(session, 0);
  g_assert_cmphex(hash_after(session, 150), ==, expected);
  g_assert_cmpuint(wiping_samples(session, 0.0399, 0.1401), ==, wiping);
  spore_session_reset(session);
  spore_session_step(session, 50);
  g_assert_cmpuint(wiping_samples(session, 0, 0), ==, 0);
  spore_session_free(session);
}

static void test_recording_keeps_track(Fixture *fixture, gconstpointer data) {
  SporeSession *session = new_session(fixture, 1, &fixture->track);
  spore_session_step(session, 30);
  SporeTrack *recording = spore_session_recording(session);
  spore_session_free(session);
  g_assert_cmpuint(recording->channel_count, ==, 1);
  g_assert_cmpuint(recording->channels[0].count, ==, fixture->track.channels[0].count);
  free_track(recording);
}

static void test_carry_over(Fixture *fixture, gconstpointer data) {
  SporeSession *old = new_session(fixture, 1, &fixture->track), *new = new_session(fixture, 1, &fixture->track);
  spore_session_step(old, 50);
  const SporeWorld *world = spore_session_simulation(old)->world;
  size_t offset = spore_world_q_offset(world, spore_world_find_body(world, "stone"));
  double expected = spore_session_snapshot(old)->q[offset + 1];
  g_assert_cmpfloat(spore_session_snapshot(new)->q[offset + 1], !=, expected);
  spore_session_carry_over(new, old);
  g_assert_cmpfloat(spore_session_snapshot(new)->q[offset + 1], ==, expected);
  spore_session_free(old);
  spore_session_free(new);
}

static gsize column_of(SporeSession *session, const char *name) {
  gsize count;
  const SporeColumn *columns = spore_session_columns(session, &count);
  for (gsize c = 0; c < count; c++)
    if (g_str_equal(columns[c].name, name)) return c;
  g_error("no column %s", name);
}

/* Single steps have a row each, time 0 too; a watched point lies where it was asked for and moves; a reset begins anew.
 */
static void test_numbers(Fixture *fixture, gconstpointer data) {
  SporeSession *session = new_session(fixture, 1, &fixture->track);
  const SporeWorld *world = spore_session_simulation(session)->world;
  const SporeWatchRequest point = {"stone@0.01,0.12,0", spore_world_find_body(world, "stone"), {0.01, 0.12, 0}};
  gsize rows;
  spore_session_step(session, 5);
  g_free(spore_session_numbers(session, 0, 1, &rows));
  g_assert_cmpuint(rows, ==, 6);
  g_assert_true(spore_session_watch(session, &point, 1, NULL));
  g_assert_cmpuint(spore_session_snapshot(session)->step, ==, 0);
  spore_session_step(session, 100);
  gsize height = column_of(session, "watch.stone@0.01,0.12,0.y");
  g_autofree double *time_s = spore_session_numbers(session, 0, 1, &rows);
  g_autofree double *place = spore_session_numbers(session, height, 1, &rows);
  g_assert_cmpuint(rows, ==, 101);
  for (gsize i = 0; i < rows; i++) g_assert_cmpfloat_with_epsilon(time_s[i], 0.001 * (double)i, 1e-12);
  g_assert_cmpfloat_with_epsilon(place[0], 0.12, 1e-12);
  g_assert_cmpfloat(place[100], <, 0.11);
  SporeSessionFigures figures = spore_session_figures(session);
  g_assert_cmpfloat(figures.local_error, >, 0);
  g_assert_cmpuint(figures.error_body, <, spore_world_body_count(world));
  gsize size = 0, lines = 0;
  char *csv = spore_session_csv(session, &size);
  for (gsize i = 0; i < size; i++) lines += csv[i] == '\n';
  g_assert_cmpuint(lines, ==, 102);
  spore_free(csv);
  spore_session_reset(session);
  g_free(spore_session_numbers(session, 0, 1, &rows));
  g_assert_cmpuint(rows, ==, 1);
  g_assert_true(isnan(spore_session_figures(session).local_error));
  spore_session_free(session);
}

/* A long run keeps fewer rows, evenly, from time 0 to its end. */
static void test_numbers_thin_out(Fixture *fixture, gconstpointer data) {
  SporeSession *session = new_session(fixture, 1, &fixture->track);
  gsize rows;
  spore_session_set_speed(session, 0);
  spore_session_step(session, 5000);
  g_autofree double *time_s = spore_session_numbers(session, 0, 1, &rows);
  g_assert_cmpuint(rows, >, 2000);
  g_assert_cmpuint(rows, <, 4096);
  g_assert_cmpfloat(time_s[0], ==, 0);
  g_assert_cmpfloat_with_epsilon(time_s[rows - 1], 5, 0.0011);
  for (gsize i = 1; i < rows; i++) g_assert_cmpfloat(time_s[i], >, time_s[i - 1]);
  spore_session_free(session);
}

/* A sheet of 10,000 points whose balance takes minutes: a step that outlasts what waits for it. */
static const char long_text[] =
    "<spore version=\"1.0\"><solver integrator=\"static\" linear=\"conjugate_gradients\"/>"
    "<assets><mesh name=\"sheet\" file=\"sheet.off\"/></assets><bodies><body name=\"sheet\">"
    "<mechanical geometry=\"sheet\"><spline_2d control_points_u=\"100\" control_points_v=\"100\"/></mechanical>"
    "</body></bodies><links><pin name=\"corner\" body=\"sheet\" point=\"0 0 0\" radius=\"0.01\"/></links></spore>";

/* Neither a step nor a pause waits for the end of a long step; a reset and an end do not let it go on. */
static void test_long_step(Fixture *fixture, gconstpointer data) {
  g_autoptr(GError) error = NULL;
  SporeDocument *document = spore_scene_parse(fixture->schema, NULL, long_text, strlen(long_text), &error);
  g_assert_no_error(error);
  put(document, "sheet.off", g_strdup("OFF\n4 2 0\n0 0 0\n.1 0 0\n.1 .1 0\n0 .1 0\n3 0 1 2\n3 0 2 3\n"));
  SporeSession *session = spore_session_new(document, 1, NULL, NULL, &error);
  g_assert_no_error(error);
  const SporeWorld *world = spore_session_simulation(session)->world;
  spore_session_pause(session);
  g_assert_true(spore_session_stands(session));
  g_assert_false(spore_session_try_step(session, 1));
  g_assert_false(spore_session_stands(session));
  spore_session_reset(session);
  g_assert_true(spore_session_stands(session));
  g_assert_false(spore_world_cancelled(world));
  g_assert_false(spore_session_try_step(session, 1));
  g_assert_false(spore_session_try_pause(session));
  while (!spore_session_try_give_up(session)) continue;
  g_assert_true(spore_session_stands(session));
  g_assert_true(spore_world_cancelled(world));
  g_assert_cmpuint(spore_session_snapshot(session)->step, ==, 0);
  spore_session_free(session);
  spore_document_free(document);
}

static void test_refused_scene(Fixture *fixture, gconstpointer data) {
  g_autoptr(GError) error = NULL;
  SporeObject *probe = spore_document_by_path(fixture->document, "bodies/probe");
  g_assert_true(spore_document_set_text(fixture->document, probe, "role", "unmovable", NULL));
  g_assert_null(spore_session_new(fixture->document, 1, NULL, NULL, &error));
  g_assert_nonnull(error);
  g_assert_nonnull(strstr(error->message, "probe"));
}

int main(int argc, char **argv) {
  static const struct {
    const char *name;
    void (*run)(Fixture *fixture, gconstpointer data);
    gboolean scripted;
  } tests[] = {
      {"steps-equal-loop", test_steps_equal_loop},
      {"free-run-equals-loop", test_free_run_equals_loop},
      {"paced-run-equals-loop", test_paced_run_equals_loop},
      {"pause-stands-still", test_pause_stands_still},
      {"reset-goes-back", test_reset_goes_back},
      {"exercise-equals-loop", test_exercise_equals_loop},
      {"exercise-is-repeated", test_exercise_is_repeated},
      {"exercise-is-tried", test_exercise_is_tried},
      {"exercise-carries-nothing-over", test_exercise_carries_nothing_over},
      {"no-exercise", test_no_exercise},
      {"pointer-leads-and-pushes", test_pointer_leads_and_pushes},
      {"pointer-takes-over", test_pointer_takes_over},
      {"recording-repeats", test_recording_repeats},
      {"recording-repeats-taken-over", test_recording_repeats, TRUE},
      {"recording-wipes", test_recording_wipes},
      {"recording-wipes-track", test_recording_wipes, TRUE},
      {"recording-keeps-track", test_recording_keeps_track},
      {"goes-back", test_goes_back},
      {"goes-back-taken-over", test_goes_back, TRUE},
      {"way-ends", test_way_ends, TRUE},
      {"carry-over", test_carry_over},
      {"numbers", test_numbers},
      {"numbers-thin-out", test_numbers_thin_out},
      {"long-step", test_long_step},
      {"refused-scene", test_refused_scene},
  };
  g_test_init(&argc, &argv, NULL);
  for (gsize i = 0; i < G_N_ELEMENTS(tests); i++) {
    g_autofree char *path = g_strconcat("/session/", tests[i].name, NULL);
    g_test_add(path, Fixture, GINT_TO_POINTER(tests[i].scripted), set_up, tests[i].run, tear_down);
  }
  return g_test_run();
}
