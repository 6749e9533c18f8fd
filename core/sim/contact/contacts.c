/* Contacts of a step: maps spheres from the state, finds contacts of the spheres, and makes terms of the contacts. */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

/* Spheres of an active body have the velocity that takes them to their target in one step. */
static void map_active(SporeWorld *world, const SporeBody *body, double *centre, double *velocity) {
  assert(body->role == SPORE_ACTIVE);
  assert(world->solver.time_step > 0);
  spore_mapping_positions(&body->collision.spheres, world->state.target_q + body->q_offset, velocity);
  double rate = 1 / world->solver.time_step;
  for (size_t k = 0; k < 3 * body->collision.spheres.point_count; k++) velocity[k] = (velocity[k] - centre[k]) * rate;
}

/* Drops go in this step for as long as they go at all, and fall meanwhile. */
static void map_drops(const SporeWorld *world, const SporeBody *body, double *velocity) {
  double time_s = spore_body_pour_time(world, body), part = time_s / world->solver.time_step;
  SporeVec3 gained = spore_vec3_scale(0.5 * time_s, spore_body_gravity(world, body));
  for (size_t i = 0; i < body->collision.spheres.point_count; i++, velocity += 3)
    spore_vec3_store(velocity, spore_vec3_scale(part, spore_vec3_add(spore_vec3_load(velocity), gained)));
}

/* Notes where the spheres of the body are, before they follow the state. */
static void keep_centres(const SporeWorld *world, SporeBody *body, bool moves) {
  size_t start = 3 * body->collision.start, count = 3 * body->collision.spheres.point_count;
  const SporeSpheres *spheres = &world->contact.spheres;
  if (moves || body->collision.moved) memcpy(spheres->before + start, spheres->centre + start, count * sizeof(double));
  body->collision.moved = moves;
}

/* Of spheres that were put where they are: they have come no way. A particle that leaves the world or comes into it is
 * put, too. */
static void forget_ways(const SporeWorld *world, const SporeBody *body) {
  size_t start = 3 * body->collision.start, count = 3 * body->collision.spheres.point_count;
  const double *centre = world->contact.spheres.centre + start;
  double *before = world->contact.spheres.before + start;
  if (body->collision.put) memcpy(before, centre, count * sizeof *before);
  for (size_t k = 0; body->parking_gap > 0 && k < count; k += 3)
    if (fabs(centre[k] - before[k]) > 0.5 * SPORE_PARTICLES_OUT_M) before[k] = NAN;
}

void spore_world_map_spheres(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    bool still = body->role == SPORE_UNMOVABLE && !world->schedule.unpruned;
    if (still || body->collision.spheres.point_count == 0) continue;
    keep_centres(world, body, body->changed > world->contact.mapped || world->schedule.unpruned);
    if (!body->collision.moved) continue;
    assert(body->collision.start + body->collision.spheres.point_count <= world->contact.spheres.count);
    const double *q = world->state.q + body->q_offset, *v = world->state.v + body->v_offset;
    double *centre = world->contact.spheres.centre + 3 * body->collision.start;
    double *velocity = world->contact.spheres.velocity + 3 * body->collision.start;
    spore_mapping_positions(&body->collision.spheres, q, centre);
    if (body->role == SPORE_ACTIVE) map_active(world, body, centre, velocity);
    else spore_mapping_velocities(&body->collision.spheres, q, v, velocity);
    if (body->effect.on && body->effect.drops.from) map_drops(world, body, velocity);
    forget_ways(world, body);
  }
  world->contact.mapped = world->state.snapshots.newest;
}

/* Makes room for `wanted` contacts in the arrays of the world. An array that has grown where another could not stays
 * larger than the capacity says. */
static bool reserve_terms(SporeWorld *world, size_t wanted) {
  size_t old = world->contact.capacity;
  assert(wanted >= old);
  SporeContactTerm *terms = spore_reallocate(world->contact.terms, old, wanted, sizeof *terms);
  if (terms) world->contact.terms = terms;
  SporeCoupling *couplings = spore_reallocate(world->contact.couplings, old, wanted, sizeof *couplings);
  if (couplings) world->contact.couplings = couplings;
  size_t bodies = world->body_count; /* each island may leave some lanes empty */
  SporeContactLanes *lanes = spore_reallocate(world->contact.lanes, old ? spore_lanes_for(old) + bodies : 0,
                                              spore_lanes_for(wanted) + bodies, sizeof *lanes);
  if (lanes) world->contact.lanes = lanes;
  SporeManifoldContact *manifold = spore_reallocate(world->contact.manifold, old, wanted, sizeof *manifold);
  if (manifold) world->contact.manifold = manifold;
  bool pairs = spore_pairs_reserve(world, old, wanted);
  uint32_t *order = spore_reallocate(world->contact.order, old, wanted, sizeof *order);
  if (order) world->contact.order = order;
  if (!terms || !couplings || !lanes || !manifold || !pairs || !order) return false;
  world->contact.capacity = wanted;
  return true;
}

/* The grid grows last, so that the grid never finds more contacts than the world has room for. */
bool spore_world_reserve_contacts(SporeWorld *world) {
  assert(world->contact.grid);
  size_t missed = world->contact.missed, wanted = spore_grid_capacity(world->contact.grid) + missed;
  if (missed) wanted += wanted / 2;
  if (wanted > world->contact.capacity && !reserve_terms(world, wanted)) return false;
  if (missed && !spore_grid_reserve(world->contact.grid, wanted)) return false;
  world->contact.missed = 0;
  return true;
}

bool spore_body_map_spheres(SporeWorld *world, uint32_t index, const SporeSphereSet *set, SporeError *error) {
  assert(index < world->body_count);
  assert(!set || set->count == 0 || set->spheres);
  SporeBody *body = &world->bodies[index];
  size_t count = set ? set->count : 0;
  double *points = SPORE_NEW_ARRAY(double, 3 * count);
  if (!points) return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the world"));
  for (size_t s = 0; s < count; s++) memcpy(points + 3 * s, set->spheres + 4 * s, 3 * sizeof *points);
  bool mapped =
      spore_body_map(world, index, body->grade, points, count, world->cancel, &body->collision.spheres, error);
  spore_free(points);
  if (mapped) return true;
  char place[200];
  snprintf(place, sizeof place, "bodies/%s", body->name);
  spore_error_at(error, place);
  return false;
}

/* The grid does not say of which bodies the contacts would have been. */
static void count_left_out(SporeWorld *world) {
  for (uint32_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].role == SPORE_PASSIVE && world->bodies[b].collision.spheres.point_count > 0)
      spore_world_count_unsolved(world, b, SPORE_UNSOLVED_LEFT_OUT, (double)world->contact.missed);
}

#define SLOWEST_IMPACT 5e-3 /* m/s */
#define STEPS_OF_FALL 2

double spore_world_slowest_impact(const SporeWorld *world) {
  return fmax(SLOWEST_IMPACT, STEPS_OF_FALL * world->solver.time_step * spore_vec3_length(world->state.gravity));
}

/* Of the slowest impact: what meets so slowly enters without a force before the next step. */
#define LOOKED_AHEAD 0.125

static void find_contacts(SporeWorld *world) {
  assert(world->contact.reach);
  SporeSpheres reaching = world->contact.spheres;
  reaching.radius = world->contact.reach;
  reaching.slowest = LOOKED_AHEAD * spore_world_slowest_impact(world);
  world->contact.count =
      spore_grid_detect(world->contact.grid, &reaching, world->solver.time_step, &world->contact.missed);
}

/* Without room for a contact, a body would fall through another, and the run could not be repeated. So room is made at
 * once. This is the only place where a step may allocate. It does so seldom, since the room never shrinks. */
void spore_world_detect(SporeWorld *world) {
  assert(world->contact.grid);
  assert(spore_grid_capacity(world->contact.grid) <= world->contact.capacity);
  find_contacts(world);
  while (world->contact.missed && spore_world_reserve_contacts(world)) find_contacts(world);
  if (!world->contact.missed) return;
  count_left_out(world);
  spore_world_report(world, _("%zu contacts are left out: there is no memory for them; use fewer or smaller spheres"),
                     world->contact.missed);
}

void spore_world_fill_end(const SporeWorld *world, SporeEnd *end) {
  assert(end->body == SPORE_NO_BODY || end->body < world->body_count);
  assert(end->mapping && end->point < end->mapping->point_count);
  const SporeVec3 none = {0, 0, 0};
  end->velocity = end->offset = none;
  end->prescribed = end->body == SPORE_NO_BODY || !spore_body_moves(&world->bodies[end->body]);
  if (end->body == SPORE_NO_BODY) {
    end->position = spore_mapping_position(end->mapping, end->point, NULL);
    return;
  }
  const SporeBody *body = &world->bodies[end->body];
  end->position = spore_mapping_position(end->mapping, end->point, world->state.q + body->q_offset);
  if (body->role != SPORE_ACTIVE) return;
  SporeVec3 target = spore_mapping_position(end->mapping, end->point, world->state.target_q + body->q_offset);
  end->offset = spore_vec3_sub(target, end->position);
  end->velocity = spore_vec3_scale(1 / world->solver.time_step, end->offset);
}

static void fill_sphere_end(const SporeWorld *world, uint32_t sphere, SporeEnd *end) {
  assert(sphere < world->contact.spheres.count);
  const SporeVec3 none = {0, 0, 0};
  uint32_t index = world->contact.spheres.body[sphere];
  const SporeBody *body = &world->bodies[index];
  *end = (SporeEnd){.mapping = &body->collision.spheres,
                    .body = index,
                    .point = sphere - (uint32_t)body->collision.start,
                    .prescribed = !spore_body_moves(body),
                    .position = spore_vec3_load(world->contact.spheres.centre + 3 * (size_t)sphere)};
  if (!end->prescribed) return;
  bool driven = body->role == SPORE_ACTIVE;
  end->velocity = driven ? spore_vec3_load(world->contact.spheres.velocity + 3 * (size_t)sphere) : none;
  end->offset = spore_vec3_scale(world->solver.time_step, end->velocity);
}

static SporeContactMaterial material(const SporeBody *body) {
  return (SporeContactMaterial){body->collision.fields.stiffness, body->collision.fields.damping,
                                body->collision.fields.friction};
}

/* The arm in the frame of its rigid body; 0 for other bodies. */
static SporeVec3 frame_arm(const SporeWorld *world, const SporeEnd *end, SporeVec3 arm) {
  if (end->mapping->kind != SPORE_MAPPING_RIGID) return (SporeVec3){0, 0, 0};
  SporeQuat turn = spore_quat_load(world->state.q + world->bodies[end->body].q_offset + 3);
  return spore_quat_rotate(spore_quat_conjugate(turn), arm);
}

/* Arms lead from the centres of the spheres to the contact point, in the middle of the depth. */
static void set_arms(const SporeWorld *world, SporeContactTerm *term) {
  assert(term->sphere_a < world->contact.spheres.count && term->sphere_b < world->contact.spheres.count);
  const double *radius = world->contact.spheres.radius;
  SporeVec3 apart = spore_vec3_sub(term->b.position, term->a.position);
  spore_contact_term_set_arms(term, radius[term->sphere_a], radius[term->sphere_b]);
  if (term->field_a) term->arm_a = spore_vec3_add(term->arm_b, apart);
  if (term->field_b) term->arm_b = spore_vec3_sub(term->arm_a, apart);
  term->frame_arm_a = frame_arm(world, &term->a, term->arm_a);
  term->frame_arm_b = frame_arm(world, &term->b, term->arm_b);
}

/* Gives a driven end the velocity of its contact point, so that a tool that turns drags tissue along. The depth of a
 * sphere does not change by the turning. */
static void turn_driven_end(const SporeWorld *world, SporeEnd *end, SporeVec3 frame_arm, SporeVec3 arm, bool field,
                            SporeVec3 normal) {
  assert(end->body < world->body_count);
  const SporeBody *body = &world->bodies[end->body];
  if (body->role != SPORE_ACTIVE || end->mapping->kind != SPORE_MAPPING_RIGID) return;
  SporeQuat target = spore_quat_load(world->state.target_q + body->q_offset + 3);
  SporeVec3 moved = spore_vec3_sub(spore_quat_rotate(target, frame_arm), arm);
  if (!field) moved = spore_vec3_add_scaled(moved, -spore_vec3_dot(moved, normal), normal);
  end->offset = spore_vec3_add(end->offset, moved);
  end->velocity = spore_vec3_scale(1 / world->solver.time_step, end->offset);
}

static void fill_term(const SporeWorld *world, const SporeManifoldContact *found, SporeContactTerm *term) {
  assert(found->contact.a != found->contact.b);
  const SporeContact *contact = &found->contact;
  fill_sphere_end(world, contact->a, &term->a);
  fill_sphere_end(world, contact->b, &term->b);
  SporeContactMaterial a = material(&world->bodies[term->a.body]), b = material(&world->bodies[term->b.body]);
  term->sphere_a = contact->a;
  term->sphere_b = contact->b;
  term->pair_a = found->pair_a;
  term->pair_b = found->pair_b;
  term->field_a = found->field_a;
  term->field_b = found->field_b;
  term->normal = contact->normal;
  term->depth = contact->depth;
  term->overlap = 0;
  set_arms(world, term);
  turn_driven_end(world, &term->a, term->frame_arm_a, term->arm_a, term->field_a, term->normal);
  turn_driven_end(world, &term->b, term->frame_arm_b, term->arm_b, term->field_b, term->normal);
  term->law =
      spore_contact_law(&a, &b, world->contact.spheres.radius[contact->a], world->contact.spheres.radius[contact->b]);
  term->stretch = term->drag = term->force = (SporeVec3){0, 0, 0};
  term->pressing = INFINITY;
}

void spore_world_respond(SporeWorld *world) {
  world->contact.count = spore_world_find_manifold(world);
  assert(world->contact.count <= world->contact.capacity);
  for (size_t i = 0; i < world->contact.count; i++)
    fill_term(world, &world->contact.manifold[i], &world->contact.terms[i]);
  spore_world_restore_pairs(world);
  spore_world_watch_passing(world);
  for (size_t i = 0; i < world->contact.count; i++) {
    /* Two bodies that physics does not move still press on each other, such as a tool on a wall. The force goes to the
     * tool's device. */
    SporeContactTerm *term = &world->contact.terms[i];
    if (term->a.prescribed && term->b.prescribed) spore_contact_term_hold(term);
  }
  for (size_t b = 0; world->contact.any_put && b < world->body_count; b++) world->bodies[b].collision.put = false;
  world->contact.any_put = false;
}

void spore_body_put(SporeWorld *world, uint32_t index) {
  assert(index < world->body_count);
  world->bodies[index].collision.put = world->contact.any_put = true;
}

void spore_contacts_forget(SporeWorld *world) {
  world->contact.count = world->contact.pair_count = 0; /* contacts belong to the state before */
  for (uint32_t b = 0; b < world->body_count; b++) spore_body_put(world, b);
}

void spore_contacts_clear(SporeContactSystem *contact) {
  spore_grid_free(contact->grid);
  spore_free(contact->spheres.centre);
  spore_free(contact->spheres.before);
  spore_free(contact->spheres.velocity);
  spore_free(contact->spheres.radius);
  spore_free(contact->spheres.body);
  spore_free(contact->reach);
  spore_free(contact->manifold);
  spore_free(contact->terms);
  spore_free(contact->lanes);
  spore_free(contact->frames);
  spore_free(contact->couplings);
  spore_free(contact->order);
  spore_free(contact->pairs);
  spore_free(contact->pairs_scratch);
}
