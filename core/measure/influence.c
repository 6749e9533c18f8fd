/* Measures what an element of a scene does to the rest, and judges by it. */
#include "core/measure/influence.h"

#include <assert.h>
#include <math.h>

const char *const spore_verdict_names[] = {"physical", "still", "coarse", "effect", NULL};

/* Where a body's points begin among those of a sample; SIZE_MAX: the body is not followed. *index: which one it is of
 * those that are followed. */
static size_t first_point(const SporeTrialPoints *points, uint32_t body, size_t *index) {
  size_t first = 0;
  for (*index = 0; *index < points->body_count; first += points->bodies[(*index)++].count)
    if (points->bodies[*index].body == body) return first;
  return SIZE_MAX;
}

/* Sum of squares of how far the particles of a body are apart over the samples, m^2, for what add_body says. */
static double add_cloud(const SporeTrialPoints *points, const SporeTrial *a, size_t index_a,
                        const SporeTrialPoints *other_points, const SporeTrial *b, size_t index_b, double *counted,
                        double *worst) {
  double sum = 0, length = points->bodies[index_a].length;
  for (size_t s = 0; s < a->samples; s++, ++*counted) {
    size_t row_a = s * points->body_count + index_a, row_b = s * other_points->body_count + index_b;
    double square = length * length * spore_trial_cloud_square(a, row_a, b, row_b, length);
    sum += square;
    *worst = fmax(*worst, sqrt(square));
  }
  return sum;
}

/* Sum of squares of the distances of a body's points; *counted: points that are numbers in both; *worst: the largest.
 */
static double add_body(const SporeTrial *a, const SporeTrial *b, size_t first_a, size_t first_b, size_t count,
                       double *counted, double *worst) {
  double sum = 0;
  for (size_t s = 0; s < a->samples; s++)
    for (size_t i = 0; i < count; i++) {
      SporeVec3 p = spore_vec3_load(a->positions + 3 * (s * a->points + first_a + i)),
                r = spore_vec3_load(b->positions + 3 * (s * b->points + first_b + i));
      double distance = spore_vec3_distance(p, r);
      if (!isfinite(distance)) continue;
      sum += distance * distance;
      *worst = fmax(*worst, distance);
      ++*counted;
    }
  return sum;
}

static double force_between(const SporeTrial *a, const SporeTrial *b) {
  double sum = 0;
  size_t count = a->samples * a->world_bodies;
  if (a->world_bodies != b->world_bodies) return INFINITY;
  for (size_t i = 0; i < 3 * count; i++)
    sum += (a->device_force[i] - b->device_force[i]) * (a->device_force[i] - b->device_force[i]);
  return a->samples ? sqrt(sum / (double)a->samples) : 0;
}

/* Both are of one scene: their exercises have the same steps. */
static void compare_exercises(SporeInfluence *influence, const SporeTrial *a, const SporeTrial *b) {
  assert(a->exercise.steps == b->exercise.steps);
  influence->score = fabs(a->exercise.score - b->exercise.score);
  for (size_t i = a->exercise.steps; i-- > 0;)
    if (a->steps_done[i] != b->steps_done[i]) influence->step = i, influence->steps++;
}

SporeInfluence spore_influence_between(const SporeTrialPoints *points, const SporeTrial *trial,
                                       const SporeTrialPoints *other_points, const SporeTrial *other) {
  SporeInfluence influence = {.worst_body = SPORE_NO_BODY};
  double bodies = 0;
  if (trial->samples != other->samples || !trial->finite || !other->finite) {
    influence.rms = influence.worst = influence.force = influence.score = INFINITY;
    return influence;
  }
  for (size_t k = 0, first = 0; k < points->body_count; first += points->bodies[k++].count) {
    const SporeTrialBody *body = &points->bodies[k];
    double counted = 0, worst = 0;
    size_t index, there = first_point(other_points, body->body, &index);
    if (there == SIZE_MAX || other_points->bodies[index].count != body->count) continue;
    double sum = body->changes ? add_cloud(points, trial, k, other_points, other, index, &counted, &worst)
                               : add_body(trial, other, first, there, body->count, &counted, &worst);
    if (counted == 0 || !(body->length > 0)) continue;
    influence.rms += sum / counted / (body->length * body->length);
    bodies++;
    if (influence.worst_body != SPORE_NO_BODY && worst / body->length <= influence.worst) continue;
    influence.worst = worst / body->length;
    influence.worst_body = body->body;
  }
  influence.rms = bodies > 0 ? sqrt(influence.rms / bodies) : 0;
  influence.force = force_between(trial, other);
  compare_exercises(&influence, trial, other);
  return influence;
}

double spore_influence_own_motion(const SporeTrialPoints *points, const SporeTrial *trial, size_t followed) {
  assert(followed < points->body_count);
  size_t first = 0;
  double most = 0;
  for (size_t k = 0; k < followed; k++) first += points->bodies[k].count;
  for (size_t s = 1; s < trial->samples; s++)
    for (size_t i = 0; i < points->bodies[followed].count; i++) {
      const double *start = trial->positions + 3 * (first + i), *now = start + 3 * s * trial->points;
      double distance = spore_vec3_distance(spore_vec3_load(start), spore_vec3_load(now));
      if (isfinite(distance)) most = fmax(most, distance);
    }
  return points->bodies[followed].length > 0 ? most / points->bodies[followed].length : 0;
}

/* Whether nobody feels the form, and something is saved by it. */
static bool will_do(const SporeEvidence *evidence, SporeVerdict verdict) {
  const SporeForm *form = &evidence->forms[verdict];
  return form->tried && form->influence.rms <= evidence->floor && form->influence.force <= evidence->force_floor &&
         form->influence.score <= evidence->score_floor && form->influence.steps == 0 &&
         form->saved_us >= SPORE_EVIDENCE_WORTH * evidence->step_us;
}

SporeVerdict spore_evidence_verdict(const SporeEvidence *evidence) {
  if (evidence->held || evidence->alone || evidence->chaotic || evidence->awaited || evidence->events)
    return SPORE_VERDICT_PHYSICAL;
  if (will_do(evidence, SPORE_VERDICT_EFFECT)) return SPORE_VERDICT_EFFECT;
  if (evidence->own_motion <= SPORE_EVIDENCE_STILL && will_do(evidence, SPORE_VERDICT_STILL))
    return SPORE_VERDICT_STILL;
  return will_do(evidence, SPORE_VERDICT_COARSE) ? SPORE_VERDICT_COARSE : SPORE_VERDICT_PHYSICAL;
}
