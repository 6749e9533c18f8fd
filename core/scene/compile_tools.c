/* Describes tools and effects of a document to the world. */
#include <string.h>

#include "core/scene/camera_sight.h"
#include "core/scene/compile_private.h"
#include "core/scene/fidelity.h"

/* The bodies that the type's parameters refer to, in their order. */
static gboolean find_bodies(SporeCompiler *compiler, const SporeObject *object, SporeToolDescription *tool) {
  const SporeParameterTable *table = &tool->type->parameters;
  guint count = 0;
  for (gsize i = 0; i < table->count; i++) {
    const SporeParameter *parameter = &table->parameters[i];
    if (parameter->type != SPORE_REFERENCE || strcmp(parameter->references, "body") != 0) continue;
    if (!spore_compiler_body_index(compiler, object, parameter->name, &tool->bodies[count++])) return FALSE;
  }
  while (count < SPORE_TOOL_BODIES) tool->bodies[count++] = SPORE_NO_BODY;
  return TRUE;
}

/* Whoever looks through a camera sees what is near it: bodies may be fine there. */
static gboolean add_eye(SporeCompiler *compiler, const SporeObject *camera) {
  SporeCameraFields fields;
  spore_object_fields(camera, &fields);
  SporeVec3 point = spore_vec3_load(fields.position), along = spore_vec3_sub(spore_camera_sight(&fields), point);
  SporeEyeDescription eye = {.point = point,
                             .sight = spore_vec3_normalise(along, spore_vec3(0, 0, -1)),
                             .lens = fields.lens,
                             .haze_s = fields.haze};
  if (!spore_compiler_body_index(compiler, camera, "body", &eye.body)) return FALSE;
  g_array_append_val(compiler->eyes, eye);
  return TRUE;
}

gboolean spore_compiler_add_tool(SporeCompiler *compiler, const SporeObject *object) {
  const char *element = spore_object_type(object)->element;
  SporeToolDescription tool = {.type = spore_tool_type_find(element)};
  if (strcmp(element, "camera") == 0) return add_eye(compiler, object);
  if (!tool.type) return TRUE; /* a probe only moves its body */
  gpointer fields = spore_compiler_keep(compiler, tool.type->parameters.size);
  spore_object_fields(object, fields);
  tool.fields = fields;
  tool.effect = spore_fidelity_is_effect(compiler->document, object);
  if (!find_bodies(compiler, object, &tool)) return FALSE;
  g_array_append_val(compiler->tools, tool);
  return TRUE;
}

gboolean spore_compiler_add_emitter(SporeCompiler *compiler, const SporeObject *object) {
  SporeWoundFields fields = {0};
  spore_object_fields(object, &fields);
  SporeEmitterDescription emitter = {.name = fields.name,
                                     .point = spore_vec3_load(fields.point),
                                     .direction = spore_vec3_load(fields.direction),
                                     .fields = fields.emitter,
                                     .effect = spore_fidelity_is_effect(compiler->document, object)};
  if (!spore_compiler_body_index(compiler, object, "body", &emitter.body) ||
      !spore_compiler_body_index(compiler, object, "source", &emitter.source))
    return FALSE;
  g_array_append_val(compiler->emitters, emitter);
  return TRUE;
}
