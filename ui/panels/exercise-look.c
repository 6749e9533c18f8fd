/* An exercise as its run has made it so far. */
#include "ui/panels/exercise-look.h"

#include <glib/gi18n.h>

static void take(const SporeExercise *exercise, gpointer data) {
  SporeExerciseLook *look = data;
  look->state = spore_exercise_state(exercise);
  look->steps = g_new(SporeStepState, look->state.steps);
  look->metrics = g_new(SporeMetricState, look->state.metrics);
  for (gsize i = 0; i < look->state.steps; i++) look->steps[i] = spore_exercise_step_state(exercise, i);
  for (gsize i = 0; i < look->state.metrics; i++) look->metrics[i] = spore_exercise_metric_state(exercise, i);
}

gboolean spore_exercise_look_take(SporeSession *session, SporeExerciseLook *look) {
  return session && spore_session_read_exercise(session, take, look);
}

void spore_exercise_look_clear(SporeExerciseLook *look) {
  g_free(look->steps);
  g_free(look->metrics);
}

const SporeStepState *spore_exercise_look_step(const SporeExerciseLook *look, const char *name) {
  for (gsize i = 0; i < look->state.steps; i++)
    if (g_str_equal(look->steps[i].name, name)) return &look->steps[i];
  return NULL;
}

const SporeMetricState *spore_exercise_look_metric(const SporeExerciseLook *look, const char *name) {
  for (gsize i = 0; i < look->state.metrics; i++)
    if (g_str_equal(look->metrics[i].name, name)) return &look->metrics[i];
  return NULL;
}

const char *spore_exercise_look_told(const SporeExerciseLook *look, const SporeObject *section) {
  const char *task = spore_object_text(section, "task");
  for (gsize i = 0; look && i < look->state.steps; i++)
    if (look->steps[i].phase == SPORE_STEP_OPEN && look->steps[i].hint) return look->steps[i].hint;
  return task ? task : "";
}

/* Words. */

char *spore_exercise_look_phase(const SporeExerciseLook *look) {
  static const char *const phases[SPORE_EXERCISE_PHASES] = {N_("Under way"), N_("Done"), N_("Out of time")};
  return g_strdup(look->state.tried ? _("Try-out") : _(phases[look->state.phase]));
}

char *spore_exercise_look_clock(const SporeExerciseLook *look, const SporeObject *section) {
  double time_s = look->state.time_s, limit_s = spore_object_number(section, "time_limit");
  return limit_s > 0 ? g_strdup_printf(_("%.2f of %g s"), time_s, limit_s) : g_strdup_printf(_("%.2f s"), time_s);
}

char *spore_exercise_look_steps(const SporeExerciseLook *look) {
  return g_strdup_printf(_("%zu of %zu steps"), look->state.steps_done, look->state.steps);
}

char *spore_exercise_look_text(const SporeExerciseLook *look, const SporeObject *section) {
  const SporeExerciseState *state = &look->state;
  g_autofree char *phase = spore_exercise_look_phase(look), *steps = spore_exercise_look_steps(look);
  g_autofree char *clock = spore_exercise_look_clock(look, section);
  g_autoptr(GString) text = g_string_new(phase);
  g_string_append_printf(text, _(": score %.1f"), state->score);
  if (state->phase != SPORE_EXERCISE_RUNNING)
    g_string_append_printf(text, ", %s", state->passed ? _("passed") : _("not passed"));
  g_string_append_printf(text, ", %s, %s", steps, clock);
  return g_strdup(text->str);
}
