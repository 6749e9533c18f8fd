/* Makes and keeps the worlds of a study. */
#include "core/author/varied_worlds.h"

static void free_simulation(gpointer simulation) { spore_simulation_free(simulation); }

void spore_varied_worlds_init(SporeVariedWorlds *worlds, SporeDocument *document, SporePool *pool,
                              const SporeCancel *cancel) {
  *worlds = (SporeVariedWorlds){document, pool, cancel, g_ptr_array_new_with_free_func(free_simulation)};
}

void spore_varied_worlds_clear(SporeVariedWorlds *worlds) { g_clear_pointer(&worlds->made, g_ptr_array_unref); }

SporeWorld *spore_varied_worlds_make(SporeVariedWorlds *worlds, const SporeVariation *variation,
                                     const SporeTrack *input, SporeError *fault) {
  g_autoptr(GError) error = NULL;
  SporeSimulation *simulation =
      spore_variation_make(worlds->document, variation, worlds->pool, input, worlds->cancel, &error);
  if (!simulation) {
    /* The place is in the message already. */
    spore_error_set(fault, error->domain == SPORE_ERROR ? (SporeErrorCode)error->code : SPORE_ERROR_INTERNAL, NULL,
                    "%s", error->message);
    return NULL;
  }
  g_ptr_array_add(worlds->made, simulation);
  return simulation->world;
}

SporeSimulation *spore_varied_worlds_simulation(const SporeVariedWorlds *worlds, const SporeWorld *world) {
  for (guint i = 0; i < worlds->made->len; i++) {
    SporeSimulation *simulation = g_ptr_array_index(worlds->made, i);
    if (simulation->world == world) return simulation;
  }
  g_assert_not_reached();
}

void spore_varied_worlds_drop(SporeVariedWorlds *worlds, SporeWorld *world) {
  g_ptr_array_remove_fast(worlds->made, spore_varied_worlds_simulation(worlds, world));
}
