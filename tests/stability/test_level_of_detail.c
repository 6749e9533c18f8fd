/* Level of detail: what a change of level preserves, how far it moves a body, and which changes are refused. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/body/momentum.h"
#include "core/sim/world_private.h"
#include "tests/stability/rig.h"

/* Specimens: the same body in a number of `parts`, which halves from level to level. */

static SporeModel *thread(unsigned parts) {
  SporeCurve curve;
  shape_helix(&curve, 200, 0.05, 0.03, 0.002);
  return rig_curve_model(&spore_spline_1d, &curve, "control_points", (double)parts + 3, "young_modulus", 1e6, NULL);
}

static SporeModel *voxels(unsigned parts) {
  SporeTriangleMesh mesh;
  shape_box(&mesh, spore_vec3(0.1, 0, 0), spore_vec3(0.2, 0.05, 0.05));
  return rig_surface_model(&spore_finite_differences, &mesh, "cells", (double)parts, "young_modulus", 2e4, NULL);
}

static SporeModel *rod(unsigned parts) {
  SporeCurve curve;
  shape_line(&curve, 2, 0.2, 0.003);
  return rig_curve_model(&spore_spline_1d, &curve, "control_points", (double)parts + 3, "young_modulus", 1e6, NULL);
}

static SporeModel *tube(unsigned parts) {
  SporeCurve curve;
  shape_helix(&curve, 200, 0.05, 0.04, 0.008);
  return rig_curve_model(&spore_intestine, &curve, "control_points", (double)parts + 3, NULL);
}

static SporeModel *sheet(unsigned parts) {
  SporeTriangleMesh mesh;
  shape_level_sheet(&mesh, 25, 25, 0.004);
  return rig_surface_model(&spore_spline_2d, &mesh, "control_points_u", (double)parts + 3, "control_points_v",
                           (double)parts + 3, "young_modulus", 2e4, NULL);
}

static SporeModel *net(unsigned parts) {
  SporeTriangleMesh mesh;
  shape_sheet(&mesh, parts + 1, parts + 1, 0.1 / parts, TRUE);
  return rig_surface_model(&spore_mass_spring_net, &mesh, "structural_stiffness", 50., NULL);
}

static SporeModel *shell(unsigned parts) {
  SporeTriangleMesh mesh;
  shape_block_surface(&mesh, parts, parts, 1, spore_vec3(0.1, 0.1, 0.03));
  return rig_surface_model(&spore_deformable_surface, &mesh, NULL);
}

static SporeModel *block_of(const SporeModelType *type, unsigned parts) {
  SporeTetrahedralMesh mesh;
  shape_block(&mesh, parts, parts / 4, parts / 4, spore_vec3(0.2, 0.05, 0.05));
  return rig_solid_model(type, &mesh, "young_modulus", 2e4, NULL);
}

static SporeModel *neo_hookean(unsigned parts) { return block_of(&spore_neo_hookean_tetrahedra, parts); }
static SporeModel *corotational(unsigned parts) { return block_of(&spore_corotational_tetrahedra, parts); }

typedef struct Specimen {
  const char *name;
  SporeModel *(*create)(unsigned parts);
  unsigned fine;
  double tolerance; /* m */
  double bend;      /* 1/s: how fast it bends at first */
} Specimen;

static const Specimen specimens[] = {
    {"rod", rod, 32, 1e-3, 4},
    {"thread", thread, 64, 1e-3, 4},
    {"intestine", tube, 48, 3e-3, 2},
    {"sheet", sheet, 12, 1e-3, 4},
    {"net", net, 20, 2e-3, 2},
    {"deformable surface", shell, 12, 2e-3, 2},
    {"neo-Hookean", neo_hookean, 16, 2e-3, 3},
    {"corotational", corotational, 16, 2e-3, 3},
    {"finite differences", voxels, 16, 2e-3, 3},
};

#define CENTRE spore_vec3(0.3, 0.2, -0.1)

/* A body with its levels, turned, turning and flying, with spheres on some of its nodes. */
static Rig *rig_of(const Specimen *specimen, SporeLodGrade first) {
  Rig *rig = rig_new();
  SporeModel *model = specimen->create(specimen->fine);
  SporeBodyDescription *body = rig_passive(rig, "body", model, NULL);
  body->lod =
      (SporeLodDescription){.model = {specimen->create(specimen->fine / 4), specimen->create(specimen->fine / 2)},
                            .first = first,
                            .tolerance = specimen->tolerance};
  body->pose = (SporePose){CENTRE, spore_quat_from_rotation_vector(spore_vec3(0.4, -0.3, 0.8))};
  body->velocity = spore_vec3(0.3, 0.1, -0.2);
  body->spin = spore_vec3(1, -2, 3);
  rig->description.solver.sleep_speed = 0;
  return rig;
}

/* Bends it: velocities along one axis by the square of the place along another. */
static void bend(SporeWorld *world, double rate) {
  const SporeModel *model = spore_world_body_model(world, 0);
  g_autofree double *q = g_memdup2(spore_world_q(world, 0), model->q_count * sizeof(double));
  g_autofree double *v = g_memdup2(spore_world_v(world, 0), 3 * model->block_count * sizeof(double));
  for (size_t i = 0; i < model->node_count; i++) {
    double x = q[3 * i] - CENTRE.x, y = q[3 * i + 1] - CENTRE.y;
    v[3 * i + 2] += rate * (x * x - 0.5 * y * y) / 0.05;
  }
  spore_world_set_state(world, 0, q, v);
}

static SporeLodState state_of(const SporeWorld *world) {
  SporeLodState state;
  g_assert_true(spore_world_lod_state(world, 0, &state));
  return state;
}

/* Changes it at once, without a step. */
static SporeLodState change(SporeWorld *world, SporeLodGrade level) {
  SporeCommand command = {.kind = SPORE_COMMAND_LOD, .body = 0, .level = level};
  g_assert_true(spore_world_post(world, &command));
  spore_world_apply_commands(world);
  return state_of(world);
}

/* About `centre`, or the body's own. */
static SporeMotion motion_of(const SporeWorld *world, const SporeVec3 *centre) {
  return spore_model_motion(spore_world_body_model(world, 0), spore_world_q(world, 0), spore_world_v(world, 0), centre);
}

/* Of the rigid motion that has the body's momentum: it is less where lumped masses lie further out. */
static double rigid_energy(const SporeMotion *motion) {
  SporeMat3 inverse;
  g_assert_true(spore_mat3_invert(motion->inertia, &inverse));
  SporeVec3 spin = spore_mat3_apply(inverse, motion->angular);
  return 0.5 *
         (spore_vec3_dot(motion->momentum, motion->momentum) / motion->mass + spore_vec3_dot(motion->angular, spin));
}

static double own_energy(const SporeWorld *world) {
  SporeEnergy energy = spore_world_energy(world);
  return energy.kinetic + energy.internal;
}

static void assert_vectors_equal(SporeVec3 a, SporeVec3 b, double scale, double share) {
  g_assert_cmpfloat(spore_vec3_distance(a, b), <=, share * scale);
}

/* Down and up again while it moves and bends: momentum to rounding, error below the bound, no energy from nowhere. */
static void test_moving(gconstpointer data) {
  const Specimen *specimen = data;
  static const SporeLodGrade way[] = {SPORE_LOD_MEDIUM, SPORE_LOD_COARSE, SPORE_LOD_FINE, SPORE_LOD_COARSE,
                                      SPORE_LOD_FINE};
  Rig *rig = rig_of(specimen, SPORE_LOD_FINE);
  SporeWorld *world = rig_build(rig);
  bend(world, specimen->bend);
  rig_run(world, 10);
  double before_all = own_energy(world);
  for (size_t k = 0; k < G_N_ELEMENTS(way); k++) {
    SporeMotion before = motion_of(world, NULL);
    double energy = own_energy(world);
    SporeLodState state = change(world, way[k]);
    g_test_message("%s to %s: error %.2e m, energy %+.2e of %.2e J, momentum %.1e of %.1e N s", specimen->name,
                   spore_lod_names[way[k]], state.error, own_energy(world) - energy, energy, state.momentum,
                   spore_vec3_length(before.momentum));
    if (state.level != way[k]) g_test_message("%s", rig_last_message(world));
    g_assert_cmpint((int)state.level, ==, (int)way[k]);
    g_assert_cmpuint(state.changes, ==, k + 1);
    g_assert_cmpfloat(state.error, <=, specimen->tolerance);
    SporeMotion after = motion_of(world, &before.centre), own = motion_of(world, NULL);
    assert_vectors_equal(after.momentum, before.momentum, spore_vec3_length(before.momentum), 1e-12);
    assert_vectors_equal(after.angular, before.angular, spore_vec3_length(before.angular), 1e-12);
    double lent = fmax(rigid_energy(&own) - rigid_energy(&before), 0);
    g_assert_cmpfloat(own_energy(world), <=, energy + lent + 0.02 * before_all);
    rig_run(world, 10);
    g_assert_true(rig_finite(world));
    g_assert_false(rig_any_frozen(world));
  }
  g_assert_cmpfloat(own_energy(world), <=, 1.02 * before_all);
  rig_free(rig);
}

/* What the coarse one can do the fine one can do: the way through the fine level changes nothing. */
static void test_round_trip(gconstpointer data) {
  const Specimen *specimen = data;
  Rig *rig = rig_of(specimen, SPORE_LOD_COARSE);
  SporeWorld *world = rig_build(rig);
  bend(world, specimen->bend);
  rig_run(world, 10);
  size_t count = spore_world_body_model(world, 0)->node_count;
  g_autofree double *before = g_memdup2(spore_world_q(world, 0), 3 * count * sizeof(double));
  SporeLodState up = change(world, SPORE_LOD_FINE), down = change(world, SPORE_LOD_COARSE);
  double apart = 0;
  for (size_t i = 0; i < count; i++)
    apart = fmax(
        apart, spore_vec3_distance(spore_vec3_load(before + 3 * i), spore_vec3_load(spore_world_q(world, 0) + 3 * i)));
  g_test_message("%s: %.2e m up, %.2e m in all, nodes %.2e m from where they were", specimen->name, up.error,
                 down.error, apart);
  g_assert_cmpint((int)down.level, ==, SPORE_LOD_COARSE);
  g_assert_cmpfloat(apart, <=, 0.1 * specimen->tolerance);
  rig_free(rig);
}

/* At rest a change moves nothing beyond what one level lies beside the other, and gives it no energy. */
static void test_rest(gconstpointer data) {
  const Specimen *specimen = data;
  Rig *rig = rig_of(specimen, SPORE_LOD_FINE);
  SporeBodyDescription *body = &g_array_index(rig->bodies, SporeBodyDescription, 0);
  body->velocity = body->spin = spore_vec3(0, 0, 0);
  SporeWorld *world = rig_build(rig);
  for (int level = SPORE_LOD_MEDIUM; level >= 0; level--) change(world, (SporeLodGrade)level);
  SporeLodState state = change(world, SPORE_LOD_FINE);
  g_test_message("%s: %.2e m, %.2e J", specimen->name, state.error, state.energy);
  g_assert_cmpuint(state.changes, ==, 3);
  g_assert_cmpfloat(state.energy, <=, 1e-9);
  rig_free(rig);
}

/* Held at one edge, with a spring at the other; falls, and changes level on the way. */
static Rig *hanging(const Specimen *specimen) {
  Rig *rig = rig_of(specimen, SPORE_LOD_FINE);
  SporeBodyDescription *body = &g_array_index(rig->bodies, SporeBodyDescription, 0);
  body->pose = spore_pose_identity();
  body->velocity = body->spin = spore_vec3(0, 0, 0);
  rig->description.gravity = spore_vec3(0, 0, -9.81);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-6);
  SporeLinkDescription spring = {.name = "spring",
                                 .type = &spore_link_spring,
                                 .body_a = 0,
                                 .body_b = SPORE_NO_BODY,
                                 .point_a = spore_vec3(0.1, 0.1, 0),
                                 .point_b = spore_vec3(0.1, 0.1, 0.02),
                                 .stiffness = 5,
                                 .damping = 0.05,
                                 .rest_length = -1};
  g_array_append_val(rig->links, spring);
  return rig;
}

/* Pins and links are of each level: what is pinned stays to the bit, and a spring holds the same point. */
static void test_held(void) {
  const Specimen specimen = {"net", net, 20, 6e-3, 0};
  Rig *rig = hanging(&specimen);
  SporeWorld *world = rig_build(rig);
  size_t dof = spore_world_dof(world);
  g_assert_cmpuint(dof, ==, 3 * (21 * 21 - 1));
  for (int k = 0; k < 6; k++) {
    rig_run(world, 10);
    SporeVec3 force = spore_world_link_state(world, 0).force;
    SporeLodState state = change(world, k % 2 ? SPORE_LOD_FINE : SPORE_LOD_COARSE);
    g_assert_cmpuint(state.changes, ==, (guint)k + 1);
    g_assert_cmpuint(spore_world_dof(world), ==, k % 2 ? dof : 3 * (6 * 6 - 1));
    assert_vectors_equal(spore_vec3_load(spore_world_q(world, 0)), spore_vec3(0, 0, 0), 1, 0);
    rig_run(world, 1);
    SporeVec3 after = spore_world_link_state(world, 0).force;
    g_assert_cmpfloat(spore_vec3_distance(force, after), <=,
                      5 * 2 * specimen.tolerance + 0.05 * spore_vec3_length(force));
  }
  g_assert_false(rig_any_frozen(world));
  rig_free(rig);
}

/* Twice from time 0, and on several threads: the same bits. */
static void test_deterministic(void) {
  const Specimen specimen = {"net", net, 40, 2e-3, 0};
  uint64_t expected = 0;
  for (int threads = 1; threads <= 4; threads *= 4) {
    Rig *rig = hanging(&specimen);
    SporePool *pool = spore_pool_create(threads);
    SporeWorld *world = rig_build_on(rig, pool);
    for (int run = 0; run < 2; run++) {
      for (int k = 0; k < 3; k++) {
        rig_run(world, 10);
        g_assert_cmpuint(change(world, (SporeLodGrade)k).changes, ==, (guint)k + 1);
      }
      rig_run(world, 10);
      if (expected == 0) expected = spore_world_hash(world);
      g_assert_cmphex(spore_world_hash(world), ==, expected);
      spore_world_reset(world);
      g_assert_cmpint((int)state_of(world).level, ==, SPORE_LOD_FINE);
    }
    rig_free(rig);
    spore_pool_free(pool);
  }
}

/* What cannot be is said, and changes nothing. */
static void test_refused(void) {
  const Specimen specimen = {"rod", rod, 32, 1e-12, 40};
  Rig *rig = rig_of(&specimen, SPORE_LOD_FINE);
  SporeWorld *world = rig_build(rig);
  bend(world, specimen.bend);
  rig_run(world, 20);
  uint64_t hash = spore_world_hash(world);
  SporeLodState state = change(world, SPORE_LOD_COARSE);
  g_assert_cmpuint(state.refused, ==, 1);
  g_assert_cmpuint(state.changes, ==, 0);
  g_assert_cmphex(spore_world_hash(world), ==, hash);
  g_assert_true(rig_said(world, "body: does not change to level coarse: a point of it would move "));
  rig_free(rig);
}

static void assert_no_world(SporeModel *fine, SporeModel *coarse, const char *said) {
  Rig *rig = rig_new();
  SporeBodyDescription *body = rig_passive(rig, "body", fine, NULL);
  body->lod = (SporeLodDescription){.model = {coarse}, .first = SPORE_LOD_FINE, .tolerance = 1e-3};
  SporeError error = SPORE_ERROR_INIT;
  g_assert_null(rig_try_build(rig, &error));
  g_assert_cmpstr(error.place, ==, "bodies/body");
  g_assert_nonnull(strstr(error.message, said));
  rig_free(rig);
}

static void test_no_level(void) {
  SporeTriangleMesh large;
  shape_sheet(&large, 11, 11, 0.02, TRUE);
  assert_no_world(net(20), rig_surface_model(&spore_mass_spring_net, &large, NULL), "level coarse: it weighs ");
  SporeTriangleMesh away;
  shape_level_sheet(&away, 11, 11, 0.01);
  assert_no_world(net(20), rig_surface_model(&spore_mass_spring_net, &away, NULL),
                  "level coarse does not lie where the others do: ");
  assert_no_world(net(20), rod(8), "level coarse: it is of another model than the body");
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  for (size_t i = 0; i < G_N_ELEMENTS(specimens); i++) {
    const Specimen *specimen = &specimens[i];
    g_autofree char *moving = g_strdup_printf("/level_of_detail/moving/%s", specimen->name);
    g_autofree char *round = g_strdup_printf("/level_of_detail/round-trip/%s", specimen->name);
    g_autofree char *rest = g_strdup_printf("/level_of_detail/rest/%s", specimen->name);
    g_test_add_data_func(moving, specimen, test_moving);
    g_test_add_data_func(round, specimen, test_round_trip);
    g_test_add_data_func(rest, specimen, test_rest);
  }
  g_test_add_func("/level_of_detail/held", test_held);
  g_test_add_func("/level_of_detail/deterministic", test_deterministic);
  g_test_add_func("/level_of_detail/refused", test_refused);
  g_test_add_func("/level_of_detail/no-level", test_no_level);
  return g_test_run();
}
