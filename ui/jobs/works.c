#include "ui/jobs/works.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/io/scene_xml.h"
#include "ui/document/asset-readers.h"
#include "core/author/edits.h"
#include "ui/jobs/generate-types.h"

/* Open. */

SporeOpenWork *spore_open_work_new(const SporeSchema *schema, const char *file) {
  SporeOpenWork *work = g_new0(SporeOpenWork, 1);
  work->schema = schema;
  work->file = g_strdup(file);
  return work;
}

void spore_open_work_free(gpointer data) {
  SporeOpenWork *work = data;
  g_free(work->file);
  g_free(work->original);
  if (work->document) spore_document_free(work->document);
  g_free(work);
}

/* Decoded here, so that the GTK thread finds them in the document. What cannot be read is said by the checks. */
static void decode_asset(SporeDocument *document, SporeObject *asset) {
  const char *element = spore_object_type(asset)->element;
  if (g_str_equal(element, "mesh")) spore_document_mesh(document, asset, NULL);
  if (g_str_equal(element, "spheres")) spore_document_spheres(document, asset, NULL);
  if (g_str_equal(element, "tetrahedra")) spore_document_tetrahedra(document, asset, NULL);
}

gboolean spore_open_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeOpenWork *work = data;
  work->document = spore_scene_load(work->schema, work->file, error);
  if (!work->document) return FALSE;
  spore_document_set_readers(work->document, &spore_editor_readers);
  SporeObject *assets = spore_document_section(work->document, "assets");
  guint count = spore_object_child_count(assets);
  for (guint i = 0; i < count; i++) {
    if (!spore_progress(progress, (double)i / count, _("Reading assets")))
      return spore_error_raise(error, SPORE_ERROR_CANCELLED, work->file, "%s", _("cancelled"));
    decode_asset(work->document, spore_object_child(assets, i));
  }
  return TRUE;
}

/* Generate. */

SporeObject *spore_generate_source(SporeDocument *document, SporeObject *body, SporeGenerateKind kind, GError **error) {
  return spore_edit_generator_source(document, body, spore_generate_target(document, body, kind), error);
}

static SporeGenerateWork *new_of_labels(const SporeGenerateOptions *options) {
  SporeGenerateWork *work = g_atomic_rc_box_new0(SporeGenerateWork);
  work->options = *options;
  work->source = g_strdup(spore_label_source_file(options->labels));
  spore_label_source_ref(options->labels);
  return work;
}

static gboolean same_regions(const SporeGenerateWork *work, const SporeObject *asset) {
  SporeGenerateRegion regions[SPORE_GENERATE_REGIONS];
  gsize count;
  return spore_edit_generator_regions(asset, regions, &count, NULL) && count == work->region_count &&
         memcmp(regions, work->regions, count * sizeof *regions) == 0;
}

SporeGenerateWork *spore_generate_work_new(SporeDocument *document, SporeObject *body,
                                           const SporeGenerateOptions *options, GError **error) {
  if (options->kind == SPORE_GENERATE_LABELS) return new_of_labels(options);
  SporeObject *asset = spore_generate_source(document, body, options->kind, error);
  const SporeTriangleMesh *mesh = asset ? spore_document_mesh(document, asset, error) : NULL;
  if (!mesh) return NULL;
  SporeGenerateWork *work = g_atomic_rc_box_new0(SporeGenerateWork);
  SporeError failure = SPORE_ERROR_INIT;
  work->options = *options;
  work->body = spore_object_id(body);
  work->source = g_strdup(spore_object_name(asset));
  work->source_hash = spore_document_asset_hash(document, asset);
  SporeObject *target = spore_generate_target(document, body, options->kind);
  if (spore_edit_generator_regions(target, work->regions, &work->region_count, error)) {
    if (spore_triangle_mesh_copy(&work->mesh, mesh, &failure)) return work;
    spore_error_propagate(&failure, error);
  }
  spore_generate_work_unref(work);
  return NULL;
}

static void clear_work(gpointer data) {
  SporeGenerateWork *work = data;
  g_free(work->source);
  g_free(work->source_hash);
  spore_triangle_mesh_clear(&work->mesh);
  spore_sphere_set_clear(&work->spheres);
  spore_spheres_quality_clear(&work->spheres_quality);
  spore_tetrahedral_mesh_clear(&work->tetrahedra);
  g_clear_pointer(&work->label_report.labels, g_array_unref);
  g_clear_pointer(&work->options.labels, spore_label_source_unref);
  spore_curve_clear(&work->curve);
  spore_triangle_mesh_clear(&work->surface);
  g_free(work->surface_distance);
}

SporeGenerateWork *spore_generate_work_ref(SporeGenerateWork *work) { return g_atomic_rc_box_acquire(work); }

void spore_generate_work_unref(gpointer data) { g_atomic_rc_box_release_full(data, clear_work); }

gboolean spore_generate_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeGenerateWork *work = data;
  return spore_generate_type(work->options.kind)->run(work, progress, error);
}

gboolean spore_measure_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeGenerateWork *work = data;
  SporeError failure = SPORE_ERROR_INIT;
  return spore_spheres_measure(&work->mesh, &work->spheres, &work->spheres_report, &failure) ||
         spore_error_propagate(&failure, error);
}

SporeObject *spore_generate_work_body(const SporeGenerateWork *work, SporeDocument *document) {
  SporeObject *body = spore_document_by_id(document, work->body);
  SporeObject *asset = body ? spore_generate_source(document, body, work->options.kind, NULL) : NULL;
  if (!asset || g_strcmp0(spore_object_name(asset), work->source) != 0 ||
      !same_regions(work, spore_generate_target(document, body, work->options.kind)))
    return NULL;
  g_autofree char *hash = spore_document_asset_hash(document, asset);
  return g_strcmp0(hash, work->source_hash) == 0 ? body : NULL;
}

gboolean spore_generate_work_holds(const SporeGenerateWork *work, SporeDocument *document) {
  return work->options.kind == SPORE_GENERATE_LABELS || spore_generate_work_body(work, document);
}

gboolean spore_generate_work_apply(const SporeGenerateWork *work, SporeDocument *document, GError **error) {
  if (!spore_generate_work_holds(work, document))
    return spore_error_raise(
        error, SPORE_ERROR_INPUT, work->source,
        _("the mesh or its regions changed meanwhile and the result was dropped; generate it again"));
  SporeObject *body = spore_document_by_id(document, work->body); /* none where it came from a file */
  return spore_generate_type(work->options.kind)->apply(work, document, body, error);
}
