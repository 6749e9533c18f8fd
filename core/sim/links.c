/* Links: pins become held blocks, springs and pulls become terms. */
#include <float.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/constraint/pin.h"
#include "core/sim/world_private.h"

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the links"));
}

static bool finite3(SporeVec3 a) { return isfinite(a.x) && isfinite(a.y) && isfinite(a.z); }

static bool known_body(const SporeWorld *world, uint32_t body) { return body < world->body_count; }

static bool passive(const SporeWorld *world, uint32_t body) {
  return known_body(world, body) && world->bodies[body].role == SPORE_PASSIVE;
}

/* Where the blocks of a body are at time 0, count x 3. A frame's angular velocity is where its origin is: at the last
 * node. */
static double *block_positions(const SporeWorld *world, const SporeBody *body) {
  double *points = SPORE_NEW_ARRAY(double, 3 * body->block_count);
  const double *q = world->rest_q + body->q_offset;
  size_t last = body->model->node_count - 1;
  for (size_t i = 0; points && i < body->block_count; i++)
    memcpy(points + 3 * i, q + 3 * (i < last ? i : last), 3 * sizeof *q);
  return points;
}

/* What is wrong with a pin, or NULL; *memory: there was none. */
static const char *select_pin(const SporeWorld *world, const SporeLinkDescription *link, uint8_t *held, bool *memory) {
  if (!passive(world, link->body_a))
    return _("a pin holds nothing here: its body does not move; choose a passive body");
  const SporeBody *body = &world->bodies[link->body_a];
  double *points = block_positions(world, body);
  if (!points) {
    *memory = false;
    return NULL;
  }
  size_t found = spore_pin_select(points, body->block_count, link->point_a, link->radius, held + body->v_offset / 3);
  spore_free(points);
  return found ? NULL : _("the pin holds nothing: no node lies within its radius; move it or make the radius larger");
}

/* The lists of held blocks from the marks, and velocity 0 for them. */
static bool collect_held(SporeWorld *world, const uint8_t *marks) {
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    const uint8_t *held = marks + body->v_offset / 3;
    size_t count = 0;
    for (size_t i = 0; i < body->block_count; i++) count += held[i];
    body->held = SPORE_NEW_ARRAY(uint32_t, count);
    if (!body->held) return false;
    for (size_t i = 0; i < body->block_count; i++)
      if (held[i]) body->held[body->held_count++] = (uint32_t)i;
    spore_pin_filter(body->held, body->held_count, world->rest_v + body->v_offset);
  }
  return true;
}

/* The material point of `body` at the world point `at` at time 0. */
static bool attach(SporeWorld *world, uint32_t body, SporeVec3 at, SporeMapping *mapping, SporeEnd *end,
                   SporeError *error) {
  double point[3];
  *end = (SporeEnd){.mapping = mapping, .body = body};
  if (body == SPORE_NO_BODY) {
    spore_vec3_store(point, at);
    return spore_mapping_init_points(mapping, SPORE_MAPPING_FIXED, point, 1, error);
  }
  const SporePose *pose = &world->bodies[body].rest_pose;
  SporeVec3 in_body = spore_quat_rotate(spore_quat_conjugate(pose->orientation), spore_vec3_sub(at, pose->position));
  spore_vec3_store(point, in_body);
  return spore_world_map(world, body, point, 1, mapping, error);
}

static const char *spring_fault(const SporeWorld *world, const SporeLinkDescription *link) {
  bool known = known_body(world, link->body_a) && (link->body_b == SPORE_NO_BODY || known_body(world, link->body_b));
  if (!known) return _("the link names a body that is not there; expected one of the scene's bodies; correct it");
  if (!passive(world, link->body_a) && !passive(world, link->body_b))
    return _("neither end of the spring can move; expected at least one passive body; choose one");
  if (!(link->stiffness >= 0) || !(link->damping >= 0) || !isfinite(link->stiffness) || !isfinite(link->damping))
    return _("stiffness and damping must be finite and not negative; correct them");
  return NULL;
}

static bool make_spring(SporeWorld *world, size_t index, const SporeLinkDescription *link, SporeError *error) {
  SporeSpringTerm *term = &world->springs[index];
  SporeVec3 along = spore_vec3_sub(link->point_a, link->point_b);
  term->law = (SporeSpring){.stiffness = link->stiffness,
                            .damping = link->damping,
                            .rest_length = link->rest_length < 0 ? spore_vec3_length(along) : link->rest_length,
                            .fallback = spore_vec3_normalise(along, (SporeVec3){0, 1, 0})};
  world->spring_active[index] = true;
  return attach(world, link->body_a, link->point_a, &world->spring_mappings[2 * index], &term->a, error) &&
         attach(world, link->body_b, link->point_b, &world->spring_mappings[2 * index + 1], &term->b, error);
}

static const char *link_numbers_fault(const SporeLinkDescription *link) {
  if (finite3(link->point_a) && finite3(link->point_b) && isfinite(link->radius) && isfinite(link->rest_length))
    return NULL;
  return _("a number of the link is not finite; expected points and lengths in m; correct it");
}

/* A pull needs a place to hold one point of a frame; nodes need none. */
static bool make_pulls(SporeWorld *world) {
  const double origin[3] = {0, 0, 0};
  for (size_t b = 0; b < world->body_count; b++) {
    size_t index = world->link_count + b;
    const SporeModel *model = world->bodies[b].model;
    SporeMapping *end_a = &world->spring_mappings[2 * index], *end_b = end_a + 1;
    if (!model) continue;
    bool made = spore_model_is_rigid(model) ? spore_mapping_init_points(end_a, SPORE_MAPPING_RIGID, origin, 1, NULL)
                                            : spore_mapping_init_identity(end_a, model->node_count);
    if (!made || !spore_mapping_init_points(end_b, SPORE_MAPPING_FIXED, origin, 1, NULL)) return false;
    world->springs[index].a = (SporeEnd){.mapping = end_a, .body = (uint32_t)b};
    world->springs[index].b = (SporeEnd){.mapping = end_b, .body = SPORE_NO_BODY};
  }
  return true;
}

static bool allocate_springs(SporeWorld *world, const SporeWorldDescription *description) {
  for (size_t i = 0; i < description->link_count; i++)
    world->link_count += description->links[i].kind == SPORE_LINK_SPRING;
  size_t count = spore_world_spring_count(world);
  world->springs = SPORE_NEW_ARRAY(SporeSpringTerm, count);
  world->spring_active = SPORE_NEW_ARRAY(bool, count);
  world->spring_mappings = SPORE_NEW_ARRAY(SporeMapping, 2 * count);
  world->spring_couplings = SPORE_NEW_ARRAY(SporeCoupling, count);
  world->spring_order = SPORE_NEW_ARRAY(uint32_t, count);
  return world->springs && world->spring_active && world->spring_mappings && world->spring_couplings &&
         world->spring_order && make_pulls(world);
}

static bool compile_link(SporeWorld *world, const SporeLinkDescription *link, uint8_t *marks, size_t *springs,
                         SporeError *error) {
  char place[200];
  snprintf(place, sizeof place, "links/%s", link->name ? link->name : "");
  bool memory = true;
  const char *fault = link_numbers_fault(link);
  if (!fault && link->kind == SPORE_LINK_PIN) fault = select_pin(world, link, marks, &memory);
  if (!fault && link->kind == SPORE_LINK_SPRING) fault = spring_fault(world, link);
  if (fault) return spore_error_set(error, SPORE_ERROR_INPUT, place, "%s", fault);
  if (!memory) return no_memory(error);
  if (link->kind == SPORE_LINK_PIN || make_spring(world, (*springs)++, link, error)) return true;
  spore_error_at(error, place);
  return false;
}

bool spore_world_compile_links(SporeWorld *world, const SporeWorldDescription *description, SporeError *error) {
  if (!allocate_springs(world, description)) return no_memory(error);
  uint8_t *marks = SPORE_NEW_ARRAY(uint8_t, world->v_count / 3);
  if (!marks) return no_memory(error);
  size_t springs = 0;
  bool good = true;
  for (size_t i = 0; good && i < description->link_count; i++)
    good = compile_link(world, &description->links[i], marks, &springs, error);
  if (good && !collect_held(world, marks)) good = no_memory(error);
  spore_free(marks);
  for (size_t b = 0; good && b < world->body_count; b++)
    if (world->bodies[b].role == SPORE_PASSIVE)
      world->dof += 3 * (world->bodies[b].block_count - world->bodies[b].held_count);
  return good;
}

static size_t nearest_block(const double *q, size_t count, SporeVec3 point) {
  size_t nearest = 0;
  double best = DBL_MAX;
  for (size_t i = 0; i < count; i++) {
    double distance = spore_vec3_distance(spore_vec3_load(q + 3 * i), point);
    if (distance < best) best = distance, nearest = i;
  }
  return nearest;
}

/* Chooses the material point that a pull holds, and a damping that does not let it swing. */
static void grasp(SporeWorld *world, size_t index, const SporeBody *body, SporeVec3 point, double stiffness) {
  SporeSpringTerm *term = &world->springs[index];
  const double *q = world->q + body->q_offset;
  double mass;
  if (!spore_model_is_rigid(body->model)) {
    term->a.point = (uint32_t)nearest_block(q, body->model->node_count, point);
    mass = body->model->block_mass[term->a.point];
  } else {
    SporeVec3 arm = spore_vec3_sub(point, spore_vec3_load(q));
    SporeVec3 in_body = spore_quat_rotate(spore_quat_conjugate(spore_quat_load(q + 3)), arm);
    spore_vec3_store(world->spring_mappings[2 * index].points, in_body);
    mass = spore_model_total_mass(body->model);
  }
  term->law.damping = 2 * sqrt(stiffness * mass);
}

/* The plan has a link stage while there is something to link. */
static void set_pulled(SporeWorld *world, size_t index, bool pulled) {
  if (world->spring_active[index] == pulled) return;
  world->spring_active[index] = pulled;
  if (pulled) world->pull_count++;
  else world->pull_count--;
  spore_world_make_plan(world);
}

void spore_world_pull(SporeWorld *world, const SporeCommand *command) {
  const SporeBody *body = &world->bodies[command->body];
  bool good = finite3(command->point) && finite3(command->vector) && command->number >= 0 && isfinite(command->number);
  if (!good || body->role != SPORE_PASSIVE) return;
  size_t index = world->link_count + command->body;
  SporeSpringTerm *term = &world->springs[index];
  if (!world->spring_active[index]) grasp(world, index, body, command->point, command->number);
  term->law.stiffness = command->number;
  spore_vec3_store(world->spring_mappings[2 * index + 1].points, command->vector);
  set_pulled(world, index, true);
}

void spore_world_release(SporeWorld *world, uint32_t body) { set_pulled(world, world->link_count + body, false); }

void spore_world_link(SporeWorld *world) {
  size_t count = spore_world_spring_count(world);
  for (size_t i = 0; i < count; i++) {
    if (!world->spring_active[i]) continue;
    spore_world_fill_end(world, &world->springs[i].a);
    spore_world_fill_end(world, &world->springs[i].b);
  }
}
