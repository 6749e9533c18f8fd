/* Contacts that are too soft because explicit steps soften them: see SporeSoftening.
 *
 * Two ends alone rest as deep as the law demands, at any step. Where other bodies lie on them, only
 *   1 / (1 + L) of k depth,   L = w (h d + h t k)
 * presses, since the ends do not take into account that their neighbours push back too. A pile sinks in until this
 * force holds it. For light particles the damping d is most often the reason: its usual value is large beside the
 * critical damping of their oscillation. */
#include <assert.h>
#include <math.h>
#include <stdio.h>

#include "core/base/text.h"
#include "core/sim/world_private.h"

#define LEAST_SHARE 0.5 /* of k depth: what a contact at rest must hold */
#define GOOD_SHARE 0.8  /* of k depth: what it holds with the substeps that the message asks for */
#define REST_TIME_S 0.1 /* a contact is at rest if it lasts longer than this; it is watched for as long */
#define NEIGHBOURS 6    /* contacts of a body in a pile: as many as hold the body without friction */
#define SINKING 0.25    /* of their radius: how far particles may sink in */

static double share_held(double h, double w, const SporeContactLaw *law) {
  assert(h > 0 && w >= 0);
  SporeSoftening softening = spore_softening(h, w, law->stiffness);
  return 1 / (1 + w * h * (law->damping + softening.ahead * law->stiffness));
}

/* Number of substeps of a step of time_step seconds; more than SPORE_SUBSTEPS_MAXIMUM: there is no such number. */
static size_t substeps_to_hold(double time_step, double w, const SporeContactLaw *law) {
  assert(time_step > 0);
  size_t substeps = 1;
  while (substeps <= SPORE_SUBSTEPS_MAXIMUM && share_held(time_step / (double)substeps, w, law) < GOOD_SHARE)
    substeps++;
  return substeps;
}

/* Damping with which a step of h seconds leaves the good share; 0: no damping does. */
static double damping_to_hold(double h, double w, const SporeContactLaw *law) {
  assert(h > 0 && w >= 0);
  SporeSoftening softening = spore_softening(h, w, law->stiffness);
  return fmax((1 / GOOD_SHARE - 1) / (w * h) - softening.ahead * law->stiffness, 0);
}

static bool softened_at_rest(const SporeWorld *world, const SporeContactTerm *term) {
  double spring = term->law.stiffness * term->depth;
  if (!(term->softening.inverse_mass > 0) || !(spring > 0) || !(term->pressing < LEAST_SHARE * spring)) return false;
  SporeVec3 gap = spore_vec3_sub(spore_vec3_load(world->contact.spheres.velocity + 3 * (size_t)term->sphere_a),
                                 spore_vec3_load(world->contact.spheres.velocity + 3 * (size_t)term->sphere_b));
  return fabs(spore_vec3_dot(term->normal, gap)) * REST_TIME_S < term->depth;
}

static SporePileLimit limit_of(double time_step, double h, double w, const SporeContactLaw *law, bool particles) {
  return (SporePileLimit){.share = share_held(h, w, law),
                          .substeps = substeps_to_hold(time_step, w, law),
                          .damping = damping_to_hold(h, w, law),
                          .implicit = !particles};
}

void spore_pile_remedy(const SporePileLimit *limit, char *text, size_t size) {
  assert(limit && text && size > 0);
  char substeps[64] = "", damping[64] = "";
  if (limit->substeps <= SPORE_SUBSTEPS_MAXIMUM)
    snprintf(substeps, sizeof substeps, _("%zu substeps, "), limit->substeps);
  if (limit->damping > 0) snprintf(damping, sizeof damping, _("contact damping %.2g, "), limit->damping);
  snprintf(text, size,
           limit->implicit ? _("take %s%sa smaller time_step or integrator implicit_euler")
                           : _("take %s%sor a smaller time_step"),
           substeps, damping);
}

static bool is_of_particles(const SporeBody *body) {
  return body->role == SPORE_PASSIVE && body->model->type->rates && body->collision.spheres.point_count > 0;
}

static void report(SporeWorld *world, const SporeBody *body, const SporeContactTerm *term) {
  double percent = 100 * term->pressing / (term->law.stiffness * term->depth);
  SporePileLimit limit = limit_of(world->solver.time_step, term->softening.h, term->softening.inverse_mass, &term->law,
                                  is_of_particles(body));
  char remedy[160];
  spore_pile_remedy(&limit, remedy, sizeof remedy);
  spore_world_report(world, _("%s: lies too deep: steps of %.3g s leave a contact %.2g%% of its stiffness; %s"),
                     body->name, term->softening.h, percent, remedy);
}

/* A body is watched from the first of the consecutive steps in which it has such a contact. */
static bool watch_body(SporeWorld *world, const SporeEnd *end, const SporeContactTerm *term) {
  assert(end->prescribed || end->body < world->body_count);
  if (end->prescribed) return false;
  SporeBody *body = &world->bodies[end->body];
  if (body->collision.soft_last + 1 < world->state.step + 1) body->collision.soft_since = world->state.step + 1;
  body->collision.soft_last = world->state.step + 1; /* 0: never */
  if ((double)(body->collision.soft_last - body->collision.soft_since) * world->solver.time_step < REST_TIME_S)
    return false;
  if (!body->reported.soft) report(world, body, term);
  body->reported.soft = true;
  return true;
}

static void watch_island(SporeWorld *world, const SporeIsland *island) {
  assert(island->contact_start + island->contact_count <= world->contact.count);
  for (size_t i = 0; i < island->contact_count; i++) {
    const SporeContactTerm *term = &world->contact.terms[world->contact.order[island->contact_start + i]];
    if (!softened_at_rest(world, term)) continue;
    bool a = watch_body(world, &term->a, term), b = watch_body(world, &term->b, term);
    world->state.monitor.soft_contacts += a || b;
  }
}

void spore_world_watch_contacts(SporeWorld *world) {
  for (size_t i = 0; i < world->solve.island_count; i++)
    if (!spore_integrator(world->solve.islands[i].integrator)->implicit) watch_island(world, &world->solve.islands[i]);
}

/* Inverse mass of the lightest end of the body, in a contact with a body of its kind. */
static double pile_inverse_mass(const SporeWorld *world, const SporeBody *body) {
  assert(spore_model_is_rigid(body->model));
  const double *inverse = world->state.mass_inverse + 3 * body->v_offset;
  double w = inverse[0];
  if (body->collision.fields.friction > 0) {
    double turn = inverse[9] + inverse[13] + inverse[17], least = HUGE_VAL;
    for (size_t i = 0; i < body->collision.spheres.point_count; i++)
      least = fmin(least, world->contact.spheres.radius[body->collision.start + i]);
    w += least * least * turn;
  }
  return 2 * NEIGHBOURS * w;
}

/* Whether another body that moves may lie on the body, or under it. */
static bool may_be_piled(const SporeWorld *world, const SporeBody *body) {
  if (body->role != SPORE_PASSIVE || !spore_model_is_rigid(body->model) || body->collision.spheres.point_count == 0)
    return false;
  for (size_t b = 0; b < world->body_count; b++) {
    const SporeBody *other = &world->bodies[b];
    bool meets = body->collision.fields.group == 0 || body->collision.fields.group != other->collision.fields.group;
    if (other != body && other->role == SPORE_PASSIVE && other->collision.spheres.point_count > 0 && meets) return true;
  }
  return false;
}

/* Whether particles sink in too far. Their own forces carry the particles above, so the column on a particle presses it
 * into the surface that holds it. */
static bool particles_sink(const SporeWorld *world, const SporeBody *body, double share) {
  assert(body->collision.spheres.point_count > 0);
  double count = (double)body->collision.spheres.point_count, radius = HUGE_VAL;
  for (size_t i = 0; i < body->collision.spheres.point_count; i++)
    radius = fmin(radius, world->contact.spheres.radius[body->collision.start + i]);
  double weight = body->total_mass / count * spore_vec3_length(world->state.gravity);
  return cbrt(count) * weight > SINKING * radius * share * body->collision.fields.stiffness;
}

bool spore_world_pile_sinks(const SporeWorld *world, uint32_t index, SporePileLimit *limit) {
  assert(index < world->body_count);
  assert(limit);
  const SporeBody *body = &world->bodies[index];
  assert(body->method.substeps >= 1);
  bool particles = is_of_particles(body);
  if (!(particles || may_be_piled(world, body)) || spore_integrator(body->method.integrator)->implicit) return false;
  SporeContactMaterial its = {body->collision.fields.stiffness, body->collision.fields.damping,
                              body->collision.fields.friction};
  SporeContactLaw law = spore_contact_law(&its, &its, 1, 1);
  if (particles)
    law.stiffness = its.stiffness, law.damping = its.damping; /* the body that holds them may be much stiffer */
  double w = particles ? NEIGHBOURS * world->state.mass_inverse[3 * body->v_offset] : pile_inverse_mass(world, body);
  double h = world->solver.time_step / (double)body->method.substeps;
  *limit = limit_of(world->solver.time_step, h, w, &law, particles);
  return limit->share < LEAST_SHARE && (!particles || particles_sink(world, body, limit->share));
}
