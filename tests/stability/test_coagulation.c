/* Heat: what bipolar forceps do to nets and tetrahedra. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/conformance/specimen.h"
#include "tests/stability/rig.h"

#define LEAST 0.8
#define STIFFENING 7

static const SporeModelType *const types[] = {&spore_mass_spring_net, &spore_corotational_tetrahedra,
                                              &spore_neo_hookean_tetrahedra, &spore_saint_venant_kirchhoff_tetrahedra};

static SporeModel *make(const SporeModelType *type, gboolean quadratic) {
  if (type == &spore_mass_spring_net) {
    SporeTriangleMesh sheet;
    shape_sheet(&sheet, 8, 8, 0.005, TRUE);
    return rig_surface_model(type, &sheet, NULL);
  }
  SporeTetrahedralMesh block;
  shape_block(&block, 4, 2, 2, spore_vec3(0.04, 0.02, 0.02));
  if (quadratic) return rig_solid_model(type, &block, "element", 1.0, NULL);
  return rig_solid_model(type, &block, NULL);
}

/* q = scale F X, stretched unevenly. */
static void stretch(const SporeModel *model, double scale, double *q, double *v) {
  model->type->place(model, (SporePose){{0, 0, 0}, {1, 0, 0, 0}}, spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), q, v);
  for (size_t i = 0; i < model->node_count; i++) {
    double x = q[3 * i], y = q[3 * i + 1], z = q[3 * i + 2];
    memcpy(q + 3 * i, (double[3]){scale * (1.2 * x + 0.1 * y), scale * 0.9 * y, scale * (1.1 * z - 0.1 * x)},
           3 * sizeof *q);
  }
}

/* All of it coagulated by many steps: the same body on a smaller scale, and stiffer. */
static void check_scale(const SporeModelType *type, gboolean quadratic) {
  SporeModel *model = make(type, quadratic);
  double *q = g_new0(double, model->q_count), *v = g_new0(double, 3 * model->block_count);
  stretch(model, 1, q, v);
  double before = type->potential(model, q);
  g_assert_true(type->heat->prepare(model));
  g_assert_cmpfloat(type->potential(model, q), ==, before);
  const SporeHeat heat = {{0, 0, 0}, 1, 0.013, 1 - LEAST, STIFFENING};
  for (int i = 0; i < 80; i++) type->heat->coagulate(model, q, &heat);
  g_assert_cmpuint(type->heat->coagulate(model, q, &heat), ==, 0);
  stretch(model, LEAST, q, v);
  double volume = type == &spore_mass_spring_net ? LEAST * LEAST : LEAST * LEAST * LEAST;
  double expected = STIFFENING * volume * before, after = type->potential(model, q);
  g_test_message("%s%s: %.6g J, expected %.6g", type->name, quadratic ? ", quadratic" : "", after, expected);
  g_assert_cmpfloat_with_epsilon(after, expected, 1e-11 * expected);
  type->mend(model);
  stretch(model, 1, q, v);
  g_assert_cmpfloat(type->potential(model, q), ==, before);
  g_free(q);
  g_free(v);
  type->destroy(model);
}

static void test_scale(void) {
  for (size_t i = 0; i < G_N_ELEMENTS(types); i++) {
    check_scale(types[i], FALSE);
    if (i > 0) check_scale(types[i], TRUE);
  }
}

/* Force against energy and matrix against force, by differences, with heat in one corner. */
static void check_derivatives(const SporeModelType *type, gboolean quadratic) {
  SporeModel *model = make(type, quadratic);
  size_t n = 3 * model->block_count;
  double *q = g_new0(double, n), *v = g_new0(double, n), *f = g_new0(double, n), *g = g_new0(double, n),
         *d = g_new0(double, n), *y = g_new0(double, n);
  SporeBlockMatrix matrix;
  g_assert_true(spore_model_matrix_create(model, &matrix) && type->heat->prepare(model));
  stretch(model, 1, q, v);
  for (int i = 0; i < 20; i++) type->heat->coagulate(model, q, &(SporeHeat){{0, 0, 0}, 0.03, 0.02, 0.05, STIFFENING});
  GRand *random = g_rand_new_with_seed(5);
  for (size_t i = 0; i < n; i++) d[i] = g_rand_double_range(random, -1, 1);
  g_rand_free(random);
  double h = 1e-7, force = 0, change = 0, error = 0;
  type->force(model, q, q, v, f);
  for (size_t i = 0; i < n; i++) force -= f[i] * d[i], q[i] += h * d[i];
  double energy = type->potential(model, q);
  type->force(model, q, q, v, g);
  for (size_t i = 0; i < n; i++) q[i] -= 2 * h * d[i];
  energy -= type->potential(model, q);
  memset(f, 0, n * sizeof *f);
  type->force(model, q, q, v, f);
  for (size_t i = 0; i < n; i++) q[i] += h * d[i];
  spore_block_matrix_zero(&matrix);
  type->jacobian(model, q, q, v, 1, 0, &matrix);
  spore_block_matrix_multiply_add(&matrix, d, y);
  for (size_t i = 0; i < n; i++) {
    double difference = (f[i] - g[i]) / (2 * h);
    change += difference * difference, error += (difference - y[i]) * (difference - y[i]);
  }
  g_test_message("%s: force differs by %.1e, matrix by %.1e", type->name, fabs(energy / (2 * h) / force - 1),
                 sqrt(error / change));
  g_assert_cmpfloat_with_epsilon(energy / (2 * h), force, 1e-5 * fabs(force));
  g_assert_cmpfloat(error, <, 1e-8 * change);
  spore_block_matrix_clear(&matrix);
  double *const all[] = {q, v, f, g, d, y};
  for (size_t i = 0; i < G_N_ELEMENTS(all); i++) g_free(all[i]);
  type->destroy(model);
}

/* Strained so that every element's matrix is definite, and nothing of it is left out. */
static void test_derivatives(void) {
  check_derivatives(&spore_corotational_tetrahedra, FALSE);
  check_derivatives(&spore_neo_hookean_tetrahedra, FALSE);
  check_derivatives(&spore_neo_hookean_tetrahedra, TRUE);
  check_derivatives(&spore_saint_venant_kirchhoff_tetrahedra, FALSE);
}

static bool pedal_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                           SporeDeviceState *state) {
  *state = (SporeDeviceState){.position = {0.02, 0.03, 0.01}, .orientation = {1, 0, 0, 0}, .buttons = time_s > 0.1};
  return true;
}
static void pedal_close(SporeDevice *device) {}
static const SporeDeviceType pedal_type = {
    .name = "pedal", .doc = "", .exchange = pedal_exchange, .close = pedal_close};

static Rig *block_and_forceps(const SporeModelType *type) {
  Rig *rig = rig_new();
  SporeTetrahedralMesh block;
  shape_block(&block, 8, 4, 4, spore_vec3(0.04, 0.02, 0.02));
  rig_passive(rig, "block", rig_solid_model(type, &block, "stiffness_damping", 0.01, NULL), NULL);
  rig_active(rig, "shaft", NULL)->pose.position = spore_vec3(0.02, 0.03, 0.01);
  SporeBipolarFields *fields = rig_tool_fields(rig_tool(rig, &spore_bipolar, "forceps", 1));
  spore_vec3_store(fields->point, spore_vec3(0.02, 0.02, 0.01));
  fields->radius = 0.008, fields->rate = 2, fields->least = LEAST, fields->stiffening = STIFFENING;
  return rig;
}

static double width(const SporeWorld *world) { /* across the heated side, between nodes (3, 4, 2) and (5, 4, 2) */
  const double *q = spore_world_q(world, 0);
  return spore_vec3_distance(spore_vec3_load(q + 3 * ((3 * 5 + 4) * 5 + 2)),
                             spore_vec3_load(q + 3 * ((5 * 5 + 4) * 5 + 2)));
}

/* Speed of the centre of mass of the first body. */
static double drift_of(const Rig *rig) {
  const SporeModel *model = g_array_index(rig->bodies, SporeBodyDescription, 0).model;
  const double *v = spore_world_v(rig->world, 0);
  SporeVec3 momentum = {0, 0, 0};
  for (size_t i = 0; i < model->node_count; i++)
    momentum = spore_vec3_add_scaled(momentum, model->block_mass[i], spore_vec3_load(v + 3 * i));
  return spore_vec3_length(momentum) / spore_model_total_mass(model);
}

/* A free block shrinks where it is heated: it bends, does not move as a whole, and its energy comes little by little,
 * no more in a step than the dose allows. */
static void check_block(const SporeModelType *type) {
  Rig *rig = block_and_forceps(type);
  SporeDevice pedal = {&pedal_type};
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 1, &pedal);
  double cold = width(world), most = 0, last = 0, jump = 0;
  uint64_t before = spore_allocation_count();
  unsigned steps = (unsigned)lround(0.8 / rig->description.solver.time_step);
  for (unsigned i = 0; i < steps; i++) {
    spore_world_step(world);
    double energy = rig_energy(world);
    g_assert_true(isfinite(energy));
    jump = fmax(jump, energy - last), most = fmax(most, energy), last = energy;
  }
  g_assert_cmpuint(spore_allocation_count(), ==, before);
  double drift = drift_of(rig);
  g_test_message("%s: 10 mm became %.2f mm; at most %.3g J, %.3g J more in a step; drifts at %.1e m/s; %s", type->name,
                 1e3 * width(world), most, jump, drift, rig_last_message(world));
  g_assert_cmpstr(rig_last_message(world), ==, "");
  g_assert_cmpfloat_with_epsilon(cold, 0.01, 1e-12);
  g_assert_cmpfloat(width(world), <, 0.0088);
  g_assert_cmpfloat(width(world), >, 0.99 * LEAST * cold);
  g_assert_cmpfloat(jump, <, 0.05 * most);
  g_assert_cmpfloat(drift, <, 1e-8);
  uint64_t hash = spore_world_hash(world);
  spore_world_reset(world);
  g_assert_cmpfloat(width(world), ==, cold);
  rig_run(world, steps);
  g_assert_cmpuint(spore_world_hash(world), ==, hash);
  rig_free(rig);
}

static void test_block(void) {
  for (size_t i = 1; i < G_N_ELEMENTS(types); i++) check_block(types[i]);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/coagulation/scale", test_scale);
  g_test_add_func("/coagulation/derivatives", test_derivatives);
  g_test_add_func("/coagulation/block", test_block);
  return g_test_run();
}
