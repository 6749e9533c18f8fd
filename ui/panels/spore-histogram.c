#include "ui/panels/spore-histogram.h"

#include <glib/gi18n.h>
#include <math.h>

#include "ui/render/colour_scale.h"

#define BINS 24
#define MARGIN 8
#define LINE 16 /* of text, pixels */

struct _SporeHistogram {
  GtkDrawingArea parent;
  double share[BINS], largest, mean; /* share: of the weight; the last bin has what lies beyond the scale too */
  double low, high;
  char *title, *unit; /* title NULL: nothing to show */
};

G_DEFINE_FINAL_TYPE(SporeHistogram, spore_histogram, GTK_TYPE_DRAWING_AREA)

/* Returns its width. */
static int draw_text(GtkWidget *widget, cairo_t *cr, double x, double y, double align, const char *text) {
  int width, height;
  g_autoptr(PangoLayout) layout = gtk_widget_create_pango_layout(widget, text);
  pango_layout_get_pixel_size(layout, &width, &height);
  gtk_render_layout(gtk_widget_get_style_context(widget), cr, x - align * width, y, layout);
  return width;
}

static double place_of(const SporeHistogram *self, double value) {
  return CLAMP((value - self->low) / (self->high - self->low), 0, 1);
}

static void draw_bars(const SporeHistogram *self, cairo_t *cr, double left, double top, double width, double height) {
  for (int i = 0; i < BINS; i++) {
    double colour[3], bar = height * self->share[i] / self->largest;
    spore_colour_scale((i + 0.5) / BINS, colour);
    cairo_set_source_rgb(cr, colour[0], colour[1], colour[2]);
    cairo_rectangle(cr, left + width * i / BINS + 0.5, top + height - bar, width / BINS - 1, bar);
    cairo_fill(cr);
  }
}

/* A line in the colour of the text, so that dark bars have an edge in a dark theme. */
static void draw_frame(SporeHistogram *self, cairo_t *cr, double left, double top, double width, double height) {
  GdkRGBA colour;
  GtkStyleContext *style = gtk_widget_get_style_context(GTK_WIDGET(self));
  gtk_style_context_get_color(style, gtk_style_context_get_state(style), &colour);
  gdk_cairo_set_source_rgba(cr, &colour);
  cairo_set_line_width(cr, 1);
  cairo_move_to(cr, left, top + height + 0.5);
  cairo_line_to(cr, left + width, top + height + 0.5);
  for (int i = 0; i < BINS; i++) {
    double y = top + height - height * self->share[i] / self->largest;
    cairo_move_to(cr, left + width * i / BINS + 0.5, y);
    cairo_line_to(cr, left + width * (i + 1) / BINS - 0.5, y);
  }
  cairo_stroke(cr);
  double x = left + width * place_of(self, self->mean);
  cairo_set_dash(cr, (double[]){3, 3}, 2, 0);
  cairo_move_to(cr, x, top);
  cairo_line_to(cr, x, top + height);
  cairo_stroke(cr);
}

static gboolean draw(GtkWidget *widget, cairo_t *cr) {
  SporeHistogram *self = SPORE_HISTOGRAM(widget);
  double width = gtk_widget_get_allocated_width(widget), height = gtk_widget_get_allocated_height(widget);
  if (!self->title) return FALSE;
  double left = MARGIN, top = LINE + MARGIN, across = width - 2 * MARGIN, up = height - top - LINE - MARGIN;
  g_autofree char *title = g_strdup_printf(_("Mean %.3g %s"), self->mean, self->unit);
  g_autofree char *low = g_strdup_printf("%g", self->low);
  g_autofree char *high = g_strdup_printf(_("%g %s and over"), self->high, self->unit);
  draw_text(widget, cr, left, 2, 0, title);
  if (draw_text(widget, cr, left + across, top + up + 3, 1, high) < across - LINE)
    draw_text(widget, cr, left, top + up + 3, 0, low);
  if (up <= 0 || across <= BINS) return FALSE;
  draw_bars(self, cr, left, top, across, up);
  draw_frame(self, cr, left, top, across, up);
  return FALSE;
}

static void describe(SporeHistogram *self, const SporeQuality *quality) {
  g_autofree char *unit = quality && *quality->unit ? g_strconcat(" ", quality->unit, NULL) : g_strdup("");
  g_autofree char *text = quality
                              ? g_strdup_printf(_("Histogram of %s: mean %.3g%s, 95 %% below %.3g%s"), quality->label,
                                                self->mean, unit, spore_quality_quantile(quality, 0.95), unit)
                              : g_strdup(_("Histogram: nothing to show yet"));
  atk_object_set_name(gtk_widget_get_accessible(GTK_WIDGET(self)), text);
  gtk_widget_set_tooltip_text(GTK_WIDGET(self), text);
}

void spore_histogram_set_quality(SporeHistogram *self, const SporeQuality *quality) {
  if (quality && !quality->count) quality = NULL;
  g_clear_pointer(&self->title, g_free);
  g_clear_pointer(&self->unit, g_free);
  for (int i = 0; i < BINS; i++) self->share[i] = 0;
  if (quality) {
    double whole = 0;
    self->title = g_strdup(quality->label);
    self->unit = g_strdup(quality->unit);
    self->mean = spore_quality_mean(quality);
    self->low = quality->low;
    self->high = quality->high;
    for (gsize i = 0; i < quality->count; i++) {
      double weight = quality->weights ? quality->weights[i] : 1;
      self->share[MIN((int)(BINS * spore_quality_place(quality, i)), BINS - 1)] += weight;
      whole += weight;
    }
    self->largest = 0;
    for (int i = 0; i < BINS; i++) {
      self->share[i] /= whole;
      self->largest = MAX(self->largest, self->share[i]);
    }
  }
  describe(self, quality);
  gtk_widget_queue_draw(GTK_WIDGET(self));
}

static void spore_histogram_finalize(GObject *object) {
  SporeHistogram *self = SPORE_HISTOGRAM(object);
  g_free(self->title);
  g_free(self->unit);
  G_OBJECT_CLASS(spore_histogram_parent_class)->finalize(object);
}

static void spore_histogram_class_init(SporeHistogramClass *class) {
  G_OBJECT_CLASS(class)->finalize = spore_histogram_finalize;
  GTK_WIDGET_CLASS(class)->draw = draw;
}

static void spore_histogram_init(SporeHistogram *self) {
  gtk_widget_set_size_request(GTK_WIDGET(self), 150, 110);
  spore_histogram_set_quality(self, NULL);
}
