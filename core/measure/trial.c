/* Runs a world from time 0, follows points of its bodies, and counts what the run took. */
#include "core/measure/trial.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>
#include <time.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/body/momentum.h"
#include "core/measure/stretch.h"

#define WHOLE 1e-6 /* of a step: what is that near to a whole number of steps is one */

double spore_trial_step(double interval_s, double most_s) {
  assert(interval_s > 0 && most_s > 0);
  return interval_s / fmax(1, ceil(interval_s / most_s * (1 - WHOLE)));
}

typedef struct Run {
  SporeTrial *trial;
  SporeWorld *world;
  const SporeTrialPoints *points;
  const SporeTrialSettings *settings;
  SporeMapping *mappings; /* SPORE_LOD_COUNT of each body followed: of each level that it has; of particles empty */
  SporeStretch stretch;
  bool lines; /* control points come and go */
} Run;

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL,
                         _("there is not enough memory for what a run gives; measure a shorter time"));
}

static bool allocate(Run *run) {
  SporeTrial *trial = run->trial;
  size_t samples = run->settings->timed_only ? 0 : run->settings->samples + 1;
  trial->positions = SPORE_NEW_ARRAY(double, samples * run->points->count * 3);
  trial->energy = SPORE_NEW_ARRAY(double, samples);
  trial->kinetic = SPORE_NEW_ARRAY(double, samples);
  trial->momentum = SPORE_NEW_ARRAY(double, samples * 3);
  trial->centre = SPORE_NEW_ARRAY(double, samples * run->points->body_count * 3);
  trial->spread = SPORE_NEW_ARRAY(double, samples * run->points->body_count);
  trial->present = SPORE_NEW_ARRAY(double, samples * run->points->body_count);
  trial->device_force = SPORE_NEW_ARRAY(double, samples * trial->world_bodies * 3);
  trial->contact_force = SPORE_NEW_ARRAY(double, samples * trial->world_bodies * 3);
  trial->contact_depth = SPORE_NEW_ARRAY(double, samples);
  trial->steps_done =
      SPORE_NEW_ARRAY(bool, run->settings->exercise ? spore_exercise_state(run->settings->exercise).steps : 0);
  run->mappings = SPORE_NEW_ARRAY(SporeMapping, SPORE_LOD_COUNT * run->points->body_count);
  return trial->positions && trial->energy && trial->kinetic && trial->momentum && trial->centre && trial->spread &&
         trial->present && trial->device_force && trial->contact_force && trial->contact_depth && trial->steps_done &&
         run->mappings;
}

/* Maps the points at each level that the body has: it may change from one to another. */
static bool map_body(Run *run, size_t k, SporeError *error) {
  const SporeTrialBody *body = &run->points->bodies[k];
  for (size_t level = 0; level < SPORE_LOD_COUNT; level++)
    if (spore_world_lod_model(run->world, body->body, (SporeLodGrade)level) &&
        !spore_world_map_lod(run->world, body->body, (SporeLodGrade)level, body->rest, body->count,
                             &run->mappings[SPORE_LOD_COUNT * k + level], error))
      return false;
  return true;
}

/* The mapping of a body followed at its present level. */
static SporeMapping *mapping_of(const Run *run, size_t k) {
  SporeLodState state = {.level = SPORE_LOD_FINE};
  spore_world_lod_state(run->world, run->points->bodies[k].body, &state);
  return &run->mappings[SPORE_LOD_COUNT * k + (size_t)state.level];
}

static bool map_points(Run *run, SporeError *error) {
  SporeLineState line;
  for (size_t k = 0; k < run->points->body_count; k++) {
    const SporeTrialBody *body = &run->points->bodies[k];
    run->lines |= spore_world_line_state(run->world, body->body, &line);
    if (body->rest && !map_body(run, k, error)) return false;
  }
  return true;
}

#define EVENT_COUNTS (offsetof(SporeTrialEvents, coagulated) / sizeof(uint64_t)) /* the first members */

/* The distances of a's and b's counts. */
static void events_apart(uint64_t apart[EVENT_COUNTS], const SporeTrialEvents *a, const SporeTrialEvents *b) {
  uint64_t in_b[EVENT_COUNTS];
  memcpy(apart, a, sizeof in_b);
  memcpy(in_b, b, sizeof in_b);
  for (size_t i = 0; i < EVENT_COUNTS; i++) apart[i] = apart[i] > in_b[i] ? apart[i] - in_b[i] : in_b[i] - apart[i];
}

void spore_trial_events_spread(SporeTrialEvents *spread, const SporeTrialEvents *a, const SporeTrialEvents *b) {
  uint64_t apart[EVENT_COUNTS], most[EVENT_COUNTS];
  events_apart(apart, a, b);
  memcpy(most, spread, sizeof most);
  for (size_t i = 0; i < EVENT_COUNTS; i++) most[i] = most[i] > apart[i] ? most[i] : apart[i];
  memcpy(spread, most, sizeof most);
}

bool spore_trial_events_alike(const SporeTrialEvents *a, const SporeTrialEvents *b, const SporeTrialEvents *spread) {
  uint64_t apart[EVENT_COUNTS], most[EVENT_COUNTS];
  bool alike = !a->coagulated == !b->coagulated && !a->taken == !b->taken;
  events_apart(apart, a, b);
  memcpy(most, spread, sizeof most);
  for (size_t i = 0; i < EVENT_COUNTS; i++) alike &= apart[i] <= most[i];
  return alike;
}

/* -1 .. 1, the same on every machine. */
static double next_random(uint32_t *state) {
  *state = *state * 1664525u + 1013904223u;
  return 2 * (double)(*state >> 8) / (1 << 24) - 1;
}

/* Moves the nodes of the bodies followed a little. */
static bool perturb(Run *run) {
  uint32_t state = 2463534242u + run->settings->seed;
  for (size_t k = 0; k < run->points->body_count; k++) {
    const SporeTrialBody *body = &run->points->bodies[k];
    const SporeModel *model = spore_world_body_model(run->world, body->body);
    double *q = SPORE_NEW_ARRAY(double, model->q_count);
    if (!q) return false;
    memcpy(q, spore_world_q(run->world, body->body), model->q_count * sizeof *q);
    for (size_t i = 0; i < 3 * model->node_count; i++) {
      double part = run->settings->perturbation * body->length * next_random(&state);
      if (!model->type->particles || !spore_particle_is_out(q + i / 3 * 3)) q[i] += part;
    }
    spore_world_set_state(run->world, body->body, q, spore_world_v(run->world, body->body));
    spore_free(q);
  }
  return true;
}

/* Positions of one body's points. False: one of them is not finite. */
static bool look_at_body(Run *run, size_t k, const SporeSnapshot *lines, double *positions) {
  const SporeTrialBody *body = &run->points->bodies[k];
  const double *q = spore_world_q(run->world, body->body);
  bool finite = true;
  if (body->rest) {
    if (lines)
      spore_world_follow_knots(run->world, body->body, spore_snapshot_knots(run->world, lines, body->body),
                               mapping_of(run, k));
    spore_mapping_positions(mapping_of(run, k), q, positions);
    for (size_t i = 0; i < 3 * body->count; i++) finite &= isfinite(positions[i]) != 0;
    return finite;
  }
  for (size_t i = 0; i < body->count; i++) {
    const double *p = q + 3 * i * body->stride;
    bool out = spore_particle_is_out(p);
    for (int c = 0; c < 3; c++) {
      positions[3 * i + (size_t)c] = out ? NAN : p[c];
      finite &= out || isfinite(p[c]);
    }
  }
  return finite;
}

/* Mean and spread of the positions that are in the world. */
static void take_cloud(SporeTrial *trial, size_t row, const double *positions, size_t count) {
  double counted = 0, square = 0;
  SporeVec3 sum = {0, 0, 0};
  for (size_t i = 0; i < count; i++)
    if (isfinite(positions[3 * i]) && !spore_particle_is_out(positions + 3 * i)) {
      sum = spore_vec3_add(sum, spore_vec3_load(positions + 3 * i));
      counted++;
    }
  SporeVec3 centre = spore_vec3_scale(counted > 0 ? 1 / counted : 0, sum);
  for (size_t i = 0; i < count; i++)
    if (isfinite(positions[3 * i]) && !spore_particle_is_out(positions + 3 * i)) {
      SporeVec3 apart = spore_vec3_sub(spore_vec3_load(positions + 3 * i), centre);
      square += spore_vec3_dot(apart, apart);
    }
  spore_vec3_store(trial->centre + 3 * row, centre);
  trial->spread[row] = counted > 0 ? sqrt(square / counted) : 0;
  trial->present[row] = counted;
}

/* Deepest overlap among the contacts that the snapshot lists. */
static double deepest(const SporeWorld *world, const SporeSnapshot *snapshot) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  double most = 0;
  size_t count =
      snapshot->contact_count < snapshot->contact_capacity ? snapshot->contact_count : snapshot->contact_capacity;
  for (size_t i = 0; i < count; i++) {
    uint32_t a = snapshot->contacts[i].sphere_a, b = snapshot->contacts[i].sphere_b;
    double apart =
        spore_vec3_distance(spore_vec3_load(spheres->centre + 3 * a), spore_vec3_load(spheres->centre + 3 * b));
    double smaller = fmin(spheres->radius[a], spheres->radius[b]);
    if (smaller > 0) most = fmax(most, (spheres->radius[a] + spheres->radius[b] - apart) / smaller);
  }
  return most;
}

static SporeVec3 momentum_of(const SporeWorld *world) {
  SporeVec3 sum = {0, 0, 0};
  for (uint32_t i = 0; i < spore_world_body_count(world); i++) {
    const SporeModel *model = spore_world_body_model(world, i);
    const double *v = model ? spore_world_v(world, i) : NULL;
    for (size_t b = 0; model && b < model->block_count; b++)
      sum = spore_vec3_add_scaled(sum, model->block_mass[b], spore_vec3_load(v + 3 * b));
  }
  return sum;
}

static void take_forces(const Run *run, const SporeSnapshot *snapshot, double *force) {
  for (uint32_t b = 0; b < run->trial->world_bodies; b++)
    if (spore_world_body_role(run->world, b) == SPORE_ACTIVE)
      memcpy(force + 3 * b, snapshot->reaction + 6 * b, 3 * sizeof *force);
}

/* Those that the snapshot lists. */
static void take_contacts(const Run *run, const SporeSnapshot *snapshot, double *force) {
  const SporeSpheres *spheres = spore_world_spheres(run->world);
  size_t count =
      snapshot->contact_count < snapshot->contact_capacity ? snapshot->contact_count : snapshot->contact_capacity;
  for (size_t i = 0; i < count; i++) {
    const SporeSnapshotContact *contact = &snapshot->contacts[i];
    double *a = force + 3 * spheres->body[contact->sphere_a], *b = force + 3 * spheres->body[contact->sphere_b];
    spore_vec3_store(a, spore_vec3_add(spore_vec3_load(a), contact->force));
    spore_vec3_store(b, spore_vec3_sub(spore_vec3_load(b), contact->force));
  }
}

static void look(Run *run) {
  SporeTrial *trial = run->trial;
  size_t s = trial->samples, point = 0;
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(run->world);
  for (size_t k = 0; k < run->points->body_count; k++) {
    double *positions = trial->positions + 3 * (s * run->points->count + point);
    trial->finite &= look_at_body(run, k, run->lines ? snapshot : NULL, positions);
    const SporeTrialBody *body = &run->points->bodies[k];
    const double *q = spore_world_q(run->world, body->body);
    size_t nodes = body->changes ? spore_world_body_model(run->world, body->body)->node_count : 0;
    take_cloud(trial, s * run->points->body_count + k, nodes ? q : positions, nodes ? nodes : body->count);
    point += body->count;
  }
  take_forces(run, snapshot, trial->device_force + 3 * s * trial->world_bodies);
  take_contacts(run, snapshot, trial->contact_force + 3 * s * trial->world_bodies);
  trial->contact_depth[s] = s > 0 ? spore_world_counts(run->world).contact_depth : 0;
  SporeEnergy energy = spore_world_energy(run->world);
  trial->energy[s] = energy.kinetic + energy.internal + energy.gravity + energy.contact;
  trial->kinetic[s] = energy.kinetic;
  spore_vec3_store(trial->momentum + 3 * s, momentum_of(run->world));
  trial->finite &= isfinite(trial->energy[s]) != 0;
  trial->gap = fmax(trial->gap, spore_stretch_gap(run->world));
  trial->line_stretch = fmax(trial->line_stretch, spore_stretch_of_lines(&run->stretch, run->world, snapshot));
  if (s > 0) trial->penetration = fmax(trial->penetration, deepest(run->world, snapshot));
  trial->samples++;
}

static double thread_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The steps of an interval. False: cancelled. */
static bool step(Run *run, size_t steps) {
  SporeTrial *trial = run->trial;
  double start = thread_s();
  for (size_t i = 0; i < steps; i++) {
    spore_world_step(run->world);
    if (spore_world_cancelled(run->world)) break;
    spore_world_tidy(run->world);
    if (run->settings->exercise) spore_exercise_watch(run->settings->exercise, run->world);
    SporeStepCounts counts = spore_world_counts(run->world);
    trial->force_evaluations += (double)counts.force_evaluations;
    trial->newton += (double)counts.newton_iterations;
    trial->linear += (double)counts.linear_iterations;
    trial->contacts += (double)counts.contacts;
    trial->residual = fmax(trial->residual, counts.residual);
    for (size_t t = 0; t < spore_world_tool_count(run->world); t++)
      trial->events.coagulated += spore_world_tool_state(run->world, t).coagulated;
    trial->steps++;
  }
  trial->cpu_s += thread_s() - start;
  trial->cancelled = spore_world_cancelled(run->world) || spore_cancel_asked(run->settings->cancel);
  return !trial->cancelled;
}

static void count_events(SporeTrialEvents *events, const SporeWorld *world) {
  const SporeMonitor *monitor = spore_world_monitor(world);
  events->broken = monitor->broken_links;
  events->torn = monitor->torn_springs;
  events->lost = monitor->lost_holds;
  for (size_t i = 0; i < spore_world_tool_count(world); i++) {
    SporeToolState tool = spore_world_tool_state(world, i);
    events->cut += tool.cut, events->taken += tool.taken, events->pierced += tool.pierced;
    events->stitches += tool.stitches, events->held += tool.held;
  }
}

static void take_exercise(SporeTrial *trial, const SporeExercise *exercise) {
  trial->exercise = spore_exercise_state(exercise);
  for (size_t i = 0; i < trial->exercise.steps; i++)
    trial->steps_done[i] = spore_exercise_step_state(exercise, i).phase == SPORE_STEP_DONE;
}

static void judge(Run *run) {
  SporeTrial *trial = run->trial;
  const SporeMonitor *monitor = spore_world_monitor(run->world);
  SporeProfileSummary times = spore_profile_summary(spore_world_profile(run->world));
  trial->median_us = times.median_us, trial->p99_us = times.p99_us;
  trial->simulated_s = (double)trial->steps * trial->dt_s;
  trial->spheres = spore_world_spheres(run->world)->count;
  trial->recoveries = monitor->recoveries;
  trial->unsolved = spore_world_unsolved_count(run->world);
  count_events(&trial->events, run->world);
  if (run->settings->exercise) take_exercise(trial, run->settings->exercise);
  trial->stable = trial->finite && !monitor->not_finite && !monitor->too_fast && !monitor->energy;
  for (uint32_t i = 0; i < spore_world_body_count(run->world); i++)
    trial->stable &= !spore_world_body_frozen(run->world, i) && !spore_world_body_made_safer(run->world, i);
}

bool spore_trial_run(SporeTrial *trial, SporeWorld *world, const SporeTrialPoints *points,
                     const SporeTrialSettings *settings, SporeError *error) {
  assert(settings->interval_s > 0 && settings->dt_s > 0);
  *trial = (SporeTrial){.world_bodies = spore_world_body_count(world),
                        .points = points->count,
                        .dt_s = settings->dt_s,
                        .finite = true,
                        .gap = NAN,
                        .line_stretch = NAN};
  Run run = {.trial = trial, .world = world, .points = points, .settings = settings};
  size_t each = (size_t)fmax(1, round(settings->interval_s / settings->dt_s));
  bool good = allocate(&run) || no_memory(error);
  good = good && map_points(&run, error) && spore_stretch_create(&run.stretch, world, error);
  if (good && settings->perturbation > 0) good = perturb(&run) || no_memory(error);
  if (good && settings->exercise) spore_exercise_restart(settings->exercise, world);
  if (good && !settings->timed_only) look(&run);
  for (size_t s = 0; good && s < settings->samples && step(&run, each); s++) {
    if (!settings->timed_only) look(&run);
    trial->cancelled = !spore_progress(settings->progress, (double)(s + 1) / (double)settings->samples, _("running"));
    if (trial->cancelled) break;
  }
  if (good) judge(&run);
  for (size_t k = 0; run.mappings && k < SPORE_LOD_COUNT * points->body_count; k++)
    spore_mapping_clear(&run.mappings[k]);
  spore_free(run.mappings);
  spore_stretch_clear(&run.stretch);
  if (!good) spore_trial_clear(trial);
  return good;
}

void spore_trial_clear(SporeTrial *trial) {
  spore_free(trial->positions);
  spore_free(trial->energy);
  spore_free(trial->kinetic);
  spore_free(trial->momentum);
  spore_free(trial->centre);
  spore_free(trial->spread);
  spore_free(trial->present);
  spore_free(trial->device_force);
  spore_free(trial->contact_force);
  spore_free(trial->contact_depth);
  spore_free(trial->steps_done);
  *trial = (SporeTrial){0};
}
