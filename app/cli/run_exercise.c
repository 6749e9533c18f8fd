/* Says the steps, metrics and score of an exercise, and writes its report. */
#include "app/cli/run_exercise.h"

#include <glib/gi18n.h>
#include <stdio.h>
#include <string.h>

#include "core/io/scene_xml.h"

static void say_steps(const SporeCli *cli, const SporeExercise *exercise, gsize count) {
  for (gsize i = 0; i < count; i++) {
    SporeStepState step = spore_exercise_step_state(exercise, i);
    if (step.phase == SPORE_STEP_DONE) spore_cli_say(cli, _("  step %s: done at %.2f s\n"), step.name, step.done_s);
    else if (step.phase == SPORE_STEP_OPEN && step.hint)
      spore_cli_say(cli, _("  step %s: not done; %s\n"), step.name, step.hint);
    else spore_cli_say(cli, _("  step %s: not done\n"), step.name);
  }
}

static void say_metrics(const SporeCli *cli, const SporeExercise *exercise, gsize count) {
  for (gsize i = 0; i < count; i++) {
    SporeMetricState metric = spore_exercise_metric_state(exercise, i);
    gboolean judged = metric.verdict != SPORE_METRIC_NONE;
    spore_cli_say(cli, "  %s: %.4g %s%s%s\n", metric.name, metric.value, metric.unit, judged ? ": " : "",
                  judged ? spore_metric_verdict_names[metric.verdict] : "");
  }
}

void spore_run_report_exercise(SporeCli *cli, const SporeExercise *exercise) {
  if (!exercise) return;
  SporeExerciseState state = spore_exercise_state(exercise);
  spore_exercise_report_add(exercise, cli->report);
  spore_cli_say(cli, _("exercise: %zu of %zu steps done in %.2f s, score %.1f of 100\n"), state.steps_done, state.steps,
                state.time_s, state.score);
  say_steps(cli, exercise, state.steps);
  say_metrics(cli, exercise, state.metrics);
}

gboolean spore_exercise_file_check(const char *file, const char *scene, const char *input, GError **error) {
  return spore_exercise_report_names(file, error) && spore_cli_has_room(file, scene, error) &&
         (!input || spore_cli_has_room(file, input, error));
}

int spore_exercise_file_save(const SporeCli *cli, const SporeExercise *exercise, const char *scene, const char *file,
                             const SporeReportPictures *pictures) {
  GError *error = NULL;
  if (spore_cli_interrupted()) {
    fprintf(stderr, _("%s: interrupted; the report was not written, and what was there stays\n"), file);
    return SPORE_EXIT_INTERRUPTED;
  }
  g_autofree char *title = g_filename_display_basename(scene),
                  *text = spore_exercise_report(exercise, title, file, pictures);
  if (!spore_write_file(file, text, strlen(text), &error)) return spore_cli_fail(error);
  spore_cli_say(cli, _("%s: the report of the exercise\n"), file);
  return SPORE_EXIT_DONE;
}
