/* From document to world: what runs, and one clear message for each scene that cannot. */
#include <string.h>

#include "core/scene/compile.h"
#include "core/scene/fidelity.h"
#include "fixture.h"

#define ASSETS                                                                                                         \
  "<spore version=\"1.0\">\n"                                                                                          \
  "<assets><mesh name=\"cube\" file=\"cube.off\"/><mesh name=\"open\" file=\"open.off\"/>\n"                           \
  "<spheres name=\"ball\" file=\"ball.spheres\"/><tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n"
#define BALL "<collision spheres=\"ball\"/>"

static const char everything[] =
    "<spore version=\"1.0\">\n"
    "<environment gravity=\"0 -1 0\"/>\n"
    "<solver time_step=\"0.001\"/>\n"
    "<assets><mesh name=\"cube\" file=\"cube.off\"/>\n"
    "<spheres name=\"ball\" file=\"ball.spheres\"/><tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets>\n"
    "<bodies>\n"
    "<body name=\"floor\" role=\"unmovable\" position=\"0 -1 0\">" BALL "</body>\n"
    "<body name=\"organ\"><mechanical geometry=\"cells\"><corotational_tetrahedra/></mechanical>" BALL "</body>\n"
    "<body name=\"skin\" position=\"1 0 0\"><mechanical geometry=\"cube\" "
    "integrator=\"symplectic_euler\"><mass_spring_net/>"
    "</mechanical></body>\n"
    "<body name=\"stone\" position=\"2 0 0\" rotation=\"0 0 1.5707963267948966\" velocity=\"0 0 3\">"
    "<mechanical geometry=\"cube\"><rigid_body/></mechanical></body>\n"
    "<body name=\"probe\" role=\"active\" position=\"3 0 0\">" BALL "</body>\n"
    "</bodies>\n"
    "<links><pin name=\"anchor\" body=\"organ\" point=\"-0.05 -0.05 -0.05\" radius=\"0.01\"/>"
    "<spring name=\"thread\" body_a=\"stone\" point_a=\"2 0 0\" point_b=\"2 1 0\"/></links>\n"
    "<tools><probe name=\"tool\" body=\"probe\" device=\"hand\"/><camera name=\"eye\"/></tools>\n"
    "<devices><track name=\"hand\" file=\"hand.track\"/></devices>\n"
    "</spore>\n";
static const char hand_track[] = "spore-track 1\ndevice probe\n0 3 0 0 1 0 0 0 0 0\n1 4 0 0 1 0 0 0 0 0\n";

static SporeSimulation *compile(SporeDocument *document, const SporeTrack *input) {
  GError *error = NULL;
  SporeSimulation *simulation = spore_simulation_new(document, NULL, input, NULL, &error);
  g_assert_no_error(error);
  return simulation;
}

static void run(SporeSimulation *simulation, int steps) {
  for (int i = 0; i < steps; i++) spore_world_step(simulation->world);
}

static void test_everything(void) {
  g_autofree char *folder = fixture_scene_folder_new(everything);
  g_free(fixture_write(folder, "hand.track", hand_track));
  SporeDocument *document = fixture_load(folder);
  SporeSimulation *simulation = compile(document, NULL);
  SporeWorld *world = simulation->world;
  g_assert_cmpuint(spore_world_body_count(world), ==, 5);
  const SporeRole roles[] = {SPORE_UNMOVABLE, SPORE_PASSIVE, SPORE_PASSIVE, SPORE_PASSIVE, SPORE_ACTIVE};
  for (guint32 i = 0; i < 5; i++) {
    SporeObject *body = spore_object_child(spore_document_section(document, "bodies"), i);
    guint32 index = spore_world_find_body(world, spore_object_name(body));
    g_assert_cmpuint(spore_simulation_body_of(simulation, body), ==, index);
    g_assert_cmpuint(simulation->body_object[index], ==, spore_object_id(body));
    g_assert_cmpint(spore_world_body_role(world, index), ==, roles[i]);
  }
  SporeObject *model = spore_document_by_path(document, "bodies/organ/mechanical/corotational_tetrahedra");
  g_assert_cmpuint(spore_simulation_body_of(simulation, model), ==, spore_world_find_body(world, "organ"));
  g_assert_cmpuint(spore_simulation_body_of(simulation, spore_document_by_path(document, "solver")), ==, SPORE_NO_BODY);
  guint32 stone = spore_world_find_body(world, "stone"), probe = spore_world_find_body(world, "probe");
  const double *q = spore_world_q(world, stone);
  g_assert_cmpfloat_with_epsilon(q[0], 2, 1e-12);
  g_assert_cmpfloat_with_epsilon(fabs(q[3]), sqrt(0.5), 1e-12); /* a quarter turn about z */
  g_assert_cmpfloat_with_epsilon(fabs(q[6]), sqrt(0.5), 1e-12);
  g_assert_cmpfloat(spore_world_v(world, stone)[2], ==, 3);
  run(simulation, 500);
  g_assert_cmpfloat_with_epsilon(spore_world_q(world, probe)[0], 3.5, 2e-3); /* the track moved it */
  g_assert_cmpfloat_with_epsilon(spore_world_time_s(world), 0.5, 1e-9);
  g_assert_cmpuint(spore_world_monitor(world)->recoveries, ==, 0);
  spore_simulation_free(simulation);
  spore_document_free(document);
  fixture_folder_free(g_steal_pointer(&folder));
}

/* Scenes that cannot run. */
typedef struct Bad {
  const char *name, *text, *place, *says;
} Bad;

#define BODIES(content) ASSETS "<bodies>\n" content "</bodies>\n</spore>"
#define WITH(bodies, sections) ASSETS "<bodies>\n" bodies "</bodies>\n" sections "\n</spore>"
#define MODEL(geometry, model) BODIES("<body name=\"b\"><mechanical" geometry "><" model "/></mechanical></body>")
#define PROBE "<body name=\"p\" role=\"active\"/>"

#define CUBE(name)                                                                                                     \
  "<body name=\"" name "\"><mechanical geometry=\"cells\"><neo_hookean_tetrahedra/></mechanical></body>\n"

#define LEVEL(fidelity)                                                                                                \
  BODIES("<body name=\"b\"><mechanical geometry=\"cube\"><finite_differences/></mechanical>\n" fidelity "</body>")

static const Bad bad[] = {
    {"level-no-setting", LEVEL("<fidelity><coarse settings=\"cells 3\"/></fidelity>"), "6:11",
     "\"cells\" is no setting"},
    {"level-no-parameter", LEVEL("<fidelity><coarse settings=\"cels=3\"/></fidelity>"), "6:11",
     "did you mean \"cells\"?"},
    {"level-out-of-range", LEVEL("<fidelity><coarse settings=\"cells=0\"/></fidelity>"), "6:11", "out of range"},
    {"level-other-body", LEVEL("<fidelity><medium settings=\"young_modulus=3\"/></fidelity>"), "6:11",
     "young_modulus says what the body is, and not how finely it is made"},
    {"level-missing", LEVEL("<fidelity level=\"medium\"><coarse settings=\"cells=3\"/></fidelity>"), "6:1",
     "there is no such level; expected <medium>"},
    {"level-geometry", LEVEL("<fidelity><coarse geometry=\"cells\"/></fidelity>"), "6:11", "needs a mesh"},
    {"level-unmoved", BODIES("<body name=\"b\" role=\"unmovable\">\n<fidelity><coarse/></fidelity></body>"), "6:11",
     "does not move by physics, so that it has no levels"},
    {"no-mechanical", BODIES("<body name=\"b\"/>"), "5:1", "no mechanical model"},
    {"no-model", BODIES("<body name=\"b\"><mechanical/></body>"), "5:1", "no mechanical model"},
    {"no-geometry", MODEL("", "corotational_tetrahedra"), "5:16", "generate them and name them here"},
    {"no-mesh", MODEL("", "rigid_body"), "5:16", "expected a mesh"},
    {"geometry-missing", MODEL(" geometry=\"cub\"", "rigid_body"), "5:16", "did you mean \"cube\"?"},
    {"geometry-far", MODEL(" geometry=\"wholly-other\"", "rigid_body"), "5:16",
     "names nothing; expected the name of a <mesh|tetrahedra|curve>"},
    {"mesh-for-tetrahedra", MODEL(" geometry=\"cube\"", "corotational_tetrahedra"), "5:16",
     "needs tetrahedra; generate them"},
    {"tetrahedra-for-mesh", MODEL(" geometry=\"cells\"", "mass_spring_net"), "5:16", "needs a mesh"},
    {"geometry-of-wrong-kind", MODEL(" geometry=\"ball\"", "rigid_body"), "5:16", "geometry=\"ball\" names nothing"},
    {"open-solid", MODEL(" geometry=\"open\"", "rigid_body"), "5:16", "is not closed (4 open"},
    {"spheres-missing", BODIES("<body name=\"b\" role=\"active\"><collision spheres=\"bal\"/></body>"), "5:30",
     "did you mean \"ball\"?"},
    {"spheres-are-mesh", BODIES("<body name=\"b\" role=\"active\"><collision spheres=\"cube\"/></body>"), "5:30",
     "expected the name of a <spheres>"},
    {"asset-missing",
     "<spore version=\"1.0\"><assets><mesh name=\"m\" file=\"gone.off\"/></assets><bodies><body name=\"b\"><mechanical "
     "geometry=\"m\"><rigid_body/></mechanical></body></bodies></spore>",
     "1:30", "there is no file \"gone.off\""},
    {"pin-without-body", WITH(PROBE, "<links><pin name=\"l\"/></links>"), "6:8", "the link \"l\" has no body"},
    {"pin-body-missing", WITH(PROBE, "<links><pin name=\"l\" body=\"q\"/></links>"), "6:8", "body=\"q\" names nothing"},
    {"seam-of-one", WITH(PROBE, "<links><seam name=\"l\" body_a=\"p\"/></links>"), "6:8", "names fewer"},
    {"seam-without-nodes", WITH(PROBE CUBE("q"), "<links><seam name=\"l\" body_a=\"p\" body_b=\"q\"/></links>"), "7:8",
     "no node of \"p\" lies within 1e-06 m of one of \"q\""},
    {"spring-without-body", WITH(PROBE, "<links><spring name=\"l\" body_b=\"p\"/></links>"), "6:8", "has no body_a"},
    {"pin-holds-nothing",
     WITH("<body name=\"b\"><mechanical geometry=\"cells\"><corotational_tetrahedra/></mechanical></body>\n",
          "<links><pin name=\"l\" body=\"b\" point=\"9 9 9\"/></links>"),
     "7:8", ""},
    {"tool-body-not-active",
     WITH("<body name=\"f\" role=\"unmovable\"/>", "<tools><probe name=\"t\" body=\"f\"/></tools>"), "6:8",
     "is not active"},
    {"tool-device-missing", WITH(PROBE, "<tools><probe name=\"t\" body=\"p\" device=\"d\"/></tools>"), "6:8",
     "names nothing"},
    {"track-missing",
     WITH(PROBE, "<tools><probe name=\"t\" body=\"p\" device=\"d\"/></tools>\n<devices><track name=\"d\" "
                 "file=\"d.track\"/></devices>"),
     "7:10", "d.track"},
    {"track-broken",
     WITH(PROBE, "<tools><probe name=\"t\" body=\"p\" device=\"d\"/></tools>\n<devices><track name=\"d\" "
                 "file=\"cube.off\"/></devices>"),
     "7:10", "cube.off:1"},
    {"track-of-another",
     WITH(PROBE, "<tools><probe name=\"t\" body=\"p\" device=\"d\"/></tools>\n<devices><track name=\"d\" "
                 "file=\"two.track\"/></devices>"),
     "7:10", "no channel \"p\""},
    {"two-tools",
     WITH(PROBE,
          "<tools><probe name=\"t\" body=\"p\" device=\"d\"/><probe name=\"u\" body=\"p\" device=\"d\"/></tools>\n"
          "<devices><track name=\"d\" file=\"one.track\"/></devices>"),
     "6:45", "two tools move"},
};

static void test_bad(gconstpointer data) {
  const Bad *one = data;
  g_autofree char *folder = fixture_scene_folder_new(one->text);
  g_free(fixture_write(folder, "one.track", "spore-track 1\ndevice x\n0 0 0 0 1 0 0 0 0 0\n"));
  g_free(fixture_write(folder, "two.track",
                       "spore-track 1\ndevice x\n0 0 0 0 1 0 0 0 0 0\ndevice y\n0 0 0 0 1 0 0 0 0 0\n"));
  SporeDocument *document = fixture_load(folder);
  GError *error = NULL;
  g_assert_null(spore_simulation_new(document, NULL, NULL, NULL, &error));
  g_test_message("%s", error->message);
  g_autofree char *place = g_strdup_printf("%s:%s: ", spore_document_file(document), one->place);
  if (!g_str_has_prefix(error->message, place)) g_error("\"%s\" is not at %s", error->message, one->place);
  g_assert_cmpint(spore_error_exit_status(error), ==, 2);
  fixture_assert_error(error, error->code, one->says);
  spore_document_free(document);
  fixture_folder_free(g_steal_pointer(&folder));
}

/* The place is in the asset, where the fault is. */
static void test_broken_asset(void) {
  g_autofree char *folder =
      fixture_scene_folder_new(BODIES("<body name=\"b\" role=\"active\"><collision spheres=\"ball\"/></body>"));
  g_autofree char *broken = fixture_write(folder, "ball.spheres", "0 0 0 0.05\n0 0 zero 0.05\n");
  SporeDocument *document = fixture_load(folder);
  GError *error = NULL;
  g_assert_null(spore_simulation_new(document, NULL, NULL, NULL, &error));
  g_autofree char *place = g_strdup_printf("%s:2:5: ", broken);
  fixture_assert_error(error, SPORE_ERROR_INPUT, place);
  spore_document_free(document);
  fixture_folder_free(g_steal_pointer(&folder));
}

/* Input. */

static void add_sample(SporeTrack *track, const char *name, double x) {
  SporeTrackChannel *channel = spore_track_add_channel(track, name);
  SporeDeviceState state = {.position = {x, 0, 0}, .orientation = {1, 0, 0, 0}};
  g_assert_true(spore_track_append(channel, 0, &state));
}

/* A cube that hangs from another, half a turn about the upright apart: on each of the four nodes that meet, and the
 * weight comes apart what it holds as far as the stiffness of all of them says. */
static void test_seam(void) {
  static const char text[] =
      ASSETS "<bodies>\n"
             "<body name=\"upper\"><mechanical geometry=\"cells\"><neo_hookean_tetrahedra young_modulus=\"1e5\"/>"
             "</mechanical></body>\n"
             "<body name=\"lower\" position=\"0 -0.1 0\" rotation=\"0 3.14159265358979 0\"><mechanical "
             "geometry=\"cells\"><neo_hookean_tetrahedra young_modulus=\"1e5\" density=\"1000\"/></mechanical></body>\n"
             "</bodies>\n<links><pin name=\"p\" body=\"upper\" point=\"0 0.05 0\" radius=\"0.09\"/>\n"
             "<seam name=\"s\" body_a=\"upper\" body_b=\"lower\" stiffness=\"20000\"/></links></spore>";
  g_autofree char *folder = fixture_scene_folder_new(text);
  SporeDocument *document = fixture_load(folder);
  SporeSimulation *simulation = compile(document, NULL);
  const SporeWorld *world = simulation->world;
  g_assert_cmpuint(spore_world_link_count(world), ==, 4);
  run(simulation, 3000);
  const double *upper = spore_world_q(world, 0), *lower = spore_world_q(world, 1);
  double apart = 0;
  int met = 0;
  for (int i = 0; i < 8; i++)
    for (int k = 0; k < 8; k++) {
      if (fabs(upper[3 * i] - lower[3 * k]) > 0.04 || fabs(upper[3 * i + 2] - lower[3 * k + 2]) > 0.04) continue;
      double gap = upper[3 * i + 1] - lower[3 * k + 1];
      if (fabs(gap) > 0.01) continue;
      apart += gap / 4;
      met++;
    }
  g_assert_cmpint(met, ==, 4);
  g_assert_cmpfloat_with_epsilon(apart, 9.81 / 20000, 1e-6); /* 1 kg */
  g_assert_cmpuint(spore_world_monitor(world)->recoveries, ==, 0);
  spore_simulation_free(simulation);
  spore_document_free(document);
  fixture_folder_free(g_steal_pointer(&folder));
}

static void test_input_replaces(void) {
  g_autofree char *folder = fixture_scene_folder_new(everything);
  g_free(fixture_write(folder, "hand.track", hand_track));
  SporeDocument *document = fixture_load(folder);
  SporeTrack input = {0}, wrong = {0};
  add_sample(&input, "probe", 3.001);
  SporeSimulation *simulation = compile(document, &input);
  run(simulation, 20);
  g_assert_cmpfloat_with_epsilon(spore_world_q(simulation->world, 4)[0], 3.001, 1e-9);
  g_assert_cmpuint(simulation->track->channel_count, ==, 1);
  spore_simulation_free(simulation);
  add_sample(&wrong, "stone", 0);
  GError *error = NULL;
  g_assert_null(spore_simulation_new(document, NULL, &wrong, NULL, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "the input track moves \"stone\"");
  spore_track_clear(&input);
  spore_track_clear(&wrong);
  spore_document_free(document);
  fixture_folder_free(g_steal_pointer(&folder));
}

static void test_no_input(void) {
  g_autofree char *folder = fixture_scene_folder_new(WITH(PROBE, ""));
  SporeDocument *document = fixture_load(folder);
  SporeSimulation *simulation = compile(document, NULL);
  g_assert_null(simulation->track);
  run(simulation, 3);
  spore_simulation_free(simulation);
  spore_document_free(document);
  fixture_folder_free(g_steal_pointer(&folder));
}

static void test_empty(void) {
  SporeDocument *document = spore_document_new(fixture_model_schema());
  SporeSimulation *simulation = compile(document, NULL);
  run(simulation, 3);
  g_assert_cmpuint(spore_world_body_count(simulation->world), ==, 0);
  spore_simulation_free(simulation);
  spore_document_free(document);
}

/* While running. */

static void set(SporeDocument *document, const char *path, const char *property, const char *text) {
  GError *error = NULL;
  spore_document_set_text(document, spore_document_by_path(document, path), property, text, &error);
  g_assert_no_error(error);
}

static gboolean apply(SporeSimulation *simulation, SporeDocument *document, const char *path, const char *property) {
  SporeObject *object = spore_document_by_path(document, path);
  int index = spore_parameter_find(spore_object_type(object)->table, property);
  g_assert_cmpint(index, >=, 0);
  return spore_simulation_apply(simulation, document, object, (guint)index);
}

/* An effect takes the place of physics while it runs, and gives it back; so do advice and its end. */
static void test_apply_effect(void) {
  g_autofree char *folder = fixture_scene_folder_new(everything);
  g_free(fixture_write(folder, "hand.track", hand_track));
  SporeDocument *document = fixture_load(folder);
  SporeSimulation *simulation = compile(document, NULL);
  guint32 stone = spore_world_find_body(simulation->world, "stone");
  SporeObject *body = spore_document_by_path(document, "bodies/stone");
  g_assert_true(spore_fidelity_advise(document, body, TRUE, NULL));
  g_assert_true(apply(simulation, document, "bodies/stone/fidelity", "advice_hash"));
  run(simulation, 1);
  g_assert_true(spore_world_body_is_effect(simulation->world, stone));
  set(document, "bodies/stone", "velocity", "0 0 1"); /* the advice was for another scene */
  g_assert_true(apply(simulation, document, "bodies/stone/fidelity", "advice"));
  run(simulation, 1);
  g_assert_false(spore_world_body_is_effect(simulation->world, stone));
  for (int on = 1; on >= 0; on--) {
    set(document, "bodies/stone/fidelity", "mode", on ? "effect" : "physical");
    g_assert_true(apply(simulation, document, "bodies/stone/fidelity", "mode"));
    run(simulation, 1);
    g_assert_true(spore_world_body_is_effect(simulation->world, stone) == on);
  }
  spore_simulation_free(simulation);
  spore_document_free(document);
  fixture_folder_free(g_steal_pointer(&folder));
}

static void test_apply(void) {
  g_autofree char *folder = fixture_scene_folder_new(everything);
  g_free(fixture_write(folder, "hand.track", hand_track));
  SporeDocument *document = fixture_load(folder);
  SporeSimulation *simulation = compile(document, NULL);
  guint32 stone = spore_world_find_body(simulation->world, "stone");
  set(document, "environment", "gravity", "100 0 0");
  g_assert_true(apply(simulation, document, "environment", "gravity"));
  run(simulation, 2);
  g_assert_cmpfloat(spore_world_v(simulation->world, stone)[0], >, 0.1);
  set(document, "bodies/organ/mechanical/corotational_tetrahedra", "young_modulus", "12345");
  g_assert_true(apply(simulation, document, "bodies/organ/mechanical/corotational_tetrahedra", "young_modulus"));
  set(document, "bodies/organ/collision", "stiffness", "50");
  g_assert_true(apply(simulation, document, "bodies/organ/collision", "stiffness"));
  GError *error = NULL;
  spore_document_insert(document, spore_document_section(document, "defaults"), "contact", NULL, 0, &error);
  set(document, "defaults/contact", "stiffness", "70");
  g_assert_true(apply(simulation, document, "defaults/contact", "stiffness"));
  set(document, "meta", "title", "x");
  g_assert_true(apply(simulation, document, "meta", "title"));
  g_assert_false(apply(simulation, document, "bodies/organ/mechanical", "geometry"));
  g_assert_false(apply(simulation, document, "solver", "time_step"));
  g_assert_false(apply(simulation, document, "bodies/stone", "position"));
  SporeObject *added =
      spore_document_insert(document, spore_document_section(document, "bodies"), "body", "new", 0, &error);
  spore_document_insert(document, added, "collision", NULL, 0, &error);
  g_assert_false(apply(simulation, document, "bodies/new/collision", "stiffness")); /* not in this world */
  run(simulation, 2);
  spore_simulation_free(simulation);
  spore_document_free(document);
  fixture_folder_free(g_steal_pointer(&folder));
}

static void test_carry_over(void) {
  g_autofree char *folder = fixture_scene_folder_new(everything);
  g_free(fixture_write(folder, "hand.track", hand_track));
  SporeDocument *document = fixture_load(folder);
  SporeSimulation *before = compile(document, NULL);
  run(before, 50);
  set(document, "solver", "time_step", "0.002");
  set(document, "bodies/organ", "name", "renamed");
  GError *error = NULL;
  SporeObject *bodies = spore_document_section(document, "bodies");
  g_assert_true(spore_document_move(document, spore_document_by_path(document, "bodies/stone"), bodies, 0, &error));
  SporeSimulation *after = compile(document, NULL);
  spore_simulation_carry_over(after, before);
  for (guint i = 0; i < 2; i++) {
    const char *name = i ? "skin" : "stone";
    guint32 old = spore_world_find_body(before->world, name), new = spore_world_find_body(after->world, name);
    size_t size = spore_world_body_model(after->world, new)->q_count * sizeof(double);
    g_assert_cmpmem(spore_world_q(before->world, old), size, spore_world_q(after->world, new), size);
    g_assert_cmpfloat(spore_world_v(before->world, old)[0], ==, spore_world_v(after->world, new)[0]);
  }
  guint32 renamed = spore_world_find_body(after->world, "renamed"),
          organ = spore_world_find_body(before->world, "organ");
  g_assert_cmpfloat(spore_world_q(after->world, renamed)[22], !=,
                    spore_world_q(before->world, organ)[22]); /* starts anew */
  run(after, 5);
  spore_simulation_free(before);
  spore_simulation_free(after);
  spore_document_free(document);
  fixture_folder_free(g_steal_pointer(&folder));
}

/* A drop of a cubic centimetre, 5 mm above a floor. */
#define FLUID(collision)                                                                                               \
  "<spore version=\"1.0\">\n<solver time_step=\"0.0005\"/>\n"                                                          \
  "<assets><mesh name=\"cube\" file=\"drop.off\"/><spheres name=\"ball\" file=\"ball.spheres\"/>"                      \
  "<spheres name=\"ground\" file=\"ground.spheres\"/></assets>\n<bodies>\n"                                            \
  "<body name=\"blood\" position=\"0 0.01 0\"><mechanical geometry=\"cube\"><lennard_jones particles=\"120\" "         \
  "drag=\"5\"/></mechanical>" collision "</body>\n"                                                                    \
  "<body name=\"floor\" role=\"unmovable\"><collision spheres=\"ground\"/></body>\n</bodies>\n</spore>\n"

static char *fluid_folder_new(const char *scene) {
  char *folder = fixture_scene_folder_new(scene);
  g_free(fixture_write(folder, "drop.off",
                       "OFF\n8 12 0\n-.005 -.005 -.005\n.005 -.005 -.005\n.005 .005 -.005\n-.005 .005 -.005\n-.005 "
                       "-.005 .005\n.005 -.005 .005\n.005 .005 .005\n-.005 .005 .005\n3 0 3 2\n3 0 2 1\n3 4 5 6\n"
                       "3 4 6 7\n3 0 1 5\n3 0 5 4\n3 2 3 7\n3 2 7 6\n3 1 2 6\n3 1 6 5\n3 0 4 7\n3 0 7 3\n"));
  g_autoptr(GString) ground = g_string_new(NULL); /* tops at y = 0 */
  for (int x = -15; x <= 15; x++)
    for (int z = -15; z <= 15; z++) g_string_append_printf(ground, "%g -0.003 %g 0.003\n", 0.002 * x, 0.002 * z);
  g_free(fixture_write(folder, "ground.spheres", ground->str));
  return folder;
}

/* The fluid's own spheres carry it. A particle weighs 8 mg: the contact is as soft as the step can follow. */
static void test_own_spheres(void) {
  g_autofree char *folder = fluid_folder_new(FLUID("<collision stiffness=\"20\"/>"));
  SporeDocument *document = fixture_load(folder);
  SporeSimulation *simulation = compile(document, NULL);
  SporeWorld *world = simulation->world;
  guint32 blood = spore_world_find_body(world, "blood");
  const SporeModel *model = spore_world_body_model(world, blood);
  size_t count = model->block_count;
  double mass = model->block_mass[0];
  g_assert_cmpuint(spore_world_spheres(world)->count, ==, 31 * 31 + count);
  SporeEnergy before = spore_world_energy(world);
  double start = before.kinetic + before.internal + before.gravity + before.contact, most = start, fastest = 0;
  SporeVec3 momentum;
  double lowest, highest, farthest;
  for (int i = 0; i < 4000; i++) {
    spore_world_step(world);
    SporeEnergy energy = spore_world_energy(world);
    most = fmax(most, energy.kinetic + energy.internal + energy.gravity + energy.contact);
    lowest = HUGE_VAL, highest = farthest = 0;
    momentum = (SporeVec3){0, 0, 0};
    for (size_t k = 0; k < count; k++) {
      SporeVec3 p = spore_vec3_load(spore_world_q(world, blood) + 3 * k);
      SporeVec3 v = spore_vec3_load(spore_world_v(world, blood) + 3 * k);
      lowest = fmin(lowest, p.y);
      highest = fmax(highest, p.y);
      farthest = fmax(farthest, fmax(fabs(p.x), fabs(p.z)));
      fastest = fmax(fastest, spore_vec3_length(v));
      momentum = spore_vec3_add_scaled(momentum, mass, v);
    }
  }
  double kinetic = spore_world_energy(world).kinetic, drop = mass * (double)count * 9.81 * 0.005;
  double impulse = mass * (double)count * sqrt(2 * 9.81 * 0.005);
  g_test_message(
      "%zu particles; at the end %.2f to %.2f mm above the floor, within %.2f mm; energy rose by %.2e of the "
      "fall's, kinetic %.2e of it, momentum %.2e of the impact's; up to %.2f m/s; %s",
      count, 1e3 * lowest, 1e3 * highest, 1e3 * farthest, (most - start) / drop, kinetic / drop,
      spore_vec3_length(momentum) / impulse, fastest, spore_world_monitor(world)->messages[0].text);
  g_assert_cmpfloat(lowest, >, 0);
  g_assert_cmpfloat(highest, <, 0.01);
  g_assert_cmpfloat(farthest, <, 0.02);
  g_assert_cmpfloat(most - start, <, 0.05 * drop);
  g_assert_cmpfloat(kinetic, <, 1e-3 * drop);
  g_assert_cmpfloat(spore_vec3_length(momentum), <, 0.01 * impulse);
  spore_simulation_free(simulation);
  spore_document_free(document);
  fixture_folder_free(g_steal_pointer(&folder));
}

/* Spheres that the scene names are kept, and without a collision unit there are none. */
static void test_named_spheres(void) {
  static const struct {
    const char *scene;
    size_t count;
  } cases[] = {{FLUID("<collision spheres=\"ball\"/>"), 1}, {FLUID(""), 0}};
  for (gsize i = 0; i < G_N_ELEMENTS(cases); i++) {
    g_autofree char *folder = fluid_folder_new(cases[i].scene);
    SporeDocument *document = fixture_load(folder);
    SporeSimulation *simulation = compile(document, NULL);
    g_assert_cmpuint(spore_world_spheres(simulation->world)->count, ==, 31 * 31 + cases[i].count);
    spore_simulation_free(simulation);
    spore_document_free(document);
    fixture_folder_free(g_steal_pointer(&folder));
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/compile/everything", test_everything);
  for (guint i = 0; i < G_N_ELEMENTS(bad); i++) {
    g_autofree char *path = g_strconcat("/compile/bad/", bad[i].name, NULL);
    g_test_add_data_func(path, &bad[i], test_bad);
  }
  g_test_add_func("/compile/broken-asset", test_broken_asset);
  g_test_add_func("/compile/seam", test_seam);
  g_test_add_func("/compile/input-replaces", test_input_replaces);
  g_test_add_func("/compile/no-input", test_no_input);
  g_test_add_func("/compile/empty", test_empty);
  g_test_add_func("/compile/apply", test_apply);
  g_test_add_func("/compile/apply-effect", test_apply_effect);
  g_test_add_func("/compile/carry-over", test_carry_over);
  g_test_add_func("/compile/own-spheres", test_own_spheres);
  g_test_add_func("/compile/named-spheres", test_named_spheres);
  return g_test_run();
}
