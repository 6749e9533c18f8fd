/* Plots of a run while it goes on: the quantities that `spore run --output` writes, over time. */
#ifndef SPORE_UI_PANELS_SPORE_PLOTS_H
#define SPORE_UI_PANELS_SPORE_PLOTS_H

#include "ui/sim/spore-player.h"

#include <gtk/gtk.h>

G_BEGIN_DECLS

#define SPORE_TYPE_PLOTS spore_plots_get_type()
G_DECLARE_FINAL_TYPE(SporePlots, spore_plots, SPORE, PLOTS, GtkBox)

void spore_plots_set_document(SporePlots *self, SporeEditorDocument *document, SporePlayer *player);
/* Shows a quantity, by its name ("energy"), or what of it has a unit of its own ("contacts.depth"). FALSE: the run has
 * no such quantity. Where there is no run, one is prepared. */
gboolean spore_plots_show(SporePlots *self, const char *quantity);
/* Watches one more point, BODY@X,Y,Z, and goes back to time 0. FALSE with a GError: see spore_watch_place_parse. Where
 * there is no run, one is prepared, and a point that is refused then is told by the action "report". */
gboolean spore_plots_watch(SporePlots *self, const char *point, GError **error);
/* Watches no points, and goes back to time 0. */
void spore_plots_forget_points(SporePlots *self);
/* Writes all numbers as CSV, or what is shown as SVG, by the name of the file. */
gboolean spore_plots_save(SporePlots *self, const char *file, GError **error);

G_END_DECLS
#endif
