/* The box of one generator: the number, Generate, and the quality of the result. */
#ifndef SPORE_UI_PANELS_SPORE_GENERATOR_BOX_H
#define SPORE_UI_PANELS_SPORE_GENERATOR_BOX_H

#include <gtk/gtk.h>

G_BEGIN_DECLS

#define SPORE_TYPE_GENERATOR_BOX spore_generator_box_get_type()
G_DECLARE_FINAL_TYPE(SporeGeneratorBox, spore_generator_box, SPORE, GENERATOR_BOX, GtkBox)

/* Facts of the current asset. */
typedef struct SporeGeneratorState {
  const char *asset;   /* path; NULL: there is no asset */
  const char *remarks; /* its state since it was generated; "": unchanged */
  guint count;         /* number that it was or will be made with; 0: the user's last choice */
  gboolean generated, stale, frozen;
} SporeGeneratorState;

/* action: of the window, takes the count (u). count: initial count; 0 where 0 is allowed and means "as many as needed".
 * label: "Spheres", translated. */
GtkWidget *spore_generator_box_new(const char *action, const char *label, guint count, guint maximum);
/* text: the asset, in words. */
void spore_generator_box_set_result(SporeGeneratorBox *self, const char *text, SporeGeneratorState state);

G_END_DECLS
#endif
