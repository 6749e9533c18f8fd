/* Keeps what a user chose for all scenes. */
#include "ui/document/preferences.h"

#include <errno.h>
#include <glib/gi18n.h>

#include "core/scene/error.h"

#define GROUP "editor"
#define FOLDER_MODE 0700

const SporePreference spore_preferences[] = {
    {.name = "look",
     .label = N_("Windows"),
     .doc = N_("Dark or light, and the room around the scene with them"),
     .choices = {{"system", N_("As the system has it")}, {"light", N_("Light windows")}, {"dark", N_("Dark windows")}}},
    {.name = "language",
     .label = N_("Language"),
     .doc = N_("Of menus and messages; it changes when the program is started again"),
     .at_next_start = TRUE,
     .choices = {{"system", N_("As the system has it")}, {"en", "English"}, {"fr", "Français"}}},
    {.name = "turning",
     .label = N_("Turning the view"),
     .doc = N_("The button that turns it by a drag; with Shift the view moves across"),
     .choices = {{"left", N_("Left beside the organs, or middle")}, {"middle", N_("Middle button alone")}}},
    {.name = "wheel",
     .label = N_("Wheel in the view"),
     .doc = N_("What turning the wheel upward, away from you, does"),
     .choices = {{"nearer", N_("Goes nearer")}, {"farther", N_("Goes farther away")}}},
    {.name = "pictures",
     .label = N_("Quality of pictures"),
     .doc = N_("Fine ones have soft shadows, smooth edges and all triangles of fine meshes; without a graphics card "
               "each takes long"),
     .choices = {{"automatic", N_("Fine where there is a graphics card")},
                 {"fine", N_("Always fine")},
                 {"plain", N_("Always plain")}}},
    {.name = "keeping",
     .label = N_("Keeping unsaved work"),
     .doc = N_("How often it is kept aside, to be offered again after a crash"),
     .preset = 1,
     .choices = {{"15", N_("Every 15 seconds")}, {"60", N_("Every minute")}, {"300", N_("Every 5 minutes")}}},
    {.name = "unit",
     .label = N_("Length unit of imports"),
     .doc = N_("Of meshes whose files do not say theirs"),
     .choices =
         {{"guess", N_("Guessed from the size")}, {"m", "m"}, {"cm", "cm"}, {"mm", "mm"}, {"um", "µm"}, {"in", "in"}}},
    {.name = NULL},
};

static char *folder_of_file(void) { return g_build_filename(g_get_user_config_dir(), "spore", NULL); }

static char *file_in(const char *folder) { return g_build_filename(folder, "editor.ini", NULL); }

/* What the file holds; nothing where it is not there, or is no such file. */
static GKeyFile *read_file(const char *file) {
  GKeyFile *keys = g_key_file_new();
  g_key_file_load_from_file(keys, file, G_KEY_FILE_KEEP_COMMENTS, NULL);
  return keys;
}

const SporePreference *spore_preference_find(const char *name) {
  for (const SporePreference *preference = spore_preferences; preference->name; preference++)
    if (g_str_equal(preference->name, name)) return preference;
  return NULL;
}

int spore_preference_choice(const SporePreference *preference, const char *choice) {
  for (int i = 0; i < SPORE_PREFERENCE_CHOICES && preference->choices[i].name; i++)
    if (g_str_equal(preference->choices[i].name, choice)) return i;
  return -1;
}

const char *spore_preference_get(const SporePreference *preference) {
  g_autofree char *folder = folder_of_file();
  g_autofree char *file = file_in(folder);
  g_autoptr(GKeyFile) keys = read_file(file);
  g_autofree char *kept = g_key_file_get_string(keys, GROUP, preference->name, NULL);
  int choice = kept ? spore_preference_choice(preference, kept) : -1;
  return preference->choices[choice < 0 ? (int)preference->preset : choice].name;
}

gboolean spore_preference_set(const SporePreference *preference, const char *choice, GError **error) {
  g_autofree char *folder = folder_of_file();
  g_autofree char *file = file_in(folder);
  g_autoptr(GKeyFile) keys = read_file(file);
  if (g_mkdir_with_parents(folder, FOLDER_MODE) != 0)
    return spore_error_raise(error, SPORE_ERROR_FILE, folder, "%s", g_strerror(errno));
  g_key_file_set_string(keys, GROUP, preference->name, choice);
  return g_key_file_save_to_file(keys, file, error);
}
