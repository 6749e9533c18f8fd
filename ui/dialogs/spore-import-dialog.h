/* Asks for a mesh file, its unit and its axes, and shows how large the organ would be. */
#ifndef SPORE_UI_DIALOGS_SPORE_IMPORT_DIALOG_H
#define SPORE_UI_DIALOGS_SPORE_IMPORT_DIALOG_H

#include <gtk/gtk.h>

G_BEGIN_DECLS

#define SPORE_TYPE_IMPORT_DIALOG spore_import_dialog_get_type()
G_DECLARE_FINAL_TYPE(SporeImportDialog, spore_import_dialog, SPORE, IMPORT_DIALOG, GtkDialog)

/* file may be NULL. Responds GTK_RESPONSE_ACCEPT when the mesh is to be imported. */
GtkWidget *spore_import_dialog_new(GtkWindow *parent, const char *file);
char *spore_import_dialog_get_file(SporeImportDialog *self); /* g_free */
int spore_import_dialog_get_unit(SporeImportDialog *self);   /* index into spore_length_units */
int spore_import_dialog_get_frame(SporeImportDialog *self);  /* index into spore_mesh_frames */

G_END_DECLS
#endif
