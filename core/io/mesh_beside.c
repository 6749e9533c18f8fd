/* What was read beside a mesh file. What cannot be read is kept as a reason: a mesh without its picture is still a
 * mesh.
 */
#include "core/io/mesh_beside.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/io/beside.h"
#include "core/io/import_wire.h"
#include "core/scene/texture.h"

#define MOST_BYTES ((gsize)1 << 30) /* of all pictures together */

static void free_picture(SporeMeshPicture *picture) {
  g_free(picture->name);
  g_clear_pointer(&picture->content, g_bytes_unref);
  g_free(picture->reason);
  g_free(picture);
}

static void free_material(SporeMeshMaterial *material) {
  g_free(material->name);
  g_free(material);
}

SporeMeshBeside *spore_mesh_beside_new(void) {
  SporeMeshBeside *beside = g_new0(SporeMeshBeside, 1);
  beside->room = MOST_BYTES;
  beside->pictures = g_ptr_array_new_with_free_func((GDestroyNotify)free_picture);
  beside->materials = g_ptr_array_new_with_free_func((GDestroyNotify)free_material);
  return beside;
}

void spore_mesh_beside_free(SporeMeshBeside *beside) {
  g_ptr_array_unref(beside->pictures);
  g_ptr_array_unref(beside->materials);
  g_free(beside->reason);
  g_free(beside);
}

guint spore_mesh_beside_picture(SporeMeshBeside *beside, const char *file, const char *name, const char *path) {
  for (guint i = 0; i < beside->pictures->len; i++)
    if (g_str_equal(((SporeMeshPicture *)g_ptr_array_index(beside->pictures, i))->name, name)) return i + 1;
  if (beside->pictures->len == SPORE_IMPORT_PICTURES_MAXIMUM) {
    if (!beside->reason)
      beside->reason = g_strdup_printf(_("it names more than %d pictures, and the rest is left out; expected fewer; "
                                         "split it, or lay some into one"),
                                       SPORE_IMPORT_PICTURES_MAXIMUM);
    return 0;
  }
  g_autoptr(GError) error = NULL;
  SporeMeshPicture *picture = g_new0(SporeMeshPicture, 1);
  picture->name = g_strdup(name);
  picture->content = spore_beside_read(file, path, NULL, 0, MIN(SPORE_TEXTURE_BYTES_MAXIMUM, beside->room), &error);
  if (picture->content) beside->room -= g_bytes_get_size(picture->content);
  else picture->reason = spore_mesh_beside_reason(file, error);
  g_ptr_array_add(beside->pictures, picture);
  return beside->pictures->len;
}

void spore_mesh_beside_wear(SporeMeshBeside *beside, GBytes *picture) {
  SporeMeshPicture *worn = g_new0(SporeMeshPicture, 1);
  worn->name = g_strdup("");
  worn->content = g_bytes_ref(picture);
  g_ptr_array_add(beside->pictures, worn);
  beside->worn = beside->pictures->len;
}

char *spore_mesh_beside_reason(const char *file, const GError *error) {
  gsize length = strlen(file);
  gboolean placed = g_str_has_prefix(error->message, file) && g_str_has_prefix(error->message + length, ": ");
  return g_strdup(placed ? error->message + length + 2 : error->message);
}
