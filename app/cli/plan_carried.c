#include "app/cli/plan_carried.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/scene/carried.h"

/* A figure of the table; what does not apply is a dash. */
static const char *figure(double value, char room[16]) {
  g_snprintf(room, 16, isfinite(value) ? "%.1e" : "-", value);
  return room;
}

static void say(const SporeCli *cli, const char *body, int width, const char *unit, const SporeCarried *carried) {
  char rest[16], rigid[16], affine[16], bend[16];
  spore_cli_say(cli, "%-*s %-9s %7zu %7.1f %12.3g %9.3g %9s %9s %9s %9s\n", width, body, unit, carried->count,
                100 * (double)carried->off / (double)carried->count, carried->farthest, carried->error.leverage,
                figure(carried->error.rest, rest), figure(carried->error.rigid, rigid),
                figure(carried->error.affine, affine), figure(carried->error.bend, bend));
}

static void report(SporeCli *cli, const SporeObject *body, int width, const char *unit, const SporeCarried *carried) {
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", spore_object_name(body));
  spore_cli_text(cli, "unit", unit);
  spore_cli_count(cli, "points", (gint64)carried->count);
  spore_cli_number(cli, "off_share", (double)carried->off / (double)carried->count);
  spore_cli_number(cli, "farthest_m", carried->farthest);
  spore_cli_number(cli, "leverage", carried->error.leverage);
  spore_cli_number(cli, "rest_error_m", carried->error.rest);
  spore_cli_number(cli, "rigid_error_m", carried->error.rigid);
  spore_cli_number(cli, "affine_error_m", carried->error.affine);
  spore_cli_number(cli, "bend_error_m", carried->error.bend);
  if (carried->framed) {
    spore_cli_number(cli, "crowd", carried->error.crowd);
    spore_cli_number(cli, "crowd_share", carried->error.crowd_share);
    spore_cli_number(cli, "torn_share", carried->error.torn);
  }
  spore_cli_close(cli);
  say(cli, spore_object_name(body), width, unit, carried);
}

void spore_plan_report_carried(SporeCli *cli, const SporeRun *run) {
  const SporeObject *bodies = spore_document_section(run->document, "bodies");
  gboolean said = FALSE;
  int width = spore_cli_body_width(run->simulation->world);
  spore_cli_open_array(cli, "mappings");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    for (int unit = 0; unit < SPORE_CARRIED_COUNT; unit++) {
      SporeCarried carried;
      if (!spore_carried_measure(run->simulation, run->document, body, (SporeCarriedUnit)unit, &carried, NULL))
        continue;
      if (!said)
        spore_cli_say(cli, "%-*s %-9s %7s %7s %12s %9s %9s %9s %9s %9s\n", width, _("body"), _("carries"), _("points"),
                      _("off, %"), _("farthest, m"), _("leverage"), _("rest, m"), _("rigid, m"), _("affine, m"),
                      _("bend, m"));
      said = TRUE;
      report(cli, body, width, spore_carried_units[unit], &carried);
    }
  }
  spore_cli_close_array(cli);
}
