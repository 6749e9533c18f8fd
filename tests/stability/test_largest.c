/* The largest documented sizes are made and stepped, and work that is cancelled ends after a bounded piece of it: case
 * 45 of the stability suite. */
#include <math.h>
#include <stdatomic.h>

#include "core/base/memory.h"
#include "tests/stability/rig.h"

/* Says yes from the question number `at` on. */
typedef struct Asker {
  atomic_uint asked;
  unsigned at;
} Asker;

static bool answer(void *data) {
  Asker *asker = data;
  return atomic_fetch_add(&asker->asked, 1) + 1 >= asker->at;
}

/* Questions after the first yes: loops within loops ask once each on their way out, whatever the sizes are. */
#define QUESTIONS_ON_THE_WAY_OUT 100

/* A sheet that is held at an edge and falls, a tetrahedral block on springs, and a net: each solver has its work. */
static Rig *make_rig(SporeIntegratorKind integrator, int linear, const SporeCancel *cancel) {
  Rig *rig = rig_new();
  SporeTriangleMesh sheet;
  SporeTetrahedralMesh block;
  rig->description.cancel = cancel;
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.integrator = integrator;
  rig->description.solver.linear = linear;
  rig->description.solver.time_step = 4e-3;
  shape_sheet(&sheet, 9, 9, 0.01, TRUE);
  rig_passive(rig, "sheet",
              rig_surface_model(&spore_spline_2d, &sheet, "control_points_u", 16.0, "control_points_v", 16.0, NULL),
              NULL);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 0.02);
  shape_block(&block, 3, 3, 3, spore_vec3(0.06, 0.06, 0.06));
  rig_passive(rig, "block", rig_tetrahedra_model(&block, NULL), NULL)->pose.position = spore_vec3(1, 0, 0);
  rig_pin(rig, 1, spore_vec3(1, 0, 0), 0.01);
  return rig;
}

static uint64_t run_uncancelled(SporeIntegratorKind integrator, int linear, unsigned steps, unsigned *asked) {
  Asker asker = {0, G_MAXUINT};
  const SporeCancel cancel = {answer, &asker};
  Rig *rig = make_rig(integrator, linear, &cancel);
  SporeWorld *world = rig_build(rig);
  asker.asked = 0;
  spore_world_step(world);
  *asked = asker.asked;
  rig_run(world, steps - 1);
  uint64_t hash = spore_world_hash(world);
  g_assert_false(spore_world_cancelled(world));
  rig_free(rig);
  return hash;
}

#define STEPS 2

/* Cancelled at that question, the world is where it was; after a reset it goes as if nothing had been. */
static void cancel_at(SporeIntegratorKind integrator, int linear, unsigned at, uint64_t expected) {
  Asker asker = {0, G_MAXUINT};
  const SporeCancel cancel = {answer, &asker};
  Rig *rig = make_rig(integrator, linear, &cancel);
  SporeWorld *world = rig_build(rig);
  uint64_t before = spore_world_hash(world), published = spore_world_snapshot_acquire(world)->step;
  asker.asked = 0;
  asker.at = at;
  spore_world_step(world);
  g_assert_true(spore_world_cancelled(world));
  g_assert_cmpuint(asker.asked, <=, at + QUESTIONS_ON_THE_WAY_OUT);
  g_assert_cmphex(spore_world_hash(world), ==, before);
  g_assert_cmpuint(spore_world_snapshot_acquire(world)->step, ==, published);
  asker.at = G_MAXUINT;
  spore_world_step(world); /* only a reset makes it go on */
  g_assert_cmphex(spore_world_hash(world), ==, before);
  g_assert_false(rig_any_frozen(world));
  spore_world_reset(world);
  g_assert_false(spore_world_cancelled(world));
  rig_run(world, STEPS);
  g_assert_cmphex(spore_world_hash(world), ==, expected);
  rig_free(rig);
}

static void test_step(void) {
  static const SporeIntegratorKind integrators[] = {SPORE_INTEGRATOR_IMPLICIT_EULER, SPORE_INTEGRATOR_IMPLICIT_MIDPOINT,
                                                    SPORE_INTEGRATOR_BDF2, SPORE_INTEGRATOR_TR_BDF2,
                                                    SPORE_INTEGRATOR_STATIC};
  for (size_t i = 0; i < G_N_ELEMENTS(integrators); i++)
    for (int linear = SPORE_LINEAR_CONJUGATE_GRADIENTS; linear <= SPORE_LINEAR_CHOLESKY; linear++) {
      unsigned asked;
      if (tests_sanitized && integrators[i] == SPORE_INTEGRATOR_STATIC && linear == SPORE_LINEAR_CHOLESKY) continue;
      uint64_t expected = run_uncancelled(integrators[i], linear, STEPS, &asked);
      g_test_message("%s, %s: asked %u times in the first step", spore_integrator_names[integrators[i]],
                     spore_linear_names[linear], asked);
      g_assert_cmpuint(asked, >, 20);
      unsigned parts = integrators[i] != SPORE_INTEGRATOR_STATIC ? 8
                       : tests_sanitized                         ? 1
                                                                 : 2; /* its load steps take long */
      for (unsigned part = 0; part <= parts; part++)
        cancel_at(integrators[i], linear, 1 + part * (asked - 1) / parts, expected);
    }
}

static void test_making(void) {
  Asker asker = {0, G_MAXUINT};
  const SporeCancel cancel = {answer, &asker};
  Rig *rig = make_rig(SPORE_INTEGRATOR_IMPLICIT_EULER, SPORE_LINEAR_CHOLESKY, &cancel);
  rig_build(rig);
  unsigned asked = asker.asked;
  rig_free(rig);
  g_test_message("asked %u times while the world is made", asked);
  g_assert_cmpuint(asked, >, 256); /* the analysis asks at each block */
  for (unsigned part = 0; part <= 4; part++) {
    SporeError error = SPORE_ERROR_INIT;
    asker = (Asker){0, 1 + part * (asked - 1) / 4};
    rig = make_rig(SPORE_INTEGRATOR_IMPLICIT_EULER, SPORE_LINEAR_CHOLESKY, &cancel);
    g_assert_null(rig_try_build(rig, &error));
    g_assert_cmpint(error.code, ==, SPORE_ERROR_CANCELLED);
    g_assert_cmpuint(asker.asked, <=, asker.at + QUESTIONS_ON_THE_WAY_OUT);
    rig_free(rig);
  }
}

/* A kind of model that takes long to make: a smaller one, by the geometry that it needs. */
typedef struct Making {
  const SporeModelType *type;
  unsigned least; /* questions: rows of cells, columns of a matrix, sweeps */
  const char *size_name, *other_name;
  double size;
} Making;

static SporeModel *make_model(const Making *making, const SporeCancel *cancel, SporeError *error) {
  SporeTriangleMesh sheet, box;
  SporeTetrahedralMesh block;
  shape_sheet(&sheet, 17, 17, 0.01, TRUE);
  shape_block_surface(&box, 1, 1, 1, spore_vec3(0.06, 0.05, 0.05));
  shape_block(&block, 4, 4, 4, spore_vec3(0.06, 0.06, 0.06));
  void *fields = making->size_name
                     ? rig_fields(making->type, making->size_name, making->size, making->other_name, making->size, NULL)
                     : rig_fields(making->type, NULL);
  const SporeGeometry geometry = {.surface = making->type->geometry == SPORE_GEOMETRY_SURFACE ? &sheet : &box,
                                  .tetrahedra = &block,
                                  .cancel = cancel};
  SporeModel *model = spore_model_create(making->type, &geometry, fields, error);
  spore_free(fields);
  spore_triangle_mesh_clear(&sheet);
  spore_triangle_mesh_clear(&box);
  spore_tetrahedral_mesh_clear(&block);
  return model;
}

/* A model asks while it is made, and gives up at whatever question the answer is yes. */
static void test_models(void) {
  static const Making makings[] = {{&spore_spline_2d, 40, "control_points_u", "control_points_v", 16},
                                   {&spore_condensed_tetrahedra, 98},
                                   {&spore_finite_differences, 280, "cells", NULL, 20},
                                   {&spore_lennard_jones, 256, "particles", NULL, 2000},
                                   {&spore_smoke, 64, "particles", NULL, 500},
                                   {&spore_mass_spring_net, 3},
                                   {&spore_corotational_tetrahedra, 1}};
  for (size_t i = 0; i < G_N_ELEMENTS(makings); i++) {
    Asker asker = {0, G_MAXUINT};
    const SporeCancel cancel = {answer, &asker};
    SporeError error = SPORE_ERROR_INIT;
    SporeModel *model = make_model(&makings[i], &cancel, &error);
    if (!model) g_error("%s", error.message);
    model->type->destroy(model);
    unsigned asked = asker.asked;
    g_test_message("%s: asked %u times while the model is made", makings[i].type->name, asked);
    g_assert_cmpuint(asked, >, makings[i].least);
    for (unsigned part = 0; part <= 8; part++) {
      asker = (Asker){0, 1 + part * (asked - 1) / 8};
      g_assert_null(make_model(&makings[i], &cancel, &error));
      g_assert_cmpint(error.code, ==, SPORE_ERROR_CANCELLED);
      g_assert_cmpuint(asker.asked, <=, asker.at + QUESTIONS_ON_THE_WAY_OUT);
    }
  }
}

/* A helix, so that no place is like another, whose radius grows with the length. */
static SporeCurve helix(size_t count) {
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, count, NULL));
  for (size_t i = 0; i < count; i++) {
    double part = (double)i / (double)(count - 1), turn = 40 * M_PI * part;
    double *point = curve.points + 4 * i;
    point[0] = 0.1 * cos(turn), point[1] = 0.1 * sin(turn), point[2] = part, point[3] = 1e-3 * (1 + part);
  }
  return curve;
}

/* As many points and control points as a line may have. Work for each place by the number of points would take hours.
 */
static void test_curve(void) {
  size_t points = tests_sanitized ? 30000 : 300000;
  double control = tests_sanitized ? 10000 : 100000;
  SporeCurve curve = helix(points);
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
  SporeModel *model =
      rig_curve_model(&spore_spline_1d, &curve, "control_points", control, "maximum_control_points", control, NULL);
  SporeSphereSet spheres;
  g_assert_true(model->type->spheres(model, &spheres, NULL));
  const double *first = spheres.spheres, *last = spheres.spheres + 4 * (spheres.count - 1);
  const double *middle = spheres.spheres + 4 * (spheres.count / 2);
  g_assert_cmpfloat_with_epsilon(first[3], 1e-3, 1e-9);
  g_assert_cmpfloat_with_epsilon(middle[3], 1e-3 * (1 + middle[2]), 1e-8);
  g_assert_cmpfloat_with_epsilon(last[3], 2e-3, 1e-9);
  spore_sphere_set_clear(&spheres);
  rig_passive(rig, "thread", model, NULL);
  SporeWorld *world = rig_build(rig);
  spore_world_step(world);
  g_assert_true(rig_finite(world));
  g_test_message("%s", rig_last_message(world));
  /* Control points 3e-5 m apart: what rounding leaves may be more than the tolerance, and is said then. */
  g_assert_true(spore_world_monitor(world)->not_converged == 0 || rig_said(world, "thread: rounding"));
  rig_free(rig);
}

/* Very many spheres of one body above another's. */
static void test_spheres(void) {
  size_t count = tests_sanitized ? 20000 : 200000;
  double *points = g_new(double, 3 * count);
  unsigned side = (unsigned)ceil(cbrt((double)count));
  for (size_t i = 0; i < count; i++) {
    points[3 * i] = 1e-3 * (double)(i % side);
    points[3 * i + 1] = 1e-3 * (double)(i / side % side);
    points[3 * i + 2] = 1e-3 * (double)(i / side / side);
  }
  Rig *rig = rig_new();
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0.05, 0.05, 0.05), spore_vec3(0.1, 0.1, 0.1));
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig_passive(rig, "grains", rig_surface_model(&spore_rigid_body, &cube, NULL), rig_spheres(rig, points, count, 4e-4));
  rig_unmovable(rig, "floor", rig_floor(rig, 20, 20, 0.02, 0.02))->pose.position = spore_vec3(0, -0.01, 0);
  SporeWorld *world = rig_build(rig);
  spore_world_step(world);
  g_assert_true(rig_finite(world));
  rig_free(rig);
  g_free(points);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/largest/cancelled-step", test_step);
  g_test_add_func("/largest/cancelled-making", test_making);
  g_test_add_func("/largest/cancelled-models", test_models);
  g_test_add_func("/largest/curve", test_curve);
  g_test_add_func("/largest/spheres", test_spheres);
  return g_test_run();
}
