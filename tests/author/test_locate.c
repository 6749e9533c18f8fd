/* Missing files are found again where they lie now, all of a folder in one step that undoes exactly; a file that is not
 * the one that is missing is refused, and nothing changes. */
#include "core/author/locate.h"
#include "core/io/organ.h"
#include "tests/scene/fixture.h"

/* The cube's spheres were made from another content than open.off has. */
static const char scene_text[] =
    "<spore version=\"1.0\"><assets><mesh name=\"cube\" file=\"gone/cube.off\"/>"
    "<spheres name=\"ball\" file=\"gone/ball.spheres\" source=\"cube\" source_hash=\"%s\"/>"
    "<mesh name=\"there\" file=\"wide.off\"/><curve name=\"line\" file=\"gone/nowhere.curve\"/></assets><bodies>"
    "<body name=\"wall\" role=\"unmovable\"><collision spheres=\"ball\"/><visual mesh=\"cube\"/></body></bodies>"
    "</spore>\n";

typedef struct {
  char *folder, *elsewhere; /* of the scene; of the files */
  SporeDocument *document;
} Fixture;

static char *hash_of_cube(void) {
  FixtureScene scene =
      fixture_scene_new("<spore version=\"1.0\"><assets><mesh name=\"cube\" file=\"cube.off\"/></assets></spore>\n");
  char *hash = spore_document_asset_hash(scene.document, spore_document_by_path(scene.document, "assets/cube"));
  fixture_scene_free(&scene);
  return hash;
}

static void set_up(Fixture *fixture, gconstpointer data) {
  g_autofree char *hash = hash_of_cube();
  g_autofree char *text = g_strdup_printf(scene_text, hash);
  fixture->elsewhere = fixture_scene_folder_new("<spore version=\"1.0\"/>\n");
  fixture->folder = fixture_scene_folder_new(text);
  fixture->document = fixture_load(fixture->folder);
}

static void tear_down(Fixture *fixture, gconstpointer data) {
  spore_document_free(fixture->document);
  fixture_folder_free(fixture->folder);
  fixture_folder_free(fixture->elsewhere);
}

static SporeLocateWork *work_new(Fixture *fixture, const char *missing, const char *folder, const char *file) {
  g_autofree char *place = g_build_filename(folder, file, NULL);
  return spore_locate_work_new(fixture->document, missing, place);
}

static void test_taken(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  g_autofree char *before = fixture_format(fixture->document);
  SporeObject *cube = spore_document_by_path(fixture->document, "assets/cube");
  g_autoptr(GPtrArray) missing = spore_missing_files(fixture->document);
  g_assert_cmpuint(missing->len, ==, 3);
  g_assert_cmpstr(missing->pdata[0], ==, "gone/cube.off");
  SporeLocateWork *work = work_new(fixture, "gone/cube.off", fixture->elsewhere, "cube.off");
  g_assert_true(spore_locate_work_run(work, NULL, &error));
  g_assert_no_error(error);
  g_assert_true(spore_locate_work_apply(work, fixture->document, &error));
  g_assert_no_error(error);
  g_assert_cmpuint(spore_locate_work_found(work)->len, ==, 2); /* the spheres lay beside the mesh; the line did not */
  g_autoptr(GPtrArray) left = spore_missing_files(fixture->document);
  g_assert_cmpuint(left->len, ==, 1);
  g_assert_cmpstr(left->pdata[0], ==, "gone/nowhere.curve");
  g_assert_nonnull(spore_document_mesh(fixture->document, cube, &error));
  g_assert_false(spore_locate_work_apply(work, fixture->document, &error)); /* twice */
  fixture_assert_error(error, SPORE_ERROR_INPUT, "not missing any more");
  spore_locate_work_free(work);
  spore_document_undo(fixture->document);
  g_autofree char *after = fixture_format(fixture->document);
  g_assert_cmpstr(after, ==, before);
  g_assert_null(spore_document_mesh(fixture->document, cube, NULL));
}

/* What lies in the scene's folder is named where it lies. */
static void test_inside(Fixture *fixture, gconstpointer data) {
  SporeLocateWork *work = work_new(fixture, "gone/cube.off", fixture->folder, "cube.off");
  g_assert_true(spore_locate_work_run(work, NULL, NULL) && spore_locate_work_apply(work, fixture->document, NULL));
  SporeObject *cube = spore_document_by_path(fixture->document, "assets/cube");
  g_assert_cmpstr(spore_object_text(cube, "file"), ==, "cube.off");
  spore_locate_work_free(work);
}

static void test_refused(Fixture *fixture, gconstpointer data) {
  static const struct {
    const char *missing, *file, *says;
    int code;
  } cases[] = {
      {"gone/cube.off", "open.off", "\"ball\" was made from", SPORE_ERROR_INPUT},
      {"gone/cube.off", "ball.spheres", "ball.spheres: ", SPORE_ERROR_INPUT},
      {"gone/cube.off", "none.off", "cannot be read", SPORE_ERROR_FILE},
      {"wide.off", "wide.off", "no such file is missing", SPORE_ERROR_INPUT},
  };
  g_autofree char *before = fixture_format(fixture->document);
  for (gsize i = 0; i < G_N_ELEMENTS(cases); i++) {
    GError *error = NULL;
    SporeLocateWork *work = work_new(fixture, cases[i].missing, fixture->elsewhere, cases[i].file);
    g_assert_false(spore_locate_work_run(work, NULL, &error));
    fixture_assert_error(error, cases[i].code, cases[i].says);
    spore_locate_work_free(work);
  }
  g_autofree char *after = fixture_format(fixture->document);
  g_assert_cmpstr(after, ==, before);
}

/* A file that is named by its content is that content; others beside it that do not fit are left. */
static void test_by_name(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  SporeObject *ball = spore_document_by_path(fixture->document, "assets/ball");
  spore_document_set_text(fixture->document, ball, "file", "ball-0123abcd.spheres", &error);
  g_assert_no_error(error);
  g_autofree char *beside = fixture_write(fixture->elsewhere, "ball-0123abcd.spheres", "0 0 0 1\n");
  SporeLocateWork *work = work_new(fixture, "gone/cube.off", fixture->elsewhere, "cube.off");
  g_assert_true(spore_locate_work_run(work, NULL, &error) && spore_locate_work_apply(work, fixture->document, &error));
  const SporeLocatedFile *left = spore_locate_work_found(work)->pdata[1];
  g_assert_nonnull(strstr(left->refused, "whose name says it"));
  g_assert_cmpstr(spore_object_text(ball, "file"), ==, "ball-0123abcd.spheres");
  spore_locate_work_free(work);
  g_autofree char *name = spore_content_file_name("ball", "spheres", "0 0 0 1\n", 8);
  spore_document_set_text(fixture->document, ball, "file", name, &error);
  work = work_new(fixture, name, fixture->elsewhere, "ball-0123abcd.spheres");
  g_assert_true(spore_locate_work_run(work, NULL, &error));
  spore_locate_work_free(work);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add("/locate/taken", Fixture, NULL, set_up, test_taken, tear_down);
  g_test_add("/locate/inside", Fixture, NULL, set_up, test_inside, tear_down);
  g_test_add("/locate/refused", Fixture, NULL, set_up, test_refused, tear_down);
  g_test_add("/locate/by_name", Fixture, NULL, set_up, test_by_name, tear_down);
  return g_test_run();
}
