/* All of an exercise after one step of its run, and the words for that. */
#ifndef SPORE_UI_PANELS_EXERCISE_LOOK_H
#define SPORE_UI_PANELS_EXERCISE_LOOK_H

#include "core/scene/document.h"
#include "ui/sim/session.h"

/* Texts are of the session. */
typedef struct SporeExerciseLook {
  SporeExerciseState state;
  SporeStepState *steps;
  SporeMetricState *metrics;
} SporeExerciseLook;

/* FALSE: there is no session (NULL), or its scene has no exercise; *look stays as it is. */
gboolean spore_exercise_look_take(SporeSession *session, SporeExerciseLook *look);
void spore_exercise_look_clear(SporeExerciseLook *look);
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(SporeExerciseLook, spore_exercise_look_clear)

/* Borrowed; NULL: the run has no part of that name. */
const SporeStepState *spore_exercise_look_step(const SporeExerciseLook *look, const char *name);
const SporeMetricState *spore_exercise_look_metric(const SporeExerciseLook *look, const char *name);
/* What the trainee is told now: the hint of the first open step that has one, else the task; "": neither. look: NULL:
 * there is no run. Borrowed. section: the exercise in the document, here and below. */
const char *spore_exercise_look_told(const SporeExerciseLook *look, const SporeObject *section);
/* "Under way", or how it ended. g_free, as all below. */
char *spore_exercise_look_phase(const SporeExerciseLook *look);
/* "12.30 of 600 s" */
char *spore_exercise_look_clock(const SporeExerciseLook *look, const SporeObject *section);
/* "2 of 5 steps" */
char *spore_exercise_look_steps(const SporeExerciseLook *look);
/* All of these and the score in one line. */
char *spore_exercise_look_text(const SporeExerciseLook *look, const SporeObject *section);

#endif
