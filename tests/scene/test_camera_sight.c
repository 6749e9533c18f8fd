/* Where cameras look: cases whose answer is known. */
#include <glib.h>
#include <math.h>

#include "core/scene/camera_sight.h"

static void assert_sight(const SporeCameraFields *fields, double x, double y, double z) {
  g_assert_cmpfloat_with_epsilon(spore_vec3_distance(spore_camera_sight(fields), spore_vec3(x, y, z)), 0, 1e-12);
}

static void test_straight(void) {
  SporeCameraFields fields = {.position = {0, 0, 0.1}, .target = {0.01, 0.02, 0}, .turn = 1};
  assert_sight(&fields, 0.01, 0.02, 0);
}

/* An optic of 30 degrees on a level shaft: down, to the right, up, to the left. */
static void test_aside(void) {
  SporeCameraFields fields = {.position = {0, 0, 0.1}, .angle = G_PI / 6};
  const double ahead = 0.1 - 0.1 * cos(G_PI / 6), away = 0.1 * sin(G_PI / 6);
  assert_sight(&fields, 0, -away, ahead);
  fields.turn = G_PI / 2;
  assert_sight(&fields, away, 0, ahead);
  fields.turn = G_PI;
  assert_sight(&fields, 0, away, ahead);
  fields.turn = -G_PI / 2;
  assert_sight(&fields, -away, 0, ahead);
}

/* From above and aslant, and straight down: as far away, at the angle. */
static void test_any_axis(void) {
  const double positions[][3] = {{0.1, 0.2, 0.05}, {-0.3, -0.1, -0.2}, {0, 0.2, 0}, {0, -0.2, 0}};
  for (guint i = 0; i < G_N_ELEMENTS(positions); i++)
    for (double turn = -3; turn < 3.2; turn += 1) {
      SporeCameraFields fields = {.angle = 0.7, .turn = turn};
      SporeVec3 position = spore_vec3_load(positions[i]), target = {0, 0, 0};
      for (int k = 0; k < 3; k++) fields.position[k] = positions[i][k];
      SporeVec3 sight = spore_camera_sight(&fields), view = spore_vec3_sub(sight, position);
      double distance = spore_vec3_length(position);
      g_assert_cmpfloat_with_epsilon(spore_vec3_length(view), distance, 1e-12);
      g_assert_cmpfloat_with_epsilon(-spore_vec3_dot(view, position) / (distance * distance), cos(0.7), 1e-12);
      g_assert_cmpfloat_with_epsilon(spore_camera_turn_to(position, target, sight), turn, 1e-9);
    }
  SporeCameraFields nowhere = {.angle = 0.7};
  assert_sight(&nowhere, 0, 0, 0);
  g_assert_cmpfloat(spore_camera_turn_to(spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), spore_vec3(1, 0, 0)), ==, 0);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/camera-sight/straight", test_straight);
  g_test_add_func("/camera-sight/aside", test_aside);
  g_test_add_func("/camera-sight/any-axis", test_any_axis);
  return g_test_run();
}
