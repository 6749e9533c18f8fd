/* Works of the editor that no generator does: a scene is opened or checked, a sphere set or a mapping measured. */
#include "ui/jobs/works.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/io/bundle.h"
#include "core/io/scene_xml.h"
#include "ui/document/asset-readers.h"

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

/* Decodes assets here, so that the GTK thread finds them in the document. The checks report assets that cannot be read.
 * */
static void decode_asset(SporeDocument *document, SporeObject *asset) {
  const char *element = spore_object_type(asset)->element;
  if (g_str_equal(element, "mesh")) spore_document_mesh(document, asset, NULL);
  if (g_str_equal(element, "spheres")) spore_document_spheres(document, asset, NULL);
  if (g_str_equal(element, "tetrahedra")) spore_document_tetrahedra(document, asset, NULL);
  if (g_str_equal(element, "curve")) spore_document_curve(document, asset, NULL);
}

gboolean spore_open_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeOpenWork *work = data;
  gboolean bundle = spore_bundle_is_name(work->file);
  work->document = bundle ? spore_bundle_load(work->schema, work->file, progress, error)
                          : spore_scene_load(work->schema, work->file, error);
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

/* Measure. */

gboolean spore_measure_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeGenerateWork *work = data;
  SporeError failure = SPORE_ERROR_INIT;
  return spore_spheres_measure(&work->mesh, &work->spheres, &work->spheres_report, &failure) ||
         spore_error_propagate(&failure, error);
}

/* Check. */

SporeCheckWork *spore_check_work_new(const SporeDocument *document) {
  SporeCheckWork *work = g_new0(SporeCheckWork, 1);
  work->document = spore_document_copy(document);
  work->revision = spore_document_revision(document);
  return work;
}

gboolean spore_check_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeCheckWork *work = data;
  work->found = spore_document_check(work->document, NULL);
  return TRUE;
}

void spore_check_work_free(gpointer data) {
  SporeCheckWork *work = data;
  g_clear_pointer(&work->found, g_ptr_array_unref);
  spore_document_free(work->document);
  g_free(work);
}

/* Mapping. */

SporeMappingWork *spore_mapping_work_new(const SporeDocument *document, const SporeObject *body) {
  SporeMappingWork *work = g_new0(SporeMappingWork, 1);
  work->document = spore_document_copy(document);
  work->report.body = spore_object_id(body);
  work->report.revision = spore_document_revision(document);
  return work;
}

gboolean spore_mapping_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeMappingWork *work = data;
  SporeObject *body = spore_document_by_id(work->document, work->report.body);
  return spore_mapping_report_measure(&work->report, work->document, body, progress, error);
}

void spore_mapping_work_free(gpointer data) {
  SporeMappingWork *work = data;
  spore_mapping_report_clear(&work->report);
  spore_document_free(work->document);
  g_free(work);
}
