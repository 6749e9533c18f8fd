/* Many islands, of every integrator, on any number of threads: the same bits. */
#include "tests/stability/rig.h"

#define NETS 30 /* enough work for the pool to be called, whatever integrates them */

static void add_net(Rig *rig, guint index, SporeIntegratorKind integrator) {
  SporeTriangleMesh sheet;
  g_autofree char *name = g_strdup_printf("net%u", index);
  shape_sheet(&sheet, 6, 6, 0.02, TRUE);
  SporeModel *model = rig_surface_model(&spore_mass_spring_net, &sheet, "damping", 0.01 + 0.001 * index, NULL);
  SporeBodyDescription *net = rig_passive(rig, g_intern_string(name), model, NULL);
  net->integrator = integrator;
  net->pose.position = spore_vec3(0.2 * index, 0, 0);
  rig_pin(rig, index, net->pose.position, 1e-3);
}

static void test_integrator(gconstpointer data) {
  uint64_t expected = 0;
  for (int threads = 1; threads <= 4; threads *= 2) {
    Rig *rig = rig_new();
    rig->description.gravity = spore_vec3(0, -9.81, 0);
    rig->description.solver.time_step = 1e-4;
    for (guint i = 0; i < NETS; i++) add_net(rig, i, (SporeIntegratorKind)GPOINTER_TO_INT(data));
    SporePool *pool = spore_pool_create(threads);
    rig->description.bodies = (const SporeBodyDescription *)(const void *)rig->bodies->data;
    rig->description.body_count = rig->bodies->len;
    rig->description.links = (const SporeLinkDescription *)(const void *)rig->links->data;
    rig->description.link_count = rig->links->len;
    rig->world = spore_world_create(&rig->description, pool, NULL);
    g_assert_nonnull(rig->world);
    rig_run(rig->world, 10);
    g_assert_cmpuint(spore_world_counts(rig->world).islands, ==, NETS);
    if (threads == 1) expected = spore_world_hash(rig->world);
    g_assert_cmphex(spore_world_hash(rig->world), ==, expected);
    rig_free(rig);
    spore_pool_free(pool);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  for (int kind = 0; spore_integrator_names[kind]; kind++) {
    g_autofree char *path = g_strdup_printf("/threads/%s", spore_integrator_names[kind]);
    g_test_add_data_func(path, GINT_TO_POINTER(kind), test_integrator);
  }
  return g_test_run();
}
