/* Stage: bodies change their level of detail by themselves, each by its own rule.
 *
 * Every few steps the world looks at each such body. By error, the body takes the coarsest level whose estimated error
 * (estimate.c) is within the tolerance. By distance, the body is fine where a tool or an eye is near. By time, one body
 * at a time gets a level coarser while steps take longer than they may, and finer where what that would cost fits
 * again. A body gets coarser only where it would have done so with some slack, waits after each change, and after a
 * refused one twice as long as before, so that it does not go to and fro. By error and distance the same state gives
 * the same level, whatever the threads. */
#include <assert.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

#define LOOK_S 0.02        /* simulated, from one look to the next */
#define ERROR_SLACK 2.     /* a body gets coarser where it is bent half as far as would do */
#define DISTANCE_SLACK 0.8 /* a body gets coarser where all are this much further away than would do */
#define LONGEST_WAIT 5     /* doublings */
#define LOOKS 2            /* that have to find the same, by time */
#define UNDER 0.7          /* of the budget: steps that take less are short */
#define FITS 0.8           /* of the budget: what a finer level is expected to take at most */

const char *const spore_lod_cause_names[] = {"none", "error", "distance", "time", NULL};

bool spore_lod_is_automatic(const SporeWorld *world) { return world->levels.automatic_count > 0; }
size_t spore_lod_automatic_count(const SporeWorld *world) { return world->levels.automatic_count; }
bool spore_world_is_repeatable(const SporeWorld *world) { return !world->levels.by_time; }

SporeLodRule spore_world_lod_rule(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  const SporeLod *levels = world->bodies[body].lod;
  return levels ? levels->automation.rule : (SporeLodRule){.by = SPORE_LOD_BY_HAND};
}

bool spore_lod_create_automation(SporeWorld *world, const SporeWorldDescription *description, SporeError *error) {
  SporeLodSystem *system = &world->levels;
  system->look_steps = (uint64_t)fmax(1, round(LOOK_S / world->solver.time_step));
  system->eyes = SPORE_NEW_ARRAY(SporeEyeDescription, description->eye_count);
  if (!system->eyes)
    return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a body's levels"));
  for (size_t i = 0; i < description->eye_count; i++) system->eyes[system->eye_count++] = description->eyes[i];
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (!body->lod || body->lod->automation.rule.by == SPORE_LOD_BY_HAND) continue;
    SporeLodAutomation *automation = &body->lod->automation;
    automation->stays_fine = automation->rule.by != SPORE_LOD_BY_DISTANCE && spore_world_may_be_cut(world, b);
    system->automatic_count++;
    system->by_time |= automation->rule.by == SPORE_LOD_BY_TIME;
  }
  return true;
}

/* Changes of one body. */

static bool follows(const SporeBody *body, SporeLodCause by) {
  return body->lod && body->lod->automation.rule.by == by && spore_body_moves(body) && !body->altered;
}

static bool may_change(const SporeWorld *world, const SporeBody *body) {
  return world->state.step >= body->lod->automation.not_before;
}

/* Steps of the wait, doubled so many times. */
static uint64_t wait_steps(const SporeWorld *world, const SporeBody *body, uint32_t doublings) {
  double steps = ceil(body->lod->automation.rule.wait_s / world->solver.time_step);
  return (uint64_t)fmax(steps, 1) << (doublings < LONGEST_WAIT ? doublings : LONGEST_WAIT);
}

/* The next level that the body has below or above its own; its own where there is none. */
static SporeLodGrade next_level(const SporeBody *body, int direction) {
  for (int k = (int)body->grade + direction; k >= 0 && k < SPORE_LOD_COUNT; k += direction)
    if (body->lod->level[k].model) return (SporeLodGrade)k;
  return body->grade;
}

/* Whether the body has changed. A refused change is tried again later. */
static bool change(SporeWorld *world, uint32_t index, SporeLodGrade to, double figure) {
  const SporeBody *body = &world->bodies[index];
  SporeLodAutomation *automation = &body->lod->automation;
  char reason[300];
  bool changed = spore_world_try_lod(world, index, to, automation->rule.by, figure, reason, sizeof reason);
  automation->refusals = changed ? 0 : automation->refusals + 1;
  automation->not_before = world->state.step + wait_steps(world, body, automation->refusals);
  return changed;
}

/* Gets finer at once. */
static void refine(SporeWorld *world, uint32_t index, SporeLodGrade to, double figure) {
  const SporeBody *body = &world->bodies[index];
  SporeLodAutomation *automation = &body->lod->automation;
  automation->calm_steps = 0;
  if (!may_change(world, body) || !change(world, index, to, figure)) return;
  bool soon = world->state.step < automation->coarser_step + wait_steps(world, body, LONGEST_WAIT);
  automation->returns = soon && automation->coarser_step > 0 ? automation->returns + 1 : 0;
}

/* Gets coarser by one level where that would have done for as long as the wait; for longer, where the body came back
 * soon the last time: so what swings stays as fine as its furthest point needs. */
static void coarsen(SporeWorld *world, uint32_t index, SporeLodGrade to, double figure) {
  const SporeBody *body = &world->bodies[index];
  SporeLodAutomation *automation = &body->lod->automation;
  automation->calm_steps += world->levels.look_steps;
  if (!may_change(world, body) || automation->calm_steps < wait_steps(world, body, automation->returns)) return;
  if (change(world, index, to, figure)) automation->coarser_step = world->state.step;
}

/* By error. */

static SporeLodGrade coarsest_within(const SporeLod *levels, double bent) {
  for (int k = 0; k < SPORE_LOD_FINE; k++)
    if (levels->level[k].model && spore_lod_estimate(levels, (SporeLodGrade)k, bent) <= levels->tolerance)
      return (SporeLodGrade)k;
  return SPORE_LOD_FINE;
}

static void adapt_by_error(SporeWorld *world, uint32_t index) {
  const SporeBody *body = &world->bodies[index];
  SporeLod *levels = body->lod;
  double bent = spore_lod_bent(world, body);
  SporeLodGrade needed = coarsest_within(levels, bent), to = next_level(body, -1);
  if (needed > body->grade) refine(world, index, needed, spore_lod_estimate(levels, body->grade, bent));
  else if (coarsest_within(levels, ERROR_SLACK * bent) >= body->grade) levels->automation.calm_steps = 0;
  else if (!levels->automation.stays_fine) coarsen(world, index, to, spore_lod_estimate(levels, to, bent));
}

/* By distance. */

/* Points of a body: its spheres, or else its nodes, or else the origin of its frame. */
typedef struct Points {
  const double *at, *radius; /* radius NULL: 0 */
  size_t count;
} Points;

static Points points_of(const SporeWorld *world, uint32_t index) {
  const SporeBody *body = &world->bodies[index];
  const SporeSpheres *spheres = &world->contact.spheres;
  size_t start = body->collision.start, count = body->collision.spheres.point_count;
  if (count > 0 && world->contact.grid) return (Points){spheres->centre + 3 * start, spheres->radius + start, count};
  return (Points){world->state.q + body->q_offset, NULL, body->model ? body->model->node_count : 1};
}

/* Distance of a point from the nearest of the points; `most` where it is further. */
static double nearest(const Points *points, SporeVec3 from, double most) {
  for (size_t i = 0; i < points->count; i++) {
    double apart = spore_vec3_distance(spore_vec3_load(points->at + 3 * i), from);
    most = fmin(most, apart - (points->radius ? points->radius[i] : 0));
  }
  return most;
}

static SporeVec3 eye_point(const SporeWorld *world, const SporeEyeDescription *eye) {
  if (eye->body == SPORE_NO_BODY) return eye->point;
  const SporeBody *body = &world->bodies[eye->body];
  if (body->model && !spore_model_is_rigid(body->model)) return eye->point;
  const double *q = world->state.q + body->q_offset;
  SporePose now = spore_pose_load(q);
  return spore_pose_apply(now, spore_pose_apply_inverse(body->rest_pose, eye->point));
}

static double nearest_tool(const SporeWorld *world, const Points *points) {
  double least = HUGE_VAL;
  for (uint32_t b = 0; b < world->body_count; b++) {
    if (world->bodies[b].role != SPORE_ACTIVE) continue;
    Points tool = points_of(world, b);
    for (size_t i = 0; i < tool.count; i++) {
      double radius = tool.radius ? tool.radius[i] : 0;
      least = fmin(least, nearest(points, spore_vec3_load(tool.at + 3 * i), least + radius) - radius);
    }
  }
  return least;
}

static double nearest_eye(const SporeWorld *world, const Points *points) {
  double least = HUGE_VAL;
  for (size_t i = 0; i < world->levels.eye_count; i++)
    least = fmin(least, nearest(points, eye_point(world, &world->levels.eyes[i]), least));
  return least;
}

/* How near it is: 1 where the body is to be fine; *figure: the distance, m. */
static double nearness(const SporeWorld *world, uint32_t index, double *figure) {
  const SporeLodRule *rule = &world->bodies[index].lod->automation.rule;
  const Points points = points_of(world, index);
  double tool = rule->tool_distance > 0 ? nearest_tool(world, &points) : HUGE_VAL;
  double eye = rule->view_distance > 0 ? nearest_eye(world, &points) : HUGE_VAL;
  double by_tool = tool > 0 ? rule->tool_distance / tool : HUGE_VAL;
  double by_eye = eye > 0 ? rule->view_distance / eye : HUGE_VAL;
  *figure = by_tool >= by_eye ? tool : eye;
  return fmax(by_tool, by_eye);
}

static SporeLodGrade level_for(const SporeLod *levels, double near) {
  for (int k = near >= 1 ? SPORE_LOD_FINE : near >= 0.5 ? SPORE_LOD_MEDIUM : SPORE_LOD_COARSE; k < SPORE_LOD_FINE; k++)
    if (levels->level[k].model) return (SporeLodGrade)k;
  return SPORE_LOD_FINE;
}

static void adapt_by_distance(SporeWorld *world, uint32_t index) {
  const SporeBody *body = &world->bodies[index];
  double figure, near = nearness(world, index, &figure);
  SporeLodGrade needed = level_for(body->lod, near);
  if (needed > body->grade) refine(world, index, needed, figure);
  else if (level_for(body->lod, near / DISTANCE_SLACK) >= body->grade) body->lod->automation.calm_steps = 0;
  else coarsen(world, index, next_level(body, -1), figure);
}

/* By time. */

static double budget_us(const SporeWorld *world) {
  return world->schedule.budget_us > 0 ? world->schedule.budget_us : 1e6 * world->solver.time_step;
}

/* The body that gets coarser next: that with the most blocks. */
static uint32_t largest_body(const SporeWorld *world) {
  uint32_t chosen = SPORE_NO_BODY;
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (!follows(body, SPORE_LOD_BY_TIME) || !may_change(world, body)) continue;
    if (body->lod->automation.stays_fine || next_level(body, -1) == body->grade) continue;
    if (chosen == SPORE_NO_BODY || body->block_count > world->bodies[chosen].block_count) chosen = b;
  }
  return chosen;
}

/* The body that gets finer next: that which costs the least of those that fit. */
static uint32_t cheapest_body(const SporeWorld *world, double step_us) {
  uint32_t chosen = SPORE_NO_BODY;
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (!follows(body, SPORE_LOD_BY_TIME) || !may_change(world, body) || next_level(body, 1) == body->grade) continue;
    double cost_us = body->lod->automation.saved_us;
    if (step_us + cost_us > FITS * budget_us(world)) continue;
    if (chosen == SPORE_NO_BODY || cost_us < world->bodies[chosen].lod->automation.saved_us) chosen = b;
  }
  return chosen;
}

/* Learns what the last change to a coarser level saved. */
static void learn(SporeWorld *world, double step_us) {
  SporeLodClock *clock = &world->levels.clock;
  if (clock->changed_body == SPORE_NO_BODY) return;
  world->bodies[clock->changed_body].lod->automation.saved_us = fmax(clock->before_us - step_us, 0);
  clock->changed_body = SPORE_NO_BODY;
}

static void adapt_by_time(SporeWorld *world) {
  SporeLodClock *clock = &world->levels.clock;
  if (clock->steps == 0) return;
  double step_us = clock->sum_us / clock->steps;
  clock->sum_us = 0;
  clock->steps = 0;
  learn(world, step_us);
  clock->over = step_us > budget_us(world) ? clock->over + 1 : 0;
  clock->under = step_us < UNDER * budget_us(world) ? clock->under + 1 : 0;
  uint32_t body = clock->over >= LOOKS    ? largest_body(world)
                  : clock->under >= LOOKS ? cheapest_body(world, step_us)
                                          : SPORE_NO_BODY;
  if (body == SPORE_NO_BODY) return;
  bool coarser = clock->over >= LOOKS;
  clock->over = clock->under = 0;
  if (!change(world, body, next_level(&world->bodies[body], coarser ? -1 : 1), step_us)) return;
  clock->skip = true;
  if (!coarser) return;
  clock->changed_body = body;
  clock->before_us = step_us;
}

/* Counts the step before, unless a level changed in that step: the change itself took time. */
static void count_step(SporeWorld *world) {
  SporeLodClock *clock = &world->levels.clock;
  if (!clock->skip) {
    clock->sum_us += world->schedule.step_us;
    clock->steps++;
  }
  clock->skip = false;
}

void spore_world_adapt_levels(SporeWorld *world) {
  SporeLodSystem *system = &world->levels;
  if (system->by_time && world->state.step > 0) count_step(world);
  if (world->state.step % system->look_steps != 0) return;
  for (uint32_t b = 0; b < world->body_count; b++) {
    if (follows(&world->bodies[b], SPORE_LOD_BY_ERROR)) adapt_by_error(world, b);
    if (follows(&world->bodies[b], SPORE_LOD_BY_DISTANCE)) adapt_by_distance(world, b);
  }
  if (system->by_time) adapt_by_time(world);
}
