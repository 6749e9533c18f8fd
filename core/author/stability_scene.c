/* Worlds of a document for a stability study, by variations of it. */
#include "core/author/stability_scene.h"

#include "core/author/varied_worlds.h"

struct SporeVariedScene {
  SporeVariedWorlds worlds;
  const SporeTrack *input;
  double time_step_s;
};

SporeVariedScene *spore_varied_scene_new(SporeDocument *document, SporePool *pool, const SporeTrack *input,
                                         const SporeCancel *cancel) {
  SporeVariedScene *varied = g_new(SporeVariedScene, 1);
  spore_varied_worlds_init(&varied->worlds, document, pool, cancel);
  varied->input = input;
  varied->time_step_s = spore_object_number(spore_document_section(document, "solver"), "time_step");
  return varied;
}

void spore_varied_scene_free(SporeVariedScene *varied) {
  spore_varied_worlds_clear(&varied->worlds);
  g_free(varied);
}

static SporeWorld *make(void *data, const SporeStabilityChange *change, SporeError *fault) {
  SporeVariedScene *varied = data;
  const SporeVariation variation = {.dt_s = change->time_step == 1 ? 0 : change->time_step * varied->time_step_s,
                                    .stiffness = change->stiffness,
                                    .mass = change->mass,
                                    .contact = change->contact,
                                    .every_second = change->every_second};
  return spore_varied_worlds_make(&varied->worlds, &variation, varied->input, fault);
}

static void drop(void *data, SporeWorld *world) {
  SporeVariedScene *varied = data;
  spore_varied_worlds_drop(&varied->worlds, world);
}

static bool jump(void *data, SporeWorld *world, double stiffness, double contact) {
  SporeVariedScene *varied = data;
  const SporeVariation variation = {.stiffness = stiffness == 1 ? 0 : stiffness, .contact = contact == 1 ? 0 : contact};
  return spore_variation_apply(varied->worlds.document, &variation,
                               spore_varied_worlds_simulation(&varied->worlds, world));
}

SporeStabilityScene spore_varied_scene_worlds(SporeVariedScene *varied) {
  return (SporeStabilityScene){varied, varied->time_step_s, make, drop, jump};
}
