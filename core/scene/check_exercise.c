/* The exercise: steps that nothing in the scene can do. Whether it can be put together at all is said where it is
 * compiled. */
#include <glib/gi18n.h>

#include "core/exercise/event.h"
#include "core/scene/check_private.h"
#include "core/scene/port_reach.h"

static gboolean some_tool(const SporeCheck *check, const SporeEventKind *kind) {
  const SporeObject *tools = spore_document_section(check->document, "tools");
  for (guint i = 0; i < spore_object_child_count(tools); i++)
    if (spore_event_kind_allows(kind, spore_object_type(spore_object_child(tools, i))->element)) return TRUE;
  return FALSE;
}

/* What a body does by itself needs no tool. */
static void check_step(SporeCheck *check, SporeObject *step) {
  const SporeEventKind *kind = spore_event_kind_find(spore_object_type(step)->element);
  if (!kind || !kind->needs_body || spore_parameter_find(&kind->parameters, "tool") < 0 || some_tool(check, kind))
    return;
  spore_check_say(check, SPORE_WARNING, step, _("add a tool that can, or remove the step"),
                  _("no tool of the scene can do the step \"%s\""), spore_object_name(step));
}

/* Ports. */

/* What a step is done to: a body, or a place that the instrument itself has to get to. */
typedef struct Target {
  const SporeObject *body; /* NULL: the place */
  SporeVec3 place;
  double radius;
} Target;

/* FALSE: the step is done to nothing that a port can keep an instrument from. */
static gboolean find_target(const SporeObject *step, Target *target) {
  const SporeParameterTable *table = spore_object_type(step)->table;
  const SporeObject *body = spore_object_reference(step, "body");
  int point = spore_parameter_find(table, "point");
  if (spore_parameter_find(table, "tool") < 0) return FALSE;
  *target = (Target){.body = body};
  if (point < 0) return body != NULL;
  target->place = spore_vec3_load(spore_object_value(step, (guint)point)->number);
  target->radius = spore_object_number(step, "radius");
  return !body; /* else the body has to get there, wherever it is held */
}

static gboolean gets_to(SporeDocument *document, const SporePortReach *reach, const Target *target) {
  double share;
  if (target->body) return !spore_ports_share(document, reach, 1, target->body, &share) || share > 0;
  SporeVec3 way = spore_vec3_sub(target->place, reach->pivot);
  double depth = CLAMP(spore_vec3_dot(way, reach->along), reach->shallowest, reach->deepest);
  SporeVec3 middle = spore_vec3_add_scaled(reach->pivot, depth, reach->along);
  SporeVec3 inward = spore_vec3_sub(middle, target->place);
  double part = fmin(1, target->radius / fmax(spore_vec3_length(inward), 1e-12));
  return spore_port_reaches(reach, spore_vec3_add_scaled(target->place, part, inward));
}

/* Whether no port keeps the tool from the target; else *found is one that does. */
static gboolean is_free(SporeDocument *document, const SporeObject *tool, const Target *target, SporePortReach *found) {
  g_autoptr(GArray) ports = spore_ports_of(document, tool);
  for (guint i = 0; i < ports->len; i++) {
    const SporePortReach *reach = &g_array_index(ports, SporePortReach, i);
    if (gets_to(document, reach, target)) continue;
    *found = *reach;
    return FALSE;
  }
  return TRUE;
}

/* Of a step that names no tool, any one may do it. */
static void check_reach(SporeCheck *check, SporeObject *step) {
  const SporeEventKind *kind = spore_event_kind_find(spore_object_type(step)->element);
  const SporeObject *tools = spore_document_section(check->document, "tools");
  Target target;
  SporePortReach reach = {0};
  if (!kind || !find_target(step, &target)) return;
  const SporeObject *named = spore_object_reference(step, "tool");
  for (guint i = 0; i < spore_object_child_count(tools); i++) {
    const SporeObject *tool = spore_object_child(tools, i);
    gboolean may = named ? tool == named : spore_event_kind_allows(kind, spore_object_type(tool)->element);
    if (may && is_free(check->document, tool, &target, &reach)) return;
  }
  if (!reach.port) return;
  const char *remedy = _("move the port: drag it in the view with the Edit tool, or by spore edit --port");
  if (target.body)
    spore_check_say(check, SPORE_NOTE, step, remedy, _("\"%s\" reaches nothing of \"%s\" through its port \"%s\""),
                    spore_object_name(reach.tool), spore_object_name(target.body), spore_object_name(reach.port));
  else
    spore_check_say(check, SPORE_NOTE, step, remedy,
                    _("\"%s\" does not get to the place of the step \"%s\" through its port \"%s\""),
                    spore_object_name(reach.tool), spore_object_name(step), spore_object_name(reach.port));
}

void spore_check_exercise(SporeCheck *check) {
  spore_check_each(check, "exercise", NULL, check_step);
  spore_check_each(check, "exercise", NULL, check_reach);
}
