/* Ports: what an instrument reaches through one, and what goes with one that is moved. */
#include <math.h>

#include "core/author/instrument_edits.h"
#include "core/author/port_edits.h"
#include "core/math/quat.h"
#include "core/scene/camera_sight.h"
#include "core/scene/compile.h"
#include "core/scene/run_hash.h"
#include "tests/scene/fixture.h"

#define ROUNDED 3e-4 /* m: places are written to a tenth of a millimetre, angles to a tenth of a milliradian */

/* A cube of 0.1 m about the origin. */
static const char cube[] = "<spore version=\"1.0\"><assets><mesh name=\"cube\" file=\"cube.off\"/></assets><bodies>"
                           "<body name=\"organ\" role=\"unmovable\"><visual mesh=\"cube\"/></body></bodies></spore>\n";

typedef struct Scene {
  char *folder;
  SporeDocument *document;
  SporeObject *body, *port;
} Scene;

static const SporeVec3 target = {0, 0.05, 0};

static Scene scene_new(const char *kind, SporeVec3 entry) {
  g_autoptr(GError) error = NULL;
  Scene scene = {.folder = fixture_scene_folder_new(cube)};
  scene.document = fixture_load(scene.folder);
  scene.body = spore_edit_add_instrument(scene.document, spore_instrument_find(kind), "tool",
                                         (SporeInstrumentPlaces){&entry, &target}, &error);
  g_assert_no_error(error);
  scene.port = spore_document_find(scene.document, "port", "tool_port");
  g_assert_nonnull(scene.port);
  return scene;
}

static void scene_free(Scene *scene) {
  spore_document_free(scene->document);
  fixture_folder_free(scene->folder);
}

static SporePortReach reach_of(const Scene *scene) {
  SporePortReach reach;
  g_assert_true(spore_port_reach(scene->document, scene->port, &reach));
  return reach;
}

#define assert_near(a, b) g_assert_cmpfloat(spore_vec3_distance(a, b), <, ROUNDED)

/* The cone ends at its angle, and at its least and greatest depth. */
static void test_cone(void) {
  Scene scene = scene_new("grasper", (SporeVec3){0, 0.2, 0});
  SporePortReach reach = reach_of(&scene);
  g_assert_cmpstr(spore_object_name(reach.tool), ==, "tool");
  assert_near(reach.pivot, ((SporeVec3){0, 0.2, 0}));
  assert_near(reach.along, ((SporeVec3){0, -1, 0}));
  assert_near(reach.tip, ((SporeVec3){0, 0.06, 0})); /* a centimetre before the target */
  for (int side = 0; side < 4; side++) {
    SporeVec3 across = {cos(side * G_PI / 2), 0, sin(side * G_PI / 2)};
    for (int out = 0; out < 2; out++) {
      double angle = G_PI / 4 + (out ? 1e-3 : -1e-3);
      SporeVec3 way = spore_vec3_add_scaled(spore_vec3_scale(sin(angle), across), -cos(angle), (SporeVec3){0, 1, 0});
      g_assert_cmpint(spore_port_reaches(&reach, spore_vec3_add_scaled(reach.pivot, 0.1, way)), ==, !out);
    }
  }
  const struct {
    double depth;
    gboolean reached;
  } depths[] = {{-0.1, FALSE}, {0.019, FALSE}, {0.021, TRUE}, {0.299, TRUE}, {0.301, FALSE}};
  for (guint i = 0; i < G_N_ELEMENTS(depths); i++)
    g_assert_cmpint(
        spore_port_reaches(&reach, spore_vec3_add_scaled(reach.pivot, depths[i].depth, (SporeVec3){0, -1, 0})), ==,
        depths[i].reached);
  scene_free(&scene);
}

static void set(const Scene *scene, const char *property, const char *value) {
  g_autoptr(GError) error = NULL;
  spore_document_set_text(scene->document, scene->port, property, value, &error);
  g_assert_no_error(error);
}

/* A port of its own reach; a run is the same with it. */
static void test_own_reach(void) {
  Scene scene = scene_new("probe", (SporeVec3){0, 0.2, 0});
  SporePortReach reach = reach_of(&scene);
  SporeVec3 aside = {0.09, 0.1, 0}, deep = {0, -0.11, 0};
  g_assert_true(spore_port_reaches(&reach, aside));
  g_assert_false(spore_port_reaches(&reach, deep));
  guint64 hash = spore_document_run_hash(scene.document);
  set(&scene, "reach_angle", "0.5");
  set(&scene, "reach_most", "0.35");
  set(&scene, "reach_least", "0.1");
  reach = reach_of(&scene);
  g_assert_false(spore_port_reaches(&reach, aside));
  g_assert_true(spore_port_reaches(&reach, deep));
  g_assert_false(spore_port_reaches(&reach, (SporeVec3){0, 0.11, 0}));
  g_assert_cmpuint(spore_document_run_hash(scene.document), ==, hash);
  set(&scene, "friction", "0.5");
  g_assert_cmpuint(spore_document_run_hash(scene.document), !=, hash);
  scene_free(&scene);
}

/* The lines of a cone lie at its angle and between its depths, the last one on the shaft. */
static void test_lines(void) {
  Scene scene = scene_new("probe", (SporeVec3){0, 0.2, 0});
  SporePortReach reach = reach_of(&scene);
  double points[6 * SPORE_PORT_LINES];
  spore_port_lines(&reach, points);
  for (guint i = 0; i < 2 * (SPORE_PORT_LINES - 1); i++) {
    SporeVec3 way = spore_vec3_sub(spore_vec3_load(points + 3 * i), reach.pivot);
    double depth = spore_vec3_length(way);
    g_assert_cmpfloat(depth, >, 0.02 - 1e-9);
    g_assert_cmpfloat(depth, <, 0.3 + 1e-9);
    g_assert_cmpfloat_with_epsilon(-way.y / depth, cos(G_PI / 4), 1e-9);
  }
  assert_near(spore_vec3_load(points + 6 * (SPORE_PORT_LINES - 1)), reach.pivot);
  assert_near(spore_vec3_load(points + 6 * (SPORE_PORT_LINES - 1) + 3), reach.tip);
  scene_free(&scene);
}

static double share_of(const Scene *scene) {
  double share = -1;
  SporePortReach reach = reach_of(scene);
  g_assert_true(
      spore_ports_share(scene->document, &reach, 1, spore_document_find(scene->document, "body", "organ"), &share));
  return share;
}

/* From above, all of the cube lies in the cone; from afar, its top alone is within the greatest depth; from near, its
 * bottom alone within the angle. */
static void test_share(void) {
  static const struct {
    SporeVec3 entry;
    double share;
  } cases[] = {{{0, 0.2, 0}, 1}, {{0, 0.3, 0}, 0.5}, {{0, 0.075, 0}, 0.5}};
  for (guint i = 0; i < G_N_ELEMENTS(cases); i++) {
    Scene scene = scene_new("probe", cases[i].entry);
    g_assert_cmpfloat_with_epsilon(share_of(&scene), cases[i].share, 1e-9);
    scene_free(&scene);
  }
}

/* What one of several ports reaches is reached: from above the top, from below the bottom. */
static void test_share_of_several(void) {
  Scene scene = scene_new("probe", (SporeVec3){0, 0.3, 0});
  SporeObject *organ = spore_document_find(scene.document, "body", "organ");
  SporePortReach ports[2] = {reach_of(&scene), reach_of(&scene)};
  double share;
  ports[1].pivot.y = -0.3, ports[1].along.y = 1;
  g_assert_true(spore_ports_share(scene.document, ports, 2, organ, &share));
  g_assert_cmpfloat_with_epsilon(share, 1, 1e-9);
  g_assert_true(spore_ports_share(scene.document, ports + 1, 1, organ, &share));
  g_assert_cmpfloat_with_epsilon(share, 0.5, 1e-9);
  g_assert_true(spore_ports_share(scene.document, NULL, 0, organ, &share));
  g_assert_cmpfloat(share, ==, 0);
  scene_free(&scene);
}

static void test_sentences(void) {
  Scene scene = scene_new("grasper", (SporeVec3){0, 0.3, 0});
  SporeObject *organ = spore_document_find(scene.document, "body", "organ");
  const SporeObject *const asked[] = {organ, scene.port, scene.body,
                                      spore_document_find(scene.document, "grasper", "tool"),
                                      spore_document_find(scene.document, "body", "tool_jaw_a")};
  for (guint i = 0; i < G_N_ELEMENTS(asked); i++) {
    g_autofree char *text = spore_port_sentences(scene.document, asked[i]);
    g_assert_cmpstr(text, ==,
                    "\"tool\" reaches 50 % of \"organ\" through \"tool_port\"\nWhat lies in the way is not looked at.");
  }
  g_assert_null(spore_port_sentences(scene.document, spore_document_section(scene.document, "assets")));
  g_autofree char *none = spore_port_share_text(0), *little = spore_port_share_text(1e-4),
                  *most = spore_port_share_text(0.9999), *all = spore_port_share_text(1);
  g_assert_cmpstr(none, ==, "nothing");
  g_assert_cmpstr(little, ==, "1 %");
  g_assert_cmpstr(most, ==, "99 %");
  g_assert_cmpstr(all, ==, "all");
  scene_free(&scene);
}

/* Distance of a point from the line of the shaft. */
static double off_shaft(const Scene *scene, SporeVec3 point) {
  SporePose pose = spore_body_pose(scene->body);
  SporeVec3 along = spore_quat_rotate(pose.orientation, (SporeVec3){0, 1, 0});
  return spore_vec3_length(spore_vec3_cross(spore_vec3_sub(point, pose.position), along));
}

/* The tip stays, the shaft passes through the new port, jaws and hinge stay at its end; one step of undo. */
static void test_move(void) {
  g_autoptr(GError) error = NULL;
  Scene scene = scene_new("grasper", (SporeVec3){0, 0.2, 0});
  const SporeVec3 to = {0.1, 0.17, -0.07};
  SporeObject *tool = spore_document_find(scene.document, "grasper", "tool");
  SporeObject *jaw = spore_document_find(scene.document, "body", "tool_jaw_b");
  SporeVec3 tip = reach_of(&scene).tip;
  g_autofree char *before = fixture_format(scene.document);
  g_assert_true(spore_edit_move_port(scene.document, scene.port, to, &error));
  g_assert_no_error(error);
  assert_near(spore_object_vector(scene.port, "point"), to);
  g_assert_cmpfloat(off_shaft(&scene, to), <, ROUNDED);
  assert_near(reach_of(&scene).tip, tip);
  assert_near(spore_object_vector(tool, "hinge"), spore_body_pose(scene.body).position);
  assert_near(spore_body_pose(jaw).position, spore_body_pose(scene.body).position);
  assert_near(spore_object_vector(tool, "axis"),
              spore_quat_rotate(spore_body_pose(scene.body).orientation, (SporeVec3){1, 0, 0}));
  assert_near(spore_object_vector(scene.port, "direction"),
              spore_quat_rotate(spore_body_pose(scene.body).orientation, (SporeVec3){0, 1, 0}));
  spore_document_undo(scene.document);
  g_autofree char *after = fixture_format(scene.document);
  g_assert_cmpstr(after, ==, before);
  scene_free(&scene);
}

static SporeVec3 sight_of(const SporeObject *camera) {
  SporeCameraFields fields = {.angle = spore_object_number(camera, "angle"),
                              .turn = spore_object_number(camera, "turn")};
  spore_vec3_store(fields.position, spore_object_vector(camera, "position"));
  spore_vec3_store(fields.target, spore_object_vector(camera, "target"));
  return spore_camera_sight(&fields);
}

/* An endoscope goes on looking at the same place, aside of its shaft or not, and its camera stays at its end. */
static void test_move_endoscope(void) {
  static const char *const kinds[] = {"endoscope", "endoscope_30"};
  for (guint i = 0; i < G_N_ELEMENTS(kinds); i++) {
    g_autoptr(GError) error = NULL;
    Scene scene = scene_new(kinds[i], (SporeVec3){0, 0.2, 0.05});
    const SporeVec3 to = {-0.09, 0.19, 0.07};
    SporeObject *camera = spore_document_find(scene.document, "camera", "tool_view");
    assert_near(sight_of(camera), target);
    g_assert_true(spore_edit_move_port(scene.document, scene.port, to, &error));
    g_assert_no_error(error);
    assert_near(sight_of(camera), target);
    assert_near(spore_object_vector(camera, "position"), spore_body_pose(scene.body).position);
    g_assert_cmpfloat(off_shaft(&scene, to), <, ROUNDED);
    scene_free(&scene);
  }
}

/* Nothing changes where the shaft cannot turn, or where no instrument passes. */
static void test_refused(void) {
  g_autoptr(GError) error = NULL;
  Scene scene = scene_new("probe", (SporeVec3){0, 0.2, 0});
  SporeVec3 tip = reach_of(&scene).tip;
  g_autofree char *before = fixture_format(scene.document);
  g_assert_false(spore_edit_move_port(scene.document, scene.port, tip, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "choose one farther away");
  g_autofree char *after = fixture_format(scene.document);
  g_assert_cmpstr(after, ==, before);
  g_assert_true(spore_document_set_text(scene.document, scene.port, "body_a", "organ", &error));
  g_assert_false(spore_edit_move_port(scene.document, scene.port, (SporeVec3){0, 0.3, 0}, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "no instrument passes through it");
  scene_free(&scene);
}

/* In a run, the moved instrument stands where the scene says: the port turns it no farther. */
static void test_runs(void) {
  g_autoptr(GError) error = NULL;
  Scene scene = scene_new("grasper", (SporeVec3){0, 0.2, 0});
  g_assert_true(spore_edit_move_port(scene.document, scene.port, (SporeVec3){0.1, 0.17, -0.07}, &error));
  g_autoptr(SporeSimulation) simulation = spore_simulation_new(scene.document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  for (int i = 0; i < 3; i++) spore_world_step(simulation->world);
  const SporeSnapshot *now = spore_world_snapshot_acquire(simulation->world);
  guint32 body = spore_simulation_body_of(simulation, scene.body);
  SporeVec3 at = spore_vec3_load(now->q + spore_world_q_offset(simulation->world, body));
  assert_near(at, spore_body_pose(scene.body).position);
  scene_free(&scene);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/author/ports/cone", test_cone);
  g_test_add_func("/author/ports/own_reach", test_own_reach);
  g_test_add_func("/author/ports/lines", test_lines);
  g_test_add_func("/author/ports/share", test_share);
  g_test_add_func("/author/ports/share_of_several", test_share_of_several);
  g_test_add_func("/author/ports/sentences", test_sentences);
  g_test_add_func("/author/ports/move", test_move);
  g_test_add_func("/author/ports/move_endoscope", test_move_endoscope);
  g_test_add_func("/author/ports/refused", test_refused);
  g_test_add_func("/author/ports/runs", test_runs);
  return g_test_run();
}
