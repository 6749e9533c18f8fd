/* What explicit steps take away from contacts that carry more than their own two ends: see SporeSoftening. Alone, two
 * ends rest as deep as the law says at any step; but where others lie on them, what presses is only
 *   1 / (1 + L) of k depth,   L = w (h d + h t k)
 * since the ends do not know that their neighbours push back as well, and a pile sinks in until that holds. */
#include <math.h>

#include "core/base/text.h"
#include "core/sim/world_private.h"

#define LEAST_SHARE 0.5 /* of k depth, that a contact at rest must hold */
#define GOOD_SHARE 0.8  /* that the substeps asked for let it hold */
#define REST_TIME_S 0.1 /* at rest: in this time it would not be gone; and for how long it is watched */
#define NEIGHBOURS 6    /* contacts of a body in a pile: as many as hold it without friction */

static double share_held(double h, double w, const SporeContactLaw *law) {
  SporeSoftening softening = spore_softening(h, w, law->stiffness);
  return 1 / (1 + w * h * (law->damping + softening.ahead * law->stiffness));
}

/* Of a step of time_step seconds; more than SPORE_SUBSTEPS_MAXIMUM: too many. */
static size_t substeps_to_hold(double time_step, double w, const SporeContactLaw *law) {
  size_t substeps = 1;
  while (substeps <= SPORE_SUBSTEPS_MAXIMUM && share_held(time_step / (double)substeps, w, law) < GOOD_SHARE)
    substeps++;
  return substeps;
}

static bool softened_at_rest(const SporeWorld *world, const SporeContactTerm *term) {
  double spring = term->law.stiffness * term->depth;
  if (!(term->softening.inverse_mass > 0) || !(spring > 0) || !(term->pressing < LEAST_SHARE * spring)) return false;
  SporeVec3 gap = spore_vec3_sub(spore_vec3_load(world->spheres.velocity + 3 * (size_t)term->sphere_a),
                                 spore_vec3_load(world->spheres.velocity + 3 * (size_t)term->sphere_b));
  return fabs(spore_vec3_dot(term->normal, gap)) * REST_TIME_S < term->depth;
}

static void report(SporeWorld *world, const SporeBody *body, const SporeContactTerm *term) {
  double percent = 100 * term->pressing / (term->law.stiffness * term->depth);
  size_t substeps = substeps_to_hold(world->solver.time_step, term->softening.inverse_mass, &term->law);
  if (substeps <= SPORE_SUBSTEPS_MAXIMUM)
    spore_world_report(world,
                       _("%s: lies too deep: steps of %.3g s leave a contact %.2g%% of its stiffness; take %zu "
                         "substeps, a smaller time_step or integrator implicit_euler"),
                       body->name, term->softening.h, percent, substeps);
  else
    spore_world_report(world,
                       _("%s: lies too deep: steps of %.3g s leave a contact %.2g%% of its stiffness; take a smaller "
                         "time_step or integrator implicit_euler"),
                       body->name, term->softening.h, percent);
}

/* A body is watched from the first of the steps in a row that it has such a contact in. */
static bool watch_body(SporeWorld *world, const SporeEnd *end, const SporeContactTerm *term) {
  if (end->prescribed) return false;
  SporeBody *body = &world->bodies[end->body];
  if (body->soft_last + 1 < world->step + 1) body->soft_since = world->step + 1;
  body->soft_last = world->step + 1; /* 0: never */
  if ((double)(body->soft_last - body->soft_since) * world->solver.time_step < REST_TIME_S) return false;
  if (!body->told_soft) report(world, body, term);
  body->told_soft = true;
  return true;
}

static void watch_island(SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->contact_count; i++) {
    const SporeContactTerm *term = &world->contacts[world->contact_order[island->contact_start + i]];
    if (!softened_at_rest(world, term)) continue;
    bool a = watch_body(world, &term->a, term), b = watch_body(world, &term->b, term);
    world->monitor.soft_contacts += a || b;
  }
}

void spore_world_watch_contacts(SporeWorld *world) {
  for (size_t i = 0; i < world->island_count; i++)
    if (!spore_integrator(world->islands[i].integrator)->implicit) watch_island(world, &world->islands[i]);
}

/* Of the body's lightest end in a contact with its like. */
static double pile_inverse_mass(const SporeWorld *world, const SporeBody *body) {
  const double *inverse = world->mass_inverse + 3 * body->v_offset;
  double w = inverse[0];
  if (body->contact.friction > 0) {
    double turn = inverse[9] + inverse[13] + inverse[17], least = HUGE_VAL;
    for (size_t i = 0; i < body->spheres.point_count; i++)
      least = fmin(least, world->spheres.radius[body->sphere_start + i]);
    w += least * least * turn;
  }
  return 2 * NEIGHBOURS * w;
}

/* Whether another body that moves may lie on it, or under. */
static bool may_be_piled(const SporeWorld *world, const SporeBody *body) {
  if (body->role != SPORE_PASSIVE || !spore_model_is_rigid(body->model) || body->spheres.point_count == 0) return false;
  for (size_t b = 0; b < world->body_count; b++) {
    const SporeBody *other = &world->bodies[b];
    bool meets = body->contact.group == 0 || body->contact.group != other->contact.group;
    if (other != body && other->role == SPORE_PASSIVE && other->spheres.point_count > 0 && meets) return true;
  }
  return false;
}

size_t spore_world_pile_substeps(const SporeWorld *world, uint32_t index, double *share) {
  const SporeBody *body = &world->bodies[index];
  *share = 1;
  if (!may_be_piled(world, body) || spore_integrator(body->integrator)->implicit) return 0;
  SporeContactMaterial its = {body->contact.stiffness, body->contact.damping, body->contact.friction};
  SporeContactLaw law = spore_contact_law(&its, &its, 1, 1);
  double w = pile_inverse_mass(world, body);
  *share = share_held(world->solver.time_step / (double)body->substeps, w, &law);
  return *share < LEAST_SHARE ? substeps_to_hold(world->solver.time_step, w, &law) : 0;
}
