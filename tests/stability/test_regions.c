/* Regions of another stiffness and density: two springs in a row, whole matrices, masses. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "models/registry.h"
#include "tests/mesh/shapes.h"

#define SIDE 0.08 /* m, of a cube */
#define CELLS 4   /* each way */
#define STIFFER 10.
#define DENSER 3.

typedef struct Case {
  const char *model, *element;
} Case;

static const Case cases[] = {
    {"corotational_tetrahedra", "0"}, {"neo_hookean_tetrahedra", "0"}, {"saint_venant_kirchhoff_tetrahedra", "0"},
    {"corotational_tetrahedra", "1"}, {"neo_hookean_tetrahedra", "1"}, {"saint_venant_kirchhoff_tetrahedra", "1"},
    {"linear_tetrahedra", NULL},      {"finite_differences", NULL}};

static void set(const SporeModelType *type, const char *name, double value, void *fields) {
  int index = spore_parameter_find(&type->parameters, name);
  if (index < 0) return;
  SporeValue set_to = {type->parameters.parameters[index].type, {value}, NULL};
  spore_parameter_store(&type->parameters.parameters[index], &set_to, fields);
}

/* A cube whose half above x = SIDE / 2 is stiffer and denser: what lies in a ball so large that its surface is plane.
 */
static SporeModel *make(const Case *one, SporeRegions *regions) {
  const SporeModelType *type = spore_model_type_find(spore_model_registry, one->model);
  SporeTetrahedralMesh cells;
  SporeTriangleMesh surface;
  SporeError error = SPORE_ERROR_INIT;
  const double lower[3] = {0, 0, 0}, upper[3] = {SIDE, SIDE, SIDE};
  shape_tetrahedral_box(&cells, CELLS, SIDE / CELLS);
  shape_box(&surface, lower, upper, CELLS);
  SporeGeometry geometry = {.surface = &surface, .tetrahedra = &cells, .regions = regions};
  void *fields = spore_allocate(1, type->parameters.size);
  spore_parameters_set_initial(&type->parameters, fields);
  set(type, "young_modulus", 1000, fields);
  set(type, "poisson_ratio", 0, fields);
  set(type, "density", 1000, fields);
  set(type, "cells", CELLS, fields);
  if (one->element) set(type, "element", one->element[0] - '0', fields);
  SporeModel *model = type->create(&geometry, fields, &error);
  if (!model) g_error("%s: %s", one->model, error.message);
  spore_free(fields);
  spore_tetrahedral_mesh_clear(&cells);
  spore_triangle_mesh_clear(&surface);
  return model;
}

typedef struct State {
  double *q, *v, *f;
} State;

static State place(const SporeModel *model) {
  const SporeVec3 none = {0, 0, 0};
  State state = {g_new0(double, model->q_count), g_new0(double, 3 * model->block_count),
                 g_new0(double, 3 * model->block_count)};
  model->type->place(model, spore_pose_identity(), none, none, state.q, state.v);
  return state;
}

static void clear(State *state) {
  g_free(state->q);
  g_free(state->v);
  g_free(state->f);
}

/* Pulled by a strain e of its softer half, the other has e / STIFFER: nothing pulls on the nodes between, and the ends
 * are pulled by E A e. Mass: of both halves. */
static void check_two_springs(gconstpointer data) {
  const Case *one = data;
  /* A dab within the ball changes nothing: an element is of a region once. */
  double balls[] = {SIDE / 2 + 1000, SIDE / 2, SIDE / 2, 1000, SIDE, SIDE / 2, SIDE / 2, 0.4 * SIDE};
  SporeRegion half = {2, balls, STIFFER, DENSER, 0};
  SporeRegions regions = {1, &half};
  SporeModel *model = make(one, &regions);
  State state = place(model);
  const double strain = 1e-6;
  for (size_t i = 0; i < model->node_count; i++) {
    double *x = state.q + 3 * i;
    *x += strain * (*x < SIDE / 2 ? *x : SIDE / 2 + (*x - SIDE / 2) / STIFFER);
  }
  State rest = place(model);
  model->type->force(model, state.q, state.q, state.v, state.f);
  double between = 0, ends[2] = {0, 0}, pull = 1000 * SIDE * SIDE * strain;
  for (size_t i = 0; i < model->node_count; i++) {
    double x = rest.q[3 * i], force = state.f[3 * i];
    if (x < 1e-9) ends[0] += force;
    else if (x > SIDE - 1e-9) ends[1] += force;
    else between = fmax(between, fabs(force));
  }
  double mass = spore_model_total_mass(model), expected = 1000 * SIDE * SIDE * SIDE * (1 + DENSER) / 2;
  g_test_message("%s: %zu elements; between %.2e of the pull, ends %.2e and %.2e off, mass %.2e off", one->model,
                 half.elements, between / pull, ends[0] / pull - 1, ends[1] / pull + 1, mass / expected - 1);
  g_assert_cmpuint(half.elements, >, 0);
  g_assert_cmpfloat(between, <, 1e-5 * pull);
  g_assert_cmpfloat(fabs(ends[0] / pull - 1), <, 1e-5);
  g_assert_cmpfloat(fabs(ends[1] / pull + 1), <, 1e-5);
  g_assert_cmpfloat(fabs(mass / expected - 1), <, 1e-12);
  clear(&state);
  clear(&rest);
  model->type->destroy(model);
}

/* The matrix is the force's derivative, the force the energy's, in a region as elsewhere. */
static void check_derivatives(gconstpointer data) {
  const Case *one = data;
  double balls[2][4] = {{0, 0, 0, 0.05}, {SIDE, SIDE, 0, 0.03}};
  SporeRegion parts[2] = {{1, balls[0], 7, 1, 0}, {1, balls[1], 0.2, 2, 0}};
  SporeRegions regions = {2, parts};
  SporeModel *model = make(one, &regions);
  State state = place(model);
  GRand *random = g_rand_new_with_seed(3);
  SporeBlockMatrix matrix;
  size_t n = 3 * model->block_count;
  g_autofree double *to = g_new0(double, n), *pulled = g_new0(double, n), *ahead = g_new0(double, n),
                    *behind = g_new0(double, n), *moved = g_new0(double, n);
  /* Stretched, so that no mode is clamped; linear solids, whose matrix leaves out how strain turns, hardly. */
  const double stretch = strcmp(one->model, "linear_tetrahedra") == 0 ? 2e-5 : 2e-3;
  for (size_t i = 0; i < n; i++) state.q[i] *= 1 + stretch * (double)(i % 3);
  for (size_t i = 0; i < n; i++) to[i] = g_rand_double_range(random, -1, 1);
  g_assert_true(spore_model_matrix_create(model, &matrix));
  spore_block_matrix_zero(&matrix);
  model->type->jacobian(model, state.q, state.q, state.v, 1, 0, &matrix);
  spore_block_matrix_multiply_add(&matrix, to, pulled);
  const double h = 1e-7;
  for (size_t i = 0; i < n; i++) moved[i] = state.q[i] + h * to[i];
  model->type->force(model, moved, moved, state.v, ahead);
  double energy = model->type->potential(model, moved), work = 0, off = 0, size = 0;
  for (size_t i = 0; i < n; i++) moved[i] = state.q[i] - h * to[i];
  model->type->force(model, moved, moved, state.v, behind);
  energy -= model->type->potential(model, moved);
  model->type->force(model, state.q, state.q, state.v, state.f);
  for (size_t i = 0; i < n; i++) {
    double slope = (behind[i] - ahead[i]) / (2 * h);
    off += (slope - pulled[i]) * (slope - pulled[i]);
    size += slope * slope;
    work -= state.f[i] * to[i];
  }
  g_test_message("%s: matrix off by %.2e, energy by %.2e", one->model, sqrt(off / size), energy / (2 * h) / work - 1);
  g_assert_cmpuint(parts[0].elements, >, 0);
  g_assert_cmpuint(parts[1].elements, >, 0);
  g_assert_cmpfloat(sqrt(off / size), <, 1e-5);
  g_assert_cmpfloat(fabs(energy / (2 * h) / work - 1), <, 1e-4);
  spore_block_matrix_clear(&matrix);
  g_rand_free(random);
  clear(&state);
  model->type->destroy(model);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  for (gsize i = 0; i < G_N_ELEMENTS(cases); i++) {
    g_autofree char *name = g_strdup_printf("%s%s", cases[i].model, cases[i].element ? cases[i].element : "");
    g_autofree char *springs = g_strconcat("/regions/two-springs/", name, NULL);
    g_autofree char *derivatives = g_strconcat("/regions/derivatives/", name, NULL);
    g_test_add_data_func(springs, &cases[i], check_two_springs);
    g_test_add_data_func(derivatives, &cases[i], check_derivatives);
  }
  return g_test_run();
}
