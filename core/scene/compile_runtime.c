/* Compiles a document into a runtime file: the descriptions that its world is made from. */
#include "core/scene/compile_runtime.h"

#include <glib/gi18n.h>

#include "core/scene/compile_private.h"

static gboolean add_visuals(SporeCompiler *compiler, GArray *visuals, GPtrArray *undrawn) {
  for (guint i = 0; i < compiler->objects->len; i++) {
    const SporeObject *body = g_ptr_array_index(compiler->objects, i);
    SporeRuntimeVisual visual = {.body = i};
    if (!spore_compiler_visual(compiler, body, &visual.mesh)) return FALSE;
    if (visual.mesh) g_array_append_val(visuals, visual);
    else g_ptr_array_add(undrawn, g_strdup(spore_object_name(body)));
  }
  return TRUE;
}

/* Making the world and the exercise refuses what could not run. The descriptions stay as they are. */
static gboolean can_run(SporeCompiler *compiler, const SporeExerciseDescription *description) {
  SporeExercise *exercise = NULL;
  SporeWorld *world = spore_compiler_create(compiler, NULL);
  if (!world) spore_compiler_destroy_models(compiler);
  gboolean can = world && spore_compiler_create_exercise(compiler, description, world, &exercise);
  spore_exercise_free(exercise);
  spore_world_free(world);
  return can;
}

static gpointer format(SporeCompiler *compiler, const SporeTrack *input, GPtrArray *undrawn, gsize *size) {
  g_autoptr(GArray) visuals = g_array_new(FALSE, TRUE, sizeof(SporeRuntimeVisual));
  SporeTrack track = {0};
  SporeExerciseDescription exercise = {.step_count = 0};
  gboolean described = spore_compiler_describe(compiler) && add_visuals(compiler, visuals, undrawn) &&
                       spore_compiler_merge_input(compiler, &track, input) &&
                       spore_compiler_describe_exercise(compiler, &exercise);
  if (!described) spore_compiler_destroy_models(compiler);
  gboolean done = described && can_run(compiler, &exercise);
  const SporeRuntimeScene scene = {.world = spore_compiler_world(compiler),
                                   .recipes = (const SporeModelRecipe *)(void *)compiler->recipes->data,
                                   .visual_count = visuals->len,
                                   .visuals = (const SporeRuntimeVisual *)(void *)visuals->data,
                                   .track = track,
                                   .exercise = exercise};
  gpointer content = done ? spore_runtime_format(&scene, size) : NULL;
  if (done && !content)
    spore_error_raise(compiler->error, SPORE_ERROR_MEMORY, NULL, "%s",
                      _("not enough memory for the runtime file; close something or make the scene smaller"));
  spore_track_clear(&track);
  return content;
}

gpointer spore_document_format_runtime(SporeDocument *document, const SporeTrack *input, const SporeCancel *cancel,
                                       GPtrArray *undrawn, gsize *size, GError **error) {
  SporeCompiler compiler = {.document = document, .cancel = cancel, .error = error};
  spore_compiler_init(&compiler);
  gpointer content = format(&compiler, input, undrawn, size);
  spore_compiler_clear(&compiler);
  return content;
}
