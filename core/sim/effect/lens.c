/* What wets the front of an endoscope, and the haze before it.
 *
 * A drop that touches the front covers a part of it. Blood dries on the lens and stays there until it is rinsed; water
 * rinses, and runs off. Both are taken on and washed off at the rate at which the fluid stains what it lies on. Smoke
 * between lens and tissue takes light away; what was let out by now goes on taking light while it thins out, although
 * the puffs themselves are gone.
 *
 * A lens is wiped by the first button of the device that moves its body, by a command, and when it was drawn out of its
 * port: then an assistant wipes it. Lenses are looked at as often as stains are, in steps that are told by their
 * number, so that a run can be repeated to the bit. */
#include "core/sim/effect/lens.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/sim/world_private.h"

#define TOUCH 2.      /* radii of the drop: so near to the glass it runs onto the glass */
#define RUNS_OFF_S 3. /* in which a film of water on warm glass thins to a third */
/* Area of smoke, weighted by how much of what is behind it each puff covers, that dims the view by a third in a second:
 * that of a field of view as wide as a hand. */
#define HAZE_M2 8e-3
#define NEAR_M 0.1           /* smoke that is nearer counts wherever it is */
#define COS_BEFORE M_SQRT1_2 /* of the angle to the sight within which smoke that is farther counts */

static SporePose frame_of(const SporeWorld *world, uint32_t index) {
  if (index == SPORE_NO_BODY) return spore_pose_identity();
  const double *q = world->state.q + world->bodies[index].q_offset;
  return spore_pose_load(q);
}

static bool has_frame(const SporeWorld *world, uint32_t body) {
  const SporeModel *model = world->bodies[body].model;
  return !model || spore_model_is_rigid(model);
}

static void find_port(const SporeWorld *world, SporeLens *lens) {
  for (size_t i = 0; i < world->links.trocar_count; i++) {
    const SporeTrocar *trocar = &world->links.trocars[i];
    if (trocar->body != lens->body) continue;
    SporeVec3 inside = spore_vec3_sub(lens->point, trocar->base);
    double side = spore_vec3_dot(inside, trocar->along);
    SporeVec3 pivot = spore_pose_apply_inverse(world->bodies[lens->body].rest_pose, trocar->pivot);
    side -= spore_vec3_dot(spore_vec3_sub(pivot, trocar->base), trocar->along);
    lens->has_port = side != 0;
    lens->pivot = trocar->pivot;
    lens->inward = spore_vec3_scale(side < 0 ? -1 : 1, trocar->along);
  }
}

static SporeLens make_lens(const SporeWorld *world, const SporeEyeDescription *eye) {
  bool moves = eye->body != SPORE_NO_BODY && has_frame(world, eye->body);
  SporeLens lens = {.body = moves ? eye->body : SPORE_NO_BODY, .radius = eye->lens, .haze_s = eye->haze_s};
  SporePose start = moves ? world->bodies[eye->body].rest_pose : spore_pose_identity();
  lens.point = spore_pose_apply_inverse(start, eye->point);
  lens.sight = spore_quat_rotate(spore_quat_conjugate(start.orientation), eye->sight);
  if (moves) find_port(world, &lens);
  return lens;
}

bool spore_world_create_lenses(SporeWorld *world, const SporeWorldDescription *description) {
  SporeLenses *lenses = &world->lenses;
  lenses->all = SPORE_NEW_ARRAY(SporeLens, description->eye_count);
  lenses->state = SPORE_NEW_ARRAY(SporeLensState, description->eye_count);
  if (!lenses->all || !lenses->state) return false;
  lenses->count = description->eye_count;
  for (size_t i = 0; i < lenses->count; i++) lenses->all[i] = make_lens(world, &description->eyes[i]);
  return true;
}

void spore_world_clear_lenses(SporeWorld *world) {
  spore_free(world->lenses.all);
  spore_free(world->lenses.state);
}

void spore_world_reset_lenses(SporeWorld *world) {
  if (world->lenses.count) memset(world->lenses.state, 0, world->lenses.count * sizeof *world->lenses.state);
}

void spore_world_wipe_lens(SporeWorld *world, size_t lens) {
  if (lens < world->lenses.count) world->lenses.state[lens].blood = world->lenses.state[lens].water = 0;
}

static bool is_smoke(const SporeBody *body) { return body->model->type->particles->puff != NULL; }

/* Whether the fluid comes onto that lens, or before it. */
static bool reaches(const SporeWorld *world, const SporeLens *lens, const SporeBody *body) {
  if (!spore_body_is_fluid(body)) return false;
  return is_smoke(body) ? lens->haze_s > 0 : lens->radius > 0 && body->collision.spheres.point_count > 0;
}

bool spore_world_may_wet_lens(const SporeWorld *world) {
  for (size_t i = 0; i < world->lenses.count; i++)
    for (size_t b = 0; b < world->body_count; b++)
      if (reaches(world, &world->lenses.all[i], &world->bodies[b])) return true;
  return false;
}

/* Drops on a lens, as parts of the front that they cover; and the area of smoke, m^2. */
typedef struct Met {
  double blood, water, smoke;
} Met;

static void meet_drops(const SporeWorld *world, const SporeLens *lens, const SporeBody *body, Met *met) {
  SporePose frame = frame_of(world, lens->body);
  SporeVec3 glass = spore_pose_apply(frame, lens->point), sight = spore_quat_rotate(frame.orientation, lens->sight);
  const double *q = world->state.q + body->q_offset, rate = body->model->stain;
  const double *radius = world->contact.spheres.radius + body->collision.start;
  double covered = 0;
  for (size_t i = 0; i < body->collision.spheres.point_count; i++) {
    SporeVec3 to = spore_vec3_sub(spore_vec3_load(q + 3 * i), glass);
    double before = spore_vec3_dot(to, sight), near = TOUCH * radius[i];
    double aside = sqrt(fmax(spore_vec3_dot(to, to) - before * before, 0));
    if (fabs(before) < near && aside < lens->radius + radius[i])
      covered += radius[i] * radius[i] / (lens->radius * lens->radius);
  }
  if (rate > 0) met->blood += rate * fmin(covered, 1);
  else met->water += -rate * fmin(covered, 1);
}

/* Whether a puff there takes light away: near smoke drifts before the lens wherever it is. */
static bool dims(SporeVec3 glass, SporeVec3 sight, SporeVec3 puff, double radius) {
  SporeVec3 to = spore_vec3_sub(puff, glass);
  double far = fmax(spore_vec3_length(to) - radius, 0);
  return far < NEAR_M || spore_vec3_dot(to, sight) + radius > COS_BEFORE * far;
}

static void meet_smoke(const SporeWorld *world, const SporeLens *lens, const SporeBody *body, Met *met) {
  SporePose frame = frame_of(world, lens->body);
  SporeVec3 glass = spore_pose_apply(frame, lens->point), sight = spore_quat_rotate(frame.orientation, lens->sight);
  const double *q = world->state.q + body->q_offset;
  for (size_t i = 0; i < body->model->node_count; i++) {
    double radius, opacity;
    if (spore_particle_is_out(q + 3 * i)) continue;
    body->model->type->particles->puff(body->model, q, i, &radius, &opacity);
    if (!dims(glass, sight, spore_vec3_load(q + 3 * i), radius)) continue;
    met->smoke += 3.141592653589793 * radius * radius * opacity;
  }
}

static bool is_out(const SporeWorld *world, const SporeLens *lens) {
  SporePose frame = frame_of(world, lens->body);
  SporeVec3 in = spore_vec3_sub(spore_pose_apply(frame, lens->point), lens->pivot);
  return spore_vec3_dot(in, spore_quat_rotate(frame.orientation, lens->inward)) < 0;
}

static bool is_wiped(const SporeWorld *world, const SporeLens *lens) {
  if (lens->body == SPORE_NO_BODY) return false;
  const SporeBodyDevice *device = &world->bodies[lens->body].device;
  return (device->has_input && (device->input.buttons & SPORE_FIRST_BUTTON)) || (lens->has_port && is_out(world, lens));
}

/* The rates are those of the drops that lie there now, so that this is exact for any step in which they stay. */
static void take_on(SporeLensState *state, const SporeLens *lens, const Met *met, double time_s) {
  state->blood -= (1 - state->blood) * (float)expm1(-met->blood * time_s);
  state->blood *= (float)exp(-met->water * time_s);
  state->water -= (1 - state->water) * (float)expm1(-met->water * time_s);
  state->water *= (float)exp(-time_s / RUNS_OFF_S);
  if (!(lens->haze_s > 0)) return;
  state->haze -= (1 - state->haze) * (float)expm1(-met->smoke / HAZE_M2 * time_s);
  state->haze *= (float)exp(-time_s / lens->haze_s);
}

void spore_world_wet_lenses(SporeWorld *world) {
  double steps = spore_stain_pace(world);
  if (world->state.step % (uint64_t)steps != 0) return;
  for (size_t i = 0; i < world->lenses.count; i++) {
    const SporeLens *lens = &world->lenses.all[i];
    Met met = {0};
    for (size_t b = 0; b < world->body_count; b++) {
      const SporeBody *body = &world->bodies[b];
      if (!reaches(world, lens, body)) continue;
      if (is_smoke(body)) meet_smoke(world, lens, body, &met);
      else meet_drops(world, lens, body, &met);
    }
    take_on(&world->lenses.state[i], lens, &met, steps * world->solver.time_step);
    if (is_wiped(world, lens)) spore_world_wipe_lens(world, i);
  }
}

/* What others see. */

size_t spore_world_lens_count(const SporeWorld *world) { return world->lenses.count; }

SporeLensState spore_world_lens(const SporeWorld *world, size_t lens) {
  assert(lens < world->lenses.count);
  return world->lenses.state[lens];
}

uint32_t spore_world_lens_body(const SporeWorld *world, size_t lens) {
  assert(lens < world->lenses.count);
  return world->lenses.all[lens].body;
}

void spore_world_carry_lenses(SporeWorld *to, const SporeWorld *from) {
  size_t count = to->lenses.count;
  if (count > 0 && count == from->lenses.count)
    memcpy(to->lenses.state, from->lenses.state, count * sizeof *to->lenses.state);
}
