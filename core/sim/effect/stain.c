/* Stains: what drops lie on takes on their colour, and what water runs over loses it.
 *
 * Spheres may be far larger than drops. So places are laid on them, about as far from each other as a drop is wide, and
 * those inside another sphere of the body are left out. A place that a drop covers takes on the fluid's colour at the
 * fluid's rate, or loses it: both are exact for any step in which the drops stay where they are.
 *
 * Stains are looked at once in STAIN_PACE_S: nobody sees more, and what stains moves no farther than a drop is wide
 * meanwhile. Which steps do is told by their number, so that a run can be repeated to the bit. */
#include "core/sim/effect/stain.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/collide/near_pairs.h"
#include "core/sim/world_private.h"

#define STAIN_PACE_S 16e-3
#define TOUCH 1.3   /* radii of the drop: nearer to a sphere it wets the sphere, though warmth lifts it now and then */
#define SPACING 1.6 /* of places, in radii of the smallest drop */
#define REACH 1.8   /* radii of the drop: how far from its middle it wets a place */
#define INSIDE 0.99 /* radii of another sphere: a place nearer to its middle is not on the surface */
/* Places that are tried on a sphere, and on a body. Where they do not suffice, they lie farther apart. */
#define SPHERE_MOST 2000
#define BODY_MOST 300000
#define GOLDEN_ANGLE 2.399963229728653

/* Places. */

/* Place k of n on a sphere, evenly: along a spiral from pole to pole. */
static SporeVec3 on_sphere(const double *sphere, size_t k, size_t n) {
  double height = 1 - (2 * (double)k + 1) / (double)n, round = sqrt(1 - height * height);
  double turn = GOLDEN_ANGLE * (double)k;
  SporeVec3 direction = {round * cos(turn), height, round * sin(turn)};
  return spore_vec3_add_scaled(spore_vec3_load(sphere), sphere[3], direction);
}

static size_t tries_on(const double *sphere, double spacing) {
  double area = 12.566370614359172 * sphere[3] * sphere[3];
  return (size_t)fmax(1, fmin(SPHERE_MOST, ceil(area / (spacing * spacing))));
}

static double wide_enough(const SporeSphereSet *set, double spacing) {
  double tries = 0;
  for (size_t i = 0; i < set->count; i++) tries += (double)tries_on(set->spheres + 4 * i, spacing);
  return spacing * sqrt(fmax(1, tries / BODY_MOST));
}

/* The spheres that each sphere meets. */
typedef struct Beside {
  uint32_t *start; /* one a sphere, and one more */
  uint32_t *other; /* of sphere i from start[i] to before start[i + 1]; NULL while the others are counted */
} Beside;

static bool add_beside(void *data, uint32_t a, uint32_t b) {
  const Beside *beside = data;
  if (beside->other) beside->other[beside->start[a]++] = b, beside->other[beside->start[b]++] = a;
  else beside->start[a]++, beside->start[b]++;
  return true;
}

/* Where each sphere's others begin, from how many it has. The sum. */
static size_t begin_each(uint32_t *start, size_t count) {
  size_t sum = 0;
  for (size_t i = 0; i < count; i++) {
    size_t own = start[i];
    start[i] = (uint32_t)sum;
    sum += own;
  }
  return sum;
}

/* Counts the others first, and then notes which they are. */
static bool fill_beside(Beside *beside, const double *centre, const double *radius, size_t count) {
  if (!spore_near_pairs(centre, radius, count, 1, 0, add_beside, beside)) return false;
  beside->other = SPORE_NEW_ARRAY(uint32_t, begin_each(beside->start, count));
  if (!beside->other || !spore_near_pairs(centre, radius, count, 1, 0, add_beside, beside)) return false;
  memmove(beside->start + 1, beside->start, count * sizeof *beside->start); /* each has come to the next one's start */
  beside->start[0] = 0;
  return true;
}

static bool find_beside(Beside *beside, const SporeSphereSet *set) {
  double *centre = SPORE_NEW_ARRAY(double, 3 * set->count), *radius = SPORE_NEW_ARRAY(double, set->count);
  beside->start = SPORE_NEW_ARRAY(uint32_t, set->count + 1);
  bool room = centre && radius && beside->start;
  for (size_t i = 0; room && i < set->count; i++) {
    memcpy(centre + 3 * i, set->spheres + 4 * i, 3 * sizeof *centre);
    radius[i] = set->spheres[4 * i + 3];
  }
  bool found = room && fill_beside(beside, centre, radius, set->count);
  spore_free(centre);
  spore_free(radius);
  return found;
}

static bool is_inside(const SporeSphereSet *set, const Beside *beside, size_t i, SporeVec3 place) {
  for (uint32_t k = beside->start[i]; k < beside->start[i + 1]; k++) {
    const double *other = set->spheres + 4 * (size_t)beside->other[k];
    if (spore_vec3_distance(spore_vec3_load(other), place) < INSIDE * other[3]) return true;
  }
  return false;
}

static void keep_place(SporeStainUnit *unit, size_t index, const double *sphere, SporeVec3 place) {
  spore_vec3_store(unit->rest + 3 * index, place);
  for (size_t k = 0; k < 3; k++)
    unit->out[3 * index + k] = (float)((unit->rest[3 * index + k] - sphere[k]) / sphere[3]);
}

/* Lays places on all spheres: counts them, and keeps them where there is room. */
static void lay(SporeStainUnit *unit, const SporeSphereSet *set, double spacing, const Beside *beside) {
  size_t count = 0;
  for (size_t i = 0; i < set->count; i++) {
    const double *sphere = set->spheres + 4 * i;
    size_t n = tries_on(sphere, spacing);
    unit->first[i] = (uint32_t)count;
    for (size_t k = 0; k < n; k++) {
      SporeVec3 place = on_sphere(sphere, k, n);
      if (is_inside(set, beside, i, place)) continue;
      if (unit->rest) keep_place(unit, count, sphere, place);
      count++;
    }
  }
  unit->first[set->count] = (uint32_t)count;
  unit->count = count;
}

static bool lay_places(SporeStainUnit *unit, const SporeSphereSet *set, double spacing) {
  Beside beside = {0};
  unit->first = SPORE_NEW_ARRAY(uint32_t, set->count + 1);
  bool made = unit->first && find_beside(&beside, set);
  if (made) {
    lay(unit, set, spacing, &beside);
    unit->rest = SPORE_NEW_ARRAY(double, 3 * unit->count);
    unit->out = SPORE_NEW_ARRAY(float, 3 * unit->count);
    made = unit->rest && unit->out;
  }
  if (made) lay(unit, set, spacing, &beside);
  spore_free(beside.start);
  spore_free(beside.other);
  return made;
}

/* The middle of the sphere that each place is on, and how the place leans from there. */
static double *find_middles(SporeStainUnit *unit, const SporeSphereSet *set, SporeQuat turn) {
  double *middles = SPORE_NEW_ARRAY(double, 3 * unit->count);
  unit->lean = middles ? SPORE_NEW_ARRAY(double, 3 * unit->count) : NULL;
  for (size_t s = 0; unit->lean && s < set->count; s++)
    for (size_t i = unit->first[s]; i < unit->first[s + 1]; i++) {
      SporeVec3 middle = spore_vec3_load(set->spheres + 4 * s);
      spore_vec3_store(middles + 3 * i, middle);
      SporeVec3 lean = spore_vec3_sub(spore_vec3_load(unit->rest + 3 * i), middle);
      spore_vec3_store(unit->lean + 3 * i, spore_quat_rotate(turn, lean));
    }
  if (unit->lean) return middles;
  spore_free(middles);
  return NULL;
}

/* A line that does not resist twist carries nothing beside its middle: there the spheres carry the places, which stay
 * on the side that they are on. What cannot carry the spheres either is not stained. False: no memory. */
static bool map_places(SporeWorld *world, uint32_t index, SporeStainUnit *unit, const SporeSphereSet *set) {
  SporeError error = SPORE_ERROR_INIT;
  if (spore_body_map(world, index, SPORE_LOD_FINE, unit->rest, unit->count, world->cancel, &unit->mapping, &error))
    return true;
  double *middles = find_middles(unit, set, world->bodies[index].rest_pose.orientation);
  if (!middles) return false;
  error = SPORE_ERROR_INIT;
  if (!spore_body_map(world, index, SPORE_LOD_FINE, middles, unit->count, world->cancel, &unit->mapping, &error))
    unit->count = 0;
  spore_free(middles);
  return true;
}

static SporeVec3 place_now(const SporeWorld *world, const SporeBody *body, const SporeStainUnit *unit, size_t i) {
  SporeVec3 at = spore_mapping_position(&unit->mapping, i, world->state.q + body->q_offset);
  return unit->lean ? spore_vec3_add(at, spore_vec3_load(unit->lean + 3 * i)) : at;
}

static bool make_unit(SporeWorld *world, uint32_t index, const SporeSphereSet *set, double spacing) {
  SporeStainUnit *unit = &world->stains.units[index];
  const SporeBody *body = &world->bodies[index];
  unit->start = world->stains.count;
  if (!set || set->count == 0 || spore_body_is_fluid(body)) return true;
  if (!lay_places(unit, set, wide_enough(set, spacing))) return false;
  if (!map_places(world, index, unit, set)) return false;
  world->stains.count += unit->count;
  return true;
}

/* The radius of the smallest drop; infinite: nothing can be stained. */
static double smallest_drop(const SporeWorld *world) {
  double smallest = INFINITY;
  for (size_t b = 0; world->contact.grid && b < world->body_count; b++) {
    const SporeCollisionUnit *unit = &world->bodies[b].collision;
    if (!spore_body_is_fluid(&world->bodies[b]) || world->bodies[b].model->type->particles->puff) continue;
    for (size_t i = 0; i < unit->spheres.point_count; i++)
      smallest = fmin(smallest, world->contact.spheres.radius[unit->start + i]);
  }
  return smallest;
}

bool spore_world_create_stains(SporeWorld *world, const SporeWorldDescription *description) {
  SporeStains *stains = &world->stains;
  double smallest = smallest_drop(world);
  if (!isfinite(smallest)) return true;
  stains->units = SPORE_NEW_ARRAY(SporeStainUnit, world->body_count);
  if (!stains->units) return false;
  for (uint32_t b = 0; b < world->body_count; b++)
    if (!make_unit(world, b, description->bodies[b].spheres, SPACING * smallest)) return false;
  stains->amount = SPORE_NEW_ARRAY(float, stains->count);
  stains->wet = SPORE_NEW_ARRAY(uint32_t, stains->count);
  stains->wetting = SPORE_NEW_ARRAY(SporeWetting, stains->count);
  return stains->amount && stains->wet && stains->wetting;
}

void spore_world_clear_stains(SporeWorld *world) {
  SporeStains *stains = &world->stains;
  for (size_t b = 0; stains->units && b < world->body_count; b++) {
    spore_free(stains->units[b].rest);
    spore_free(stains->units[b].out);
    spore_free(stains->units[b].first);
    spore_free(stains->units[b].lean);
    spore_mapping_clear(&stains->units[b].mapping);
  }
  spore_free(stains->units);
  spore_free(stains->amount);
  spore_free(stains->wet);
  spore_free(stains->wetting);
}

void spore_world_reset_stains(SporeWorld *world) {
  if (world->stains.number == 0) return;
  memset(world->stains.amount, 0, world->stains.count * sizeof *world->stains.amount);
  world->stains.number++;
}

/* Staining. */

bool spore_world_may_stain(const SporeWorld *world) {
  for (size_t b = 0; world->stains.count > 0 && b < world->body_count; b++)
    if (spore_body_is_fluid(&world->bodies[b]) && world->bodies[b].model->stain != 0) return true;
  return false;
}

/* share: 1 under the drop, less toward the edge of what it wets. */
static void wet_place(SporeStains *stains, size_t place, double rate, double share) {
  SporeWetting *wetting = &stains->wetting[place];
  if (wetting->dyeing == 0 && wetting->washing == 0) stains->wet[stains->wet_count++] = (uint32_t)place;
  if (rate > 0) wetting->dyeing = fmaxf(wetting->dyeing, (float)(rate * share));
  else wetting->washing = fmaxf(wetting->washing, (float)(-rate * share));
}

/* The drop wets places of the sphere, where the two touch. Another level of detail than the finest is not stained. */
static void wet(SporeWorld *world, const SporeBody *fluid, uint32_t drop, uint32_t sphere) {
  const SporeSpheres *spheres = &world->contact.spheres;
  const SporeBody *body = &world->bodies[spheres->body[sphere]];
  const SporeStainUnit *unit = &world->stains.units[spheres->body[sphere]];
  double rate = fluid->model->stain, radius = spheres->radius[drop];
  if (rate == 0 || unit->count == 0 || (body->lod && body->grade != SPORE_LOD_FINE)) return;
  SporeVec3 at = spore_vec3_load(spheres->centre + 3 * (size_t)drop);
  double apart = spore_vec3_distance(at, spore_vec3_load(spheres->centre + 3 * (size_t)sphere));
  if (!(apart < spheres->radius[sphere] + TOUCH * radius)) return;
  size_t local = sphere - body->collision.start;
  for (size_t i = unit->first[local]; i < unit->first[local + 1]; i++) {
    SporeVec3 place = place_now(world, body, unit, i);
    double off = spore_vec3_distance(place, at) / (REACH * radius);
    if (off < 1) wet_place(&world->stains, unit->start + i, rate, fmin(1, 2 * (1 - off)));
  }
}

#define FILM_M 5e-4 /* how thick blood lies that seeps from a wound */

/* What seeped from the mouth has run over its source as far as it would as a film. The places are at rest: the film
 * goes with the tissue. */
static void wet_around(SporeWorld *world, SporeEmitter *emitter) {
  if (!(emitter->seeped > emitter->seen) || emitter->source == SPORE_NO_BODY) return;
  const SporeStainUnit *unit = &world->stains.units[emitter->source];
  double rate = world->bodies[emitter->body].model->stain, radius = sqrt(emitter->seeped / (M_PI * FILM_M));
  emitter->seen = emitter->seeped;
  for (size_t i = 0; i < unit->count; i++) {
    double off = spore_vec3_distance(spore_vec3_load(unit->rest + 3 * i), emitter->rest) / radius;
    if (off < 1) wet_place(&world->stains, unit->start + i, rate, fmin(1, 2 * (1 - off)));
  }
}

static void wet_pair(SporeWorld *world, uint32_t a, uint32_t b) {
  const SporeBody *of_a = &world->bodies[world->contact.spheres.body[a]];
  const SporeBody *of_b = &world->bodies[world->contact.spheres.body[b]];
  if (spore_body_is_fluid(of_a)) wet(world, of_a, a, b);
  else if (spore_body_is_fluid(of_b)) wet(world, of_b, b, a);
}

/* What covers the place dyes it and washes it for time_s. */
static bool take_on(float *amount, const SporeWetting *wetting, float time_s) {
  float before = *amount;
  *amount -= (1 - before) * expm1f(-wetting->dyeing * time_s);
  *amount *= expf(-wetting->washing * time_s);
  return *amount != before;
}

double spore_stain_pace(const SporeWorld *world) {
  double h = world->solver.time_step, pour = fmax(1, round(SPORE_POUR_PACE_S / h)); /* drops move in such steps alone */
  return pour * fmax(1, round(STAIN_PACE_S / (pour * h)));
}

void spore_world_stain(SporeWorld *world) {
  SporeStains *stains = &world->stains;
  double steps = spore_stain_pace(world);
  if (!spore_world_may_stain(world) || world->state.step % (uint64_t)steps != 0) return;
  const SporeContact *contacts = spore_grid_contacts(world->contact.grid);
  const SporePair *pairs;
  size_t pair_count = spore_grid_apart(world->contact.grid, &pairs);
  for (size_t i = 0; i < world->contact.count; i++) wet_pair(world, contacts[i].a, contacts[i].b);
  for (size_t i = 0; i < pair_count; i++) wet_pair(world, pairs[i].a, pairs[i].b);
  for (size_t i = 0; i < world->tools.emitter_count; i++)
    if (world->tools.emitters[i].effect) wet_around(world, &world->tools.emitters[i]);
  bool changed = false;
  for (size_t i = 0; i < stains->wet_count; i++) {
    uint32_t place = stains->wet[i];
    changed |= take_on(&stains->amount[place], &stains->wetting[place], (float)(steps * world->solver.time_step));
    stains->wetting[place] = (SporeWetting){0};
  }
  stains->wet_count = 0;
  stains->number += changed;
}

/* What others see. */

SporeStainPlaces spore_world_stain_places(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  if (!world->stains.units) return (SporeStainPlaces){0};
  const SporeStainUnit *unit = &world->stains.units[body];
  return (SporeStainPlaces){unit->start, unit->count, unit->rest, unit->out, unit->first};
}

double spore_world_stained(const SporeWorld *world, uint32_t body) {
  SporeStainPlaces places = spore_world_stain_places(world, body);
  double sum = 0;
  for (size_t i = 0; i < places.count; i++) sum += (double)world->stains.amount[places.start + i];
  return sum / fmax(1, (double)places.count);
}

void spore_world_carry_stain(SporeWorld *to, uint32_t body, const SporeWorld *from, uint32_t old) {
  SporeStainPlaces there = spore_world_stain_places(to, body), here = spore_world_stain_places(from, old);
  size_t size = 3 * here.count * sizeof *here.rest;
  if (from->stains.number == 0 || here.count == 0 || there.count != here.count) return;
  if (memcmp(there.rest, here.rest, size) != 0) return;
  memcpy(to->stains.amount + there.start, from->stains.amount + here.start, here.count * sizeof(float));
  to->stains.number++;
}
