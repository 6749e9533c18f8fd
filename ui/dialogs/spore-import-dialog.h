/* Asks for mesh files, their unit and axes, which bodies to make, and how to repair them. Shows the result before it is
 * imported. */
#ifndef SPORE_UI_DIALOGS_SPORE_IMPORT_DIALOG_H
#define SPORE_UI_DIALOGS_SPORE_IMPORT_DIALOG_H

#include <gtk/gtk.h>

#include "core/author/organ_import.h"

G_BEGIN_DECLS

#define SPORE_TYPE_IMPORT_DIALOG spore_import_dialog_get_type()
G_DECLARE_FINAL_TYPE(SporeImportDialog, spore_import_dialog, SPORE, IMPORT_DIALOG, GtkDialog)

#define SPORE_RESPONSE_TOGETHER 1

/* files may be NULL. Responds GTK_RESPONSE_ACCEPT when the bodies are to be imported, and SPORE_RESPONSE_TOGETHER when
 * the organs of the label map are to be meshed together instead. */
GtkWidget *spore_import_dialog_new(GtkWindow *parent, const char *const *files);
/* The last import that was read; the caller frees it. NULL: none. */
SporeImport *spore_import_dialog_take(SporeImportDialog *self);

/* The file, where it is a single label map that was read; else NULL. Borrowed. */
const char *spore_import_dialog_get_label_map(SporeImportDialog *self);

G_END_DECLS
#endif
