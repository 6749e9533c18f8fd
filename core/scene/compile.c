/* Compiles a document into a simulation: describes its bodies, links, tools and effects to a world, and opens its
 * devices. */
#include "core/scene/compile_private.h"

#include <glib/gi18n.h>
#include <string.h>

static void free_spheres(gpointer data) {
  spore_sphere_set_clear(data);
  g_free(data);
}

static gboolean go_on(SporeCompiler *compiler) {
  if (!spore_cancel_asked(compiler->cancel)) return TRUE;
  return spore_error_raise(compiler->error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
}

gboolean spore_compiler_describe(SporeCompiler *compiler) {
  SporeObject *bodies = spore_document_section(compiler->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    if (!spore_compiler_add_body(compiler, spore_object_child(bodies, i)) || !go_on(compiler)) return FALSE;
  SporeObject *links = spore_document_section(compiler->document, "links");
  for (guint i = 0; i < spore_object_child_count(links); i++)
    if (!spore_compiler_add_link(compiler, spore_object_child(links, i))) return FALSE;
  SporeObject *tools = spore_document_section(compiler->document, "tools");
  for (guint i = 0; i < spore_object_child_count(tools); i++)
    if (!spore_compiler_add_tool(compiler, spore_object_child(tools, i))) return FALSE;
  SporeObject *effects = spore_document_section(compiler->document, "effects");
  for (guint i = 0; i < spore_object_child_count(effects); i++)
    if (!spore_compiler_add_emitter(compiler, spore_object_child(effects, i))) return FALSE;
  return TRUE;
}

void spore_compiler_destroy_models(const SporeCompiler *compiler) {
  for (guint i = 0; i < compiler->bodies->len; i++) {
    const SporeBodyDescription *body = &g_array_index(compiler->bodies, SporeBodyDescription, i);
    SporeModel *const models[] = {body->model, body->lod.model[SPORE_LOD_COARSE], body->lod.model[SPORE_LOD_MEDIUM]};
    for (gsize k = 0; k < G_N_ELEMENTS(models); k++)
      if (models[k]) models[k]->type->destroy(models[k]);
  }
}

SporeWorldDescription spore_compiler_world(const SporeCompiler *compiler) {
  SporeEnvironmentFields environment;
  SporeWorldDescription description = {.cancel = compiler->cancel,
                                       .unpruned = compiler->unpruned,
                                       .body_count = compiler->bodies->len,
                                       .link_count = compiler->links->len,
                                       .tool_count = compiler->tools->len,
                                       .emitter_count = compiler->emitters->len,
                                       .eye_count = compiler->eyes->len,
                                       .eyes = (const SporeEyeDescription *)(void *)compiler->eyes->data,
                                       .emitters = (const SporeEmitterDescription *)(void *)compiler->emitters->data,
                                       .bodies = (const SporeBodyDescription *)(void *)compiler->bodies->data,
                                       .links = (const SporeLinkDescription *)(void *)compiler->links->data,
                                       .tools = (const SporeToolDescription *)(void *)compiler->tools->data};
  spore_object_fields(spore_document_section(compiler->document, "environment"), &environment);
  spore_object_fields(spore_document_section(compiler->document, "solver"), &description.solver);
  description.gravity = spore_vec3_load(environment.gravity);
  return description;
}

SporeWorld *spore_compiler_create(SporeCompiler *compiler, SporePool *pool) {
  const SporeWorldDescription description = spore_compiler_world(compiler);
  SporeError fault = SPORE_ERROR_INIT;
  SporeWorld *world = spore_world_create(&description, pool, &fault);
  if (!world) spore_compiler_say_in_scene(compiler, &fault);
  return world;
}

static void close_device(gpointer data) {
  SporeDevice *device = data;
  device->type->close(device);
}

static SporeSimulation *assemble(SporeCompiler *compiler, SporePool *pool, const SporeTrack *input) {
  SporeSimulation *simulation = g_new0(SporeSimulation, 1);
  simulation->devices = g_ptr_array_new_with_free_func(close_device);
  simulation->track = g_new0(SporeTrack, 1);
  gboolean done = spore_compiler_describe(compiler) && spore_compiler_merge_input(compiler, simulation->track, input);
  if (done) simulation->world = spore_compiler_create(compiler, pool);
  if (!simulation->world) spore_compiler_destroy_models(compiler);
  simulation->body_object = g_new0(guint32, MAX(compiler->objects->len, 1));
  for (guint i = 0; i < compiler->objects->len; i++)
    simulation->body_object[i] = spore_object_id(g_ptr_array_index(compiler->objects, i));
  SporeExerciseDescription exercise;
  if (simulation->world && spore_compiler_open_devices(compiler, simulation) &&
      spore_compiler_describe_exercise(compiler, &exercise) &&
      spore_compiler_create_exercise(compiler, &exercise, simulation->world, &simulation->exercise))
    return simulation;
  spore_simulation_free(simulation);
  return NULL;
}

void spore_compiler_init(SporeCompiler *compiler) {
  compiler->objects = g_ptr_array_new();
  compiler->bodies = g_array_new(FALSE, TRUE, sizeof(SporeBodyDescription));
  compiler->links = g_array_new(FALSE, TRUE, sizeof(SporeLinkDescription));
  compiler->tools = g_array_new(FALSE, TRUE, sizeof(SporeToolDescription));
  compiler->emitters = g_array_new(FALSE, TRUE, sizeof(SporeEmitterDescription));
  compiler->eyes = g_array_new(FALSE, TRUE, sizeof(SporeEyeDescription));
  compiler->recipes = g_array_new(FALSE, TRUE, sizeof(SporeModelRecipe));
  compiler->spheres = g_ptr_array_new_with_free_func(free_spheres);
  compiler->kept = g_ptr_array_new_with_free_func(g_free);
}

void spore_compiler_clear(SporeCompiler *compiler) {
  g_ptr_array_unref(compiler->objects);
  g_array_unref(compiler->bodies);
  g_array_unref(compiler->links);
  g_array_unref(compiler->tools);
  g_array_unref(compiler->emitters);
  g_array_unref(compiler->eyes);
  g_array_unref(compiler->recipes);
  g_ptr_array_unref(compiler->spheres);
  g_ptr_array_unref(compiler->kept);
}

static SporeSimulation *compile(SporeDocument *document, SporePool *pool, const SporeTrack *input, gboolean unpruned,
                                const SporeCancel *cancel, GError **error) {
  SporeCompiler compiler = {.document = document, .unpruned = unpruned, .cancel = cancel, .error = error};
  spore_compiler_init(&compiler);
  SporeSimulation *simulation = assemble(&compiler, pool, input);
  spore_compiler_clear(&compiler);
  return simulation;
}

SporeSimulation *spore_simulation_new(SporeDocument *document, SporePool *pool, const SporeTrack *input,
                                      const SporeCancel *cancel, GError **error) {
  return compile(document, pool, input, FALSE, cancel, error);
}

SporeSimulation *spore_simulation_new_unpruned(SporeDocument *document, SporePool *pool, const SporeTrack *input,
                                               const SporeCancel *cancel, GError **error) {
  return compile(document, pool, input, TRUE, cancel, error);
}

void spore_input_free(SporeTrack *input) {
  if (input) spore_track_clear(input);
  g_free(input);
}

void spore_simulation_free(SporeSimulation *simulation) {
  if (!simulation) return;
  spore_exercise_free(simulation->exercise);
  if (simulation->world) spore_world_free(simulation->world);
  g_ptr_array_unref(simulation->devices); /* the world borrows the devices, and the devices borrow the track */
  spore_input_free(simulation->track);
  g_free(simulation->body_object);
  g_free(simulation);
}

guint32 spore_simulation_body_of(const SporeSimulation *simulation, SporeObject *object) {
  while (object && strcmp(spore_object_type(object)->element, "body") != 0) object = spore_object_parent(object);
  if (!object) return SPORE_NO_BODY;
  size_t count = spore_world_body_count(simulation->world);
  for (guint32 i = 0; i < count; i++)
    if (simulation->body_object[i] == spore_object_id(object)) return i;
  return SPORE_NO_BODY;
}
