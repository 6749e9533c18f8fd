/* One parameter of one object: label, editor, unit, what a change needs, and back to the default. */
#ifndef SPORE_UI_PANELS_SPORE_PROPERTY_ROW_H
#define SPORE_UI_PANELS_SPORE_PROPERTY_ROW_H

#include <gtk/gtk.h>

#include "ui/document/spore-editor-document.h"

G_BEGIN_DECLS

#define SPORE_TYPE_PROPERTY_ROW spore_property_row_get_type()
G_DECLARE_FINAL_TYPE(SporePropertyRow, spore_property_row, SPORE, PROPERTY_ROW, GtkBox)

/* path: of the object, or of a unit that its body does not have yet (made by the first change). */
GtkWidget *spore_property_row_new(SporeEditorDocument *document, const char *path, const SporeObjectType *type,
                                  guint property);
/* The same parameter of several objects of that type: one change sets them all, as one undo step. Where they differ,
 * nothing is shown. paths: one or more, ended by NULL. */
GtkWidget *spore_property_row_new_of_several(SporeEditorDocument *document, const char *const *paths,
                                             const SporeObjectType *type, guint property);
/* Shows the value now in force. */
void spore_property_row_refresh(SporePropertyRow *self);

G_END_DECLS
#endif
