/* spore advise: physical or effect. Each body that physics moves is replayed in cheaper forms, and what the others do
 * then is compared with what they do when the step is halved or the start is a little off. */
#include <glib/gi18n.h>
#include <math.h>

#include "app/cli/advise_budget.h"
#include "app/cli/cli.h"
#include "app/cli/scene.h"
#include "core/author/advice.h"
#include "core/io/scene_xml.h"

/* Reports. */

static void report_exercise(SporeCli *cli, const SporeExerciseState *exercise, const SporeEvidence *floor) {
  if (exercise->steps == 0) return;
  spore_cli_open(cli, "exercise");
  spore_cli_text(cli, "phase", spore_exercise_phase_names[exercise->phase]);
  spore_cli_number(cli, "score", exercise->score);
  spore_cli_number(cli, "score_floor", floor->score_floor);
  spore_cli_count(cli, "steps", exercise->steps);
  spore_cli_count(cli, "steps_done", exercise->steps_done);
  spore_cli_close(cli);
  spore_cli_say(cli, _("exercise: %zu of %zu steps are done, score %.1f; the same moves the score by %.2g\n"),
                exercise->steps_done, exercise->steps, exercise->score, floor->score_floor);
}

static void report_form(SporeCli *cli, const char *name, const SporeForm *form) {
  if (!form->tried) return;
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "form", name);
  spore_cli_number(cli, "influence", form->influence.rms);
  spore_cli_number(cli, "worst", form->influence.worst);
  spore_cli_number(cli, "force_N", form->influence.force);
  spore_cli_number(cli, "score", form->influence.score);
  spore_cli_flag(cli, "same_steps", form->influence.steps == 0);
  spore_cli_number(cli, "saved_us", form->saved_us);
  spore_cli_close(cli);
}

static void report_element(SporeCli *cli, const SporeAdviceElement *element, int width) {
  const SporeEvidence *evidence = &element->evidence;
  const SporeForm *out = &evidence->forms[SPORE_VERDICT_EFFECT];
  g_autofree char *id = g_strdup_printf("%s/%s", element->section, element->name);
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "id", id);
  spore_cli_number(cli, "influence", out->tried ? out->influence.rms : NAN);
  spore_cli_number(cli, "noise_floor", evidence->floor);
  spore_cli_number(cli, "force_N", out->tried ? out->influence.force : NAN);
  spore_cli_number(cli, "force_floor_N", evidence->force_floor);
  spore_cli_number(cli, "cost_us", out->tried ? out->saved_us : NAN);
  spore_cli_number(cli, "own_motion", evidence->own_motion);
  spore_cli_text(cli, "verdict", spore_verdict_names[element->verdict]);
  spore_cli_text(cli, "reason", element->reason);
  spore_cli_open_array(cli, "forms");
  for (int k = 0; k < SPORE_VERDICT_COUNT; k++) report_form(cli, spore_verdict_names[k], &evidence->forms[k]);
  spore_cli_close_array(cli);
  spore_cli_close(cli);
  g_autofree char *influence = out->tried ? g_strdup_printf("%.2g %%", 100 * out->influence.rms) : g_strdup("-");
  g_autofree char *cost = out->tried ? g_strdup_printf("%.2f us", out->saved_us) : g_strdup("-");
  spore_cli_say(cli, "%-*s %-9s %9s %12s  %s\n", width, element->name, spore_verdict_names[element->verdict], influence,
                cost, element->reason);
}

static void report_suggestions(SporeCli *cli, const SporeAdvice *advice) {
  guint count = 0;
  spore_cli_open_array(cli, "suggestion");
  for (gsize k = 0; k < advice->count; k++) {
    const SporeAdviceElement *element = &advice->elements[k];
    double saved_us;
    const char *change = spore_advice_change(element, &saved_us);
    if (!change) continue;
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "id", element->name);
    spore_cli_text(cli, "change", change);
    spore_cli_number(cli, "saves_us", saved_us);
    spore_cli_close(cli);
    spore_cli_say(cli, _("%s: %s; saves %.1f us of %.1f us a step\n"), element->name, change, saved_us,
                  advice->floor.step_us);
    count++;
  }
  spore_cli_close_array(cli);
  if (count == 0) spore_cli_say(cli, _("nothing to suggest: what is simulated is felt\n"));
  spore_cli_say(cli, _("this holds for this input, over %g s\n"), advice->time_s);
}

static void report(SporeCli *cli, const SporeRun *run, const SporeAdvice *advice) {
  int width = spore_cli_body_width(run->simulation->world);
  spore_cli_say(cli,
                _("noise floor: halving the step, or a start that is a little off, moves bodies by %.2g %% of "
                  "their length, and hands feel %.2g N of it\n"),
                100 * advice->floor.floor, advice->floor.force_floor);
  report_exercise(cli, &advice->exercise, &advice->floor);
  spore_cli_say(cli, "%-*s %-9s %9s %12s  %s\n", width, _("body"), _("verdict"), _("influence"), _("cost"), _("why"));
  spore_cli_open_array(cli, "elements");
  for (gsize k = 0; k < advice->count; k++) report_element(cli, &advice->elements[k], width);
  spore_cli_close_array(cli);
  report_suggestions(cli, advice);
}

/* Writes the scene with the verdicts, where that is asked for. */
static gboolean write_scene(SporeCli *cli, const SporeAdvice *advice, SporeDocument *document, const char *output,
                            GError **error) {
  guint count = output ? spore_advice_count(advice, document) : 0;
  if (!output) return TRUE;
  if (count == 0) {
    spore_cli_say(cli, _("nothing was written: nothing is to be an effect\n"));
    return TRUE;
  }
  if (!spore_advice_apply(advice, document, error) || !spore_cli_save_scene(document, output, error)) return FALSE;
  spore_cli_text(cli, "scene", output);
  spore_cli_say(cli, _("%s: written; so many take what was advised: %u\n"), output, count);
  return TRUE;
}

static int run_advice(SporeCli *cli, const char *scene, const SporeSceneOptions *options,
                      const SporeBudgetRequest *request) {
  GError *error = NULL;
  const char *time = request->time, *output = request->output ? request->output : request->apply ? scene : NULL;
  SporeAdviceOptions how = {.cancel = spore_cli_cancel(), .progress = spore_cli_progress(cli)};
  if (output && !spore_file_may_be_written(output, TRUE, &error)) return spore_cli_fail(error);
  if (time && !spore_cli_seconds("--time", time, &how.time_s, &error)) return spore_cli_fail(error);
  g_autoptr(SporeRun) run = spore_run_open(cli, scene, options, 1, &error);
  if (!run) return spore_cli_fail(error);
  how.pool = run->pool;
  how.input = run->input.channel_count ? &run->input : NULL;
  g_autoptr(SporeAdvice) advice = spore_advice_find(run->document, run->simulation, &how, &error);
  if (advice) report(cli, run, advice);
  gboolean good = advice && write_scene(cli, advice, run->document, output, &error);
  if (spore_cli_interrupted()) {
    g_clear_error(&error);
    return SPORE_EXIT_INTERRUPTED;
  }
  return good ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

static int carry_out(SporeCli *cli, const char *scene, const SporeSceneOptions *options,
                     const SporeBudgetRequest *budget) {
  if (budget->budget) return spore_advise_budget(cli, scene, options, budget);
  if (budget->keep || budget->seconds)
    return spore_cli_usage(_("--keep, --seconds: they go with --budget-us; give a budget, or leave them out"));
  return run_advice(cli, scene, options, budget);
}

int spore_command_advise(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"elements",
       N_("bodies that physics moves, then clamps and emitters: id, influence (without it, how far the others are "
          "elsewhere: root mean square, "
          "by "
          "their length; null: not tried), noise_floor (the same of half the step, or of a start that is a little "
          "off), force_N and force_floor_N (the same of forces on what devices move), cost_us (of a step, that it "
          "takes), own_motion (by its length), verdict (physical, still, coarse, effect), reason, forms (that were "
          "tried: form, influence, worst, force_N, score and same_steps (of the exercise: how far the score is away, "
          "whether the same steps are done), saved_us)")},
      {"exercise",
       N_("the scene's, as the replay did it: phase, score, score_floor (that half the step, or a start that is a "
          "little off, moves the score by), steps, steps_done")},
      {"suggestion", N_("what may be changed: id, change, saves_us")},
      {"budget",
       N_("with --budget-us, where elements tell the verdict (physical, or the level that is taken), integrator and "
          "level of each body: budget_us (for per_s of simulated time), met, kept_promise, promise_us, runs (of "
          "again_us), before and chosen (dt_s, nonlinear, linear, error: by the length of a body, resolved: it is more "
          "than can be told, as_written, us: for per_s, step_us and p99_us of its own steps, again_us: median, low, "
          "high), tried (runs of the search), together (of them, of several changes at once), start_s, time_s, "
          "contacts, floor, happens (what instruments do in one of the two alone), "
          "applied, cut")},
      {"scene", N_("file that was written, with --apply or --output")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {
      "advise",
      "SCENE",
      N_("Replays the scene without the physics of each of its bodies, clamps and emitters, and says which of them "
         "nobody would miss: "
         "physical where "
         "others "
         "feel it, or an effect where what is seen of it is enough. What has an effect is replayed as one. Where the "
         "scene has an exercise, its steps and score have to stay the same, too. The advice holds for the input that "
         "was replayed."),
      1,
      1,
      members};
  SporeSceneOptions options = {0};
  SporeBudgetRequest budget = {0};
  const GOptionEntry entries[] = {
      {"time", 't', 0, G_OPTION_ARG_STRING, &budget.time,
       N_("Simulated time of each replay (default: the recorded input, up to 10 s, of an exercise up to 120 s; without "
          "one 1 s; with --budget-us 1 s with contacts in it)"),
       "S"},
      {"budget-us", 0, 0, G_OPTION_ARG_STRING, &budget.budget,
       N_("Choose the level and integrator of each body, step and solvers, so that what a step of the scene simulates "
          "now takes at most so many us on the processor, with the least error"),
       "N"},
      {"keep", 0, 0, G_OPTION_ARG_STRING_ARRAY, &budget.keep,
       N_("With --budget-us: a body that keeps its level and integrator (may be repeated)"), "BODY"},
      {"seconds", 0, 0, G_OPTION_ARG_STRING, &budget.seconds,
       N_("With --budget-us: time on the processor that choosing may take (default 40)"), "S"},
      {"apply", 0, 0, G_OPTION_ARG_NONE, &budget.apply,
       N_("Write into the scene which bodies are effects, or what was chosen with --budget-us"), NULL},
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &budget.output, N_("The same, to this file"), "F.spore"},
      SPORE_SCENE_OPTION_ENTRIES(options),
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) status = carry_out(cli, argv[1], &options, &budget);
  spore_scene_options_clear(&options);
  g_free(budget.time);
  g_free(budget.budget);
  g_free(budget.seconds);
  g_free(budget.output);
  g_strfreev(budget.keep);
  return status;
}
