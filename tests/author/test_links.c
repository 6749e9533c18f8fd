/* Links made of picked ends: each kind that the schema has gets its bodies and its places, as one undo step. */
#include "core/author/link_edits.h"
#include "core/scene/compile.h"
#include "tests/scene/fixture.h"

#define CUBE(name, x)                                                                                                  \
  "<body name=\"" name "\" position=\"" x " 0 0\"><mechanical geometry=\"cube\"><rigid_body/></mechanical>"            \
  "<visual mesh=\"cube\"/></body>"

static const char cubes[] =
    "<spore version=\"1.0\"><assets><mesh name=\"cube\" file=\"cube.off\"/></assets><bodies>" CUBE("left", "0")
        CUBE("right", "0.2") "</bodies></spore>\n";

typedef struct Scene {
  char *folder;
  SporeDocument *document;
  SporeLinkEnd ends[2];
} Scene;

static Scene scene_new(void) {
  Scene scene = {.folder = fixture_scene_folder_new(cubes)};
  scene.document = fixture_load(scene.folder);
  scene.ends[0] = (SporeLinkEnd){spore_document_find(scene.document, "body", "left"), {0.05, 0.01, 0.02}};
  scene.ends[1] = (SporeLinkEnd){spore_document_find(scene.document, "body", "right"), {0.15, 0.01, 0.02}};
  return scene;
}

static void scene_free(Scene *scene) {
  spore_document_free(scene->document);
  fixture_folder_free(scene->folder);
}

static void assert_place(SporeVec3 place, SporeVec3 expected) {
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(place, expected), 0, 1e-9);
}

static void assert_places(const Scene *scene, const SporeObject *link) {
  const char *element = spore_object_type(link)->element;
  SporeVec3 places[SPORE_LINK_MOST_ENDS];
  guint count = spore_link_places(scene->document, link, places);
  gboolean spring = g_str_equal(element, "spring"), port = g_str_equal(element, "port");
  g_assert_cmpuint(count, ==, g_str_equal(element, "pin") ? 1 : 2);
  if (g_str_equal(element, "seam")) { /* the middles of the bodies */
    g_assert_cmpfloat_with_epsilon(spore_vec3_distance(places[0], places[1]), 0.2, 1e-9);
    return;
  }
  assert_place(places[0], scene->ends[port].place);
  if (count > 1) assert_place(places[1], scene->ends[spring || port].place);
}

/* The schema is the list of kinds: one that is new to it is tried here, too. */
static void test_kinds(void) {
  Scene scene = scene_new();
  const SporeObject *section = spore_document_section(scene.document, "links");
  const GPtrArray *types = spore_object_type(section)->children;
  g_assert_cmpuint(types->len, ==, 8);
  for (guint i = 0; i < types->len; i++) {
    const SporeObjectType *type = types->pdata[i];
    guint count = spore_link_end_count(type);
    g_autoptr(GError) error = NULL;
    SporeObject *link = spore_edit_add_link(scene.document, type->element, scene.ends, count, &error);
    g_assert_no_error(error);
    g_assert_true(spore_link_is(link));
    g_autofree char *name = g_strdup_printf("left_%s", type->element);
    g_assert_cmpstr(spore_object_name(link), ==, name);
    g_assert_true(spore_object_refers_to(link, scene.ends[0].body));
    g_assert_cmpint(spore_object_refers_to(link, scene.ends[1].body), ==, count > 1);
    assert_places(&scene, link);
    spore_document_undo(scene.document);
    g_assert_cmpuint(spore_object_child_count(section), ==, 0);
  }
  scene_free(&scene);
}

/* What is made runs: of each kind but the seam, whose bodies share no nodes here. */
static void test_runs(void) {
  Scene scene = scene_new();
  const GPtrArray *types = spore_object_type(spore_document_section(scene.document, "links"))->children;
  for (guint i = 0; i < types->len; i++) {
    const SporeObjectType *type = types->pdata[i];
    g_autoptr(GError) error = NULL;
    if (g_str_equal(type->element, "seam")) continue;
    spore_edit_add_link(scene.document, type->element, scene.ends, spore_link_end_count(type), &error);
    g_assert_no_error(error);
    SporeSimulation *simulation = spore_simulation_new(scene.document, NULL, NULL, NULL, &error);
    g_assert_no_error(error);
    spore_simulation_free(simulation);
    spore_document_undo(scene.document);
  }
  scene_free(&scene);
}

static void test_names(void) {
  Scene scene = scene_new();
  g_autoptr(GError) error = NULL;
  SporeObject *first = spore_edit_add_link(scene.document, "ball", scene.ends, 2, &error);
  SporeObject *second = spore_edit_add_link(scene.document, "ball", scene.ends, 1, &error);
  g_assert_no_error(error);
  g_assert_cmpstr(spore_object_name(first), ==, "left_ball");
  g_assert_cmpstr(spore_object_name(second), ==, "left_ball-2");
  g_assert_false(spore_object_refers_to(second, scene.ends[1].body));
  scene_free(&scene);
}

static void refuses(Scene *scene, const char *element, const SporeLinkEnd *ends, guint count, const char *part) {
  GError *error = NULL;
  guint64 revision = spore_document_revision(scene->document);
  g_assert_null(spore_edit_add_link(scene->document, element, ends, count, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, part);
  g_assert_cmpuint(spore_document_revision(scene->document), ==, revision);
}

static void test_refusals(void) {
  Scene scene = scene_new();
  const SporeLinkEnd nowhere = {NULL, {0, 0.1, 0}}, same[2] = {scene.ends[0], {scene.ends[0].body, {0, 0.05, 0}}};
  refuses(&scene, "spring", &nowhere, 1, "click on a body first");
  refuses(&scene, "spring", NULL, 0, "click on a body first");
  refuses(&scene, "weld", same, 2, "both ends are of one body");
  refuses(&scene, "seam", scene.ends, 1, "a seam joins two bodies");
  refuses(&scene, "sprng", scene.ends, 2, "did you mean spring?");
  g_assert_false(spore_document_can_undo(scene.document));
  scene_free(&scene);
}

/* Other ends, the same stiffness. */
static void test_tie_elsewhere(void) {
  Scene scene = scene_new();
  const SporeLinkEnd other[2] = {scene.ends[1], {NULL, {0.2, 0.3, 0}}};
  g_autoptr(GError) error = NULL;
  SporeVec3 places[SPORE_LINK_MOST_ENDS];
  SporeObject *link = spore_edit_add_link(scene.document, "spring", scene.ends, 2, &error);
  g_assert_true(spore_document_set_text(scene.document, link, "stiffness", "7", &error));
  g_assert_true(spore_edit_tie_link(scene.document, link, other, 2, &error));
  g_assert_no_error(error);
  g_assert_cmpfloat(spore_object_number(link, "stiffness"), ==, 7);
  g_assert_false(spore_object_refers_to(link, scene.ends[0].body));
  g_assert_cmpuint(spore_link_places(scene.document, link, places), ==, 2);
  assert_place(places[1], other[1].place);
  spore_document_undo(scene.document);
  g_assert_true(spore_object_refers_to(link, scene.ends[0].body));
  GError *refusal = NULL;
  g_assert_false(spore_edit_tie_link(scene.document, link, &other[1], 1, &refusal));
  fixture_assert_error(refusal, SPORE_ERROR_INPUT, "click on a body first");
  scene_free(&scene);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/links/kinds", test_kinds);
  g_test_add_func("/links/runs", test_runs);
  g_test_add_func("/links/names", test_names);
  g_test_add_func("/links/refusals", test_refusals);
  g_test_add_func("/links/tie-elsewhere", test_tie_elsewhere);
  return g_test_run();
}
