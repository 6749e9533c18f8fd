/* A bundle in the editor: opened with progress, never written over, and saved as a scene with its files. No display. */
#include <glib/gstdio.h>
#include <string.h>

#include "core/author/generator.h"
#include "core/io/bundle.h"
#include "core/io/scene_xml.h"
#include "core/scene/run_hash.h"
#include "models/registry.h"
#include "ui/document/spore-editor-document.h"
#include "ui/jobs/works.h"

typedef struct Fixture {
  SporeSchema *schema;
  char *folder, *file; /* the bundle of minimal.spore */
  GByteArray *content;
  guint64 hash; /* of what a run of the scene depends on */
} Fixture;

static void set_up(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  fixture->schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  fixture->folder = g_dir_make_tmp("spore-bundle-XXXXXX", &error);
  g_assert_no_error(error);
  fixture->file = g_build_filename(fixture->folder, "ball.sporez", NULL);
  SporeDocument *document = spore_scene_load(fixture->schema, SPORE_SCENES "/minimal.spore", &error);
  g_assert_no_error(error);
  fixture->hash = spore_document_run_hash(document);
  fixture->content = spore_bundle_format(document, fixture->file, NULL, &error);
  g_assert_no_error(error);
  spore_document_free(document);
  g_assert_true(spore_write_file(fixture->file, fixture->content->data, fixture->content->len, &error));
}

static void tear_down(Fixture *fixture, gconstpointer data) {
  g_autofree char *content = NULL;
  gsize size;
  g_assert_true(g_file_get_contents(fixture->file, &content, &size, NULL));
  g_assert_cmpmem(content, size, fixture->content->data, fixture->content->len); /* as it was */
  g_remove(fixture->file);
  g_assert_cmpint(g_rmdir(fixture->folder), ==, 0); /* nothing else is there */
  g_byte_array_unref(fixture->content);
  g_free(fixture->file);
  g_free(fixture->folder);
  spore_schema_free(fixture->schema);
}

static bool go_on(void *data, double fraction, const char *stage) {
  g_assert_cmpfloat(fraction, >=, 0);
  g_assert_cmpfloat(fraction, <=, 1);
  guint *left = data;
  return *left > 0 ? --*left > 0 : false;
}

static SporeDocument *open_file(Fixture *fixture, guint calls, GError **error) {
  SporeOpenWork *work = spore_open_work_new(fixture->schema, fixture->file);
  const SporeProgress progress = {.report = go_on, .data = &calls};
  gboolean done = spore_open_work_run(work, &progress, error);
  SporeDocument *document = done ? g_steal_pointer(&work->document) : NULL;
  spore_open_work_free(work);
  return document;
}

static void test_open(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  SporeDocument *document = open_file(fixture, 1000, &error);
  g_assert_no_error(error);
  g_assert_cmpuint(spore_document_run_hash(document), ==, fixture->hash);
  SporeEditorDocument *editor = spore_editor_document_new(document);
  g_autofree char *title = spore_editor_document_get_title(editor);
  g_assert_cmpstr(title, ==, "ball.sporez");
  g_assert_null(spore_editor_document_get_save_file(editor)); /* Save asks for a name */
  g_assert_false(spore_editor_document_is_modified(editor));
  SporeDocument *copy = spore_document_copy(document);
  g_autofree char *where = spore_object_where(spore_document_find(copy, "body", "ball"));
  g_autofree char *place = g_strconcat(fixture->file, ":", NULL);
  g_assert_true(g_str_has_prefix(where, place)); /* messages name the bundle */
  spore_document_free(copy);
  g_object_unref(editor);
}

static void test_cancel(Fixture *fixture, gconstpointer data) {
  for (guint calls = 1; calls < 4; calls++) { /* while the scene is unpacked, and while its files are */
    GError *error = NULL;
    g_assert_null(open_file(fixture, calls, &error));
    g_assert_error(error, SPORE_ERROR, SPORE_ERROR_CANCELLED);
    g_error_free(error);
  }
}

static void remove_saved(const char *folder) {
  static const char *const files[] = {"ball.spore",
                                      "minimal/ball.off",
                                      "minimal/ball.spheres",
                                      "minimal/floor.off",
                                      "minimal/floor.spheres",
                                      "minimal",
                                      ""};
  for (gsize i = 0; i < G_N_ELEMENTS(files); i++) {
    g_autofree char *path = g_build_filename(folder, files[i], NULL);
    g_assert_cmpint(g_remove(path), ==, 0);
  }
}

static void test_save(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  SporeDocument *document = open_file(fixture, 1000, &error);
  g_assert_no_error(error);
  SporeEditorDocument *editor = spore_editor_document_new(document);
  g_assert_false(spore_editor_document_save(editor, fixture->file, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_INPUT);
  g_clear_error(&error);
  g_assert_cmpstr(spore_document_bundle(document), ==, fixture->file);
  g_autofree char *folder = g_build_filename(fixture->folder, "saved", NULL);
  g_assert_cmpint(g_mkdir(folder, 0777), ==, 0);
  g_autofree char *file = g_build_filename(folder, "ball.spore", NULL);
  g_assert_true(spore_editor_document_save(editor, file, &error));
  g_autofree char *title = spore_editor_document_get_title(editor);
  g_assert_cmpstr(title, ==, "ball.spore");
  g_assert_null(spore_document_bundle(document));
  g_assert_cmpstr(spore_document_file(document), ==, file);
  SporeDocument *again = spore_scene_load(fixture->schema, file, &error);
  g_assert_no_error(error);
  g_assert_cmpuint(spore_document_run_hash(again), ==, fixture->hash);
  spore_document_free(again);
  remove_saved(folder);
  g_object_unref(editor);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add("/bundle/open", Fixture, NULL, set_up, test_open, tear_down);
  g_test_add("/bundle/cancel", Fixture, NULL, set_up, test_cancel, tear_down);
  g_test_add("/bundle/save", Fixture, NULL, set_up, test_save, tear_down);
  return g_test_run();
}
