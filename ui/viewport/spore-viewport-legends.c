/* Legends of the colours in the picture. They are laid where nothing else lies over it: from the lower right upwards,
 * then further left. Where there is no room for all of them they are set small; the last one says how many still
 * find none. */
#include <glib/gi18n.h>
#include <math.h>

#include "ui/render/colour_scale.h"
#include "ui/render/free_place.h"
#include "ui/render/legend.h"
#include "ui/viewport/spore-viewport-private.h"

#define MARGIN 12        /* to the sides of the view */
#define GAP 8            /* to what lies beside */
#define PADDING 8        /* inside, to the text */
#define BAR_TEXT_GAP 3   /* between the bar and what stands at its ends */
#define KEY_SHARE 0.5    /* of the height of a line that a patch of colour has */
#define SMALL_SHARE 0.8  /* of the size of letters */
#define OTHERS_SHARE 0.4 /* of the width, for how many found no place */
#define MOST 6           /* legends at once */
#define MOST_AROUND 48   /* things that lie over the picture */
/* What is written changes its size from picture to picture; legends beside it do not follow each pixel of that. */
#define AROUND_STEP 32

/* How large legends are. */
typedef struct Size {
  gboolean small;
  double line; /* height of a line of text, pixels */
  double width, bar;
} Size;

typedef struct Legend {
  SporeStageLegend of;
  SporePlace at;
} Legend;

/* Everything that a legend must not lie on. */
typedef struct Around {
  guint count;
  SporePlace at[MOST_AROUND];
} Around;

/* What there is to say. */

/* Whoever does not see the colours reads what they say at the button that shows them. */
static void tell_at(GtkWidget *shower, const SporeStageLegend *legend) {
  AtkObject *button = gtk_widget_get_accessible(shower);
  g_autofree char *text = legend ? spore_stage_legend_text(legend) : g_strdup("");
  if (g_strcmp0(atk_object_get_description(button), text) != 0) atk_object_set_description(button, text);
}

/* The legends of all that is shown; of a candidate, its own alone: it hides the others. Each to be cleared. */
static guint collect(SporeViewport *self, Legend legends[MOST]) {
  guint count = 0;
  if (self->legend) {
    legends[0] = (Legend){.of = {.label = g_strdup(self->legend), .high = g_strdup(self->legend_high)}};
    legends[0].of.low = g_strdup("0");
    return 1;
  }
  if (!self->stage) return 0;
  memset(legends, 0, MOST * sizeof *legends);
  gboolean field = spore_stage_legend(self->stage, &legends[count].of);
  tell_at(self->colours_button, field ? &legends[count].of : NULL);
  count += field;
  count += spore_stage_sphere_legend(self->stage, &legends[count].of);
  count += spore_viewport_reach_legend(self, &legends[count].of);
  count += spore_stage_contact_legend(self->stage, &legends[count].of);
  gboolean links = spore_stage_link_legend(self->stage, &legends[count].of);
  tell_at(self->links_button, links ? &legends[count].of : NULL);
  return count + links;
}

/* Sizes. */

static PangoLayout *write_out(SporeViewport *self, const Size *size, const char *text) {
  PangoLayout *layout = gtk_widget_create_pango_layout(self->area, text);
  if (!size->small) return layout;
  const PangoFontDescription *normal = pango_context_get_font_description(pango_layout_get_context(layout));
  PangoFontDescription *font = pango_font_description_copy(normal);
  if (pango_font_description_get_size_is_absolute(font))
    pango_font_description_set_absolute_size(font, SMALL_SHARE * pango_font_description_get_size(font));
  else pango_font_description_set_size(font, (int)(SMALL_SHARE * pango_font_description_get_size(font)));
  pango_layout_set_font_description(layout, font);
  pango_font_description_free(font);
  return layout;
}

static Size size_of(SporeViewport *self, gboolean small) {
  int height;
  Size size = {.small = small, .width = small ? 150 : 220, .bar = small ? 6 : 10};
  g_autoptr(PangoLayout) layout = write_out(self, &size, "Xg");
  pango_layout_get_pixel_size(layout, NULL, &height);
  size.line = height;
  return size;
}

static double height_of_row(const SporeLegendRow *row, const Size *size) {
  gboolean bar = row->kind == SPORE_LEGEND_BAR || row->kind == SPORE_LEGEND_TINT;
  return bar ? size->bar + BAR_TEXT_GAP : size->line;
}

static int height_of(const Legend *legend, const Size *size) {
  SporeLegendRow rows[SPORE_LEGEND_ROWS];
  guint count = spore_legend_rows(&legend->of, size->small, rows);
  double height = 2 * PADDING;
  for (guint i = 0; i < count; i++) height += height_of_row(&rows[i], size);
  return (int)ceil(height);
}

/* Places. */

static void add_around(SporeViewport *self, Around *around, GtkWidget *widget) {
  SporePlace at = {.width = gtk_widget_get_allocated_width(widget), .height = gtk_widget_get_allocated_height(widget)};
  if (around->count == MOST_AROUND || at.width <= 1 ||
      !gtk_widget_translate_coordinates(widget, self->area, 0, 0, &at.x, &at.y))
    return;
  at.width = AROUND_STEP * ((at.width + AROUND_STEP - 1) / AROUND_STEP);
  around->at[around->count++] = at;
}

/* A box that shows nothing of its own is as large as what it holds. */
static gboolean is_bare(GtkWidget *widget) {
  GtkStyleContext *style = gtk_widget_get_style_context(widget);
  return G_OBJECT_TYPE(widget) == GTK_TYPE_BOX && !gtk_style_context_has_class(style, "linked") &&
         !gtk_style_context_has_class(style, "hud");
}

static void look_around(SporeViewport *self, Around *around, GtkWidget *holder) {
  g_autoptr(GList) children = gtk_container_get_children(GTK_CONTAINER(holder));
  for (GList *child = children; child; child = child->next) {
    if (child->data == self->area || !gtk_widget_get_visible(child->data)) continue;
    if (is_bare(child->data)) look_around(self, around, child->data);
    else add_around(self, around, child->data);
  }
}

/* Lays the legends; returns how many found a place, which come first then. */
static guint lay(Around around, Legend *legends, guint count, const Size *size, int width, int height) {
  guint laid = 0;
  for (guint i = 0; i < count && around.count < MOST_AROUND; i++) {
    Legend legend = legends[i];
    legend.at.width = (int)size->width, legend.at.height = height_of(&legend, size);
    const SporeAround whole = {width, height, GAP, MARGIN, around.count, around.at};
    if (!spore_free_place_find(&whole, &legend.at)) continue;
    around.at[around.count++] = legend.at;
    legends[i] = legends[laid];
    legends[laid++] = legend;
  }
  return laid;
}

/* Drawing. */

static void draw_box(SporeViewport *self, cairo_t *cr, const SporePlace *at) {
  spore_viewport_set_ground(self, cr);
  cairo_rectangle(cr, at->x, at->y, at->width, at->height);
  cairo_fill(cr);
}

/* align: share of the width that is left free before the text. */
static void write_line(SporeViewport *self, cairo_t *cr, const Size *size, const char *text, double x, double y,
                       double width, double align) {
  int wide;
  g_autoptr(PangoLayout) layout = write_out(self, size, text);
  pango_layout_get_pixel_size(layout, &wide, NULL);
  if (wide > width) {
    pango_layout_set_width(layout, (int)(width * PANGO_SCALE));
    pango_layout_set_ellipsize(layout, PANGO_ELLIPSIZE_MIDDLE);
    wide = (int)width;
  }
  spore_viewport_set_letters(self, cr);
  cairo_move_to(cr, x + align * (width - wide), y);
  pango_cairo_show_layout(cr, layout);
}

/* tint: NULL: the scale of colours. */
static void draw_bar(cairo_t *cr, const double *tint, double x, double y, double width, double height) {
  for (int i = 0; i < (int)width; i++) {
    double colour[3];
    spore_colour_scale(i / width, colour);
    const double *shown = tint ? tint : colour;
    cairo_set_source_rgb(cr, shown[0], shown[1], shown[2]);
    cairo_rectangle(cr, x + i, y, 1, height);
    cairo_fill(cr);
  }
}

/* A patch of the colour, and what the colour means. */
static void draw_key(SporeViewport *self, cairo_t *cr, const Size *size, const SporeLegendRow *key, double x, double y,
                     double width) {
  double side = KEY_SHARE * size->line;
  cairo_set_source_rgb(cr, key->colour[0], key->colour[1], key->colour[2]);
  cairo_rectangle(cr, x, y + 0.5 * (size->line - side), side, side);
  cairo_fill_preserve(cr);
  cairo_set_source_rgba(cr, 0, 0, 0, 0.5); /* white is a colour, too */
  cairo_set_line_width(cr, 1);
  cairo_stroke(cr);
  write_line(self, cr, size, key->text, x + 2 * side, y, width - 2 * side, 0);
}

static void draw_row(SporeViewport *self, cairo_t *cr, const Size *size, const SporeLegendRow *row, double x, double y,
                     double width) {
  switch (row->kind) {
  case SPORE_LEGEND_BAR:
  case SPORE_LEGEND_TINT:
    draw_bar(cr, row->colour, x, y, width, size->bar);
    break;
  case SPORE_LEGEND_KEY:
    draw_key(self, cr, size, row, x, y, width);
    break;
  case SPORE_LEGEND_ENDS:
    write_line(self, cr, size, row->end_text, x, y, width, 1);
    write_line(self, cr, size, row->text, x, y, width, 0);
    break;
  case SPORE_LEGEND_LINE:
    write_line(self, cr, size, row->text, x, y, width, 0);
    break;
  }
}

/* others: that found no place, which is said here. */
static void draw_legend(SporeViewport *self, cairo_t *cr, const Legend *legend, const Size *size, guint others) {
  SporeLegendRow rows[SPORE_LEGEND_ROWS];
  guint count = spore_legend_rows(&legend->of, size->small, rows);
  double x = legend->at.x + PADDING, y = legend->at.y + PADDING, width = size->width - 2 * PADDING;
  draw_box(self, cr, &legend->at);
  if (others) {
    g_autofree char *text = g_strdup_printf(_("+ %u more"), others);
    write_line(self, cr, size, text, x + (1 - OTHERS_SHARE) * width, y, OTHERS_SHARE * width, 1);
  }
  for (guint i = 0; i < count; i++) {
    draw_row(self, cr, size, &rows[i], x, y, i == 0 && others ? (1 - OTHERS_SHARE) * width : width);
    y += height_of_row(&rows[i], size);
  }
}

void spore_viewport_legends_draw(SporeViewport *self, cairo_t *cr, int width, int height) {
  Legend legends[MOST];
  Around around = {0};
  guint count = collect(self, legends);
  if (count == 0) return;
  look_around(self, &around, GTK_WIDGET(self));
  Size size = size_of(self, FALSE);
  guint laid = lay(around, legends, count, &size, width, height);
  if (laid < count) {
    size = size_of(self, TRUE);
    laid = lay(around, legends, count, &size, width, height);
  }
  for (guint i = 0; i < laid; i++) draw_legend(self, cr, &legends[i], &size, i + 1 < laid ? 0 : count - laid);
  for (guint i = 0; i < count; i++) spore_stage_legend_clear(&legends[i].of);
}
