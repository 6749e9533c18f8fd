/* Loads a runtime file: its scene, the models, the world, the recorded devices and the exercise. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/runtime/runtime_private.h"
#include "core/runtime/trust.h"

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the runtime file"));
}

/* The model slot of a body at a level of detail. */
static SporeModel **slot(SporeBodyDescription *body, int level) {
  return level == SPORE_LOD_FINE ? &body->model : &body->lod.model[level];
}

static bool make_models(SporeRuntimeScene *scene, SporeBodyDescription *bodies, const SporeCancel *cancel,
                        SporeError *error) {
  for (size_t i = 0; i < scene->world.body_count; i++) {
    for (int level = 0; level < SPORE_LOD_COUNT; level++) {
      const SporeModelRecipe *recipe = &scene->recipes[SPORE_LOD_COUNT * i + (size_t)level];
      SporeGeometry geometry = recipe->geometry;
      geometry.cancel = cancel;
      if (!recipe->type) continue;
      *slot(&bodies[i], level) = spore_model_create(recipe->type, &geometry, recipe->fields, error);
      if (!*slot(&bodies[i], level)) return false;
    }
  }
  return true;
}

static void destroy_models(SporeBodyDescription *bodies, size_t count) {
  for (size_t i = 0; i < count; i++)
    for (int level = 0; level < SPORE_LOD_COUNT; level++) {
      SporeModel *model = *slot(&bodies[i], level);
      if (model) model->type->destroy(model);
    }
}

static bool make_world(SporeRuntime *runtime, SporePool *pool, const SporeCancel *cancel, SporeError *error) {
  SporeWorldDescription *world = &runtime->scene.world;
  SporeBodyDescription *bodies = (SporeBodyDescription *)world->bodies;
  world->cancel = cancel;
  if (make_models(&runtime->scene, bodies, cancel, error)) runtime->world = spore_world_create(world, pool, error);
  if (!runtime->world) destroy_models(bodies, world->body_count);
  return runtime->world != NULL;
}

/* The recorded input moves its bodies until the program sets devices of its own. */
static bool open_devices(SporeRuntime *runtime, SporeError *error) {
  const SporeTrack *track = &runtime->scene.track;
  runtime->devices = spore_arena_allocate(&runtime->arena, track->channel_count, sizeof(SporeDevice *));
  if (!runtime->devices) return no_memory(error);
  for (size_t i = 0; i < track->channel_count; i++) {
    runtime->devices[i] = spore_track_device_create(&track->channels[i]);
    if (!runtime->devices[i]) return no_memory(error);
    spore_world_set_device(runtime->world, spore_world_find_body(runtime->world, track->channels[i].name),
                           runtime->devices[i]);
  }
  return true;
}

static bool make_exercise(SporeRuntime *runtime, SporeError *error) {
  const SporeExerciseDescription *exercise = &runtime->scene.exercise;
  if (exercise->step_count + exercise->metric_count == 0) return true;
  runtime->exercise = spore_exercise_create(exercise, runtime->world, error);
  return runtime->exercise != NULL;
}

SporeRuntime *spore_runtime_parse(const char *place, const void *content, size_t size, SporeModelRegistry registry,
                                  SporePool *pool, const SporeCancel *cancel, SporeError *error) {
  SporeError fault = SPORE_ERROR_INIT;
  SporeRuntime *runtime = SPORE_NEW(SporeRuntime);
  bool done = runtime ? spore_runtime_read(runtime, content, size, registry, &fault) : no_memory(&fault);
  done = done && spore_runtime_trust(&runtime->scene, &fault) && make_world(runtime, pool, cancel, &fault) &&
         open_devices(runtime, &fault) && make_exercise(runtime, &fault);
  if (done) {
    runtime->maps =
        spore_arena_allocate(&runtime->arena, SPORE_LOD_COUNT * runtime->scene.visual_count, sizeof *runtime->maps);
    if (runtime->maps) return runtime;
    no_memory(&fault);
  }
  spore_runtime_free(runtime);
  spore_error_set(error, fault.code, place, "%s%s%s", fault.place, *fault.place ? ": " : "", fault.message);
  return NULL;
}

/* All bytes of the file, from spore_allocate. */
static void *read_all(const char *file, size_t *size, SporeError *error) {
  FILE *stream = fopen(file, "rb");
  uint8_t *bytes = stream ? SPORE_NEW_ARRAY(uint8_t, 1) : NULL;
  size_t capacity = 1, count = 0;
  bool done = bytes != NULL;
  while (done && !feof(stream)) {
    void *more = spore_room_for_one(bytes, count, &capacity, 65536, 1);
    done = more != NULL;
    if (!done) break;
    bytes = more;
    count += fread(bytes + count, 1, capacity - count, stream);
    if (ferror(stream)) break;
  }
  if (!stream || (done && ferror(stream)))
    spore_error_set(error, SPORE_ERROR_FILE, file, _("it cannot be read: %s; correct the name or the permissions"),
                    strerror(errno));
  else if (!done) no_memory(error);
  done = done && !ferror(stream);
  if (stream) fclose(stream);
  if (!done) {
    spore_free(bytes);
    return NULL;
  }
  *size = count;
  return bytes;
}

SporeRuntime *spore_runtime_load(const char *file, SporeModelRegistry registry, SporePool *pool,
                                 const SporeCancel *cancel, SporeError *error) {
  size_t size = 0;
  void *content = read_all(file, &size, error);
  if (!content) {
    spore_error_at(error, file);
    return NULL;
  }
  SporeRuntime *runtime = spore_runtime_parse(file, content, size, registry, pool, cancel, error);
  spore_free(content);
  return runtime;
}

void spore_runtime_free(SporeRuntime *runtime) {
  if (!runtime) return;
  spore_exercise_free(runtime->exercise);
  spore_world_free(runtime->world);
  for (size_t i = 0; runtime->devices && i < runtime->scene.track.channel_count; i++)
    if (runtime->devices[i]) runtime->devices[i]->type->close(runtime->devices[i]);
  for (size_t i = 0; runtime->maps && i < SPORE_LOD_COUNT * runtime->scene.visual_count; i++)
    spore_mapping_clear(&runtime->maps[i].mapping);
  spore_arena_clear(&runtime->arena);
  spore_free(runtime);
}

SporeWorld *spore_runtime_world(SporeRuntime *runtime) { return runtime->world; }

SporeExercise *spore_runtime_exercise(SporeRuntime *runtime) { return runtime->exercise; }

size_t spore_runtime_visual_count(const SporeRuntime *runtime) { return runtime->scene.visual_count; }
