/* Physics knows no origin, scale, axes or numbering: cases 16, 17, 29 and 30. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/stability/rig.h"

/* What is done to the scene. */
typedef struct Change {
  SporePose pose;      /* of the whole scene */
  double length, time; /* scales; mass scales with the cube of length (square for a net), stiffness to match */
  gboolean relabel;
} Change;

static const Change none = {{{0, 0, 0}, {1, 0, 0, 0}}, 1, 1, FALSE};

static uint32_t *order_for(size_t count, gboolean relabel) {
  GRand *random = g_rand_new_with_seed(77);
  uint32_t *order = shape_order(count, random);
  for (size_t i = 0; !relabel && i < count; i++) order[i] = (uint32_t)i;
  g_rand_free(random);
  return order;
}

static void scale_points(double *points, size_t count, double length) {
  for (size_t i = 0; i < 3 * count; i++) points[i] *= length;
}

static SporePose placed(const Change *change, SporeVec3 at, SporeVec3 turn) {
  SporePose pose = {spore_vec3_scale(change->length, at), spore_quat_from_rotation_vector(turn)};
  return (SporePose){spore_pose_apply(change->pose, pose.position),
                     spore_quat_multiply(change->pose.orientation, pose.orientation)};
}

static void add_body(Rig *rig, const Change *change, const char *name, SporeModel *model, SporeVec3 at, SporeVec3 turn,
                     SporeVec3 velocity, SporeVec3 spin) {
  SporeBodyDescription *body = rig_passive(rig, name, model, NULL);
  body->pose = placed(change, at, turn);
  SporeVec3 scaled = spore_vec3_scale(change->length / change->time, velocity);
  body->velocity = spore_quat_rotate(change->pose.orientation, scaled);
  body->spin = spore_quat_rotate(change->pose.orientation, spore_vec3_scale(1 / change->time, spin));
}

/* A block of tissue and a net, both thrown and turning, and a stone; the block and the stone hang on springs. */
static Rig *scene(const Change *change, uint32_t **block_order, uint32_t **sheet_order) {
  Rig *rig = rig_new();
  double l = change->length, t = change->time, pressure = l * l / (t * t);
  rig->description.solver.time_step = 2e-3 * t;
  rig->description.solver.tolerance = 1e-11;
  rig->description.gravity = spore_quat_rotate(change->pose.orientation, spore_vec3(0, -9.81 * l / (t * t), 0));

  SporeTetrahedralMesh block, named;
  shape_block(&block, 3, 2, 2, spore_vec3(0.03, 0.02, 0.02));
  scale_points(block.vertices, block.vertex_count, l);
  *block_order = order_for(block.vertex_count, change->relabel);
  shape_relabel_tetrahedra(&named, &block, *block_order);
  spore_tetrahedral_mesh_clear(&block);
  add_body(rig, change, "block",
           rig_tetrahedra_model(&named, "young_modulus", 5000 * pressure, "stiffness_damping", 0.01 * t, NULL),
           spore_vec3(0, 0, 0), spore_vec3(0.1, 0.2, 0.3), spore_vec3(0.1, 0.2, 0), spore_vec3(1, 5, 2));

  SporeTriangleMesh sheet, named_sheet;
  shape_sheet(&sheet, 7, 6, 0.01, TRUE);
  scale_points(sheet.vertices, sheet.vertex_count, l);
  *sheet_order = order_for(sheet.vertex_count, change->relabel);
  shape_relabel_triangles(&named_sheet, &sheet, *sheet_order);
  spore_triangle_mesh_clear(&sheet);
  double k = l * l / (t * t); /* N/m, of a net whose mass goes with its area */
  add_body(rig, change, "net",
           rig_surface_model(&spore_mass_spring_net, &named_sheet, "structural_stiffness", 100 * k, "shear_stiffness",
                             50 * k, "bending_stiffness", 10 * k, "damping", 0.01 * k * t, NULL),
           spore_vec3(0.1, 0, 0), spore_vec3(1, 0.2, 0.3), spore_vec3(0.1, 0.5, 0), spore_vec3(3, 1, 10));

  SporeTriangleMesh stone;
  shape_box(&stone, spore_vec3(0.01 * l, 0, 0), spore_vec3(0.01 * l, 0.02 * l, 0.03 * l));
  add_body(rig, change, "stone", rig_surface_model(&spore_rigid_body, &stone, NULL), spore_vec3(0, 0.1, 0),
           spore_vec3(0, 0, 1), spore_vec3(0, 0, 0.1), spore_vec3(10, 20, 5));

  double link = l * l * l / (t * t); /* N/m, of bodies whose mass goes with their volume */
  SporeLinkDescription spring = {.name = "tie",
                                 .type = &spore_link_spring,
                                 .body_a = 0,
                                 .body_b = 2,
                                 .point_a = placed(change, spore_vec3(0.005, 0.01, 0.01), spore_vec3(0, 0, 0)).position,
                                 .point_b = placed(change, spore_vec3(0.005, 0.1, 0), spore_vec3(0, 0, 0)).position,
                                 .stiffness = 20 * link,
                                 .damping = 0.01 * link * t,
                                 .rest_length = -1};
  g_array_append_val(rig->links, spring);
  rig_build(rig);
  return rig;
}

/* Positions brought back to the unchanged scene. */
static void record(GArray *to, const SporeWorld *world, const Change *change, uint32_t *const order[2]) {
  SporeQuat back = spore_quat_conjugate(change->pose.orientation);
  for (uint32_t b = 0; b < 3; b++) {
    const double *q = spore_world_q(world, b);
    size_t count = b < 2 ? spore_world_body_model(world, b)->block_count : 1;
    for (size_t i = 0; i < count; i++) {
      SporeVec3 x = spore_vec3_load(q + 3 * (b < 2 ? order[b][i] : i));
      x = spore_quat_rotate(back, spore_vec3_sub(x, change->pose.position));
      double values[3];
      spore_vec3_store(values, spore_vec3_scale(1 / change->length, x));
      g_array_append_vals(to, values, 3);
    }
  }
}

static GArray *run(const Change *change, unsigned steps) {
  uint32_t *order[2];
  Rig *rig = scene(change, &order[0], &order[1]);
  GArray *positions = g_array_new(FALSE, FALSE, sizeof(double));
  for (unsigned i = 0; i < steps; i++) {
    spore_world_step(rig->world);
    if (i % 10 == 9) record(positions, rig->world, change, order);
  }
  g_assert_true(rig_finite(rig->world));
  g_assert_false(rig_any_frozen(rig->world));
  g_free(order[0]);
  g_free(order[1]);
  rig_free(rig);
  return positions;
}

/* Greatest distance between the runs, in the unchanged scene's metres. */
static double difference(const Change *change, unsigned steps) {
  GArray *a = run(&none, steps), *b = run(change, steps);
  double worst = 0, travelled = 0;
  g_assert_cmpuint(a->len, ==, b->len);
  for (guint i = 0; i < a->len; i++) {
    worst = fmax(worst, fabs(g_array_index(a, double, i) - g_array_index(b, double, i)));
    travelled =
        fmax(travelled, fabs(g_array_index(a, double, i) - g_array_index(a, double, i % (a->len / (steps / 10)))));
  }
  g_assert_cmpfloat(travelled, >, 0.01); /* something went on */
  g_array_unref(a);
  g_array_unref(b);
  return worst;
}

static void case_16(void) {
  Change change = none;
  change.pose.position = spore_vec3(1e6, -1e6, 1e6);
  double worst = difference(&change, 100);
  g_test_message("case 16: 1e6 m away: paths differ by %.2e m", worst);
  g_assert_cmpfloat(worst, <, 1e-6);
}

static void case_17(void) {
  Change change = none;
  change.length = 1e-6;
  change.time = 1e-3; /* as small as the smallest time step lets it be */
  double worst = difference(&change, 100);
  g_test_message("case 17: 1e-6 of the size: paths differ by %.2e m, scaled back", worst);
  g_assert_cmpfloat(worst / 0.03, <, 1e-8);
}

static void case_29(void) {
  Change change = none;
  change.pose.orientation = spore_quat_from_rotation_vector(spore_vec3(0.3, -1.1, 2.2));
  double worst = difference(&change, 100);
  g_test_message("case 29: turned scene: paths differ by %.2e m", worst);
  g_assert_cmpfloat(worst, <, 1e-9);
}

static void case_30(void) {
  Change change = none;
  change.relabel = TRUE;
  double worst = difference(&change, 100);
  g_test_message("case 30: other numbers: paths differ by %.2e m", worst);
  g_assert_cmpfloat(worst, <, 1e-9);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/16_far_away", case_16);
  g_test_add_func("/stability/17_small", case_17);
  g_test_add_func("/stability/29_turned", case_29);
  g_test_add_func("/stability/30_relabelled", case_30);
  return g_test_run();
}
