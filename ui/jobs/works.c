#include "ui/jobs/works.h"

#include <glib/gi18n.h>
#include <sys/stat.h>

#include "core/io/mesh_import.h"
#include "core/io/scene_xml.h"
#include "ui/document/asset-readers.h"
#include "ui/document/edits.h"

#define IMPORT_MAXIMUM_BYTES ((goffset)1 << 30)

/* Import. */

SporeImportWork *spore_import_work_new(const char *file, int unit, int frame) {
  SporeImportWork *work = g_new0(SporeImportWork, 1);
  work->file = g_strdup(file);
  work->unit = unit;
  work->frame = frame;
  return work;
}

void spore_import_work_free(gpointer data) {
  SporeImportWork *work = data;
  g_free(work->file);
  g_clear_pointer(&work->content, g_bytes_unref);
  spore_triangle_mesh_clear(&work->mesh);
  g_free(work);
}

/* Regular files alone: a pipe or a device would never end. */
static gboolean check_readable(const char *file, GError **error) {
  struct stat info;
  if (stat(file, &info) != 0)
    return spore_error_raise(error, SPORE_ERROR_FILE, file, _("%s; choose a mesh file that exists"), g_strerror(errno));
  if (!S_ISREG(info.st_mode))
    return spore_error_raise(error, SPORE_ERROR_FILE, file, _("not a regular file; choose a mesh file"));
  if (info.st_size == 0)
    return spore_error_raise(error, SPORE_ERROR_INPUT, file,
                             _("the file is empty; a mesh was expected; export it again"));
  if (info.st_size > IMPORT_MAXIMUM_BYTES)
    return spore_error_raise(error, SPORE_ERROR_INPUT, file, _("the file is over 1 GiB; decimate the mesh first"));
  return TRUE;
}

gboolean spore_import_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeImportWork *work = data;
  char *bytes;
  gsize size;
  g_autoptr(GError) failure = NULL;
  if (!check_readable(work->file, error)) return FALSE;
  if (!g_file_get_contents(work->file, &bytes, &size, &failure))
    return spore_error_raise(error, SPORE_ERROR_FILE, work->file, "%s", failure->message);
  work->content = g_bytes_new_take(bytes, size);
  work->frame_hint = spore_mesh_frame_hint(bytes, size);
  if (!spore_mesh_decode(work->file, work->file, bytes, size, work->unit, work->frame, &work->mesh, progress, error))
    return FALSE;
  spore_editor_readers_remember(work->content, work->unit, work->frame, &work->mesh);
  return TRUE;
}

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

SporeGenerateWork *spore_generate_work_new(SporeDocument *document, SporeObject *body, GError **error) {
  SporeObject *asset = spore_edit_visual_mesh(document, body, error);
  const SporeTriangleMesh *mesh = asset ? spore_document_mesh(document, asset, error) : NULL;
  if (!mesh) return NULL;
  SporeGenerateWork *work = g_new0(SporeGenerateWork, 1);
  SporeError failure = SPORE_ERROR_INIT;
  work->body = spore_object_id(body);
  work->source = g_strdup(spore_object_name(asset));
  work->source_hash = spore_document_asset_hash(document, asset);
  if (spore_triangle_mesh_copy(&work->mesh, mesh, &failure)) return work;
  spore_error_propagate(&failure, error);
  spore_generate_work_free(work);
  return NULL;
}

void spore_generate_work_free(gpointer data) {
  SporeGenerateWork *work = data;
  g_free(work->source);
  g_free(work->source_hash);
  spore_triangle_mesh_clear(&work->mesh);
  spore_sphere_set_clear(&work->spheres);
  spore_tetrahedral_mesh_clear(&work->tetrahedra);
  g_free(work);
}

gboolean spore_spheres_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeGenerateWork *work = data;
  SporeError failure = SPORE_ERROR_INIT;
  return spore_spheres_from_mesh(&work->mesh, &work->spheres_options, &work->spheres, &work->spheres_report, progress,
                                 &failure) ||
         spore_error_propagate(&failure, error);
}

gboolean spore_measure_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeGenerateWork *work = data;
  SporeError failure = SPORE_ERROR_INIT;
  return spore_spheres_measure(&work->mesh, &work->spheres, &work->spheres_report, &failure) ||
         spore_error_propagate(&failure, error);
}

gboolean spore_tetrahedra_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeGenerateWork *work = data;
  return spore_tetrahedra_from_mesh(work->source, &work->mesh, &work->tetrahedra_options, &work->tetrahedra,
                                    &work->tetrahedra_report, progress, error);
}

SporeObject *spore_generate_work_body(const SporeGenerateWork *work, SporeDocument *document) {
  SporeObject *body = spore_document_by_id(document, work->body);
  SporeObject *asset = body ? spore_edit_visual_mesh(document, body, NULL) : NULL;
  if (!asset || g_strcmp0(spore_object_name(asset), work->source) != 0) return NULL;
  g_autofree char *hash = spore_document_asset_hash(document, asset);
  return g_strcmp0(hash, work->source_hash) == 0 ? body : NULL;
}
