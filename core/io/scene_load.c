/* Reads the files of scenes. */
#include <errno.h>
#include <glib/gi18n.h>

#include "core/io/bundle.h"
#include "core/io/file_content.h"
#include "core/io/scene_markup.h"
#include "core/io/scene_xml.h"

static gboolean read_failed(const char *file, int fault, GError **error) {
  if (fault == EISDIR)
    return spore_error_raise(error, SPORE_ERROR_FILE, file, "%s",
                             _("this is a folder; expected a .spore file; name the file inside it"));
  if (fault == EINVAL)
    return spore_error_raise(error, SPORE_ERROR_FILE, file, "%s",
                             _("this is not a regular file; expected a .spore file; choose another"));
  if (fault == EFBIG)
    return spore_error_raise(error, SPORE_ERROR_INPUT, file,
                             _("the scene has over %u MiB; expected less; keep meshes in "
                               "files of their own"),
                             SPORE_LARGEST_SCENE >> 20);
  if (fault == ENOENT)
    return spore_error_raise(error, SPORE_ERROR_FILE, file, "%s",
                             _("there is no such file; expected a .spore file; correct the name"));
  return spore_error_raise(error, SPORE_ERROR_FILE, file,
                           _("cannot be read: %s; expected a .spore file; check its "
                             "permissions"),
                           g_strerror(fault));
}

gboolean spore_scene_is_name(const char *file) {
  return g_str_has_suffix(file, ".spore") || spore_bundle_is_name(file);
}

SporeDocument *spore_scene_load(const SporeSchema *schema, const char *file, GError **error) {
  if (spore_bundle_is_name(file)) return spore_bundle_load(schema, file, NULL, error);
  int fault = 0;
  g_autoptr(GByteArray) content = spore_file_content(file, SPORE_LARGEST_SCENE, &fault);
  if (content) return spore_scene_parse(schema, file, (const char *)content->data, content->len, error);
  read_failed(file, fault, error);
  return NULL;
}
