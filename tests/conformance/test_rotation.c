/* Rotations of tetrahedra in closed form against the general polar decomposition, whatever the tetrahedron has been
 * through. */
#include <glib.h>
#include <math.h>

#include "core/base/memory.h"
#include "models/registry.h"
#include "tests/conformance/shapes.h"

/* One corotational tetrahedron whose Dm is the identity, with mu = 1 and lambda = 0: the forces on corners 1..3 are the
 * columns of (R - F) / 3. */
static SporeModel *unit_tetrahedron(void) {
  SporeTetrahedralMesh mesh = {0};
  g_assert_true(spore_tetrahedral_mesh_allocate(&mesh, 4, 1, NULL));
  for (uint32_t i = 0; i < 4; i++) mesh.tetrahedra[i] = i;
  for (int k = 0; k < 3; k++) mesh.vertices[3 * (k + 1) + k] = 1;
  const SporeModelType *type = &spore_corotational_tetrahedra;
  char *fields = g_malloc0(type->parameters.size);
  spore_parameters_set_initial(&type->parameters, fields);
  const struct {
    const char *name;
    double number;
  } set[] = {{"young_modulus", 2}, {"poisson_ratio", 0}, {"stiffness_damping", 0}};
  for (size_t i = 0; i < G_N_ELEMENTS(set); i++) {
    SporeValue value = {.type = SPORE_REAL, .number = {set[i].number}};
    const SporeParameter *parameter =
        type->parameters.parameters + spore_parameter_find(&type->parameters, set[i].name);
    spore_parameter_store(parameter, &value, fields);
  }
  SporeModel *model = type->create(&(SporeGeometry){.tetrahedra = &mesh}, fields, NULL);
  g_assert_nonnull(model);
  g_free(fields);
  spore_tetrahedral_mesh_clear(&mesh);
  return model;
}

/* Largest difference of R from that of the general decomposition, times the least sum of two stretches relative to the
 * mean: what the decomposition is ill-conditioned by. */
static double error_of(const SporeModel *model, SporeMat3 f) {
  double q[12] = {0}, v[12] = {0}, force[12] = {0}, worst = 0, value[3];
  for (int k = 0; k < 3; k++) spore_vec3_store(q + 3 * (k + 1), spore_mat3_column(f, k));
  model->type->force(model, q, q, v, force);
  SporeMat3 r, s, unused;
  spore_mat3_polar(f, &r, &s);
  spore_mat3_eigen_symmetric(s, value, &unused);
  double size = fmax(fabs(value[0]), fabs(value[2])), condition = (value[0] + value[1]) / size;
  for (int k = 0; k < 3; k++) {
    SporeVec3 expected = spore_vec3_sub(spore_mat3_column(r, k), spore_mat3_column(f, k));
    SporeVec3 found = spore_vec3_scale(3, spore_vec3_load(force + 3 * (k + 1)));
    worst = fmax(worst, spore_vec3_distance(expected, found));
  }
  return worst / fmax(1, size) * fmin(1, condition);
}

static SporeMat3 stretched(GRand *random, double a, double b, double c) {
  SporeMat3 axes = spore_quat_to_mat3(shape_random_rotation(random));
  SporeMat3 turn = spore_quat_to_mat3(shape_random_rotation(random));
  return spore_mat3_multiply(spore_mat3_multiply(turn, spore_mat3_diagonal(a, b, c)), spore_mat3_transpose(axes));
}

static void check_family(const char *name, double low, double high, double third_sign) {
  SporeModel *model = unit_tetrahedron();
  GRand *random = g_rand_new_with_seed(9);
  double worst = 0;
  for (int trial = 0; trial < 20000; trial++) {
    double stretch[3];
    for (int k = 0; k < 3; k++) stretch[k] = pow(10, g_rand_double_range(random, low, high));
    double least = fmin(stretch[0], fmin(stretch[1], stretch[2]));
    for (int k = 0; k < 3; k++)
      if (stretch[k] == least) stretch[k] *= third_sign;
    worst = fmax(worst, error_of(model, stretched(random, stretch[0], stretch[1], stretch[2])));
  }
  g_test_message("%s: worst error %.1e", name, worst);
  g_assert_cmpfloat(worst, <, 5e-15);
  g_rand_free(random);
  model->type->destroy(model);
}

static void test_mild(void) { check_family("stretches from 0.9 to 1.1", -0.045, 0.045, 1); }
static void test_wild(void) { check_family("stretches from 0.01 to 100", -2, 2, 1); }
static void test_flat(void) { check_family("flat, else from 0.5 to 2", -0.3, 0.3, 0); }
static void test_inverted(void) { check_family("inverted, from 0.3 to 3", -0.5, 0.5, -0.5); }
static void test_huge(void) { check_family("stretches about 1e30", 30, 31, 1); }

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/rotation/mild", test_mild);
  g_test_add_func("/rotation/wild", test_wild);
  g_test_add_func("/rotation/flat", test_flat);
  g_test_add_func("/rotation/inverted", test_inverted);
  g_test_add_func("/rotation/huge", test_huge);
  return g_test_run();
}
