/* The parameter table: parsing, formatting, checking, structures. */
#include <glib.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/parameter.h"

typedef struct {
  double stiffness, offset;
  int64_t count;
  bool self;
  double gravity[3];
  int method;
  const char *title, *file, *body, *name;
} Fields;

static const char *const methods[] = {"implicit_euler", "symplectic_euler", NULL};

static const SporeParameter list[] = {
    {"stiffness", SPORE_REAL, "N/m", 0, 1e6, {100}, .offset = offsetof(Fields, stiffness), .doc = "d"},
    {"offset", SPORE_REAL, "", -HUGE_VAL, HUGE_VAL, {0}, .offset = offsetof(Fields, offset), .doc = "d"},
    {"count", SPORE_INTEGER, "", 1, HUGE_VAL, {10}, .offset = offsetof(Fields, count), .doc = "d"},
    {"self", SPORE_BOOLEAN, "", 0, 1, {1}, .offset = offsetof(Fields, self), .doc = "d"},
    {"gravity", SPORE_VECTOR, "m/s^2", -1000, 1000, {0, -9.81, 0}, .offset = offsetof(Fields, gravity), .doc = "d"},
    {"method", SPORE_CHOICE, "", .initial = {1}, .choices = methods, .offset = offsetof(Fields, method), .doc = "d"},
    {"title", SPORE_TEXT, "", .initial_text = "untitled", .offset = offsetof(Fields, title), .doc = "d"},
    {"file", SPORE_FILE, "", .required = true, .offset = offsetof(Fields, file), .doc = "d"},
    {"body", SPORE_REFERENCE, "", .references = "body", .offset = offsetof(Fields, body), .doc = "d"},
    {"name", SPORE_NAME, "", .required = true, .offset = offsetof(Fields, name), .doc = "d"},
};
static const SporeParameterTable table = {list, G_N_ELEMENTS(list), sizeof(Fields)};

static const SporeParameter *get(const char *name) { return &list[spore_parameter_find(&table, name)]; }

static void test_find(void) {
  g_assert_cmpint(spore_parameter_find(&table, "count"), ==, 2);
  g_assert_cmpint(spore_parameter_find(&table, "Count"), ==, -1);
  g_assert_cmpstr(spore_parameter_nearest(&table, "stifness"), ==, "stiffness");
  g_assert_null(spore_parameter_nearest(&table, "temperature"));
}

static void check_round_trip(const char *name, const char *text, const char *expected) {
  const SporeParameter *parameter = get(name);
  SporeError error = SPORE_ERROR_INIT;
  SporeValue value, again;
  if (!spore_parameter_parse(parameter, text, &value, &error)) g_error("%s", error.message);
  char written[256];
  int length = spore_parameter_format(parameter, &value, written, sizeof written);
  g_assert_cmpstr(written, ==, expected);
  g_assert_cmpint(length, ==, (int)strlen(expected));
  g_assert_true(spore_parameter_parse(parameter, written, &again, &error));
  g_assert_true(spore_value_equal(&value, &again));
  char cut[3];
  g_assert_cmpint(spore_parameter_format(parameter, &value, cut, sizeof cut), ==, length);
  spore_value_clear(&value);
  spore_value_clear(&again);
}

static void test_round_trip(void) {
  check_round_trip("stiffness", "100", "100");
  check_round_trip("stiffness", " \t1e-310\n", "9.99999999999997e-311");
  check_round_trip("stiffness", "-0", "-0");
  check_round_trip("offset", "1e308", "1e+308");
  check_round_trip("offset", "-1.7976931348623157e308", "-1.7976931348623157e+308");
  check_round_trip("offset", "5e-324", "4.94065645841247e-324");
  check_round_trip("offset", "0.1", "0.1");
  check_round_trip("offset", "0.30000000000000004", "0.30000000000000004");
  check_round_trip("count", "+7", "7");
  check_round_trip("count", "9007199254740992", "9007199254740992");
  check_round_trip("self", " true ", "true");
  check_round_trip("self", "false", "false");
  check_round_trip("gravity", "1 -0  2.5e-3", "1 -0 0.0025");
  check_round_trip("method", "implicit_euler", "implicit_euler");
  check_round_trip("title", " two words ", " two words ");
  check_round_trip("title", "", "");
  check_round_trip("file", " meshes/liver.stl ", "meshes/liver.stl");
  check_round_trip("file", "a..b/..c", "a..b/..c");
  check_round_trip("body", "liver", "liver");
}

static void check_refused(const char *name, const char *text, const char *part) {
  SporeError error = SPORE_ERROR_INIT;
  SporeValue value = {.type = SPORE_TEXT, .number = {1, 2, 3}, .text = NULL}, before = value;
  g_assert_false(spore_parameter_parse(get(name), text, &value, &error));
  g_assert_cmpmem(&value, sizeof value, &before, sizeof before);
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  if (!strstr(error.message, part)) g_error("\"%s\" lacks \"%s\"", error.message, part);
  g_assert_nonnull(strstr(error.message, name));
  g_assert_nonnull(strstr(error.message, "expected"));
}

static void test_refused(void) {
  check_refused("stiffness", "abc", "is not a number");
  check_refused("stiffness", "", "is not a number");
  check_refused("stiffness", "1 2", "is not a number");
  check_refused("stiffness", "1,5", "is not a number");
  check_refused("stiffness", "0x10", "is not a number");
  check_refused("stiffness", "1e7", "from 0 to 1000000 N/m");
  check_refused("stiffness", "-1", "is out of range");
  check_refused("stiffness", "-1", "the default is 100");
  check_refused("stiffness", "nan", "is not a number");
  check_refused("offset", "1e999", "is not a finite number");
  check_refused("count", "1.5", "is not an integer");
  check_refused("count", "1e3", "is not an integer");
  check_refused("count", "0", "an integer, at least 1");
  check_refused("count", "9007199254740994", "is out of range");
  check_refused("self", "yes", "true or false");
  check_refused("gravity", "1 2", "three numbers");
  check_refused("gravity", "1 2 3 4", "three numbers");
  check_refused("gravity", "1-2 3", "three numbers");
  check_refused("gravity", "0 2000 0", "from -1000 to 1000 m/s^2");
  check_refused("method", "implicit_eulr", "did you mean implicit_euler?");
  check_refused("method", "leapfrog", "one of implicit_euler, symplectic_euler");
  check_refused("title", "a\x01", "control characters");
  static const char *const paths[] = {"", "/etc/passwd", "..", "../x", "a/../../x", "a/..", "C:x", "a\\b"};
  for (size_t i = 0; i < G_N_ELEMENTS(paths); i++) check_refused("file", paths[i], "stays inside the scene's folder");
  check_refused("body", "", "is not a name");
  check_refused("body", "a b", "the name of an object (body)");
  check_refused("name", "1st", "is not a name");
  /* A value of any length is refused with a message that is whole. */
  char *endless = g_strnfill(100000, 'x');
  check_refused("stiffness", endless, "is not a number");
  check_refused("method", endless, "is not known");
  g_free(endless);
}

static void test_check(void) {
  SporeError error = SPORE_ERROR_INIT;
  SporeValue value = {.type = SPORE_REAL, .number = {5}};
  g_assert_true(spore_parameter_check(get("stiffness"), &value, &error));
  static const double bad[] = {NAN, INFINITY, -1, 2e6};
  for (size_t i = 0; i < G_N_ELEMENTS(bad); i++) {
    value.number[0] = bad[i];
    g_assert_false(spore_parameter_check(get("stiffness"), &value, &error));
  }
  value = (SporeValue){.type = SPORE_REAL};
  g_assert_false(spore_parameter_check(get("count"), &value, &error));
  value = (SporeValue){.type = SPORE_CHOICE, .number = {2}};
  g_assert_false(spore_parameter_check(get("method"), &value, &error));
  value = (SporeValue){.type = SPORE_BOOLEAN, .number = {0.5}};
  g_assert_false(spore_parameter_check(get("self"), &value, &error));
  value = (SporeValue){.type = SPORE_VECTOR, .number = {0, 0, NAN}};
  g_assert_false(spore_parameter_check(get("gravity"), &value, &error));
  value = (SporeValue){.type = SPORE_NAME};
  g_assert_false(spore_parameter_check(get("name"), &value, &error));
  g_assert_nonnull(strstr(error.message, "name is missing"));
  value = (SporeValue){.type = SPORE_REFERENCE};
  g_assert_true(spore_parameter_check(get("body"), &value, &error));
  g_assert_false(spore_parameter_check(get("name"), &value, NULL));
}

static void test_values(void) {
  SporeValue value, copy;
  for (size_t i = 0; i < table.count; i++) {
    g_assert_true(spore_parameter_initial(&list[i], &value));
    g_assert_true(spore_value_copy(&copy, &value));
    g_assert_true(spore_value_equal(&copy, &value));
    if (value.text) g_assert_true(copy.text != value.text);
    spore_value_clear(&value);
    spore_value_clear(&copy);
  }
  SporeValue zero = {.type = SPORE_REAL, .number = {0}}, minus = {.type = SPORE_REAL, .number = {-0.0}};
  g_assert_false(spore_value_equal(&zero, &minus));
  minus.type = SPORE_INTEGER;
  g_assert_false(spore_value_equal(&zero, &minus));
}

static void test_fields(void) {
  Fields fields;
  memset(&fields, 0xFF, sizeof fields);
  spore_parameters_set_initial(&table, &fields);
  g_assert_cmpfloat(fields.stiffness, ==, 100);
  g_assert_cmpint(fields.count, ==, 10);
  g_assert_true(fields.self);
  g_assert_cmpfloat(fields.gravity[1], ==, -9.81);
  g_assert_cmpint(fields.method, ==, 1);
  g_assert_cmpstr(fields.title, ==, "untitled");
  g_assert_null(fields.file);
  SporeError error = SPORE_ERROR_INIT;
  g_assert_false(spore_parameters_check(&table, &fields, &error));
  g_assert_nonnull(strstr(error.message, "file is missing"));
  fields.file = "a.stl";
  fields.name = "liver";
  g_assert_true(spore_parameters_check(&table, &fields, &error));
  SporeValue value = {.type = SPORE_INTEGER, .number = {-3}};
  spore_parameter_store(get("count"), &value, &fields);
  g_assert_cmpint(fields.count, ==, -3);
  g_assert_false(spore_parameters_check(&table, &fields, &error));
  g_assert_nonnull(strstr(error.message, "count=\"-3\""));
}

static void test_without_memory(void) {
  SporeError error = SPORE_ERROR_INIT;
  SporeValue value = {.type = SPORE_TEXT}, from = {.type = SPORE_TEXT, .text = (char[]){"x"}};
  spore_allocation_fail_at(1);
  g_assert_false(spore_parameter_parse(get("title"), "x", &value, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_MEMORY);
  spore_allocation_fail_at(1);
  g_assert_false(spore_value_copy(&value, &from));
  spore_allocation_fail_at(1);
  g_assert_false(spore_parameter_initial(get("title"), &value));
  g_assert_null(value.text);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/parameter/find", test_find);
  g_test_add_func("/parameter/round-trip", test_round_trip);
  g_test_add_func("/parameter/refused", test_refused);
  g_test_add_func("/parameter/check", test_check);
  g_test_add_func("/parameter/values", test_values);
  g_test_add_func("/parameter/fields", test_fields);
  g_test_add_func("/parameter/without-memory", test_without_memory);
  return g_test_run();
}
