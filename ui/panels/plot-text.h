/* Text in plots that widgets draw. */
#ifndef SPORE_UI_PANELS_PLOT_TEXT_H
#define SPORE_UI_PANELS_PLOT_TEXT_H

#include <gtk/gtk.h>

/* Pixels. */
double spore_plot_text_width(GtkWidget *widget, const char *text);
/* align: 0 to 1, the part of the text left of x; y: the text's top. The text never begins left of the widget. */
void spore_plot_text_draw(GtkWidget *widget, cairo_t *cr, double x, double y, double align, const char *text);

#endif
