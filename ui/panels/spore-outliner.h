/* Organs, instruments, cameras, links and assets of the scene as a tree. */
#ifndef SPORE_UI_PANELS_SPORE_OUTLINER_H
#define SPORE_UI_PANELS_SPORE_OUTLINER_H

#include <gtk/gtk.h>

#include "ui/document/spore-editor-document.h"

G_BEGIN_DECLS

#define SPORE_TYPE_OUTLINER spore_outliner_get_type()
G_DECLARE_FINAL_TYPE(SporeOutliner, spore_outliner, SPORE, OUTLINER, GtkBox)

void spore_outliner_set_document(SporeOutliner *self, SporeEditorDocument *document);
/* Array of SporeDiagnostic *; the worst of each object becomes its badge. */
void spore_outliner_set_problems(SporeOutliner *self, GPtrArray *diagnostics);
/* Ids (as pointers) of the bodies that the view hides. Keeps a reference; after each change it is to be called again.
 */
void spore_outliner_set_hidden(SporeOutliner *self, GHashTable *hidden);
/* Likewise, of the bodies that are locked. */
void spore_outliner_set_locked(SporeOutliner *self, GHashTable *locked);
/* Begins to edit the name of the selected object. */
void spore_outliner_rename(SporeOutliner *self);
/* Moves the selected rows up (-1) or down (1) by one in their list, and so in the scene. */
void spore_outliner_move(SporeOutliner *self, int by);
void spore_outliner_focus_filter(SporeOutliner *self);

G_END_DECLS
#endif
