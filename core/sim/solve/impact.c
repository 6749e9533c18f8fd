/* Impacts of rigid bodies. How fast a body leaves an impact depends on how well the impact is followed: a step that is
 * long for the contact takes energy away, or makes some. So an island of one or two rigid bodies that meet, press or
 * part faster than what rests takes its step in parts: by velocity Verlet, which keeps momentum and, to a thousandth or
 * two, energy; each a tenth of a radian of the stiffest contact as long as something touches, and up to the next touch
 * in one part. With each part, contacts follow their spheres: a normal that stays while the ball rolls off a sphere is
 * that of another slope, and makes energy.
 *
 * What rests, slides or is pushed evenly has no impact, and takes its step by its own method; so does what overlaps
 * since it was put there, as its exit is damped in full (core/collide/response.h). Not followed are bodies with links,
 * and soft ones: the impact of a soft body is that of its nodes, whose own swings its step does not follow either. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/integrate/integrator.h"
#include "core/sim/solve/island_system.h"

#define PART 0.1               /* radians of the stiffest contact in a part that touches: 63 parts a swing */
#define CERTAIN 0.5            /* of the slowest impact: what is slower by a first look has none */
#define MOST_EVALUATIONS 65536 /* of contacts, and of MANY more a part, in all parts of a step */
#define MANY 16
#define MOST_BODIES 2 /* of more, what leaves one may meet the next where the step has not looked for contacts */

typedef struct Impact {
  SporeWorld *world;
  SporeIsland *island;
  SporeIslandSystem system;
  SporeDynamics dynamics;
  double part_s; /* of a part that touches */
  double *force; /* at the start of a part; then scratch */
} Impact;

/* How fast the ends part along the normal by x, of the bodies that physics moves, at q. */
static double parting(const Impact *impact, SporeContactTerm *term, const double *q, const double *x) {
  return spore_contact_term_parting(term, impact->world->solve.local_sites, q, x);
}

static double driven(const SporeContactTerm *term) {
  double speed = 0;
  if (term->a.prescribed) speed += spore_vec3_dot(term->normal, term->a.velocity);
  if (term->b.prescribed) speed -= spore_vec3_dot(term->normal, term->b.velocity);
  return speed;
}

static double end_inverse_mass(const SporeWorld *world, const SporeEnd *end) {
  return end->prescribed ? 0 : world->state.mass_inverse[3 * world->bodies[end->body].v_offset];
}

/* Whether some contact may have an impact: by its speed or by its depth, which are known. */
static bool may_strike(const SporeWorld *world, const SporeIsland *island) {
  const uint32_t *order = world->contact.order + island->contact_start;
  double least = CERTAIN * spore_world_slowest_impact(world);
  for (size_t i = 0; i < island->contact_count; i++) {
    const SporeContact *contact = &world->contact.manifold[order[i]].contact;
    const SporeContactTerm *term = &world->contact.terms[order[i]];
    if (fabs(contact->gap_speed) > least) return true;
    double inverse_mass = end_inverse_mass(world, &term->a) + end_inverse_mass(world, &term->b);
    if (contact->depth > 0 && contact->depth * contact->depth * term->law.stiffness * inverse_mass > least * least)
      return true;
  }
  return false;
}

/* Whether some contact has an impact: speed and acceleration along its normal are those of a swing as fast as that. */
static bool strikes(Impact *impact) {
  SporeWorld *world = impact->world;
  SporeIsland *island = impact->island;
  SporeDynamics dynamics = spore_island_system_dynamics(&impact->system);
  double *force = world->solve.scratch + world->solve.scratch_per_block * (island->v_start / 3);
  double *acceleration = force + island->v_count, least = spore_world_slowest_impact(world),
         swing_s = impact->part_s / PART;
  dynamics.set_time(dynamics.data, 0);
  dynamics.force(dynamics.data, island->q0, island->v0, force);
  memset(acceleration, 0, island->v_count * sizeof *acceleration);
  dynamics.kick(dynamics.data, force, 1, acceleration);
  bool any = false, overlap = false;
  for (size_t i = 0; i < island->contact_count; i++) {
    SporeContactTerm *term = spore_island_system_contact(&impact->system, i);
    overlap |= term->overlap > 0;
    double speed = parting(impact, term, island->q0, island->v0) + driven(term);
    double gained = swing_s * parting(impact, term, island->q0, acceleration);
    if (term->depth <= 0 && speed >= 0) continue;
    any |= speed * speed + gained * gained > least * least;
  }
  dynamics.set_time(dynamics.data, world->solver.time_step);
  return any && !overlap;
}

static bool is_rigid(const SporeBody *body) { return spore_model_is_rigid(body->model) && !spore_body_is_static(body); }

static bool all_rigid(const SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++) {
    if (!is_rigid(&world->bodies[world->solve.island_bodies[island->body_start + i]])) return false;
  }
  return island->kept_count > 0 && island->kept_count <= MOST_BODIES;
}

/* Whether the method follows impacts itself, by control of its error. */
static bool follows(const SporeWorld *world, SporeIntegratorKind kind) {
  return kind == SPORE_INTEGRATOR_TR_BDF2 && world->solver.error_tolerance > 0;
}

static bool is_linked(const SporeWorld *world, uint32_t body) {
  size_t springs = spore_world_spring_count(world);
  for (size_t i = 0; i < springs; i++) {
    const SporeSpringTerm *term = &world->links.springs[i];
    if (world->links.active[i] && (term->a.body == body || term->b.body == body)) return true;
  }
  return false;
}

SporeImpacts spore_body_impacts(const SporeWorld *world, uint32_t index) {
  assert(index < world->body_count);
  const SporeBody *body = &world->bodies[index];
  bool touches = world->contact.grid && body->collision.spheres.point_count > 0;
  if (!touches || !is_rigid(body) || follows(world, body->method.integrator)) return SPORE_IMPACTS_NONE;
  return is_linked(world, index) ? SPORE_IMPACTS_LINKED : SPORE_IMPACTS_FOLLOWED;
}

bool spore_island_strikes(SporeWorld *world, SporeIsland *island, double *part_s) {
  assert(part_s && island->q0 && island->v0);
  if (island->contact_count == 0 || island->spring_count > 0 || island->multirate || !may_strike(world, island) ||
      !all_rigid(world, island) || follows(world, island->integrator))
    return false;
  Impact impact = {.world = world, .island = island};
  impact.system = (SporeIslandSystem){.world = world, .island = island, .now_s = -1};
  *part_s = impact.part_s = spore_island_system_short_step(&impact.system, PART);
  return impact.part_s > 0 && strikes(&impact);
}

/* Contacts follow their spheres to q, where time begins anew for them. */
static void follow(Impact *impact, const double *q) {
  const double *radius = impact->world->contact.spheres.radius;
  for (size_t i = 0; i < impact->island->contact_count; i++) {
    SporeContactTerm *term = spore_island_system_contact(&impact->system, i);
    spore_contact_term_follow(term, radius[term->sphere_a], radius[term->sphere_b], impact->world->solve.local_sites,
                              q);
  }
  spore_island_system_lay_contacts(&impact->system);
  impact->system.now_s = -1;
  impact->dynamics.set_time(impact->dynamics.data, 0);
}

/* Length of the next part from q, v, of `left` seconds. */
static double next_part(Impact *impact, const double *q, const double *v, double left) {
  double until = left;
  for (size_t i = 0; i < impact->island->contact_count; i++) {
    SporeContactTerm *term = spore_island_system_contact(&impact->system, i);
    double speed = parting(impact, term, q, v) + driven(term);
    if (term->depth > 0) until = fmin(until, impact->part_s);
    else if (speed < 0) until = fmin(until, fmax(impact->part_s, term->depth / speed));
  }
  return left - until < 0.5 * impact->part_s ? left : until;
}

/* What the contacts push in `time_s` seconds, by their last forces. */
static void add_impulses(Impact *impact, double time_s) {
  spore_island_system_keep_contacts(&impact->system);
  for (size_t i = 0; i < impact->island->contact_count; i++) {
    SporeContactTerm *term = spore_island_system_contact(&impact->system, i);
    term->impulse = spore_vec3_add_scaled(term->impulse, time_s, term->force);
  }
}

/* Forces are the mean ones of the step: an impact may be over when it ends. */
static void set_means(Impact *impact) {
  double rate = 1 / impact->world->solver.time_step;
  for (size_t i = 0; i < impact->island->contact_count; i++) {
    SporeContactTerm *term = spore_island_system_contact(&impact->system, i);
    term->force = spore_vec3_scale(rate, term->impulse);
  }
}

/* Velocity Verlet from q0, v0: kick, drift, kick, each kick where the contacts have been followed to. Forces at the end
 * that depend on velocity see it as the first kick, made twice, has it. */
static void take_part(Impact *impact, double h, const double *q0, const double *v0) {
  const SporeDynamics *dynamics = &impact->dynamics;
  SporeIsland *island = impact->island;
  size_t n = island->v_count;
  double *q1 = island->q1, *v1 = island->v1, *half = impact->force + n, *change = half + n, *predicted = change + n;
  add_impulses(impact, 0.5 * h);
  memset(change, 0, n * sizeof *change);
  dynamics->kick(dynamics->data, impact->force, 0.5 * h, change);
  for (size_t i = 0; i < n; i++) half[i] = v0[i] + change[i];
  dynamics->drift(dynamics->data, q0, half, h, q1, v1);
  memcpy(predicted, v1, n * sizeof *v1);
  dynamics->carry(dynamics->data, change, q1, predicted);
  dynamics->set_time(dynamics->data, h);
  follow(impact, q1);
  dynamics->force(dynamics->data, q1, predicted, impact->force);
  add_impulses(impact, 0.5 * h);
  dynamics->set_mass(dynamics->data, q1);
  dynamics->kick(dynamics->data, impact->force, 0.5 * h, v1);
}

/* What is left of a step of very many parts, as a step that has no impact. */
static SporeStepResult take_rest(Impact *impact, double h, const double *q0, const double *v0) {
  SporeIsland *island = impact->island;
  SporeHistory none = {0};
  SporeStepResult result = spore_implicit_euler.step(&impact->dynamics, &impact->world->solver, &none, h, q0, v0,
                                                     island->q1, island->v1, impact->force);
  impact->dynamics.set_time(impact->dynamics.data, h);
  add_impulses(impact, h);
  return result;
}

static void begin(Impact *impact) {
  SporeWorld *world = impact->world;
  SporeIsland *island = impact->island;
  impact->system = (SporeIslandSystem){.world = world, .island = island, .equations = &island->equations, .now_s = -1};
  impact->dynamics = spore_island_system_dynamics(&impact->system);
  impact->force = world->solve.scratch + world->solve.scratch_per_block * (island->v_start / 3);
  island->stand_in = NULL;
  island->taken = SPORE_INTEGRATOR_IMPLICIT_EULER; /* of what is left, the only part that is solved */
  island->history.step_s = 0;
  for (size_t i = 0; i < island->contact_count; i++)
    spore_island_system_contact(&impact->system, i)->impulse = (SporeVec3){0, 0, 0};
  impact->dynamics.set_time(impact->dynamics.data, 0);
  follow(impact, island->q0);
  impact->dynamics.force(impact->dynamics.data, island->q0, island->v0, impact->force);
}

SporeStepResult spore_island_advance_impact(SporeWorld *world, SporeIsland *island, double part_s) {
  assert(part_s > 0 && island->q1 && island->v1);
  Impact impact = {.world = world, .island = island, .part_s = part_s};
  SporeStepResult total = {.converged = true};
  const double *q0 = island->q0, *v0 = island->v0;
  size_t most = MOST_EVALUATIONS / (MANY + island->contact_count) + 1;
  begin(&impact);
  for (double left = world->solver.time_step, h; left > 0 && !spore_cancel_asked(world->cancel); left -= h) {
    h = ++total.force_evaluations < most ? next_part(&impact, q0, v0, left) : left;
    if (total.force_evaluations < most) take_part(&impact, h, q0, v0);
    else total = take_rest(&impact, h, q0, v0);
    q0 = memcpy(world->solve.local_q0 + island->q_start, island->q1, island->q_count * sizeof *q0);
    v0 = memcpy(world->solve.local_v0 + island->v_start, island->v1, island->v_count * sizeof *v0);
  }
  set_means(&impact);
  island->drift_s = impact.system.drift_s;
  return total;
}
