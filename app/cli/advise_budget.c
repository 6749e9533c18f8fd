/* spore advise --budget-us: what was chosen, what it gives up, and whether it costs what was promised. */
#include "app/cli/advise_budget.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/author/budget.h"
#include "core/base/number.h"
#include "core/io/scene_xml.h"

#define MOST_US 1e9
#define LEAST_SECONDS 1
#define MOST_SECONDS 1e4

static gboolean read_budget(const char *text, double *budget_us, GError **error) {
  gsize length = strlen(text);
  gboolean good = length > 0 && spore_number_read(text, length, budget_us) == length;
  return (good && *budget_us > 0 && *budget_us <= MOST_US) ||
         spore_error_raise(error, SPORE_ERROR_INPUT, "--budget-us",
                           _("'%s' is no budget; expected a time above 0, at most %g us; such as 1000"), text, MOST_US);
}

static gboolean read_range(const char *option, const char *text, double least, double most, double *seconds,
                           GError **error) {
  if (!text) return TRUE;
  if (!spore_cli_seconds(option, text, seconds, error)) return FALSE;
  return (*seconds >= least && *seconds <= most) ||
         spore_error_raise(error, SPORE_ERROR_INPUT, option, _("%s s; expected %g s to %g s"), text, least, most);
}

static gboolean read_request(const SporeBudgetRequest *request, SporeBudgetOptions *options, GError **error) {
  options->kept = (const char *const *)request->keep;
  return read_budget(request->budget, &options->budget_us, error) &&
         read_range("--time", request->time, 1e-3, 1e3, &options->time_s, error) &&
         read_range("--seconds", request->seconds, LEAST_SECONDS, MOST_SECONDS, &options->most_s, error);
}

static gboolean check_kept(SporeDocument *document, char **names, GError **error) {
  for (char **name = names; name && *name; name++)
    if (!spore_cli_find_body(document, "--keep", *name, error)) return FALSE;
  return TRUE;
}

static void report_form(SporeCli *cli, const char *member, const SporeBudgetForm *form) {
  spore_cli_open(cli, member);
  spore_cli_number(cli, "dt_s", form->dt_s);
  spore_cli_text(cli, "nonlinear", form->nonlinear);
  spore_cli_text(cli, "linear", form->linear);
  spore_cli_number(cli, "error", form->error);
  spore_cli_count(cli, "resolved", form->resolved);
  spore_cli_count(cli, "as_written", form->as_written);
  spore_cli_number(cli, "us", form->us);
  spore_cli_number(cli, "step_us", form->step_us);
  spore_cli_number(cli, "p99_us", form->p99_us);
  spore_cli_open(cli, "again_us");
  spore_cli_number(cli, "median", form->median_us > 0 ? form->median_us : NAN);
  spore_cli_number(cli, "low", form->median_us > 0 ? form->low_us : NAN);
  spore_cli_number(cli, "high", form->median_us > 0 ? form->high_us : NAN);
  spore_cli_close(cli);
  spore_cli_close(cli);
}

static void report_elements(SporeCli *cli, const SporeBudget *budget) {
  spore_cli_open_array(cli, "elements");
  for (gsize i = 0; i < budget->body_count; i++) {
    const SporeBudgetBody *body = &budget->bodies[i];
    g_autofree char *id = g_strdup_printf("bodies/%s", body->name), *changes = spore_budget_body_change(body);
    gboolean coarser = body->level[0] && !g_str_equal(body->level[0], body->level[1]);
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "id", id);
    spore_cli_number(cli, "influence", NAN);
    spore_cli_number(cli, "noise_floor", budget->floor);
    spore_cli_number(cli, "cost_us", NAN);
    spore_cli_text(cli, "verdict", coarser ? body->level[1] : "physical");
    spore_cli_text(cli, "reason", changes ? changes : body->reason ? body->reason : _("as it is"));
    spore_cli_text(cli, "integrator", body->integrator[1]);
    if (body->level[1]) spore_cli_text(cli, "level", body->level[1]);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
}

static void report_suggestions(SporeCli *cli, const SporeBudget *budget) {
  g_autoptr(GArray) changes = spore_budget_list_changes(budget);
  spore_cli_open_array(cli, "suggestion");
  for (guint i = 0; i < changes->len; i++) {
    const SporeBudgetChange *change = &g_array_index(changes, SporeBudgetChange, i);
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "id", change->id);
    spore_cli_text(cli, "change", change->text);
    spore_cli_close(cli);
    spore_cli_say(cli, "  %s: %s\n", change->id, change->text);
  }
  spore_cli_close_array(cli);
  if (changes->len == 0) spore_cli_say(cli, _("  nothing: nothing that was tried is better\n"));
}

static void report_budget(SporeCli *cli, const SporeBudget *budget, gboolean applied) {
  spore_cli_open(cli, "budget");
  spore_cli_number(cli, "budget_us", budget->budget_us);
  spore_cli_number(cli, "per_s", budget->step_s);
  spore_cli_count(cli, "met", budget->met);
  spore_cli_count(cli, "kept_promise", budget->kept_promise);
  spore_cli_number(cli, "promise_us", budget->chosen.us);
  spore_cli_count(cli, "runs", budget->chosen.median_us > 0 ? SPORE_BUDGET_RUNS : 0);
  report_form(cli, "before", &budget->before);
  report_form(cli, "chosen", &budget->chosen);
  spore_cli_count(cli, "tried", budget->tried);
  spore_cli_count(cli, "together", budget->together);
  spore_cli_number(cli, "start_s", budget->start_s);
  spore_cli_number(cli, "time_s", budget->time_s);
  spore_cli_number(cli, "contacts", budget->contacts);
  spore_cli_number(cli, "floor", budget->floor);
  if (budget->happens) spore_cli_text(cli, "happens", budget->happens);
  spore_cli_count(cli, "applied", applied);
  spore_cli_open_array(cli, "cut");
  for (char **cut = budget->cuts; *cut; cut++) spore_cli_text(cli, NULL, *cut);
  spore_cli_close_array(cli);
  spore_cli_close(cli);
}

static void say_form(SporeCli *cli, const char *name, const SporeBudgetForm *form) {
  g_autofree char *error = spore_budget_error_text(form);
  spore_cli_say(cli, "%-10s %9.4g %14s %12.4g\n", name, 1e3 * form->dt_s, error, form->us);
}

static void say_chosen(SporeCli *cli, const SporeBudget *budget) {
  const SporeBudgetForm *before = &budget->before, *chosen = &budget->chosen;
  spore_cli_say(cli, _("budget: %g us for each %g ms that are simulated, %.3g times as fast as real time\n"),
                budget->budget_us, 1e3 * budget->step_s, 1e6 * budget->step_s / budget->budget_us);
  spore_cli_say(cli,
                _("measured over %.3g s of the input from %.3g s on, with %.2g contacts a step; %u other choices "
                  "were run, %u of them of several changes at once\n"),
                budget->time_s, budget->start_s, budget->contacts, budget->tried, budget->together);
  spore_cli_say(cli, "%-10s %9s %14s %12s\n", "", _("step ms"), _("error"), _("us"));
  say_form(cli, _("as it is"), before);
  say_form(cli, _("chosen"), chosen);
  spore_cli_say(cli, _("changes:\n"));
}

static void say_again(SporeCli *cli, const SporeBudget *budget) {
  const SporeBudgetForm *before = &budget->before, *chosen = &budget->chosen;
  spore_cli_say(cli,
                _("timed again, %d runs of each in turn: %.4g us (%.4g to %.4g) as it is, %.4g us (%.4g to %.4g) as "
                  "chosen\n"),
                SPORE_BUDGET_RUNS, before->median_us, before->low_us, before->high_us, chosen->median_us,
                chosen->low_us, chosen->high_us);
  double off = 100 * (chosen->median_us / chosen->us - 1), within = 100 * SPORE_BUDGET_WITHIN;
  if (budget->kept_promise)
    spore_cli_say(cli, _("the promise of %.4g us held: it is %+.1f %% off (%g %% are allowed)\n"), chosen->us, off,
                  within);
  else
    spore_cli_say(cli,
                  _("the promise of %.4g us did not hold: it is %+.1f %% off (%g %% are allowed); the machine may be "
                    "busy: run it again\n"),
                  chosen->us, off, within);
  if (!budget->met)
    spore_cli_say(cli, _("the budget is not met: %.4g us of %g us; run it again, or allow more\n"), chosen->median_us,
                  budget->budget_us);
}

static void say_warnings(SporeCli *cli, const SporeBudget *budget) {
  if (budget->happens)
    spore_cli_say(cli, _("mind: in one of the two alone %s; look at both before you take it\n"), budget->happens);
  if (!budget->chosen.as_written)
    spore_cli_say(cli, _("mind: some steps are not solved as they are written, as it is and as chosen\n"));
  for (gsize i = 0; i < budget->body_count; i++)
    if (budget->bodies[i].reason)
      spore_cli_say(cli, _("%s keeps its level: %s\n"), budget->bodies[i].name, budget->bodies[i].reason);
  for (char **cut = budget->cuts; *cut; cut++) spore_cli_say(cli, _("cut: %s\n"), *cut);
}

/* One line, with the nearest that can be had. */
static void say_unmet(SporeCli *cli, const SporeBudget *budget) {
  g_autofree char *error = spore_budget_error_text(&budget->chosen);
  spore_cli_say(cli,
                _("%g us for each %g ms cannot be met: the nearest that was found takes %.4g us (steps of %.4g ms, "
                  "error %s); allow as much, or add coarser levels to the bodies\n"),
                budget->budget_us, 1e3 * budget->step_s, budget->chosen.us, 1e3 * budget->chosen.dt_s, error);
}

static gboolean write_scene(SporeCli *cli, SporeDocument *document, const SporeBudget *budget, const char *output,
                            GError **error) {
  if (!spore_budget_apply(budget, document, error) || !spore_cli_save_scene(document, output, error)) return FALSE;
  spore_cli_text(cli, "scene", output);
  spore_cli_say(cli, _("%s: written\n"), output);
  return TRUE;
}

static int report(SporeCli *cli, const char *scene, const SporeBudgetRequest *request, SporeDocument *document,
                  const SporeBudget *budget) {
  GError *error = NULL;
  gboolean fits = budget->chosen.median_us > 0, wanted = request->apply || request->output;
  gboolean applied = wanted && fits && budget->met;
  if (!fits) say_unmet(cli, budget);
  SporeCli mute = *cli; /* what cannot be met is told in one line */
  mute.quiet |= !fits;
  say_chosen(&mute, budget);
  report_elements(cli, budget);
  report_suggestions(&mute, budget);
  if (fits) say_again(cli, budget);
  say_warnings(&mute, budget);
  report_budget(cli, budget, applied);
  if (applied && !write_scene(cli, document, budget, request->output ? request->output : scene, &error))
    return spore_cli_fail(error);
  if (wanted && fits && !applied) spore_cli_say(cli, _("nothing was written, since the budget is not met\n"));
  return spore_cli_finish(cli, budget->met && budget->kept_promise ? SPORE_EXIT_DONE : SPORE_EXIT_NOT_HELD);
}

int spore_advise_budget(SporeCli *cli, const char *scene, const SporeSceneOptions *options,
                        const SporeBudgetRequest *request) {
  GError *error = NULL;
  SporeBudgetOptions wanted = {.cancel = spore_cli_cancel(), .progress = spore_cli_progress(cli)};
  const char *output = request->output ? request->output : scene;
  if (!read_request(request, &wanted, &error)) return spore_cli_fail(error);
  if ((request->apply || request->output) && !spore_file_may_be_written(output, TRUE, &error))
    return spore_cli_fail(error);
  g_autoptr(SporeRun) run = spore_run_open(cli, scene, options, 1, &error);
  if (!run || !check_kept(run->document, request->keep, &error)) return spore_cli_fail(error);
  const SporeTrack *input = run->input.channel_count ? &run->input : NULL;
  g_autoptr(SporeBudget) budget = spore_budget_find(run->document, run->simulation, run->pool, input, &wanted, &error);
  if (spore_cli_interrupted()) {
    g_clear_error(&error);
    return SPORE_EXIT_INTERRUPTED;
  }
  if (!budget) return spore_cli_fail(error);
  spore_progress(wanted.progress, 1, NULL);
  return report(cli, scene, request, run->document, budget);
}
