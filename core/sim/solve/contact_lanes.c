/* Contact lanes: fills lanes with the contacts of an island, and adds their forces to the bodies. */
#include "core/sim/contact/contact_lanes.h"

#include <assert.h>

#include "core/sim/solve/island_system.h"

static SporeContactLanes *lanes_at(const SporeIslandSystem *system, size_t i) {
  assert(i < spore_lanes_for(system->island->contact_count));
  return &system->world->contact.lanes[system->island->lanes_start + i];
}

static size_t lanes_count(const SporeIslandSystem *system) {
  return system->meets ? 0 : spore_lanes_for(system->island->contact_count);
}

/* Number of contacts in the i-th lanes. */
static size_t count_in(const SporeIslandSystem *system, size_t i) {
  assert(i * SPORE_LANES < system->island->contact_count);
  size_t left = system->island->contact_count - i * SPORE_LANES;
  return left < SPORE_LANES ? left : SPORE_LANES;
}

/* Kind of the lanes with this end too. `kind`: of the ends before. */
static SporeLanesKind join_kind(const SporeIslandSystem *system, const SporeEnd *end, bool field, SporeLanesKind kind) {
  assert(end->prescribed || end->body < system->world->body_count);
  assert(end->mapping && end->point < end->mapping->point_count);
  if (field) return SPORE_LANES_APART;
  if (end->prescribed) return kind;
  SporeLanesKind its = SPORE_LANES_APART;
  if (end->mapping->kind == SPORE_MAPPING_RIGID) its = SPORE_LANES_FRAMES;
  else if (end->mapping->kind == SPORE_MAPPING_IDENTITY && system->world->solve.local_sites[end->body].q % 3 == 0)
    its = SPORE_LANES_NODES;
  return kind == its ? kind : SPORE_LANES_APART;
}

static SporeLanesKind kind_of(const SporeIslandSystem *system, size_t first, size_t count) {
  assert(count > 0 && first + count <= system->island->contact_count);
  const SporeContactTerm *term = spore_island_system_contact(system, first);
  const SporeEnd *moving = term->a.prescribed ? &term->b : &term->a;
  bool frames = !moving->prescribed && moving->mapping->kind == SPORE_MAPPING_RIGID;
  SporeLanesKind kind = frames ? SPORE_LANES_FRAMES : SPORE_LANES_NODES;
  for (size_t i = first; i < first + count; i++) {
    term = spore_island_system_contact(system, i);
    kind = join_kind(system, &term->a, term->field_a, kind);
    kind = join_kind(system, &term->b, term->field_b, kind);
  }
  return kind;
}

static void set_lane(SporeLaneVector *vector, size_t k, SporeVec3 value) {
  vector->x[k] = value.x, vector->y[k] = value.y, vector->z[k] = value.z;
}

static SporeVec3 lane_of(const SporeLaneVector *vector, size_t k) {
  return (SporeVec3){vector->x[k], vector->y[k], vector->z[k]};
}

static void fill_end(const SporeIslandSystem *system, const SporeEnd *end, SporeVec3 arm, SporeVec3 frame_arm,
                     SporeLaneEnd *lanes, size_t k) {
  assert(k < SPORE_LANES);
  set_lane(&lanes->start, k, end->position);
  lanes->moves[k] = end->prescribed ? 0 : -1;
  lanes->at[k] = lanes->v_node[k] = 0;
  lanes->v[k] = SPORE_LANE_FIXED;
  bool turns = !end->prescribed && end->mapping->kind == SPORE_MAPPING_RIGID;
  const SporeVec3 none = {0, 0, 0};
  set_lane(&lanes->point, k, turns ? spore_vec3_load(end->mapping->points + 3 * (size_t)end->point) : none);
  set_lane(&lanes->arm, k, turns ? arm : none);
  set_lane(&lanes->frame_arm, k, turns ? frame_arm : none);
  if (end->prescribed) return;
  const SporeSite *site = &system->world->solve.local_sites[end->body];
  uint32_t node = turns ? 0 : end->point;
  lanes->v[k] = lanes->v_node[k] = (uint32_t)(site->v / 3) + node;
  lanes->at[k] = turns ? SPORE_FRAME_DOUBLES / 3 * end->body : (uint32_t)(site->q / 3) + node;
}

static void fill_lane(const SporeIslandSystem *system, const SporeContactTerm *term, SporeContactLanes *lanes,
                      size_t k) {
  fill_end(system, &term->a, term->arm_a, term->frame_arm_a, &lanes->a, k);
  fill_end(system, &term->b, term->arm_b, term->frame_arm_b, &lanes->b, k);
  set_lane(&lanes->normal, k, term->normal);
  SporeVec3 none = {0, 0, 0}, driven = term->a.prescribed ? term->a.velocity : none;
  set_lane(&lanes->driven, k, term->b.prescribed ? spore_vec3_sub(driven, term->b.velocity) : driven);
  set_lane(&lanes->stretch, k, term->stretch);
  lanes->depth[k] = term->depth;
  lanes->overlap[k] = term->overlap;
  lanes->overlaps |= term->overlap > 0;
  lanes->rolls[k] = spore_contact_term_rolls(term) ? -1 : 0;
  lanes->stiffness[k] = term->law.stiffness;
  lanes->damping[k] = term->law.damping;
  lanes->damping_depth[k] = term->law.damping_depth;
  lanes->friction[k] = term->law.friction;
  lanes->rubs |= term->law.friction > 0;
}

/* A lane without force. It reads node 0, so that it reads no invalid memory. */
static void empty_lane(SporeContactLanes *lanes, size_t k) {
  assert(k < SPORE_LANES);
  SporeLaneEnd *ends[2] = {&lanes->a, &lanes->b};
  const SporeVec3 none = {0, 0, 0};
  for (int e = 0; e < 2; e++) {
    ends[e]->at[k] = ends[e]->v_node[k] = 0;
    ends[e]->moves[k] = 0;
    set_lane(&ends[e]->start, k, none);
    set_lane(&ends[e]->point, k, none);
    set_lane(&ends[e]->arm, k, none);
    set_lane(&ends[e]->frame_arm, k, none);
  }
  set_lane(&lanes->normal, k, none);
  set_lane(&lanes->driven, k, none);
  set_lane(&lanes->stretch, k, none);
  lanes->rolls[k] = 0;
  lanes->depth[k] = lanes->overlap[k] = lanes->stiffness[k] = lanes->damping[k] = lanes->friction[k] = 0;
  lanes->damping_depth[k] = 1;
}

static bool is_driven(const SporeEnd *end) {
  return end->prescribed && spore_vec3_dot(end->velocity, end->velocity) > 0;
}

static void find_driven(SporeIslandSystem *system) {
  system->driven = false;
  for (size_t i = 0; i < system->island->contact_count; i++) {
    const SporeContactTerm *term = spore_island_system_contact(system, i);
    system->driven |= is_driven(&term->a) || is_driven(&term->b);
  }
  for (size_t i = 0; i < system->island->spring_count; i++) {
    const SporeSpringTerm *term = spore_island_system_spring(system, i);
    system->driven |= is_driven(&term->a) || is_driven(&term->b);
  }
}

void spore_island_system_lay_contacts(SporeIslandSystem *system) {
  find_driven(system);
  system->frames = false;
  for (size_t i = 0; i < lanes_count(system); i++) {
    SporeContactLanes *lanes = lanes_at(system, i);
    size_t first = i * SPORE_LANES, count = count_in(system, i);
    lanes->kind = kind_of(system, first, count);
    lanes->count = (uint32_t)count;
    lanes->rubs = lanes->overlaps = false;
    if (lanes->kind == SPORE_LANES_APART) continue;
    system->frames |= lanes->kind == SPORE_LANES_FRAMES;
    for (size_t k = 0; k < count; k++) fill_lane(system, spore_island_system_contact(system, first + k), lanes, k);
    for (size_t k = count; k < SPORE_LANES; k++) empty_lane(lanes, k);
  }
}

void spore_island_system_keep_contacts(const SporeIslandSystem *system) {
  for (size_t i = 0; i < lanes_count(system); i++) {
    const SporeContactLanes *lanes = lanes_at(system, i);
    if (lanes->kind == SPORE_LANES_APART) continue;
    for (size_t k = 0; k < lanes->count; k++) {
      SporeContactTerm *term = spore_island_system_contact(system, i * SPORE_LANES + k);
      term->force = lane_of(&lanes->force, k);
      term->pressing = lanes->pressing[k];
    }
  }
}

static void find_frames(const SporeIslandSystem *system, const double *q, const double *v) {
  assert(system->world->contact.frames);
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (body->collision.spheres.kind != SPORE_MAPPING_RIGID) continue;
    double *frame = system->world->contact.frames + SPORE_FRAME_DOUBLES * (size_t)(body - system->world->bodies);
    SporeMat3 rotation = spore_quat_to_mat3(spore_quat_load(q + site->q + 3));
    memcpy(frame, rotation.m, sizeof rotation.m);
    memcpy(frame + 9, q + site->q, 3 * sizeof *q);
    memcpy(frame + 12, v + site->v, 6 * sizeof *v);
  }
}

static void scatter(const SporeLaneEnd *end, size_t k, bool turns, SporeVec3 force, double *f) {
  if (end->v[k] == SPORE_LANE_FIXED) return;
  double *local = f + 3 * (size_t)end->v[k];
  spore_vec3_accumulate(local, force);
  if (turns) spore_vec3_accumulate(local + 3, spore_vec3_cross(lane_of(&end->lever, k), force));
}

/* In the order of the contacts, so that the sums are the same at any width. */
static void scatter_lanes(const SporeContactLanes *lanes, double *f) {
  bool turns = lanes->kind == SPORE_LANES_FRAMES;
  for (size_t k = 0; k < lanes->count; k++) {
    SporeVec3 force = lane_of(&lanes->force, k);
    scatter(&lanes->a, k, turns, force, f);
    scatter(&lanes->b, k, turns, spore_vec3_scale(-1, force), f);
  }
}

void spore_island_system_add_contact_forces(const SporeIslandSystem *system, const double *q, const double *v,
                                            double *f) {
  assert(q && v && f);
  if (system->frames) find_frames(system, q, v);
  for (size_t i = 0; i < lanes_count(system); i++) {
    SporeContactLanes *lanes = lanes_at(system, i);
    if (lanes->kind == SPORE_LANES_APART) {
      for (size_t k = 0; k < lanes->count; k++)
        spore_contact_term_force(spore_island_system_contact(system, i * SPORE_LANES + k),
                                 system->world->solve.local_sites, q, v, system->now_s, f);
      continue;
    }
    const double *at = lanes->kind == SPORE_LANES_FRAMES ? system->world->contact.frames : q;
    SPORE_KERNEL(spore_contact_lanes_force)(lanes, at, v, system->now_s);
    scatter_lanes(lanes, f);
  }
}
