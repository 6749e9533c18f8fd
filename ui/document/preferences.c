/* Keeps what a user chose for all scenes. */
#include "ui/document/preferences.h"

#include <errno.h>

#include "core/scene/error.h"

#define GROUP "editor"
#define FOLDER_MODE 0700

static char *folder_of_file(void) { return g_build_filename(g_get_user_config_dir(), "spore", NULL); }

static char *file_in(const char *folder) { return g_build_filename(folder, "editor.ini", NULL); }

/* What the file holds; nothing where it is not there, or is no such file. */
static GKeyFile *read_file(const char *file) {
  GKeyFile *keys = g_key_file_new();
  g_key_file_load_from_file(keys, file, G_KEY_FILE_KEEP_COMMENTS, NULL);
  return keys;
}

char *spore_preference_get(const char *name) {
  g_autofree char *folder = folder_of_file();
  g_autofree char *file = file_in(folder);
  g_autoptr(GKeyFile) keys = read_file(file);
  return g_key_file_get_string(keys, GROUP, name, NULL);
}

gboolean spore_preference_set(const char *name, const char *text, GError **error) {
  g_autofree char *folder = folder_of_file();
  g_autofree char *file = file_in(folder);
  g_autoptr(GKeyFile) keys = read_file(file);
  if (g_mkdir_with_parents(folder, FOLDER_MODE) != 0)
    return spore_error_raise(error, SPORE_ERROR_FILE, folder, "%s", g_strerror(errno));
  g_key_file_set_string(keys, GROUP, name, text);
  return g_key_file_save_to_file(keys, file, error);
}
