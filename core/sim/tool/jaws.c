/* Jaws: two active bodies on a hinge of a third.
 *
 * The jaws turn toward the opening that the device wants. They turn the slower, the nearer the squeeze comes to their
 * torque, and give way above it, so that they never press with more. When the squeeze reaches half of the torque, or
 * the jaws are shut, each sphere that a jaw touches is tied to the jaw by a spring without length. Opening the jaws
 * releases the spheres.
 *
 * Tissue that is an effect gives way, and does not balance their torque. Jaws hold what of it lies between both of
 * them, it goes with them (core/sim/effect/shape.c), and they stay as they are until they open. */
#include <assert.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/tool/clip.h"
#include "core/sim/tool/jaws.h"
#include "core/sim/world_private.h"

#define HOLD_SHARE 0.5  /* of the torque: squeeze from which jaws hold */
#define LET_GO_RAD 0.02 /* opening beyond that at which holding began, which releases */

const char *const spore_jaw_triggers[] = {"grip", "button", NULL};

static bool active(const SporeWorld *world, uint32_t body) {
  return body < world->body_count && world->bodies[body].role == SPORE_ACTIVE;
}

const char *spore_jaws_fault(const SporeWorld *world, const SporeToolDescription *from) {
  const SporeJawFields *fields = from->fields;
  uint32_t body = from->bodies[0], jaw_a = from->bodies[SPORE_TOOL_JAW_A], jaw_b = from->bodies[SPORE_TOOL_JAW_B];
  if (!active(world, jaw_a) || !active(world, jaw_b) || jaw_a == jaw_b || jaw_a == body || jaw_b == body)
    return _("the jaws are not two more active bodies; expected one body for the shaft and one for each jaw; set them");
  return spore_hinge_fault(fields);
}

const char *spore_hinge_fault(const SporeJawFields *fields) {
  SporeVec3 hinge = spore_vec3_load(fields->hinge), axis = spore_vec3_load(fields->axis);
  if (!spore_vec3_is_finite(hinge) || !spore_vec3_is_finite(axis) || !(spore_vec3_length(axis) > 0))
    return _("the jaws have no axis to turn about; expected a direction; set it");
  return NULL;
}

/* In the frame of the tool's body: the middle between the spheres of the closed jaws that are farthest from the hinge;
 * the hinge, where no jaw has spheres. */
static SporeVec3 tip_of(const SporeWorld *world, const SporeJaws *jaws) {
  SporeVec3 sum = {0, 0, 0};
  double count = 0;
  for (int j = 0; j < 2; j++) {
    const SporeJaw *jaw = &jaws->jaw[j];
    const SporeMapping *spheres = jaw->body == SPORE_NO_BODY ? NULL : &world->bodies[jaw->body].collision.spheres;
    SporeVec3 farthest = jaws->hinge;
    for (size_t i = 0; spheres && i < spheres->point_count; i++) {
      SporeVec3 at = spore_pose_apply(jaw->closed, spore_vec3_load(spheres->points + 3 * i));
      if (spore_vec3_distance(at, jaws->hinge) > spore_vec3_distance(farthest, jaws->hinge)) farthest = at;
    }
    if (spheres && spheres->point_count > 0) sum = spore_vec3_add(sum, farthest), count++;
  }
  return count > 0 ? spore_vec3_scale(1 / count, sum) : jaws->hinge;
}

/* How far the jaws reach, by their spheres. */
static void measure(const SporeWorld *world, SporeJaws *jaws) {
  SporeVec3 along = spore_vec3_sub(jaws->tool.tip, jaws->hinge);
  along = spore_vec3_add_scaled(along, -spore_vec3_dot(along, jaws->axis), jaws->axis);
  jaws->length = spore_vec3_length(along);
  jaws->along = spore_vec3_normalise(along, (SporeVec3){0, 0, 0});
  for (int j = 0; j < 2; j++) {
    const SporeBody *body = jaws->jaw[j].body == SPORE_NO_BODY ? NULL : &world->bodies[jaws->jaw[j].body];
    for (size_t i = 0; body && i < body->collision.spheres.point_count; i++) {
      SporeVec3 at = spore_pose_apply(jaws->jaw[j].closed, spore_vec3_load(body->collision.spheres.points + 3 * i));
      double radius = world->contact.spheres.radius[body->collision.start + i];
      SporeVec3 from = spore_vec3_sub(at, jaws->hinge);
      jaws->width = fmax(jaws->width, fabs(spore_vec3_dot(from, jaws->axis)) + radius);
      jaws->reach = fmax(jaws->reach, spore_vec3_length(from) + radius);
    }
  }
}

bool spore_jaws_make(SporeWorld *world, SporeTool *tool, const SporeToolDescription *from) {
  assert(from->fields && tool->bodies[0] < world->body_count);
  assert(tool->spring_start + tool->spring_count <= spore_world_spring_count(world));
  static const double origin[3] = {0, 0, 0};
  SporeJaws *jaws = (SporeJaws *)tool;
  const SporePose *frame = &world->bodies[tool->bodies[0]].rest_pose;
  SporeQuat back = spore_quat_conjugate(frame->orientation);
  jaws->fields = *(const SporeJawFields *)from->fields;
  jaws->hinge = spore_world_to_frame(world, tool->bodies[0], spore_vec3_load(jaws->fields.hinge));
  jaws->axis = spore_tool_direction(world, tool->bodies[0], jaws->fields.axis);
  for (int j = 0; j < 2; j++) {
    SporeJaw *jaw = &jaws->jaw[j];
    jaw->body = tool->bodies[j ? SPORE_TOOL_JAW_B : SPORE_TOOL_JAW_A];
    jaw->side = j ? -1 : 1;
    if (jaw->body == SPORE_NO_BODY) continue;
    const SporePose *pose = &world->bodies[jaw->body].rest_pose;
    jaw->closed =
        (SporePose){spore_pose_apply_inverse(*frame, pose->position), spore_quat_multiply(back, pose->orientation)};
  }
  tool->tip = tip_of(world, jaws);
  measure(world, jaws);
  jaws->held_at = -1;
  jaws->holds = SPORE_NEW_ARRAY(SporeHold, tool->spring_count);
  bool made = jaws->holds != NULL;
  for (size_t i = 0; made && i < tool->spring_count; i++) {
    size_t index = tool->spring_start + i;
    SporeMapping *mapping = &world->links.mappings[2 * index + 1];
    made = spore_mapping_init_points(mapping, SPORE_MAPPING_RIGID, origin, 1, NULL);
    world->links.springs[index].b.mapping = mapping;
  }
  return made;
}

void spore_jaws_clear(SporeTool *tool) { spore_free(((SporeJaws *)tool)->holds); }

/* Holds. */

/* Holds the spheres that the jaws press, found by the contacts of the last step. */
static void hold_touched(SporeWorld *world, SporeJaws *jaws) {
  assert(world->contact.count <= world->contact.capacity);
  for (size_t i = 0; i < world->contact.count; i++) {
    const SporeContactTerm *term = &world->contact.terms[i];
    if (!(spore_vec3_dot(term->force, term->normal) > 0)) continue;
    for (int j = 0; j < 2; j++) {
      uint32_t jaw = jaws->jaw[j].body;
      if (term->a.body == jaw && world->bodies[term->b.body].role == SPORE_PASSIVE)
        spore_jaws_hold(world, jaws, jaw, term->sphere_b);
      if (term->b.body == jaw && world->bodies[term->a.body].role == SPORE_PASSIVE)
        spore_jaws_hold(world, jaws, jaw, term->sphere_a);
    }
  }
  if (jaws->held_at < 0) jaws->held_at = jaws->opening;
}

static void tear(SporeWorld *world, SporeTool *tool) {
  SporeJaws *jaws = (SporeJaws *)tool;
  for (size_t i = 0; i < jaws->tool.spring_count && !spore_clip_leads(jaws); i++) {
    SporeHold *hold = &jaws->holds[i];
    size_t index = jaws->tool.spring_start + i;
    if (hold->state != SPORE_HOLD_TIED) continue;
    double load = spore_vec3_length(world->links.springs[index].force);
    if (load <= jaws->fields.strength) continue;
    hold->state = SPORE_HOLD_LOST;
    world->links.active[index] = false;
    if (world->state.monitor.lost_holds++ == 0)
      spore_world_report(world, _("%s: tissue tore away from it, it held %.3g N and can hold %.3g N"), jaws->tool.name,
                         load, jaws->fields.strength);
  }
}

/* Motion. */

/* Torque about the hinge that opens the jaw, of the last step. */
static double opening_torque(const SporeWorld *world, const SporeJaws *jaws, const SporeJaw *jaw) {
  assert(jaw->body == SPORE_NO_BODY || jaw->body < world->body_count);
  if (jaw->body == SPORE_NO_BODY) return 0;
  const double *shaft = world->state.q + world->bodies[jaws->tool.bodies[0]].q_offset;
  const SporePose frame = spore_pose_load(shaft);
  const double *reaction = world->state.reaction + 6 * (size_t)jaw->body;
  SporeVec3 origin = spore_vec3_load(world->state.q + world->bodies[jaw->body].q_offset);
  SporeVec3 arm = spore_vec3_sub(origin, spore_pose_apply(frame, jaws->hinge));
  SporeVec3 torque = spore_vec3_add(spore_vec3_load(reaction + 3), spore_vec3_cross(arm, spore_vec3_load(reaction)));
  return jaw->side * spore_vec3_dot(spore_quat_rotate(frame.orientation, jaws->axis), torque);
}

/* The opening that the device asks for. */
static double wanted_opening(SporeJaws *jaws, const SporeDeviceState *input, bool has_input) {
  if (jaws->latches && (input->buttons & SPORE_SECOND_BUTTON)) {
    jaws->latched = false;
    return jaws->fields.opening;
  }
  if (jaws->latched) return 0;
  if (!has_input) return jaws->opening;
  if (jaws->fields.trigger == SPORE_TRIGGER_BUTTON)
    return input->buttons & SPORE_FIRST_BUTTON ? 0 : jaws->fields.opening;
  return fmin(fmax(input->grip_rad, 0), jaws->fields.opening);
}

/* The opening at the end of the step. The jaws close the slower, the nearer the squeeze is to their torque. Above their
 * torque they give way. */
static double next_opening(const SporeJaws *jaws, double wanted, double h) {
  assert(h > 0 && jaws->fields.torque > 0);
  double most = h * jaws->fields.speed, change = fmin(fmax(wanted - jaws->opening, -most), most);
  if (change >= 0) return jaws->opening + change;
  double left = 1 - jaws->squeeze / jaws->fields.torque;
  change = left >= 0 ? change * fmin(left, 1) : most * fmin(-left, 1);
  return fmin(fmax(jaws->opening + change, 0), jaws->fields.opening);
}

static bool hold_effect(const SporeWorld *world, const SporeJaws *jaws) {
  bool found = false;
  for (size_t i = 0; i < jaws->tool.spring_count && !found; i++) {
    const SporeHold *hold = &jaws->holds[i];
    found = hold->state == SPORE_HOLD_TIED && world->bodies[world->contact.spheres.body[hold->sphere]].effect.on;
  }
  return found;
}

static void place_jaw(SporeWorld *world, const SporeJaws *jaws, const SporeJaw *jaw) {
  assert(jaw->body < world->body_count);
  const double *shaft = world->state.target_q + world->bodies[jaws->tool.bodies[0]].q_offset;
  const SporePose frame = spore_pose_load(shaft);
  double *target = world->state.target_q + world->bodies[jaw->body].q_offset;
  SporeQuat turn = spore_quat_from_rotation_vector(spore_vec3_scale(0.5 * jaw->side * jaws->opening, jaws->axis));
  SporeVec3 arm = spore_quat_rotate(turn, spore_vec3_sub(jaw->closed.position, jaws->hinge));
  SporeQuat turned = spore_quat_multiply(turn, jaw->closed.orientation);
  spore_vec3_store(target, spore_pose_apply(frame, spore_vec3_add(jaws->hinge, arm)));
  spore_quat_store(target + 3, spore_quat_normalise(spore_quat_multiply(frame.orientation, turned)));
  spore_active_set_velocity(world, jaw->body);
}

/* The opening at which the jaw stands as it does. */
static double opening_of(const SporeWorld *world, const SporeJaws *jaws, const SporeJaw *jaw) {
  assert(jaw->body < world->body_count);
  SporeQuat shaft = spore_quat_load(world->state.q + world->bodies[jaws->tool.bodies[0]].q_offset + 3);
  SporeQuat stands = spore_quat_load(world->state.q + world->bodies[jaw->body].q_offset + 3);
  SporeQuat own = spore_quat_multiply(spore_quat_conjugate(shaft), stands);
  SporeVec3 turn =
      spore_quat_to_rotation_vector(spore_quat_multiply(own, spore_quat_conjugate(jaw->closed.orientation)));
  return fmin(fmax(2 * jaw->side * spore_vec3_dot(turn, jaws->axis), 0), jaws->fields.opening);
}

void spore_jaws_follow(SporeWorld *world, SporeTool *tool) {
  SporeJaws *jaws = (SporeJaws *)tool;
  for (int j = 0; j < 2; j++)
    if (jaws->jaw[j].body != SPORE_NO_BODY) jaws->opening = jaws->stroke = opening_of(world, jaws, &jaws->jaw[j]);
}

/* Closes by physics: presses what is between the jaws, holds it, and lets it go. */
static void press(SporeWorld *world, SporeJaws *jaws, double wanted) {
  const SporeTool *tool = &jaws->tool;
  jaws->squeeze = fmax(0, fmax(opening_torque(world, jaws, &jaws->jaw[0]), opening_torque(world, jaws, &jaws->jaw[1])));
  bool shut = wanted <= 0 && jaws->opening <= 0;
  bool presses = shut ? jaws->squeeze > 0 : wanted < jaws->opening && jaws->squeeze >= HOLD_SHARE * jaws->fields.torque;
  bool closes = wanted < jaws->opening && !hold_effect(world, jaws);
  presses |= closes && tool->spring_count > 0 && spore_jaws_pinch(world, jaws, true);
  if (presses && tool->spring_count > 0) hold_touched(world, jaws);
  if (presses && jaws->latches) jaws->latched = true;
  if (jaws->held_at >= 0 && wanted > jaws->held_at + LET_GO_RAD) spore_jaws_let_go(world, jaws);
  if (wanted >= jaws->opening || !hold_effect(world, jaws))
    jaws->opening = next_opening(jaws, wanted, world->solver.time_step);
}

void spore_jaws_use(SporeWorld *world, SporeTool *tool) {
  assert(tool->bodies[0] < world->body_count);
  SporeJaws *jaws = (SporeJaws *)tool;
  const SporeBody *body = &world->bodies[jaws->tool.bodies[0]];
  double wanted = wanted_opening(jaws, &body->device.input, body->device.has_input), before = jaws->opening;
  if (spore_clip_leads(jaws)) spore_clip_use(world, jaws, wanted);
  else press(world, jaws, wanted);
  spore_clip_come_back(world, jaws);
  for (int j = 0; j < 2; j++)
    if (jaws->jaw[j].body != SPORE_NO_BODY) place_jaw(world, jaws, &jaws->jaw[j]);
  if (jaws->opening > before) jaws->stroke = jaws->opening;
}

void spore_jaws_feed_back(SporeWorld *world, const SporeTool *tool) {
  assert(tool->bodies[0] < world->body_count);
  const SporeJaws *jaws = (const SporeJaws *)tool;
  SporeDeviceCommand *command = &world->bodies[jaws->tool.bodies[0]].device.command;
  SporeVec3 origin = spore_vec3_load(world->state.q + world->bodies[jaws->tool.bodies[0]].q_offset);
  for (int j = 0; j < 2; j++) {
    uint32_t jaw = jaws->jaw[j].body;
    if (jaw == SPORE_NO_BODY) continue;
    const double *reaction = world->state.reaction + 6 * (size_t)jaw;
    SporeVec3 arm = spore_vec3_sub(spore_vec3_load(world->state.q + world->bodies[jaw].q_offset), origin);
    SporeVec3 force = spore_vec3_load(reaction);
    spore_vec3_accumulate(command->force, force);
    spore_vec3_accumulate(command->torque, spore_vec3_load(reaction + 3));
    spore_vec3_accumulate(command->torque, spore_vec3_cross(arm, force));
  }
}

void spore_jaws_reset(SporeWorld *world, SporeTool *tool) {
  SporeJaws *jaws = (SporeJaws *)tool;
  spore_jaws_let_go(world, jaws);
  jaws->opening = jaws->squeeze = jaws->stroke = 0;
  jaws->latched = false;
  if (jaws->latches) spore_clip_reset(world, jaws);
}

void spore_jaws_state(const SporeTool *tool, SporeToolState *state) {
  const SporeJaws *jaws = (const SporeJaws *)tool;
  state->opening = jaws->opening;
  state->squeeze = jaws->squeeze;
  for (size_t i = 0; i < tool->spring_count; i++) {
    state->held += jaws->holds[i].state == SPORE_HOLD_TIED;
    state->lost += jaws->holds[i].state == SPORE_HOLD_LOST;
  }
}

static size_t holds(const SporeWorld *world, const SporeTool *tool, uint32_t body) {
  const SporeJaws *jaws = (const SporeJaws *)tool;
  size_t count = 0;
  for (size_t i = 0; i < tool->spring_count; i++)
    count += jaws->holds[i].state == SPORE_HOLD_TIED && world->contact.spheres.body[jaws->holds[i].sphere] == body;
  return count;
}

/* Grasper and clamp. */

static size_t spring_count(const void *fields) { return (size_t)((const SporeJawFields *)fields)->holds; }

static bool make_clamp(SporeWorld *world, SporeTool *tool, const SporeToolDescription *from) {
  ((SporeJaws *)tool)->latches = true;
  return spore_jaws_make(world, tool, from);
}

static const SporeParameter rows[] = {SPORE_JAW_BODY_ROWS, SPORE_JAW_ROWS};

const SporeToolType spore_grasper = {.element = "grasper",
                                     .label = N_("Grasper"),
                                     .doc = N_("Two jaws that close on tissue and hold it."),
                                     .parameters = SPORE_TABLE(rows, SporeJawFields),
                                     .size = sizeof(SporeJaws),
                                     .make = spore_jaws_make,
                                     .spring_count = spring_count,
                                     .fault = spore_jaws_fault,
                                     .clear = spore_jaws_clear,
                                     .reset = spore_jaws_reset,
                                     .follow = spore_jaws_follow,
                                     .use = spore_jaws_use,
                                     .tear = tear,
                                     .feed_back = spore_jaws_feed_back,
                                     .state = spore_jaws_state,
                                     .holds = holds};

static bool pinches(const SporeWorld *world, const SporeTool *tool, uint32_t body, SporeVec3 place, double distance) {
  const SporeJaws *jaws = (const SporeJaws *)tool;
  const SporeSpheres *spheres = &world->contact.spheres;
  for (size_t i = 0; i < tool->spring_count; i++) {
    const SporeHold *hold = &jaws->holds[i];
    if (hold->state == SPORE_HOLD_TIED && spheres->body[hold->sphere] == body &&
        spore_vec3_distance(spore_vec3_load(spheres->centre + 3 * (size_t)hold->sphere), place) < distance)
      return true;
  }
  return false;
}

const SporeToolType spore_clamp = {
    .element = "clamp",
    .label = N_("Clamp"),
    .doc = N_("Two jaws that stay closed on what they took hold of, until the second button."),
    .parameters = SPORE_TABLE(rows, SporeJawFields),
    .size = sizeof(SporeJaws),
    .make = make_clamp,
    .spring_count = spring_count,
    .fault = spore_jaws_fault,
    .clear = spore_jaws_clear,
    .reset = spore_jaws_reset,
    .follow = spore_jaws_follow,
    .use = spore_jaws_use,
    .tear = tear,
    .feed_back = spore_jaws_feed_back,
    .state = spore_jaws_state,
    .holds = holds,
    .pinches = pinches,
    .set_effect = spore_clip_set_effect,
    .squeeze = spore_clip_squeeze};
