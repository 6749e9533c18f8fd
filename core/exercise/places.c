/* Where bodies and instruments are, and what lies in what. */
#include <assert.h>
#include <math.h>

#include "core/exercise/exercise_private.h"
#include "core/math/quat.h"

SporeVec3 spore_instrument_point(const SporeExercise *exercise, const SporeWorld *world, uint32_t instrument) {
  assert(instrument < exercise->instrument_count);
  const SporeInstrument *at = &exercise->instruments[instrument];
  if (at->tool != SPORE_NO_PART) return spore_world_tool_tip(world, at->tool);
  return spore_vec3_load(spore_world_q(world, at->bodies[0]));
}

/* Nodes of a body, 3 doubles each. A body without a model is the origin of its frame. Spare nodes are none. */
static const double *nodes_of(const SporeWorld *world, uint32_t body, size_t *count) {
  const SporeModel *model = spore_world_body_model(world, body);
  *count = model ? model->node_count - model->spare_count : 1;
  return spore_world_q(world, body);
}

SporeVec3 spore_body_middle(const SporeWorld *world, uint32_t body) {
  size_t count, present = 0;
  const double *q = nodes_of(world, body, &count);
  SporeVec3 sum = {0, 0, 0};
  for (size_t i = 0; i < count; i++) {
    if (spore_particle_is_out(q + 3 * i)) continue;
    sum = spore_vec3_add(sum, spore_vec3_load(q + 3 * i));
    present++;
  }
  return present > 0 ? spore_vec3_scale(1.0 / (double)present, sum) : sum;
}

#define SIDES 13 /* pairs of sides of the hull: along axes, edges and corners of a cube */

typedef struct Hull {
  double low[SIDES], high[SIDES];
} Hull;

static const SporeVec3 hull_axes[SIDES] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 0},  {1, -1, 0},
                                           {1, 0, 1},  {1, 0, -1}, {0, 1, 1}, {0, 1, -1}, {1, 1, 1},
                                           {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};

static void grow(Hull *hull, SporeVec3 point, double radius) {
  for (int k = 0; k < SIDES; k++) {
    double along = spore_vec3_dot(hull_axes[k], point), wide = radius * spore_vec3_length(hull_axes[k]);
    hull->low[k] = fmin(hull->low[k], along - wide);
    hull->high[k] = fmax(hull->high[k], along + wide);
  }
}

static bool is_within(const Hull *hull, SporeVec3 point) {
  bool within = true;
  for (int k = 0; k < SIDES; k++) {
    double along = spore_vec3_dot(hull_axes[k], point);
    within &= hull->low[k] <= along && along <= hull->high[k];
  }
  return within;
}

static Hull hull_of(const SporeWorld *world, uint32_t body) {
  Hull hull;
  for (int k = 0; k < SIDES; k++) hull.low[k] = HUGE_VAL, hull.high[k] = -HUGE_VAL;
  size_t count;
  const double *q = nodes_of(world, body, &count);
  for (size_t i = 0; count > 1 && i < count; i++) grow(&hull, spore_vec3_load(q + 3 * i), 0);
  const SporeSpheres *spheres = spore_world_spheres(world);
  for (size_t i = 0; count == 1 && i < spheres->count; i++)
    if (spheres->body[i] == body) grow(&hull, spore_vec3_load(spheres->centre + 3 * i), spheres->radius[i]);
  return hull;
}

double spore_share_within(const SporeWorld *world, uint32_t body, uint32_t container) {
  const Hull hull = hull_of(world, container);
  size_t count, within = 0;
  const double *q = nodes_of(world, body, &count);
  for (size_t i = 0; i < count; i++) within += is_within(&hull, spore_vec3_load(q + 3 * i));
  return (double)within / (double)count;
}

bool spore_view_sees(const SporeView *view, const SporeWorld *world, SporeVec3 point) {
  SporePose frame = spore_pose_identity();
  if (view->body != SPORE_NO_BODY) {
    const double *q = spore_world_q(world, view->body);
    frame = spore_pose_load(q);
  }
  SporeVec3 eye = spore_pose_apply(frame, view->position);
  SporeVec3 line = spore_vec3_sub(spore_pose_apply(frame, view->target), eye), to = spore_vec3_sub(point, eye);
  double most = cos(0.5 * view->field_of_view);
  return spore_vec3_dot(line, to) >= most * spore_vec3_length(line) * spore_vec3_length(to);
}
