/* Which files hold meshes, by their names: for choosers, and for folders of organs. */
#include "ui/dialogs/mesh-files.h"

#include <glib/gi18n.h>

static const char *const endings[] = {".stl", ".obj", ".ply",    ".off",  ".gltf", ".glb", ".vtk",
                                      ".vtp", ".nii", ".nii.gz", ".nrrd", ".nhdr", ".hdr"};

void spore_mesh_files_filter(GtkFileChooser *chooser) {
  GtkFileFilter *filter = gtk_file_filter_new(), *all = gtk_file_filter_new();
  gtk_file_filter_set_name(filter, _("Meshes"));
  for (gsize i = 0; i < G_N_ELEMENTS(endings); i++) {
    g_autofree char *pattern = g_strconcat("*", endings[i], NULL);
    g_autofree char *upper = g_ascii_strup(pattern, -1);
    gtk_file_filter_add_pattern(filter, pattern);
    gtk_file_filter_add_pattern(filter, upper);
  }
  gtk_file_filter_set_name(all, _("All files"));
  gtk_file_filter_add_pattern(all, "*");
  gtk_file_chooser_add_filter(chooser, filter);
  gtk_file_chooser_add_filter(chooser, all);
}

static gboolean has_ending(const char *name) {
  g_autofree char *lower = g_ascii_strdown(name, -1);
  for (gsize i = 0; i < G_N_ELEMENTS(endings); i++)
    if (g_str_has_suffix(lower, endings[i])) return TRUE;
  return FALSE;
}

static int by_name(gconstpointer a, gconstpointer b) { return strcmp(*(char *const *)a, *(char *const *)b); }

GPtrArray *spore_mesh_files_of_folder(const char *folder) {
  g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
  if (!dir) return NULL;
  GPtrArray *files = g_ptr_array_new_with_free_func(g_free);
  for (const char *name = g_dir_read_name(dir); name; name = g_dir_read_name(dir))
    if (has_ending(name)) g_ptr_array_add(files, g_build_filename(folder, name, NULL));
  g_ptr_array_sort(files, by_name);
  return files;
}
