/* Jaws: two active bodies on a hinge of a third.
 *
 * They turn as fast as they can toward where the device wants them, the slower the nearer what they press comes to
 * their torque, and give way above it: what lies between them is pressed by no more. Once half of the torque presses,
 * or the jaws are shut, each sphere that a jaw touches is tied to it where it is, by a spring without length; opening
 * lets go. */
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

#define HOLD_SHARE 0.5     /* of the torque: from here on jaws hold */
#define LET_GO_RAD 0.02    /* opening beyond where it began to hold that lets go */
#define SECOND_BUTTON 0x2u /* opens a clamp */

static const char *const triggers[] = {"grip", "button", NULL};

#define JAW(field) .offset = offsetof(SporeJawFields, field), .change = SPORE_CHANGE_REBUILD
static const SporeParameter jaw_parameters[] = {
    {.name = "opening",
     .type = SPORE_REAL,
     .unit = "rad",
     .minimum = 0.01,
     .maximum = 3.1,
     .initial = {1},
     JAW(opening),
     .doc = N_("Angle between the jaws when they are wide open.")},
    {.name = "speed",
     .type = SPORE_REAL,
     .unit = "rad/s",
     .minimum = 0.01,
     .maximum = 100,
     .initial = {5},
     JAW(speed),
     .doc = N_("How fast the angle between the jaws changes at most.")},
    {.name = "torque",
     .type = SPORE_REAL,
     .unit = "N m",
     .minimum = 1e-6,
     .maximum = 10,
     .initial = {0.02},
     JAW(torque),
     .doc = N_("Torque with which each jaw closes at most; half of it holds what is between them.")},
    {.name = "stiffness",
     .type = SPORE_REAL,
     .unit = "N/m",
     .minimum = 1e-3,
     .maximum = 1e9,
     .initial = {500},
     JAW(stiffness),
     .doc = N_("How firmly each sphere between the jaws is held.")},
    {.name = "strength",
     .type = SPORE_REAL,
     .unit = "N",
     .minimum = 0,
     .maximum = 1e6,
     .initial = {2},
     JAW(strength),
     .doc = N_("Force above which a sphere tears away from the jaws.")},
    {.name = "holds",
     .type = SPORE_INTEGER,
     .unit = "",
     .minimum = 1,
     .maximum = 1000,
     .initial = {32},
     JAW(holds),
     .doc = N_("Spheres that the jaws can hold at a time.")},
    {.name = "trigger",
     .type = SPORE_CHOICE,
     .unit = "",
     .minimum = 0,
     .maximum = 1,
     .choices = triggers,
     JAW(trigger),
     .doc = N_("What closes the jaws: grip, the device's own angle; button, its first button.")},
};
const SporeParameterTable spore_jaw_parameters = {jaw_parameters, sizeof jaw_parameters / sizeof *jaw_parameters,
                                                  sizeof(SporeJawFields)};

static bool active(const SporeWorld *world, uint32_t body) {
  return body < world->body_count && world->bodies[body].role == SPORE_ACTIVE;
}

const char *spore_jaws_fault(const SporeWorld *world, const SporeToolDescription *from) {
  bool bare = from->kind == SPORE_TOOL_SCISSORS && from->jaw_a == SPORE_NO_BODY && from->jaw_b == SPORE_NO_BODY;
  if (!bare && (!active(world, from->jaw_a) || !active(world, from->jaw_b) || from->jaw_a == from->jaw_b ||
                from->jaw_a == from->body || from->jaw_b == from->body))
    return _("the jaws are not two more active bodies; expected one body for the shaft and one for each jaw; set them");
  if (!spore_vec3_is_finite(from->hinge) || !spore_vec3_is_finite(from->axis) || !(spore_vec3_length(from->axis) > 0))
    return _("the jaws have no axis to turn about; expected a direction; set it");
  return NULL;
}

bool spore_jaws_make(SporeWorld *world, SporeTool *tool, const SporeToolDescription *from) {
  static const double origin[3] = {0, 0, 0};
  const SporePose *frame = &world->bodies[from->body].rest_pose;
  SporeQuat back = spore_quat_conjugate(frame->orientation);
  tool->fields = from->jaws;
  tool->hinge = spore_pose_apply_inverse(*frame, from->hinge);
  tool->axis = spore_quat_rotate(back, spore_vec3_normalise(from->axis, (SporeVec3){0, 0, 0}));
  for (int j = 0; j < 2; j++) {
    SporeJaw *jaw = &tool->jaws[j];
    jaw->body = j ? from->jaw_b : from->jaw_a;
    jaw->side = j ? -1 : 1;
    if (jaw->body == SPORE_NO_BODY) continue;
    const SporePose *pose = &world->bodies[jaw->body].rest_pose;
    jaw->closed =
        (SporePose){spore_pose_apply_inverse(*frame, pose->position), spore_quat_multiply(back, pose->orientation)};
  }
  tool->held_at = -1;
  tool->point = spore_pose_apply_inverse(*frame, from->point);
  if (!spore_tool_kind_holds(from->kind)) tool->fields.holds = 0;
  tool->holds = SPORE_NEW_ARRAY(SporeHold, (size_t)tool->fields.holds);
  bool made = tool->holds != NULL;
  for (size_t i = 0; made && i < (size_t)tool->fields.holds; i++) {
    size_t index = tool->hold_start + i;
    SporeMapping *mapping = &world->links.mappings[2 * index + 1];
    made = spore_mapping_init_points(mapping, SPORE_MAPPING_RIGID, origin, 1, NULL);
    world->links.springs[index].b.mapping = mapping;
  }
  return made;
}

/* Holds. */

void spore_jaws_let_go(SporeWorld *world, SporeTool *tool) {
  for (size_t i = 0; i < (size_t)tool->fields.holds; i++) {
    tool->holds[i].state = SPORE_HOLD_FREE;
    world->links.active[tool->hold_start + i] = false;
  }
  tool->held_at = -1;
}

/* A place for the sphere; NULL: there is none, or it has one. */
static SporeHold *find_place(const SporeTool *tool, uint32_t sphere) {
  SporeHold *place = NULL;
  for (size_t i = 0; i < (size_t)tool->fields.holds; i++) {
    SporeHold *hold = &tool->holds[i];
    if (hold->state == SPORE_HOLD_FREE) place = place ? place : hold;
    else if (hold->sphere == sphere) return NULL;
  }
  return place;
}

/* Ties the sphere to the jaw where it is. */
static void hold_sphere(SporeWorld *world, SporeTool *tool, uint32_t jaw, uint32_t sphere) {
  SporeHold *hold = find_place(tool, sphere);
  if (!hold) return;
  *hold = (SporeHold){SPORE_HOLD_TIED, sphere};
  size_t index = tool->hold_start + (size_t)(hold - tool->holds);
  uint32_t held = world->contact.spheres.body[sphere];
  const SporeBody *body = &world->bodies[held];
  uint32_t point = sphere - (uint32_t)body->collision.start;
  SporeSpringTerm *term = &world->links.springs[index];
  term->a = (SporeEnd){.mapping = &body->collision.spheres, .body = held, .point = point};
  term->b = (SporeEnd){.mapping = &world->links.mappings[2 * index + 1], .body = jaw};
  const double *frame = world->state.q + world->bodies[jaw].q_offset;
  const SporePose pose = {spore_vec3_load(frame), spore_quat_load(frame + 3)};
  SporeVec3 at = spore_mapping_position(&body->collision.spheres, point, world->state.q + body->q_offset);
  spore_vec3_store(term->b.mapping->points, spore_pose_apply_inverse(pose, at));
  double mass = body->total_mass / (double)body->collision.spheres.point_count;
  term->law = (SporeSpring){.stiffness = tool->fields.stiffness, .damping = 2 * sqrt(tool->fields.stiffness * mass)};
  term->force = (SporeVec3){0, 0, 0};
  world->links.active[index] = true;
  spore_world_wake(world, held);
}

/* What the jaws press, by the contacts of the last step. */
static void hold_touched(SporeWorld *world, SporeTool *tool) {
  for (size_t i = 0; i < world->contact.count; i++) {
    const SporeContactTerm *term = &world->contact.terms[i];
    if (!(spore_vec3_dot(term->force, term->normal) > 0)) continue;
    for (int j = 0; j < 2; j++) {
      uint32_t jaw = tool->jaws[j].body;
      if (term->a.body == jaw && world->bodies[term->b.body].role == SPORE_PASSIVE)
        hold_sphere(world, tool, jaw, term->sphere_b);
      if (term->b.body == jaw && world->bodies[term->a.body].role == SPORE_PASSIVE)
        hold_sphere(world, tool, jaw, term->sphere_a);
    }
  }
  if (tool->held_at < 0) tool->held_at = tool->opening;
}

void spore_jaws_tear(SporeWorld *world, SporeTool *tool) {
  for (size_t i = 0; i < (size_t)tool->fields.holds; i++) {
    SporeHold *hold = &tool->holds[i];
    size_t index = tool->hold_start + i;
    if (hold->state != SPORE_HOLD_TIED) continue;
    double load = spore_vec3_length(world->links.springs[index].force);
    if (load <= tool->fields.strength) continue;
    hold->state = SPORE_HOLD_LOST;
    world->links.active[index] = false;
    if (world->state.monitor.lost_holds++ == 0)
      spore_world_report(world, _("%s: tissue tore away from it, it held %.3g N and can hold %.3g N"), tool->name, load,
                         tool->fields.strength);
  }
}

/* Motion. */

/* Torque about the hinge that opens the jaw, of the last step. */
static double opening_torque(const SporeWorld *world, const SporeTool *tool, const SporeJaw *jaw) {
  if (jaw->body == SPORE_NO_BODY) return 0;
  const double *shaft = world->state.q + world->bodies[tool->body].q_offset;
  const SporePose frame = {spore_vec3_load(shaft), spore_quat_load(shaft + 3)};
  const double *reaction = world->state.reaction + 6 * (size_t)jaw->body;
  SporeVec3 origin = spore_vec3_load(world->state.q + world->bodies[jaw->body].q_offset);
  SporeVec3 arm = spore_vec3_sub(origin, spore_pose_apply(frame, tool->hinge));
  SporeVec3 torque = spore_vec3_add(spore_vec3_load(reaction + 3), spore_vec3_cross(arm, spore_vec3_load(reaction)));
  return jaw->side * spore_vec3_dot(spore_quat_rotate(frame.orientation, tool->axis), torque);
}

/* The opening that the device asks for. */
static double wanted_opening(SporeTool *tool, const SporeDeviceState *input, bool spoke) {
  if (tool->kind == SPORE_TOOL_CLAMP && (input->buttons & SECOND_BUTTON)) {
    tool->latched = false;
    return tool->fields.opening;
  }
  if (tool->latched) return 0;
  if (!spoke) return tool->opening;
  if (tool->fields.trigger == SPORE_TRIGGER_BUTTON) return input->buttons & 1u ? 0 : tool->fields.opening;
  return fmin(fmax(input->grip_rad, 0), tool->fields.opening);
}

/* The slower the nearer the squeeze is to what the jaws can; above, they give way. */
static double next_opening(const SporeTool *tool, double wanted, double h) {
  double most = h * tool->fields.speed, change = fmin(fmax(wanted - tool->opening, -most), most);
  if (change >= 0) return tool->opening + change;
  double left = 1 - tool->squeeze / tool->fields.torque;
  change = left >= 0 ? change * fmin(left, 1) : most * fmin(-left, 1);
  return fmin(fmax(tool->opening + change, 0), tool->fields.opening);
}

static void place_jaw(SporeWorld *world, const SporeTool *tool, const SporeJaw *jaw) {
  const double *shaft = world->state.target_q + world->bodies[tool->body].q_offset;
  const SporePose frame = {spore_vec3_load(shaft), spore_quat_load(shaft + 3)};
  double *target = world->state.target_q + world->bodies[jaw->body].q_offset;
  SporeQuat turn = spore_quat_from_rotation_vector(spore_vec3_scale(0.5 * jaw->side * tool->opening, tool->axis));
  SporeVec3 arm = spore_quat_rotate(turn, spore_vec3_sub(jaw->closed.position, tool->hinge));
  SporeQuat turned = spore_quat_multiply(turn, jaw->closed.orientation);
  spore_vec3_store(target, spore_pose_apply(frame, spore_vec3_add(tool->hinge, arm)));
  spore_quat_store(target + 3, spore_quat_normalise(spore_quat_multiply(frame.orientation, turned)));
  spore_active_set_velocity(world, jaw->body);
}

void spore_jaws_use(SporeWorld *world, SporeTool *tool) {
  const SporeBody *body = &world->bodies[tool->body];
  double wanted = wanted_opening(tool, &body->device.input, body->device.has_input);
  tool->squeeze =
      fmax(0, fmax(opening_torque(world, tool, &tool->jaws[0]), opening_torque(world, tool, &tool->jaws[1])));
  double before = tool->opening;
  bool shut = wanted <= 0 && tool->opening <= 0;
  bool presses = shut ? tool->squeeze > 0 : wanted < tool->opening && tool->squeeze >= HOLD_SHARE * tool->fields.torque;
  if (presses && spore_tool_kind_holds(tool->kind)) hold_touched(world, tool);
  if (presses && tool->kind == SPORE_TOOL_CLAMP) tool->latched = true;
  if (tool->held_at >= 0 && wanted > tool->held_at + LET_GO_RAD) spore_jaws_let_go(world, tool);
  tool->opening = next_opening(tool, wanted, world->solver.time_step);
  for (int j = 0; j < 2; j++)
    if (tool->jaws[j].body != SPORE_NO_BODY) place_jaw(world, tool, &tool->jaws[j]);
  if (tool->opening > before) tool->stroke = tool->opening;
  if (tool->kind == SPORE_TOOL_SCISSORS && tool->opening < before)
    spore_scissors_cut(world, tool, before, tool->opening);
}

void spore_jaws_feed_back(SporeWorld *world, const SporeTool *tool) {
  SporeDeviceCommand *command = &world->bodies[tool->body].device.command;
  SporeVec3 origin = spore_vec3_load(world->state.q + world->bodies[tool->body].q_offset);
  for (int j = 0; j < 2; j++) {
    uint32_t jaw = tool->jaws[j].body;
    if (jaw == SPORE_NO_BODY) continue;
    const double *reaction = world->state.reaction + 6 * (size_t)jaw;
    SporeVec3 arm = spore_vec3_sub(spore_vec3_load(world->state.q + world->bodies[jaw].q_offset), origin);
    SporeVec3 force = spore_vec3_load(reaction);
    spore_vec3_accumulate(command->force, force);
    spore_vec3_accumulate(command->torque, spore_vec3_load(reaction + 3));
    spore_vec3_accumulate(command->torque, spore_vec3_cross(arm, force));
  }
}
