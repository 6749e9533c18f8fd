/* Sections under titles that the user can close. Each is filled with rows and other widgets. When the list is made
 * anew, sections that show the same as before are kept, because making widgets takes long. */
#ifndef SPORE_UI_PANELS_SPORE_SECTION_LIST_H
#define SPORE_UI_PANELS_SPORE_SECTION_LIST_H

#include <gtk/gtk.h>

#include "core/scene/document.h"

G_BEGIN_DECLS

#define SPORE_TYPE_SECTION_LIST spore_section_list_get_type()
G_DECLARE_FINAL_TYPE(SporeSectionList, spore_section_list, SPORE, SECTION_LIST, GtkBox)

/* Begins a new list. The sections follow, from the first to the last, until end. */
void spore_section_list_begin(SporeSectionList *self);
/* The box to fill; NULL: the section shows the same and stays. path: of the object that the section shows. holder: of
 * the regions that it lists, may be NULL. */
GtkBox *spore_section_list_add(SporeSectionList *self, const char *title, const char *path, const SporeObject *holder);
void spore_section_list_end(SporeSectionList *self);

/* SporePropertyRow * of a section, borrowed from the box, to be added to. */
GPtrArray *spore_section_rows(GtkBox *box);
/* An empty label for facts, at the end of a section. */
GtkWidget *spore_section_fact_new(GtkBox *box);
/* Every row shows the value now in force. */
void spore_section_list_refresh(SporeSectionList *self);

G_END_DECLS
#endif
