#include "app/cli/plan_levels.h"

#include <glib/gi18n.h>

/* Median time of a step with the body at the level from time 0 on, us. */
static gboolean measure(SporeRun *run, guint32 body, SporeLevelGrade level, int steps, double *median_us,
                        GError **error) {
  SporeSimulation *copy =
      spore_simulation_new(run->document, run->pool, run->input.channel_count ? &run->input : NULL, error);
  if (!copy) return FALSE;
  spore_world_set_level(copy->world, body, level);
  for (int i = 0; i < steps && !spore_cli_interrupted(); i++) spore_world_step(copy->world);
  *median_us = spore_profile_summary(spore_world_profile(copy->world)).median_us;
  spore_simulation_free(copy);
  return TRUE;
}

static void report_level(SporeCli *cli, const SporeWorld *world, guint32 body, SporeLevelGrade level, gboolean active,
                         double median_us) {
  const SporeModel *model = spore_world_level_model(world, body, level);
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "level", spore_level_names[level]);
  json_builder_set_member_name(cli->report, "active");
  json_builder_add_boolean_value(cli->report, active);
  spore_cli_count(cli, "dof", (gint64)(3 * model->block_count));
  spore_cli_count(cli, "spheres", (gint64)spore_world_body_sphere_count(world, body));
  if (median_us >= 0) spore_cli_number(cli, "measured_us", median_us);
  spore_cli_close(cli);
  g_autofree char *time = median_us >= 0 ? g_strdup_printf("%.2f us", median_us) : g_strdup("-");
  spore_cli_say(cli, "%-*s %c %-7s %7zu %7zu %12s\n", spore_cli_body_width(world), spore_world_body_name(world, body),
                active ? '*' : ' ', spore_level_names[level], 3 * model->block_count,
                spore_world_body_sphere_count(world, body), time);
}

static gboolean report_body(SporeCli *cli, SporeRun *run, guint32 body, int steps, GError **error) {
  const SporeWorld *world = run->simulation->world;
  SporeLevelState state;
  gboolean done = TRUE;
  spore_world_level_state(world, body, &state);
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", spore_world_body_name(world, body));
  spore_cli_count(cli, "memory_bytes", (gint64)spore_world_level_memory(world, body));
  spore_cli_open_array(cli, "levels");
  for (int k = 0; done && k < SPORE_LEVEL_COUNT; k++) {
    double median_us = -1;
    if (!spore_world_level_model(world, body, (SporeLevelGrade)k)) continue;
    done = steps == 0 || measure(run, body, (SporeLevelGrade)k, steps, &median_us, error);
    if (done) report_level(cli, world, body, (SporeLevelGrade)k, (int)state.level == k, median_us);
  }
  spore_cli_close_array(cli);
  spore_cli_close(cli);
  return done;
}

gboolean spore_plan_report_levels(SporeCli *cli, SporeRun *run, int steps, GError **error) {
  const SporeWorld *world = run->simulation->world;
  SporeLevelState state;
  gboolean any = FALSE, done = TRUE;
  for (guint32 body = 0; done && body < spore_world_body_count(world); body++) {
    if (!spore_world_level_state(world, body, &state)) continue;
    if (!any) {
      spore_cli_open_array(cli, "levels");
      spore_cli_say(cli, "%-*s   %-7s %7s %7s %12s  %s\n", spore_cli_body_width(world), _("body"), _("level"), _("dof"),
                    _("spheres"), _("a step"), _("(* active; the step is of the whole scene)"));
    }
    any = TRUE;
    done = report_body(cli, run, body, steps, error);
  }
  if (any) spore_cli_close_array(cli);
  return done;
}
