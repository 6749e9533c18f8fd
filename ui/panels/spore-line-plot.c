/* Draws lines over time, with their axes and their legend. */
#include "ui/panels/spore-line-plot.h"

#include <math.h>

#include "ui/panels/plot-text.h"

#define LEFT 70
#define RIGHT 14
#define BOTTOM 20
#define LEGEND_GAP 14
#define LEGEND_LINE 16
#define SAMPLE 18 /* of a line, in the legend */

struct _SporeLinePlot {
  GtkDrawingArea parent;
  const SporePlotPanel *panel; /* NULL: nothing to show */
  char *invitation;
};

G_DEFINE_FINAL_TYPE(SporeLinePlot, spore_line_plot, GTK_TYPE_DRAWING_AREA)

/* Frame in pixels, and the values at its ends. */
typedef struct {
  double left, top, width, height, low_x, high_x, low_y, high_y;
} Frame;

static void widen(double *low, double *high) {
  if (*high - *low > 1e-12 * fmax(fabs(*low), fabs(*high))) return;
  double by = *high != 0 ? 0.1 * fabs(*high) : 1; /* a constant: a line through the middle */
  *low -= by;
  *high += by;
}

/* top: where the lines begin, below the legend. FALSE: no value can be shown. */
static gboolean fit(SporeLinePlot *self, Frame *frame, double top) {
  *frame = (Frame){.left = LEFT,
                   .top = top,
                   .width = gtk_widget_get_allocated_width(GTK_WIDGET(self)) - LEFT - RIGHT,
                   .height = gtk_widget_get_allocated_height(GTK_WIDGET(self)) - top - BOTTOM,
                   .low_x = HUGE_VAL,
                   .high_x = -HUGE_VAL,
                   .low_y = HUGE_VAL,
                   .high_y = -HUGE_VAL};
  for (gsize l = 0; l < self->panel->line_count; l++)
    for (gsize i = 0; i < self->panel->lines[l].count; i++) {
      double x = self->panel->lines[l].x[i], y = self->panel->lines[l].y[i];
      if (!isfinite(x) || !isfinite(y)) continue;
      frame->low_x = fmin(frame->low_x, x), frame->high_x = fmax(frame->high_x, x);
      frame->low_y = fmin(frame->low_y, y), frame->high_y = fmax(frame->high_y, y);
    }
  if (!(frame->low_x <= frame->high_x)) return FALSE;
  widen(&frame->low_x, &frame->high_x);
  widen(&frame->low_y, &frame->high_y);
  double room = 0.05 * (frame->high_y - frame->low_y);
  frame->low_y -= room;
  frame->high_y += room;
  return frame->width > 0 && frame->height > 0;
}

static double x_of(const Frame *f, double x) { return f->left + f->width * (x - f->low_x) / (f->high_x - f->low_x); }
static double y_of(const Frame *f, double y) { return f->top + f->height * (f->high_y - y) / (f->high_y - f->low_y); }

static void draw_axes(SporeLinePlot *self, cairo_t *cr, const Frame *f, const GdkRGBA *colour) {
  GtkWidget *widget = GTK_WIDGET(self);
  double tick[SPORE_PLOT_TICKS], last = -HUGE_VAL;
  GdkRGBA faint = *colour;
  faint.alpha = 0.18;
  gdk_cairo_set_source_rgba(cr, &faint);
  cairo_set_line_width(cr, 1);
  gsize count = spore_plot_ticks(f->low_x, f->high_x, tick);
  for (gsize i = 0; i < count; i++) {
    double x = floor(x_of(f, tick[i])) + 0.5;
    g_autofree char *number = g_strdup_printf("%.6g", tick[i]);
    cairo_move_to(cr, x, f->top);
    cairo_line_to(cr, x, f->top + f->height);
    cairo_stroke(cr);
    if (x - last < 50) continue;
    spore_plot_text_draw(widget, cr, last = x, f->top + f->height + 2, 0.5, number);
  }
  count = spore_plot_ticks(f->low_y, f->high_y, tick);
  last = HUGE_VAL;
  for (gsize i = 0; i < count; i++) {
    double y = floor(y_of(f, tick[i])) + 0.5;
    g_autofree char *number = g_strdup_printf("%.4g", fabs(tick[i]) < 1e-9 * (f->high_y - f->low_y) ? 0 : tick[i]);
    cairo_move_to(cr, f->left, y);
    cairo_line_to(cr, f->left + f->width, y);
    cairo_stroke(cr);
    if (last - y < 16) continue;
    spore_plot_text_draw(widget, cr, f->left - 5, (last = y) - 8, 1, number);
  }
}

/* Lines that have the colour of an earlier one are dashed. */
static void set_style(cairo_t *cr, gsize line) {
  GdkRGBA colour;
  const double dash = 2 + 3 * (double)(line / SPORE_PLOT_COLOURS);
  gdk_rgba_parse(&colour, spore_plot_colours[line % SPORE_PLOT_COLOURS]);
  gdk_cairo_set_source_rgba(cr, &colour);
  cairo_set_line_width(cr, 1.8);
  cairo_set_dash(cr, &dash, line >= SPORE_PLOT_COLOURS, 0);
}

static void draw_lines(SporeLinePlot *self, cairo_t *cr, const Frame *f) {
  for (gsize l = 0; l < self->panel->line_count; l++) {
    const SporePlotLine *line = &self->panel->lines[l];
    set_style(cr, l);
    gboolean joined = FALSE;
    for (gsize i = 0; i < line->count; i++) {
      gboolean shown = isfinite(line->x[i]) && isfinite(line->y[i]);
      if (shown && joined) cairo_line_to(cr, x_of(f, line->x[i]), y_of(f, line->y[i]));
      else if (shown) cairo_move_to(cr, x_of(f, line->x[i]), y_of(f, line->y[i]));
      joined = shown;
    }
    cairo_stroke(cr);
  }
}

/* What is plotted, and the name of each line, in as many rows as it takes. Draws where cr is not NULL. Returns the
 * height, pixels. */
static double lay_legend(SporeLinePlot *self, cairo_t *cr) {
  GtkWidget *widget = GTK_WIDGET(self);
  const SporePlotPanel *panel = self->panel;
  double right = gtk_widget_get_allocated_width(widget) - RIGHT, x = LEFT, y = 3;
  if (cr) spore_plot_text_draw(widget, cr, x, y, 0, panel->y_label);
  if (cr) spore_plot_text_draw(widget, cr, right, y, 1, panel->x_label);
  x += spore_plot_text_width(widget, panel->y_label) + LEGEND_GAP;
  double end = right - spore_plot_text_width(widget, panel->x_label) - LEGEND_GAP;
  for (gsize l = 0; l < panel->line_count && panel->line_count > 1; l++) {
    double width = SAMPLE + 4 + spore_plot_text_width(widget, panel->lines[l].label);
    if (x + width > end && x > LEFT) {
      x = LEFT;
      y += LEGEND_LINE;
      end = right;
    }
    if (cr) {
      set_style(cr, l);
      cairo_move_to(cr, x, y + 9);
      cairo_line_to(cr, x + SAMPLE, y + 9);
      cairo_stroke(cr);
      spore_plot_text_draw(widget, cr, x + SAMPLE + 4, y, 0, panel->lines[l].label);
    }
    x += width + LEGEND_GAP;
  }
  return y + LEGEND_LINE;
}

static gboolean draw(GtkWidget *widget, cairo_t *cr) {
  SporeLinePlot *self = SPORE_LINE_PLOT(widget);
  GtkStyleContext *style = gtk_widget_get_style_context(widget);
  GdkRGBA text;
  Frame f;
  gtk_style_context_get_color(style, gtk_style_context_get_state(style), &text);
  if (!self->panel || !fit(self, &f, lay_legend(self, NULL) + 4)) {
    spore_plot_text_draw(widget, cr, RIGHT, LEGEND_LINE, 0, self->invitation ? self->invitation : "");
    return FALSE;
  }
  draw_axes(self, cr, &f, &text);
  cairo_save(cr);
  cairo_rectangle(cr, f.left, f.top, f.width, f.height);
  cairo_clip(cr);
  draw_lines(self, cr, &f);
  cairo_restore(cr);
  lay_legend(self, cr);
  return FALSE;
}

void spore_line_plot_set_panel(SporeLinePlot *self, const SporePlotPanel *panel, const char *invitation) {
  self->panel = panel;
  if (g_strcmp0(invitation, self->invitation) != 0) {
    g_free(self->invitation);
    self->invitation = g_strdup(invitation);
  }
  gtk_widget_queue_draw(GTK_WIDGET(self));
}

static void spore_line_plot_finalize(GObject *object) {
  g_free(SPORE_LINE_PLOT(object)->invitation);
  G_OBJECT_CLASS(spore_line_plot_parent_class)->finalize(object);
}

static void spore_line_plot_class_init(SporeLinePlotClass *class) {
  G_OBJECT_CLASS(class)->finalize = spore_line_plot_finalize;
  GTK_WIDGET_CLASS(class)->draw = draw;
}

static void spore_line_plot_init(SporeLinePlot *self) { gtk_widget_set_size_request(GTK_WIDGET(self), 200, 90); }
