/* Scenes while memory runs short: from reading a scene to its last step, each allocation of the kernel fails, at its
 * first and at its last turn on every way by which the program comes to it, in the smallest shipped scene that goes
 * that way. What cannot be made is refused for want of memory, a step goes on without what it has no room for, and
 * nothing leaks (the sanitizer looks). */
#include <glib.h>
#include <string.h>

#include "core/author/generator.h"
#include "core/base/memory.h"
#include "core/io/scene_xml.h"
#include "core/scene/compile.h"
#include "models/registry.h"
#include "tests/ways.h"

#define STEPS 8

typedef struct Scene {
  char *file;
  guint64 allocations; /* of a whole life */
} Scene;

/* Steps, changes levels both ways, and reads what is published. */
static void run(SporeWorld *world) {
  for (int step = 0; step < STEPS; step++) {
    for (guint32 body = 0; step % 4 == 2 && body < spore_world_body_count(world); body++) {
      SporeLodGrade level = step == 2 ? SPORE_LOD_COARSE : SPORE_LOD_FINE;
      const SporeCommand command = {.kind = SPORE_COMMAND_LOD, .body = body, .level = level};
      if (spore_world_lod_model(world, body, level)) spore_world_post(world, &command);
    }
    spore_world_step(world);
    spore_world_tidy(world);
    const SporeSnapshot *snapshot = spore_world_snapshot_acquire(world);
    g_assert_cmpuint(snapshot->step, ==, spore_world_step_count(world));
  }
}

/* Fewer particles and cells: to look for what lies inside a surface takes most of the time, and all go the same way. */
static void coarsen(SporeDocument *document) {
  static const struct { const char *name, *value; } settings[] = {{"particles", "120"}, {"cells", "5"}};
  SporeObject *bodies = spore_document_section(document, "bodies"),
              *effects = spore_document_section(document, "effects");
  for (guint e = 0; e < spore_object_child_count(effects); e++) { /* no more can be kept back than there are */
    SporeObject *effect = spore_object_child(effects, e);
    if (spore_parameter_find(spore_object_type(effect)->table, "reserve") < 0) continue;
    if (spore_object_number(effect, "reserve") > 20) spore_document_set_text(document, effect, "reserve", "20", NULL);
  }
  for (guint b = 0; b < spore_object_child_count(bodies); b++) {
    SporeObject *mechanical = spore_object_child_of(spore_object_child(bodies, b), "mechanical");
    if (!mechanical || spore_object_child_count(mechanical) == 0) continue;
    SporeObject *model = spore_object_child(mechanical, 0);
    for (guint s = 0; s < G_N_ELEMENTS(settings); s++)
      if (spore_parameter_find(spore_object_type(model)->table, settings[s].name) >= 0)
        spore_document_set_text(document, model, settings[s].name, settings[s].value, NULL);
  }
}

static SporeSchema *schema;
static const char *file; /* of the scene that lives */

static bool live_in(SporeDocument *document, SporePool *pool, GError **error) {
  SporeSimulation *simulation = spore_simulation_new(document, pool, NULL, NULL, error);
  if (!simulation) return false;
  run(simulation->world);
  spore_simulation_free(simulation);
  return true;
}

/* Reads, makes and runs the scene. */
static bool live(GError **error) {
  SporeDocument *document = spore_scene_load(schema, file, error);
  if (!document) return false;
  coarsen(document);
  SporePool *pool = spore_pool_create(1);
  bool lived = pool ? live_in(document, pool, error)
                    : spore_error_raise(error, SPORE_ERROR_MEMORY, file, "there is no memory for a pool of threads");
  spore_pool_free(pool);
  spore_document_free(document);
  return lived;
}

static void test_scene(gconstpointer data) {
  const Scene *scene = data;
  file = scene->file;
  ways_fail_each(live);
}

static int compare_scenes(gconstpointer a, gconstpointer b) {
  const Scene *x = *(Scene *const *)a, *y = *(Scene *const *)b;
  if (x->allocations != y->allocations) return x->allocations < y->allocations ? -1 : 1;
  return strcmp(x->file, y->file);
}

static void free_scene(gpointer data) {
  Scene *scene = data;
  g_free(scene->file);
  g_free(scene);
}

static guint64 count_allocations(const char *of) {
  GError *error = NULL;
  guint64 before = spore_allocation_count();
  file = of;
  g_assert_true(live(&error));
  g_assert_no_error(error);
  return spore_allocation_count() - before;
}

/* The shipped scenes, the one with the fewest allocations first. */
static GPtrArray *list_scenes(void) {
  GPtrArray *scenes = g_ptr_array_new_with_free_func(free_scene);
  g_autoptr(GDir) folder = g_dir_open(SPORE_SCENES, 0, NULL);
  g_assert_nonnull(folder);
  for (const char *name; (name = g_dir_read_name(folder));) {
    if (!g_str_has_suffix(name, ".spore")) continue;
    Scene *scene = g_new0(Scene, 1);
    scene->file = g_build_filename(SPORE_SCENES, name, NULL);
    scene->allocations = count_allocations(scene->file);
    g_ptr_array_add(scenes, scene);
  }
  g_ptr_array_sort(scenes, compare_scenes);
  return scenes;
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  g_autoptr(GPtrArray) scenes = list_scenes();
  for (guint i = 0; i < scenes->len; i++) {
    const Scene *scene = scenes->pdata[i];
    g_autofree char *name = g_path_get_basename(scene->file), *path = g_strconcat("/memory/", name, NULL);
    g_test_add_data_func(path, scene, test_scene);
  }
  int status = g_test_run();
  ways_clear();
  spore_schema_free(schema);
  return status;
}
