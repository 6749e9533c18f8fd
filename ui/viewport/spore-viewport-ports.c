/* Ports over the picture: the cone that the selected instrument reaches through its port, and the port moved by hand.
 */
#include "ui/viewport/spore-viewport-private.h"

#include "core/author/edits.h"
#include "core/author/port_edits.h"
#include "ui/panels/report.h"

#define SIDES 12       /* lines of the cone */
#define RINGS 3        /* across them, at equal depths */
#define PIECES 6       /* of a line: what is behind the eye is not drawn */
#define SURFACE_M 0.02 /* a port that is led nearer to a surface lies on it */

typedef struct Port {
  guint32 id;
  SporePortReach reach; /* its objects are not to be used: the document may have changed */
  double colour[3];
  char name[64];
} Port;

GArray *spore_viewport_ports_new(void) { return g_array_new(FALSE, FALSE, sizeof(Port)); }

static SporeDocument *document_of(SporeViewport *self) { return spore_editor_document_get(self->document); }

static void find_colour(const SporeObject *body, double colour[3]) {
  const SporeObject *visual = spore_object_child_of(body, "visual");
  int index = visual ? spore_parameter_find(spore_object_type(visual)->table, "colour") : -1;
  for (int k = 0; k < 3; k++) colour[k] = index < 0 ? 0.8 : spore_object_value(visual, (guint)index)->number[k];
}

void spore_viewport_ports_refresh(SporeViewport *self) {
  const SporeObject *selected = spore_editor_document_selected(self->document);
  g_array_set_size(self->ports, 0);
  if (!selected) return;
  g_autoptr(GArray) found = spore_ports_of(document_of(self), selected);
  for (guint i = 0; i < found->len; i++) {
    Port port = {.reach = g_array_index(found, SporePortReach, i)};
    port.id = spore_object_id(port.reach.port);
    find_colour(port.reach.body, port.colour);
    g_strlcpy(port.name, spore_object_name(port.reach.port), sizeof port.name);
    g_array_append_val(self->ports, port);
  }
}

static gboolean is_shown(SporeViewport *self) { return self->document && !self->presented; }

gboolean spore_viewport_has_ports(SporeViewport *self) { return is_shown(self) && self->ports->len > 0; }

/* Drawing. */

/* A point of the cone's mantle. */
static SporeVec3 on_cone(const SporePortReach *reach, double depth, double turn) {
  SporeVec3 u = spore_vec3_any_across(reach->along), v = spore_vec3_cross(reach->along, u);
  SporeVec3 aside = spore_vec3_add(spore_vec3_scale(cos(turn), u), spore_vec3_scale(sin(turn), v));
  SporeVec3 way = spore_vec3_add_scaled(spore_vec3_scale(sin(reach->angle), aside), cos(reach->angle), reach->along);
  return spore_vec3_add_scaled(reach->pivot, depth, way);
}

static void draw_piece(SporeViewport *self, cairo_t *cr, SporeVec3 from, SporeVec3 to) {
  double x, y, x1, y1;
  if (!spore_viewport_project(self, from, &x, &y) || !spore_viewport_project(self, to, &x1, &y1)) return;
  cairo_move_to(cr, x, y);
  cairo_line_to(cr, x1, y1);
}

static void draw_cone(SporeViewport *self, cairo_t *cr, const SporePortReach *reach) {
  double long_way = reach->deepest - reach->shallowest;
  for (guint side = 0; side < SIDES; side++)
    for (guint piece = 0; piece < PIECES; piece++)
      draw_piece(self, cr, on_cone(reach, reach->shallowest + long_way * piece / PIECES, side * 2 * G_PI / SIDES),
                 on_cone(reach, reach->shallowest + long_way * (piece + 1) / PIECES, side * 2 * G_PI / SIDES));
  for (guint ring = 0; ring <= RINGS; ring++)
    for (guint arc = 0; arc < 4 * SIDES; arc++)
      draw_piece(self, cr, on_cone(reach, reach->shallowest + long_way * ring / RINGS, arc * G_PI / (2 * SIDES)),
                 on_cone(reach, reach->shallowest + long_way * ring / RINGS, (arc + 1) * G_PI / (2 * SIDES)));
}

void spore_viewport_ports_draw(SporeViewport *self, cairo_t *cr) {
  for (guint i = 0; is_shown(self) && i < self->ports->len; i++) {
    const Port *port = &g_array_index(self->ports, Port, i);
    double x, y;
    cairo_new_path(cr);
    draw_cone(self, cr, &port->reach);
    draw_piece(self, cr, port->reach.pivot, port->reach.tip);
    cairo_set_source_rgba(cr, port->colour[0], port->colour[1], port->colour[2], 0.55);
    cairo_set_line_width(cr, 1);
    cairo_stroke(cr);
    spore_viewport_draw_handle(self, cr, port->reach.pivot, self->drag == DRAG_PORT);
    if (spore_viewport_project(self, port->reach.pivot, &x, &y))
      spore_viewport_draw_text(self, cr, port->name, x + 9, y - 22);
  }
}

/* Moving. */

gboolean spore_viewport_ports_press(SporeViewport *self, double x, double y) {
  for (guint i = 0; is_shown(self) && i < self->ports->len; i++) {
    const Port *port = &g_array_index(self->ports, Port, i);
    if (!spore_viewport_handle_is_at(self, port->reach.pivot, x, y)) continue;
    self->port_held = port->id;
    self->offset = spore_vec3_sub(port->reach.pivot, spore_viewport_under_cursor(self, port->reach.pivot));
    self->drag = DRAG_PORT;
    return TRUE;
  }
  return FALSE;
}

static Port *held(SporeViewport *self) {
  for (guint i = 0; i < self->ports->len; i++)
    if (g_array_index(self->ports, Port, i).id == self->port_held) return &g_array_index(self->ports, Port, i);
  return NULL;
}

void spore_viewport_ports_motion(SporeViewport *self, guint32 body, SporeVec3 surface) {
  Port *port = held(self);
  const SporeObject *met = body ? spore_document_by_id(document_of(self), body) : NULL;
  SporePortReach moved;
  if (!port) return;
  SporeVec3 place = spore_vec3_add(spore_viewport_under_cursor(self, port->reach.pivot), self->offset);
  if (met && (SporeRole)spore_object_number(met, "role") != SPORE_ACTIVE &&
      spore_vec3_distance(surface, place) < SURFACE_M)
    place = surface;
  if (spore_port_moved(&port->reach, place, &moved, NULL)) port->reach = moved;
}

void spore_viewport_ports_release(SporeViewport *self, gboolean keep) {
  g_autoptr(GError) error = NULL;
  const Port *port = held(self);
  SporeObject *object = spore_document_by_id(document_of(self), self->port_held);
  self->port_held = 0;
  SporePortReach before;
  if (keep && port && object && spore_port_reach(document_of(self), object, &before) &&
      spore_vec3_distance(before.pivot, port->reach.pivot) > 0 &&
      !spore_edit_move_port(document_of(self), object, port->reach.pivot, &error))
    spore_report(GTK_WIDGET(self), error);
  spore_viewport_ports_refresh(self);
}
