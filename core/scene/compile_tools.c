#include "core/scene/compile_private.h"

#include <string.h>

static gboolean add_jaws(SporeCompiler *compiler, const SporeObject *object, SporeToolKind kind) {
  SporeJawToolFields fields = {0};
  spore_object_fields(object, &fields);
  SporeToolDescription tool = {.name = fields.name,
                               .kind = kind,
                               .hinge = spore_vec3_load(fields.hinge),
                               .axis = spore_vec3_load(fields.axis),
                               .point = spore_vec3_load(fields.tip),
                               .jaws = fields.jaws};
  if (!spore_compiler_body_index(compiler, object, "body", &tool.body) ||
      !spore_compiler_body_index(compiler, object, "jaw_a", &tool.jaw_a) ||
      !spore_compiler_body_index(compiler, object, "jaw_b", &tool.jaw_b))
    return FALSE;
  g_array_append_val(compiler->tools, tool);
  return TRUE;
}

static gboolean add_suction(SporeCompiler *compiler, const SporeObject *object) {
  SporeSuctionToolFields fields = {0};
  spore_object_fields(object, &fields);
  SporeToolDescription tool = {.name = fields.name,
                               .kind = SPORE_TOOL_SUCTION,
                               .point = spore_vec3_load(fields.point),
                               .suction = fields.suction};
  if (!spore_compiler_body_index(compiler, object, "body", &tool.body)) return FALSE;
  g_array_append_val(compiler->tools, tool);
  return TRUE;
}

static gboolean add_bipolar(SporeCompiler *compiler, const SporeObject *object) {
  SporeBipolarToolFields fields = {0};
  spore_object_fields(object, &fields);
  SporeToolDescription tool = {.name = fields.name,
                               .kind = SPORE_TOOL_BIPOLAR,
                               .point = spore_vec3_load(fields.point),
                               .bipolar = fields.bipolar};
  if (!spore_compiler_body_index(compiler, object, "body", &tool.body)) return FALSE;
  g_array_append_val(compiler->tools, tool);
  return TRUE;
}

static gboolean add_needle(SporeCompiler *compiler, const SporeObject *object) {
  SporeNeedleToolFields fields = {0};
  spore_object_fields(object, &fields);
  SporeToolDescription tool = {.name = fields.name,
                               .kind = SPORE_TOOL_NEEDLE,
                               .point = spore_vec3_load(fields.tip),
                               .middle = spore_vec3_load(fields.middle),
                               .swage = spore_vec3_load(fields.swage),
                               .needle = fields.needle};
  if (!spore_compiler_body_index(compiler, object, "body", &tool.body) ||
      !spore_compiler_body_index(compiler, object, "thread", &tool.thread))
    return FALSE;
  g_array_append_val(compiler->tools, tool);
  return TRUE;
}

gboolean spore_compiler_add_emitter(SporeCompiler *compiler, const SporeObject *object) {
  SporeWoundFields fields = {0};
  spore_object_fields(object, &fields);
  SporeEmitterDescription emitter = {.name = fields.name,
                                     .point = spore_vec3_load(fields.point),
                                     .direction = spore_vec3_load(fields.direction),
                                     .fields = fields.emitter};
  if (!spore_compiler_body_index(compiler, object, "body", &emitter.body) ||
      !spore_compiler_body_index(compiler, object, "source", &emitter.source))
    return FALSE;
  g_array_append_val(compiler->emitters, emitter);
  return TRUE;
}

gboolean spore_compiler_add_tool(SporeCompiler *compiler, const SporeObject *object) {
  const char *element = spore_object_type(object)->element;
  if (strcmp(element, "grasper") == 0) return add_jaws(compiler, object, SPORE_TOOL_GRASPER);
  if (strcmp(element, "clamp") == 0) return add_jaws(compiler, object, SPORE_TOOL_CLAMP);
  if (strcmp(element, "scissors") == 0) return add_jaws(compiler, object, SPORE_TOOL_SCISSORS);
  if (strcmp(element, "bipolar") == 0) return add_bipolar(compiler, object);
  if (strcmp(element, "suction") == 0) return add_suction(compiler, object);
  if (strcmp(element, "needle") == 0) return add_needle(compiler, object);
  return TRUE;
}
