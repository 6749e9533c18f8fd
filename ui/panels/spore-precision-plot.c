/* Draws the work-precision plot, and tells which point is meant. */
#include "ui/panels/spore-precision-plot.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/author/accuracy_page.h"
#include "core/author/accuracy_study.h"
#include "core/measure/plot_axis.h"
#include "ui/panels/plot-text.h"

/* Pixels. */
#define LEFT 54
#define RIGHT 12
#define BOTTOM 36
#define LINE 16
#define SAMPLE 26 /* of a line, in the legend */
#define LEGEND_GAP 12
#define LEAST_PANEL 260 /* two panels stand side by side where each is as wide */
#define RADIUS 3.5
#define NEAR 11 /* of the pointer to a point */
#define PANELS G_N_ELEMENTS(((SporeAccuracyPlot *)NULL)->panels)

struct _SporePrecisionPlot {
  GtkDrawingArea parent;
  const SporeAccuracyReport *report; /* NULL: none */
  SporeAccuracyPlot plot;            /* of the report */
  gssize selected, current;
};

G_DEFINE_FINAL_TYPE(SporePrecisionPlot, spore_precision_plot, GTK_TYPE_DRAWING_AREA)

enum { POINT_SELECTED, POINT_ACTIVATED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

char *spore_precision_plot_describe(const SporeAccuracyReport *report, gssize index) {
  const SporeAccuracyPoint *point = &report->points[index];
  g_autofree char *name = spore_accuracy_point_name(report, point);
  g_autofree char *figures = spore_accuracy_point_figures(report, point);
  const char *remark = spore_accuracy_remark(point);
  g_autofree char *pace = g_strdup_printf(_("%.3g times real time"), point->real_time_factor);
  return point->stable && *remark ? g_strdup_printf(_("%s: %s, %s; %s"), name, figures, pace, remark)
                                  : g_strdup_printf(_("%s: %s, %s"), name, figures, pace);
}

/* Layout. */

/* A panel as it stands in the widget. */
typedef struct {
  const SporePlotPanel *panel;
  SporePlotAxis x, y;
} View;

/* The names of the lines below the panels, in as many rows as it takes. Draws where cr is not NULL, from y on. Returns
 * the height. */
static double lay_legend(SporePrecisionPlot *self, cairo_t *cr, double y);

/* Fills in the views. Returns their number. */
static gsize lay_out(SporePrecisionPlot *self, View views[PANELS]) {
  double width = gtk_widget_get_allocated_width(GTK_WIDGET(self));
  double height = gtk_widget_get_allocated_height(GTK_WIDGET(self)) - lay_legend(self, NULL, 0), top = LINE + 4;
  gsize count = width >= PANELS * LEAST_PANEL ? PANELS : 1, shown = 0;
  for (gsize p = PANELS - count; p < PANELS; p++) {
    double left = width * (double)shown / (double)count;
    const SporePlotPanel *panel = &self->plot.panels[p];
    View *view = &views[shown];
    *view = (View){panel,
                   {.from = left + LEFT, .to = left + width / (double)count - RIGHT, .logarithmic = panel->log_x},
                   {.from = height - BOTTOM, .to = top, .logarithmic = panel->log_y}};
    if (!spore_plot_axis_fit(&view->x, panel, false) || !spore_plot_axis_fit(&view->y, panel, true)) continue;
    if (view->x.to > view->x.from && view->y.from > view->y.to) shown++;
  }
  return shown;
}

/* FALSE: the point has no place. */
static gboolean place(const View *view, const SporePlotLine *line, gsize i, double *x, double *y) {
  if (!spore_plot_axis_shows(&view->x, line->x[i]) || !spore_plot_axis_shows(&view->y, line->y[i])) return FALSE;
  *x = spore_plot_axis_place(&view->x, line->x[i]);
  *y = spore_plot_axis_place(&view->y, line->y[i]);
  return TRUE;
}

/* The point nearest to a place in the widget; -1: none is near. */
static gssize find_point(SporePrecisionPlot *self, double at_x, double at_y) {
  View views[PANELS];
  gssize found = -1;
  double nearest = NEAR, x, y;
  for (gsize v = 0, count = self->report ? lay_out(self, views) : 0; v < count; v++)
    for (gsize l = 0; l < views[v].panel->line_count; l++)
      for (gsize i = 0; i < views[v].panel->lines[l].count; i++) {
        if (!place(&views[v], &views[v].panel->lines[l], i, &x, &y) || hypot(x - at_x, y - at_y) >= nearest) continue;
        nearest = hypot(x - at_x, y - at_y);
        found = (gssize)(self->plot.first[l] + i);
      }
  return found;
}

/* Drawing. */

static void set_faint(cairo_t *cr, const GdkRGBA *colour, double alpha) {
  cairo_set_source_rgba(cr, colour->red, colour->green, colour->blue, alpha);
}

static void set_colour(cairo_t *cr, gsize line) {
  GdkRGBA colour;
  gdk_rgba_parse(&colour, spore_plot_colours[line % SPORE_PLOT_COLOURS]);
  gdk_cairo_set_source_rgba(cr, &colour);
}

static void draw_marker(cairo_t *cr, gsize line, double x, double y, gboolean hollow) {
  const SporePlotStyle *style = &spore_plot_styles[line % SPORE_PLOT_COLOURS];
  if (style->corner_count == 0) cairo_arc(cr, x, y, RADIUS, 0, 2 * G_PI);
  for (gsize i = 0; i < style->corner_count; i++)
    cairo_line_to(cr, x + RADIUS * style->corner[i][0], y + RADIUS * style->corner[i][1]);
  cairo_close_path(cr);
  set_colour(cr, line);
  cairo_set_line_width(cr, 1.3);
  if (!hollow) cairo_fill_preserve(cr);
  cairo_stroke(cr);
}

static void set_line(cairo_t *cr, gsize line) {
  const SporePlotStyle *style = &spore_plot_styles[line % SPORE_PLOT_COLOURS];
  set_colour(cr, line);
  cairo_set_line_width(cr, 1.8);
  cairo_set_dash(cr, style->dash, (int)style->dash_count, 0);
}

static double lay_legend(SporePrecisionPlot *self, cairo_t *cr, double y) {
  GtkWidget *widget = GTK_WIDGET(self);
  const SporePlotPanel *panel = &self->plot.panels[0];
  double right = gtk_widget_get_allocated_width(widget) - RIGHT, x = RIGHT, top = y;
  for (gsize l = 0; l < panel->line_count; l++) {
    double width = SAMPLE + 4 + spore_plot_text_width(widget, panel->lines[l].label);
    if (x + width > right && x > RIGHT) {
      x = RIGHT;
      y += LINE;
    }
    if (cr) {
      set_line(cr, l);
      cairo_move_to(cr, x, y + 9);
      cairo_line_to(cr, x + SAMPLE, y + 9);
      cairo_stroke(cr);
      cairo_set_dash(cr, NULL, 0, 0);
      draw_marker(cr, l, x + SAMPLE / 2., y + 9, FALSE);
      spore_plot_text_draw(widget, cr, x + SAMPLE + 4, y, 0, panel->lines[l].label);
    }
    x += width + LEGEND_GAP;
  }
  return y + LINE - top;
}

static void draw_shade(GtkWidget *widget, cairo_t *cr, const View *view, const GdkRGBA *text) {
  const SporePlotPanel *panel = view->panel;
  if (!(panel->shade_below > view->y.low)) return;
  double top = panel->shade_below < view->y.high ? spore_plot_axis_place(&view->y, panel->shade_below) : view->y.to;
  set_faint(cr, text, 0.14);
  cairo_rectangle(cr, view->x.from, top, view->x.to - view->x.from, view->y.from - top);
  cairo_fill(cr);
  spore_plot_text_draw(widget, cr, view->x.from + 5, view->y.from - 18, 0, panel->shade_label);
}

static void draw_grid(GtkWidget *widget, cairo_t *cr, const View *view, const GdkRGBA *text) {
  double last = -HUGE_VAL;
  cairo_set_line_width(cr, 1);
  for (gsize i = 0; i < view->x.ticks; i++) {
    double x = floor(spore_plot_axis_place(&view->x, view->x.tick[i])) + 0.5;
    g_autofree char *number = g_strdup_printf("%g", view->x.tick[i]);
    set_faint(cr, text, 0.18);
    cairo_move_to(cr, x, view->y.from);
    cairo_line_to(cr, x, view->y.to);
    cairo_stroke(cr);
    double half = 0.5 * spore_plot_text_width(widget, number);
    if (x - half < last + 6) continue;
    spore_plot_text_draw(widget, cr, x, view->y.from + 1, 0.5, number);
    last = x + half;
  }
  last = HUGE_VAL;
  for (gsize i = 0; i < view->y.ticks; i++) {
    double y = floor(spore_plot_axis_place(&view->y, view->y.tick[i])) + 0.5;
    g_autofree char *number = g_strdup_printf("%g", view->y.tick[i]);
    set_faint(cr, text, 0.18);
    cairo_move_to(cr, view->x.from, y);
    cairo_line_to(cr, view->x.to, y);
    cairo_stroke(cr);
    if (last - y < LINE) continue;
    spore_plot_text_draw(widget, cr, view->x.from - 5, (last = y) - 8, 1, number);
  }
}

static void draw_axes(GtkWidget *widget, cairo_t *cr, const View *view, gboolean first, const GdkRGBA *text) {
  draw_grid(widget, cr, view, text);
  set_faint(cr, text, 0.6);
  cairo_rectangle(cr, floor(view->x.from) + 0.5, floor(view->y.to) + 0.5, floor(view->x.to - view->x.from),
                  floor(view->y.from - view->y.to));
  cairo_stroke(cr);
  double half = 0.5 * spore_plot_text_width(widget, view->panel->x_label);
  double middle = fmin(0.5 * (view->x.from + view->x.to), view->x.to + RIGHT - 2 - half);
  spore_plot_text_draw(widget, cr, middle, view->y.from + LINE, 0.5, view->panel->x_label);
  if (first) spore_plot_text_draw(widget, cr, 4, view->y.to - LINE - 3, 0, view->panel->y_label);
}

/* A vertical line, with what it says on the side that has room. */
static void draw_mark(GtkWidget *widget, cairo_t *cr, const View *view, const GdkRGBA *text) {
  const SporePlotPanel *panel = view->panel;
  if (!panel->mark_label || panel->mark_x < view->x.low || panel->mark_x > view->x.high) return;
  double x = spore_plot_axis_place(&view->x, panel->mark_x);
  gboolean right = x < 0.5 * (view->x.from + view->x.to);
  set_faint(cr, text, 0.7);
  cairo_set_dash(cr, (double[]){5, 4}, 2, 0);
  cairo_move_to(cr, x, view->y.from);
  cairo_line_to(cr, x, view->y.to);
  cairo_stroke(cr);
  cairo_set_dash(cr, NULL, 0, 0);
  spore_plot_text_draw(widget, cr, x + (right ? 5 : -5), view->y.to + 1, right ? 0 : 1, panel->mark_label);
}

static void draw_line(cairo_t *cr, const View *view, gsize l) {
  const SporePlotLine *line = &view->panel->lines[l];
  double x, y;
  set_line(cr, l);
  for (gsize i = 0; i < line->count; i++)
    if (place(view, line, i, &x, &y)) cairo_line_to(cr, x, y);
  cairo_stroke(cr);
  cairo_set_dash(cr, NULL, 0, 0);
}

static void draw_ring(cairo_t *cr, double x, double y, double radius, double width) {
  cairo_arc(cr, x, y, radius, 0, 2 * G_PI);
  cairo_set_line_width(cr, width);
  cairo_stroke(cr);
}

static void draw_points(SporePrecisionPlot *self, cairo_t *cr, const View *view, gsize l, const GdkRGBA *text,
                        const GdkRGBA *accent) {
  const SporePlotLine *line = &view->panel->lines[l];
  double x, y;
  for (gsize i = 0; i < line->count; i++) {
    gssize point = (gssize)(self->plot.first[l] + i);
    if (!place(view, line, i, &x, &y)) continue;
    if (point == self->selected) {
      gdk_cairo_set_source_rgba(cr, accent);
      draw_ring(cr, x, y, 9.5, 3);
    }
    draw_marker(cr, l, x, y, line->hollow[i]);
    gdk_cairo_set_source_rgba(cr, text);
    if (line->ringed[i]) draw_ring(cr, x, y, 6.5, 1.3);
    if (point != self->current) continue;
    cairo_set_line_width(cr, 1.6);
    cairo_move_to(cr, x - 10, y), cairo_line_to(cr, x + 10, y);
    cairo_move_to(cr, x, y - 10), cairo_line_to(cr, x, y + 10);
    cairo_stroke(cr);
  }
}

static gboolean draw(GtkWidget *widget, cairo_t *cr) {
  SporePrecisionPlot *self = SPORE_PRECISION_PLOT(widget);
  GtkStyleContext *style = gtk_widget_get_style_context(widget);
  GdkRGBA text, accent;
  View views[PANELS];
  if (!self->report) return FALSE;
  gtk_style_context_get_color(style, gtk_style_context_get_state(style), &text);
  if (!gtk_style_context_lookup_color(style, "theme_selected_bg_color", &accent)) accent = text;
  lay_legend(self, cr, gtk_widget_get_allocated_height(widget) - lay_legend(self, NULL, 0));
  for (gsize v = 0, count = lay_out(self, views); v < count; v++) {
    draw_shade(widget, cr, &views[v], &text);
    draw_axes(widget, cr, &views[v], v == 0, &text);
    draw_mark(widget, cr, &views[v], &text);
    for (gsize l = 0; l < views[v].panel->line_count; l++) draw_line(cr, &views[v], l);
    for (gsize l = 0; l < views[v].panel->line_count; l++) draw_points(self, cr, &views[v], l, &text, &accent);
  }
  if (gtk_widget_has_visible_focus(widget))
    gtk_render_focus(style, cr, 0, 0, gtk_widget_get_allocated_width(widget), gtk_widget_get_allocated_height(widget));
  return FALSE;
}

/* Choosing. */

static gboolean pressed(GtkWidget *widget, GdkEventButton *event) {
  SporePrecisionPlot *self = SPORE_PRECISION_PLOT(widget);
  gssize found = find_point(self, event->x, event->y);
  gtk_widget_grab_focus(widget);
  if (event->button != GDK_BUTTON_PRIMARY || found < 0) return GDK_EVENT_PROPAGATE;
  if (event->type == GDK_BUTTON_PRESS) spore_precision_plot_select(self, found);
  if (event->type == GDK_2BUTTON_PRESS) g_signal_emit(self, signals[POINT_ACTIVATED], 0);
  return GDK_EVENT_STOP;
}

static gboolean key_pressed(GtkWidget *widget, GdkEventKey *event) {
  SporePrecisionPlot *self = SPORE_PRECISION_PLOT(widget);
  gssize count = self->report ? (gssize)self->report->point_count : 0;
  gboolean back = event->keyval == GDK_KEY_Left || event->keyval == GDK_KEY_Up,
           on = event->keyval == GDK_KEY_Right || event->keyval == GDK_KEY_Down;
  if (count > 0 && (back || on)) {
    gssize from = self->selected < 0 && back ? count : self->selected;
    spore_precision_plot_select(self, CLAMP(from + (on ? 1 : -1), 0, count - 1));
    return GDK_EVENT_STOP;
  }
  if (self->selected >= 0 && (event->keyval == GDK_KEY_Return || event->keyval == GDK_KEY_KP_Enter)) {
    g_signal_emit(self, signals[POINT_ACTIVATED], 0);
    return GDK_EVENT_STOP;
  }
  return GTK_WIDGET_CLASS(spore_precision_plot_parent_class)->key_press_event(widget, event);
}

static gboolean query_tooltip(GtkWidget *widget, int x, int y, gboolean keyboard, GtkTooltip *tooltip) {
  SporePrecisionPlot *self = SPORE_PRECISION_PLOT(widget);
  gssize found = keyboard ? self->selected : find_point(self, x, y);
  if (!self->report || found < 0) return FALSE;
  g_autofree char *text = spore_precision_plot_describe(self->report, found);
  gtk_tooltip_set_text(tooltip, text);
  return TRUE;
}

static void describe(SporePrecisionPlot *self) {
  g_autofree char *point = self->selected < 0 ? NULL : spore_precision_plot_describe(self->report, self->selected);
  AtkObject *accessible = gtk_widget_get_accessible(GTK_WIDGET(self));
  atk_object_set_name(accessible, _("Work-precision plot"));
  atk_object_set_description(accessible, point ? point : "");
}

void spore_precision_plot_set_report(SporePrecisionPlot *self, const SporeAccuracyReport *report) {
  spore_accuracy_plot_clear(&self->plot);
  self->report = report && spore_accuracy_plot_make(&self->plot, report, NULL) ? report : NULL;
  self->selected = self->current = -1;
  describe(self);
  gtk_widget_queue_draw(GTK_WIDGET(self));
}

gssize spore_precision_plot_get_selected(SporePrecisionPlot *self) { return self->selected; }

void spore_precision_plot_select(SporePrecisionPlot *self, gssize point) {
  gssize count = self->report ? (gssize)self->report->point_count : 0;
  if (point >= count || point == self->selected) return;
  self->selected = point;
  describe(self);
  gtk_widget_queue_draw(GTK_WIDGET(self));
  g_signal_emit(self, signals[POINT_SELECTED], 0);
}

void spore_precision_plot_set_current(SporePrecisionPlot *self, gssize point) {
  self->current = point;
  gtk_widget_queue_draw(GTK_WIDGET(self));
}

static void spore_precision_plot_finalize(GObject *object) {
  spore_accuracy_plot_clear(&SPORE_PRECISION_PLOT(object)->plot);
  G_OBJECT_CLASS(spore_precision_plot_parent_class)->finalize(object);
}

static void spore_precision_plot_class_init(SporePrecisionPlotClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  GType type = G_TYPE_FROM_CLASS(class);
  G_OBJECT_CLASS(class)->finalize = spore_precision_plot_finalize;
  widget->draw = draw;
  widget->button_press_event = pressed;
  widget->key_press_event = key_pressed;
  widget->query_tooltip = query_tooltip;
  signals[POINT_SELECTED] =
      g_signal_new("point-selected", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
  signals[POINT_ACTIVATED] =
      g_signal_new("point-activated", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
}

static void spore_precision_plot_init(SporePrecisionPlot *self) {
  self->selected = self->current = -1;
  gtk_widget_set_size_request(GTK_WIDGET(self), 200, 210);
  gtk_widget_set_can_focus(GTK_WIDGET(self), TRUE);
  gtk_widget_set_has_tooltip(GTK_WIDGET(self), TRUE);
  gtk_widget_add_events(GTK_WIDGET(self), GDK_BUTTON_PRESS_MASK | GDK_KEY_PRESS_MASK | GDK_POINTER_MOTION_MASK);
  describe(self);
}
