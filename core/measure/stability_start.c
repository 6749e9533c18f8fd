/* Degenerate starts: bodies that are knocked, pressed flat, shrunk to a point, or put inside one another. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/measure/stability_private.h"

#define KNOCK 1.   /* m/s, and rad/s of a frame times SPIN */
#define SPIN 10.   /* rad/s */
#define FLAT 1e-3  /* of the height */
#define POINT 1e-6 /* of the size */

static bool is_passive(const SporeWorld *world, uint32_t body) {
  return spore_world_body_role(world, body) == SPORE_PASSIVE;
}

/* Whether nodes can be moved apart from one another: neither a rigid body nor particles. */
static bool deforms(const SporeWorld *world, uint32_t body) {
  const SporeModel *model = spore_world_body_model(world, body);
  return is_passive(world, body) && !spore_model_is_rigid(model) && !model->type->rates;
}

/* Where the body's spheres begin, and how many there are. */
static size_t spheres_of(const SporeWorld *world, uint32_t body, size_t *count) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  *count = spore_world_body_sphere_count(world, body);
  for (size_t i = 0; i < spheres->count; i++)
    if (spheres->body[i] == body) return i;
  *count = 0;
  return 0;
}

static bool middle_of(const SporeWorld *world, uint32_t body, SporeVec3 *middle) {
  size_t count, first = spheres_of(world, body, &count);
  *middle = (SporeVec3){0, 0, 0};
  for (size_t i = first; i < first + count; i++)
    *middle = spore_vec3_add(*middle, spore_vec3_load(spore_world_spheres(world)->centre + 3 * i));
  if (count > 0) *middle = spore_vec3_scale(1 / (double)count, *middle);
  return count > 0;
}

/* The body that is moved, and the nearest one that it is moved into. */
static bool find_pair(const SporeWorld *world, uint32_t *moved, SporeVec3 *by) {
  double least = HUGE_VAL;
  SporeVec3 from, to;
  for (uint32_t a = 0; a < spore_world_body_count(world); a++) {
    if (!is_passive(world, a) || spore_world_body_model(world, a)->type->rates || !middle_of(world, a, &from)) continue;
    for (uint32_t b = 0; b < spore_world_body_count(world); b++) {
      if (a == b || !middle_of(world, b, &to)) continue;
      double distance = spore_vec3_distance(from, to);
      if (!(distance < least)) continue;
      least = distance;
      *moved = a;
      *by = spore_vec3_sub(to, from);
    }
  }
  return isfinite(least);
}

bool spore_start_is_possible(const SporeWorld *world, SporePushStart start) {
  uint32_t moved;
  SporeVec3 by;
  if (start == SPORE_START_OVERLAP) return find_pair(world, &moved, &by);
  for (uint32_t b = 0; b < spore_world_body_count(world); b++)
    if (start == SPORE_START_KNOCKED ? is_passive(world, b) : deforms(world, b)) return true;
  return false;
}

/* A copy of the body's state that may be changed. */
typedef struct Start {
  const SporeModel *model;
  double *q, *v;
} Start;

static bool copy_state(const SporeWorld *world, uint32_t body, Start *start) {
  start->model = spore_world_body_model(world, body);
  size_t q = start->model->q_count, v = 3 * start->model->block_count;
  start->q = SPORE_NEW_ARRAY(double, q);
  start->v = SPORE_NEW_ARRAY(double, v);
  if (!start->q || !start->v) {
    spore_free(start->q);
    spore_free(start->v);
    return false;
  }
  memcpy(start->q, spore_world_q(world, body), q * sizeof(double));
  memcpy(start->v, spore_world_v(world, body), v * sizeof(double));
  return true;
}

static void set_state(SporeWorld *world, uint32_t body, Start *start) {
  spore_world_set_state(world, body, start->q, start->v);
  spore_free(start->q);
  spore_free(start->v);
}

static void knock(Start *start, uint32_t *random) {
  for (size_t k = 0; k < 3 * start->model->block_count; k++) {
    *random = *random * 1664525u + 1013904223u;
    double part = 2 * (double)(*random >> 8) / (1 << 24) - 1;
    bool node = k / 3 < start->model->node_count;
    if (start->model->type->rates && spore_particle_is_out(start->q + 3 * (k / 3))) continue;
    start->v[k] += part * (node ? KNOCK : SPIN);
  }
}

static void squeeze(Start *start, SporeVec3 scale) {
  size_t count = start->model->node_count;
  SporeVec3 middle = {0, 0, 0};
  for (size_t i = 0; i < count; i++) middle = spore_vec3_add(middle, spore_vec3_load(start->q + 3 * i));
  middle = spore_vec3_scale(1 / (double)count, middle);
  for (size_t i = 0; i < count; i++) {
    SporeVec3 apart = spore_vec3_sub(spore_vec3_load(start->q + 3 * i), middle);
    SporeVec3 near = {scale.x * apart.x, scale.y * apart.y, scale.z * apart.z};
    spore_vec3_store(start->q + 3 * i, spore_vec3_add(middle, near));
  }
}

static bool put_inside(SporeWorld *world) {
  uint32_t moved = 0;
  SporeVec3 by = {0, 0, 0};
  Start start;
  if (!find_pair(world, &moved, &by)) return true;
  if (!copy_state(world, moved, &start)) return false;
  for (size_t i = 0; i < start.model->node_count; i++) spore_vec3_accumulate(start.q + 3 * i, by);
  set_state(world, moved, &start);
  return true;
}

bool spore_start_put(SporeWorld *world, SporePushStart how) {
  uint32_t random = 88675123u;
  if (how == SPORE_START_AS_IT_IS) return true;
  if (how == SPORE_START_OVERLAP) return put_inside(world);
  for (uint32_t b = 0; b < spore_world_body_count(world); b++) {
    Start start;
    if (!is_passive(world, b) || (how != SPORE_START_KNOCKED && !deforms(world, b))) continue;
    if (!copy_state(world, b, &start)) return false;
    if (how == SPORE_START_KNOCKED) knock(&start, &random);
    if (how == SPORE_START_FLAT) squeeze(&start, spore_vec3(1, FLAT, 1));
    if (how == SPORE_START_POINT) squeeze(&start, spore_vec3(POINT, POINT, POINT));
    set_state(world, b, &start);
  }
  return true;
}
