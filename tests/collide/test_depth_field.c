/* The depth field of spheres, and how a ball that slides over spheres feels it and the spheres one by one. */
#include <glib.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/collide/depth_field.h"

/* rows x columns spheres of radius 1, tops at y = 0. */
static void make_floor(SporeDepthField *field, int side, double spacing) {
  size_t count = (size_t)side * (size_t)side;
  double *centre = g_new(double, 3 * count), *radius = g_new(double, count);
  for (size_t i = 0; i < count; i++) {
    spore_vec3_store(centre + 3 * i, spore_vec3(((double)(i % (size_t)side) - side / 2) * spacing, -1,
                                                ((double)(i / (size_t)side) - side / 2) * spacing));
    radius[i] = 1;
  }
  g_assert_true(spore_depth_field_create(field, centre, radius, NULL, 0, count));
  g_free(centre);
  g_free(radius);
}

static double angle_to_up(SporeVec3 normal) { return acos(fmin(1, normal.y)) * 180 / G_PI; }

typedef struct Felt {
  double mean, ripple, angle, worst_angle; /* depth or force over stiffness, its deviation; degrees */
} Felt;

static void add_felt(Felt *felt, double depth, SporeVec3 normal) {
  felt->mean += depth;
  felt->ripple += depth * depth;
  felt->angle += angle_to_up(normal);
  felt->worst_angle = fmax(felt->worst_angle, angle_to_up(normal));
}

static void finish_felt(Felt *felt, double count) {
  felt->mean /= count;
  felt->ripple = sqrt(fmax(0, felt->ripple / count - felt->mean * felt->mean));
  felt->angle /= count;
}

/* Sum of the forces of all spheres over their stiffness, and the nearest sphere. */
static SporeVec3 pairwise(const SporeDepthField *field, SporeVec3 centre, double radius, uint32_t *nearest) {
  SporeVec3 sum = {0, 0, 0};
  double deepest = -HUGE_VAL;
  for (uint32_t i = 0; i < field->count; i++) {
    SporeVec3 offset = spore_vec3_sub(centre, spore_vec3_load(field->ball + 4 * i));
    double distance = spore_vec3_length(offset), depth = radius + field->ball[4 * i + 3] - distance;
    if (depth > deepest) deepest = depth, *nearest = i;
    if (depth > 0) sum = spore_vec3_add_scaled(sum, depth / distance, offset);
  }
  return sum;
}

/* A ball slides a tenth of a radius deep over a floor of spheres. */
static void test_floor(void) {
  static const double spacings[] = {0.7, 1, 1.4}, radii[] = {0.25, 1, 4};
  const double depth = 0.1;
  for (size_t s = 0; s < G_N_ELEMENTS(spacings); s++) {
    SporeDepthField field;
    make_floor(&field, 15, spacings[s]);
    for (size_t r = 0; r < G_N_ELEMENTS(radii); r++) {
      Felt one_by_one = {0}, smooth = {0};
      int count = 0;
      for (double x = -0.5; x <= 0.5; x += 0.05)
        for (double z = -0.5; z <= 0.5; z += 0.05, count++) {
          uint32_t nearest = 0;
          SporeVec3 centre = {x * spacings[s], radii[r] - depth, z * spacings[s]}, normal;
          SporeVec3 force = pairwise(&field, centre, radii[r], &nearest);
          add_felt(&one_by_one, spore_vec3_length(force), spore_vec3_normalise(force, (SporeVec3){0, 1, 0}));
          double felt = spore_depth_field_ball(&field, nearest, centre, radii[r], &normal);
          add_felt(&smooth, felt, normal);
        }
      finish_felt(&one_by_one, count);
      finish_felt(&smooth, count);
      g_test_message("ball of %g on spheres %g apart, %g deep: one by one %.3f +- %.3f, normal off by %.1f, at worst "
                     "%.1f degrees; depth field %.3f +- %.3f, %.1f, %.1f degrees",
                     radii[r], spacings[s], depth, one_by_one.mean, one_by_one.ripple, one_by_one.angle,
                     one_by_one.worst_angle, smooth.mean, smooth.ripple, smooth.angle, smooth.worst_angle);
      if (spacings[s] > 1) continue; /* hollows deeper than the field fills */
      g_assert_cmpfloat(fabs(smooth.mean - depth), <, 0.03 * depth);
      g_assert_cmpfloat(smooth.ripple, <, 0.03 * depth);
      g_assert_cmpfloat(smooth.worst_angle, <, 2);
    }
    spore_depth_field_clear(&field);
  }
}

/* Spheres too far apart to be felt together are spheres. */
static void test_alone(void) {
  static const double centre[] = {0, 0, 0, 10, 0, 0}, radius[] = {1, 0.5};
  SporeDepthField field;
  g_assert_true(spore_depth_field_create(&field, centre, radius, NULL, 0, 2));
  SporeVec3 normal, out = spore_vec3_normalise(spore_vec3(1, 2, 3), spore_vec3(0, 1, 0));
  double depth = spore_depth_field_ball(&field, 0, spore_vec3_scale(1.2, out), 0.3, &normal);
  g_assert_cmpfloat(fabs(depth - 0.1), <, 1e-12);
  g_assert_cmpfloat(spore_vec3_distance(normal, out), <, 1e-12);
  depth = spore_depth_field_ball(&field, 1, spore_vec3(10, 0, 0), 0.1, &normal); /* centre in centre */
  g_assert_cmpfloat(fabs(depth - 0.6), <, 1e-12);
  g_assert_cmpfloat(spore_vec3_length(normal), ==, 1);
  spore_depth_field_clear(&field);
}

static void test_gradient(void) {
  GRand *random = g_rand_new_with_seed(3);
  SporeDepthField field;
  make_floor(&field, 9, 1.1);
  uint32_t middle = 40;
  for (int i = 0; i < 1000; i++) {
    SporeVec3 point = {g_rand_double_range(random, -0.5, 0.5), g_rand_double_range(random, -0.3, 0.3),
                       g_rand_double_range(random, -0.5, 0.5)};
    SporeVec3 gradient, unused;
    spore_depth_field_at(&field, middle, point, &gradient);
    for (int axis = 0; axis < 3; axis++) {
      SporeVec3 step = {axis == 0, axis == 1, axis == 2};
      double ahead = spore_depth_field_at(&field, middle, spore_vec3_add_scaled(point, 1e-6, step), &unused);
      double behind = spore_depth_field_at(&field, middle, spore_vec3_add_scaled(point, -1e-6, step), &unused);
      g_assert_cmpfloat(fabs((ahead - behind) / 2e-6 - spore_vec3_dot(gradient, step)), <, 1e-7);
    }
  }
  spore_depth_field_clear(&field);
  g_rand_free(random);
}

/* A level takes its length off what is felt, of a ball with weight w level / w off its radius; where no sphere reaches,
 * a ball is as far away as the nearest. */
static void test_level(void) {
  static const double centre[] = {0, 0, 0, 10, 0, 0}, radius[] = {1, 0.9}, weight[] = {1, 0.5};
  SporeDepthField field;
  SporeVec3 normal, out = spore_vec3_normalise(spore_vec3(1, 2, 3), spore_vec3(0, 1, 0));
  g_assert_true(spore_depth_field_create(&field, centre, radius, weight, 0.2, 2));
  double depth = spore_depth_field_ball(&field, 0, spore_vec3_scale(1, out), 0.3, &normal);
  g_assert_cmpfloat(fabs(depth - 0.1), <, 1e-12);
  g_assert_cmpfloat(spore_vec3_distance(normal, out), <, 1e-12);
  depth = spore_depth_field_ball(&field, 0, spore_vec3_scale(1.2, out), 0.3, &normal); /* ends where the sphere does */
  g_assert_cmpfloat(fabs(depth + 0.1), <, 1e-12);
  depth = spore_depth_field_ball(&field, 0, spore_vec3_scale(1.7, out), 0.3, &normal);
  g_assert_cmpfloat(fabs(depth + 0.4), <, 1e-12);
  g_assert_cmpfloat(fabs(spore_depth_field_felt_radius(&field, 0) - 0.8), <, 1e-3);
  g_assert_cmpfloat(fabs(spore_depth_field_felt_radius(&field, 1) - 0.5), <, 1e-3);
  spore_depth_field_clear(&field);
}

/* Neighbours are all those that count: the field does not jump where another sphere becomes the nearest. */
static void test_nearest(void) {
  SporeDepthField field;
  make_floor(&field, 9, 1.2);
  SporeVec3 left, right, place = {0.6, -0.1, 0.2};
  double a = spore_depth_field_at(&field, 40, place, &left), b = spore_depth_field_at(&field, 41, place, &right);
  g_assert_cmpfloat(fabs(a - b), <, 1e-12);
  g_assert_cmpfloat(spore_vec3_distance(left, right), <, 1e-12);
  spore_depth_field_clear(&field);
}

/* Spheres with weights of their own: the sum is what it says, its slope is that of the sum, and one of weight 1 is felt
 * as the sphere. */
static void test_weights(void) {
  static const double centre[] = {0, 0, 0, 0.8, 0, 0, 0.3, 0.6, 0.1}, radius[] = {1, 0.9, 0.7},
                      weight[] = {0.5, 0.7, 0.25}, one[] = {1, 1};
  GRand *random = g_rand_new_with_seed(5);
  SporeDepthField field;
  g_assert_true(spore_depth_field_create(&field, centre, radius, weight, 0, 3));
  for (int i = 0; i < 1000; i++) {
    SporeVec3 point = {g_rand_double_range(random, -0.9, 0.9), g_rand_double_range(random, -0.9, 0.9),
                       g_rand_double_range(random, -0.9, 0.9)};
    SporeVec3 slope, unused;
    double sum = 0, value = spore_depth_field_at(&field, 0, point, &slope), near_edge = 1;
    for (int k = 0; k < 3; k++) {
      double depth = radius[k] - spore_vec3_distance(point, spore_vec3_load(centre + 3 * k));
      sum += weight[k] * fmax(0, depth);
      near_edge = fmin(near_edge, fabs(depth));
    }
    g_assert_cmpfloat(fabs(value - sum), <, 1e-15);
    for (int axis = 0; axis < 3 && near_edge > 1e-5; axis++) {
      SporeVec3 step = {axis == 0, axis == 1, axis == 2};
      double ahead = spore_depth_field_at(&field, 0, spore_vec3_add_scaled(point, 1e-6, step), &unused);
      double behind = spore_depth_field_at(&field, 0, spore_vec3_add_scaled(point, -1e-6, step), &unused);
      g_assert_cmpfloat(fabs((ahead - behind) / 2e-6 - spore_vec3_dot(slope, step)), <, 1e-5);
    }
  }
  spore_depth_field_clear(&field);
  static const double apart[] = {0, 0, 0, 10, 0, 0};
  SporeVec3 normal, out = spore_vec3_normalise(spore_vec3(1, 2, 3), spore_vec3(0, 1, 0));
  g_assert_true(spore_depth_field_create(&field, apart, radius, one, 0, 2));
  double depth = spore_depth_field_ball(&field, 0, spore_vec3_scale(1.2, out), 0.3, &normal);
  g_assert_cmpfloat(fabs(depth - 0.1), <, 1e-12);
  g_assert_cmpfloat(spore_vec3_distance(normal, out), <, 1e-12);
  spore_depth_field_clear(&field);
  g_rand_free(random);
}

static void test_without_memory(void) {
  static const double centre[] = {0, 0, 0, 1, 0, 0}, radius[] = {1, 1};
  for (guint64 n = 1;; n++) {
    SporeDepthField field;
    spore_allocation_fail_at(n);
    bool made = spore_depth_field_create(&field, centre, radius, NULL, 0, 2);
    spore_allocation_fail_at(0);
    if (made) {
      g_assert_cmpuint(n, >, 8);
      spore_depth_field_clear(&field);
      break;
    }
    g_assert_null(field.ball);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/depth-field/floor", test_floor);
  g_test_add_func("/depth-field/alone", test_alone);
  g_test_add_func("/depth-field/gradient", test_gradient);
  g_test_add_func("/depth-field/nearest", test_nearest);
  g_test_add_func("/depth-field/weights", test_weights);
  g_test_add_func("/depth-field/level", test_level);
  g_test_add_func("/depth-field/without-memory", test_without_memory);
  return g_test_run();
}
