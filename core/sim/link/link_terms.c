/* Links as spring terms: their law, their load, and when they break. A joint consists of stiff springs of length 0.
 * So joints work wherever springs work: with every integrator, islands, sleep, and deformable bodies. */
#include <assert.h>
#include <math.h>

#include "core/base/text.h"
#include "core/sim/world_private.h"

/* Critical damping for the lighter of the bodies that move. */
static double critical_damping(const SporeWorld *world, const SporeLinkDescription *link) {
  double mass = INFINITY;
  if (spore_body_is_passive(world, link->body_a)) mass = world->bodies[link->body_a].total_mass;
  if (spore_body_is_passive(world, link->body_b)) mass = fmin(mass, world->bodies[link->body_b].total_mass);
  return 2 * sqrt(link->stiffness * mass);
}

SporeSpring spore_link_law(const SporeWorld *world, const SporeLinkDescription *link) {
  assert(link->type->term_count > 0);
  double damping = link->damping < 0 ? critical_damping(world, link) : link->damping;
  double share = 1 / (double)link->type->term_count;
  SporeSpring law = {.stiffness = share * link->stiffness, .damping = share * damping, .friction = link->friction};
  if (link->type->law) link->type->law(link, &law);
  return law;
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

const char *spore_world_link_name(const SporeWorld *world, size_t link) { return world->links.all[link].name; }

SporeLinkState spore_world_link_state(const SporeWorld *world, size_t index) {
  const SporeLink *link = &world->links.all[index];
  SporeLinkState state = {.name = link->name, .broken = link->broken};
  double sign = link->type->line == SPORE_LINE_OF_BODY_A ? -1 : 1;
  if (link->curve.knots.span_count > 0) state.along = link->curve.start / spore_spline_end(link->curve.knots);
  for (size_t t = 0; !link->broken && t < link->term_count; t++) {
    const SporeSpringTerm *term = &world->links.springs[link->term_start + t];
    SporeVec3 apart = spore_spring_held(&term->law, spore_vec3_sub(term->a.position, term->b.position));
    state.force = spore_vec3_add_scaled(state.force, sign, term->force);
    state.load += spore_vec3_length(term->force);
    if (link->type->is_joint) state.drift = fmax(state.drift, spore_vec3_length(apart));
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
