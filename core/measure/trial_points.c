/* Chooses the material points that trials follow, and compares trials by these points. */
#include <assert.h>
#include <math.h>
#include <stdint.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/measure/trial.h"
#include "core/sim/tool/tool.h"

static bool no_memory(SporeError *error) {
  return spore_error_set(
      error, SPORE_ERROR_MEMORY, NULL,
      _("there is not enough memory to follow the bodies of a run; close other programs and try again"));
}

/* The model at rest in its own frame. */
static bool place_at_rest(const SporeModel *model, double **q) {
  double *v = SPORE_NEW_ARRAY(double, 3 * model->block_count);
  *q = SPORE_NEW_ARRAY(double, model->q_count);
  if (*q && v) model->type->place(model, spore_pose_identity(), spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), *q, v);
  spore_free(v);
  return *q && v;
}

/* Points at the radii of gyration on the axes of the frame, either side. */
static bool take_rigid(const SporeModel *model, double **points, size_t *count) {
  double *q = NULL;
  bool good = place_at_rest(model, &q);
  *points = SPORE_NEW_ARRAY(double, 18);
  *count = 6;
  if (good && *points) {
    SporeMat3 inertia = model->type->inertia(model, q);
    double mass = model->block_mass[0], trace = inertia.m[0] + inertia.m[4] + inertia.m[8];
    for (int i = 0; i < 6; i++) {
      int axis = i / 2;
      double square = (0.5 * trace - inertia.m[4 * axis]) / mass;
      (*points)[3 * i + axis] = (i % 2 ? -1 : 1) * sqrt(fmax(square, 0));
    }
  }
  spore_free(q);
  return good && *points;
}

/* All points that could be followed. */
static bool take_all(const SporeModel *model, double **points, size_t *count) {
  size_t seen;
  if (spore_model_is_rigid(model)) return take_rigid(model, points, count);
  if (model->type->samples) return model->type->samples(model, points, count, &seen);
  *count = model->node_count - !spore_model_is_nodal(model) - model->spare_count;
  return place_at_rest(model, points);
}

/* Moves the points to the front that lie as far as they can from those before; returns how many. */
static size_t spread(double *points, size_t count, double *distance) {
  size_t wanted = count < SPORE_TRIAL_POINTS ? count : SPORE_TRIAL_POINTS;
  for (size_t i = 0; i < count; i++) distance[i] = HUGE_VAL;
  for (size_t chosen = 0; chosen + 1 < wanted; chosen++) {
    size_t farthest = chosen + 1;
    for (size_t i = chosen + 1; i < count; i++) {
      double apart = spore_vec3_distance(spore_vec3_load(points + 3 * i), spore_vec3_load(points + 3 * chosen));
      distance[i] = fmin(distance[i], apart);
      if (distance[i] > distance[farthest]) farthest = i;
    }
    SporeVec3 one = spore_vec3_load(points + 3 * (chosen + 1)), other = spore_vec3_load(points + 3 * farthest);
    spore_vec3_store(points + 3 * (chosen + 1), other);
    spore_vec3_store(points + 3 * farthest, one);
    distance[farthest] = distance[chosen + 1];
  }
  return wanted;
}

/* Diagonal of the box around points. */
static double diagonal(const double *points, size_t count) {
  SporeVec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (size_t i = 0; i < count; i++) {
    const double *p = points + 3 * i;
    low = spore_vec3(fmin(low.x, p[0]), fmin(low.y, p[1]), fmin(low.z, p[2]));
    high = spore_vec3(fmax(high.x, p[0]), fmax(high.y, p[1]), fmax(high.z, p[2]));
  }
  double length = spore_vec3_distance(low, high);
  return isfinite(length) && length > 0 ? length : 1;
}

static bool choose_body(SporeTrialBody *chosen, const SporeWorld *world) {
  const SporeModel *model = spore_world_body_model(world, chosen->body);
  size_t count = 0;
  if (model->type->particles) {
    chosen->stride = (model->node_count + SPORE_TRIAL_POINTS - 1) / SPORE_TRIAL_POINTS;
    chosen->count = (model->node_count + chosen->stride - 1) / chosen->stride;
    chosen->changes = spore_world_exchanges_particles(world);
    double *q = NULL; /* in the world there may be none yet */
    bool placed = place_at_rest(model, &q);
    if (placed) chosen->length = diagonal(q, model->node_count);
    spore_free(q);
    return placed;
  }
  bool good = take_all(model, &chosen->rest, &count);
  double *distance = SPORE_NEW_ARRAY(double, count);
  good = good && distance;
  if (good) chosen->count = spread(chosen->rest, count, distance);
  if (good) chosen->length = diagonal(chosen->rest, count);
  spore_free(distance);
  return good;
}

bool spore_trial_points_choose(SporeTrialPoints *points, const SporeWorld *world, uint32_t body, SporeError *error) {
  *points = (SporeTrialPoints){.bodies = SPORE_NEW_ARRAY(SporeTrialBody, spore_world_body_count(world))};
  bool good = points->bodies;
  for (uint32_t i = 0; good && i < spore_world_body_count(world); i++) {
    if (spore_world_body_role(world, i) != SPORE_PASSIVE || (body != SPORE_NO_BODY && i != body)) continue;
    SporeTrialBody *chosen = &points->bodies[points->body_count++];
    *chosen = (SporeTrialBody){.body = i};
    good = choose_body(chosen, world);
    points->count += chosen->count;
  }
  if (good && points->count > 0) return true;
  spore_trial_points_clear(points);
  if (!good) return no_memory(error);
  return spore_error_set(error, SPORE_ERROR_INPUT, "bodies",
                         _("nothing in the scene moves by physics; expected a passive body; give a body a model"));
}

void spore_trial_points_clear(SporeTrialPoints *points) {
  for (size_t i = 0; i < points->body_count; i++) spore_free(points->bodies[i].rest);
  spore_free(points->bodies);
  *points = (SporeTrialPoints){0};
}

double spore_trial_cloud_square(const SporeTrial *a, size_t row_a, const SporeTrial *b, size_t row_b, double length) {
  double more = fmax(a->present[row_a], b->present[row_b]), missing = more - fmin(a->present[row_a], b->present[row_b]);
  if (!(more > 0)) return 0;
  double square = missing / more * missing / more;
  if (missing == more) return square;
  double spread = (a->spread[row_a] - b->spread[row_b]) / length;
  SporeVec3 apart = spore_vec3_sub(spore_vec3_load(a->centre + 3 * row_a), spore_vec3_load(b->centre + 3 * row_b));
  return square + spread * spread + spore_vec3_dot(apart, apart) / (length * length);
}

/* Sum of squares of a sample, each body with the same weight; raises *worst. */
static double sample_square(const SporeTrialPoints *points, const SporeTrial *trial, const SporeTrial *other,
                            size_t sample, double *worst) {
  const double *a = trial->positions + 3 * sample * trial->points, *b = other->positions + 3 * sample * other->points;
  double sum = 0;
  for (size_t k = 0; k < points->body_count; k++) {
    const SporeTrialBody *body = &points->bodies[k];
    if (body->changes) {
      size_t row = sample * points->body_count + k;
      double part = spore_trial_cloud_square(trial, row, other, row, body->length);
      sum += part;
      if (!(part <= *worst * *worst)) *worst = sqrt(part);
      a += 3 * body->count, b += 3 * body->count;
      continue;
    }
    double square = 0;
    for (size_t i = 0; i < body->count; i++, a += 3, b += 3) {
      SporeVec3 apart = spore_vec3_sub(spore_vec3_load(a), spore_vec3_load(b));
      double part = spore_vec3_dot(apart, apart) / (body->length * body->length);
      square += part;
      if (!(part <= *worst * *worst)) *worst = sqrt(part);
    }
    sum += square / (double)body->count;
  }
  return sum / (double)points->body_count;
}

static double or_infinite(double value) { return isfinite(value) ? value : HUGE_VAL; }

SporeTrialDifference spore_trial_difference(const SporeTrialPoints *points, const SporeTrial *a, const SporeTrial *b) {
  const SporeTrialDifference none = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
  assert(a->points == points->count && b->points == points->count);
  if (a->samples != b->samples || a->samples < 2 || !a->finite || !b->finite || a->cancelled || b->cancelled)
    return none;
  SporeTrialDifference difference = {0};
  double sum = 0, last = 0;
  for (size_t s = 1; s < a->samples; s++) {
    last = sample_square(points, a, b, s, &difference.worst);
    sum += last;
  }
  difference.rms = or_infinite(sqrt(sum / (double)(a->samples - 1)));
  difference.final = or_infinite(sqrt(last));
  difference.worst = or_infinite(difference.worst);
  return difference;
}
