/* Lays a picture over an organ. What decodes meshes finds the places that the mesh's file gives, and makes a PNG of a
 * photograph. */
#include "core/author/texture_edits.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/edits.h"
#include "core/base/memory.h"
#include "core/io/file_content.h"
#include "core/io/mesh_import.h"
#include "core/io/organ.h"
#include "core/scene/texture.h"

struct SporeTextureWork {
  guint32 body; /* object id */
  char *where;  /* path of the body */
  char *file;   /* of the picture */
  GBytes *picture;
  char *mesh_file;
  GBytes *mesh; /* content of the file of the body's mesh */
  int unit, frame;
  gsize triangles;
  float *places; /* triangles x 3 x 2; NULL: not found yet */
};

static GBytes *read_picture(const char *file, GError **error) {
  int fault;
  GByteArray *content = spore_file_content(file, SPORE_TEXTURE_BYTES_MAXIMUM, &fault);
  if (content) return g_byte_array_free_to_bytes(content);
  spore_error_raise(error, SPORE_ERROR_FILE, file,
                    _("cannot be read (%s); expected a picture, PNG or JPEG, of at most 64 MiB; check the path"),
                    g_strerror(fault));
  return NULL;
}

/* The places that the body has, where they fit its mesh. */
static float *places_of(SporeDocument *document, const SporeObject *visual, gsize triangles) {
  const char *file = spore_object_text(visual, "texture_places");
  g_autoptr(GBytes) content = file ? spore_document_read_asset(document, file, NULL) : NULL;
  if (!content) return NULL;
  gsize size;
  const char *text = g_bytes_get_data(content, &size);
  return spore_texture_places_parse(file, text, size, 3 * triangles, NULL);
}

static gboolean take_mesh(SporeTextureWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  const SporeObject *visual = spore_object_child_of(body, "visual");
  SporeObject *asset = visual ? spore_object_reference(visual, "mesh") : NULL;
  if (!asset)
    return spore_error_raise(
        error, SPORE_ERROR_INPUT, work->where,
        _("the body shows no mesh; expected a visual mesh that a picture can be laid over; give it "
          "one"));
  const SporeTriangleMesh *mesh = spore_document_mesh(document, asset, error);
  if (!mesh) return FALSE;
  work->triangles = mesh->triangle_count;
  work->mesh_file = g_strdup(spore_object_text(asset, "file"));
  work->mesh = spore_document_read_asset(document, work->mesh_file, error);
  work->unit = (int)spore_object_number(asset, "unit"), work->frame = (int)spore_object_number(asset, "frame");
  work->places = places_of(document, visual, work->triangles);
  return work->mesh != NULL;
}

SporeTextureWork *spore_texture_work_new(SporeDocument *document, SporeObject *body, const char *file, GError **error) {
  SporeTextureWork *work = g_new0(SporeTextureWork, 1);
  work->body = spore_object_id(body);
  work->where = spore_object_path(body);
  work->file = g_strdup(file);
  work->picture = read_picture(file, error);
  if (work->picture && take_mesh(work, document, body, error)) return work;
  spore_texture_work_free(work);
  return NULL;
}

void spore_texture_work_free(gpointer data) {
  SporeTextureWork *work = data;
  g_free(work->where);
  g_free(work->file);
  g_clear_pointer(&work->picture, g_bytes_unref);
  g_free(work->mesh_file);
  g_clear_pointer(&work->mesh, g_bytes_unref);
  spore_free(work->places);
  g_free(work);
}

/* The mesh with the picture on all of it; NULL with an error. g_ptr_array_unref. */
static GPtrArray *decode(const SporeTextureWork *work, const SporeProgress *progress, GError **error) {
  g_autoptr(SporeMeshBeside) beside = spore_mesh_beside_new();
  guint count;
  gsize size;
  gconstpointer bytes = g_bytes_get_data(work->mesh, &size);
  spore_mesh_beside_wear(beside, work->picture);
  return spore_mesh_decode_parts(work->mesh_file, bytes, size, beside, work->unit, work->frame, FALSE, &count, progress,
                                 error);
}

/* Takes picture and places from the mesh. */
static gboolean take_worn(SporeTextureWork *work, SporeMeshPart *part, GError **error) {
  if (part->untextured) return spore_error_raise(error, SPORE_ERROR_INPUT, work->where, "%s", part->untextured);
  if (!part->picture || part->mesh.triangle_count != work->triangles)
    return spore_error_raise(error, SPORE_ERROR_INPUT, work->where,
                             _("the corners of its mesh have no places in a picture (UV); expected them; unwrap the "
                               "mesh, and import it again"));
  g_bytes_unref(work->picture);
  work->picture = g_bytes_ref(part->picture);
  if (!work->places) work->places = g_steal_pointer(&part->places);
  return TRUE;
}

gboolean spore_texture_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeTextureWork *work = data;
  int width, height;
  g_autoptr(GError) fault = NULL;
  gboolean drawn = spore_texture_size(work->file, work->picture, &width, &height, &fault);
  if (drawn && work->places) return TRUE;
  g_autoptr(GPtrArray) parts = decode(work, progress, error);
  if (!parts) return FALSE;
  return take_worn(work, parts->pdata[0], error);
}

static char *keep(SporeDocument *document, const SporeObject *body, const char *extension, GBytes *content) {
  gsize size;
  gconstpointer bytes = g_bytes_get_data(content, &size);
  char *file = spore_content_file_name(spore_object_name(body), extension, bytes, size);
  spore_document_put_blob(document, file, content);
  return file;
}

static gboolean apply(const SporeTextureWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  static const double white[3] = {1, 1, 1};
  SporeObject *visual = (SporeObject *)spore_object_child_of(body, "visual");
  gsize size;
  char *text = spore_texture_places_format(work->places, 3 * work->triangles, &size);
  g_autoptr(GBytes) content = g_bytes_new_take(text, size);
  g_autofree char *picture = keep(document, body, "png", work->picture);
  g_autofree char *places = keep(document, body, "places", content);
  gboolean bare = !spore_object_text(visual, "texture");
  return spore_document_set_text(document, visual, "texture", picture, error) &&
         spore_document_set_text(document, visual, "texture_places", places, error) &&
         (!bare || spore_edit_set_colour(document, body, white, error));
}

/* Whether the body shows the mesh that the work is of. */
static gboolean holds(const SporeTextureWork *work, SporeDocument *document, SporeObject *body) {
  const SporeObject *visual = spore_object_child_of(body, "visual");
  SporeObject *asset = visual ? spore_object_reference(visual, "mesh") : NULL;
  const SporeTriangleMesh *mesh = asset ? spore_document_mesh(document, asset, NULL) : NULL;
  return mesh && mesh->triangle_count == work->triangles &&
         strcmp(spore_object_text(asset, "file"), work->mesh_file) == 0;
}

gboolean spore_texture_work_apply(const SporeTextureWork *work, SporeDocument *document, GError **error) {
  SporeObject *body = spore_document_by_id(document, work->body);
  if (!body || !holds(work, document, body))
    return spore_error_raise(error, SPORE_ERROR_INPUT, work->where,
                             _("its mesh changed meanwhile, and the picture was not laid over it; lay it again"));
  spore_document_begin(document, _("Lay a picture"));
  return spore_edit_finish(document, apply(work, document, body, error));
}
