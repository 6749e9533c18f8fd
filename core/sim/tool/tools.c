/* Tools of a world: made, used and queried by the slots of their types. They act between reading the devices and
 * mapping the spheres, on the state after the last step. So the same input gives the same run. */
#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

static size_t spring_count(const SporeToolDescription *from) {
  return from->type->spring_count ? from->type->spring_count(from->fields) : 0;
}

size_t spore_tools_spring_count(const SporeWorldDescription *description) {
  size_t count = 0;
  for (size_t i = 0; i < description->tool_count; i++) count += spring_count(&description->tools[i]);
  return count;
}

static const char *tool_fault(const SporeWorld *world, const SporeToolDescription *from) {
  assert(from->type && from->fields);
  if (from->bodies[0] >= world->body_count || world->bodies[from->bodies[0]].role != SPORE_ACTIVE)
    return _("the tool's body is not active; expected a body that a device moves; choose one");
  return from->type->fault ? from->type->fault(world, from) : NULL;
}

static const char *name_of(const SporeToolDescription *from) {
  const char *name = ((const SporeToolFields *)from->fields)->name;
  return name ? name : "";
}

static SporeTool *make_tool(SporeWorld *world, const SporeToolDescription *from, size_t spring_start) {
  assert(from->type->make && from->type->size >= sizeof(SporeTool));
  assert(spring_start <= spore_world_spring_count(world));
  SporeTool *tool = spore_allocate(1, from->type->size);
  if (!tool) return NULL;
  world->tools.all[world->tools.count++] = tool;
  tool->type = from->type;
  tool->name = spore_copy_text(name_of(from));
  memcpy(tool->bodies, from->bodies, sizeof tool->bodies);
  tool->spring_start = spring_start;
  tool->spring_count = spring_count(from);
  tool->effect = tool->effect_at_start = from->effect && from->type->set_effect;
  return tool->name && from->type->make(world, tool, from) ? tool : NULL;
}

static void prepare_heat(SporeModel *model, void *user) {
  bool *made = user;
  *made = *made && model->type->heat->prepare(model);
}

/* Makes room in the models that can be heated. */
static bool prepare_models(SporeWorld *world, bool heats) {
  bool made = true;
  for (size_t b = 0; heats && made && b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (body->model && body->model->type->heat) spore_body_each_model(body, prepare_heat, &made);
  }
  return made;
}

bool spore_world_create_tools(SporeWorld *world, const SporeWorldDescription *description, SporeError *error) {
  size_t spring_start = world->links.term_count;
  world->tools.all = SPORE_NEW_ARRAY(SporeTool *, description->tool_count);
  bool made = world->tools.all != NULL, heats = false;
  for (size_t i = 0; made && i < description->tool_count; i++) {
    const SporeToolDescription *from = &description->tools[i];
    char place[200];
    snprintf(place, sizeof place, "tools/%s", name_of(from));
    const char *fault = tool_fault(world, from);
    if (fault) return spore_error_set(error, SPORE_ERROR_INPUT, place, "%s", fault);
    const SporeTool *tool = make_tool(world, from, spring_start);
    if (tool) spring_start += tool->spring_count;
    made = tool != NULL;
    heats |= from->type->heats;
  }
  made =
      made && spore_world_create_cutting(world) && spore_world_create_splitting(world) && prepare_models(world, heats);
  return made || spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the tools"));
}

static void count_tools(SporeWorld *world) {
  SporeToolCounts counts = {.poured = world->tools.counts.poured};
  for (size_t i = 0; i < world->tools.count; i++) {
    SporeToolState state = spore_world_tool_state(world, i);
    counts.cut += state.cut;
    counts.pierced += state.pierced;
    counts.stitches += state.stitches;
  }
  world->tools.counts = counts;
}

void spore_world_reset_tools(SporeWorld *world) {
  for (size_t i = 0; i < world->tools.count; i++) {
    SporeTool *tool = world->tools.all[i];
    tool->effect = tool->effect_at_start;
    if (tool->type->reset) tool->type->reset(world, tool);
  }
  for (size_t b = 0; b < world->body_count; b++) world->bodies[b].marks = (SporeBodyMarks){0};
  world->tools.counts.poured = 0;
  count_tools(world);
}

void spore_world_set_tool_effect(SporeWorld *world, size_t index, bool on) {
  assert(index < world->tools.count);
  SporeTool *tool = world->tools.all[index];
  if (!tool->type->set_effect || tool->effect == on) return;
  tool->effect = on;
  tool->type->set_effect(world, tool);
  spore_world_wake_all(world);
  world->schedule.stale = true;
}

bool spore_world_is_led_by_effect(const SporeWorld *world, uint32_t body) {
  for (size_t i = 0; i < world->tools.count; i++) {
    const SporeTool *tool = world->tools.all[i];
    for (int part = 0; tool->effect && part < SPORE_TOOL_BODIES; part++)
      if (tool->bodies[part] == body) return true;
  }
  return false;
}

void spore_world_follow_tools(SporeWorld *world, uint32_t index) {
  assert(index < world->body_count && world->bodies[index].role == SPORE_ACTIVE);
  SporeBody *body = &world->bodies[index];
  const double *q = world->state.q + body->q_offset;
  double time_s = (double)world->state.step * world->solver.time_step;
  spore_guard_start(&body->device.guard, time_s, spore_pose_load(q));
  for (size_t i = 0; i < world->tools.count; i++) {
    SporeTool *tool = world->tools.all[i];
    bool has = false;
    for (int part = 0; part < SPORE_TOOL_BODIES; part++) has |= tool->bodies[part] == index;
    if (has && tool->type->follow) tool->type->follow(world, tool);
  }
}

void spore_world_clear_tools(SporeWorld *world) {
  for (size_t i = 0; i < world->tools.count; i++) {
    SporeTool *tool = world->tools.all[i];
    if (tool->type->clear) tool->type->clear(tool);
    spore_free(tool->name);
    spore_free(tool);
  }
  spore_free(world->tools.all);
  spore_free(world->tools.emitters);
}

void spore_world_use_tools(SporeWorld *world) {
  for (size_t i = 0; i < world->tools.count; i++) {
    SporeTool *tool = world->tools.all[i];
    if (tool->type->use) tool->type->use(world, tool);
  }
  count_tools(world);
}

void spore_world_tear_holds(SporeWorld *world) {
  for (size_t i = 0; i < world->tools.count; i++) {
    SporeTool *tool = world->tools.all[i];
    if (tool->type->tear) tool->type->tear(world, tool);
  }
}

void spore_world_feed_back_tools(SporeWorld *world) {
  for (size_t i = 0; i < world->tools.count; i++) {
    const SporeTool *tool = world->tools.all[i];
    if (tool->type->feed_back) tool->type->feed_back(world, tool);
  }
}

const char *spore_tool_point_fault(const double point[3]) {
  if (spore_vec3_is_finite(spore_vec3_load(point))) return NULL;
  return _("a point of the tool is not finite; expected it in m; correct it");
}

SporeVec3 spore_tool_direction(const SporeWorld *world, uint32_t body, const double direction[3]) {
  assert(body < world->body_count);
  SporeQuat back = spore_quat_conjugate(world->bodies[body].rest_pose.orientation);
  return spore_quat_rotate(back, spore_vec3_normalise(spore_vec3_load(direction), (SporeVec3){0, 0, 0}));
}

bool spore_tool_button(const SporeWorld *world, uint32_t body, uint32_t button) {
  assert(body == SPORE_NO_BODY || body < world->body_count);
  const SporeBodyDevice *device = body == SPORE_NO_BODY ? NULL : &world->bodies[body].device;
  return device && device->has_input && (device->input.buttons & button);
}

size_t spore_world_tool_holds(const SporeWorld *world, size_t index, uint32_t body) {
  assert(index < world->tools.count && body < world->body_count);
  const SporeTool *tool = world->tools.all[index];
  return tool->type->holds ? tool->type->holds(world, tool, body) : 0;
}

size_t spore_world_emitter_count(const SporeWorld *world) { return world->tools.emitter_count; }

bool spore_world_emitter_is_effect(const SporeWorld *world, size_t index) {
  assert(index < world->tools.emitter_count);
  return world->tools.emitters[index].effect;
}

size_t spore_world_tool_count(const SporeWorld *world) { return world->tools.count; }

SporeVec3 spore_world_tool_tip(const SporeWorld *world, size_t index) {
  assert(index < world->tools.count);
  const SporeTool *tool = world->tools.all[index];
  const double *q = world->state.q + world->bodies[tool->bodies[0]].q_offset;
  return spore_pose_apply(spore_pose_load(q), tool->tip);
}

const SporeToolType *spore_world_tool_type(const SporeWorld *world, size_t index) {
  assert(index < world->tools.count);
  return world->tools.all[index]->type;
}

bool spore_world_tool_is_effect(const SporeWorld *world, size_t index) {
  assert(index < world->tools.count);
  return world->tools.all[index]->effect;
}

SporeToolState spore_world_tool_state(const SporeWorld *world, size_t index) {
  assert(index < world->tools.count);
  const SporeTool *tool = world->tools.all[index];
  SporeToolState state = {.name = tool->name};
  if (tool->type->state) tool->type->state(tool, &state);
  return state;
}
