/* Tissue as an effect: it has the shape of time 0, and gives way to instruments. What they press in goes with them, and
 * so does what jaws hold; what they have left comes back in a fraction of a second. */
#include <assert.h>
#include <string.h>

#include "core/sim/effect/shape.h"
#include "core/sim/world_private.h"

#define MOST_DENTS 8    /* at a time; where more of an instrument presses, the deepest do */
#define MOST_HOLDS 8    /* at a time, of what jaws hold: the farthest from its jaw first */
#define HOLD_WIDTH 2.0  /* of what goes with the jaws, in radii of the tissue's sphere */
#define DEEP 0.02       /* of the radius of the sphere: what is less deep makes no dent of its own */
#define LEAST_WIDTH 0.5 /* of a dent, in radii of the tissue's sphere */
#define BACK_S 0.15     /* time in which what was pressed in comes back, but for 1/e of it */
#define AT_REST_M 1e-7  /* what is nearer to rest is there */

typedef struct Shape {
  SporeWorld *world;
  const SporeBody *body;
  SporeDent dents[MOST_DENTS + MOST_HOLDS];
  size_t dent_count;
} Shape;

/* Whether jaws hold the body, one of which is that; what they hold goes with them, and they press it no further. */
static bool holds(const SporeWorld *world, uint32_t jaw, const SporeBody *body) {
  bool held = false;
  for (size_t i = 0; i < world->tools.count && !held; i++) {
    const SporeTool *tool = world->tools.all[i];
    if (tool->bodies[SPORE_TOOL_JAW_A] == jaw || tool->bodies[SPORE_TOOL_JAW_B] == jaw)
      held = tool->type->holds && tool->type->holds(world, tool, (uint32_t)(body - world->bodies)) > 0;
  }
  return held;
}

static bool presses(const SporeWorld *world, uint32_t active, const SporeBody *body) {
  const SporeBody *other = &world->bodies[active];
  int64_t group = other->collision.fields.group;
  return other->role == SPORE_ACTIVE && !spore_world_is_led_by_effect(world, active) &&
         !(group != 0 && group == body->collision.fields.group) && !holds(world, active, body);
}

/* Centre of the instrument's sphere when the step ends. */
static SporeVec3 sphere_then(const SporeWorld *world, size_t sphere) {
  const SporeSpheres *all = &world->contact.spheres;
  return spore_vec3_add_scaled(spore_vec3_load(all->centre + 3 * sphere), world->solver.time_step,
                               spore_vec3_load(all->velocity + 3 * sphere));
}

/* Ball around the tissue's spheres at rest. */
static void surround(const Shape *shape, SporeVec3 *centre, double *radius) {
  const SporeBody *body = shape->body;
  const double *rest = shape->world->state.rest_q + body->q_offset;
  size_t count = body->collision.spheres.point_count;
  *centre = (SporeVec3){0, 0, 0}, *radius = 0;
  for (size_t i = 0; i < count; i++)
    *centre =
        spore_vec3_add_scaled(*centre, 1. / (double)count, spore_mapping_position(&body->collision.spheres, i, rest));
  for (size_t i = 0; i < count; i++) {
    SporeVec3 place = spore_mapping_position(&body->collision.spheres, i, rest);
    double reach =
        spore_vec3_distance(place, *centre) + shape->world->contact.spheres.radius[body->collision.start + i];
    *radius = fmax(*radius, reach);
  }
}

/* The deepest that the sphere of an instrument still is in the tissue, as it comes back and is dented by now. */
static void press(const Shape *shape, size_t sphere, SporeDent *deepest) {
  const SporeBody *body = shape->body;
  const double *radii = shape->world->contact.spheres.radius, *next = shape->world->state.next_q + body->q_offset;
  SporeVec3 tool = sphere_then(shape->world, sphere);
  double most = spore_vec3_length(deepest->push);
  for (size_t i = 0; i < body->collision.spheres.point_count; i++) {
    SporeVec3 place = spore_mapping_position(&body->collision.spheres, i, next);
    place = spore_vec3_add(place, spore_dents_at(shape->dents, shape->dent_count, place));
    double own = radii[body->collision.start + i], depth = radii[sphere] + own - spore_vec3_distance(place, tool);
    if (!(depth > most) || !(depth > DEEP * own)) continue;
    most = depth;
    SporeVec3 away = spore_vec3_normalise(spore_vec3_sub(place, tool), (SporeVec3){0, -1, 0});
    *deepest = (SporeDent){place, spore_vec3_scale(depth, away), fmax(radii[sphere], LEAST_WIDTH * own)};
  }
}

/* Dents of all instruments, the deepest first. */
static void find_dents(Shape *shape) {
  SporeWorld *world = shape->world;
  const SporeSpheres *all = &world->contact.spheres;
  SporeVec3 centre;
  double radius;
  if (shape->body->collision.spheres.point_count == 0) return;
  surround(shape, &centre, &radius);
  while (shape->dent_count < MOST_DENTS) {
    SporeDent deepest = {.width = 0};
    for (size_t s = all->static_count; s < all->count; s++)
      if (presses(world, all->body[s], shape->body) &&
          spore_vec3_distance(sphere_then(world, s), centre) < radius + all->radius[s])
        press(shape, s, &deepest);
    if (!(deepest.width > 0)) return;
    shape->dents[shape->dent_count++] = deepest;
  }
}

/* Of the spheres that a tool holds the one that is farthest from where its jaw takes it, as it is dented by now. */
static void lag(const Shape *shape, const SporeTool *tool, SporeDent *farthest) {
  const SporeWorld *world = shape->world;
  const SporeBody *body = shape->body;
  const double *next = world->state.next_q + body->q_offset;
  for (size_t i = tool->spring_start; i < tool->spring_start + tool->spring_count; i++) {
    const SporeSpringTerm *term = &world->links.springs[i];
    if (!world->links.active[i] || &world->bodies[term->a.body] != body) continue;
    SporeVec3 place = spore_mapping_position(term->a.mapping, term->a.point, next);
    SporeVec3 to =
        spore_mapping_position(term->b.mapping, 0, world->state.target_q + world->bodies[term->b.body].q_offset);
    SporeVec3 push = spore_vec3_sub(to, spore_vec3_add(place, spore_dents_at(shape->dents, shape->dent_count, place)));
    if (!(spore_vec3_length(push) > fmax(AT_REST_M, spore_vec3_length(farthest->push)))) continue;
    double own = world->contact.spheres.radius[body->collision.start + term->a.point];
    *farthest = (SporeDent){place, push, HOLD_WIDTH * own};
  }
}

/* After those of what presses: what is held is where its jaw is. */
static void find_holds(Shape *shape) {
  for (size_t n = 0; n < MOST_HOLDS; n++) {
    SporeDent farthest = {.width = 0};
    for (size_t i = 0; i < shape->world->tools.count; i++)
      if (shape->world->tools.all[i]->type->holds) lag(shape, shape->world->tools.all[i], &farthest);
    if (!(farthest.width > 0)) return;
    shape->dents[shape->dent_count++] = farthest;
  }
}

/* What was pressed in comes part of the way back. Returns how far the farthest node is from its place at rest, m. */
static double come_back(const SporeWorld *world, const SporeBody *body) {
  const double *rest = world->state.rest_q + body->q_offset, *q = world->state.q + body->q_offset;
  double *next = world->state.next_q + body->q_offset, kept = exp(-world->solver.time_step / BACK_S), farthest = 0;
  for (size_t i = 0; i < 3 * body->block_count; i++) {
    double off = kept * (q[i] - rest[i]);
    next[i] = rest[i] + off;
    farthest = fmax(farthest, fabs(off));
  }
  return farthest;
}

static void dent_nodes(const Shape *shape) {
  const SporeBody *body = shape->body;
  const double *q = shape->world->state.q + body->q_offset;
  double *next = shape->world->state.next_q + body->q_offset;
  for (size_t i = 0; i < body->block_count; i++) {
    SporeVec3 place = spore_vec3_load(next + 3 * i);
    spore_vec3_store(next + 3 * i, spore_vec3_add(place, spore_dents_at(shape->dents, shape->dent_count, place)));
  }
  for (size_t i = 0; i < body->held.count; i++)
    memcpy(next + 3 * body->held.blocks[i], q + 3 * body->held.blocks[i], 3 * sizeof *q);
}

bool spore_body_shape_effect(SporeWorld *world, SporeBody *body) {
  assert(body->model && spore_model_is_nodal(body->model));
  Shape shape = {.world = world, .body = body};
  double farthest = come_back(world, body);
  find_dents(&shape);
  find_holds(&shape);
  if (shape.dent_count == 0 && body->effect.settled) return false;
  body->effect.settled = shape.dent_count == 0 && farthest < AT_REST_M;
  double *next = world->state.next_q + body->q_offset;
  if (body->effect.settled) memcpy(next, world->state.rest_q + body->q_offset, 3 * body->block_count * sizeof *next);
  else dent_nodes(&shape);
  return true;
}
