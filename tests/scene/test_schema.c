/* The schema: every element and property says all that files, inspector and documentation need. */
#include <string.h>

#include "core/integrate/solver.h"
#include "core/io/mesh_import.h"
#include "fixture.h"

typedef void (*Visit)(const SporeObjectType *type);

static void each_type(const SporeObjectType *type, Visit visit) {
  visit(type);
  for (guint i = 0; i < type->children->len; i++) each_type(g_ptr_array_index(type->children, i), visit);
}

static void check_parameter(const SporeObjectType *type, const SporeParameter *parameter, const SporeValue *initial) {
  SporeError fault = SPORE_ERROR_INIT;
  g_test_message("%s %s", type->element, parameter->name);
  g_assert_nonnull(parameter->unit);
  g_assert_cmpuint(strlen(parameter->doc), >, 10);
  g_assert_true(g_str_has_suffix(parameter->doc, "."));
  g_assert_cmpint(spore_parameter_find(type->table, parameter->name), ==, (int)(parameter - type->table->parameters));
  g_assert_cmpuint(parameter->offset, <, type->table->size);
  g_assert_true((parameter->type == SPORE_CHOICE) == (parameter->choices != NULL));
  g_assert_true((parameter->type == SPORE_REFERENCE) == (parameter->references != NULL));
  g_assert_cmpint(initial->type, ==, parameter->type);
  if (!parameter->required || parameter->initial_text) g_assert_true(spore_parameter_check(parameter, initial, &fault));
  if (!parameter->references) return;
  g_auto(GStrv) elements = g_strsplit(parameter->references, "|", -1);
  for (char **element = elements; *element; element++)
    g_assert_nonnull(spore_schema_find(fixture_model_schema(), *element));
}

static void check_type(const SporeObjectType *type) {
  g_assert_true(spore_schema_find(fixture_model_schema(), type->key) == type);
  g_assert_cmpuint(strlen(type->label), >, 0);
  g_assert_cmpuint(strlen(type->doc), >, 10);
  for (size_t i = 0; i < type->table->count; i++) check_parameter(type, &type->table->parameters[i], &type->initial[i]);
}

static void test_complete(void) { each_type(spore_schema_root(fixture_model_schema()), check_type); }

static void test_models_are_children_of_mechanical(void) {
  const SporeSchema *schema = fixture_model_schema();
  const SporeObjectType *mechanical = spore_schema_find(schema, "mechanical");
  guint count = 0;
  for (SporeModelRegistry model = spore_schema_registry(schema); *model; model++, count++) {
    const SporeObjectType *type = spore_object_type_child(mechanical, (*model)->name);
    g_assert_true(type->model == *model);
    g_assert_true(type->table->parameters == (*model)->parameters.parameters);
  }
  g_assert_cmpuint(mechanical->children->len, ==, count);
  g_assert_true(mechanical->single_child);
}

/* Lists that two rooms count by index. */
static void assert_same(const char *element, const char *property, const char *const *words, int from) {
  const SporeObjectType *type = spore_schema_find(fixture_model_schema(), element);
  const SporeParameter *parameter = &type->table->parameters[spore_parameter_find(type->table, property)];
  for (int i = 0; i == 0 || words[i - 1]; i++) g_assert_cmpstr(parameter->choices[from + i], ==, words[i]);
}

static void test_lists_agree(void) {
  assert_same("mesh", "unit", spore_length_units, 0);
  assert_same("units", "length", spore_length_units, 0);
  assert_same("mesh", "frame", spore_mesh_frames, 0);
  assert_same("solver", "integrator", spore_integrator_names, 0);
  assert_same("mechanical", "integrator", spore_integrator_names, 1); /* behind "scene" */
}

static void test_versions(void) {
  const struct {
    const char *version;
    gboolean good;
  } versions[] = {{"1.0", TRUE},    {"1", TRUE},     {"1.42", TRUE},  {"2.0", FALSE},    {"0.9", FALSE},
                  {"10.0", FALSE},  {"01.0", FALSE}, {"", FALSE},     {"1.", FALSE},     {".1", FALSE},
                  {"1.0.0", FALSE}, {"1.x", FALSE},  {" 1.0", FALSE}, {"1.00000", FALSE}};
  for (guint i = 0; i < G_N_ELEMENTS(versions); i++) {
    SporeError fault = SPORE_ERROR_INIT;
    g_assert_cmpint(spore_format_version_check(versions[i].version, &fault), ==, versions[i].good);
    g_assert_true((fault.code == SPORE_ERROR_NONE) == versions[i].good);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/schema/complete", test_complete);
  g_test_add_func("/schema/models-are-children-of-mechanical", test_models_are_children_of_mechanical);
  g_test_add_func("/schema/lists-agree", test_lists_agree);
  g_test_add_func("/schema/versions", test_versions);
  return g_test_run();
}
