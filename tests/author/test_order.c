/* Objects change their place in the list of their section, several in their order, as one step that undoes exactly;
 * what belongs to another list is refused, and nothing moves. */
#include "core/author/order_edits.h"
#include "core/scene/run_hash.h"
#include "tests/scene/fixture.h"

static const char scene_text[] =
    "<spore version=\"1.0\"><bodies><body name=\"a\"/><body name=\"b\"/><body name=\"c\"/><body name=\"d\"/></bodies>"
    "<tools><camera name=\"eye\"/></tools></spore>\n";

static char *order_of(SporeDocument *document) {
  const SporeObject *bodies = spore_document_section(document, "bodies");
  GString *text = g_string_new(NULL);
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    g_string_append(text, spore_object_name(spore_object_child(bodies, i)));
  return g_string_free(text, FALSE);
}

/* Moves the bodies of these letters. */
static gboolean move(SporeDocument *document, const char *letters, char target, gboolean after) {
  g_autoptr(GArray) ids = g_array_new(FALSE, FALSE, sizeof(guint32));
  const char to[] = {target, '\0'};
  GError *error = NULL;
  for (; *letters; letters++) {
    const char name[] = {*letters, '\0'};
    guint32 id = spore_object_id(spore_document_find(document, "body", name));
    g_array_append_val(ids, id);
  }
  gboolean done = spore_edit_reorder(document, ids, spore_document_find(document, "body", to), after, &error);
  g_assert_no_error(error);
  return done;
}

static void test_moved(void) {
  static const struct {
    const char *letters;
    char target;
    gboolean after;
    const char *order;
  } cases[] = {{"a", 'c', TRUE, "bcad"},  {"d", 'a', FALSE, "dabc"}, {"db", 'a', FALSE, "bdac"},
               {"ab", 'd', TRUE, "cdab"}, {"ac", 'b', TRUE, "bacd"}, {"bc", 'b', FALSE, "abcd"},
               {"ad", 'd', TRUE, "bcad"}};
  for (gsize i = 0; i < G_N_ELEMENTS(cases); i++) {
    SporeDocument *document = fixture_parse(scene_text);
    g_assert_true(move(document, cases[i].letters, cases[i].target, cases[i].after));
    g_autofree char *order = order_of(document);
    g_assert_cmpstr(order, ==, cases[i].order);
    if (spore_document_can_undo(document)) spore_document_undo(document);
    g_autofree char *before = order_of(document);
    g_assert_cmpstr(before, ==, "abcd");
    spore_document_free(document);
  }
}

static void test_refused(void) {
  SporeDocument *document = fixture_parse(scene_text);
  GError *error = NULL;
  guint32 id = spore_object_id(spore_document_by_path(document, "bodies/a"));
  g_autoptr(GArray) ids = g_array_new(FALSE, FALSE, sizeof(guint32));
  g_array_append_val(ids, id);
  g_assert_false(spore_edit_reorder(document, ids, spore_document_by_path(document, "tools/eye"), TRUE, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "belongs to one list");
  g_assert_false(spore_document_is_modified(document));
  spore_document_free(document);
}

static guint count_in(SporeDocument *document, const char *folder) {
  const SporeObject *bodies = spore_document_section(document, "bodies");
  guint count = 0;
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    count += g_strcmp0(spore_folder_of(spore_object_child(bodies, i)), folder) == 0;
  return count;
}

/* A folder is nothing but what its bodies say; a run does not depend on it. */
static void test_folders(void) {
  SporeDocument *document = fixture_parse(scene_text);
  guint64 hash = spore_document_run_hash(document);
  g_autoptr(GArray) ids = g_array_new(FALSE, FALSE, sizeof(guint32));
  static const char *const paths[] = {"bodies/a", "bodies/c", "tools/eye"}; /* a camera is in no folder */
  for (gsize i = 0; i < G_N_ELEMENTS(paths); i++) {
    guint32 id = spore_object_id(spore_document_by_path(document, paths[i]));
    g_array_append_val(ids, id);
  }
  g_autofree char *name = spore_folder_new_name(document);
  g_assert_true(spore_edit_put_in_folder(document, ids, name, NULL));
  g_assert_cmpuint(count_in(document, name), ==, 2);
  g_autofree char *other = spore_folder_new_name(document);
  g_assert_cmpstr(other, !=, name);
  g_assert_true(spore_edit_rename_folder(document, name, "Pelvis", NULL));
  g_assert_cmpuint(count_in(document, "Pelvis"), ==, 2);
  g_assert_cmpuint(spore_document_run_hash(document), ==, hash);
  spore_document_undo(document);
  g_assert_cmpuint(count_in(document, name), ==, 2);
  g_assert_true(spore_edit_rename_folder(document, name, NULL, NULL));
  g_assert_cmpuint(count_in(document, NULL), ==, 4);
  spore_document_free(document);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/order/moved", test_moved);
  g_test_add_func("/order/refused", test_refused);
  g_test_add_func("/order/folders", test_folders);
  return g_test_run();
}
