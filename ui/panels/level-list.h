/* The levels of detail of a body: add, edit, delete. */
#ifndef SPORE_UI_PANELS_LEVEL_LIST_H
#define SPORE_UI_PANELS_LEVEL_LIST_H

#include <gtk/gtk.h>

#include "ui/document/spore-editor-document.h"

/* Adds the list to the box. rows: gets each SporePropertyRow, borrowed. */
void spore_add_level_list(GtkBox *box, SporeEditorDocument *document, const SporeObject *body, GPtrArray *rows);

#endif
