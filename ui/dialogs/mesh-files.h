/* Which files hold meshes, by their names: for choosers, and for folders of organs. */
#ifndef SPORE_UI_DIALOGS_MESH_FILES_H
#define SPORE_UI_DIALOGS_MESH_FILES_H

#include <gtk/gtk.h>

/* Lets a chooser show meshes and label maps, or all files. */
void spore_mesh_files_filter(GtkFileChooser *chooser);
/* The meshes and label maps of a folder, not of folders in it, sorted by name: of char *, g_ptr_array_unref. NULL: it
 * is no folder that can be read. */
GPtrArray *spore_mesh_files_of_folder(const char *folder);

#endif
