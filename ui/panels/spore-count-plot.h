/* Error against number, both logarithmic: measured points, the number of now, and where more stop paying. A click takes
 * the number under it; with the keyboard Left and Right go along the points and Enter takes one.
 *
 * Signals
 *   count-chosen (u count)                                                                                           */
#ifndef SPORE_UI_PANELS_SPORE_COUNT_PLOT_H
#define SPORE_UI_PANELS_SPORE_COUNT_PLOT_H

#include <gtk/gtk.h>

G_BEGIN_DECLS

#define SPORE_TYPE_COUNT_PLOT spore_count_plot_get_type()
G_DECLARE_FINAL_TYPE(SporeCountPlot, spore_count_plot, SPORE, COUNT_PLOT, GtkDrawingArea)

/* errors in %; ascending counts; copied. enough: 0 for none. */
void spore_count_plot_set_points(SporeCountPlot *self, const size_t *counts, const double *errors, gsize count,
                                 size_t enough);
/* The numbers it reaches from and to, what the error is called, and what they are numbers of (kept, not copied). */
void spore_count_plot_set_axes(SporeCountPlot *self, size_t least, size_t most, const char *label,
                               const char *count_label);
void spore_count_plot_set_current(SporeCountPlot *self, size_t count);

G_END_DECLS
#endif
