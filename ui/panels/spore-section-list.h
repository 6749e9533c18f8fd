/* Sections under titles that the user can close, each of rows and what else it is filled with. Those that show the same
 * as before are kept when the list is made anew: making widgets takes long. */
#ifndef SPORE_UI_PANELS_SPORE_SECTION_LIST_H
#define SPORE_UI_PANELS_SPORE_SECTION_LIST_H

#include <gtk/gtk.h>

#include "core/scene/document.h"

G_BEGIN_DECLS

#define SPORE_TYPE_SECTION_LIST spore_section_list_get_type()
G_DECLARE_FINAL_TYPE(SporeSectionList, spore_section_list, SPORE, SECTION_LIST, GtkBox)

/* The sections that there are to be follow, from the first to the last; then it ends. */
void spore_section_list_begin(SporeSectionList *self);
/* The box to fill; NULL: it stays as it is, since it shows the same. path: of what it shows. holder: of the regions
 * that it lists, may be NULL. */
GtkBox *spore_section_list_add(SporeSectionList *self, const char *title, const char *path, const SporeObject *holder);
void spore_section_list_end(SporeSectionList *self);

/* SporePropertyRow * of a section, borrowed from the box, to be added to. */
GPtrArray *spore_section_rows(GtkBox *box);
/* Every row shows the value now in force. */
void spore_section_list_refresh(SporeSectionList *self);

G_END_DECLS
#endif
