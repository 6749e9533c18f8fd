/* Makes the worlds of an accuracy study: variations of a document, with the input from some time on. */
#include "core/author/accuracy_source.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/author/sphere_sets.h"
#include "core/author/varied_worlds.h"

#define EARLY_S 1e-9 /* what is shifted comes so much earlier, or rounding would make some of it a step late */

/* The document with another number of spheres. */
typedef struct SphereVariant {
  double factor;
  SporeDocument *document;
} SphereVariant;

struct SporeAccuracySource {
  SporeDocument *document;
  GArray *spheres; /* SphereVariant */
  SporeVariedWorlds worlds;
  const SporeSimulation *simulation; /* of the document as it is */
  const SporeTrack *input;
  const char *body;
  const char *const *kept; /* bodies that keep their level */
  SporeTrack shifted;      /* the input from start_s on; empty: from time 0 */
  double start_s;
};

/* Appends what the channel says from start_s on, as if that were time 0. */
static gboolean shift_channel(SporeTrackChannel *to, const SporeTrackChannel *from, double start_s) {
  SporeDevice *device = spore_track_device_create(from);
  SporeDeviceState first;
  const SporeDeviceCommand nothing = {0};
  gboolean good =
      device && device->type->exchange(device, start_s, &nothing, &first) && spore_track_append(to, 0, &first);
  for (gsize i = 0; good && i < from->count; i++)
    if (from->time_s[i] > start_s)
      good = spore_track_append(to, fmax(from->time_s[i] - start_s - EARLY_S, 0), &from->states[i]);
  if (device) device->type->close(device);
  return good;
}

/* Makes the input begin at start_s. */
static gboolean shift(SporeAccuracySource *source, double start_s, SporeError *error) {
  const SporeTrack *track = source->simulation->track;
  if (source->start_s == start_s || !track) return TRUE;
  spore_track_clear(&source->shifted);
  source->start_s = start_s;
  for (gsize i = 0; start_s > 0 && i < track->channel_count; i++) {
    SporeTrackChannel *channel = spore_track_add_channel(&source->shifted, track->channels[i].name);
    if (!channel || !shift_channel(channel, &track->channels[i], start_s))
      return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the recorded input"));
  }
  return TRUE;
}

/* The name of a choice; NULL: the scene's. */
static const char *name_of(const char *const *names, int choice) { return choice < 0 ? NULL : names[choice]; }

static SporeDocument *document_with(const SporeAccuracySource *source, double factor) {
  for (guint i = 0; i < source->spheres->len; i++) {
    const SphereVariant *variant = &g_array_index(source->spheres, SphereVariant, i);
    if (variant->factor == factor) return variant->document;
  }
  return source->document;
}

static SporeWorld *make(void *data, const SporeAccuracyWorld *world, SporeError *error) {
  SporeAccuracySource *source = data;
  const SporeAccuracyMethod *method = world->method;
  SporeVariation variation = world->choice ? *(const SporeVariation *)world->choice : (SporeVariation){0};
  variation.body = source->body;
  variation.kept = source->kept;
  if (method) {
    variation.integrator = name_of(spore_integrator_names, method->integrator);
    variation.nonlinear = name_of(spore_nonlinear_names, method->nonlinear);
    variation.linear = name_of(spore_linear_names, method->linear);
  }
  if (world->level >= 0) variation.level = spore_lod_names[world->level];
  if (world->dt_s > 0) variation.dt_s = world->dt_s;
  variation.tolerance = world->tolerance;
  variation.awake = world->awake;
  if (!shift(source, world->start_s, error)) return NULL;
  const SporeTrack *input = source->shifted.channel_count ? &source->shifted : source->input;
  source->worlds.document = document_with(source, world->spheres);
  return spore_varied_worlds_make(&source->worlds, &variation, input, error);
}

static void drop(void *data, SporeWorld *world) {
  SporeAccuracySource *source = data;
  spore_varied_worlds_drop(&source->worlds, world);
}

/* The method of the bodies, or where they differ that of the solver. */
static SporeIntegratorKind own_integrator(const SporeAccuracySource *source) {
  const SporeWorld *world = source->simulation->world;
  const char *name = NULL;
  gboolean mixed = FALSE;
  for (guint32 body = 0; body < spore_world_body_count(world); body++) {
    SporeMethod method;
    if (!spore_world_body_method(world, body, &method)) continue;
    if (source->body && !g_str_equal(source->body, spore_world_body_name(world, body))) continue;
    mixed |= name && !g_str_equal(name, method.integrator.name);
    name = method.integrator.name;
  }
  if (mixed || !name)
    return (SporeIntegratorKind)spore_object_number(spore_document_section(source->document, "solver"), "integrator");
  int kind = 0;
  while (!g_str_equal(spore_integrator_names[kind], name)) kind++;
  return (SporeIntegratorKind)kind;
}

SporeAccuracySource *spore_accuracy_source_new(SporeDocument *document, const SporeSimulation *simulation,
                                               SporePool *pool, const SporeTrack *input, const SporeCancel *cancel,
                                               const char *body) {
  SporeAccuracySource *source = g_new0(SporeAccuracySource, 1);
  spore_varied_worlds_init(&source->worlds, document, pool, cancel);
  source->document = document;
  source->spheres = g_array_new(FALSE, FALSE, sizeof(SphereVariant));
  source->simulation = simulation;
  source->input = input;
  source->body = body;
  return source;
}

void spore_accuracy_source_free(SporeAccuracySource *source) {
  spore_varied_worlds_clear(&source->worlds);
  spore_track_clear(&source->shifted);
  for (guint i = 0; i < source->spheres->len; i++)
    spore_document_free(g_array_index(source->spheres, SphereVariant, i).document);
  g_array_unref(source->spheres);
  g_free(source);
}

gboolean spore_accuracy_source_vary_spheres(SporeAccuracySource *source, const double *factors, gsize count,
                                            const SporeProgress *progress, GError **error) {
  for (gsize i = 0; i < count; i++) {
    SphereVariant variant = {factors[i], NULL};
    variant.document = spore_sphere_sets_vary(source->document, source->body, factors[i], progress, error);
    if (!variant.document) return FALSE;
    g_array_append_val(source->spheres, variant);
  }
  return TRUE;
}

void spore_accuracy_source_keep(SporeAccuracySource *source, const char *const *bodies) { source->kept = bodies; }

SporeAccuracyScene spore_accuracy_source_scene(SporeAccuracySource *source) {
  SporeDocument *document = source->document;
  return (SporeAccuracyScene){.data = source,
                              .make = make,
                              .drop = drop,
                              .starts_late = true,
                              .own = {own_integrator(source), -1, -1},
                              .dt_s = spore_object_number(spore_document_section(document, "solver"), "time_step")};
}
