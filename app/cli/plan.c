/* spore plan: what a scene needs, what it leaves out, and why. */
#include <glib/gi18n.h>
#include <link.h>

#include "app/cli/cli.h"
#include "app/cli/scene.h"

#define MEASURED_STEPS 200

static void report_stage(SporeCli *cli, const SporePlanStage *stage, gboolean measured) {
  double median_us = measured && stage->profile ? spore_profile_summary(stage->profile).median_us : -1;
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", stage->name);
  json_builder_set_member_name(cli->report, "included");
  json_builder_add_boolean_value(cli->report, stage->included);
  spore_cli_text(cli, "reason", stage->reason);
  spore_cli_count(cli, "items", (gint64)stage->items);
  if (median_us >= 0) spore_cli_number(cli, "measured_us", median_us);
  spore_cli_close(cli);
  g_autofree char *time = median_us >= 0 ? g_strdup_printf("%.2f us", median_us) : g_strdup("-");
  spore_cli_say(cli, "%-11s %-4s %7zu %12s  %s\n", stage->name, stage->included ? _("yes") : _("no"), stage->items,
                time, stage->reason);
}

static int report_library(struct dl_phdr_info *info, gsize size, void *data) {
  (void)size;
  if (info->dlpi_name && g_str_has_prefix(info->dlpi_name, "/")) {
    g_autofree char *name = g_path_get_basename(info->dlpi_name);
    spore_cli_text(data, NULL, name);
  }
  return 0;
}

static void report(SporeCli *cli, const SporePlan *plan, gboolean measured) {
  spore_cli_say(cli, "%-11s %-4s %7s %12s  %s\n", _("stage"), _("in?"), _("items"), _("measured"), _("why"));
  spore_cli_open_array(cli, "stages");
  for (gsize i = 0; i < plan->stage_count; i++) report_stage(cli, &plan->stages[i], measured);
  spore_cli_close_array(cli);
  spore_cli_open_array(cli, "left_out");
  for (gsize i = 0; i < plan->left_out_count; i++) {
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "what", plan->left_out[i].what);
    spore_cli_text(cli, "reason", plan->left_out[i].reason);
    spore_cli_close(cli);
    spore_cli_say(cli, _("left out: %s (%s)\n"), plan->left_out[i].what, plan->left_out[i].reason);
  }
  spore_cli_close_array(cli);
  spore_cli_open_array(cli, "libraries");
  dl_iterate_phdr(report_library, cli);
  spore_cli_close_array(cli);
}

int spore_command_plan(SporeCli *cli, int argc, char **argv) {
  static const SporeCommandInfo info = {"plan", "SCENE", N_("Says what a scene needs, what it leaves out, and why."), 1,
                                        1};
  SporeSceneOptions options = {0};
  gboolean measure = FALSE;
  const GOptionEntry entries[] = {
      {"measure", 0, 0, G_OPTION_ARG_NONE, &measure, N_("Run 200 steps and say what each stage costs"), NULL},
      SPORE_SCENE_OPTION_ENTRIES(options),
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status != SPORE_EXIT_DONE) return status;
  GError *error = NULL;
  g_autoptr(SporeRun) run = spore_run_open(cli, argv[1], &options, 1, &error);
  spore_scene_options_clear(&options);
  if (!run) return spore_cli_fail(error);
  for (int i = 0; measure && i < MEASURED_STEPS && !spore_cli_interrupted(); i++)
    spore_world_step(run->simulation->world);
  report(cli, spore_world_plan(run->simulation->world), measure);
  return spore_cli_finish(cli, spore_cli_interrupted() ? SPORE_EXIT_INTERRUPTED : SPORE_EXIT_DONE);
}
