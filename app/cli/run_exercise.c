/* Reports the steps, metrics and score of an exercise. */
#include "app/cli/run_exercise.h"

#include <glib/gi18n.h>
#include <math.h>

/* A member that is there where there is such a number. */
static void report_known(SporeCli *cli, const char *member, double value) {
  if (isfinite(value)) spore_cli_number(cli, member, value);
}

static void report_steps(SporeCli *cli, const SporeExercise *exercise) {
  gsize count = spore_exercise_state(exercise).steps;
  spore_cli_open_array(cli, "steps");
  for (gsize i = 0; i < count; i++) {
    SporeStepState step = spore_exercise_step_state(exercise, i);
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", step.name);
    spore_cli_text(cli, "kind", step.kind->element);
    spore_cli_text(cli, "phase", spore_step_phase_names[step.phase]);
    report_known(cli, "done_s", step.done_s);
    spore_cli_count(cli, "early", (gint64)step.early);
    if (step.hint) spore_cli_text(cli, "hint", step.hint);
    spore_cli_close(cli);
    if (step.phase == SPORE_STEP_DONE) spore_cli_say(cli, _("  step %s: done at %.2f s\n"), step.name, step.done_s);
    else if (step.phase == SPORE_STEP_OPEN && step.hint)
      spore_cli_say(cli, _("  step %s: not done; %s\n"), step.name, step.hint);
    else spore_cli_say(cli, _("  step %s: not done\n"), step.name);
  }
  spore_cli_close_array(cli);
}

static void report_metric(SporeCli *cli, const SporeMetricState *metric) {
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", metric->name);
  spore_cli_text(cli, "kind", metric->kind->element);
  spore_cli_number(cli, "value", metric->value);
  spore_cli_text(cli, "unit", metric->unit);
  report_known(cli, "good", metric->good);
  report_known(cli, "pass", metric->pass);
  report_known(cli, "mark", metric->mark);
  spore_cli_text(cli, "verdict", spore_metric_verdict_names[metric->verdict]);
  if (metric->source) spore_cli_text(cli, "source", metric->source);
  spore_cli_close(cli);
  spore_cli_say(cli, "  %s: %.4g %s%s%s\n", metric->name, metric->value, metric->unit,
                metric->verdict == SPORE_METRIC_NONE ? "" : ": ",
                metric->verdict == SPORE_METRIC_NONE ? "" : spore_metric_verdict_names[metric->verdict]);
}

void spore_run_report_exercise(SporeCli *cli, const SporeExercise *exercise) {
  if (!exercise) return;
  SporeExerciseState state = spore_exercise_state(exercise);
  spore_cli_open(cli, "exercise");
  spore_cli_text(cli, "phase", spore_exercise_phase_names[state.phase]);
  spore_cli_number(cli, "time_s", state.time_s);
  spore_cli_number(cli, "score", state.score);
  spore_cli_flag(cli, "passed", state.passed);
  spore_cli_say(cli, _("exercise: %zu of %zu steps done in %.2f s, score %.1f of 100\n"), state.steps_done, state.steps,
                state.time_s, state.score);
  report_steps(cli, exercise);
  spore_cli_open_array(cli, "metrics");
  for (gsize i = 0; i < state.metrics; i++) {
    SporeMetricState metric = spore_exercise_metric_state(exercise, i);
    report_metric(cli, &metric);
  }
  spore_cli_close_array(cli);
  spore_cli_close(cli);
}
