/* Legends of the colours in the picture. They are laid where nothing else lies over it: from the lower right upwards,
 * then further left. Where there is no room for all of them they are set small; the last one says how many still
 * find none. */
#include <glib/gi18n.h>
#include <math.h>

#include "ui/document/free-place.h"
#include "ui/render/colour_scale.h"
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
  gboolean tint; /* the bar shows the tint, else the scale of colours */
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
  gboolean reach = spore_viewport_reach_legend(self, &legends[count].of);
  legends[count].tint = reach;
  count += reach;
  count += spore_stage_contact_legend(self->stage, &legends[count].of);
  gboolean links = spore_stage_link_legend(self->stage, &legends[count].of);
  tell_at(self->links_button, links ? &legends[count].of : NULL);
  return count + links;
}

static gboolean has_bar(const Legend *legend) { return legend->of.high || legend->tint; }

/* The remarks below. A small legend with a scale does without them. */
static guint notes_of(const Legend *legend, const Size *size, const char *notes[2]) {
  guint count = 0;
  if (size->small && legend->of.high) return 0;
  if (legend->of.range) notes[count++] = legend->of.range;
  if (legend->of.without) notes[count++] = legend->of.without;
  return count;
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

static int height_of(const Legend *legend, const Size *size) {
  const char *notes[2];
  double lines = 1 + legend->of.key_count + notes_of(legend, size, notes) + (legend->of.high != NULL);
  return (int)ceil(lines * size->line + (has_bar(legend) ? size->bar + BAR_TEXT_GAP : 0) + 2 * PADDING);
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

static void draw_bar(cairo_t *cr, const Legend *legend, double x, double y, double width, double height) {
  for (int i = 0; i < (int)width; i++) {
    double colour[3];
    spore_colour_scale(i / width, colour);
    const double *shown = legend->tint ? spore_tint_colour : colour;
    cairo_set_source_rgb(cr, shown[0], shown[1], shown[2]);
    cairo_rectangle(cr, x + i, y, 1, height);
    cairo_fill(cr);
  }
}

/* A patch of the colour, and what the colour means. */
static void draw_key(SporeViewport *self, cairo_t *cr, const Size *size, const SporeStageKey *key, double x, double y,
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

/* others: that found no place, which is said here. */
static void draw_legend(SporeViewport *self, cairo_t *cr, const Legend *legend, const Size *size, guint others) {
  const char *notes[2];
  guint note_count = notes_of(legend, size, notes);
  double x = legend->at.x + PADDING, y = legend->at.y + PADDING, width = size->width - 2 * PADDING;
  draw_box(self, cr, &legend->at);
  write_line(self, cr, size, legend->of.label, x, y, others ? (1 - OTHERS_SHARE) * width : width, 0);
  if (others) {
    g_autofree char *text = g_strdup_printf(_("+ %u more"), others);
    write_line(self, cr, size, text, x + (1 - OTHERS_SHARE) * width, y, OTHERS_SHARE * width, 1);
  }
  y += size->line;
  if (has_bar(legend)) {
    draw_bar(cr, legend, x, y, width, size->bar);
    y += size->bar + BAR_TEXT_GAP;
  }
  if (legend->of.high) {
    write_line(self, cr, size, legend->of.low, x, y, width, 0);
    write_line(self, cr, size, legend->of.high, x, y, width, 1);
    y += size->line;
  }
  for (guint i = 0; i < legend->of.key_count; i++, y += size->line)
    draw_key(self, cr, size, &legend->of.keys[i], x, y, width);
  for (guint i = 0; i < note_count; i++, y += size->line) write_line(self, cr, size, notes[i], x, y, width, 0);
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
