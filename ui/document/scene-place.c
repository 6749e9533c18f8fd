/* Places in the user's data folder for what belongs to a scene. */
#include "ui/document/scene-place.h"

#include <glib.h>

char *spore_scene_place(const char *scene, const char *folder, const char *extension) {
  g_autofree char *path = g_canonicalize_filename(scene, NULL), *name = g_path_get_basename(path);
  g_autofree char *hash = g_compute_checksum_for_string(G_CHECKSUM_SHA256, path, -1);
  g_autofree char *file = g_strdup_printf("%s-%.16s%s", name, hash, extension);
  return g_build_filename(g_get_user_data_dir(), "spore", folder, file, NULL);
}
