/* Asks for mesh files, their unit and axes, what bodies to make of them and how to mend them; shows what comes of it
 * before anything is done. */
#ifndef SPORE_UI_DIALOGS_SPORE_IMPORT_DIALOG_H
#define SPORE_UI_DIALOGS_SPORE_IMPORT_DIALOG_H

#include <gtk/gtk.h>

#include "core/author/organ_import.h"

G_BEGIN_DECLS

#define SPORE_TYPE_IMPORT_DIALOG spore_import_dialog_get_type()
G_DECLARE_FINAL_TYPE(SporeImportDialog, spore_import_dialog, SPORE, IMPORT_DIALOG, GtkDialog)

#define SPORE_RESPONSE_TOGETHER 1

/* files may be NULL. Responds GTK_RESPONSE_ACCEPT when what was read is to be imported, SPORE_RESPONSE_TOGETHER when
 * the organs of its label map are to be meshed together instead. */
GtkWidget *spore_import_dialog_new(GtkWindow *parent, const char *const *files);
/* What was read last; the caller's to free. NULL: nothing. */
SporeImport *spore_import_dialog_take(SporeImportDialog *self);

/* The one file, where it was read and is a label map; NULL: it is not. Borrowed. */
const char *spore_import_dialog_get_label_map(SporeImportDialog *self);

G_END_DECLS
#endif
