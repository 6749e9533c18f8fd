/* Every registered model: its declaration, making and unmaking, and what it refuses. */
#include "tests/conformance/specimen.h"

static void check_type(gconstpointer data) {
  const Specimen *specimen = data;
  SporeError error = SPORE_ERROR_INIT;
  if (!spore_model_type_check(specimen->type, &error)) g_error("%s: %s", error.place, error.message);
  g_assert_true(spore_model_type_find(spore_model_registry, specimen->type->name) == specimen->type);
  g_assert_true(spore_parameters_check(&specimen->type->parameters, specimen->fields, &error));
}

static void check_create(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  g_assert_true(model->type == specimen->type);
  g_assert_cmpuint(model->block_count, >, 0);
  double mass = spore_model_total_mass(model);
  g_assert_true(isfinite(mass) && mass > 0);
  g_test_message("%s: %zu blocks, %g kg", specimen->name, model->block_count, mass);
  model->type->destroy(model);
}

/* Leaks show in the sanitizer run. */
static void check_create_without_memory(gconstpointer data) {
  const Specimen *specimen = data;
  for (uint64_t n = 1;; n++) {
    SporeError error = SPORE_ERROR_INIT;
    spore_allocation_fail_at(n);
    SporeModel *model = specimen->type->create(&specimen->geometry, specimen->fields, &error);
    spore_allocation_fail_at(0);
    if (model) {
      model->type->destroy(model);
      g_assert_cmpuint(n, >, 1);
      g_test_message("%s: %u allocations refused in turn", specimen->name, (unsigned)n - 1);
      return;
    }
    g_assert_cmpint(error.code, ==, SPORE_ERROR_MEMORY);
    g_assert_cmpstr(error.message, !=, "");
  }
}

static void check_bad_numbers(gconstpointer data) {
  const Specimen *specimen = data;
  const SporeParameterTable *table = &specimen->type->parameters;
  const double bad[] = {NAN, INFINITY, -INFINITY};
  for (size_t p = 0; p < table->count; p++) {
    if (table->parameters[p].type != SPORE_REAL) continue;
    char *fields = g_memdup2(specimen->fields, table->size);
    double *field = (double *)(void *)(fields + table->parameters[p].offset);
    for (unsigned b = 0; b < G_N_ELEMENTS(bad); b++) {
      SporeError error = SPORE_ERROR_INIT;
      *field = bad[b];
      g_assert_false(spore_parameters_check(table, fields, &error));
      g_assert_nonnull(strstr(error.message, table->parameters[p].name));
    }
    g_free(fields);
  }
}

static void check_without_geometry(gconstpointer data) {
  const Specimen *specimen = data;
  SporeError error = SPORE_ERROR_INIT;
  SporeGeometry nothing = {0};
  if (specimen->type->geometry == SPORE_GEOMETRY_NONE) return;
  g_assert_null(specimen->type->create(&nothing, specimen->fields, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  g_assert_cmpstr(error.message, !=, "");
}

/* A coordinate that is no number, a radius below 0. */
static void check_broken_curve(const Specimen *specimen) {
  for (size_t i = 5; i <= 7; i += 2) {
    double *number = specimen->curve.points + i, kept = *number;
    SporeError error = SPORE_ERROR_INIT;
    *number = i == 5 ? NAN : -kept;
    g_assert_null(specimen->type->create(&specimen->geometry, specimen->fields, &error));
    g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
    g_test_message("%s: %s", error.place, error.message);
    *number = kept;
  }
}

/* Geometry that came past the loader all the same: coordinates that are no numbers, corners that do not exist. */
static void check_broken_geometry(gconstpointer data) {
  const Specimen *specimen = data;
  if (specimen->type->geometry == SPORE_GEOMETRY_NONE) return;
  if (specimen->type->geometry == SPORE_GEOMETRY_CURVE) {
    check_broken_curve(specimen);
    return;
  }
  gboolean solid = specimen->type->geometry == SPORE_GEOMETRY_TETRAHEDRA;
  double *x = solid ? specimen->tetrahedra.vertices : specimen->surface.vertices;
  uint32_t *corner = solid ? specimen->tetrahedra.tetrahedra : specimen->surface.triangles;
  double kept_x = x[4];
  uint32_t kept_corner = corner[2];
  for (int i = 0; i < 2; i++) {
    SporeError error = SPORE_ERROR_INIT;
    if (i == 0) x[4] = NAN;
    else corner[2] = 1000000;
    g_assert_null(specimen->type->create(&specimen->geometry, specimen->fields, &error));
    g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
    g_test_message("%s: %s", error.place, error.message);
    x[4] = kept_x;
    corner[2] = kept_corner;
  }
}

/* Returns a value in range that differs from `value`. */
static double another(const SporeParameter *parameter, double value) {
  double twice = value == 0 ? 1e-3 : 2 * value, half = 0.5 * value;
  return twice <= parameter->maximum ? twice : half;
}

static void check_retune(gconstpointer data) {
  const Specimen *specimen = data;
  const SporeParameterTable *table = &specimen->type->parameters;
  GRand *random = g_rand_new_with_seed(5);
  unsigned live = 0;
  for (size_t p = 0; p < table->count; p++) {
    const SporeParameter *parameter = &table->parameters[p];
    if (parameter->change != SPORE_CHANGE_LIVE || parameter->type != SPORE_REAL) continue;
    live++;
    Specimen changed = *specimen;
    changed.fields = g_memdup2(specimen->fields, table->size);
    double *field = (double *)(void *)((char *)changed.fields + parameter->offset);
    *field = another(parameter, *field);
    SporeModel *tuned = specimen_model(specimen), *fresh = specimen_model(&changed);
    State state = state_random(tuned, random, 1.1, 0.3 * specimen->size);
    double *before = model_force(tuned, &state), stain = tuned->stain;
    g_assert_true(tuned->type->retune(tuned, changed.fields, NULL));
    double *after = model_force(tuned, &state), *expected = model_force(fresh, &state);
    g_assert_cmpmem(after, state.v_count * sizeof(double), expected, state.v_count * sizeof(double));
    g_assert_cmpfloat(tuned->stain, ==, fresh->stain);
    /* The parameter does something. */
    g_assert_true(vector_distance(before, after, state.v_count) > 0 || tuned->stain != stain);
    g_free(before);
    g_free(after);
    g_free(expected);
    state_clear(&state);
    tuned->type->destroy(tuned);
    fresh->type->destroy(fresh);
    g_free(changed.fields);
  }
  g_assert_true(live == 0 || specimen->type->retune);
  g_rand_free(random);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  specimen_add_tests("/conformance/type", check_type, NULL);
  specimen_add_tests("/conformance/create", check_create, NULL);
  specimen_add_tests("/conformance/create_without_memory", check_create_without_memory, NULL);
  specimen_add_tests("/conformance/bad_numbers", check_bad_numbers, NULL);
  specimen_add_tests("/conformance/without_geometry", check_without_geometry, NULL);
  specimen_add_tests("/conformance/broken_geometry", check_broken_geometry, NULL);
  specimen_add_tests("/conformance/retune", check_retune, NULL);
  return g_test_run();
}
