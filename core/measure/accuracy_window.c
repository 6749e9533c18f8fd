/* Finds the stretch of input that the accuracy study runs: the first one in which something touches, an instrument acts
 * or particles come. Where it begins later than at time 0, every run begins with the state that the scene has there by
 * its own method. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/measure/accuracy_private.h"

#define SEARCH_S 20.     /* simulated, at most */
#define SEARCH_SHARE 0.1 /* of the time of the study */
#define BEFORE_S 0.05    /* simulated, before something happens */
#define CHECKED 8        /* samples of a run that goes on, and of one that begins there */
#define CARRIED 1e-3     /* of a body's length: how far the two may be apart */

void spore_study_start(const SporeStudy *study, SporeWorld *world) {
  for (uint32_t i = 0; study->q && i < study->body_count; i++) {
    spore_world_set_lod(world, i, study->levels[i]);
    spore_world_set_state(world, i, study->q[i], study->v[i]);
    SporeCommand command = {.kind = SPORE_COMMAND_LOD, .body = i, .level = spore_world_first_lod(world, i)};
    if (spore_world_lod_rule(world, i).by == SPORE_LOD_BY_HAND && command.level != study->levels[i])
      spore_world_post(world, &command);
  }
}

bool spore_study_started(const SporeStudy *study, const SporeWorld *world, SporeError *why) {
  for (uint32_t i = 0; study->q && i < study->body_count; i++) {
    SporeLodState state;
    if (!spore_world_lod_state(world, i, &state) || spore_world_lod_rule(world, i).by != SPORE_LOD_BY_HAND) continue;
    if (state.level == spore_world_first_lod(world, i)) continue;
    return spore_error_set(why, SPORE_ERROR_INPUT, NULL, _("%s cannot take level %s where the stretch begins"),
                           spore_world_body_name(world, i), spore_lod_names[spore_world_first_lod(world, i)]);
  }
  return true;
}

void spore_study_forget_state(SporeStudy *study) {
  for (size_t i = 0; i < study->body_count; i++) {
    if (study->q) spore_free(study->q[i]);
    if (study->v) spore_free(study->v[i]);
  }
  spore_free(study->q);
  spore_free(study->v);
  spore_free(study->levels);
  study->q = study->v = NULL;
  study->levels = NULL;
}

static double *copy(const double *numbers, size_t count) {
  double *copied = SPORE_NEW_ARRAY(double, count);
  if (copied) memcpy(copied, numbers, count * sizeof *copied);
  return copied;
}

static bool keep_state(SporeStudy *study, const SporeWorld *world) {
  study->q = SPORE_NEW_ARRAY(double *, study->body_count);
  study->v = SPORE_NEW_ARRAY(double *, study->body_count);
  study->levels = SPORE_NEW_ARRAY(SporeLodGrade, study->body_count);
  bool good = study->q && study->v && study->levels;
  for (uint32_t i = 0; good && i < study->body_count; i++) {
    SporeLodState state = {.level = SPORE_LOD_FINE};
    spore_world_lod_state(world, i, &state);
    study->levels[i] = state.level;
    const SporeModel *model = spore_world_body_model(world, i);
    study->q[i] = copy(spore_world_q(world, i), model ? model->q_count : 7);
    study->v[i] = copy(spore_world_v(world, i), model ? 3 * model->block_count : 6);
    good = study->q[i] && study->v[i];
  }
  if (good) return true;
  spore_study_forget_state(study);
  return spore_error_set(study->error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the state of a run"));
}

/* Particles in the world, of all bodies. */
static size_t count_particles(const SporeWorld *world) {
  size_t count = 0;
  for (uint32_t i = 0; i < spore_world_body_count(world); i++) {
    const SporeModel *model = spore_world_body_model(world, i);
    if (model && model->type->particles) count += spore_world_particle_count(world, i);
  }
  return count;
}

/* Whether something touches or an instrument acts. */
static bool something_happens(const SporeWorld *world) {
  bool acts = spore_world_counts(world).contacts > 0;
  for (size_t i = 0; i < spore_world_tool_count(world); i++) {
    SporeToolState tool = spore_world_tool_state(world, i);
    acts |= tool.held || tool.taken || tool.cut || tool.pierced || tool.coagulated;
  }
  return acts;
}

/* Steps until something happens: the time of that. Infinite: nothing does in the time that there is. */
static double first_event(SporeStudy *study, SporeWorld *world) {
  double most_s = SEARCH_SHARE * study->most_s;
  size_t particles = count_particles(world);
  while (spore_world_time_s(world) < SEARCH_S && spore_study_elapsed_s(study) < most_s) {
    spore_world_step(world);
    if (spore_world_cancelled(world)) break;
    spore_world_tidy(world);
    if (something_happens(world) || count_particles(world) != particles) return spore_world_time_s(world);
  }
  return HUGE_VAL;
}

static SporeWorld *own_world(SporeStudy *study, double start_s, double dt_s) {
  const SporeAccuracyWorld own = {.level = -1, .dt_s = dt_s, .start_s = start_s};
  return study->scene.make(study->scene.data, &own, study->error);
}

/* Whether a run that begins with the state of `world` goes on as that world does. */
static bool can_begin(SporeStudy *study, SporeWorld *world, double dt_s) {
  SporeTrial on = {0}, anew = {0};
  SporeTrialSettings settings = {.interval_s = study->report->interval_s, .samples = CHECKED, .dt_s = dt_s};
  SporeWorld *other = own_world(study, study->report->start_s, dt_s);
  if (!other) return false;
  spore_study_start(study, other);
  bool good = spore_trial_run(&on, world, &study->points, &settings, study->error) &&
              spore_trial_run(&anew, other, &study->points, &settings, study->error);
  good = good && spore_trial_difference(&study->points, &on, &anew).worst <= CARRIED;
  study->scene.drop(study->scene.data, other);
  spore_trial_clear(&on);
  spore_trial_clear(&anew);
  return good;
}

/* Begins the stretch shortly before something happens, if a run can begin there. */
static bool begin_late(SporeStudy *study, SporeWorld *world, double event_s, double dt_s) {
  double steps = floor(fmax(event_s - BEFORE_S, 0) / dt_s);
  spore_world_reset(world);
  for (double i = 0; i < steps && !spore_world_cancelled(world); i++) {
    spore_world_step(world);
    spore_world_tidy(world);
  }
  study->report->start_s = spore_world_time_s(world);
  if (!keep_state(study, world)) return false;
  if (can_begin(study, world, dt_s)) return true;
  if (study->error && study->error->code != SPORE_ERROR_NONE) return false;
  spore_study_forget_state(study);
  spore_study_cut(
      study,
      _("nothing touches and no instrument acts in the first %.3g s of the input; the stretch begins at 0 s all the "
        "same, since the scene's state there cannot be taken over (--full with a longer --time takes in what comes)"),
      event_s);
  study->report->start_s = 0;
  return true;
}

bool spore_study_find_window(SporeStudy *study) {
  double dt_s = spore_trial_step(study->report->interval_s, study->scene.dt_s);
  SporeWorld *world = own_world(study, 0, dt_s);
  if (!world) return false;
  bool good = true;
  double event_s = first_event(study, world);
  if (spore_world_cancelled(world)) good = spore_error_set(study->error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
  else if (isinf(event_s))
    spore_study_cut(study, _("nothing touches and no instrument acts in the first %.3g s of the input"),
                    spore_world_time_s(world));
  else if (event_s > 0.5 * study->report->time_s && study->scene.starts_late)
    good = begin_late(study, world, event_s, dt_s);
  study->scene.drop(study->scene.data, world);
  return good;
}
