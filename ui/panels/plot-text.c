/* Lays out and draws the texts of plots in the widget's own font and colour. */
#include "ui/panels/plot-text.h"

#include <math.h>

double spore_plot_text_width(GtkWidget *widget, const char *text) {
  int width;
  g_autoptr(PangoLayout) layout = gtk_widget_create_pango_layout(widget, text);
  pango_layout_get_pixel_size(layout, &width, NULL);
  return width;
}

void spore_plot_text_draw(GtkWidget *widget, cairo_t *cr, double x, double y, double align, const char *text) {
  int width;
  g_autoptr(PangoLayout) layout = gtk_widget_create_pango_layout(widget, text);
  pango_layout_get_pixel_size(layout, &width, NULL);
  gtk_render_layout(gtk_widget_get_style_context(widget), cr, fmax(0, x - align * width), y, layout);
  cairo_new_path(cr); /* the text leaves a current point, from which a line would begin */
}
