/* Ports over the picture: what the selected instrument, or all, reach through them, and a port moved by hand. */
#include "ui/viewport/spore-viewport-private.h"

#include "core/author/edits.h"
#include "core/author/port_edits.h"
#include "ui/panels/report.h"
#include "ui/render/stage_ports.h"

#define SURFACE_M 0.02 /* a port that is led nearer to a surface lies on it */

typedef struct Port {
  guint32 id;
  SporeStagePort shown; /* its objects are not to be used: the document may have changed */
  char name[64];
} Port;

GArray *spore_viewport_ports_new(void) { return g_array_new(FALSE, FALSE, sizeof(Port)); }

static SporeDocument *document_of(SporeViewport *self) { return spore_editor_document_get(self->document); }

/* Takes along those of the other array that are not there yet. */
static void add_ports(SporeViewport *self, const GArray *found, gboolean tint) {
  for (guint i = 0; i < found->len; i++) {
    Port port = {.shown = {g_array_index(found, SporePortReach, i), tint}};
    port.id = spore_object_id(port.shown.reach.port);
    for (guint k = 0; k < self->ports->len && port.id; k++)
      if (g_array_index(self->ports, Port, k).id == port.id) port.id = 0;
    if (!port.id) continue;
    g_strlcpy(port.name, spore_object_name(port.shown.reach.port), sizeof port.name);
    g_array_append_val(self->ports, port);
  }
}

/* The cones and the tint are drawn by the stage. */
static void show_ports(SporeViewport *self) {
  if (!self->stage) return;
  g_autofree SporeStagePort *shown = g_new(SporeStagePort, self->ports->len);
  for (guint i = 0; i < self->ports->len; i++) shown[i] = g_array_index(self->ports, Port, i).shown;
  spore_stage_set_ports(self->stage, shown, self->ports->len);
}

/* Of what is selected, which is for an author; with the overlay all, where what is selected alone tints. */
void spore_viewport_ports_refresh(SporeViewport *self) {
  const SporeObject *selected = self->document ? spore_editor_document_selected(self->document) : NULL;
  g_array_set_size(self->ports, 0);
  if (selected && (self->reach || !self->presented)) {
    g_autoptr(GArray) own = spore_ports_of(document_of(self), selected);
    add_ports(self, own, self->reach);
  }
  if (self->document && self->reach) {
    g_autoptr(GArray) all = spore_ports_of(document_of(self), NULL);
    add_ports(self, all, self->ports->len == 0);
  }
  show_ports(self);
}

void spore_viewport_set_reach(SporeViewport *self, gboolean shown) {
  self->reach = shown;
  spore_viewport_ports_refresh(self);
  spore_viewport_redraw(self);
}

gboolean spore_viewport_reach_legend(SporeViewport *self, SporeStageLegend *legend) {
  guint tinting = 0;
  const char *name = NULL;
  for (guint i = 0; i < self->ports->len; i++) {
    const Port *port = &g_array_index(self->ports, Port, i);
    if (port->shown.tints) tinting++, name = port->name;
  }
  return spore_stage_reach_legend(tinting, name, legend);
}

static gboolean is_shown(SporeViewport *self) { return self->document && !self->presented; }

gboolean spore_viewport_has_ports(SporeViewport *self) { return is_shown(self) && self->ports->len > 0; }

/* Drawing. */

void spore_viewport_ports_draw(SporeViewport *self, cairo_t *cr) {
  for (guint i = 0; is_shown(self) && i < self->ports->len; i++) {
    const Port *port = &g_array_index(self->ports, Port, i);
    double x, y;
    spore_viewport_draw_handle(self, cr, port->shown.reach.pivot,
                               self->drag == DRAG_PORT && port->id == self->port_held);
    if (spore_viewport_project(self, port->shown.reach.pivot, &x, &y))
      spore_viewport_draw_text(self, cr, port->name, x + 9, y - 22);
  }
}

/* Moving. */

gboolean spore_viewport_ports_press(SporeViewport *self, double x, double y) {
  for (guint i = 0; is_shown(self) && i < self->ports->len; i++) {
    const Port *port = &g_array_index(self->ports, Port, i);
    if (!spore_viewport_handle_is_at(self, port->shown.reach.pivot, x, y)) continue;
    self->port_held = port->id;
    self->offset = spore_vec3_sub(port->shown.reach.pivot, spore_viewport_under_cursor(self, port->shown.reach.pivot));
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
  SporeVec3 place = spore_vec3_add(spore_viewport_under_cursor(self, port->shown.reach.pivot), self->offset);
  if (met && (SporeRole)spore_object_number(met, "role") != SPORE_ACTIVE &&
      spore_vec3_distance(surface, place) < SURFACE_M)
    place = surface;
  if (!spore_port_moved(&port->shown.reach, place, &moved, NULL)) return;
  port->shown.reach = moved;
  show_ports(self);
}

void spore_viewport_ports_release(SporeViewport *self, gboolean keep) {
  g_autoptr(GError) error = NULL;
  const Port *port = held(self);
  SporeObject *object = spore_document_by_id(document_of(self), self->port_held);
  self->port_held = 0;
  SporePortReach before;
  if (keep && port && object && spore_port_reach(document_of(self), object, &before) &&
      spore_vec3_distance(before.pivot, port->shown.reach.pivot) > 0 &&
      !spore_edit_move_port(document_of(self), object, port->shown.reach.pivot, &error))
    spore_report(GTK_WIDGET(self), error);
  spore_viewport_ports_refresh(self);
}
