/* Works on meshes for a job: importing files, and changing a mesh of the scene. */
#include "ui/jobs/mesh-works.h"

#include "core/io/mesh_import.h"
#include "core/io/scene_xml.h"
#include "ui/document/asset-readers.h"

/* Import. */

SporeImportWork *spore_import_work_new(char *const *files, const SporeImportOptions *options) {
  SporeImportWork *work = g_new0(SporeImportWork, 1);
  work->files = g_strdupv((char **)files);
  work->options = *options;
  return work;
}

void spore_import_work_free(gpointer data) {
  SporeImportWork *work = data;
  g_strfreev(work->files);
  g_clear_pointer(&work->import, spore_import_free);
  g_free(work);
}

gboolean spore_import_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeImportWork *work = data;
  work->import = spore_import_read(work->files, &work->options, progress, error);
  for (guint i = 0; work->import && i < work->import->bodies->len; i++) {
    const SporeImportBody *body = g_ptr_array_index(work->import->bodies, i);
    if (!body->changed)
      spore_editor_readers_remember(body->source->content, body->source->unit, body->source->frame, &body->mesh);
  }
  return work->import != NULL;
}

/* A change. */

SporeMeshWork *spore_mesh_work_new(SporeDocument *document, SporeObject *asset, SporeMeshOperationKind operation,
                                   double argument, GError **error) {
  const SporeTriangleMesh *mesh = spore_document_mesh(document, asset, error);
  if (!mesh) return NULL;
  SporeMeshWork *work = g_new0(SporeMeshWork, 1);
  SporeError failure = SPORE_ERROR_INIT;
  work->asset = spore_object_id(asset);
  work->hash = spore_document_asset_hash(document, asset);
  work->operation = operation;
  work->argument = argument;
  if (spore_triangle_mesh_copy(&work->mesh, mesh, &failure)) return work;
  spore_error_propagate(&failure, error);
  spore_mesh_work_free(work);
  return NULL;
}

void spore_mesh_work_free(gpointer data) {
  SporeMeshWork *work = data;
  g_free(work->hash);
  spore_triangle_mesh_clear(&work->mesh);
  g_clear_pointer(&work->content, g_bytes_unref);
  g_free(work);
}

/* The stored mesh is read back as the scene will read it, without triangles that have no area, and kept for the
 * readers. */
static gboolean store(SporeMeshWork *work, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeTriangleMesh read = {0};
  gsize size;
  char *text = spore_off_format(&work->mesh, &size);
  work->content = g_bytes_new_take(text, size);
  if (!spore_io_readers.mesh("", "changed.off", work->content, 0, 0, &read, error)) return FALSE;
  spore_triangle_mesh_clear(&work->mesh);
  work->mesh = read;
  spore_editor_readers_remember(work->content, 0, 0, &work->mesh);
  return spore_mesh_figures(&work->mesh, &work->change.after, &failure) || spore_error_propagate(&failure, error);
}

gboolean spore_mesh_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeMeshWork *work = data;
  SporeError failure = SPORE_ERROR_INIT;
  if (!spore_mesh_operate(&work->mesh, work->operation, work->argument, &work->change, progress, &failure))
    return spore_error_propagate(&failure, error);
  return store(work, error);
}

SporeObject *spore_mesh_work_asset(const SporeMeshWork *work, SporeDocument *document) {
  SporeObject *asset = spore_document_by_id(document, work->asset);
  g_autofree char *hash = asset ? spore_document_asset_hash(document, asset) : NULL;
  return hash && g_strcmp0(hash, work->hash) == 0 ? asset : NULL;
}
