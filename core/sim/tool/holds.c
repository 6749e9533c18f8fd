/* What jaws hold: the spheres of bodies, each tied to one of the jaws by a spring without length, or not tied at all
 * where the tool is an effect. */
#include <assert.h>
#include <math.h>

#include "core/sim/tool/jaws.h"
#include "core/sim/world_private.h"

#define PINCHED 0.3  /* of the radius of a sphere: depth of both jaws in it together, to hold it */
#define REACHED -0.1 /* the same of each: from there a jaw reaches it */

void spore_jaws_let_go(SporeWorld *world, SporeJaws *jaws) {
  assert(jaws->holds);
  for (size_t i = 0; i < jaws->tool.spring_count; i++) {
    jaws->holds[i].state = SPORE_HOLD_FREE;
    world->links.active[jaws->tool.spring_start + i] = false;
  }
  jaws->held_at = -1;
}

/* A free hold for the sphere; NULL: there is none, or the sphere is held already. */
static SporeHold *find_place(const SporeJaws *jaws, uint32_t sphere) {
  SporeHold *place = NULL;
  for (size_t i = 0; i < jaws->tool.spring_count; i++) {
    SporeHold *hold = &jaws->holds[i];
    if (hold->state == SPORE_HOLD_FREE) place = place ? place : hold;
    else if (hold->sphere == sphere) return NULL;
  }
  return place;
}

/* Ties the sphere of the hold to the jaw at its present place. */
static void tie(SporeWorld *world, SporeJaws *jaws, uint32_t jaw, const SporeHold *hold) {
  assert(jaw < world->body_count);
  assert(hold->sphere < world->contact.spheres.count);
  size_t index = jaws->tool.spring_start + (size_t)(hold - jaws->holds);
  uint32_t held = world->contact.spheres.body[hold->sphere];
  const SporeBody *body = &world->bodies[held];
  uint32_t point = hold->sphere - (uint32_t)body->collision.start;
  SporeSpringTerm *term = &world->links.springs[index];
  term->a = (SporeEnd){.mapping = &body->collision.spheres, .body = held, .point = point};
  term->b = (SporeEnd){.mapping = &world->links.mappings[2 * index + 1], .body = jaw};
  const double *frame = world->state.q + world->bodies[jaw].q_offset;
  const SporePose pose = spore_pose_load(frame);
  SporeVec3 at = spore_mapping_position(&body->collision.spheres, point, world->state.q + body->q_offset);
  spore_vec3_store(term->b.mapping->points, spore_pose_apply_inverse(pose, at));
  double mass = body->total_mass / (double)body->collision.spheres.point_count;
  term->law = (SporeSpring){.stiffness = jaws->fields.stiffness, .damping = 2 * sqrt(jaws->fields.stiffness * mass)};
  term->force = (SporeVec3){0, 0, 0};
  world->links.active[index] = true;
  spore_world_wake(world, held);
}

void spore_jaws_tie(SporeWorld *world, SporeJaws *jaws) {
  for (size_t i = 0; i < jaws->tool.spring_count; i++) {
    const SporeHold *hold = &jaws->holds[i];
    if (hold->state == SPORE_HOLD_TIED &&
        world->bodies[world->contact.spheres.body[hold->sphere]].role == SPORE_PASSIVE)
      tie(world, jaws, jaws->jaw[0].body, hold);
  }
  jaws->held_at = jaws->opening;
}

/* Holds the sphere, where it is not held yet and there is a hold for it. */
static SporeHold *take(SporeJaws *jaws, uint32_t sphere) {
  SporeHold *hold = find_place(jaws, sphere);
  if (hold) *hold = (SporeHold){SPORE_HOLD_TIED, sphere};
  return hold;
}

void spore_jaws_hold(SporeWorld *world, SporeJaws *jaws, uint32_t jaw, uint32_t sphere) {
  const SporeHold *hold = take(jaws, sphere);
  if (hold) tie(world, jaws, jaw, hold);
}

/* How deep the jaw is in the ball, m; negative: it does not touch it. */
static double depth_in(const SporeWorld *world, const SporeJaw *jaw, SporeVec3 centre, double radius) {
  assert(jaw->body < world->body_count);
  double deepest = -HUGE_VAL;
  const SporeBody *body = &world->bodies[jaw->body];
  const SporeMapping *spheres = &body->collision.spheres;
  for (size_t i = 0; i < spheres->point_count; i++) {
    SporeVec3 at = spore_mapping_position(spheres, i, world->state.q + body->q_offset);
    double reach = radius + world->contact.spheres.radius[body->collision.start + i];
    deepest = fmax(deepest, reach - spore_vec3_distance(at, centre));
  }
  return deepest;
}

/* Whether jaws may have the body between them by its shape alone: drops they do not feel. */
static bool may_pinch(const SporeWorld *world, const SporeJaws *jaws, const SporeBody *body) {
  int64_t group = world->bodies[jaws->jaw[0].body].collision.fields.group;
  return body->role != SPORE_ACTIVE && !spore_body_is_fluid(body) &&
         !(group != 0 && group == body->collision.fields.group);
}

/* The jaws as they are in a state. */
typedef struct Jaws {
  SporeWorld *world;
  SporeJaws *jaws;
  SporePose frame; /* spore_jaws_frame */
  double half_gap; /* between them, for a length of 1 */
  double depth[2]; /* how deep each is in what of a body lies between them, in radii of its spheres */
} Jaws;

SporePose spore_jaws_frame(const SporeWorld *world, const SporeJaws *jaws) {
  const SporePose shaft = spore_pose_load(world->state.q + world->bodies[jaws->tool.bodies[0]].q_offset);
  SporeMat3 axes = spore_mat3_from_columns(jaws->along, jaws->axis, spore_vec3_cross(jaws->along, jaws->axis));
  return (SporePose){spore_pose_apply(shaft, jaws->hinge),
                     spore_quat_multiply(shaft.orientation, spore_quat_from_mat3(axes))};
}

static Jaws look_at(SporeWorld *world, SporeJaws *jaws) {
  return (Jaws){.world = world,
                .jaws = jaws,
                .frame = spore_jaws_frame(world, jaws),
                .half_gap = tan(0.5 * fmin(jaws->opening, 3.)),
                .depth = {-HUGE_VAL, -HUGE_VAL}};
}

static SporeVec3 centre_of(const Jaws *look, const SporeBody *body, size_t sphere) {
  return spore_mapping_position(&body->collision.spheres, sphere, look->world->state.q + body->q_offset);
}

/* Whether the sphere lies between the jaws, or is met by one of them from within. */
static bool is_between(const Jaws *look, SporeVec3 centre, double radius) {
  SporeVec3 at = spore_pose_apply_inverse(look->frame, centre);
  return at.x > -radius && at.x < look->jaws->length + radius && fabs(at.y) < look->jaws->width + radius &&
         fabs(at.z) < look->half_gap * fmax(at.x, 0) + look->jaws->width + radius;
}

/* How deep each jaw is in what of the body lies between them. */
static void find_depths(Jaws *look, const SporeBody *body) {
  look->depth[0] = look->depth[1] = -HUGE_VAL;
  for (size_t i = 0; i < body->collision.spheres.point_count; i++) {
    double radius = look->world->contact.spheres.radius[body->collision.start + i];
    SporeVec3 centre = centre_of(look, body, i);
    if (spore_vec3_distance(centre, look->frame.position) > look->jaws->reach + radius ||
        !is_between(look, centre, radius))
      continue;
    for (int j = 0; j < 2; j++) {
      double depth = depth_in(look->world, &look->jaws->jaw[j], centre, radius) / radius;
      look->depth[j] = fmax(look->depth[j], depth);
    }
  }
}

static bool take_between(const Jaws *look, const SporeBody *body, bool tied) {
  bool found = false;
  for (size_t i = 0; i < body->collision.spheres.point_count; i++) {
    uint32_t sphere = (uint32_t)(body->collision.start + i);
    if (!is_between(look, centre_of(look, body, i), look->world->contact.spheres.radius[sphere])) continue;
    if (tied) spore_jaws_hold(look->world, look->jaws, look->jaws->jaw[0].body, sphere);
    else take(look->jaws, sphere);
    found = true;
  }
  return found;
}

bool spore_jaws_pinch(SporeWorld *world, SporeJaws *jaws, bool effects) {
  Jaws look = look_at(world, jaws);
  bool found = false;
  for (size_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (!may_pinch(world, jaws, body) || (effects && !body->effect.on)) continue;
    find_depths(&look, body);
    if (fmin(look.depth[0], look.depth[1]) > REACHED && look.depth[0] + look.depth[1] > PINCHED)
      found |= take_between(&look, body, effects);
  }
  return found;
}
