/* Surface around a set of particles. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/mesh.h"

#define SPACING 2e-3

/* An n x n x n block of particles from `corner`; returns the next free place. */
static size_t add_block(double *centres, size_t at, size_t n, double corner) {
  for (size_t i = 0; i < n * n * n; i++, at++) {
    const size_t place[3] = {i % n, i / n % n, i / (n * n)};
    for (int k = 0; k < 3; k++) centres[3 * at + k] = corner + (double)place[k] * SPACING;
  }
  return at;
}

static SporeMeshReport report_of(const double *centres, size_t count) {
  SporeTriangleMesh skin;
  SporeMeshReport report;
  g_assert_true(spore_particle_skin(centres, count, SPACING, &skin, NULL));
  g_assert_true(spore_triangle_mesh_validate(&skin, NULL));
  g_assert_true(spore_triangle_mesh_report(&skin, &report, NULL));
  spore_triangle_mesh_clear(&skin);
  return report;
}

/* One closed skin, looking outward, around about the space that the particles have. */
static void test_block(void) {
  double centres[3 * 512];
  SporeMeshReport report = report_of(centres, add_block(centres, 0, 8, 0.1));
  g_assert_true(report.closed);
  g_assert_cmpuint(report.components, ==, 1);
  double side = cbrt(report.volume) / SPACING;
  g_assert_cmpfloat_with_epsilon(side, 8, 0.4);
  g_assert_cmpfloat_with_epsilon(report.lower[0], 0.1 - 0.55 * SPACING, 0.15 * SPACING);
}

static void test_drops_part(void) {
  double centres[3 * 128];
  size_t count = add_block(centres, add_block(centres, 0, 4, 0), 4, 0.1);
  SporeMeshReport report = report_of(centres, count);
  g_assert_true(report.closed);
  g_assert_cmpuint(report.components, ==, 2);
}

/* No strand is spun between particles that are near enough to weigh in each other's surroundings. */
static void test_strangers_part(void) {
  const double centres[6] = {0, 0, 0, 2 * SPACING, 0, 0};
  SporeMeshReport report = report_of(centres, 2);
  g_assert_true(report.closed);
  g_assert_cmpuint(report.components, ==, 2);
}

/* Particles that are nowhere, and ones beyond all bounds, leave the others' skin as it is. */
static void test_lost_particles(void) {
  double centres[3 * 66] = {0};
  size_t count = add_block(centres, 0, 4, 0);
  double volume = report_of(centres, count).volume;
  centres[3 * 64] = NAN;
  centres[3 * 65 + 1] = 1e9;
  g_assert_cmpfloat(report_of(centres, 66).volume, ==, volume);
}

static void test_none(void) {
  SporeTriangleMesh skin;
  g_assert_true(spore_particle_skin(NULL, 0, SPACING, &skin, NULL));
  g_assert_cmpuint(skin.triangle_count, ==, 0);
}

static void test_no_memory(void) {
  double centres[3 * 64];
  size_t count = add_block(centres, 0, 4, 0);
  SporeTriangleMesh skin;
  uint64_t before = spore_allocation_count();
  g_assert_true(spore_particle_skin(centres, count, SPACING, &skin, NULL));
  spore_triangle_mesh_clear(&skin);
  uint64_t needed = spore_allocation_count() - before;
  for (uint64_t n = 1; n <= needed; n++) {
    spore_allocation_fail_at(n);
    SporeError error = {0};
    g_assert_false(spore_particle_skin(centres, count, SPACING, &skin, &error));
    g_assert_nonnull(strstr(error.message, "memory"));
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/mesh/particle-skin/block", test_block);
  g_test_add_func("/mesh/particle-skin/drops-part", test_drops_part);
  g_test_add_func("/mesh/particle-skin/strangers-part", test_strangers_part);
  g_test_add_func("/mesh/particle-skin/lost-particles", test_lost_particles);
  g_test_add_func("/mesh/particle-skin/none", test_none);
  g_test_add_func("/mesh/particle-skin/no-memory", test_no_memory);
  return g_test_run();
}
