/* The histogram of a quality: bars in the colours of the scale. */
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
  double high;
  char *title, *marks[3]; /* title NULL: nothing to show; marks: at the ends and in the middle of the scale */
};

G_DEFINE_FINAL_TYPE(SporeHistogram, spore_histogram, GTK_TYPE_DRAWING_AREA)

/* align: 0: the text begins at x; 0.5: it is centred at x; 1: it ends at x. A text that would reach beyond `free_until`
 * is left out. Returns where the text begins. */
static double draw_text(GtkWidget *widget, cairo_t *cr, double x, double y, double align, const char *text,
                        double free_until) {
  int width;
  g_autoptr(PangoLayout) layout = gtk_widget_create_pango_layout(widget, text);
  pango_layout_get_pixel_size(layout, &width, NULL);
  double begin = x - align * width;
  if (begin + width > free_until) return free_until;
  gtk_render_layout(gtk_widget_get_style_context(widget), cr, begin, y, layout);
  return begin;
}

static double place_of(const SporeHistogram *self, double value) { return CLAMP(value / self->high, 0, 1); }

/* The axis from its end, which has the unit, to its beginning. */
static void draw_marks(SporeHistogram *self, cairo_t *cr, double left, double width, double y) {
  double free_until = left + width;
  for (int i = 2; i >= 0; i--) {
    double begin = draw_text(GTK_WIDGET(self), cr, left + 0.5 * i * width, y, 0.5 * i, self->marks[i], free_until);
    free_until = begin - MARGIN;
  }
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
  draw_text(widget, cr, left, 2, 0, self->title, width);
  draw_marks(self, cr, left, across, top + up + 3);
  if (up <= 0 || across <= BINS) return FALSE;
  draw_bars(self, cr, left, top, across, up);
  draw_frame(self, cr, left, top, across, up);
  return FALSE;
}

static void describe(SporeHistogram *self, const SporeQuality *quality) {
  g_autofree char *mean = quality ? spore_quality_figure(quality, self->mean) : NULL;
  g_autofree char *most = quality ? spore_quality_figure(quality, spore_quality_quantile(quality, 0.95)) : NULL;
  g_autofree char *text =
      quality ? g_strdup_printf(_("Histogram of %s: mean %s, 95 %% below %s\nThe tallest bar has %.2g %%"),
                                quality->label, mean, most, 100 * self->largest)
              : g_strdup(_("Histogram: nothing to show yet"));
  atk_object_set_name(gtk_widget_get_accessible(GTK_WIDGET(self)), text);
  gtk_widget_set_tooltip_text(GTK_WIDGET(self), text);
}

static void clear_texts(SporeHistogram *self) {
  g_clear_pointer(&self->title, g_free);
  for (int i = 0; i < 3; i++) g_clear_pointer(&self->marks[i], g_free);
}

static void set_texts(SporeHistogram *self, const SporeQuality *quality) {
  g_autofree char *mean = spore_quality_figure(quality, self->mean);
  g_autofree char *high = spore_quality_figure(quality, self->high);
  self->title = g_strdup_printf(_("Mean %s"), mean);
  self->marks[0] = g_strdup("0");
  self->marks[1] = g_strdup_printf("%.3g", 0.5 * self->high);
  self->marks[2] = g_strconcat(spore_quality_goes_beyond(quality) ? "≥ " : "", high, NULL);
}

void spore_histogram_set_quality(SporeHistogram *self, const SporeQuality *quality) {
  if (quality && !quality->count) quality = NULL;
  clear_texts(self);
  for (int i = 0; i < BINS; i++) self->share[i] = 0;
  if (quality) {
    double whole = 0;
    self->mean = spore_quality_mean(quality);
    self->high = quality->high;
    set_texts(self, quality);
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
  clear_texts(SPORE_HISTOGRAM(object));
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
