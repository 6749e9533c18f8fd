/* Asks in which format a scene is exported, and shows what came of it. */
#ifndef SPORE_UI_DIALOGS_SPORE_EXPORT_DIALOG_H
#define SPORE_UI_DIALOGS_SPORE_EXPORT_DIALOG_H

#include <gtk/gtk.h>

#include "ui/export/export.h"

/* A dialog that responds GTK_RESPONSE_ACCEPT when a format is chosen. played_s: how long the scene has played; 0: not
 * yet. */
GtkWidget *spore_export_dialog_new(GtkWindow *parent, double played_s);
const SporeExportFormat *spore_export_dialog_get_format(GtkWidget *dialog);
double spore_export_dialog_get_time_s(GtkWidget *dialog);
double spore_export_dialog_get_every_s(GtkWidget *dialog);
/* Whether the input of the run so far moves the instruments. */
gboolean spore_export_dialog_get_as_played(GtkWidget *dialog);

/* A window of its own with the report, in markup. */
void spore_export_report_show(GtkWindow *parent, const char *markup);

#endif
