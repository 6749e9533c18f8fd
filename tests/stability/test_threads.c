/* Many islands, of every integrator, and large bodies of every kind that computes on several threads: the same bits on
 * any number of them. */
#include "tests/stability/rig.h"

#define NETS 30 /* enough work for the pool to be called, whatever integrates them */
#define THREADS 4

static Rig *new_rig(SporeIntegratorKind integrator, double time_step) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = time_step;
  rig->description.solver.integrator = integrator;
  return rig;
}

static void add_net(Rig *rig, guint index) {
  SporeTriangleMesh sheet;
  g_autofree char *name = g_strdup_printf("net%u", index);
  shape_sheet(&sheet, 6, 6, 0.02, TRUE);
  SporeModel *model = rig_surface_model(&spore_mass_spring_net, &sheet, "damping", 0.01 + 0.001 * index, NULL);
  SporeBodyDescription *net = rig_passive(rig, g_intern_string(name), model, NULL);
  net->integrator = rig->description.solver.integrator;
  net->pose.position = spore_vec3(0.2 * index, 0, 0);
  rig_pin(rig, index, net->pose.position, 1e-3);
}

static void test_integrator(gconstpointer data) {
  uint64_t expected = 0;
  for (int threads = 1; threads <= THREADS; threads *= tests_sanitized ? THREADS : 2) {
    Rig *rig = new_rig((SporeIntegratorKind)GPOINTER_TO_INT(data), 1e-4);
    for (guint i = 0; i < NETS; i++) add_net(rig, i);
    SporePool *pool = spore_pool_create(threads);
    rig_build_on(rig, pool);
    rig_run(rig->world, 10);
    g_assert_cmpuint(spore_world_counts(rig->world).islands, ==, NETS);
    if (threads == 1) expected = spore_world_hash(rig->world);
    g_assert_cmphex(spore_world_hash(rig->world), ==, expected);
    rig_free(rig);
    spore_pool_free(pool);
  }
}

/* Bodies of which every loop alone is enough work for the pool. */
static SporeModel *large_net(void) {
  SporeTriangleMesh sheet;
  shape_sheet(&sheet, 60, 60, 0.01, TRUE);
  return rig_surface_model(&spore_mass_spring_net, &sheet, NULL);
}

static SporeModel *large_surface(void) {
  SporeTriangleMesh surface;
  shape_block_surface(&surface, 50, 50, 1, spore_vec3(0.5, 0.5, 0.01));
  return rig_surface_model(&spore_deformable_surface, &surface, NULL);
}

static SporeModel *large_solid(const SporeModelType *type) {
  SporeTetrahedralMesh block;
  shape_block(&block, 20, 10, 10, spore_vec3(0.2, 0.1, 0.1));
  return rig_solid_model(type, &block, NULL);
}

static SporeModel *large_corotational(void) { return large_solid(&spore_corotational_tetrahedra); }
static SporeModel *large_neo_hookean(void) { return large_solid(&spore_neo_hookean_tetrahedra); }

typedef struct Large {
  const char *name;
  SporeModel *(*create)(void);
  SporeIntegratorKind integrator;
  guint bodies; /* several: each is computed by one thread, and calls the pool that it runs in */
} Large;

static uint64_t hash_of(const Large *large, int threads) {
  bool implicit = large->integrator == SPORE_INTEGRATOR_IMPLICIT_EULER;
  Rig *rig = new_rig(large->integrator, implicit ? 5e-3 : 1e-4);
  for (guint i = 0; i < large->bodies; i++) {
    g_autofree char *name = g_strdup_printf("body%u", i);
    rig_passive(rig, g_intern_string(name), large->create(), NULL)->pose.position.x = i;
    rig_pin(rig, i, spore_vec3(i, 0, 0), 0.015);
  }
  SporePool *pool = threads > 0 ? spore_pool_create(threads) : NULL;
  rig_build_on(rig, pool);
  uint64_t start = spore_world_hash(rig->world);
  rig_run(rig->world, implicit ? rig_steps(3, 2) : rig_steps(10, 3));
  uint64_t hash = spore_world_hash(rig->world);
  g_assert_cmphex(hash, !=, start);
  g_assert_true(rig_finite(rig->world));
  rig_free(rig);
  spore_pool_free(pool);
  return hash;
}

static void test_large(gconstpointer data) {
  uint64_t expected = hash_of(data, 0);
  for (int threads = tests_sanitized ? THREADS : 1; threads <= THREADS; threads++)
    g_assert_cmphex(hash_of(data, threads), ==, expected);
}

int main(int argc, char **argv) {
  static const Large larges[] = {
      {"net/explicit", large_net, SPORE_INTEGRATOR_SYMPLECTIC_EULER, 1},
      {"net/implicit", large_net, SPORE_INTEGRATOR_IMPLICIT_EULER, 1},
      {"surface/explicit", large_surface, SPORE_INTEGRATOR_SYMPLECTIC_EULER, 1},
      {"surface/implicit", large_surface, SPORE_INTEGRATOR_IMPLICIT_EULER, 1},
      {"corotational/explicit", large_corotational, SPORE_INTEGRATOR_SYMPLECTIC_EULER, 1},
      {"corotational/implicit", large_corotational, SPORE_INTEGRATOR_IMPLICIT_EULER, 1},
      {"neo_hookean/implicit", large_neo_hookean, SPORE_INTEGRATOR_IMPLICIT_EULER, 1},
      {"three_nets/implicit", large_net, SPORE_INTEGRATOR_IMPLICIT_EULER, 3},
  };
  g_test_init(&argc, &argv, NULL);
  for (int kind = 0; spore_integrator_names[kind]; kind++) {
    g_autofree char *path = g_strdup_printf("/threads/%s", spore_integrator_names[kind]);
    g_test_add_data_func(path, GINT_TO_POINTER(kind), test_integrator);
  }
  for (size_t i = 0; i < G_N_ELEMENTS(larges); i++) {
    g_autofree char *path = g_strdup_printf("/threads/large/%s", larges[i].name);
    g_test_add_data_func(path, &larges[i], test_large);
  }
  return g_test_run();
}
