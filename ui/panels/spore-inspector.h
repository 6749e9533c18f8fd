/* What is selected, with every parameter from its table. */
#ifndef SPORE_UI_PANELS_SPORE_INSPECTOR_H
#define SPORE_UI_PANELS_SPORE_INSPECTOR_H

#include <gtk/gtk.h>

#include "ui/document/spore-editor-document.h"

G_BEGIN_DECLS

#define SPORE_TYPE_INSPECTOR spore_inspector_get_type()
G_DECLARE_FINAL_TYPE(SporeInspector, spore_inspector, SPORE, INSPECTOR, GtkBox)

void spore_inspector_set_document(SporeInspector *self, SporeEditorDocument *document);

G_END_DECLS
#endif
