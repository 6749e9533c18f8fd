/* Organs are made soft in one step: what each gets, what is kept, what is refused, and that one step takes it back. */
#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "core/author/soft_edits.h"
#include "core/scene/compile.h"
#include "tests/scene/fixture.h"

#define ORGAN(name, x, more)                                                                                           \
  "<body name=\"" name "\" role=\"unmovable\" position=\"" x " 0 0\">" more "<visual mesh=\"cube\"/></body>"

static const char organs[] =
    "<spore version=\"1.0\"><assets><mesh name=\"cube\" file=\"cube.off\"/><mesh name=\"sheet\" file=\"sheet.off\"/>"
    "<spheres name=\"ball\" file=\"ball.spheres\"/></assets><bodies>" ORGAN("liver", "0", "")
        ORGAN("thing", "0.3", "<collision spheres=\"ball\"/>")
            ORGAN("stone", "0.6", "<mechanical geometry=\"cube\"><rigid_body/></mechanical>")
                ORGAN("spleen_2", "0.9", "") "<body name=\"flat\" role=\"unmovable\"><visual mesh=\"sheet\"/></body>"
                                             "<body name=\"hook\" role=\"active\"><visual mesh=\"cube\"/></body>" ORGAN(
                                                 "fifth", "1.2",
                                                 "") "<body name=\"bare\" role=\"unmovable\"/></bodies></spore>\n";

typedef struct Scene {
  char *folder;
  SporeDocument *document;
  GPtrArray *bodies;
} Scene;

static SporeObject *body_named(const Scene *scene, const char *name) {
  return spore_document_find(scene->document, "body", name);
}

/* names: separated by blanks. */
static Scene scene_new(const char *names) {
  Scene scene = {.folder = fixture_scene_folder_new(organs), .bodies = g_ptr_array_new()};
  scene.document = fixture_load(scene.folder);
  g_auto(GStrv) all = g_strsplit(names, " ", -1);
  for (char **name = all; *name; name++) g_ptr_array_add(scene.bodies, body_named(&scene, *name));
  return scene;
}

static void scene_free(Scene *scene) {
  spore_document_free(scene->document);
  fixture_folder_free(scene->folder);
  g_ptr_array_unref(scene->bodies);
}

/* Few cells and spheres, which are made soon. */
static SporeSoftWork *coarse_of(const Scene *scene) {
  g_autoptr(GError) error = NULL;
  SporeSoftWork *work = spore_soft_work_new(scene->document, scene->bodies, &error);
  g_assert_no_error(error);
  for (guint i = 0; i < work->organs->len; i++) {
    SporeSoftOrgan *organ = work->organs->pdata[i];
    spore_generate_set_count(&organ->tetrahedra->options, 60);
    if (organ->spheres) spore_generate_set_count(&organ->spheres->options, 8);
  }
  return work;
}

static SporeSoftWork *run_of(const Scene *scene) {
  g_autoptr(GError) error = NULL;
  SporeSoftWork *work = coarse_of(scene);
  g_assert_true(spore_soft_work_run(work, NULL, &error));
  g_assert_no_error(error);
  return work;
}

static const char *material_of(const Scene *scene, const char *body) {
  const SporeObject *mechanical = spore_object_child_of(body_named(scene, body), "mechanical");
  return spore_material_names[(int)spore_object_number(mechanical, "material")];
}

static void assert_soft(const Scene *scene, const char *name) {
  SporeObject *body = body_named(scene, name);
  g_assert_nonnull(spore_edit_body_tetrahedra(scene->document, body));
  g_assert_nonnull(spore_edit_body_spheres(scene->document, body));
  g_assert_nonnull(spore_body_model_object(body));
  g_assert_cmpint((int)spore_object_number(body, "role"), ==, SPORE_PASSIVE);
}

static guint pins_of(const Scene *scene, const char *name) {
  const SporeObject *links = spore_document_section(scene->document, "links");
  guint count = 0;
  for (guint i = 0; i < spore_object_child_count(links); i++)
    count += spore_object_refers_to(spore_object_child(links, i), body_named(scene, name));
  return count;
}

static const double *colour_of(const Scene *scene, const char *name) {
  const SporeObject *visual = spore_object_child_of(body_named(scene, name), "visual");
  return spore_object_value(visual, (guint)spore_parameter_find(spore_object_type(visual)->table, "colour"))->number;
}

/* Each organ gets its units; the tissue and the colour are those of its name; the whole is one step, and runs. */
static void test_several(void) {
  Scene scene = scene_new("liver thing liver spleen_2");
  g_autofree char *before = fixture_format(scene.document);
  g_autoptr(GError) error = NULL;
  SporeSoftWork *work = run_of(&scene);
  g_assert_cmpuint(work->organs->len, ==, 3);
  g_assert_true(spore_soft_work_apply(work, scene.document, &error));
  g_assert_no_error(error);
  for (guint i = 0; i < 3; i++) {
    const SporeSoftOrgan *organ = work->organs->pdata[i];
    assert_soft(&scene, organ->name);
    g_assert_cmpuint(pins_of(&scene, organ->name), ==, 1);
  }
  g_assert_cmpstr(material_of(&scene, "liver"), ==, "liver");
  g_assert_cmpstr(material_of(&scene, "spleen_2"), ==, "spleen");
  g_assert_cmpstr(material_of(&scene, "thing"), ==, "none");
  g_assert_cmpfloat_with_epsilon(colour_of(&scene, "liver")[0], 0.52, 1e-9);
  g_assert_cmpfloat_with_epsilon(colour_of(&scene, "spleen_2")[2], 0.24, 1e-9);
  const SporeObject *ball = spore_document_find(scene.document, "spheres", "ball");
  g_assert_true(spore_edit_body_spheres(scene.document, body_named(&scene, "thing")) == ball);
  SporeSimulation *simulation = spore_simulation_new(scene.document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  for (int i = 0; i < 20; i++) spore_world_step(simulation->world);
  spore_simulation_free(simulation);
  spore_document_undo(scene.document);
  g_autofree char *after = fixture_format(scene.document);
  g_assert_cmpstr(after, ==, before);
  g_assert_false(spore_document_can_undo(scene.document));
  spore_soft_work_free(work);
  scene_free(&scene);
}

/* Cells and spheres are shared by all organs of a step, in equal parts. */
static void assert_counts(const char *names, guint cells, guint spheres) {
  Scene scene = scene_new(names);
  g_autoptr(GError) error = NULL;
  SporeSoftWork *work = spore_soft_work_new(scene.document, scene.bodies, &error);
  g_assert_no_error(error);
  const SporeSoftOrgan *organ = work->organs->pdata[0];
  g_assert_cmpuint(spore_generate_get_count(&organ->tetrahedra->options), ==, cells);
  g_assert_cmpuint(spore_generate_get_count(&organ->spheres->options), ==, spheres);
  spore_soft_work_free(work);
  scene_free(&scene);
}

static void test_share(void) {
  assert_counts("liver", 1000, 60);
  assert_counts("liver thing spleen_2", 1000, 60);
  assert_counts("liver thing spleen_2 flat fifth", 600, 48);
}

static void refuses(const char *name, const char *says) {
  Scene scene = scene_new(name);
  GError *error = NULL;
  g_assert_null(spore_soft_work_new(scene.document, scene.bodies, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, says);
  scene_free(&scene);
}

static void test_refused(void) {
  refuses("hook", "a hand leads the body");
  refuses("stone", "has the model rigid_body already");
  refuses("bare", "shows no mesh");
  refuses("liver stone", "has the model rigid_body already");
}

/* A sheet has no inside: it is left out, says why, and the liver beside it is made soft. Alone it is an error. */
static void test_left_out(void) {
  Scene scene = scene_new("flat liver"), alone = scene_new("flat");
  GError *error = NULL;
  SporeSoftWork *work = run_of(&scene);
  const SporeSoftOrgan *flat = work->organs->pdata[0], *liver = work->organs->pdata[1];
  g_assert_nonnull(flat->refused);
  g_assert_null(liver->refused);
  g_autofree char *text = spore_soft_organ_text(flat);
  g_assert_nonnull(strstr(text, flat->refused->message));
  g_assert_true(spore_soft_work_apply(work, scene.document, &error));
  assert_soft(&scene, "liver");
  g_assert_null(spore_body_model_object(body_named(&scene, "flat")));
  spore_soft_work_free(work);
  work = spore_soft_work_new(alone.document, alone.bodies, &error);
  g_assert_false(spore_soft_work_run(work, NULL, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "");
  spore_soft_work_free(work);
  scene_free(&scene);
  scene_free(&alone);
}

typedef struct Watch {
  guint calls, most; /* most: calls before it is cancelled */
  double last;
  gboolean names;
} Watch;

static bool watch(void *data, double fraction, const char *stage) {
  Watch *seen = data;
  g_assert_cmpfloat(fraction, >=, seen->last - 1e-9);
  g_assert_cmpfloat(fraction, <=, 1 + 1e-9);
  seen->last = fraction;
  seen->names = seen->names || (stage && g_str_has_prefix(stage, "spleen_2"));
  return ++seen->calls < seen->most;
}

/* Progress rises over all organs and says which one; a cancelled run is an error, and nothing else. */
static void test_progress(void) {
  Scene scene = scene_new("liver spleen_2");
  GError *error = NULL;
  Watch whole = {.most = G_MAXUINT}, few = {.most = 3};
  SporeSoftWork *work = coarse_of(&scene);
  g_assert_true(spore_soft_work_run(work, &(SporeProgress){.report = watch, .data = &whole}, &error));
  g_assert_cmpuint(whole.calls, >, 3);
  g_assert_true(whole.names);
  g_assert_cmpfloat(whole.last, >, 0.5);
  spore_soft_work_free(work);
  work = coarse_of(&scene);
  g_assert_false(spore_soft_work_run(work, &(SporeProgress){.report = watch, .data = &few}, &error));
  fixture_assert_error(error, SPORE_ERROR_CANCELLED, "");
  spore_soft_work_free(work);
  g_assert_false(spore_document_can_undo(scene.document));
  scene_free(&scene);
}

/* A body that a link holds gets no pin; a mesh that changed meanwhile drops the whole. */
static void test_meanwhile(void) {
  Scene scene = scene_new("liver spleen_2");
  GError *error = NULL;
  SporeSoftWork *work = run_of(&scene);
  SporeObject *pin =
      spore_document_insert(scene.document, spore_document_section(scene.document, "links"), "pin", "p", 0, &error);
  g_assert_true(spore_document_set_text(scene.document, pin, "body", "liver", &error));
  g_assert_true(spore_soft_work_apply(work, scene.document, &error));
  g_assert_cmpuint(pins_of(&scene, "liver"), ==, 1);
  g_assert_cmpuint(pins_of(&scene, "spleen_2"), ==, 1);
  spore_document_undo(scene.document);
  SporeObject *visual = spore_object_child_of(body_named(&scene, "spleen_2"), "visual");
  g_assert_true(spore_document_set_text(scene.document, visual, "mesh", "sheet", &error));
  g_autofree char *before = fixture_format(scene.document);
  g_assert_false(spore_soft_work_apply(work, scene.document, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "changed meanwhile");
  g_autofree char *after = fixture_format(scene.document);
  g_assert_cmpstr(after, ==, before);
  spore_soft_work_free(work);
  scene_free(&scene);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/soft/several", test_several);
  g_test_add_func("/soft/share", test_share);
  g_test_add_func("/soft/refused", test_refused);
  g_test_add_func("/soft/left_out", test_left_out);
  g_test_add_func("/soft/progress", test_progress);
  g_test_add_func("/soft/meanwhile", test_meanwhile);
  return g_test_run();
}
