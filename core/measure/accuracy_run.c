/* One run of the accuracy study: a world made, put where the stretch begins, run and dropped. */
#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/measure/accuracy_private.h"

/* The study's own limit of time beside the user's wish to end. */
static bool asked(void *data) {
  const SporeStudy *study = data;
  if (spore_cancel_asked(study->options.cancel)) return true;
  return study->until_s > 0 && spore_processor_s() > study->until_s;
}

static SporeStudyOutcome end(const SporeStudy *study) {
  spore_error_set(study->error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
  return SPORE_STUDY_ENDED;
}

static SporeStudyOutcome refuse(SporeStudy *study, const SporeError *reason, SporeError *why) {
  if (reason->code == SPORE_ERROR_CANCELLED) return end(study);
  *why = *reason;
  if (reason->code != SPORE_ERROR_MEMORY) return SPORE_STUDY_REFUSED;
  if (study->error) *study->error = *reason;
  return SPORE_STUDY_ENDED;
}

SporeStudyOutcome spore_study_run(SporeStudy *study, const SporeAccuracyWorld *wanted, const SporeStudyRun *run,
                                  SporeTrial *trial, SporeError *why) {
  SporeError reason = SPORE_ERROR_INIT;
  const SporeCancel cancel = {asked, study};
  SporeAccuracyWorld world = *wanted;
  world.start_s = study->report->start_s;
  *trial = (SporeTrial){0};
  if (!spore_progress(study->options.progress, study->done, _("running the scene by other methods"))) return end(study);
  SporeWorld *made = study->scene.make(study->scene.data, &world, &reason);
  if (!made) return refuse(study, &reason, why);
  spore_study_start(study, made);
  const SporeTrialSettings settings = {.interval_s = study->report->interval_s,
                                       .samples = study->samples,
                                       .dt_s = world.dt_s > 0 ? world.dt_s : study->scene.dt_s,
                                       .perturbation = run->perturbation,
                                       .seed = run->seed,
                                       .timed_only = run->timed_only,
                                       .cancel = &cancel};
  study->until_s = run->most_s > 0 ? spore_processor_s() + run->most_s : 0;
  bool good = spore_trial_run(trial, made, &study->points, &settings, &reason);
  if (good && !trial->cancelled && !spore_study_started(study, made, &reason)) {
    spore_trial_clear(trial);
    good = false;
  }
  study->scene.drop(study->scene.data, made);
  if (!good) return refuse(study, &reason, why);
  if (!trial->cancelled) return SPORE_STUDY_RAN;
  spore_trial_clear(trial);
  return spore_cancel_asked(study->options.cancel) ? end(study) : SPORE_STUDY_TOO_LONG;
}
