/* A generator: how many, Generate, and how good its result is. */
#ifndef SPORE_UI_PANELS_SPORE_GENERATOR_BOX_H
#define SPORE_UI_PANELS_SPORE_GENERATOR_BOX_H

#include <gtk/gtk.h>

G_BEGIN_DECLS

#define SPORE_TYPE_GENERATOR_BOX spore_generator_box_get_type()
G_DECLARE_FINAL_TYPE(SporeGeneratorBox, spore_generator_box, SPORE, GENERATOR_BOX, GtkBox)

/* Of what is there now. */
typedef struct SporeGeneratorState {
  const char *asset;   /* path; NULL: nothing is there */
  const char *remarks; /* what became of it since it was generated; "": nothing */
  guint count;         /* that it was, or is to be, made with; 0: as the user chose last */
  gboolean generated, stale, frozen;
} SporeGeneratorState;

/* action: of the window, takes the count (u). count: to begin with; 0 where that is one, "as many as it takes". label:
 * "Spheres", translated. */
GtkWidget *spore_generator_box_new(const char *action, const char *label, guint count, guint maximum);
/* text: what is there, in words. */
void spore_generator_box_set_result(SporeGeneratorBox *self, const char *text, SporeGeneratorState state);

G_END_DECLS
#endif
