/* Links that are terms: what they hold, where, and until when. A joint is made of stiff springs of length 0, so that
 * all that bears springs bears joints: every method, islands, sleep, and bodies that deform. */
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

static const SporeParameter joint_parameters[] = {
    {.name = "stiffness",
     .type = SPORE_REAL,
     .unit = "N/m",
     .minimum = 1e-3,
     .maximum = 1e12,
     .initial = {1e5},
     .offset = offsetof(SporeJointFields, stiffness),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Force for each metre that what is held together comes apart.")},
    {.name = "damping",
     .type = SPORE_REAL,
     .unit = "N s/m",
     .minimum = -1,
     .maximum = 1e9,
     .initial = {-1},
     .offset = offsetof(SporeJointFields, damping),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Force against each metre per second of coming apart; negative: so much that the lighter body does not "
               "swing.")},
    {.name = "strength",
     .type = SPORE_REAL,
     .unit = "N",
     .minimum = 0,
     .maximum = 1e9,
     .initial = {0},
     .offset = offsetof(SporeJointFields, strength),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Force above which it breaks for good; 0: never.")},
};
const SporeParameterTable spore_joint_parameters = {
    joint_parameters, sizeof joint_parameters / sizeof *joint_parameters, sizeof(SporeJointFields)};

size_t spore_link_term_count(const SporeLinkDescription *link) {
  switch (link->kind) {
  case SPORE_LINK_PIN:
    return 0;
  case SPORE_LINK_HINGE:
    return 2;
  case SPORE_LINK_WELD:
    return 4;
  default:
    return 1;
  }
}

static bool known(const SporeWorld *world, uint32_t body) { return body < world->body_count; }

static bool passive(const SporeWorld *world, uint32_t body) {
  return known(world, body) && world->bodies[body].role == SPORE_PASSIVE;
}

static bool is_finite(const SporeLinkDescription *link) {
  return spore_vec3_is_finite(link->point_a) && spore_vec3_is_finite(link->point_b) &&
         spore_vec3_is_finite(link->direction) &&
         isfinite(link->radius + link->length + link->stiffness + link->damping + link->rest_length + link->strength +
                  link->friction);
}

static const char *ends_fault(const SporeWorld *world, const SporeLinkDescription *link) {
  bool to_world = link->body_b == SPORE_NO_BODY;
  if (!known(world, link->body_a) || !(to_world || known(world, link->body_b)))
    return _("the link names a body that is not there; expected one of the scene's bodies; correct it");
  if (link->body_a == link->body_b)
    return _("both ends of the link are of one body; expected two bodies, or one and the scene; choose another");
  bool aimed = link->kind == SPORE_LINK_PORT && world->bodies[link->body_a].role == SPORE_ACTIVE;
  if (aimed && !to_world && world->bodies[link->body_b].role != SPORE_UNMOVABLE)
    return _("the port of a body that a device moves must stand still; expected an unmovable body or none; choose one");
  if (!aimed && !passive(world, link->body_a) && !passive(world, link->body_b))
    return _("neither end of the link can move; expected at least one passive body; choose one");
  return NULL;
}

const char *spore_link_fault(const SporeWorld *world, const SporeLinkDescription *link) {
  if (!is_finite(link)) return _("a number of the link is not finite; expected points and lengths in m; correct it");
  if (link->kind == SPORE_LINK_PIN) return NULL;
  const char *fault = ends_fault(world, link);
  if (fault) return fault;
  if (!(link->stiffness >= 0) || !(link->strength >= 0) || !(link->friction >= 0))
    return _("stiffness, strength and friction must not be negative; correct them");
  bool along = spore_link_runs_along(link->kind) && !spore_link_is_curved(world, link);
  if ((along || link->kind == SPORE_LINK_HINGE) && !(spore_vec3_length(link->direction) > 0))
    return _("the link has no direction; expected a vector of any length but 0; set it");
  if ((link->kind == SPORE_LINK_HINGE || link->kind == SPORE_LINK_WELD) && !(link->length > 0))
    return _("the link has no length, so that it cannot keep bodies from turning; expected more than 0 m; set it");
  return NULL;
}

/* Critical for the lighter of the bodies that move. */
static double critical_damping(const SporeWorld *world, const SporeLinkDescription *link) {
  double mass = INFINITY;
  if (passive(world, link->body_a)) mass = world->bodies[link->body_a].total_mass;
  if (passive(world, link->body_b)) mass = fmin(mass, world->bodies[link->body_b].total_mass);
  return 2 * sqrt(link->stiffness * mass);
}

SporeSpring spore_link_law(const SporeWorld *world, const SporeLinkDescription *link) {
  SporeVec3 along = spore_vec3_sub(link->point_a, link->point_b);
  double damping = link->damping < 0 ? critical_damping(world, link) : link->damping;
  double share = 1 / (double)spore_link_term_count(link);
  SporeSpring law = {.stiffness = share * link->stiffness, .damping = share * damping, .friction = link->friction};
  if (link->kind != SPORE_LINK_SPRING) return law;
  law.rest_length = link->rest_length < 0 ? spore_vec3_length(along) : link->rest_length;
  law.fallback = spore_vec3_normalise(along, (SporeVec3){0, 1, 0});
  return law;
}

/* Where the ends of a term are, at time 0. */
static void find_points(const SporeLinkDescription *link, size_t term, SporeVec3 *a, SporeVec3 *b) {
  static const double corners[4][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}; /* edges of length 2^1.5 */
  *a = link->point_a;
  if (link->kind == SPORE_LINK_HINGE) {
    SporeVec3 along = spore_vec3_normalise(link->direction, (SporeVec3){0, 0, 0});
    *a = spore_vec3_add_scaled(*a, ((double)term - 0.5) * link->length, along);
  }
  if (link->kind == SPORE_LINK_WELD)
    *a = spore_vec3_add_scaled(*a, link->length / sqrt(8), spore_vec3_load(corners[term]));
  *b = link->kind == SPORE_LINK_SPRING ? link->point_b : *a;
}

bool spore_link_make(SporeWorld *world, SporeLink *link, const SporeLinkDescription *from, SporeError *error) {
  link->kind = from->kind;
  link->term_count = spore_link_term_count(from);
  link->strength = from->strength > 0 ? from->strength : INFINITY;
  link->name = spore_copy_text(from->name ? from->name : "");
  if (!link->name) return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the links"));
  if (spore_link_is_curved(world, from)) return spore_link_make_curve(world, link, from, error);
  bool swapped = from->kind == SPORE_LINK_PORT; /* the line is at end b */
  for (size_t t = 0; t < link->term_count; t++) {
    size_t index = link->term_start + t;
    SporeSpringTerm *term = &world->links.springs[index];
    SporeMapping *mapping = &world->links.mappings[2 * index];
    SporeVec3 a, b;
    find_points(from, t, &a, &b);
    term->law = spore_link_law(world, from);
    world->links.active[index] = true;
    if (!spore_world_attach(world, swapped ? from->body_b : from->body_a, a, mapping, &term->a, error) ||
        !spore_world_attach(world, swapped ? from->body_a : from->body_b, b, mapping + 1, &term->b, error))
      return false;
  }
  return !spore_link_runs_along(link->kind) || spore_link_make_line(world, link, from, error);
}

static void wake_end(SporeWorld *world, const SporeEnd *end) {
  if (end->body != SPORE_NO_BODY) spore_world_wake(world, end->body);
}

void spore_link_release(SporeWorld *world, SporeLink *link) {
  link->broken = true;
  for (size_t t = link->term_start; t < link->term_start + link->term_count; t++) {
    world->links.active[t] = false;
    wake_end(world, &world->links.springs[t].a);
    wake_end(world, &world->links.springs[t].b);
  }
  world->state.monitor.broken_links++;
}

size_t spore_world_link_count(const SporeWorld *world) { return world->links.count; }

SporeLinkState spore_world_link_state(const SporeWorld *world, size_t index) {
  const SporeLink *link = &world->links.all[index];
  SporeLinkState state = {.name = link->name, .broken = link->broken};
  double sign = link->kind == SPORE_LINK_PORT ? -1 : 1;
  if (link->curve.knots.span_count > 0) state.along = link->curve.start / spore_spline_end(link->curve.knots);
  for (size_t t = 0; !link->broken && t < link->term_count; t++) {
    const SporeSpringTerm *term = &world->links.springs[link->term_start + t];
    SporeVec3 apart = spore_spring_held(&term->law, spore_vec3_sub(term->a.position, term->b.position));
    state.force = spore_vec3_add_scaled(state.force, sign, term->force);
    state.load += spore_vec3_length(term->force);
    if (link->kind != SPORE_LINK_SPRING) state.drift = fmax(state.drift, spore_vec3_length(apart));
  }
  return state;
}

static void break_link(SporeWorld *world, SporeLink *link, double load) {
  spore_link_release(world, link);
  spore_world_report(world, _("%s: broke, it held %.3g N and can hold %.3g N"), link->name, load, link->strength);
}

void spore_world_break_links(SporeWorld *world) {
  for (size_t i = 0; i < world->links.count; i++) {
    SporeLink *link = &world->links.all[i];
    if (link->broken || !isfinite(link->strength)) continue;
    double load = spore_world_link_state(world, i).load;
    if (load > link->strength) break_link(world, link, load);
  }
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
