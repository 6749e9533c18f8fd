/* Steps and metrics made of what is picked: each kind that the schema has gets what its table asks for, and runs. */
#include "core/author/exercise_edits.h"

#include "core/scene/compile.h"
#include "tests/scene/fixture.h"

#define CUBE(name, x)                                                                                                  \
  "<body name=\"" name "\" position=\"" x " 0 0\"><mechanical geometry=\"cube\"><rigid_body/></mechanical>"            \
  "<visual mesh=\"cube\"/></body>"
#define HAND(name) "<body name=\"" name "\" role=\"active\" position=\"0 0.5 0\"><collision spheres=\"ball\"/></body>"

/* A body of each role, and a tool of each kind that a step can name. */
static const char scene_text[] = "<spore version=\"1.0\"><assets><mesh name=\"cube\" file=\"cube.off\"/>"
                                 "<spheres name=\"ball\" file=\"ball.spheres\"/></assets>"
                                 "<bodies>" CUBE("left", "0") CUBE("right", "0.2") HAND("hand") HAND("a")
                                     HAND("b") "<body name=\"blood\" position=\"0 1 0\"><mechanical "
                                               "geometry=\"cube\"><lennard_jones/></mechanical></body>"
                                               "<body name=\"tissue\" position=\"0 2 0\"><mechanical "
                                               "geometry=\"cube\"><mass_spring_net/></mechanical></body></bodies>"
                                               "<tools>%s</tools></spore>\n";
static const char tools[] =
    "<probe name=\"one\" body=\"hand\"/><clamp name=\"two\" body=\"hand\" jaw_a=\"a\" jaw_b=\"b\"/>"
    "<scissors name=\"three\" body=\"hand\" jaw_a=\"a\" jaw_b=\"b\"/><suction name=\"four\" body=\"hand\"/>"
    "<bipolar name=\"five\" body=\"hand\"/><needle name=\"six\" body=\"hand\" tip=\".01 0 0\" middle=\"0 .005 0\" "
    "swage=\"-.01 0 0\"/>"
    "<camera name=\"eye\" position=\"0 0 1\" target=\"0 0 0\"/>";

typedef struct Scene {
  char *folder;
  SporeDocument *document;
  const SporeObject *section;
  SporeLinkEnd ends[2];
} Scene;

static Scene scene_new(const char *with) {
  g_autofree char *text = g_strdup_printf(scene_text, with);
  Scene scene = {.folder = fixture_scene_folder_new(text)};
  scene.document = fixture_load(scene.folder);
  scene.section = spore_document_section(scene.document, "exercise");
  scene.ends[0] = (SporeLinkEnd){spore_document_find(scene.document, "body", "left"), {0.05, 0.01, 0.02}};
  scene.ends[1] = (SporeLinkEnd){spore_document_find(scene.document, "body", "right"), {0.15, 0.01, 0.02}};
  return scene;
}

static void scene_free(Scene *scene) {
  spore_document_free(scene->document);
  fixture_folder_free(scene->folder);
}

static SporeObject *add_step(Scene *scene, const char *element) {
  g_autoptr(GError) error = NULL;
  SporeObject *step = spore_edit_add_step(scene->document, element, scene->ends, 2, &error);
  g_assert_no_error(error);
  g_assert_true(spore_step_is(step) && !spore_metric_is(step));
  return step;
}

static SporeObject *add_metric(Scene *scene, const char *element, const SporeObject *body) {
  g_autoptr(GError) error = NULL;
  SporeObject *metric = spore_edit_add_metric(scene->document, element, body, &error);
  g_assert_no_error(error);
  g_assert_true(spore_metric_is(metric) && !spore_step_is(metric));
  return metric;
}

/* The schema is the list of kinds: one that is new to it is tried here, too. All of them together are an exercise. */
static void test_kinds(void) {
  Scene scene = scene_new(tools);
  const GPtrArray *types = spore_object_type(scene.section)->children;
  g_assert_cmpuint(types->len, ==, 12 + 16);
  for (guint i = 0; i < types->len; i++) {
    const SporeObjectType *type = types->pdata[i];
    gboolean step = spore_event_kind_find(type->element) != NULL,
             place = spore_parameter_find(type->table, "point") >= 0;
    SporeObject *part = step ? add_step(&scene, type->element) : add_metric(&scene, type->element, NULL);
    spore_document_undo(scene.document);
    g_assert_cmpuint(spore_object_child_count(scene.section), ==, i);
    spore_document_redo(scene.document);
    part = spore_object_child(scene.section, i);
    if (!step) continue;
    g_assert_cmpuint(spore_step_end_count(type), ==, g_str_equal(type->element, "bagged") ? 2 : 1);
    g_assert_true(*spore_step_end_doc(type, 0));
    g_autofree char *name = place ? g_strdup(type->element) : g_strdup_printf("left_%s", type->element);
    g_assert_cmpstr(spore_object_name(part), ==, name);
    g_assert_cmpint(spore_object_refers_to(part, scene.ends[0].body), ==, !place);
    g_assert_cmpint(spore_object_refers_to(part, scene.ends[1].body), ==, g_str_equal(type->element, "bagged"));
  }
  g_autoptr(GError) error = NULL;
  g_autoptr(SporeSimulation) simulation = spore_simulation_new(scene.document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  g_assert_cmpuint(spore_exercise_state(simulation->exercise).steps, ==, 12);
  g_assert_cmpuint(spore_exercise_state(simulation->exercise).metrics, ==, 16);
  scene_free(&scene);
}

static void refuses_step(Scene *scene, const char *element, const SporeLinkEnd *ends, guint count, const char *says) {
  GError *error = NULL;
  g_assert_null(spore_edit_add_step(scene->document, element, ends, count, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, says);
}

static void refuses_metric(Scene *scene, const char *element, const char *says) {
  GError *error = NULL;
  g_assert_null(spore_edit_add_metric(scene->document, element, NULL, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, says);
}

static void test_refusals(void) {
  Scene scene = scene_new("<probe name=\"one\" body=\"hand\"/>");
  const SporeLinkEnd beside = {NULL, {0, 1, 0}}, twice[2] = {scene.ends[0], scene.ends[0]};
  refuses_step(&scene, "touched", &beside, 1, "nothing was met there");
  refuses_step(&scene, "touched", NULL, 0, "one more click");
  refuses_step(&scene, "bagged", scene.ends, 1, "one more click");
  refuses_step(&scene, "bagged", twice, 2, "one body");
  refuses_step(&scene, "grasped", scene.ends, 1, "expected one of: grasper clamp");
  refuses_step(&scene, "time_taken", scene.ends, 1, "no step \"time_taken\"");
  refuses_metric(&scene, "touched", "no metric \"touched\"");
  refuses_metric(&scene, "out_of_view", "no camera");
  g_assert_false(spore_document_can_undo(scene.document));
  g_assert_nonnull(spore_edit_add_step(scene.document, "reached", &beside, 1, NULL));
  g_autoptr(GError) error = NULL;
  g_assert_true(spore_document_remove(scene.document, spore_document_find(scene.document, "body", "blood"), &error));
  refuses_metric(&scene, "blood_lost", "no fluid");
  g_assert_true(spore_document_remove(scene.document, spore_document_find(scene.document, "body", "tissue"), &error));
  refuses_metric(&scene, "peak_strain", "no tissue");
  scene_free(&scene);
}

/* A metric is of the body that is selected where it can be. */
static void test_subject(void) {
  Scene scene = scene_new(tools);
  g_assert_true(spore_object_refers_to(add_metric(&scene, "drops", scene.ends[1].body), scene.ends[1].body));
  g_assert_null(spore_object_reference(add_metric(&scene, "drops", NULL), "body"));
  const SporeObject *blood = spore_document_find(scene.document, "body", "blood");
  g_assert_true(spore_object_refers_to(add_metric(&scene, "blood_lost", scene.ends[1].body), blood));
  const SporeObject *tissue = spore_document_find(scene.document, "body", "tissue");
  g_assert_true(spore_object_refers_to(add_metric(&scene, "peak_strain", scene.ends[1].body), tissue));
  scene_free(&scene);
}

static void test_aim(void) {
  Scene scene = scene_new(tools);
  g_autoptr(GError) error = NULL;
  SporeObject *step = add_step(&scene, "touched");
  g_assert_true(spore_document_set_text(scene.document, step, "hint", "Press.", &error));
  g_assert_true(spore_edit_aim_step(scene.document, step, &scene.ends[1], 1, &error));
  g_assert_true(spore_object_refers_to(step, scene.ends[1].body));
  g_assert_cmpstr(spore_object_text(step, "hint"), ==, "Press.");
  spore_document_undo(scene.document);
  g_assert_true(spore_object_refers_to(step, scene.ends[0].body));
  scene_free(&scene);
}

static void assert_order(const Scene *scene, const char *names) {
  g_autoptr(GString) order = g_string_new(NULL);
  for (guint i = 0; i < spore_object_child_count(scene->section); i++)
    g_string_append_printf(order, "%s ", spore_object_name(spore_object_child(scene->section, i)));
  g_assert_cmpstr(order->str, ==, names);
}

/* Steps change places with steps and metrics with metrics, whatever stands between; what is not there is no place. */
static void test_order(void) {
  Scene scene = scene_new(tools);
  g_autoptr(GError) error = NULL;
  SporeObject *first = add_step(&scene, "touched"), *metric = add_metric(&scene, "errors", NULL),
              *second = add_step(&scene, "held");
  g_assert_true(spore_edit_move_part(scene.document, second, -1, &error));
  assert_order(&scene, "left_held left_touched errors ");
  g_assert_false(spore_edit_move_part(scene.document, second, -1, &error));
  g_assert_false(spore_edit_move_part(scene.document, first, 1, &error));
  g_assert_false(spore_edit_move_part(scene.document, metric, -1, &error));
  g_assert_true(spore_edit_move_part(scene.document, second, 1, &error));
  assert_order(&scene, "left_touched left_held errors ");
  spore_document_undo(scene.document);
  assert_order(&scene, "left_held left_touched errors ");
  g_assert_no_error(error);
  scene_free(&scene);
}

/* What waited for a step that goes waits for what that one waited for. */
static void test_remove(void) {
  Scene scene = scene_new(tools);
  g_autoptr(GError) error = NULL;
  SporeObject *first = add_step(&scene, "touched"), *second = add_step(&scene, "held"),
              *third = add_step(&scene, "cut");
  g_assert_true(spore_document_set_text(scene.document, second, "after", "left_touched", &error));
  g_assert_true(spore_document_set_text(scene.document, third, "after", "left_held", &error));
  g_assert_true(spore_edit_remove_part(scene.document, second, &error));
  g_assert_true(spore_object_reference(third, "after") == first);
  g_assert_true(spore_edit_remove_part(scene.document, first, &error));
  g_assert_null(spore_object_text(third, "after"));
  assert_order(&scene, "left_cut ");
  spore_document_undo(scene.document);
  spore_document_undo(scene.document);
  assert_order(&scene, "left_touched left_held left_cut ");
  g_assert_cmpstr(spore_object_text(third, "after"), ==, "left_held");
  g_assert_no_error(error);
  scene_free(&scene);
}

static void test_threshold(void) {
  static const char *const good[][3] = {{"time_taken", "60", "60 s"},
                                        {"time_taken", " 2 min ", "2 min"},
                                        {"economy", "70 %", "70 %"},
                                        {"economy", ".7", ".7"},
                                        {"path_length", "80cm", "80cm"}};
  Scene scene = scene_new(tools);
  for (guint i = 0; i < G_N_ELEMENTS(good); i++) {
    g_autoptr(GError) error = NULL;
    SporeObject *metric = add_metric(&scene, good[i][0], NULL);
    g_assert_true(spore_edit_set_threshold(scene.document, metric, "good", good[i][1], &error));
    g_assert_cmpstr(spore_object_text(metric, "good"), ==, good[i][2]);
    g_assert_true(spore_edit_set_threshold(scene.document, metric, "good", "", &error));
    g_assert_null(spore_object_text(metric, "good"));
    g_assert_no_error(error);
  }
  GError *error = NULL;
  SporeObject *metric = add_metric(&scene, "time_taken", NULL);
  g_assert_false(spore_edit_set_threshold(scene.document, metric, "pass", "60 mm", &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "\"60 mm\" has a unit that this is not measured in; expected \"s\"");
  g_assert_false(spore_edit_set_threshold(scene.document, metric, "pass", "soon", &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "\"soon\" is no number");
  g_assert_null(spore_object_text(metric, "pass"));
  scene_free(&scene);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/exercise_edits/kinds", test_kinds);
  g_test_add_func("/exercise_edits/refusals", test_refusals);
  g_test_add_func("/exercise_edits/subject", test_subject);
  g_test_add_func("/exercise_edits/aim", test_aim);
  g_test_add_func("/exercise_edits/order", test_order);
  g_test_add_func("/exercise_edits/remove", test_remove);
  g_test_add_func("/exercise_edits/threshold", test_threshold);
  return g_test_run();
}
