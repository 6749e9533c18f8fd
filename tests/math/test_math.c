/* 3x3 matrices and quaternions. */
#include <glib.h>
#include <math.h>

#include "core/math/quat.h"

static GRand *random_source;

static double uniform(double low, double high) { return g_rand_double_range(random_source, low, high); }

static SporeVec3 random_vec3(void) { return (SporeVec3){uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }

static SporeMat3 random_mat3(void) { return spore_mat3_from_columns(random_vec3(), random_vec3(), random_vec3()); }

static SporeMat3 random_rotation(void) {
  return spore_quat_to_mat3(spore_quat_from_rotation_vector(spore_vec3_scale(3, random_vec3())));
}

static double distance(SporeMat3 a, SporeMat3 b) {
  double largest = 0;
  for (int i = 0; i < 9; i++) largest = fmax(largest, fabs(a.m[i] - b.m[i]));
  return largest;
}

static void assert_rotation(SporeMat3 r) {
  g_assert_cmpfloat(distance(spore_mat3_multiply(spore_mat3_transpose(r), r), spore_mat3_identity()), <, 1e-14);
  g_assert_cmpfloat(fabs(spore_mat3_determinant(r) - 1), <, 1e-14);
}

static void test_invert(void) {
  for (int i = 0; i < 1000; i++) {
    double scale = pow(10, uniform(-100, 100));
    SporeMat3 a = spore_mat3_scale(scale, random_mat3()), inverse;
    if (!spore_mat3_invert(a, &inverse)) g_error("a random matrix is not singular");
    double condition = fabs(spore_mat3_determinant(spore_mat3_scale(1 / scale, a)));
    g_assert_cmpfloat(distance(spore_mat3_multiply(a, inverse), spore_mat3_identity()), <, 1e-14 / condition);
  }
  SporeMat3 untouched = spore_mat3_identity(), inverse = untouched;
  SporeMat3 flat = {{1, 2, 3, 2, 4, 6, 0, 1, 0}};
  g_assert_false(spore_mat3_invert(flat, &inverse));
  g_assert_false(spore_mat3_invert((SporeMat3){{0}}, &inverse));
  g_assert_false(spore_mat3_invert(spore_mat3_diagonal(1, NAN, 1), &inverse));
  g_assert_false(spore_mat3_invert(spore_mat3_diagonal(1, INFINITY, 1), &inverse));
  g_assert_cmpfloat(distance(inverse, untouched), ==, 0);
}

static void check_eigen(SporeMat3 a, double tolerance) {
  double values[3];
  SporeMat3 vectors;
  spore_mat3_eigen_symmetric(a, values, &vectors);
  assert_rotation(vectors);
  g_assert_cmpfloat(values[0], <=, values[1]);
  g_assert_cmpfloat(values[1], <=, values[2]);
  SporeMat3 rebuilt =
      spore_mat3_multiply(spore_mat3_multiply(vectors, spore_mat3_diagonal(values[0], values[1], values[2])),
                          spore_mat3_transpose(vectors));
  g_assert_cmpfloat(distance(rebuilt, a), <=, tolerance);
}

static void test_eigen(void) {
  for (int i = 0; i < 1000; i++) {
    SporeMat3 a = random_mat3();
    check_eigen(spore_mat3_add(a, spore_mat3_transpose(a)), 1e-14);
  }
  check_eigen(spore_mat3_identity(), 0);
  check_eigen((SporeMat3){{0}}, 0);
  check_eigen(spore_mat3_diagonal(3, 1, 2), 0);
  check_eigen(spore_mat3_outer((SporeVec3){1, 2, 3}, (SporeVec3){1, 2, 3}), 1e-14);
  check_eigen(spore_mat3_scale(1e200, spore_mat3_outer((SporeVec3){1, 2, 3}, (SporeVec3){1, 2, 3})), 1e186);
  check_eigen((SporeMat3){{1, 1e-9, 0, 1e-9, 1, 0, 0, 0, 1}}, 1e-15);
}

/* R a rotation, S symmetric, F = R S, and no rotation near R is nearer to F. */
static void check_polar(SporeMat3 f) {
  double scale = 0;
  for (int i = 0; i < 9; i++) scale = fmax(scale, fabs(f.m[i]));
  SporeMat3 r, s;
  spore_mat3_polar(f, &r, &s);
  assert_rotation(r);
  g_assert_cmpfloat(distance(s, spore_mat3_transpose(s)), ==, 0);
  g_assert_cmpfloat(distance(spore_mat3_multiply(r, s), f), <=, 4e-15 * scale);
  double best = spore_mat3_trace(s);
  for (int k = 0; k < 8; k++) {
    SporeMat3 nudge =
        spore_quat_to_mat3(spore_quat_from_rotation_vector(spore_vec3_scale(k < 4 ? 1e-3 : 2, random_vec3())));
    SporeMat3 other = spore_mat3_multiply(spore_mat3_transpose(spore_mat3_multiply(nudge, r)), f);
    g_assert_cmpfloat(spore_mat3_trace(other), <=, best + 1e-14 * scale);
  }
}

static void test_polar(void) {
  for (int i = 0; i < 1000; i++) check_polar(random_mat3());
  for (int i = 0; i < 200; i++) { /* stretches from 1 to 1e-16, of either handedness */
    SporeMat3 stretch = spore_mat3_diagonal(1, pow(10, uniform(-16, 0)), pow(10, uniform(-16, 0)) * (i % 2 ? 1 : -1));
    check_polar(spore_mat3_multiply(random_rotation(), spore_mat3_multiply(stretch, random_rotation())));
  }
  check_polar(spore_mat3_identity());
  check_polar(spore_mat3_scale(-1, spore_mat3_identity()));
  check_polar(spore_mat3_diagonal(1, 1, -1));
  check_polar(spore_mat3_diagonal(2, 0, 0));
  check_polar(spore_mat3_diagonal(0, 0, -3));
  check_polar(spore_mat3_diagonal(1, 1, 0));
  check_polar((SporeMat3){{0}});
  check_polar(spore_mat3_outer((SporeVec3){1, 2, 3}, (SporeVec3){-1, 0, 2}));
  check_polar(spore_mat3_scale(1e250, random_mat3()));
  check_polar(spore_mat3_scale(1e-250, random_mat3()));
  SporeMat3 r, s;
  spore_mat3_polar(spore_mat3_diagonal(NAN, 1, 1), &r, &s);
  assert_rotation(r);
}

/* A positive stretch is found exactly, whatever the rotation. */
static void test_polar_known(void) {
  for (int i = 0; i < 200; i++) {
    SporeMat3 rotation = random_rotation(), axes = random_rotation(), r, s;
    SporeMat3 stretch = spore_mat3_multiply(
        spore_mat3_multiply(axes, spore_mat3_diagonal(uniform(.1, 3), uniform(.1, 3), uniform(.1, 3))),
        spore_mat3_transpose(axes));
    spore_mat3_polar(spore_mat3_multiply(rotation, stretch), &r, &s);
    g_assert_cmpfloat(distance(r, rotation), <, 1e-13);
    g_assert_cmpfloat(distance(s, stretch), <, 1e-13);
  }
}

static void test_quat_rotation(void) {
  for (int i = 0; i < 1000; i++) {
    SporeQuat q = spore_quat_from_rotation_vector(spore_vec3_scale(6, random_vec3()));
    SporeVec3 v = random_vec3();
    SporeMat3 r = spore_quat_to_mat3(q);
    assert_rotation(r);
    g_assert_cmpfloat(spore_vec3_distance(spore_quat_rotate(q, v), spore_mat3_apply(r, v)), <, 1e-14);
    SporeQuat back = spore_quat_from_mat3(r);
    double dot = back.w * q.w + back.x * q.x + back.y * q.y + back.z * q.z;
    g_assert_cmpfloat(fabs(fabs(dot) - 1), <, 1e-14);
    SporeVec3 vector = spore_quat_to_rotation_vector(q);
    g_assert_cmpfloat(spore_vec3_length(vector), <=, G_PI + 1e-14);
    g_assert_cmpfloat(distance(spore_quat_to_mat3(spore_quat_from_rotation_vector(vector)), r), <, 1e-14);
  }
}

static void test_rotation_vector(void) {
  for (double angle = 1e-300; angle < 3; angle *= 1.7) {
    SporeVec3 v = {0, angle, 0}, back = spore_quat_to_rotation_vector(spore_quat_from_rotation_vector(v));
    g_assert_cmpfloat(fabs(back.y / angle - 1), <, 1e-14);
    g_assert_cmpfloat(back.x, ==, 0);
  }
  SporeVec3 quarter =
      spore_quat_rotate(spore_quat_from_rotation_vector((SporeVec3){0, 0, G_PI / 2}), (SporeVec3){1, 0, 0});
  g_assert_cmpfloat(spore_vec3_distance(quarter, (SporeVec3){0, 1, 0}), <, 1e-15);
  /* Half turns, where the trace is smallest. */
  for (int axis = 0; axis < 3; axis++) {
    SporeVec3 v = {axis == 0 ? G_PI : 0, axis == 1 ? G_PI : 0, axis == 2 ? G_PI : 0};
    SporeMat3 r = spore_quat_to_mat3(spore_quat_from_rotation_vector(v));
    g_assert_cmpfloat(distance(spore_quat_to_mat3(spore_quat_from_mat3(r)), r), <, 1e-15);
  }
}

static void test_normalise(void) {
  SporeQuat q = spore_quat_normalise((SporeQuat){0, 0, 0, 0});
  g_assert_cmpfloat(q.w, ==, 1);
  q = spore_quat_normalise((SporeQuat){NAN, 0, 0, 0});
  g_assert_cmpfloat(q.w, ==, 1);
  q = spore_quat_normalise((SporeQuat){0, 1e-200, 0, 0});
  g_assert_cmpfloat(q.x, ==, 1);
  q = spore_quat_normalise((SporeQuat){0, 0, -1e200, 0});
  g_assert_cmpfloat(q.y, ==, -1);
  for (int i = 0; i < 10000; i++) { /* once is enough, to the last bit */
    SporeQuat once = spore_quat_normalise((SporeQuat){uniform(-9, 9), uniform(-9, 9), uniform(-9, 9), uniform(-9, 9)});
    SporeQuat twice = spore_quat_normalise(once);
    g_assert_cmpmem(&once, sizeof once, &twice, sizeof twice);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  random_source = g_rand_new_with_seed(7);
  g_test_add_func("/math/invert", test_invert);
  g_test_add_func("/math/eigen", test_eigen);
  g_test_add_func("/math/polar", test_polar);
  g_test_add_func("/math/polar-known", test_polar_known);
  g_test_add_func("/math/quaternion-rotation", test_quat_rotation);
  g_test_add_func("/math/rotation-vector", test_rotation_vector);
  g_test_add_func("/math/normalise", test_normalise);
  int status = g_test_run();
  g_rand_free(random_source);
  return status;
}
