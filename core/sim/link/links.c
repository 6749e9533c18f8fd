/* Links of a world: checking, making and updating them. Pins become held blocks, trocars turn active bodies, all
 * others are terms. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/constraint/pin.h"
#include "core/sim/link/link_rows.h"
#include "core/sim/world_private.h"

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the links"));
}

/* Positions of the blocks of a body at time 0, count x 3. The angular velocity of a frame is placed at the frame's
 * origin, the last node. */
static double *block_positions(const SporeWorld *world, const SporeBody *body) {
  double *points = SPORE_NEW_ARRAY(double, 3 * body->block_count);
  const double *q = world->state.rest_q + body->q_offset;
  size_t last = body->model->node_count - 1;
  for (size_t i = 0; points && i < body->block_count; i++)
    memcpy(points + 3 * i, q + 3 * (i < last ? i : last), 3 * sizeof *q);
  return points;
}

/* The fault of a link to a body whose particles come and go, or NULL. */
static const char *particles_fault(const SporeWorld *world, const SporeWorldDescription *description, uint32_t index) {
  const SporeModel *model = index < world->body_count ? world->bodies[index].model : NULL;
  if (!model || !model->type->particles) return NULL;
  if (model->life_s > 0)
    return _("the link hangs on particles that dissolve; expected a body that stays; choose another");
  for (size_t i = 0; i < description->tool_count; i++)
    if (description->tools[i].type->takes_particles)
      return _("the link hangs on particles that a suction may take; expected a body that stays; choose another, or "
               "remove the suction");
  for (size_t i = 0; i < description->emitter_count; i++)
    if (description->emitters[i].body == index && description->emitters[i].fields.reserve > 0)
      return _("the link hangs on particles of which an emitter keeps some back; expected a body that stays; choose "
               "another, or an emitter without a reserve");
  return NULL;
}

static bool is_known(const SporeWorld *world, uint32_t body) { return body < world->body_count; }

/* Whether the link is a trocar of an active body: it has no term but rotates the body's target pose. */
static bool is_trocar(const SporeWorld *world, const SporeLinkDescription *link) {
  return link->type->line == SPORE_LINE_OF_BODY_A && is_known(world, link->body_a) &&
         world->bodies[link->body_a].role == SPORE_ACTIVE;
}

static bool is_finite(const SporeLinkDescription *link) {
  return spore_vec3_is_finite(link->point_a) && spore_vec3_is_finite(link->point_b) &&
         spore_vec3_is_finite(link->direction) &&
         isfinite(link->radius + link->length + link->stiffness + link->damping + link->rest_length + link->strength +
                  link->friction);
}

static const char *ends_fault(const SporeWorld *world, const SporeLinkDescription *link) {
  bool to_world = link->body_b == SPORE_NO_BODY, trocar = is_trocar(world, link);
  if (!is_known(world, link->body_a) || !(to_world || is_known(world, link->body_b)))
    return _("the link names a body that is not there; expected one of the scene's bodies; correct it");
  if (link->body_a == link->body_b)
    return _("both ends of the link are of one body; expected two bodies, or one and the scene; choose another");
  if (trocar && !to_world && world->bodies[link->body_b].role != SPORE_UNMOVABLE)
    return _("the port of a body that a device moves must stand still; expected an unmovable body or none; choose one");
  if (!trocar && !spore_body_is_passive(world, link->body_a) && !spore_body_is_passive(world, link->body_b))
    return _("neither end of the link can move; expected at least one passive body; choose one");
  return NULL;
}

const char *spore_link_direction_fault(const SporeLinkDescription *link) {
  if (spore_vec3_length(link->direction) > 0) return NULL;
  return _("the link has no direction; expected a vector of any length but 0; set it");
}

const char *spore_link_length_fault(const SporeLinkDescription *link) {
  if (link->length > 0) return NULL;
  return _("the link has no length, so that it cannot keep bodies from turning; expected more than 0 m; set it");
}

/* The fault of a link that has terms, or NULL. */
static const char *term_fault(const SporeWorld *world, const SporeLinkDescription *link) {
  const char *fault = ends_fault(world, link);
  if (fault) return fault;
  if (!(link->stiffness >= 0) || !(link->strength >= 0) || !(link->friction >= 0))
    return _("stiffness, strength and friction must not be negative; correct them");
  if (link->type->line != SPORE_LINE_NONE && !spore_link_is_curved(world, link))
    fault = spore_link_direction_fault(link);
  if (!fault && link->type->fault) fault = link->type->fault(link);
  return fault;
}

/* The fault of a pin's body, or NULL. */
static const char *pin_fault(const SporeWorld *world, const SporeLinkDescription *link) {
  if (link->body_a < world->body_count && world->bodies[link->body_a].role == SPORE_PASSIVE) return NULL;
  return _("a pin holds nothing here: its body does not move; choose a passive body");
}

static bool place_error(const SporeLinkDescription *link, SporeError *error) {
  char place[200];
  snprintf(place, sizeof place, "links/%s", link->name ? link->name : "");
  spore_error_at(error, place);
  return false;
}

/* Marks the blocks of the body at `points` that pins hold. */
static bool mark_held(const SporeBody *body, const SporeWorldDescription *description, uint32_t index,
                      const double *points, uint8_t *marks, SporeError *error) {
  for (size_t i = 0; i < description->link_count; i++) {
    const SporeLinkDescription *link = &description->links[i];
    if (!link->type->hold || link->body_a != index) continue;
    if (link->type->hold(link, points, body->block_count - body->model->spare_count, marks) > 0) continue;
    spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                    _("the pin holds nothing: no node lies within its radius; move it or make the radius larger"));
    return place_error(link, error);
  }
  return true;
}

/* Makes the list of held blocks from the marks, and sets the velocity of these blocks to 0. */
static bool collect_held(SporeWorld *world, SporeBody *body, const uint8_t *marks) {
  size_t count = 0;
  for (size_t i = 0; i < body->block_count; i++) count += marks[i];
  body->held.blocks = SPORE_NEW_ARRAY(uint32_t, count);
  if (!body->held.blocks) return false;
  body->held.count = 0;
  for (size_t i = 0; i < body->block_count; i++)
    if (marks[i]) body->held.blocks[body->held.count++] = (uint32_t)i;
  body->held.pin_count = body->held.count;
  spore_pin_filter(body->held.blocks, body->held.count, world->state.rest_v + body->v_offset);
  return true;
}

bool spore_body_create_pins(SporeWorld *world, const SporeWorldDescription *description, uint32_t index,
                            SporeError *error) {
  SporeBody *body = &world->bodies[index];
  uint8_t *marks = SPORE_NEW_ARRAY(uint8_t, body->block_count);
  double *points = body->model ? block_positions(world, body) : NULL;
  bool good = marks && (points || !body->model);
  if (!good) no_memory(error);
  good = good && (!points || mark_held(body, description, index, points, marks, error));
  if (good && !collect_held(world, body, marks)) good = no_memory(error);
  spore_free(points);
  spore_free(marks);
  return good;
}

static bool allocate_links(SporeWorld *world, const SporeWorldDescription *description) {
  size_t links = 0, ports = 0;
  for (size_t i = 0; i < description->link_count; i++) {
    const SporeLinkDescription *link = &description->links[i];
    if (is_trocar(world, link)) {
      ports++;
    } else if (link->type->term_count > 0) {
      links++;
      world->links.term_count += link->type->term_count;
    }
  }
  world->links.all = SPORE_NEW_ARRAY(SporeLink, links);
  world->links.trocars = SPORE_NEW_ARRAY(SporeTrocar, ports);
  return world->links.all && world->links.trocars;
}

static bool allocate_springs(SporeWorld *world) {
  size_t count = spore_world_spring_count(world);
  world->links.springs = SPORE_NEW_ARRAY(SporeSpringTerm, count);
  world->links.active = SPORE_NEW_ARRAY(bool, count);
  world->links.mappings = SPORE_NEW_ARRAY(SporeMapping, 2 * count);
  world->links.couplings = SPORE_NEW_ARRAY(SporeCoupling, count);
  world->links.order = SPORE_NEW_ARRAY(uint32_t, count);
  return world->links.springs && world->links.active && world->links.mappings && world->links.couplings &&
         world->links.order && spore_world_create_pulls(world);
}

/* Fills the link, whose term_start is set, and its terms. */
static bool make_terms(SporeWorld *world, SporeLink *link, const SporeLinkDescription *from, SporeError *error) {
  link->type = from->type;
  link->term_count = from->type->term_count;
  link->strength = from->strength > 0 ? from->strength : INFINITY;
  link->name = spore_copy_text(from->name ? from->name : "");
  if (!link->name) return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the links"));
  if (spore_link_is_curved(world, from)) return spore_link_make_curve(world, link, from, error);
  bool swapped = from->type->line == SPORE_LINE_OF_BODY_A; /* the line is at end b */
  for (size_t t = 0; t < link->term_count; t++) {
    size_t index = link->term_start + t;
    SporeSpringTerm *term = &world->links.springs[index];
    SporeMapping *mapping = &world->links.mappings[2 * index];
    SporeVec3 a = from->point_a, b = a;
    if (from->type->place) from->type->place(from, t, &a, &b);
    term->law = spore_link_law(world, from);
    world->links.active[index] = true;
    if (!spore_world_attach(world, swapped ? from->body_b : from->body_a, a, mapping, &term->a, error) ||
        !spore_world_attach(world, swapped ? from->body_a : from->body_b, b, mapping + 1, &term->b, error))
      return false;
  }
  return link->type->line == SPORE_LINE_NONE || spore_link_make_line(world, link, from, error);
}

/* term_count: of the links so far. */
static bool make_link(SporeWorld *world, const SporeLinkDescription *from, size_t *term_count, SporeError *error) {
  if (is_trocar(world, from)) {
    spore_trocar_make(world, &world->links.trocars[world->links.trocar_count++], from);
    return true;
  }
  SporeLink *link = &world->links.all[world->links.count++];
  link->term_start = *term_count;
  if (!make_terms(world, link, from, error)) return false;
  *term_count += link->term_count;
  return true;
}

static bool create_link(SporeWorld *world, const SporeWorldDescription *description, const SporeLinkDescription *link,
                        size_t *term_count, SporeError *error) {
  bool pin = link->type->term_count == 0;
  const char *fault = NULL;
  if (!is_finite(link)) fault = _("a number of the link is not finite; expected points and lengths in m; correct it");
  else if (!pin) fault = term_fault(world, link);
  if (!fault) fault = particles_fault(world, description, link->body_a);
  if (!fault) fault = particles_fault(world, description, link->body_b);
  if (!fault && pin) fault = pin_fault(world, link);
  if (fault) spore_error_set(error, SPORE_ERROR_INPUT, NULL, "%s", fault);
  else if (pin || make_link(world, link, term_count, error)) return true;
  return place_error(link, error);
}

bool spore_world_create_links(SporeWorld *world, const SporeWorldDescription *description, SporeError *error) {
  if (!allocate_links(world, description) || !allocate_springs(world)) return no_memory(error);
  size_t term_count = 0;
  for (size_t i = 0; i < description->link_count; i++)
    if (!create_link(world, description, &description->links[i], &term_count, error)) return false;
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (!spore_body_create_pins(world, description, b, error)) return false;
    if (body->role == SPORE_PASSIVE) world->state.dof += 3 * (body->block_count - body->held.count);
  }
  return true;
}

void spore_world_link(SporeWorld *world) {
  for (size_t i = 0; i < world->links.count; i++) spore_link_follow(world, &world->links.all[i]);
  size_t count = spore_world_spring_count(world);
  for (size_t i = 0; i < count; i++) {
    if (!world->links.active[i]) continue;
    SporeSpringTerm *term = &world->links.springs[i];
    spore_world_fill_end(world, &term->a);
    spore_world_fill_end(world, &term->b);
    if (term->a.prescribed && term->b.prescribed) spore_spring_term_hold(term);
  }
}

void spore_world_clear_links(SporeWorld *world) {
  SporeLinkSystem *links = &world->links;
  for (size_t i = 0; links->mappings && i < 2 * spore_world_spring_count(world); i++)
    spore_mapping_clear(&links->mappings[i]);
  for (size_t i = 0; links->all && i < links->count; i++) spore_free(links->all[i].name);
  spore_free(links->all);
  spore_free(links->trocars);
  spore_free(links->springs);
  spore_free(links->active);
  spore_free(links->mappings);
  spore_free(links->couplings);
  spore_free(links->order);
}

void spore_world_reset_links(SporeWorld *world) {
  spore_world_lose_lines(world);
  for (size_t i = 0; i < world->links.count; i++) {
    SporeLink *link = &world->links.all[i];
    link->broken = link->reported_sharp = false;
    link->sharp_steps = 0;
    for (size_t t = 0; t < link->term_count; t++) world->links.active[link->term_start + t] = true;
  }
}
