/* The organs of a label map with colour, name, volume and size, and what becomes of each.
 *
 * Signals
 *   changed ()   the user chose otherwise for one */
#ifndef SPORE_UI_PANELS_SPORE_LABEL_LIST_H
#define SPORE_UI_PANELS_SPORE_LABEL_LIST_H

#include <gtk/gtk.h>

#include "ui/jobs/works.h"

G_BEGIN_DECLS

#define SPORE_TYPE_LABEL_LIST spore_label_list_get_type()
G_DECLARE_FINAL_TYPE(SporeLabelList, spore_label_list, SPORE, LABEL_LIST, GtkBox)

/* Shows a label map that was read. */
void spore_label_list_set_options(SporeLabelList *self, const SporeGenerateOptions *options);
void spore_label_list_get_options(SporeLabelList *self, SporeGenerateOptions *options);

G_END_DECLS
#endif
