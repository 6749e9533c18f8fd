/* Links over the picture: the chosen one, what a click meets, and the places that are picked for a new one. */
#include "core/author/link_edits.h"
#include "ui/viewport/spore-viewport-private.h"

#define MARK_PIXELS 6.5   /* radius as drawn */
#define REACH_PIXELS 10.0 /* distance from a mark or line within which a click meets the link */
#define OUTLINE_PIXELS 7.0

typedef struct Mark {
  guint32 link; /* object id */
  guint count;
  SporeVec3 places[SPORE_LINK_MOST_ENDS];
} Mark;

GArray *spore_viewport_link_marks_new(void) { return g_array_new(FALSE, FALSE, sizeof(Mark)); }

void spore_viewport_links_refresh(SporeViewport *self) {
  SporeDocument *document = spore_editor_document_get(self->document);
  const SporeObject *links = spore_document_section(document, "links");
  g_array_set_size(self->link_marks, 0);
  for (guint i = 0; i < spore_object_child_count(links); i++) {
    const SporeObject *link = spore_object_child(links, i);
    Mark mark = {.link = spore_object_id(link)};
    mark.count = spore_link_places(document, link, mark.places);
    if (mark.count) g_array_append_val(self->link_marks, mark);
  }
}

/* Links are drawn where the author put them; a run takes the bodies away from there. */
static gboolean shows_links(SporeViewport *self) {
  SporeSession *session = self->player ? spore_player_get_session(self->player) : NULL;
  return self->document && !self->presented && (!session || spore_session_snapshot(session)->time_s == 0);
}

static void draw_dot(cairo_t *cr, double x, double y) {
  cairo_new_path(cr);
  cairo_arc(cr, x, y, MARK_PIXELS, 0, 2 * G_PI);
  cairo_set_source_rgb(cr, 1, 1, 1);
  cairo_fill_preserve(cr);
  cairo_set_source_rgb(cr, 0.05, 0.2, 0.25);
  cairo_set_line_width(cr, 1.5);
  cairo_stroke(cr);
}

static void draw_line(cairo_t *cr, const double from[2], const double to[2]) {
  cairo_new_path(cr);
  cairo_move_to(cr, from[0], from[1]);
  cairo_line_to(cr, to[0], to[1]);
  spore_viewport_stroke(cr, (const double[4]){1, 1, 1, 1}, 2);
}

static void draw_chosen(SporeViewport *self, cairo_t *cr, const Mark *mark) {
  double at[SPORE_LINK_MOST_ENDS][2];
  for (guint end = 0; end < mark->count; end++)
    if (!spore_viewport_project(self, mark->places[end], &at[end][0], &at[end][1])) return;
  if (mark->count > 1) draw_line(cr, at[0], at[1]);
  for (guint end = 0; end < mark->count; end++) draw_dot(cr, at[end][0], at[end][1]);
}

/* An instrument as a shaft of light: it stands when it is placed. */
static void draw_outline(SporeViewport *self, cairo_t *cr) {
  cairo_new_path(cr);
  for (guint i = 0; i < self->outline_count; i++) {
    double x, y;
    if (spore_viewport_project(self, self->outline[i], &x, &y)) cairo_line_to(cr, x, y);
  }
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  spore_viewport_stroke(cr, (const double[4]){0.85, 0.88, 0.92, 0.7}, OUTLINE_PIXELS);
}

/* The places so far, and a line from there to the cursor. */
static void draw_picking(SporeViewport *self, cairo_t *cr) {
  double at[2], cursor[2] = {self->last_x, self->last_y};
  spore_viewport_draw_cross(self, cr);
  draw_outline(self, cr);
  for (guint i = 0; i < self->anchor_count; i++) {
    if (!spore_viewport_project(self, self->anchors[i], &at[0], &at[1])) continue;
    draw_line(cr, at, cursor);
    draw_dot(cr, at[0], at[1]);
  }
}

/* The stage draws the links; the chosen one stands out. */
void spore_viewport_links_draw(SporeViewport *self, cairo_t *cr) {
  guint32 chosen = shows_links(self) ? spore_editor_document_get_selection(self->document) : 0;
  for (guint i = 0; chosen && i < self->link_marks->len; i++) {
    const Mark *mark = &g_array_index(self->link_marks, Mark, i);
    if (mark->link == chosen) draw_chosen(self, cr, mark);
  }
  if (self->picking) draw_picking(self, cr);
}

/* Distance of a point from the piece of a line. */
static double distance_to(const double from[2], const double to[2], double x, double y) {
  double along[2] = {to[0] - from[0], to[1] - from[1]}, square = along[0] * along[0] + along[1] * along[1];
  double share = square > 0 ? ((x - from[0]) * along[0] + (y - from[1]) * along[1]) / square : 0;
  share = CLAMP(share, 0, 1);
  return hypot(from[0] + share * along[0] - x, from[1] + share * along[1] - y);
}

guint32 spore_viewport_link_at(SporeViewport *self, double x, double y) {
  guint32 link = 0;
  double nearest = REACH_PIXELS;
  for (guint i = 0; shows_links(self) && i < self->link_marks->len; i++) {
    const Mark *mark = &g_array_index(self->link_marks, Mark, i);
    double from[2], to[2];
    if (!spore_viewport_project(self, mark->places[0], &from[0], &from[1]) ||
        !spore_viewport_project(self, mark->places[mark->count - 1], &to[0], &to[1]))
      continue;
    double distance = distance_to(from, to, x, y);
    if (distance <= nearest) nearest = distance, link = mark->link;
  }
  return link;
}

void spore_viewport_set_anchors(SporeViewport *self, const SporeVec3 *places, guint count) {
  self->anchor_count = MIN(count, G_N_ELEMENTS(self->anchors));
  for (guint i = 0; i < self->anchor_count; i++) self->anchors[i] = places[i];
  self->outline_count = 0;
  gtk_widget_queue_draw(self->area);
}

void spore_viewport_set_link_menu(SporeViewport *self, GMenuModel *kinds) {
  g_set_object(&self->link_kinds, kinds);
  gtk_menu_button_set_menu_model(GTK_MENU_BUTTON(self->link_button), kinds);
}

void spore_viewport_set_fluid_menu(SporeViewport *self, GMenuModel *kinds) { g_set_object(&self->fluid_kinds, kinds); }

void spore_viewport_set_outline(SporeViewport *self, const SporeVec3 *points, guint count) {
  self->outline_count = MIN(count, G_N_ELEMENTS(self->outline));
  for (guint i = 0; i < self->outline_count; i++) self->outline[i] = points[i];
  gtk_widget_queue_draw(self->area);
}

void spore_viewport_set_instrument_menu(SporeViewport *self, GMenuModel *kinds, GMenuModel *led) {
  g_set_object(&self->instrument_kinds, kinds);
  gtk_menu_button_set_menu_model(GTK_MENU_BUTTON(self->instrument_button), kinds);
  gtk_menu_button_set_menu_model(GTK_MENU_BUTTON(self->led_button), led);
}
