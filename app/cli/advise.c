/* spore advise: physical or effect. Each body that physics moves is replayed in cheaper forms, and what the others do
 * then is compared with what they do when the step is halved or the start is a little off. */
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "app/cli/advise_budget.h"
#include "app/cli/cli.h"
#include "app/cli/scene.h"
#include "core/io/scene_xml.h"
#include "core/measure/influence.h"
#include "core/scene/fidelity.h"
#include "core/scene/schema_fields.h"
#include "core/scene/variation.h"

#define USUAL_TIME_S 1. /* where nothing is recorded */
#define LONGEST_TIME_S 10.
#define LONGEST_EXERCISE_S 120. /* the last steps of an exercise are as much of it as the first */
#define SAMPLES 50
#define PERTURBED 2        /* runs from a start that is a little off */
#define PERTURBATION 1e-8  /* of a body's length */
#define LEAST_FLOOR 1e-6   /* of a body's length: nobody sees less */
#define LEAST_FORCE_N 1e-4 /* no hand feels less */
#define LEAST_SCORE 0.05   /* reports tell no less */

/* The run of all that is physical, and the bodies that it followed. */
typedef struct Replay {
  SporeTrialPoints points;
  SporeTrial trial;
} Replay;

typedef struct Advice {
  SporeCli *cli;
  SporeRun *run;
  double dt_s, interval_s;
  guint done, count;  /* replays */
  const char *output; /* scene to write; NULL: none */
} Advice;

static void clear_replay(Replay *replay) {
  spore_trial_clear(&replay->trial);
  spore_trial_points_clear(&replay->points);
}

static gboolean cancelled(GError **error) {
  return spore_error_raise(error, SPORE_ERROR_CANCELLED, "", "%s", _("cancelled"));
}

/* Runs the scene varied; what is an effect there is physical in it. perturbation: 0, or by how much the start is off.
 * points: what is followed; chosen here where nothing was chosen yet. */
static gboolean replay(Advice *advice, const SporeVariation *difference, double perturbation, guint32 seed,
                       SporeTrialPoints *points, SporeTrial *trial, GError **error) {
  SporeVariation variation = *difference;
  SporeError fault = SPORE_ERROR_INIT;
  const SporeTrack *input = advice->run->input.channel_count ? &advice->run->input : NULL;
  variation.physical = TRUE;
  *trial = (SporeTrial){0};
  g_autoptr(SporeSimulation) simulation =
      spore_variation_make(advice->run->document, &variation, advice->run->pool, input, spore_cli_cancel(), error);
  if (!simulation) return FALSE;
  SporeProgressShare share = {spore_cli_progress(advice->cli), (double)advice->done / advice->count,
                              1. / advice->count};
  SporeProgress progress = spore_progress_of_share(&share);
  const SporeTrialSettings settings = {.interval_s = advice->interval_s,
                                       .samples = SAMPLES,
                                       .dt_s = variation.dt_s > 0 ? variation.dt_s : advice->dt_s,
                                       .perturbation = perturbation,
                                       .seed = seed,
                                       .exercise = simulation->exercise,
                                       .progress = &progress,
                                       .cancel = spore_cli_cancel()};
  gboolean good = (points->bodies || spore_trial_points_choose(points, simulation->world, SPORE_NO_BODY, &fault)) &&
                  spore_trial_run(trial, simulation->world, points, &settings, &fault);
  advice->done++;
  if (good && !trial->cancelled) return TRUE;
  spore_trial_clear(trial);
  return good ? cancelled(error) : spore_error_propagate(&fault, error);
}

/* The noise floor: half the step, and starts that are a little off. */
static gboolean find_floor(Advice *advice, Replay *full, SporeEvidence *evidence, GError **error) {
  evidence->floor = LEAST_FLOOR, evidence->force_floor = LEAST_FORCE_N, evidence->score_floor = LEAST_SCORE;
  for (guint32 i = 0; i <= PERTURBED; i++) {
    const SporeVariation half = {.dt_s = i == 0 ? 0.5 * advice->dt_s : 0};
    SporeTrial other;
    if (!replay(advice, &half, i == 0 ? 0 : PERTURBATION, i, &full->points, &other, error)) return FALSE;
    SporeInfluence influence = spore_influence_between(&full->points, &full->trial, &full->points, &other);
    if (isfinite(influence.rms)) {
      evidence->floor = fmax(evidence->floor, influence.rms);
      evidence->force_floor = fmax(evidence->force_floor, influence.force);
      evidence->score_floor = fmax(evidence->score_floor, influence.score);
      spore_trial_events_spread(&evidence->events_floor, &full->trial.events, &other.events);
    }
    spore_trial_clear(&other);
  }
  return TRUE;
}

static double step_us(const SporeTrial *trial) { return trial->steps ? 1e6 * trial->cpu_s / (double)trial->steps : 0; }

/* The points without those of a body, whose own motion is not what others feel of it. `bodies` is to be freed; the rest
 * stays that of `points`. */
static SporeTrialPoints without(const SporeTrialPoints *points, guint32 body) {
  SporeTrialPoints others = {.bodies = g_new(SporeTrialBody, points->body_count)};
  for (gsize k = 0; k < points->body_count; k++) {
    if (points->bodies[k].body == body) continue;
    others.bodies[others.body_count++] = points->bodies[k];
    others.count += points->bodies[k].count;
  }
  return others;
}

/* The other bodies in a run in which this one has another form. */
static gboolean try_form(Advice *advice, const Replay *full, guint32 body, const SporeVariation *variation,
                         SporeVerdict verdict, SporeEvidence *evidence, GError **error) {
  SporeTrial other;
  SporeForm *form = &evidence->forms[verdict];
  SporeTrialPoints points = without(&full->points, body);
  gboolean good = replay(advice, variation, 0, 0, &points, &other, error);
  if (good) {
    form->tried = true;
    form->influence = spore_influence_between(&full->points, &full->trial, &points, &other);
    form->saved_us = evidence->step_us - step_us(&other);
    if (verdict == SPORE_VERDICT_EFFECT)
      evidence->events = !spore_trial_events_alike(&full->trial.events, &other.events, &evidence->events_floor);
    spore_trial_clear(&other);
  }
  g_free(points.bodies);
  return good;
}

static gboolean refers_to(const SporeObject *object, const SporeObject *target) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  for (gsize p = 0; p < table->count; p++)
    if (table->parameters[p].type == SPORE_REFERENCE &&
        spore_object_reference(object, table->parameters[p].name) == target)
      return TRUE;
  return FALSE;
}

/* Name of a step of the exercise that is done to the body, and that the run did not do: what the body does for the step
 * was not seen. */
static const char *awaited_of(const Advice *advice, const SporeTrial *full, const SporeObject *body) {
  const SporeObject *section = spore_document_section(advice->run->document, "exercise");
  for (gsize i = 0; i < full->exercise.steps; i++) {
    const char *name = spore_exercise_step_state(advice->run->simulation->exercise, i).name;
    for (guint k = 0; !full->steps_done[i] && k < spore_object_child_count(section); k++) {
      const SporeObject *part = spore_object_child(section, k);
      if (g_strcmp0(spore_object_name(part), name) == 0 && refers_to(part, body)) return spore_object_name(part);
    }
  }
  return NULL;
}

/* Name of an instrument that names the body, or of a link that ties the body to what a device moves. */
static const char *holder_of(SporeDocument *document, const SporeObject *body) {
  static const char *const sections[] = {"tools", "links"};
  for (gsize k = 0; k < G_N_ELEMENTS(sections); k++) {
    const SporeObject *section = spore_document_section(document, sections[k]);
    for (guint i = 0; i < spore_object_child_count(section); i++) {
      const SporeObject *object = spore_object_child(section, i);
      const SporeParameterTable *table = spore_object_type(object)->table;
      gboolean active = k == 0;
      for (gsize p = 0; p < table->count; p++) {
        if (table->parameters[p].type != SPORE_REFERENCE) continue;
        const SporeObject *target = spore_object_reference(object, table->parameters[p].name);
        active |= target && strcmp(spore_object_type(target)->element, "body") == 0 &&
                  (int)spore_object_number(target, "role") == SPORE_ACTIVE;
      }
      if (active && refers_to(object, body)) return spore_object_name(object);
    }
  }
  return NULL;
}

/* Whether the body is replayed as the effect that the kernel has for it. What stands still is a form of its own, and
 * what a link ties would pull at the other end of the link: these are left out instead. */
static gboolean has_effect(const Advice *advice, const SporeObject *body, guint32 index) {
  SporeEffectForm form = spore_model_effect_form(spore_world_body_model(advice->run->simulation->world, index));
  return form != SPORE_EFFECT_STILL &&
         !spore_object_refers_to(spore_document_section(advice->run->document, "links"), body);
}

static gboolean find_evidence(Advice *advice, const Replay *full, gsize followed, SporeEvidence *evidence,
                              GError **error) {
  const SporeWorld *world = advice->run->simulation->world;
  guint32 body = full->points.bodies[followed].body;
  const char *name = spore_world_body_name(world, body);
  SporeObject *object = spore_document_find(advice->run->document, "body", name);
  evidence->own_motion = spore_influence_own_motion(&full->points, &full->trial, followed);
  evidence->held = holder_of(advice->run->document, object);
  gboolean has = has_effect(advice, object, body);
  evidence->alone = full->points.body_count == 1 && !(has && full->trial.exercise.steps > 0);
  evidence->awaited = awaited_of(advice, &full->trial, object);
  if (evidence->held || evidence->alone || evidence->awaited) return TRUE;
  evidence->forms[SPORE_VERDICT_EFFECT].left_out = !has;
  const SporeVariation still = {.still = name}, effect = {.effect = has ? name : NULL, .left_out = has ? NULL : name};
  if (!try_form(advice, full, body, &effect, SPORE_VERDICT_EFFECT, evidence, error)) return FALSE;
  gboolean particles = spore_world_body_model(world, body)->type->particles != NULL;
  if (!particles && evidence->own_motion <= SPORE_EVIDENCE_STILL &&
      !try_form(advice, full, body, &still, SPORE_VERDICT_STILL, evidence, error))
    return FALSE;
  for (int level = 0; level < SPORE_LOD_FINE; level++) {
    if (!spore_world_lod_model(world, body, (SporeLodGrade)level)) continue;
    const SporeVariation coarse = {.body = name, .level = spore_lod_names[level]};
    return try_form(advice, full, body, &coarse, SPORE_VERDICT_COARSE, evidence, error);
  }
  return TRUE;
}

/* Reports. */

#define LEAVE_OUT N_("let a special effect take its place, or leave it out")

static void report_exercise(SporeCli *cli, const SporeExerciseState *exercise, const SporeEvidence *floor) {
  if (exercise->steps == 0) return;
  spore_cli_open(cli, "exercise");
  spore_cli_text(cli, "phase", spore_exercise_phase_names[exercise->phase]);
  spore_cli_number(cli, "score", exercise->score);
  spore_cli_number(cli, "score_floor", floor->score_floor);
  spore_cli_count(cli, "steps", exercise->steps);
  spore_cli_count(cli, "steps_done", exercise->steps_done);
  spore_cli_close(cli);
  spore_cli_say(cli, _("exercise: %zu of %zu steps are done, score %.1f; the same moves the score by %.2g\n"),
                exercise->steps_done, exercise->steps, exercise->score, floor->score_floor);
}

/* Why a cheaper form will do. */
static char *praise_of(const SporeEvidence *evidence, SporeVerdict verdict, gboolean exercise) {
  static const char *const unmoved[SPORE_VERDICT_COUNT] = {
      [SPORE_VERDICT_STILL] = N_("nothing else moves otherwise where it stands still"),
      [SPORE_VERDICT_COARSE] = N_("nothing else moves otherwise at its coarsest level"),
      [SPORE_VERDICT_EFFECT] = N_("nothing else moves otherwise where its effect takes its place")};
  const SporeForm *form = &evidence->forms[verdict];
  GString *text = g_string_new(form->left_out ? _("nothing else moves otherwise without it") : _(unmoved[verdict]));
  if (verdict == SPORE_VERDICT_STILL)
    g_string_append_printf(text, _("; it moves by %.2g %% of its length at most"), 100 * evidence->own_motion);
  if (exercise) g_string_append(text, _("; the exercise has the same steps done and the same score"));
  g_string_append_printf(text, _("; %.0f %% of a step is saved"), 100 * form->saved_us / evidence->step_us);
  return g_string_free(text, FALSE);
}

static char *reason_of(const Advice *advice, const SporeEvidence *evidence, SporeVerdict verdict, gboolean exercise) {
  const SporeForm *out = &evidence->forms[SPORE_VERDICT_EFFECT];
  if (evidence->held) return g_strdup_printf(_("\"%s\" acts on it"), evidence->held);
  if (evidence->alone) return g_strdup(_("it is all that moves by physics"));
  if (evidence->events)
    return g_strdup(_("an instrument or a load does to it what does not happen without it: it is cut, coagulated, "
                      "taken, held, or breaks"));
  if (verdict != SPORE_VERDICT_PHYSICAL) return praise_of(evidence, verdict, exercise);
  if (evidence->awaited)
    return g_strdup_printf(_("step \"%s\" of the exercise is done to it, and not done with this input"),
                           evidence->awaited);
  if (out->influence.rms > evidence->floor && out->influence.worst_body != SPORE_NO_BODY)
    return g_strdup_printf(_("without it \"%s\" is up to %.2g %% of its length elsewhere"),
                           spore_world_body_name(advice->run->simulation->world, out->influence.worst_body),
                           100 * out->influence.worst);
  if (out->influence.force > evidence->force_floor)
    return g_strdup_printf(_("without it hands feel %.2g N less or more"), out->influence.force);
  if (out->influence.steps > 0)
    return g_strdup_printf(_("without it step \"%s\" of the exercise is done otherwise"),
                           spore_exercise_step_state(advice->run->simulation->exercise, out->influence.step).name);
  if (out->influence.score > evidence->score_floor)
    return g_strdup_printf(_("without it the score of the exercise is %.1f away"), out->influence.score);
  if (!(out->saved_us > 0)) return g_strdup(_("leaving it out saves nothing"));
  return g_strdup_printf(_("leaving it out saves %.1f %% of a step, which is not worth it"),
                         100 * out->saved_us / evidence->step_us);
}

static void report_form(SporeCli *cli, const char *name, const SporeForm *form) {
  if (!form->tried) return;
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "form", name);
  spore_cli_number(cli, "influence", form->influence.rms);
  spore_cli_number(cli, "worst", form->influence.worst);
  spore_cli_number(cli, "force_N", form->influence.force);
  spore_cli_number(cli, "score", form->influence.score);
  spore_cli_flag(cli, "same_steps", form->influence.steps == 0);
  spore_cli_number(cli, "saved_us", form->saved_us);
  spore_cli_close(cli);
}

static SporeVerdict report_element(Advice *advice, const char *name, const SporeEvidence *evidence, gboolean exercise,
                                   int width) {
  SporeCli *cli = advice->cli;
  SporeVerdict verdict = spore_evidence_verdict(evidence);
  const SporeForm *out = &evidence->forms[SPORE_VERDICT_EFFECT];
  g_autofree char *reason = reason_of(advice, evidence, verdict, exercise), *id = g_strdup_printf("bodies/%s", name);
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "id", id);
  spore_cli_number(cli, "influence", out->tried ? out->influence.rms : NAN);
  spore_cli_number(cli, "noise_floor", evidence->floor);
  spore_cli_number(cli, "force_N", out->tried ? out->influence.force : NAN);
  spore_cli_number(cli, "force_floor_N", evidence->force_floor);
  spore_cli_number(cli, "cost_us", out->tried ? out->saved_us : NAN);
  spore_cli_number(cli, "own_motion", evidence->own_motion);
  spore_cli_text(cli, "verdict", spore_verdict_names[verdict]);
  spore_cli_text(cli, "reason", reason);
  spore_cli_open_array(cli, "forms");
  for (int k = 0; k < SPORE_VERDICT_COUNT; k++) report_form(cli, spore_verdict_names[k], &evidence->forms[k]);
  spore_cli_close_array(cli);
  spore_cli_close(cli);
  g_autofree char *influence = out->tried ? g_strdup_printf("%.2g %%", 100 * out->influence.rms) : g_strdup("-");
  g_autofree char *cost = out->tried ? g_strdup_printf("%.2f us", out->saved_us) : g_strdup("-");
  spore_cli_say(cli, "%-*s %-9s %9s %12s  %s\n", width, name, spore_verdict_names[verdict], influence, cost, reason);
  return verdict;
}

static void report_suggestions(Advice *advice, const SporeTrialPoints *points, const SporeVerdict *verdicts,
                               const SporeEvidence *evidence) {
  static const char *const changes[SPORE_VERDICT_COUNT] = {[SPORE_VERDICT_STILL] = N_("make it unmovable"),
                                                           [SPORE_VERDICT_COARSE] = N_("begin at its coarsest level"),
                                                           [SPORE_VERDICT_EFFECT] =
                                                               N_("let its special effect take its place")};
  SporeCli *cli = advice->cli;
  guint count = 0;
  spore_cli_open_array(cli, "suggestion");
  for (gsize k = 0; k < points->body_count; k++) {
    if (verdicts[k] == SPORE_VERDICT_PHYSICAL) continue;
    const char *name = spore_world_body_name(advice->run->simulation->world, points->bodies[k].body);
    double saved_us = evidence[k].forms[verdicts[k]].saved_us;
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "id", name);
    const char *change = _(evidence[k].forms[verdicts[k]].left_out ? LEAVE_OUT : changes[verdicts[k]]);
    spore_cli_text(cli, "change", change);
    spore_cli_number(cli, "saves_us", saved_us);
    spore_cli_close(cli);
    spore_cli_say(cli, _("%s: %s; saves %.1f us of %.1f us a step\n"), name, change, saved_us, evidence[k].step_us);
    count++;
  }
  spore_cli_close_array(cli);
  if (count == 0) spore_cli_say(cli, _("nothing to suggest: what is simulated is felt\n"));
  spore_cli_say(cli, _("this holds for this input, over %g s\n"), SAMPLES * advice->interval_s);
}

/* What is an effect now, or was advised on before, takes the verdict. *count: bodies that do. */
static gboolean apply(Advice *advice, const SporeTrialPoints *points, const SporeVerdict *verdicts, guint *count,
                      GError **error) {
  SporeDocument *document = advice->run->document;
  const SporeWorld *world = advice->run->simulation->world;
  for (gsize k = 0; k < points->body_count; k++) {
    guint32 index = points->bodies[k].body;
    SporeObject *body = spore_document_find(document, "body", spore_world_body_name(world, index));
    SporeObject *fidelity = spore_object_child_of(body, "fidelity");
    gboolean effect = verdicts[k] == SPORE_VERDICT_EFFECT && has_effect(advice, body, index);
    if (!effect && !(fidelity && (int)spore_object_number(fidelity, "mode") != SPORE_FIDELITY_PHYSICAL)) continue;
    if (!spore_fidelity_advise(document, body, effect, error)) return FALSE;
    ++*count;
  }
  return TRUE;
}

/* Writes the scene with the verdicts, where that is asked for. */
static gboolean write_scene(Advice *advice, const SporeTrialPoints *points, const SporeVerdict *verdicts,
                            GError **error) {
  guint count = 0;
  if (!advice->output) return TRUE;
  if (!apply(advice, points, verdicts, &count, error)) return FALSE;
  if (count == 0) {
    spore_cli_say(advice->cli, _("nothing was written: no body is to be an effect\n"));
    return TRUE;
  }
  if (!spore_cli_save_scene(advice->run->document, advice->output, error)) return FALSE;
  spore_cli_text(advice->cli, "scene", advice->output);
  spore_cli_say(advice->cli, _("%s: written; bodies that take what was advised: %u\n"), advice->output, count);
  return TRUE;
}

static gboolean advise(Advice *advice, GError **error) {
  const SporeVariation as_it_is = {0};
  SporeEvidence floor = {0};
  Replay full = {0};
  if (!replay(advice, &as_it_is, 0, 0, &full.points, &full.trial, error)) {
    clear_replay(&full);
    return FALSE;
  }
  gsize count = full.points.body_count;
  g_autofree SporeEvidence *evidence = g_new0(SporeEvidence, count);
  g_autofree SporeVerdict *verdicts = g_new0(SporeVerdict, count);
  floor.step_us = step_us(&full.trial);
  gboolean good = find_floor(advice, &full, &floor, error);
  for (gsize k = 0; good && k < count; k++) {
    evidence[k] = floor;
    good = find_evidence(advice, &full, k, &evidence[k], error);
  }
  if (good) {
    SporeCli *cli = advice->cli;
    int width = spore_cli_body_width(advice->run->simulation->world);
    spore_cli_say(cli,
                  _("noise floor: halving the step, or a start that is a little off, moves bodies by %.2g %% of "
                    "their length, and hands feel %.2g N of it\n"),
                  100 * floor.floor, floor.force_floor);
    report_exercise(cli, &full.trial.exercise, &floor);
    spore_cli_say(cli, "%-*s %-9s %9s %12s  %s\n", width, _("body"), _("verdict"), _("influence"), _("cost"), _("why"));
    spore_cli_open_array(cli, "elements");
    for (gsize k = 0; k < count; k++)
      verdicts[k] =
          report_element(advice, spore_world_body_name(advice->run->simulation->world, full.points.bodies[k].body),
                         &evidence[k], full.trial.exercise.steps > 0, width);
    spore_cli_close_array(cli);
    report_suggestions(advice, &full.points, verdicts, evidence);
    good = write_scene(advice, &full.points, verdicts, error);
  }
  clear_replay(&full);
  return good;
}

/* The whole of the recorded input, up to a limit. */
static double usual_time(const SporeRun *run) {
  double longest_s = run->simulation->exercise ? LONGEST_EXERCISE_S : LONGEST_TIME_S;
  const SporeTrack *track = run->input.channel_count ? &run->input : run->simulation->track;
  double end_s = 0;
  for (gsize i = 0; track && i < track->channel_count; i++)
    if (track->channels[i].count) end_s = fmax(end_s, track->channels[i].time_s[track->channels[i].count - 1]);
  return end_s > 0 ? fmin(end_s, longest_s) : USUAL_TIME_S;
}

static int run_advice(SporeCli *cli, const char *scene, const SporeSceneOptions *options,
                      const SporeBudgetRequest *request) {
  GError *error = NULL;
  const char *time = request->time, *output = request->output ? request->output : request->apply ? scene : NULL;
  double time_s = 0;
  if (output && !spore_file_may_be_written(output, TRUE, &error)) return spore_cli_fail(error);
  if (time && !spore_cli_seconds("--time", time, &time_s, &error)) return spore_cli_fail(error);
  g_autoptr(SporeRun) run = spore_run_open(cli, scene, options, 1, &error);
  if (!run) return spore_cli_fail(error);
  Advice advice = {.cli = cli, .run = run, .output = output};
  if (!time) time_s = usual_time(run);
  advice.dt_s = spore_object_number(spore_document_section(run->document, "solver"), "time_step");
  advice.interval_s = advice.dt_s * fmax(1, round(time_s / SAMPLES / advice.dt_s));
  guint passive = 0;
  for (guint32 b = 0; b < spore_world_body_count(run->simulation->world); b++)
    passive += spore_world_body_role(run->simulation->world, b) == SPORE_PASSIVE;
  if (passive == 0) {
    spore_error_raise(&error, SPORE_ERROR_INPUT, scene,
                      _("physics moves no body; expected one at least; there is nothing to advise"));
    return spore_cli_fail(error);
  }
  advice.count = 2 + PERTURBED + 2 * passive;
  gboolean good = advise(&advice, &error);
  if (spore_cli_interrupted()) {
    g_clear_error(&error);
    return SPORE_EXIT_INTERRUPTED;
  }
  return good ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

static int carry_out(SporeCli *cli, const char *scene, const SporeSceneOptions *options,
                     const SporeBudgetRequest *budget) {
  if (budget->budget) return spore_advise_budget(cli, scene, options, budget);
  if (budget->keep || budget->seconds)
    return spore_cli_usage(_("--keep, --seconds: they go with --budget-us; give a budget, or leave them out"));
  return run_advice(cli, scene, options, budget);
}

int spore_command_advise(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"elements",
       N_("bodies that physics moves: id, influence (without it, how far the others are elsewhere: root mean square, "
          "by "
          "their length; null: not tried), noise_floor (the same of half the step, or of a start that is a little "
          "off), force_N and force_floor_N (the same of forces on what devices move), cost_us (of a step, that it "
          "takes), own_motion (by its length), verdict (physical, still, coarse, effect), reason, forms (that were "
          "tried: form, influence, worst, force_N, score and same_steps (of the exercise: how far the score is away, "
          "whether the same steps are done), saved_us)")},
      {"exercise",
       N_("the scene's, as the replay did it: phase, score, score_floor (that half the step, or a start that is a "
          "little off, moves the score by), steps, steps_done")},
      {"suggestion", N_("what may be changed: id, change, saves_us")},
      {"budget",
       N_("with --budget-us, where elements tell the verdict (physical, or the level that is taken), integrator and "
          "level of each body: budget_us (for per_s of simulated time), met, kept_promise, promise_us, runs (of "
          "again_us), before and chosen (dt_s, nonlinear, linear, error: by the length of a body, resolved: it is more "
          "than can be told, as_written, us: for per_s, step_us and p99_us of its own steps, again_us: median, low, "
          "high), tried (runs of the search), together (of them, of several changes at once), start_s, time_s, "
          "contacts, floor, happens (what instruments do in one of the two alone), "
          "applied, cut")},
      {"scene", N_("file that was written, with --apply or --output")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {
      "advise",
      "SCENE",
      N_("Replays the scene without the physics of each of its bodies, and says which of them nobody would miss: "
         "physical where "
         "others "
         "feel it, or an effect where what is seen of it is enough. What has an effect is replayed as one. Where the "
         "scene has an exercise, its steps and score have to stay the same, too. The advice holds for the input that "
         "was replayed."),
      1,
      1,
      members};
  SporeSceneOptions options = {0};
  SporeBudgetRequest budget = {0};
  const GOptionEntry entries[] = {
      {"time", 't', 0, G_OPTION_ARG_STRING, &budget.time,
       N_("Simulated time of each replay (default: the recorded input, up to 10 s, of an exercise up to 120 s; without "
          "one 1 s; with --budget-us 1 s with contacts in it)"),
       "S"},
      {"budget-us", 0, 0, G_OPTION_ARG_STRING, &budget.budget,
       N_("Choose the level and integrator of each body, step and solvers, so that what a step of the scene simulates "
          "now takes at most so many us on the processor, with the least error"),
       "N"},
      {"keep", 0, 0, G_OPTION_ARG_STRING_ARRAY, &budget.keep,
       N_("With --budget-us: a body that keeps its level and integrator (may be repeated)"), "BODY"},
      {"seconds", 0, 0, G_OPTION_ARG_STRING, &budget.seconds,
       N_("With --budget-us: time on the processor that choosing may take (default 40)"), "S"},
      {"apply", 0, 0, G_OPTION_ARG_NONE, &budget.apply,
       N_("Write into the scene which bodies are effects, or what was chosen with --budget-us"), NULL},
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &budget.output, N_("The same, to this file"), "F.spore"},
      SPORE_SCENE_OPTION_ENTRIES(options),
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) status = carry_out(cli, argv[1], &options, &budget);
  spore_scene_options_clear(&options);
  g_free(budget.time);
  g_free(budget.budget);
  g_free(budget.seconds);
  g_free(budget.output);
  g_strfreev(budget.keep);
  return status;
}
