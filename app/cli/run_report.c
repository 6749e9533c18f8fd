/* What spore run reports: times of stages, solver, tools, contacts, energy and messages of a run. */
#include "app/cli/run_report.h"

#include <glib/gi18n.h>
#include <math.h>

#include "app/cli/run_exercise.h"
#include "app/cli/run_loops.h"

static void report_stages(SporeCli *cli, const SporePlan *plan) {
  double total_us = 0;
  for (gsize i = 0; i < plan->stage_count; i++)
    if (plan->stages[i].profile) total_us += spore_profile_summary(plan->stages[i].profile).median_us;
  spore_cli_open_array(cli, "stages");
  for (gsize i = 0; i < plan->stage_count; i++) {
    const SporePlanStage *stage = &plan->stages[i];
    if (!stage->profile) continue;
    double median_us = spore_profile_summary(stage->profile).median_us;
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", stage->name);
    spore_cli_number(cli, "median_us", median_us);
    spore_cli_number(cli, "share", total_us > 0 ? median_us / total_us : 0);
    spore_cli_close(cli);
    spore_cli_say(cli, "  %-10s %9.2f us %5.1f %%\n", stage->name, median_us,
                  total_us > 0 ? 100 * median_us / total_us : 0);
  }
  spore_cli_close_array(cli);
}

static void report_solver(SporeCli *cli, const SporeRunStatistics *result) {
  spore_cli_open(cli, "solver");
  spore_cli_number(cli, "newton_mean", spore_run_statistics_mean(result, result->newton));
  spore_cli_count(cli, "newton_max", (gint64)result->newton_max);
  spore_cli_number(cli, "linear_mean", spore_run_statistics_mean(result, result->linear));
  spore_cli_count(cli, "linear_max", (gint64)result->linear_max);
  spore_cli_number(cli, "residual_max", result->residual_max);
  spore_cli_close(cli);
  if (result->newton_max > 0)
    spore_cli_say(
        cli, _("solver: %.1f Newton and %.1f linear iterations a step (most %zu and %zu), residual %.1e at worst\n"),
        spore_run_statistics_mean(result, result->newton), spore_run_statistics_mean(result, result->linear),
        result->newton_max, result->linear_max, result->residual_max);
}

static void report_local_error(SporeCli *cli, const SporeWorld *world, const SporeLocalError *estimate) {
  gboolean known = estimate->most_body != SPORE_NO_BODY;
  const char *body = known ? spore_world_body_name(world, estimate->most_body) : NULL;
  double mean = estimate->samples > 0 ? estimate->sum / (double)estimate->samples : NAN;
  spore_cli_open(cli, "local_error");
  spore_cli_count(cli, "samples", (gint64)estimate->samples);
  spore_cli_number(cli, "mean", mean);
  spore_cli_number(cli, "max", estimate->samples > 0 ? estimate->most : NAN);
  spore_cli_text(cli, "body", body);
  spore_cli_close(cli);
  if (known)
    spore_cli_say(cli, _("local error of a step, estimated: mean %.2g m, worst %.2g m (%s)\n"), mean, estimate->most,
                  body);
}

typedef bool (*BodyTest)(const SporeWorld *world, uint32_t body);

/* Reports the names of the bodies for which the test holds. */
static void report_bodies(SporeCli *cli, const char *member, const SporeWorld *world, BodyTest holds) {
  spore_cli_open_array(cli, member);
  for (guint body = 0; body < spore_world_body_count(world); body++)
    if (holds(world, body)) spore_cli_text(cli, NULL, spore_world_body_name(world, body));
  spore_cli_close_array(cli);
}

static void report_messages(SporeCli *cli, const SporeMonitor *monitor) {
  spore_cli_open_array(cli, "messages");
  guint64 kept = MIN(monitor->message_count, SPORE_MONITOR_MESSAGES);
  for (guint64 serial = monitor->message_count - kept; serial < monitor->message_count; serial++) {
    const SporeMonitorMessage *message = &monitor->messages[serial % SPORE_MONITOR_MESSAGES];
    spore_cli_text(cli, NULL, message->text);
    spore_cli_say(cli, _("  step %llu: %s\n"), (unsigned long long)message->step, message->text);
  }
  spore_cli_close_array(cli);
}

/* Every step that was not solved as the scene is written. Returns whether there is none. */
static gboolean report_unsolved(SporeCli *cli, const SporeWorld *world) {
  gsize count = spore_world_unsolved_count(world);
  spore_cli_open_array(cli, "unsolved");
  for (gsize i = 0; i < count; i++) {
    SporeUnsolved entry = spore_world_unsolved(world, i);
    const char *name = spore_world_body_name(world, entry.body);
    g_autofree char *worst =
        entry.unit ? g_strdup_printf(_(" (worst %.2g%s%s)"), entry.worst, *entry.unit ? " " : "", entry.unit)
                   : g_strdup("");
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "body", name);
    spore_cli_count(cli, "steps", (gint64)entry.steps);
    spore_cli_number(cli, "worst", entry.unit ? entry.worst : NAN);
    spore_cli_text(cli, "cause", entry.cause);
    spore_cli_text(cli, "remedy", entry.remedy);
    spore_cli_close(cli);
    spore_cli_say(cli, _("unsolved: %s: %llu steps: %s%s; %s\n"), name, (unsigned long long)entry.steps, entry.cause,
                  worst, entry.remedy);
  }
  spore_cli_close_array(cli);
  return count == 0;
}

/* Whether the checks of the monitor held. */
static gboolean report_monitor(SporeCli *cli, const SporeWorld *world) {
  const SporeMonitor *monitor = spore_world_monitor(world);
  const struct {
    const char *member;
    uint64_t count;
  } counts[] = {{"recoveries", monitor->recoveries},
                {"substeps", monitor->substeps},
                {"not_finite", monitor->not_finite},
                {"too_fast", monitor->too_fast},
                {"energy", monitor->energy},
                {"not_converged", monitor->not_converged},
                {"deep_contacts", monitor->deep_contacts},
                {"over_budget", monitor->over_budget},
                {"held_inputs", monitor->held_inputs},
                {"shortened_forces", monitor->shortened_forces},
                {"broken_links", monitor->broken_links},
                {"lost_holds", monitor->lost_holds},
                {"torn_springs", monitor->torn_springs}};
  spore_cli_open(cli, "monitor");
  for (gsize i = 0; i < G_N_ELEMENTS(counts); i++) spore_cli_count(cli, counts[i].member, (gint64)counts[i].count);
  if (monitor->not_converged || monitor->recoveries)
    spore_cli_say(cli, _("monitor: %llu steps above the solver's tolerance, %llu taken again with %llu substeps\n"),
                  (unsigned long long)monitor->not_converged, (unsigned long long)monitor->recoveries,
                  (unsigned long long)monitor->substeps);
  if (monitor->torn_springs) spore_cli_say(cli, _("torn: %llu springs\n"), (unsigned long long)monitor->torn_springs);
  report_bodies(cli, "frozen", world, spore_world_body_frozen);
  report_bodies(cli, "made_safer", world, spore_world_body_made_safer);
  gboolean solved = report_unsolved(cli, world);
  report_messages(cli, monitor);
  spore_cli_close(cli);
  return solved;
}

/* Links and tools, where there are any. */
static void report_links(SporeCli *cli, const SporeWorld *world) {
  size_t count = spore_world_link_count(world);
  if (count == 0) return;
  spore_cli_open_array(cli, "links");
  for (size_t i = 0; i < count; i++) {
    SporeLinkState state = spore_world_link_state(world, i);
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", state.name);
    spore_cli_number(cli, "load_N", state.load);
    spore_cli_number(cli, "drift_m", state.drift);
    spore_cli_count(cli, "broken", state.broken);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
}

static void report_tools(SporeCli *cli, const SporeWorld *world) {
  size_t count = spore_world_tool_count(world);
  if (count == 0) return;
  spore_cli_open_array(cli, "tools");
  for (size_t i = 0; i < count; i++) {
    SporeToolState state = spore_world_tool_state(world, i);
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", state.name);
    spore_cli_number(cli, "opening_rad", state.opening);
    spore_cli_number(cli, "squeeze_Nm", state.squeeze);
    spore_cli_count(cli, "held", (gint64)state.held);
    spore_cli_count(cli, "lost", (gint64)state.lost);
    spore_cli_count(cli, "taken", (gint64)state.taken);
    spore_cli_count(cli, "cut", (gint64)state.cut);
    spore_cli_count(cli, "coagulated", (gint64)state.coagulated);
    spore_cli_count(cli, "pierced", (gint64)state.pierced);
    spore_cli_count(cli, "stitches", (gint64)state.stitches);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
}

#define MILLILITRES 1e6 /* in a cubic metre */

/* Of each fluid, how much is in the scene, and how much came and went. */
static void report_fluids(SporeCli *cli, const SporeWorld *world) {
  gboolean any = FALSE;
  for (guint32 body = 0; body < spore_world_body_count(world); body++) {
    const SporeModel *model = spore_world_body_model(world, body);
    if (!model || !model->type->particles) continue;
    SporeBodyMarks marks = spore_world_body_marks(world, body);
    double each = MILLILITRES * model->particle_volume;
    if (!any) spore_cli_open_array(cli, "fluids");
    any = TRUE;
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", spore_world_body_name(world, body));
    spore_cli_number(cli, "present_ml", each * (double)spore_world_particle_count(world, body));
    spore_cli_number(cli, "poured_ml", each * (double)marks.poured);
    spore_cli_number(cli, "seeped_ml", each * (double)marks.seeped);
    spore_cli_number(cli, "sucked_ml", each * (double)marks.sucked);
    spore_cli_close(cli);
    if (marks.seeped > 0)
      spore_cli_say(cli, _("%s: %.3g ml seeped out, as an effect\n"), spore_world_body_name(world, body),
                    each * (double)marks.seeped);
    if (marks.poured + marks.sucked > 0)
      spore_cli_say(cli, _("%s: %.3g ml came out, %.3g ml were sucked away\n"), spore_world_body_name(world, body),
                    each * (double)marks.poured, each * (double)marks.sucked);
  }
  if (any) spore_cli_close_array(cli);
}

static void report_level(SporeCli *cli, const char *body, const SporeLodState *state) {
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", body);
  spore_cli_text(cli, "level", spore_lod_names[state->level]);
  spore_cli_count(cli, "changes", (gint64)state->changes);
  spore_cli_count(cli, "refused", (gint64)state->refused);
  spore_cli_number(cli, "error_m", state->error);
  spore_cli_number(cli, "energy_J", state->energy);
  spore_cli_number(cli, "momentum_Ns", state->momentum);
  spore_cli_close(cli);
  spore_cli_say(cli, _("%s: level %s, %llu changes moved it by at most %.3g m, %llu refused\n"), body,
                spore_lod_names[state->level], (unsigned long long)state->changes, state->error,
                (unsigned long long)state->refused);
}

/* Why a level changed; g_free. */
static char *describe_cause(const SporeLodChange *change) {
  switch (change->by) {
  case SPORE_LOD_BY_ERROR:
    return g_strdup_printf(_("level %s is estimated to be %.2g m wrong"),
                           spore_lod_names[MIN(change->from, change->to)], change->figure);
  case SPORE_LOD_BY_DISTANCE:
    return g_strdup_printf(_("the nearest tool or camera is %.3g m away"), change->figure);
  case SPORE_LOD_BY_TIME:
    return g_strdup_printf(_("a step took %.4g us"), change->figure);
  default:
    return g_strdup(_("it was asked for"));
  }
}

/* The log of changes of level, where there are levels. */
static void report_level_changes(SporeCli *cli, const SporeWorld *world) {
  guint64 count = spore_world_lod_change_count(world), first = count > SPORE_LOD_LOG ? count - SPORE_LOD_LOG : 0;
  if (first > 0)
    spore_cli_say(cli, _("of %llu changes of level the last %d:\n"), (unsigned long long)count, SPORE_LOD_LOG);
  spore_cli_open_array(cli, "level_changes");
  for (guint64 i = first; i < count; i++) {
    SporeLodChange change = spore_world_lod_change(world, i);
    const char *body = spore_world_body_name(world, change.body);
    g_autofree char *reason = describe_cause(&change);
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "body", body);
    spore_cli_text(cli, "from", spore_lod_names[change.from]);
    spore_cli_text(cli, "to", spore_lod_names[change.to]);
    spore_cli_number(cli, "time_s", change.time_s);
    spore_cli_text(cli, "by", spore_lod_cause_names[change.by]);
    spore_cli_number(cli, "figure", change.figure);
    spore_cli_text(cli, "reason", reason);
    spore_cli_close(cli);
    spore_cli_say(cli, _("%g s: %s: level %s to %s: %s\n"), change.time_s, body, spore_lod_names[change.from],
                  spore_lod_names[change.to], reason);
  }
  spore_cli_close_array(cli);
}

/* Only where bodies have levels. */
static void report_levels(SporeCli *cli, const SporeWorld *world) {
  SporeLodState state;
  gboolean any = FALSE;
  for (guint body = 0; body < spore_world_body_count(world); body++) {
    if (!spore_world_lod_state(world, body, &state)) continue;
    if (!any) spore_cli_open_array(cli, "levels");
    any = TRUE;
    report_level(cli, spore_world_body_name(world, body), &state);
  }
  if (!any) return;
  spore_cli_close_array(cli);
  report_level_changes(cli, world);
}

/* Only where control points come and go. */
static void report_lines(SporeCli *cli, const SporeWorld *world) {
  SporeLineState line;
  gboolean any = FALSE;
  for (guint body = 0; body < spore_world_body_count(world); body++) {
    if (!spore_world_line_state(world, body, &line)) continue;
    if (!any) spore_cli_open_array(cli, "lines");
    any = TRUE;
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", spore_world_body_name(world, body));
    spore_cli_count(cli, "made", (gint64)line.made);
    spore_cli_count(cli, "points", (gint64)line.points);
    spore_cli_count(cli, "peak", (gint64)line.peak);
    spore_cli_count(cli, "reserve", (gint64)line.reserve);
    spore_cli_count(cli, "inserted", (gint64)line.inserted);
    spore_cli_count(cli, "removed", (gint64)line.removed);
    spore_cli_close(cli);
    spore_cli_say(cli,
                  _("%s: %zu control points at the start, %zu at the end, %zu at most, of %zu; %llu came, %llu went\n"),
                  spore_world_body_name(world, body), line.made, line.points, line.peak, line.reserve,
                  (unsigned long long)line.inserted, (unsigned long long)line.removed);
  }
  if (any) spore_cli_close_array(cli);
}

/* Whether the run kept pace with the clock. */
static gboolean report_pace(SporeCli *cli, const SporeWorld *world, const SporePace *pace) {
  if (!pace) return TRUE;
  SporePaceSummary summary = spore_pace_summary(pace, spore_world_time_s(world));
  spore_cli_open(cli, "realtime");
  spore_cli_number(cli, "factor", summary.factor);
  spore_cli_count(cli, "deadline_misses", (gint64)summary.misses);
  spore_cli_number(cli, "worst_late_us", summary.worst_late_us);
  spore_cli_open(cli, "jitter_us");
  spore_cli_number(cli, "median", summary.jitter_median_us);
  spore_cli_number(cli, "p99", summary.jitter_p99_us);
  spore_cli_number(cli, "max", summary.jitter_max_us);
  spore_cli_close(cli);
  spore_cli_number(cli, "given_up_s", summary.given_up_s);
  spore_cli_close(cli);
  spore_cli_say(
      cli,
      _("real time: factor %.3f, %llu of %llu steps ended late, at worst by %.0f us; begun late by %.0f us in "
        "the median, %.0f us at the 99th percentile, %.0f us at worst\n"),
      summary.factor, (unsigned long long)summary.misses, (unsigned long long)summary.steps, summary.worst_late_us,
      summary.jitter_median_us, summary.jitter_p99_us, summary.jitter_max_us);
  if (summary.given_up_s > 0) spore_cli_say(cli, _("it did not keep pace: %.3f s were given up\n"), summary.given_up_s);
  return !(summary.given_up_s > 0);
}

/* Number of bodies asleep at the end. */
static guint count_asleep(const SporeWorld *world) {
  guint asleep = 0;
  for (guint body = 0; body < spore_world_body_count(world); body++) asleep += spore_world_body_asleep(world, body);
  return asleep;
}

/* The state of each body as a number, and what moves it. */
static void report_states(SporeCli *cli, const SporeWorld *world) {
  spore_cli_open_array(cli, "bodies");
  for (guint32 body = 0; body < spore_world_body_count(world); body++) {
    g_autofree char *hash = g_strdup_printf("%016" G_GINT64_MODIFIER "x", spore_world_body_hash(world, body));
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", spore_world_body_name(world, body));
    spore_cli_text(cli, "hash", hash);
    if (spore_world_body_role(world, body) == SPORE_PASSIVE)
      spore_cli_text(cli, "moved_by", spore_world_body_is_effect(world, body) ? "effect" : "physics");
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
}

int spore_run_report(SporeCli *cli, const char *scene, const SporeWorld *world, const SporeRunStatistics *result,
                     const SporePace *pace, const SporeExercise *exercise) {
  SporeProfileSummary step = spore_profile_summary(spore_world_profile(world));
  g_autofree char *hash = g_strdup_printf("%016" G_GINT64_MODIFIER "x", spore_world_hash(world));
  gint64 steps = (gint64)spore_world_step_count(world);
  spore_cli_text(cli, "scene", scene);
  spore_cli_count(cli, "steps", steps);
  spore_cli_number(cli, "time_s", spore_world_time_s(world));
  spore_cli_count(cli, "dof", (gint64)spore_world_dof(world));
  spore_cli_count(cli, "spheres", (gint64)spore_world_spheres(world)->count);
  spore_cli_open(cli, "contacts");
  spore_cli_number(cli, "mean", spore_run_statistics_mean(result, result->contacts));
  spore_cli_count(cli, "max", (gint64)result->contacts_max);
  spore_cli_number(cli, "depth_max_m", result->depth_max);
  spore_cli_number(cli, "force_max_N", result->force_max);
  spore_cli_close(cli);
  spore_cli_open(cli, "step_us");
  spore_cli_number(cli, "median", step.median_us);
  spore_cli_number(cli, "p99", step.p99_us);
  spore_cli_number(cli, "max", step.max_us);
  spore_cli_close(cli);
  spore_cli_say(cli, _("%s: %lld steps, %g s, %zu degrees of freedom, %zu spheres\n"), scene, (long long)steps,
                spore_world_time_s(world), spore_world_dof(world), spore_world_spheres(world)->count);
  spore_cli_say(cli, _("step: median %.2f us, 99th percentile %.2f us, longest %.2f us\n"), step.median_us, step.p99_us,
                step.max_us);
  report_stages(cli, spore_world_plan(world));
  guint asleep = count_asleep(world);
  spore_cli_count(cli, "asleep", asleep);
  if (asleep > 0) spore_cli_say(cli, _("bodies asleep at the end: %u\n"), asleep);
  spore_cli_open(cli, "energy");
  spore_cli_number(cli, "start", result->energy_start);
  spore_cli_number(cli, "end", result->energy_end);
  spore_cli_number(cli, "max_drift", result->energy_drift);
  spore_cli_close(cli);
  spore_cli_say(cli,
                _("contacts: mean %.1f, most %zu, deepest %.2g m; energy: %.6g J at the start, %.6g J at the end\n"),
                spore_run_statistics_mean(result, result->contacts), result->contacts_max, result->depth_max,
                result->energy_start, result->energy_end);
  report_solver(cli, result);
  report_local_error(cli, world, &result->local_error);
  report_links(cli, world);
  report_tools(cli, world);
  report_fluids(cli, world);
  report_levels(cli, world);
  report_lines(cli, world);
  spore_run_report_exercise(cli, exercise);
  gboolean held = spore_run_report_loops(cli, world, &result->loops);
  held &= report_monitor(cli, world);
  held &= report_pace(cli, world, pace);
  json_builder_set_member_name(cli->report, "repeatable");
  json_builder_add_boolean_value(cli->report, spore_world_is_repeatable(world));
  if (!spore_world_is_repeatable(world))
    spore_cli_say(cli, _("levels followed the clock: another run of this scene may end in another state\n"));
  report_states(cli, world);
  spore_cli_text(cli, "state_hash", hash);
  spore_cli_say(cli, _("state hash %s\n"), hash);
  return held ? SPORE_EXIT_DONE : SPORE_EXIT_NOT_HELD;
}
