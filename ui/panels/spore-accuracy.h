/* The accuracy study of the scene: measured on a worker, plotted, applied to the scene, and written to files.
 *
 * Signals
 *   study-changed ()     whether it measures, what was measured, or which point is selected may differ           */
#ifndef SPORE_UI_PANELS_SPORE_ACCURACY_H
#define SPORE_UI_PANELS_SPORE_ACCURACY_H

#include <gtk/gtk.h>

#include "ui/document/spore-editor-document.h"

G_BEGIN_DECLS

#define SPORE_TYPE_ACCURACY spore_accuracy_get_type()
G_DECLARE_FINAL_TYPE(SporeAccuracyPanel, spore_accuracy, SPORE, ACCURACY, GtkBox)

void spore_accuracy_set_document(SporeAccuracyPanel *self, SporeEditorDocument *document);
/* Begins a study, as the options say. */
void spore_accuracy_measure(SporeAccuracyPanel *self);
gboolean spore_accuracy_is_measuring(SporeAccuracyPanel *self);
/* Selects a point by its index in the report. */
void spore_accuracy_choose(SporeAccuracyPanel *self, gsize point);
/* Whether a point is selected that the scene can have. */
gboolean spore_accuracy_can_apply(SporeAccuracyPanel *self);
/* Gives the scene the selected point's method, step, solvers and level. */
gboolean spore_accuracy_apply(SporeAccuracyPanel *self, GError **error);
/* Writes the last study as the file's suffix says: .html a page, .csv a table, .svg the plot. */
gboolean spore_accuracy_save(SporeAccuracyPanel *self, const char *file, GError **error);

G_END_DECLS
#endif
