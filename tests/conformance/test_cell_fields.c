/* Strain and stress of elements against what they are in a block that is stretched alike everywhere. */
#include <glib.h>
#include <math.h>

#include "core/body/cell_fields.h"
#include "tests/conformance/specimen.h"

#define YOUNG 6000.0
#define POISSON 0.3
#define LONGER 1.2
#define THINNER 0.9

static void set(const SporeModelType *type, void *fields, const char *name, double number) {
  SporeValue value = {.type = SPORE_REAL, .number = {number}};
  const SporeParameter *parameter = type->parameters.parameters + spore_parameter_find(&type->parameters, name);
  spore_parameter_store(parameter, &value, fields);
}

/* A block that is known through and through. */
typedef struct Block {
  const SporeModelType *type;
  SporeTetrahedralMesh mesh;
  void *fields;
  SporeModel *model;
  SporeCellFields *cells;
  double *q, *values, *nodes;
} Block;

/* A sphere around one end is three times as stiff, where `regions`. */
static Block block_new(const SporeModelType *type, int variant, gboolean regions) {
  Block block = {.type = type, .fields = g_malloc0(type->parameters.size)};
  double ball[4] = {0, 0.05, 0.05, 0.1};
  SporeRegion region = {.ball_count = 1, .balls = ball, .stiffness = 3, .density = 1};
  SporeRegions parts = {1, &region};
  shape_block(&block.mesh, 3, 1, 1, spore_vec3(0.3, 0.1, 0.1));
  spore_parameters_set_initial(&type->parameters, block.fields);
  specimen_set_variant(type, variant, block.fields);
  set(type, block.fields, "young_modulus", YOUNG);
  set(type, block.fields, "poisson_ratio", POISSON);
  SporeGeometry geometry = {.tetrahedra = &block.mesh, .regions = regions ? &parts : NULL};
  block.model = spore_model_create(type, &geometry, block.fields, NULL);
  g_assert_nonnull(block.model);
  block.cells = spore_cell_fields_new(block.model, block.fields, NULL);
  g_assert_nonnull(block.cells);
  g_assert_cmpuint(spore_cell_fields_count(block.cells), ==, block.mesh.tetrahedron_count);
  block.q = vector_new(block.model->q_count);
  block.values = vector_new(block.mesh.tetrahedron_count);
  block.nodes = vector_new(block.model->node_count);
  return block;
}

static void block_free(Block *block) {
  spore_cell_fields_free(block->cells);
  block->type->destroy(block->model);
  spore_tetrahedral_mesh_clear(&block->mesh);
  g_free(block->fields);
  g_free(block->q);
  g_free(block->values);
  g_free(block->nodes);
}

/* Puts the block into this deformation, somewhere else in space. */
static void deform(Block *block, SporeMat3 f) {
  double *v = vector_new(3 * block->model->block_count);
  SporePose pose = {{0, 0, 0}, spore_quat_from_rotation_vector(spore_vec3(0, 0, 0))};
  block->type->place(block->model, pose, spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), block->q, v);
  for (size_t i = 0; i < block->model->node_count; i++) {
    SporeVec3 at = spore_mat3_apply(f, spore_vec3_load(block->q + 3 * i));
    spore_vec3_store(block->q + 3 * i, spore_vec3_add(at, spore_vec3(1, -2, 0.5)));
  }
  spore_cell_fields_take(block->cells, NULL, block->q);
  g_free(v);
}

static SporeMat3 turn(void) { return spore_quat_to_mat3(spore_quat_from_rotation_vector(spore_vec3(0.4, -1.1, 2.0))); }
static SporeMat3 stretch(void) { return spore_mat3_multiply(turn(), spore_mat3_diagonal(LONGER, THINNER, THINNER)); }

/* |sigma_1 - sigma_2| of F = diag(a, b, b), from each law as published (models/tetrahedra/tetrahedra.h has sources). */
static double expected_stress(const SporeModelType *type) {
  double mu = YOUNG / (2 * (1 + POISSON)), lambda = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON));
  double a = LONGER, b = THINNER, j = a * b * b, along, across;
  if (type == &spore_corotational_tetrahedra) {
    along = 2 * mu * (a - 1) + lambda * (a + 2 * b - 3);
    across = 2 * mu * (b - 1) + lambda * (a + 2 * b - 3);
  } else if (type == &spore_saint_venant_kirchhoff_tetrahedra) {
    double e = (a * a - 1) / 2, t = (b * b - 1) / 2;
    along = a * (2 * mu * e + lambda * (e + 2 * t));
    across = b * (2 * mu * t + lambda * (e + 2 * t));
  } else {
    double m = 4 * mu / 3, l = lambda + 5 * mu / 6, alpha = 1 + m / l - m / (4 * l), sum = a * a + 2 * b * b;
    along = m * (1 - 1 / (sum + 1)) * a + l * (j - alpha) * b * b;
    across = m * (1 - 1 / (sum + 1)) * b + l * (j - alpha) * a * b;
  }
  return fabs(along * a - across * b) / j;
}

static void assert_all(const double *values, size_t count, double expected, double tolerance) {
  for (size_t i = 0; i < count; i++) g_assert_cmpfloat_with_epsilon(values[i], expected, tolerance);
}

/* A turn leaves the shapes as they are, a stretch makes the worst one worse; inside out, an element is worth nothing.
 */
static void check_shapes(Block *block) {
  size_t cells = block->mesh.tetrahedron_count, nodes = block->model->node_count;
  SporeTetrahedraQuality rest;
  double worst = HUGE_VAL, stretched = HUGE_VAL, least = HUGE_VAL;
  spore_tetrahedral_mesh_quality(&block->mesh, &rest);
  deform(block, turn());
  spore_cell_fields_shape(block->cells, block->values);
  for (size_t i = 0; i < cells; i++) worst = fmin(worst, block->values[i]);
  g_assert_cmpfloat(worst, >, 0);
  g_assert_cmpfloat(worst, <=, rest.min_dihedral_deg + 1e-6);
  spore_cell_fields_least(block->cells, block->values, nodes, block->nodes);
  for (size_t i = 0; i < nodes; i++) least = fmin(least, block->nodes[i]);
  g_assert_cmpfloat(least, ==, worst);
  deform(block, spore_mat3_diagonal(3, 1.0 / 3, 1));
  spore_cell_fields_shape(block->cells, block->values);
  for (size_t i = 0; i < cells; i++) stretched = fmin(stretched, block->values[i]);
  g_assert_cmpfloat(stretched, <, worst);
  deform(block, spore_mat3_diagonal(-1, 1, 1));
  spore_cell_fields_shape(block->cells, block->values);
  assert_all(block->values, cells, 0, 1e-12);
}

static void check_stretched(Block *block) {
  double strain = (LONGER * LONGER - 1) / 2, stress = expected_stress(block->type);
  size_t cells = block->mesh.tetrahedron_count, nodes = block->model->node_count;
  deform(block, stretch());
  spore_cell_fields_strain(block->cells, block->values);
  assert_all(block->values, cells, strain, 1e-12);
  spore_cell_fields_spread(block->cells, block->values, nodes, block->nodes);
  assert_all(block->nodes, nodes, strain, 1e-12);
  spore_cell_fields_stress(block->cells, block->values);
  assert_all(block->values, cells, stress, 1e-8 * stress);
  spore_cell_fields_spread(block->cells, block->values, nodes, block->nodes);
  assert_all(block->nodes, nodes, stress, 1e-8 * stress);
  set(block->type, block->fields, "young_modulus", 2 * YOUNG);
  g_assert_true(spore_cell_fields_retune(block->cells, block->fields, NULL));
  spore_cell_fields_stress(block->cells, block->values);
  assert_all(block->values, cells, 2 * stress, 1e-8 * stress);
}

static void check_rigid(Block *block) {
  deform(block, turn());
  spore_cell_fields_strain(block->cells, block->values);
  assert_all(block->values, block->mesh.tetrahedron_count, 0, 1e-13);
  spore_cell_fields_stress(block->cells, block->values);
  assert_all(block->values, block->mesh.tetrahedron_count, 0, 1e-10 * YOUNG);
}

/* Squeezed alike from all sides nothing shears; inside out there is no stress to speak of, and nothing is drawn. */
static void check_extremes(Block *block) {
  deform(block, spore_mat3_scale(0.9, turn()));
  spore_cell_fields_strain(block->cells, block->values);
  assert_all(block->values, block->mesh.tetrahedron_count, (0.81 - 1) / 2, 1e-12);
  spore_cell_fields_stress(block->cells, block->values);
  assert_all(block->values, block->mesh.tetrahedron_count, 0, 1e-9 * YOUNG);
  deform(block, spore_mat3_diagonal(-1, 1, 1));
  spore_cell_fields_stress(block->cells, block->values);
  for (size_t i = 0; i < block->mesh.tetrahedron_count; i++) g_assert_true(isnan(block->values[i]));
  spore_cell_fields_spread(block->cells, block->values, block->model->node_count, block->nodes);
  g_assert_true(isnan(block->nodes[0]));
}

/* The stress of each element is that of its own stiffness. */
static void check_regions(const SporeModelType *type) {
  Block block = block_new(type, 0, TRUE);
  double soft = expected_stress(type);
  size_t stiff = 0;
  deform(&block, stretch());
  spore_cell_fields_stress(block.cells, block.values);
  for (size_t i = 0; i < block.mesh.tetrahedron_count; i++) {
    gboolean is_stiff = block.values[i] > 2 * soft;
    g_assert_cmpfloat_with_epsilon(block.values[i], (is_stiff ? 3 : 1) * soft, 1e-8 * soft);
    stiff += is_stiff;
  }
  g_assert_cmpuint(stiff, >, 0);
  g_assert_cmpuint(stiff, <, block.mesh.tetrahedron_count);
  block_free(&block);
}

static void test_block(gconstpointer data) {
  const SporeModelType *type = data;
  for (int variant = 0; specimen_variant(type, variant); variant++) {
    Block block = block_new(type, variant, FALSE);
    check_rigid(&block);
    check_extremes(&block);
    check_shapes(&block);
    check_stretched(&block);
    block_free(&block);
  }
  check_regions(type);
}

/* After a cut the elements follow the nodes that they have then. */
static void test_cut(void) {
  Block block = block_new(&spore_corotational_tetrahedra, 0, FALSE);
  g_autofree uint32_t *corners =
      g_memdup2(block.mesh.tetrahedra, 4 * block.mesh.tetrahedron_count * sizeof *block.mesh.tetrahedra);
  deform(&block, turn());
  size_t nodes = block.model->node_count;
  block.q = g_renew(double, block.q, 3 * (nodes + 1));
  memcpy(block.q + 3 * nodes, block.q + 3 * corners[0], 3 * sizeof *block.q);
  block.q[3 * corners[0]] += 0.01; /* the first element no longer has this node */
  corners[0] = (uint32_t)nodes;
  spore_cell_fields_take(block.cells, corners, block.q);
  spore_cell_fields_strain(block.cells, block.values);
  g_assert_cmpfloat_with_epsilon(block.values[0], 0, 1e-13);
  double most = 0;
  for (size_t i = 1; i < block.mesh.tetrahedron_count; i++) most = fmax(most, block.values[i]);
  g_assert_cmpfloat(most, >, 0.01);
  block_free(&block);
}

/* Of the others none tells elements apart: their forces do not follow from an element's nodes alone. */
static void test_refused(void) {
  Specimen dummy = {0};
  SporeModel model = {.type = &spore_mass_spring_net};
  SporeError error = SPORE_ERROR_INIT;
  g_assert_null(spore_cell_fields_new(&model, &dummy, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
}

static void test_surface(void) {
  double rest[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 5, 5, 5}, now[15], strain[5];
  const uint32_t triangles[] = {0, 1, 2, 1, 3, 2};
  SporeMat3 f = spore_mat3_multiply(turn(), spore_mat3_diagonal(1.3, 0.8, 1));
  for (size_t i = 0; i < 5; i++) spore_vec3_store(now + 3 * i, spore_mat3_apply(f, spore_vec3_load(rest + 3 * i)));
  spore_surface_strain(rest, now, 5, triangles, 2, strain);
  assert_all(strain, 4, (1.3 * 1.3 - 1) / 2, 1e-12);
  g_assert_cmpfloat(strain[4], ==, 0);
  for (size_t i = 0; i < 5; i++) spore_vec3_store(now + 3 * i, spore_mat3_apply(turn(), spore_vec3_load(rest + 3 * i)));
  spore_surface_strain(rest, now, 5, triangles, 2, strain);
  assert_all(strain, 5, 0, 1e-14);
}

/* Two pieces: one longer by a tenth, one turned alone. */
static void test_line(void) {
  const double rest[] = {0, 0, 0, 9, 1, 0, 0, 9, 2, 0, 0, 9}, now[] = {0, 0, 0, 1.1, 0, 0, 1.1, 1, 0};
  double strain[3];
  spore_line_strain(rest, 4, now, 3, strain);
  g_assert_cmpfloat_with_epsilon(strain[0], 0.105, 1e-14);
  g_assert_cmpfloat_with_epsilon(strain[1], 0.0525, 1e-14);
  g_assert_cmpfloat_with_epsilon(strain[2], 0, 1e-14);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_data_func("/cell_fields/corotational", &spore_corotational_tetrahedra, test_block);
  g_test_add_data_func("/cell_fields/neo_hookean", &spore_neo_hookean_tetrahedra, test_block);
  g_test_add_data_func("/cell_fields/saint_venant_kirchhoff", &spore_saint_venant_kirchhoff_tetrahedra, test_block);
  g_test_add_func("/cell_fields/cut", test_cut);
  g_test_add_func("/cell_fields/refused", test_refused);
  g_test_add_func("/cell_fields/surface", test_surface);
  g_test_add_func("/cell_fields/line", test_line);
  return g_test_run();
}
