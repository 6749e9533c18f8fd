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

/* What happened in a life of a scene. */
typedef struct Life {
  gboolean read, made;
  guint64 allocations;
  guint64 hash; /* at the end; 0: it was not made */
} Life;

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

static void expect_memory(const GError *error) {
  if (!g_error_matches(error, SPORE_ERROR, SPORE_ERROR_MEMORY)) g_error("not for want of memory: %s", error->message);
}

/* Fewer particles and cells: to look for what lies inside a surface takes most of the time, and all go the same way. */
static void coarsen(SporeDocument *document) {
  static const struct { const char *name, *value; } settings[] = {{"particles", "120"}, {"cells", "5"}};
  SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint b = 0; b < spore_object_child_count(bodies); b++) {
    SporeObject *mechanical = spore_object_child_of(spore_object_child(bodies, b), "mechanical");
    if (!mechanical || spore_object_child_count(mechanical) == 0) continue;
    SporeObject *model = spore_object_child(mechanical, 0);
    for (guint s = 0; s < G_N_ELEMENTS(settings); s++)
      if (spore_parameter_find(spore_object_type(model)->table, settings[s].name) >= 0)
        spore_document_set_text(document, model, settings[s].name, settings[s].value, NULL);
  }
}

/* Reads, makes and runs the scene; the allocation of that number fails (0: none). */
static Life live(SporeSchema *schema, const char *file, guint64 failing) {
  Life life = {0};
  GError *error = NULL;
  guint64 start = spore_allocation_count();
  spore_allocation_fail_at(failing);
  SporeDocument *document = spore_scene_load(schema, file, &error);
  life.read = document != NULL;
  if (document) coarsen(document);
  SporePool *pool = document ? spore_pool_create(1) : NULL;
  SporeSimulation *simulation = pool ? spore_simulation_new(document, pool, NULL, NULL, &error) : NULL;
  life.made = simulation != NULL;
  if (life.made) run(simulation->world);
  spore_allocation_fail_at(0);
  life.allocations = spore_allocation_count() - start;
  if (life.made) life.hash = spore_world_hash(simulation->world);
  else if (error) expect_memory(error);
  else g_assert_null(pool);
  g_clear_error(&error);
  g_clear_pointer(&simulation, spore_simulation_free);
  spore_pool_free(pool);
  g_clear_pointer(&document, spore_document_free);
  return life;
}

/* The allocations that are to fail, each once. */
static GArray *choose(SporeSchema *schema, const char *file, Life *whole) {
  ways_begin();
  *whole = live(schema, file, 0);
  return ways_end(NULL);
}

static void test_scene(gconstpointer data) {
  const Scene *scene = data;
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  Life whole;
  guint refused = 0, as_ever = 0;
  g_autoptr(GArray) failing = choose(schema, scene->file, &whole);
  g_assert_true(whole.made);
  for (guint i = 0; i < failing->len; i++) {
    Life life = live(schema, scene->file, g_array_index(failing, guint64, i));
    refused += !life.made;
    as_ever += life.hash == whole.hash;
  }
  g_test_message("%u of %llu allocations failed: %u times refused, %u times the same end", failing->len,
                 (unsigned long long)whole.allocations, refused, as_ever);
  if (failing->len > 0) g_assert_cmpuint(refused, >, 0);
  spore_schema_free(schema);
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

/* The shipped scenes, the one with the fewest allocations first. */
static GPtrArray *list_scenes(void) {
  GPtrArray *scenes = g_ptr_array_new_with_free_func(free_scene);
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  g_autoptr(GDir) folder = g_dir_open(SPORE_SCENES, 0, NULL);
  g_assert_nonnull(folder);
  for (const char *name; (name = g_dir_read_name(folder));) {
    if (!g_str_has_suffix(name, ".spore")) continue;
    Scene *scene = g_new0(Scene, 1);
    scene->file = g_build_filename(SPORE_SCENES, name, NULL);
    scene->allocations = live(schema, scene->file, 0).allocations;
    g_ptr_array_add(scenes, scene);
  }
  g_ptr_array_sort(scenes, compare_scenes);
  spore_schema_free(schema);
  return scenes;
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_autoptr(GPtrArray) scenes = list_scenes();
  for (guint i = 0; i < scenes->len; i++) {
    const Scene *scene = scenes->pdata[i];
    g_autofree char *name = g_path_get_basename(scene->file), *path = g_strconcat("/memory/", name, NULL);
    g_test_add_data_func(path, scene, test_scene);
  }
  int status = g_test_run();
  ways_clear();
  return status;
}
