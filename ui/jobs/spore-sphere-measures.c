/* Measures sets of spheres on a worker, each once, and keeps the figures. */
#include "ui/jobs/spore-sphere-measures.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/edits.h"
#include "ui/jobs/spore-job.h"

struct _SporeSphereMeasures {
  GObject parent;
  GHashTable *reports; /* char * -> SporeSpheresReport * */
  char *key;           /* now being measured, or NULL */
};

G_DEFINE_FINAL_TYPE(SporeSphereMeasures, spore_sphere_measures, G_TYPE_OBJECT)

static guint measured_signal;

static void measured(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeSphereMeasures *self = owner;
  SporeGenerateWork *work = data;
  char *key = g_steal_pointer(&self->key);
  /* What cannot be measured is kept too (all zero), so that it is not tried again and again. */
  g_hash_table_replace(self->reports, key, g_memdup2(&work->spheres_report, sizeof work->spheres_report));
  g_signal_emit(self, measured_signal, 0);
}

static gboolean copy(const SporeSphereSet *set, SporeSphereSet *to) {
  if (!spore_sphere_set_allocate(to, set->count, NULL)) return FALSE;
  memcpy(to->spheres, set->spheres, set->count * 4 * sizeof(double));
  if (!set->weights) return TRUE;
  if (!spore_sphere_set_add_weights(to, NULL)) return FALSE;
  memcpy(to->weights, set->weights, set->count * sizeof(double));
  to->level = set->level;
  return TRUE;
}

/* Takes the key. */
static gboolean start(SporeSphereMeasures *self, SporeDocument *document, SporeObject *body, const SporeSphereSet *set,
                      char *key) {
  SporeGenerateOptions options = {.kind = SPORE_GENERATE_SPHERES};
  SporeGenerateWork *work = spore_generate_work_new(document, body, &options, NULL);
  if (!work || !copy(set, &work->spheres)) {
    g_clear_pointer(&work, spore_generate_work_unref);
    g_free(key);
    return FALSE;
  }
  self->key = key;
  g_object_unref(spore_job_start(_("Measuring spheres"), spore_measure_work_run, work, spore_generate_work_unref,
                                 measured, G_OBJECT(self)));
  return TRUE;
}

const SporeSpheresReport *spore_sphere_measures_get(SporeSphereMeasures *self, SporeDocument *document,
                                                    SporeObject *body, SporeObject *asset) {
  static const SporeSpheresReport none;
  SporeObject *mesh = spore_edit_visual_mesh(document, body, NULL);
  const SporeSphereSet *set = spore_document_spheres(document, asset, NULL);
  if (!mesh || !set) return &none;
  g_autofree char *mesh_hash = spore_document_asset_hash(document, mesh);
  g_autofree char *set_hash = spore_document_asset_hash(document, asset);
  g_autofree char *key = g_strconcat(mesh_hash ? mesh_hash : "", set_hash, NULL);
  const SporeSpheresReport *report = g_hash_table_lookup(self->reports, key);
  if (report || self->key) return report;
  return start(self, document, body, set, g_steal_pointer(&key)) ? NULL : &none;
}

static void spore_sphere_measures_finalize(GObject *object) {
  SporeSphereMeasures *self = SPORE_SPHERE_MEASURES(object);
  g_hash_table_unref(self->reports);
  g_free(self->key);
  G_OBJECT_CLASS(spore_sphere_measures_parent_class)->finalize(object);
}

static void spore_sphere_measures_class_init(SporeSphereMeasuresClass *class) {
  G_OBJECT_CLASS(class)->finalize = spore_sphere_measures_finalize;
  measured_signal =
      g_signal_new("measured", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
}

static void spore_sphere_measures_init(SporeSphereMeasures *self) {
  self->reports = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
}

SporeSphereMeasures *spore_sphere_measures_new(void) { return g_object_new(SPORE_TYPE_SPHERE_MEASURES, NULL); }
