/* Checks of kept poses: whether they still are of their bodies, and what jaws let go. */
#include <glib/gi18n.h>

#include "core/scene/check_private.h"
#include "core/scene/kept_pose.h"

static void check_pose(SporeCheck *check, const SporeSimulation *simulation, SporeObject *body) {
  guint32 index = spore_simulation_body_of(simulation, body);
  const char *name = spore_object_name(body);
  if (index == SPORE_NO_BODY || !spore_object_text(body, "kept_pose")) return;
  if ((SporeRole)spore_object_number(body, "role") == SPORE_UNMOVABLE) {
    spore_check_say(check, SPORE_NOTE, body, _("take kept_pose out, or make it movable"),
                    _("\"%s\" has a kept pose, and does not move"), name);
    spore_check_offer_set(check, body, "kept_pose", NULL);
    return;
  }
  const SporeModel *model =
      spore_world_lod_model(simulation->world, index, spore_world_first_lod(simulation->world, index));
  SporeKeptPoseState state;
  double *q;
  gsize count;
  g_autoptr(GError) error = NULL;
  if (!spore_kept_pose_read(check->document, body, model, spore_world_start_pose(simulation->world, index), &state, &q,
                            &count, &error))
    spore_check_say_error(check, SPORE_FAULT, body, error);
  else if (state == SPORE_POSE_STALE) {
    spore_check_say(check, SPORE_WARNING, body, _("play and keep the pose again, or take kept_pose out"),
                    _("the kept pose of \"%s\" is of another shape or model: it begins as its geometry says"), name);
    spore_check_offer_set(check, body, "kept_pose", NULL);
  }
  g_free(q);
}

/* Whether a ball of the jaw touches one of the passive body at the start. */
static gboolean touches(const SporeSimulation *simulation, guint32 jaw, guint32 body) {
  const SporeSpheres *spheres = spore_world_spheres(simulation->world);
  for (size_t i = 0; i < spheres->count; i++) {
    if (spheres->body[i] != jaw) continue;
    SporeVec3 at = spore_vec3_load(spheres->centre + 3 * i);
    for (size_t j = 0; j < spheres->count; j++)
      if (spheres->body[j] == body &&
          spore_vec3_distance(at, spore_vec3_load(spheres->centre + 3 * j)) < spheres->radius[i] + spheres->radius[j])
        return TRUE;
  }
  return FALSE;
}

/* The jaw's body; SPORE_NO_BODY: the jaw has none, or begins as modelled. */
static guint32 kept_jaw(const SporeSimulation *simulation, SporeObject *tool, const char *property) {
  SporeObject *body = spore_object_reference(tool, property);
  return body && spore_object_text(body, "kept_pose") ? spore_simulation_body_of(simulation, body) : SPORE_NO_BODY;
}

/* Jaws that were kept with something between them do not hold it. */
static void check_tool(SporeCheck *check, const SporeSimulation *simulation, const SporeToolType *type,
                       const char *name) {
  SporeObject *tool = type->holds ? spore_document_find(check->document, type->element, name) : NULL;
  guint32 one = tool ? kept_jaw(simulation, tool, "jaw_a") : SPORE_NO_BODY;
  guint32 other = tool ? kept_jaw(simulation, tool, "jaw_b") : SPORE_NO_BODY;
  if (one == SPORE_NO_BODY || other == SPORE_NO_BODY) return;
  for (guint32 body = 0; body < spore_world_body_count(simulation->world); body++)
    if (spore_world_body_role(simulation->world, body) == SPORE_PASSIVE && touches(simulation, one, body) &&
        touches(simulation, other, body))
      spore_check_say(check, SPORE_NOTE, tool, _("close them at the start, or let a link hold it"),
                      _("\"%s\" has its jaws about \"%s\" as they were kept, and holds it only when its device closes "
                        "them"),
                      name, spore_world_body_name(simulation->world, body));
}

void spore_check_poses(SporeCheck *check, const SporeSimulation *simulation) {
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    check_pose(check, simulation, spore_object_child(bodies, i));
  for (gsize i = 0; i < spore_world_tool_count(simulation->world); i++)
    check_tool(check, simulation, spore_world_tool_type(simulation->world, i),
               spore_world_tool_state(simulation->world, i).name);
}
