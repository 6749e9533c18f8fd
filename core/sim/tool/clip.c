/* A clamp as an effect.
 *
 * Nothing touches its bodies. As its jaws close, they take hold of the spheres that lie between both of them; from then
 * on the clamp goes with these spheres, and not with its device, until its second button opens it. What physics moves
 * feels nothing of this. The jaws close on until the tissue between them is drawn as thin as tissue gets. */
#include "core/sim/tool/clip.h"

#include <assert.h>

#include "core/sim/world_private.h"

#define THINNEST 0.2 /* of its thickness: as thin as tissue is drawn */
#define BACK_M_S 0.1 /* how fast the shaft comes back to its device */
#define BACK_RAD_S 2.

static SporePose relative(SporePose frame, SporePose pose) {
  return (SporePose){
      spore_pose_apply_inverse(frame, pose.position),
      spore_quat_normalise(spore_quat_multiply(spore_quat_conjugate(frame.orientation), pose.orientation))};
}

static SporePose placed(SporePose frame, SporePose pose) {
  return (SporePose){spore_pose_apply(frame, pose.position),
                     spore_quat_normalise(spore_quat_multiply(frame.orientation, pose.orientation))};
}

bool spore_clip_leads(const SporeJaws *jaws) { return jaws->tool.effect || jaws->clip.leaving; }

static void set_apart(SporeWorld *world, const SporeJaws *jaws, bool apart) {
  for (int part = 0; world->contact.grid && part < SPORE_TOOL_BODIES; part++)
    if (jaws->tool.bodies[part] != SPORE_NO_BODY)
      spore_grid_set_apart(world->contact.grid, jaws->tool.bodies[part], apart);
}

/* The seat. */

static SporeSeatPoints spheres_of(const SporeWorld *world, const SporeBody *body) {
  const SporeMapping *spheres = &body->collision.spheres;
  return (SporeSeatPoints){world->state.q + body->q_offset, (uint32_t)spheres->point_count, spheres};
}

/* The frame that the clip goes with, in the state. */
static SporePose seat_frame(const SporeWorld *world, const SporeJawClip *clip) {
  assert(clip->set && clip->body < world->body_count);
  const SporeBody *body = &world->bodies[clip->body];
  SporeSeatPoints spheres = spheres_of(world, body);
  if (body->role == SPORE_UNMOVABLE) return body->rest_pose;
  return spore_model_is_rigid(body->model) ? spore_pose_load(spheres.q) : spore_seat_frame(&clip->seat, &spheres);
}

/* Sits down on the body of the held sphere that is nearest to the middle of the jaws. */
static void sit_down(SporeWorld *world, SporeJaws *jaws) {
  SporeJawClip *clip = &jaws->clip;
  SporePose shaft = spore_pose_load(world->state.q + world->bodies[jaws->tool.bodies[0]].q_offset);
  SporeVec3 middle = spore_pose_apply(shaft, spore_vec3_add_scaled(jaws->hinge, 0.5 * jaws->length, jaws->along));
  double least = INFINITY;
  for (size_t i = 0; i < jaws->tool.spring_count; i++) {
    const SporeHold *hold = &jaws->holds[i];
    if (hold->state != SPORE_HOLD_TIED) continue;
    uint32_t index = world->contact.spheres.body[hold->sphere];
    const SporeBody *body = &world->bodies[index];
    SporeVec3 at = spore_mapping_position(&body->collision.spheres, hold->sphere - body->collision.start,
                                          world->state.q + body->q_offset);
    double off = spore_vec3_distance(at, middle);
    if (!(off < least)) continue;
    least = off;
    clip->body = index;
  }
  clip->set = isfinite(least);
  if (!clip->set) return;
  SporeSeatPoints spheres = spheres_of(world, &world->bodies[clip->body]);
  spore_seat_find(&clip->seat, &spheres, middle);
  clip->shaft = relative(seat_frame(world, clip), shaft);
  clip->touched = jaws->opening;
  clip->back = false;
}

/* The shaft. */

/* Gives the shaft a pose for the end of the step; in a port it keeps to that. */
static void aim(SporeWorld *world, const SporeJaws *jaws, SporePose pose) {
  uint32_t shaft = jaws->tool.bodies[0];
  double *target = world->state.target_q + world->bodies[shaft].q_offset;
  spore_vec3_store(target, pose.position);
  spore_quat_store(target + 3, pose.orientation);
  for (size_t i = 0; i < world->links.trocar_count; i++)
    if (world->links.trocars[i].body == shaft) spore_trocar_aim(world, &world->links.trocars[i]);
  spore_active_set_velocity(world, shaft);
}

void spore_clip_come_back(SporeWorld *world, SporeJaws *jaws) {
  if (!jaws->clip.back) return;
  const SporeBody *body = &world->bodies[jaws->tool.bodies[0]];
  SporePose is = spore_pose_load(world->state.q + body->q_offset),
            to = spore_pose_load(world->state.target_q + body->q_offset);
  SporeVec3 way = spore_vec3_sub(to.position, is.position);
  SporeVec3 turn =
      spore_quat_to_rotation_vector(spore_quat_multiply(to.orientation, spore_quat_conjugate(is.orientation)));
  double steps =
      fmax(spore_vec3_length(way) / BACK_M_S, spore_vec3_length(turn) / BACK_RAD_S) / world->solver.time_step;
  jaws->clip.back = steps > 1;
  if (!jaws->clip.back) return;
  SporeQuat part = spore_quat_from_rotation_vector(spore_vec3_scale(1 / steps, turn));
  aim(world, jaws,
      (SporePose){spore_vec3_add_scaled(is.position, 1 / steps, way),
                  spore_quat_normalise(spore_quat_multiply(part, is.orientation))});
}

/* The step. */

static void get_up(SporeWorld *world, SporeJaws *jaws) {
  spore_jaws_let_go(world, jaws);
  jaws->clip.back |= jaws->clip.set;
  jaws->clip.set = false;
}

/* Opens as far as the jaws were when they touched the tissue; then they hold it as physics does. */
static void leave(SporeWorld *world, SporeJaws *jaws) {
  SporeJawClip *clip = &jaws->clip;
  if (clip->set && jaws->opening < clip->touched) {
    jaws->opening = fmin(clip->touched, jaws->opening + world->solver.time_step * jaws->fields.speed);
    return;
  }
  set_apart(world, jaws, false);
  if (clip->set) spore_jaws_tie(world, jaws);
  clip->back |= clip->set;
  clip->set = clip->leaving = false;
}

static void close_on(SporeWorld *world, SporeJaws *jaws, double wanted) {
  SporeJawClip *clip = &jaws->clip;
  double most = world->solver.time_step * jaws->fields.speed, least = clip->set ? THINNEST * clip->touched : 0;
  if (clip->set && !jaws->latched) get_up(world, jaws);
  if (!clip->set && wanted < jaws->opening && spore_jaws_pinch(world, jaws, false)) {
    sit_down(world, jaws);
    jaws->latched = clip->set;
  }
  jaws->opening = fmax(least, jaws->opening + fmin(fmax(wanted - jaws->opening, -most), most));
}

void spore_clip_use(SporeWorld *world, SporeJaws *jaws, double wanted) {
  jaws->squeeze = 0;
  /* Another level of the body may have no spheres. */
  if (jaws->clip.set && world->bodies[jaws->clip.body].collision.spheres.point_count == 0) get_up(world, jaws);
  if (jaws->clip.leaving) leave(world, jaws);
  else close_on(world, jaws, wanted);
  if (jaws->clip.set) aim(world, jaws, placed(seat_frame(world, &jaws->clip), jaws->clip.shaft));
}

void spore_clip_set_effect(SporeWorld *world, SporeTool *tool) {
  SporeJaws *jaws = (SporeJaws *)tool;
  SporeJawClip *clip = &jaws->clip;
  if (!tool->effect) {
    clip->leaving = true;
    return;
  }
  set_apart(world, jaws, true);
  if (!clip->leaving) sit_down(world, jaws);
  clip->leaving = false;
  for (size_t i = 0; i < tool->spring_count; i++) world->links.active[tool->spring_start + i] = false;
}

void spore_clip_reset(SporeWorld *world, SporeJaws *jaws) {
  jaws->clip.set = jaws->clip.leaving = jaws->clip.back = false;
  set_apart(world, jaws, jaws->tool.effect);
}

/* The tissue between the jaws. */

bool spore_clip_squeeze(const SporeWorld *world, const SporeTool *tool, SporeSqueeze *squeeze) {
  const SporeJaws *jaws = (const SporeJaws *)tool;
  const SporeJawClip *clip = &jaws->clip;
  if (!clip->set || !(jaws->length > 0) || !(clip->touched > 0)) return false;
  *squeeze = (SporeSqueeze){.body = clip->body,
                            .frame = spore_jaws_frame(world, jaws),
                            .length = jaws->length,
                            .width = jaws->width,
                            .height = jaws->length * tan(0.5 * fmin(clip->touched, 3.)),
                            .ratio = fmin(1, tan(0.5 * fmin(jaws->opening, 3.)) / tan(0.5 * fmin(clip->touched, 3.)))};
  return true;
}
