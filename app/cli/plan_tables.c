/* Tables of spore plan about bodies: how well points follow what moves them, and what levels and control points cost.
 */
#include "app/cli/plan_tables.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/scene/variation.h"
#include "core/scene/mapping_quality.h"
#include "core/scene/pinned_line.h"
#include "core/scene/pinned_sheet.h"

/* Points that follow a body. */

/* A figure of the table; a dash where the figure does not apply. */
static const char *figure(double value, char room[16]) {
  g_snprintf(room, 16, isfinite(value) ? "%.1e" : "-", value);
  return room;
}

static void say_unit(const SporeCli *cli, const char *body, int width, const char *unit,
                     const SporeMappingQuality *quality) {
  char rest[16], rigid[16], affine[16], bend[16];
  spore_cli_say(cli, "%-*s %-9s %7zu %7.1f %12.3g %9.3g %9s %9s %9s %9s\n", width, body, unit, quality->count,
                100 * (double)quality->off / (double)quality->count, quality->farthest, quality->error.leverage,
                figure(quality->error.rest, rest), figure(quality->error.rigid, rigid),
                figure(quality->error.affine, affine), figure(quality->error.bend, bend));
}

static void report_unit(SporeCli *cli, const SporeObject *body, int width, const char *unit,
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
  say_unit(cli, spore_object_name(body), width, unit, quality);
}

void spore_plan_report_mapping(SporeCli *cli, const SporeRun *run) {
  const SporeObject *bodies = spore_document_section(run->document, "bodies");
  gboolean titled = FALSE;
  int width = spore_cli_body_width(run->simulation->world);
  spore_cli_open_array(cli, "mappings");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    for (int unit = 0; unit < SPORE_MAPPED_UNITS; unit++) {
      SporeMappingQuality quality;
      if (!spore_mapping_quality_measure(run->simulation, run->document, body, (SporeMappedUnit)unit, &quality, NULL))
        continue;
      if (!titled)
        spore_cli_say(cli, "%-*s %-9s %7s %7s %12s %9s %9s %9s %9s %9s\n", width, _("body"), _("unit"), _("points"),
                      _("off, %"), _("farthest, m"), _("leverage"), _("rest, m"), _("rigid, m"), _("affine, m"),
                      _("bend, m"));
      titled = TRUE;
      report_unit(cli, body, width, spore_mapped_unit_names[unit], &quality);
    }
  }
  spore_cli_close_array(cli);
}

/* Pins on lines and sheets. */

static void report_pin(SporeCli *cli, const SporeObject *pin, const char *towards, const SporePinnedSide *side) {
  const char *body = spore_object_name(spore_object_reference(pin, "body"));
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", spore_object_name(pin));
  spore_cli_text(cli, "body", body);
  spore_cli_text(cli, "side", towards);
  spore_cli_count(cli, "held", (gint64)side->held);
  spore_cli_number(cli, "clamp_beyond_m", side->turns ? NAN : side->beyond_m);
  spore_cli_number(cli, "free_m", side->free_m);
  spore_cli_close(cli);
  if (side->turns)
    spore_cli_say(cli, _("pin %s: holds %zu control points of %s, which can turn there\n"), spore_object_name(pin),
                  side->held, body);
  else
    spore_cli_say(cli,
                  _("pin %s: holds %zu control points of %s, which bends as if it were clamped %.2g m "
                    "within the pin's radius\n"),
                  spore_object_name(pin), side->held, body, fmax(0, -side->beyond_m));
}

static void report_sheet(SporeCli *cli, const SporeObject *pin, const SporePinnedSheet *sheet) {
  const char *name = spore_object_name(pin), *body = spore_object_name(spore_object_reference(pin, "body"));
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", name);
  spore_cli_text(cli, "body", body);
  spore_cli_text(cli, "side", "sheet");
  spore_cli_count(cli, "held", (gint64)sheet->held);
  spore_cli_number(cli, "moves_m", sheet->still ? sheet->moves_m : NAN);
  spore_cli_number(cli, "free_m", sheet->free_m);
  spore_cli_close(cli);
  if (sheet->still)
    spore_cli_say(
        cli,
        _("pin %s: holds %zu control points of %s, which stands still deeper than %.2g m within the pin's radius\n"),
        name, sheet->held, body, sheet->moves_m);
  else
    spore_cli_say(cli,
                  _("pin %s: holds %zu control points of %s, of which no place within the pin's radius stands still\n"),
                  name, sheet->held, body);
}

void spore_plan_report_pins(SporeCli *cli, const SporeRun *run) {
  const SporeObject *links = spore_document_section(run->document, "links");
  spore_cli_open_array(cli, "pins");
  for (guint i = 0; i < spore_object_child_count(links); i++) {
    SporeObject *link = spore_object_child(links, i);
    SporePinnedSide side;
    if (strcmp(spore_object_type(link)->element, "pin") != 0) continue;
    SporePinnedSheet sheet;
    if (spore_pinned_sheet_measure(run->simulation, link, &sheet)) report_sheet(cli, link, &sheet);
    if (spore_pinned_side_measure(run->simulation, link, -1, &side)) report_pin(cli, link, "start", &side);
    if (spore_pinned_side_measure(run->simulation, link, 1, &side)) report_pin(cli, link, "end", &side);
  }
  spore_cli_close_array(cli);
}

/* Levels. */

/* Median time of a step with the body at the level from time 0 on, us. */
static gboolean measure(SporeRun *run, guint32 body, SporeLodGrade level, int steps, double *median_us,
                        GError **error) {
  const SporeVariation at_level = {.body = spore_world_body_name(run->simulation->world, body),
                                   .level = spore_lod_names[level]};
  SporeSimulation *copy = spore_variation_make(
      run->document, &at_level, run->pool, run->input.channel_count ? &run->input : NULL, spore_cli_cancel(), error);
  if (!copy) return FALSE;
  for (int i = 0; i < steps && !spore_cli_interrupted(); i++) spore_world_step(copy->world);
  *median_us = spore_profile_summary(spore_world_profile(copy->world)).median_us;
  spore_simulation_free(copy);
  return TRUE;
}

static void report_level(SporeCli *cli, const SporeWorld *world, guint32 body, SporeLodGrade level, gboolean active,
                         double median_us) {
  const SporeModel *model = spore_world_lod_model(world, body, level);
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "level", spore_lod_names[level]);
  json_builder_set_member_name(cli->report, "active");
  json_builder_add_boolean_value(cli->report, active);
  spore_cli_count(cli, "dof", (gint64)(3 * model->block_count));
  spore_cli_count(cli, "spheres", (gint64)spore_world_body_sphere_count(world, body));
  if (median_us >= 0) spore_cli_number(cli, "measured_us", median_us);
  spore_cli_close(cli);
  g_autofree char *time = median_us >= 0 ? g_strdup_printf("%.2f us", median_us) : g_strdup("-");
  spore_cli_say(cli, "%-*s %c %-7s %7zu %7zu %12s\n", spore_cli_body_width(world), spore_world_body_name(world, body),
                active ? '*' : ' ', spore_lod_names[level], 3 * model->block_count,
                spore_world_body_sphere_count(world, body), time);
}

/* How the body changes its level by itself. */
static void report_rule(SporeCli *cli, const SporeWorld *world, guint32 body) {
  const char *name = spore_world_body_name(world, body);
  SporeLodRule rule = spore_world_lod_rule(world, body);
  spore_cli_text(cli, "automatic", spore_lod_cause_names[rule.by]);
  if (rule.by == SPORE_LOD_BY_ERROR)
    spore_cli_say(cli, _("%s changes its level by itself, so that its estimated error stays within its tolerance\n"),
                  name);
  if (rule.by == SPORE_LOD_BY_DISTANCE)
    spore_cli_say(cli, _("%s changes its level by itself: it is fine within %g m of a tool, and %g m of a camera\n"),
                  name, rule.tool_distance, rule.view_distance);
  if (rule.by == SPORE_LOD_BY_TIME)
    spore_cli_say(cli,
                  _("%s changes its level by itself, by the time that steps take: two runs of this scene may differ\n"),
                  name);
}

static gboolean report_body(SporeCli *cli, SporeRun *run, guint32 body, int steps, GError **error) {
  const SporeWorld *world = run->simulation->world;
  SporeLodState state;
  gboolean done = TRUE;
  spore_world_lod_state(world, body, &state);
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", spore_world_body_name(world, body));
  spore_cli_count(cli, "memory_bytes", (gint64)spore_world_lod_memory(world, body));
  spore_cli_open_array(cli, "levels");
  for (int k = 0; done && k < SPORE_LOD_COUNT; k++) {
    double median_us = -1;
    if (!spore_world_lod_model(world, body, (SporeLodGrade)k)) continue;
    done = steps == 0 || measure(run, body, (SporeLodGrade)k, steps, &median_us, error);
    if (done) report_level(cli, world, body, (SporeLodGrade)k, (int)state.level == k, median_us);
  }
  spore_cli_close_array(cli);
  report_rule(cli, world, body);
  spore_cli_close(cli);
  return done;
}

gboolean spore_plan_report_levels(SporeCli *cli, SporeRun *run, int steps, GError **error) {
  const SporeWorld *world = run->simulation->world;
  SporeLodState state;
  gboolean any = FALSE, done = TRUE;
  for (guint32 body = 0; done && body < spore_world_body_count(world); body++) {
    if (!spore_world_lod_state(world, body, &state)) continue;
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

/* Control points that come and go. */

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
