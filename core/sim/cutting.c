/* Scissors: what they take from bodies, and how the spheres there follow.
 *
 * The way of a blade in a step is two triangles. A model says itself what of it crosses them; a sphere that hangs on
 * nodes of both sides of a cut stays with those that it hangs on more. */
#include <string.h>

#include "core/base/memory.h"
#include "core/sim/world_private.h"

static bool can_be_cut(const SporeBody *body) { return body->model && body->model->type->cut; }

bool spore_world_compile_cutting(SporeWorld *world) {
  bool cuts = false, made = true;
  for (size_t i = 0; i < world->tool_count; i++) cuts |= world->tools[i].kind == SPORE_TOOL_SCISSORS;
  for (size_t b = 0; made && cuts && b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (!can_be_cut(body)) continue;
    made = body->model->type->prepare_cut(body->model, &world->cuts.capacity);
    if (!made || body->spheres.kind != SPORE_MAPPING_LINEAR) continue;
    size_t count = body->spheres.row_start[body->spheres.point_count];
    body->whole_weight = SPORE_NEW_ARRAY(double, count);
    made = body->whole_weight != NULL;
    if (made) memcpy(body->whole_weight, body->spheres.weight, count * sizeof(double));
  }
  world->cuts.edges = SPORE_NEW_ARRAY(SporeCutEdge, world->cuts.capacity);
  return made && world->cuts.edges;
}

void spore_world_mend_bodies(SporeWorld *world) {
  world->cuts.count = 0;
  world->cut_run++;
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (body->model && body->model->type->mend) body->model->type->mend(body->model);
    if (!body->whole_weight) continue;
    memcpy(body->spheres.weight, body->whole_weight,
           body->spheres.row_start[body->spheres.point_count] * sizeof(double));
  }
}

static bool are_parted(const double *q, uint32_t a, uint32_t b, const double *triangle) {
  return spore_vec3_crosses(spore_vec3_load(q + 3 * (size_t)a), spore_vec3_load(q + 3 * (size_t)b),
                            spore_vec3_load(triangle), spore_vec3_load(triangle + 3), spore_vec3_load(triangle + 6));
}

/* Weight of the nodes of a row that the triangle does not part from node k of it. */
static double weight_beside(const SporeMapping *spheres, size_t point, uint32_t k, const double *q,
                            const double *triangle) {
  double sum = 0;
  for (uint32_t i = spheres->row_start[point]; i < spheres->row_start[point + 1]; i++)
    if (i == k || !are_parted(q, spheres->block[k], spheres->block[i], triangle)) sum += spheres->weight[i];
  return sum;
}

/* Leaves the sphere to the nodes on the side of the cut that it hangs on more. */
static void part_row(SporeMapping *spheres, size_t point, const double *q, const double *triangle) {
  uint32_t start = spheres->row_start[point], end = spheres->row_start[point + 1], most = start;
  double kept = -INFINITY, whole = 0;
  for (uint32_t k = start; k < end; k++) {
    double beside = weight_beside(spheres, point, k, q, triangle);
    if (beside > kept) kept = beside, most = k;
    whole += spheres->weight[k];
  }
  if (fabs(kept - whole) < 1e-12) return;
  for (uint32_t k = start; k < end; k++) {
    bool stays = k == most || !are_parted(q, spheres->block[most], spheres->block[k], triangle);
    spheres->weight[k] = stays ? spheres->weight[k] / kept : 0;
  }
}

/* What the body remembers of steps before is of one that was whole. */
void spore_body_changed_model(SporeWorld *world, uint32_t index) {
  SporeBody *body = &world->bodies[index];
  spore_world_wake(world, index);
  body->matrix_c = 0;
  body->history_s = 0;
  body->watch.started = false;
  body->pause = body->pauses = 0;
  spore_body_reset_choice(world, body);
}

static size_t cut_body(SporeWorld *world, uint32_t index, const double *triangle) {
  SporeBody *body = &world->bodies[index];
  const double *q = world->q + body->q_offset;
  size_t count = body->model->type->cut(body->model, q, triangle, index, &world->cuts);
  if (count == 0) return 0;
  spore_body_changed_model(world, index);
  for (size_t i = 0; body->whole_weight && i < body->spheres.point_count; i++) part_row(&body->spheres, i, q, triangle);
  return count;
}

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
  for (uint32_t b = 0; b < world->body_count; b++)
    if (can_be_cut(&world->bodies[b])) tool->cut += cut_body(world, b, triangle);
}

void spore_scissors_cut(SporeWorld *world, SporeTool *tool, double from, double to) {
  size_t at = world->bodies[tool->body].q_offset;
  const double *before = world->q + at, *after = world->target_q + at;
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
