/* Measures how near the windings of bodies along a line come to each other. */
#include "core/measure/loops.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/body/path.h"
#include "core/collide/near_pairs.h"

#define SAMPLES 8       /* places a span that a sphere's place on the line is sought from */
#define SKIN 1.0        /* of the mean radius */
#define ROUNDING 1e-9   /* of the sum of radii: neighbours are a radius apart along their line */
#define FIRST_PAIRS 256 /* room */

static void clear_body(SporeLoopsBody *body) {
  spore_free(body->along);
  spore_free(body->listed);
  spore_free(body->pairs);
  *body = (SporeLoopsBody){0};
}

void spore_loops_clear(SporeLoops *loops) {
  for (size_t i = 0; i < loops->count; i++) clear_body(&loops->bodies[i]);
  spore_free(loops->bodies);
  *loops = (SporeLoops){0};
}

/* Places on the line. */

/* Samples of the line at rest: places, and the length up to each. */
typedef struct Samples {
  size_t count;
  double *place, *length;
} Samples;

static bool sample(SporeSplineKnots knots, const double *q, Samples *samples) {
  samples->count = SAMPLES * knots.span_count + 1;
  samples->place = SPORE_NEW_ARRAY(double, 3 * samples->count);
  samples->length = SPORE_NEW_ARRAY(double, samples->count);
  if (!samples->place || !samples->length) return false;
  for (size_t i = 0; i < samples->count; i++) {
    double parameter = spore_spline_part(knots, SAMPLES, i);
    spore_vec3_store(samples->place + 3 * i, spore_path_at(knots, q, parameter).position);
    double before = i > 0 ? spore_spline_part(knots, SAMPLES, i - 1) : 0;
    samples->length[i] = i > 0 ? samples->length[i - 1] + spore_path_length(knots, q, before, parameter) : 0;
  }
  return true;
}

/* Length of the line up to the place that is nearest to the point, m. */
static double along_of(SporeSplineKnots knots, const double *q, const Samples *samples, SporeVec3 point) {
  size_t nearest = 0;
  double least = HUGE_VAL;
  for (size_t i = 0; i < samples->count; i++) {
    SporeVec3 away = spore_vec3_sub(spore_vec3_load(samples->place + 3 * i), point);
    double square = spore_vec3_dot(away, away);
    if (square < least) least = square, nearest = i;
  }
  double from = spore_spline_part(knots, SAMPLES, nearest);
  double to = spore_path_follow(knots, q, from, point).parameter;
  return samples->length[nearest] + spore_path_length(knots, q, from, to);
}

/* Fills `along`. */
static bool place_spheres(SporeLoopsBody *body, const SporeWorld *world, const SporeSpheres *spheres) {
  const SporeModel *model = spore_world_body_model(world, body->body);
  const double *q = spore_world_q(world, body->body);
  SporeSplineKnots knots = model->type->line->path(model);
  Samples samples = {0};
  bool sampled = sample(knots, q, &samples);
  for (size_t i = 0; sampled && i < body->count; i++)
    body->along[i] = along_of(knots, q, &samples, spore_vec3_load(spheres->centre + 3 * (body->start + i)));
  spore_free(samples.place);
  spore_free(samples.length);
  return sampled;
}

/* The list of pairs. */

static bool add_pair(SporeLoopsBody *body, uint32_t a, uint32_t b) {
  SporeLoopsPair *pairs =
      spore_room_for_one(body->pairs, body->pair_count, &body->pair_capacity, FIRST_PAIRS, sizeof *pairs);
  if (!pairs) return false;
  body->pairs = pairs;
  body->pairs[body->pair_count++] = (SporeLoopsPair){a, b};
  return true;
}

/* A search for the pairs of a body. */
typedef struct Search {
  SporeLoopsBody *body;
  const double *radius;
} Search;

/* Adds the pair where the spheres are of different windings. */
static bool weigh_pair(void *data, uint32_t a, uint32_t b) {
  const Search *search = data;
  SporeLoopsBody *body = search->body;
  double sum = search->radius[a] + search->radius[b];
  return !(fabs(body->along[a] - body->along[b]) > (1 + ROUNDING) * sum) || add_pair(body, a, b);
}

static bool list_pairs(SporeLoopsBody *body, const double *centre, const double *radius) {
  Search search = {body, radius};
  body->pair_count = 0;
  memcpy(body->listed, centre, 3 * body->count * sizeof *centre);
  return spore_near_pairs(centre, radius, body->count, 1, body->skin, weigh_pair, &search);
}

/* Whether a sphere has gone so far that a pair may be near that is not listed. */
static bool is_stale(const SporeLoopsBody *body, const double *centre) {
  double farthest = 0.25 * body->skin * body->skin;
  for (size_t i = 0; i < body->count; i++) {
    SporeVec3 way = spore_vec3_sub(spore_vec3_load(centre + 3 * i), spore_vec3_load(body->listed + 3 * i));
    if (!(spore_vec3_dot(way, way) < farthest)) return true;
  }
  return false;
}

/* The least distance of a listed pair over the sum of its radii; 1: none touches. */
static double nearest_pair(const SporeLoopsBody *body, const double *centre, const double *radius) {
  double least = 1;
  for (size_t i = 0; i < body->pair_count; i++) {
    SporeLoopsPair pair = body->pairs[i];
    SporeVec3 away = spore_vec3_sub(spore_vec3_load(centre + 3 * pair.a), spore_vec3_load(centre + 3 * pair.b));
    double sum = radius[pair.a] + radius[pair.b], square = spore_vec3_dot(away, away);
    if (square < least * least * sum * sum) least = sqrt(square) / sum;
  }
  return least;
}

static bool step_body(SporeLoopsBody *body, const SporeSpheres *spheres, double began_s, bool first) {
  const double *centre = spheres->centre + 3 * body->start, *radius = spheres->radius + body->start;
  if (is_stale(body, centre) && !list_pairs(body, centre, radius)) return false;
  double nearest = nearest_pair(body, centre, radius);
  bool through = nearest < SPORE_LOOPS_THROUGH;
  body->from_start = body->from_start || (through && first);
  body->through += through;
  if (!(nearest < body->least)) return true;
  body->least = nearest;
  body->least_s = began_s;
  return true;
}

/* Bodies. */

static bool is_measured(const SporeWorld *world, uint32_t body) {
  const SporeModel *model = spore_world_body_model(world, body);
  return model && model->type->line && spore_world_body_sphere_count(world, body) > 1;
}

static bool make_body(SporeLoopsBody *body, const SporeWorld *world, uint32_t index) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  *body = (SporeLoopsBody){.body = index, .least = 1, .count = spore_world_body_sphere_count(world, index)};
  while (spheres->body[body->start] != index) body->start++;
  for (size_t i = 0; i < body->count; i++) body->skin += SKIN / (double)body->count * spheres->radius[body->start + i];
  body->along = SPORE_NEW_ARRAY(double, body->count);
  body->listed = SPORE_NEW_ARRAY(double, 3 * body->count);
  return body->along && body->listed && place_spheres(body, world, spheres) &&
         list_pairs(body, spheres->centre + 3 * body->start, spheres->radius + body->start);
}

/* Whether the step maps spheres; where nothing can touch, they stay where they were. */
static bool maps_spheres(const SporeWorld *world) {
  const SporePlan *plan = spore_world_plan(world);
  for (size_t i = 0; i < plan->stage_count; i++)
    if (strcmp(plan->stages[i].name, "map") == 0) return plan->stages[i].included;
  return false;
}

void spore_loops_start(SporeLoops *loops, const SporeWorld *world) {
  size_t bodies = spore_world_body_count(world);
  *loops = (SporeLoops){.bodies = maps_spheres(world) ? SPORE_NEW_ARRAY(SporeLoopsBody, bodies) : NULL,
                        .time_s = spore_world_time_s(world)};
  for (uint32_t b = 0; loops->bodies && b < bodies; b++) {
    if (!is_measured(world, b)) continue;
    SporeLoopsBody *body = &loops->bodies[loops->count];
    if (make_body(body, world, b)) loops->count++;
    else clear_body(body);
  }
}

static void leave_out(SporeLoops *loops, size_t i) {
  clear_body(&loops->bodies[i]);
  loops->count--;
  memmove(loops->bodies + i, loops->bodies + i + 1, (loops->count - i) * sizeof *loops->bodies);
}

void spore_loops_step(SporeLoops *loops, const SporeWorld *world) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  for (size_t i = loops->count; i-- > 0;)
    if (!step_body(&loops->bodies[i], spheres, loops->time_s, loops->steps == 0)) leave_out(loops, i);
  loops->steps++;
  loops->time_s = spore_world_time_s(world);
}
