/* A fluid as an effect: drops that fall, lie on what they meet, and pool.
 *
 * Drops feel no force of each other, so that nothing limits their step. Two of them that are too near are put apart,
 * and their motion towards each other ends; a drop that has come into a sphere of another body is put out of it, and
 * slides on it within the cone of friction (M. Müller, B. Heidelberger, M. Hennix, J. Ratcliff, "Position based
 * dynamics", 2006, with velocities of their own, so that what is put apart is not thrown apart). Other bodies are only
 * read. What lies so in a hollow is a heap without friction, which is level: see DENSE for its volume.
 *
 * Short steps move the drops once in SPORE_POUR_PACE_S. Which steps do is told by their number, so that a run can be
 * repeated to the bit. Drops that lie still sleep: see settle.c. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/effect/drops.h"
#include "core/sim/world_private.h"

#define ROUNDS 2  /* of putting apart and putting out, each time */
#define NEAR 1.15 /* of the distance below: in a round drops come nearer by less */
/* Distance of drops that lie on each other, in widths of a drop. A drop is as wide as the sigma of the fluid, which has
 * 0.8442 particles in a cube of that side. Loosely heaped spheres fill 0.6 of space, so that they take up the fluid's
 * volume at a distance d with pi/6 d^3 / 0.6 = 1 / 0.8442. */
#define DENSE 1.107
#define PAIRS 12      /* room for so many a drop; where they lie side by side there are up to 6 */
#define PUT_APART 0.5 /* of what is missing to that distance, in a round */
#define CLING 30.     /* 1/s: rate at which drops that touch take on each other's speed */

/* Which drops are near each other. They lie in cubes that a table finds. */

static void find_cube(const double *at, double side, int32_t *cube) {
  for (int k = 0; k < 3; k++) cube[k] = (int32_t)fmax(fmin(floor(at[k] / side), 1e9), -1e9);
}

/* Share of the cube's slot along an axis. */
static uint32_t share_of(int32_t place, int axis) {
  static const uint32_t primes[3] = {73856093u, 19349663u, 83492791u};
  return (uint32_t)place * primes[axis];
}

static uint32_t slot_of(const SporeDrops *drops, uint32_t x, uint32_t y, uint32_t z) {
  uint32_t hash = x ^ y ^ z;
  return (hash ^ hash >> 15) & drops->mask;
}

/* Drops out of the world are in no cube. */
static void fill_cubes(SporeDrops *drops, const double *q, size_t count, double side) {
  memset(drops->first, 0xff, (drops->mask + (size_t)1) * sizeof *drops->first);
  for (size_t i = count; i-- > 0;) {
    int32_t cube[3];
    if (spore_particle_is_out(q + 3 * i)) continue;
    find_cube(q + 3 * i, side, cube);
    uint32_t slot = slot_of(drops, share_of(cube[0], 0), share_of(cube[1], 1), share_of(cube[2], 2));
    drops->next[i] = drops->first[slot];
    drops->first[slot] = (uint32_t)i;
  }
}

/* Those of the list that begins with `j`; without room they have to wait. */
static void add_near(SporeDrops *drops, const double *q, uint32_t i, uint32_t j, double side) {
  const double *a = q + 3 * (size_t)i;
  for (; j != SPORE_NO_DROP; j = drops->next[j]) {
    const double *b = q + 3 * (size_t)j;
    double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    if (x * x + y * y + z * z < side * side && j != i && drops->pair_count < drops->pair_room)
      drops->pairs[drops->pair_count++] = (SporePair){i, j};
  }
}

/* Of the cubes around a cube, as shares of -1, 0 and 1 along each axis, the half that comes after it. */
static void add_beside(SporeDrops *drops, const double *q, uint32_t i, const int32_t *cube, double side) {
  uint32_t shares[3][3];
  for (int axis = 0; axis < 3; axis++)
    for (int k = 0; k < 3; k++) shares[axis][k] = share_of(cube[axis] + k - 1, axis);
  for (int k = 14; k < 27; k++) {
    uint32_t first = drops->first[slot_of(drops, shares[0][k / 9], shares[1][k / 3 % 3], shares[2][k % 3])];
    if (first != SPORE_NO_DROP) add_near(drops, q, i, first, side);
  }
}

/* Pairs of drops that are nearer than the side. */
static void find_near(SporeDrops *drops, const double *q, size_t count, double side) {
  fill_cubes(drops, q, count, side);
  drops->pair_count = 0;
  for (uint32_t i = 0; i < count; i++) {
    int32_t cube[3];
    if (spore_particle_is_out(q + 3 * (size_t)i)) continue;
    find_cube(q + 3 * (size_t)i, side, cube);
    add_near(drops, q, i, drops->next[i], side);
    add_beside(drops, q, i, cube, side);
  }
}

/* Drops. */

typedef struct Pour {
  const SporeWorld *world;
  SporeBody *body;
  double *q, *v;  /* of the body, in the next state */
  double piece_s; /* s */
  double distance, cling;
} Pour;

static void part(const Pour *pour, SporePair pair) {
  double *a = pour->q + 3 * (size_t)pair.a, *b = pour->q + 3 * (size_t)pair.b;
  SporeVec3 apart = spore_vec3_sub(spore_vec3_load(a), spore_vec3_load(b));
  double square = spore_vec3_dot(apart, apart);
  if (!(square < pour->distance * pour->distance)) return;
  double *va = pour->v + 3 * (size_t)pair.a, *vb = pour->v + 3 * (size_t)pair.b;
  SporeVec3 normal = spore_vec3_normalise(apart, (SporeVec3){0.6, 0, 0.8}); /* of two in one place */
  double push = 0.5 * PUT_APART * (pour->distance - sqrt(square));
  SporeVec3 speed = spore_vec3_sub(spore_vec3_load(va), spore_vec3_load(vb));
  double nearing = fmin(spore_vec3_dot(speed, normal), 0);
  SporeVec3 lost = spore_vec3_scale(pour->cling, speed);
  lost = spore_vec3_add_scaled(lost, (1 - pour->cling) * nearing, normal);
  spore_vec3_store(a, spore_vec3_add_scaled(spore_vec3_load(a), push, normal));
  spore_vec3_store(b, spore_vec3_add_scaled(spore_vec3_load(b), -push, normal));
  spore_vec3_store(va, spore_vec3_add_scaled(spore_vec3_load(va), -0.5, lost));
  spore_vec3_store(vb, spore_vec3_add_scaled(spore_vec3_load(vb), 0.5, lost));
}

/* How far the sphere goes in this step. */
static SporeVec3 way_of(const SporeWorld *world, uint32_t sphere, SporeVec3 centre) {
  const SporeBody *body = &world->bodies[world->contact.spheres.body[sphere]];
  if (body->role == SPORE_ACTIVE)
    return spore_vec3_scale(world->solver.time_step,
                            spore_vec3_load(world->contact.spheres.velocity + 3 * (size_t)sphere));
  if (!spore_body_moves(body)) return (SporeVec3){0, 0, 0};
  return spore_vec3_sub(spore_mapping_position(&body->collision.spheres, sphere - body->collision.start,
                                               world->state.next_q + body->q_offset),
                        centre);
}

/* Takes up to `most` off the length of x. */
static SporeVec3 shorten(SporeVec3 x, double most) {
  double length = spore_vec3_length(x);
  return spore_vec3_scale(length > most ? 1 - most / length : 0, x);
}

static SporeVec3 along(SporeVec3 x, SporeVec3 normal) {
  return spore_vec3_add_scaled(x, -spore_vec3_dot(x, normal), normal);
}

/* Puts drop i out of the sphere. gone: part of the step that has passed. */
static void put_out(const Pour *pour, size_t i, uint32_t sphere, double gone) {
  const SporeWorld *world = pour->world;
  const SporeSpheres *spheres = &world->contact.spheres;
  SporeVec3 centre = spore_vec3_load(spheres->centre + 3 * (size_t)sphere), way = way_of(world, sphere, centre);
  SporeVec3 at = spore_vec3_load(pour->q + 3 * i);
  SporeVec3 apart = spore_vec3_sub(at, spore_vec3_add_scaled(centre, gone, way));
  double reach = spheres->radius[sphere] + spheres->radius[pour->body->collision.start + i],
         square = spore_vec3_dot(apart, apart);
  if (!(square < reach * reach)) return;
  SporeVec3 normal = spore_vec3_normalise(apart, (SporeVec3){0, 1, 0});
  double push = reach - sqrt(square), friction = fmin(pour->body->collision.fields.friction,
                                                      world->bodies[spheres->body[sphere]].collision.fields.friction);
  SporeVec3 speed = spore_vec3_scale(1 / world->solver.time_step, way);
  SporeVec3 slip = spore_vec3_sub(at, spore_vec3_load(pour->body->effect.drops.from + 3 * i));
  slip = along(spore_vec3_add_scaled(slip, -pour->piece_s, speed), normal);
  at = spore_vec3_add_scaled(spore_vec3_sub(at, spore_vec3_sub(slip, shorten(slip, friction * push))), push, normal);
  spore_vec3_store(pour->q + 3 * i, at);
  SporeVec3 against = spore_vec3_sub(spore_vec3_load(pour->v + 3 * i), speed);
  double leaving = spore_vec3_dot(against, normal);
  against = shorten(along(against, normal), friction * fmax(-leaving, 0));
  against = spore_vec3_add_scaled(against, fmax(leaving, 0), normal);
  spore_vec3_store(pour->v + 3 * i, spore_vec3_add(speed, against));
}

static void put_drops_out(const Pour *pour, double gone) {
  const SporePair *pairs;
  size_t start = pour->body->collision.start, end = start + pour->body->block_count;
  size_t count = pour->body->effect.drops.meet && pour->world->contact.grid
                     ? spore_grid_apart(pour->world->contact.grid, &pairs)
                     : 0;
  for (size_t k = 0; k < count; k++) {
    if (pairs[k].a >= start && pairs[k].a < end) put_out(pour, pairs[k].a - start, pairs[k].b, gone);
    else if (pairs[k].b >= start && pairs[k].b < end) put_out(pour, pairs[k].b - start, pairs[k].a, gone);
  }
}

static void pour_piece(const Pour *pour, double gone) {
  SporeBody *body = pour->body;
  SporeDrops *drops = &body->effect.drops;
  memcpy(drops->from, pour->q, 3 * body->block_count * sizeof *drops->from);
  body->model->type->particles->carry(body->model, spore_body_gravity(pour->world, body), pour->piece_s, pour->q,
                                      pour->v, pour->q, pour->v);
  find_near(drops, pour->q, body->block_count, NEAR * pour->distance);
  for (int k = 0; k < ROUNDS; k++) {
    for (size_t i = 0; i < drops->pair_count; i++) part(pour, drops->pairs[i]);
    put_drops_out(pour, gone);
  }
}

static void keep_held(SporeWorld *world, const SporeBody *body) {
  const double *q = world->state.q + body->q_offset;
  double *next_q = world->state.next_q + body->q_offset, *next_v = world->state.next_v + body->v_offset;
  for (size_t i = 0; i < body->held.count; i++) {
    size_t at = 3 * body->held.blocks[i];
    memcpy(next_q + at, q + at, 3 * sizeof *q);
    memset(next_v + at, 0, 3 * sizeof *next_v);
  }
}

void spore_body_pour(SporeWorld *world, SporeBody *body) {
  assert(body->model->type->particles);
  Pour pour = {world, body, world->state.next_q + body->q_offset, world->state.next_v + body->v_offset};
  memcpy(pour.q, world->state.q + body->q_offset, body->q_count * sizeof *pour.q);
  memcpy(pour.v, world->state.v + body->v_offset, 3 * body->block_count * sizeof *pour.v);
  double time_s = spore_body_pour_time(world, body), pieces = ceil(time_s / SPORE_POUR_PACE_S * (1 - 1e-9));
  if (!(time_s > 0)) return;
  pour.piece_s = time_s / pieces;
  pour.distance = 2 * DENSE * body->effect.drops.radius;
  pour.cling = -expm1(-CLING * pour.piece_s);
  for (double k = 1; k <= pieces; k++) pour_piece(&pour, k / pieces);
  keep_held(world, body);
}

/* Making. */

static bool make_tables(SporeDrops *drops, size_t count) {
  size_t slots = 1;
  while (slots < 2 * count) slots *= 2;
  drops->mask = (uint32_t)(slots - 1);
  drops->first = SPORE_NEW_ARRAY(uint32_t, slots);
  drops->next = SPORE_NEW_ARRAY(uint32_t, count);
  drops->pair_room = PAIRS * count;
  drops->pairs = SPORE_NEW_ARRAY(SporePair, drops->pair_room);
  drops->from = SPORE_NEW_ARRAY(double, 3 * count);
  return drops->first && drops->next && drops->pairs && drops->from;
}

bool spore_body_make_drops(SporeBody *body, SporeError *error) {
  SporeDrops *drops = &body->effect.drops;
  SporeSphereSet set;
  if (!body->model->type->spheres(body->model, &set, error)) return false;
  drops->radius = set.spheres[3];
  spore_sphere_set_clear(&set);
  drops->meet = body->collision.spheres.kind == SPORE_MAPPING_IDENTITY &&
                body->collision.spheres.point_count == body->block_count;
  return make_tables(drops, body->block_count) ||
         spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the world"));
}

void spore_body_clear_effect(SporeBody *body) {
  spore_free(body->effect.drops.first);
  spore_free(body->effect.drops.next);
  spore_free(body->effect.drops.pairs);
  spore_free(body->effect.drops.from);
  spore_drops_clear_rest(&body->effect.drops.rest);
}
