/* Ports for an instrument that a device moves: the tip is where the device puts it, and the shaft passes through the
 * port. */
#include "core/sim/world_private.h"

#define LEAST_M 1e-6 /* least distance to the pivot: nearer, the direction is undefined */

static SporeVec3 to_frame(SporeQuat orientation, SporeVec3 a) {
  return spore_quat_rotate(spore_quat_conjugate(orientation), a);
}

void spore_trocar_make(const SporeWorld *world, SporeTrocar *trocar, const SporeLinkDescription *from) {
  const SporePose *pose = &world->bodies[from->body_a].rest_pose;
  *trocar = (SporeTrocar){.body = from->body_a, .pivot = from->point_a};
  SporeVec3 along = spore_vec3_normalise(from->direction, (SporeVec3){0, 0, 0});
  trocar->along = to_frame(pose->orientation, along);
  trocar->base = to_frame(pose->orientation, spore_vec3_sub(from->point_a, pose->position));
  /* The point of the line that is nearest to the body's origin. */
  trocar->base = spore_vec3_add_scaled(trocar->base, -spore_vec3_dot(trocar->base, trocar->along), trocar->along);
}

void spore_trocar_aim(const SporeWorld *world, const SporeTrocar *trocar) {
  double *target = world->state.target_q + world->bodies[trocar->body].q_offset;
  SporeQuat orientation = spore_quat_load(target + 3);
  SporeVec3 to_pivot = spore_vec3_sub(trocar->pivot, spore_vec3_load(target));
  double distance = spore_vec3_length(to_pivot), aside = spore_vec3_length(trocar->base);
  if (!(distance > aside + LEAST_M)) return;
  /* Of the two points of the line that are as far from the origin as the pivot is, take the one nearer to the pivot. */
  double reach = sqrt(distance * distance - aside * aside);
  SporeVec3 ahead = spore_vec3_add_scaled(trocar->base, reach, trocar->along);
  SporeVec3 behind = spore_vec3_add_scaled(trocar->base, -reach, trocar->along);
  SporeVec3 wanted = to_frame(orientation, to_pivot);
  bool forward = spore_vec3_dot(wanted, ahead) >= spore_vec3_dot(wanted, behind);
  SporeVec3 from = spore_quat_rotate(orientation, spore_vec3_scale(1 / distance, forward ? ahead : behind));
  SporeQuat turn = spore_quat_between(from, spore_vec3_scale(1 / distance, to_pivot));
  spore_quat_store(target + 3, spore_quat_normalise(spore_quat_multiply(turn, orientation)));
}
