/* Distance, angle and volume are what geometry says, and read with their units. */
#include "core/scene/gauge.h"
#include "tests/scene/fixture.h"

static const SporeVec3 corner = {0.2, -0.1, 7};

static double of(const char *name, SporeVec3 a, SporeVec3 b, SporeVec3 c) {
  const SporeVec3 places[SPORE_GAUGE_PLACES] = {spore_vec3_add(corner, a), spore_vec3_add(corner, b),
                                                spore_vec3_add(corner, c)};
  return spore_gauge_find(name)->of_places(places);
}

static void assert_text(const char *name, double figure, const char *text) {
  g_autofree char *is = spore_gauge_find(name)->text(figure);
  g_assert_cmpstr(is, ==, text);
}

static void test_distance(void) {
  const SporeVec3 none = {0, 0, 0};
  g_assert_cmpfloat_with_epsilon(of("distance", none, spore_vec3(0.03, 0.04, 0.12), none), 0.13, 1e-14);
  g_assert_cmpfloat(of("distance", none, none, none), ==, 0);
  assert_text("distance", 0.13, "130 mm");
  assert_text("distance", 0.0042, "4.2 mm");
}

static void test_angle(void) {
  const SporeVec3 none = {0, 0, 0}, along = {0.05, 0, 0};
  g_assert_cmpfloat_with_epsilon(of("angle", along, none, spore_vec3(0, 0, -0.3)), G_PI_2, 1e-12);
  g_assert_cmpfloat_with_epsilon(of("angle", along, none, spore_vec3(-0.01, 0.01, 0)), 3 * G_PI_4, 1e-12);
  g_assert_cmpfloat_with_epsilon(of("angle", along, none, spore_vec3(-0.2, 0, 0)), G_PI, 1e-12);
  /* An angle that a cosine in doubles cannot tell from 0. */
  const SporeVec3 narrow[] = {{1, 0, 0}, {0, 0, 0}, {1, 1e-9, 0}};
  g_assert_cmpfloat_with_epsilon(spore_gauge_find("angle")->of_places(narrow), 1e-9, 1e-15);
  g_assert_cmpfloat(of("angle", none, none, along), ==, 0);
  assert_text("angle", G_PI / 3, "60.0°");
}

static void test_volume(void) {
  /* A box of 2 x 3 x 4 cm, far from the origin. */
  double vertices[8][3];
  uint32_t triangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                               {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (int i = 0; i < 8; i++) {
    vertices[i][0] = 50 + (i & 1 ? 0.02 : 0);
    vertices[i][1] = i & 2 ? 0.03 : 0;
    vertices[i][2] = i & 4 ? 0.04 : 0;
  }
  SporeTriangleMesh box = {
      .vertex_count = 8, .triangle_count = 12, .vertices = &vertices[0][0], .triangles = &triangles[0][0]};
  double volume = -1;
  GError *error = NULL;
  g_assert_true(spore_gauge_volume(&box, &volume, &error));
  g_assert_cmpfloat_with_epsilon(volume, 2.4e-5, 1e-15);
  for (int t = 0; t < 12; t++) {
    uint32_t second = triangles[t][1];
    triangles[t][1] = triangles[t][2], triangles[t][2] = second;
  }
  g_assert_true(spore_gauge_volume(&box, &volume, &error));
  g_assert_cmpfloat_with_epsilon(volume, 2.4e-5, 1e-15); /* inside out */
  box.triangle_count = 11;
  g_assert_false(spore_gauge_volume(&box, &volume, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "not closed (3 open, 0 non-manifold, 0 misoriented edges)");
  box.triangle_count = 0;
  g_assert_false(spore_gauge_volume(&box, &volume, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "not closed");
  assert_text("volume", 2.4e-5, "24 cm³");
  assert_text("volume", 3e-9, "3 mm³");
}

static void test_kinds(void) {
  g_assert_null(spore_gauge_find("weight"));
  for (const SporeGauge *const *gauge = spore_gauges; *gauge; gauge++) {
    g_assert_true(spore_gauge_find((*gauge)->name) == *gauge);
    g_assert_cmpuint((*gauge)->place_count, <=, SPORE_GAUGE_PLACES);
    for (guint i = 0; i < (*gauge)->place_count; i++) g_assert_nonnull((*gauge)->hints[i]);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/gauge/distance", test_distance);
  g_test_add_func("/gauge/angle", test_angle);
  g_test_add_func("/gauge/volume", test_volume);
  g_test_add_func("/gauge/kinds", test_kinds);
  return g_test_run();
}
