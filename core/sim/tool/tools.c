/* Tools: what instruments do besides being there. They act between sensing and mapping, on what the last step did, so
 * that a run is repeated by its input alone. */
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

static size_t hold_count(const SporeToolDescription *from) {
  if (from->kind == SPORE_TOOL_NEEDLE) return spore_needle_term_count(from);
  return spore_tool_kind_holds(from->kind) ? (size_t)from->jaws.holds : 0;
}

size_t spore_tools_hold_count(const SporeWorldDescription *description) {
  size_t count = 0;
  for (size_t i = 0; i < description->tool_count; i++) count += hold_count(&description->tools[i]);
  return count;
}

static const char *tool_fault(const SporeWorld *world, const SporeToolDescription *from) {
  if (from->body >= world->body_count || world->bodies[from->body].role != SPORE_ACTIVE)
    return _("the tool's body is not active; expected a body that a device moves; choose one");
  if (!spore_vec3_is_finite(from->point)) return _("a point of the tool is not finite; expected it in m; correct it");
  if (from->kind == SPORE_TOOL_NEEDLE) return spore_needle_fault(world, from);
  return from->kind >= SPORE_TOOL_SUCTION ? NULL : spore_jaws_fault(world, from);
}

static bool make_tool(SporeWorld *world, SporeTool *tool, const SporeToolDescription *from) {
  tool->name = spore_copy_text(from->name ? from->name : "");
  tool->kind = from->kind;
  tool->body = from->body;
  if (spore_tool_has_jaws(tool)) return tool->name && spore_jaws_make(world, tool, from);
  if (from->kind == SPORE_TOOL_NEEDLE) return tool->name && spore_needle_make(world, tool, from);
  const SporePose *frame = &world->bodies[from->body].rest_pose;
  tool->suction = from->suction;
  tool->bipolar = from->bipolar;
  tool->point =
      spore_quat_rotate(spore_quat_conjugate(frame->orientation), spore_vec3_sub(from->point, frame->position));
  return tool->name != NULL;
}

bool spore_world_create_tools(SporeWorld *world, const SporeWorldDescription *description, SporeError *error) {
  size_t hold = world->links.term_count;
  world->tools.all = SPORE_NEW_ARRAY(SporeTool, description->tool_count);
  bool made = world->tools.all != NULL;
  for (size_t i = 0; made && i < description->tool_count; i++) {
    const SporeToolDescription *from = &description->tools[i];
    char place[200];
    snprintf(place, sizeof place, "tools/%s", from->name ? from->name : "");
    const char *fault = tool_fault(world, from);
    if (fault) return spore_error_set(error, SPORE_ERROR_INPUT, place, "%s", fault);
    SporeTool *tool = &world->tools.all[world->tools.count++];
    tool->hold_start = hold;
    hold += hold_count(from);
    made = make_tool(world, tool, from);
  }
  made = made && spore_world_create_cutting(world) && spore_world_create_splitting(world) &&
         spore_world_create_coagulation(world);
  return made || spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the tools"));
}

static void count_tools(SporeWorld *world) {
  SporeToolCounts counts = {0};
  for (size_t i = 0; i < world->tools.count; i++) {
    const SporeTool *tool = &world->tools.all[i];
    counts.cut += tool->cut;
    if (!tool->needle) continue;
    counts.pierced += tool->needle->pierced;
    counts.stitches += spore_needle_stitch_count(tool->needle);
  }
  world->tools.counts = counts;
}

void spore_world_reset_tools(SporeWorld *world) {
  for (size_t i = 0; i < world->tools.count; i++) {
    SporeTool *tool = &world->tools.all[i];
    spore_jaws_let_go(world, tool);
    tool->opening = tool->squeeze = tool->stroke = 0;
    tool->latched = false;
    tool->due = 0;
    if (tool->needle) spore_needle_reset(world, tool);
    tool->taken = tool->cut = tool->coagulated = 0;
  }
  count_tools(world);
}

void spore_world_clear_tools(SporeWorld *world) {
  for (size_t i = 0; i < world->tools.count; i++) {
    spore_free(world->tools.all[i].name);
    spore_free(world->tools.all[i].holds);
    spore_needle_clear(world->tools.all[i].needle);
  }
  spore_free(world->tools.all);
  spore_free(world->tools.emitters);
}

void spore_world_use_tools(SporeWorld *world) {
  for (size_t i = 0; i < world->tools.count; i++) {
    SporeTool *tool = &world->tools.all[i];
    if (spore_tool_has_jaws(tool)) spore_jaws_use(world, tool);
    if (tool->kind == SPORE_TOOL_BIPOLAR) spore_bipolar_use(world, tool);
    if (tool->needle) spore_needle_use(world, tool);
  }
  count_tools(world);
}

void spore_world_tear_holds(SporeWorld *world) {
  for (size_t i = 0; i < world->tools.count; i++)
    if (spore_tool_has_jaws(&world->tools.all[i])) spore_jaws_tear(world, &world->tools.all[i]);
}

void spore_world_feed_back_tools(SporeWorld *world) {
  for (size_t i = 0; i < world->tools.count; i++)
    if (spore_tool_has_jaws(&world->tools.all[i])) spore_jaws_feed_back(world, &world->tools.all[i]);
}

size_t spore_world_tool_count(const SporeWorld *world) { return world->tools.count; }

SporeToolState spore_world_tool_state(const SporeWorld *world, size_t index) {
  const SporeTool *tool = &world->tools.all[index];
  SporeToolState state = {.name = tool->name,
                          .opening = tool->opening,
                          .squeeze = tool->squeeze,
                          .taken = tool->taken,
                          .cut = tool->cut,
                          .coagulated = tool->coagulated};
  if (tool->needle) {
    state.pierced = tool->needle->pierced;
    state.stitches = spore_needle_stitch_count(tool->needle);
  }
  for (size_t i = 0; i < (size_t)tool->fields.holds; i++) {
    state.held += tool->holds[i].state == SPORE_HOLD_TIED;
    state.lost += tool->holds[i].state == SPORE_HOLD_LOST;
  }
  return state;
}
