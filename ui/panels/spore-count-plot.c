/* The plot of the error against the number of elements, both logarithmic. */
#include "ui/panels/spore-count-plot.h"

#include <glib/gi18n.h>
#include <math.h>

#include "ui/panels/plot-text.h"

#define EXACT_PERCENT 1e-6 /* smaller errors are rounding: the result has as many elements as its source */
#define MOST_POINTS 16
#define LEFT 54
#define RIGHT 12
#define TOP 22
#define BOTTOM 36 /* numbers, and the name of what they count */
#define LINE 15
#define NEAR_PIXELS 14

struct _SporeCountPlot {
  GtkDrawingArea parent;
  gsize count, chosen; /* chosen: by the keyboard */
  size_t counts[MOST_POINTS], enough, current;
  double errors[MOST_POINTS];
  size_t least, most; /* ends of the axis */
  const char *label, *count_label;
};

G_DEFINE_FINAL_TYPE(SporeCountPlot, spore_count_plot, GTK_TYPE_DRAWING_AREA)

enum { COUNT_CHOSEN, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

/* Frame in pixels, and the logarithms at its ends. */
typedef struct {
  double left, top, width, height, low_x, high_x, low_y, high_y;
} Frame;

static Frame frame_of(SporeCountPlot *self) {
  Frame frame = {.left = LEFT,
                 .top = TOP,
                 .width = gtk_widget_get_allocated_width(GTK_WIDGET(self)) - LEFT - RIGHT,
                 .height = gtk_widget_get_allocated_height(GTK_WIDGET(self)) - TOP - BOTTOM,
                 .low_x = log((double)self->least),
                 .high_x = log((double)self->most),
                 .low_y = HUGE_VAL,
                 .high_y = -HUGE_VAL};
  for (gsize i = 0; i < self->count; i++) {
    frame.low_y = MIN(frame.low_y, log(self->errors[i]));
    frame.high_y = MAX(frame.high_y, log(self->errors[i]));
  }
  frame.low_y -= 0.2;
  frame.high_y += 0.2;
  return frame;
}

static double x_of(const Frame *f, size_t count) {
  return f->left + f->width * (log((double)count) - f->low_x) / (f->high_x - f->low_x);
}

static double y_of(const Frame *f, double error) {
  return f->top + f->height * (f->high_y - log(error)) / (f->high_y - f->low_y);
}

/* Wraps the text to the width of the widget. */
static void draw_invitation(GtkWidget *widget, cairo_t *cr, const char *text) {
  g_autoptr(PangoLayout) layout = gtk_widget_create_pango_layout(widget, text);
  pango_layout_set_width(layout, (gtk_widget_get_allocated_width(widget) - 2 * RIGHT) * PANGO_SCALE);
  pango_layout_set_wrap(layout, PANGO_WRAP_WORD);
  gtk_render_layout(gtk_widget_get_style_context(widget), cr, RIGHT, TOP, layout);
}

static void draw_axes(SporeCountPlot *self, cairo_t *cr, const Frame *f) {
  GtkWidget *widget = GTK_WIDGET(self);
  cairo_rectangle(cr, f->left + 0.5, f->top + 0.5, f->width, f->height);
  cairo_set_line_width(cr, 1);
  cairo_stroke(cr);
  double free_from = 0; /* numbers that would touch the one before are left out */
  for (gsize i = 0; i < self->count; i++) {
    g_autofree char *number = g_strdup_printf("%zu", self->counts[i]);
    double x = x_of(f, self->counts[i]), half = 0.5 * spore_plot_text_width(widget, number);
    if (x - half < free_from) continue;
    spore_plot_text_draw(widget, cr, fmin(x, gtk_widget_get_allocated_width(widget) - half), f->top + f->height + 2,
                         0.5, number);
    free_from = x + half + 6;
  }
  g_autofree char *high = g_strdup_printf("%.2g %%", exp(f->high_y)), *low = g_strdup_printf("%.2g %%", exp(f->low_y));
  spore_plot_text_draw(widget, cr, f->left - 4, f->top - 4, 1, high);
  spore_plot_text_draw(widget, cr, f->left - 4, f->top + f->height - 12, 1, low);
  spore_plot_text_draw(widget, cr, f->left, 1, 0, self->label);
  spore_plot_text_draw(widget, cr, f->left + f->width, f->top + f->height + 2 + LINE, 1, self->count_label);
}

static void draw_line_at(cairo_t *cr, const Frame *f, size_t count, gboolean dashed) {
  double x = x_of(f, count);
  if (x < f->left || x > f->left + f->width) return;
  cairo_save(cr);
  if (dashed) cairo_set_dash(cr, (double[]){4, 3}, 2, 0);
  cairo_move_to(cr, x, f->top);
  cairo_line_to(cr, x, f->top + f->height);
  cairo_stroke(cr);
  cairo_restore(cr);
}

static void draw_points(SporeCountPlot *self, cairo_t *cr, const Frame *f) {
  for (gsize i = 0; i < self->count; i++) cairo_line_to(cr, x_of(f, self->counts[i]), y_of(f, self->errors[i]));
  cairo_set_line_width(cr, 2);
  cairo_stroke(cr);
  for (gsize i = 0; i < self->count; i++) {
    gboolean marked = i == self->chosen && gtk_widget_has_focus(GTK_WIDGET(self));
    cairo_arc(cr, x_of(f, self->counts[i]), y_of(f, self->errors[i]), marked ? 6.5 : 4, 0, 2 * G_PI);
    cairo_fill(cr);
  }
}

static GdkRGBA between(const GdkRGBA *a, const GdkRGBA *b) {
  return (GdkRGBA){0.5 * (a->red + b->red), 0.5 * (a->green + b->green), 0.5 * (a->blue + b->blue), 1};
}

static gboolean draw(GtkWidget *widget, cairo_t *cr) {
  SporeCountPlot *self = SPORE_COUNT_PLOT(widget);
  GtkStyleContext *style = gtk_widget_get_style_context(widget);
  GdkRGBA text, accent;
  gtk_style_context_get_color(style, gtk_style_context_get_state(style), &text);
  if (!gtk_style_context_lookup_color(style, "theme_selected_bg_color", &accent)) accent = text;
  if (text.red + text.green + text.blue > 1.5) accent = between(&accent, &text); /* on a dark ground it is too dark */
  if (!self->count) {
    draw_invitation(widget, cr, _("Measure what other numbers give"));
    return FALSE;
  }
  Frame f = frame_of(self);
  gdk_cairo_set_source_rgba(cr, &text);
  draw_axes(self, cr, &f);
  if (self->current) draw_line_at(cr, &f, self->current, FALSE);
  if (self->enough) {
    draw_line_at(cr, &f, self->enough, TRUE);
    double x = x_of(&f, self->enough) - 5; /* the error falls, so there is room below, before the mark, or nowhere */
    if (spore_plot_text_width(widget, _("more stop paying")) < x - f.left - 5)
      spore_plot_text_draw(widget, cr, x, f.top + f.height - 20, 1, _("more stop paying"));
  }
  gdk_cairo_set_source_rgba(cr, &accent);
  draw_points(self, cr, &f);
  if (gtk_widget_has_visible_focus(widget))
    gtk_render_focus(style, cr, 0, 0, gtk_widget_get_allocated_width(widget), gtk_widget_get_allocated_height(widget));
  return FALSE;
}

/* Choosing. */

static void choose(SporeCountPlot *self, size_t count) { g_signal_emit(self, signals[COUNT_CHOSEN], 0, (guint)count); }

static gboolean pressed(GtkWidget *widget, GdkEventButton *event) {
  SporeCountPlot *self = SPORE_COUNT_PLOT(widget);
  Frame f = frame_of(self);
  gtk_widget_grab_focus(widget);
  if (event->button != GDK_BUTTON_PRIMARY || event->type != GDK_BUTTON_PRESS || !self->count)
    return GDK_EVENT_PROPAGATE;
  for (gsize i = 0; i < self->count; i++)
    if (fabs(x_of(&f, self->counts[i]) - event->x) < NEAR_PIXELS) {
      self->chosen = i;
      choose(self, self->counts[i]);
      return GDK_EVENT_STOP;
    }
  double part = CLAMP((event->x - f.left) / f.width, 0, 1);
  choose(self, (size_t)lround(exp(f.low_x + part * (f.high_x - f.low_x))));
  return GDK_EVENT_STOP;
}

static gboolean key_pressed(GtkWidget *widget, GdkEventKey *event) {
  SporeCountPlot *self = SPORE_COUNT_PLOT(widget);
  if (!self->count) return GTK_WIDGET_CLASS(spore_count_plot_parent_class)->key_press_event(widget, event);
  if (event->keyval == GDK_KEY_Left && self->chosen > 0) self->chosen--;
  else if (event->keyval == GDK_KEY_Right && self->chosen + 1 < self->count) self->chosen++;
  else if (event->keyval == GDK_KEY_Return || event->keyval == GDK_KEY_space) choose(self, self->counts[self->chosen]);
  else return GTK_WIDGET_CLASS(spore_count_plot_parent_class)->key_press_event(widget, event);
  gtk_widget_queue_draw(widget);
  return GDK_EVENT_STOP;
}

static void describe(SporeCountPlot *self) {
  GString *text = g_string_new(_("Error against number:"));
  for (gsize i = 0; i < self->count; i++)
    g_string_append_printf(text, " %zu: %.2g %%;", self->counts[i], self->errors[i]);
  if (self->enough) {
    g_string_append_c(text, ' ');
    g_string_append_printf(text, _("more than %zu stop paying"), self->enough);
  }
  atk_object_set_name(gtk_widget_get_accessible(GTK_WIDGET(self)), text->str);
  g_string_append_printf(text, "\n%s", _("Click to take a number; Left, Right and Enter do it with the keyboard"));
  gtk_widget_set_tooltip_text(GTK_WIDGET(self), text->str);
  g_string_free(text, TRUE);
}

void spore_count_plot_set_points(SporeCountPlot *self, const size_t *counts, const double *errors, gsize count,
                                 size_t enough) {
  self->count = 0;
  for (gsize i = 0; i < count && self->count < MOST_POINTS; i++) {
    if (!(errors[i] > EXACT_PERCENT)) continue; /* its logarithm would leave no room for the other points */
    self->counts[self->count] = counts[i];
    self->errors[self->count++] = errors[i];
  }
  self->enough = enough;
  self->chosen = MIN(self->chosen, self->count ? self->count - 1 : 0);
  describe(self);
  gtk_widget_queue_draw(GTK_WIDGET(self));
}

void spore_count_plot_set_axes(SporeCountPlot *self, size_t least, size_t most, const char *label,
                               const char *count_label) {
  self->least = least;
  self->most = most;
  self->label = label;
  self->count_label = count_label;
  gtk_widget_queue_draw(GTK_WIDGET(self));
}

void spore_count_plot_set_current(SporeCountPlot *self, size_t count) {
  self->current = count;
  gtk_widget_queue_draw(GTK_WIDGET(self));
}

static void spore_count_plot_class_init(SporeCountPlotClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  widget->draw = draw;
  widget->button_press_event = pressed;
  widget->key_press_event = key_pressed;
  signals[COUNT_CHOSEN] = g_signal_new("count-chosen", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL,
                                       G_TYPE_NONE, 1, G_TYPE_UINT);
}

static void spore_count_plot_init(SporeCountPlot *self) {
  gtk_widget_set_size_request(GTK_WIDGET(self), 150, 110);
  gtk_widget_set_can_focus(GTK_WIDGET(self), TRUE);
  gtk_widget_add_events(GTK_WIDGET(self), GDK_BUTTON_PRESS_MASK | GDK_KEY_PRESS_MASK);
  describe(self);
}
