#include "app/cli/plan_mapping.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/scene/mapping_quality.h"

/* A figure of the table; what does not apply is a dash. */
static const char *figure(double value, char room[16]) {
  g_snprintf(room, 16, isfinite(value) ? "%.1e" : "-", value);
  return room;
}

static void say(const SporeCli *cli, const char *body, int width, const char *unit,
                const SporeMappingQuality *quality) {
  char rest[16], rigid[16], affine[16], bend[16];
  spore_cli_say(cli, "%-*s %-9s %7zu %7.1f %12.3g %9.3g %9s %9s %9s %9s\n", width, body, unit, quality->count,
                100 * (double)quality->off / (double)quality->count, quality->farthest, quality->error.leverage,
                figure(quality->error.rest, rest), figure(quality->error.rigid, rigid),
                figure(quality->error.affine, affine), figure(quality->error.bend, bend));
}

static void report(SporeCli *cli, const SporeObject *body, int width, const char *unit,
                   const SporeMappingQuality *quality) {
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", spore_object_name(body));
  spore_cli_text(cli, "unit", unit);
  spore_cli_count(cli, "points", (gint64)quality->count);
  spore_cli_number(cli, "off_share", (double)quality->off / (double)quality->count);
  spore_cli_number(cli, "farthest_m", quality->farthest);
  spore_cli_number(cli, "leverage", quality->error.leverage);
  spore_cli_number(cli, "rest_error_m", quality->error.rest);
  spore_cli_number(cli, "rigid_error_m", quality->error.rigid);
  spore_cli_number(cli, "affine_error_m", quality->error.affine);
  spore_cli_number(cli, "bend_error_m", quality->error.bend);
  if (quality->framed) {
    spore_cli_number(cli, "crowd", quality->error.crowd);
    spore_cli_number(cli, "crowd_share", quality->error.crowd_share);
    spore_cli_number(cli, "torn_share", quality->error.torn);
  }
  spore_cli_close(cli);
  say(cli, spore_object_name(body), width, unit, quality);
}

void spore_plan_report_mapping(SporeCli *cli, const SporeRun *run) {
  const SporeObject *bodies = spore_document_section(run->document, "bodies");
  gboolean said = FALSE;
  int width = spore_cli_body_width(run->simulation->world);
  spore_cli_open_array(cli, "mappings");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    for (int unit = 0; unit < SPORE_MAPPED_UNITS; unit++) {
      SporeMappingQuality quality;
      if (!spore_mapping_quality_measure(run->simulation, run->document, body, (SporeMappedUnit)unit, &quality, NULL))
        continue;
      if (!said)
        spore_cli_say(cli, "%-*s %-9s %7s %7s %12s %9s %9s %9s %9s %9s\n", width, _("body"), _("carries"), _("points"),
                      _("off, %"), _("farthest, m"), _("leverage"), _("rest, m"), _("rigid, m"), _("affine, m"),
                      _("bend, m"));
      said = TRUE;
      report(cli, body, width, spore_mapped_unit_names[unit], &quality);
    }
  }
  spore_cli_close_array(cli);
}
