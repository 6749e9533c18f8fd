/* What instruments reach through their ports: a cone of lines in the colour of each instrument, and the tint. */
#include "ui/render/stage_ports.h"

#include <glib/gi18n.h>

#include "core/math/colour.h"
#include "ui/render/stage_body.h"

#define LINE_PIXELS 1.0f

GArray *spore_stage_find_ports(SporeDocument *document, const char *name, GError **error) {
  SporeObject *port = spore_document_find(document, "port", name);
  gboolean all = !port && g_str_equal(name, SPORE_STAGE_ALL_PORTS);
  GArray *found = port || all ? spore_ports_of(document, port) : NULL;
  if (found && found->len) return found;
  g_clear_pointer(&found, g_array_unref);
  if (all)
    spore_error_raise(error, SPORE_ERROR_INPUT, name, "%s",
                      _("no instrument passes through a port here; expected a scene with one; add an instrument with "
                        "an entry"));
  else
    spore_error_raise(error, SPORE_ERROR_INPUT, name,
                      _("the scene has no port of this name that an instrument passes through; expected the name of "
                        "one, or %s"),
                      SPORE_STAGE_ALL_PORTS);
  return NULL;
}

static void find_colour(const SporeObject *body, float colour[3]) {
  const SporeObject *visual = spore_object_child_of(body, "visual");
  SporeVec3 shown = visual ? spore_object_vector(visual, "colour") : spore_vec3(0.8, 0.8, 0.8);
  colour[0] = (float)spore_linear_light(shown.x);
  colour[1] = (float)spore_linear_light(shown.y);
  colour[2] = (float)spore_linear_light(shown.z);
}

static void remove_lines(SporeStage *stage) {
  for (guint i = 0; i < stage->port_lines->len; i++)
    spore_renderer_remove(stage->renderer, g_array_index(stage->port_lines, guint, i));
  g_array_set_size(stage->port_lines, 0);
}

static void add_lines(SporeStage *stage, const SporePortReach *reach) {
  double points[6 * SPORE_PORT_LINES];
  float colour[3];
  spore_port_lines(reach, points);
  find_colour(reach->body, colour);
  guint handle = spore_renderer_add_lines(stage->renderer, points, SPORE_PORT_LINES, colour, LINE_PIXELS);
  g_array_append_val(stage->port_lines, handle);
}

void spore_stage_set_ports(SporeStage *stage, const SporeStagePort *ports, guint count) {
  SporeCone cones[SPORE_CONES_MOST];
  guint tinting = 0;
  remove_lines(stage);
  for (guint i = 0; i < count; i++) {
    const SporePortReach *reach = &ports[i].reach;
    add_lines(stage, reach);
    if (ports[i].tints && tinting < SPORE_CONES_MOST)
      cones[tinting++] = (SporeCone){reach->pivot, reach->along, reach->angle, reach->shallowest, reach->deepest};
  }
  spore_renderer_tint_beyond(stage->renderer, cones, tinting);
}

gboolean spore_stage_reach_legend(guint count, const char *name, SporeStageLegend *legend) {
  *legend = (SporeStageLegend){.tint = TRUE};
  if (count == 0) return FALSE;
  legend->label =
      count > 1 ? g_strdup(_("Out of reach of every port")) : g_strdup_printf(_("Out of reach of \"%s\""), name);
  legend->range = g_strdup(_("blue, at the start"));
  return TRUE;
}
