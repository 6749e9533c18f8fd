/* spore run: the kernel without a window. */
#include <glib/gi18n.h>
#include <stdio.h>

#include "app/cli/cli.h"
#include "app/cli/run_exercise.h"
#include "app/cli/run_output.h"
#include "app/cli/run_pictures.h"
#include "app/cli/run_report.h"
#include "app/cli/scene.h"
#include "core/base/memory.h"
#include "core/io/scene_xml.h"

#define USUAL_STEPS 1000
#define NOT_GIVEN G_MININT64
#define PROGRESS_REPORTS 1000 /* a run */

typedef struct RunOptions {
  char *time;
  gint64 steps;
  gboolean realtime;
  char *record, *report;
  char **level;
  int threads;
  SporeSceneOptions scene;
  SporeOutputOptions output;
} RunOptions;

/* The devices' input. */
typedef struct Recording {
  SporeTrack track;
  gboolean lost; /* a part, for want of memory */
} Recording;

/* Appends the device states that the last step used. */
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

/* What goes on beside the steps. */
typedef struct Beside {
  double dt_s;
  GArray *levels;
  SporePace *pace;      /* the clock that paces the steps; NULL: none */
  Recording *recording; /* with a channel for each active body; NULL: nothing is recorded */
  SporeOutput *output;
  SporeExercise *exercise;    /* NULL: the scene has none */
  SporeRunPictures *pictures; /* of the exercise; NULL: none are wanted */
} Beside;

static SporeRunStatistics run_steps(const SporeCli *cli, SporeWorld *world, gint64 steps, const Beside *beside) {
  SporePace *pace = beside->pace;
  SporeRunStatistics statistics;
  spore_run_statistics_start(&statistics, world, beside->dt_s);
  gint64 stride = MAX(1, steps / PROGRESS_REPORTS);
  if (pace) spore_pace_start(pace, spore_world_time_s(world), 1);
  for (gint64 done = 1; done <= steps && !spore_cli_interrupted(); done++) {
    if (pace) spore_pace_begin(pace, spore_pace_due_ns(pace, spore_world_time_s(world)));
    spore_level_changes_post(beside->levels, world);
    spore_world_step(world);
    if (spore_world_cancelled(world)) break;
    if (pace) spore_pace_end(pace, spore_world_time_s(world));
    spore_world_tidy(world);
    spore_run_statistics_step(&statistics, world);
    if (beside->exercise) spore_exercise_watch(beside->exercise, world);
    if (beside->pictures) spore_run_pictures_look(beside->pictures);
    if (beside->recording && !record_inputs(world, &beside->recording->track)) {
      beside->recording->lost = TRUE;
      break;
    }
    if (!spore_output_step(beside->output, (guint64)done)) break;
    if (done % stride == 0 || done == steps)
      spore_progress(spore_cli_progress(cli), (double)done / (double)steps, _("running"));
    if (pace) spore_pace_sleep_until(spore_pace_due_ns(pace, spore_world_time_s(world)));
  }
  spore_run_statistics_energy(&statistics, world);
  return statistics;
}

static gboolean add_channels(const SporeWorld *world, SporeTrack *recording) {
  for (guint body = 0; body < spore_world_body_count(world); body++)
    if (spore_world_body_role(world, body) == SPORE_ACTIVE &&
        !spore_track_add_channel(recording, spore_world_body_name(world, body)))
      return FALSE;
  return TRUE;
}

/* An interrupted recording is a part, which must not take the place of a whole one. */
static int save_recording(const Recording *recording, const char *file) {
  GError *error = NULL;
  gsize size = 0;
  if (spore_cli_interrupted()) {
    fprintf(stderr, _("%s: interrupted; the recording was not written, and what was there stays\n"), file);
    return SPORE_EXIT_INTERRUPTED;
  }
  char *text = recording->lost ? NULL : spore_track_format(&recording->track, &size);
  gboolean saved =
      text ? spore_write_file(file, text, size, &error)
           : spore_error_raise(&error, SPORE_ERROR_MEMORY, file, _("not enough memory; record fewer steps"));
  spore_free(text);
  return saved ? SPORE_EXIT_DONE : spore_cli_fail(error);
}

/* Number of steps that the options ask for. */
static gboolean count_steps(const RunOptions *options, double dt_s, gint64 *steps, GError **error) {
  *steps = options->steps != NOT_GIVEN ? options->steps : USUAL_STEPS;
  return !options->time || spore_cli_steps(options->time, dt_s, steps, error);
}

/* What can be refused before the scene is opened. */
static gboolean check_files(const char *scene, const RunOptions *options, GError **error) {
  const char *record = options->record, *input = options->scene.input;
  if (record && !(spore_cli_has_room(record, scene, error) && (!input || spore_cli_has_room(record, input, error))))
    return FALSE;
  if (options->report && !spore_exercise_file_check(options->report, scene, input, error)) return FALSE;
  return spore_output_check(&options->output, scene, input, record, error);
}

static int save_report(SporeCli *cli, const char *scene, const char *file, const Beside *beside) {
  SporeReportPictures pictures = {0};
  if (beside->pictures) pictures = spore_run_pictures_get(beside->pictures);
  return spore_exercise_file_save(cli, beside->exercise, scene, file, beside->pictures ? &pictures : NULL);
}

/* Runs what was opened, and writes what was asked for. */
static int run_opened(SporeCli *cli, const char *scene, const RunOptions *options, SporeWorld *world, gint64 steps,
                      Beside *beside) {
  Recording recording = {0};
  if (options->record && !add_channels(world, &recording.track)) {
    spore_track_clear(&recording.track);
    return spore_cli_usage(_("--record: not enough memory"));
  }
  if (options->record) beside->recording = &recording;
  g_autofree SporePace *pace = beside->pace = options->realtime ? g_new(SporePace, 1) : NULL;
  if (pace) spore_world_set_budget(world, 1e6 * beside->dt_s);
  SporeRunStatistics result = run_steps(cli, world, steps, beside);
  int status = spore_cli_finish(cli, spore_run_report(cli, scene, world, &result, pace, beside->exercise));
  int saved = options->record ? save_recording(&recording, options->record) : SPORE_EXIT_DONE;
  int written = spore_output_save(cli, beside->output, scene);
  int reported = options->report ? save_report(cli, scene, options->report, beside) : SPORE_EXIT_DONE;
  status = MAX(MAX(status, reported), MAX(saved, written));
  spore_track_clear(&recording.track);
  spore_run_statistics_clear(&result);
  return spore_cli_interrupted() ? SPORE_EXIT_INTERRUPTED : status;
}

static int run(SporeCli *cli, const char *scene, const RunOptions *options) {
  GError *error = NULL;
  if (!check_files(scene, options, &error)) return spore_cli_fail(error);
  g_autoptr(SporeRun) run = spore_run_open(cli, scene, &options->scene, options->threads, &error);
  if (!run) return spore_cli_fail(error);
  g_autoptr(GArray) levels = spore_level_changes_parse(run->simulation->world, options->level, &error);
  if (!levels) return spore_cli_fail(error);
  double dt_s = spore_object_number(spore_document_section(run->document, "solver"), "time_step");
  gint64 steps = 0;
  if (!count_steps(options, dt_s, &steps, &error)) return spore_cli_fail(error);
  if (options->report && !run->simulation->exercise)
    return spore_cli_usage(
        _("--report: the scene has no exercise; expected steps or metrics in it; leave --report out"));
  SporeOutput output;
  Beside beside = {.dt_s = dt_s, .levels = levels, .output = &output, .exercise = run->simulation->exercise};
  if (options->report && g_str_has_suffix(options->report, ".html")) beside.pictures = spore_run_pictures_new(run);
  gboolean opened = spore_output_open(&output, &options->output, run, &error);
  int status = opened ? run_opened(cli, scene, options, run->simulation->world, steps, &beside) : spore_cli_fail(error);
  spore_output_clear(&output);
  spore_run_pictures_free(beside.pictures);
  return status;
}

int spore_command_run(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"scene", N_("file of the scene")},
      {"steps", N_("number of steps taken")},
      {"time_s", N_("simulated time, s")},
      {"dof", N_("degrees of freedom: velocity components that physics moves")},
      {"spheres", N_("number of collision spheres")},
      {"contacts", N_("a step, of bodies that are awake: mean, max; depth_max_m (the deepest, when a step began), "
                      "force_max_N (sum of the normal forces of all)")},
      {"step_us", N_("time that a step took, us: median, p99, max")},
      {"stages", N_("of a step: name, median_us, share of the step")},
      {"asleep",
       N_("number of bodies asleep at the end: at rest, and costing nothing until something that moves touches them")},
      {"energy", N_("kinetic, elastic, of gravity and of contacts together, J: start, end, max_drift (largest "
                    "difference from the start; looked at every 64 steps, and at the end)")},
      {"solver", N_("iterations of implicit steps: newton_mean, newton_max, linear_mean, linear_max, and residual_max, "
                    "relative")},
      {"local_error",
       N_("error in position that a step made, estimated every 64 steps for the body that is worst, m: samples, mean, "
          "max, body (of max). It is how far the step is from the trapezoidal rule, and that rule from its next term "
          "(root mean square over the body's mass, without turning): close to the error of a method of first order, "
          "above that of a better one; where contacts set in, it tells of the impact")},
      {"links", N_("where there are any but pins: each one's name, load_N (what it held at the end), drift_m (how far "
                   "what it holds together is apart), broken (1: for good)")},
      {"tools", N_("where instruments do more than touch: each one's name, opening_rad, squeeze_Nm (torque against "
                   "closing), held and lost (spheres), taken (particles), cut and coagulated (springs, elements), "
                   "pierced (surfaces) and stitches (that hold now)")},
      {"fluids", N_("where there are fluids: each one's name, present_ml (in the scene at the end), poured_ml (that "
                    "emitters let out), seeped_ml (that came out of emitters that are effects, as no particle) and "
                    "sucked_ml (that suction took away)")},
      {"levels",
       N_("where bodies have levels: each one's name, level (at the end), changes and refused (how many), error_m "
          "(how far they moved a point of it at most), energy_J (its own, that one added at most), "
          "momentum_Ns (that one missed at most)")},
      {"level_changes",
       N_("where bodies have levels, the last 256 changes: body, from, to, time_s, by (error, distance, time; none: it "
          "was asked for), figure (by error the estimated error of the coarser level, m; by distance that of the "
          "nearest tool or camera, m; by time what a step took, us), reason")},
      {"lines",
       N_("where control points come and go as a line bends (most_bend): each one's name, control points made (at the "
          "start), points (at the end), peak (at most) and reserve (that there may be), inserted and removed")},
      {"loops",
       N_("where bodies along a line can touch something: each one's body, least (distance of two of its spheres that "
          "are farther apart along it than the sum of their radii, of that sum, over all steps; 1: none touched), "
          "time_s (when that was), through (steps that began with such spheres nearer than half of it: its loops go "
          "through each other; where it collides with itself the exit status is 1)")},
      {"exercise",
       N_("where the scene has one: phase (running, done, out_of_time), time_s, score (0 to 100: share of the steps "
          "done, times the mean mark), passed, steps (name, kind, phase, done_s once it is done, early: how often its "
          "event came before its turn, lost: how often it ended though it had to last, hint), metrics (name, kind, "
          "value, unit, where it is graded good, pass and "
          "mark: "
          "1 at good, .5 at pass, verdict, source). Where less is better, the mark is 0 and the verdict unfinished or "
          "fail until all steps are done. The exit status does not depend on it")},
      {"monitor", N_("what went wrong, counted in steps: recoveries (taken again), substeps (that this cost), "
                     "not_finite, too_fast, energy (made without bound), not_converged (above the tolerance), "
                     "deep_contacts, over_budget, held_inputs (refused from devices), shortened_forces (to "
                     "hands), broken_links, "
                     "lost_holds (that tore away from jaws), torn_springs (of nets)")},
      {"monitor.frozen", N_("names of bodies that could not be computed")},
      {"monitor.made_safer", N_("names of bodies that were moved by a safer method than the scene says")},
      {"monitor.unsolved",
       N_("what was not solved as the scene is written, by body and cause: body, steps, worst (null where "
          "the cause has no figure), cause, remedy; the exit status is 1 where there is any")},
      {"monitor.messages", N_("the last of them, each naming body and cause")},
      {"realtime",
       N_("with --realtime: factor (simulated by real time), deadline_misses (steps that ended late), worst_late_us, "
          "jitter_us of their beginnings (median, p99, max), given_up_s (time that was not caught up with)")},
      {"repeatable", N_("false where levels follow the clock, so that another run may end in another state")},
      {"bodies",
       N_("the state of each body at the end: name, hash (of its positions and velocities), moved_by (of a passive "
          "one: physics or effect)")},
      {"state_hash",
       N_("of all positions and velocities: the same for the same scene and input, whatever the threads")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {
      "run",
      "SCENE",
      N_("Runs a scene and says how it went. The exit status is 1 where a step was not solved as the scene is written "
         "(monitor.unsolved says of which body, and why), and with --realtime where the steps did not keep pace."),
      1,
      1,
      members,
      spore_output_describe};
  RunOptions options = {.steps = NOT_GIVEN, .threads = 1};
  const GOptionEntry entries[] = {
      {"time", 't', 0, G_OPTION_ARG_STRING, &options.time, N_("Simulated time"), "S"},
      {"steps", 'n', 0, G_OPTION_ARG_INT64, &options.steps, N_("Number of steps (default 1000)"), "N"},
      {"threads", 0, 0, G_OPTION_ARG_INT, &options.threads, N_("Threads (default 1); the result is the same"), "N"},
      {"realtime", 0, 0, G_OPTION_ARG_NONE, &options.realtime,
       N_("Keep pace with the clock, and say how well that went"), NULL},
      {"level", 0, 0, G_OPTION_ARG_STRING_ARRAY, &options.level,
       N_("Change the level of a body while it runs, at 0 s or later: thread=coarse@1.5"), "BODY=LEVEL[@S]"},
      {"record", 0, 0, G_OPTION_ARG_FILENAME, &options.record, N_("Write the devices' input as a track"), "FILE"},
      {"report", 0, 0, G_OPTION_ARG_FILENAME, &options.report,
       N_("Write steps, metrics and score of the scene's exercise: a table, an object, or a page with plots"),
       "F.csv, F.json or F.html"},
      SPORE_OUTPUT_OPTION_ENTRIES(options.output),
      SPORE_SCENE_OPTION_ENTRIES(options.scene),
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) {
    if (options.time && options.steps != NOT_GIVEN)
      status = spore_cli_usage(_("--time, --steps: both given; expected one of them; leave one out"));
    else if (options.steps != NOT_GIVEN && options.steps < 0)
      status = spore_cli_usage(_("--steps: %lld; expected 0 or more"), (long long)options.steps);
    else if (options.threads < 1 || options.threads > 256)
      status = spore_cli_usage(_("--threads: %d; expected 1 to 256"), options.threads);
    else status = run(cli, argv[1], &options);
  }
  spore_scene_options_clear(&options.scene);
  spore_output_options_clear(&options.output);
  g_free(options.time);
  g_free(options.record);
  g_free(options.report);
  g_strfreev(options.level);
  return status;
}
