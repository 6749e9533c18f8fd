/* Worlds of a document with factors on the time step, stiffness, mass and contacts. */
#include "core/author/stability_scene.h"

#include <math.h>
#include <string.h>

#include "core/scene/scaling.h"

struct SporeVariedScene {
  SporeDocument *document;
  SporePool *pool;
  const SporeTrack *input;
  const SporeCancel *cancel;
  GPtrArray *made; /* of Made *: worlds that are not dropped yet */
};

/* A world, and the copy of the document that it was made of. */
typedef struct Made {
  SporeDocument *document;
  SporeSimulation *simulation;
} Made;

static void free_made(gpointer data) {
  Made *made = data;
  g_clear_pointer(&made->simulation, spore_simulation_free);
  spore_document_free(made->document);
  g_free(made);
}

SporeVariedScene *spore_varied_scene_new(SporeDocument *document, SporePool *pool, const SporeTrack *input,
                                         const SporeCancel *cancel) {
  SporeVariedScene *varied = g_new(SporeVariedScene, 1);
  *varied = (SporeVariedScene){document, pool, input, cancel, g_ptr_array_new_with_free_func(free_made)};
  return varied;
}

void spore_varied_scene_free(SporeVariedScene *varied) {
  g_ptr_array_unref(varied->made);
  g_free(varied);
}

static gboolean is_passive(const SporeObject *body) {
  return spore_object_child_of(body, "mechanical") && spore_object_number(body, "role") == SPORE_PASSIVE;
}

static void scale_bodies(SporeDocument *document, const SporeStabilityChange *change) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  guint passive = 0;
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    if (change->contact != 1) spore_object_scale(document, body, SPORE_SCALED_CONTACT, change->contact);
    if (!is_passive(body)) continue;
    gboolean spared = change->every_second && passive++ % 2 == 0;
    if (spared) continue;
    if (change->stiffness != 1) spore_object_scale(document, body, SPORE_SCALED_STIFFNESS, change->stiffness);
    if (change->mass != 1) spore_object_scale(document, body, SPORE_SCALED_MASS, change->mass);
  }
}

static gboolean scale_step(SporeDocument *document, double factor, GError **error) {
  SporeObject *solver = spore_document_section(document, "solver");
  const SporeParameterTable *table = spore_object_type(solver)->table;
  int property = spore_parameter_find(table, "time_step");
  const SporeParameter *parameter = &table->parameters[property];
  double step_s = factor * spore_object_number(solver, "time_step");
  SporeValue value = {.type = SPORE_REAL, .number = {fmin(fmax(step_s, parameter->minimum), parameter->maximum)}};
  return factor == 1 || spore_document_set(document, solver, (guint)property, &value, error);
}

/* A GError, as the kernel's errors are. */
static void hand_over(GError *error, SporeError *into) {
  spore_error_set(into, error->domain == SPORE_ERROR ? (SporeErrorCode)error->code : SPORE_ERROR_INTERNAL, NULL, "%s",
                  error->message);
  g_error_free(error);
}

static SporeWorld *make(void *data, const SporeStabilityChange *change, SporeError *fault) {
  SporeVariedScene *varied = data;
  GError *error = NULL;
  Made *made = g_new0(Made, 1);
  made->document = spore_document_copy(varied->document);
  scale_bodies(made->document, change);
  if (scale_step(made->document, change->time_step, &error))
    made->simulation = spore_simulation_new(made->document, varied->pool, varied->input, varied->cancel, &error);
  if (!made->simulation) {
    hand_over(error, fault);
    free_made(made);
    return NULL;
  }
  g_ptr_array_add(varied->made, made);
  return made->simulation->world;
}

static Made *made_of(const SporeVariedScene *varied, const SporeWorld *world) {
  for (guint i = 0; i < varied->made->len; i++) {
    Made *made = g_ptr_array_index(varied->made, i);
    if (made->simulation->world == world) return made;
  }
  return NULL;
}

static void drop(void *data, SporeWorld *world) {
  SporeVariedScene *varied = data;
  Made *made = made_of(varied, world);
  if (made) g_ptr_array_remove(varied->made, made);
}

static bool jump_of_body(Made *made, SporeObject *body, SporeScaled what, double factor) {
  int property = spore_object_scale(made->document, body, what, factor);
  return property >= 0 && spore_simulation_apply(made->simulation, made->document, spore_object_scaled_unit(body, what),
                                                 (guint)property);
}

static bool jump(void *data, SporeWorld *world, double stiffness, double contact) {
  Made *made = made_of(data, world);
  SporeObject *bodies = spore_document_section(made->document, "bodies");
  bool any = false;
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    if (stiffness != 1 && is_passive(body)) any |= jump_of_body(made, body, SPORE_SCALED_STIFFNESS, stiffness);
    if (contact != 1) any |= jump_of_body(made, body, SPORE_SCALED_CONTACT, contact);
  }
  return any;
}

SporeStabilityScene spore_varied_scene_worlds(SporeVariedScene *varied) {
  return (SporeStabilityScene){.data = varied,
                               .time_step_s =
                                   spore_object_number(spore_document_section(varied->document, "solver"), "time_step"),
                               .make = make,
                               .drop = drop,
                               .jump = jump};
}
