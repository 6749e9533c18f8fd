/* Checks of levels of detail that are to change by themselves: rules that have nothing to act on. */
#include <glib/gi18n.h>

#include "core/scene/check_private.h"

static gboolean has_active(const SporeWorld *world) {
  for (guint32 b = 0; b < spore_world_body_count(world); b++)
    if (spore_world_body_role(world, b) == SPORE_ACTIVE) return TRUE;
  return FALSE;
}

static gboolean has_camera(const SporeCheck *check) {
  const SporeObject *tools = spore_document_section(check->document, "tools");
  for (guint i = 0; i < spore_object_child_count(tools); i++)
    if (g_str_equal(spore_object_type(spore_object_child(tools, i))->element, "camera")) return TRUE;
  return FALSE;
}

static void check_rule(SporeCheck *check, const SporeObject *fidelity, const SporeWorld *world, guint32 body) {
  SporeLodRule rule = spore_world_lod_rule(world, body);
  const char *name = spore_world_body_name(world, body);
  gboolean tools = rule.tool_distance > 0 && has_active(world), eyes = rule.view_distance > 0 && has_camera(check);
  if (rule.by == SPORE_LOD_BY_DISTANCE && !tools && !eyes)
    spore_check_say(check, SPORE_WARNING, fidelity,
                    _("add an instrument or a camera, or make the distance larger than 0"),
                    _("the level of \"%s\" goes by distance, and nothing counts that could be near: it stays at its "
                      "coarsest level"),
                    name);
  if (rule.by != SPORE_LOD_BY_DISTANCE && spore_world_may_be_cut(world, body))
    spore_check_say(check, SPORE_NOTE, fidelity, _("let its level go by distance, or nothing, if it should stay fine"),
                    _("the level of \"%s\" does not get coarser by itself: it may be cut or torn, at level fine alone"),
                    name);
}

void spore_check_levels(SporeCheck *check, const SporeSimulation *simulation) {
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    const SporeObject *fidelity = spore_object_child_of(body, "fidelity");
    if (!fidelity || (int)spore_object_number(fidelity, "automatic") == SPORE_LOD_BY_HAND) continue;
    if (spore_object_child_count(fidelity) == 0)
      spore_check_say(check, SPORE_WARNING, fidelity, _("add <coarse> or <medium> to its fidelity"),
                      _("\"%s\" is to change its level by itself, and has but one"), spore_object_name(body));
    else check_rule(check, fidelity, simulation->world, spore_simulation_body_of(simulation, body));
  }
}
