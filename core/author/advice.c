/* Replays a scene without the physics of each of its elements. */
#include "core/author/advice.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/author/advice_private.h"
#include "core/author/edits.h"
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

typedef struct Search {
  SporeDocument *document;
  const SporeSimulation *simulation;
  const SporeAdviceOptions *options;
  double dt_s, interval_s;
  guint done, count; /* replays; count: at most */
  GPtrArray *others; /* SporeObject *: tools and emitters that are advised on */
  SporeAdvice *advice;
} Search;

static void clear_replay(Replay *replay) {
  spore_trial_clear(&replay->trial);
  spore_trial_points_clear(&replay->points);
}

/* Runs the scene varied; what is an effect there is physical in it. perturbation: 0, or by how much the start is off.
 * points: what is followed; chosen here where nothing was chosen yet. */
static gboolean replay(Search *search, const SporeVariation *difference, double perturbation, guint32 seed,
                       SporeTrialPoints *points, SporeTrial *trial, GError **error) {
  SporeVariation variation = *difference;
  SporeError fault = SPORE_ERROR_INIT;
  const SporeAdviceOptions *options = search->options;
  variation.physical = TRUE;
  *trial = (SporeTrial){0};
  g_autoptr(SporeSimulation) simulation =
      spore_variation_make(search->document, &variation, options->pool, options->input, options->cancel, error);
  if (!simulation) return FALSE;
  SporeProgressShare share = {options->progress, (double)search->done / search->count, 1. / search->count};
  SporeProgress progress = spore_progress_of_share(&share);
  const SporeTrialSettings settings = {.interval_s = search->interval_s,
                                       .samples = SAMPLES,
                                       .dt_s = variation.dt_s > 0 ? variation.dt_s : search->dt_s,
                                       .perturbation = perturbation,
                                       .seed = seed,
                                       .exercise = simulation->exercise,
                                       .progress = &progress,
                                       .cancel = options->cancel};
  gboolean good = (points->bodies || spore_trial_points_choose(points, simulation->world, SPORE_NO_BODY, &fault)) &&
                  spore_trial_run(trial, simulation->world, points, &settings, &fault);
  search->done++;
  if (good && !trial->cancelled) return TRUE;
  spore_trial_clear(trial);
  return good ? spore_error_raise(error, SPORE_ERROR_CANCELLED, "", "%s", _("cancelled"))
              : spore_error_propagate(&fault, error);
}

/* The noise floor: half the step, and starts that are a little off. */
static gboolean find_floor(Search *search, Replay *full, SporeEvidence *evidence, GError **error) {
  evidence->floor = LEAST_FLOOR, evidence->force_floor = LEAST_FORCE_N, evidence->score_floor = LEAST_SCORE;
  for (guint32 i = 0; i <= PERTURBED; i++) {
    const SporeVariation half = {.dt_s = i == 0 ? 0.5 * search->dt_s : 0};
    SporeTrial other;
    if (!replay(search, &half, i == 0 ? 0 : PERTURBATION, i, &full->points, &other, error)) return FALSE;
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
static gboolean try_form(Search *search, const Replay *full, guint32 body, const SporeVariation *variation,
                         SporeVerdict verdict, SporeEvidence *evidence, GError **error) {
  SporeTrial other;
  SporeForm *form = &evidence->forms[verdict];
  SporeTrialPoints points = without(&full->points, body);
  gboolean good = replay(search, variation, 0, 0, &points, &other, error);
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

/* Name of a step of the exercise that is done to the body, and that the run did not do: what the body does for the step
 * was not seen. */
static const char *awaited_of(const Search *search, const SporeTrial *full, const SporeObject *body) {
  const SporeObject *section = spore_document_section(search->document, "exercise");
  for (gsize i = 0; i < full->exercise.steps; i++) {
    const char *name = spore_exercise_step_state(search->simulation->exercise, i).name;
    for (guint k = 0; !full->steps_done[i] && k < spore_object_child_count(section); k++) {
      const SporeObject *part = spore_object_child(section, k);
      if (g_strcmp0(spore_object_name(part), name) == 0 && spore_object_refers_to(part, body))
        return spore_object_name(part);
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
      if (active && spore_object_refers_to(object, body)) return spore_object_name(object);
    }
  }
  return NULL;
}

/* Whether the body is replayed as the effect that the kernel has for it. What stands still is a form of its own, and
 * what a link ties would pull at the other end of the link: these are left out instead. */
static gboolean has_effect(const Search *search, const SporeObject *body, guint32 index) {
  SporeEffectForm form = spore_model_effect_form(spore_world_body_model(search->simulation->world, index));
  return form != SPORE_EFFECT_STILL && !spore_object_refers_to(spore_document_section(search->document, "links"), body);
}

/* Tries the forms that the body has. */
static gboolean try_forms(Search *search, const Replay *full, guint32 index, SporeAdviceElement *body, GError **error) {
  const SporeWorld *world = search->simulation->world;
  SporeEvidence *evidence = &body->evidence;
  const char *name = body->name;
  gboolean particles = spore_world_body_model(world, index)->type->particles != NULL;
  const SporeVariation still = {.still = name},
                       effect = {.effect = body->has_effect ? name : NULL, .left_out = body->has_effect ? NULL : name};
  evidence->forms[SPORE_VERDICT_EFFECT].left_out = !body->has_effect;
  if (!try_form(search, full, index, &effect, SPORE_VERDICT_EFFECT, evidence, error)) return FALSE;
  if (!particles && evidence->own_motion <= SPORE_EVIDENCE_STILL &&
      !try_form(search, full, index, &still, SPORE_VERDICT_STILL, evidence, error))
    return FALSE;
  for (int level = 0; level < SPORE_LOD_FINE; level++) {
    if (!spore_world_lod_model(world, index, (SporeLodGrade)level)) continue;
    const SporeVariation coarse = {.body = name, .level = spore_lod_names[level]};
    return try_form(search, full, index, &coarse, SPORE_VERDICT_COARSE, evidence, error);
  }
  return TRUE;
}

static gboolean find_evidence(Search *search, const Replay *full, gsize followed, GError **error) {
  const SporeWorld *world = search->simulation->world;
  guint32 index = full->points.bodies[followed].body;
  SporeAdviceElement *body = &search->advice->elements[followed];
  SporeEvidence *evidence = &body->evidence;
  body->section = "bodies";
  body->name = g_strdup(spore_world_body_name(world, index));
  SporeObject *object = spore_document_find(search->document, "body", body->name);
  *evidence = search->advice->floor;
  evidence->own_motion = spore_influence_own_motion(&full->points, &full->trial, followed);
  evidence->held = body->held = g_strdup(holder_of(search->document, object));
  evidence->awaited = body->awaited = g_strdup(awaited_of(search, &full->trial, object));
  body->has_effect = has_effect(search, object, index);
  evidence->alone = full->points.body_count == 1 && !(body->has_effect && full->trial.exercise.steps > 0);
  if (evidence->held || evidence->alone || evidence->awaited) return TRUE;
  return try_forms(search, full, index, body, error);
}

/* A tool or an emitter: its effect alone is tried, and all bodies may feel that. */
static gboolean find_evidence_of(Search *search, const Replay *full, SporeObject *object, SporeAdviceElement *element,
                                 GError **error) {
  SporeEvidence *evidence = &element->evidence;
  const SporeVariation effect = {.effect_section = element->section, .effect = element->name};
  *evidence = search->advice->floor;
  evidence->awaited = element->awaited = g_strdup(awaited_of(search, &full->trial, object));
  evidence->events_floor.held = UINT64_MAX; /* how many spheres it holds is its own affair */
  element->has_effect = TRUE;
  return evidence->awaited || try_form(search, full, SPORE_NO_BODY, &effect, SPORE_VERDICT_EFFECT, evidence, error);
}

/* The tools and emitters that have a form as an effect, of which something is seen. */
static GPtrArray *others_of(SporeDocument *document) {
  static const char *const sections[] = {"tools", "effects"};
  GPtrArray *others = g_ptr_array_new();
  for (gsize k = 0; k < G_N_ELEMENTS(sections); k++) {
    SporeObject *section = spore_document_section(document, sections[k]);
    for (guint i = 0; i < spore_object_child_count(section); i++)
      if (spore_fidelity_is_seen(spore_object_child(section, i)))
        g_ptr_array_add(others, spore_object_child(section, i));
  }
  return others;
}

static gboolean find(Search *search, GError **error) {
  SporeAdvice *advice = search->advice;
  const SporeVariation as_it_is = {0};
  Replay full = {0};
  gboolean good = replay(search, &as_it_is, 0, 0, &full.points, &full.trial, error);
  if (good) {
    advice->floor.step_us = step_us(&full.trial);
    advice->exercise = full.trial.exercise;
    advice->count = full.points.body_count + search->others->len;
    advice->elements = g_new0(SporeAdviceElement, advice->count);
    good = find_floor(search, &full, &advice->floor, error);
    advice->floor.chaotic = advice->floor.floor > SPORE_EVIDENCE_TELLING && full.trial.exercise.steps == 0;
  }
  for (gsize k = 0; good && k < full.points.body_count; k++) good = find_evidence(search, &full, k, error);
  for (guint i = 0; good && i < search->others->len; i++) {
    SporeObject *other = search->others->pdata[i];
    SporeAdviceElement *element = &advice->elements[full.points.body_count + i];
    element->section = spore_object_type(spore_object_parent(other))->element;
    element->name = g_strdup(spore_object_name(other));
    good = find_evidence_of(search, &full, other, element, error);
  }
  for (gsize k = 0; good && k < advice->count; k++) {
    SporeAdviceElement *body = &advice->elements[k];
    body->verdict = spore_evidence_verdict(&body->evidence);
    body->reason = spore_advice_reason(body, &advice->exercise, search->simulation);
  }
  clear_replay(&full);
  return good;
}

/* The whole of the recorded input, up to a limit. */
static double usual_time(const SporeTrack *track, gboolean exercise) {
  double end_s = spore_track_end_s(track);
  return end_s > 0 ? fmin(end_s, exercise ? LONGEST_EXERCISE_S : LONGEST_TIME_S) : USUAL_TIME_S;
}

SporeAdvice *spore_advice_find(SporeDocument *document, const SporeSimulation *simulation,
                               const SporeAdviceOptions *options, GError **error) {
  const SporeWorld *world = simulation->world;
  Search search = {.document = document, .simulation = simulation, .options = options};
  guint passive = 0;
  for (guint32 b = 0; b < spore_world_body_count(world); b++)
    passive += spore_world_body_role(world, b) == SPORE_PASSIVE;
  if (passive == 0) {
    spore_error_raise(error, SPORE_ERROR_INPUT, "bodies",
                      _("physics moves no body; expected one at least; there is nothing to advise"));
    return NULL;
  }
  double time_s = options->time_s > 0
                      ? options->time_s
                      : usual_time(options->input ? options->input : simulation->track, simulation->exercise != NULL);
  search.dt_s = spore_object_number(spore_document_section(document, "solver"), "time_step");
  search.interval_s = search.dt_s * fmax(1, round(time_s / SAMPLES / search.dt_s));
  search.others = others_of(document);
  search.count = 2 + PERTURBED + 2 * passive + search.others->len;
  search.advice = g_new0(SporeAdvice, 1);
  search.advice->time_s = SAMPLES * search.interval_s;
  gboolean found = find(&search, error);
  g_ptr_array_unref(search.others);
  if (found) return search.advice;
  spore_advice_free(search.advice);
  return NULL;
}

void spore_advice_free(SporeAdvice *advice) {
  if (!advice) return;
  for (gsize k = 0; k < advice->count; k++) {
    g_free(advice->elements[k].name);
    g_free(advice->elements[k].held);
    g_free(advice->elements[k].awaited);
    g_free(advice->elements[k].reason);
  }
  g_free(advice->elements);
  g_free(advice);
}

/* What is to be done with it. */

static SporeObject *object_of(const SporeAdviceElement *element, SporeDocument *document) {
  g_autofree char *path = g_strdup_printf("%s/%s", element->section, element->name);
  return spore_document_by_path(document, path);
}

static gboolean is_effect(const SporeAdviceElement *body) {
  return body->verdict == SPORE_VERDICT_EFFECT && body->has_effect;
}

/* What is an effect now, or was advised on before, takes the verdict. */
static gboolean takes_verdict(const SporeAdviceElement *body, const SporeObject *object) {
  const SporeObject *fidelity = spore_object_child_of(object, "fidelity");
  return is_effect(body) || (fidelity && (int)spore_object_number(fidelity, "mode") != SPORE_FIDELITY_PHYSICAL);
}

guint spore_advice_count(const SporeAdvice *advice, SporeDocument *document) {
  guint count = 0;
  for (gsize k = 0; k < advice->count; k++)
    count += takes_verdict(&advice->elements[k], object_of(&advice->elements[k], document));
  return count;
}

gboolean spore_advice_apply(const SporeAdvice *advice, SporeDocument *document, GError **error) {
  gboolean good = TRUE;
  spore_document_begin(document, _("What was advised"));
  for (gsize k = 0; good && k < advice->count; k++) {
    SporeObject *object = object_of(&advice->elements[k], document);
    if (takes_verdict(&advice->elements[k], object))
      good = spore_fidelity_advise(document, object, is_effect(&advice->elements[k]), error);
  }
  return spore_edit_finish(document, good);
}
