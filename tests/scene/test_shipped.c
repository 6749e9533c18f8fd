/* The scenes that ship: their steps allocate nothing once warm, the same bits come from any number of threads, and the
 * monitor has nothing to say, nor has check. */
#include <glib.h>

#include "core/author/generator.h"
#include "core/base/memory.h"
#include "core/io/scene_xml.h"
#include "core/scene/check.h"
#include "core/scene/compile.h"
#include "models/registry.h"
#include "tests/sanitized.h"

#define WARM_STEPS 40 /* room for contacts grows, preconditioners are chosen */
#define STEPS 60

typedef struct Run {
  uint64_t hash, allocations;
  SporeMonitor monitor;
} Run;

static Run run_scene(const char *file, int threads) {
  GError *error = NULL;
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  SporeDocument *document = spore_scene_load(schema, file, &error);
  g_assert_no_error(error);
  SporePool *pool = spore_pool_create(threads);
  SporeSimulation *simulation = spore_simulation_new(document, pool, NULL, NULL, &error);
  g_assert_no_error(error);
  SporeWorld *world = simulation->world;
  for (int i = 0; i < WARM_STEPS; i++) spore_world_step(world);
  uint64_t before = spore_allocation_count();
  for (int i = 0; i < STEPS; i++) spore_world_step(world);
  Run run = {spore_world_hash(world), spore_allocation_count() - before, *spore_world_monitor(world)};
  spore_simulation_free(simulation);
  spore_pool_free(pool);
  spore_document_free(document);
  spore_schema_free(schema);
  return run;
}

static void test_scene(gconstpointer data) {
  const char *file = data;
  uint64_t expected = 0;
  for (int threads = 1; threads <= 3; threads += tests_sanitized ? 2 : 1) {
    Run run = run_scene(file, threads);
    if (threads == 1) expected = run.hash;
    g_assert_cmphex(run.hash, ==, expected);
    g_assert_cmpuint(run.allocations, ==, 0);
    if (run.monitor.message_count) g_test_message("%s", run.monitor.messages[0].text);
    g_assert_cmpuint(run.monitor.message_count, ==, 0);
    g_assert_cmpuint(run.monitor.not_converged + run.monitor.recoveries, ==, 0);
    g_assert_cmpuint(run.monitor.deep_contacts, ==, 0);
  }
}

/* What check says of a scene that ships is false, or the scene is to be mended. */
static void test_check(gconstpointer data) {
  const char *file = data;
  GError *error = NULL;
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  SporeDocument *document = spore_scene_load(schema, file, &error);
  g_assert_no_error(error);
  g_autoptr(GPtrArray) diagnostics = spore_document_check(document, NULL);
  for (guint i = 0; i < diagnostics->len; i++) {
    const SporeDiagnostic *diagnostic = diagnostics->pdata[i];
    g_test_message("%s: %s", diagnostic->place, diagnostic->message);
  }
  g_assert_cmpuint(diagnostics->len, ==, 0);
  spore_document_free(document);
  spore_schema_free(schema);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_autoptr(GDir) folder = g_dir_open(SPORE_SCENES, 0, NULL);
  g_assert_nonnull(folder);
  for (const char *name; (name = g_dir_read_name(folder));) {
    if (!g_str_has_suffix(name, ".spore")) continue;
    g_autofree char *path = g_strconcat("/shipped/", name, NULL);
    g_test_add_data_func_full(path, g_build_filename(SPORE_SCENES, name, NULL), test_scene, g_free);
    g_autofree char *check = g_strconcat("/shipped/check/", name, NULL);
    g_test_add_data_func_full(check, g_build_filename(SPORE_SCENES, name, NULL), test_check, g_free);
  }
  return g_test_run();
}
