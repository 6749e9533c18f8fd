/* Objects change their place in the list of their section, several in their order, as one step that undoes exactly;
 * what belongs to another list is refused, and nothing moves. */
#include "core/author/order_edits.h"
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

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/order/moved", test_moved);
  g_test_add_func("/order/refused", test_refused);
  return g_test_run();
}
