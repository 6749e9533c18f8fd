/* Tetrahedra in bad shape: cases 6 to 11. */
#include <math.h>
#include <string.h>

#include "models/tetrahedra/map.h"
#include "tests/stability/rig.h"

/* Size-relative distance from the rest shape in the best frame: edge lengths against those at rest. */
static double shape_error(const double *q, const double *rest, const SporeTetrahedralMesh *mesh) {
  double worst = 0;
  for (size_t t = 0; t < mesh->tetrahedron_count; t++)
    for (int a = 0; a < 4; a++)
      for (int b = 0; b < a; b++) {
        size_t i = 3 * (size_t)mesh->tetrahedra[4 * t + a], j = 3 * (size_t)mesh->tetrahedra[4 * t + b];
        double now = spore_vec3_distance(spore_vec3_load(q + i), spore_vec3_load(q + j));
        double then = spore_vec3_distance(spore_vec3_load(rest + i), spore_vec3_load(rest + j));
        worst = fmax(worst, fabs(now - then) / then);
      }
  return worst;
}

/* Volume of the element that is worst off, relative to its own at rest. */
static double least_volume(const double *q, const double *rest, const SporeTetrahedralMesh *mesh) {
  double least = HUGE_VAL;
  SporeVec3 unused[3];
  for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
    const uint32_t *corners = mesh->tetrahedra + 4 * t;
    least = fmin(least,
                 spore_tetrahedron_gradients(q, corners, unused) / spore_tetrahedron_gradients(rest, corners, unused));
  }
  return least;
}

/* Angle between the element's faces at its edge from `from` to `to`; 0: it has no such edge. */
static double dihedral_angle(const double *q, const uint32_t *corners, uint32_t from, uint32_t to) {
  SporeVec3 origin = spore_vec3_load(q + 3 * (size_t)from), flat[4];
  SporeVec3 edge = spore_vec3_sub(spore_vec3_load(q + 3 * (size_t)to), origin);
  edge = spore_vec3_normalise(edge, (SporeVec3){0, 0, 0});
  int others = 0;
  for (int k = 0; k < 4; k++) {
    if (corners[k] == from || corners[k] == to) continue;
    SporeVec3 side = spore_vec3_sub(spore_vec3_load(q + 3 * (size_t)corners[k]), origin);
    flat[others++] = spore_vec3_add_scaled(side, -spore_vec3_dot(side, edge), edge);
  }
  if (others != 2) return 0;
  return atan2(spore_vec3_length(spore_vec3_cross(flat[0], flat[1])), spore_vec3_dot(flat[0], flat[1]));
}

/* The most that the elements around an edge inside the mesh turn about it: 1 in a sound one. */
static double most_turns(const double *q, const double *rest, const SporeTetrahedralMesh *mesh) {
  double most = 0;
  for (uint32_t a = 0; a < mesh->vertex_count; a++)
    for (uint32_t b = a + 1; b < mesh->vertex_count; b++) {
      double turns = 0, whole = 0;
      for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
        turns += dihedral_angle(q, mesh->tetrahedra + 4 * t, a, b) / (2 * G_PI);
        whole += dihedral_angle(rest, mesh->tetrahedra + 4 * t, a, b) / (2 * G_PI);
      }
      if (fabs(whole - 1) < 1e-9) most = fmax(most, turns);
    }
  return most;
}

typedef struct Recovery {
  double error, least_volume, turns;
  gboolean frozen;
} Recovery;

/* Starts a block of soft tissue from another shape and lets it come to rest. Returns what came of it. The
 * damping stops the spin that implicit Euler leaves, which would stretch the block. */
static Recovery recover(const SporeModelType *type, const char *name, guint32 seed,
                        void (*deform)(double *q, size_t nodes, GRand *random), unsigned steps) {
  SporeTetrahedralMesh block, copy;
  shape_block(&block, 2, 2, 2, spore_vec3(0.04, 0.04, 0.04));
  shape_block(&copy, 2, 2, 2, spore_vec3(0.04, 0.04, 0.04));
  Rig *rig = rig_new();
  rig->description.solver.time_step = 0.01;
  rig_passive(rig, "block", rig_solid_model(type, &block, "poisson_ratio", 0.3, "mass_damping", 5.0, NULL), NULL);
  SporeWorld *world = rig_build(rig);
  GRand *random = g_rand_new_with_seed(seed);
  size_t n = 3 * copy.vertex_count;
  double *q = g_memdup2(copy.vertices, n * sizeof(double)), *v = g_new0(double, n);
  deform(q, copy.vertex_count, random);
  spore_world_set_state(world, 0, q, v);
  double before = shape_error(q, copy.vertices, &copy), start = rig_energy(world), most = start;
  for (unsigned i = 0; i < steps; i++) {
    spore_world_step(world);
    most = fmax(most, rig_energy(world));
  }
  const double *q1 = spore_world_q(world, 0);
  Recovery recovery = {shape_error(q1, copy.vertices, &copy), least_volume(q1, copy.vertices, &copy),
                       most_turns(q1, copy.vertices, &copy), rig_any_frozen(world)};
  g_test_message(
      "%s, %s: edges off by %.2e at first, %.2e after %g s; energy %.2e J, at most %.2e J; %u not converged; %s", name,
      type->name, before, recovery.error, spore_world_time_s(world), start, most,
      (unsigned)spore_world_monitor(world)->not_converged, rig_last_message(world));
  g_assert_true(rig_finite(world));
  g_assert_cmpfloat(most, <=, start * (1 + 1e-6));
  g_rand_free(random);
  g_free(q);
  g_free(v);
  spore_tetrahedral_mesh_clear(&copy);
  rig_free(rig);
  return recovery;
}

static void invert_corner(double *q, size_t nodes, GRand *random) {
  for (int k = 0; k < 3; k++) q[3 * (nodes - 1) + k] -= 0.03; /* through the opposite face of its tetrahedra */
}

static void flatten(double *q, size_t nodes, GRand *random) {
  for (size_t i = 0; i < nodes; i++) q[3 * i + 1] = 0.02;
}

static void shuffle(double *q, size_t nodes, GRand *random) {
  for (size_t i = 0; i < 3 * nodes; i++) q[i] = g_rand_double_range(random, 0, 0.04);
}

/* Neo-Hookean forces grow with the square of what is left of the shape: within 1 um it would take minutes. */
static void gather_to_point(double *q, size_t nodes, GRand *random) {
  for (size_t i = 0; i < 3 * nodes; i++) q[i] = 0.02 + g_rand_double_range(random, -1e-5, 1e-5);
}

static void case_6(void) {
  SporeTetrahedralMesh block;
  shape_block(&block, 2, 2, 2, spore_vec3(0.04, 0.04, 0.04));
  /* The corner (0, 0, 0) belongs to six tetrahedra round the diagonal; a vertex pulled toward the far side of its
   * cell makes slivers. */
  double *middle = block.vertices + 3 * 13, *next = block.vertices + 3 * 14;
  for (int k = 0; k < 3; k++) middle[k] = next[k] + (middle[k] - next[k]) * 2e-6;
  SporeTetrahedraQuality quality;
  spore_tetrahedral_mesh_quality(&block, &quality);
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  SporeError error = SPORE_ERROR_INIT;
  SporeModel *model = rig_try_tetrahedra(&block, &error, NULL);
  if (!model) {
    g_test_message("case 6: worst radius ratio %.1e: refused: %s: %s", quality.worst_radius_ratio, error.place,
                   error.message);
    g_assert_true(g_str_has_prefix(error.place, "tetrahedron "));
    rig_free(rig);
    return;
  }
  rig_passive(rig, "block", model, NULL);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-3);
  SporeWorld *world = rig_build(rig);
  double start = rig_energy(world), most = -HUGE_VAL;
  for (int i = 0; i < 300; i++) {
    spore_world_step(world);
    most = fmax(most, rig_energy(world));
  }
  g_test_message("case 6: worst radius ratio %.1e: energy at most %+.1e J above the start, frozen %d, %s",
                 quality.worst_radius_ratio, most - start, rig_any_frozen(world), rig_last_message(world));
  g_assert_true(rig_finite(world));
  g_assert_cmpfloat(most - start, <, 1e-9);
  rig_free(rig);
}

/* Flat, turned round, or of no size: refused, with the element's number and what to do. */
static void case_7(void) {
  for (int kind = 0; kind < 3; kind++) {
    SporeTetrahedralMesh block;
    shape_block(&block, 1, 1, 2, spore_vec3(0.01, 0.01, 0.02));
    uint32_t *bad = block.tetrahedra + 4 * 7;
    if (kind == 0) bad[3] = bad[2];
    if (kind == 1) {
      uint32_t kept = bad[0];
      bad[0] = bad[1], bad[1] = kept;
    }
    if (kind == 2)
      for (int k = 0; k < 3; k++) block.vertices[3 * (size_t)bad[3] + k] = block.vertices[3 * (size_t)bad[0] + k];
    SporeError error = SPORE_ERROR_INIT;
    g_assert_null(rig_try_tetrahedra(&block, &error, NULL));
    g_test_message("case 7: %s: %s", error.place, error.message);
    g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
    if (kind < 2) g_assert_cmpstr(error.place, ==, "tetrahedron 7");
    else g_assert_true(g_str_has_prefix(error.place, "tetrahedron "));
  }
}

static const SporeModelType *const solids[] = {&spore_corotational_tetrahedra, &spore_neo_hookean_tetrahedra};

static void check_recovery(const SporeModelType *type, const char *name,
                           void (*deform)(double *q, size_t nodes, GRand *random)) {
  Recovery recovery = recover(type, name, 8, deform, 600);
  g_assert_cmpfloat(recovery.error, <, 1e-6);
  g_assert_false(recovery.frozen);
}

static void case_8(void) {
  for (size_t i = 0; i < G_N_ELEMENTS(solids); i++)
    check_recovery(solids[i], "case 8: one corner inside out", invert_corner);
}

/* The table asks recovery of the neo-Hookean element; of the corotational one the common pass is asked, and what is
 * left is said. A heap that does not recover (here one of twelve, of forty three) has come to rest with the mesh wound
 * twice round an edge: no element is inside out then, and no energy of single elements knows of it, so that no search
 * for less energy leaves it. */
static void case_9(void) {
  enum { HEAPS = 12, RECOVERED = 11 };
  unsigned recovered = 0;
  for (guint32 seed = 1; seed <= HEAPS; seed++) {
    Recovery recovery = recover(&spore_neo_hookean_tetrahedra, "case 9: all vertices random", seed, shuffle, 600);
    g_assert_false(recovery.frozen);
    g_assert_cmpfloat(recovery.least_volume, >, 0);
    if (recovery.error < 1e-4) recovered++;
    else g_test_message("case 9: heap %u is wound %.6f times round an edge", seed, recovery.turns);
    g_assert_true(recovery.error < 1e-4 || fabs(recovery.turns - 2) < 1e-6);
  }
  g_test_message("case 9: %u of %u heaps recovered", recovered, (unsigned)HEAPS);
  g_assert_cmpuint(recovered, >=, RECOVERED);
  g_assert_false(recover(&spore_corotational_tetrahedra, "case 9: all vertices random", 8, shuffle, 1000).frozen);
}

static void case_10(void) {
  for (size_t i = 0; i < G_N_ELEMENTS(solids); i++) check_recovery(solids[i], "case 10: collapsed to a plane", flatten);
}

static void case_11(void) {
  for (size_t i = 0; i < G_N_ELEMENTS(solids); i++)
    check_recovery(solids[i], "case 11: collapsed to a point", gather_to_point);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/06_sliver", case_6);
  g_test_add_func("/stability/07_no_volume", case_7);
  g_test_add_func("/stability/08_inverted", case_8);
  g_test_add_func("/stability/09_random", case_9);
  g_test_add_func("/stability/10_plane", case_10);
  g_test_add_func("/stability/11_point", case_11);
  return g_test_run();
}
