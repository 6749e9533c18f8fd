/* What a hand may lead. */
#include "ui/document/hands.h"

#include "core/sim/world.h"

static gboolean names(const SporeObject *tool, const char *property, const SporeObject *body) {
  return spore_parameter_find(spore_object_type(tool)->table, property) >= 0 &&
         spore_object_reference(tool, property) == body;
}

/* The tool of this body, its own or one that it is a jaw of. A camera only looks. NULL: none. */
static SporeObject *tool_of(SporeDocument *document, const SporeObject *body) {
  SporeObject *tools = spore_document_section(document, "tools");
  for (guint i = 0; i < spore_object_child_count(tools); i++) {
    SporeObject *tool = spore_object_child(tools, i);
    gboolean looks = g_str_equal(spore_object_type(tool)->element, "camera");
    if (!looks && (names(tool, "body", body) || names(tool, "jaw_a", body) || names(tool, "jaw_b", body))) return tool;
  }
  return NULL;
}

SporeObject *spore_hand_of(SporeDocument *document, SporeObject *object) {
  const SporeObject *tools = spore_document_section(document, "tools");
  while (object && spore_object_parent(object) != tools && !g_str_equal(spore_object_type(object)->element, "body"))
    object = spore_object_parent(object);
  if (!object) return NULL;
  gboolean is_tool = spore_object_parent(object) == tools;
  const SporeObject *tool = is_tool ? object : tool_of(document, object);
  SporeObject *led = tool && spore_parameter_find(spore_object_type(tool)->table, "body") >= 0
                         ? spore_object_reference(tool, "body")
                         : NULL;
  SporeObject *body = led || is_tool ? led : object;
  return body && (SporeRole)spore_object_number(body, "role") == SPORE_ACTIVE ? body : NULL;
}

GPtrArray *spore_hands(SporeDocument *document) {
  GPtrArray *hands = g_ptr_array_new();
  SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    if (spore_hand_of(document, body) == body) g_ptr_array_add(hands, body);
  }
  return hands;
}

/* A jaw that the tool does not have is its body. */
gboolean spore_hand_jaws(SporeDocument *document, const SporeObject *hand, SporeObject *jaws[2]) {
  static const char *const properties[2] = {"jaw_a", "jaw_b"};
  const SporeObject *tool = tool_of(document, hand);
  if (!tool || spore_parameter_find(spore_object_type(tool)->table, "jaw_a") < 0) return FALSE;
  for (int i = 0; i < 2; i++) {
    jaws[i] = spore_object_reference(tool, properties[i]);
    if (!jaws[i]) jaws[i] = spore_object_reference(tool, "body");
  }
  return jaws[0] && jaws[1] && jaws[0] != jaws[1];
}

gboolean spore_hand_latches(SporeDocument *document, const SporeObject *hand) {
  const SporeObject *tool = tool_of(document, hand);
  return tool && g_str_equal(spore_object_type(tool)->element, "clamp");
}

gboolean spore_hand_pours(SporeDocument *document, const SporeObject *hand) {
  const SporeObject *effects = spore_document_section(document, "effects");
  for (guint i = 0; i < spore_object_child_count(effects); i++) {
    const SporeObject *emitter = spore_object_child(effects, i);
    if (spore_object_reference(emitter, "source") == hand &&
        (int)spore_object_number(emitter, "trigger") == SPORE_FLOW_SECOND_BUTTON)
      return TRUE;
  }
  return FALSE;
}
