/* Drops that lie still sleep: they are not moved, and what is near them is not looked for among what lies still, too.
 *
 * Single drops of a pool never rest, since each step puts them apart anew. So a pool counts as still by how far its
 * drops have come in WINDOW_S: in WINDOWS windows, one after the other, none as far as STILL. What is lost is at most
 * that way in a window.
 *
 * They wake all together: when a sphere that moves comes to them that was not there, when one that they lie on has gone
 * BUDGED from where it was, however slowly, when a drop goes or comes, and when a command or an edit may have changed
 * the forces on them. Drops are not poured in the step in which they wake, since what they lie on is found from the
 * next one on. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/sim/effect/drops.h"
#include "core/sim/world_private.h"

#define WINDOW_S 0.25
#define WINDOWS 2
#define STILL 0.15  /* radii of a drop */
#define BUDGED 0.05 /* radii of a drop */

bool spore_drops_make_rest(SporeWorld *world, SporeBody *body) {
  SporeDropRest *rest = &body->effect.drops.rest;
  rest->room = world->contact.spheres.count;
  rest->from = SPORE_NEW_ARRAY(double, 3 * body->block_count);
  rest->near = SPORE_NEW_ARRAY(uint32_t, rest->room);
  rest->near_at = SPORE_NEW_ARRAY(double, 3 * rest->room);
  rest->is_near = SPORE_NEW_ARRAY(uint8_t, rest->room);
  return rest->from && rest->near && rest->near_at && rest->is_near;
}

void spore_drops_clear_rest(SporeDropRest *rest) {
  spore_free(rest->from);
  spore_free(rest->near);
  spore_free(rest->near_at);
  spore_free(rest->is_near);
}

/* The sphere of the pair that is not of the drops; UINT32_MAX: neither is of them. */
static uint32_t other_of(const SporeBody *body, const SporePair *pair) {
  size_t start = body->collision.start, end = start + body->collision.spheres.point_count;
  if (pair->a >= start && pair->a < end) return pair->b;
  return pair->b >= start && pair->b < end ? pair->a : UINT32_MAX;
}

static SporeVec3 place_of(const SporeWorld *world, uint32_t sphere) {
  return spore_vec3_load(world->contact.spheres.centre + 3 * (size_t)sphere);
}

/* Notes the spheres near the drops that may move. */
static void note_near(SporeWorld *world, SporeBody *body) {
  SporeDropRest *rest = &body->effect.drops.rest;
  const SporePair *pairs;
  size_t count = spore_grid_apart(world->contact.grid, &pairs);
  for (size_t i = 0; i < count; i++) {
    uint32_t other = other_of(body, &pairs[i]);
    if (other == UINT32_MAX || rest->is_near[other]) continue;
    rest->is_near[other] = 1;
    spore_vec3_store(rest->near_at + 3 * rest->near_count, place_of(world, other));
    rest->near[rest->near_count++] = other;
  }
  rest->noted = true;
}

static bool is_disturbed(const SporeWorld *world, const SporeBody *body) {
  const SporeDropRest *rest = &body->effect.drops.rest;
  const SporePair *pairs;
  size_t count = spore_grid_apart(world->contact.grid, &pairs);
  for (size_t i = 0; i < count; i++) {
    uint32_t other = other_of(body, &pairs[i]);
    if (other != UINT32_MAX && !rest->is_near[other]) return true;
  }
  double most = BUDGED * body->effect.drops.radius;
  for (size_t i = 0; i < rest->near_count; i++)
    if (!(spore_vec3_distance(place_of(world, rest->near[i]), spore_vec3_load(rest->near_at + 3 * i)) <= most))
      return true;
  return false;
}

void spore_drops_wake(SporeWorld *world, SporeBody *body) {
  SporeDropRest *rest = &body->effect.drops.rest;
  if (!body->effect.drops.from) return;
  for (size_t i = 0; i < rest->near_count; i++) rest->is_near[rest->near[i]] = 0;
  rest->near_count = 0;
  rest->noted = rest->begun = body->effect.settled = false;
  if (!rest->asleep) return;
  rest->asleep = false;
  spore_grid_set_asleep(world->contact.grid, (uint32_t)(body - world->bodies), false);
}

/* They have just woken: particles may be taken and put in this step. */
static void stay_once(SporeWorld *world, SporeBody *body) {
  spore_drops_wake(world, body);
  memcpy(world->state.next_q + body->q_offset, world->state.q + body->q_offset, body->q_count * sizeof(double));
  memcpy(world->state.next_v + body->v_offset, world->state.v + body->v_offset, 3 * body->block_count * sizeof(double));
  spore_body_mark_changed(world, body);
}

bool spore_drops_stay(SporeWorld *world, SporeBody *body) {
  SporeDropRest *rest = &body->effect.drops.rest;
  if (!rest->asleep) return false;
  if (!body->effect.settled) stay_once(world, body);
  else if (!rest->noted) note_near(world, body);
  else if (is_disturbed(world, body)) stay_once(world, body);
  return true;
}

static void begin_window(SporeWorld *world, SporeBody *body) {
  SporeDropRest *rest = &body->effect.drops.rest;
  memcpy(rest->from, world->state.next_q + body->q_offset, 3 * body->block_count * sizeof *rest->from);
  rest->step = world->state.step;
  rest->held = body->held.count;
  rest->begun = true;
}

/* How far any of the drops has come in the window, m. */
static double way_in_window(const SporeWorld *world, const SporeBody *body) {
  const double *q = world->state.next_q + body->q_offset, *from = body->effect.drops.rest.from;
  double most = 0;
  for (size_t i = 0; i < body->block_count; i++)
    if (!spore_particle_is_out(q + 3 * i))
      most = fmax(most, spore_vec3_distance(spore_vec3_load(q + 3 * i), spore_vec3_load(from + 3 * i)));
  return most;
}

static void fall_asleep(SporeWorld *world, SporeBody *body) {
  SporeDropRest *rest = &body->effect.drops.rest;
  memset(world->state.next_v + body->v_offset, 0, 3 * body->block_count * sizeof(double));
  rest->asleep = body->effect.settled = true;
  rest->windows = 0;
  spore_grid_set_asleep(world->contact.grid, (uint32_t)(body - world->bodies), true);
}

void spore_drops_watch(SporeWorld *world, SporeBody *body) {
  SporeDropRest *rest = &body->effect.drops.rest;
  if (!(world->solver.sleep_speed > 0) || !body->effect.drops.meet || !world->contact.grid) return;
  if (!rest->begun || rest->held != body->held.count) {
    rest->windows = 0;
    begin_window(world, body);
    return;
  }
  if ((double)(world->state.step - rest->step) * world->solver.time_step < WINDOW_S * (1 - 1e-9)) return;
  bool still = way_in_window(world, body) < STILL * body->effect.drops.radius;
  rest->windows = still ? rest->windows + 1 : 0;
  begin_window(world, body);
  if (rest->windows >= WINDOWS) fall_asleep(world, body);
}
