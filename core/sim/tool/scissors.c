/* Scissors: blades that cut bodies. The way of a blade in a step is two triangles. Each model finds which of its parts
 * cross them. */
#include <assert.h>

#include "core/base/text.h"
#include "core/sim/tool/jaws.h"
#include "core/sim/world_private.h"

typedef struct SporeScissors {
  SporeJaws jaws;
  size_t cut; /* ties so far */
} SporeScissors;

/* The end of a blade, in the world, m. */
static SporeVec3 blade_tip(const SporeScissors *scissors, const double *shaft, double half) {
  const SporePose frame = spore_pose_load(shaft);
  SporeQuat turn = spore_quat_from_rotation_vector(spore_vec3_scale(half, scissors->jaws.axis));
  SporeVec3 arm = spore_quat_rotate(turn, spore_vec3_sub(scissors->jaws.tool.tip, scissors->jaws.hinge));
  return spore_pose_apply(frame, spore_vec3_add(scissors->jaws.hinge, arm));
}

static SporeVec3 blade_root(const SporeScissors *scissors, const double *shaft) {
  return spore_pose_apply(spore_pose_load(shaft), scissors->jaws.hinge);
}

static void store_triangle(double *triangle, SporeVec3 a, SporeVec3 b, SporeVec3 c) {
  spore_vec3_store(triangle, a);
  spore_vec3_store(triangle + 3, b);
  spore_vec3_store(triangle + 6, c);
}

static void cut_all(SporeWorld *world, SporeScissors *scissors, const double *triangle) {
  assert(triangle);
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (!spore_body_can_be_cut(body)) continue;
    size_t count =
        body->model->type->cut->cut(body->model, world->state.q + body->q_offset, triangle, b, &world->topology.cuts);
    if (count > 0) spore_body_was_cut(world, b);
    scissors->cut += count;
    world->bodies[b].marks.cut += count;
  }
}

/* Tissue moves between steps. So that none slips past, blades also cut a little behind them, within their present
 * stroke. */
#define OVERLAP_RAD 0.1

/* Cuts along the way of the blades: they move with their body from the last state to its target, and close from one
 * opening to another, by half of the angle each. */
static void cut_between(SporeWorld *world, SporeScissors *scissors, double from, double to) {
  assert(to < from);
  from = fmin(scissors->jaws.stroke, from + OVERLAP_RAD);
  size_t at = world->bodies[scissors->jaws.tool.bodies[0]].q_offset;
  const double *before = world->state.q + at, *after = world->state.target_q + at;
  SporeVec3 root = blade_root(scissors, before), next_root = blade_root(scissors, after);
  double triangle[9];
  for (int side = -1; side <= 1; side += 2) {
    SporeVec3 tip = blade_tip(scissors, before, 0.5 * side * from),
              next_tip = blade_tip(scissors, after, 0.5 * side * to);
    store_triangle(triangle, root, tip, next_tip);
    cut_all(world, scissors, triangle);
    store_triangle(triangle, root, next_tip, next_root);
    cut_all(world, scissors, triangle);
  }
  if (to > 0) return;
  /* Tissue just where the blades meet is on the way of neither blade. */
  store_triangle(triangle, root, blade_tip(scissors, before, 0.5 * from), blade_tip(scissors, before, -0.5 * from));
  cut_all(world, scissors, triangle);
}

/* Scissors may have blades only, without bodies for them. */
static const char *fault(const SporeWorld *world, const SporeToolDescription *from) {
  const SporeJawFields *fields = from->fields;
  const char *fault = spore_tool_point_fault(fields->tip);
  if (fault) return fault;
  bool bare = from->bodies[SPORE_TOOL_JAW_A] == SPORE_NO_BODY && from->bodies[SPORE_TOOL_JAW_B] == SPORE_NO_BODY;
  return bare ? spore_hinge_fault(fields) : spore_jaws_fault(world, from);
}

static bool make(SporeWorld *world, SporeTool *tool, const SporeToolDescription *from) {
  const SporeJawFields *fields = from->fields;
  bool made = spore_jaws_make(world, tool, from);
  tool->tip = spore_world_to_frame(world, tool->bodies[0], spore_vec3_load(fields->tip));
  return made;
}

static void use(SporeWorld *world, SporeTool *tool) {
  SporeScissors *scissors = (SporeScissors *)tool;
  double before = scissors->jaws.opening;
  spore_jaws_use(world, tool);
  if (scissors->jaws.opening < before) cut_between(world, scissors, before, scissors->jaws.opening);
}

static void reset(SporeWorld *world, SporeTool *tool) {
  spore_jaws_reset(world, tool);
  ((SporeScissors *)tool)->cut = 0;
}

static void state(const SporeTool *tool, SporeToolState *now) {
  spore_jaws_state(tool, now);
  now->cut = ((const SporeScissors *)tool)->cut;
}

static const SporeParameter rows[] = {
    SPORE_JAW_BODY_ROWS,
    SPORE_ROW_PLACE(SporeJawFields, tip, N_("Where the blades end at the start, closed, in the scene.")),
    SPORE_JAW_ROWS,
};

const SporeToolType spore_scissors = {
    .element = "scissors",
    .label = N_("Scissors"),
    .doc = N_("Blades that cut nets and tetrahedra where they close; jaws are the bodies that are seen and felt of "
              "them, and may be left out."),
    .parameters = SPORE_TABLE(rows, SporeJawFields),
    .cuts = true,
    .size = sizeof(SporeScissors),
    .make = make,
    .fault = fault,
    .clear = spore_jaws_clear,
    .reset = reset,
    .follow = spore_jaws_follow,
    .use = use,
    .feed_back = spore_jaws_feed_back,
    .state = state};
