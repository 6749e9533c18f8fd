/* Lines over time: what spore_plot_svg writes, drawn in a widget. */
#ifndef SPORE_UI_PANELS_SPORE_LINE_PLOT_H
#define SPORE_UI_PANELS_SPORE_LINE_PLOT_H

#include <gtk/gtk.h>

#include "core/measure/plot.h"

G_BEGIN_DECLS

#define SPORE_TYPE_LINE_PLOT spore_line_plot_get_type()
G_DECLARE_FINAL_TYPE(SporeLinePlot, spore_line_plot, SPORE, LINE_PLOT, GtkDrawingArea)

/* Shows a panel with linear axes. The panel, with all that it points to, is borrowed until the next call. NULL: an
 * invitation is shown instead. */
void spore_line_plot_set_panel(SporeLinePlot *self, const SporePlotPanel *panel, const char *invitation);

G_END_DECLS
#endif
