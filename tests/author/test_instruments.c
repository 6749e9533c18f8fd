/* The library of instruments: each has geometry that is whole, stands where it is asked to, and makes a scene that
 * runs. */
#include <math.h>

#include "core/author/instrument_edits.h"
#include "core/io/off.h"
#include "core/math/quat.h"
#include "core/scene/camera_sight.h"
#include "core/scene/compile.h"
#include "tests/scene/fixture.h"

/* A soft block that physics moves, its top at y = 0.05, and an unmovable one that is nearer to the entries. */
static const char blocks[] =
    "<spore version=\"1.0\"><assets><mesh name=\"cube\" file=\"cube.off\"/></assets><bodies>"
    "<body name=\"organ\"><mechanical geometry=\"cube\"><mass_spring_net/></mechanical><visual mesh=\"cube\"/></body>"
    "<body name=\"wall\" role=\"unmovable\" position=\"0 0.05 0\"><visual mesh=\"cube\"/></body>"
    "</bodies></spore>\n";

static SporeObject *add(const FixtureScene *scene, const char *kind, const SporeVec3 *entry, const SporeVec3 *target) {
  g_autoptr(GError) error = NULL;
  SporeObject *body = spore_edit_add_instrument(scene->document, spore_instrument_find(kind), NULL,
                                                (SporeInstrumentPlaces){entry, target}, &error);
  g_assert_no_error(error);
  return body;
}

static SporeVec3 tip_of(const SporeObject *body, const char *kind) {
  return spore_pose_apply(spore_body_pose(body), spore_instrument_tip(spore_instrument_find(kind)));
}

/* Distance of a point from the line through a along a unit vector. */
static double off_line(SporeVec3 point, SporeVec3 a, SporeVec3 along) {
  return spore_vec3_length(spore_vec3_cross(spore_vec3_sub(point, a), along));
}

#define ROUNDED 2e-4 /* m: places are written to a tenth of a millimetre, angles to a tenth of a milliradian */

static double volume_of(const SporeInstrumentKind *instrument, SporeInstrumentPart part, double lower[3],
                        double upper[3]) {
  gsize size;
  g_autofree char *text = spore_instrument_mesh(instrument, part, 0.1, &size);
  g_autoptr(GError) error = NULL;
  SporeTriangleMesh mesh = {0};
  SporeMeshReport report;
  g_assert_true(spore_off_parse(instrument->name, text, size, &mesh, &error));
  g_assert_true(spore_triangle_mesh_report(&mesh, &report, NULL));
  g_assert_true(report.closed);
  for (int k = 0; k < 3; k++) lower[k] = HUGE_VAL, upper[k] = -HUGE_VAL;
  for (size_t i = 0; i < 3 * mesh.vertex_count; i++) {
    lower[i % 3] = fmin(lower[i % 3], mesh.vertices[i]);
    upper[i % 3] = fmax(upper[i % 3], mesh.vertices[i]);
  }
  spore_triangle_mesh_clear(&mesh);
  return report.volume;
}

/* Meshes are closed and outward; a jaw lies on its side of the plane where the jaws meet, and ends at the tip. */
static void test_geometry(void) {
  for (const SporeInstrumentKind *one = spore_instruments; one->name; one++) {
    double lower[3], upper[3];
    g_assert_cmpfloat(volume_of(one, SPORE_PART_SHAFT, lower, upper), >, 0);
    if (one->head != SPORE_HEAD_ARC) g_assert_cmpfloat_with_epsilon(upper[1], 0.1, 1e-9);
    if (!spore_instrument_has_jaws(one)) continue;
    g_assert_cmpfloat(volume_of(one, SPORE_PART_JAW_A, lower, upper), >, 0);
    g_assert_cmpfloat(upper[2], <=, 1e-9);
    g_assert_cmpfloat_with_epsilon(lower[1], spore_instrument_tip(one).y, 1e-9);
    g_assert_cmpfloat(volume_of(one, SPORE_PART_JAW_B, lower, upper), >, 0);
    g_assert_cmpfloat(lower[2], >=, -1e-9);
  }
}

/* Places between which instruments stand upright, nearly so, upside down, level and askew. */
static const SporeVec3 entries[] = {
    {0.05, 0.3, 0.05}, {0.0501, 0.3, 0.05}, {0.05, -0.3, 0.05}, {0.4, 0.1, 0.05}, {-0.1, 0.25, 0.2}};
static const SporeVec3 targets[] = {
    {0.05, 0.1, 0.05}, {0.05, 0.1, 0.05}, {0.05, -0.1, 0.05}, {0.05, 0.1, 0.05}, {0.03, 0.1, 0.02}};

/* The shaft comes from the entry, and the tip stands the clearance before the target. What looks aside meets the
 * target, and looks no higher than its shaft points. */
static void assert_stands(const SporeObject *body, const SporeInstrumentKind *kind, SporeVec3 entry, SporeVec3 target) {
  SporePose pose = spore_body_pose(body);
  SporeVec3 shaft = spore_quat_rotate(pose.orientation, (SporeVec3){0, -1, 0}), tip = tip_of(body, kind->name);
  SporeVec3 ahead = spore_quat_rotate(pose.orientation, (SporeVec3){0, -cos(kind->look_rad), -sin(kind->look_rad)});
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(tip, target), kind->clearance, ROUNDED);
  g_assert_cmpfloat_with_epsilon(off_line(tip, entry, shaft), 0, ROUNDED);
  g_assert_cmpfloat(spore_vec3_dot(spore_vec3_sub(tip, entry), shaft), >, 0);
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(spore_vec3_add_scaled(tip, kind->clearance, ahead), target), 0,
                                 ROUNDED);
  gboolean upright = spore_vec3_length(spore_vec3_cross(shaft, (SporeVec3){0, 1, 0})) < 0.3;
  if (!upright) g_assert_cmpfloat(ahead.y, <=, shaft.y * cos(kind->look_rad) + 1e-3);
}

/* What is shown beforehand ends at the tip, and begins outside the entry or at the end of the needle's thread. */
static void assert_outline(const SporeObject *body, const SporeInstrumentKind *kind, const SporeVec3 *line,
                           guint points) {
  g_assert_cmpuint(points, ==, kind->head == SPORE_HEAD_ARC ? SPORE_OUTLINE_POINTS : 2);
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(line[points - 1], tip_of(body, kind->name)), 0, ROUNDED);
  SporeVec3 begins = spore_pose_apply_inverse(spore_body_pose(body), line[0]);
  if (kind->head == SPORE_HEAD_ARC) g_assert_cmpfloat_with_epsilon(begins.x, -kind->head_radius, ROUNDED);
  else g_assert_cmpfloat(begins.y, >, 0.1);
}

static void test_stands(void) {
  FixtureScene scene = fixture_scene_new(blocks);
  for (const SporeInstrumentKind *one = spore_instruments; one->name; one++)
    for (gsize i = 0; i < G_N_ELEMENTS(entries); i++) {
      g_autofree char *before = fixture_format(scene.document);
      SporeVec3 line[SPORE_OUTLINE_POINTS];
      guint points =
          spore_instrument_outline(scene.document, one, (SporeInstrumentPlaces){&entries[i], &targets[i]}, line);
      SporeObject *body = add(&scene, one->name, &entries[i], &targets[i]);
      assert_stands(body, one, entries[i], targets[i]);
      assert_outline(body, one, line, points);
      spore_document_undo(scene.document);
      g_autofree char *after = fixture_format(scene.document);
      g_assert_cmpstr(after, ==, before);
    }
  fixture_scene_free(&scene);
}

static SporeObject *tool_of(const FixtureScene *scene, const SporeObject *body) {
  SporeObject *tools = spore_document_section(scene->document, "tools");
  for (guint i = 0; i < spore_object_child_count(tools); i++) {
    SporeObject *tool = spore_object_child(tools, i);
    if (g_strcmp0(spore_object_text(tool, "body"), spore_object_name(body)) == 0 &&
        spore_parameter_find(spore_object_type(tool)->table, "device") >= 0)
      return tool;
  }
  return NULL;
}

static void assert_port(const FixtureScene *scene, const SporeObject *body, const SporeInstrumentKind *kind,
                        SporeVec3 entry) {
  const SporeObject *links = spore_document_section(scene->document, "links");
  const SporeObject *port = spore_object_child_of(links, "port");
  g_assert_cmpuint(spore_object_child_count(links), ==,
                   kind->head == SPORE_HEAD_ARC    ? 0
                   : kind->head == SPORE_HEAD_HOOP ? 14
                                                   : 1);
  if (kind->head == SPORE_HEAD_ARC) return;
  g_assert_true(spore_object_refers_to(port, body));
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(spore_object_vector(port, "point"), entry), 0, ROUNDED);
}

/* Each one has a tool of its kind that the mouse moves, is drawn as a mesh, goes through its port, and runs. */
static void test_runs(void) {
  FixtureScene scene = fixture_scene_new(blocks);
  for (const SporeInstrumentKind *one = spore_instruments; one->name; one++) {
    SporeObject *body = add(&scene, one->name, &entries[4], &targets[4]);
    const SporeObject *tool = tool_of(&scene, body);
    g_assert_cmpstr(spore_object_type(tool)->element, ==, one->tool);
    g_assert_cmpstr(spore_object_type(spore_object_reference(tool, "device"))->element, ==, "mouse");
    g_assert_nonnull(spore_object_text(spore_object_child_of(body, "visual"), "mesh"));
    assert_port(&scene, body, one, entries[4]);
    g_autoptr(GError) error = NULL;
    SporeSimulation *simulation = spore_simulation_new(scene.document, NULL, NULL, NULL, &error);
    g_assert_no_error(error);
    SporeVec3 before = spore_body_pose(body).position;
    for (int step = 0; step < 3; step++) spore_world_step(simulation->world);
    const double *q = spore_world_q(simulation->world, spore_simulation_body_of(simulation, body));
    g_assert_cmpfloat_with_epsilon(spore_vec3_distance(spore_vec3_load(q), before), 0, 1e-9);
    spore_simulation_free(simulation);
    spore_document_undo(scene.document);
  }
  fixture_scene_free(&scene);
}

/* Where nothing is said: above the highest point; at what physics moves, be something else nearer; straight down. */
static void test_defaults(void) {
  FixtureScene scene = fixture_scene_new(blocks);
  g_assert_cmpfloat_with_epsilon(tip_of(add(&scene, "grasper", NULL, NULL), "grasper").y, 0.11, ROUNDED);
  g_assert_cmpuint(spore_object_child_count(spore_document_section(scene.document, "links")), ==, 0);
  SporeVec3 entry = {0.1, 0.4, 0.1}, corner = {0.05, 0.05, 0.05};
  SporeVec3 tip = tip_of(add(&scene, "suction", &entry, NULL), "suction");
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(tip, corner), 0.01, ROUNDED);
  SporeObject *camera = spore_document_find(scene.document, "camera", "endoscope_30_1_view");
  g_assert_null(camera);
  SporeObject *body = add(&scene, "endoscope_30", &entry, &corner);
  camera = spore_document_find(scene.document, "camera", "endoscope_30_1_view");
  g_assert_true(spore_object_reference(camera, "body") == body);
  SporeCameraFields fields;
  spore_object_fields(camera, &fields);
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(spore_camera_sight(&fields), corner), 0, ROUNDED);
  g_assert_cmpfloat(fields.distortion, ==, 0.2);
  fixture_scene_free(&scene);
}

/* The pose of the instrument after a device has led it 30 mm aside. */
static SporePose led_aside(const FixtureScene *scene, SporeObject *body) {
  SporePose pose = spore_body_pose(body);
  SporeTrack track = {0};
  SporeTrackChannel *channel = spore_track_add_channel(&track, spore_object_name(body));
  SporeDeviceState state = {0};
  for (int i = 0; i < 2; i++) {
    spore_vec3_store(state.position, spore_vec3_add(pose.position, (SporeVec3){0.03 * i, 0, 0}));
    spore_quat_store(state.orientation, pose.orientation);
    g_assert_true(spore_track_append(channel, 0.05 * i, &state));
  }
  g_autoptr(GError) error = NULL;
  SporeSimulation *simulation = spore_simulation_new(scene->document, NULL, &track, NULL, &error);
  g_assert_no_error(error);
  while (spore_world_time_s(simulation->world) < 0.1) spore_world_step(simulation->world);
  const double *q = spore_world_q(simulation->world, spore_simulation_body_of(simulation, body));
  pose = spore_pose_load(q);
  spore_simulation_free(simulation);
  spore_track_clear(&track);
  return pose;
}

/* Led aside, the shaft turns about the place where it enters; one without an entry does not turn. */
static void test_port(void) {
  FixtureScene scene = fixture_scene_new(blocks);
  const SporeVec3 up = {0, 1, 0};
  SporePose pose = led_aside(&scene, add(&scene, "grasper", &entries[0], &targets[0]));
  SporeVec3 shaft = spore_quat_rotate(pose.orientation, up);
  g_assert_cmpfloat(spore_vec3_length(spore_vec3_cross(shaft, up)), >, 0.1);
  g_assert_cmpfloat_with_epsilon(off_line(pose.position, entries[0], shaft), 0, ROUNDED);
  SporePose loose = led_aside(&scene, add(&scene, "grasper", NULL, NULL));
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(spore_quat_rotate(loose.orientation, up), up), 0, 1e-9);
  fixture_scene_free(&scene);
}

static guint asset_count(const FixtureScene *scene) {
  return spore_object_child_count(spore_document_section(scene->document, "assets"));
}

/* The second one of a kind has its own name, and the meshes, spheres and mouse of the first. */
static void test_names(void) {
  FixtureScene scene = fixture_scene_new(blocks);
  SporeObject *first = add(&scene, "clamp", &entries[0], &targets[0]);
  guint assets = asset_count(&scene);
  SporeObject *second = add(&scene, "clamp", &entries[0], &targets[0]);
  g_assert_cmpstr(spore_object_name(first), ==, "clamp_1");
  g_assert_cmpstr(spore_object_name(second), ==, "clamp_2");
  g_assert_cmpstr(spore_object_name(tool_of(&scene, second)), ==, "clamp_2");
  g_assert_cmpuint(asset_count(&scene), ==, assets);
  g_assert_cmpuint(spore_object_child_count(spore_document_section(scene.document, "devices")), ==, 1);
  fixture_scene_free(&scene);
}

/* As near as may be, and a little nearer. */
static void test_refusals(void) {
  FixtureScene scene = fixture_scene_new(blocks);
  SporeVec3 target = {0.05, 0.1, 0.05}, near = {0.05, 0.1278, 0.05}, enough = {0.05, 0.1282, 0.05};
  GError *error = NULL;
  g_assert_null(spore_edit_add_instrument(scene.document, spore_instrument_find("grasper"), NULL,
                                          (SporeInstrumentPlaces){&near, &target}, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "choose places that are farther apart");
  g_assert_false(spore_document_can_undo(scene.document));
  SporeVec3 line[SPORE_OUTLINE_POINTS];
  g_assert_cmpuint(spore_instrument_outline(scene.document, spore_instrument_find("grasper"),
                                            (SporeInstrumentPlaces){&near, &target}, line),
                   ==, 0);
  SporeVec3 tip = tip_of(add(&scene, "grasper", &enough, &target), "grasper");
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(tip, target), 0.0051, ROUNDED);
  g_assert_null(spore_instrument_find("graspr"));
  fixture_scene_free(&scene);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/instruments/geometry", test_geometry);
  g_test_add_func("/instruments/stands", test_stands);
  g_test_add_func("/instruments/runs", test_runs);
  g_test_add_func("/instruments/defaults", test_defaults);
  g_test_add_func("/instruments/port", test_port);
  g_test_add_func("/instruments/names", test_names);
  g_test_add_func("/instruments/refusals", test_refusals);
  return g_test_run();
}
