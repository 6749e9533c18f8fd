/* spore run: the kernel without a window. */
#include <glib/gi18n.h>
#include <math.h>
#include <time.h>

#include "app/cli/cli.h"
#include "app/cli/scene.h"
#include "core/base/memory.h"
#include "core/io/scene_xml.h"
#include "core/measure/run_statistics.h"

#define USUAL_STEPS 1000
#define NOT_GIVEN G_MININT64
#define ENERGY_LOOKS 1000 /* a run: few enough to cost nothing */

typedef struct RunOptions {
  double time_s, dt_s;
  gint64 steps;
  gboolean realtime;
  char *record;
  int threads;
  SporeSceneOptions scene;
} RunOptions;

static void wait_until(guint64 start_ns, double time_s) {
  guint64 due = start_ns + (guint64)(1e9 * time_s);
  struct timespec at = {.tv_sec = (time_t)(due / 1000000000u), .tv_nsec = (long)(due % 1000000000u)};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, NULL);
}

/* Appends what each device was taken to say in the step just done. */
static gboolean record_inputs(const SporeWorld *world, SporeTrack *recording) {
  for (gsize i = 0; i < recording->channel_count; i++) {
    SporeTrackChannel *channel = &recording->channels[i];
    guint body = spore_world_find_body(world, channel->name);
    double time_s = 0;
    const SporeDeviceState *state = spore_world_input(world, body, &time_s);
    if (state && !spore_track_append(channel, time_s, state)) return FALSE;
  }
  return TRUE;
}

/* recording: NULL, or a track with a channel for each active body. */
static SporeRunStatistics run_steps(const SporeCli *cli, SporeWorld *world, gint64 steps, gboolean realtime,
                                    SporeTrack *recording) {
  SporeRunStatistics statistics;
  spore_run_statistics_start(&statistics, world);
  gint64 stride = MAX(1, steps / ENERGY_LOOKS);
  guint64 start_ns = spore_clock_ns();
  for (gint64 done = 1; done <= steps && !spore_cli_interrupted(); done++) {
    spore_world_step(world);
    spore_run_statistics_step(&statistics, world);
    if (recording && !record_inputs(world, recording)) break;
    if (done % stride == 0 || done == steps) {
      spore_run_statistics_energy(&statistics, world);
      spore_progress(spore_cli_progress(cli), (double)done / (double)steps, _("running"));
    }
    if (realtime) wait_until(start_ns, spore_world_time_s(world));
  }
  return statistics;
}

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

/* Number of frozen bodies. */
static guint report_monitor(SporeCli *cli, const SporeWorld *world) {
  const SporeMonitor *monitor = spore_world_monitor(world);
  guint frozen = 0;
  spore_cli_open(cli, "monitor");
  spore_cli_count(cli, "recoveries", (gint64)monitor->recoveries);
  spore_cli_count(cli, "substeps", (gint64)monitor->substeps);
  spore_cli_count(cli, "not_converged", (gint64)monitor->not_converged);
  spore_cli_count(cli, "held_inputs", (gint64)monitor->held_inputs);
  if (monitor->not_converged || monitor->recoveries)
    spore_cli_say(cli, _("monitor: %llu steps above the solver's tolerance, %llu taken again with %llu substeps\n"),
                  (unsigned long long)monitor->not_converged, (unsigned long long)monitor->recoveries,
                  (unsigned long long)monitor->substeps);
  spore_cli_open_array(cli, "frozen");
  for (guint body = 0; body < spore_world_body_count(world); body++)
    if (spore_world_body_frozen(world, body)) {
      spore_cli_text(cli, NULL, spore_world_body_name(world, body));
      frozen++;
    }
  spore_cli_close_array(cli);
  spore_cli_open_array(cli, "messages");
  guint64 kept = MIN(monitor->message_count, SPORE_MONITOR_MESSAGES);
  for (guint64 serial = monitor->message_count - kept; serial < monitor->message_count; serial++) {
    const SporeMonitorMessage *message = &monitor->messages[serial % SPORE_MONITOR_MESSAGES];
    spore_cli_text(cli, NULL, message->text);
    spore_cli_say(cli, _("  step %llu: %s\n"), (unsigned long long)message->step, message->text);
  }
  spore_cli_close_array(cli);
  spore_cli_close(cli);
  return frozen;
}

/* Number of bodies asleep at the end. */
static guint count_asleep(const SporeWorld *world) {
  guint asleep = 0;
  for (guint body = 0; body < spore_world_body_count(world); body++) asleep += spore_world_body_asleep(world, body);
  return asleep;
}

static int report(SporeCli *cli, const char *scene, const SporeWorld *world, const SporeRunStatistics *result) {
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
  if (asleep > 0) spore_cli_say(cli, _("asleep at the end: %u bodies\n"), asleep);
  spore_cli_open(cli, "energy");
  spore_cli_number(cli, "start", result->energy_start);
  spore_cli_number(cli, "end", result->energy_end);
  spore_cli_number(cli, "max_drift", result->energy_drift);
  spore_cli_close(cli);
  spore_cli_say(cli, _("contacts: mean %.1f, most %zu; energy: %.6g J at the start, %.6g J at the end\n"),
                spore_run_statistics_mean(result, result->contacts), result->contacts_max, result->energy_start,
                result->energy_end);
  report_solver(cli, result);
  guint frozen = report_monitor(cli, world);
  spore_cli_text(cli, "state_hash", hash);
  spore_cli_say(cli, _("state hash %s\n"), hash);
  return frozen ? SPORE_EXIT_NOT_HELD : SPORE_EXIT_DONE;
}

static gboolean add_channels(const SporeWorld *world, SporeTrack *recording) {
  for (guint body = 0; body < spore_world_body_count(world); body++)
    if (spore_world_body_role(world, body) == SPORE_ACTIVE &&
        !spore_track_add_channel(recording, spore_world_body_name(world, body)))
      return FALSE;
  return TRUE;
}

static int save_recording(const SporeTrack *recording, const char *file) {
  GError *error = NULL;
  gsize size = 0;
  char *text = spore_track_format(recording, &size);
  gboolean saved =
      text ? spore_write_file(file, text, size, &error)
           : spore_error_raise(&error, SPORE_ERROR_MEMORY, file, _("not enough memory; record fewer steps"));
  spore_free(text);
  return saved ? SPORE_EXIT_DONE : spore_cli_fail(error);
}

static int run(SporeCli *cli, const char *scene, const RunOptions *options) {
  GError *error = NULL;
  if (options->record && (!spore_cli_keeps(options->record, scene, &error) ||
                          (options->scene.input && !spore_cli_keeps(options->record, options->scene.input, &error))))
    return spore_cli_fail(error);
  g_autoptr(SporeRun) run = spore_run_open(cli, scene, &options->scene, options->threads, &error);
  if (!run) return spore_cli_fail(error);
  SporeWorld *world = run->simulation->world;
  SporeTrack recording = {0};
  if (options->record && !add_channels(world, &recording)) return spore_cli_usage(_("--record: not enough memory"));
  double dt_s = spore_object_number(spore_document_section(run->document, "solver"), "time_step");
  gint64 steps = options->steps != NOT_GIVEN ? options->steps : USUAL_STEPS;
  if (!isnan(options->time_s)) steps = (gint64)ceil(options->time_s / dt_s - 1e-9);
  SporeRunStatistics result = run_steps(cli, world, steps, options->realtime, options->record ? &recording : NULL);
  int status = spore_cli_finish(cli, report(cli, scene, world, &result));
  int saved = options->record ? save_recording(&recording, options->record) : SPORE_EXIT_DONE;
  status = MAX(status, saved);
  spore_track_clear(&recording);
  return spore_cli_interrupted() ? SPORE_EXIT_INTERRUPTED : status;
}

int spore_command_run(SporeCli *cli, int argc, char **argv) {
  static const SporeCommandInfo info = {"run", "SCENE", N_("Runs a scene and says how it went."), 1, 1};
  RunOptions options = {.time_s = NAN, .steps = NOT_GIVEN, .threads = 1};
  const GOptionEntry entries[] = {
      {"time", 't', 0, G_OPTION_ARG_DOUBLE, &options.time_s, N_("Simulated time"), "S"},
      {"steps", 'n', 0, G_OPTION_ARG_INT64, &options.steps, N_("Number of steps (default 1000)"), "N"},
      {"threads", 0, 0, G_OPTION_ARG_INT, &options.threads, N_("Threads (default 1); the result is the same"), "N"},
      {"realtime", 0, 0, G_OPTION_ARG_NONE, &options.realtime, N_("Keep pace with the clock"), NULL},
      {"record", 0, 0, G_OPTION_ARG_FILENAME, &options.record, N_("Write the devices' input as a track"), "FILE"},
      SPORE_SCENE_OPTION_ENTRIES(options.scene),
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) {
    if (!isnan(options.time_s) && options.steps != NOT_GIVEN)
      status = spore_cli_usage(_("--time, --steps: both given; expected one of them; leave one out"));
    else if (options.time_s < 0 || isinf(options.time_s))
      status = spore_cli_usage(_("--time: %g s; expected a time of 0 s or more"), options.time_s);
    else if (options.steps != NOT_GIVEN && options.steps < 0)
      status = spore_cli_usage(_("--steps: %lld; expected 0 or more"), (long long)options.steps);
    else if (options.threads < 1 || options.threads > 256)
      status = spore_cli_usage(_("--threads: %d; expected 1 to 256"), options.threads);
    else status = run(cli, argv[1], &options);
  }
  spore_scene_options_clear(&options.scene);
  g_free(options.record);
  return status;
}
