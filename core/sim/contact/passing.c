/* Bodies that contacts do not hold. A contact holds up to a depth of the radius of its smaller sphere: deeper, it soon
 * pushes to the wrong side. Nothing may come so far without a word:
 *   too fast  a fast body meets others at a speed that all contacts of the step together do not stop within that depth.
 *             The step does not show what becomes of it, so that this is told by the energy;
 *   deep      a contact is deeper when a step begins;
 *   passed    two spheres were deeper in each other on their way through the last step, and have left each other. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/collide/narrow.h"
#include "core/sim/world_private.h"

static double smaller_radius(const SporeWorld *world, uint32_t a, uint32_t b) {
  assert(a < world->contact.spheres.count && b < world->contact.spheres.count);
  return fmin(world->contact.spheres.radius[a], world->contact.spheres.radius[b]);
}

static bool is_held(const SporeBody *body) { return spore_body_is_physical(body) && !body->frozen; }

static SporeBody *body_of(const SporeWorld *world, uint32_t sphere) {
  assert(sphere < world->contact.spheres.count);
  return &world->bodies[world->contact.spheres.body[sphere]];
}

/* Inverse mass (1/kg) of the sphere against a push along the normal, at its centre; 0: physics does not move it. */
static double sphere_inverse_mass(const SporeWorld *world, uint32_t sphere, SporeVec3 normal) {
  const SporeBody *body = body_of(world, sphere);
  if (!is_held(body)) return 0;
  const SporeMapping *mapping = &body->collision.spheres;
  const double *inverse = world->state.mass_inverse + 3 * body->v_offset;
  uint32_t point = sphere - (uint32_t)body->collision.start;
  if (mapping->kind == SPORE_MAPPING_IDENTITY) return inverse[9 * (size_t)point];
  if (mapping->kind == SPORE_MAPPING_RIGID) {
    SporeVec3 centre = spore_vec3_load(world->contact.spheres.centre + 3 * (size_t)sphere);
    SporeVec3 arm = spore_vec3_sub(centre, spore_vec3_load(world->state.q + body->q_offset));
    SporeVec3 turn = spore_vec3_cross(arm, normal);
    SporeMat3 inertia;
    memcpy(inertia.m, inverse + 9, sizeof inertia.m);
    return inverse[0] + spore_vec3_dot(turn, spore_mat3_apply(inertia, turn));
  }
  double sum = 0;
  for (uint32_t k = mapping->row_start[point]; k < mapping->row_start[point + 1]; k++)
    sum += mapping->weight[k] * mapping->weight[k] * inverse[9 * (size_t)mapping->block[k]];
  return sum;
}

/* The same of the whole body, which comes head-on. */
static double head_on_inverse_mass(const SporeWorld *world, uint32_t sphere) {
  return sphere_inverse_mass(world, sphere, (SporeVec3){0, 0, 0});
}

static double pair_inverse_mass(const SporeWorld *world, uint32_t a, uint32_t b, SporeVec3 normal) {
  return sphere_inverse_mass(world, a, normal) + sphere_inverse_mass(world, b, normal);
}

static SporeContactLaw law_of(const SporeWorld *world, uint32_t a, uint32_t b) {
  const SporeContactFields *one = &body_of(world, a)->collision.fields, *other = &body_of(world, b)->collision.fields;
  return spore_contact_law(&(SporeContactMaterial){one->stiffness, one->damping, one->friction},
                           &(SporeContactMaterial){other->stiffness, other->damping, other->friction},
                           world->contact.spheres.radius[a], world->contact.spheres.radius[b]);
}

/* Counts the step for the bodies of the two spheres that physics moves; false: it moves neither. */
static bool count(SporeWorld *world, uint32_t a, uint32_t b, double speed) {
  uint32_t bodies[2] = {world->contact.spheres.body[a], world->contact.spheres.body[b]};
  bool any = false;
  for (int i = 0; i < 2; i++) {
    if (!is_held(&world->bodies[bodies[i]])) continue;
    spore_world_count_unsolved(world, bodies[i], SPORE_UNSOLVED_PASSED, speed);
    any = true;
  }
  return any;
}

static double speed_of(const SporeWorld *world, uint32_t sphere) {
  return spore_vec3_length(spore_vec3_load(world->contact.spheres.velocity + 3 * (size_t)sphere));
}

/* The body of the two spheres that a message names first: the one that physics moves, or else the faster. */
static SporeBody *first_named(const SporeWorld *world, uint32_t a, uint32_t b, SporeBody **other) {
  SporeBody *one = body_of(world, a), *second = body_of(world, b);
  bool alike = is_held(one) == is_held(second);
  bool swap = alike ? speed_of(world, b) > speed_of(world, a) : is_held(second);
  *other = swap ? one : second;
  return swap ? second : one;
}

/* Of two bodies that physics does not move, no stiffness keeps one from the other. */
static bool is_led(const SporeBody *a, const SporeBody *b) { return !is_held(a) && !is_held(b); }

/* Deep. */

/* What a spring needs, N/m, to stop within the radius what is so deep and still comes so fast: the energy is k d^2 / 2
 * and m g^2 / 2. */
static double stiffness_for(const SporeContactLaw *law, double inverse_mass, double radius, double depth,
                            double speed) {
  double moving = inverse_mass > 0 ? speed * speed / inverse_mass : 0;
  return (law->stiffness * depth * depth + moving) / (radius * radius);
}

static void report_depth(SporeWorld *world, const SporeContactTerm *term, double radius, double speed, bool put) {
  SporeBody *b, *a = first_named(world, term->sphere_a, term->sphere_b, &b);
  if (a->reported.deep && b->reported.deep) return;
  a->reported.deep = b->reported.deep = true;
  double w = pair_inverse_mass(world, term->sphere_a, term->sphere_b, term->normal);
  if (is_led(a, b))
    spore_world_report(world, _("%s: is led %.2g m deep into %s, more than the radius of a sphere; lead it back"),
                       a->name, term->depth, b->name);
  else if (put)
    spore_world_report(world, _("%s: overlaps %s by %.2g m, more than the radius of a sphere; move them apart"),
                       a->name, b->name, term->depth);
  else
    spore_world_report(world,
                       _("%s: is %.2g m deep in %s, more than the radius of a sphere, at %.2g m/s; take a contact "
                         "stiffness of %.2g N/m or more for the two, or a smaller time_step"),
                       a->name, term->depth, b->name, speed, stiffness_for(&term->law, w, radius, term->depth, speed));
}

/* A depth that motion has not made is told, but it is what the scene, or somebody, wants. */
static void watch_depth(SporeWorld *world, const SporeContactTerm *term, const SporeContact *contact) {
  double radius = smaller_radius(world, term->sphere_a, term->sphere_b), speed = fabs(contact->gap_speed);
  bool put = term->depth - term->overlap <= radius;
  world->state.monitor.deep_contacts++;
  if (!put) count(world, term->sphere_a, term->sphere_b, speed);
  report_depth(world, term, radius, speed, put);
}

/* Too fast. */

static bool comes_fast(const SporeWorld *world, const SporeContact *contact) {
  double way = -contact->gap_speed * world->solver.time_step;
  return way > SPORE_SPHERES_FAST * smaller_radius(world, contact->a, contact->b);
}

static SporeImpact *impact_of(const SporeWorld *world, uint32_t sphere) {
  return &body_of(world, sphere)->collision.impact;
}

static bool meets_now(const SporeWorld *world, uint32_t sphere) {
  return is_held(body_of(world, sphere)) && impact_of(world, sphere)->step == world->state.step + 1;
}

/* When the contact would be as deep as the radius, if nothing stopped it, s. */
static double time_of_depth(const SporeWorld *world, const SporeContact *contact) {
  assert(contact->gap_speed < 0);
  return fmax(smaller_radius(world, contact->a, contact->b) - contact->depth, 0) / -contact->gap_speed;
}

static void note_impact(SporeWorld *world, uint32_t sphere, double at_s) {
  SporeImpact *impact = impact_of(world, sphere);
  if (!meets_now(world, sphere)) *impact = (SporeImpact){world->state.step + 1, at_s, 0};
  impact->at_s = fmin(impact->at_s, at_s);
}

/* Adds what the contact holds of a body that meets others in this step. */
static void add_support(const SporeWorld *world, const SporeContactTerm *term, const SporeContact *contact,
                        uint32_t sphere) {
  if (!meets_now(world, sphere)) return;
  SporeImpact *impact = impact_of(world, sphere);
  double depth = fmax(contact->depth - contact->gap_speed * impact->at_s, 0);
  depth = fmin(depth, smaller_radius(world, contact->a, contact->b));
  impact->support += 0.5 * term->law.stiffness * depth * depth;
}

/* Speed up to which the contacts of both bodies stop the pair, m/s. Damping raises it as it does that of one contact.
 */
static double stopping_speed(const SporeWorld *world, const SporeContactTerm *term, double radius) {
  double support = HUGE_VAL, alone = 0.5 * term->law.stiffness * radius * radius;
  const uint32_t spheres[2] = {term->sphere_a, term->sphere_b};
  for (int i = 0; i < 2; i++)
    if (meets_now(world, spheres[i])) support = fmin(support, impact_of(world, spheres[i])->support);
  double w = pair_inverse_mass(world, term->sphere_a, term->sphere_b, term->normal);
  double shared = alone > 0 && isfinite(support) ? fmax(support / alone, 1) : 1;
  return sqrt(shared) * spore_contact_stops(&term->law, w, radius);
}

/* Whether the contact is the one that would be deep first, of a body of the two. */
static bool is_first(const SporeWorld *world, const SporeContact *contact) {
  double at_s = time_of_depth(world, contact);
  return (meets_now(world, contact->a) && at_s <= impact_of(world, contact->a)->at_s) ||
         (meets_now(world, contact->b) && at_s <= impact_of(world, contact->b)->at_s);
}

static void watch_impact(SporeWorld *world, const SporeContactTerm *term, const SporeContact *contact) {
  double radius = smaller_radius(world, contact->a, contact->b), speed = -contact->gap_speed;
  double stops = stopping_speed(world, term, radius);
  if (speed <= stops || !count(world, contact->a, contact->b, speed)) return;
  SporeBody *b, *a = first_named(world, contact->a, contact->b, &b);
  if (a->reported.fast) return;
  a->reported.fast = true;
  double w = pair_inverse_mass(world, contact->a, contact->b, term->normal);
  double needed = stops > 0 && term->law.stiffness > 0 ? term->law.stiffness * (speed / stops) * (speed / stops)
                                                       : stiffness_for(&term->law, w, radius, 0, speed);
  spore_world_report(world,
                     _("%s: meets %s at %.3g m/s, and their contact stops it up to %.3g m/s; take a contact stiffness "
                       "of %.3g N/m for the two instead of %.3g, or a lower speed"),
                     a->name, b->name, speed, stops, needed, term->law.stiffness);
}

static void watch_impacts(SporeWorld *world) {
  const SporeManifoldContact *manifold = world->contact.manifold;
  for (size_t i = 0; i < world->contact.count; i++) {
    const SporeContact *contact = &manifold[i].contact;
    if (!comes_fast(world, contact)) continue;
    double at_s = time_of_depth(world, contact);
    note_impact(world, contact->a, at_s);
    note_impact(world, contact->b, at_s);
  }
  for (size_t i = 0; i < world->contact.count; i++) {
    add_support(world, &world->contact.terms[i], &manifold[i].contact, manifold[i].contact.a);
    add_support(world, &world->contact.terms[i], &manifold[i].contact, manifold[i].contact.b);
  }
  for (size_t i = 0; i < world->contact.count; i++)
    if (comes_fast(world, &manifold[i].contact) && is_first(world, &manifold[i].contact))
      watch_impact(world, &world->contact.terms[i], &manifold[i].contact);
}

/* Passed. */

static void watch_passed(SporeWorld *world, const SporeContact *found) {
  SporeContact passed;
  double h = world->solver.time_step;
  if (!spore_narrow_passed(&world->contact.spheres, found->a, found->b, h, &passed)) return; /* within a margin */
  double speed = -passed.gap_speed;
  count(world, passed.a, passed.b, speed);
  SporeBody *b, *a = first_named(world, passed.a, passed.b, &b);
  if (a->reported.passed) return;
  a->reported.passed = true;
  if (is_led(a, b)) {
    spore_world_report(world, _("%s: was led through %s within a step, at %.3g m/s; lead it more slowly"), a->name,
                       b->name, speed);
    return;
  }
  SporeContactLaw law = law_of(world, passed.a, passed.b);
  double radius = smaller_radius(world, passed.a, passed.b);
  double w = pair_inverse_mass(world, passed.a, passed.b, passed.normal);
  double needed = fmax(stiffness_for(&law, w, radius, 0, speed), law.stiffness);
  spore_world_report(world,
                     _("%s: passed through %s within a step, at %.3g m/s; take a smaller time_step and a contact "
                       "stiffness of %.3g N/m for the two, or a lower speed"),
                     a->name, b->name, speed, needed);
}

/* What contacts stop. */

/* The sphere of the body that is hardest to stop, as the other one of a pair: the smallest, and the heaviest. */
typedef struct Obstacle {
  double radius, inverse_mass;
} Obstacle;

static Obstacle obstacle_of(const SporeWorld *world, const SporeBody *body) {
  Obstacle obstacle = {HUGE_VAL, HUGE_VAL};
  for (size_t i = 0; i < body->collision.spheres.point_count; i++) {
    uint32_t sphere = (uint32_t)(body->collision.start + i);
    obstacle.radius = fmin(obstacle.radius, world->contact.spheres.radius[sphere]);
    obstacle.inverse_mass = fmin(obstacle.inverse_mass, head_on_inverse_mass(world, sphere));
  }
  return obstacle;
}

static double stopped_by(const SporeWorld *world, const SporeBody *body, const SporeBody *other) {
  Obstacle obstacle = obstacle_of(world, other);
  double least = HUGE_VAL;
  for (size_t i = 0; i < body->collision.spheres.point_count; i++) {
    uint32_t sphere = (uint32_t)(body->collision.start + i);
    SporeContactLaw law = law_of(world, sphere, (uint32_t)other->collision.start);
    double radius = fmin(world->contact.spheres.radius[sphere], obstacle.radius);
    double w = head_on_inverse_mass(world, sphere) + obstacle.inverse_mass;
    least = fmin(least, spore_contact_stops(&law, w, radius));
  }
  return least;
}

static double fastest_sphere(const SporeWorld *world, const SporeBody *body) {
  double fastest = 0;
  for (size_t i = 0; i < body->collision.spheres.point_count; i++) {
    SporeVec3 velocity = spore_vec3_load(world->contact.spheres.velocity + 3 * (body->collision.start + i));
    fastest = fmax(fastest, spore_vec3_length(velocity));
  }
  return fastest;
}

bool spore_world_stopping_speed(const SporeWorld *world, uint32_t index, SporeStoppingSpeed *stopping) {
  assert(index < world->body_count);
  assert(stopping);
  const SporeBody *body = &world->bodies[index];
  *stopping = (SporeStoppingSpeed){HUGE_VAL, 0, SPORE_NO_BODY};
  if (!is_held(body) || body->collision.spheres.point_count == 0) return false;
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *other = &world->bodies[b];
    bool grouped = body->collision.fields.group != 0 && body->collision.fields.group == other->collision.fields.group;
    if (b == index || grouped || other->collision.spheres.point_count == 0) continue;
    double speed = stopped_by(world, body, other);
    if (speed < stopping->stops) stopping->stops = speed, stopping->other = b;
  }
  stopping->moves = fastest_sphere(world, body);
  return stopping->other != SPORE_NO_BODY;
}

void spore_world_watch_passing(SporeWorld *world) {
  const SporeContact *passed;
  size_t passed_count = spore_grid_passed(world->contact.grid, &passed);
  for (size_t i = 0; i < passed_count; i++) watch_passed(world, &passed[i]);
  bool fast = false;
  for (size_t i = 0; i < world->contact.count; i++) {
    const SporeContactTerm *term = &world->contact.terms[i];
    const SporeContact *contact = &world->contact.manifold[i].contact;
    if (term->depth > smaller_radius(world, term->sphere_a, term->sphere_b)) watch_depth(world, term, contact);
    fast |= comes_fast(world, contact);
  }
  if (fast) watch_impacts(world);
}
