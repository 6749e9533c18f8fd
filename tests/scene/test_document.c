/* The document's commands: what they refuse, what they change, and that every change can be taken back. */
#include <string.h>

#include "core/scene/document_private.h"
#include "fixture.h"

static SporeObject *insert(SporeDocument *document, const char *parent, const char *element, const char *name) {
  GError *error = NULL;
  SporeObject *above = spore_document_by_path(document, parent);
  SporeObject *object = spore_document_insert(document, above, element, name, G_MAXUINT, &error);
  g_assert_no_error(error);
  return object;
}

static void set(SporeDocument *document, SporeObject *object, const char *property, const char *text) {
  GError *error = NULL;
  spore_document_set_text(document, object, property, text, &error);
  g_assert_no_error(error);
}

static void test_starts_empty(void) {
  SporeDocument *document = spore_document_new(fixture_schema());
  g_assert_cmpuint(spore_object_child_count(spore_document_root(document)), ==, 12);
  g_assert_nonnull(spore_document_section(document, "bodies"));
  g_assert_false(spore_document_is_modified(document));
  g_assert_false(spore_document_can_undo(document));
  SporeObject *environment = spore_document_by_path(document, "environment");
  g_assert_cmpfloat(spore_object_value(environment, 0)->number[1], ==, -9.81);
  g_assert_false(spore_object_is_set(environment, 0));
  g_autofree char *text = fixture_format(document);
  g_assert_cmpstr(text, ==, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<spore version=\"1.0\"/>\n");
  spore_document_free(document);
}

static void test_set_and_unset(void) {
  SporeDocument *document = spore_document_new(fixture_schema());
  SporeObject *body = insert(document, "bodies", "body", "liver");
  set(document, body, "position", "1 2 3");
  g_assert_cmpfloat(spore_object_value(body, 2)->number[2], ==, 3);
  guint64 revision = spore_document_revision(document);
  set(document, body, "position", "1 2 3");
  g_assert_cmpuint(spore_document_revision(document), ==, revision); /* nothing changed */
  GError *error = NULL;
  g_assert_true(spore_document_unset(document, body, 2, &error));
  g_assert_false(spore_object_is_set(body, 2));
  spore_document_undo(document);
  g_assert_cmpfloat(spore_object_value(body, 2)->number[0], ==, 1);
  spore_document_free(document);
}

static void test_refusals(void) {
  SporeDocument *document = spore_document_new(fixture_schema());
  SporeObject *bodies = spore_document_section(document, "bodies"), *body = insert(document, "bodies", "body", "liver");
  insert(document, "bodies", "body", "spleen");
  SporeObject *mechanical = insert(document, "bodies/liver", "mechanical", NULL);
  SporeObject *model = insert(document, "bodies/liver/mechanical", "particle", NULL);
  guint64 revision = spore_document_revision(document);
  GError *error = NULL;
  g_assert_false(spore_document_set_text(document, model, "mass", "0", &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "bodies/liver/mechanical/particle: mass=\"0\"");
  g_assert_false(spore_document_set_text(document, model, "mas", "1", &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "did you mean \"mass\"");
  SporeValue infinite = {.type = SPORE_REAL, .number = {INFINITY}};
  g_assert_false(spore_document_set(document, model, 0, &infinite, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "finite");
  SporeValue broken = {.type = SPORE_TEXT, .text = (char *)"\xff"};
  g_assert_false(spore_document_set(document, model, 5, &broken, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "UTF-8");
  g_assert_false(spore_document_rename(document, body, "spleen", &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "bodies/liver: the name \"spleen\" is taken");
  g_assert_false(spore_document_rename(document, body, "two words", &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "is not a name");
  g_assert_false(spore_document_rename(document, model, "x", &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "has no name");
  g_assert_null(spore_document_insert(document, bodies, "bodi", NULL, 0, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "did you mean \"body\"");
  g_assert_null(spore_document_insert(document, bodies, "body", "9", 0, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "is not a name");
  g_assert_null(spore_document_insert(document, body, "mechanical", NULL, 0, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "already has its mechanical");
  g_assert_null(spore_document_insert(document, mechanical, "particle", NULL, 0, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "already holds particle");
  g_assert_false(spore_document_remove(document, bodies, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "belongs to every scene");
  g_assert_false(spore_document_move(document, body, spore_document_section(document, "links"), 0, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "links cannot hold \"body\"");
  g_assert_false(spore_document_unset(document, body, 0, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "name has no default");
  g_assert_false(spore_document_set_text(document, spore_document_root(document), "version", "2.0", &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "2.0");
  g_assert_cmpuint(spore_document_revision(document), ==, revision);
  spore_document_free(document);
}

static void test_names_are_made_unique(void) {
  SporeDocument *document = spore_document_new(fixture_schema());
  g_assert_cmpstr(spore_object_name(insert(document, "bodies", "body", "liver")), ==, "liver");
  g_assert_cmpstr(spore_object_name(insert(document, "bodies", "body", "liver")), ==, "liver-2");
  g_assert_cmpstr(spore_object_name(insert(document, "bodies", "body", "liver")), ==, "liver-3");
  g_assert_cmpstr(spore_object_name(insert(document, "bodies", "body", NULL)), ==, "body");
  g_assert_cmpstr(spore_object_name(insert(document, "assets", "mesh", "liver")), ==, "liver");
  g_assert_cmpstr(spore_object_name(insert(document, "assets", "tetrahedra", "liver")), ==, "liver-2");
  spore_document_free(document);
}

static void test_paths(void) {
  SporeDocument *document = spore_document_new(fixture_schema());
  insert(document, "bodies", "body", "liver");
  insert(document, "bodies/liver", "mechanical", NULL);
  SporeObject *model = insert(document, "bodies/liver/mechanical", "particle", NULL);
  g_autofree char *path = spore_object_path(model);
  g_assert_cmpstr(path, ==, "bodies/liver/mechanical/particle");
  g_assert_true(spore_document_by_path(document, path) == model);
  g_assert_null(spore_document_by_path(document, "bodies/liver/visual"));
  g_assert_null(spore_document_by_path(document, ""));
  g_assert_null(spore_document_by_path(document, "bodies/"));
  g_assert_true(spore_document_by_path(document, "spore") == spore_document_root(document));
  g_assert_nonnull(spore_document_find(document, "mesh|body", "liver"));
  g_assert_null(spore_document_find(document, "mesh|bod", "liver"));
  spore_document_free(document);
}

static void test_fixed_order(void) {
  SporeDocument *document = spore_document_new(fixture_schema());
  SporeObject *body = insert(document, "bodies", "body", "liver");
  insert(document, "bodies/liver", "fidelity", NULL);
  insert(document, "bodies/liver", "collision", NULL);
  insert(document, "bodies/liver", "mechanical", NULL);
  insert(document, "bodies/liver", "visual", NULL);
  const char *const order[] = {"mechanical", "collision", "visual", "fidelity"};
  for (guint i = 0; i < 4; i++) g_assert_cmpstr(spore_object_type(spore_object_child(body, i))->element, ==, order[i]);
  spore_document_free(document);
}

static void test_move(void) {
  SporeDocument *document = spore_document_new(fixture_schema());
  SporeObject *bodies = spore_document_section(document, "bodies");
  SporeObject *a = insert(document, "bodies", "body", "a");
  insert(document, "bodies", "body", "b");
  insert(document, "bodies", "body", "c");
  GError *error = NULL;
  g_assert_true(spore_document_move(document, a, bodies, G_MAXUINT, &error));
  g_assert_true(spore_object_child(bodies, 2) == a);
  g_assert_true(spore_document_move(document, a, bodies, 1, &error));
  g_assert_true(spore_object_child(bodies, 1) == a);
  spore_document_undo(document);
  spore_document_undo(document);
  g_assert_true(spore_object_child(bodies, 0) == a);
  SporeObject *mechanical = insert(document, "bodies/a", "mechanical", NULL);
  SporeObject *b = spore_document_by_path(document, "bodies/b");
  g_assert_true(spore_document_move(document, mechanical, b, 0, &error));
  g_assert_true(spore_object_parent(mechanical) == b);
  spore_document_undo(document);
  g_assert_true(spore_object_parent(mechanical) == a);
  spore_document_free(document);
}

static void test_rename_follows_references(void) {
  SporeDocument *document = spore_document_new(fixture_schema());
  SporeObject *body = insert(document, "bodies", "body", "liver");
  SporeObject *mesh = insert(document, "assets", "mesh", "liver");
  SporeObject *mechanical = insert(document, "bodies/liver", "mechanical", NULL);
  SporeObject *pin = insert(document, "links", "pin", NULL);
  set(document, mechanical, "geometry", "liver");
  set(document, pin, "body", "liver");
  set(document, body, "name", "hepar");
  g_assert_cmpstr(spore_object_name(body), ==, "hepar");
  g_assert_cmpstr(spore_object_text(pin, "body"), ==, "hepar");
  g_assert_cmpstr(spore_object_text(mechanical, "geometry"), ==, "liver");
  GError *error = NULL;
  g_assert_true(spore_document_rename(document, mesh, "skin", &error));
  g_assert_cmpstr(spore_object_text(mechanical, "geometry"), ==, "skin");
  spore_document_undo(document);
  spore_document_undo(document);
  g_assert_cmpstr(spore_object_text(pin, "body"), ==, "liver");
  g_assert_cmpstr(spore_object_name(body), ==, "liver");
  g_assert_cmpstr(spore_object_text(mechanical, "geometry"), ==, "liver");
  spore_document_free(document);
}

static void test_defaults_are_inherited(void) {
  SporeDocument *document = spore_document_new(fixture_schema());
  insert(document, "bodies", "body", "liver");
  SporeObject *collision = insert(document, "bodies/liver", "collision", NULL);
  double built_in = spore_object_number(collision, "stiffness");
  SporeObject *contact = insert(document, "defaults", "contact", NULL);
  set(document, contact, "stiffness", "123");
  g_assert_cmpfloat(spore_object_number(collision, "stiffness"), ==, 123);
  set(document, collision, "stiffness", "7");
  g_assert_cmpfloat(spore_object_number(collision, "stiffness"), ==, 7);
  spore_document_undo(document);
  spore_document_undo(document);
  g_assert_cmpfloat(spore_object_number(collision, "stiffness"), ==, built_in);
  spore_document_free(document);
}

static guint undo_all(SporeDocument *document) {
  guint steps = 0;
  for (; spore_document_can_undo(document); steps++) spore_document_undo(document);
  return steps;
}

static void test_groups_merge(void) {
  SporeDocument *document = spore_document_new(fixture_schema());
  SporeObject *body = insert(document, "bodies", "body", "liver");
  spore_document_begin(document, "Drag");
  for (int i = 0; i < 100; i++) {
    g_autofree char *text = g_strdup_printf("%d 0 0", i);
    set(document, body, "position", text);
  }
  g_assert_false(spore_document_can_undo(document)); /* not inside a group */
  g_assert_true(spore_document_is_modified(document));
  spore_document_end(document);
  const SporeUndoStep *step = g_ptr_array_index(document->undo, document->undo->len - 1);
  g_assert_cmpuint(step->edits->len, ==, 1); /* a hundred moves of the mouse */
  g_assert_cmpstr(spore_document_undo_label(document), ==, "Drag");
  spore_document_undo(document);
  g_assert_false(spore_object_is_set(body, 2));
  g_assert_cmpstr(spore_document_redo_label(document), ==, "Drag");
  spore_document_redo(document);
  g_assert_cmpfloat(spore_object_value(body, 2)->number[0], ==, 99);
  spore_document_begin(document, "Nothing");
  spore_document_end(document);
  g_assert_cmpstr(spore_document_undo_label(document), ==, "Drag");
  g_assert_cmpuint(undo_all(document), ==, 2);
  spore_document_free(document);
}

/* The order of the properties comes back too, however they were set and unset in between. */
static void test_group_keeps_order(void) {
  SporeDocument *document =
      fixture_parse("<spore version=\"1.0\"><bodies><body name=\"a\" position=\"1 0 0\" spin=\"0 0 1\" "
                    "velocity=\"1 1 1\"/></bodies></spore>");
  g_autofree char *before = fixture_format(document);
  SporeObject *body = spore_document_by_path(document, "bodies/a");
  spore_document_begin(document, "Group");
  spore_document_unset(document, body, 2, NULL);
  spore_document_unset(document, body, 4, NULL);
  set(document, body, "position", "2 0 0");
  set(document, body, "position", "3 0 0");
  spore_document_end(document);
  g_autofree char *between = fixture_format(document);
  spore_document_undo(document);
  g_autofree char *after = fixture_format(document);
  g_assert_cmpstr(after, ==, before);
  spore_document_redo(document);
  g_autofree char *again = fixture_format(document);
  g_assert_cmpstr(again, ==, between);
  spore_document_free(document);
}

static void test_abort_restores(void) {
  SporeDocument *document = spore_document_new(fixture_schema());
  SporeObject *body = insert(document, "bodies", "body", "liver");
  set(document, body, "position", "1 0 0");
  set(document, body, "position", "2 0 0");
  spore_document_undo(document);
  g_autofree char *before = fixture_format(document);
  spore_document_begin(document, "Outer");
  set(document, body, "velocity", "1 1 1");
  g_autofree char *between = fixture_format(document);
  spore_document_begin(document, "Inner");
  set(document, body, "velocity", "2 2 2");
  set(document, body, "position", "3 0 0");
  guint32 id = spore_object_id(insert(document, "bodies", "body", "spleen"));
  spore_document_abort(document);
  g_autofree char *after_inner = fixture_format(document);
  g_assert_cmpstr(after_inner, ==, between);
  g_assert_null(spore_document_by_id(document, id));
  spore_document_abort(document);
  g_autofree char *after = fixture_format(document);
  g_assert_cmpstr(after, ==, before);
  g_assert_true(spore_document_can_redo(document)); /* what could be redone still can */
  g_assert_cmpuint(spore_object_id(insert(document, "bodies", "body", "spleen")), >, id);
  spore_document_free(document);
}

static void test_modified(void) {
  g_autofree char *folder = fixture_folder_new();
  g_autofree char *file = g_build_filename(folder, "a.spore", NULL);
  SporeDocument *document = spore_document_new(fixture_schema());
  SporeObject *body = insert(document, "bodies", "body", "liver");
  GError *error = NULL;
  spore_scene_save(document, file, &error);
  g_assert_no_error(error);
  g_assert_false(spore_document_is_modified(document));
  set(document, body, "role", "active");
  g_assert_true(spore_document_is_modified(document));
  spore_document_undo(document);
  g_assert_false(spore_document_is_modified(document));
  spore_document_undo(document);
  g_assert_true(spore_document_is_modified(document));
  insert(document, "bodies", "body", "other"); /* what was saved cannot be reached any more */
  spore_document_undo(document);
  g_assert_true(spore_document_is_modified(document));
  spore_document_free(document);
  fixture_folder_free(g_steal_pointer(&folder));
}

typedef struct Heard {
  guint count[5];
  SporeObject *object;
  guint property;
} Heard;

static void hear(SporeDocument *document, SporeChangeKind kind, SporeObject *object, guint property, gpointer data) {
  Heard *heard = data;
  heard->count[kind]++;
  if (kind == SPORE_DOCUMENT_HISTORY) return;
  heard->object = object, heard->property = property;
  if (kind == SPORE_DOCUMENT_REMOVED) {
    g_autofree char *path = spore_object_path(object);
    g_assert_true(g_str_has_prefix(path, "bodies/"));
    g_assert_null(spore_document_by_id(document, spore_object_id(object)));
  }
}

static void test_listeners(void) {
  SporeDocument *document = spore_document_new(fixture_schema());
  Heard heard = {0};
  guint id = spore_document_listen(document, hear, &heard);
  SporeObject *body = insert(document, "bodies", "body", "liver");
  g_assert_true(heard.object == body);
  g_assert_cmpuint(heard.count[SPORE_DOCUMENT_INSERTED], ==, 1);
  g_assert_cmpuint(heard.count[SPORE_DOCUMENT_SET], ==, 0);
  set(document, body, "role", "active");
  g_assert_cmpuint(heard.count[SPORE_DOCUMENT_SET], ==, 1);
  g_assert_cmpuint(heard.property, ==, 1);
  undo_all(document);
  g_assert_cmpuint(heard.count[SPORE_DOCUMENT_SET], ==, 2);
  g_assert_cmpuint(heard.count[SPORE_DOCUMENT_REMOVED], ==, 1);
  g_assert_cmpuint(heard.count[SPORE_DOCUMENT_HISTORY], ==, 4);
  spore_document_unlisten(document, id);
  spore_document_redo(document);
  g_assert_cmpuint(heard.count[SPORE_DOCUMENT_HISTORY], ==, 4);
  spore_document_free(document);
}

/* Random editing. */

static SporeObject *random_object(SporeDocument *document, GRand *random) {
  SporeObject *object = spore_document_root(document);
  while (spore_object_child_count(object) > 0 && g_rand_int_range(random, 0, 8) > 0)
    object = spore_object_child(object, (guint)g_rand_int_range(random, 0, (gint32)spore_object_child_count(object)));
  return object;
}

static char *random_text(const SporeParameter *parameter, GRand *random) {
  double low = fmax(parameter->minimum, -5), high = fmin(parameter->maximum, 5);
  int number = g_rand_int_range(random, 0, 5);
  switch (parameter->type) {
  case SPORE_REAL:
    return g_strdup_printf("%.3f", g_rand_double_range(random, low, fmax(high, low + 1)));
  case SPORE_INTEGER:
    return g_strdup_printf("%d", 1 + number);
  case SPORE_BOOLEAN:
    return g_strdup(number % 2 ? "true" : "false");
  case SPORE_VECTOR:
    return g_strdup_printf("%d %d.5 0.25", number % 2, number % 2 ? 0 : 0);
  case SPORE_CHOICE:
    return g_strdup(parameter->choices[number % (int)g_strv_length((char **)parameter->choices)]);
  case SPORE_FILE:
    return g_strdup_printf("folder/%d.off", number);
  case SPORE_TEXT:
    return g_strdup_printf("\"%d\" < & >\n\t'", number);
  default:
    return g_strdup_printf("n%d", number);
  }
}

static void random_edit(SporeDocument *document, GRand *random) {
  SporeObject *object = random_object(document, random), *other = random_object(document, random);
  const SporeObjectType *type = spore_object_type(object);
  guint properties = (guint)type->table->count;
  guint property = properties ? (guint)g_rand_int_range(random, 0, (gint32)properties) : 0;
  switch (g_rand_int_range(random, 0, 8)) {
  case 0:
  case 1: {
    if (type->children->len == 0) return;
    const SporeObjectType *child = type->children->pdata[g_rand_int_range(random, 0, (gint32)type->children->len)];
    g_autofree char *name = g_strdup_printf("n%d", g_rand_int_range(random, 0, 5));
    spore_document_insert(document, object, child->element, name, (guint)g_rand_int_range(random, 0, 9), NULL);
    return;
  }
  case 2:
    spore_document_remove(document, object, NULL);
    return;
  case 3:
    spore_document_move(document, object, other, (guint)g_rand_int_range(random, 0, 9), NULL);
    return;
  case 4:
    if (properties) spore_document_unset(document, object, property, NULL);
    return;
  default: {
    if (!properties || object == spore_document_root(document)) return;
    g_autofree char *text = random_text(&type->table->parameters[property], random);
    spore_document_set_text(document, object, type->table->parameters[property].name, text, NULL);
  }
  }
}

static void random_group(SporeDocument *document, GRand *random) {
  g_autofree char *before = fixture_format(document);
  spore_document_begin(document, "Group");
  for (int i = g_rand_int_range(random, 0, 12); i > 0; i--) {
    if (g_rand_int_range(random, 0, 6) == 0) random_group(document, random);
    else random_edit(document, random);
  }
  if (g_rand_boolean(random)) {
    spore_document_end(document);
    return;
  }
  spore_document_abort(document);
  g_autofree char *after = fixture_format(document);
  g_assert_cmpstr(after, ==, before);
}

static const char start_scene[] = "<!-- start -->\n"
                                  "<spore version=\"1.0\">\n"
                                  "  <assets>\n"
                                  "    <mesh file=\"a.off\" unit=\"cm\" name=\"n0\"/> <!-- beside -->\n"
                                  "\n"
                                  "    <!-- before -->\n"
                                  "    <mesh name=\"n1\" file=\"b.off\"/>\n"
                                  "  </assets>\n"
                                  "  <bodies>\n"
                                  "    <body spin=\"0 0 1e-3\" name=\"n0\" velocity=\"00 0 1.50\" role=\"active\">\n"
                                  "      <mechanical/>\n"
                                  "      <!-- tail -->\n"
                                  "    </body>\n"
                                  "  </bodies>\n"
                                  "</spore>\n";

static void test_random_editing(void) {
  GRand *random = g_rand_new_with_seed(20030611);
  SporeDocument *document = fixture_parse(start_scene);
  for (int i = 0; i < 10000; i++) {
    int choice = g_rand_int_range(random, 0, 100);
    if (choice < 10) spore_document_undo(document);
    else if (choice < 16) spore_document_redo(document);
    else if (choice < 20) random_group(document, random);
    else random_edit(document, random);
  }
  while (spore_document_can_redo(document)) spore_document_redo(document);
  g_autofree char *end = fixture_format(document);
  guint steps = undo_all(document);
  g_assert_cmpuint(steps, >, 1000);
  g_autofree char *start = fixture_format(document);
  g_assert_cmpstr(start, ==, start_scene);
  g_assert_false(spore_document_is_modified(document));
  while (spore_document_can_redo(document)) spore_document_redo(document);
  g_autofree char *again = fixture_format(document);
  g_assert_cmpstr(again, ==, end);
  spore_document_free(document);
  g_rand_free(random);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/document/starts-empty", test_starts_empty);
  g_test_add_func("/document/set-and-unset", test_set_and_unset);
  g_test_add_func("/document/refusals", test_refusals);
  g_test_add_func("/document/names-are-made-unique", test_names_are_made_unique);
  g_test_add_func("/document/paths", test_paths);
  g_test_add_func("/document/fixed-order", test_fixed_order);
  g_test_add_func("/document/move", test_move);
  g_test_add_func("/document/rename-follows-references", test_rename_follows_references);
  g_test_add_func("/document/defaults-are-inherited", test_defaults_are_inherited);
  g_test_add_func("/document/groups-merge", test_groups_merge);
  g_test_add_func("/document/group-keeps-order", test_group_keeps_order);
  g_test_add_func("/document/abort-restores", test_abort_restores);
  g_test_add_func("/document/modified", test_modified);
  g_test_add_func("/document/listeners", test_listeners);
  g_test_add_func("/document/random-editing", test_random_editing);
  return g_test_run();
}
