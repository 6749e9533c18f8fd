/* The selected object, with every parameter of its table.
 *
 * Signals
 *   marks-changed ()   what the view is to point out may differ                                                     */
#ifndef SPORE_UI_PANELS_SPORE_INSPECTOR_H
#define SPORE_UI_PANELS_SPORE_INSPECTOR_H

#include <gtk/gtk.h>

#include "ui/document/mapping-report.h"
#include "ui/document/spore-editor-document.h"
#include "ui/render/stage.h"

G_BEGIN_DECLS

#define SPORE_TYPE_INSPECTOR spore_inspector_get_type()
G_DECLARE_FINAL_TYPE(SporeInspector, spore_inspector, SPORE, INSPECTOR, GtkBox)

void spore_inspector_set_document(SporeInspector *self, SporeEditorDocument *document);
/* Shows the quality of a body's mapping; takes the content of the report. */
void spore_inspector_set_mapping(SporeInspector *self, SporeMappingReport *report);
/* Marks of the selected body: its regions, and the worst place of its mapping where it was measured. The caller frees
 * them. */
SporeStageMarks spore_inspector_get_marks(SporeInspector *self);

G_END_DECLS
#endif
