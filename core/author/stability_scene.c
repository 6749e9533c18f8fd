/* Worlds of a document for a stability study, by variations of it. */
#include "core/author/stability_scene.h"

#include "core/scene/variation.h"

struct SporeVariedScene {
  SporeDocument *document;
  SporePool *pool;
  const SporeTrack *input;
  const SporeCancel *cancel;
  double time_step_s;
  GPtrArray *made; /* of SporeSimulation *: worlds that are not dropped yet */
};

static void free_simulation(gpointer simulation) { spore_simulation_free(simulation); }

SporeVariedScene *spore_varied_scene_new(SporeDocument *document, SporePool *pool, const SporeTrack *input,
                                         const SporeCancel *cancel) {
  SporeVariedScene *varied = g_new(SporeVariedScene, 1);
  double time_step_s = spore_object_number(spore_document_section(document, "solver"), "time_step");
  *varied =
      (SporeVariedScene){document, pool, input, cancel, time_step_s, g_ptr_array_new_with_free_func(free_simulation)};
  return varied;
}

void spore_varied_scene_free(SporeVariedScene *varied) {
  g_ptr_array_unref(varied->made);
  g_free(varied);
}

static SporeWorld *make(void *data, const SporeStabilityChange *change, SporeError *fault) {
  SporeVariedScene *varied = data;
  GError *error = NULL;
  const SporeVariation variation = {.dt_s = change->time_step == 1 ? 0 : change->time_step * varied->time_step_s,
                                    .stiffness = change->stiffness,
                                    .mass = change->mass,
                                    .contact = change->contact,
                                    .every_second = change->every_second};
  SporeSimulation *simulation =
      spore_variation_make(varied->document, &variation, varied->pool, varied->input, varied->cancel, &error);
  if (!simulation) {
    /* The place is in the message already. */
    spore_error_set(fault, error->domain == SPORE_ERROR ? (SporeErrorCode)error->code : SPORE_ERROR_INTERNAL, NULL,
                    "%s", error->message);
    g_error_free(error);
    return NULL;
  }
  g_ptr_array_add(varied->made, simulation);
  return simulation->world;
}

static SporeSimulation *simulation_of(const SporeVariedScene *varied, const SporeWorld *world) {
  for (guint i = 0; i < varied->made->len; i++) {
    SporeSimulation *simulation = g_ptr_array_index(varied->made, i);
    if (simulation->world == world) return simulation;
  }
  g_assert_not_reached();
}

static void drop(void *data, SporeWorld *world) {
  SporeVariedScene *varied = data;
  g_ptr_array_remove(varied->made, simulation_of(varied, world));
}

static bool jump(void *data, SporeWorld *world, double stiffness, double contact) {
  SporeVariedScene *varied = data;
  const SporeVariation variation = {.stiffness = stiffness == 1 ? 0 : stiffness, .contact = contact == 1 ? 0 : contact};
  return spore_variation_apply(varied->document, &variation, simulation_of(varied, world));
}

SporeStabilityScene spore_varied_scene_worlds(SporeVariedScene *varied) {
  return (SporeStabilityScene){varied, varied->time_step_s, make, drop, jump};
}
