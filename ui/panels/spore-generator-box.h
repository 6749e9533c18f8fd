/* A generator: how many, Generate, and how good its result is. */
#ifndef SPORE_UI_PANELS_SPORE_GENERATOR_BOX_H
#define SPORE_UI_PANELS_SPORE_GENERATOR_BOX_H

#include <gtk/gtk.h>

G_BEGIN_DECLS

#define SPORE_TYPE_GENERATOR_BOX spore_generator_box_get_type()
G_DECLARE_FINAL_TYPE(SporeGeneratorBox, spore_generator_box, SPORE, GENERATOR_BOX, GtkBox)

/* action: of the window, takes the count (u). label: "Spheres", translated. */
GtkWidget *spore_generator_box_new(const char *action, const char *label, guint count, guint maximum);
/* What is there now, in words; stale: the source changed since. */
void spore_generator_box_set_result(SporeGeneratorBox *self, const char *text, gboolean stale);

G_END_DECLS
#endif
