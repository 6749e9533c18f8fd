/* Bodies are moved, turned and aligned with all that is placed on them, exactly, and nothing else is. */
#include <math.h>

#include "core/author/instrument_edits.h"
#include "core/author/placement.h"
#include "tests/scene/fixture.h"

/* Two blocks and a wall, tied in every way; a wound in the first block, and a camera that stands still. */
static const char blocks[] =
    "<spore version=\"1.0\"><assets><mesh name=\"cube\" file=\"cube.off\"/></assets><bodies>"
    "<body name=\"one\"><mechanical geometry=\"cube\"><rigid_body/></mechanical><visual mesh=\"cube\"/></body>"
    "<body name=\"two\" position=\"0.2 0 0\"><mechanical geometry=\"cube\"><rigid_body/></mechanical>"
    "<visual mesh=\"cube\"/></body>"
    "<body name=\"wall\" role=\"unmovable\" position=\"0 0.3 0.1\"><visual mesh=\"cube\"/></body></bodies><links>"
    "<spring name=\"cord\" body_a=\"one\" point_a=\"0.05 0 0\" body_b=\"two\" point_b=\"0.15 0 0\"/>"
    "<spring name=\"rope\" body_a=\"one\" point_a=\"0 0.05 0\" point_b=\"0 0.1 0\"/>"
    "<ball name=\"joint\" body_a=\"one\" body_b=\"two\" point=\"0.1 0 0\"/>"
    "<hinge name=\"hinge\" body_a=\"one\" point=\"0 -0.05 0\" direction=\"1 0 0\"/>"
    "<pin name=\"pin\" body=\"two\" point=\"0.2 0 0\" radius=\"0.01\"/></links>"
    "<effects><emitter name=\"wound\" body=\"two\" source=\"one\" point=\"0 0 0.05\" direction=\"0 0 1\"/></effects>"
    "<tools><camera name=\"view\" position=\"0 0 1\"/></tools></spore>\n";

static SporePlacement *placement_of(const FixtureScene *scene, const char *first, const char *second) {
  g_autoptr(GPtrArray) bodies = g_ptr_array_new();
  g_ptr_array_add(bodies, spore_document_find(scene->document, "body", first));
  if (second) g_ptr_array_add(bodies, spore_document_find(scene->document, "body", second));
  return spore_placement_new(scene->document, bodies);
}

static SporeVec3 vector(const FixtureScene *scene, const char *path, const char *property) {
  return spore_object_vector(spore_document_by_path(scene->document, path), property);
}

static void assert_at(const FixtureScene *scene, const char *path, const char *property, double x, double y, double z) {
  SporeVec3 at = vector(scene, path, property);
  if (spore_vec3_distance(at, spore_vec3(x, y, z)) > 2e-6)
    g_error("%s %s is %g %g %g, expected %g %g %g", path, property, at.x, at.y, at.z, x, y, z);
}

static void move(SporePlacement *placement, SporePose motion) {
  g_autoptr(GError) error = NULL;
  g_assert_true(spore_placement_move(placement, motion, &error));
  g_assert_no_error(error);
}

static void test_moves(void) {
  FixtureScene scene = fixture_scene_new(blocks);
  g_autofree char *before = fixture_format(scene.document);
  SporePose motion = {{0.01, 0.02, 0.0333333}, {1, 0, 0, 0}};
  spore_document_begin(scene.document, "Move");
  g_autoptr(SporePlacement) placement = placement_of(&scene, "one", NULL);
  move(placement, (SporePose){{1, 1, 1}, {1, 0, 0, 0}});
  move(placement, motion);
  spore_document_end(scene.document);
  assert_at(&scene, "bodies/one", "position", 0.01, 0.02, 0.033333);
  assert_at(&scene, "bodies/two", "position", 0.2, 0, 0);
  assert_at(&scene, "links/cord", "point_a", 0.06, 0.02, 0.033333);
  assert_at(&scene, "links/cord", "point_b", 0.15, 0, 0);
  assert_at(&scene, "links/rope", "point_b", 0, 0.1, 0);
  assert_at(&scene, "links/joint", "point", 0.1, 0, 0); /* ties another body, too */
  assert_at(&scene, "links/hinge", "point", 0.01, -0.03, 0.033333);
  assert_at(&scene, "links/hinge", "direction", 1, 0, 0);
  assert_at(&scene, "links/pin", "point", 0.2, 0, 0);
  assert_at(&scene, "effects/wound", "point", 0.01, 0.02, 0.083333);
  assert_at(&scene, "tools/view", "position", 0, 0, 1);
  spore_document_undo(scene.document);
  g_autofree char *after = fixture_format(scene.document);
  g_assert_cmpstr(after, ==, before);
  fixture_scene_free(&scene);
}

/* A quarter of a turn about z through the middle of both blocks, and back to where they were. */
static void test_turns(void) {
  FixtureScene scene = fixture_scene_new(blocks);
  g_autofree char *before = fixture_format(scene.document);
  g_autoptr(SporePlacement) placement = placement_of(&scene, "one", "two");
  SporeVec3 middle = spore_placement_middle(placement);
  g_assert_cmpfloat_with_epsilon(middle.x, 0.1, 1e-12);
  SporePose turn = {{0, 0, 0}, spore_quat_from_rotation_vector(spore_vec3(0, 0, 0.5 * G_PI))};
  turn.position = spore_vec3_sub(middle, spore_quat_rotate(turn.orientation, middle));
  spore_document_begin(scene.document, "Turn");
  move(placement, turn);
  assert_at(&scene, "bodies/one", "position", 0.1, -0.1, 0);
  assert_at(&scene, "bodies/one", "rotation", 0, 0, 0.5 * G_PI);
  assert_at(&scene, "bodies/two", "position", 0.1, 0.1, 0);
  assert_at(&scene, "links/joint", "point", 0.1, 0, 0);
  assert_at(&scene, "links/cord", "point_b", 0.1, 0.05, 0);
  assert_at(&scene, "links/hinge", "direction", 0, 1, 0);
  assert_at(&scene, "effects/wound", "direction", 0, 0, 1);
  move(placement, spore_pose_identity());
  spore_document_end(scene.document);
  assert_at(&scene, "bodies/one", "rotation", 0, 0, 0);
  assert_at(&scene, "links/hinge", "direction", 1, 0, 0);
  spore_document_undo(scene.document);
  g_autofree char *after = fixture_format(scene.document);
  g_assert_cmpstr(after, ==, before);
  fixture_scene_free(&scene);
}

/* An instrument goes with its jaws, its hinge and its port, whichever part is taken. */
static void test_instrument(void) {
  const SporeVec3 entry = {0, 0.3, 0}, target = {0, 0.05, 0};
  static const char *const taken[] = {"grasper_1", "grasper_1_jaw_b"};
  for (gsize i = 0; i < 2; i++) {
    FixtureScene scene = fixture_scene_new(blocks);
    g_assert_nonnull(spore_edit_add_instrument(scene.document, spore_instrument_find("grasper"), NULL,
                                               (SporeInstrumentPlaces){&entry, &target}, NULL));
    SporeVec3 hinge = vector(&scene, "tools/grasper_1", "hinge"),
              jaw = vector(&scene, "bodies/grasper_1_jaw_a", "position");
    g_autoptr(SporePlacement) placement = placement_of(&scene, taken[i], NULL);
    move(placement, (SporePose){{0.1, 0, 0}, {1, 0, 0, 0}});
    assert_at(&scene, "tools/grasper_1", "hinge", hinge.x + 0.1, hinge.y, hinge.z);
    assert_at(&scene, "bodies/grasper_1_jaw_a", "position", jaw.x + 0.1, jaw.y, jaw.z);
    assert_at(&scene, "links/grasper_1_port", "point", 0.1, 0.3, 0);
    assert_at(&scene, "bodies/one", "position", 0, 0, 0);
    fixture_scene_free(&scene);
  }
}

/* A bag goes with the film that hangs on it; a block that is tied to it and to a wall, too, stays. */
static void test_bag(void) {
  const SporeVec3 entry = {0, 0.4, 0.3}, target = {0, 0.05, 0};
  FixtureScene scene = fixture_scene_new(blocks);
  g_assert_nonnull(spore_edit_add_instrument(scene.document, spore_instrument_find("bag"), NULL,
                                             (SporeInstrumentPlaces){&entry, &target}, NULL));
  SporeObject *rope = spore_document_by_path(scene.document, "links/rope");
  g_assert_true(spore_document_set_text(scene.document, rope, "body_b", "bag_1", NULL));
  SporeVec3 film = vector(&scene, "bodies/bag_1_film", "position"), tie = vector(&scene, "links/bag_1_1", "point");
  g_autoptr(SporePlacement) placement = placement_of(&scene, "bag_1", NULL);
  move(placement, (SporePose){{0.1, 0, 0}, {1, 0, 0, 0}});
  assert_at(&scene, "bodies/bag_1_film", "position", film.x + 0.1, film.y, film.z);
  assert_at(&scene, "links/bag_1_1", "point", tie.x + 0.1, tie.y, tie.z);
  assert_at(&scene, "bodies/one", "position", 0, 0, 0);
  fixture_scene_free(&scene);
}

static void test_align(void) {
  for (int axis = 0; axis < 2; axis++) {
    FixtureScene scene = fixture_scene_new(blocks);
    GError *error = NULL;
    g_autoptr(GPtrArray) bodies = g_ptr_array_new();
    g_ptr_array_add(bodies, spore_document_find(scene.document, "body", axis ? "two" : "one"));
    g_assert_false(spore_edit_align(scene.document, bodies, axis, SPORE_ALIGN_LEAST, &error));
    fixture_assert_error(error, SPORE_ERROR_INPUT, "select two bodies or more");
    g_ptr_array_add(bodies, spore_document_find(scene.document, "body", "wall"));
    SporeObject *wall = bodies->pdata[1];
    if (axis == 0) g_assert_true(spore_document_set_text(scene.document, wall, "rotation", "0 0 0.785398", NULL));
    g_assert_true(
        spore_edit_align(scene.document, bodies, axis, axis ? SPORE_ALIGN_MIDDLE : SPORE_ALIGN_GREATEST, NULL));
    double x = axis ? 0 : 0.05 - 0.05 * sqrt(2), y = axis ? 0.0 : 0.3;
    assert_at(&scene, "bodies/wall", "position", x, y, 0.1);
    spore_document_undo(scene.document);
    assert_at(&scene, "bodies/wall", "position", 0, 0.3, 0.1);
    fixture_scene_free(&scene);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/placement/moves", test_moves);
  g_test_add_func("/placement/turns", test_turns);
  g_test_add_func("/placement/instrument", test_instrument);
  g_test_add_func("/placement/bag", test_bag);
  g_test_add_func("/placement/align", test_align);
  return g_test_run();
}
