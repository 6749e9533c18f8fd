/* A varied scene runs as the variation says, and the author's document stays as it is. */
#include "core/scene/variation.h"
#include "tests/scene/fixture.h"

#define SCENE                                                                                                          \
  "<spore version=\"1.0\"><solver time_step=\"0.004\" substeps=\"3\"/><assets>"                                        \
  "<mesh name=\"cube\" file=\"cube.off\"/></assets><bodies>"                                                           \
  "<body name=\"a\"><mechanical geometry=\"cube\" substeps=\"2\"><mass_spring_net mass=\"1\"/></mechanical>"           \
  "<collision/></body>"                                                                                                \
  "<body name=\"b\"><mechanical geometry=\"cube\"><mass_spring_net mass=\"1\"/></mechanical></body>"                   \
  "<body name=\"c\" role=\"unmovable\"/></bodies></spore>"

static SporeSimulation *make(SporeDocument *document, const SporeVariation *variation) {
  GError *error = NULL;
  SporeSimulation *simulation = spore_variation_make(document, variation, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  return simulation;
}

static double mass_of(const SporeSimulation *simulation, guint32 body) {
  return spore_model_total_mass(spore_world_body_model(simulation->world, body));
}

static void test_method(void) {
  char *folder = fixture_scene_folder_new(SCENE);
  SporeDocument *document = fixture_load(folder);
  gsize size, size_after;
  g_autofree char *before = spore_scene_format(document, &size);
  const SporeVariation variation = {.body = "a", .integrator = "rk4", .nonlinear = "broyden", .dt_s = 0.001};
  g_autoptr(SporeSimulation) simulation = make(document, &variation);
  SporeMethod method;
  g_assert_true(spore_world_body_method(simulation->world, 0, &method));
  g_assert_cmpstr(method.integrator.name, ==, "rk4");
  g_assert_cmpuint(method.substeps, ==, 1);
  g_assert_true(spore_world_body_method(simulation->world, 1, &method));
  g_assert_cmpstr(method.integrator.name, ==, "implicit_euler");
  g_assert_cmpstr(method.nonlinear.name, ==, "broyden");
  g_assert_cmpuint(method.substeps, ==, 3);
  spore_world_step(simulation->world);
  g_assert_cmpfloat_with_epsilon(spore_world_time_s(simulation->world), 0.001, 1e-12);
  g_autofree char *after = spore_scene_format(document, &size_after);
  g_assert_cmpstr(before, ==, after);
  spore_document_free(document);
  fixture_folder_free(folder);
}

static void test_factors(void) {
  char *folder = fixture_scene_folder_new(SCENE);
  SporeDocument *document = fixture_load(folder);
  g_autoptr(SporeSimulation) all = make(document, &(SporeVariation){.mass = 4, .stiffness = 10, .contact = 2});
  g_assert_cmpfloat_with_epsilon(mass_of(all, 0), 4, 1e-9);
  g_assert_cmpfloat_with_epsilon(mass_of(all, 1), 4, 1e-9);
  g_autoptr(SporeSimulation) second = make(document, &(SporeVariation){.mass = 4, .every_second = TRUE});
  g_assert_cmpfloat_with_epsilon(mass_of(second, 0), 1, 1e-9);
  g_assert_cmpfloat_with_epsilon(mass_of(second, 1), 4, 1e-9);
  spore_document_free(document);
  fixture_folder_free(folder);
}

static void test_refused(void) {
  char *folder = fixture_scene_folder_new(SCENE);
  SporeDocument *document = fixture_load(folder);
  GError *error = NULL;
  g_assert_null(spore_variation_make(document, &(SporeVariation){.body = "c"}, NULL, NULL, NULL, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "c: physics moves no body of that name");
  g_assert_null(spore_variation_make(document, &(SporeVariation){.integrator = "rk5"}, NULL, NULL, NULL, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "rk5");
  spore_document_free(document);
  fixture_folder_free(folder);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/variation/method", test_method);
  g_test_add_func("/variation/factors", test_factors);
  g_test_add_func("/variation/refused", test_refused);
  return g_test_run();
}
