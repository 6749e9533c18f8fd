/* Where a body is in the next state, and the mouth of an emitter on it: a place of the body, and the way out.
 *
 * A rigid body takes both along. On tissue the mouth goes with the node that was nearest at time 0, and turns with the
 * triangle of that node and two nodes near it, or with the line to one of them where all lie on a line. */
#include <assert.h>
#include <math.h>

#include "core/sim/world_private.h"

#define NEAR 2.5     /* times as far as the nearest node: no farther off is the third */
#define ON_A_LINE .2 /* sine of the triangle's angle: below, the nodes lie on a line */

SporePose spore_world_next_pose(const SporeWorld *world, uint32_t body) {
  assert(body == SPORE_NO_BODY || body < world->body_count);
  if (body == SPORE_NO_BODY) return spore_pose_identity();
  if (world->bodies[body].role == SPORE_UNMOVABLE) return world->bodies[body].rest_pose;
  const double *q = world->state.next_q + world->bodies[body].q_offset;
  return (SporePose){spore_vec3_load(q), spore_quat_load(q + 3)};
}

static bool deforms(const SporeBody *body) { return body->model && !spore_model_is_rigid(body->model); }

/* The triangle of the emitter's nodes; *sine: of its angle at the mouth. */
static SporeMat3 triangle_of(const SporeEmitter *emitter, const double *q, double *sine) {
  SporeVec3 at = spore_vec3_load(q + 3 * (size_t)emitter->node), none = {0, 0, 0};
  SporeVec3 one = spore_vec3_sub(spore_vec3_load(q + 3 * (size_t)emitter->beside[0]), at);
  SporeVec3 other = spore_vec3_sub(spore_vec3_load(q + 3 * (size_t)emitter->beside[1]), at);
  one = spore_vec3_normalise(one, none), other = spore_vec3_normalise(other, none);
  SporeVec3 normal = spore_vec3_cross(one, other);
  *sine = spore_vec3_length(normal);
  normal = spore_vec3_normalise(normal, none);
  return spore_mat3_from_columns(one, spore_vec3_cross(normal, one), normal);
}

/* How the tissue has turned about the mouth since time 0. */
static SporeQuat turn_of(const SporeEmitter *emitter, const double *q) {
  double sine;
  SporeMat3 now = triangle_of(emitter, q, &sine);
  if (!(spore_vec3_length(spore_mat3_column(now, 0)) > 0)) return (SporeQuat){1, 0, 0, 0}; /* two nodes in one place */
  if (emitter->on_a_line) return spore_quat_between(spore_mat3_column(emitter->triangle, 0), spore_mat3_column(now, 0));
  if (!(sine > 0)) return (SporeQuat){1, 0, 0, 0};
  return spore_quat_from_mat3(spore_mat3_multiply(now, spore_mat3_transpose(emitter->triangle)));
}

static double apart(const double *q, uint32_t a, uint32_t b) {
  return spore_vec3_distance(spore_vec3_load(q + 3 * (size_t)a), spore_vec3_load(q + 3 * (size_t)b));
}

/* The node that is nearest to the place, besides one in the same place as the mouth's. */
static uint32_t nearest_node(const double *q, uint32_t count, SporeVec3 place, uint32_t but) {
  uint32_t nearest = SPORE_NO_NODE;
  double least = INFINITY;
  for (uint32_t i = 0; i < count; i++) {
    double off = spore_vec3_distance(spore_vec3_load(q + 3 * (size_t)i), place);
    if (!(off < least) || (but != SPORE_NO_NODE && !(apart(q, i, but) > 0))) continue;
    least = off;
    nearest = i;
  }
  return nearest;
}

/* Two nodes beside the mouth's: the nearest, and of those near it the one that is least on a line with it. */
static void find_beside(SporeEmitter *emitter, const double *q, uint32_t count) {
  SporeVec3 at = spore_vec3_load(q + 3 * (size_t)emitter->node);
  uint32_t one = nearest_node(q, count, at, emitter->node);
  double most = -1, sine;
  if (one == SPORE_NO_NODE) one = emitter->node;
  emitter->beside[0] = one;
  uint32_t best = one;
  for (uint32_t i = 0; i < count; i++) {
    emitter->beside[1] = i;
    if (apart(q, i, emitter->node) > NEAR * apart(q, one, emitter->node)) continue;
    triangle_of(emitter, q, &sine);
    if (sine > most) most = sine, best = i;
  }
  emitter->beside[1] = best;
  emitter->triangle = triangle_of(emitter, q, &sine);
  emitter->on_a_line = sine < ON_A_LINE;
}

SporePose spore_emitter_frame(const SporeWorld *world, const SporeEmitter *emitter) {
  if (emitter->node == SPORE_NO_NODE) return spore_world_next_pose(world, emitter->source);
  const SporeBody *body = &world->bodies[emitter->source];
  const double *q = (spore_body_lies_still(body) ? world->state.q : world->state.next_q) + body->q_offset;
  uint32_t last = (uint32_t)body->model->node_count - 1;
  SporePose frame = spore_pose_identity();
  if (body->lod && body->grade != SPORE_LOD_FINE) { /* has other nodes */
    frame.position = spore_vec3_load(q + 3 * (size_t)(emitter->node < last ? emitter->node : last));
    return frame;
  }
  frame.position = spore_vec3_load(q + 3 * (size_t)emitter->node);
  if (emitter->beside[0] <= last && emitter->beside[1] <= last) frame.orientation = turn_of(emitter, q);
  return frame;
}

void spore_emitter_set_mouth(const SporeWorld *world, SporeEmitter *emitter, SporeVec3 point, SporeVec3 direction) {
  assert(emitter->source == SPORE_NO_BODY || emitter->source < world->body_count);
  const SporeBody *source = emitter->source == SPORE_NO_BODY ? NULL : &world->bodies[emitter->source];
  SporePose frame = source ? source->rest_pose : spore_pose_identity();
  emitter->node = SPORE_NO_NODE;
  if (source && deforms(source)) {
    const double *q = world->state.rest_q + source->q_offset;
    emitter->node = nearest_node(q, (uint32_t)source->model->node_count, point, SPORE_NO_NODE);
    find_beside(emitter, q, (uint32_t)source->model->node_count);
    frame = spore_pose_identity();
    frame.position = spore_vec3_load(q + 3 * (size_t)emitter->node);
  }
  SporeQuat back = spore_quat_conjugate(frame.orientation);
  emitter->point = spore_quat_rotate(back, spore_vec3_sub(point, frame.position));
  emitter->direction = spore_quat_rotate(back, spore_vec3_normalise(direction, (SporeVec3){0, 0, 0}));
}
