/* The suture, from its scene's recorded input: the needle goes through both edges of the wound, and its thread draws
 * them together. */
#include <glib.h>

#include "core/author/generator.h"
#include "core/io/scene_xml.h"
#include "core/scene/compile.h"
#include "models/registry.h"

/* Of the skin as make_suture.py makes it: the middle of the wound's left edge, and of its right one. */
#define LEFT (7 * 21 + 10)
#define RIGHT (15 * 21 + 3)
#define WOUND_M 0.006
#define SEWN_S 1.3
#define END_S 2.8

static double wound_width(const SporeWorld *world) {
  const double *q = spore_world_q(world, spore_world_find_body(world, "skin"));
  return spore_vec3_distance(spore_vec3_load(q + 3 * LEFT), spore_vec3_load(q + 3 * RIGHT));
}

static void run_until(SporeWorld *world, double time_s) {
  while (spore_world_time_s(world) < time_s - 1e-9) spore_world_step(world);
}

static void edges_come_together(void) {
  GError *error = NULL;
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  SporeDocument *document = spore_scene_load(schema, SPORE_SCENES "/suture.spore", &error);
  g_assert_no_error(error);
  SporePool *pool = spore_pool_create(1);
  SporeSimulation *simulation = spore_simulation_new(document, pool, NULL, NULL, &error);
  g_assert_no_error(error);
  SporeWorld *world = simulation->world;
  double before = wound_width(world);
  g_assert_cmpfloat_with_epsilon(before, WOUND_M, 1e-6);
  run_until(world, SEWN_S);
  SporeToolState state = spore_world_tool_state(world, 0);
  g_test_message("%zu pierced, %zu stitches, wound of %.2f mm", state.pierced, state.stitches,
                 1e3 * wound_width(world));
  g_assert_cmpuint(state.pierced, ==, 2);
  run_until(world, END_S);
  state = spore_world_tool_state(world, 0);
  const SporeMonitor *monitor = spore_world_monitor(world);
  g_test_message("%zu stitches, wound of %.2f mm; %llu of %llu steps not solved", state.stitches,
                 1e3 * wound_width(world), (unsigned long long)monitor->not_converged,
                 (unsigned long long)spore_world_step_count(world));
  g_assert_cmpuint(state.pierced, ==, 2);
  g_assert_cmpuint(state.stitches, ==, 2);
  g_assert_cmpfloat(wound_width(world), <, 0.5 * before);
  g_assert_cmpuint(monitor->not_finite + monitor->too_fast + monitor->lost_holds, ==, 0);
  g_assert_cmpuint(monitor->not_converged + monitor->recoveries, ==, 0);
  spore_simulation_free(simulation);
  spore_pool_free(pool);
  spore_document_free(document);
  spore_schema_free(schema);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/suture/edges-come-together", edges_come_together);
  return g_test_run();
}
