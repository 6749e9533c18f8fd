#include "app/cli/plan_lines.h"

#include <glib/gi18n.h>

static void report_line(SporeCli *cli, const SporeWorld *world, guint32 body, const SporeLineState *line,
                        gboolean measured) {
  const SporeModel *model = spore_world_body_model(world, body);
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", spore_world_body_name(world, body));
  spore_cli_count(cli, "made", (gint64)line->made);
  spore_cli_count(cli, "reserve", (gint64)line->reserve);
  spore_cli_count(cli, "dof_most", (gint64)(3 * model->block_room));
  spore_cli_count(cli, "memory_bytes", (gint64)line->memory_bytes);
  spore_cli_say(cli, _("%s: %zu control points, up to %zu as it bends: %zu degrees of freedom then; %.0f kB are kept"),
                spore_world_body_name(world, body), line->made, line->reserve, 3 * model->block_room,
                1e-3 * (double)line->memory_bytes);
  if (measured) {
    spore_cli_number(cli, "look_us", line->look_us);
    spore_cli_number(cli, "change_us", line->change_us);
    spore_cli_say(cli, _("; %.2f us a step to look at its bends, %.1f us when some come or go"), line->look_us,
                  line->change_us);
  }
  spore_cli_say(cli, "\n");
  spore_cli_close(cli);
}

void spore_plan_report_lines(SporeCli *cli, const SporeWorld *world, gboolean measured) {
  SporeLineState line;
  gboolean any = FALSE;
  for (guint32 body = 0; body < spore_world_body_count(world); body++) {
    if (!spore_world_line_state(world, body, &line)) continue;
    if (!any) spore_cli_open_array(cli, "lines");
    any = TRUE;
    report_line(cli, world, body, &line, measured);
  }
  if (any) spore_cli_close_array(cli);
}
