/* The work-precision plot of an accuracy study: what spore_accuracy_svg writes, drawn in a widget, where there is room
 * for it both error over step and error over cost, else error over cost alone. The pointer over a point is told what
 * the point is. A click selects the point; with the keyboard, the arrows move along the points.
 *
 * Signals
 *   point-selected ()      spore_precision_plot_get_selected has changed
 *   point-activated ()     double click on the selected point, or Enter                                           */
#ifndef SPORE_UI_PANELS_SPORE_PRECISION_PLOT_H
#define SPORE_UI_PANELS_SPORE_PRECISION_PLOT_H

#include <gtk/gtk.h>

#include "core/measure/accuracy.h"

G_BEGIN_DECLS

#define SPORE_TYPE_PRECISION_PLOT spore_precision_plot_get_type()
G_DECLARE_FINAL_TYPE(SporePrecisionPlot, spore_precision_plot, SPORE, PRECISION_PLOT, GtkDrawingArea)

/* The report is borrowed until the next call; NULL: none. No point is selected. */
void spore_precision_plot_set_report(SporePrecisionPlot *self, const SporeAccuracyReport *report);
/* Index of a point of the report; -1: none. */
gssize spore_precision_plot_get_selected(SporePrecisionPlot *self);
void spore_precision_plot_select(SporePrecisionPlot *self, gssize point);
/* The point whose settings the scene has, which is marked; -1: none. */
void spore_precision_plot_set_current(SporePrecisionPlot *self, gssize point);
/* "tr_bdf2 at 8 ms: 0.2 % off, 0.15 ms a step, 50 times real time; Pareto". g_free. */
char *spore_precision_plot_describe(const SporeAccuracyReport *report, gssize point);

G_END_DECLS
#endif
