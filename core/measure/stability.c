/* The study: cases, limits and the map, as far as the time allows. */
#include "core/measure/stability.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/integrate/integrator.h"
#include "core/measure/stability_private.h"

#define QUICK_STEPS 100 /* of a trial */
#define QUICK_CUTS 6
#define CUTS 9
#define LIMIT_STEPS 300      /* of a trial, where time is given */
#define CELL_STEPS 100       /* of a cell of the map */
#define WORK_OF_A_CASE 2.5e6 /* steps times degrees of freedom */
#define WORK_OF_A_QUICK_CASE 2.5e5
#define TIMES_EXPLICIT 8 /* as many steps where none is implicit */
#define LEAST_STEPS 100  /* of a case */
#define USUAL_TIME_S 1.
/* Parts of the time: limits are found until the first, cases are run until the second, the map is made after that. */
#define UNTIL_LIMITS 0.4
#define UNTIL_CASES 0.8
#define UNTIL_CASES_ALONE 0.95 /* where no map is wanted */
#define SMALL_STEP 1e-9        /* of the scene's: the smallest step that a scene may have is taken */
#define LEFT_OUT_MOST 16
/* Times the steps of a case, until an instrument meets something. */
#define LONGER 4
#define LONGER_QUICK 3

typedef struct Study {
  const SporeStabilityScene *scene;
  const SporeStabilityOptions *options;
  SporeStabilityReport *report;
  uint64_t begun_ns;
  double done, all; /* pieces of work, for the progress */
  bool spent;       /* the world of the scene was changed so that no reset helps */
  SporeError *error;
} Study;

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory to try the scene"));
}

/* False: cancelled. */
static bool go_on(Study *study, double pieces, const char *what) {
  study->done += pieces;
  double part = study->all > 0 ? fmin(study->done / study->all, 1) : 0;
  return spore_progress_step(study->options->progress, part, what, study->error);
}

static uint64_t clock_at(const Study *study, double part) {
  return study->begun_ns + (uint64_t)(1e9 * part * study->options->most_s);
}

static double until_cases(const Study *study) { return study->options->map ? UNTIL_CASES : UNTIL_CASES_ALONE; }

static bool is_late(const Study *study, double part) { return spore_clock_ns() > clock_at(study, part); }

/* Notes what is left out, and why. Things that are left out for one reason share a line. */
static void leave_out(Study *study, const char *why, const char *what) {
  SporeStabilityReport *report = study->report;
  SporeStabilityLeftOut *line = NULL;
  for (size_t i = 0; i < report->left_out_count; i++)
    if (strcmp(report->left_out[i].why, why) == 0) line = &report->left_out[i];
  if (!line) {
    if (report->left_out_count == LEFT_OUT_MOST) return;
    line = &report->left_out[report->left_out_count++];
    snprintf(line->why, sizeof line->why, "%s", why);
  }
  size_t used = strlen(line->what);
  snprintf(line->what + used, sizeof line->what - used, "%s%s", used > 0 ? ", " : "", what);
}

/* Cases. */

/* Why the case cannot be had in this scene; NULL: it can. */
static const char *impossible(const SporeWorld *world, const SporePush *push) {
  size_t passive = 0;
  for (uint32_t b = 0; b < spore_world_body_count(world); b++)
    passive += spore_world_body_role(world, b) == SPORE_PASSIVE;
  if (push->input != SPORE_INPUT_AS_IT_IS && !spore_input_is_possible(world)) return _("no instrument has a device");
  if (push->start != SPORE_START_AS_IT_IS && !spore_start_is_possible(world, push->start))
    return push->start == SPORE_START_OVERLAP ? _("there are no two bodies with spheres") : _("no body deforms");
  if (push->change.every_second && passive < 2) return _("there is but one body that physics moves");
  return NULL;
}

/* Steps of a case, so that it takes as long as the scene's `steps`, between half and twice as many. The scene as it is
 * goes on until an instrument meets something, and so do all cases after that if there is time. */
static SporePushLength length_of(const Study *study, const SporePush *push) {
  size_t own = study->report->steps;
  double steps = fmin(fmax((double)own / push->change.time_step, 0.5 * (double)own), 2 * (double)own);
  bool first = push == &spore_pushes[0] && study->options->time_s == 0;
  return (SporePushLength){.steps = (size_t)steps,
                           .most = first ? (study->options->quick ? LONGER_QUICK : LONGER) * own : 0,
                           .until_ns = clock_at(study, until_cases(study))};
}

/* Whether there is time for all cases, each as long as the one that began then. */
static bool are_affordable(const Study *study, uint64_t begun_ns) {
  double count = 0;
  for (size_t i = 0; i < spore_push_count; i++) count += spore_pushes[i].quick || !study->options->quick;
  double all_s = (until_cases(study) - UNTIL_LIMITS) * study->options->most_s;
  return 1e-9 * (double)(spore_clock_ns() - begun_ns) <= all_s / count;
}

/* Whether a world was not made for want of memory, or since the study was cancelled: then the study ends, too. */
static bool is_fatal(Study *study, const SporeError *refusal) {
  bool fatal = refusal->code == SPORE_ERROR_CANCELLED || refusal->code == SPORE_ERROR_MEMORY;
  if (fatal && study->error) *study->error = *refusal;
  return fatal;
}

/* Runs the case. False: cancelled, or no memory. */
static bool push_world(Study *study, SporeWorld *world, const SporePush *push, SporePushLength length,
                       SporePushRun *run) {
  if (!spore_push_run(study->scene, world, push, length, run)) return no_memory(study->error);
  if (spore_world_cancelled(world)) return spore_error_set(study->error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
  return true;
}

static bool has_remedy(const SporePush *push) { return push->stiffer_contacts > 0 || push->smaller_steps > 0; }

/* Runs the case again with its remedy. False: cancelled, or no memory. */
static bool try_remedy(Study *study, const SporePush *push, SporeStabilityCase *into) {
  SporePush mended = *push;
  SporePushLength length = length_of(study, push);
  if (push->stiffer_contacts > 0) mended.change.contact *= push->stiffer_contacts;
  else mended.change.time_step /= push->smaller_steps, length.steps *= (size_t)push->smaller_steps;
  SporeError refusal = SPORE_ERROR_INIT;
  SporeWorld *world = study->scene->make(study->scene->data, &mended.change, &refusal);
  if (!world) return !is_fatal(study, &refusal);
  SporePushRun run;
  char detail[sizeof into->detail];
  bool done = push_world(study, world, &mended, length, &run);
  if (done && run.out_of_time) {
    char what[200];
    snprintf(what, sizeof what, _("remedy of: %s"), _(push->label));
    leave_out(study, _("no time; give it more by --seconds"), what);
  } else if (done && spore_push_judge(world, &mended, &run, detail, sizeof detail) != SPORE_STABILITY_FAILED) {
    into->verdict = SPORE_STABILITY_RECOVERED;
    spore_push_add_remedy(push, into->detail, sizeof into->detail);
  }
  study->scene->drop(study->scene->data, world);
  return done;
}

/* Runs the case in the world. False: cancelled, or no memory. */
static bool run_case(Study *study, SporeWorld *world, const SporePush *push) {
  SporeStabilityReport *report = study->report;
  SporeStabilityCase *into = &report->cases[report->case_count];
  SporePushRun run;
  uint64_t begun_ns = spore_clock_ns();
  study->spent |= push->jump != SPORE_JUMP_NONE;
  if (!push_world(study, world, push, length_of(study, push), &run)) return false;
  if (run.out_of_time) {
    leave_out(study, _("no time; give it more by --seconds"), _(push->label));
    return true;
  }
  *into = (SporeStabilityCase){.name = push->name, .label = push->label};
  into->verdict = spore_push_judge(world, push, &run, into->detail, sizeof into->detail);
  if (report->case_count++ > 0) {
    bool again = has_remedy(push) && spore_push_fails_by_contacts(world, push, &run);
    return !again || try_remedy(study, push, into);
  }
  report->contacts = run.contacts;
  bool longer = run.steps > report->steps;
  report->met = run.met_at > 0 && (!longer || are_affordable(study, begun_ns));
  if (report->met) report->steps = run.steps;
  return true;
}

/* A scene that is refused with the remedy before it runs went as it should. */
static bool note_refusal(Study *study, const SporePush *push, const SporeError *refusal) {
  if (is_fatal(study, refusal)) return false;
  SporeStabilityCase *into = &study->report->cases[study->report->case_count++];
  *into = (SporeStabilityCase){.name = push->name, .label = push->label, .verdict = SPORE_STABILITY_REFUSED};
  snprintf(into->detail, sizeof into->detail, _("refused before the first step: %s%s%s"), refusal->place,
           *refusal->place ? ": " : "", refusal->message);
  return true;
}

static bool same_world(const SporeStabilityChange *change) {
  return change->time_step == 1 && change->stiffness == 1 && change->mass == 1 && change->contact == 1;
}

/* world: of the scene as it is, for the cases that need no other. */
static bool try_case(Study *study, SporeWorld *world, const SporePush *push) {
  const char *why = impossible(world, push);
  if (why) {
    leave_out(study, why, _(push->label));
    return true;
  }
  if (study->options->quick && !push->quick) {
    leave_out(study, _("not with --quick"), _(push->label));
    return true;
  }
  if (is_late(study, until_cases(study))) {
    leave_out(study, _("no time; give it more by --seconds"), _(push->label));
    return true;
  }
  if (same_world(&push->change)) {
    bool done = run_case(study, world, push);
    spore_world_reset(world);
    return done;
  }
  SporeError refusal = SPORE_ERROR_INIT;
  SporeWorld *other = study->scene->make(study->scene->data, &push->change, &refusal);
  if (!other) return note_refusal(study, push, &refusal);
  bool done = run_case(study, other, push);
  study->scene->drop(study->scene->data, other);
  return done;
}

/* Those that are run with `quick`, or the others. A jump of parameters outlasts a reset: the world is made anew after
 * it.
 */
static bool try_cases(Study *study, SporeWorld **world, bool quick) {
  for (size_t i = 1; i < spore_push_count; i++) {
    if (spore_pushes[i].quick != quick) continue;
    if (!go_on(study, 1, _(spore_pushes[i].label)) || !try_case(study, *world, &spore_pushes[i])) return false;
    if (!study->spent) continue;
    study->spent = false;
    study->scene->drop(study->scene->data, *world);
    *world = study->scene->make(study->scene->data, &spore_pushes[0].change, study->error);
    if (!*world) return false;
  }
  return true;
}

/* Limits. */

/* Why a search ended before it was done. */
typedef enum SearchEnd { SEARCH_DONE, SEARCH_LATE, SEARCH_NOTHING, SEARCH_FAILED } SearchEnd;

typedef struct LimitSearch {
  Study *study;
  SporeWorld *world;
  uint32_t body;
  SporeStabilityLimit *limit;
  SearchEnd end; /* SEARCH_NOTHING: nothing of the body moves; SEARCH_FAILED: cancelled, or no memory */
} LimitSearch;

static bool limits_are_late(void *study) { return is_late(study, UNTIL_LIMITS); }

/* Ends the search. */
static int end_search(LimitSearch *search, SearchEnd end) {
  search->end = end;
  return -1;
}

static int is_safe(void *data, double step_s) {
  LimitSearch *search = data;
  SporeStabilityLimit *limit = search->limit;
  const SporeCancel late = {limits_are_late, search->study};
  if (spore_cancel_asked(&late)) return end_search(search, SEARCH_LATE);
  if (!go_on(search->study, 0, _("the largest steps"))) return end_search(search, SEARCH_FAILED);
  SporeMethodResult result = spore_world_try_method(search->world, search->body,
                                                    &(SporeMethodTrial){limit->method, step_s, limit->steps, &late});
  switch (result.outcome) {
  case SPORE_METHOD_BOUNDED:
    return 1;
  case SPORE_METHOD_NOTHING:
    return end_search(search, SEARCH_NOTHING);
  case SPORE_METHOD_NO_MEMORY:
    no_memory(search->study->error);
    return end_search(search, SEARCH_FAILED);
  case SPORE_METHOD_CANCELLED:
    if (spore_cancel_asked(&late)) return end_search(search, SEARCH_LATE);
    spore_error_set(search->study->error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
    return end_search(search, SEARCH_FAILED);
  default:
    break;
  }
  if (step_s < limit->found.unsafe_s) {
    limit->found.unsafe_s = step_s;
    limit->beyond = result.outcome;
  }
  return 0;
}

/* A step that is tried where nothing is predicted: a tenth of what the fastest mode takes for 1 rad, or the scene's. */
static double usual_step(const SporeStepLimit *limit, double step_s) {
  double usual = limit->whole_dt_s == 0 && limit->frequency > 0 ? 0.1 / limit->frequency : step_s;
  return fmin(fmax(usual, 1e-9), SPORE_STABILITY_LARGEST_STEP_S);
}

static SporeIntegratorKind kind_of(const char *name) {
  int kind = 0;
  while (strcmp(spore_integrator_names[kind], name) != 0) kind++;
  return (SporeIntegratorKind)kind;
}

/* Notes that the largest step of the body was not found. */
static void leave_limit_out(Study *study, const char *why, const char *body, SporeIntegratorKind kind) {
  char what[200];
  snprintf(what, sizeof what, _("largest step of %s by %s"), body, spore_integrator_names[kind]);
  leave_out(study, why, what);
}

/* False: cancelled, or no memory. */
static bool search_limit(LimitSearch *search) {
  Study *study = search->study;
  SporeStabilityLimit *limit = search->limit;
  SporeStepLimit predicted;
  if (!limit->body || !spore_world_predict_step(search->world, search->body, limit->method, &predicted, study->error))
    return no_memory(study->error);
  limit->predicted_s = predicted.whole_dt_s;
  limit->found = spore_step_search(&(SporeStepSearch){.predicted_s = limit->predicted_s,
                                                      .usual_s = usual_step(&predicted, limit->step_s),
                                                      .largest_s = SPORE_STABILITY_LARGEST_STEP_S,
                                                      .cuts = study->options->quick ? QUICK_CUTS : CUTS},
                                   is_safe, search);
  return search->end != SEARCH_FAILED;
}

static bool find_limit(Study *study, SporeWorld *world, uint32_t body, SporeIntegratorKind kind,
                       const SporeMethod *method) {
  SporeStabilityReport *report = study->report;
  const char *name = spore_world_body_name(world, body);
  SporeStabilityLimit *limit = &report->limits[report->limit_count];
  *limit = (SporeStabilityLimit){.body = spore_copy_text(name),
                                 .method = kind,
                                 .own = kind == kind_of(method->integrator.name),
                                 .step_s = report->time_step_s / (double)method->substeps,
                                 .found = {.unsafe_s = HUGE_VAL},
                                 .steps = study->options->quick ? QUICK_STEPS : LIMIT_STEPS};
  report->limit_count++;
  LimitSearch search = {.study = study, .world = world, .body = body, .limit = limit};
  bool done = search_limit(&search);
  if (search.end == SEARCH_LATE) leave_limit_out(study, _("no time; give it more by --seconds"), name, kind);
  if (search.end == SEARCH_NOTHING) leave_limit_out(study, _("nothing of it moves at the start"), name, kind);
  if (search.end == SEARCH_LATE || search.end == SEARCH_NOTHING) {
    spore_free(limit->body);
    report->limit_count--;
  }
  return done;
}

/* The body by its own method, or by all others that take steps in time. */
static bool find_limits_of(Study *study, SporeWorld *world, uint32_t body, bool own) {
  SporeMethod method;
  if (!spore_world_body_method(world, body, &method)) return true;
  SporeIntegratorKind chosen = kind_of(method.integrator.name);
  if (own && chosen != SPORE_INTEGRATOR_STATIC) return find_limit(study, world, body, chosen, &method);
  if (own)
    leave_limit_out(study, _("static finds a balance, and takes no step in time"), spore_world_body_name(world, body),
                    chosen);
  for (int kind = 0; !own && kind < SPORE_INTEGRATOR_STATIC; kind++)
    if (kind != (int)chosen && !find_limit(study, world, body, (SporeIntegratorKind)kind, &method)) return false;
  return true;
}

static bool find_limits(Study *study, SporeWorld *world) {
  uint32_t count = (uint32_t)spore_world_body_count(world);
  for (uint32_t body = 0; body < count; body++)
    if (!go_on(study, 1, _("the largest steps")) || !find_limits_of(study, world, body, true)) return false;
  if (study->options->quick)
    leave_out(study, _("not with --quick"), _("largest steps by other methods than each body's own"));
  for (uint32_t body = 0; !study->options->quick && body < count; body++)
    if (!go_on(study, 0, _("the largest steps")) || !find_limits_of(study, world, body, false)) return false;
  return true;
}

/* The map. */

static SporeStabilityMap empty_map(const Study *study) {
  bool quick = study->options->quick;
  SporeStabilityMap map = {
      .columns = quick ? 5 : SPORE_STABILITY_COLUMNS, .rows = quick ? 3 : SPORE_STABILITY_ROWS, .steps = CELL_STEPS};
  for (size_t c = 0; c < map.columns; c++)
    map.time_step_s[c] = fmin(study->report->time_step_s * pow(quick ? 4 : 2, (double)c - (double)(map.columns / 2)),
                              SPORE_STABILITY_LARGEST_STEP_S);
  for (size_t r = 0; r < map.rows; r++) map.stiffness[r] = pow(100, (double)r - (double)(map.rows / 2));
  while (map.columns > 1 && map.time_step_s[map.columns - 1] == map.time_step_s[map.columns - 2]) map.columns--;
  return map;
}

static bool fill_cell(Study *study, SporeStabilityMap *map, size_t row, size_t column) {
  const SporeStabilityChange change = {map->time_step_s[column] / study->report->time_step_s, map->stiffness[row], 1, 1,
                                       false};
  char detail[64];
  SporeError refusal = SPORE_ERROR_INIT;
  SporePushRun run;
  SporeWorld *world = study->scene->make(study->scene->data, &change, &refusal);
  if (!world) {
    map->known[row][column] = !is_fatal(study, &refusal);
    map->cells[row][column] = SPORE_STABILITY_REFUSED;
    return map->known[row][column];
  }
  bool done = spore_push_run(study->scene, world, &spore_pushes[0],
                             (SporePushLength){.steps = map->steps, .until_ns = clock_at(study, 1)}, &run);
  if (!done) no_memory(study->error);
  map->known[row][column] = !run.out_of_time;
  map->cells[row][column] = spore_push_judge(world, &spore_pushes[0], &run, detail, sizeof detail);
  if (spore_world_cancelled(world)) done = spore_error_set(study->error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
  study->scene->drop(study->scene->data, world);
  return done;
}

/* The body whose own method bears the smallest steps, compared with its step in the scene; NULL: theory sets no limit.
 */
static const SporeStabilityLimit *narrowest(const SporeStabilityReport *report) {
  const SporeStabilityLimit *found = NULL;
  double least = HUGE_VAL;
  for (size_t i = 0; i < report->limit_count; i++) {
    const SporeStabilityLimit *limit = &report->limits[i];
    double part = limit->predicted_s / limit->step_s;
    if (!limit->own || !(limit->predicted_s > 0) || !(part < least)) continue;
    least = part;
    found = limit;
  }
  return found;
}

/* What theory says of that body at the row's stiffness, from a world with a step that is small enough not to be
 * refused. */
static bool predict_row(Study *study, SporeStabilityMap *map, size_t row) {
  SporeError refusal = SPORE_ERROR_INIT;
  SporeStepLimit predicted;
  const SporeStabilityLimit *limit = map->narrowest;
  const SporeStabilityChange change = {SMALL_STEP, map->stiffness[row], 1, 1, false};
  if (!limit) return true;
  SporeWorld *world = study->scene->make(study->scene->data, &change, &refusal);
  if (!world) return !is_fatal(study, &refusal);
  uint32_t body = spore_world_find_body(world, limit->body);
  bool done = spore_world_predict_step(world, body, limit->method, &predicted, study->error);
  if (done) map->limit_s[row] = predicted.whole_dt_s * study->report->time_step_s / limit->step_s;
  study->scene->drop(study->scene->data, world);
  return done;
}

/* Rows from the scene's own stiffness outward, so that what is left out lies at the edges. */
static bool make_map(Study *study) {
  SporeStabilityMap *map = &study->report->map;
  size_t left = 0;
  if (!study->options->map) {
    leave_out(study, _("ask for it by --svg"), _("map of steps and stiffnesses"));
    return true;
  }
  *map = empty_map(study);
  map->narrowest = narrowest(study->report);
  for (size_t k = 0; k < map->rows; k++) {
    size_t half = map->rows / 2, away = (k + 1) / 2, row = k % 2 ? half + away : half - away;
    if (!is_late(study, 1) && !predict_row(study, map, row)) return false;
    for (size_t column = 0; column < map->columns; column++) {
      if (is_late(study, 1)) left++;
      else if (!go_on(study, 0.3, _("the map")) || !fill_cell(study, map, row, column)) return false;
    }
  }
  char what[100];
  snprintf(what, sizeof what, _("%zu cells of the map"), left);
  if (left > 0) leave_out(study, _("no time; give it more by --seconds"), what);
  return true;
}

/* The whole. */

static bool allocate(SporeStabilityReport *report, const SporeWorld *world) {
  report->cases = SPORE_NEW_ARRAY(SporeStabilityCase, spore_push_count);
  report->limits = SPORE_NEW_ARRAY(SporeStabilityLimit, spore_world_body_count(world) * SPORE_INTEGRATOR_COUNT);
  report->left_out = SPORE_NEW_ARRAY(SporeStabilityLeftOut, LEFT_OUT_MOST);
  return report->cases && report->limits && report->left_out;
}

static bool all_explicit(const SporeWorld *world) {
  for (uint32_t b = 0; b < spore_world_body_count(world); b++) {
    SporeMethod method;
    if (spore_world_body_method(world, b, &method) && spore_integrator(kind_of(method.integrator.name))->implicit)
      return false;
  }
  return true;
}

/* Steps of a case: the time that was asked for; else a second, and no more work than a case may be. */
static size_t choose_steps(const SporeStabilityOptions *options, const SporeWorld *world, double step_s) {
  if (options->time_s > 0) return (size_t)fmax(ceil(options->time_s / step_s - 1e-9), 1);
  double most = (options->quick ? WORK_OF_A_QUICK_CASE : WORK_OF_A_CASE) / fmax((double)spore_world_dof(world), 1);
  if (all_explicit(world)) most *= TIMES_EXPLICIT;
  return (size_t)fmax(fmin(ceil(USUAL_TIME_S / step_s), most), LEAST_STEPS);
}

/* False: cancelled, no memory, or the scene cannot run. */
static bool run_study(Study *study, SporeWorld **world) {
  SporeStabilityReport *report = study->report;
  report->time_step_s = study->scene->time_step_s;
  report->steps = choose_steps(study->options, *world, report->time_step_s);
  report->instruments = spore_input_is_possible(*world);
  study->all = (double)(spore_push_count + spore_world_body_count(*world)) +
               (study->options->map ? 0.3 * SPORE_STABILITY_COLUMNS * SPORE_STABILITY_ROWS : 0);
  return go_on(study, 0, _(spore_pushes[0].label)) && try_case(study, *world, &spore_pushes[0]) &&
         find_limits(study, *world) && try_cases(study, world, true) && try_cases(study, world, false) &&
         make_map(study);
}

SporeStabilityReport *spore_stability_study(const SporeStabilityScene *scene, const SporeStabilityOptions *options,
                                            SporeError *error) {
  assert(scene && scene->make && scene->drop && scene->jump && options->most_s > 0);
  Study study = {.scene = scene, .options = options, .begun_ns = spore_clock_ns(), .error = error};
  SporeWorld *world = scene->make(scene->data, &spore_pushes[0].change, error);
  if (!world) return NULL;
  study.report = SPORE_NEW(SporeStabilityReport);
  bool done = study.report && allocate(study.report, world);
  if (!done) no_memory(error);
  else done = run_study(&study, &world);
  if (world) scene->drop(scene->data, world);
  if (done) return study.report;
  spore_stability_report_free(study.report);
  return NULL;
}

void spore_stability_report_free(SporeStabilityReport *report) {
  if (!report) return;
  for (size_t i = 0; i < report->limit_count; i++) spore_free(report->limits[i].body);
  spore_free(report->cases);
  spore_free(report->limits);
  spore_free(report->left_out);
  spore_free(report);
}

size_t spore_stability_count(const SporeStabilityReport *report, SporeStabilityVerdict verdict) {
  size_t count = 0;
  for (size_t i = 0; i < report->case_count; i++) count += report->cases[i].verdict == verdict;
  return count;
}
