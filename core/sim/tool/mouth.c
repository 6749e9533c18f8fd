/* Where a body is in the next state, and the mouth of an emitter on it: a place of the body, and the way out. A rigid
 * body takes both along, on tissue they sit by nodes. */
#include <assert.h>

#include "core/sim/world_private.h"

SporePose spore_world_next_pose(const SporeWorld *world, uint32_t body) {
  assert(body == SPORE_NO_BODY || body < world->body_count);
  if (body == SPORE_NO_BODY) return spore_pose_identity();
  if (world->bodies[body].role == SPORE_UNMOVABLE) return world->bodies[body].rest_pose;
  const double *q = world->state.next_q + world->bodies[body].q_offset;
  return spore_pose_load(q);
}

static bool deforms(const SporeBody *body) { return body->model && !spore_model_is_rigid(body->model); }

static SporeSeatPoints nodes_of(const SporeBody *body, const double *q) {
  return (SporeSeatPoints){.q = q, .count = (uint32_t)body->model->node_count};
}

SporePose spore_emitter_frame(const SporeWorld *world, const SporeEmitter *emitter) {
  if (emitter->seat.point == SPORE_NO_POINT) return spore_world_next_pose(world, emitter->source);
  const SporeBody *body = &world->bodies[emitter->source];
  const double *q = (spore_body_lies_still(body) ? world->state.q : world->state.next_q) + body->q_offset;
  SporeSeatPoints nodes = nodes_of(body, q);
  SporePose frame = spore_seat_frame(&emitter->seat, &nodes);
  if (body->lod && body->grade != SPORE_LOD_FINE) frame.orientation = spore_quat_identity(); /* has other nodes */
  return frame;
}

void spore_emitter_set_mouth(const SporeWorld *world, SporeEmitter *emitter, SporeVec3 point, SporeVec3 direction) {
  assert(emitter->source == SPORE_NO_BODY || emitter->source < world->body_count);
  const SporeBody *source = emitter->source == SPORE_NO_BODY ? NULL : &world->bodies[emitter->source];
  SporePose frame = source ? source->rest_pose : spore_pose_identity();
  emitter->seat.point = SPORE_NO_POINT;
  emitter->rest = spore_pose_apply_inverse(frame, point);
  if (source && deforms(source)) {
    SporeSeatPoints nodes = nodes_of(source, world->state.rest_q + source->q_offset);
    spore_seat_find(&emitter->seat, &nodes, point);
    frame = spore_pose_identity();
    frame.position = spore_vec3_load(nodes.q + 3 * (size_t)emitter->seat.point);
  }
  SporeQuat back = spore_quat_conjugate(frame.orientation);
  emitter->point = spore_quat_rotate(back, spore_vec3_sub(point, frame.position));
  emitter->direction = spore_quat_rotate(back, spore_vec3_normalise(direction, (SporeVec3){0, 0, 0}));
}
