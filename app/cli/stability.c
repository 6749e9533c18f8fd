/* spore stability: what becomes of a scene that is pushed, and how large its steps may be. */
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "app/cli/cli.h"
#include "app/cli/scene.h"
#include "core/author/stability_scene.h"
#include "core/base/memory.h"
#include "core/io/scene_xml.h"

#define SHORT_DETAIL 70  /* characters */
#define DETAIL_INDENT 13 /* of a longer one */
#define MOST_S 240.
#define MOST_QUICK_S 18. /* the scene is read before that, and the last step ends after it */

typedef struct StabilityOptions {
  gboolean quick;
  char *svg, *time, *seconds;
  SporeSceneOptions scene;
} StabilityOptions;

/* A long detail gets a line of its own. */
static void say_case(SporeCli *cli, const SporeStabilityCase *each, int width) {
  const char *label = _(each->label), *verdict = _(spore_stability_verdicts[each->verdict]);
  int blanks = width - (int)g_utf8_strlen(label, -1);
  if (g_utf8_strlen(each->detail, -1) <= SHORT_DETAIL)
    spore_cli_say(cli, "%-9s  %s%*s  %s\n", verdict, label, blanks, "", each->detail);
  else spore_cli_say(cli, "%-9s  %s\n%*s%s\n", verdict, label, DETAIL_INDENT, "", each->detail);
}

static void report_cases(SporeCli *cli, const SporeStabilityReport *report) {
  int width = 0;
  for (gsize i = 0; i < report->case_count; i++) width = MAX(width, (int)g_utf8_strlen(_(report->cases[i].label), -1));
  spore_cli_open_array(cli, "cases");
  for (gsize i = 0; i < report->case_count; i++) {
    const SporeStabilityCase *each = &report->cases[i];
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", each->name);
    spore_cli_text(cli, "verdict", spore_stability_verdicts[each->verdict]);
    spore_cli_text(cli, "detail", each->detail);
    spore_cli_close(cli);
    say_case(cli, each, width);
  }
  spore_cli_close_array(cli);
}

/* A step in ms or us; "any" where there is no limit, "none" where no step is safe. */
static char *step_text(double step_s) {
  if (isinf(step_s)) return g_strdup(_("any"));
  if (step_s == 0) return g_strdup(_("none"));
  return step_s < 1e-5 ? g_strdup_printf("%.3g us", 1e6 * step_s) : g_strdup_printf("%.3g ms", 1e3 * step_s);
}

static const char *outcome_text(SporeMethodOutcome outcome) {
  if (outcome == SPORE_METHOD_NOT_SOLVED) return _("not solved");
  return outcome == SPORE_METHOD_NOT_FINITE ? _("not finite") : _("energy grows");
}

/* What is known of larger steps than the largest safe one. */
static char *beyond_text(const SporeStabilityLimit *limit) {
  g_autofree char *unsafe = step_text(limit->found.unsafe_s);
  if (limit->method == SPORE_INTEGRATOR_EXPLICIT_EULER && limit->found.safe_s > 1.5 * limit->predicted_s)
    return g_strdup_printf(_("below, it grows too slowly for %zu steps to show"), limit->steps);
  if (!isinf(limit->found.unsafe_s)) return g_strdup_printf(_("%s at %s"), outcome_text(limit->beyond), unsafe);
  return g_strdup(limit->found.safe_s >= SPORE_STABILITY_LARGEST_STEP_S ? _("no scene may have a larger one")
                                                                        : _("larger ones were not tried"));
}

static void say_limit(SporeCli *cli, const SporeStabilityLimit *limit, int width) {
  g_autofree char *predicted = step_text(limit->predicted_s), *safe = step_text(limit->found.safe_s),
                  *own = step_text(limit->step_s), *beyond = beyond_text(limit);
  const char *note = !limit->own                              ? ""
                     : limit->step_s <= limit->found.safe_s   ? _("; the scene's")
                     : limit->step_s >= limit->found.unsafe_s ? _("; the scene's, and its step is too large")
                                                              : _("; the scene's, and its step is close to it");
  spore_cli_say(cli, "%-*s  %-17s  %10s  %10s  %10s  %s%s\n", width, limit->body, spore_integrator_names[limit->method],
                own, predicted, safe, beyond, note);
}

static void report_limits(SporeCli *cli, const SporeStabilityReport *report) {
  int width = 12;
  for (gsize i = 0; i < report->limit_count; i++) width = MAX(width, (int)strlen(report->limits[i].body));
  if (report->limit_count > 0)
    spore_cli_say(cli,
                  _("\nLargest step that each method bears on each body alone, slightly pushed, with no recovery\n"
                    "%-*s  %-17s  %10s  %10s  %10s\n"),
                  width, _("body"), _("method"), _("step now"), _("by theory"), _("measured"));
  spore_cli_open_array(cli, "dt_limit_s");
  for (gsize i = 0; i < report->limit_count; i++) {
    const SporeStabilityLimit *limit = &report->limits[i];
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "body", limit->body);
    spore_cli_text(cli, "method", spore_integrator_names[limit->method]);
    json_builder_set_member_name(cli->report, "own");
    json_builder_add_boolean_value(cli->report, limit->own);
    spore_cli_number(cli, "step_s", limit->step_s);
    spore_cli_number(cli, "predicted_s", limit->predicted_s);
    spore_cli_number(cli, "safe_s", limit->found.safe_s);
    spore_cli_number(cli, "unsafe_s", limit->found.unsafe_s);
    spore_cli_close(cli);
    say_limit(cli, limit, width);
  }
  spore_cli_close_array(cli);
}

static void report_map(SporeCli *cli, const SporeStabilityMap *map) {
  spore_cli_open(cli, "map");
  spore_cli_open_array(cli, "time_step_s");
  for (gsize c = 0; c < map->columns; c++) spore_cli_number(cli, NULL, map->time_step_s[c]);
  spore_cli_close_array(cli);
  spore_cli_open_array(cli, "stiffness");
  for (gsize r = 0; r < map->rows; r++) spore_cli_number(cli, NULL, map->stiffness[r]);
  spore_cli_close_array(cli);
  spore_cli_open_array(cli, "verdicts");
  for (gsize r = 0; r < map->rows; r++) {
    spore_cli_open_array(cli, NULL);
    for (gsize c = 0; c < map->columns; c++)
      spore_cli_text(cli, NULL, map->known[r][c] ? spore_stability_verdicts[map->cells[r][c]] : NULL);
    spore_cli_close_array(cli);
  }
  spore_cli_close_array(cli);
  spore_cli_close(cli);
}

static void report_left_out(SporeCli *cli, const SporeStabilityReport *report) {
  spore_cli_open_array(cli, "left_out");
  if (report->left_out_count > 0) spore_cli_say(cli, _("\nLeft out\n"));
  for (gsize i = 0; i < report->left_out_count; i++) {
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "what", report->left_out[i].what);
    spore_cli_text(cli, "reason", report->left_out[i].why);
    spore_cli_close(cli);
    spore_cli_say(cli, "  %s: %s\n", report->left_out[i].why, report->left_out[i].what);
  }
  spore_cli_close_array(cli);
}

static int report(SporeCli *cli, const char *scene, const SporeStabilityReport *study) {
  gsize failed = spore_stability_count(study, SPORE_STABILITY_FAILED);
  gsize stable = spore_stability_count(study, SPORE_STABILITY_STABLE);
  spore_cli_text(cli, "scene", scene);
  spore_cli_number(cli, "time_step_s", study->time_step_s);
  spore_cli_count(cli, "steps", (gint64)study->steps);
  report_cases(cli, study);
  report_limits(cli, study);
  if (study->map.columns > 0) report_map(cli, &study->map);
  report_left_out(cli, study);
  spore_cli_say(cli, _("\n%zu cases of %zu steps of %.3g ms: %zu stable, %zu recovered, %zu failed\n"),
                study->case_count, study->steps, 1e3 * study->time_step_s, stable, study->case_count - stable - failed,
                failed);
  if (study->instruments && !study->met)
    spore_cli_say(cli, _("no instrument meets anything within these steps; a longer --time may say more\n"));
  return failed > 0 ? SPORE_EXIT_NOT_HELD : SPORE_EXIT_DONE;
}

static gboolean write_map(const SporeStabilityReport *study, const char *scene, const char *file, GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  g_autofree char *name = g_path_get_basename(scene),
                  *title = g_strdup_printf(_("%s: stability by step and stiffness"), name);
  char *svg = spore_stability_map_svg(study, title, &fault);
  if (!svg) return spore_error_propagate(&fault, error);
  gboolean written = spore_write_file(file, svg, strlen(svg), error);
  spore_free(svg);
  return written;
}

/* Seconds that an option gives; fallback where it is not given. FALSE: they are none, or 0. */
static gboolean read_seconds(const char *option, const char *text, double fallback, double *seconds, GError **error) {
  *seconds = fallback;
  if (!text) return TRUE;
  if (!spore_cli_seconds(option, text, seconds, error)) return FALSE;
  return *seconds > 0 || spore_error_raise(error, SPORE_ERROR_INPUT, option, _("0 s; expected more than 0 s"));
}

static int run(SporeCli *cli, const char *scene, const StabilityOptions *options) {
  GError *error = NULL;
  SporeStabilityOptions study = {
      .quick = options->quick, .map = options->svg != NULL || !options->quick, .progress = spore_cli_progress(cli)};
  if (!read_seconds("--time", options->time, 0, &study.time_s, &error) ||
      !read_seconds("--seconds", options->seconds, options->quick ? MOST_QUICK_S : MOST_S, &study.most_s, &error) ||
      (options->svg && !spore_cli_has_room(options->svg, scene, &error)))
    return spore_cli_fail(error);
  g_autoptr(SporeRun) opened = spore_run_open(cli, scene, &options->scene, 1, &error);
  if (!opened) return spore_cli_fail(error);
  SporeVariedScene *varied = spore_varied_scene_new(opened->document, opened->pool,
                                                    options->scene.input ? &opened->input : NULL, spore_cli_cancel());
  SporeStabilityScene worlds = spore_varied_scene_worlds(varied);
  SporeError fault = SPORE_ERROR_INIT;
  SporeStabilityReport *found = spore_stability_study(&worlds, &study, &fault);
  int status = SPORE_EXIT_DONE;
  if (!found) {
    spore_error_propagate(&fault, &error);
    status = spore_cli_fail(error);
  } else if (options->svg && !write_map(found, scene, options->svg, &error)) {
    status = spore_cli_fail(error);
  } else {
    status = spore_cli_finish(cli, report(cli, scene, found));
  }
  spore_stability_report_free(found);
  spore_varied_scene_free(varied);
  return status;
}

int spore_command_stability(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"scene", N_("file of the scene")},
      {"time_step_s", N_("of the scene, s")},
      {"steps", N_("of a case, in steps of the scene")},
      {"cases",
       N_("each one's name, verdict (stable, recovered, failed) and detail. recovered: the program met trouble, "
          "said so, and went on with a finite state and bounded energy, or it refused the scene with the remedy")},
      {"dt_limit_s",
       N_("of each body and method, alone and without recovery, s: step_s (now), predicted_s (by the stiffest "
          "mode; null: any), safe_s (largest tried that is safe; 0: none), unsafe_s (smallest tried that "
          "is not; null: none); own (the method is the scene's)")},
      {"map", N_("verdicts by stiffness (rows, factors) and time_step_s (columns); null where left out")},
      {"left_out", N_("what was not tried, and the reason")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {"stability",
                                        "SCENE",
                                        N_("Pushes a scene: larger steps, stiffer and heavier bodies, instruments that "
                                           "rush, input that is no number, bad "
                                           "starts and parameters that jump; says what came of it, and the largest "
                                           "step of each body and method. The exit "
                                           "status is 1 where a case failed."),
                                        1,
                                        1,
                                        members};
  StabilityOptions options = {0};
  const GOptionEntry entries[] = {
      {"quick", 0, 0, G_OPTION_ARG_NONE, &options.quick,
       N_("In less than 20 s: fewer cases of 100 steps, and each body by its own method alone"), NULL},
      {"svg", 0, 0, G_OPTION_ARG_FILENAME, &options.svg, N_("Write the map of steps and stiffnesses as a picture"),
       "FILE"},
      {"time", 't', 0, G_OPTION_ARG_STRING, &options.time, N_("Simulated time of a case"), "S"},
      {"seconds", 0, 0, G_OPTION_ARG_STRING, &options.seconds,
       N_("Time that it all may take (default 240; with --quick 18); what does not fit is left out, and said"), "S"},
      SPORE_SCENE_OPTION_ENTRIES(options.scene),
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) status = run(cli, argv[1], &options);
  spore_scene_options_clear(&options.scene);
  g_free(options.svg);
  g_free(options.time);
  g_free(options.seconds);
  return status;
}
