/* Checks of kept poses: whether they still are of their bodies. */
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

void spore_check_poses(SporeCheck *check, const SporeSimulation *simulation) {
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    check_pose(check, simulation, spore_object_child(bodies, i));
}
