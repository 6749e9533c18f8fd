/* Estimates the local error of steps by the trapezoidal rule. */
#include "core/measure/local_error.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"

/* The last two states of a body, while an estimate is under way. */
struct SporeLocalErrorBody {
  const SporeModel *model; /* of which they are; NULL: nothing is kept */
  size_t node_count, capacity;
  double *v_before, *q0, *v0; /* 3 node_count each */
};

static bool make_room(SporeLocalErrorBody *kept, const SporeWorld *world, uint32_t body) {
  for (int level = 0; level < SPORE_LOD_COUNT; level++) {
    const SporeModel *model = spore_world_lod_model(world, body, (SporeLodGrade)level);
    if (model && model->block_room > kept->capacity) kept->capacity = model->block_room;
  }
  kept->v_before = SPORE_NEW_ARRAY(double, 3 * kept->capacity);
  kept->q0 = SPORE_NEW_ARRAY(double, 3 * kept->capacity);
  kept->v0 = SPORE_NEW_ARRAY(double, 3 * kept->capacity);
  return kept->v_before && kept->q0 && kept->v0;
}

bool spore_local_error_init(SporeLocalError *estimate, const SporeWorld *world, double dt_s) {
  assert(dt_s > 0);
  size_t count = spore_world_body_count(world);
  *estimate = (SporeLocalError){.dt_s = dt_s, .last_body = SPORE_NO_BODY, .most_body = SPORE_NO_BODY};
  estimate->bodies = SPORE_NEW_ARRAY(SporeLocalErrorBody, count);
  if (!estimate->bodies) return false;
  for (; estimate->body_count < count; estimate->body_count++) {
    if (make_room(&estimate->bodies[estimate->body_count], world, (uint32_t)estimate->body_count)) continue;
    estimate->body_count++;
    spore_local_error_clear(estimate);
    return false;
  }
  return true;
}

void spore_local_error_clear(SporeLocalError *estimate) {
  for (size_t b = 0; b < estimate->body_count; b++) {
    spore_free(estimate->bodies[b].v_before);
    spore_free(estimate->bodies[b].q0);
    spore_free(estimate->bodies[b].v0);
  }
  spore_free(estimate->bodies);
  *estimate = (SporeLocalError){.last_body = SPORE_NO_BODY, .most_body = SPORE_NO_BODY};
}

void spore_local_error_reset(SporeLocalError *estimate) {
  estimate->samples = 0;
  estimate->last = estimate->most = estimate->sum = 0;
  estimate->last_body = estimate->most_body = SPORE_NO_BODY;
  for (size_t b = 0; b < estimate->body_count; b++) estimate->bodies[b].model = NULL;
}

/* Whether what is kept is of the nodes that the body has now. */
static bool is_same(const SporeLocalErrorBody *kept, const SporeModel *model) {
  return model && kept->model == model && kept->node_count == model->node_count;
}

static void keep_before(SporeLocalErrorBody *kept, const SporeWorld *world, uint32_t body) {
  kept->model = spore_world_body_is_effect(world, body) ? NULL : spore_world_body_model(world, body);
  if (!kept->model) return;
  kept->node_count = kept->model->node_count;
  assert(kept->node_count <= kept->capacity);
  memcpy(kept->v_before, spore_world_v(world, body), 3 * kept->node_count * sizeof(double));
}

static void keep_start(SporeLocalErrorBody *kept, const SporeWorld *world, uint32_t body) {
  if (!is_same(kept, spore_world_body_model(world, body))) {
    kept->model = NULL;
    return;
  }
  memcpy(kept->q0, spore_world_q(world, body), 3 * kept->node_count * sizeof(double));
  memcpy(kept->v0, spore_world_v(world, body), 3 * kept->node_count * sizeof(double));
}

/* The sum of the head of local_error.h, m. */
static double error_of(const SporeLocalErrorBody *kept, const double *q1, const double *v1, double h) {
  double mass = 0, apart = 0, next = 0;
  for (size_t i = 0; i < kept->node_count; i++) {
    const size_t k = 3 * i;
    const double m = kept->model->block_mass[i];
    if (kept->model->type->particles && (spore_particle_is_out(kept->q0 + k) || spore_particle_is_out(q1 + k)))
      continue;
    mass += m;
    for (size_t c = k; c < k + 3; c++) {
      double d = q1[c] - kept->q0[c] - 0.5 * h * (kept->v0[c] + v1[c]);
      double e = v1[c] - 2 * kept->v0[c] + kept->v_before[c];
      apart += m * d * d;
      next += m * e * e;
    }
  }
  return mass > 0 ? (sqrt(apart) + h / 12 * sqrt(next)) / sqrt(mass) : 0;
}

static void estimate_now(SporeLocalError *estimate, const SporeWorld *world) {
  estimate->last = 0;
  estimate->last_body = SPORE_NO_BODY;
  for (uint32_t b = 0; b < estimate->body_count; b++) {
    const SporeLocalErrorBody *kept = &estimate->bodies[b];
    if (!is_same(kept, spore_world_body_model(world, b))) continue;
    double error = error_of(kept, spore_world_q(world, b), spore_world_v(world, b), estimate->dt_s);
    if (!(error > estimate->last)) continue;
    estimate->last = error;
    estimate->last_body = b;
  }
  estimate->samples++;
  estimate->sum += estimate->last;
  if (!(estimate->last > estimate->most)) return;
  estimate->most = estimate->last;
  estimate->most_body = estimate->last_body;
}

bool spore_local_error_step(SporeLocalError *estimate, const SporeWorld *world) {
  uint64_t phase = spore_world_step_count(world) % SPORE_LOCAL_ERROR_PERIOD;
  if (phase < 1 || phase > 3 || estimate->body_count == 0) return false;
  for (uint32_t b = 0; phase < 3 && b < estimate->body_count; b++) {
    if (phase == 1) keep_before(&estimate->bodies[b], world, b);
    else keep_start(&estimate->bodies[b], world, b);
  }
  if (phase == 3) estimate_now(estimate, world);
  return phase == 3;
}
