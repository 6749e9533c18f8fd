/* Error against number, both logarithmic: measured points, the current number, and the number from which more do not
 * pay. A click chooses the number under it. With the keyboard, Left and Right move along the points and Enter chooses
 * one.
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
/* The range of numbers, the name of the error, and the name of what is counted (kept, not copied). */
void spore_count_plot_set_axes(SporeCountPlot *self, size_t least, size_t most, const char *label,
                               const char *count_label);
void spore_count_plot_set_current(SporeCountPlot *self, size_t count);

G_END_DECLS
#endif
