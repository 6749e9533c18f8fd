/* Scissors: what they take from bodies. The way of a blade in a step is two triangles; a model says itself what of it
 * crosses them. */
#include "core/sim/world_private.h"

/* The end of a blade, world. */
static SporeVec3 blade_tip(const SporeTool *tool, const double *shaft, double half) {
  const SporePose frame = {spore_vec3_load(shaft), spore_quat_load(shaft + 3)};
  SporeQuat turn = spore_quat_from_rotation_vector(spore_vec3_scale(half, tool->axis));
  SporeVec3 arm = spore_quat_rotate(turn, spore_vec3_sub(tool->point, tool->hinge));
  return spore_pose_apply(frame, spore_vec3_add(tool->hinge, arm));
}

static SporeVec3 blade_root(const SporeTool *tool, const double *shaft) {
  return spore_pose_apply((SporePose){spore_vec3_load(shaft), spore_quat_load(shaft + 3)}, tool->hinge);
}

static void store_triangle(double *triangle, SporeVec3 a, SporeVec3 b, SporeVec3 c) {
  spore_vec3_store(triangle, a);
  spore_vec3_store(triangle + 3, b);
  spore_vec3_store(triangle + 6, c);
}

static void cut_all(SporeWorld *world, SporeTool *tool, const double *triangle) {
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (!spore_body_can_be_cut(body)) continue;
    size_t count =
        body->model->type->cut(body->model, world->state.q + body->q_offset, triangle, b, &world->topology.cuts);
    if (count > 0) spore_body_was_cut(world, b);
    tool->cut += count;
  }
}

/* What is cut moves between steps: the blades cut a little behind them too, where they have been in this stroke, so
 * that nothing slips past. */
#define OVERLAP_RAD 0.1

void spore_scissors_cut(SporeWorld *world, SporeTool *tool, double from, double to) {
  from = fmin(tool->stroke, from + OVERLAP_RAD);
  size_t at = world->bodies[tool->body].q_offset;
  const double *before = world->state.q + at, *after = world->state.target_q + at;
  SporeVec3 root = blade_root(tool, before), next_root = blade_root(tool, after);
  double triangle[9];
  for (int side = -1; side <= 1; side += 2) {
    SporeVec3 tip = blade_tip(tool, before, 0.5 * side * from), next_tip = blade_tip(tool, after, 0.5 * side * to);
    store_triangle(triangle, root, tip, next_tip);
    cut_all(world, tool, triangle);
    store_triangle(triangle, root, next_tip, next_root);
    cut_all(world, tool, triangle);
  }
  if (to > 0) return;
  /* What lies just where the blades meet is on the way of neither. */
  store_triangle(triangle, root, blade_tip(tool, before, 0.5 * from), blade_tip(tool, before, -0.5 * from));
  cut_all(world, tool, triangle);
}
