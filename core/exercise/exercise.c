/* Makes exercises, and watches a world by them. */
#include "core/exercise/exercise.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/parameter_rows.h"
#include "core/base/text.h"
#include "core/exercise/exercise_private.h"
#include "core/math/quat.h"

static const char *const orders[] = {"free", "given", NULL};
static const SporeParameter rows[] = {
    {.name = "task",
     .type = SPORE_TEXT,
     .unit = "",
     .offset = offsetof(SporeExerciseFields, task),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("What the trainee is told to do.")},
    SPORE_ROW_REAL(SporeExerciseFields, time_limit, "s", 0, 86400, 0,
                   N_("Time after which nothing counts any more; 0: none.")),
    SPORE_ROW_CHOICE(SporeExerciseFields, order, orders,
                     N_("When steps count: free, at once or after the step that they name; given, one after the other "
                        "as they are listed.")),
};
const SporeParameterTable spore_exercise_parameters = SPORE_TABLE(rows, SporeExerciseFields);

/* Making. */

/* Copies a text that the exercise then owns; NULL stays NULL. False: no memory. */
static bool own_text(const char **text) {
  if (!*text) return true;
  *text = spore_copy_text(*text);
  return *text != NULL;
}

static void disown(const char *text) { spore_free((void *)(uintptr_t)text); }

static bool refuse(SporeError *error, const char *name, const char *format, const char *a, const char *b) {
  char place[200];
  snprintf(place, sizeof place, "exercise/%s", name);
  return spore_error_set(error, SPORE_ERROR_INPUT, place, format, a, b);
}

static bool read_threshold(const SporeMetricRun *metric, const char *text, double *value, SporeError *error) {
  *value = NAN;
  const char *fault = text ? spore_threshold_read(metric->from.kind, text, value) : NULL;
  return !fault || refuse(error, metric->from.fields.name, fault, text, metric->from.kind->units[0].name);
}

static bool make_metric(SporeExercise *exercise, SporeMetricRun *metric, SporeError *error) {
  SporeMetricFields *fields = &metric->from.fields;
  if (!read_threshold(metric, fields->good, &metric->good, error) ||
      !read_threshold(metric, fields->pass, &metric->pass, error))
    return false;
  double sign = metric->from.kind->more_is_better ? -1 : 1;
  if (sign * metric->good > sign * metric->pass)
    return refuse(error, fields->name,
                  _("good=\"%s\" is worse than pass=\"%s\"; expected it to be better; exchange them"), fields->good,
                  fields->pass);
  if (metric->from.kind->traces) metric->traces = SPORE_NEW_ARRAY(SporeTrace, exercise->instrument_count + 1);
  bool whole = metric->traces || !metric->from.kind->traces;
  return whole || spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the exercise"));
}

/* Whether the steps that it waits for come to an end. */
static bool can_open(const SporeExercise *exercise, uint32_t step) {
  for (size_t passed = 0; passed <= exercise->step_count; passed++) {
    if (step == SPORE_NO_PART) return true;
    step = exercise->steps[step].from.after;
  }
  return false;
}

static bool check_steps(const SporeExercise *exercise, SporeError *error) {
  for (uint32_t i = 0; i < exercise->step_count; i++)
    if (!can_open(exercise, i))
      return refuse(error, exercise->steps[i].from.fields.name,
                    _("%s waits for \"%s\", which waits for it; expected an order; let one of them wait for none"),
                    exercise->steps[i].from.fields.name,
                    exercise->steps[exercise->steps[i].from.after].from.fields.name);
  return true;
}

/* In the order that is given each step waits for the one before, too. A step that names another already waits. */
static void order_steps(SporeExercise *exercise) {
  for (uint32_t i = 1; exercise->fields.order == SPORE_ORDER_GIVEN && i < exercise->step_count; i++)
    if (exercise->steps[i].from.after == SPORE_NO_PART) exercise->steps[i].from.after = i - 1;
}

static SporeView view_in_frame(const SporeView *from, const SporeWorld *world) {
  SporeView view = *from;
  const SporeModel *model = view.body == SPORE_NO_BODY ? NULL : spore_world_body_model(world, view.body);
  if (model && !spore_model_is_rigid(model)) view.body = SPORE_NO_BODY;
  if (view.body == SPORE_NO_BODY) return view;
  SporePose start = spore_world_start_pose(world, view.body);
  view.position = spore_pose_apply_inverse(start, from->position);
  view.target = spore_pose_apply_inverse(start, from->target);
  return view;
}

static bool allocate(SporeExercise *exercise, const SporeExerciseDescription *from) {
  exercise->instruments = SPORE_NEW_ARRAY(SporeInstrument, from->instrument_count + 1);
  exercise->before = SPORE_NEW_ARRAY(SporeToolBefore, from->instrument_count + 1);
  exercise->views = SPORE_NEW_ARRAY(SporeView, from->view_count + 1);
  exercise->steps = SPORE_NEW_ARRAY(SporeStepRun, from->step_count + 1);
  exercise->metrics = SPORE_NEW_ARRAY(SporeMetricRun, from->metric_count + 1);
  exercise->instrument_of = SPORE_NEW_ARRAY(uint32_t, exercise->body_count + 1);
  exercise->marks = SPORE_NEW_ARRAY(SporeBodyMarks, exercise->body_count + 1);
  return exercise->instruments && exercise->before && exercise->views && exercise->steps && exercise->metrics &&
         exercise->instrument_of && exercise->marks;
}

static bool own_texts(SporeExercise *exercise, const SporeExerciseDescription *from) {
  exercise->fields = from->fields;
  bool whole = own_text(&exercise->fields.task);
  for (size_t i = 0; i < from->step_count; i++) {
    SporeStepRun *step = &exercise->steps[exercise->step_count++];
    step->from = from->steps[i];
    whole &= own_text(&step->from.fields.name);
    whole &= own_text(&step->from.fields.hint);
  }
  for (size_t i = 0; i < from->metric_count; i++) {
    SporeMetricRun *metric = &exercise->metrics[exercise->metric_count++];
    metric->from = from->metrics[i];
    whole &= own_text(&metric->from.fields.name);
    whole &= own_text(&metric->from.fields.source);
  }
  return whole;
}

static void place_instruments(SporeExercise *exercise, const SporeExerciseDescription *from, const SporeWorld *world) {
  for (size_t b = 0; b < exercise->body_count; b++) exercise->instrument_of[b] = SPORE_NO_PART;
  for (uint32_t i = 0; i < from->instrument_count; i++) {
    exercise->instruments[i] = from->instruments[i];
    for (int k = 0; k < SPORE_TOOL_BODIES; k++)
      if (from->instruments[i].bodies[k] != SPORE_NO_BODY) exercise->instrument_of[from->instruments[i].bodies[k]] = i;
  }
  exercise->instrument_count = from->instrument_count;
  for (size_t i = 0; i < from->view_count; i++) exercise->views[i] = view_in_frame(&from->views[i], world);
  exercise->view_count = from->view_count;
}

/* What touches alone is no tool of the world. */
static const char *element_of(const SporeInstrument *instrument, const SporeWorld *world) {
  return instrument->tool == SPORE_NO_PART ? "probe" : spore_world_tool_type(world, instrument->tool)->element;
}

static void find_able(SporeExercise *exercise, const SporeWorld *world) {
  for (size_t s = 0; s < exercise->step_count; s++)
    for (uint32_t i = 0; i < exercise->instrument_count; i++)
      if (spore_event_kind_allows(exercise->steps[s].from.kind, element_of(&exercise->instruments[i], world)))
        exercise->steps[s].able |= UINT64_C(1) << i;
}

static bool make(SporeExercise *exercise, const SporeExerciseDescription *from, const SporeWorld *world,
                 SporeError *error) {
  exercise->body_count = spore_world_body_count(world);
  if (from->instrument_count > SPORE_INSTRUMENTS_MOST)
    return spore_error_set(
        error, SPORE_ERROR_INPUT, "exercise",
        _("the scene has %zu instruments; expected at most %d where there is an exercise; remove some"),
        from->instrument_count, SPORE_INSTRUMENTS_MOST);
  bool whole = allocate(exercise, from);
  if (!whole || !own_texts(exercise, from))
    return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the exercise"));
  place_instruments(exercise, from, world);
  find_able(exercise, world);
  exercise->up = spore_vec3_normalise(from->up, (SporeVec3){0, 0, 0});
  order_steps(exercise);
  bool made = check_steps(exercise, error);
  for (size_t i = 0; made && i < exercise->metric_count; i++)
    made = make_metric(exercise, &exercise->metrics[i], error);
  return made;
}

SporeExercise *spore_exercise_create(const SporeExerciseDescription *description, const SporeWorld *world,
                                     SporeError *error) {
  SporeExercise *exercise = SPORE_NEW(SporeExercise);
  if (!exercise) {
    spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the exercise"));
    return NULL;
  }
  if (make(exercise, description, world, error)) {
    spore_exercise_restart(exercise, world);
    return exercise;
  }
  spore_exercise_free(exercise);
  return NULL;
}

void spore_exercise_free(SporeExercise *exercise) {
  if (!exercise) return;
  disown(exercise->fields.task);
  for (size_t i = 0; i < exercise->step_count; i++) {
    disown(exercise->steps[i].from.fields.name);
    disown(exercise->steps[i].from.fields.hint);
  }
  for (size_t i = 0; i < exercise->metric_count; i++) {
    disown(exercise->metrics[i].from.fields.name);
    disown(exercise->metrics[i].from.fields.source);
    spore_free(exercise->metrics[i].traces);
  }
  spore_free(exercise->instruments);
  spore_free(exercise->before);
  spore_free(exercise->views);
  spore_free(exercise->steps);
  spore_free(exercise->metrics);
  spore_free(exercise->instrument_of);
  spore_free(exercise->marks);
  spore_free(exercise);
}

/* Watching. */

static void remember(SporeExercise *exercise, const SporeWorld *world) {
  for (size_t i = 0; i < exercise->instrument_count; i++) {
    if (exercise->instruments[i].tool == SPORE_NO_PART) continue;
    SporeToolState now = spore_world_tool_state(world, exercise->instruments[i].tool);
    exercise->before[i] = (SporeToolBefore){now.taken, now.cut, now.pierced};
  }
  for (uint32_t b = 0; b < exercise->body_count; b++) exercise->marks[b] = spore_world_body_marks(world, b);
  exercise->world_s = spore_world_time_s(world);
}

static void look_at_metrics(SporeExercise *exercise, const SporeWorld *world, double h) {
  for (size_t i = 0; i < exercise->metric_count; i++) {
    SporeMetricRun *metric = &exercise->metrics[i];
    if (metric->from.kind->look) metric->from.kind->look(exercise, metric, world, h);
  }
}

/* One that it waits for through others may have come undone. */
static bool is_open(const SporeExercise *exercise, const SporeStepRun *step) {
  for (uint32_t at = step->from.after; at != SPORE_NO_PART; at = exercise->steps[at].from.after)
    if (exercise->steps[at].phase != SPORE_STEP_DONE) return false;
  return true;
}

static void open_steps(SporeExercise *exercise) {
  for (size_t i = 0; i < exercise->step_count; i++) {
    SporeStepRun *step = &exercise->steps[i];
    if (step->phase != SPORE_STEP_WAITING || !is_open(exercise, step)) continue;
    step->phase = SPORE_STEP_OPEN;
    step->amount = 0;
    step->since_s = -1;
  }
}

static bool happens(const SporeExercise *exercise, SporeStepRun *step, const SporeWorld *world) {
  const SporeEventKind *kind = step->from.kind;
  bool by_none = step->from.container != SPORE_NO_BODY ||
                 (!kind->needs_body && step->from.body != SPORE_NO_BODY); /* what a body does by itself */
  if (by_none) return kind->happens(exercise, step, world, SPORE_NO_PART);
  if (step->from.instrument != SPORE_NO_PART) return kind->happens(exercise, step, world, step->from.instrument);
  bool happened = false;
  for (uint32_t i = 0; i < exercise->instrument_count && !happened; i++)
    happened = (step->able >> i & 1) && kind->happens(exercise, step, world, i);
  return happened;
}

static void look_at_step(SporeExercise *exercise, SporeStepRun *step, const SporeWorld *world) {
  bool now = happens(exercise, step, world);
  if (step->phase == SPORE_STEP_WAITING) {
    step->early += now && !step->was && step->from.kind->lasting;
    step->was = now;
    return;
  }
  if (!now) step->since_s = -1;
  else if (step->since_s < 0) step->since_s = exercise->time_s;
  if (!now || exercise->time_s - step->since_s < step->from.fields.time * (1 - 1e-12)) return;
  step->phase = SPORE_STEP_DONE;
  step->done_s = exercise->time_s;
  exercise->steps_done++;
  exercise->step_was_done = true;
}

static bool waits_for(const SporeExercise *exercise, uint32_t step, uint32_t other) {
  for (uint32_t at = exercise->steps[step].from.after; at != SPORE_NO_PART; at = exercise->steps[at].from.after)
    if (at == other) return true;
  return false;
}

static bool is_needed(const SporeExercise *exercise, uint32_t step) {
  for (uint32_t i = 0; i < exercise->step_count; i++)
    if (exercise->steps[i].phase != SPORE_STEP_DONE && waits_for(exercise, i, step)) return true;
  return false;
}

/* The step is to be done again, and what waits for it waits anew. */
static void lose_step(SporeExercise *exercise, uint32_t index) {
  SporeStepRun *lost = &exercise->steps[index];
  lost->phase = SPORE_STEP_OPEN;
  lost->done_s = NAN;
  lost->since_s = -1;
  lost->lost++;
  exercise->steps_done--;
  for (uint32_t i = 0; i < exercise->step_count; i++) {
    SporeStepRun *step = &exercise->steps[i];
    if (step->phase != SPORE_STEP_OPEN || !waits_for(exercise, i, index)) continue;
    step->phase = SPORE_STEP_WAITING;
    step->amount = 0;
  }
}

/* Steps whose event had to last, and ended. */
static void lose_steps(SporeExercise *exercise, const SporeWorld *world) {
  for (uint32_t i = 0; i < exercise->step_count; i++) {
    SporeStepRun *step = &exercise->steps[i];
    if (step->phase == SPORE_STEP_DONE && step->from.fields.stays && !step->skipped && is_needed(exercise, i) &&
        !happens(exercise, step, world))
      lose_step(exercise, i);
  }
}

static void look_at_steps(SporeExercise *exercise, const SporeWorld *world) {
  exercise->step_was_done = false;
  lose_steps(exercise, world);
  for (size_t i = 0; i < exercise->step_count; i++)
    if (exercise->steps[i].phase != SPORE_STEP_DONE) look_at_step(exercise, &exercise->steps[i], world);
  open_steps(exercise);
}

void spore_exercise_restart(SporeExercise *exercise, const SporeWorld *world) {
  exercise->time_s = 0;
  exercise->looks = 0;
  exercise->steps_done = 0;
  exercise->phase = SPORE_EXERCISE_RUNNING;
  exercise->step_was_done = exercise->paused = exercise->tried = false;
  for (size_t i = 0; i < exercise->step_count; i++)
    exercise->steps[i] = (SporeStepRun){.from = exercise->steps[i].from,
                                        .able = exercise->steps[i].able,
                                        .done_s = NAN,
                                        .since_s = -1,
                                        .holder = SPORE_NO_PART};
  for (size_t i = 0; i < exercise->metric_count; i++) {
    SporeMetricRun *metric = &exercise->metrics[i];
    *metric =
        (SporeMetricRun){.from = metric->from, .good = metric->good, .pass = metric->pass, .traces = metric->traces};
    if (metric->traces) memset(metric->traces, 0, exercise->instrument_count * sizeof *metric->traces);
    if (metric->from.kind->needs_fluid) metric->start = spore_particles_out(world, metric->from.body);
  }
  open_steps(exercise);
  remember(exercise, world);
  look_at_metrics(exercise, world, 0);
}

void spore_exercise_pause(SporeExercise *exercise, bool paused) { exercise->paused = paused; }

void spore_exercise_try_out(SporeExercise *exercise) { exercise->tried = true; }

void spore_exercise_skip_to(SporeExercise *exercise, size_t index) {
  assert(index < exercise->step_count);
  if (exercise->phase != SPORE_EXERCISE_RUNNING || exercise->steps[index].phase != SPORE_STEP_WAITING) return;
  for (uint32_t at = exercise->steps[index].from.after; at != SPORE_NO_PART; at = exercise->steps[at].from.after) {
    SporeStepRun *step = &exercise->steps[at];
    if (step->phase == SPORE_STEP_DONE) continue;
    step->phase = SPORE_STEP_DONE;
    step->skipped = true;
    step->done_s = exercise->time_s;
    exercise->steps_done++;
  }
  spore_exercise_try_out(exercise);
  open_steps(exercise);
}

void spore_exercise_watch(SporeExercise *exercise, const SporeWorld *world) {
  double h = spore_world_time_s(world) - exercise->world_s;
  if (exercise->phase == SPORE_EXERCISE_RUNNING && !exercise->paused) {
    exercise->looks++;
    exercise->time_s += h;
    look_at_steps(exercise, world);
    look_at_metrics(exercise, world, h);
    if (exercise->step_count > 0 && exercise->steps_done == exercise->step_count) exercise->phase = SPORE_EXERCISE_DONE;
    else if (exercise->fields.time_limit > 0 && exercise->time_s >= exercise->fields.time_limit)
      exercise->phase = SPORE_EXERCISE_OUT_OF_TIME;
  }
  remember(exercise, world);
}

/* What came of it. */

const char *const spore_exercise_phase_names[SPORE_EXERCISE_PHASES] = {"running", "done", "out_of_time"};
const char *const spore_step_phase_names[SPORE_STEP_PHASES] = {"waiting", "open", "done"};
const char *const spore_metric_verdict_names[SPORE_METRIC_VERDICTS] = {"none", "good", "pass", "fail", "unfinished"};

SporeStepState spore_exercise_step_state(const SporeExercise *exercise, size_t index) {
  assert(index < exercise->step_count);
  const SporeStepRun *step = &exercise->steps[index];
  return (SporeStepState){.name = step->from.fields.name,
                          .hint = step->from.fields.hint,
                          .kind = step->from.kind,
                          .phase = step->phase,
                          .done_s = step->done_s,
                          .early = step->early,
                          .lost = step->lost};
}

/* The mark of a value, where less is better. */
static double mark_of(double value, double good, double pass) {
  if (isnan(value)) return 0;
  double only = isnan(pass) ? good : pass;
  if (isnan(good) || isnan(pass) || !(pass > good)) return value <= only ? 1 : 0;
  return fmin(fmax(1 - 0.5 * (value - good) / (pass - good), 0), 1);
}

SporeMetricState spore_exercise_metric_state(const SporeExercise *exercise, size_t index) {
  assert(index < exercise->metric_count);
  const SporeMetricRun *metric = &exercise->metrics[index];
  const SporeMetricKind *kind = metric->from.kind;
  SporeMetricState state = {.name = metric->from.fields.name,
                            .source = metric->from.fields.source,
                            .kind = kind,
                            .unit = kind->units[0].name,
                            .value = kind->value(exercise, metric),
                            .good = metric->good,
                            .pass = metric->pass,
                            .mark = NAN};
  if (isnan(state.good) && isnan(state.pass)) return state;
  double sign = kind->more_is_better ? -1 : 1, value = sign * state.value;
  bool whole = kind->more_is_better || exercise->steps_done == exercise->step_count;
  state.mark = whole ? mark_of(value, sign * state.good, sign * state.pass) : 0;
  bool good = value <= sign * state.good, pass = value <= sign * (isnan(state.pass) ? state.good : state.pass);
  state.verdict = !good && !pass ? SPORE_METRIC_FAIL
                  : !whole       ? SPORE_METRIC_UNFINISHED
                  : good         ? SPORE_METRIC_GOOD
                                 : SPORE_METRIC_PASS;
  return state;
}

SporeExercisePhase spore_exercise_phase(const SporeExercise *exercise) { return exercise->phase; }

SporeExerciseState spore_exercise_state(const SporeExercise *exercise) {
  SporeExerciseState state = {.phase = exercise->phase,
                              .paused = exercise->paused,
                              .tried = exercise->tried,
                              .time_s = exercise->time_s,
                              .steps = exercise->step_count,
                              .steps_done = exercise->steps_done,
                              .errors = spore_exercise_errors(exercise),
                              .metrics = exercise->metric_count};
  double marks = 0, weights = 0;
  bool failed = false;
  for (size_t i = 0; i < exercise->metric_count; i++) {
    SporeMetricState metric = spore_exercise_metric_state(exercise, i);
    if (metric.verdict == SPORE_METRIC_NONE) continue;
    double weight = exercise->metrics[i].from.fields.weight;
    marks += weight * metric.mark, weights += weight;
    failed |= metric.verdict == SPORE_METRIC_FAIL;
  }
  double share = state.steps > 0 ? (double)state.steps_done / (double)state.steps : 1;
  state.score = 100 * share * (weights > 0 ? marks / weights : 1);
  state.passed = state.steps_done == state.steps && !failed;
  return state;
}
