/* The regions of a body, or of what is generated for it: add, edit, delete. */
#ifndef SPORE_UI_PANELS_REGION_LIST_H
#define SPORE_UI_PANELS_REGION_LIST_H

#include <gtk/gtk.h>

#include "core/author/generator.h"
#include "core/author/region_edits.h"
#include "ui/document/spore-editor-document.h"

/* Fills the box. holder: path of the regions' parent, which may not exist yet, of that type. rows: gets each
 * SporePropertyRow, borrowed. empty: text where there are no regions, translated. */
void spore_fill_region_list(GtkBox *box, SporeEditorDocument *document, const char *holder, const SporeObjectType *type,
                            const char *empty, GPtrArray *rows);

/* A button in a list that activates an action of the window with the path of what it stands beside. text: for people,
 * translated. */
GtkWidget *spore_row_icon_new(const char *icon, const char *text, const char *action, const char *path);

#endif
