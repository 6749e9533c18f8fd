/* Contacts met one after the other, each implicitly by itself: what the method position_based does with them.
 *
 * With the law of core/collide/response.h, the inverse mass w of both ends and the ends where all else led them in the
 * h seconds of the step, a contact moves them so that its force is that of where they are then, and of how fast they
 * came there: N = N(d - h^2 w N, g + h w N),   T = (k s + c s(d) w_t) / (1 + w (h^2 k + h c s(d))), cut to the length
 * mu N. N is found by Newton's method: the law falls with N, so that there is one. Normals are held, as in all methods.
 * Ends of more than one node move by their weights. It is implicit Euler, which takes energy from what strikes and
 * never gives any: a contact that was met within the step and followed to its end, as other elements are, would throw
 * out what it let in. */
#include <assert.h>
#include <math.h>

#include "core/sim/solve/island_system.h"

/* Whether sweeps move the end: it is prescribed, or of nodes that models meet. */
static bool is_met(const SporeIslandSystem *system, const SporeEnd *end, bool field) {
  if (end->prescribed) return true;
  bool nodes = end->mapping->kind == SPORE_MAPPING_IDENTITY || end->mapping->kind == SPORE_MAPPING_LINEAR;
  return nodes && !field && spore_model_sweeps(system->world->bodies[end->body].model);
}

bool spore_island_system_can_meet(const SporeIslandSystem *system) {
  if (!spore_integrator(system->island->integrator)->sweeps) return false;
  for (size_t i = 0; i < system->island->contact_count; i++) {
    const SporeContactTerm *term = spore_island_system_contact(system, i);
    if (!is_met(system, &term->a, term->field_a) || !is_met(system, &term->b, term->field_b)) return false;
  }
  return system->island->contact_count > 0;
}

/* Where an end is. */
typedef struct Met {
  SporeVec3 moved, since; /* since the step of the world began, and since that of the integrator, m */
  double give;            /* inverse mass, 1/kg */
} Met;

/* Of a point of several nodes: which they are. */
typedef struct Nodes {
  size_t first; /* where the body's nodes begin */
  uint32_t start, end;
} Nodes;

static Nodes nodes_of(const SporeIslandSystem *system, const SporeEnd *end) {
  size_t first = system->world->solve.local_sites[end->body].v / 3;
  if (end->mapping->kind == SPORE_MAPPING_IDENTITY) return (Nodes){first, end->point, end->point + 1};
  return (Nodes){first, end->mapping->row_start[end->point], end->mapping->row_start[end->point + 1]};
}

static size_t node_of(const SporeEnd *end, const Nodes *nodes, uint32_t k, double *weight) {
  bool whole = end->mapping->kind == SPORE_MAPPING_IDENTITY;
  *weight = whole ? 1 : end->mapping->weight[k];
  return whole ? k : end->mapping->block[k];
}

static Met look(const SporeIslandSystem *system, const SporeEnd *end, const SporeContactSweep *at) {
  if (end->prescribed)
    return (Met){.moved = spore_vec3_scale(system->start_s + at->h, end->velocity),
                 .since = spore_vec3_scale(at->h, end->velocity)};
  Nodes nodes = nodes_of(system, end);
  const size_t first = system->world->solve.local_sites[end->body].q;
  Met met = {.moved = spore_vec3_scale(-1, end->position)};
  for (uint32_t k = nodes.start; k < nodes.end; k++) {
    double weight;
    size_t node = node_of(end, &nodes, k, &weight);
    SporeVec3 place = spore_vec3_load(at->q + first + 3 * node);
    SporeVec3 since = spore_vec3_sub(place, spore_vec3_load(at->before + first + 3 * node));
    met.moved = spore_vec3_add_scaled(met.moved, weight, place);
    met.since = spore_vec3_add_scaled(met.since, weight, since);
    met.give += weight * weight * at->rows[4 * (nodes.first + node) + 3];
  }
  return met;
}

/* Moves the end's nodes by a force that acts all the step. */
static void move(const SporeIslandSystem *system, const SporeEnd *end, const SporeContactSweep *at, SporeVec3 force) {
  if (end->prescribed) return;
  Nodes nodes = nodes_of(system, end);
  const SporeSite *site = &system->world->solve.local_sites[end->body];
  for (uint32_t k = nodes.start; k < nodes.end; k++) {
    double weight;
    size_t node = node_of(end, &nodes, k, &weight);
    SporeVec3 kick = spore_vec3_scale(at->h * weight * at->rows[4 * (nodes.first + node) + 3], force);
    spore_vec3_accumulate(at->v + site->v + 3 * node, kick);
    spore_vec3_accumulate(at->q + site->q + 3 * node, spore_vec3_scale(at->h, kick));
  }
}

#define ITERATIONS 30 /* halving alone leaves 1e-9 of the first force */

/* N, between 0 and the force at the state before it acts. give: inverse mass. */
static double press(const SporeContactLaw *law, const SporeContactState *state, double gap_speed, double h,
                    double give) {
  double pressing = 0, low = 0, high = 0;
  bool linear = law->damping == 0 && state->overlap == 0;
  for (int i = 0; i < ITERATIONS; i++) {
    SporeContactNormal normal = spore_contact_normal(law, state->depth - h * h * give * pressing, state->overlap,
                                                     gap_speed + h * give * pressing);
    double left = normal.force - pressing;
    if (i == 0) high = left;
    if (left > 0) low = pressing;
    else high = pressing;
    double next = pressing + left / (1 + h * give * (h * normal.stiffness + normal.damping));
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    double change = fabs(next - pressing);
    pressing = next;
    if (linear || change <= 1e-12 * high) break;
  }
  return pressing;
}

/* T; state: before N acts, depth: after it. */
static SporeVec3 hold_back(const SporeContactLaw *law, SporeContactState *state, double pressing, double h,
                           double give) {
  double damping;
  state->depth -= h * h * give * pressing;
  SporeVec3 hold = spore_contact_hold(law, state, &damping);
  hold = spore_vec3_scale(1 / (1 + h * give * (h * law->stiffness + damping)), hold);
  return spore_contact_cut(law, hold, pressing);
}

static void meet(const SporeIslandSystem *system, SporeContactTerm *term, const SporeContactSweep *at) {
  Met a = look(system, &term->a, at), b = look(system, &term->b, at);
  SporeVec3 moved = spore_vec3_sub(a.moved, b.moved);
  double gone = spore_vec3_dot(term->normal, moved), give = a.give + b.give;
  SporeContactState state = {.normal = term->normal, .depth = term->depth - gone, .overlap = term->overlap};
  state.velocity = spore_vec3_scale(1 / at->h, spore_vec3_sub(a.since, b.since));
  term->force = (SporeVec3){0, 0, 0}, term->pressing = 0;
  if (!(state.depth > 0)) return;
  term->pressing = press(&term->law, &state, spore_vec3_dot(term->normal, state.velocity), at->h, give);
  term->force = spore_vec3_scale(term->pressing, term->normal);
  if (term->law.friction * term->pressing > 0) {
    state.stretch = spore_vec3_add(term->stretch, spore_vec3_add_scaled(moved, -gone, term->normal));
    term->force = spore_vec3_sub(term->force, hold_back(&term->law, &state, term->pressing, at->h, give));
  }
  move(system, &term->a, at, term->force);
  move(system, &term->b, at, spore_vec3_scale(-1, term->force));
}

void spore_island_system_meet_contacts(const SporeIslandSystem *system, const SporeContactSweep *at) {
  assert(system->meets && at->h > 0 && at->before && at->q && at->v && at->rows);
  for (size_t i = 0; i < system->island->contact_count; i++) meet(system, spore_island_system_contact(system, i), at);
}
